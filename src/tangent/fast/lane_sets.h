/* SPDX-License-Identifier: MIT */
/*
 * Sets of lanes, which comparisons give: a vector of 0 and -1, or a mask where the instruction set has masks. By name,
 * because gcc 12 makes vectors of masks and masks of vectors at each step. Included by lanes.h.
 */
#ifndef NT_TANGENT_FAST_LANE_SETS_H
#define NT_TANGENT_FAST_LANE_SETS_H

#include <stdbool.h>
#include "tangent/fast/turn.h"

#if WIDTH == 16
#include <immintrin.h>

typedef __mmask16 lane_set;
typedef __mmask32 half_set; /* of the 16-bit halves of lanes */
#define ALL_LANES ((lane_set)-1)
#define ALL_HALVES ((half_set)-1)

/* Those of a set where a and b differ. */
static inline lane_set differ(lane_set set, lanes a, lanes b)
{
	return _mm512_mask_cmpneq_epi32_mask(set, (__m512i)a, (__m512i)b);
}

static inline half_set halves_differ(half_set set, lanes a, lanes b)
{
	return _mm512_mask_cmpneq_epi16_mask(set, (__m512i)a, (__m512i)b);
}

static inline half_set common_halves(half_set a, half_set b)
{
	return _kand_mask32(a, b);
}

static inline lane_set having_bit(lanes a, uint32_t bit)
{
	return _mm512_test_epi32_mask((__m512i)a, _mm512_set1_epi32((int)bit));
}

/* a without that bit, or with the bits of b, in a set. */
static inline lanes without_bit(lanes a, lane_set set, uint32_t bit)
{
	return (lanes)_mm512_mask_and_epi32((__m512i)a, set, (__m512i)a, _mm512_set1_epi32((int)~bit));
}

static inline lanes with_bits(lanes a, lane_set set, lanes b)
{
	return (lanes)_mm512_mask_or_epi32((__m512i)a, set, (__m512i)a, (__m512i)b);
}

/* a with the bits of both halves in those halves in which b and c are the same; they were not there. */
static inline lanes with_bit_where_same(lanes a, lanes b, lanes c, uint32_t halves)
{
	return (lanes)_mm512_mask_add_epi16((__m512i)a, _mm512_cmpeq_epi16_mask((__m512i)b, (__m512i)c), (__m512i)a,
		_mm512_set1_epi32((int)halves));
}

/* One more where a has none of the bits. */
static inline lanes one_more_without(lanes count, lanes a, uint32_t bits)
{
	const __mmask16 without = _mm512_testn_epi32_mask((__m512i)a, _mm512_set1_epi32((int)bits));
	return (lanes)_mm512_mask_add_epi32((__m512i)count, without, (__m512i)count, _mm512_set1_epi32(1));
}

static inline bool all_halves(half_set set)
{
	return set == ALL_HALVES;
}

/* Whether a lane is not 0. */
static inline bool any_lane(lanes a)
{
	return _mm512_test_epi32_mask((__m512i)a, (__m512i)a) != 0;
}
#else
typedef lanes lane_set;
#define ALL_LANES ((lane_set){0} - 1)
#if WIDTH > 1
typedef uint16_t lane_halves __attribute__((vector_size(4 * WIDTH)));
typedef lane_halves half_set;
#define ALL_HALVES ((half_set){0} - 1)

static inline lanes same_halves(lanes a, lanes b)
{
	return (lanes)((lane_halves)a == (lane_halves)b);
}

static inline half_set halves_differ(half_set set, lanes a, lanes b)
{
	return set & (lane_halves)((lane_halves)a != (lane_halves)b);
}
#else
typedef lanes half_set;
#define ALL_HALVES ALL_LANES

static inline lanes same_halves(lanes a, lanes b)
{
	const lanes other = a ^ b;
	return LANES_WHERE((other & 0xffff) == 0) >> 16 | LANES_WHERE(other >> 16 == 0) << 16;
}

static inline half_set halves_differ(half_set set, lanes a, lanes b)
{
	return set & ~same_halves(a, b);
}
#endif

static inline lane_set differ(lane_set set, lanes a, lanes b)
{
	return set & LANES_WHERE(a != b);
}

static inline half_set common_halves(half_set a, half_set b)
{
	return a & b;
}

static inline lane_set having_bit(lanes a, uint32_t bit)
{
	return LANES_WHERE((a & bit) != 0);
}

static inline lanes without_bit(lanes a, lane_set set, uint32_t bit)
{
	return a & ~(set & bit);
}

static inline lanes with_bits(lanes a, lane_set set, lanes b)
{
	return a | (set & b);
}

static inline lanes with_bit_where_same(lanes a, lanes b, lanes c, uint32_t halves)
{
	return a | (same_halves(b, c) & halves);
}

static inline lanes one_more_without(lanes count, lanes a, uint32_t bits)
{
	return count - LANES_WHERE((a & bits) == 0);
}

static inline bool any_lane(lanes a)
{
#if WIDTH > 1
	uint32_t any = 0;
	for (int i = 0; i < WIDTH; i++)
		any |= a[i];
	return any != 0;
#else
	return a != 0;
#endif
}

static inline bool all_halves(half_set set)
{
	return !any_lane(~(lanes)set);
}
#endif

#endif
