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

/* Corners of a batch, but for a vertex that has more; corners that are solved together. */
enum { NT_BATCH = 512, NT_SOLVED = 128 };

/* A corner is 4 * triangle + k here, so that parting the two is no division. A "place" is an index into all
 * corners of complex vertices, which are sorted by vertex and then by triangle. */
typedef struct nt_complex {
	nt_fast *fast;
	const nt_kernels *kernels;
	nt_borrowed *memory;
	int orient;          /* of the records whose states have the places of complex vertices */
	size_t vertex_count;
	uint32_t *vertices;  /* [vertex_count + 1] first place of each, with NT_RESULT_SUM and NT_RESULT_TANGLED */
	uint32_t *corners;   /* [places] */
	uint32_t *waiting;   /* [welded vertices] see pair_edge(); NULL: no vertex is tangled */
	uint32_t *order;     /* [corner_count] places in the order of triangles; NULL: the order decides nothing */
	size_t corner_count;
	uint32_t *decided;   /* [places] groups that nt_find_groups_in_order() has found; NULL: none */
	bool single;         /* there are records of this orientation only */
	bool more;           /* results are whole, not only their u */
} nt_complex;

/* The corners of some vertices. Their indices are counted from the first place. */
typedef struct nt_batch {
	uint32_t first, count;
	const uint32_t *corners; /* [count] */
	uint32_t *across;        /* [2 * count + 2] the corner beyond the edge to the next (2 i) and from the previous
	                            vertex (2 i + 1); NT_WAITS and above: there is none */
	uint32_t *group;         /* [count] the corner that it begins with, then its number; NT_NONE or NT_WRITTEN */
	uint32_t group_count;
	uint32_t *members;       /* [count] corners by group, ascending; the memory of across */
	uint32_t *bounds;        /* [group_count + 1] first member of each group; the same */
	nt_corner *results;      /* [count] where the halves of quads have to meet; NULL: there are no quads */
} nt_batch;

static inline uint32_t nt_first_place(const nt_complex *c, size_t v)
{
	return c->vertices[v] & NT_RESULT_NUMBER;
}

static inline bool nt_is_tangled(const nt_complex *c, size_t v)
{
	return c->vertices[v] & NT_RESULT_TANGLED;
}

/* The place behind the last corner of a vertex; for hubs there may be more places. */
static inline uint32_t nt_last_place(const nt_complex *c, size_t v)
{
	if (!nt_is_tangled(c, v))
		return nt_first_place(c, v + 1);
	const uint32_t corner = c->corners[nt_first_place(c, v)];
	const nt_triangles *triangles = &c->fast->triangles;
	const uint32_t vertex = triangles->ids[nt_triangle_corner(triangles, corner >> 2, corner & 3)];
	return nt_fast_record(c->fast, c->orient, vertex)->state & NT_RESULT_NUMBER;
}

/* Memory of a batch of `capacity` corners; false: there is none. */
bool nt_batch_alloc(const nt_complex *c, size_t capacity, nt_batch *batch);

/* Finds the groups of complex vertex v, which the batch has. */
void nt_find_groups(const nt_complex *c, nt_batch *batch, size_t v);

/* Finds the groups of all vertices that have a triangle without a frame, in the order of triangles: every such triangle
 * takes the orientation of the first group that reaches it. At the other vertices it leaves NT_WRITTEN. */
void nt_find_groups_in_order(const nt_complex *c, nt_batch *all);

/* Numbers the groups of a batch from 0 in the order in which they begin. Those that are written are none. */
void nt_number_groups(nt_batch *batch);

/* Lists the members of a batch's groups, in the memory of across. */
void nt_list_members(nt_batch *batch);

#endif
