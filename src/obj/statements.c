/* SPDX-License-Identifier: MIT */
/*
 * OBJ lines become arrays. A chunk is a run of whole lines, so several can be read at once; what a
 * line means does not depend on the lines before it, but for faces that count back ("-1") and for the
 * statements between faces, which are kept in order for later.
 *
 * Forgiving where exporters differ: blanks and tabs anywhere, CRLF and lone CR, `\` before a line end,
 * comments behind a statement, trailing slashes ("3/"), statements of OBJ that say nothing about
 * polygons; vt and vn that are not finite, which become zeros and a finding. Strict where a guess could be wrong:
 * numbers, their count, positions that are not finite, index 0.
 */
#include "obj/line.h"

#include <math.h>
#include <stdlib.h>
#include "file/decimal.h"
#include "scene/srgb.h"

const char *const obj_ignored_names[OBJ_IGNORED_COUNT] = {
	[OBJ_SMALL_FACE] = "f",
	"l", "p", "vp", "deg", "bmat", "step", "cstype", "curv", "curv2", "surf", "parm", "trim", "hole",
	"scrv", "sp", "end", "con", "mg", "bevel", "c_interp", "d_interp", "lod", "shadow_obj",
	"trace_obj", "ctech", "stech", "usemap", "maplib", "call", "csh", "bsp", "bzp", "cdc", "cdp",
	[OBJ_NUL_LINE] = "line of NUL bytes",
	[OBJ_UNKNOWN] = "unknown statement",
};

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

/* Reads numbers up to the end of the line, at most `most`, of which `finite` must be so; -1 after an error, else how
 * many. */
static int read_numbers(obj_reader *r, float *numbers, int most, int finite, const char *expected)
{
	for (int count = 0;; count++) {
		skip_blanks(r);
		if (is_line_end(*r->p) || *r->p == '#')
			return count;
		if (count == most) {
			obj_fail_expected(r, expected);
			return -1;
		}
		const char *p = nt_read_decimal(r->p, r->chunk->end, &numbers[count]);
		if (!p || !is_word_end(p)) {
			obj_fail_expected(r, "a number");
			return -1;
		}
		if (count < finite && !isfinite(numbers[count])) {
			obj_fail_expected(r, "a finite number");
			return -1;
		}
		r->p = p;
	}
}

/* A vt or vn that is not finite becomes zeros: one of them is no reason to refuse the file. */
static void mend_row(obj_reader *r, int kind, float *numbers)
{
	obj_ignored *bad = &r->chunk->bad_rows[kind];
	bool sound = true;
	for (size_t k = 0; k < obj_widths[kind]; k++)
		sound &= isfinite(numbers[k]) != 0;
	if (sound)
		return;
	memset(numbers, 0, obj_widths[kind] * sizeof *numbers);
	if (!bad->count++)
		bad->line = r->statement_line;
}

/* The same, with the quick way for the usual number of them tried first, in which all are finite. */
static inline int read_line(obj_reader *r, int kind, float *numbers, int usual, int most, const char *expected)
{
	const char *p = read_plain_numbers(r->p, numbers, usual);
	if (!p) {
		const int count = read_numbers(r, numbers, most, kind == OBJ_V ? 3 : 0, expected);
		if (kind != OBJ_V && count >= usual)
			mend_row(r, kind, numbers);
		return count;
	}
	r->p = p;
	return usual;
}

/* Appends a row of a kind: as many of the numbers as are kept. */
static inline nt_status store_row(obj_reader *r, int kind, const float *numbers)
{
	obj_rows *rows = &r->chunk->rows[kind];
	const size_t bytes = obj_widths[kind] * sizeof(float);
	if (!obj_reserve(r->chunk, (void **)&rows->data, &rows->capacity, rows->count, bytes))
		return obj_fail_memory(r);
	memcpy(&rows->data[obj_widths[kind] * rows->count++], numbers, bytes);
	return NT_OK;
}

/* Keeps the colour of the last position; positions before the first that has one are white. */
static nt_status store_color(obj_reader *r, const float *numbers, int count)
{
	obj_chunk *chunk = r->chunk;
	const size_t last = chunk->rows[OBJ_V].count - 1;
	const size_t first = chunk->colors ? last : 0;
	chunk->rare = true;
	if (last >= chunk->color_capacity && !nt_grow((void **)&chunk->colors, &chunk->color_capacity,
							 chunk->rows[OBJ_V].capacity, 4 * sizeof(float)))
		return obj_fail_memory(r);
	for (size_t i = 4 * first; i < 4 * last + 4; i++)
		chunk->colors[i] = 1;
	if (count >= 6)
		memcpy(&chunk->colors[4 * last], numbers + 3, (size_t)(count - 3) * sizeof *numbers);
	if (nt_color_mend(&chunk->colors[4 * last]) && !chunk->bad_colors.count++)
		chunk->bad_colors.line = r->statement_line;
	return NT_OK;
}

/* Keeps what few files have or need behind a row: doubles and the colour. `begin`: where its numbers begin. */
static nt_status store_rare(obj_reader *r, const char *begin, const float *numbers, int count)
{
	obj_chunk *chunk = r->chunk;
	obj_reader again = *r;
	again.p = begin;
	const size_t row = chunk->rows[OBJ_V].count - 1;
	for (size_t k = 0; again.p && row < chunk->exact_count && k < 3; k++) {
		skip_blanks(&again);
		again.p = nt_read_double(again.p, chunk->end, &chunk->exact[3 * row + k]);
	}
	return count >= 6 || chunk->colors ? store_color(r, numbers, count) : NT_OK;
}

/* v x y z [w] or v x y z r g b [a]. The weight w belongs to curves: polygons do not use it. */
static nt_status read_position(obj_reader *r)
{
	static const char expected[] = "3 coordinates, with a weight or a colour of 3 or 4 numbers";
	obj_chunk *chunk = r->chunk;
	const char *begin = r->p;
	float numbers[7];
	int count = read_line(r, OBJ_V, numbers, 3, 7, expected);
	if (count == 4 && !isfinite(numbers[3])) { /* it fails as others do */
		r->p = begin;
		count = read_numbers(r, numbers, 4, 4, expected);
	}
	if (count < 0)
		return chunk->error.status;
	if (count < 3 || count == 5)
		return obj_fail_expected(r, count < 3 ? "3 coordinates" : expected);
	const nt_status status = store_row(r, OBJ_V, numbers);
	return status || (count < 6 && !chunk->rare) ? status : store_rare(r, begin, numbers, count);
}

/* vt u [v [w]] */
static nt_status read_texcoord(obj_reader *r)
{
	obj_chunk *chunk = r->chunk;
	float numbers[3] = {0, 0, 0};
	const int count = read_line(r, OBJ_VT, numbers, 2, 3, "at most 3 texture coordinates");
	if (count < 0)
		return chunk->error.status;
	if (count == 0)
		return obj_fail_expected(r, "a texture coordinate");
	return store_row(r, OBJ_VT, numbers);
}

/* vn x y z */
static nt_status read_normal(obj_reader *r)
{
	obj_chunk *chunk = r->chunk;
	float numbers[3];
	const int count = read_line(r, OBJ_VN, numbers, 3, 3, "3 components of a normal and no more");
	if (count < 0)
		return chunk->error.status;
	if (count < 3)
		return obj_fail_expected(r, "3 components of a normal");
	return store_row(r, OBJ_VN, numbers);
}

/* ---- o, g, usemtl, mtllib, s ---- */

static nt_status store_event(obj_reader *r, obj_event event)
{
	obj_chunk *chunk = r->chunk;
	if (!nt_grow((void **)&chunk->events, &chunk->event_capacity, chunk->event_count + 1,
			sizeof *chunk->events))
		return obj_fail_memory(r);
	event.line = r->statement_line;
	event.face = chunk->face_count;
	event.corner = chunk->corner_count;
	if (event.kind == OBJ_EVENT_OBJECT || event.kind == OBJ_EVENT_MATERIAL)
		r->object_begin = chunk->distinct_count;
	chunk->events[chunk->event_count++] = event;
	return NT_OK;
}

/* A name is what is left of the line, blanks inside included; `\` and `#` belong to it, because paths
 * and names have them. */
static nt_status read_name(obj_reader *r, obj_event_kind kind)
{
	while (is_blank(*r->p))
		r->p++;
	const char *begin = r->p, *p = begin;
	while (!is_line_end(*p)) {
		if (*p == '\0') {
			r->p = p;
			return obj_fail_expected(r, "a name in text");
		}
		p++;
	}
	r->p = p;
	while (p > begin && is_blank(p[-1]))
		p--;
	return store_event(r, (obj_event){.kind = kind, .text = begin, .length = (size_t)(p - begin)});
}

/* s off, s on or s N: a group of faces that are shaded as one; 0 and off mean flat. N has up to 32 bits, one of which
 * 3ds Max sets for each of its groups. ZBrush writes s alone, which is on; others write null for off. */
static nt_status read_smoothing(obj_reader *r)
{
	skip_blanks(r);
	const char *p = r->p;
	const bool alone = is_line_end(*p) || *p == '#';
	uint64_t group = alone;
	for (; is_digit(*p) && group <= UINT32_MAX; p++)
		group = group * 10 + (uint64_t)(*p - '0');
	if (p == r->p && strncmp(p, "on", 2) == 0) {
		p += 2;
		group = 1;
	} else if (p == r->p) {
		p += strncmp(p, "off", 3) == 0 ? 3 : strncmp(p, "null", 4) == 0 ? 4 : 0;
	}
	if (!alone && (p == r->p || !is_word_end(p) || group > UINT32_MAX))
		return obj_fail_expected(r, "a smoothing group, on or off");
	r->p = p;
	return store_event(r, (obj_event){.kind = OBJ_EVENT_SMOOTHING, .group = (uint32_t)group});
}

/* ---- lines ---- */

/* To the end of the line; `\` joins the next one unless it is a comment. */
static void skip_statement(obj_reader *r, bool comment)
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
static nt_status read_other(obj_reader *r, const char *word, size_t length)
{
	/* ZBrush ends files with a line of NUL alone. Many are what a write that failed leaves of a file. */
	enum { MOST_NULS = 64 };
	if (*word == '\0') {
		const char *p = word;
		while ((*p == '\0' || is_blank(*p)) && p - word < MOST_NULS)
			p++;
		if (is_line_end(*p)) {
			r->p = p;
			obj_ignore(r, OBJ_NUL_LINE);
			return NT_OK;
		}
	}
	for (size_t i = 0; i < length; i++)
		if ((unsigned char)word[i] < 0x20 || (unsigned char)word[i] >= 0x7F) {
			r->p = word;
			return obj_fail_expected(r, "a statement of an OBJ file");
		}
	size_t which = OBJ_SMALL_FACE + 1;
	while (which < OBJ_NUL_LINE && (strlen(obj_ignored_names[which]) != length ||
					      memcmp(obj_ignored_names[which], word, length) != 0))
		which++;
	which = which == OBJ_NUL_LINE ? OBJ_UNKNOWN : which;
	if (which == OBJ_UNKNOWN && !r->chunk->unknown) {
		r->chunk->unknown = word;
		r->chunk->unknown_length = length;
	}
	obj_ignore(r, which);
	skip_statement(r, false);
	return NT_OK;
}

static bool is_word(const char *word, size_t length, const char *expected)
{
	return strlen(expected) == length && memcmp(word, expected, length) == 0;
}

/* A statement whose first letters are not v or f. */
static nt_status read_rare(obj_reader *r)
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
		return obj_read_face(r);
	if (is_word(word, length, "o"))
		return read_name(r, OBJ_EVENT_OBJECT);
	if (is_word(word, length, "usemtl"))
		return read_name(r, OBJ_EVENT_MATERIAL);
	if (is_word(word, length, "mtllib"))
		return read_name(r, OBJ_EVENT_LIBRARY);
	if (is_word(word, length, "s"))
		return read_smoothing(r);
	if (is_word(word, length, "g"))
		return read_name(r, OBJ_EVENT_GROUP);
	return read_other(r, word, length);
}

/* One statement, up to its line end or comment. The four that files consist of come first. */
static inline nt_status read_statement(obj_reader *r)
{
	const char *p = r->p;
	if (p[0] == 'v' && is_blank(p[1])) {
		r->p = p + 2;
		return read_position(r);
	}
	if (p[0] == 'f' && is_blank(p[1])) {
		r->p = p + 2;
		return obj_read_face(r);
	}
	if (p[0] == 'v' && p[1] == 'n' && is_blank(p[2])) {
		r->p = p + 3;
		return read_normal(r);
	}
	if (p[0] == 'v' && p[1] == 't' && is_blank(p[2])) {
		r->p = p + 3;
		return read_texcoord(r);
	}
	if (*p == '#' && strncmp(p, "#MRGB", 5) == 0 && is_blank(p[5]))
		return obj_read_mrgb(r);
	if (is_line_end(*p) || *p == '#')
		return NT_OK;
	return read_rare(r);
}

nt_status obj_read_lines(obj_reader *r, size_t last)
{
	obj_chunk *chunk = r->chunk;
	while (r->p < chunk->end) {
		skip_blanks(r);
		r->statement = r->p;
		r->statement_line = r->line;
		const nt_status status = read_statement(r);
		if (status)
			return status;
		if (*r->p == '#')
			skip_statement(r, true);
		r->p = behind_line_end(r->p);
		r->line++;
		if (chunk->face_count > last)
			break;
	}
	chunk->line_count = r->line;
	return NT_OK;
}
