/* SPDX-License-Identifier: MIT */
/*
 * The weld on several threads. All of them enter their ranges of items into one table, whose entries hold
 * item numbers and are changed by compare-and-swap only. Entries never move, so equal rows meet in one slot,
 * and the least item wins it whoever comes first: numbers do not depend on threads, nor on their timing.
 *
 *   enter    find or make the slot of each item                  all of them, in ranges
 *   mark     the items that own their slot, counted by range
 *   number   owners, from the sum of the counts before a range; their numbers replace them in the table
 *   resolve  the others read their slot
 *
 * Rows are read from the mesh again to be compared; equal ones are usually near. All threads together take 2.3
 * times as long as one does alone (Xeon, 2 processors): a compare-and-swap is dearer than a store.
 */
#include "base/parallel.h"
#include "topology/weld_parts.h"

/* Items by which a slot is asked for before it is read. */
enum { SLOT_AHEAD = 16 };

/* In `numbers` between the passes: a slot, the slot of the item that owns it, a final number. */
#define OWNER ((uint32_t)1 << 30)
#define FINAL ((uint32_t)1 << 31)
#define UNORDERED UINT32_MAX /* the item holds a NaN */

typedef struct weld_job {
	nt_welder *w;
	unsigned ranges;
	size_t *owners;     /* [ranges] */
	size_t entry_limit; /* entries that the table may take */
	size_t entry_count; /* atomic */
	bool unordered;     /* atomic: an item holds a NaN */
} weld_job;

typedef struct batch {
	nt_weld_row rows[NT_WELD_BATCH];
	size_t begin, count;
	uint64_t hashes[NT_WELD_BATCH];
	bool ordered[NT_WELD_BATCH];
} batch;

static void run_pass(weld_job *job, size_t count,
	void (*pass)(void *context, size_t begin, size_t end, unsigned slot))
{
	nt_parallel_ranges(job->ranges, count, 1, pass, job);
}

static void clear_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const weld_job *job = context;
	(void)slot;
	memset(job->w->table + begin, 0xff, (end - begin) * sizeof *job->w->table);
}

/* Enter */

static void load_batch(const nt_welder *w, size_t begin, size_t end, batch *b)
{
	b->begin = begin;
	b->count = end - begin < NT_WELD_BATCH ? end - begin : NT_WELD_BATCH;
	for (size_t i = 0; i < b->count; i++) {
		b->ordered[i] = nt_weld_ordered(nt_weld_load(w->mesh, nt_weld_vertex(w, begin + i), &b->rows[i]));
		b->hashes[i] = nt_weld_hash(&b->rows[i]);
		__builtin_prefetch(&w->table[nt_weld_slot(w, b->hashes[i])], 1);
	}
}

static bool has_row(const nt_welder *w, size_t item, const nt_weld_row *row)
{
	nt_weld_row other;
	nt_weld_load(w->mesh, nt_weld_vertex(w, item), &other);
	return nt_weld_same(&other, row);
}

/* Asks for the rows that the batch's items are going to be compared with. */
static void ask_rows(const nt_welder *w, const batch *b)
{
	const uint32_t number_mask = ((uint32_t)1 << w->index_bits) - 1;
	for (size_t i = 0; i < b->count; i++) {
		const uint32_t entry = __atomic_load_n(&w->table[nt_weld_slot(w, b->hashes[i])], __ATOMIC_RELAXED);
		if (entry == NT_WELD_EMPTY)
			continue;
		const size_t vertex = nt_weld_vertex(w, entry & number_mask);
		__builtin_prefetch(nt_position(w->mesh, vertex));
		__builtin_prefetch(nt_normal(w->mesh, vertex));
		__builtin_prefetch(nt_texcoord(w->mesh, vertex));
	}
}

/* Makes the item the owner unless a lower one is. All entries of a slot have one tag: they compare
 * as their items do. */
static void lower_owner(uint32_t *slot, uint32_t entry, uint32_t mine)
{
	while (mine < entry && !__atomic_compare_exchange_n(slot, &entry, mine, false, __ATOMIC_ACQ_REL,
					__ATOMIC_ACQUIRE))
		continue;
}

/* The slot of a row; adds to *added. */
static uint32_t enter_item(const nt_welder *w, const nt_weld_row *row, uint64_t hash, uint32_t item,
	size_t *added)
{
	const size_t mask = ((size_t)1 << w->table_bits) - 1;
	const uint32_t number_mask = ((uint32_t)1 << w->index_bits) - 1;
	const uint32_t mine = nt_weld_entry(w, hash, item);
	for (size_t at = nt_weld_slot(w, hash);; at = (at + 1) & mask) {
		uint32_t entry = __atomic_load_n(&w->table[at], __ATOMIC_ACQUIRE);
		if (entry == NT_WELD_EMPTY && __atomic_compare_exchange_n(&w->table[at], &entry, mine, false,
						     __ATOMIC_ACQ_REL, __ATOMIC_ACQUIRE)) {
			++*added;
			return (uint32_t)at;
		}
		if (((entry ^ mine) & ~number_mask) == 0 && has_row(w, entry & number_mask, row)) {
			lower_owner(&w->table[at], entry, mine);
			return (uint32_t)at;
		}
	}
}

static void enter_batch(weld_job *job, const batch *b, size_t *added)
{
	const nt_welder *w = job->w;
	for (size_t i = 0; i < b->count; i++) {
		uint32_t slot = UNORDERED;
		if (b->ordered[i])
			slot = enter_item(w, &b->rows[i], b->hashes[i], (uint32_t)(b->begin + i), added);
		else
			__atomic_store_n(&job->unordered, true, __ATOMIC_RELAXED);
		w->numbers[b->begin + i] = slot;
	}
}

/* Stops when the table is full, which entry_count then tells. */
static void enter_range(void *context, size_t begin, size_t end, unsigned slot)
{
	weld_job *job = context;
	const nt_welder *w = job->w;
	batch batches[2];
	(void)slot;
	if (begin < end)
		load_batch(w, begin, end, &batches[0]);
	for (size_t first = begin, i = 0; first < end; first += NT_WELD_BATCH, i ^= 1) {
		size_t added = 0;
		if (first + NT_WELD_BATCH < end)
			load_batch(w, first + NT_WELD_BATCH, end, &batches[i ^ 1]);
		ask_rows(w, &batches[i]);
		enter_batch(job, &batches[i], &added);
		if (__atomic_add_fetch(&job->entry_count, added, __ATOMIC_RELAXED) > job->entry_limit)
			break;
	}
}

/* Enters all items into a table for `expected` rows; false when out of memory. */
static bool enter_items(weld_job *job, size_t expected)
{
	nt_welder *w = job->w;
	/* when the limit is passed each thread may have a batch under way */
	const size_t most = expected + (size_t)job->ranges * NT_WELD_BATCH;
	if (!nt_weld_make_table(w, nt_weld_bits_for(2 * most + 1), nt_weld_bits_for(w->item_count + 1)))
		return false;
	job->entry_limit = expected;
	job->entry_count = 0;
	run_pass(job, (size_t)1 << w->table_bits, clear_range);
	run_pass(job, w->item_count, enter_range);
	return true;
}

/* Mark */

static void mark_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const weld_job *job = context;
	const nt_welder *w = job->w;
	const uint32_t number_mask = ((uint32_t)1 << w->index_bits) - 1;
	size_t owners = 0;
	for (size_t i = begin; i < end; i++) {
		const uint32_t at = w->numbers[i], ahead = w->numbers[i + SLOT_AHEAD < end ? i + SLOT_AHEAD : i];
		__builtin_prefetch(&w->table[ahead == UNORDERED ? 0 : ahead]);
		if (at == UNORDERED) {
			owners++;
		} else if ((w->table[at] & number_mask) == i) {
			w->numbers[i] = at | OWNER;
			owners++;
		}
	}
	job->owners[slot] = owners;
}

/* Number */

static void number_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const weld_job *job = context;
	const nt_welder *w = job->w;
	uint32_t number = 0;
	for (unsigned s = 0; s < slot; s++)
		number += (uint32_t)job->owners[s];
	for (size_t i = begin; i < end; i++) {
		const uint32_t at = w->numbers[i];
		if (!(at & OWNER)) /* a NaN has all bits */
			continue;
		if (at != UNORDERED)
			w->table[at & ~OWNER] = number;
		nt_weld_load(w->mesh, nt_weld_vertex(w, i), &w->rows[number]);
		w->numbers[i] = number++ | FINAL;
	}
}

/* Resolve */

static void resolve_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const nt_welder *w = ((const weld_job *)context)->w;
	(void)slot;
	for (size_t i = begin; i < end; i++) {
		const uint32_t at = w->numbers[i], ahead = w->numbers[i + SLOT_AHEAD < end ? i + SLOT_AHEAD : i];
		__builtin_prefetch(&w->table[ahead & FINAL ? 0 : ahead]);
		w->numbers[i] = at & FINAL ? at & ~FINAL : w->table[at];
	}
}

static bool number_items(weld_job *job)
{
	nt_welder *w = job->w;
	size_t rows = 0;
	run_pass(job, w->item_count, mark_range);
	for (unsigned r = 0; r < job->ranges; r++)
		rows += job->owners[r];
	if (rows > w->row_capacity && !nt_weld_grow_rows(w, rows))
		return false;
	w->row_count = rows;
	run_pass(job, w->item_count, number_range);
	run_pass(job, w->item_count, resolve_range);
	return true;
}

/* A table of the usual size, or, where that was not enough, for as many rows as there are items. */
static bool enter_all(weld_job *job, size_t usual)
{
	nt_room *room = job->w->room;
	char *const begin = room->begin;
	const nt_scratch_mark mark = nt_scratch_here(room->scratch);
	if (!enter_items(job, usual))
		return false;
	if (job->entry_count <= job->entry_limit)
		return true;
	room->begin = begin;
	nt_scratch_back(room->scratch, mark);
	return enter_items(job, job->w->item_count);
}

bool nt_weld_items_threads(nt_welder *w, unsigned ranges)
{
	weld_job job = {.w = w, .ranges = nt_parallel_slots(ranges, w->item_count, 1)};
	job.owners = nt_scratch_alloc(w->room->scratch, job.ranges, sizeof *job.owners);
	if (!job.owners || !nt_weld_grow_rows(w, w->row_guess + 1) || !enter_all(&job, w->row_guess) ||
		!number_items(&job))
		return false;
	w->unordered = job.unordered;
	return true;
}
