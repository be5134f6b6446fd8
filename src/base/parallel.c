/* SPDX-License-Identifier: MIT */
/*
 * Parallel ranges: see parallel.h. Range r of n covers [count * r / n, count * (r + 1) / n), so the
 * bounds depend on the request alone, not on how many threads the system grants.
 */
#include "base/parallel.h"

#include "base/compiler.h"

unsigned nt_thread_count(unsigned requested)
{
	return requested ? requested : nt_pool_processors();
}

unsigned nt_parallel_slots(unsigned threads, size_t count, size_t grain)
{
	/* no division for the small meshes that come by the thousand */
	if (threads <= 1 || count / 2 < grain)
		return 1;
	const size_t most = grain ? count / grain : count;
	return most <= 1 ? 1 : most < threads ? (unsigned)most : threads;
}

/* First item of range r: count * r / n without overflow. */
static size_t range_begin(size_t count, unsigned r, unsigned n)
{
	return count / n * r + count % n * r / n;
}

typedef struct range_job {
	void (*body)(void *context, size_t begin, size_t end, unsigned slot);
	void *context;
	size_t count;
	unsigned slots;
} range_job;

static void run_range(void *context, unsigned slot)
{
	const range_job *job = context;
	job->body(job->context, range_begin(job->count, slot, job->slots),
		range_begin(job->count, slot + 1, job->slots), slot);
}

void nt_parallel_ranges(unsigned threads, size_t count, size_t grain,
	void (*body)(void *context, size_t begin, size_t end, unsigned slot), void *context)
{
	const unsigned slots = nt_parallel_slots(threads, count, grain);
	if (slots == 1) {
		body(context, 0, count, 0);
		return;
	}
	range_job job = {body, context, count, slots};
	nt_pool_run(slots, run_range, &job);
}

typedef struct item_job {
	void (*body)(void *context, size_t item, unsigned slot);
	void *context;
	size_t count;
	size_t next; /* atomic */
} item_job;

static void run_items(void *context, unsigned slot)
{
	item_job *job = context;
	for (size_t i; (i = nt_atomic_add(&job->next, 1, RELAXED)) < job->count;)
		job->body(job->context, i, slot);
}

void nt_parallel_items(unsigned threads, size_t count,
	void (*body)(void *context, size_t item, unsigned slot), void *context)
{
	item_job job = {.body = body, .context = context, .count = count};
	nt_pool_run(threads < count ? threads : (unsigned)count, run_items, &job);
}
