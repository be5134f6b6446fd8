/* SPDX-License-Identifier: MIT */
/*
 * The largest of many numbers: see largest.h. The loop is vectorised by the compiler (Makefile: lanes).
 */
#include "base/largest.h"

#include "base/parallel.h"

enum { GRAIN = 1 << 18, MOST_RANGES = 64 }; /* numbers per thread below which threads do not pay */

typedef struct search {
	const uint32_t *values;
	uint32_t largest[MOST_RANGES];
} search;

static void search_range(void *context, size_t begin, size_t end, unsigned slot)
{
	search *s = context;
	uint32_t largest = 0;
	for (size_t i = begin; i < end; i++)
		largest = s->values[i] > largest ? s->values[i] : largest;
	s->largest[slot] = largest;
}

uint32_t nt_largest(const uint32_t *values, size_t count, unsigned threads)
{
	search s = {.values = values};
	/* asking how many processors there are is a system call */
	threads = count < 2 * GRAIN ? 1 : nt_thread_count(threads);
	threads = threads < MOST_RANGES ? threads : MOST_RANGES;
	nt_parallel_ranges(threads, count, GRAIN, search_range, &s);
	uint32_t largest = 0;
	for (unsigned slot = 0; slot < nt_parallel_slots(threads, count, GRAIN); slot++)
		largest = s.largest[slot] > largest ? s.largest[slot] : largest;
	return largest;
}
