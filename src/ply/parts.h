/* SPDX-License-Identifier: MIT */
/*
 * The inside of the room: the header of a PLY as parsed, its body as rows of columns, and data that reading a PLY
 * leaves for writing a PLY from it.
 *
 * read.c has the order of reading. header.c parses the header, rows.c and runs.c read rows of any element into columns,
 * faces.c makes faces of the columns of polygons, origin.c moves positions that float does not hold. write.c has the
 * order of writing.
 */
#ifndef NT_PLY_PARTS_H
#define NT_PLY_PARTS_H

#include <float.h>
#include <math.h>
#include <string.h>
#include "base/buffer.h"
#include "base/dvec.h"
#include "base/memory.h"
#include "ext/number.h"
#include "file/decimal.h"
#include "file/output.h"
#include "scene/scene.h"
#include "scene/srgb.h"

/* ---- values ---- */

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

static inline size_t ply_size(ply_type type)
{
	static const unsigned char sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
	return sizes[type];
}

/* The number that stands for 1 in colours and normals: the largest number of an integer type. */
static inline double ply_one(ply_type type)
{
	static const double largest[] = {127, 255, 32767, 65535, 2147483647, 4294967295, 1, 1};
	return largest[type];
}

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

/* Bytes behind its begin that nt_read_decimal may touch: sign, 8 digits, point, 24 digits. */
enum { PLY_DECIMAL_MARGIN = 40 };

/* Within a row of text: to the next value; behind the value at `at`. */
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

/* Reads the number at `at`; NULL: there is none, or something sticks to it. */
static inline const unsigned char *ply_read_float(const unsigned char *at, const unsigned char *end, float *value)
{
	const char *const p = (const char *)at;
	const unsigned char *after = (const unsigned char *)(end - at > PLY_DECIMAL_MARGIN
			? nt_read_decimal(p, (const char *)end, value)
			: nt_read_float(p, (const char *)end, value));
	return after && (after == end || ply_is_space(*after)) ? after : NULL;
}

/* The same for an integer; one that does not fit is cut to a number that is out of every range. */
static inline const unsigned char *ply_read_integer(const unsigned char *at, const unsigned char *end, int64_t *value)
{
	const bool negative = at < end && *at == '-';
	at += negative || (at < end && *at == '+');
	const unsigned char *const digits = at;
	int64_t sum = 0;
	for (; at < end && *at >= '0' && *at <= '9'; at++)
		sum = sum < INT64_MAX / 100 ? sum * 10 + (*at - '0') : sum;
	*value = negative ? -sum : sum;
	return at > digits && (at == end || ply_is_space(*at)) ? at : NULL;
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

/* An integer of that type; of float types -1, which is out of every range. */
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
	case PLY_UINT32:
		return ply_load32(at, swap);
	default:
		return -1;
	}
}

static inline double ply_load_double(const unsigned char *at, ply_type type, bool swap)
{
	if (type == PLY_FLOAT32) {
		const uint32_t bits = ply_load32(at, swap);
		float value;
		memcpy(&value, &bits, sizeof value);
		return value;
	}
	if (type == PLY_FLOAT64) {
		uint64_t bits;
		double value;
		memcpy(&bits, at, sizeof bits);
		bits = swap ? __builtin_bswap64(bits) : bits;
		memcpy(&value, &bits, sizeof value);
		return value;
	}
	return (double)ply_load_integer(at, type, swap);
}

static inline bool ply_is_finite(float value)
{
	return fabsf(value) <= FLT_MAX;
}

/* ---- the header: header.c ---- */

enum { PLY_NO_PROPERTY = -1 };

typedef struct ply_property {
	const char *name;
	size_t line;
	ply_type type;
	bool list;
	ply_type count_type; /* of a list */
	size_t offset;       /* in the binary row, if no list comes before */
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
	const char **textures; /* names after "comment TextureFile" */
	size_t texture_count, texture_capacity;
	size_t unknown_lines, unknown_line; /* lines before the first element that are no statements: how many,
	                                       the first */
	size_t body;        /* offset of the first byte after the header */
	size_t body_line;   /* its line, 1-based */
	const char *newline; /* as the header has it: "\n", "\r\n" or "\r" */
	nt_arena texts;
} ply_header;

nt_status ply_parse_header(ply_header *header, const unsigned char *bytes, size_t size, nt_error *error);
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

/* The next line of a header, in which '\r' may be a line's end by itself. */
ply_line ply_header_line(const ply_header *header, const unsigned char *bytes, size_t size, size_t begin);

typedef struct ply_word {
	const char *text;
	size_t length; /* 0: there is none */
} ply_word;

/* The next word of [*at, end), blanks around it skipped. */
ply_word ply_next_word(const char **at, const char *end);
bool ply_word_is(ply_word word, const char *text);

/* ---- the body as rows of columns: rows.c ---- */

/* A place in the body. */
typedef struct ply_cursor {
	const unsigned char *begin, *at, *end; /* of the input */
	size_t body_line;                      /* line that body is on */
	const unsigned char *body;
	ply_encoding encoding;
	unsigned threads; /* of plain rows of text; 0 and 1: the caller alone */
} ply_cursor;

ply_cursor ply_begin_body(const nt_scene *scene, const ply_header *header, unsigned threads);

/* The place of a position: its line in ASCII, its offset in binary. */
nt_place ply_place(const ply_cursor *cursor, const unsigned char *at);

/* An error at a position. */
nt_status ply_fail_at(const ply_cursor *cursor, const unsigned char *at, nt_error *error, const char *format, ...)
	NT_PRINTF(4, 5);

/* Refuses an element that cannot fit into the rest of the input, whatever its values are. */
nt_status ply_check_count(const ply_cursor *cursor, const ply_element *element, nt_error *error);

/* Moves behind the rows of an element, whose count is checked against the input first. */
nt_status ply_skip_element(ply_cursor *cursor, const ply_element *element, nt_error *error);

/* Moves to the first value of the next ASCII row, or to the end of the input. */
static inline void ply_next_row(ply_cursor *cursor)
{
	while (cursor->at < cursor->end && ply_is_space(*cursor->at))
		cursor->at++;
}

typedef enum ply_use {
	PLY_SKIPPED, /* nobody wants the values */
	PLY_FLOATS,
	PLY_DOUBLES,
	PLY_INDICES, /* integers below the limit; others are refused */
	PLY_CHOICES  /* integers below the limit; others become the limit */
} ply_use;

/* Treatment of floats that are not finite. */
typedef enum ply_finiteness { PLY_ANY, PLY_MENDED, PLY_REFUSED } ply_finiteness;

/* The values of a property. A row has its own at row * stride; a list is that of the last row that was read. */
typedef struct ply_column {
	ply_use use;
	union {
		void *values;
		float *floats;
		double *doubles;
		uint32_t *integers;
	};
	size_t stride;
	float divisor;        /* of floats */
	ply_finiteness other; /* of floats */
	size_t limit;         /* of integers */
	bool restarts;        /* -1 is an index, too: NT_NONE */
	size_t capacity;      /* of a list */
} ply_column;

/* A property in the row that was read last. */
typedef struct ply_cell {
	const unsigned char *begin, *end;
	size_t count; /* values of a list; else 1 */
} ply_cell;

/* A property in rows of one size: its column from the next row on. */
typedef struct ply_slot {
	ply_column column;
	const ply_property *property;
	size_t offset; /* in the binary row */
	size_t size;   /* of a list; else 0 */
} ply_slot;

typedef struct ply_rows {
	ply_cursor *cursor;
	const ply_element *element;
	ply_column *columns; /* [property_count] */
	ply_cell *cells;     /* [property_count] */
	ply_slot *slots;     /* [property_count] of ply_take_rows() */
	size_t row;          /* the next one */
	const unsigned char *begin; /* of the row that was read last */
	bool unsound;        /* floats to be mended were stored */
	bool may_be_longer;  /* a line may have more values than the element has properties: they are passed over */
	size_t longer;       /* lines that are, and the first of them */
	const unsigned char *first_longer;
} ply_rows;

/* Rows from the cursor on, whose columns are all skipped; false: out of memory. ply_free_rows is due in any case. */
bool ply_begin_rows(ply_rows *rows, ply_cursor *cursor, const ply_element *element);
void ply_free_rows(ply_rows *rows);

/* Reads the next row: its cells and its columns. The cursor moves behind it. */
nt_status ply_read_row(ply_rows *rows, nt_error *error);

/* Reads all rows of an element without lists of indices, in both ways. */
nt_status ply_read_rows(ply_rows *rows, nt_error *error);

/* The value of a number as it was in the row that was read last; false: text that is none. */
bool ply_cell_float(const ply_rows *rows, size_t property, float *value);

/* Value k of a list; of a list of integers. */
ply_cell ply_cell_value(const ply_rows *rows, size_t property, size_t k);
int64_t ply_cell_integer(const ply_rows *rows, size_t property, size_t k);

/* ---- rows of one size: runs.c ---- */

/* Reads rows of one size as long as they are plain and sound, and moves behind them; the one that follows is for
 * ply_read_row(). indices: of the element's list if it has one, in each row `size` of them; else NULL and 0. The number
 * of rows is returned. */
size_t ply_take_rows(ply_rows *rows, uint32_t *indices, size_t size);

/* The length of the list of indices that the next row seems to have; 0: not known. */
size_t ply_list_size(ply_rows *rows, size_t list);

/* ---- what the reader keeps for the writer ---- */

/* Which property of the vertex element has which role. */
typedef struct ply_roles {
	int position[3], normal[3], texcoord[2], color[4], tangent[4];
} ply_roles;

typedef struct ply_source {
	ply_header header;
	ply_roles roles;
	const ply_element *vertex, *face, *strips; /* NULL: the file has none */
	int face_indices, face_texcoords;          /* properties of face or strips; PLY_NO_PROPERTY */
	size_t vertex_begin;                       /* offset of the rows of vertices */
	size_t face_begin, face_end;               /* offsets of the rows of faces or strips */
	/* per-face texture coordinates un-share vertices: vertex vertex->count + i of the mesh has the
	 * row wedge_rows[i] */
	uint32_t *wedge_rows;
	size_t wedge_count;
	/* faces of five and more corners, cut: corner numbers of their triangles, one polygon after the other */
	uint32_t *cuts;
	size_t cut_count;
} ply_source;

/* ---- faces.c ---- */

/* A face of five and more corners. */
typedef struct ply_large_face {
	size_t size;
	const unsigned char *row;
} ply_large_face;

/* The faces as the file has them. */
typedef struct ply_polygons {
	size_t count;
	uint32_t *corners; /* vertices of all of them */
	size_t corner_count, corner_capacity;
	uint8_t *sizes;    /* [count] 3, 4, or 0: it is the next one of `large`; NULL: all have three */
	size_t size_capacity;
	ply_large_face *large;
	size_t large_count, large_capacity;
	bool has_quads;
	uint32_t *textures; /* [count] numbers of the header's textures, texture_count: none of them; NULL: none have */
} ply_polygons;

/* Reads the faces (or strips) at the cursor. Copies of vertices are appended to the mesh, whose vertices are there, if
 * faces have texture coordinates of their own. */
nt_status ply_read_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_polygons *polygons, ply_cursor *cursor,
	nt_error *error);

/* Makes the mesh's faces of polygons, whose arrays the scene takes over; if that is done, and positions have changed,
 * cuts them once more. unsound: the number of those that could be cut by a guess alone; first: the row of the first. */
nt_status ply_make_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_polygons *polygons, size_t *unsound,
	const unsigned char **first, nt_error *error);

void ply_free_polygons(ply_polygons *polygons);

/* ---- origin.c ---- */

/* Lengths of one edge of each of `most` faces or fewer, evenly taken, of positions or of `exact` ones; NULL: there are
 * none. The count is returned. */
size_t ply_sample_edges(const nt_mesh *mesh, const double *exact, size_t most, double *lengths);

/* Gives the scene an origin if it needs one, or the user names one: positions are then others. The cursor moves.
 * Returns NT_OK or NT_ERROR_MEMORY. */
nt_status ply_settle_origin(nt_scene *scene, nt_mesh *mesh, const ply_source *source, const nt_origin *wished,
	ply_cursor *cursor, nt_error *error);

/* ---- writing ---- */

/* Values of a vertex that is written, three of each but for four of colours and tangents and two of s and t. */
typedef enum ply_value {
	PLY_X,
	PLY_NX = 3,
	PLY_RED = 6,
	PLY_S = 10,
	PLY_TX = 12,
	PLY_BX = 16,
	PLY_VALUES = 19
} ply_value;

/* The mesh of a PLY that is written from a PLY: numbering.c. Rows of the source keep their number; what normals,
 * tangents and per-face texture coordinates have added comes behind them. */
typedef struct ply_numbering {
	const nt_mesh *mesh;
	const ply_source *source;
	size_t row_count;        /* vertices of the source */
	const uint32_t *indices; /* final vertex of each corner */
	size_t final_count;      /* vertices after all stages; some of them become one in the output */
	uint32_t *numbers;       /* [final_count - row_count] number in the output */
	uint32_t *appended;      /* [appended_count] final vertex of each appended row */
	size_t appended_count;
	size_t cut_polygons;     /* polygons that become triangles, and how many faces that adds */
	size_t added_faces;
} ply_numbering;

/* False: out of memory. ply_numbering_free is due in any case. */
bool ply_number_vertices(ply_numbering *numbering, const nt_mesh *mesh, const ply_source *source);
void ply_numbering_free(ply_numbering *numbering);

/* The vertex of the mesh, and the row of the source, that a final vertex has its attributes from. */
size_t ply_mesh_vertex(const ply_numbering *numbering, size_t vertex);
size_t ply_source_row(const ply_numbering *numbering, size_t vertex);

/* The vertex of the output at a corner of the mesh. */
uint32_t ply_output_vertex(const ply_numbering *numbering, size_t corner);

/* Vertices for the corners of a cut polygon whose triangles begin at `corner`; false: the triangles
 * disagree about one. cut: its part of source->cuts; vertices: [size]. */
bool ply_resolve_polygon(const ply_numbering *numbering, size_t corner, size_t size, const uint32_t *cut,
	uint32_t *vertices);

/* All meshes of a scene in the world: world.c */
typedef struct ply_world {
	bool normals, colors, byte_colors, texcoords, tangents, bitangents; /* what vertices have */
	bool doubles; /* positions, which float does not hold */
	bool flips_v;
	nt_srgb srgb;
	size_t vertex_count, face_count;
} ply_world;

/* How one instance is brought into the world. */
typedef struct ply_placement {
	bool identity, mirrored;
	nt_dvec3 columns[4];   /* of the matrix */
	nt_dvec3 cofactors[3]; /* columns of the inverse transpose times |determinant| */
} ply_placement;

void ply_find_world(ply_world *world, const nt_scene *scene, bool bitangents);
ply_placement ply_find_placement(const nt_instance *instance);

/* Vertices of a mesh that are written; 0: the mesh is not. */
size_t ply_world_vertices(const nt_mesh *mesh);

/* Returns NT_OK or NT_ERROR_INPUT. */
nt_status ply_world_vertex(const ply_world *world, const ply_placement *placement, const nt_mesh *mesh, size_t vertex,
	double values[PLY_VALUES], nt_error *error);

/* Puts the image beside the output, if it is not there, and says what of the scene's materials is lost. name: appended,
 * from the folder of the PLY; "": there is none. texture.c */
nt_status ply_settle_texture(nt_buffer *name, nt_scene *scene, const nt_write_options *options, nt_output *set,
	nt_error *error);

/* A PLY made of a PLY keeps names of images: tells which lie in the folder of the input, and not in the output's. */
void ply_tell_left(nt_scene *scene, const nt_write_options *options);

#endif
