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

/* Corners that are solved together. */
enum { NT_BATCH = 128 };

/* A corner is 4 * triangle + k here, so that parting the two is no division. A "place" is an index into all
 * corners of complex vertices, which are sorted by vertex and then by triangle. */
typedef struct nt_complex {
	nt_fast *fast;
	const nt_kernels *kernels;
	nt_borrowed *memory;
	int orient;          /* of the records in which x of a complex vertex is its number, bit by bit */
	size_t vertex_count, corner_count;
	size_t most;         /* corners of one vertex */
	uint32_t *begin;     /* [vertex_count + 1] first place of each vertex */
	uint32_t *corners;   /* [corner_count] */
	uint32_t *waiting;   /* [welded vertices] see pair_edge() */
	bool any;            /* there are corners without a frame */
	bool more;           /* results are whole, not only their u */
} nt_complex;

/* The corners of some vertices. Their indices are counted from the first place. */
typedef struct nt_batch {
	uint32_t first, count;
	const uint32_t *corners; /* [count] */
	uint32_t *across;        /* [2 * count + 2] the corner beyond the edge to the next (2 i) and from the previous
	                            vertex (2 i + 1); NT_WAITS and above: there is none */
	uint32_t *group;         /* [count] or NT_NONE */
	uint32_t group_count;
	uint32_t *members;       /* [count] corners by group, ascending; the memory of across */
	uint32_t *bounds;        /* [group_count + 1] first member of each group; the same */
} nt_batch;

/* The number of a complex vertex; NT_NONE: it is not complex. */
static inline uint32_t nt_complex_number(const nt_complex *c, uint32_t vertex)
{
	const nt_record *record = nt_fast_record(c->fast, c->orient, vertex);
	uint32_t number;
	memcpy(&number, &record->x, sizeof number);
	return record->state == NT_RESULT_NUMBERED ? number : NT_NONE;
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

/* Lists the members of a batch's groups. */
void nt_list_members(nt_batch *batch);

/* Finds the groups of a batch whose vertices are paired, and lists their members. */
void nt_find_groups(const nt_complex *c, nt_batch *batch);

/* Gives every triangle without a frame the orientation of the first group that reaches it. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_decide_any(const nt_complex *c);

#endif
