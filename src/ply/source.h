/* SPDX-License-Identifier: MIT */
/*
 * What reading a PLY leaves to whoever writes a PLY from it.
 */
#ifndef NT_PLY_SOURCE_H
#define NT_PLY_SOURCE_H

#include "ply/header.h"

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

#endif
