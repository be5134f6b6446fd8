/* SPDX-License-Identifier: MIT */
/*
 * The faces of an OBJ: "f" and its corners, which are most of a file. Corners of the usual form are
 * taken in one tight loop; whatever else comes goes the general way, which also words the errors.
 *
 * A corner is kept as the number of its v/t/n among the distinct ones of the chunk. A small table of
 * recent ones recognises nearly all that neighbouring faces share, in the cache; vertices.c does the
 * rest for the file.
 */
#include "obj/line.h"

#include "file/decimal.h"

/* An index of nine and more digits, one that counts back, or none. */
static nt_status read_unusual_index(obj_reader *r, size_t count, uint32_t *index)
{
	const char *p = r->p;
	const bool back = *p == '-';
	p += back;
	if (!is_digit(*p))
		return obj_fail_expected(r, "the number of a vertex, as in 3, 3/1, 3//2 or 3/1/2");
	uint64_t value = 0;
	for (; is_digit(*p); p++)
		if (value < OBJ_RELATIVE)
			value = value * 10 + (uint64_t)(*p - '0');
	if (value == 0)
		return obj_fail_expected(r, "an index, which begins at 1 or counts back from -1");
	if (value > (back ? OBJ_BIAS : OBJ_RELATIVE - 1))
		return obj_fail_expected(r, "an index that a file can hold");
	*index = back ? OBJ_RELATIVE | (uint32_t)(OBJ_BIAS + count - value) : (uint32_t)value - 1;
	r->p = p;
	return NT_OK;
}

/* `count` elements of that kind precede the face in its chunk. */
static nt_status read_index(obj_reader *r, size_t count, uint32_t *index)
{
	uint32_t value;
	const unsigned digits = nt_read_digits(r->p, &value);
	if (digits == 0 || digits == 8 || value == 0)
		return read_unusual_index(r, count, index);
	r->p += digits;
	*index = value - 1;
	return NT_OK;
}

/* The quick way for v, v//n and v/t/n of short positive numbers before a blank or the line's end. NULL:
 * something else, which read_corner() takes or refuses. 0 stands for no digits as well. Other bytes up
 * to the blank end a corner, too: they will be no corner when they are next. */
static inline const char *read_plain_corner(const char *p, obj_corner *corner)
{
	uint32_t t = 0, n = 0;
	unsigned digits;
	const uint32_t v = nt_read_short_digits(p, &digits);
	p += digits;
	if (*p == '/') {
		if (*++p != '/') {
			t = nt_read_short_digits(p, &digits);
			p += digits;
			if (t == 0 || *p != '/')
				return NULL;
		}
		n = nt_read_short_digits(++p, &digits);
		p += digits;
		if (n == 0)
			return NULL;
	}
	*corner = (obj_corner){v - 1, t - 1, n - 1}; /* 0 becomes OBJ_ABSENT */
	return v != 0 && (unsigned char)*p <= ' ' ? p : NULL;
}

/* v, v/t, v//n or v/t/n. */
static nt_status read_corner(obj_reader *r, obj_corner *corner)
{
	const obj_chunk *chunk = r->chunk;
	nt_status status = read_index(r, chunk->rows[OBJ_V].count, &corner->v);
	corner->t = corner->n = OBJ_ABSENT;
	if (!status && *r->p == '/') {
		r->p++;
		if (*r->p != '/' && !is_word_end(r->p))
			status = read_index(r, chunk->rows[OBJ_VT].count, &corner->t);
		if (!status && *r->p == '/') {
			r->p++;
			if (!is_word_end(r->p))
				status = read_index(r, chunk->rows[OBJ_VN].count, &corner->n);
		}
	}
	if (!status && !is_word_end(r->p) && *r->p != '#')
		return obj_fail_expected(r, "a blank behind the corner of a face");
	return status;
}

/* The number of a corner among the distinct ones of this object that were seen lately; where it is not
 * there it takes the place of `next`, the next free number. */
static inline uint32_t number_corner(const obj_reader *r, const obj_corner *distinct, size_t next,
	const obj_corner *corner)
{
	uint32_t *recent = &r->recent[corner->v % RECENT_COUNT];
	const size_t number = (size_t)*recent - 1;
	if (number - r->object_begin < next - r->object_begin) {
		const obj_corner *seen = &distinct[number];
		if (((seen->v ^ corner->v) | (seen->t ^ corner->t) | (seen->n ^ corner->n)) == 0)
			return (uint32_t)number;
	}
	*recent = (uint32_t)next + 1;
	return (uint32_t)next;
}

static nt_status store_corner(obj_reader *r, obj_corner corner)
{
	obj_chunk *chunk = r->chunk;
	if (!obj_reserve(chunk, (void **)&chunk->corners, &chunk->corner_capacity, chunk->corner_count,
			sizeof *chunk->corners) ||
		!obj_reserve(chunk, (void **)&chunk->distinct, &chunk->distinct_capacity,
			chunk->distinct_count, sizeof *chunk->distinct))
		return obj_fail_memory(r);
	const uint32_t number = number_corner(r, chunk->distinct, chunk->distinct_count, &corner);
	if (number == chunk->distinct_count)
		chunk->distinct[chunk->distinct_count++] = corner;
	chunk->corners[chunk->corner_count++] = number;
	return NT_OK;
}

/* Takes corners the quick way as long as they are plain and there is room. */
static void read_plain_corners(obj_reader *r)
{
	obj_chunk *chunk = r->chunk;
	obj_corner *const distinct = chunk->distinct;
	size_t distinct_count = chunk->distinct_count, count = chunk->corner_count;
	const char *p = r->p;
	while (count < chunk->corner_capacity && distinct_count < chunk->distinct_capacity) {
		while (*p == ' ')
			p++;
		obj_corner corner;
		const char *end = read_plain_corner(p, &corner);
		if (!end)
			break;
		p = end;
		const uint32_t number = number_corner(r, distinct, distinct_count, &corner);
		if (number == distinct_count)
			distinct[distinct_count++] = corner;
		chunk->corners[count++] = number;
	}
	r->p = p;
	chunk->distinct_count = distinct_count;
	chunk->corner_count = count;
}

/* Closes the face that began at these counts, or takes it back where it is none. */
static nt_status end_face(obj_reader *r, size_t first_corner, size_t first_distinct)
{
	obj_chunk *chunk = r->chunk;
	const size_t size = chunk->corner_count - first_corner;
	if (size < 3) {
		if (chunk->ignored[OBJ_SMALL_FACE].count == 0)
			chunk->small_size = size;
		chunk->corner_count = first_corner;
		chunk->distinct_count = first_distinct;
		obj_ignore(r, OBJ_SMALL_FACE);
		return NT_OK;
	}
	if (!obj_reserve(chunk, (void **)&chunk->face_sizes, &chunk->face_capacity, chunk->face_count, 1))
		return obj_fail_memory(r);
	if (size >= OBJ_POLYGON) {
		if (!nt_grow((void **)&chunk->polygons, &chunk->polygon_capacity, chunk->polygon_count + 1,
				sizeof *chunk->polygons))
			return obj_fail_memory(r);
		chunk->polygons[chunk->polygon_count++] = (obj_polygon){chunk->face_count, size, r->statement_line};
	}
	chunk->face_sizes[chunk->face_count++] = (uint8_t)(size < OBJ_POLYGON ? size : OBJ_POLYGON);
	return NT_OK;
}

nt_status obj_read_face(obj_reader *r)
{
	const obj_chunk *chunk = r->chunk;
	const size_t first_corner = chunk->corner_count, first_distinct = chunk->distinct_count;
	for (;;) {
		read_plain_corners(r);
		skip_blanks(r);
		if (is_line_end(*r->p) || *r->p == '#')
			return end_face(r, first_corner, first_distinct);
		obj_corner corner;
		nt_status status = read_corner(r, &corner);
		if (!status)
			status = store_corner(r, corner);
		if (status)
			return status;
	}
}
