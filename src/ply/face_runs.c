/* SPDX-License-Identifier: MIT */
/*
 * Runs of plain faces: nearly every file is triangles (or quads) whose row is a list of numbers and
 * little else. They are read here in tight loops that stop at the first row that is anything else, be
 * it wrong or only unusual, and leave it to faces.c.
 */
#include "ply/source.h"


/* Bytes that a short row of text and the eight-byte steps of decimal.h may touch. */
enum { TEXT_MARGIN = 64 };

ply_run_layout ply_find_run_layout(const ply_element *element, int indices, ply_encoding encoding)
{
	const ply_property *list = &element->properties[indices];
	ply_run_layout layout = {.encoding = encoding};
	if (encoding == PLY_ASCII) {
		layout.possible = element->property_count == 1;
		return layout;
	}
	for (size_t i = 0; i < element->property_count; i++)
		if (element->properties[i].list && (int)i != indices)
			return layout;
	layout.possible = ply_size(list->count_type) == 1 && ply_size(list->type) == 4;
	layout.lead = list->offset;
	layout.tail = element->row_bytes - list->offset - 1;
	return layout;
}

/* Constant sizes and orders give four loops without a test. */
static inline __attribute__((always_inline)) size_t take_binary(const ply_run_layout *layout,
	ply_cursor *cursor, size_t rows, size_t size, bool swap, size_t vertex_count, uint32_t *indices)
{
	const size_t row_bytes = layout->lead + 1 + 4 * size + layout->tail;
	const size_t most = (size_t)(cursor->end - cursor->at) / row_bytes;
	const size_t limit = rows < most ? rows : most;
	const unsigned char *at = cursor->at + layout->lead;
	size_t taken = 0;
	for (; taken < limit && *at == size; taken++, at += row_bytes, indices += size) {
		uint32_t largest = 0;
		for (size_t k = 0; k < size; k++) {
			indices[k] = ply_load32(at + 1 + 4 * k, swap);
			largest = indices[k] > largest ? indices[k] : largest;
		}
		if (largest >= vertex_count)
			break;
	}
	cursor->at += taken * row_bytes;
	return taken;
}

/* "3 0 1 2" with single blanks and numbers of at most 8 digits, from the beginning of a line. */
static inline __attribute__((always_inline)) size_t take_text(ply_cursor *cursor, size_t rows, size_t size,
	size_t vertex_count, uint32_t *indices)
{
	const char *at = (const char *)cursor->at;
	const char *const end = (const char *)cursor->end;
	size_t taken = 0;
	for (; taken < rows && end - at > TEXT_MARGIN && *at == (char)('0' + size); taken++) {
		const char *p = at + 1;
		bool plain = true;
		for (size_t k = 0; k < size; k++) {
			plain &= *p++ == ' ';
			const unsigned digits = nt_read_digits(p, &indices[k]);
			plain &= digits > 0 && indices[k] < vertex_count;
			p += digits;
		}
		p += *p == '\r';
		if (!plain || *p != '\n')
			break;
		at = p + 1;
		indices += size;
	}
	cursor->at = (const unsigned char *)at;
	return taken;
}

typedef struct text_faces {
	size_t size, vertex_count;
	uint32_t *indices; /* of the first row */
} text_faces;

static size_t take_text_rows(void *user, ply_cursor *cursor, size_t first, size_t rows)
{
	const text_faces *faces = user;
	uint32_t *const to = faces->indices + first * faces->size;
	return faces->size == 3 ? take_text(cursor, rows, 3, faces->vertex_count, to)
				: take_text(cursor, rows, 4, faces->vertex_count, to);
}

size_t ply_run_size(const ply_run_layout *layout, const ply_cursor *cursor)
{
	if (!layout->possible || (size_t)(cursor->end - cursor->at) <= layout->lead)
		return 0;
	const unsigned first = cursor->at[layout->lead];
	const unsigned size = layout->encoding == PLY_ASCII ? first - '0' : first;
	return size == 3 || size == 4 ? size : 0;
}

size_t ply_take_run(const ply_run_layout *layout, ply_cursor *cursor, size_t rows, size_t size,
	size_t vertex_count, uint32_t *indices)
{
	if (layout->encoding == PLY_ASCII)
		return ply_take_pieces(cursor, rows, take_text_rows, &(text_faces){size, vertex_count, indices});
	const bool swap = ply_swaps(layout->encoding);
	if (size == 3)
		return swap ? take_binary(layout, cursor, rows, 3, true, vertex_count, indices)
			    : take_binary(layout, cursor, rows, 3, false, vertex_count, indices);
	return swap ? take_binary(layout, cursor, rows, 4, true, vertex_count, indices)
		    : take_binary(layout, cursor, rows, 4, false, vertex_count, indices);
}
