/* SPDX-License-Identifier: MIT */
/*
 * The weld of an indexed mesh of up to 32 768 vertices on one thread. Here a table of 16-bit numbers takes the
 * place of the sieve's bitmaps (weld_sieve.c). A hash has one place in it, which belongs to the vertex that comes
 * first; those that find it taken are candidates, 11 to 20 of a hundred vertices by chance alone. They are found and
 * looked at in loops of few instructions and without branches, which could not be predicted:
 *
 *   load   rows and hashes, four at a time (weld_four.h)
 *   seek   the candidates
 *   part   those that have the whole hash of the first one from the others. Equal vertices have one place, so the
 *          others can only be equal to each other
 *
 * The others seek once more, by bits of the hash that were not used yet; the few that are left go to the table of rows
 * (weld_table.c). 3273 vertices take 3.2 ns each (AMD EPYC, one thread), and 4.6 by the sieve. Memory: 11 to 14
 * bytes a vertex beside its row.
 */
#include "topology/weld_four.h"
#include "topology/weld_parts.h"

/* Vertices loaded before they seek. */
enum { BATCH = 64 };

/* In `firsts`: nobody is. */
#define NOBODY UINT16_MAX

/* Candidates for which there is room. More are no chance: the table is at most half full. */
static size_t most_candidates(size_t count)
{
	return count / 4 + 64;
}

typedef struct few {
	const nt_weld_row *rows;
	uint16_t *firsts;
	uint32_t *hashes;  /* [count] */
	uint32_t *list;    /* candidates; then those who are equal, first << 16 | vertex */
	uint32_t *others;
	size_t equal_count, other_count;
	unsigned used_bits, bits; /* of the hash: those above that were used, and log2 of the places */
} few;

static inline uint16_t *place_of(const few *f, uint32_t vertex)
{
	return &f->firsts[f->hashes[vertex] << f->used_bits >> (32 - f->bits)];
}

/* Adds the candidates among `items`, NULL: from `begin` on, to a list of `count`; returns how many it has then. */
static inline __attribute__((always_inline)) size_t seek(const few *given, const uint32_t *items, size_t begin,
	size_t end, size_t count)
{
	const few f = *given; /* a copy, which no store changes */
	for (size_t i = begin; i < end; i++) {
		const uint32_t vertex = items ? items[i] : (uint32_t)i;
		uint16_t *place = place_of(&f, vertex);
		const uint16_t first = *place;
		*place = first == NOBODY ? (uint16_t)vertex : first;
		f.list[count] = vertex;
		count += first != NOBODY;
	}
	return count;
}

/* Parts the candidates from `begin` on. */
static void part(few *given, size_t begin, size_t end)
{
	few f = *given;
	f.other_count = 0;
	for (size_t i = begin; i < end; i++) {
		const uint32_t vertex = f.list[i], first = *place_of(&f, vertex);
		const bool equal = f.hashes[first] == f.hashes[vertex];
		f.list[f.equal_count] = first << 16 | vertex;
		f.equal_count += equal;
		f.others[f.other_count] = vertex;
		f.other_count += !equal;
	}
	*given = f;
}

static void clear(few *f, unsigned used_bits, unsigned bits)
{
	f->used_bits = used_bits;
	f->bits = bits;
	memset(f->firsts, 0xff, sizeof *f->firsts << bits);
}

/* Rows, and candidates of all vertices. */
static nt_weld_outcome load_and_seek(const nt_welder *w, few *f, size_t *candidate_count)
{
	const size_t most = most_candidates(w->item_count);
	size_t count = 0;
	nt_weld_flags unordered = {0};
	for (size_t begin = 0, end; begin < w->item_count && count <= most; begin = end) {
		end = w->item_count - begin < BATCH ? w->item_count : begin + BATCH;
		unordered |= nt_weld_load_some(w->mesh, begin, end, w->rows, f->hashes);
		count = seek(f, NULL, begin, end, count);
	}
	*candidate_count = count;
	return count > most ? NT_WELD_MANY : nt_weld_ordered(unordered) ? NT_WELD_DONE : NT_WELD_LEFT;
}

/* Who only has the same hash as who is first is one of the others. */
static void keep_equal(few *f)
{
	size_t kept = 0;
	for (size_t i = 0; i < f->equal_count; i++) {
		const uint32_t vertex = f->list[i] & UINT16_MAX, first = f->list[i] >> 16;
		if (nt_weld_same(&f->rows[vertex], &f->rows[first]))
			f->list[kept++] = f->list[i];
		else
			f->others[f->other_count++] = vertex;
	}
	f->equal_count = kept;
}

static bool make_few(nt_welder *w, few *f, unsigned bits)
{
	if (!nt_weld_grow_rows(w, w->item_count + 1))
		return false;
	const size_t places = sizeof *f->firsts << bits, hashes = w->item_count * sizeof *f->hashes;
	const size_t listed = (most_candidates(w->item_count) + BATCH) * sizeof *f->list;
	char *memory = nt_borrowed_alloc(w->memory, places + hashes + 2 * listed, 1);
	if (!memory)
		return false;
	*f = (few){.rows = w->rows, .firsts = (uint16_t *)memory, .hashes = (uint32_t *)(memory + places),
		.list = (uint32_t *)(memory + places + hashes),
		.others = (uint32_t *)(memory + places + hashes + listed)};
	clear(f, 0, bits);
	return true;
}

static bool number_vertices(nt_welder *w, const few *f)
{
	w->row_count = w->item_count;
	if (!nt_weld_list(w, f->others, f->other_count, 1))
		return false;
	if (f->equal_count > 0 && !w->numbers && !nt_weld_number_own(w))
		return false;
	for (size_t i = 0; i < f->equal_count; i++)
		nt_weld_rename(w, f->list[i] & UINT16_MAX, f->list[i] >> 16);
	return true;
}

nt_weld_outcome nt_weld_few(nt_welder *w)
{
	const unsigned bits = nt_weld_bits_for(2 * w->item_count);
	few f;
	size_t count;
	if (!make_few(w, &f, bits))
		return NT_WELD_NO_MEMORY;
	const nt_weld_outcome outcome = load_and_seek(w, &f, &count);
	if (outcome != NT_WELD_DONE)
		return outcome;
	part(&f, 0, count);

	/* once more, with other bits */
	const size_t begin = f.equal_count;
	const unsigned next_bits = nt_weld_bits_for(8 * f.other_count);
	clear(&f, bits, next_bits < bits ? next_bits : bits);
	count = seek(&f, f.others, 0, f.other_count, begin);
	part(&f, begin, count);
	keep_equal(&f);
	return number_vertices(w, &f) ? NT_WELD_DONE : NT_WELD_NO_MEMORY;
}
