/* SPDX-License-Identifier: MIT */
/*
 * The vertices that are not settled by their sums: pinches, edges with three triangles, triangles without a
 * frame between orientations, directions that are on one side of no axis, hubs. The steps are those of the
 * scalar definition, but at these vertices only:
 *
 *   collect   corners of complex vertices, sorted by vertex and then by triangle
 *   decide    which orientation each triangle without a frame takes: that of the first group that reaches it,
 *             wherever that is. Nothing else depends on the order of all corners    complex_groups.c
 *
 * and then for a few vertices at a time, so that all of it stays in the first-level cache:
 *
 *   pair      edges of triangles that meet at the vertex                            complex_groups.c
 *   groups    corners of one orientation that hang together by such edges           complex_groups.c
 *   solve     corners, in lanes                                                     corners.h
 *   average   and write                                                             complex_solve.c
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
			nt_record *record = nt_fast_record(fast, c->orient, v[k]);
			if (record->state == NT_RESULT_COMPLEX) {
				record->state = NT_RESULT_NUMBERED;
				memcpy(&record->x, &numbers, sizeof numbers);
				numbers++;
			}
			const uint32_t number = nt_complex_number(c, v[k]);
			if (number != NT_NONE)
				counts[number]++;
		}
	}
}

static nmtan_status collect(nt_complex *c)
{
	const nt_fast *fast = c->fast;
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
	if (!c->corners)
		return NMTAN_ERROR_MEMORY;
	for (size_t t = nt_next_complex(c, 0); t < fast->triangle_count; t = nt_next_complex(c, t + 1)) {
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&fast->triangles, t, 1, copy);
		for (size_t k = 0; k < 3; k++) {
			const uint32_t number = nt_complex_number(c, v[k]);
			if (number != NT_NONE)
				c->corners[at[number]++] = (uint32_t)(4 * t + k);
		}
	}
	return NMTAN_OK;
}

/* As many vertices at a time as have NT_BATCH corners together; one that has more is a batch of its own. */
static nmtan_status solve_vertices(const nt_complex *c)
{
	const size_t capacity = c->most > NT_BATCH ? c->most : NT_BATCH;
	const bool quads = c->fast->triangles.cuts;
	nt_batch b;
	nt_corner *results = quads ? nt_borrowed_alloc(c->memory, capacity, sizeof *results) : NULL;
	if (!nt_batch_alloc(c, capacity, &b) || (quads && !results))
		return NMTAN_ERROR_MEMORY;
	nmtan_status status = NMTAN_OK;
	for (size_t v = 0; v < c->vertex_count && !status;) {
		b.first = c->begin[v];
		b.corners = c->corners + b.first;
		do {
			nt_pair_vertex(c, &b, c->begin[v], c->begin[v + 1]);
			v++;
		} while (v < c->vertex_count && c->begin[v + 1] - b.first <= NT_BATCH);
		b.count = c->begin[v] - b.first;
		nt_find_groups(c, &b);
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
	nmtan_status status = collect(&c);
	/* without a second orientation there is nothing to choose */
	if (!status && c.any && fast->records[0] && fast->records[1])
		status = nt_decide_any(&c);
	return status ? status : solve_vertices(&c);
}
