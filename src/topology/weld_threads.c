/* SPDX-License-Identifier: MIT */
/*
 * The weld by tables (weld_table.c), on one thread or several.
 *
 *   weld     each thread its range of items, by a table of its own, as one does alone
 *   seek     each row of a range in the tables of the ranges before it, which nobody changes any more
 *   number   the rows that no range before has: after all rows of the ranges before, in their order
 *   resolve  items have the number of their row, or of the row that was found
 *
 * The first range's rows keep their numbers. A row is met first in the first range that has it, so numbers are in
 * order of first appearance, whatever the ranges: what one thread makes.
 *
 * The fewer rows the ranges have in common, the more threads gain.
 */
#include "base/parallel.h"
#include "topology/inside.h"

/* In `places`: no range before has the row; then its number, behind the bit. */
#define NEW UINT32_MAX
#define FINAL ((uint32_t)1 << 31)

typedef struct range {
	nt_welder welder;
	size_t begin, done; /* first item, items welded */
	size_t place;       /* rows of all ranges before, welded or not */
	size_t new_count;   /* atomic */
} range;

typedef struct joint {
	nt_welder *w;
	unsigned count;
	range *ranges;    /* [count] */
	uint32_t *places; /* [rows of all ranges] place of an equal row of a range before, or NEW; later its number */
	unsigned sought;  /* range whose rows are sought now */
} joint;

/* Weld */

static void weld_range(void *context, size_t begin, size_t end, unsigned thread)
{
	const joint *j = context;
	(void)thread;
	for (size_t r = begin; r < end; r++)
		j->ranges[r].done = nt_weld_some(&j->ranges[r].welder, j->ranges[r].done);
}

static bool make_ranges(joint *j)
{
	nt_welder *w = j->w;
	j->ranges = nt_scratch_alloc(w->memory->scratch, j->count, sizeof *j->ranges);
	for (unsigned r = 0; r < j->count && j->ranges; r++) {
		const size_t begin = w->item_count / j->count * r, end = w->item_count / j->count * (r + 1);
		range *here = &j->ranges[r];
		*here = (range){.welder = *w, .begin = begin};
		here->welder.item_count = (r + 1 < j->count ? end : w->item_count) - begin;
		here->welder.items = w->items ? w->items + begin : NULL;
		here->welder.first_vertex = begin;
		here->welder.row_guess = w->row_guess / j->count;
		here->welder.numbers = w->numbers + begin;
		here->welder.row_memory = r ? w->memory : w->row_memory;
		/* all rows come behind those of the first range */
		if (!nt_weld_start(&here->welder, r ? 0 : w->row_guess))
			return false;
	}
	return j->ranges;
}

/* Whether all items are welded; where they are not, there is more memory after it. */
static bool are_done(joint *j, bool *failed)
{
	bool done = true;
	for (unsigned r = 0; r < j->count && !*failed; r++) {
		range *here = &j->ranges[r];
		if (here->done == here->welder.item_count)
			continue;
		done = false;
		*failed = !nt_weld_reserve(&here->welder, here->done);
	}
	return done;
}

static bool weld_ranges(joint *j)
{
	bool failed = false;
	do
		nt_parallel_ranges(j->count, j->count, 1, weld_range, j);
	while (!are_done(j, &failed) && !failed);
	return !failed;
}

/* Seek */

/* The places of a batch of rows in the range `in`, for those that are NEW so far. */
static void seek_batch(const range *in, const nt_weld_row *rows, const uint64_t *hashes, size_t count,
	uint32_t *places)
{
	const nt_welder *w = &in->welder;
	const uint32_t number_mask = ((uint32_t)1 << (w->table_bits - 1)) - 1;
	for (size_t i = 0; i < count; i++)
		NT_PREFETCH(&w->table[nt_weld_slot(w, hashes[i])]);
	for (size_t i = 0; i < count; i++) {
		if (places[i] != NEW)
			continue;
		const uint32_t entry = w->table[nt_weld_probe(w, &rows[i], hashes[i])];
		if (entry != NT_WELD_EMPTY)
			places[i] = (uint32_t)in->place + (entry & number_mask);
	}
}

static void seek_rows(void *context, size_t begin, size_t end, unsigned thread)
{
	const joint *j = context;
	range *here = &j->ranges[j->sought];
	size_t new_count = 0;
	(void)thread;
	for (size_t first = begin, count; first < end; first += count) {
		const nt_weld_row *rows = here->welder.rows + first;
		uint32_t *places = j->places + here->place + first;
		uint64_t hashes[NT_WELD_BATCH];
		count = end - first < NT_WELD_BATCH ? end - first : NT_WELD_BATCH;
		for (size_t i = 0; i < count; i++) {
			hashes[i] = nt_weld_hash(&j->w->key, &rows[i]);
			places[i] = NEW;
		}
		for (unsigned r = 0; r < j->sought; r++)
			seek_batch(&j->ranges[r], rows, hashes, count, places);
		for (size_t i = 0; i < count; i++)
			new_count += places[i] == NEW;
	}
	(void)nt_atomic_add(&here->new_count, new_count, RELAXED);
}

static bool seek_all(joint *j)
{
	size_t rows = 0;
	for (unsigned r = 0; r < j->count; r++) {
		j->ranges[r].place = rows;
		rows += j->ranges[r].welder.row_count;
	}
	j->places = nt_borrowed_alloc(j->w->memory, rows, sizeof *j->places);
	if (!j->places)
		return false;
	for (j->sought = 1; j->sought < j->count; j->sought++)
		nt_parallel_ranges(j->count, j->ranges[j->sought].welder.row_count, 1, seek_rows, j);
	return true;
}

/* Number */

static void number_range(void *context, size_t begin, size_t end, unsigned thread)
{
	const joint *j = context;
	(void)thread;
	for (size_t r = begin > 0 ? begin : 1; r < end; r++) {
		const range *here = &j->ranges[r];
		size_t number = j->ranges[0].welder.row_count;
		for (size_t before = 1; before < r; before++)
			number += j->ranges[before].new_count;
		uint32_t *places = j->places + here->place;
		for (size_t i = 0; i < here->welder.row_count; i++)
			if (places[i] == NEW) {
				j->w->rows[number] = here->welder.rows[i];
				places[i] = (uint32_t)number++ | FINAL;
			}
	}
}

static bool number_rows(joint *j)
{
	nt_welder *w = j->w, *first = &j->ranges[0].welder;
	size_t rows = first->row_count;
	for (unsigned r = 1; r < j->count; r++)
		rows += j->ranges[r].new_count;
	if (rows > first->row_capacity && !nt_weld_grow_rows(first, rows))
		return false;
	w->rows = first->rows;
	w->rows_borrowed = first->rows_borrowed;
	w->row_capacity = first->row_capacity;
	w->row_count = rows;
	for (unsigned r = 0; r < j->count; r++)
		w->unordered = w->unordered || j->ranges[r].welder.unordered;
	nt_parallel_ranges(j->count, j->count, 1, number_range, j);
	return true;
}

/* Resolve */

/* Items have got the number of their row in their range. If a range before has the row, it is new in that one, or of
 * the first range. */
static void resolve_items(void *context, size_t begin, size_t end, unsigned thread)
{
	const joint *j = context;
	const size_t first_end = j->ranges[0].welder.item_count, first_count = j->ranges[0].welder.row_count;
	(void)thread;
	begin += first_end;
	end += first_end;
	for (unsigned r = 1; r < j->count; r++) {
		const range *here = &j->ranges[r];
		const size_t here_end = here->begin + here->welder.item_count;
		const uint32_t *places = j->places + here->place;
		for (size_t i = begin > here->begin ? begin : here->begin; i < end && i < here_end; i++) {
			const uint32_t place = places[j->w->numbers[i]];
			j->w->numbers[i] = (place < first_count || place & FINAL ? place : j->places[place]) & ~FINAL;
		}
	}
}

static bool weld_items_threads(nt_welder *w, unsigned ranges)
{
	joint j = {.w = w, .count = nt_parallel_slots(ranges, w->item_count, 1)};
	if (!make_ranges(&j) || !weld_ranges(&j) || !seek_all(&j) || !number_rows(&j))
		return false;
	nt_parallel_ranges(j.count, w->item_count - j.ranges[0].welder.item_count, 1, resolve_items, &j);
	return true;
}

static bool weld_items_alone(nt_welder *w)
{
	if (!nt_weld_start(w, 0))
		return false;
	for (size_t done = 0; (done = nt_weld_some(w, done)) < w->item_count;)
		if (!nt_weld_reserve(w, done))
			return false;
	return true;
}

bool nt_weld_items(nt_welder *w, unsigned ranges)
{
	/* nearly all of this file is left out without threads: 1200 bytes of what is sent to a browser */
	const bool by_threads = !NT_ONE_THREAD && ranges > 1 && w->item_count > 1;
	return by_threads ? weld_items_threads(w, ranges) : weld_items_alone(w);
}
