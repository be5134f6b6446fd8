/* SPDX-License-Identifier: MIT */
/*
 * What the weld on one thread (weld.c) and on several (weld_threads.c) share: rows, their hash, entries of the
 * table. For these two files only.
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
#define NT_WELD_UNORDERED UINT32_MAX /* in `numbers`: the row holds a NaN */

typedef struct nt_welder {
	const nmtan_mesh *mesh;
	nt_room *room;
	const uint32_t *items; /* vertex of item i; NULL: i */
	size_t item_count;
	bool by_corner;        /* items are corners, not vertices */
	nt_weld_row *rows;
	bool rows_in_room;
	size_t row_capacity, row_count;
	uint32_t *table;
	unsigned table_bits, index_bits; /* log2 of the entries; bits of an entry's number */
	uint32_t *numbers; /* [item_count] row of each item; NULL while number i is i */
	size_t unordered_count; /* vertices of an indexed mesh that hold a NaN: they have no row yet */
} nt_welder;

/* Both halves of a 64 by 64 bit product, folded: every input bit reaches every output bit. */
static inline uint64_t nt_weld_fold(uint64_t a, uint64_t b)
{
	const unsigned __int128 product = (unsigned __int128)a * b;
	return (uint64_t)product ^ (uint64_t)(product >> 64);
}

static inline uint64_t nt_weld_hash(const nt_weld_row *row)
{
	/* digits of pi: numbers of no structure */
	uint64_t words[4];
	memcpy(words, row, sizeof words);
	const uint64_t a = nt_weld_fold(words[0] ^ 0x243f6a8885a308d3u, words[1] ^ 0x13198a2e03707344u);
	const uint64_t b = nt_weld_fold(words[2] ^ 0xa4093822299f31d0u, words[3] ^ 0x082efa98ec4e6c89u);
	return nt_weld_fold(a ^ 0x452821e638d01377u, b ^ 0xbe5466cf34e90c6cu);
}

static inline void nt_weld_load(const nmtan_mesh *mesh, size_t vertex, nt_weld_row *row)
{
	memcpy(row->position, nt_position(mesh, vertex), sizeof row->position);
	memcpy(row->normal, nt_normal(mesh, vertex), sizeof row->normal);
	memcpy(row->texcoord, nt_texcoord(mesh, vertex), sizeof row->texcoord);
}

/* -0 becomes +0, so that equal rows have equal bits; true where no value is NaN. */
static inline bool nt_weld_canonise(nt_weld_row *row)
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

static inline size_t nt_weld_vertex(const nt_welder *w, size_t item)
{
	return w->items ? w->items[item] : item;
}

static inline size_t nt_weld_slot(const nt_welder *w, uint64_t hash)
{
	return (size_t)(hash >> (64 - w->table_bits));
}

/* The entry of a number with that hash: tag above, number below. */
static inline uint32_t nt_weld_entry(const nt_welder *w, uint64_t hash, uint32_t number)
{
	return (uint32_t)(hash >> 4) << w->index_bits | number;
}

static inline unsigned nt_weld_bits_for(size_t entries)
{
	unsigned bits = 8;
	while ((size_t)1 << bits < entries)
		bits++;
	return bits;
}

/* A table that is not cleared. */
bool nt_weld_make_table(nt_welder *w, unsigned table_bits, unsigned index_bits);

/* Memory for a number for each item: for good where items are corners; else in the room, until the corners are
 * numbered. */
uint32_t *nt_weld_alloc_numbers(nt_welder *w);

/* A larger place for the rows, which move. */
bool nt_weld_grow_rows(nt_welder *w, size_t capacity);

/* Numbers the items on `ranges` threads (at least 2): rows, row_count, numbers and unordered_count become what
 * one thread makes them. False when out of memory. */
bool nt_weld_items_threads(nt_welder *w, unsigned ranges);

#endif
