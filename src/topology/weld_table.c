/* SPDX-License-Identifier: MIT */
/*
 * Numbers for rows of eight floats, by a table of hashes (inside.h) on one thread.
 *
 * Rows go in batches: first all hashes of the batch and a prefetch of their entries, then the probes. On a
 * mesh of a million vertices the table is larger than the second-level cache, and a probe without the
 * prefetch waits for each entry in turn.
 *
 * NaN equals nothing: each item of a row with a NaN has a row of its own.
 */
#include "topology/inside.h"

typedef struct batch {
	nt_weld_row *rows; /* where they were loaded */
	size_t begin, count;
	uint64_t hashes[NT_WELD_BATCH];
	bool ordered; /* no row holds a NaN */
} batch;

/* An empty table. */
static bool make_table(nt_welder *w, unsigned bits)
{
	w->table = nt_borrowed_alloc(w->memory, (size_t)1 << bits, sizeof *w->table);
	w->table_bits = bits;
	if (w->table)
		memset(w->table, 0xff, sizeof *w->table << bits);
	return w->table;
}

/* A larger table with the same content. */
static bool grow_table(nt_welder *w, unsigned bits)
{
	if (!make_table(w, bits))
		return false;
	const size_t mask = ((size_t)1 << bits) - 1;
	uint64_t hashes[NT_WELD_BATCH];
	for (size_t begin = 0; begin < w->row_count; begin += NT_WELD_BATCH) {
		const size_t left = w->row_count - begin, count = left < NT_WELD_BATCH ? left : NT_WELD_BATCH;
		for (size_t i = 0; i < count; i++) {
			hashes[i] = nt_weld_hash(&w->key, &w->rows[begin + i]);
			NT_PREFETCH_TO_WRITE(&w->table[nt_weld_slot(w, hashes[i])]);
		}
		for (size_t i = 0; i < count; i++) {
			if (w->unordered && !nt_weld_row_ordered(&w->rows[begin + i]))
				continue;
			size_t at = nt_weld_slot(w, hashes[i]);
			while (w->table[at] != NT_WELD_EMPTY)
				at = (at + 1) & mask;
			w->table[at] = nt_weld_entry(w, hashes[i], (uint32_t)(begin + i));
		}
	}
	return true;
}

bool nt_weld_grow_rows(nt_welder *w, size_t capacity)
{
	const bool in_room = nt_borrowed_has(w->row_memory, capacity, sizeof *w->rows);
	nt_weld_row *rows = nt_borrowed_alloc(w->row_memory, capacity, sizeof *rows);
	if (!rows)
		return false;
	if (w->rows)
		memcpy(rows, w->rows, w->row_count * sizeof *rows);
	w->rows_borrowed = in_room;
	w->rows = rows;
	w->row_capacity = capacity;
	return true;
}

/* Room for rows that are loaded but not yet numbered: see next_place(). */
enum { AHEAD = 5 * NT_WELD_BATCH };

/* Rows for which there must be memory, and twice as many entries, before the next batches. */
static size_t rows_soon(const nt_welder *w, size_t row_count)
{
	return row_count + AHEAD < w->item_count ? row_count + AHEAD : w->item_count;
}

static bool is_tight(const nt_welder *w)
{
	const size_t rows = rows_soon(w, w->row_count);
	return rows > w->row_capacity || rows * 2 >= (size_t)1 << w->table_bits;
}

bool nt_weld_start(nt_welder *w, size_t capacity)
{
	const size_t rows = rows_soon(w, w->row_guess);
	return nt_weld_grow_rows(w, (rows > capacity ? rows : capacity) + 1) &&
	       make_table(w, nt_weld_bits_for(2 * rows + 1));
}

bool nt_weld_reserve(nt_welder *w, size_t done)
{
	/* as many rows an item as so far and a sixteenth more, but at least half as many again */
	const double more = (double)w->row_count / (double)done * (double)(w->item_count - done) * 1.0625;
	const size_t least = w->row_count / 2, expected = more < (double)least ? least : (size_t)more;
	const size_t soon = rows_soon(w, w->row_count), rows = rows_soon(w, w->row_count + expected);
	if (soon > w->row_capacity && !nt_weld_grow_rows(w, rows + 1))
		return false;
	return soon * 2 < (size_t)1 << w->table_bits || grow_table(w, nt_weld_bits_for(2 * rows + 1));
}

/* A row, its hash, and its entry on the way. Returns the flags of nt_weld_load(). */
static inline nt_weld_flags load_item(const nt_welder *w, const nmtan_mesh *mesh, size_t vertex, nt_weld_row *row,
	uint64_t *hash)
{
	const nt_weld_flags unordered = nt_weld_load(mesh, vertex, row);
	*hash = nt_weld_hash(&w->key, row);
	NT_PREFETCH_TO_WRITE(&w->table[nt_weld_slot(w, *hash)]);
	return unordered;
}

/* Loads and hashes the rows of a batch to `rows`, and prefetches their entries. */
static void load_batch(const nt_welder *w, size_t begin, nt_weld_row *rows, batch *b)
{
	const size_t left = w->item_count - begin;
	const size_t count = left < NT_WELD_BATCH ? left : NT_WELD_BATCH;
	/* copies, which no store changes */
	const nt_welder local = *w;
	const nmtan_mesh mesh = *w->mesh;
	nt_weld_flags unordered = {0};
	if (local.items)
		for (size_t i = 0; i < count; i++)
			unordered |= load_item(&local, &mesh, local.items[begin + i], &rows[i], &b->hashes[i]);
	else
		for (size_t i = 0; i < count; i++)
			unordered |= load_item(&local, &mesh, local.first_vertex + begin + i, &rows[i], &b->hashes[i]);
	b->rows = rows;
	b->begin = begin;
	b->count = count;
	b->ordered = nt_weld_ordered(unordered);
}

/* Keeps a row that is at its place or behind it. */
static inline uint32_t keep_row(nt_welder *w, const nt_weld_row *row)
{
	nt_weld_row *place = &w->rows[w->row_count];
	if (place != row)
		*place = *row;
	return (uint32_t)w->row_count++;
}

/* The number of a row: that of an equal one, or the next. */
static inline uint32_t find_or_add(nt_welder *w, const nt_weld_row *row, uint64_t hash)
{
	const uint32_t number_mask = ((uint32_t)1 << (w->table_bits - 1)) - 1;
	uint32_t *entry = &w->table[nt_weld_probe(w, row, hash)];
	if (*entry == NT_WELD_EMPTY)
		*entry = nt_weld_entry(w, hash, keep_row(w, row));
	return *entry & number_mask;
}

static void number_batch(nt_welder *w, const batch *b)
{
	nt_welder local = *w; /* a copy, which no store changes */
	uint32_t *const numbers = local.numbers + b->begin;
	for (size_t i = 0; i < b->count; i++)
		numbers[i] = b->ordered || nt_weld_row_ordered(&b->rows[i])
			? find_or_add(&local, &b->rows[i], b->hashes[i])
			: keep_row(&local, &b->rows[i]);
	w->row_count = local.row_count;
	w->unordered = local.unordered || !b->ordered;
}

/* The place into which the batch after `now` is loaded: right behind, so that rows of a mesh without doubles are
 * never moved; once doubles have left a gap before `now`, into the gap, out of the way of the rows that
 * `now` will keep. */
static nt_weld_row *next_place(const nt_welder *w, const batch *now)
{
	nt_weld_row *end = w->rows + w->row_count;
	return now->rows - end >= 2 * NT_WELD_BATCH ? end + NT_WELD_BATCH : now->rows + NT_WELD_BATCH;
}

/* While one batch is numbered, the entries of the next are on their way. */
size_t nt_weld_some(nt_welder *w, size_t item)
{
	batch batches[2];
	load_batch(w, item, w->rows + w->row_count, &batches[0]);
	for (size_t i = 0; item < w->item_count; i ^= 1) {
		batch *now = &batches[i];
		item += now->count;
		if (item < w->item_count)
			load_batch(w, item, next_place(w, now), &batches[i ^ 1]);
		number_batch(w, now);
		if (item < w->item_count && is_tight(w))
			break; /* everything moves: the next batch will be loaded again */
	}
	return item;
}
