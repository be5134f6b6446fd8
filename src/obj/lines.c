/* SPDX-License-Identifier: MIT */
/*
 * OBJ lines become arrays. A chunk is a run of whole lines, so several can be read at once; what a
 * line means does not depend on the lines before it, but for faces that count back ("-1") and for the
 * statements between faces, which are kept in order for later.
 *
 * Every chunk ends behind a line feed and has 8 readable bytes behind it (the last lines of the file are
 * copied to make it so). Numbers and blanks therefore stop by themselves, and nothing here asks
 * for the end of the input within a line.
 *
 * Forgiving where exporters differ: blanks and tabs anywhere, CRLF and lone CR, `\` before a line end,
 * comments behind a statement, trailing slashes ("3/"), statements of OBJ that say nothing about
 * polygons; vt and vn that are not finite, which become zeros and a finding. Strict where a guess could be wrong:
 * numbers, their count, positions that are not finite, index 0.
 */
#include "obj/parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/compiler.h"
#include "base/text.h"
#include "file/decimal.h"
#include "scene/values.h"

/* A chunk's arrays begin with room for one element per this many bytes of text, which is about what
 * dense files hold; memory that is not used is never touched. */
enum { BYTES_PER_ELEMENT = 24 };

/* Neighbouring faces share corners: a table of this size finds nearly all of them again within a chunk and
 * stays in the cache. */
enum { RECENT_COUNT = 1 << 13 };

#define UNUSED(word) {word, OBJ_UNUSED, false, NULL}
#define UNUSED_PROOF(word) {word, OBJ_UNUSED, true, NULL}

const obj_keyword obj_keywords[OBJ_WORD_COUNT] = {
	{"v", OBJ_POSITION, true, NULL}, {"vt", OBJ_TEXCOORD, true, NULL}, {"vn", OBJ_NORMAL, true, NULL},
	{"o", OBJ_OBJECT, true, NULL}, {"usemtl", OBJ_MATERIAL, true, NULL}, {"mtllib", OBJ_LIBRARY, true, NULL},
	{"g", OBJ_GROUP, true, NULL}, {"s", OBJ_SMOOTHING, true, NULL}, {"fo", OBJ_FACE, false, NULL},
	[OBJ_SMALL_FACE] = {"f", OBJ_FACE, true, "faces of fewer than three corners"},
	{"l", OBJ_UNUSED, true, "lines"}, {"p", OBJ_UNUSED, true, "points"}, UNUSED_PROOF("vp"), UNUSED_PROOF("deg"),
	UNUSED("bmat"), UNUSED("step"), UNUSED_PROOF("cstype"), {"curv", OBJ_UNUSED, false, "curves"}, UNUSED("curv2"),
	{"surf", OBJ_UNUSED, false, "surfaces"}, UNUSED("parm"), UNUSED("trim"), UNUSED("hole"), UNUSED("scrv"),
	UNUSED("sp"), UNUSED("end"), UNUSED("con"), UNUSED_PROOF("mg"), UNUSED("bevel"), UNUSED("c_interp"),
	UNUSED("d_interp"), UNUSED_PROOF("lod"), UNUSED("shadow_obj"), UNUSED("trace_obj"), UNUSED("ctech"),
	UNUSED("stech"), UNUSED("usemap"), UNUSED("maplib"), UNUSED("call"), UNUSED("csh"), UNUSED("bsp"),
	UNUSED("bzp"), UNUSED("cdc"), UNUSED("cdp"),
	[OBJ_NUL_LINE] = UNUSED("line of NUL bytes"),
	[OBJ_UNKNOWN] = UNUSED("unknown statement"),
};

const obj_keyword *obj_find_keyword(const char *word, size_t length)
{
	for (const obj_keyword *k = obj_keywords; k < obj_keywords + OBJ_NUL_LINE; k++)
		if (strlen(k->word) == length && memcmp(k->word, word, length) == 0)
			return k;
	return NULL;
}

/* ---- the cursor ---- */

/* Behind blanks and joined lines. */
static const char *skip_blanks(obj_chunk *c, const char *p)
{
	while (is_blank(*p) || joins_lines(p)) {
		if (!is_blank(*p)) {
			p = behind_line_end(p + 1) - 1;
			c->line++;
		}
		p++;
	}
	return p;
}

/* Whether the statement ends at p. */
static bool is_end(const char *p)
{
	return is_line_end(*p) || *p == '#';
}

/* Fails with "found WORD, expected EXPECTED" at the current line: the word is cut at 32 characters, bytes that are no
 * ASCII are \xHH. */
static nt_status fail_expected(obj_chunk *c, const char *p, const char *expected)
{
	char found[160] = "the end of the line";
	if (!is_end(p)) {
		size_t used = (size_t)snprintf(found, sizeof found, "\"");
		for (int i = 0; i < 32 && !is_word_end(p); i++, p++) {
			const unsigned char byte = (unsigned char)*p;
			used += (size_t)snprintf(found + used, sizeof found - used,
				byte >= 0x20 && byte < 0x7F ? "%c" : "\\x%02x", byte);
		}
		snprintf(found + used, sizeof found - used, is_word_end(p) ? "\"" : "...\"");
	}
	return nt_fail_line(&c->error, NT_ERROR_INPUT, c->line + 1, "found %s, expected %s", found, expected);
}

static nt_status fail_memory(obj_chunk *c)
{
	return nt_fail_memory(&c->error);
}

/* A chunk never has 2^30 elements, which OBJ_BIAS relies on. */
static bool grow(const obj_chunk *c, void **block, size_t *capacity, size_t count, size_t row_size)
{
	const size_t guess = (size_t)(c->end - c->begin) / BYTES_PER_ELEMENT + 1;
	return count + 1 < OBJ_BIAS && nt_grow(block, capacity, *capacity ? count + 1 : guess, row_size);
}

/* Room for one more row. */
static inline bool reserve(const obj_chunk *c, void **block, size_t *capacity, size_t count, size_t row_size)
{
	return count < *capacity || grow(c, block, capacity, count, row_size);
}

/* Counts statements of a kind, with the line of the first. */
static void count_at(const obj_chunk *c, obj_count *count)
{
	if (count->count++ == 0)
		count->line = c->statement_line;
}

/* ---- v, vt, vn ---- */

/* The kinds of rows: how many numbers there may be, and what is said where there are fewer or more. */
static const struct {
	int least, most;
	const char *few, *many;
} rows_of[OBJ_KIND_COUNT] = {
	{3, 7, "3 coordinates", "3 coordinates, with a weight or a colour of 3 or 4 numbers"},
	{1, 3, "a texture coordinate", "at most 3 texture coordinates"},
	{3, 3, "3 components of a normal", "3 components of a normal and no more"},
};

/* Behind the number at p, which ends a word; NULL: it is none, or not finite although it has to be. */
static const char *read_any_number(obj_chunk *c, const char *p, bool finite, float *number)
{
	const char *end = nt_read_decimal(p, c->end, number);
	if (end && is_word_end(end) && (!finite || isfinite(*number)))
		return end;
	fail_expected(c, p, end && is_word_end(end) ? "a finite number" : "a number");
	return NULL;
}

/* Behind the numbers up to the end of the line, of which coordinates have to be finite; NULL after an error. *finite:
 * whether all are. */
static inline NT_ALWAYS_INLINE const char *read_numbers(obj_chunk *c, const char *p, int kind, float *numbers,
	int *count, bool *finite)
{
	*finite = true;
	for (*count = 0;; ++*count) {
		while (*p == ' ')
			p++;
		if ((unsigned char)*p <= '#' || *p == '\\') {
			p = is_line_end(*p) ? p : skip_blanks(c, p);
			if (is_end(p))
				return p;
		}
		if (*count == rows_of[kind].most) {
			fail_expected(c, p, rows_of[kind].many);
			return NULL;
		}
		const char *end = nt_read_plain_decimal(p, &numbers[*count]);
		if (!end || !(is_blank(*end) || is_line_end(*end))) {
			end = read_any_number(c, p, kind == OBJ_V && *count < 3, &numbers[*count]);
			if (!end)
				return NULL;
			*finite = *finite && isfinite(numbers[*count]);
		}
		p = end;
	}
}

/* Keeps the colour of the last position; positions before the first that has one are white. */
static nt_status store_color(obj_chunk *c, const float *numbers, int count)
{
	const size_t last = c->rows[OBJ_V].count - 1;
	const size_t first = c->colors ? last : 0;
	c->rare = true;
	if (last >= c->color_capacity &&
		!nt_grow((void **)&c->colors, &c->color_capacity, c->rows[OBJ_V].capacity, 4 * sizeof(float)))
		return fail_memory(c);
	for (size_t i = 4 * first; i < 4 * last + 4; i++)
		c->colors[i] = 1;
	if (count >= 6)
		memcpy(&c->colors[4 * last], numbers + 3, (size_t)(count - 3) * sizeof *numbers);
	if (nt_color_mend(&c->colors[4 * last]))
		count_at(c, &c->bad_colors);
	return NT_OK;
}

/* Keeps what few files have or need behind a row: doubles and the colour. `p`: where its numbers begin. */
static nt_status store_rare(obj_chunk *c, const char *p, const float *numbers, int count)
{
	const size_t row = c->rows[OBJ_V].count - 1, line = c->line;
	for (size_t k = 0; p && row < c->exact_count && k < 3; k++)
		p = nt_read_double(skip_blanks(c, p), c->end, &c->exact[3 * row + k]);
	c->line = line;
	return count >= 6 || c->colors ? store_color(c, numbers, count) : NT_OK;
}

/* v x y z [w], v x y z r g b [a], vt u [v [w]], vn x y z: a row of the numbers that are kept. The weight w of a
 * position belongs to curves: polygons do not use it. */
static inline NT_ALWAYS_INLINE nt_status read_row(obj_chunk *c, const char *p, int kind)
{
	obj_rows *rows = &c->rows[kind];
	const size_t width = obj_widths[kind];
	const char *begin = p;
	float numbers[7];
	int count;
	bool finite;
	numbers[1] = 0; /* of a texture coordinate of one number */
	p = read_numbers(c, p, kind, numbers, &count, &finite);
	if (!p)
		return c->error.status;
	if (kind == OBJ_V && count == 4 && !finite) { /* it fails as coordinates do */
		c->line = c->statement_line;
		for (int k = 0; k < 3; k++)
			begin = nt_read_decimal(skip_blanks(c, begin), c->end, &numbers[k]);
		return fail_expected(c, skip_blanks(c, begin), "a finite number");
	}
	if (count < rows_of[kind].least || (kind == OBJ_V && count == 5))
		return fail_expected(c, p, count == 5 ? rows_of[kind].many : rows_of[kind].few);
	/* a vt or vn that is not finite becomes zeros: one of them is no reason to refuse the file */
	if (kind != OBJ_V && !finite &&
		!(isfinite(numbers[0]) && isfinite(numbers[1]) && isfinite(numbers[width - 1]))) {
		memset(numbers, 0, sizeof numbers);
		count_at(c, &c->bad_rows[kind]);
	}
	if (!reserve(c, (void **)&rows->data, &rows->capacity, rows->count, width * sizeof(float)))
		return fail_memory(c);
	memcpy(&rows->data[width * rows->count++], numbers, width * sizeof(float));
	c->p = p;
	return kind == OBJ_V && (count >= 6 || c->rare) ? store_rare(c, begin, numbers, count) : NT_OK;
}

static nt_status read_position(obj_chunk *c, const char *p)
{
	return read_row(c, p, OBJ_V);
}

static nt_status read_texcoord(obj_chunk *c, const char *p)
{
	return read_row(c, p, OBJ_VT);
}

static nt_status read_normal(obj_chunk *c, const char *p)
{
	return read_row(c, p, OBJ_VN);
}

/* ---- f ---- */

/* An index of eight and more digits, one that counts back, or none where it may be missing. */
static const char *read_rare_index(obj_chunk *c, const char *p, int kind, uint32_t *index)
{
	const char *digits = p + (*p == '-');
	if ((kind != OBJ_V && is_word_end(p)) || (kind == OBJ_VT && *p == '/')) {
		*index = OBJ_ABSENT;
		return p;
	}
	if (!is_digit(*digits)) {
		fail_expected(c, p, "the number of a vertex, as in 3, 3/1, 3//2 or 3/1/2");
		return NULL;
	}
	uint64_t value = 0;
	const char *end = digits;
	for (; is_digit(*end); end++)
		if (value < OBJ_RELATIVE)
			value = value * 10 + (uint64_t)(*end - '0');
	const bool back = digits > p;
	if (value == 0 || value > (back ? OBJ_BIAS : OBJ_RELATIVE - 1)) {
		fail_expected(c, p, value == 0 ? "an index, which begins at 1 or counts back from -1"
					       : "an index that a file can hold");
		return NULL;
	}
	*index = back ? OBJ_RELATIVE | (uint32_t)(OBJ_BIAS + c->rows[kind].count - value) : (uint32_t)value - 1;
	return end;
}

static inline const char *read_index(obj_chunk *c, const char *p, int kind, uint32_t *index)
{
	unsigned digits;
	*index = nt_read_short_digits(p, &digits) - 1;
	const char *end = p + digits;
	return *index == OBJ_ABSENT || (unsigned char)*end > '/' ? read_rare_index(c, p, kind, index) : end;
}

/* Behind v, v/t, v//n or v/t/n; NULL after an error. */
static inline const char *read_corner(obj_chunk *c, const char *p, obj_corner *corner)
{
	corner->t = corner->n = OBJ_ABSENT;
	p = read_index(c, p, OBJ_V, &corner->v);
	if (p && *p == '/') {
		p = read_index(c, p + 1, OBJ_VT, &corner->t);
		if (p && *p == '/')
			p = read_index(c, p + 1, OBJ_VN, &corner->n);
	}
	if (!p || *p == ' ' || is_word_end(p) || *p == '#')
		return p;
	fail_expected(c, p, "a blank behind the corner of a face");
	return NULL;
}

/* The number of a corner among the distinct ones of this object that were seen lately; one that is not there takes the
 * next free number. */
static inline uint32_t number_corner(obj_chunk *c, const obj_corner *corner)
{
	uint32_t *recent = &c->recent[corner->v % RECENT_COUNT];
	const size_t number = (size_t)*recent - 1, next = c->distinct_count;
	if (number - c->object_begin < next - c->object_begin) {
		const obj_corner *seen = &c->distinct[number];
		if (((seen->v ^ corner->v) | (seen->t ^ corner->t) | (seen->n ^ corner->n)) == 0)
			return (uint32_t)number;
	}
	*recent = (uint32_t)next + 1;
	c->distinct[c->distinct_count++] = *corner;
	return (uint32_t)next;
}

/* A face that has its corners; one of fewer than three is taken back. */
static nt_status end_face(obj_chunk *c, size_t first_corner, size_t first_distinct)
{
	const size_t size = c->corner_count - first_corner;
	if (size < 3) {
		if (c->ignored[OBJ_SMALL_FACE].count == 0)
			c->small_size = size;
		c->corner_count = first_corner;
		c->distinct_count = first_distinct;
		count_at(c, &c->ignored[OBJ_SMALL_FACE]);
		return NT_OK;
	}
	if (!reserve(c, (void **)&c->face_sizes, &c->face_capacity, c->face_count, 1))
		return fail_memory(c);
	if (size >= OBJ_POLYGON) {
		if (!nt_grow((void **)&c->polygons, &c->polygon_capacity, c->polygon_count + 1, sizeof *c->polygons))
			return fail_memory(c);
		c->polygons[c->polygon_count++] = (obj_polygon){c->face_count, size, c->statement_line};
	}
	c->face_sizes[c->face_count++] = (uint8_t)(size < OBJ_POLYGON ? size : OBJ_POLYGON);
	return NT_OK;
}

/* A corner is kept as the number of its v/t/n among the distinct ones of the chunk. A small table of recent ones
 * recognises nearly all that neighbouring faces share, in the cache; vertices.c does the rest for the file. */
static nt_status read_face(obj_chunk *c, const char *p)
{
	const size_t first_corner = c->corner_count, first_distinct = c->distinct_count;
	for (;;) {
		while (*p == ' ')
			p++;
		if (!is_digit(*p)) {
			p = is_line_end(*p) ? p : skip_blanks(c, p);
			if (is_end(p))
				break;
		}
		obj_corner corner;
		p = read_corner(c, p, &corner);
		if (!p)
			return c->error.status;
		if (!reserve(c, (void **)&c->corners, &c->corner_capacity, c->corner_count, sizeof *c->corners) ||
			!reserve(c, (void **)&c->distinct, &c->distinct_capacity, c->distinct_count,
				sizeof *c->distinct))
			return fail_memory(c);
		c->corners[c->corner_count++] = number_corner(c, &corner);
	}
	c->p = p;
	return end_face(c, first_corner, first_distinct);
}

/* ---- #MRGB ---- */

/* A comment by which ZBrush gives vertices colours: colors.c. */
static nt_status read_mrgb(obj_chunk *c, const char *p)
{
	enum { DIGITS = 8 };
	const size_t first = c->mrgb_count;
	bool sound = true;
	while (is_blank(*p))
		p++;
	const char *end = p;
	while (!is_line_end(*end))
		end++;
	while (end > p && is_blank(end[-1]))
		end--;
	for (; p < end; p += DIGITS) {
		char digits[DIGITS + 1] = "";
		memcpy(digits, p, end - p < DIGITS ? (size_t)(end - p) : DIGITS);
		const bool whole = strspn(digits, "0123456789ABCDEFabcdef") == DIGITS;
		const uint32_t color = whole ? (uint32_t)strtoul(digits, NULL, 16) & OBJ_WHITE : OBJ_WHITE;
		sound &= whole;
		if (!reserve(c, (void **)&c->mrgb, &c->mrgb_capacity, c->mrgb_count, sizeof color))
			return fail_memory(c);
		c->mrgb[c->mrgb_count++] = color;
	}
	if (!nt_grow((void **)&c->mrgb_lines, &c->mrgb_line_capacity, c->mrgb_line_count + 1, sizeof *c->mrgb_lines))
		return fail_memory(c);
	c->mrgb_lines[c->mrgb_line_count++] =
		(obj_mrgb_line){c->statement_line, c->rows[OBJ_V].count, c->mrgb_count - first, sound};
	return NT_OK;
}

/* ---- o, g, usemtl, mtllib, s ---- */

static nt_status store_event(obj_chunk *c, obj_event event)
{
	if (!nt_grow((void **)&c->events, &c->event_capacity, c->event_count + 1, sizeof *c->events))
		return fail_memory(c);
	event.line = c->statement_line;
	event.face = c->face_count;
	event.corner = c->corner_count;
	if (event.kind == OBJ_OBJECT || event.kind == OBJ_MATERIAL)
		c->object_begin = c->distinct_count;
	c->events[c->event_count++] = event;
	return NT_OK;
}

/* A name is what is left of the line, blanks inside included; `\` and `#` belong to it, because paths
 * and names have them. */
static nt_status read_name(obj_chunk *c, const char *begin, obj_statement kind)
{
	while (is_blank(*begin))
		begin++;
	const char *end = begin;
	while (!is_line_end(*end) && *end != '\0')
		end++;
	if (*end == '\0')
		return fail_expected(c, end, "a name in text");
	c->p = end;
	while (end > begin && is_blank(end[-1]))
		end--;
	return store_event(c, (obj_event){.kind = kind, .text = begin, .length = (size_t)(end - begin)});
}

/* s off, s on or s N: a group of faces that are shaded as one; 0 and off mean flat. N has up to 32 bits, one of which
 * 3ds Max sets for each of its groups. ZBrush writes s alone, which is on; others write null for off. */
static nt_status read_smoothing(obj_chunk *c, const char *p)
{
	static const struct {
		const char *word;
		uint64_t group;
	} words[] = {{"on", 1}, {"off", 0}, {"null", 0}};
	const char *const begin = p = skip_blanks(c, p);
	uint64_t group = is_end(p);
	for (; is_digit(*p) && group <= UINT32_MAX; p++)
		group = group * 10 + (uint64_t)(*p - '0');
	for (int i = 0; i < 3 && p == begin; i++)
		if (strncmp(begin, words[i].word, strlen(words[i].word)) == 0) {
			p += strlen(words[i].word);
			group = words[i].group;
		}
	if (!is_end(begin) && (p == begin || !is_word_end(p) || group > UINT32_MAX))
		return fail_expected(c, begin, "a smoothing group, on or off");
	c->p = p;
	return store_event(c, (obj_event){.kind = OBJ_SMOOTHING, .group = (uint32_t)group});
}

/* ---- lines ---- */

/* To the end of the line; `\` joins the next one unless it is a comment. */
static void skip_statement(obj_chunk *c, bool comment)
{
	while (!is_line_end(*c->p))
		if (!comment && joins_lines(c->p)) {
			c->p = behind_line_end(c->p + 1);
			c->line++;
		} else {
			c->p++;
		}
}

/* ZBrush ends files with a line of NUL alone. Many are what a write that failed leaves of a file. */
static bool is_nul_line(const char *p)
{
	enum { MOST_NULS = 64 };
	const char *const begin = p;
	while (*begin == '\0' && (*p == '\0' || is_blank(*p)) && p - begin < MOST_NULS)
		p++;
	return *begin == '\0' && is_line_end(*p);
}

/* Any statement: one that OBJ defines, or any word. Bytes that no text has are an error, so that a file of another kind
 * is not taken for an OBJ without faces. */
static nt_status read_rare(obj_chunk *c)
{
	const char *word = c->p, *p = word;
	while (!is_word_end(p))
		p++;
	const size_t length = (size_t)(p - word);
	const obj_keyword *keyword = obj_find_keyword(word, length);
	switch (keyword ? keyword->statement : OBJ_UNUSED) {
	case OBJ_POSITION:
		return read_position(c, p);
	case OBJ_TEXCOORD:
		return read_texcoord(c, p);
	case OBJ_NORMAL:
		return read_normal(c, p);
	case OBJ_FACE:
		return read_face(c, p);
	case OBJ_SMOOTHING:
		return read_smoothing(c, p);
	case OBJ_OBJECT:
	case OBJ_MATERIAL:
	case OBJ_GROUP:
	case OBJ_LIBRARY:
		return read_name(c, p, keyword->statement);
	case OBJ_UNUSED:
		break;
	}
	const bool nul = is_nul_line(word);
	for (size_t i = 0; i < length && !nul; i++)
		if ((unsigned char)word[i] < 0x20 || (unsigned char)word[i] >= 0x7F)
			return fail_expected(c, word, "a statement of an OBJ file");
	const size_t which = keyword ? (size_t)(keyword - obj_keywords) : nul ? OBJ_NUL_LINE : OBJ_UNKNOWN;
	if (which == OBJ_UNKNOWN && !c->unknown) {
		c->unknown = word;
		c->unknown_length = length;
	}
	count_at(c, &c->ignored[which]);
	skip_statement(c, false);
	return NT_OK;
}

/* One statement, up to its line end or comment. The four that files consist of come first. */
static inline nt_status read_statement(obj_chunk *c)
{
	const char *p = c->p;
	if (p[0] == 'v' && is_blank(p[1]))
		return read_position(c, p + 2);
	if (p[0] == 'f' && is_blank(p[1]))
		return read_face(c, p + 2);
	if (p[0] == 'v' && p[1] == 'n' && is_blank(p[2]))
		return read_normal(c, p + 3);
	if (p[0] == 'v' && p[1] == 't' && is_blank(p[2]))
		return read_texcoord(c, p + 3);
	if (strncmp(p, "#MRGB", 5) == 0 && is_blank(p[5]))
		return read_mrgb(c, p + 5);
	return is_end(p) ? NT_OK : read_rare(c);
}

nt_status obj_read_lines(obj_chunk *c, size_t last)
{
	if (!c->recent && !(c->recent = nt_calloc(RECENT_COUNT, sizeof *c->recent)))
		return fail_memory(c);
	while (c->p < c->end && c->face_count <= last) {
		if (is_blank(*c->p) || *c->p == '\\')
			c->p = skip_blanks(c, c->p);
		c->statement = c->p;
		c->statement_line = c->line;
		const nt_status status = read_statement(c);
		if (status)
			return status;
		if (*c->p == '#')
			skip_statement(c, true);
		c->p = behind_line_end(c->p);
		c->line++;
	}
	return NT_OK;
}

/* ---- names ---- */

static bool is_utf8(const char *text, size_t length)
{
	for (size_t i = 0; i < length;) {
		const size_t step = nt_utf8_length(text + i, length - i);
		if (step == 0)
			return false;
		i += step;
	}
	return true;
}

char *obj_utf8_text(nt_arena *arena, const char *text, size_t length)
{
	if (is_utf8(text, length))
		return nt_arena_text(arena, text, length);
	char *copy = nt_arena_alloc(arena, 2 * length + 1, 1);
	if (!copy)
		return NULL;
	char *to = copy;
	for (size_t i = 0; i < length; i++) {
		const unsigned char c = (unsigned char)text[i];
		if (c >= 0x80)
			*to++ = (char)(0xC0 | c >> 6);
		*to++ = (char)(c < 0x80 ? c : 0x80 | (c & 0x3F));
	}
	*to = '\0';
	return copy;
}

/* ---- chunks ---- */

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

obj_chunk obj_chunk_of(const char *begin, const char *end)
{
	return (obj_chunk){.begin = begin, .end = end, .p = begin};
}

const obj_chunk *obj_count_all(const obj_file *file, size_t member, obj_count *all)
{
	const obj_chunk *first = NULL;
	*all = (obj_count){0};
	for (const obj_chunk *c = file->chunks; c < file->chunks + file->chunk_count; c++) {
		const obj_count *count = (const obj_count *)((const char *)c + member);
		if (!first && count->count) {
			first = c;
			all->line = c->first_line + count->line + 1;
		}
		all->count += count->count;
	}
	return first;
}

void obj_chunk_free_rest(obj_chunk *c)
{
	free(c->recent);
	free(c->colors);
	free(c->mrgb);
	free(c->mrgb_lines);
	free(c->polygons);
	free(c->events);
}

void obj_chunk_free(obj_chunk *c)
{
	obj_chunk_free_rest(c);
	for (int kind = 0; kind < OBJ_KIND_COUNT; kind++)
		free(c->rows[kind].data);
	free(c->distinct);
	free(c->corners);
	free(c->face_sizes);
}
