/* SPDX-License-Identifier: MIT */
/*
 * MikkTSpace, fast: the bytes of mikktspace.c at the speed of memory. At nearly every vertex all triangles of
 * one orientation are one group. So their sum is made first, 32 triangles at a time, and only then is it checked
 * whether the definition's groups would give the same; where they may not, they are found.
 *
 *   1 weld        hash every vertex's row, find equal ones                 topology/weld.c
 *   2 cut         quads become triangles
 *   3 adjacency   count the corners of each vertex, make their places      topology/adjacency.c
 *   4 accumulate  frames and weights of 32 triangles at a time, added to   accumulate.h
 *                 the records of vertices in triangle order                records.c
 *   5 settle      16 vertices at a time: is the record the result?         settle.h
 *   6 write       every corner gets its vertex's result                    write.c
 *   7 complex     the other vertices: pairs, groups, averages              complex.c
 *   8 copies      degenerate triangles copy a neighbour's corner           write.c
 *
 * Step 4 takes about half of the time on a clean mesh. If neighbouring triangles have vertices far apart, there is no
 * step 3, step 4 writes corners down in bins of vertices, and step 5 adds up and settles one bin after the other
 * (bins.h). Threads own ranges of triangles, and every sum is in triangle order whatever their number.
 *
 * Words of these files:
 *
 *   record      the sum of a welded vertex over its corners of one orientation; from step 5 on its result
 *   any         of a triangle, after MikkTSpace's flag: its UVs have no area, and it joins groups of either orientation
 *   undecided   an "any" triangle that groups of both orientations can reach: it takes that of the first
 *   fan         the corners of a vertex that hang together by shared edges
 *   hub         a vertex of too many corners for step 3 to give them places
 *   settled     a vertex whose records are its results: each is one fan, and its directions cannot be antiparallel
 *   complex     a vertex that is not settled; hubs are complex
 *   suspect     a triangle whose corners are not known to be good (nt_known): repair and split look at each
 *   sparse      a solve that writes the corners of suspects only; the others' tangents are those of their records
 *   scattered   a mesh whose neighbouring triangles have vertices far apart
 */
#include "tangent/fast/fast.h"

#include <assert.h>
#include <string.h>
#include "base/cpu.h"
#include "base/deadline.h"
#include "base/parallel.h"
#include "tangent/fast/parts.h"
#include "topology/corners.h"

/* Each thread has cursors of its own for all vertices, which are then gone over together: the more threads, the more
 * triangles each must have. Two need fewer: their halves take 10 to 18 % more processor time than the whole. */
static const nt_fast_plan usual = {.grain = 65536, .least_two = 30000, .least_borrowed_bytes = 65536,
	.small = true, .most_narrow = NT_NARROW_LIMIT};

typedef struct run {
	nt_fast *fast;
	const nt_kernels *kernels;
	nt_settled *settled;       /* [ranges] */
	nt_bin *bins;              /* [ranges] each for one after the other */
} run;

/* 1 and 2: weld, cut */

static nmtan_status weld(const nt_fast *fast, unsigned ranges, nt_fast_memory *memory, nt_weld *result)
{
	const nt_solve *solve = fast->solve;
	const double begin = solve->timing ? nt_seconds() : 0;
	const nmtan_status status = nt_weld_mesh(solve->mesh, solve->corner_count, ranges, memory->rows,
		&memory->borrowed, result);
	if (solve->timing)
		solve->timing->weld += nt_seconds() - begin;
	return status;
}

static unsigned count_ranges(const nt_fast *fast, const nt_fast_plan *plan)
{
	const unsigned ranges = nt_parallel_slots(fast->solve->threads, fast->triangle_count, plan->grain);
	const bool two = fast->solve->threads > 1 && plan->least_two && fast->triangle_count >= plan->least_two;
	return ranges == 1 && two ? 2 : ranges;
}

/* The mesh as the published sort of edges sees it. */
static nt_welded_mesh welded_mesh(const nt_fast *fast, nt_scratch *scratch)
{
	return (nt_welded_mesh){.triangles = &fast->triangles, .flags = fast->flags,
		.triangle_count = fast->triangle_count,
		.vertex_count = fast->vertex_count, .positions = fast->rows->position,
		.step = sizeof *fast->rows / sizeof *fast->rows->position, .box = fast->box,
		.adjacency = fast->adjacency.cursors && fast->ranges.count == 1 ? &fast->adjacency : NULL,
		.scratch = scratch};
}

/* Says what step 4 notes of the last run. */
static nmtan_status make_tail(nt_fast *fast, nt_borrowed *memory)
{
	const nt_welded_mesh mesh = welded_mesh(fast, fast->solve->scratch);
	const nt_triangle_ranges ranges =
		{.count = nt_sweeps(&fast->ranges) * fast->ranges.count, .bounds = fast->ranges.bounds};
	return fast->solve->sorted ? NMTAN_OK : nt_edge_tail_make(&mesh, &ranges, memory, fast->tail);
}

/* Whether the vertices that make the box are known to have corners. */
static bool is_box_used(const nt_fast *fast)
{
	bool used = true;
	for (int i = 0; i < 6 && used; i++) {
		const uint32_t vertex = fast->tail->extremes[i];
		used = fast->bins.cursors && nt_bins_have_corners(&fast->bins, vertex);
		for (int o = 0; o < 2 && !fast->bins.cursors; o++)
			used |= fast->records[o] && !(fast->records[o][vertex].state & NT_STATE_EMPTY);
	}
	return used;
}

/* Asks what the published sort of edges leaves, in memory that is not in use now. */
static nmtan_status find_unsorted(nt_fast *fast, const nt_borrowed *memory)
{
	/* for each triangle: what is missing would come from the system, fresh each time */
	enum { LEAST_LENT_BYTES = 32 };
	nt_scratch *scratch = fast->solve->scratch, lent;
	const size_t bytes = (size_t)(memory->end - memory->begin);
	const bool is_lent = bytes >= LEAST_LENT_BYTES * fast->triangle_count + LEAST_LENT_BYTES * LEAST_LENT_BYTES;
	if (fast->solve->sorted)
		return NMTAN_OK;
	if (fast->tail->notes && !fast->tail->is_grid_of_used)
		fast->tail->is_grid_of_used = is_box_used(fast);
	if (is_lent) {
		nt_scratch_init(&lent, &scratch->allocator);
		nt_scratch_lend(&lent, memory->begin, bytes);
	}
	const nt_welded_mesh mesh = welded_mesh(fast, is_lent ? &lent : scratch);
	const nmtan_status status = nt_find_unsorted(&mesh, fast->tail, scratch, &fast->unsorted);
	if (is_lent)
		nt_scratch_free(&lent);
	if (fast->unsorted.limit && fast->solve->sorted_instead)
		*fast->solve->sorted_instead = true;
	return status;
}

/*
 * Whether the second half of the triangles goes over the vertices of the first half once more, in their order: quads
 * were cut, and all second halves put behind all first ones. Then a thread does a part of each half, in two sweeps, and
 * hardly shares vertices with others: ogre takes 0.9 of the time on two threads. Asked is whether triangles at the same
 * places of both halves have vertices near each other, and those of later triangles are well ahead: if threads shared
 * most vertices, two sweeps would put aside half as many corners again as one.
 */
static bool is_swept_twice(const nt_fast *fast)
{
	enum { SAMPLES = 64, AHEAD = SAMPLES / 4, LEAST = 36, NEAR = 32 };
	const size_t half = fast->triangle_count / 2;
	const uint32_t reach = (uint32_t)(half / (NEAR / 2)), *const ids = fast->triangles.ids;
	size_t near = 0;
	for (size_t i = 0; i < SAMPLES - AHEAD && !fast->triangles.cuts; i++) {
		const uint32_t *const a = ids + 3 * (half / SAMPLES * i), *const b = a + 3 * half;
		const bool is_ahead = a[3 * (half / SAMPLES * AHEAD)] > a[0] + reach;
		near += is_ahead & ((b[0] - a[0] + reach < 2 * reach) | (b[1] - a[0] + reach < 2 * reach) |
			(b[2] - a[0] + reach < 2 * reach));
	}
	return near >= LEAST && fast->vertex_count > 4 * reach;
}

static nmtan_status prepare(nt_fast *fast, const nt_fast_plan *plan, bool binned, nt_fast_memory *memory)
{
	const unsigned ranges = count_ranges(fast, plan);
	nt_scratch *scratch = fast->solve->scratch;
	nt_weld welded;
	nmtan_status status = weld(fast, ranges, memory, &welded);
	if (status)
		return status;
	fast->rows = welded.rows;
	fast->vertex_count = welded.count;
	fast->triangles.ids = welded.ids;
	status = nt_cut_faces(fast->solve->mesh, fast->triangle_count, scratch, &fast->flags, &fast->triangles);
	if (status)
		return status;
	const bool twice = ranges > 1 && !binned && is_swept_twice(fast);
	status = nt_cut_ranges(fast->flags, fast->triangle_count, ranges * (twice ? 2 : 1), scratch, &fast->ranges);
	fast->ranges.count = ranges;
	fast->ranges.two_sweeps = twice;
	return status;
}

/* 3 and 4: adjacency, accumulate */

/* Directly to the records. */
static nmtan_status add_to_records(nt_fast *fast, const nt_kernels *kernels, const nt_fast_plan *plan,
	nt_fast_memory *memory)
{
	nmtan_status status = nt_adjacency_make(&fast->triangles, &fast->ranges, fast->vertex_count,
		plan->most_places ? plan->most_places : NT_ADJACENCY_PLACES, plan->most_narrow, memory->rows,
		&memory->borrowed, &fast->adjacency);
	if (!status)
		status = make_tail(fast, &memory->borrowed);
	if (status)
		return status;
	fast->scattered = nt_is_scattered(fast->triangles.ids, fast->solve->corner_count, fast->vertex_count);
	status = nt_fast_add(fast, kernels);
	return status ? status : find_unsorted(fast, &memory->borrowed);
}

/* Whether corners go by way of bins: the sums of all of them are as large as the output of triangles. */
static bool is_binned(const nt_fast *fast, unsigned bin_bits)
{
	const nmtan_mesh *mesh = fast->solve->mesh;
	if (fast->wants_more || fast->triangle_count != mesh->face_count)
		return false;
	return bin_bits || (mesh->indices &&
		nt_is_scattered(mesh->indices, fast->solve->corner_count, mesh->vertex_count));
}

static void fill_ranges(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const run *r = context;
	const size_t *bounds = r->fast->ranges.bounds;
	for (size_t range = begin; range < end; range++)
		r->kernels->accumulate(r->fast, bounds[range], bounds[range + 1], (unsigned)range, NULL, NULL);
}

/* By way of bins, which take the place of the adjacency. */
static nmtan_status fill_bins(nt_fast *fast, const nt_kernels *kernels, unsigned bin_bits, nt_fast_memory *memory)
{
	nmtan_status status = nt_bins_make(fast->triangles.ids, &fast->ranges, fast->vertex_count,
		bin_bits ? bin_bits : nt_bins_bits(fast->vertex_count), memory->bin_sums, &memory->borrowed,
		&fast->bins);
	/* sums of bins may lie in the output */
	nt_borrowed *const left = memory->bin_sums ? &memory->none : &memory->borrowed;
	if (!status)
		status = make_tail(fast, left);
	if (status)
		return status;
	fast->scattered = true;
	run r = {.fast = fast, .kernels = kernels};
	nt_parallel_ranges(fast->ranges.count, fast->ranges.count, 1, fill_ranges, &r);
	status = find_unsorted(fast, left);
	if (status)
		return status;
	bool orientations[2];
	nt_bins_orientations(&fast->bins, orientations);
	return nt_fast_place_records(fast, orientations) ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

/* 5: settle */

/* An "any" triangle that groups of both orientations can reach takes the one that is seeded first. At its
 * vertices order matters, so they are not settled. */
static void mark_undecided(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const nt_fast *fast = context;
	nt_record *const a = fast->records[0], *const b = fast->records[1];
	for (size_t first = NT_FLAG_WORD * begin; a && b && first < NT_FLAG_WORD * end; first += NT_FLAG_WORD)
		for (uint64_t any = nt_fast_flagged(fast->flags + first, fast->triangle_count - first,
			NT_TRIANGLE_ANY); any; any &= any - 1) {
			const size_t t = first + (size_t)nt_trailing_zeros(any);
			uint32_t copy[3], here[3], all[2] = {NT_STATE_EMPTY, NT_STATE_EMPTY};
			const uint32_t *v = nt_triangle_vertices(&fast->triangles, t, 1, copy);
			for (int k = 0; k < 3; k++) {
				here[k] = nt_atomic_load(&a[v[k]].state, RELAXED);
				all[0] &= here[k];
				all[1] &= b[v[k]].state;
			}
			/* of other threads some may write the same */
			for (int k = 0; !(all[0] | all[1]) && !(fast->flags[t] & NT_TRIANGLE_DEGENERATE) && k < 3; k++)
				nt_atomic_store(&a[v[k]].state, here[k] & ~(uint32_t)NT_STATE_LOCAL, RELAXED);
		}
}

static void settle_blocks(void *context, size_t begin, size_t end, unsigned thread)
{
	const run *r = context;
	nt_settled settled = {0};
	r->kernels->settle(r->fast, &r->fast->adjacency, r->fast->records, begin, end, &settled);
	r->settled[thread] = settled;
}

/* Adds up bins and settles their vertices while they are in the cache. */
static void settle_bins(void *context, size_t begin, size_t end, unsigned thread)
{
	const run *r = context;
	nt_settled settled = {0};
	nt_bin *bin = &r->bins[thread];
	for (size_t index = begin; index < end; index++) {
		nt_bin_add_up(&r->fast->bins, index, bin);
		const size_t first = bin->adjacency.first_vertex / NT_LANES;
		r->kernels->settle(r->fast, &bin->adjacency, bin->sums, first,
			first + (bin->adjacency.vertex_count + NT_LANES - 1) / NT_LANES, &settled);
	}
	r->settled[thread] = settled;
}

static bool make_bins(run *r, unsigned ranges)
{
	const nt_fast *fast = r->fast;
	const bool needed[2] = {fast->records[0] != NULL, fast->records[1] != NULL};
	r->bins = nt_scratch_alloc(fast->solve->scratch, ranges, sizeof *r->bins);
	for (unsigned i = 0; r->bins && i < ranges; i++)
		if (nt_bin_make(&fast->bins, needed, fast->solve->scratch, &r->bins[i]))
			return false;
	return r->bins;
}

static nmtan_status settle(nt_fast *fast, const nt_kernels *kernels, nt_settled *sum)
{
	const unsigned ranges = fast->ranges.count;
	const size_t words = (fast->triangle_count + NT_FLAG_WORD - 1) / NT_FLAG_WORD;
	*sum = (nt_settled){0};
	if (fast->small) {
		mark_undecided(fast, 0, words, 0);
		kernels->settle(fast, &fast->adjacency, fast->records, 0,
			(fast->vertex_count + NT_LANES - 1) / NT_LANES, sum);
		return NMTAN_OK;
	}
	run r = {.fast = fast, .kernels = kernels};
	r.settled = nt_scratch_alloc(fast->solve->scratch, ranges, sizeof *r.settled);
	if (!r.settled)
		return NMTAN_ERROR_MEMORY;
	memset(r.settled, 0, ranges * sizeof *r.settled);
	if (fast->sparse) {
		fast->open = nt_scratch_alloc(fast->solve->scratch, (fast->vertex_count + NT_LANES - 1) / NT_LANES, 1);
		if (!fast->open)
			return NMTAN_ERROR_MEMORY;
	}
	if (fast->bins.cursors) {
		if (!make_bins(&r, ranges))
			return NMTAN_ERROR_MEMORY;
		nt_parallel_ranges(ranges, fast->bins.count, 1, settle_bins, &r);
	} else {
		nt_parallel_ranges(ranges, words, 1, mark_undecided, fast);
		nt_parallel_ranges(ranges, (fast->vertex_count + NT_LANES - 1) / NT_LANES, 1, settle_blocks,
			&r);
	}
	for (unsigned i = 0; i < ranges; i++) {
		const nt_settled *s = &r.settled[i];
		sum->complex_count += s->complex_count;
		sum->complex_corners += s->complex_corners;
		sum->tangled_count += s->tangled_count;
		sum->tangled_corners += s->tangled_corners;
		sum->most_tangled = s->most_tangled > sum->most_tangled ? s->most_tangled : sum->most_tangled;
	}
	return NMTAN_OK;
}

/* Makes a vertex complex and tangled, if it is not: as if it had no corners. */
static bool unsettle(nt_fast *fast, uint32_t vertex, nt_settled *settled)
{
	const uint32_t state = nt_fast_record(fast, !fast->records[0], vertex)->state;
	const bool complex = state & NT_RESULT_COMPLEX;
	const size_t corners = complex ? state & NT_RESULT_NUMBER : 0;
	if (complex && state & NT_RESULT_TANGLED)
		return false;
	for (int o = 0; o < 2; o++)
		if (fast->records[o])
			nt_fast_record(fast, o, vertex)->state = complex ? state | NT_RESULT_TANGLED
									 : NT_RESULT_COMPLEX | NT_RESULT_TANGLED;
	if (fast->open)
		fast->open[vertex / NT_LANES] = true;
	settled->complex_count += !complex;
	settled->tangled_count++;
	settled->tangled_corners += corners;
	settled->most_tangled = corners > settled->most_tangled ? corners : settled->most_tangled;
	return !complex;
}

/* The ends of edges that the published sort pairs otherwise have to be looked at. */
static nmtan_status unsettle_unsorted(nt_fast *fast, nt_settled *settled)
{
	const nt_unsorted *unsorted = &fast->unsorted;
	const size_t words = fast->vertex_count / 64 + 1;
	uint64_t *unsettled = nt_scratch_alloc(fast->solve->scratch, words, sizeof *unsettled);
	if (!unsettled)
		return NMTAN_ERROR_MEMORY;
	memset(unsettled, 0, words * sizeof *unsettled);
	for (size_t i = 0; i < 2 * unsorted->count; i++) {
		const uint32_t edge = unsorted->edges[i / 2].edge, k = edge % 3;
		const uint32_t vertex = nt_fast_vertex(fast, i % 2 ? edge - k + (k + 1) % 3 : edge);
		if (unsettle(fast, vertex, settled))
			unsettled[vertex / 64] |= (uint64_t)1 << vertex % 64;
	}
	/* their corners are counted */
	for (size_t i = 0; i < 3 * fast->triangle_count; i++) {
		const uint32_t vertex = nt_fast_vertex(fast, i);
		if (!(unsettled[vertex / 64] >> vertex % 64 & 1) || fast->flags[i / 3] & NT_TRIANGLE_DEGENERATE)
			continue;
		uint32_t corners = 0;
		for (int o = 0; o < 2; o++)
			if (fast->records[o])
				corners = ++nt_fast_record(fast, o, vertex)->state & NT_RESULT_NUMBER;
		settled->complex_corners++;
		settled->tangled_corners++;
		settled->most_tangled = corners > settled->most_tangled ? corners : settled->most_tangled;
	}
	return NMTAN_OK;
}

/* 6 to 8: write, complex, copies */

/* Tells tangent/usable.c which triangles need no look, and repair.c what is welded. */
static void tell_known(const nt_fast *fast)
{
	nt_known *known = fast->solve->known;
	*known = (nt_known){.flags = fast->flags, .suspect = NT_TRIANGLE_SUSPECT, .positive = NT_TRIANGLE_ORIENT,
		.doubtful = NT_TRIANGLE_UNCERTAIN, .flat = NT_TRIANGLE_ANY, .degenerate = NT_TRIANGLE_DEGENERATE,
		.judged = (uint8_t)(nt_fast_judges(fast->solve) ? NT_TRIANGLE_COMPLEX : 0),
		.open = known->open, .row_step = fast->record_step * sizeof(nt_record) / sizeof(float),
		.welded = fast->triangles.ids, .welded_count = fast->vertex_count};
	/* a record is x, y, z and, as state, the sign */
	for (int orient = 0; orient < 2; orient++)
		known->rows[orient] = fast->records[orient] ? &fast->records[orient]->x : NULL;
}

static nmtan_status write_results(nt_fast *fast, const nt_kernels *kernels, const nt_settled *settled)
{
	nt_fast_write(fast, settled);
	if (settled->complex_count > 0) {
		nt_borrowed left = nt_fast_left_memory(fast);
		const nmtan_status status = nt_fast_complex(fast, kernels, settled, &left);
		if (status)
			return status;
	}
	if (fast->solve->known)
		tell_known(fast);
	/* these corners are copied from others, which must have been written */
	const size_t count = fast->triangle_count;
	if (fast->sparse && nt_next_flagged(fast->flags, 0, count, NT_TRIANGLE_COPY) < count)
		nt_fast_write_rest(fast);
	if (fast->sparse)
		fast->solve->known->ids = fast->triangles.ids;
	return nt_fast_write_copies(fast);
}

/* The whole */

/* Whether the UVs of all triangles have exactly no area, as those that nobody made: no group begins then. */
static bool is_flat(const nt_fast *fast)
{
	size_t t = 0;
	if (!fast->solve->known || fast->solve->mesh->face_sizes)
		return false;
	const unsigned mask = NT_TRIANGLE_ANY | NT_TRIANGLE_UNCERTAIN;
	while (t < fast->triangle_count && (fast->flags[t] & mask) == NT_TRIANGLE_ANY)
		t++;
	return t == fast->triangle_count;
}

bool nt_fast_can(const nt_solve *solve)
{
	return solve->threshold_cos == -1.0f && solve->mesh->vertex_count < NT_WELD_LIMIT &&
	       3 * nt_triangle_count(solve->mesh, solve->corner_count) < NT_ADJACENCY_LIMIT;
}

/* Steps 1 to 4 of few triangles. */
static nmtan_status add_small(nt_fast *fast, const nt_kernels *kernels, bool *welded)
{
	nt_borrowed none = nt_borrow(NULL, 0, fast->solve->scratch);
	const nmtan_status status = nt_fast_weld_small(fast, welded);
	if (status || !*welded)
		return status;
	nt_fast_add_small(fast, kernels);
	return find_unsorted(fast, &none);
}

/* Steps 1 to 4. */
static nmtan_status add(nt_fast *fast, const nt_kernels *kernels, const nt_fast_plan *plan)
{
	const bool binned = is_binned(fast, plan->bin_bits);
	nt_fast_memory memory;
	nt_fast_plan_memory(fast, binned, plan->least_borrowed_bytes, &memory);

	/* which corners are one vertex, and which triangles each thread does */
	nmtan_status status = prepare(fast, plan, binned, &memory);
	if (status)
		return status;
	/* each vertex's sums over its corners, one for each orientation */
	return binned ? fill_bins(fast, kernels, plan->bin_bits, &memory)
		: add_to_records(fast, kernels, plan, &memory);
}

nmtan_status nt_mikktspace_fast_as(const nt_solve *solve, const nt_fast_plan *plan)
{
	assert(nt_fast_can(solve));
	const nt_kernels *kernels = NT_CPU_TABLE(solve->isa, nt_kernels);
	nt_edge_tail tail;
	tail.notes = NULL; /* the rest is made where there are some: few triangles do not wait for 300 bytes of zeros */
	nt_fast fast = {.solve = solve, .triangle_count = nt_triangle_count(solve->mesh, solve->corner_count),
		.wants_more = solve->bitangents || solve->magnitudes, .sparse = solve->sparse, .tail = &tail};
	bool added = false;
	nmtan_status status = NMTAN_OK;
	if (plan->small && nt_fast_is_small(&fast))
		status = add_small(&fast, kernels, &added);
	if (!status && !added)
		status = add(&fast, kernels, plan);
	if (status)
		return status;
	const bool flat = is_flat(&fast);
	if (flat || (!fast.records[0] && !fast.records[1])) {
		/* what repair will write need not be written now */
		if (!flat || !solve->repair)
			nt_fast_write_defaults(&fast);
		if (flat) {
			tell_known(&fast);
			solve->known->all_flat = true;
		}
		return NMTAN_OK;
	}
	/* sums become results, where the definition would not have split or joined them otherwise */
	nt_settled settled;
	status = settle(&fast, kernels, &settled);
	if (!status && fast.unsorted.count > 0)
		status = unsettle_unsorted(&fast, &settled);
	return status ? status : write_results(&fast, kernels, &settled);
}

nmtan_status nt_mikktspace_fast(const nt_solve *solve)
{
	return nt_mikktspace_fast_as(solve, &usual);
}
