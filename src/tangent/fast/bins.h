/* SPDX-License-Identifier: MIT */
/*
 * Sums over the corners of welded vertices: the record that has one, and the bins in which corners are sorted on their
 * way to it.
 */
#ifndef NT_TANGENT_FAST_BINS_H
#define NT_TANGENT_FAST_BINS_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include "tangent/solve.h"
#include "topology/adjacency.h"

/* ---- records: the sum of a vertex, and whether it is what the groups of the definition would give ---- */

/* Sum over the corners of one orientation at a vertex; later its result. `state` is a set of bits that
 * each corner may only clear: what is left holds for all of them. */
typedef struct nt_record {
	float x, y, z;
	uint32_t state;
} nt_record;

/* The sums behind the optional outputs. */
typedef struct nt_record_more {
	float x, y, z, angle; /* bitangent; sum of the weights */
	float mag_s, mag_t;
	float unused[2];
} nt_record_more;

/* Bits of nt_record.state while it is a sum. All states carry NT_STATE_BASE, which makes them normal
 * floats: the lane takes part in the addition of its record, and a denormal may cost 100 cycles. */
enum {
	NT_STATE_SOUND = 1 << 0,    /* every value met was well inside float's range */
	NT_STATE_EMPTY = 1 << 1,    /* no corner was added */
	NT_STATE_NO_ANY = 1 << 2,   /* no triangle without a frame touches the vertex */
	NT_STATE_LOCAL = 1 << 3,    /* the order in which groups are seeded does not matter */
	NT_STATE_U = 0xf300,        /* one bit for each half-space that all u directions lie in; zero lies in all */
	NT_STATE_V = 0x0cf0,        /* the same for v; which is which, state_of() in lanes.h knows */
	NT_STATE_ALL = 0xffff,
	NT_STATE_BASE = 0x40000000
};

/* No corner yet. Copied as a whole, as it is loaded: stores of single words would have to reach the cache first. */
static const nt_record nt_no_record = {0, 0, 0, NT_STATE_BASE | NT_STATE_ALL};

/* nt_record.state when settled: the sign as a float, or one of these. */
#define NT_RESULT_PLUS 0x3f800000u    /* 1.0f */
#define NT_RESULT_MINUS 0xbf800000u   /* -1.0f */
#define NT_RESULT_NONE 0u             /* no corner has this orientation */
#define NT_RESULT_COMPLEX 0x40000000u /* ask complex.c; no other state has this bit */

/* Beside a sign, where the solve repairs: the record is the result, but tangent/usable.c would not accept it, or not
 * that of the vertex's other orientation. */
#define NT_RESULT_UNUSABLE NT_W_OPEN

/* Beside NT_RESULT_COMPLEX: the sums have nothing extreme and do not split, so that an orientation with one group has
 * the record as its result; and that is not unusable, where the solve repairs. */
#define NT_RESULT_SUM 0x20000000u

/* Beside it: a hub, or an edge at the vertex occurs twice in one direction, so that pairs depend on order. */
#define NT_RESULT_TANGLED 0x10000000u

/* Beside it, in the lowest bits: how many corners the vertex has, a hub those of degenerate triangles too; where
 * complex.c has seen the vertex, NT_RESULT_PLACED and the place of its next corner. */
#define NT_RESULT_PLACED 0x80000000u
#define NT_RESULT_NUMBER (((uint32_t)1 << 28) - 1)

/* The words of a record on their way: loaded and stored at once, if the compiler has vectors. */
#if NT_VECTORS
typedef float nt_float4 __attribute__((vector_size(16)));
typedef int nt_int4 __attribute__((vector_size(16)));

static inline nt_int4 nt_and4(nt_int4 a, nt_int4 b)
{
	return a & b;
}

static inline nt_int4 nt_or4(nt_int4 a, nt_int4 b)
{
	return a | b;
}

static inline uint32_t nt_state4(nt_int4 a)
{
	return (uint32_t)a[3];
}

/* Adds the sum, and keeps the bits of the state that both have. */
static inline void nt_record_add(nt_record *record, nt_int4 add)
{
	nt_float4 old;
	memcpy(&old, record, sizeof old);
	const nt_int4 sum = (nt_int4)(old + (nt_float4)add), both = (nt_int4)old & add;
	const nt_int4 result = __builtin_shufflevector(sum, both, 0, 1, 2, 7);
	memcpy(record, &result, sizeof result);
}
#else
typedef struct nt_int4 {
	int32_t x, y, z, state;
} nt_int4;

static inline nt_int4 nt_and4(nt_int4 a, nt_int4 b)
{
	return (nt_int4){a.x & b.x, a.y & b.y, a.z & b.z, a.state & b.state};
}

static inline nt_int4 nt_or4(nt_int4 a, nt_int4 b)
{
	return (nt_int4){a.x | b.x, a.y | b.y, a.z | b.z, a.state | b.state};
}

static inline uint32_t nt_state4(nt_int4 a)
{
	return (uint32_t)a.state;
}

static inline void nt_record_add(nt_record *record, nt_int4 add)
{
	nt_record sum;
	memcpy(&sum, &add, sizeof sum);
	record->x += sum.x, record->y += sum.y, record->z += sum.z;
	record->state &= sum.state;
}
#endif

static inline void nt_record_more_add(nt_record_more *record, const nt_record_more *add)
{
	enum { FLOATS = sizeof *record / sizeof(float) };
	float sum[FLOATS], more[FLOATS];
	memcpy(sum, record, sizeof sum);
	memcpy(more, add, sizeof more);
	for (int i = 0; i < FLOATS; i++)
		sum[i] += more[i];
	memcpy(record, sum, sizeof sum);
}

/* ---- bins ---- */

/*
 * Corners sorted by where their vertex lies, for meshes whose neighbouring triangles have vertices far
 * apart. There each corner would wait for a cursor, an entry and a record, none of them in a cache.
 * Instead the first pass writes corners down in bins, one for every few thousand vertices, each of them
 * a stream; then one bin after the other is added up with all its vertices in the cache. (This is one pass of a
 * radix sort.)
 *
 * The corners of a bin lie in triangle order whatever the number of ranges, so the sums are those of the
 * direct way, and no range has to wait for another.
 *
 * A corner takes 16 bytes, which lie in the output until it is written, and 7 more for its entry.
 */

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

/* An entry in a bin: two vertices of 28 bits. Its orientation is the sum's. */
enum { NT_BINNED_VERTEX_BITS = 28, NT_BINNED_ENTRY = 7 };

/* In two steps that overlap, because the byte behind may be another thread's. */
static inline void nt_binned_store(uint8_t *to, uint32_t next, uint32_t previous)
{
	const uint64_t entry = (uint64_t)previous << NT_BINNED_VERTEX_BITS | next;
	const uint32_t low = (uint32_t)entry, high = (uint32_t)(entry >> 24);
	memcpy(to, NT_BIG_ENDIAN ? &high : &low, sizeof low);
	memcpy(to + 3, NT_BIG_ENDIAN ? &low : &high, sizeof high);
}

/* Reads the byte behind, too. */
static inline nt_fan_entry nt_binned_load(const uint8_t *from, uint32_t orient_bit)
{
	const uint32_t mask = ((uint32_t)1 << NT_BINNED_VERTEX_BITS) - 1;
	uint64_t entry;
	memcpy(&entry, from, sizeof entry);
	entry >>= NT_BIG_ENDIAN ? 8 : 0;
	return (nt_fan_entry){((uint32_t)entry & mask) | orient_bit,
		((uint32_t)(entry >> NT_BINNED_VERTEX_BITS) & mask) | orient_bit};
}

typedef struct nt_bins {
	unsigned vertex_bits, ranges;
	size_t count, vertex_count;
	uint32_t *cursors; /* [ranges][count] where the next corner of a range goes; NULL: no bins */
	uint32_t *begins;  /* [count][ranges] its first corner */
	nt_record *sums;   /* [3 * triangle count] */
	uint8_t *entries;  /* [3 * triangle count] of NT_BINNED_ENTRY bytes, and one byte more */
	uint8_t *seen;     /* [ranges] */
} nt_bins;

/* Memory in which one bin after the other is added up. */
typedef struct nt_bin {
	nt_adjacency adjacency;
	nt_record *sums[2]; /* [2^vertex_bits] by orientation, counted from the first vertex; NULL: not needed */
} nt_bin;

/* Whether faces that follow each other tend to have vertices that lie far apart, by a sample of corners. */
bool nt_is_scattered(const uint32_t *vertices, size_t corner_count, size_t vertex_count);

/* log2 of the vertices of a bin that suit a mesh. */
unsigned nt_bins_bits(size_t vertex_count);

/*
 * Makes places for the corners of all triangles.
 *
 *   ids           [3 * triangle count] vertices of the triangles
 *   vertex_bits   log2 of the vertices of a bin: 4, a block of the adjacency, to NT_BINNED_BITS
 *   sums          [3 * triangle count] needed until the bins are added up; NULL: taken from `memory`
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_bins_make(const uint32_t *ids, const nt_triangle_ranges *ranges, size_t vertex_count,
	unsigned vertex_bits, nt_record *sums, nt_borrowed *memory, nt_bins *bins);

/* Orientations for which there have to be records: those that came up; without a frame anywhere, one whose records
 * can take notes. */
void nt_bins_orientations(const nt_bins *bins, bool orientations[2]);

/* Whether a vertex has corners, once all are in their bins. */
bool nt_bins_have_corners(const nt_bins *bins, uint32_t vertex);

/* Memory for one bin, whichever it is, with sums of the orientations that are needed. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_bin_make(const nt_bins *bins, const bool needed[2], nt_scratch *scratch, nt_bin *bin);

/*
 * Adds up the corners of bin number `index`, and enters them in the adjacency; what was in `bin` is lost. A corner
 * without a frame goes to either orientation, and where both are needed its vertex loses NT_STATE_LOCAL: which
 * group it joins may depend on the order of seeds.
 */
void nt_bin_add_up(const nt_bins *bins, size_t index, nt_bin *bin);

#endif
