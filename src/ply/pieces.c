/* SPDX-License-Identifier: MIT */
/*
 * Plain rows of text by several threads. The text is cut into pieces of whole lines; where each row is a line, the
 * lines before a piece say which row it begins with. Whether all of them are rows shows itself when they are read: what
 * comes behind the first that is no plain row is read again, by one thread, since there may be as many of these as
 * lines.
 *
 * The size of pieces does not depend on the number of threads, and none of it shows in what is read.
 */
#include "ply/source.h"

#include <stdlib.h>
#include "base/memory.h"
#include "base/parallel.h"

enum { PIECE_BYTES = 1 << 20, LEAST_PIECES = 4 };

typedef struct piece {
	const unsigned char *begin, *end; /* the beginnings of lines */
	size_t first, rows;               /* the rows that it would have */
	size_t taken;
	const unsigned char *stop;        /* behind the last row that was taken */
} piece;

typedef struct pieces {
	const ply_cursor *cursor;
	ply_take_rows take;
	void *user;
	piece *list;
	size_t count;
} pieces;

/* Behind the line end that comes next, or the end of the input. */
static const unsigned char *next_line(const unsigned char *at, const unsigned char *end)
{
	const unsigned char *found = memchr(at, '\n', (size_t)(end - at));
	return found ? found + 1 : end;
}

static void cut(pieces *p)
{
	const unsigned char *at = p->cursor->at;
	const unsigned char *const end = p->cursor->end;
	for (p->count = 0; at < end; p->count++) {
		const bool last = (size_t)(end - at) <= PIECE_BYTES;
		piece *const new = &p->list[p->count];
		*new = (piece){.begin = at, .end = last ? end : next_line(at + PIECE_BYTES, end)};
		at = new->end;
	}
}

static void count_rows(void *context, size_t item, unsigned slot)
{
	(void)slot;
	piece *const own = &((pieces *)context)->list[item];
	for (const unsigned char *at = own->begin; at < own->end; at = next_line(at, own->end))
		own->rows++;
}

static void take_piece(void *context, size_t item, unsigned slot)
{
	(void)slot;
	const pieces *p = context;
	piece *const own = &p->list[item];
	ply_cursor cursor = *p->cursor;
	cursor.at = own->begin;
	own->taken = p->take(p->user, &cursor, own->first, own->rows);
	own->stop = cursor.at;
}

/* Gives pieces their first rows; those that would begin behind the last row are left out. */
static void number_rows(pieces *p, size_t rows)
{
	size_t first = 0, used = 0;
	for (; used < p->count && first < rows; used++) {
		piece *const own = &p->list[used];
		own->first = first;
		own->rows = own->rows < rows - first ? own->rows : rows - first;
		first += own->rows;
	}
	p->count = used;
}

size_t ply_take_pieces(ply_cursor *cursor, size_t rows, ply_take_rows take, void *user)
{
	const size_t most = (size_t)(cursor->end - cursor->at) / PIECE_BYTES + 1;
	pieces p = {.cursor = cursor, .take = take, .user = user};
	if (cursor->threads > 1 && most >= LEAST_PIECES)
		p.list = nt_alloc(most, sizeof *p.list);
	if (!p.list) /* also without memory for them */
		return take(user, cursor, 0, rows);
	cut(&p);
	nt_parallel_items(cursor->threads, p.count, count_rows, &p);
	number_rows(&p, rows);
	nt_parallel_items(cursor->threads, p.count, take_piece, &p);
	size_t taken = 0, i = 0;
	bool whole = true;
	for (; whole && i < p.count; i++) {
		taken += p.list[i].taken;
		cursor->at = p.list[i].stop;
		whole = p.list[i].taken == p.list[i].rows;
	}
	if (!whole)
		cursor->threads = 1;
	free(p.list);
	return taken;
}
