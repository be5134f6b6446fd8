/* SPDX-License-Identifier: MIT */
/*
 * The edges that mikktspace.c as published leaves unsorted (spec page, step 5). The published code sorts edges by
 * lower vertex, then higher vertex, then triangle, but skips the last run of each pass. Around the vertex of that run,
 * triangles may be paired differently.
 */
#ifndef NT_TOPOLOGY_EDGE_SORT_H
#define NT_TOPOLOGY_EDGE_SORT_H

#include "topology/representatives.h"

#define NT_NO_NEIGHBOUR UINT32_MAX

/* Meshes of more corners are beyond the limit. */
#define NT_EDGE_SORT_CORNERS ((size_t)1 << 28)

/* An edge, and its neighbour as mikktspace.c pairs it if it leaves the edge unsorted. */
typedef struct nt_unsorted_edge {
	uint32_t edge;	    /* 3 * triangle + k: from corner k to the next */
	uint32_t neighbour; /* triangle on its other side, or NT_NO_NEIGHBOUR */
} nt_unsorted_edge;

typedef struct nt_unsorted {
	nt_unsorted_edge *edges; /* [count] ascending: those that are paired otherwise than if they were sorted */
	size_t count;
	bool limit; /* positions or work are beyond a limit: what is published is not known, count is 0 */
} nt_unsorted;

/* Keys that are looked at to find the order of the last run, for each edge. */
enum { NT_EDGE_SORT_VISITS = 64 };

/* So few triangles have a quicker way to the answer, which is nearly always that the order does not matter. */
enum { NT_EDGE_FEW = 128 };

/* Whether the order of the last run certainly does not matter, or is beyond a limit; for at most NT_EDGE_FEW triangles
 * that are not halves of quads, and no more rows than corners may be. */
bool nt_few_edges_are_sorted(const nt_welded_mesh *mesh, bool *limit);

/* Expected linear time; if the order of the run does not matter, that of reading the indices once and the positions
 * twice. The result's edges come from `memory`, which may be that of the mesh. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_find_unsorted(const nt_welded_mesh *mesh, nt_scratch *memory, nt_unsorted *unsorted);

/* The neighbour across an edge as published; false: it is the same as if all were sorted. */
bool nt_unsorted_neighbour(const nt_unsorted *unsorted, uint32_t edge, uint32_t *neighbour);

#endif
