/* SPDX-License-Identifier: MIT */
/*
 * The weld of the fast path: which corners are one vertex (spec page, step 2), and each vertex's eight
 * floats as one row of 32 bytes, so that a later pass finds all of a corner in one place.
 *
 * Corners have equal numbers where those of nt_weld_corners() are equal. The numbers have gaps, and where no vertex is
 * equal to another the mesh's own indices are used as they are.
 */
#ifndef NT_TOPOLOGY_WELD_H
#define NT_TOPOLOGY_WELD_H

#include <string.h>
#include "base/hash.h"
#include "base/scratch.h"
#include "topology/corners.h"
#if NT_VECTORS && defined(__SSE2__)
#include <emmintrin.h>
#endif

/* ---- a row: loaded from a mesh, its hash, and when two are equal ---- */

/* Attributes of a welded vertex, -0 made +0. */
typedef struct nt_weld_row {
	float position[3], normal[3], texcoord[2];
} nt_weld_row;

/* Eight bytes of a row, read by themselves: gcc takes an array of four by way of the stack. */
static inline uint64_t nt_weld_word(const nt_weld_row *row, size_t index)
{
	uint64_t word;
	memcpy(&word, (const char *)row + index * sizeof word, sizeof word);
	return word;
}

/* The key of this process (base/hash.h), so that nobody can make rows of one hash. */
typedef struct nt_weld_key {
	uint64_t words[4];
} nt_weld_key;

static inline nt_weld_key nt_weld_make_key(void)
{
	uint64_t key[NT_HASH_KEY_WORDS];
	nt_hash_key(key);
	return (nt_weld_key){{key[0], key[1], key[0] * 0xa4093822299f31d1u, key[1] * 0x082efa98ec4e6c89u}};
}

/* Two products of 128 bits are added and the halves of the sum folded, so that every input bit has reached
 * others above and below it; the last factor carries what is in the low bits to the top, where slots come from.
 * Without it grids of whole numbers need up to 11 probes for a row instead of 1.5 (test_weld_hash.c). */
static inline uint64_t nt_weld_hash(const nt_weld_key *key, const nt_weld_row *row)
{
	const uint64_t a = nt_weld_word(row, 0) ^ key->words[0], b = nt_weld_word(row, 1) ^ key->words[1];
	const uint64_t c = nt_weld_word(row, 2) ^ key->words[2], d = nt_weld_word(row, 3) ^ key->words[3];
#if defined(__SIZEOF_INT128__) && !defined(NMTAN_PLAIN_C) && !defined(__wasm__)
	/* an addition with carry: gcc makes three instructions more of the one below */
	const unsigned __int128 whole = (unsigned __int128)a * b + (unsigned __int128)c * d;
	const uint64_t sum = (uint64_t)whole, upper = (uint64_t)(whole >> 64);
#else
	uint64_t high, more;
	const uint64_t first = nt_multiply(a, b, &high), sum = first + nt_multiply(c, d, &more);
	const uint64_t upper = high + more + (sum < first);
#endif
	return (sum ^ upper) * 0x9e3779b97f4a7c15u;
}

#if NT_VECTORS
typedef float nt_weld_floats __attribute__((vector_size(16)));
typedef int64_t nt_weld_flags __attribute__((vector_size(16)));

/* Two floats, of any alignment, as one that is only moved. */
static inline double nt_weld_pair(const float *floats)
{
	double pair;
	memcpy(&pair, floats, sizeof pair);
	return pair;
}

/* Flags, not 0 where either value is NaN: for gcc 12 that is one comparison by name, and two by operators. */
static inline nt_weld_flags nt_weld_unordered(nt_weld_floats a, nt_weld_floats b)
{
#ifdef __SSE2__
	return (nt_weld_flags)_mm_cmpunord_ps((__m128)a, (__m128)b);
#else
	return (nt_weld_flags)(a != a) | (nt_weld_flags)(b != b);
#endif
}

/* The two halves of a row. -0 becomes +0, so that equal rows have equal bits. Returns flags that are all 0 where no
 * value is NaN. */
static inline nt_weld_flags nt_weld_fetch(const nmtan_mesh *mesh, size_t vertex, nt_weld_floats *low,
	nt_weld_floats *high)
{
	typedef double double2 __attribute__((vector_size(16)));
	const float *p = nt_position(mesh, vertex), *n = nt_normal(mesh, vertex), *t = nt_texcoord(mesh, vertex);
	const double2 joint = (double2)(nt_weld_floats){p[2], n[0], 0.0f, 0.0f};
	*low = (nt_weld_floats)(double2){nt_weld_pair(p), joint[0]} + 0.0f;
	*high = (nt_weld_floats)(double2){nt_weld_pair(n + 1), nt_weld_pair(t)} + 0.0f;
	return nt_weld_unordered(*low, *high);
}

/* Two registers hold a row and are stored once: a row that is stored in pieces and read back has to wait for its
 * stores. */
static inline void nt_weld_put(nt_weld_floats low, nt_weld_floats high, nt_weld_row *row)
{
	memcpy(row, &low, sizeof low);
	memcpy((char *)row + sizeof low, &high, sizeof high);
}

/* If each byte of code is sent to a browser, a row is loaded out of line: 240 bytes of the package. */
#ifdef __wasm__
#define NT_WELD_INLINE NT_NOINLINE __attribute__((unused))
#else
#define NT_WELD_INLINE inline
#endif

/* Loads a row. Returns the flags of nt_weld_fetch(). */
static NT_WELD_INLINE nt_weld_flags nt_weld_load(const nmtan_mesh *mesh, size_t vertex, nt_weld_row *row)
{
	nt_weld_floats low, high;
	const nt_weld_flags unordered = nt_weld_fetch(mesh, vertex, &low, &high);
	nt_weld_put(low, high, row);
	return unordered;
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
	return nt_weld_ordered(nt_weld_unordered(values[0], values[1]));
}
#else
typedef int nt_weld_flags; /* not 0: a value is NaN */

static inline bool nt_weld_ordered(nt_weld_flags unordered)
{
	return unordered == 0;
}

static inline bool nt_weld_row_ordered(const nt_weld_row *row)
{
	const float *p = row->position, *n = row->normal, *t = row->texcoord;
	return (p[0] == p[0]) & (p[1] == p[1]) & (p[2] == p[2]) & (n[0] == n[0]) & (n[1] == n[1]) & (n[2] == n[2]) &
	       (t[0] == t[0]) & (t[1] == t[1]);
}

static inline nt_weld_flags nt_weld_load(const nmtan_mesh *mesh, size_t vertex, nt_weld_row *row)
{
	const float *p = nt_position(mesh, vertex), *n = nt_normal(mesh, vertex), *t = nt_texcoord(mesh, vertex);
	*row = (nt_weld_row){{p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f}, {n[0] + 0.0f, n[1] + 0.0f, n[2] + 0.0f},
		{t[0] + 0.0f, t[1] + 0.0f}};
	return !nt_weld_row_ordered(row);
}
#endif

static inline bool nt_weld_same(const nt_weld_row *a, const nt_weld_row *b)
{
	uint64_t difference = 0;
	for (size_t i = 0; i < 4; i++)
		difference |= nt_weld_word(a, i) ^ nt_weld_word(b, i);
	return difference == 0;
}

/* ---- the weld ---- */

typedef struct nt_weld {
	const uint32_t *ids;     /* [corner_count] welded vertex of each corner; may be mesh->indices */
	const nt_weld_row *rows; /* [count], of numbers that no corner has too */
	size_t count;
} nt_weld;

/* Corners and vertices that nt_weld can number. */
#define NT_WELD_LIMIT ((size_t)1 << 28)

/*
 * Welds the corners of a mesh whose strides are filled in and whose indices are checked. Linear time.
 *
 *   row_memory, memory
 *            for the rows, and for everything else, which is given back but for ids; may be the same
 *   ranges   threads to use, at least 1. Which corners have equal numbers does not depend on them.
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_weld_mesh(const nmtan_mesh *mesh, size_t corner_count, unsigned ranges, nt_borrowed *row_memory,
	nt_borrowed *memory, nt_weld *weld);

#endif
