/* SPDX-License-Identifier: MIT */
/*
 * Ranges and items: each is handed out once, whatever the counts.
 */
#include "test.h"
#include <stdatomic.h>
#include "base/parallel.h"

enum { MOST = 64 };

typedef struct ranges {
	size_t begin[MOST], end[MOST];
	unsigned calls[MOST];
	atomic_uint faults;
} ranges;

static void note_range(void *context, size_t begin, size_t end, unsigned slot)
{
	ranges *r = context;
	if (slot >= MOST) {
		r->faults++;
		return;
	}
	r->begin[slot] = begin;
	r->end[slot] = end;
	r->calls[slot]++;
}

TEST(ranges_follow_one_another)
{
	static const size_t counts[] = {0, 1, 2, 3, 7, 8, 63, 64, 65, 1000, SIZE_MAX};
	for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
		for (unsigned threads = 0; threads <= MOST; threads = threads < 5 ? threads + 1 : threads * 2)
			for (size_t grain = 0; grain < 12; grain += 5) {
				ranges r = {0};
				nt_parallel_ranges(threads, counts[i], grain, note_range, &r);
				const unsigned slots = nt_parallel_slots(threads, counts[i], grain);
				assert_in_range(slots, 1, threads ? threads : 1);
				assert_int_equal(r.faults, 0);
				size_t next = 0;
				for (unsigned slot = 0; slot < MOST; slot++) {
					assert_int_equal(r.calls[slot], slot < slots);
					if (slot >= slots)
						continue;
					assert_true(r.begin[slot] == next && r.end[slot] >= next);
					assert_true(slots == 1 || r.end[slot] - next >= grain);
					next = r.end[slot];
				}
				assert_true(next == counts[i]);
			}
}

typedef struct items {
	atomic_uint calls[1000];
	atomic_uint inside[MOST];
	size_t count;
	unsigned threads;
	atomic_uint faults;
} items;

static void note_item(void *context, size_t item, unsigned slot)
{
	items *s = context;
	if (item >= s->count || slot >= s->threads || slot >= s->count) {
		s->faults++;
		return;
	}
	s->calls[item]++;
	s->faults += atomic_fetch_add(&s->inside[slot], 1) != 0;
	for (volatile int i = 0; i < 500; i++)
		continue;
	atomic_fetch_sub(&s->inside[slot], 1);
}

TEST(items_come_once_and_slots_one_at_a_time)
{
	static const size_t counts[] = {0, 1, 2, 3, 100, 1000};
	for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
		for (unsigned threads = 1; threads <= 16; threads *= 2) {
			items s = {.count = counts[i], .threads = threads};
			nt_parallel_items(threads, counts[i], note_item, &s);
			for (size_t k = 0; k < 1000; k++)
				assert_int_equal(s.calls[k], k < counts[i]);
			assert_int_equal(s.faults, 0);
		}
}
