/* SPDX-License-Identifier: MIT */
/*
 * Which vertex of the solved mesh is which vertex of the file that is written. Rows of the source keep
 * their number; what normals, tangents and per-face texture coordinates have added comes behind them.
 */
#ifndef NT_PLY_VERTEX_MAP_H
#define NT_PLY_VERTEX_MAP_H

#include "ply/parts.h"
#include "scene/scene.h"

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
bool ply_resolve_polygon(const ply_numbering *numbering, size_t corner, size_t size,
	const uint32_t *cut, uint32_t *vertices);

#endif
