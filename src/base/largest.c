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

static void search_range(void *context, size_t begin, size_t end, unsigned slot)
{
	search *s = context;
	four most[4] = {(four){0} - INT32_MAX - 1};
	most[1] = most[2] = most[3] = most[0];
	size_t i = begin;
	for (; end - i >= 16; i += 16)
		for (size_t j = 0; j < 4; j++) {
			four values;
			memcpy(&values, s->values + i + 4 * j, sizeof values);
			most[j] = larger(values ^ (int32_t)half, most[j]);
		}
	const four largest = larger(larger(most[0], most[1]), larger(most[2], most[3]));
	uint32_t result = 0;
	for (size_t j = 0; j < 4; j++)
		result = ((uint32_t)largest[j] ^ half) > result ? (uint32_t)largest[j] ^ half : result;
	for (; i < end; i++)
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
