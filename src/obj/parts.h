/* SPDX-License-Identifier: MIT */
/*
 * Shared by the parts of the OBJ reader: lines.c turns lines into the arrays of a chunk, vertices.c turns corners into
 * vertices, meshes.c makes meshes of them. read.c says in which order. Nothing here is for other files.
 */
#ifndef NT_OBJ_PARTS_H
#define NT_OBJ_PARTS_H

#include <string.h>
#include "base/hash_index.h"
#include "scene/scene.h"

/* The numbers of a face corner, as they are kept until the file has been read. Bit 31 clear: counted
 * from 0. Bit 31 set: counted back, the low bits are OBJ_BIAS plus the number relative to the chunk's
 * first element, which may lie in an earlier chunk. */
#define OBJ_ABSENT   UINT32_MAX
#define OBJ_RELATIVE 0x80000000u
#define OBJ_BIAS     0x40000000u

#define OBJ_WHITE 0xffffffu

typedef struct obj_corner {
	uint32_t v, t, n;
} obj_corner;

/* The kinds of lines. */
typedef enum obj_statement {
	OBJ_UNUSED,
	OBJ_POSITION,
	OBJ_TEXCOORD,
	OBJ_NORMAL,
	OBJ_FACE,
	OBJ_OBJECT,
	OBJ_MATERIAL,  /* usemtl: a mesh begins here, too, where its normal map is mirrored in another way */
	OBJ_GROUP,
	OBJ_SMOOTHING,
	OBJ_LIBRARY
} obj_statement;

/* The words that OBJ defines, and at the end what lines without one are called. Findings about unused ones come in
 * this order. */
typedef struct obj_keyword {
	const char *word;
	obj_statement statement;
	bool is_proof;        /* no other format has such a line */
	const char *left_out; /* geometry, which an output of another format has not; else NULL */
} obj_keyword;

enum { OBJ_WORD_COUNT = 46, OBJ_UNKNOWN = OBJ_WORD_COUNT - 1, OBJ_NUL_LINE = OBJ_UNKNOWN - 1, OBJ_SMALL_FACE = 9 };
extern const obj_keyword obj_keywords[OBJ_WORD_COUNT];

/* NULL: there is no such word. */
const obj_keyword *obj_find_keyword(const char *word, size_t length);

/* A statement between faces. */
typedef struct obj_event {
	obj_statement kind;  /* o, g, usemtl, s or mtllib */
	uint32_t group;      /* SMOOTHING: its group, 0 off */
	const char *text;    /* the others: the name, in the input */
	size_t length;
	size_t line;         /* within the chunk, from 0 */
	size_t face, corner; /* faces and corners of the chunk before it */
} obj_event;

/* A face of five corners or more: face_sizes has OBJ_POLYGON for it. */
enum { OBJ_POLYGON = 5 };

typedef struct obj_polygon {
	size_t face; /* within the chunk, within the file after joining; its line, from 0 and 1, likewise */
	size_t size;
	size_t line;
} obj_polygon;

/* How often there is something, and the line of the first, within the chunk. */
typedef struct obj_count {
	size_t count, line;
} obj_count;

/* Kinds of attributes that corners refer to, and how many numbers of it are kept. */
enum { OBJ_V, OBJ_VT, OBJ_VN, OBJ_KIND_COUNT };
static const unsigned obj_widths[OBJ_KIND_COUNT] = {3, 2, 3};

/* The elements of one kind in a chunk. They stay there: making one array of them would touch as much
 * memory again. */
typedef struct obj_rows {
	float *data;
	size_t count, capacity;
	size_t first; /* of that kind in the file before this chunk; known after all have been read */
} obj_rows;

/* A line of colours. */
typedef struct obj_mrgb_line {
	size_t line;   /* within the chunk, from 0 */
	size_t vertex; /* `v` of the chunk before it */
	size_t count;  /* its colours */
	bool sound;    /* all of it are colours */
} obj_mrgb_line;

/* Whole lines of the file and what was in them. */
typedef struct obj_chunk {
	const char *begin, *end; /* of the last chunk: in obj_file.tail */
	size_t mesh;             /* that its first corner belongs to, or one before; known when vertices are numbered */

	/* the position of the reader */
	const char *p;
	size_t line;           /* of p, from 0 */
	const char *statement; /* its first word, and the line of that */
	size_t statement_line;
	uint32_t *recent;      /* number + 1 of the distinct corner that last had a v, by the low bits of v; valid are
	                          those that still exist, of this object */
	size_t object_begin;   /* distinct corners before the object, or its last usemtl */

	obj_rows rows[OBJ_KIND_COUNT];
	bool rare;      /* something is kept of a position besides its row: a colour, or doubles */
	double *exact;  /* [exact_count][3] where its numbers go as doubles; NULL: nobody asks for them */
	size_t exact_count; /* of the first reading: the file may have changed */
	float *colors; /* rows of 4 as written, as many as positions; NULL while no `v` has one */
	size_t color_capacity;
	obj_count bad_colors; /* that are not finite: white */
	obj_count bad_rows[OBJ_KIND_COUNT]; /* of vt and vn, that are not finite: zeros */
	uint32_t *mrgb; /* colours in comments, 0xRRGGBB: colors.c */
	size_t mrgb_count, mrgb_capacity;
	obj_mrgb_line *mrgb_lines;
	size_t mrgb_line_count, mrgb_line_capacity;

	/* Corners by number of their distinct v/t/n. The materials are in order of first use; some come more than
	 * once, and again in every object. */
	obj_corner *distinct;
	size_t distinct_count, distinct_capacity;
	uint32_t *corners;
	size_t corner_count, corner_capacity;
	uint8_t *face_sizes; /* 3, 4 or OBJ_POLYGON */
	size_t face_count, face_capacity;
	obj_polygon *polygons;
	size_t polygon_count, polygon_capacity;
	obj_event *events;
	size_t event_count, event_capacity;

	obj_count ignored[OBJ_WORD_COUNT];
	const char *unknown; /* the first unknown statement's word */
	size_t unknown_length;
	size_t small_size;   /* corners of the first face with fewer than 3 */

	/* How much comes before this chunk in the file; known after all have been read. */
	size_t first_corner, first_face, first_line;

	nt_error error; /* its line is within the chunk, from 1 */
} obj_chunk;

/* The arrays of one thread. */
typedef struct obj_memory {
	nt_arena rows;    /* of vertices */
	nt_arena corners; /* distinct corners, corners, sizes of faces */
} obj_memory;

/* Faces of one `o`, or some of them. It ends where the next mesh begins. */
typedef struct obj_mesh {
	const obj_event *object; /* NULL: none */
	size_t line;             /* its line */
	size_t face, corner, vertex; /* of the file: the first ones */
} obj_mesh;

/* The whole file. */
typedef struct obj_file {
	nt_scene *scene;
	unsigned threads;
	obj_chunk *chunks;
	size_t chunk_count;
	bool copies;        /* chunks have their arrays in memory, else of their own */
	obj_memory *memory; /* [threads] */
	char *tail; /* the last lines, padded */
	const char *tail_begin, *tail_end; /* where they stand in the input */

	/* For each kind: how many there are, and the chunk that has number i << OBJ_GUIDE_SHIFT. */
	size_t row_counts[OBJ_KIND_COUNT];
	uint32_t *guides[OBJ_KIND_COUNT];
	bool has_colors;
	bool lacks[OBJ_KIND_COUNT]; /* corners refer to vt or vn, of which there is none */

	/* Joined arrays. */
	uint8_t *face_sizes;
	size_t face_count, corner_count;
	obj_polygon *polygons;
	size_t polygon_count;
	bool uses_smoothing;
	const nt_read_options *options;

	obj_mesh *meshes; /* [mesh_count + 1]: behind the last one, where the file ends */
	size_t mesh_count;

	/* Stretches of faces of one material and smoothing group, in order. */
	struct obj_span *spans;
	size_t span_count, span_capacity;
	const char **groups;    /* [group_count] names; 0 is "", of faces before any `g` */
	size_t group_count;

	uint32_t *corner_vertices;          /* [corner_count], relative to the mesh's first vertex */
	struct obj_vertex *vertices;        /* of all meshes, in order */
	size_t vertex_count;
	double *exact_positions; /* [vertex_count][3]: see nt_mesh; NULL: the scene has no origin */
} obj_file;

/* A guide has an entry for so many rows. */
enum { OBJ_GUIDE_SHIFT = 12 };

/* The chunk of row number `row` of the file, which has to be there. */
static inline const obj_chunk *obj_find_row(const obj_file *file, int kind, uint32_t row)
{
	const obj_chunk *chunk = &file->chunks[file->guides[kind][row >> OBJ_GUIDE_SHIFT]];
	while (row - chunk->rows[kind].first >= chunk->rows[kind].count)
		chunk++;
	return chunk;
}

typedef struct obj_span {
	size_t face, corner; /* the first ones; the span ends where the next begins */
	size_t material_line; /* of its usemtl */
	uint32_t material;
	uint32_t group;
	uint32_t smoothing;
	bool begins_object;
	const obj_event *object; /* NULL: none */
	size_t line;             /* its line, else 0 */
} obj_span;

/* A distinct corner of a mesh: rows of the joined arrays, OBJ_ABSENT where it has none. */
typedef struct obj_vertex {
	uint32_t v, t, n;
	uint32_t next; /* for finding it: another vertex of the same v, plus 1; 0 none */
} obj_vertex;

/* Reads the lines of a chunk up to that of face number `last`, or all; the rest may be read later. Returns NT_OK or
 * what chunk->error says. */
obj_chunk obj_chunk_of(const char *begin, const char *end);
nt_status obj_read_lines(obj_chunk *chunk, size_t last);

/* Adds up a count of all chunks, with its line in the file; `member`: its offset in obj_chunk. The first chunk that has
 * any is returned, or NULL. */
const obj_chunk *obj_count_all(const obj_file *file, size_t member, obj_count *all);

/* Frees the arrays of a chunk: all of them, or those that are in no arena. */
void obj_chunk_free(obj_chunk *chunk);
void obj_chunk_free_rest(obj_chunk *chunk);

/* Gives the vertices of the file the colours that stand in comments; what is wrong with those or with
 * those of `v` is a finding. Needs guides. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status obj_join_colors(obj_file *file, nt_error *error);

/* A copy of lines that may stand at the end of a file, ended and padded as chunks are; NULL: out of memory. */
char *obj_copy_padded(const char *begin, const char *end, const char **padded_end);

/* Leaves in the scene what its locate_faces needs; false: out of memory. */
bool obj_keep_places(const obj_file *file);

/* Fills corner_vertices, vertices and the first vertices of meshes. */
nt_status obj_make_vertices(obj_file *file, nt_error *error);

/* Meshes, spans and materials from the events; findings for what was ignored. */
nt_status obj_read_events(obj_file *file, const nt_read_options *options, nt_error *error);

/* Gives the scene an origin if it needs one, or the user names one; positions: [vertex_count][3], largest: of their
 * coordinates. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status obj_settle_origin(obj_file *file, float largest, float *positions, nt_error *error);

/* The primitives of a mesh, which differ in material or group. Zeroed: none. */
typedef struct obj_primitives {
	nt_primitive *items;
	size_t count, capacity;
	nt_hash_index index;
} obj_primitives;

/* The number of a primitive, which has so many faces more; it is added if it is new. NT_NONE: out of memory. */
uint32_t obj_add_primitive(obj_primitives *list, uint32_t material, uint32_t group, size_t faces);

/* Makes the list, which is empty then, the primitives of the mesh, each group's together; face_primitive has numbers of
 * the list, and is NULL afterwards if one is enough. False: out of memory. */
bool obj_set_primitives(nt_mesh *mesh, obj_primitives *list, nt_arena *arena);

/* Fills scene->meshes from all of it. */
nt_status obj_make_meshes(obj_file *file, nt_error *error);

/* Gives each tile of a material with <UDIM> in the names of its maps a material of its own: see udim.c. Returns NT_OK
 * or NT_ERROR_MEMORY. */
nt_status obj_split_tiles(nt_scene *scene, nt_error *error);

/* ---- MTL ---- */

/* One newmtl. */
typedef struct nt_mtl_definition {
	nt_material material;
	const char *raw_name;   /* as the file spells it, for comparing with usemtl; not converted */
	size_t raw_length;
} nt_mtl_definition;

/* The definitions of all libraries, in order. Texts belong to the scene's arena, the caller
 * frees the array. */
typedef struct nt_mtl {
	nt_mtl_definition *definitions;
	size_t count, capacity;
	bool incomplete;     /* a library could not be read */
	nt_key_set files;    /* nt_file_id of those that have been: each is, once, by however many names */
} nt_mtl;

/*
 * Reads the libraries of one mtllib statement: one file name, blanks allowed, or several. A library that cannot be
 * read, or lies outside the folder of scene->path if options->outside is not YES, is a finding.
 *
 *   names, length   what follows "mtllib"
 *   line            of the statement
 *
 * Returns NT_OK, NT_ERROR_INPUT (a number that is none, with the library's line) or
 * NT_ERROR_MEMORY.
 */
nt_status nt_mtl_read(nt_scene *scene, const char *names, size_t length, size_t line,
	const nt_read_options *options, nt_mtl *mtl, nt_error *error);

/* Reads definitions from bytes; `path` names them in findings and materials and has to live as long as the scene. Each
 * contradictory, doubtful or lost statement is a finding. The same statuses. */
nt_status nt_mtl_parse(nt_scene *scene, const char *path, const unsigned char *bytes, size_t size, nt_mtl *mtl,
	nt_error *error);

void nt_mtl_free(nt_mtl *mtl);

/* A file name with `\` as `/` and without quotes; NULL: out of memory. */
char *nt_mtl_file_name(nt_arena *arena, const char *text, const char *end);

/* The text as UTF-8 with a final NUL. If it is not UTF-8 already, it is taken as Latin-1. NULL: out of memory. */
char *obj_utf8_text(nt_arena *arena, const char *text, size_t length);

/* ---- steps over text ---- */

static inline bool is_blank(char c)
{
	return c == ' ' || c == '\t';
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

/* Whether a word may end here. */
static inline bool is_word_end(const char *p)
{
	return is_blank(*p) || is_line_end(*p) || joins_lines(p);
}

#endif
