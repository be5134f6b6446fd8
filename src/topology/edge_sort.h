/* SPDX-License-Identifier: MIT */
/*
 * The edges that mikktspace.c as published leaves unsorted (spec page, step 5). It sorts all edges by their lower end,
 * each run of one lower end by the higher one, and each run of equal edges by triangle, but for the last run both
 * times. So around one vertex pairs of triangles may not meet, or others may.
 */
#ifndef NT_TOPOLOGY_EDGE_SORT_H
#define NT_TOPOLOGY_EDGE_SORT_H

#include "topology/representatives.h"

#define NT_NO_NEIGHBOUR UINT32_MAX

/* Meshes of more corners are beyond the limit. */
#define NT_EDGE_SORT_CORNERS ((size_t)1 << 28)

/* What is paired where edges are unsorted. */
typedef struct nt_unsorted_edge {
	uint32_t edge;      /* 3 * triangle + k: from corner k to the next */
	uint32_t neighbour; /* triangle on its other side, or NT_NO_NEIGHBOUR */
} nt_unsorted_edge;

typedef struct nt_unsorted {
	nt_unsorted_edge *edges; /* [count] ascending: those that are paired otherwise than if they were sorted */
	size_t count;
	bool limit;              /* positions or work are beyond a limit: what is published is not known, count is 0 */
} nt_unsorted;

/* Keys that are looked at to find the order of the last run, for each edge. */
enum { NT_EDGE_SORT_VISITS = 64 };

/* Expected linear time; where the order of the run does not matter, about that of reading the mesh. The result's edges
 * come from `memory`, which may be that of the mesh. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_find_unsorted(const nt_welded_mesh *mesh, nt_scratch *memory, nt_unsorted *unsorted);

/* The neighbour across an edge as published; false: it is the same as if all were sorted. */
bool nt_unsorted_neighbour(const nt_unsorted *unsorted, uint32_t edge, uint32_t *neighbour);

#endif
