/* SPDX-License-Identifier: MIT */
/*
 * Parallel ranges: see parallel.h. Range r of n covers [count * r / n, count * (r + 1) / n), so the
 * bounds depend on the request alone, not on how many threads the system grants.
 */
#include "base/parallel.h"

#include <omp.h>

unsigned nt_thread_count(unsigned requested)
{
	if (requested)
		return requested;
	const int processors = omp_get_num_procs();
	return processors > 0 ? (unsigned)processors : 1;
}

unsigned nt_parallel_slots(unsigned threads, size_t count, size_t grain)
{
	const size_t most = grain ? count / grain : count;
	if (most <= 1)
		return 1;
	return most < threads ? (unsigned)most : threads ? threads : 1;
}

/* First item of range r: count * r / n without overflow. */
static size_t range_begin(size_t count, unsigned r, unsigned n)
{
	return count / n * r + count % n * r / n;
}

void nt_parallel_ranges(unsigned threads, size_t count, size_t grain,
	void (*body)(void *context, size_t begin, size_t end, unsigned slot), void *context)
{
	const unsigned slots = nt_parallel_slots(threads, count, grain);
	if (slots == 1) {
		body(context, 0, count, 0);
		return;
	}
#pragma omp parallel for num_threads(slots) schedule(static, 1)
	for (unsigned slot = 0; slot < slots; slot++)
		body(context, range_begin(count, slot, slots), range_begin(count, slot + 1, slots), slot);
}
