/* SPDX-License-Identifier: MIT */
/*
 * Parallel ranges: see parallel.h. Range r of n covers [count * r / n, count * (r + 1) / n), so the
 * bounds depend on the request alone, not on how many threads the system grants.
 */
#include "base/parallel.h"

#include <omp.h>
#include <stdbool.h>
#if defined(__SANITIZE_THREAD__)
#include <pthread.h>
#endif

unsigned nt_thread_count(unsigned requested)
{
	if (requested)
		return requested;
	const int processors = omp_get_num_procs();
	return processors > 0 ? (unsigned)processors : 1;
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

#if defined(__SANITIZE_THREAD__)
/* config=tsan: libgomp's barriers are invisible to the sanitiser, which then reports every hand-over between
 * two regions as a race. With threads that it knows it reports real ones only. */
typedef struct range_job {
	void (*body)(void *context, size_t begin, size_t end, unsigned slot);
	void *context;
	size_t begin, end;
	unsigned slot;
} range_job;

static void *run_job(void *argument)
{
	const range_job *job = argument;
	job->body(job->context, job->begin, job->end, job->slot);
	return NULL;
}

static void run_ranges(unsigned slots, size_t count,
	void (*body)(void *context, size_t begin, size_t end, unsigned slot), void *context)
{
	enum { MOST = 64 };
	pthread_t threads[MOST];
	range_job jobs[MOST];
	for (unsigned first = 0; first < slots; first += MOST) {
		const unsigned here = slots - first < MOST ? slots - first : MOST;
		bool started[MOST] = {false};
		for (unsigned i = 0; i < here; i++) {
			const unsigned slot = first + i;
			jobs[i] = (range_job){body, context, range_begin(count, slot, slots),
				range_begin(count, slot + 1, slots), slot};
			started[i] = pthread_create(&threads[i], NULL, run_job, &jobs[i]) == 0;
			if (!started[i])
				run_job(&jobs[i]);
		}
		for (unsigned i = 0; i < here; i++)
			if (started[i])
				pthread_join(threads[i], NULL);
	}
}
#else
static void run_ranges(unsigned slots, size_t count,
	void (*body)(void *context, size_t begin, size_t end, unsigned slot), void *context)
{
#pragma omp parallel for num_threads(slots) schedule(static, 1)
	for (unsigned slot = 0; slot < slots; slot++)
		body(context, range_begin(count, slot, slots), range_begin(count, slot + 1, slots), slot);
}
#endif

void nt_parallel_ranges(unsigned threads, size_t count, size_t grain,
	void (*body)(void *context, size_t begin, size_t end, unsigned slot), void *context)
{
	const unsigned slots = nt_parallel_slots(threads, count, grain);
	if (slots == 1) {
		body(context, 0, count, 0);
		return;
	}
	run_ranges(slots, count, body, context);
}
