/* SPDX-License-Identifier: MIT */
/*
 * The vertices that are not settled by their sums: pinches, edges with three triangles, triangles without a
 * frame between orientations, directions that are on one side of no axis, hubs. The steps are those of the
 * scalar definition, but at these vertices only:
 *
 *   collect   corners of complex vertices, sorted by vertex and then by triangle: settle has counted them
 *   decide    which orientation triangles without a frame take
 *
 * and then for a few vertices at a time, so that all of it stays in the first-level cache, by several threads:
 *
 *   pair      edges of triangles that meet at the vertex                            complex_groups.c
 *   groups    corners of one orientation that hang together by such edges           complex_groups.c
 *   sums      a group that is all there is of its orientation has the record        complex_solve.c
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
#include "tangent/fast/complex_groups.h"
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

/* Where the next things go. */
typedef struct cursors {
	uint32_t *vertex, *order, place;
} cursors;

/* Vertices get their places as they come up. */
static inline void place_corners(const nt_complex *c, size_t t, cursors *at)
{
	const uint32_t kept = NT_RESULT_SUM | NT_RESULT_TANGLED;
	uint32_t copy[3];
	const uint32_t *v = nt_triangle_vertices(&c->fast->triangles, t, 1, copy);
	for (uint32_t k = 0; k < 3; k++) {
		uint32_t *state = &nt_fast_record(c->fast, c->orient, v[k])->state;
		const uint32_t old = *state;
		if (!(old & NT_RESULT_COMPLEX))
			continue;
		uint32_t place = old & NT_RESULT_NUMBER;
		if (!(old & NT_RESULT_PLACED)) {
			*at->vertex++ = at->place | (old & kept);
			const uint32_t corners = place;
			place = at->place;
			at->place += corners;
		}
		c->corners[place] = (uint32_t)(4 * t) + k;
		*state = NT_RESULT_COMPLEX | NT_RESULT_PLACED | (old & kept) | (place + 1);
		if (at->order)
			*at->order++ = place;
	}
}

static nmtan_status collect(nt_complex *c, size_t places)
{
	const nt_fast *fast = c->fast;
	c->vertices = nt_borrowed_alloc(c->memory, c->vertex_count + 1, sizeof *c->vertices);
	c->corners = nt_borrowed_alloc(c->memory, places, sizeof *c->corners);
	/* without a second orientation there is nothing to choose */
	const bool ordered = !c->single && nt_fast_next_flagged(fast, 0, NT_TRIANGLE_ANY) < fast->triangle_count;
	if (ordered)
		c->order = nt_borrowed_alloc(c->memory, places, sizeof *c->order);
	if (!c->vertices || !c->corners || (ordered && !c->order))
		return NMTAN_ERROR_MEMORY;
	cursors at = {c->vertices, c->order, 0};
	for (size_t t = 0, count; t < fast->triangle_count;) {
		uint32_t list[LISTED + STEP];
		count = list_triangles(c, &t, list);
		for (size_t i = 0; i < count; i++)
			place_corners(c, list[i], &at);
	}
	*at.vertex = at.place;
	c->corner_count = ordered ? (size_t)(at.order - c->order) : 0;
	return NMTAN_OK;
}

/* Finds the groups of vertices that have a triangle without a frame, and thereby the orientation of these triangles. */
static nmtan_status decide(nt_complex *c, size_t places)
{
	nt_batch all = {.corners = c->corners, .group = nt_borrowed_alloc(c->memory, places, sizeof *all.group)};
	const nt_scratch_mark mark = nt_scratch_here(c->memory->scratch);
	const nt_borrowed memory = *c->memory;
	all.across = nt_borrowed_alloc(c->memory, places, 2 * sizeof *all.across);
	if (!all.group || !all.across)
		return NMTAN_ERROR_MEMORY;
	if (c->waiting)
		memset(c->waiting, 0, c->fast->vertex_count * sizeof *c->waiting);
	nt_find_groups_in_order(c, &all);
	c->decided = all.group;
	nt_scratch_back(c->memory->scratch, mark);
	*c->memory = memory;
	return NMTAN_OK;
}

/* Threads own ranges of vertices but for those that are tangled, which wait for the end: these share a table, and
 * hubs may need memory. */
typedef struct work {
	const nt_complex *c;
	nt_batch *batches; /* [threads] */
	bool tangled;      /* the turn of those that are */
	nmtan_status status;
} work;

/* The next vertices of [*v, end) whose turn it is, as many as have NT_BATCH corners together and no place between them
 * without a corner; one that has more is a batch of its own. Moves *v to the first one; returns the one behind all. */
static size_t take_vertices(const work *w, size_t *v, size_t end, nt_batch *b)
{
	const nt_complex *c = w->c;
	while (*v < end && nt_is_tangled(c, *v) != w->tangled)
		++*v;
	size_t behind = *v;
	uint32_t last = b->first = nt_first_place(c, behind);
	while (behind < end && nt_is_tangled(c, behind) == w->tangled && nt_first_place(c, behind) == last &&
		(behind == *v || nt_last_place(c, behind) - b->first <= NT_BATCH))
		last = nt_last_place(c, behind++);
	b->corners = c->corners + b->first;
	b->count = last - b->first;
	return behind;
}

static void prefetch_corners(const nt_complex *c, const nt_batch *b)
{
	const nt_fast *fast = c->fast;
	for (uint32_t i = 0; i < b->count && i < NT_BATCH; i++)
		__builtin_prefetch(fast->solve->tangents +
			4 * nt_triangle_corner(&fast->triangles, b->corners[i] >> 2, b->corners[i] & 3), 1);
}

static void solve_range(void *context, size_t begin, size_t end, unsigned slot)
{
	work *w = context;
	const nt_complex *c = w->c;
	nt_batch *b = &w->batches[slot];
	for (size_t v = begin, behind; v < end && !w->status; v = behind) {
		behind = take_vertices(w, &v, end, b);
		prefetch_corners(c, b);
		for (size_t i = v; i < behind; i++)
			nt_find_groups(c, b, i);
		for (size_t i = v; i < behind && !c->more; i++)
			nt_write_sums(c, b, i);
		nt_number_groups(b);
		nt_list_members(b);
		const nmtan_status status = nt_solve_batch(c, b);
		if (status)
			w->status = status;
	}
}

static nmtan_status solve_vertices(const nt_complex *c)
{
	const unsigned threads = nt_parallel_slots(c->fast->solve->threads, c->vertex_count, GRAIN);
	work w = {.c = c, .batches = nt_borrowed_alloc(c->memory, threads, sizeof *w.batches)};
	for (unsigned i = 0; w.batches && i < threads; i++)
		if (!nt_batch_alloc(c, NT_BATCH, &w.batches[i]))
			return NMTAN_ERROR_MEMORY;
	if (!w.batches)
		return NMTAN_ERROR_MEMORY;
	nt_parallel_ranges(threads, c->vertex_count, GRAIN, solve_range, &w);
	if (!c->waiting)
		return w.status;
	size_t most = 0;
	for (size_t v = 0; v < c->vertex_count; v++) {
		const size_t corners = nt_last_place(c, v) - nt_first_place(c, v);
		most = corners > most ? corners : most;
	}
	if (most > NT_BATCH && !nt_batch_alloc(c, most, &w.batches[0]))
		return NMTAN_ERROR_MEMORY;
	memset(c->waiting, 0, c->fast->vertex_count * sizeof *c->waiting);
	w.tangled = true;
	solve_range(&w, 0, c->vertex_count, 0);
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
	nmtan_status status = collect(&c, settled->complex_corners);
	if (!status && c.order)
		status = decide(&c, settled->complex_corners);
	return status ? status : solve_vertices(&c);
}
