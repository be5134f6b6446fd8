/* SPDX-License-Identifier: MIT */
/*
 * What the parts of the PLY reader and writer share: the header as parsed, access to values, and what
 * the reader keeps for the writer.
 */
#ifndef NT_IO_PLY_H
#define NT_IO_PLY_H

#include <string.h>
#include "ext/number.h"
#include "io/decimal.h"
#include "scene/scene.h"

typedef enum ply_encoding { PLY_ASCII, PLY_LITTLE, PLY_BIG } ply_encoding;

typedef enum ply_type {
	PLY_INT8,
	PLY_UINT8,
	PLY_INT16,
	PLY_UINT16,
	PLY_INT32,
	PLY_UINT32,
	PLY_FLOAT32,
	PLY_FLOAT64
} ply_type;

enum { PLY_NO_PROPERTY = -1 };

/* Bytes behind its begin that nt_read_decimal may touch: sign, 8 digits, point, 24 digits. */
enum { PLY_DECIMAL_MARGIN = 40 };

typedef struct ply_property {
	const char *name;
	size_t line;
	ply_type type;
	bool list;
	ply_type count_type; /* of a list */
	size_t offset;       /* in the binary row, where no list comes before */
} ply_property;

typedef struct ply_element {
	const char *name;
	size_t line;
	size_t count;
	ply_property *properties;
	size_t property_count, property_capacity;
	bool has_list;
	size_t row_bytes; /* of a binary row; with lists: of one whose lists are empty */
} ply_element;

typedef struct ply_header {
	ply_encoding encoding;
	ply_element *elements;
	size_t element_count, element_capacity;
	char **textures; /* names after "comment TextureFile" */
	size_t texture_count, texture_capacity;
	size_t body;        /* offset of the first byte after the header */
	size_t body_line;   /* its line, 1-based */
	const char *newline; /* as the header has it: "\n", "\r\n" or "\r" */
} ply_header;

/* Reads the header of scene->bytes. */
nmtan_status ply_parse_header(ply_header *header, const unsigned char *bytes, size_t size,
	nt_error *error);
void ply_free_header(ply_header *header);

/* The element of that name, NULL: none; the property, PLY_NO_PROPERTY: none. */
const ply_element *ply_find_element(const ply_header *header, const char *name);
int ply_find_property(const ply_element *element, const char *name);

/* "float", "uchar" ... */
const char *ply_type_name(ply_type type);

/* The next line of a header: its text without the line's end, where the one after begins. */
typedef struct ply_line {
	const char *text;
	size_t length;
	size_t next;
	const char *newline; /* NULL: the file ends here */
} ply_line;

/* The next line of a header, where '\r' may be a line's end by itself. */
ply_line ply_header_line(const ply_header *header, const unsigned char *bytes, size_t size, size_t begin);

/* The next word of [*at, end), blanks around it skipped; its length, 0: none. */
size_t ply_next_word(const char **at, const char *end, const char **word);

/* Where the values come from: a position in the input with what is needed to judge it. */
typedef struct ply_cursor {
	const unsigned char *begin, *at, *end; /* of the input */
	size_t body_line;                      /* line that body is on */
	const unsigned char *body;
	ply_encoding encoding;
} ply_cursor;

/* Line (1-based) of a position in an ASCII body: counted when an error needs it. */
size_t ply_line_of(const ply_cursor *cursor, const unsigned char *at);

/* An error at a position: with its line in ASCII, with its offset in binary. */
nmtan_status ply_fail_at(const ply_cursor *cursor, const unsigned char *at, nt_error *error,
	const char *format, ...) NT_PRINTF(4, 5);

/* "the rest of the line, shortened", for messages: fills text. */
const char *ply_show(const ply_cursor *cursor, const unsigned char *at, char text[40]);

/* Moves behind the rows of an element, whose count is checked against the input first. */
nmtan_status ply_skip_element(ply_cursor *cursor, const ply_element *element, nt_error *error);

/* Moves to the first value of the next ASCII row, or to the end of the input. */
void ply_next_row(ply_cursor *cursor);

/* After the last value of an ASCII row: that nothing follows on its line. */
nmtan_status ply_check_row_end(const ply_cursor *cursor, const ply_element *element, size_t row,
	nt_error *error);

/* Skips the row at the cursor of a binary element with lists; no further than the input reaches. */
nmtan_status ply_skip_binary_row(ply_cursor *cursor, const ply_element *element, size_t row,
	nt_error *error);

/* Refuses an element that cannot fit into the rest of the input, whatever its values are. */
nmtan_status ply_check_count(const ply_cursor *cursor, const ply_element *element, nt_error *error);

/* Which property of the vertex element has which role. */
typedef struct ply_roles {
	int position[3], normal[3], texcoord[2], color[4], tangent[4];
} ply_roles;

/* Faces of five and more corners, cut: corner numbers of their triangles, one polygon after the other. */
typedef struct ply_cuts {
	uint32_t *corners;
	size_t count, capacity;
} ply_cuts;

/* What the reader keeps for the writer. */
typedef struct ply_source {
	ply_header header;
	ply_roles roles;
	const ply_element *vertex, *face, *strips; /* NULL: the file has none */
	int face_indices, face_texcoords;          /* properties of face; PLY_NO_PROPERTY */
	size_t face_begin, face_end;               /* offsets of the rows of faces or strips */
	/* per-face texture coordinates un-share vertices: vertex vertex->count + i of the mesh has the
	 * row wedge_rows[i] */
	uint32_t *wedge_rows;
	size_t wedge_count;
	ply_cuts cuts;
} ply_source;

/* Reads the faces (or strips) at the cursor into the mesh, whose positions are there. */
nmtan_status ply_read_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_cursor *cursor,
	nt_error *error);

/* Reads the rows of the vertex element at the cursor into the mesh. */
nmtan_status ply_read_vertices(nt_scene *scene, nt_mesh *mesh, const ply_source *source,
	ply_cursor *cursor, nt_error *error);

/* Rows of plain triangles or quads, read many at a time (ply_runs.c). */
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

static inline bool ply_is_blank(unsigned char c)
{
	return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

static inline bool ply_is_line_end(unsigned char c)
{
	return c == '\n' || c == '\r';
}

/* Any character that ends a value. */
static inline bool ply_is_space(unsigned char c)
{
	return c == ' ' || (unsigned char)(c - '\t') <= '\r' - '\t';
}

/* Within an ASCII row: to the next value; behind the value at `at`. */
static inline const unsigned char *ply_skip_blanks(const unsigned char *at, const unsigned char *end)
{
	while (at < end && ply_is_blank(*at))
		at++;
	return at;
}

static inline const unsigned char *ply_skip_value(const unsigned char *at, const unsigned char *end)
{
	while (at < end && !ply_is_space(*at))
		at++;
	return at;
}

/* Reads the ASCII number at `at`; NULL when there is none or something sticks to it. */
static inline const unsigned char *ply_read_float(const unsigned char *at, const unsigned char *end,
	float *value)
{
	const char *const p = (const char *)at;
	const unsigned char *after = (const unsigned char *)(end - at > PLY_DECIMAL_MARGIN
			? nt_read_decimal(p, (const char *)end, value)
			: nt_read_float(p, (const char *)end, value));
	return after && (after == end || ply_is_space(*after)) ? after : NULL;
}

/* The same for an integer; one that does not fit is cut to a number that is out of every range. */
static inline const unsigned char *ply_read_integer(const unsigned char *at, const unsigned char *end,
	int64_t *value)
{
	const bool negative = at < end && *at == '-';
	at += negative || (at < end && *at == '+');
	const unsigned char *const digits = at;
	int64_t sum = 0;
	for (; at < end && *at >= '0' && *at <= '9'; at++)
		sum = sum < INT64_MAX / 100 ? sum * 10 + (*at - '0') : sum;
	*value = negative ? -sum : sum;
	const bool ends = at == end || ply_is_space(*at);
	return at > digits && ends ? at : NULL;
}

static inline size_t ply_size(ply_type type)
{
	static const unsigned char sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
	return sizes[type];
}

static inline bool ply_swaps(ply_encoding encoding)
{
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
	return encoding == PLY_LITTLE;
#else
	return encoding == PLY_BIG;
#endif
}

static inline uint16_t ply_load16(const unsigned char *at, bool swap)
{
	uint16_t bits;
	memcpy(&bits, at, sizeof bits);
	return swap ? __builtin_bswap16(bits) : bits;
}

static inline uint32_t ply_load32(const unsigned char *at, bool swap)
{
	uint32_t bits;
	memcpy(&bits, at, sizeof bits);
	return swap ? __builtin_bswap32(bits) : bits;
}

static inline uint64_t ply_load64(const unsigned char *at, bool swap)
{
	uint64_t bits;
	memcpy(&bits, at, sizeof bits);
	return swap ? __builtin_bswap64(bits) : bits;
}

/* An integer of that type; float types give their value cut off, which nobody asks for. */
static inline int64_t ply_load_integer(const unsigned char *at, ply_type type, bool swap)
{
	switch (type) {
	case PLY_INT8:
		return (int8_t)*at;
	case PLY_UINT8:
		return *at;
	case PLY_INT16:
		return (int16_t)ply_load16(at, swap);
	case PLY_UINT16:
		return ply_load16(at, swap);
	case PLY_INT32:
		return (int32_t)ply_load32(at, swap);
	default:
		return ply_load32(at, swap);
	}
}

static inline float ply_load_float(const unsigned char *at, ply_type type, bool swap)
{
	if (type == PLY_FLOAT32) {
		const uint32_t bits = ply_load32(at, swap);
		float value;
		memcpy(&value, &bits, sizeof value);
		return value;
	}
	if (type == PLY_FLOAT64) {
		const uint64_t bits = ply_load64(at, swap);
		double value;
		memcpy(&value, &bits, sizeof value);
		return (float)value;
	}
	return (float)ply_load_integer(at, type, swap);
}

#endif
