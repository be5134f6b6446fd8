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

/* So few triangles have a quicker way to the answer, which is nearly always that the order does not matter. */
enum { NT_EDGE_FEW = 512 };

static inline bool nt_edge_are_few(const nt_welded_mesh *mesh)
{
	return mesh->triangle_count <= NT_EDGE_FEW && mesh->vertex_count <= 3 * NT_EDGE_FEW && !mesh->triangles->cuts;
}

/* Triangles first + i with bit i, and at most so many. */
typedef struct nt_edge_note {
	uint32_t first, triangles;
} nt_edge_note;

enum { NT_EDGE_NOTE_LEAST = 31, NT_EDGE_NOTE_MOST = 32, NT_EDGE_BINS = 1024 };

/* The last triangles decide most, with all that is in the cells of their vertices. A bin has two cells: triangles with
 * a corner in one of certain bins are noted while the sums have their corners in lanes. */
typedef struct nt_edge_tail {
	nt_edge_note *notes; /* see nt_edge_notes(); NULL: there is nothing to note */
	nt_triangle_ranges ranges;
	nt_grid grid;
	uint32_t extremes[6];                /* vertices at the sides of the grid's box */
	bool is_grid_of_used;                /* the box is that of vertices which have corners */
	float scale;                         /* bins for each unit of length */
	uint32_t bins[NT_EDGE_BINS / 32];    /* a bit for each */
} nt_edge_tail;

static inline bool nt_edge_is_near(const nt_edge_tail *tail, float coordinate)
{
	const uint32_t bin = (uint32_t)(int)((coordinate - tail->grid.low) * tail->scale);
	return tail->bins[bin / 32] >> bin % 32 & 1;
}

/* The notes of a range of triangles, ascending; the last one has no triangles. The sums take NT_EDGE_NOTE_LEAST or more
 * at a time, but for the last. */
static inline nt_edge_note *nt_edge_notes(const nt_edge_tail *tail, unsigned range)
{
	return tail->notes + tail->ranges.bounds[range] / NT_EDGE_NOTE_LEAST + 2 * range;
}

/* Says what is to be noted of a mesh, in memory that is used until the question is asked. The sums of few triangles
 * have nothing to note. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_edge_tail_make(const nt_welded_mesh *mesh, const nt_triangle_ranges *ranges, nt_borrowed *memory,
	nt_edge_tail *tail);

/* Expected linear time. The result's edges come from `memory`, which may be that of the mesh. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY.
 *
 *   tail    with notes of all triangles; NULL: none have been noted */
nmtan_status nt_find_unsorted(const nt_welded_mesh *mesh, const nt_edge_tail *tail, nt_scratch *memory,
	nt_unsorted *unsorted);

/* The neighbour across an edge as published; false: it is the same as if all were sorted. */
bool nt_unsorted_neighbour(const nt_unsorted *unsorted, uint32_t edge, uint32_t *neighbour);

#endif
