/* SPDX-License-Identifier: MIT */
/*
 * What the weld by a table on one thread (weld.c), that on several (weld_threads.c) and the sieve of vertices
 * (weld_sieve.c) share: rows, their hash, entries of the table. For these files only.
 *
 * An entry of 4 bytes holds a number and, in the bits that the number leaves free, a tag of the hash, so that
 * a foreign row is read about once in 2^tag probes. Tables are open-addressing and at most half full.
 */
#ifndef NT_TOPOLOGY_WELD_PARTS_H
#define NT_TOPOLOGY_WELD_PARTS_H

#include <string.h>
#include "topology/corners.h"
#include "topology/weld.h"

/* Rows whose hashes are made, and whose entries are asked for, at a time. */
enum { NT_WELD_BATCH = 32 };

#define NT_WELD_EMPTY UINT32_MAX
#define NT_WELD_TAKEN UINT32_MAX /* in place of the number of a vertex with a NaN: it was given to a corner */

typedef struct nt_welder {
	const nmtan_mesh *mesh;
	nt_room *row_room, *room; /* for the rows, for everything else */
	const uint32_t *items; /* vertex of item i; NULL: first_vertex + i */
	size_t first_vertex, item_count;
	size_t row_guess;      /* rows for which there is room at first */
	nt_weld_row *rows;
	size_t row_capacity, row_count;
	uint32_t *table;
	uint32_t *numbers;   /* [item_count] row of each item */
	unsigned table_bits; /* log2 of the entries; a number has one bit less */
	bool rows_in_room;
	bool unordered; /* an item holds a NaN */
} nt_welder;

/* Eight bytes of a row, read by themselves: gcc takes an array of four by way of the stack. */
static inline uint64_t nt_weld_word(const nt_weld_row *row, size_t index)
{
	uint64_t word;
	memcpy(&word, (const char *)row + index * sizeof word, sizeof word);
	return word;
}

/* Two products of 128 bits are added and the halves of the sum folded, so that every input bit has reached
 * others above and below it; the last factor carries what is in the low bits to the top, where slots come from.
 * Without it grids of whole numbers need up to 11 probes for a row instead of 1.5 (test_weld_hash.c). */
static inline uint64_t nt_weld_hash(const nt_weld_row *row)
{
	/* digits of pi and of the golden ratio: numbers of no structure */
	const uint64_t a = nt_weld_word(row, 0) ^ 0x243f6a8885a308d3u;
	const uint64_t b = nt_weld_word(row, 1) ^ 0x13198a2e03707344u;
	const uint64_t c = nt_weld_word(row, 2) ^ 0xa4093822299f31d0u;
	const uint64_t d = nt_weld_word(row, 3) ^ 0x082efa98ec4e6c89u;
	const unsigned __int128 sum = (unsigned __int128)a * b + (unsigned __int128)c * d;
	return ((uint64_t)sum ^ (uint64_t)(sum >> 64)) * 0x9e3779b97f4a7c15u;
}

typedef float nt_weld_floats __attribute__((vector_size(16)));
typedef int64_t nt_weld_flags __attribute__((vector_size(16)));

/* Two floats, of any alignment, as one that is only moved. */
static inline double nt_weld_pair(const float *floats)
{
	double pair;
	memcpy(&pair, floats, sizeof pair);
	return pair;
}

/* Loads a row. -0 becomes +0, so that equal rows have equal bits. Two registers hold it and are stored once: a
 * row that is stored in pieces and read back has to wait for its stores. Returns flags that are all 0 where no
 * value is NaN. */
static inline nt_weld_flags nt_weld_load(const nmtan_mesh *mesh, size_t vertex, nt_weld_row *row)
{
	typedef double double2 __attribute__((vector_size(16)));
	const float *p = nt_position(mesh, vertex), *n = nt_normal(mesh, vertex), *t = nt_texcoord(mesh, vertex);
	const double2 joint = (double2)(nt_weld_floats){p[2], n[0], 0.0f, 0.0f};
	const nt_weld_floats low = (nt_weld_floats)(double2){nt_weld_pair(p), joint[0]} + 0.0f;
	const nt_weld_floats high = (nt_weld_floats)(double2){nt_weld_pair(n + 1), nt_weld_pair(t)} + 0.0f;
	memcpy(row, &low, sizeof low);
	memcpy((char *)row + sizeof low, &high, sizeof high);
	return (nt_weld_flags)(low != low) | (nt_weld_flags)(high != high);
}

static inline bool nt_weld_ordered(nt_weld_flags unordered)
{
	return (unordered[0] | unordered[1]) == 0;
}

/* Whether no value of a loaded row is NaN. */
static inline bool nt_weld_row_ordered(const nt_weld_row *row)
{
	nt_weld_floats values[2];
	memcpy(values, row, sizeof values);
	return nt_weld_ordered((nt_weld_flags)(values[0] != values[0]) | (nt_weld_flags)(values[1] != values[1]));
}

static inline bool nt_weld_same(const nt_weld_row *a, const nt_weld_row *b)
{
	uint64_t difference = 0;
	for (size_t i = 0; i < 4; i++)
		difference |= nt_weld_word(a, i) ^ nt_weld_word(b, i);
	return difference == 0;
}

static inline size_t nt_weld_slot(const nt_welder *w, uint64_t hash)
{
	return (size_t)(hash >> (64 - w->table_bits));
}

/* The entry of a number with that hash: tag above, number below. Slots are made of the bits of the hash above
 * the tag's. */
static inline uint32_t nt_weld_entry(const nt_welder *w, uint64_t hash, uint32_t number)
{
	return (uint32_t)(hash >> 20) << (w->table_bits - 1) | number;
}

static inline unsigned nt_weld_bits_for(size_t entries)
{
	unsigned bits = 4;
	while ((size_t)1 << bits < entries)
		bits++;
	return bits;
}

/* The slot of a row: where the entry of an equal one is, or none. */
static inline size_t nt_weld_probe(const nt_welder *w, const nt_weld_row *row, uint64_t hash)
{
	const size_t mask = ((size_t)1 << w->table_bits) - 1;
	const uint32_t number_mask = (uint32_t)(mask >> 1);
	const uint32_t tag = nt_weld_entry(w, hash, 0);
	for (size_t at = nt_weld_slot(w, hash);; at = (at + 1) & mask) {
		const uint32_t entry = w->table[at];
		if (entry == NT_WELD_EMPTY ||
			((entry & ~number_mask) == tag && nt_weld_same(&w->rows[entry & number_mask], row)))
			return at;
	}
}

/* Numbers items in order of first appearance, by a table: rows, row_count and what lies at `numbers` come to be. An
 * item with a NaN has a row of its own.
 *
 *   start     table as row_guess says, and room for as many rows or for `capacity`, whichever is more; false when
 *             out of memory
 *   some      items from `item` on, until all have numbers or memory runs short; returns the first without
 *   reserve   more memory, for as many rows as the items before `done` lead to expect; false when out of memory */
bool nt_weld_start(nt_welder *w, size_t capacity);
size_t nt_weld_some(nt_welder *w, size_t item);
bool nt_weld_reserve(nt_welder *w, size_t done);

/* A larger place for the rows, which move. */
bool nt_weld_grow_rows(nt_welder *w, size_t capacity);

/* All items, on one thread or several; the second is for at least two. False when out of memory. */
bool nt_weld_items(nt_welder *w, unsigned ranges);
bool nt_weld_items_threads(nt_welder *w, unsigned ranges);

/* Welds the vertices, which are the items, of a mesh with indices; rows and row_count come to be. Returns the number
 * of each corner, which may be the mesh's indices; NULL when out of memory. */
const uint32_t *nt_weld_vertices(nt_welder *w, size_t corner_count, unsigned ranges);

#endif
