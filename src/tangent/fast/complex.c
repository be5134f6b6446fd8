/* SPDX-License-Identifier: MIT */
/*
 * The vertices that are not settled by their sums: pinches, edges with three triangles, triangles without a
 * frame between orientations, directions that are on one side of no axis, hubs. The steps are those of the
 * scalar definition, but at these vertices only:
 *
 *   collect   corners of complex vertices and the ends of their edges, sorted by vertex and then by triangle: settle
 *             has counted them
 *   decide    which orientation triangles without a frame take                      complex_groups.c
 *
 * and then by several threads, vertex by vertex:
 *
 *   pair      edges of triangles that meet at the vertex                            complex_groups.c
 *   groups    corners of one orientation that hang together by such edges           complex_groups.c
 *   records   a group that is all there is of its orientation has the record        complex_solve.c
 *
 * What is left gathers in batches:
 *
 *   solve     the corners of other groups, in lanes                                 kernel.h
 *   average   and write                                                             complex_solve.c
 *
 * A triangle without a frame takes the orientation of the first group that reaches it, wherever that is. Nothing else
 * depends on the order of all corners; where there are such triangles and both orientations, the groups of their
 * vertices are found first, all at once, in that order.
 *
 * Time is linear in corners but for directions that really are antiparallel: there every direction of a group may have
 * a sum of its own.
 */
#include "tangent/fast/parts.h"

#include <string.h>
#include "base/parallel.h"
#include "tangent/fast/complex.h"

/* Vertices for a thread at least: 70 microseconds. */
enum { GRAIN = 256 };

/* The next free places, by whether the vertex is tangled. */
typedef struct cursors {
	size_t vertex[2];
	uint32_t place[2], *order;
} cursors;

/* Corner k of triangle t, which has vertices v. A complex vertex gets its places when it comes up first. */
static inline void place_corner(const nt_complex *c, size_t t, const uint32_t v[3], unsigned k, cursors *at)
{
	uint32_t *state_at = &nt_fast_record(c->fast, c->orient, v[k])->state, state = *state_at;
	const unsigned flags = c->fast->flags[t];
	if (!(state & NT_RESULT_COMPLEX))
		return;
	if (!(state & NT_RESULT_PLACED)) {
		const unsigned tangled = state / NT_RESULT_TANGLED % 2;
		const size_t vertex = at->vertex[tangled]++;
		const uint32_t place = at->place[tangled];
		c->vertices[vertex] = place | (state & NT_RESULT_SUM);
		c->welded[vertex] = v[k];
		at->place[tangled] += state & NT_RESULT_NUMBER;
		state = (state & ~NT_RESULT_NUMBER) | NT_RESULT_PLACED | place;
	}
	*state_at = state + 1;
	const uint32_t place = state & NT_RESULT_NUMBER;
	c->corners[place] = (4 * (uint32_t)t + k) | flags / NT_TRIANGLE_ANY % 2 * NT_COMPLEX_ANY |
		flags % 2 * NT_COMPLEX_PLUS;
	if (!(state & NT_RESULT_TANGLED)) {
		c->across[2 * place] = v[k < 2 ? k + 1 : 0];
		c->across[2 * place + 1] = v[k > 0 ? k - 1 : 2];
	}
	if (at->order)
		*at->order++ = place;
}

/* Places of which edges and groups are kept: those of plain vertices, then a few tangled ones, or the largest of these.
 * If all groups are found together: all. */
static size_t room_of(const nt_settled *settled, bool ordered)
{
	const size_t plain = settled->complex_corners - settled->tangled_corners;
	const size_t tangled = settled->most_tangled > NT_BATCH ? settled->most_tangled : NT_BATCH;
	const size_t room = plain > tangled ? plain : tangled;
	return ordered || room > settled->complex_corners ? settled->complex_corners : room;
}

static nmtan_status collect(nt_complex *c, const nt_settled *settled)
{
	const nt_fast *fast = c->fast;
	const size_t places = settled->complex_corners;
	/* without a second orientation there is nothing to choose */
	const size_t count = fast->triangle_count;
	const bool ordered = !c->single && nt_next_flagged(fast->flags, 0, count, NT_TRIANGLE_ANY) < count;
	c->room = (uint32_t)room_of(settled, ordered);
	c->vertices = nt_borrowed_alloc(c->memory, c->vertex_count + 1, sizeof *c->vertices);
	c->welded = nt_borrowed_alloc(c->memory, c->vertex_count, sizeof *c->welded);
	c->corners = nt_borrowed_alloc(c->memory, places, sizeof *c->corners);
	c->across = nt_borrowed_alloc(c->memory, c->room, 2 * sizeof *c->across);
	c->group = nt_borrowed_alloc(c->memory, c->room, sizeof *c->group);
	if (ordered)
		c->order = nt_borrowed_alloc(c->memory, places, sizeof *c->order);
	if (!c->vertices || !c->welded || !c->corners || !c->across || !c->group || (ordered && !c->order))
		return NMTAN_ERROR_MEMORY;
	const uint32_t plain = (uint32_t)(places - settled->tangled_corners);
	cursors at = {{0, c->plain_count}, {0, plain}, c->order};
	for (size_t t = 0; (t = nt_next_flagged(fast->flags, t, count, NT_TRIANGLE_COMPLEX)) < count; t++) {
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&fast->triangles, t, 1, copy);
		for (unsigned k = 0; k < 3; k++)
			place_corner(c, t, v, k, &at);
	}
	c->vertices[c->vertex_count] = at.place[1];
	c->corner_count = ordered ? (size_t)(at.order - c->order) : 0;
	return NMTAN_OK;
}

/* Threads own ranges of vertices but for those that are tangled, which come last: these share a table, and hubs may
 * need memory. */
typedef struct work {
	const nt_complex *c;
	nt_batch *batches; /* [threads] */
	nmtan_status status;
} work;

static void solve_range(void *context, size_t begin, size_t end, unsigned thread)
{
	work *w = context;
	nt_batch *batch = &w->batches[thread];
	nmtan_status status = NMTAN_OK;
	for (size_t v = begin; v < end && !status; v++) {
		nt_find_groups(w->c, v);
		status = nt_take_vertex(w->c, batch, v);
	}
	if (!status)
		status = nt_solve_batch(w->c, batch);
	if (status)
		w->status = status;
}

static void forget_waiting(const nt_complex *c)
{
	if (c->waiting)
		memset(c->waiting, 0, c->fast->vertex_count * sizeof *c->waiting);
}

/* Edges and groups of tangled vertices take the place of the others': as many vertices as there is room for are a
 * window, whose places are counted from its first one. */
static nmtan_status solve_tangled(const nt_complex *c, nt_batch *batch)
{
	nt_complex window = *c;
	nmtan_status status = NMTAN_OK;
	for (size_t v = c->plain_count; v < c->vertex_count && !status; v++) {
		if (nt_last_place(&window, v) > c->room) {
			status = nt_solve_batch(&window, batch);
			window.base = nt_first_place(c, v);
			window.corners = c->corners + window.base;
		}
		nt_find_groups(&window, v);
		status = status ? status : nt_take_vertex(&window, batch, v);
	}
	return status ? status : nt_solve_batch(&window, batch);
}

static nmtan_status solve_vertices(const nt_complex *c, size_t most_tangled)
{
	const unsigned threads = nt_parallel_slots(c->fast->solve->threads, c->plain_count, GRAIN);
	const size_t most = most_tangled > NT_BATCH ? most_tangled : NT_BATCH;
	work w = {.c = c, .batches = nt_borrowed_alloc(c->memory, threads, sizeof *w.batches)};
	for (unsigned i = 0; w.batches && i < threads; i++)
		if (!nt_batch_make(c, i == 0 ? most : NT_BATCH, &w.batches[i]))
			return NMTAN_ERROR_MEMORY;
	if (!w.batches)
		return NMTAN_ERROR_MEMORY;
	nt_parallel_ranges(threads, c->plain_count, GRAIN, solve_range, &w);
	if (!w.status && c->waiting) {
		forget_waiting(c);
		w.status = solve_tangled(c, &w.batches[0]);
	}
	return w.status;
}

nmtan_status nt_fast_complex(nt_fast *fast, const nt_kernels *kernels, const nt_settled *settled, nt_borrowed *memory)
{
	nt_complex c = {.fast = fast, .kernels = kernels, .memory = memory, .vertex_count = settled->complex_count,
		.plain_count = settled->complex_count - settled->tangled_count};
	c.orient = !fast->records[0];
	c.single = !fast->records[!c.orient];
	c.more = fast->wants_more || fast->triangles.cuts;
	if (settled->tangled_count > 0) {
		c.waiting = nt_borrowed_alloc(memory, fast->vertex_count, sizeof *c.waiting);
		if (!c.waiting)
			return NMTAN_ERROR_MEMORY;
	}
	const nmtan_status status = collect(&c, settled);
	if (status)
		return status;
	if (c.order) {
		forget_waiting(&c);
		nt_find_groups_in_order(&c);
	}
	return solve_vertices(&c, settled->most_tangled);
}
