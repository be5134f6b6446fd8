/* SPDX-License-Identifier: MIT */
/*
 * Complex vertices: complex.c is the recipe, complex_groups.c finds the groups of their corners, complex_solve.c
 * averages and writes them.
 */
#ifndef NT_TANGENT_FAST_COMPLEX_H
#define NT_TANGENT_FAST_COMPLEX_H

#include "tangent/fast/parts.h"

/* ---- corners and groups ---- */

/* No group; no corner. */
#define NT_NONE UINT32_MAX

/* A value of nt_complex.across that is no corner: what is left of it is another edge that waits. */
#define NT_WAITS ((uint32_t)1 << 31)

/* A corner is 4 * triangle + k here, so that parting the two is no division, with what its triangle is above that. */
#define NT_COMPLEX_CORNER (((uint32_t)1 << 29) - 1)
#define NT_COMPLEX_SEED ((uint32_t)1 << 29)  /* nt_find_groups_in_order() may begin a group here */
#define NT_COMPLEX_PLUS ((uint32_t)1 << 30)  /* the orientation of its triangle, or group */
#define NT_COMPLEX_ANY ((uint32_t)1 << 31)   /* the triangle has no frame */

/* A "place" is an index into all corners of complex vertices, which are sorted by vertex and then by triangle; tangled
 * vertices come last. */
typedef struct nt_complex {
	nt_fast *fast;
	const nt_kernels *kernels;
	nt_borrowed *memory;
	int orient;          /* of the records whose states have the places of complex vertices */
	size_t vertex_count;
	size_t plain_count;  /* those that are not tangled */
	uint32_t *vertices;  /* [vertex_count + 1] first place of each, with NT_RESULT_SUM */
	uint32_t *welded;    /* [vertex_count] their numbers as welded vertices */
	uint32_t *corners;   /* [places] */
	uint32_t *across;    /* [2 * room] of each corner that is not tangled the next and the previous vertex of its
	                        triangle; then the corners beyond these edges: NT_WAITS and above: there is none */
	uint32_t *group;     /* [room] the place that a corner's group begins with, or NT_NONE */
	uint32_t room;       /* places, or fewer where tangled vertices have theirs one after the other */
	uint32_t base;       /* places are counted from here: see solve_tangled() */
	uint32_t *waiting;   /* [welded vertices] see pair_edge(); NULL: no vertex is tangled */
	uint32_t *order;     /* [corner_count] places in the order of triangles; NULL: the order decides nothing */
	size_t corner_count;
	bool single;         /* there are records of this orientation only */
	bool more;           /* results are whole, not only their u */
} nt_complex;

static inline uint32_t nt_first_place(const nt_complex *c, size_t v)
{
	return (c->vertices[v] & NT_RESULT_NUMBER) - c->base;
}

static inline bool nt_is_tangled(const nt_complex *c, size_t v)
{
	return v >= c->plain_count;
}

/* The corner of the mesh. */
static inline size_t nt_complex_corner(const nt_complex *c, uint32_t corner)
{
	return nt_triangle_corner(&c->fast->triangles, (corner & NT_COMPLEX_CORNER) >> 2, corner & 3);
}

/* The place behind the last corner of a vertex; for hubs there may be more places. */
static inline uint32_t nt_last_place(const nt_complex *c, size_t v)
{
	if (!nt_is_tangled(c, v))
		return nt_first_place(c, v + 1);
	return (nt_fast_record(c->fast, c->orient, c->welded[v])->state & NT_RESULT_NUMBER) - c->base;
}

/* Finds the groups of complex vertex v, if nt_find_groups_in_order() has not. */
void nt_find_groups(const nt_complex *c, size_t v);

/* Finds the groups of all vertices that have a triangle without a frame, in the order of triangles: every such triangle
 * takes the orientation of the first group that reaches it. */
void nt_find_groups_in_order(nt_complex *c);

/* ---- averages ---- */

/* Corners that are solved at a time, but for a vertex that has more. */
enum { NT_BATCH = 512 };

/* The corners of some vertices that have to be solved. They and their groups have been moved together: both are where
 * those of the first vertex were. */
typedef struct nt_batch {
	uint32_t first, count; /* places */
	uint32_t group_count;  /* groups are numbered from 0 in the order in which they begin */
	nt_corner *results;    /* [capacity] where the halves of quads have to meet; NULL: there are no quads */
} nt_batch;

/* Makes an empty batch, with results for `capacity` corners; false: there is no memory. */
bool nt_batch_make(const nt_complex *c, size_t capacity, nt_batch *batch);

/* Sees to it that complex vertex v, whose groups have been found, gets its corners written. Step 6 has done so where a
 * group is the only one of its orientation and the vertex's record is its result, but not at triangles without a frame;
 * not with quads or further outputs. The other corners go to the batch, which is solved before it becomes larger than
 * NT_BATCH. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_take_vertex(const nt_complex *c, nt_batch *batch, size_t v);

/* Solves all groups of a batch and writes its corners; then it is empty. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_solve_batch(const nt_complex *c, nt_batch *batch);

#endif
