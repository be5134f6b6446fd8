/* SPDX-License-Identifier: MIT */
/*
 * Many numbers: the largest of them, and sets of them as bits.
 */
#ifndef NT_BASE_NUMBERS_H
#define NT_BASE_NUMBERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/compiler.h"

/* ---- the largest, by which indices are checked ---- */

/* A loop that stops at the first bad one takes longer, because it cannot look at several at once. */

/* The largest of values[0..count); 0 where there are none. */
uint32_t nt_largest(const uint32_t *values, size_t count);

/* Whether each of values[0..count) is below a limit. */
bool nt_all_below(const uint32_t *values, size_t count, uint32_t limit);

/* ---- bits ---- */

/* A set of numbers in an eighth of a byte each, and how many are set before a place: the numbers of its members in
 * ascending order. */

/* Words for the bits [0, count). */
static inline size_t nt_bit_words(size_t count)
{
	return count / 64 + 1;
}

static inline bool nt_bit(const uint64_t *bits, size_t i)
{
	return bits[i / 64] >> i % 64 & 1;
}

static inline void nt_bit_clear(uint64_t *bits, size_t i)
{
	bits[i / 64] &= ~((uint64_t)1 << i % 64);
}

/* Sets a bit while other threads set others. */
static inline void nt_bit_set(uint64_t *bits, size_t i)
{
	const uint64_t bit = (uint64_t)1 << i % 64;
	if (!(nt_atomic_load(&bits[i / 64], RELAXED) & bit))
		nt_atomic_or(&bits[i / 64], bit, RELAXED);
}

/* The first set bit from `i` on; `count` where there is none before that. */
static inline size_t nt_bit_next(const uint64_t *bits, size_t i, size_t count)
{
	while (i < count) {
		const uint64_t left = bits[i / 64] >> i % 64;
		if (left) {
			i += (size_t)nt_trailing_zeros(left);
			return i < count ? i : count;
		}
		i = (i / 64 + 1) * 64;
	}
	return count;
}

/* ranks [nt_bit_words(count)] receives how many bits before each word are set. Returns how many all are. */
static inline uint32_t nt_bit_ranks(const uint64_t *bits, size_t count, uint32_t *ranks)
{
	uint32_t sum = 0;
	for (size_t word = 0; word < nt_bit_words(count); word++) {
		ranks[word] = sum;
		sum += (uint32_t)nt_count_bits(bits[word]);
	}
	return sum;
}

/* How many bits before `i` are set. */
static inline uint32_t nt_bit_rank(const uint64_t *bits, const uint32_t *ranks, size_t i)
{
	return ranks[i / 64] + (uint32_t)nt_count_bits(bits[i / 64] & (((uint64_t)1 << i % 64) - 1));
}

#endif
