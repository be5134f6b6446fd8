/* SPDX-License-Identifier: MIT */
/*
 * The inside of this room: shared by the files of the weld, and by those of the order of edges.
 */
#ifndef NT_TOPOLOGY_INSIDE_H
#define NT_TOPOLOGY_INSIDE_H

#include "base/scratch.h"
#include "topology/edge_sort.h"
#include "topology/weld.h"

/* ---- the weld: entries of the table of rows ---- */

/*
 * For the table (weld_table.c), its use on several threads (weld_threads.c) and the weld of vertices (weld_bloom.c,
 * weld.c).
 *
 * An entry of 4 bytes holds a number and, in the bits that the number leaves free, a tag of the hash, so that
 * the row of another key is read about once in 2^tag probes. Tables are open-addressing and at most half full.
 */

/* Rows whose hashes are made, and whose entries are prefetched, at a time. */
enum { NT_WELD_BATCH = 32 };

#define NT_WELD_EMPTY UINT32_MAX

typedef struct nt_welder {
	const nmtan_mesh *mesh;
	nt_weld_key key;
	nt_borrowed *row_memory, *memory; /* for the rows, for everything else */
	const uint32_t *items; /* vertex of item i; NULL: first_vertex + i */
	size_t first_vertex, item_count;
	size_t row_guess;      /* rows for which there is room at first */
	nt_weld_row *rows;
	size_t row_capacity, row_count;
	uint32_t *table;
	uint32_t *numbers;   /* [item_count] row of each item */
	unsigned table_bits; /* log2 of the entries; a number has one bit less */
	bool rows_borrowed;
	bool unordered; /* an item holds a NaN */
} nt_welder;

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

/* All items, on one thread or several. False when out of memory. */
bool nt_weld_items(nt_welder *w, unsigned ranges);

/* How a weld of vertices ends. MANY of them are equal: it is left to the table. */
typedef enum nt_weld_outcome {
	NT_WELD_DONE,
	NT_WELD_MANY,
	NT_WELD_NO_MEMORY
} nt_weld_outcome;

/* Welds vertices, which are the items of `w`: those of corners where the mesh has no indices. Makes rows, row_count
 * and, where a number is another than the vertex's own, numbers. */
nt_weld_outcome nt_weld_by_filter(nt_welder *w, unsigned ranges);

/* ---- the order of edges ---- */

/* Shared by edge_tail.c, edge_few.c (does the order of the last run matter?) and edge_sort.c (which order?) alone. */

/* If the order of the last run matters, it has three edges or more. */
enum { NT_LEAST_EDGES = 3 };

static inline uint32_t nt_least_of(uint32_t a, uint32_t b)
{
	return a < b ? a : b;
}

static inline uint32_t nt_most_of(uint32_t a, uint32_t b)
{
	return a < b ? b : a;
}

/* The one in the middle is the larger lower end of two edges of a triangle, and that of the third is the least. */
static inline uint32_t nt_middle_of(const uint32_t of[3])
{
	return nt_most_of(nt_least_of(of[0], of[1]), nt_least_of(nt_most_of(of[0], of[1]), of[2]));
}

static inline const uint32_t *nt_vertices_of(const nt_welded_mesh *mesh, size_t triangle, uint32_t copy[3])
{
	return nt_triangle_vertices(mesh->triangles, triangle, 1, copy);
}

/* The corner of the mesh that is corner k of triangle t: 3 * t + k. */
static inline uint32_t nt_mesh_corner(const nt_welded_mesh *mesh, uint32_t corner)
{
	return (uint32_t)nt_triangle_corner(mesh->triangles, corner / 3, corner % 3);
}

/* Whether the order of the last run matters; of few triangles it is quicker to find out than to ask further. */
typedef enum nt_edge_answer { NT_EDGE_NO, NT_EDGE_MAY, NT_EDGE_OPEN } nt_edge_answer;

/* Asks whether the order of the last run may matter; `grid` receives that of the vertices that have corners, if it may.
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 *
 *   tail    NULL: nothing has been noted */
nmtan_status nt_edge_tail_matters(const nt_welded_mesh *mesh, const nt_edge_tail *tail, nt_grid *grid,
	nt_edge_answer *answer, bool *limit);

/* Whether the order of the last run certainly does not matter, as far as the last triangles say, or few triangles; they
 * are not halves of quads. The grid is that of all rows, or of those that have corners. */
bool nt_edges_are_sorted(const nt_welded_mesh *mesh, nt_grid grid, bool is_grid_of_used);

#endif
