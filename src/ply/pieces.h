/* SPDX-License-Identifier: MIT */
/*
 * Plain rows of text by several threads: see pieces.c.
 */
#ifndef NT_PLY_PIECES_H
#define NT_PLY_PIECES_H

#include "ply/cursor.h"

/* Reads plain rows, each a line, at the cursor: at most `rows`, of which the first is row `first` of the run. The
 * cursor moves behind those that were read, whose number is returned; the row there is another one, or wrong. Several
 * threads call it, for rows that are not the same. */
typedef size_t (*ply_take_rows)(void *user, ply_cursor *cursor, size_t first, size_t rows);

/* The same for rows from 0 on, with cursor->threads. */
size_t ply_take_pieces(ply_cursor *cursor, size_t rows, ply_take_rows take, void *user);

#endif
