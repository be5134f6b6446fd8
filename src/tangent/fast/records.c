/* SPDX-License-Identifier: MIT */
/*
 * Step 4 of the fast path where vertices are near: corners are added to the records of their vertices at once.
 *
 * Most meshes need records of one orientation only, and which one is known when its first triangle is solved. So
 * a range that needs an array asks for it in the middle of its work: the first that asks allocates it. Each range has a
 * part of it, and clears its own first: vertices are often in the order of triangles, and then these records are in the
 * cache of who adds to them. All that ask help to clear the others.
 *
 * A vertex belongs to the first range that touches it. Later ranges put their contributions aside, and these are
 * added in the end in the order of ranges: every sum is in triangle order, whatever the number of threads. In two
 * sweeps a vertex of several ranges belongs to none of them, and all contributions are put aside but those of the first
 * range in the first sweep.
 */
#include "tangent/fast/parts.h"

#include <string.h>
#include "base/parallel.h"

/* Vertices for which a thread more adds what was put aside. */
enum { GRAIN = 1 << 14 };

/* The records of one orientation. */
typedef struct array {
	nt_record *records;
	nt_record_more *more;   /* NULL: not wanted */
	unsigned *begun;        /* [ranges] atomic: whether somebody clears the part of a range */
	unsigned cleared;       /* atomic: parts that are */
} array;

typedef struct job {
	nt_fast *fast; /* does not change while triangles are added */
	const nt_kernels *kernels;
	size_t record_count;  /* vertices, in whole blocks: settle reads these */
	nt_lock lock;         /* of the scratch, and of who allocates */
	array arrays[2];
	bool failed;
} job;

/* The first record of a range's part, which begins a block: no two parts have a cache line in common. */
static size_t part_begin(const job *j, unsigned range)
{
	const size_t blocks = j->record_count / NT_LANES;
	const unsigned ranges = j->fast->ranges.count;
	return (blocks / ranges * range + blocks % ranges * range / ranges) * NT_LANES;
}

static void clear_part(const job *j, array *a, unsigned range)
{
	const size_t begin = part_begin(j, range), end = part_begin(j, range + 1);
	for (size_t v = begin; v < end; v++)
		memcpy(&a->records[v], &nt_no_record, sizeof nt_no_record);
	if (a->more)
		memset(a->more + begin, 0, (end - begin) * sizeof *a->more);
	(void)nt_atomic_add(&a->cleared, 1, RELEASE);
}

/* Allocates the array if nobody has. False: out of memory. */
static bool make_array(job *j, array *a)
{
	const nt_fast *fast = j->fast;
	nt_scratch *scratch = fast->solve->scratch;
	nt_lock_take(&j->lock);
	if (!a->records && !j->failed) {
		a->records = nt_scratch_alloc(scratch, j->record_count, sizeof *a->records);
		a->begun = nt_scratch_alloc(scratch, fast->ranges.count, sizeof *a->begun);
		if (fast->wants_more)
			a->more = nt_scratch_alloc(scratch, j->record_count, sizeof *a->more);
		j->failed = !a->records || !a->begun || (fast->wants_more && !a->more);
		if (a->begun)
			memset(a->begun, 0, fast->ranges.count * sizeof *a->begun);
	}
	const bool failed = j->failed;
	nt_lock_give(&j->lock);
	return !failed;
}

/* Clears the part of a range, then those that nobody else has begun to clear, and waits for those that have. */
static void clear_array(const job *j, array *a, unsigned range)
{
	const unsigned ranges = j->fast->ranges.count;
	for (unsigned i = 0; i < ranges; i++) {
		const unsigned part = range + i < ranges ? range + i : range + i - ranges;
		if (nt_atomic_add(&a->begun[part], 1, RELAXED) == 0)
			clear_part(j, a, part);
	}
	while (nt_atomic_load(&a->cleared, ACQUIRE) < ranges)
		nt_give_way();
}

/* The nt_record_maker of all ranges. */
static bool get_array(nt_fast *view, int orient, unsigned range, void *context)
{
	job *j = context;
	array *a = &j->arrays[orient];
	if (!make_array(j, a))
		return false;
	clear_array(j, a, range);
	view->records[orient] = a->records;
	view->more[orient] = a->more;
	return true;
}

static void add_ranges(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	job *j = context;
	const size_t *bounds = j->fast->ranges.bounds;
	for (size_t range = begin; range < end; range++) {
		nt_fast view = *j->fast;
		for (; view.sweep < nt_sweeps(&view.ranges); view.sweep++) {
			const size_t at = view.sweep * view.ranges.count + range;
			/* nobody comes before the first range of the first sweep */
			view.deferred = at == 0 ? NULL : j->fast->deferred;
			j->kernels->accumulate(&view, bounds[at], bounds[at + 1], (unsigned)range, get_array, j);
			if (j->fast->deferred && view.sweep == 0)
				j->fast->deferred[range].swept = j->fast->deferred[range].count;
		}
	}
}

static bool make_deferred(nt_fast *fast)
{
	const unsigned ranges = fast->ranges.count;
	fast->deferred = nt_scratch_alloc(fast->solve->scratch, ranges, sizeof *fast->deferred);
	if (!fast->deferred)
		return false;
	for (unsigned r = 0; r < ranges; r++) {
		const size_t most = fast->adjacency.shared_counts[r];
		nt_deferred *d = &fast->deferred[r];
		*d = (nt_deferred){.to = nt_scratch_alloc(fast->solve->scratch, most + 1, sizeof *d->to)};
		d->add = nt_scratch_alloc(fast->solve->scratch, most, sizeof *d->add);
		if (fast->wants_more)
			d->more = nt_scratch_alloc(fast->solve->scratch, most, sizeof *d->more);
		if (!d->to || !d->add || (fast->wants_more && !d->more))
			return false;
	}
	return true;
}

/* Adds what ranges have put aside for vertices [begin, end). */
static void add_deferred(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const nt_fast *fast = context;
	const unsigned ranges = fast->ranges.count;
	for (size_t r = 0; ranges > 1 && r < nt_sweeps(&fast->ranges) * ranges; r++) {
		const nt_deferred *d = &fast->deferred[r % ranges];
		const size_t last = r < ranges ? d->swept : d->count;
		for (size_t i = r < ranges ? 0 : d->swept; i < last; i++) {
			const int orient = (d->to[i] & NT_ENTRY_ORIENT) != 0;
			const uint32_t vertex = d->to[i] & NT_ENTRY_VERTEX;
			if (vertex - begin >= end - begin)
				continue;
			nt_int4 sum;
			memcpy(&sum, &d->add[i], sizeof sum);
			nt_record_add(&fast->records[orient][vertex], sum);
			if (d->more)
				nt_record_more_add(&fast->more[orient][vertex], &d->more[i]);
		}
	}
}

nmtan_status nt_fast_add(nt_fast *fast, const nt_kernels *kernels)
{
	const unsigned ranges = fast->ranges.count;
	if (ranges > 1 && !make_deferred(fast))
		return NMTAN_ERROR_MEMORY;
	job j = {.fast = fast, .kernels = kernels,
		.record_count = (fast->vertex_count + NT_LANES - 1) / NT_LANES * NT_LANES, .lock = NT_LOCK_INIT};
	nt_parallel_ranges(ranges, ranges, 1, add_ranges, &j);
	nt_lock_free(&j.lock);
	if (j.failed)
		return NMTAN_ERROR_MEMORY;
	for (int o = 0; o < 2; o++) {
		fast->records[o] = j.arrays[o].records;
		fast->more[o] = j.arrays[o].more;
	}
	fast->record_step = 1;
	nt_parallel_ranges(ranges, fast->vertex_count, GRAIN, add_deferred, fast);
	return NMTAN_OK;
}
