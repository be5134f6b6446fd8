/* SPDX-License-Identifier: MIT */
/*
 * The steps that statements and faces share: see line.h.
 */
#include "obj/line.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A chunk's arrays begin with room for one element per this many bytes of text, which is about what
 * dense files hold; memory that is not used is never touched. */
enum { BYTES_PER_ELEMENT = 24 };

char *obj_copy_padded(const char *begin, const char *end, const char **padded_end)
{
	const size_t size = (size_t)(end - begin);
	char *copy = nt_calloc(size + 16, 1);
	if (!copy)
		return NULL;
	memcpy(copy, begin, size);
	memset(copy + size, '\n', 4);
	const bool ended = size && begin[size - 1] == '\n';
	*padded_end = copy + size + !ended;
	return copy;
}

void obj_chunk_free_rest(obj_chunk *chunk)
{
	free(chunk->colors);
	free(chunk->mrgb);
	free(chunk->mrgb_lines);
	free(chunk->polygons);
	free(chunk->events);
}

void obj_chunk_free(obj_chunk *chunk)
{
	obj_chunk_free_rest(chunk);
	for (int kind = 0; kind < OBJ_KIND_COUNT; kind++)
		free(chunk->rows[kind].data);
	free(chunk->distinct);
	free(chunk->corners);
	free(chunk->face_sizes);
}

nt_status obj_reader_init(obj_reader *r, obj_chunk *chunk)
{
	*r = (obj_reader){.chunk = chunk, .p = chunk->begin};
	r->recent = nt_calloc(RECENT_COUNT, sizeof *r->recent);
	return r->recent ? NT_OK : obj_fail_memory(r);
}

void obj_reader_free(obj_reader *r)
{
	free(r->recent);
}

void obj_skip_joined_lines(obj_reader *r)
{
	while (is_blank(*r->p) || joins_lines(r->p)) {
		if (!is_blank(*r->p)) {
			r->p = behind_line_end(r->p + 1) - 1;
			r->line++;
		}
		r->p++;
	}
}

void obj_ignore(obj_reader *r, size_t which)
{
	obj_ignored *ignored = &r->chunk->ignored[which];
	if (ignored->count++ == 0)
		ignored->line = r->statement_line;
}

/* ---- errors ---- */

/* The word at p as it may be shown: cut at 32 characters, bytes that are no ASCII as \xHH. */
static void quote_word(char text[160], const char *p)
{
	if (is_line_end(*p) || *p == '#') {
		snprintf(text, 160, "the end of the line");
		return;
	}
	size_t used = (size_t)snprintf(text, 160, "\"");
	for (int i = 0; i < 32 && !is_word_end(p); i++, p++) {
		const unsigned char c = (unsigned char)*p;
		used += (size_t)snprintf(text + used, 160 - used, c >= 0x20 && c < 0x7F ? "%c" : "\\x%02x", c);
	}
	snprintf(text + used, 160 - used, is_word_end(p) ? "\"" : "...\"");
}

nt_status obj_fail_expected(obj_reader *r, const char *expected)
{
	char found[160];
	quote_word(found, r->p);
	return nt_fail_line(&r->chunk->error, NT_ERROR_INPUT, r->line + 1, "found %s, expected %s", found,
		expected);
}

nt_status obj_fail_memory(obj_reader *r)
{
	return nt_fail_memory(&r->chunk->error);
}

/* A chunk never has 2^30 elements, which OBJ_BIAS relies on. */
bool obj_grow(obj_chunk *chunk, void **block, size_t *capacity, size_t count, size_t row_size)
{
	const size_t guess = (size_t)(chunk->end - chunk->begin) / BYTES_PER_ELEMENT + 1;
	const size_t needed = *capacity ? count + 1 : guess;
	return count + 1 < OBJ_BIAS && nt_grow(block, capacity, needed, row_size);
}
