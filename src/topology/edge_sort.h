/* SPDX-License-Identifier: MIT */
/*
 * The edges that mikktspace.c as published leaves unsorted (spec page, step 5). The published code sorts edges by
 * lower vertex, then higher vertex, then triangle, but skips the last run of each pass. Around the vertex of that run,
 * triangles may be paired differently.
 */
#ifndef NT_TOPOLOGY_EDGE_SORT_H
#define NT_TOPOLOGY_EDGE_SORT_H

#include "base/borrowed.h"
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

/* Bins of two cells each. */
enum { NT_EDGE_BINS = NT_CELLS / 2 };

/* The last triangles, which decide whether the order matters, and what has to be known of the mesh for that: corners
 * whose coordinate on the axis of the grid is in the cell of one of theirs. */
typedef struct nt_edge_tail {
	nt_grid grid;
	bool limit;              /* see nt_unsorted */
	bool is_box_used;        /* the box is that of rows that have corners */
	bool is_noted;           /* `near` is written, and is_box_used */
	uint8_t *near;           /* [triangle_count] 0: has no corner in a member's cell; NULL: few, all are listed */
	float scale;             /* of a coordinate above grid.low to its bin, below NT_EDGE_BINS */
	uint32_t bins[NT_EDGE_BINS / 32]; /* a bit for each that is at or beside a member's cell */
	size_t triangles, first_triangle; /* how many are looked at, or one more, and the first of them */
	uint32_t first;          /* their least corner */
} nt_edge_tail;

/* Begins: says what to look for, in memory of the mesh; `near` lies in what is borrowed, until the end. A caller that
 * passes all corners meanwhile may note which triangles are near, and then sets is_noted and is_box_used if the grid's
 * extremes have corners. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_edge_tail_make(const nt_welded_mesh *mesh, nt_borrowed *borrowed, nt_edge_tail *tail);

/* Whether a coordinate of the box is near. */
static inline uint32_t nt_edge_is_near(const nt_edge_tail *tail, float coordinate)
{
	const unsigned bin = (unsigned)(int)((coordinate - tail->grid.low) * tail->scale);
	return tail->bins[bin / 32] >> bin % 32 & 1;
}

/* Ends. Expected linear time; if the order of the run does not matter, a fraction of the time of reading the mesh. The
 * result's edges come from `memory`, which may be that of the mesh. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_find_unsorted(
	const nt_welded_mesh *mesh, nt_edge_tail *tail, nt_scratch *memory, nt_unsorted *unsorted);

/* So few triangles, with no more rows than corners, have a quicker way to the answer: nt_few_edges_are_sorted(). */
enum { NT_EDGE_FEW = 128 };

/* Whether the order of the last run certainly does not matter, or is beyond a limit; for few triangles, none of which
 * is half of a quad. Makes the grid. */
bool nt_few_edges_are_sorted(const nt_welded_mesh *mesh, nt_edge_tail *tail);

/* The neighbour across an edge as published; false: it is the same as if all were sorted. */
bool nt_unsorted_neighbour(const nt_unsorted *unsorted, uint32_t edge, uint32_t *neighbour);

#endif
