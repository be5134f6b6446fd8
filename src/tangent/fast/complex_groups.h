/* SPDX-License-Identifier: MIT */
/*
 * Complex vertices: their corners, and the groups of these. complex.c is the recipe, complex_groups.c finds the
 * groups, complex_solve.c averages and writes them.
 */
#ifndef NT_TANGENT_FAST_COMPLEX_GROUPS_H
#define NT_TANGENT_FAST_COMPLEX_GROUPS_H

#include "tangent/fast/parts.h"

/* No group; no corner. */
#define NT_NONE UINT32_MAX

/* In place of a group: the corner is written. */
#define NT_WRITTEN (UINT32_MAX - 1)

/* Corners that are solved together. */
enum { NT_BATCH = 128 };

/* A corner is 4 * triangle + k here, so that parting the two is no division. A "place" is an index into all
 * corners of complex vertices, which are sorted by vertex and then by triangle. */
typedef struct nt_complex {
	nt_fast *fast;
	const nt_kernels *kernels;
	nt_borrowed *memory;
	int orient;          /* of the records whose states number complex vertices */
	size_t vertex_count, corner_count;
	size_t most;         /* corners of one vertex */
	uint32_t *begin;     /* [vertex_count + 1] first place of each vertex */
	uint32_t *corners;   /* [corner_count] */
	uint32_t *waiting;   /* [welded vertices] see pair_edge() */
	uint32_t *order;     /* [corner_count] places in the order of triangles; NULL: the order decides nothing */
	bool any;            /* there are corners without a frame */
	bool more;           /* results are whole, not only their u */
} nt_complex;

/* The corners of some vertices. Their indices are counted from the first place. */
typedef struct nt_batch {
	uint32_t first, count;
	const uint32_t *corners; /* [count] */
	uint32_t *across;        /* [2 * count + 2] the corner beyond the edge to the next (2 i) and from the previous
	                            vertex (2 i + 1); NT_WAITS and above: there is none */
	uint32_t *group;         /* [count], NT_NONE or NT_WRITTEN */
	uint32_t group_count;
	uint32_t *members;       /* [count] corners by group, ascending; the memory of across */
	uint32_t *bounds;        /* [group_count + 1] first member of each group; the same */
} nt_batch;

/* The number of a complex vertex, which has one; NT_NONE: it is not complex. */
static inline uint32_t nt_complex_number(const nt_complex *c, uint32_t vertex)
{
	const uint32_t state = nt_fast_record(c->fast, c->orient, vertex)->state;
	return state & NT_RESULT_COMPLEX ? state & NT_RESULT_NUMBER : NT_NONE;
}

/* The next triangle from t on that has a corner at a complex vertex. */
static inline size_t nt_next_complex(const nt_complex *c, size_t t)
{
	return nt_fast_next_flagged(c->fast, t, NT_TRIANGLE_COMPLEX);
}

/* Memory of a batch of `capacity` corners; false: there is none. */
bool nt_batch_alloc(const nt_complex *c, size_t capacity, nt_batch *batch);

/* Pairs the edges of the vertex with places [begin, end), which the batch has. */
void nt_pair_vertex(const nt_complex *c, nt_batch *batch, uint32_t begin, uint32_t end);

/* Finds the groups of a batch whose vertices are paired. */
void nt_find_groups(const nt_complex *c, nt_batch *batch);

/* The same for a batch of all vertices, in the order of triangles: every triangle without a frame takes the orientation of
 * the first group that reaches it. */
void nt_find_groups_in_order(const nt_complex *c, nt_batch *all);

/* Gives the groups of a batch, which are numbered among those of all vertices, numbers from 0 in the order in which they
 * begin. `numbers` [groups of all vertices] is NT_NONE for those of this batch. */
void nt_number_groups(const nt_complex *c, nt_batch *batch, uint32_t *numbers);

/* Lists the members of a batch's groups, in the memory of across. */
void nt_list_members(nt_batch *batch);

#endif
