/* SPDX-License-Identifier: MIT */
/*
 * MikkTSpace, fast: the bytes of mikktspace_scalar.c at the speed of memory. The passes in order, with
 * what they cost on a clean mesh of a million triangles in 512-bit vectors (see tests/bench/core.c):
 *
 *   1 weld       hash every vertex's row, find equal ones                  topology/weld.c
 *   2 cut        quads become triangles
 *   3 adjacency  count the corners of each vertex, make places for them    topology/adjacency.c
 *   4 accumulate frames and weights of 16 triangles at a time, added to
 *                the records of their vertices in triangle order           kernel_accumulate.h
 *   5 settle     16 vertices at a time: is the record the result?          kernel_settle.h
 *   6 write      every corner gets its vertex's result                     fast_write.c
 *   7 complex    the other vertices: pairs, groups, averages               complex.c
 *   8 late       degenerate triangles copy a neighbour's corner             fast_write.c
 *
 * Where neighbouring triangles have vertices far apart there is no step 3, step 4 writes corners down in bins
 * of vertices, and step 5 adds up and settles one bin after the other (bins.h).
 *
 * Groups are not looked at before step 5, because nearly every vertex has one for each orientation;
 * what that saves is the point of this file.
 *
 * Threads own ranges of triangles. A vertex belongs to the first range that touches it; later ranges
 * put their contributions aside and these are added afterwards in order, so that every sum is in triangle
 * order whatever the number of threads.
 *
 * Scratch lives in the output until step 6 where it fits.
 */
#include "tangent/fast.h"

#include <pthread.h>
#include <string.h>
#include "base/clock.h"
#include "base/cpu.h"
#include "base/parallel.h"
#include "topology/corners.h"

/* Starting a thread costs more than it saves with fewer triangles. */
static const nt_fast_plan usual = {.grain = 65536};

/* Vertices of a range whose records are only cleared. */
enum { RECORD_GRAIN = 65536 };

static const nt_kernels *kernels_for(nmtan_isa isa)
{
#if defined(__x86_64__)
	if (isa == NMTAN_ISA_AVX512)
		return &nt_kernels_avx512;
	if (isa == NMTAN_ISA_AVX2)
		return &nt_kernels_avx2;
#endif
	(void)isa;
	return &nt_kernels_baseline;
}

/* 2 */

static size_t count_triangles(const nmtan_mesh *mesh)
{
	size_t count = mesh->face_count;
	for (size_t face = 0; mesh->face_sizes && face < mesh->face_count; face++)
		count += mesh->face_sizes[face] == 4;
	return count;
}

/* Triangles of a mesh with quads: their corners, vertices, and which are second halves. */
static nmtan_status cut_faces(nt_fast *fast, const uint32_t *corner_ids)
{
	const nmtan_mesh *mesh = fast->solve->mesh;
	uint32_t *corners = nt_scratch_alloc(fast->solve->scratch, fast->triangle_count, 3 * sizeof *corners);
	uint32_t *ids = nt_scratch_alloc(fast->solve->scratch, fast->triangle_count, 3 * sizeof *ids);
	if (!corners || !ids)
		return NMTAN_ERROR_MEMORY;
	size_t first = 0, t = 0;
	for (size_t face = 0; face < mesh->face_count; first += mesh->face_sizes[face++]) {
		uint32_t cut[2][3];
		const unsigned count = nt_face_triangles(mesh, face, first, cut);
		for (unsigned half = 0; half < count; half++, t++) {
			fast->flags[t] = half ? NT_TRIANGLE_SECOND : 0;
			for (int k = 0; k < 3; k++) {
				corners[3 * t + (size_t)k] = cut[half][k];
				ids[3 * t + (size_t)k] = corner_ids[cut[half][k]];
			}
		}
	}
	fast->corners = corners;
	fast->ids = ids;
	return NMTAN_OK;
}

static nmtan_status make_triangles(nt_fast *fast, const nt_weld *weld)
{
	fast->rows = weld->rows;
	fast->vertex_count = weld->count;
	fast->flags = nt_scratch_alloc(fast->solve->scratch, fast->triangle_count, 1);
	if (!fast->flags)
		return NMTAN_ERROR_MEMORY;
	if (fast->triangle_count != fast->solve->mesh->face_count)
		return cut_faces(fast, weld->ids);
	memset(fast->flags, 0, fast->triangle_count);
	fast->ids = weld->ids;
	return NMTAN_OK;
}

/* Contiguous ranges of triangles; halves of a quad stay together. */
static nmtan_status make_ranges(nt_fast *fast, unsigned count)
{
	size_t *bounds = nt_scratch_alloc(fast->solve->scratch, count + 1, sizeof *bounds);
	if (!bounds)
		return NMTAN_ERROR_MEMORY;
	for (unsigned r = 0; r <= count; r++) {
		bounds[r] = fast->triangle_count / count * r + fast->triangle_count % count * r / count;
		while (bounds[r] < fast->triangle_count && fast->flags[bounds[r]] & NT_TRIANGLE_SECOND)
			bounds[r]++;
	}
	fast->ranges = (nt_triangle_ranges){count, bounds};
	return NMTAN_OK;
}

/* 4 */

static void clear_records(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	nt_record *records = context;
	for (size_t v = begin; v < end; v++)
		records[v] = (nt_record){0, 0, 0, NT_STATE_BASE | NT_STATE_ALL};
}

static bool make_record(nt_fast *fast, int orient, unsigned threads)
{
	nt_record *records = nt_scratch_alloc(fast->solve->scratch, fast->vertex_count, sizeof *records);
	if (!records)
		return false;
	if (!fast->bins.cursors)
		nt_parallel_ranges(threads, fast->vertex_count, RECORD_GRAIN, clear_records, records);
	if (fast->wants_more) {
		nt_record_more *more = nt_scratch_alloc(fast->solve->scratch, fast->vertex_count, sizeof *more);
		if (!more)
			return false;
		memset(more, 0, fast->vertex_count * sizeof *more);
		fast->more[orient] = more;
	}
	fast->records[orient] = records;
	return true;
}

static bool make_deferred(nt_fast *fast)
{
	const unsigned ranges = fast->ranges.count;
	fast->deferred = nt_scratch_alloc(fast->solve->scratch, ranges, sizeof *fast->deferred);
	fast->deferred_count = nt_scratch_alloc(fast->solve->scratch, ranges, sizeof *fast->deferred_count);
	if (!fast->deferred || !fast->deferred_count)
		return false;
	for (unsigned r = 0; r < ranges; r++) {
		fast->deferred_count[r] = 0;
		fast->deferred[r] = nt_scratch_alloc(fast->solve->scratch, fast->adjacency.shared_counts[r],
			sizeof **fast->deferred);
		if (!fast->deferred[r])
			return false;
	}
	return true;
}

typedef struct run {
	nt_fast *fast;
	const nt_kernels *kernels;
	nt_settled *settled;       /* [ranges] */
	nt_adjacency *adjacencies; /* [ranges] each for one bin after the other */
	size_t begun;              /* triangles that the first range has behind it */
	pthread_mutex_t *lock;     /* of fast->records, while triangles are added */
	bool failed;
} run;

static void fill_ranges(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	const run *r = context;
	const size_t *bounds = r->fast->ranges.bounds;
	for (size_t range = begin; range < end; range++) {
		int orient;
		r->kernels->accumulate(r->fast, bounds[range], bounds[range + 1], (unsigned)range, &orient);
	}
}

/* What all ranges share, as it is now; first with the record array that this one misses (-1: none). False: out
 * of memory. */
static bool look_at_records(run *r, int missing, nt_fast *view)
{
	pthread_mutex_lock(r->lock);
	if (missing >= 0 && !r->failed && !r->fast->records[missing])
		r->failed = !make_record(r->fast, missing, 1);
	*view = *r->fast;
	const bool failed = r->failed;
	pthread_mutex_unlock(r->lock);
	return !failed;
}

/* Records of an orientation exist from the first triangle on that has it: most meshes have one only. */
static void accumulate_ranges(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	run *r = context;
	const size_t *bounds = r->fast->ranges.bounds;
	for (size_t range = begin; range < end; range++) {
		nt_fast view;
		int missing = -1;
		for (size_t t = range ? bounds[range] : r->begun; t < bounds[range + 1] && look_at_records(r, missing, &view);)
			t = r->kernels->accumulate(&view, t, bounds[range + 1], (unsigned)range, &missing);
	}
}

/* Contributions that later ranges put aside, in order. */
static void add_deferred(nt_fast *fast)
{
	for (unsigned r = 1; r < fast->ranges.count; r++) {
		for (size_t i = 0; i < fast->deferred_count[r]; i++) {
			const nt_deferred *d = &fast->deferred[r][i];
			nt_record *record = &fast->records[d->orient][d->vertex];
			record->x += d->add.x;
			record->y += d->add.y;
			record->z += d->add.z;
			record->state &= d->add.state;
			if (!fast->wants_more)
				continue;
			nt_record_more *more = &fast->more[d->orient][d->vertex];
			more->x += d->more.x;
			more->y += d->more.y;
			more->z += d->more.z;
			more->angle += d->more.angle;
			more->mag_s += d->more.mag_s;
			more->mag_t += d->more.mag_t;
		}
	}
}

/* Records of the orientations that came up; without a frame anywhere, some that can take notes. */
static bool make_seen_records(nt_fast *fast)
{
	unsigned seen = 0;
	for (unsigned r = 0; r < fast->ranges.count; r++)
		seen |= fast->bins.seen[r];
	if (seen == NT_SEEN_ANY)
		seen = NT_SEEN(0);
	for (int o = 0; o < 2; o++)
		if ((seen & NT_SEEN(o)) && !make_record(fast, o, 1))
			return false;
	return true;
}

static nmtan_status fill_bins(nt_fast *fast, const nt_kernels *kernels)
{
	run r = {.fast = fast, .kernels = kernels};
	nt_parallel_ranges(fast->ranges.count, fast->ranges.count, 1, fill_ranges, &r);
	return make_seen_records(fast) ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

static nmtan_status accumulate(nt_fast *fast, const nt_kernels *kernels)
{
	if (fast->bins.cursors)
		return fill_bins(fast, kernels);
	/* the first range runs up to the first record array it needs, which all threads clear */
	int orient = 0;
	size_t t = kernels->accumulate(fast, 0, fast->ranges.bounds[1], 0, &orient);
	if (t < fast->ranges.bounds[1] && !make_record(fast, orient, fast->ranges.count))
		return NMTAN_ERROR_MEMORY;
	if (fast->ranges.count == 1) {
		while ((t = kernels->accumulate(fast, t, fast->triangle_count, 0, &orient)) < fast->triangle_count)
			if (!make_record(fast, orient, 1))
				return NMTAN_ERROR_MEMORY;
		return NMTAN_OK;
	}
	if (!make_deferred(fast))
		return NMTAN_ERROR_MEMORY;
	pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
	run r = {.fast = fast, .kernels = kernels, .begun = t, .lock = &lock};
	nt_parallel_ranges(fast->ranges.count, fast->ranges.count, 1, accumulate_ranges, &r);
	pthread_mutex_destroy(&lock);
	add_deferred(fast);
	return r.failed ? NMTAN_ERROR_MEMORY : NMTAN_OK;
}

/* 5 */

/* The next triangle from t on that has one of these flags; triangle_count: none. */
size_t nt_fast_next_flagged(const nt_fast *fast, size_t t, unsigned flags)
{
	const uint64_t pattern = 0x0101010101010101u * flags;
	while (t < fast->triangle_count) {
		uint64_t eight;
		if (fast->triangle_count - t >= sizeof eight) {
			memcpy(&eight, fast->flags + t, sizeof eight);
			if (!(eight & pattern)) {
				t += sizeof eight;
				continue;
			}
		}
		for (const size_t stop = t + sizeof eight; t < stop && t < fast->triangle_count; t++)
			if (fast->flags[t] & flags)
				return t;
	}
	return t;
}

/* An "any" triangle that groups of both orientations can reach takes the one that is seeded first. At its
 * vertices order matters, so they are not settled. */
static void mark_contested(nt_fast *fast)
{
	if (!fast->records[0] || !fast->records[1])
		return;
	size_t t = nt_fast_next_flagged(fast, 0, NT_TRIANGLE_ANY);
	for (; t < fast->triangle_count; t = nt_fast_next_flagged(fast, t + 1, NT_TRIANGLE_ANY)) {
		const uint32_t *v = fast->ids + 3 * t;
		if (fast->flags[t] & NT_TRIANGLE_DEGENERATE)
			continue;
		uint32_t empty[2] = {NT_STATE_EMPTY, NT_STATE_EMPTY};
		for (int k = 0; k < 3; k++)
			for (int o = 0; o < 2; o++)
				empty[o] &= fast->records[o][v[k]].state;
		for (int k = 0; !empty[0] && !empty[1] && k < 3; k++)
			fast->records[0][v[k]].state &= ~(uint32_t)NT_STATE_LOCAL;
	}
}

static void settle_blocks(void *context, size_t begin, size_t end, unsigned slot)
{
	const run *r = context;
	nt_settled settled = {0};
	r->kernels->settle(r->fast, &r->fast->adjacency, begin, end, &settled);
	r->settled[slot] = settled;
}

/* Adds up bins and settles their vertices while they are at hand. */
static void settle_bins(void *context, size_t begin, size_t end, unsigned slot)
{
	const run *r = context;
	nt_settled settled = {0};
	nt_adjacency adjacency = r->adjacencies[slot];
	for (size_t bin = begin; bin < end; bin++) {
		nt_bins_add(&r->fast->bins, bin, r->fast->records, &adjacency);
		const size_t first = adjacency.first_vertex / NT_LANES;
		r->kernels->settle(r->fast, &adjacency, first,
			first + (adjacency.vertex_count + NT_LANES - 1) / NT_LANES, &settled);
	}
	r->settled[slot] = settled;
}

static nmtan_status settle(nt_fast *fast, const nt_kernels *kernels, nt_settled *sum)
{
	const unsigned ranges = fast->ranges.count;
	nt_scratch *scratch = fast->solve->scratch;
	run r = {.fast = fast, .kernels = kernels};
	r.settled = nt_scratch_alloc(scratch, ranges, sizeof *r.settled);
	if (!r.settled)
		return NMTAN_ERROR_MEMORY;
	memset(r.settled, 0, ranges * sizeof *r.settled);
	if (fast->bins.cursors) {
		r.adjacencies = nt_scratch_alloc(scratch, ranges, sizeof *r.adjacencies);
		if (!r.adjacencies)
			return NMTAN_ERROR_MEMORY;
		for (unsigned i = 0; i < ranges; i++)
			if (nt_bins_adjacency(&fast->bins, scratch, &r.adjacencies[i]))
				return NMTAN_ERROR_MEMORY;
		nt_parallel_ranges(ranges, fast->bins.count, 1, settle_bins, &r);
	} else {
		mark_contested(fast);
		nt_parallel_ranges(ranges, (fast->vertex_count + NT_LANES - 1) / NT_LANES, 1, settle_blocks,
			&r);
	}
	*sum = (nt_settled){0};
	for (unsigned i = 0; i < ranges; i++) {
		sum->complex_count += r.settled[i].complex_count;
		sum->unusable_count += r.settled[i].unusable_count;
	}
	return NMTAN_OK;
}

/* Tells judge.c which triangles need no look, where all settled results are usable, and repair.c what is welded. */
static void vouch(const nt_fast *fast, bool usable)
{
	nt_vouched *vouched = fast->solve->vouched;
	if (usable)
		*vouched = (nt_vouched){.flags = fast->flags, .positive = NT_TRIANGLE_ORIENT,
			.suspect = NT_TRIANGLE_SUSPECT};
	if (!fast->corners) {
		vouched->welded = fast->ids;
		vouched->welded_count = fast->vertex_count;
	}
}

/* 3 */
static nmtan_status make_places(nt_fast *fast, unsigned bin_bits, nt_record *sums, nt_room *room)
{
	const size_t corners = 3 * fast->triangle_count;
	fast->scattered = bin_bits || nt_is_scattered(fast->ids, corners, fast->vertex_count);
	if (!fast->scattered || fast->wants_more)
		return nt_adjacency_make(fast->ids, &fast->ranges, fast->vertex_count, room, &fast->adjacency);
	if (!bin_bits)
		bin_bits = nt_bins_bits(fast->vertex_count);
	return nt_bins_make(fast->ids, &fast->ranges, fast->vertex_count, bin_bits, sums, room->scratch,
		&fast->bins);
}

/* 1 to 4 */
static nmtan_status sum_up(nt_fast *fast, const nt_kernels *kernels, unsigned ranges, unsigned bin_bits)
{
	const nt_solve *solve = fast->solve;
	const nmtan_mesh *mesh = solve->mesh;
	/* the output lends its bytes, to the sums of binned corners if there are going to be any: rows at
	 * random are better off in the large pages of the scratch. A sparse output is not filled, so that
	 * its pages need not exist: there the caller lends what it fills from the records. */
	const bool lends_sums = !fast->sparse && !fast->wants_more && solve->corner_count == 3 * fast->triangle_count &&
		mesh->indices && (bin_bits || nt_is_scattered(mesh->indices, solve->corner_count, mesh->vertex_count));
	nt_room room = fast->sparse
		? nt_room_over(solve->lent, solve->lent_bytes, solve->scratch)
		: nt_room_over(solve->tangents,
			lends_sums ? 0 : solve->corner_count * 4 * sizeof(float), solve->scratch);
	nt_weld weld;
	const double begin = solve->timing ? nt_seconds() : 0;
	nmtan_status status = nt_weld_mesh(mesh, solve->corner_count, ranges, &room, &weld);
	if (solve->passed)
		solve->passed(solve->user, NT_PART_ATTRIBUTES);
	if (solve->timing)
		solve->timing->weld += nt_seconds() - begin;
	if (!status)
		status = make_triangles(fast, &weld);
	if (!status)
		status = make_ranges(fast, ranges);
	if (!status)
		status = make_places(fast, bin_bits, lends_sums ? (nt_record *)solve->tangents : NULL, &room);
	return status ? status : accumulate(fast, kernels);
}

static nmtan_status solve_as(nt_fast *fast, const nt_solve *solve, bool sparse, const nt_fast_plan *plan)
{
	const nt_kernels *kernels = kernels_for(solve->isa);
	*fast = (nt_fast){.solve = solve, .sparse = sparse, .triangle_count = count_triangles(solve->mesh)};
	fast->wants_more = solve->bitangents || solve->magnitudes;
	/* what the lanes have no place for goes by the definition: other thresholds split most groups, and
	 * beyond the limits numbers do not fit the entries */
	if (solve->threshold_cos != -1.0f || 3 * fast->triangle_count >= NT_ADJACENCY_LIMIT ||
		solve->mesh->vertex_count >= NT_WELD_LIMIT)
		return NMTAN_ERROR_TOO_LARGE;

	const unsigned ranges = nt_parallel_slots(solve->threads, fast->triangle_count, plan->grain);
	nmtan_status status = sum_up(fast, kernels, ranges, plan->bin_bits);
	if (status)
		return status;
	if (!fast->records[0] && !fast->records[1]) {
		fast->sparse = false;
		nt_fast_write_defaults(fast);
		return NMTAN_OK;
	}

	nt_settled settled;
	if ((status = settle(fast, kernels, &settled)))
		return status;
	fast->sparse = fast->sparse && settled.unusable_count == 0;
	nt_fast_write(fast);
	if (settled.complex_count > 0 && (status = nt_fast_complex(fast, settled.complex_count)))
		return status;
	if (solve->vouched)
		vouch(fast, settled.unusable_count == 0);
	/* late triangles copy corners, which must have been written */
	if (fast->sparse && nt_fast_next_flagged(fast, 0, NT_TRIANGLE_LATE) < fast->triangle_count)
		nt_fast_write_rest(fast);
	return nt_fast_write_late(fast);
}

nmtan_status nt_fast_solve(nt_fast *fast, const nt_solve *solve, bool sparse)
{
	return solve_as(fast, solve, sparse, &usual);
}

nmtan_status nt_mikktspace_fast_as(const nt_solve *solve, const nt_fast_plan *plan)
{
	nt_fast fast;
	const nmtan_status status = solve_as(&fast, solve, false, plan);
	return status == NMTAN_ERROR_TOO_LARGE ? nt_mikktspace_scalar(solve) : status;
}

nmtan_status nt_mikktspace_fast(const nt_solve *solve)
{
	return nt_mikktspace_fast_as(solve, &usual);
}
