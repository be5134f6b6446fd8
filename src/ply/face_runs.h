/* SPDX-License-Identifier: MIT */
/*
 * Rows of plain triangles or quads, read many at a time; faces.c takes all others.
 */
#ifndef NT_PLY_FACE_RUNS_H
#define NT_PLY_FACE_RUNS_H

#include "ply/cursor.h"

typedef struct ply_run_layout {
	bool possible;     /* the element's rows can be read so */
	ply_encoding encoding;
	size_t lead, tail; /* binary: bytes of scalars before and after the list */
} ply_run_layout;

ply_run_layout ply_find_run_layout(const ply_element *element, int indices, ply_encoding encoding);

/* The size, 3 or 4, that the row at the cursor seems to have; 0: read it the general way. */
size_t ply_run_size(const ply_run_layout *layout, const ply_cursor *cursor);

/* Reads at most `rows` faces of that size, up to the first that is not plain and sound; moves the
 * cursor behind them and returns their number. indices has room for rows * size. */
size_t ply_take_run(const ply_run_layout *layout, ply_cursor *cursor, size_t rows, size_t size,
	size_t vertex_count, uint32_t *indices);

#endif
