/* SPDX-License-Identifier: MIT */
/*
 * Welding by hash: each row of eight floats is hashed into a table (weld_parts.h). This is the way of one
 * thread; several share a table in weld_threads.c.
 *
 * Rows go in batches: first all hashes of the batch and a prefetch of their entries, then the probes. On a
 * mesh of a million vertices the table is larger than the second-level cache, and a probe without the
 * prefetch waits for each entry in turn.
 *
 * An indexed mesh hashes its vertices, others their corners. NaN equals nothing: each corner of a row
 * with a NaN is a vertex of its own.
 */
#include "base/parallel.h"
#include "topology/weld_parts.h"

typedef struct batch {
	nt_weld_row *rows; /* where they were loaded */
	size_t begin, count;
	uint64_t hashes[NT_WELD_BATCH];
	bool ordered[NT_WELD_BATCH];
} batch;

bool nt_weld_make_table(nt_welder *w, unsigned table_bits, unsigned index_bits)
{
	w->table = nt_room_alloc(w->room, (size_t)1 << table_bits, sizeof *w->table);
	w->table_bits = table_bits;
	w->index_bits = index_bits;
	return w->table;
}

static bool make_table(nt_welder *w, unsigned bits)
{
	if (!nt_weld_make_table(w, bits, bits - 1))
		return false;
	memset(w->table, 0xff, ((size_t)1 << bits) * sizeof *w->table);
	return true;
}

/* A table of four times the size with the same content. */
static bool grow_table(nt_welder *w)
{
	if (!make_table(w, w->table_bits + 2))
		return false;
	const size_t mask = ((size_t)1 << w->table_bits) - 1;
	for (size_t i = 0; i < w->row_count; i++) {
		const nt_weld_row *row = &w->rows[i];
		nt_weld_row copy = *row;
		if (!nt_weld_canonise(&copy))
			continue;
		const uint64_t hash = nt_weld_hash(row);
		size_t at = nt_weld_slot(w, hash);
		while (w->table[at] != NT_WELD_EMPTY)
			at = (at + 1) & mask;
		w->table[at] = nt_weld_entry(w, hash, (uint32_t)i);
	}
	return true;
}

bool nt_weld_grow_rows(nt_welder *w, size_t capacity)
{
	const bool in_room = nt_room_has(w->room, capacity, sizeof *w->rows);
	nt_weld_row *rows = nt_room_alloc(w->room, capacity, sizeof *rows);
	if (!rows)
		return false;
	if (w->rows)
		memcpy(rows, w->rows, w->row_count * sizeof *rows);
	w->rows_in_room = in_room;
	w->rows = rows;
	w->row_capacity = capacity;
	return true;
}

/* Room for rows that are loaded but not yet numbered: see next_place(). */
enum { AHEAD = 5 * NT_WELD_BATCH };

static bool is_tight(const nt_welder *w)
{
	return w->row_count + AHEAD > w->row_capacity ||
	       (w->row_count + AHEAD) * 2 >= (size_t)1 << w->table_bits;
}

static bool reserve(nt_welder *w)
{
	if (w->row_count + AHEAD > w->row_capacity && !nt_weld_grow_rows(w, w->item_count + AHEAD))
		return false;
	return (w->row_count + AHEAD) * 2 < (size_t)1 << w->table_bits || grow_table(w);
}

/* Loads and hashes the rows of a batch to `rows`, and asks for their entries. */
static void load_batch(const nt_welder *w, size_t begin, nt_weld_row *rows, batch *b)
{
	const size_t left = w->item_count - begin;
	b->rows = rows;
	b->begin = begin;
	b->count = left < NT_WELD_BATCH ? left : NT_WELD_BATCH;
	for (size_t i = 0; i < b->count; i++)
		nt_weld_load(w->mesh, nt_weld_vertex(w, begin + i), &rows[i]);
	for (size_t i = 0; i < b->count; i++) {
		b->ordered[i] = nt_weld_canonise(&rows[i]);
		b->hashes[i] = nt_weld_hash(&rows[i]);
		__builtin_prefetch(&w->table[nt_weld_slot(w, b->hashes[i])], 1);
	}
}

/* Keeps a row that is at its place or behind it. */
static uint32_t keep_row(nt_welder *w, const nt_weld_row *row)
{
	nt_weld_row *place = &w->rows[w->row_count];
	if (place != row)
		*place = *row;
	return (uint32_t)w->row_count++;
}

/* The number of a row: that of an equal one, or the next. */
static inline uint32_t find_or_add(nt_welder *w, const nt_weld_row *row, uint64_t hash)
{
	const size_t mask = ((size_t)1 << w->table_bits) - 1;
	const uint32_t number_mask = ((uint32_t)1 << w->index_bits) - 1;
	const uint32_t tag = nt_weld_entry(w, hash, 0);
	for (size_t at = nt_weld_slot(w, hash);; at = (at + 1) & mask) {
		const uint32_t entry = w->table[at];
		if (entry == NT_WELD_EMPTY) {
			const uint32_t number = keep_row(w, row);
			w->table[at] = tag | number;
			return number;
		}
		if ((entry & ~number_mask) == tag &&
			memcmp(&w->rows[entry & number_mask], row, sizeof *row) == 0)
			return entry & number_mask;
	}
}

uint32_t *nt_weld_alloc_numbers(nt_welder *w)
{
	return w->by_corner ? nt_scratch_alloc(w->room->scratch, w->item_count, sizeof *w->numbers)
			    : nt_room_alloc(w->room, w->item_count, sizeof *w->numbers);
}

/* From the first item whose number is not its own, numbers are written down. */
static bool begin_numbers(nt_welder *w, size_t item)
{
	w->numbers = nt_weld_alloc_numbers(w);
	if (!w->numbers)
		return false;
	for (size_t i = 0; i < item; i++)
		w->numbers[i] = (uint32_t)i;
	return true;
}

static bool number_batch(nt_welder *w, const batch *b)
{
	for (size_t i = 0; i < b->count; i++) {
		uint32_t number = NT_WELD_UNORDERED;
		if (b->ordered[i])
			number = find_or_add(w, &b->rows[i], b->hashes[i]);
		else if (w->by_corner)
			number = keep_row(w, &b->rows[i]);
		else
			w->unordered_count++;
		if (!w->numbers && number != b->begin + i && !begin_numbers(w, b->begin + i))
			return false;
		if (w->numbers)
			w->numbers[b->begin + i] = number;
	}
	return true;
}

/* Where the batch after `now` is loaded: right behind, so that rows of a mesh without doubles are
 * never moved; once doubles have left a gap before `now`, into the gap, out of the way of the rows that
 * `now` will keep. */
static nt_weld_row *next_place(const nt_welder *w, const batch *now)
{
	nt_weld_row *end = w->rows + w->row_count;
	return now->rows - end >= 2 * NT_WELD_BATCH ? end + NT_WELD_BATCH : now->rows + NT_WELD_BATCH;
}

/* While one batch is numbered, the entries of the next are on their way. */
static bool weld_items(nt_welder *w)
{
	batch batches[2];
	if (!reserve(w))
		return false;
	load_batch(w, 0, w->rows, &batches[0]);
	for (size_t begin = 0, i = 0; begin < w->item_count; begin += NT_WELD_BATCH, i ^= 1) {
		batch *now = &batches[i], *later = &batches[i ^ 1];
		if (begin + NT_WELD_BATCH < w->item_count)
			load_batch(w, begin + NT_WELD_BATCH, next_place(w, now), later);
		if (!number_batch(w, now))
			return false;
		if (begin + NT_WELD_BATCH < w->item_count && is_tight(w)) {
			/* everything moves: the next batch is loaded again */
			if (!reserve(w))
				return false;
			load_batch(w, begin + NT_WELD_BATCH, w->rows + w->row_count, later);
		}
	}
	return true;
}

typedef struct copying {
	const uint32_t *numbers, *indices;
	uint32_t *ids;
} copying;

static void copy_numbers(void *context, size_t begin, size_t end, unsigned slot)
{
	const copying *job = context;
	(void)slot;
	for (size_t c = begin; c < end; c++)
		job->ids[c] = job->numbers[job->indices[c]];
}

/* Numbers of corners from numbers of vertices; corners with a NaN get rows of their own. */
static const uint32_t *number_corners(nt_welder *w, size_t corner_count, unsigned ranges)
{
	const uint32_t *indices = w->mesh->indices;
	uint32_t *ids = nt_scratch_alloc(w->room->scratch, corner_count, sizeof *ids);
	if (!ids)
		return NULL;
	if (w->unordered_count == 0) {
		nt_parallel_ranges(ranges, corner_count, 1, copy_numbers, &(copying){w->numbers, indices, ids});
		return ids;
	}
	size_t unordered = 0;
	for (size_t c = 0; c < corner_count; c++)
		unordered += w->numbers[indices[c]] == NT_WELD_UNORDERED;
	if (w->row_count + unordered > w->row_capacity && !nt_weld_grow_rows(w, w->row_count + unordered))
		return NULL;
	for (size_t c = 0; c < corner_count; c++) {
		ids[c] = w->numbers[indices[c]];
		if (ids[c] == NT_WELD_UNORDERED) {
			ids[c] = (uint32_t)w->row_count++;
			nt_weld_load(w->mesh, indices[c], &w->rows[ids[c]]);
		}
	}
	return ids;
}

/* Numbers the items on one thread. */
static bool weld_alone(nt_welder *w)
{
	/* corners share vertices, usually six to one: begin small */
	const size_t expected = w->by_corner ? w->item_count / 4 : w->item_count;
	if (!nt_weld_grow_rows(w, expected + AHEAD) ||
		!make_table(w, nt_weld_bits_for(2 * (expected + AHEAD) + 1)) || !weld_items(w))
		return false;
	/* where each corner is its own vertex there is still no index */
	return !w->by_corner || w->numbers || begin_numbers(w, w->item_count);
}

nmtan_status nt_weld_mesh(const nmtan_mesh *mesh, size_t corner_count, unsigned ranges, nt_room *room,
	nt_weld *weld)
{
	/* few of many vertices used: corner by corner, so that time follows the corners */
	const bool by_corner = !mesh->indices || mesh->vertex_count / 2 > corner_count;
	nt_welder w = {.mesh = mesh, .room = room, .by_corner = by_corner};
	w.items = by_corner ? mesh->indices : NULL;
	w.item_count = by_corner ? corner_count : mesh->vertex_count;

	char *const begin = room->begin;
	/* threads compare corners by way of the mesh, not of few rows at hand: two of them do not pay */
	if (ranges > (by_corner ? 2 : 1) ? !nt_weld_items_threads(&w, ranges) : !weld_alone(&w))
		return NMTAN_ERROR_MEMORY;
	weld->ids = by_corner ? w.numbers : !w.numbers ? mesh->indices : number_corners(&w, corner_count, ranges);
	/* tables and numbers of vertices are not needed any more */
	if (w.rows_in_room)
		nt_room_trim(room, w.rows, w.row_count * sizeof *w.rows);
	else
		room->begin = begin;
	weld->rows = w.rows;
	weld->count = w.row_count;
	return weld->ids ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}
