/* SPDX-License-Identifier: MIT */
/*
 * Corners sorted by where their vertex lies, for meshes whose neighbouring triangles have vertices far
 * apart. There each corner would wait for a cursor, an entry and a record, none of them in a cache.
 * Instead the first pass writes corners down in bins, one for every few thousand vertices, each of them
 * a stream; then one bin after the other is added up with all its vertices at hand. (This is one pass of a
 * radix sort.)
 *
 * The corners of a bin lie in triangle order whatever the number of ranges, so the sums are those of the
 * direct way, and no range has to wait for another.
 */
#ifndef NT_TANGENT_BINS_H
#define NT_TANGENT_BINS_H

#include "tangent/record.h"
#include "topology/adjacency.h"

/* In nt_record.state of a binned corner, above the bits of a sum: its vertex, counted from the bin's first, and
 * its orientation. */
enum { NT_BINNED_SHIFT = 16, NT_BINNED_BITS = 14 };
#define NT_BINNED_ORIENT ((uint32_t)1 << 31)

/* Fewest vertices for which bins are worth their traffic: the records of fewer stay in the second-level
 * cache. */
enum { NT_BINS_LEAST = 1 << 16 };

/* Bits of nt_bins.seen: triangles with a frame of one orientation; triangles without a frame. */
#define NT_SEEN(orient) (1u << (orient))
#define NT_SEEN_ANY 4u

typedef struct nt_bins {
	unsigned vertex_bits, ranges;
	size_t count, vertex_count;
	uint32_t *cursors;     /* [ranges][count] where the next corner of a range goes; NULL: no bins */
	uint32_t *begins;      /* [count][ranges] its first corner, and one more for the end */
	nt_record *sums;       /* [3 * triangle count] */
	nt_fan_entry *entries; /* [3 * triangle count] */
	uint8_t *seen;         /* [ranges] */
} nt_bins;

/* Whether faces that follow each other tend to have vertices that lie far apart, by a sample of corners. */
bool nt_is_scattered(const uint32_t *vertices, size_t corner_count, size_t vertex_count);

/* log2 of the vertices of a bin that suit a mesh. */
unsigned nt_bins_bits(size_t vertex_count);

/*
 * Makes places for the corners of all triangles.
 *
 *   ids           [3 * triangle count] vertices of the triangles
 *   vertex_bits   log2 of the vertices of a bin: 4, a block of the adjacency, to NT_BINNED_BITS
 *   sums          [3 * triangle count] lent until the bins are added up; NULL: taken from the scratch
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_bins_make(const uint32_t *ids, const nt_triangle_ranges *ranges, size_t vertex_count,
	unsigned vertex_bits, nt_record *sums, nt_scratch *scratch, nt_bins *bins);

/* Memory for the adjacency of one bin, whichever it is. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_bins_adjacency(const nt_bins *bins, nt_scratch *scratch, nt_adjacency *adjacency);

/*
 * Clears the records of a bin's vertices, adds the bin's corners to them and enters the corners in the
 * adjacency, whose former content is lost. A corner without a frame goes to either orientation, and where both
 * exist its vertex loses NT_STATE_LOCAL: which group it joins may depend on the order of seeds.
 *
 *   records   [2] by orientation, [vertex_count] each; one of them may be NULL
 */
void nt_bins_add(const nt_bins *bins, size_t bin, nt_record *const records[2], nt_adjacency *adjacency);

#endif
