/* SPDX-License-Identifier: MIT */
/*
 * The largest of many numbers: see largest.h. In vectors, four of them so that none waits for the one before.
 */
#include "base/largest.h"

#include <string.h>
#include "base/parallel.h"

enum { GRAIN = 1 << 18, MOST_RANGES = 64 }; /* numbers per thread below which threads do not pay */

typedef struct search {
	const uint32_t *values;
	uint32_t largest[MOST_RANGES];
} search;

typedef int32_t four __attribute__((vector_size(16)));

/* Unsigned numbers as signed ones of the same order, which SSE2 can compare. */
static const uint32_t half = 0x80000000u;

static inline four larger(four a, four b)
{
	const four mask = a > b;
	return (a & mask) | (b & ~mask);
}

static inline four load_four(const uint32_t *values)
{
	four result;
	memcpy(&result, values, sizeof result);
	return result ^ (int32_t)half;
}

static void search_range(void *context, size_t begin, size_t end, unsigned slot)
{
	search *s = context;
	four most[4] = {(four){0} - INT32_MAX - 1};
	most[1] = most[2] = most[3] = most[0];
	size_t i = begin;
	for (; end - i >= 16; i += 16)
		for (size_t j = 0; j < 4; j++)
			most[j] = larger(load_four(s->values + i + 4 * j), most[j]);
	four largest = larger(larger(most[0], most[1]), larger(most[2], most[3]));
	for (; end - i >= 4; i += 4)
		largest = larger(load_four(s->values + i), largest);
	/* the last ones again, where there are four */
	if (end - begin >= 4)
		largest = larger(load_four(s->values + end - 4), largest);
	uint32_t result = 0;
	for (size_t j = 0; j < 4; j++)
		result = ((uint32_t)largest[j] ^ half) > result ? (uint32_t)largest[j] ^ half : result;
	for (; end - begin < 4 && i < end; i++)
		result = s->values[i] > result ? s->values[i] : result;
	s->largest[slot] = result;
}

uint32_t nt_largest(const uint32_t *values, size_t count, unsigned threads)
{
	search s;
	s.values = values;
	if (count < 2 * GRAIN) {
		search_range(&s, 0, count, 0);
		return s.largest[0];
	}
	threads = nt_thread_count(threads);
	threads = threads < MOST_RANGES ? threads : MOST_RANGES;
	nt_parallel_ranges(threads, count, GRAIN, search_range, &s);
	uint32_t largest = 0;
	for (unsigned slot = 0; slot < nt_parallel_slots(threads, count, GRAIN); slot++)
		largest = s.largest[slot] > largest ? s.largest[slot] : largest;
	return largest;
}
