/* SPDX-License-Identifier: MIT */
/*
 * The vertices that are not settled by their sums: pinches, edges with three triangles, triangles without a
 * frame between orientations, directions that are on one side of no axis, hubs. The steps are those of the
 * scalar definition, but at these vertices only:
 *
 *   collect   corners of complex vertices, sorted by vertex and then by triangle
 *
 * and then for a few vertices at a time, so that all of it stays in the first-level cache:
 *
 *   pair      edges of triangles that meet at the vertex                            complex_groups.c
 *   groups    corners of one orientation that hang together by such edges           complex_groups.c
 *   sums      a group that is all there is of its orientation has the record        complex_solve.c
 *   solve     the corners of other groups, in lanes                                 corners.h
 *   average   and write                                                             complex_solve.c
 *
 * A triangle without a frame takes the orientation of the first group that reaches it, wherever that is. Nothing else
 * depends on the order of all corners; where there are such triangles and both orientations, all vertices are paired and
 * grouped at once, in that order.
 *
 * Time is linear in corners but for directions that really are antiparallel: there every member of a group may have
 * a sum of its own.
 */
#include "tangent/fast/complex.h"

#include <string.h>
#include "tangent/fast/complex_groups.h"
#include "tangent/fast/complex_solve.h"

/* Numbers the vertices as they come up and counts their corners. */
static void count_corners(nt_complex *c, uint32_t *counts)
{
	const nt_fast *fast = c->fast;
	uint32_t numbers = 0;
	for (size_t t = nt_next_complex(c, 0); t < fast->triangle_count; t = nt_next_complex(c, t + 1)) {
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&fast->triangles, t, 1, copy);
		c->any |= (fast->flags[t] & NT_TRIANGLE_ANY) != 0;
		for (size_t k = 0; k < 3; k++) {
			uint32_t *state = &nt_fast_record(fast, c->orient, v[k])->state;
			if ((*state & (NT_RESULT_COMPLEX | NT_RESULT_NUMBERED)) == NT_RESULT_COMPLEX)
				*state |= NT_RESULT_NUMBERED | numbers++;
			const uint32_t number = nt_complex_number(c, v[k]);
			if (number != NT_NONE)
				counts[number]++;
		}
	}
}

/* Corners go to their vertices; `at` [vertex_count] is where the next one of each goes. */
static void sort_corners(const nt_complex *c, uint32_t *at)
{
	const nt_fast *fast = c->fast;
	size_t count = 0;
	for (size_t t = nt_next_complex(c, 0); t < fast->triangle_count; t = nt_next_complex(c, t + 1)) {
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&fast->triangles, t, 1, copy);
		for (size_t k = 0; k < 3; k++) {
			const uint32_t number = nt_complex_number(c, v[k]);
			if (number == NT_NONE)
				continue;
			if (c->order)
				c->order[count++] = at[number];
			c->corners[at[number]++] = (uint32_t)(4 * t + k);
		}
	}
}

static nmtan_status collect(nt_complex *c)
{
	c->begin = nt_borrowed_alloc(c->memory, c->vertex_count + 2, sizeof *c->begin);
	if (!c->begin)
		return NMTAN_ERROR_MEMORY;
	/* counted two places ahead: filling then moves each begin to where it belongs */
	uint32_t *at = c->begin + 1;
	memset(c->begin, 0, (c->vertex_count + 2) * sizeof *c->begin);
	count_corners(c, at + 1);
	for (size_t v = 1; v <= c->vertex_count; v++) {
		c->most = at[v] > c->most ? at[v] : c->most;
		at[v] += at[v - 1];
	}
	c->corner_count = at[c->vertex_count];
	c->corners = nt_borrowed_alloc(c->memory, c->corner_count, sizeof *c->corners);
	/* without a second orientation there is nothing to choose */
	const bool ordered = c->any && c->fast->records[0] && c->fast->records[1];
	if (ordered)
		c->order = nt_borrowed_alloc(c->memory, c->corner_count, sizeof *c->order);
	if (!c->corners || (ordered && !c->order))
		return NMTAN_ERROR_MEMORY;
	sort_corners(c, at);
	return NMTAN_OK;
}

/* As many vertices as have NT_BATCH corners together, from vertex v on; one that has more is a batch of its own. Returns
 * the first vertex behind. */
static size_t take_vertices(const nt_complex *c, size_t v, nt_batch *b)
{
	b->first = c->begin[v];
	b->corners = c->corners + b->first;
	do
		v++;
	while (v < c->vertex_count && c->begin[v + 1] - b->first <= NT_BATCH);
	b->count = c->begin[v] - b->first;
	return v;
}

static nmtan_status solve_vertices(const nt_complex *c)
{
	const size_t most = c->most > NT_BATCH ? c->most : NT_BATCH;
	const bool quads = c->fast->triangles.cuts;
	nt_batch b;
	nt_corner *results = quads ? nt_borrowed_alloc(c->memory, most, sizeof *results) : NULL;
	if (!nt_batch_alloc(c, c->order && c->corner_count > most ? c->corner_count : most, &b) || (quads && !results))
		return NMTAN_ERROR_MEMORY;
	uint32_t *const groups = b.group;
	if (c->order) {
		b.corners = c->corners;
		b.count = (uint32_t)c->corner_count;
		nt_find_groups_in_order(c, &b);
		memset(c->order, 0xff, c->corner_count * sizeof *c->order); /* now the numbers of groups */
	}
	nmtan_status status = NMTAN_OK;
	for (size_t v = 0, end; v < c->vertex_count && !status; v = end) {
		end = take_vertices(c, v, &b);
		if (c->order) {
			b.group = groups + b.first;
			nt_number_groups(c, &b, c->order);
		} else {
			for (size_t i = v; i < end; i++)
				nt_pair_vertex(c, &b, c->begin[i], c->begin[i + 1]);
			nt_find_groups(c, &b);
		}
		for (size_t i = v; i < end && !c->more; i++)
			nt_write_sums(c, &b, c->begin[i] - b.first, c->begin[i + 1] - b.first);
		nt_list_members(&b);
		status = nt_solve_batch(c, &b, results);
	}
	return status;
}

nmtan_status nt_fast_complex(nt_fast *fast, const nt_kernels *kernels, size_t complex_count, nt_borrowed *memory)
{
	nt_complex c = {.fast = fast, .kernels = kernels, .memory = memory, .vertex_count = complex_count};
	c.orient = !fast->records[0];
	c.more = fast->wants_more || fast->triangles.cuts;
	c.waiting = nt_borrowed_alloc(memory, fast->vertex_count, sizeof *c.waiting);
	if (!c.waiting)
		return NMTAN_ERROR_MEMORY;
	memset(c.waiting, 0, fast->vertex_count * sizeof *c.waiting);
	const nmtan_status status = collect(&c);
	return status ? status : solve_vertices(&c);
}
