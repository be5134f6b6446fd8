/* SPDX-License-Identifier: MIT */
/*
 * The cursor in a chunk of an OBJ, and the small steps that every statement takes: statements.c,
 * faces.c and locate.c stand on it.
 *
 * Every chunk ends behind a line feed and has 8 readable bytes behind it (the last lines of the file are
 * copied to make it so). Numbers and blanks therefore stop by themselves, and nothing here asks
 * for the end of the input within a line.
 */
#ifndef NT_OBJ_LINE_H
#define NT_OBJ_LINE_H

#include "obj/parts.h"

/* Neighbouring faces share corners: a table of this size finds nearly all of them again within a chunk and
 * stays in the cache. */
enum { RECENT_COUNT = 1 << 13 };

/* The position of the reader. */
typedef struct obj_reader {
	obj_chunk *chunk;
	const char *p;
	size_t line;           /* of p, within the chunk, from 0 */
	const char *statement; /* its first word, and the line of that */
	size_t statement_line;

	/* Number + 1 of the distinct corner that last had a v, by the low bits of v. Valid are those of
	 * this object that still exist. */
	uint32_t *recent;
	size_t object_begin;   /* distinct corners of the chunk before the object, or its last usemtl */
} obj_reader;

/* A copy of lines that may stand at the end of a file, ended and padded as chunks are; NULL: out of memory. */
char *obj_copy_padded(const char *begin, const char *end, const char **padded_end);

/* Begins a chunk; the reader is freed after failure, too. */
nt_status obj_reader_init(obj_reader *r, obj_chunk *chunk);
void obj_reader_free(obj_reader *r);

/* Steps over blanks and joined lines. */
void obj_skip_joined_lines(obj_reader *r);

/* Fails with "found WORD, expected EXPECTED" at the reader's line; and for want of memory. */
nt_status obj_fail_expected(obj_reader *r, const char *expected);
nt_status obj_fail_memory(obj_reader *r);

/* Grows an array of the chunk that has `count` rows; false: out of memory. */
bool obj_grow(obj_chunk *chunk, void **block, size_t *capacity, size_t count, size_t row_size);

/* Counts a statement that is not used. */
void obj_ignore(obj_reader *r, size_t which);

/* Reads what follows "f": faces.c. */
nt_status obj_read_face(obj_reader *r);

/* Reads a line that begins with "#MRGB": colors.c. */
nt_status obj_read_mrgb(obj_reader *r);

/* Reads the lines up to that of face number `last` of the chunk, or all: statements.c. */
nt_status obj_read_lines(obj_reader *r, size_t last);

/* Room for one more row. */
static inline bool obj_reserve(obj_chunk *chunk, void **block, size_t *capacity, size_t count,
	size_t row_size)
{
	return count < *capacity || obj_grow(chunk, block, capacity, count, row_size);
}

static inline bool is_line_end(char c)
{
	return c == '\n' || c == '\r';
}

static inline bool is_digit(char c)
{
	return c >= '0' && c <= '9';
}

/* The beginning of the next line if p is at a line end. */
static inline const char *behind_line_end(const char *p)
{
	return p + (p[0] == '\r' && p[1] == '\n' ? 2 : 1);
}

/* A blank, or a `\` that joins the next line to this one. */
static inline bool joins_lines(const char *p)
{
	return *p == '\\' && is_line_end(p[1]);
}

static inline void skip_blanks(obj_reader *r)
{
	while (*r->p == ' ')
		r->p++;
	if (*r->p == '\t' || *r->p == '\\')
		obj_skip_joined_lines(r);
}

/* Whether a word may end here. */
static inline bool is_word_end(const char *p)
{
	return is_blank(*p) || is_line_end(*p) || joins_lines(p);
}

#endif
