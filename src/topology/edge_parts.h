/* SPDX-License-Identifier: MIT */
/* Shared by edge_tail.c, edge_few.c (does the order of the last run matter?) and edge_sort.c (which order?) alone. */
#ifndef NT_TOPOLOGY_EDGE_PARTS_H
#define NT_TOPOLOGY_EDGE_PARTS_H

#include "topology/edge_sort.h"

/* If the order of the last run matters, it has three edges or more. */
enum { NT_LEAST_EDGES = 3 };

static inline uint32_t nt_least_of(uint32_t a, uint32_t b)
{
	return a < b ? a : b;
}

static inline uint32_t nt_most_of(uint32_t a, uint32_t b)
{
	return a < b ? b : a;
}

static inline const uint32_t *nt_vertices_of(const nt_welded_mesh *mesh, size_t triangle, uint32_t copy[3])
{
	return nt_triangle_vertices(mesh->triangles, triangle, 1, copy);
}

/* The corner of the mesh that is corner k of triangle t: 3 * t + k. */
static inline uint32_t nt_mesh_corner(const nt_welded_mesh *mesh, uint32_t corner)
{
	return (uint32_t)nt_triangle_corner(mesh->triangles, corner / 3, corner % 3);
}

/* Whether the order of the last run may matter, of a mesh of LEAST_EDGES triangles or more; `grid` receives that of the
 * vertices that have corners, if it may. Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 *
 *   tail    NULL: nothing has been noted */
nmtan_status nt_edge_tail_matters(const nt_welded_mesh *mesh, const nt_edge_tail *tail, nt_grid *grid, bool *matters,
	bool *limit);

/* Whether the order of the last run certainly does not matter, or is beyond a limit; for at most NT_EDGE_FEW triangles
 * that are not halves of quads, and no more rows than corners may be. `grid` receives that of the vertices that have
 * corners. */
bool nt_few_edges_are_sorted(const nt_welded_mesh *mesh, nt_grid *grid, bool *limit);

#endif
