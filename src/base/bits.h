/* SPDX-License-Identifier: MIT */
/*
 * Arrays of bits, and how many are set before a place: a set of numbers in an eighth of a byte each, and the numbers
 * of its members in ascending order.
 */
#ifndef NT_BASE_BITS_H
#define NT_BASE_BITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include "base/compiler.h"

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
