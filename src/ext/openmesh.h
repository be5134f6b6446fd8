/* SPDX-License-Identifier: MIT */
/*
 * Walks along marked edges of a triangle mesh, by OpenMesh, which is told which sides are one edge: fans that meet in a
 * vertex only are apart.
 *
 * Side 3 * t + k runs from corner k of triangle t to its next corner. An inner edge has two sides; it is marked when
 * either of them is.
 *
 * The mesh should be manifold and consistently oriented. An edge that is not becomes open: of several triangles that
 * use an edge in one direction the first gets it and the others are left out, as are degenerate ones, which have two
 * sides at one edge.
 */
#ifndef NT_EXT_OPENMESH_H
#define NT_EXT_OPENMESH_H

#include "base/text.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct nt_walked_mesh {
	size_t edge_count, triangle_count; /* at most 2^31 / 6 triangles: OpenMesh numbers half-edges by int */
	const uint32_t *sides; /* [3 * triangle_count] twice its edge, and 1 more in one of the edge's two directions */
	const uint32_t *marks; /* [3 * triangle_count] numbers of the marked sides; UINT32_MAX: not marked */
} nt_walked_mesh;

/* Takes a walk of count > 0 steps, each twice the number of a marked side, and 1 more if the walk goes against it. */
typedef void nt_walk_taker(void *context, const uint32_t *steps, size_t count, bool closed);

/*
 * The marked edges of triangles that are not left out, each once, as walks that are as long as possible without passing
 * a junction, which is a vertex where more than two marked edges meet. A walk goes the way its lowest side goes; a
 * closed one begins with that side, or at its junction where it has one. Walks come in the order of their lowest sides.
 *
 *   left_out  set to the number of triangles that are left out
 *
 * Returns NT_OK, NT_ERROR_INDEX, NT_ERROR_TOO_LARGE, NT_ERROR_MEMORY, or what opening the module comes to.
 */
nt_status nt_walk_marked(const nt_walked_mesh *mesh, nt_walk_taker *take, void *context, size_t *left_out,
	nt_error *error);

#ifdef __cplusplus
}
#endif
#endif
