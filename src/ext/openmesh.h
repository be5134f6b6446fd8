/* SPDX-License-Identifier: MIT */
/*
 * Half-edge topology of a welded triangle mesh, by OpenMesh: chains of marked edges, in the order in which one
 * walks along them.
 *
 * Edges are numbered like corners: side 3 * t + k runs from corner k of triangle t to its next corner.
 * An inner edge has two sides, each other's opposite; NT_OPEN stands where there is none. Flags on edges
 * are arrays with a byte per side; an edge is flagged when either of its sides is.
 *
 * The mesh should be manifold and consistently oriented. What is not becomes open: of several triangles
 * that use a directed edge the first gets it and the others are left out of the structure and listed, and
 * fans that meet in a vertex only are taken as apart. Numbers of triangles and vertices stay the caller's.
 *
 * Results depend on the mesh alone, and are numbered by their lowest triangle or side. A structure may
 * be read by several threads.
 */
#ifndef NT_EXT_OPENMESH_H
#define NT_EXT_OPENMESH_H

#include <stdlib.h>
#include <string.h>
#include "base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

#define NT_OPEN UINT32_MAX

typedef struct nt_halfedges nt_halfedges;

/*
 * Builds the structure.
 *
 *   triangles       [triangle_count][3] vertices, each below vertex_count; not kept
 *   triangle_count  at most 2^31 / 6: OpenMesh numbers half-edges by int
 *
 * Returns NT_OK, NT_ERROR_INDEX, NT_ERROR_TOO_LARGE or NT_ERROR_MEMORY.
 */
nt_status nt_halfedges_build(nt_halfedges **mesh, size_t vertex_count, const uint32_t *triangles,
	size_t triangle_count, nt_error *error);

/* NULL is allowed. */
void nt_halfedges_free(nt_halfedges *mesh);

/* The triangles that are not in the structure, ascending: degenerate ones (two equal vertices) and those
 * on an edge that is taken. *triangles belongs to the structure; returns how many there are. */
size_t nt_halfedges_left_out(const nt_halfedges *mesh, const uint32_t **triangles);

/* Walks along edges. Walk w has steps first[w] to first[w + 1] - 1. Step s goes along the sides left[s]
 * and right[s], seen in the direction of the walk, from vertex from[s] to vertex to[s]; to of a step is
 * from of the next, and in a closed walk to of the last is from of the first. One of left and right may
 * be NT_OPEN. */
typedef struct nt_walks {
	size_t count;
	size_t *first; /* [count + 1] */
	bool *closed;  /* [count] */
	uint32_t *left, *right, *from, *to; /* [first[count]] */
} nt_walks;

static inline void nt_walks_free(nt_walks *walks)
{
	free(walks->first);
	free(walks->closed);
	free(walks->left);
	free(walks->right);
	free(walks->from);
	free(walks->to);
	memset(walks, 0, sizeof *walks);
}

/*
 * The marked edges, each once, as walks that are as long as possible without passing a junction, which is a
 * vertex where more than two marked edges meet. A walk goes the way its lowest side goes; a closed one begins
 * with that side, or at its junction where it has one. Walks come in the order of their lowest sides, and
 * after them, as walks of one step, the marked sides of triangles left out.
 *
 *   marked  [3 * triangle_count]
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_halfedges_chains(const nt_halfedges *mesh, const uint8_t *marked, nt_walks *walks,
	nt_error *error);

#ifdef __cplusplus
}
#endif
#endif
