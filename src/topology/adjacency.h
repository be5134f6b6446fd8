/* SPDX-License-Identifier: MIT */
/*
 * The corners around each welded vertex, laid out for lanes: vertices go in blocks of 16, and the k-th
 * corners of a block's vertices lie side by side. A block is as deep as its vertex of most corners;
 * hubs, which are the vertices of more than NT_FAN_DEPTH corners, have no entries here. If places run out, because
 * a very large mesh is also very uneven, all vertices are hubs from there on.
 *
 * Several ranges of triangles can be entered at the same time: each range has a cursor of its own for
 * each vertex.
 *
 * Few vertices are not counted first. Each has places for all corners that it may have without being a hub, in entries
 * of half the size, and the k-th corners of all vertices lie side by side.
 */
#ifndef NT_TOPOLOGY_ADJACENCY_H
#define NT_TOPOLOGY_ADJACENCY_H

#include "base/scratch.h"
#include "nmtan.h"
#include "topology/corners.h"

enum { NT_FAN_LANES = 16, NT_FAN_DEPTH = 12 };

/* So many vertices can have narrow entries; none where each byte of their code is sent to a browser. */
#ifdef __wasm__
enum { NT_NARROW_LIMIT = 0 };
#else
enum { NT_NARROW_LIMIT = 1 << 14 };
#endif

/* One corner of a vertex: the vertices after and before it in its triangle. */
typedef struct nt_fan_entry {
	uint32_t next, previous;
} nt_fan_entry;

/* Entries of fans: orientation in bit 31; bit 30 marks a place without a corner, whose numbers differ
 * from all others of its vertex. */
#define NT_ENTRY_ORIENT ((uint32_t)1 << 31)
#define NT_ENTRY_VOID ((uint32_t)1 << 30)
#define NT_ENTRY_VERTEX (NT_ENTRY_ORIENT - 1)

/* A narrow entry: the two upper and the 14 lower bits of next and, in the upper half, of previous. */
static inline uint32_t nt_fan_narrow(nt_fan_entry entry)
{
	return (entry.next & (NT_NARROW_LIMIT - 1)) | (entry.next >> 16 & 0xc000u) |
	       (entry.previous & (NT_NARROW_LIMIT - 1)) << 16 | (entry.previous & 0xc0000000u);
}

/* A cursor: where the vertex's next entry of this range goes (each corner moves it by `step`), and
 * flags above. */
#define NT_CURSOR_HUB ((uint32_t)1 << 31)       /* a hub: in the place's stead is how many corners it has in all */
#define NT_CURSOR_SHARED ((uint32_t)1 << 30)    /* an earlier range has corners of this vertex too; in two sweeps, any
                                                   other one */
#define NT_CURSOR_PLACE (((uint32_t)1 << 28) - 1)

/* Cursors from here on have a flag. */
#define NT_CURSOR_FLAGGED NT_CURSOR_SHARED

typedef struct nt_adjacency {
	size_t first_vertex, vertex_count; /* the first is a multiple of NT_FAN_LANES */
	unsigned ranges;
	uint32_t *cursors;     /* [ranges][vertex_count] */
	uint32_t *block_begin; /* [blocks + 1] index of a block's first entry */
	size_t *shared_counts; /* [ranges] corners whose cursor is SHARED */
	nt_fan_entry *entries; /* [entry_count] */
	size_t entry_count;
	uint32_t *narrow;      /* [NT_FAN_DEPTH][step] narrow entries; NULL: there are the others */
	uint32_t step;         /* NT_FAN_LANES, or that of narrow entries: the vertices and padding */
} nt_adjacency;

/* Places that can be numbered, those of corners and of padding, and fewer corners than that. */
#define NT_ADJACENCY_PLACES ((size_t)NT_CURSOR_PLACE - NT_FAN_LANES)
#define NT_ADJACENCY_LIMIT ((size_t)1 << 28)

static inline bool nt_adjacency_is_narrow(const nt_adjacency *a)
{
	return NT_NARROW_LIMIT > 0 && a->narrow;
}

/* Moves a cursor on. Returns where it was; a vertex whose narrow entries are used up becomes a hub. */
static inline uint32_t nt_adjacency_next(const nt_adjacency *a, uint32_t *cursor)
{
	const uint32_t place = *cursor, hub = place & NT_CURSOR_HUB;
	const bool full = nt_adjacency_is_narrow(a) && place >= NT_FAN_DEPTH * a->step;
	if (full)
		*cursor = hub ? place + 1 : NT_CURSOR_HUB | (NT_FAN_DEPTH + 1);
	else
		*cursor = place + (hub ? 0 : a->step);
	return full ? NT_CURSOR_HUB : place;
}

static inline void nt_adjacency_store(const nt_adjacency *a, uint32_t place, nt_fan_entry entry)
{
	if (nt_adjacency_is_narrow(a))
		a->narrow[place] = nt_fan_narrow(entry);
	else
		a->entries[place & NT_CURSOR_PLACE] = entry;
}

/* The place of a vertex's first entry, of one range. */
static inline uint32_t nt_adjacency_first(const nt_adjacency *a, uint32_t vertex)
{
	return nt_adjacency_is_narrow(a) ? vertex : a->block_begin[vertex / NT_FAN_LANES] + vertex % NT_FAN_LANES;
}

/* An entry, without orientation; false: a void. */
static inline bool nt_adjacency_load(const nt_adjacency *a, uint32_t place, nt_fan_entry *entry)
{
	if (!nt_adjacency_is_narrow(a)) {
		const nt_fan_entry *wide = &a->entries[place];
		*entry = (nt_fan_entry){wide->next & NT_ENTRY_VERTEX, wide->previous & NT_ENTRY_VERTEX};
		return !(entry->next & NT_ENTRY_VOID);
	}
	const uint32_t both = a->narrow[place];
	*entry = (nt_fan_entry){both & (NT_NARROW_LIMIT - 1), both >> 16 & (NT_NARROW_LIMIT - 1)};
	return !(both & NT_ENTRY_VOID >> 16);
}

/* The first entry of a block. */
static inline const nt_fan_entry *nt_adjacency_block(const nt_adjacency *a, size_t block)
{
	return &a->entries[a->block_begin[block]];
}

/*
 * Counts the corners of each vertex, if there are many or several ranges, and makes the places, range by range. Entries
 * are not written.
 *
 *   most_places             up to NT_ADJACENCY_PLACES
 *   most_narrow             vertices that have narrow entries: up to NT_NARROW_LIMIT
 *   cursor_memory, memory   for the cursors, and for the entries; may be the same
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_adjacency_make(const nt_triangles *triangles, const nt_triangle_ranges *ranges,
	size_t vertex_count, size_t most_places, size_t most_narrow, nt_borrowed *cursor_memory, nt_borrowed *memory,
	nt_adjacency *adjacency);

#endif
