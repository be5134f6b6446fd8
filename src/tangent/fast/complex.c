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
 *   sums      a group that is all there is of its orientation has the record        complex_solve.c
 *
 * What is left gathers in batches:
 *
 *   solve     the corners of other groups, in lanes                                 corners.h
 *   average   and write                                                             complex_solve.c
 *
 * A triangle without a frame takes the orientation of the first group that reaches it, wherever that is. Nothing else
 * depends on the order of all corners; where there are such triangles and both orientations, the groups of their
 * vertices are found first, all at once, in that order.
 *
 * Time is linear in corners but for directions that really are antiparallel: there every direction of a group may have
 * a sum of its own.
 */
#include "tangent/fast/complex.h"

#include <string.h>
#include "base/parallel.h"
#include "tangent/fast/complex_solve.h"

/* Vertices for a thread at least. */
enum { GRAIN = 512 };

/* Triangles that are listed before they are gone through, so that what is loaded for them is on its way at the same
 * time; their flags are looked at STEP at a time. */
enum { LISTED = 48, STEP = 8 };

/* Lists triangles from *t on that have a complex vertex. */
static size_t list_triangles(const nt_complex *c, size_t *t, uint32_t list[LISTED + STEP])
{
	const nt_fast *fast = c->fast;
	size_t count = 0;
	while (count < LISTED && (*t = nt_fast_next_flagged(fast, *t, NT_TRIANGLE_COMPLEX)) < fast->triangle_count) {
		const size_t end = fast->triangle_count - *t < STEP ? fast->triangle_count : *t + STEP;
		for (; *t < end; ++*t) {
			list[count] = (uint32_t)*t;
			count += (fast->flags[*t] & NT_TRIANGLE_COMPLEX) != 0;
		}
	}
	for (size_t i = 0; i < count; i++)
		__builtin_prefetch(fast->triangles.ids + nt_triangle_corner(&fast->triangles, list[i], 0));
	for (size_t i = 0; i < count; i++) {
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&fast->triangles, list[i], 1, copy);
		for (size_t k = 0; k < 3; k++)
			__builtin_prefetch(nt_fast_record(fast, c->orient, v[k]), 1);
	}
	return count;
}

/* A corner at a complex vertex, and the vertices after and before it in its triangle. */
typedef struct listed_corner {
	uint32_t corner, vertex, after, before;
} listed_corner;

/* Lists the corners of triangles that are at complex vertices: about half, at random, so that there is no branch. */
static size_t list_corners(const nt_complex *c, const uint32_t *triangles, size_t count,
	listed_corner corners[3 * (LISTED + STEP) + 1])
{
	size_t n = 0;
	for (size_t i = 0; i < count; i++) {
		const uint32_t t = triangles[i];
		const unsigned flags = c->fast->flags[t];
		const uint32_t any = flags / NT_TRIANGLE_ANY % 2 * NT_COMPLEX_ANY, plus = flags % 2 * NT_COMPLEX_PLUS;
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&c->fast->triangles, t, 1, copy);
#pragma GCC unroll 3
		for (uint32_t k = 0; k < 3; k++) {
			corners[n] = (listed_corner){4 * t + k + any + plus, v[k], v[(k + 1) % 3], v[(k + 2) % 3]};
			n += nt_fast_record(c->fast, c->orient, v[k])->state / NT_RESULT_COMPLEX % 2;
		}
	}
	return n;
}

/* Where the next things go. */
typedef struct cursors {
	uint32_t *vertex, *welded, *order, place;
} cursors;

/* A vertex gets its places when it comes up first. */
static inline void place_corner(const nt_complex *c, const listed_corner *corner, cursors *at)
{
	const uint32_t kept = NT_RESULT_SUM | NT_RESULT_TANGLED;
	uint32_t *state = &nt_fast_record(c->fast, c->orient, corner->vertex)->state;
	const uint32_t old = *state;
	uint32_t place = old & NT_RESULT_NUMBER;
	if (!(old & NT_RESULT_PLACED)) {
		*at->vertex++ = at->place | (old & kept);
		*at->welded++ = corner->vertex;
		const uint32_t corners = place;
		place = at->place;
		at->place += corners;
	}
	c->corners[place] = corner->corner;
	c->across[2 * place] = corner->after;
	c->across[2 * place + 1] = corner->before;
	*state = NT_RESULT_COMPLEX | NT_RESULT_PLACED | (old & kept) | (place + 1);
	if (at->order)
		*at->order++ = place;
}

static nmtan_status collect(nt_complex *c, size_t places)
{
	const nt_fast *fast = c->fast;
	c->vertices = nt_borrowed_alloc(c->memory, c->vertex_count + 1, sizeof *c->vertices);
	c->welded = nt_borrowed_alloc(c->memory, c->vertex_count, sizeof *c->welded);
	c->corners = nt_borrowed_alloc(c->memory, places, sizeof *c->corners);
	c->across = nt_borrowed_alloc(c->memory, places, 2 * sizeof *c->across);
	c->group = nt_borrowed_alloc(c->memory, places, sizeof *c->group);
	/* without a second orientation there is nothing to choose */
	const bool ordered = !c->single && nt_fast_next_flagged(fast, 0, NT_TRIANGLE_ANY) < fast->triangle_count;
	if (ordered)
		c->order = nt_borrowed_alloc(c->memory, places, sizeof *c->order);
	if (!c->vertices || !c->welded || !c->corners || !c->across || !c->group || (ordered && !c->order))
		return NMTAN_ERROR_MEMORY;
	cursors at = {c->vertices, c->welded, c->order, 0};
	for (size_t t = 0; t < fast->triangle_count;) {
		uint32_t triangles[LISTED + STEP];
		listed_corner corners[3 * (LISTED + STEP) + 1];
		const size_t count = list_corners(c, triangles, list_triangles(c, &t, triangles), corners);
		for (size_t i = 0; i < count; i++)
			place_corner(c, &corners[i], &at);
	}
	*at.vertex = at.place;
	c->corner_count = ordered ? (size_t)(at.order - c->order) : 0;
	return NMTAN_OK;
}

/* Threads own ranges of vertices but for those that are tangled, which come first: these share a table, and hubs may
 * need memory. */
typedef struct work {
	const nt_complex *c;
	nt_batch *batches; /* [threads] */
	bool tangled;      /* the turn of those that are */
	nmtan_status status;
} work;

static void solve_range(void *context, size_t begin, size_t end, unsigned slot)
{
	work *w = context;
	nt_batch *batch = &w->batches[slot];
	nmtan_status status = NMTAN_OK;
	for (size_t v = begin; v < end && !status; v++) {
		if (nt_is_tangled(w->c, v) == w->tangled) {
			nt_find_groups(w->c, v);
			status = nt_take_vertex(w->c, batch, v);
		} else if (w->tangled && batch->count > 0) {
			/* the corners of a vertex whose turn comes later stay: others do not move over them */
			status = nt_solve_batch(w->c, batch);
		}
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

static nmtan_status solve_vertices(const nt_complex *c)
{
	const unsigned threads = nt_parallel_slots(c->fast->solve->threads, c->vertex_count, GRAIN);
	size_t most = NT_BATCH;
	for (size_t v = 0; c->waiting && v < c->vertex_count; v++) {
		const size_t corners = nt_last_place(c, v) - nt_first_place(c, v);
		most = corners > most ? corners : most;
	}
	work w = {.c = c, .batches = nt_borrowed_alloc(c->memory, threads, sizeof *w.batches), .tangled = true};
	for (unsigned i = 0; w.batches && i < threads; i++)
		if (!nt_batch_make(c, i == 0 ? most : NT_BATCH, &w.batches[i]))
			return NMTAN_ERROR_MEMORY;
	if (!w.batches)
		return NMTAN_ERROR_MEMORY;
	if (c->waiting) {
		forget_waiting(c);
		solve_range(&w, 0, c->vertex_count, 0);
	}
	w.tangled = false;
	if (!w.status)
		nt_parallel_ranges(threads, c->vertex_count, GRAIN, solve_range, &w);
	return w.status;
}

nmtan_status nt_fast_complex(nt_fast *fast, const nt_kernels *kernels, const nt_settled *settled, nt_borrowed *memory)
{
	nt_complex c = {.fast = fast, .kernels = kernels, .memory = memory, .vertex_count = settled->complex_count};
	c.orient = !fast->records[0];
	c.single = !fast->records[!c.orient];
	c.more = fast->wants_more || fast->triangles.cuts;
	if (settled->tangled_count > 0) {
		c.waiting = nt_borrowed_alloc(memory, fast->vertex_count, sizeof *c.waiting);
		if (!c.waiting)
			return NMTAN_ERROR_MEMORY;
	}
	const nmtan_status status = collect(&c, settled->complex_corners);
	if (status)
		return status;
	forget_waiting(&c);
	if (c.order)
		nt_find_groups_in_order(&c);
	return solve_vertices(&c);
}
