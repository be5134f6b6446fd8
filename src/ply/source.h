/* SPDX-License-Identifier: MIT */
/*
 * Data that reading a PLY leaves for writing a PLY from it, and the steps of reading.
 */
#ifndef NT_PLY_SOURCE_H
#define NT_PLY_SOURCE_H

#include "ply/cursor.h"
#include "scene/scene.h"

/* Which property of the vertex element has which role. */
typedef struct ply_roles {
	int position[3], normal[3], texcoord[2], color[4], tangent[4];
} ply_roles;

/* Faces of five and more corners, cut: corner numbers of their triangles, one polygon after the other. */
typedef struct ply_cuts {
	uint32_t *corners;
	size_t count, capacity;
	size_t unsound;         /* polygons that could be cut by a guess alone, and the first of them */
	nt_place first_unsound;
} ply_cuts;

/* Data that the reader keeps for the writer. */
typedef struct ply_source {
	ply_header header;
	ply_roles roles;
	const ply_element *vertex, *face, *strips; /* NULL: the file has none */
	int face_indices, face_texcoords;          /* properties of face; PLY_NO_PROPERTY */
	size_t vertex_begin;                       /* offset of the rows of vertices */
	size_t face_begin, face_end;               /* offsets of the rows of faces or strips */
	/* per-face texture coordinates un-share vertices: vertex vertex->count + i of the mesh has the
	 * row wedge_rows[i] */
	uint32_t *wedge_rows;
	size_t wedge_count;
	ply_cuts cuts;
} ply_source;

/* Reads the rows of the vertex element at the cursor into the mesh. vertices.c */
nt_status ply_read_vertices(nt_scene *scene, nt_mesh *mesh, ply_source *source,
	ply_cursor *cursor, nt_error *error);

/* Lengths of one edge of each of `most` faces or fewer, evenly taken, of positions or of `exact` ones; NULL: there are
 * none. The count is returned. */
size_t ply_sample_edges(const nt_mesh *mesh, const double *exact, size_t most, double *lengths);

/* Whether positions are of a type that float does not hold. */
bool ply_has_wide_positions(const ply_source *source);

/* Reads the positions of the vertex element at the cursor, which have been read once, as doubles: [count][3]. */
nt_status ply_read_exact_positions(const ply_source *source, ply_cursor *cursor, double *positions, nt_error *error);

/* Gives the scene an origin if it needs one, or the user names one. The cursor moves. Returns NT_OK or NT_ERROR_MEMORY.
 * origin.c */
nt_status ply_settle_origin(nt_scene *scene, nt_mesh *mesh, ply_source *source, const nt_origin *wished,
	ply_cursor *cursor, nt_error *error);

/* Reads the faces (or strips) at the cursor into the mesh, whose positions are there. faces.c */
nt_status ply_read_faces(nt_scene *scene, nt_mesh *mesh, ply_source *source, ply_cursor *cursor,
	nt_error *error);

/* ---- plain rows of text, by several threads: pieces.c ---- */

/* Reads plain rows, each a line, at the cursor: at most `rows`, of which the first is row `first` of the run. The
 * cursor moves behind those that were read, whose number is returned; the row there is another one, or wrong. Several
 * threads call it, for rows that are not the same. */
typedef size_t (*ply_take_rows)(void *user, ply_cursor *cursor, size_t first, size_t rows);

/* The same for rows from 0 on, with cursor->threads. */
size_t ply_take_pieces(ply_cursor *cursor, size_t rows, ply_take_rows take, void *user);

/* ---- rows of plain triangles or quads, many at a time: face_runs.c ---- */

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

#endif
