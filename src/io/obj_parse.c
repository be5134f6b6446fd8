/* SPDX-License-Identifier: MIT */
/*
 * OBJ lines become arrays. A chunk is a run of whole lines, so several can be read at once; what a
 * line means does not depend on the lines before it, but for faces that count back ("-1") and for the
 * statements between faces, which are kept in order for later.
 *
 * Every chunk ends behind a line feed and has 8 readable bytes behind it (obj.c copies the last lines
 * of the file to make it so). Numbers and blanks therefore stop by themselves, and nothing here asks
 * for the end of the input within a line.
 *
 * Forgiving where exporters differ: blanks and tabs anywhere, CRLF and lone CR, `\` before a line end,
 * comments behind a statement, trailing slashes ("3/"), statements of OBJ that say nothing about
 * polygons. Strict where a guess could be wrong: numbers, their count, their finiteness, index 0.
 */
#include "io/obj_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "io/decimal.h"

/* A chunk's arrays begin with room for one element per this many bytes of text, which is about what
 * dense files hold; memory that is not used is never touched. */
enum { BYTES_PER_ELEMENT = 24 };

/* Neighbouring faces share corners: a table of this size finds nearly all of them again within a chunk and
 * stays in the cache. */
enum { RECENT_COUNT = 1 << 13 };

const char *const obj_ignored_names[OBJ_IGNORED_COUNT] = {
	[OBJ_SMALL_FACE] = "f with fewer than 3 corners",
	"l", "p", "vp", "deg", "bmat", "step", "cstype", "curv", "curv2", "surf", "parm", "trim", "hole",
	"scrv", "sp", "end", "con", "mg", "bevel", "c_interp", "d_interp", "lod", "shadow_obj",
	"trace_obj", "ctech", "stech", "usemap", "maplib", "call", "csh", "bsp", "bzp", "cdc", "cdp",
	[OBJ_UNKNOWN] = "unknown statement",
};

/* Where the reader stands. */
typedef struct reader {
	obj_chunk *chunk;
	const char *p;
	size_t line;           /* of p, within the chunk, from 0 */
	size_t statement_line; /* of the statement's first word */

	/* Number + 1 of the distinct corner that last had a v, by the low bits of v. Valid are those of
	 * this object that still exist. */
	uint32_t *recent;
	size_t object_begin;   /* distinct corners of the chunk before the object */
} reader;

static bool is_blank(char c)
{
	return c == ' ' || c == '\t';
}

static bool is_line_end(char c)
{
	return c == '\n' || c == '\r';
}

static bool is_digit(char c)
{
	return c >= '0' && c <= '9';
}

/* Where the next line begins when p stands at a line end. */
static const char *behind_line_end(const char *p)
{
	return p + (p[0] == '\r' && p[1] == '\n' ? 2 : 1);
}

/* A blank, or a `\` that joins the next line to this one. */
static bool joins_lines(const char *p)
{
	return *p == '\\' && is_line_end(p[1]);
}

static void skip_joined_lines(reader *r)
{
	while (is_blank(*r->p) || joins_lines(r->p)) {
		if (!is_blank(*r->p)) {
			r->p = behind_line_end(r->p + 1) - 1;
			r->line++;
		}
		r->p++;
	}
}

static inline void skip_blanks(reader *r)
{
	while (*r->p == ' ')
		r->p++;
	if (*r->p == '\t' || *r->p == '\\')
		skip_joined_lines(r);
}

/* Whether a word may end here. */
static bool is_word_end(const char *p)
{
	return is_blank(*p) || is_line_end(*p) || joins_lines(p);
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

/* Fails with "found WORD, expected EXPECTED" at the reader's line. */
static nmtan_status fail_expected(reader *r, const char *expected)
{
	char found[160];
	quote_word(found, r->p);
	return nt_fail_line(&r->chunk->error, NMTAN_ERROR_INPUT, r->line + 1, "found %s, expected %s", found,
		expected);
}

static nmtan_status fail_memory(reader *r)
{
	return nt_fail_memory(&r->chunk->error);
}

/* ---- arrays ---- */

/* Room for one more row. A chunk never has 2^30 elements, which OBJ_BIAS relies on. */
static bool reserve(obj_chunk *chunk, void **block, size_t *capacity, size_t count, size_t row_size)
{
	if (count < *capacity)
		return true;
	const size_t guess = (size_t)(chunk->end - chunk->begin) / BYTES_PER_ELEMENT + 1;
	const size_t needed = *capacity ? count + 1 : guess;
	return count + 1 < OBJ_BIAS && nt_grow(block, capacity, needed, row_size);
}

/* ---- v, vt, vn ---- */

/* The quick way for a line of `count` short decimals and nothing else; NULL: something else. */
static inline const char *read_plain_numbers(const char *p, float *numbers, int count)
{
	for (int i = 0; i < count; i++) {
		while (*p == ' ')
			p++;
		p = nt_read_plain_decimal(p, &numbers[i]);
		if (!p || (unsigned char)*p > ' ')
			return NULL;
	}
	return is_line_end(*p) ? p : NULL;
}

/* Reads numbers up to the end of the line, at most `most`; -1 after an error, else how many. */
static int read_numbers(reader *r, float *numbers, int most, const char *expected)
{
	for (int count = 0;; count++) {
		skip_blanks(r);
		if (is_line_end(*r->p) || *r->p == '#')
			return count;
		if (count == most) {
			fail_expected(r, expected);
			return -1;
		}
		const char *p = nt_read_decimal(r->p, r->chunk->end, &numbers[count]);
		if (!p || !is_word_end(p)) {
			fail_expected(r, "a number");
			return -1;
		}
		if (!isfinite(numbers[count])) {
			fail_expected(r, "a finite number");
			return -1;
		}
		r->p = p;
	}
}

/* The same, with the quick way for the usual number of them tried first. */
static inline int read_line(reader *r, float *numbers, int usual, int most, const char *expected)
{
	const char *p = read_plain_numbers(r->p, numbers, usual);
	if (!p)
		return read_numbers(r, numbers, most, expected);
	r->p = p;
	return usual;
}

/* Appends a row of a kind: as many of the numbers as are kept. */
static inline nmtan_status store_row(reader *r, int kind, const float *numbers)
{
	obj_rows *rows = &r->chunk->rows[kind];
	const size_t bytes = obj_widths[kind] * sizeof(float);
	if (!reserve(r->chunk, (void **)&rows->data, &rows->capacity, rows->count, bytes))
		return fail_memory(r);
	memcpy(&rows->data[obj_widths[kind] * rows->count++], numbers, bytes);
	return NMTAN_OK;
}

/* Keeps the colour of the last position; positions before the first that has one are white. */
static nmtan_status store_color(reader *r, const float *numbers, int count)
{
	obj_chunk *chunk = r->chunk;
	const size_t last = chunk->rows[OBJ_V].count - 1;
	const size_t first = chunk->colors ? last : 0;
	if (last >= chunk->color_capacity && !nt_grow((void **)&chunk->colors, &chunk->color_capacity,
							 chunk->rows[OBJ_V].capacity, 4 * sizeof(float)))
		return fail_memory(r);
	for (size_t i = 4 * first; i < 4 * last + 4; i++)
		chunk->colors[i] = 1;
	if (count >= 6)
		memcpy(&chunk->colors[4 * last], numbers + 3, (size_t)(count - 3) * sizeof *numbers);
	return NMTAN_OK;
}

/* v x y z [w] or v x y z r g b [a]. The weight w belongs to curves: polygons do not use it. */
static nmtan_status read_position(reader *r)
{
	static const char expected[] = "3 coordinates, with a weight or a colour of 3 or 4 numbers";
	obj_chunk *chunk = r->chunk;
	float numbers[7];
	const int count = read_line(r, numbers, 3, 7, expected);
	if (count < 0)
		return chunk->error.status;
	if (count < 3 || count == 5)
		return fail_expected(r, count < 3 ? "3 coordinates" : expected);
	const nmtan_status status = store_row(r, OBJ_V, numbers);
	return status || (count < 6 && !chunk->colors) ? status : store_color(r, numbers, count);
}

/* vt u [v [w]] */
static nmtan_status read_texcoord(reader *r)
{
	obj_chunk *chunk = r->chunk;
	float numbers[3] = {0, 0, 0};
	const int count = read_line(r, numbers, 2, 3, "at most 3 texture coordinates");
	if (count < 0)
		return chunk->error.status;
	if (count == 0)
		return fail_expected(r, "a texture coordinate");
	return store_row(r, OBJ_VT, numbers);
}

/* vn x y z */
static nmtan_status read_normal(reader *r)
{
	obj_chunk *chunk = r->chunk;
	float numbers[3];
	const int count = read_line(r, numbers, 3, 3, "3 components of a normal and no more");
	if (count < 0)
		return chunk->error.status;
	if (count < 3)
		return fail_expected(r, "3 components of a normal");
	return store_row(r, OBJ_VN, numbers);
}

/* ---- f ---- */

/* An index of nine and more digits, one that counts back, or none. */
static nmtan_status read_unusual_index(reader *r, size_t count, uint32_t *index)
{
	const char *p = r->p;
	const bool back = *p == '-';
	p += back;
	if (!is_digit(*p))
		return fail_expected(r, "the number of a vertex, as in 3, 3/1, 3//2 or 3/1/2");
	uint64_t value = 0;
	for (; is_digit(*p); p++)
		if (value < OBJ_RELATIVE)
			value = value * 10 + (uint64_t)(*p - '0');
	if (value == 0)
		return fail_expected(r, "an index, which begins at 1 or counts back from -1");
	if (value > (back ? OBJ_BIAS : OBJ_RELATIVE - 1))
		return fail_expected(r, "an index that a file can hold");
	*index = back ? OBJ_RELATIVE | (uint32_t)(OBJ_BIAS + count - value) : (uint32_t)value - 1;
	r->p = p;
	return NMTAN_OK;
}

/* `count` elements of that kind precede the face in its chunk. */
static nmtan_status read_index(reader *r, size_t count, uint32_t *index)
{
	uint32_t value;
	const unsigned digits = nt_read_digits(r->p, &value);
	if (digits == 0 || digits == 8 || value == 0)
		return read_unusual_index(r, count, index);
	r->p += digits;
	*index = value - 1;
	return NMTAN_OK;
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
static nmtan_status read_corner(reader *r, obj_corner *corner)
{
	const obj_chunk *chunk = r->chunk;
	nmtan_status status = read_index(r, chunk->rows[OBJ_V].count, &corner->v);
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
		return fail_expected(r, "a blank behind the corner of a face");
	return status;
}

static nmtan_status store_polygon(reader *r, size_t size)
{
	obj_chunk *chunk = r->chunk;
	if (!nt_grow((void **)&chunk->polygons, &chunk->polygon_capacity, chunk->polygon_count + 1,
			sizeof *chunk->polygons))
		return fail_memory(r);
	chunk->polygons[chunk->polygon_count++] = (obj_polygon){chunk->face_count, size, r->statement_line};
	return NMTAN_OK;
}

static void ignore(reader *r, size_t which)
{
	obj_ignored *ignored = &r->chunk->ignored[which];
	if (ignored->count++ == 0)
		ignored->line = r->statement_line;
}

/* The number of a corner among the distinct ones of this object that were seen lately; where it is not
 * there it takes the place of `next`, the next free number. */
static inline uint32_t number_corner(const reader *r, const obj_corner *distinct, size_t next,
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

static nmtan_status store_corner(reader *r, obj_corner corner)
{
	obj_chunk *chunk = r->chunk;
	if (!reserve(chunk, (void **)&chunk->corners, &chunk->corner_capacity, chunk->corner_count,
			sizeof *chunk->corners) ||
		!reserve(chunk, (void **)&chunk->distinct, &chunk->distinct_capacity,
			chunk->distinct_count, sizeof *chunk->distinct))
		return fail_memory(r);
	const uint32_t number = number_corner(r, chunk->distinct, chunk->distinct_count, &corner);
	if (number == chunk->distinct_count)
		chunk->distinct[chunk->distinct_count++] = corner;
	chunk->corners[chunk->corner_count++] = number;
	return NMTAN_OK;
}

/* Takes corners the quick way as long as they are plain and there is room. */
static void read_plain_corners(reader *r)
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
static nmtan_status end_face(reader *r, size_t first_corner, size_t first_distinct)
{
	obj_chunk *chunk = r->chunk;
	const size_t size = chunk->corner_count - first_corner;
	if (size < 3) {
		if (chunk->ignored[OBJ_SMALL_FACE].count == 0)
			chunk->small_size = size;
		chunk->corner_count = first_corner;
		chunk->distinct_count = first_distinct;
		ignore(r, OBJ_SMALL_FACE);
		return NMTAN_OK;
	}
	if (!reserve(chunk, (void **)&chunk->face_sizes, &chunk->face_capacity, chunk->face_count, 1))
		return fail_memory(r);
	if (size >= OBJ_POLYGON) {
		const nmtan_status status = store_polygon(r, size);
		if (status)
			return status;
	}
	if (chunk->face_count == chunk->wanted_face)
		chunk->wanted_line = r->statement_line;
	chunk->face_sizes[chunk->face_count++] = (uint8_t)(size < OBJ_POLYGON ? size : OBJ_POLYGON);
	return NMTAN_OK;
}

static nmtan_status read_face(reader *r)
{
	const obj_chunk *chunk = r->chunk;
	const size_t first_corner = chunk->corner_count, first_distinct = chunk->distinct_count;
	for (;;) {
		read_plain_corners(r);
		skip_blanks(r);
		if (is_line_end(*r->p) || *r->p == '#')
			return end_face(r, first_corner, first_distinct);
		obj_corner corner;
		nmtan_status status = read_corner(r, &corner);
		if (!status)
			status = store_corner(r, corner);
		if (status)
			return status;
	}
}

/* ---- o, usemtl, mtllib, s ---- */

static nmtan_status store_event(reader *r, obj_event event)
{
	obj_chunk *chunk = r->chunk;
	if (!nt_grow((void **)&chunk->events, &chunk->event_capacity, chunk->event_count + 1,
			sizeof *chunk->events))
		return fail_memory(r);
	event.line = r->statement_line;
	event.face = chunk->face_count;
	event.corner = chunk->corner_count;
	if (event.kind == OBJ_EVENT_OBJECT)
		r->object_begin = chunk->distinct_count;
	chunk->events[chunk->event_count++] = event;
	return NMTAN_OK;
}

/* A name is what is left of the line, blanks inside included; `\` and `#` belong to it, because paths
 * and names have them. */
static nmtan_status read_name(reader *r, obj_event_kind kind)
{
	while (is_blank(*r->p))
		r->p++;
	const char *begin = r->p, *p = begin;
	while (!is_line_end(*p)) {
		if (*p == '\0') {
			r->p = p;
			return fail_expected(r, "a name in text");
		}
		p++;
	}
	r->p = p;
	while (p > begin && is_blank(p[-1]))
		p--;
	return store_event(r, (obj_event){.kind = kind, .text = begin, .length = (size_t)(p - begin)});
}

/* s off, s on or s N: a group of faces that are shaded as one; 0 and off mean flat. */
static nmtan_status read_smoothing(reader *r)
{
	skip_blanks(r);
	const char *p = r->p;
	uint32_t group = 0;
	unsigned length = nt_read_digits(p, &group);
	if (strncmp(p, "off", 3) == 0) {
		length = 3;
	} else if (strncmp(p, "on", 2) == 0) {
		length = 2;
		group = 1;
	}
	if (length == 0 || length == 8 || !is_word_end(p + length))
		return fail_expected(r, "a smoothing group, on or off");
	r->p = p + length;
	return store_event(r, (obj_event){.kind = OBJ_EVENT_SMOOTHING, .group = group});
}

/* ---- lines ---- */

/* To the end of the line; `\` joins the next one unless it is a comment. */
static void skip_statement(reader *r, bool comment)
{
	const char *p = r->p;
	while (!is_line_end(*p)) {
		if (!comment && joins_lines(p)) {
			p = behind_line_end(p + 1);
			r->line++;
		} else {
			p++;
		}
	}
	r->p = p;
}

/* A statement that is not used: one that OBJ defines, or any word. Bytes that no text has are an error,
 * so that a file of another kind is not taken for an OBJ without faces. */
static nmtan_status read_other(reader *r, const char *word, size_t length)
{
	for (size_t i = 0; i < length; i++)
		if ((unsigned char)word[i] < 0x20 || (unsigned char)word[i] >= 0x7F) {
			r->p = word;
			return fail_expected(r, "a statement of an OBJ file");
		}
	size_t which = OBJ_SMALL_FACE + 1;
	while (which < OBJ_UNKNOWN && (strlen(obj_ignored_names[which]) != length ||
					      memcmp(obj_ignored_names[which], word, length) != 0))
		which++;
	if (which == OBJ_UNKNOWN && !r->chunk->unknown) {
		r->chunk->unknown = word;
		r->chunk->unknown_length = length;
	}
	ignore(r, which);
	skip_statement(r, false);
	return NMTAN_OK;
}

static bool is_word(const char *word, size_t length, const char *expected)
{
	return strlen(expected) == length && memcmp(word, expected, length) == 0;
}

/* A statement whose first letters are not v or f. */
static nmtan_status read_rare(reader *r)
{
	const char *word = r->p;
	while (!is_word_end(r->p))
		r->p++;
	const size_t length = (size_t)(r->p - word);
	if (is_word(word, length, "v"))
		return read_position(r);
	if (is_word(word, length, "vt"))
		return read_texcoord(r);
	if (is_word(word, length, "vn"))
		return read_normal(r);
	if (is_word(word, length, "f") || is_word(word, length, "fo"))
		return read_face(r);
	if (is_word(word, length, "o"))
		return read_name(r, OBJ_EVENT_OBJECT);
	if (is_word(word, length, "usemtl"))
		return read_name(r, OBJ_EVENT_MATERIAL);
	if (is_word(word, length, "mtllib"))
		return read_name(r, OBJ_EVENT_LIBRARY);
	if (is_word(word, length, "s"))
		return read_smoothing(r);
	if (is_word(word, length, "g")) {
		skip_statement(r, false);
		return NMTAN_OK;
	}
	return read_other(r, word, length);
}

/* One statement, up to its line end or comment. The four that files consist of come first. */
static inline nmtan_status read_statement(reader *r)
{
	const char *p = r->p;
	if (p[0] == 'v' && is_blank(p[1])) {
		r->p = p + 2;
		return read_position(r);
	}
	if (p[0] == 'f' && is_blank(p[1])) {
		r->p = p + 2;
		return read_face(r);
	}
	if (p[0] == 'v' && p[1] == 'n' && is_blank(p[2])) {
		r->p = p + 3;
		return read_normal(r);
	}
	if (p[0] == 'v' && p[1] == 't' && is_blank(p[2])) {
		r->p = p + 3;
		return read_texcoord(r);
	}
	if (is_line_end(*p) || *p == '#')
		return NMTAN_OK;
	return read_rare(r);
}

static nmtan_status read_lines(reader *r)
{
	obj_chunk *chunk = r->chunk;
	while (r->p < chunk->end) {
		skip_blanks(r);
		r->statement_line = r->line;
		const nmtan_status status = read_statement(r);
		if (status)
			return status;
		if (*r->p == '#')
			skip_statement(r, true);
		r->p = behind_line_end(r->p);
		r->line++;
		if (chunk->face_count > chunk->wanted_face)
			break;
	}
	chunk->line_count = r->line;
	return NMTAN_OK;
}

nmtan_status obj_parse_chunk(obj_chunk *chunk)
{
	reader r = {.chunk = chunk, .p = chunk->begin};
	r.recent = nt_calloc(RECENT_COUNT, sizeof *r.recent);
	const nmtan_status status = r.recent ? read_lines(&r) : fail_memory(&r);
	free(r.recent);
	return status;
}

void obj_chunk_free(obj_chunk *chunk)
{
	for (int kind = 0; kind < OBJ_KIND_COUNT; kind++)
		free(chunk->rows[kind].data);
	free(chunk->colors);
	free(chunk->distinct);
	free(chunk->corners);
	free(chunk->face_sizes);
	free(chunk->polygons);
	free(chunk->events);
}

size_t obj_face_line(const obj_file *file, size_t face, obj_corner *before)
{
	size_t c = 0;
	while (c + 1 < file->chunk_count && file->chunks[c + 1].first_face <= face)
		c++;
	const obj_chunk *chunk = &file->chunks[c];
	obj_chunk again = {.begin = chunk->begin, .end = chunk->end};
	again.wanted_face = face - chunk->first_face;
	obj_parse_chunk(&again);
	if (before)
		*before = (obj_corner){(uint32_t)again.rows[OBJ_V].count, (uint32_t)again.rows[OBJ_VT].count,
			(uint32_t)again.rows[OBJ_VN].count};
	const size_t line = chunk->first_line + again.wanted_line + 1;
	obj_chunk_free(&again);
	return line;
}
