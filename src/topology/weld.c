/* SPDX-License-Identifier: MIT */
/*
 * Welding by hash. Each row of eight floats is hashed into an open-addressing table, at most half full;
 * an entry of 4 bytes holds the vertex and, in the bits that the vertex leaves free, a tag of the hash,
 * so that a foreign row is read about once in 2^tag probes.
 *
 * Rows go in batches: first all hashes of the batch and a prefetch of their entries, then the probes. On a
 * mesh of a million vertices the table is larger than the second-level cache, and a probe without the
 * prefetch waits for each entry in turn.
 *
 * An indexed mesh hashes its vertices, others their corners. NaN equals nothing: each corner of a row
 * with a NaN is a vertex of its own.
 */
#include "topology/weld.h"

#include <string.h>
#include "topology/corners.h"

enum { BATCH = 32, ROW_FLOATS = 8 };

#define EMPTY UINT32_MAX
#define UNORDERED UINT32_MAX /* in `numbers`: the row holds a NaN */

typedef struct welder {
	const nmtan_mesh *mesh;
	nt_room *room;
	const uint32_t *items; /* vertex of item i; NULL: i */
	size_t item_count;
	nt_weld_row *rows;
	bool rows_in_room;
	size_t row_capacity, row_count;
	uint32_t *table;
	unsigned table_bits, index_bits;
	uint32_t *numbers; /* [item_count] NULL while number i is i */
	size_t unordered_count;
} welder;

typedef struct batch {
	nt_weld_row *rows; /* where they were loaded */
	size_t begin, count;
	uint64_t hashes[BATCH];
	bool ordered[BATCH];
} batch;

/* Both halves of a 64 by 64 bit product, folded: every input bit reaches every output bit. */
static uint64_t fold(uint64_t a, uint64_t b)
{
	const unsigned __int128 product = (unsigned __int128)a * b;
	return (uint64_t)product ^ (uint64_t)(product >> 64);
}

static uint64_t hash_row(const nt_weld_row *row)
{
	/* digits of pi: numbers of no structure */
	uint64_t words[4];
	memcpy(words, row, sizeof words);
	const uint64_t a = fold(words[0] ^ 0x243f6a8885a308d3u, words[1] ^ 0x13198a2e03707344u);
	const uint64_t b = fold(words[2] ^ 0xa4093822299f31d0u, words[3] ^ 0x082efa98ec4e6c89u);
	return fold(a ^ 0x452821e638d01377u, b ^ 0xbe5466cf34e90c6cu);
}

static void load_row(const nmtan_mesh *mesh, size_t vertex, nt_weld_row *row)
{
	memcpy(row->position, nt_position(mesh, vertex), sizeof row->position);
	memcpy(row->normal, nt_normal(mesh, vertex), sizeof row->normal);
	memcpy(row->texcoord, nt_texcoord(mesh, vertex), sizeof row->texcoord);
}

/* -0 becomes +0, so that equal rows have equal bits; true where no value is NaN. */
static bool canonise_row(nt_weld_row *row)
{
	typedef float float4 __attribute__((vector_size(16)));
	typedef int64_t long2 __attribute__((vector_size(16)));
	float4 values[2];
	memcpy(values, row, sizeof values);
	values[0] += 0.0f;
	values[1] += 0.0f;
	const long2 unordered = (long2)((values[0] != values[0]) | (values[1] != values[1]));
	memcpy(row, values, sizeof values);
	return (unordered[0] | unordered[1]) == 0;
}

static size_t slot_of(const welder *w, uint64_t hash)
{
	return (size_t)(hash >> (64 - w->table_bits));
}

/* The entry of a vertex with that hash: tag above, number below. */
static uint32_t make_entry(const welder *w, uint64_t hash, uint32_t number)
{
	return (uint32_t)(hash >> 4) << w->index_bits | number;
}

static bool make_table(welder *w, unsigned bits)
{
	uint32_t *table = nt_room_alloc(w->room, (size_t)1 << bits, sizeof *table);
	if (!table)
		return false;
	memset(table, 0xff, ((size_t)1 << bits) * sizeof *table);
	w->table = table;
	w->table_bits = bits;
	w->index_bits = bits - 1;
	return true;
}

/* A table of four times the size with the same content. */
static bool grow_table(welder *w)
{
	if (!make_table(w, w->table_bits + 2))
		return false;
	const size_t mask = ((size_t)1 << w->table_bits) - 1;
	for (size_t i = 0; i < w->row_count; i++) {
		const nt_weld_row *row = &w->rows[i];
		nt_weld_row copy = *row;
		if (!canonise_row(&copy))
			continue;
		const uint64_t hash = hash_row(row);
		size_t at = slot_of(w, hash);
		while (w->table[at] != EMPTY)
			at = (at + 1) & mask;
		w->table[at] = make_entry(w, hash, (uint32_t)i);
	}
	return true;
}

static bool grow_rows(welder *w, size_t capacity)
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
enum { AHEAD = 5 * BATCH };

static bool is_tight(const welder *w)
{
	return w->row_count + AHEAD > w->row_capacity ||
	       (w->row_count + AHEAD) * 2 >= (size_t)1 << w->table_bits;
}

static bool reserve(welder *w)
{
	if (w->row_count + AHEAD > w->row_capacity && !grow_rows(w, w->item_count + AHEAD))
		return false;
	return (w->row_count + AHEAD) * 2 < (size_t)1 << w->table_bits || grow_table(w);
}

/* Loads and hashes the rows of a batch to `rows`, and asks for their entries. */
static void load_batch(const welder *w, size_t begin, nt_weld_row *rows, batch *b)
{
	const size_t left = w->item_count - begin;
	b->rows = rows;
	b->begin = begin;
	b->count = left < BATCH ? left : BATCH;
	for (size_t i = 0; i < b->count; i++)
		load_row(w->mesh, w->items ? w->items[begin + i] : begin + i, &rows[i]);
	for (size_t i = 0; i < b->count; i++) {
		b->ordered[i] = canonise_row(&rows[i]);
		b->hashes[i] = hash_row(&rows[i]);
		__builtin_prefetch(&w->table[slot_of(w, b->hashes[i])], 1);
	}
}

/* Keeps a row that is at its place or behind it. */
static uint32_t keep_row(welder *w, const nt_weld_row *row)
{
	nt_weld_row *place = &w->rows[w->row_count];
	if (place != row)
		*place = *row;
	return (uint32_t)w->row_count++;
}

/* The number of a row: that of an equal one, or the next. */
static inline uint32_t find_or_add(welder *w, const nt_weld_row *row, uint64_t hash)
{
	const size_t mask = ((size_t)1 << w->table_bits) - 1;
	const uint32_t number_mask = ((uint32_t)1 << w->index_bits) - 1;
	const uint32_t tag = make_entry(w, hash, 0);
	for (size_t at = slot_of(w, hash);; at = (at + 1) & mask) {
		const uint32_t entry = w->table[at];
		if (entry == EMPTY) {
			const uint32_t number = keep_row(w, row);
			w->table[at] = tag | number;
			return number;
		}
		if ((entry & ~number_mask) == tag &&
			memcmp(&w->rows[entry & number_mask], row, sizeof *row) == 0)
			return entry & number_mask;
	}
}

/* From the first item whose number is not its own, numbers are written down. */
static bool begin_numbers(welder *w, size_t item)
{
	w->numbers = nt_scratch_alloc(w->room->scratch, w->item_count, sizeof *w->numbers);
	if (!w->numbers)
		return false;
	for (size_t i = 0; i < item; i++)
		w->numbers[i] = (uint32_t)i;
	return true;
}

static bool number_batch(welder *w, const batch *b, bool by_corner)
{
	for (size_t i = 0; i < b->count; i++) {
		uint32_t number = UNORDERED;
		if (b->ordered[i])
			number = find_or_add(w, &b->rows[i], b->hashes[i]);
		else if (by_corner)
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
static nt_weld_row *next_place(const welder *w, const batch *now)
{
	nt_weld_row *end = w->rows + w->row_count;
	return now->rows - end >= 2 * BATCH ? end + BATCH : now->rows + BATCH;
}

/* While one batch is numbered, the entries of the next are on their way. */
static bool weld_items(welder *w, bool by_corner)
{
	batch batches[2];
	if (!reserve(w))
		return false;
	load_batch(w, 0, w->rows, &batches[0]);
	for (size_t begin = 0, i = 0; begin < w->item_count; begin += BATCH, i ^= 1) {
		batch *now = &batches[i], *later = &batches[i ^ 1];
		if (begin + BATCH < w->item_count)
			load_batch(w, begin + BATCH, next_place(w, now), later);
		if (!number_batch(w, now, by_corner))
			return false;
		if (begin + BATCH < w->item_count && is_tight(w)) {
			/* everything moves: the next batch is loaded again */
			if (!reserve(w))
				return false;
			load_batch(w, begin + BATCH, w->rows + w->row_count, later);
		}
	}
	return true;
}

/* Numbers of corners from numbers of vertices; corners with a NaN get rows of their own. */
static const uint32_t *number_corners(welder *w, size_t corner_count)
{
	const uint32_t *indices = w->mesh->indices;
	uint32_t *ids = nt_scratch_alloc(w->room->scratch, corner_count, sizeof *ids);
	if (!ids)
		return NULL;
	if (w->unordered_count == 0) {
		for (size_t c = 0; c < corner_count; c++)
			ids[c] = w->numbers[indices[c]];
		return ids;
	}
	size_t unordered = 0;
	for (size_t c = 0; c < corner_count; c++)
		unordered += w->numbers[indices[c]] == UNORDERED;
	if (w->row_count + unordered > w->row_capacity && !grow_rows(w, w->row_count + unordered))
		return NULL;
	for (size_t c = 0; c < corner_count; c++) {
		ids[c] = w->numbers[indices[c]];
		if (ids[c] == UNORDERED) {
			ids[c] = (uint32_t)w->row_count++;
			load_row(w->mesh, indices[c], &w->rows[ids[c]]);
		}
	}
	return ids;
}

/* Where each corner is its own vertex and there is no index. */
static bool number_items(welder *w)
{
	return w->numbers || begin_numbers(w, w->item_count);
}

static unsigned bits_for(size_t entries)
{
	unsigned bits = 8;
	while ((size_t)1 << bits < entries)
		bits++;
	return bits;
}

nmtan_status nt_weld_mesh(const nmtan_mesh *mesh, size_t corner_count, nt_room *room, nt_weld *weld)
{
	/* few of many vertices used: corner by corner, so that time follows the corners */
	const bool by_corner = !mesh->indices || mesh->vertex_count / 2 > corner_count;
	welder w = {.mesh = mesh, .room = room};
	w.items = by_corner ? mesh->indices : NULL;
	w.item_count = by_corner ? corner_count : mesh->vertex_count;

	/* corners share vertices, usually six to one: begin small */
	const size_t expected = by_corner ? corner_count / 4 : w.item_count;
	if (!grow_rows(&w, expected + AHEAD))
		return NMTAN_ERROR_MEMORY;
	const nt_weld_row *first_rows = w.rows;
	char *behind_rows = room->begin;
	if (!make_table(&w, bits_for(2 * (expected + AHEAD) + 1)) || !weld_items(&w, by_corner))
		return NMTAN_ERROR_MEMORY;
	/* tables are not needed any more */
	if (w.rows == first_rows)
		room->begin = behind_rows;

	if (by_corner && !number_items(&w))
		return NMTAN_ERROR_MEMORY;
	weld->ids = by_corner ? w.numbers : !w.numbers ? mesh->indices : number_corners(&w, corner_count);
	if (w.rows_in_room)
		nt_room_trim(room, w.rows, w.row_count * sizeof *w.rows);
	weld->rows = w.rows;
	weld->count = w.row_count;
	return weld->ids ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}
