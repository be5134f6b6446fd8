/* SPDX-License-Identifier: MIT */
/*
 * The inside of the room: the header of a PLY as parsed, its rows as columns, and data that reading a PLY leaves for
 * writing a PLY from it.
 *
 * header.c parses the header, rows.c reads rows of any element into columns, read.c makes a mesh of the columns of
 * vertices, faces.c its faces of those of polygons. write.c has the order of writing.
 */
#ifndef NT_PLY_PARTS_H
#define NT_PLY_PARTS_H

#include <float.h>
#include <math.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/vec.h"
#include "file/output.h"
#include "scene/scene.h"
#include "scene/values.h"

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

static inline bool ply_swaps(ply_encoding encoding)
{
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
	return encoding == PLY_LITTLE;
#else
	return encoding == PLY_BIG;
#endif
}

/* ---- the header: header.c ---- */

enum { PLY_NO_PROPERTY = -1 };

/* Offsets in the file. */
typedef struct ply_span {
	size_t begin, end;
} ply_span;

typedef struct ply_property {
	const char *name;
	size_t line;
	ply_span text; /* its line with the line's end */
	ply_type type;
	bool list;
	ply_type count_type; /* of a list */
	bool used;           /* it becomes part of the mesh */
	size_t offset;       /* in the binary row, if no list comes before */
} ply_property;

typedef struct ply_element {
	const char *name;
	size_t line;
	ply_span text; /* its line with the line's end */
	size_t count;
	ply_property *properties;
	size_t property_count, property_capacity;
	size_t list_count, last_list; /* properties that are lists; the number of the last of them */
	size_t row_bytes; /* of a binary row; with lists: of one whose lists are empty */
	ply_span rows;    /* found by the reader */
} ply_element;

typedef struct ply_header {
	const unsigned char *bytes; /* of the file */
	size_t size;
	ply_encoding encoding;
	ply_element *elements;
	size_t element_count, element_capacity;
	const char **textures; /* names after "comment TextureFile" */
	size_t texture_count, texture_capacity;
	size_t unknown_lines, unknown_line; /* lines before the first element that are no statements: how many,
	                                       the first */
	size_t body;         /* offset of the first byte after the header */
	size_t body_line;    /* its line, 1-based */
	const char *newline; /* as the header has it: "\n", "\r\n" or "\r" */
	nt_arena texts;
} ply_header;

nt_status ply_parse_header(ply_header *header, const unsigned char *bytes, size_t size, nt_error *error);
void ply_free_header(ply_header *header);

/* The element of that name, NULL: none; the property, PLY_NO_PROPERTY: none. */
ply_element *ply_find_element(const ply_header *header, const char *name);
int ply_find_property(const ply_element *element, const char *name);

/* "float", "uchar" ... */
const char *ply_type_name(ply_type type);

/* The place of a position in the body: its line in ASCII, its offset in binary; an error there. */
nt_place ply_place(const ply_header *header, const unsigned char *at);
nt_status ply_fail_at(const ply_header *header, const unsigned char *at, nt_error *error, const char *format, ...)
	NT_PRINTF(4, 5);

/* ---- rows into columns: rows.c ---- */

typedef enum ply_use {
	PLY_SKIPPED, /* nobody wants the values */
	PLY_FLOATS,
	PLY_DOUBLES,
	PLY_INDICES, /* integers below the limit; others are refused */
	PLY_CHOICES  /* integers below the limit; others become the limit */
} ply_use;

/* Treatment of floats that are not finite. */
typedef enum ply_finiteness { PLY_ANY, PLY_MENDED, PLY_REFUSED } ply_finiteness;

/* The values of a property. A row has its own at row * stride; lists follow each other. */
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
	uint32_t *counts;     /* [element's count] values of each list; NULL: all have `size` */
	size_t size;
	size_t used, capacity; /* values of all lists */
} ply_column;

/* A property in the row that was read last. */
typedef struct ply_cell {
	const unsigned char *begin, *end;
	size_t count; /* values of a list; else 1 */
} ply_cell;

/* Rows of a kind: how many, and the first. */
typedef struct ply_tally {
	size_t count, first;
} ply_tally;

typedef struct ply_rows {
	const ply_header *header;
	const ply_element *element;
	nt_error *error;
	const unsigned char *at, *end;
	size_t row, stop;     /* the next one, and that before which ply_read_rows stops: the element's count */
	ply_column *columns;  /* [property_count] */
	ply_cell *cells;      /* [property_count] */
	unsigned threads;     /* of text; 0 and 1: the caller alone */
	bool unsound;         /* floats to be mended were stored */
	bool may_be_longer;   /* a line may have more values than the element has properties: they are passed over */
	ply_tally longer;     /* lines that are */
} ply_rows;

/* Rows from `at` on, whose columns are all skipped. An element that cannot fit into the rest of the file, whatever its
 * values are, is refused. ply_free_rows is due in any case. */
nt_status ply_begin_rows(ply_rows *rows, const ply_header *header, const ply_element *element, const unsigned char *at,
	nt_error *error);
void ply_free_rows(ply_rows *rows);

/* Reads the next row: its cells and its columns. */
nt_status ply_read_row(ply_rows *rows);

/* Reads all rows up to `stop`. */
nt_status ply_read_rows(ply_rows *rows);

/* Moves behind all rows; those of text are only counted. */
nt_status ply_skip_rows(ply_rows *rows);

/* Moves to the first value of the next ASCII row, or to the end of the input. */
static inline void ply_next_row(ply_rows *rows)
{
	while (rows->at < rows->end && ply_is_space(*rows->at))
		rows->at++;
}

/* The begin of a row, for which the rows of the element are read again; NULL: out of memory. */
const unsigned char *ply_find_row(const ply_rows *rows, size_t row);

/* How long the list of a row is. */
static inline size_t ply_list_size(const ply_column *list, size_t row)
{
	return list->counts ? list->counts[row] : list->size;
}

/* The value of a number as it was in the row that was read last; false: text that is none. */
bool ply_cell_float(const ply_rows *rows, size_t property, float *value);

/* Value k of a list in that row. */
ply_cell ply_cell_value(const ply_rows *rows, size_t property, size_t k);

/* ---- what the reader keeps for the writer ---- */

typedef enum ply_role { PLY_POSITION, PLY_NORMAL, PLY_TEXCOORD, PLY_COLOR, PLY_TANGENT, PLY_ROLES } ply_role;

typedef struct ply_source {
	ply_header header;
	int roles[PLY_ROLES][4];                   /* properties of vertices; PLY_NO_PROPERTY */
	const ply_element *vertex, *face, *strips; /* NULL: the file has none */
	int face_indices, face_texcoords;          /* properties of face or strips; PLY_NO_PROPERTY */
	/* per-face texture coordinates un-share vertices: vertex vertex->count + i of the mesh has the
	 * row wedge_rows[i] */
	uint32_t *wedge_rows;
	size_t wedge_count;
	/* faces of five and more corners, cut: corner numbers of their triangles, one polygon after the other */
	uint32_t *cuts;
	size_t cut_count;
	size_t most_corners; /* of any face, at least 4 */
} ply_source;

/* ---- faces.c ---- */

/* Faces (or strips) that are read. */
typedef struct ply_faces {
	nt_scene *scene;
	nt_mesh *mesh;
	ply_source *source;
	ply_rows rows;
	ply_column *indices;  /* of rows */
	size_t row_count;     /* of these; of triangles that strips have become */
	uint32_t *textures;   /* [row_count] numbers of the header's textures, texture_count: none; NULL: none have */
	struct wedge *wedges; /* [count of vertices] texture coordinates that each row has first; NULL: vertices' own */
	nt_key_set copies;    /* and those of vertices behind the rows */
	bool any_has, any_lacks; /* some corner has, some has no coordinates */
	size_t large;            /* polygons of more than four corners */
	bool quads;
	ply_tally unsound, small; /* rows with a coordinate that is not finite, of fewer than three corners */
	ply_tally guessed;        /* polygons that could be cut by a guess alone */
} ply_faces;

/* Reads the rows, and says what is not taken of them. */
nt_status ply_read_faces(ply_faces *faces);

/* Makes the mesh's faces of them; its vertices are there. Copies of them are appended if faces have texture
 * coordinates of their own. */
nt_status ply_make_faces(ply_faces *faces, const nt_origin *origin);

void ply_free_faces(ply_faces *faces);

/* Lengths of one edge of each of `most` faces or fewer, evenly taken, of positions or of `exact` ones; NULL: there are
 * none. The count is returned. */
size_t ply_sample_edges(const nt_mesh *mesh, const double *exact, size_t most, double *lengths);

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
