/* SPDX-License-Identifier: MIT */
/*
 * Rows of welded vertices and their hashes of 32 bits, for those who weld by vertex; with SSE2 four at a time.
 *
 * That hash is a sum of products of pairs of words that have a key added (NH, of UMAC: Black et al. 1999), folded, and
 * multiplied once more so that the upper bits depend on all. Four rows take as many instructions as two with the
 * products of 128 bits of nt_weld_hash(), which the table of rows has. It needs no secret key: where many vertices have
 * one hash the sieve leaves them to the table.
 */
#ifndef NT_TOPOLOGY_WELD_FOUR_H
#define NT_TOPOLOGY_WELD_FOUR_H

#include "topology/weld_row.h"

#ifdef __SSE2__
typedef uint32_t nt_weld_words __attribute__((vector_size(16)));
typedef uint64_t nt_weld_longs __attribute__((vector_size(16)));

/* The lower halves multiplied. By name, because gcc 12 multiplies whole numbers of 64 bits, three times as long. */
static inline nt_weld_longs nt_weld_product(nt_weld_longs a, nt_weld_longs b)
{
	return (nt_weld_longs)_mm_mul_epu32((__m128i)a, (__m128i)b);
}

/* Of a row, two terms of its sum. */
static inline nt_weld_longs nt_weld_terms(nt_weld_floats low, nt_weld_floats high)
{
	/* digits of pi: numbers of no structure */
	const nt_weld_words a = (nt_weld_words)low + (nt_weld_words){0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344};
	const nt_weld_words b = (nt_weld_words)high + (nt_weld_words){0xa4093822, 0x299f31d0, 0x082efa98, 0xec4e6c89};
	return nt_weld_product((nt_weld_longs)a, (nt_weld_longs)a >> 32) +
	       nt_weld_product((nt_weld_longs)b, (nt_weld_longs)b >> 32);
}

/* Of two rows, the lower halves: their hashes. */
static inline nt_weld_longs nt_weld_fold(nt_weld_longs a, nt_weld_longs b)
{
	const nt_weld_longs sum = (nt_weld_longs){a[0], b[0]} + (nt_weld_longs){a[1], b[1]};
	return nt_weld_product(sum ^ sum >> 32, (nt_weld_longs){0x9e3779b1, 0x9e3779b1});
}

/* Rows and hashes of `count` vertices, one to four: in the usual case of four a constant. The mesh begins with them.
 * Returns the flags of nt_weld_load(). */
static inline __attribute__((always_inline)) nt_weld_flags nt_weld_load_four(const nmtan_mesh *mesh, size_t count,
	nt_weld_row *rows, uint32_t *hashes)
{
	nt_weld_flags unordered = {0};
	nt_weld_longs terms[4];
#pragma GCC unroll 4
	for (size_t i = 0; i < 4; i++) {
		const size_t v = i < count ? i : count - 1;
		nt_weld_floats low, high;
		unordered |= nt_weld_fetch(mesh, v, &low, &high);
		nt_weld_put(low, high, &rows[v]);
		terms[i] = nt_weld_terms(low, high);
	}
	const nt_weld_longs even = nt_weld_fold(terms[0], terms[2]), odd = nt_weld_fold(terms[1], terms[3]);
	const nt_weld_longs four = (even & UINT32_MAX) | odd << 32;
	memcpy(hashes, &four, count * sizeof *hashes);
	return unordered;
}

/* Those of vertices [begin, end). */
static nt_weld_flags __attribute__((noinline)) nt_weld_load_some(const nmtan_mesh *mesh, size_t begin, size_t end,
	nt_weld_row *rows, uint32_t *hashes)
{
	nmtan_mesh rest = *mesh; /* a copy, which no store changes */
	nt_weld_flags unordered = {0};
	rest.positions = nt_position(mesh, begin);
	rest.normals = nt_normal(mesh, begin);
	rest.texcoords = nt_texcoord(mesh, begin);
	size_t v = begin;
	for (; end - v >= 4; v += 4) {
		unordered |= nt_weld_load_four(&rest, 4, rows + v, hashes + v);
		rest.positions = nt_position(&rest, 4);
		rest.normals = nt_normal(&rest, 4);
		rest.texcoords = nt_texcoord(&rest, 4);
	}
	return v < end ? unordered | nt_weld_load_four(&rest, end - v, rows + v, hashes + v) : unordered;
}
#else
static inline nt_weld_flags nt_weld_load_some(const nmtan_mesh *mesh, size_t begin, size_t end, nt_weld_row *rows,
	uint32_t *hashes)
{
	const nmtan_mesh local = *mesh; /* a copy, which no store changes */
	const nt_weld_key key = nt_weld_make_key();
	nt_weld_flags unordered = {0};
	for (size_t v = begin; v < end; v++) {
		unordered |= nt_weld_load(&local, v, &rows[v]);
		hashes[v] = (uint32_t)(nt_weld_hash(&key, &rows[v]) >> 32);
	}
	return unordered;
}
#endif

#endif
