/* SPDX-License-Identifier: MIT */
/*
 * From rows of floats to lanes by component and back, in vectors of the instruction set's own width. By hand, because
 * what gcc 12 makes of the plain loops goes by single floats.
 *
 * Four rows of four floats are turned in each 16-byte part of four vectors alone, since a shuffle inside the parts
 * is the cheapest there is. So wider vectors have their rows in "turned places". Included by lanes.h.
 */
#ifndef NT_TANGENT_FAST_TURN_H
#define NT_TANGENT_FAST_TURN_H

#include <stdint.h>
#include <string.h>
#include "tangent/fast/parts.h"
#if defined(__AVX2__) || defined(NT_SET_AVX2)
#include <immintrin.h>
#endif

/* Elements of two vectors, one after the other, for shuffles: every other 16-byte part; every other element; one
 * vector's elements in turned places, and out of them. Without vectors a lane is a value, and nothing is turned. */
#if !NT_VECTORS || defined(NT_SET_LEAST)
#define WIDTH 1
#elif defined(__AVX512F__) || defined(NT_SET_AVX512)
#define WIDTH 16
#define IN_PARTS(a, b, c, d) \
	IN_PART(0, a, b, c, d), IN_PART(4, a, b, c, d), IN_PART(8, a, b, c, d), IN_PART(12, a, b, c, d)
#define LOW_PAIRS 0, 8, 2, 10, 4, 12, 6, 14
#define HIGH_PAIRS 1, 9, 3, 11, 5, 13, 7, 15
#define EVEN_PARTS 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27
#define ODD_PARTS 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31
#define EVEN 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30
#define ODD 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31
#define TURNED 0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15
#define UNTURNED TURNED
#elif defined(__AVX2__) || defined(NT_SET_AVX2)
#define WIDTH 8
#define IN_PARTS(a, b, c, d) IN_PART(0, a, b, c, d), IN_PART(4, a, b, c, d)
#define LOW_PAIRS 0, 4, 2, 6
#define HIGH_PAIRS 1, 5, 3, 7
#define EVEN_PARTS 0, 1, 2, 3, 8, 9, 10, 11
#define ODD_PARTS 4, 5, 6, 7, 12, 13, 14, 15
#define EVEN 0, 2, 4, 6, 8, 10, 12, 14
#define ODD 1, 3, 5, 7, 9, 11, 13, 15
#define TURNED 0, 2, 4, 6, 1, 3, 5, 7
#define UNTURNED 0, 4, 1, 5, 2, 6, 3, 7
#else
#define WIDTH 4
#define IN_PARTS(a, b, c, d) a, b, c, d
#define LOW_PAIRS 0, 2
#define HIGH_PAIRS 1, 3
#define EVEN 0, 2, 4, 6
#define ODD 1, 3, 5, 7
#define TURNED 0, 1, 2, 3
#define UNTURNED TURNED
#endif

/* The same four elements in every part: 0 to 3 of the first vector, 4 to 7 of the second. */
#define IN_PART(part, a, b, c, d) FROM(part, a), FROM(part, b), FROM(part, c), FROM(part, d)
#define FROM(part, i) ((part) + (i) % 4 + (i) / 4 * WIDTH)

/* All bits of the lanes where a condition holds, 0 in the others. */
#if WIDTH > 1
typedef uint32_t lanes __attribute__((vector_size(4 * WIDTH)));
typedef uint64_t lane_pairs __attribute__((vector_size(4 * WIDTH)));
#define LANES_WHERE(condition) ((lanes)(condition))
#else
typedef uint32_t lanes;
#define LANES_WHERE(condition) (0u - (uint32_t)(condition))
#endif

static inline NT_ALWAYS_INLINE lanes load_lanes(const void *from)
{
	lanes result;
	memcpy(&result, from, sizeof result);
	return result;
}

/* Whether a lane is not 0. By name in the widest vectors: gcc 12 makes a sum of halves of it. */
static inline bool any_lane(lanes a)
{
#if WIDTH == 16
	return _mm512_test_epi32_mask((__m512i)a, (__m512i)a) != 0;
#elif WIDTH > 1
	uint32_t any = 0;
	for (int i = 0; i < WIDTH; i++)
		any |= a[i];
	return any != 0;
#else
	return a != 0;
#endif
}

/* Four rows of four floats, turned, in each part. */
static inline NT_ALWAYS_INLINE void turn(lanes rows[4])
{
#if WIDTH > 1
	const lanes ab01 = __builtin_shufflevector(rows[0], rows[1], IN_PARTS(0, 4, 1, 5));
	const lanes ab23 = __builtin_shufflevector(rows[0], rows[1], IN_PARTS(2, 6, 3, 7));
	const lanes cd01 = __builtin_shufflevector(rows[2], rows[3], IN_PARTS(0, 4, 1, 5));
	const lanes cd23 = __builtin_shufflevector(rows[2], rows[3], IN_PARTS(2, 6, 3, 7));
	rows[0] = (lanes)__builtin_shufflevector((lane_pairs)ab01, (lane_pairs)cd01, LOW_PAIRS);
	rows[1] = (lanes)__builtin_shufflevector((lane_pairs)ab01, (lane_pairs)cd01, HIGH_PAIRS);
	rows[2] = (lanes)__builtin_shufflevector((lane_pairs)ab23, (lane_pairs)cd23, LOW_PAIRS);
	rows[3] = (lanes)__builtin_shufflevector((lane_pairs)ab23, (lane_pairs)cd23, HIGH_PAIRS);
#else
	(void)rows; /* one row is its components */
#endif
}

/* One vector of four floats from each place. */
static inline NT_ALWAYS_INLINE lanes load_parts(const float *const *from)
{
#if WIDTH <= 4
	return load_lanes(from[0]);
#else
	nt_float4 parts[WIDTH / 4];
	for (size_t i = 0; i < WIDTH / 4; i++)
		memcpy(&parts[i], from[i], sizeof parts[i]);
#if WIDTH == 8
	return (lanes)__builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3, 4, 5, 6, 7);
#else
	return (lanes)__builtin_shufflevector(__builtin_shufflevector(parts[0], parts[1], 0, 1, 2, 3, 4, 5, 6, 7),
		__builtin_shufflevector(parts[2], parts[3], 0, 1, 2, 3, 4, 5, 6, 7),
		0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
#endif
}

/* Four floats of each of WIDTH rows, by component. */
static inline NT_ALWAYS_INLINE void load_turned(const float *const rows[WIDTH], lanes four[4])
{
	for (size_t j = 0; j < 4; j++)
		four[j] = WIDTH > 1 ? load_parts(rows + j * (WIDTH / 4)) : load_lanes(rows[0] + j);
	turn(four);
}

/* One vector's elements in turned places, and out of them. */
static inline lanes in_turn(lanes a)
{
#if WIDTH > 1
	return __builtin_shufflevector(a, a, TURNED);
#else
	return a;
#endif
}

static inline lanes out_of_turn(lanes a)
{
#if WIDTH > 1
	return __builtin_shufflevector(a, a, UNTURNED);
#else
	return a;
#endif
}

/* The place of a lane's row before and after turn(). */
static inline size_t turned_place(size_t lane)
{
	const size_t in_vector = lane % WIDTH;
	return lane - in_vector + in_vector % 4 * (WIDTH / 4) + in_vector / 4;
}

/* The same as the first float of a lane's row of four. */
#define ROW(lane) (4 * ((lane) - (lane) % WIDTH + (lane) % WIDTH % 4 * (WIDTH / 4) + (lane) % WIDTH / 4))
#define FOUR_ROWS(lane) ROW(lane), ROW((lane) + 1), ROW((lane) + 2), ROW((lane) + 3)
static const uint8_t turned_rows[NT_TRIANGLES] = {FOUR_ROWS(0), FOUR_ROWS(4), FOUR_ROWS(8), FOUR_ROWS(12),
	FOUR_ROWS(16), FOUR_ROWS(20), FOUR_ROWS(24), FOUR_ROWS(28)};

/* Lanes of the whole vectors that hold `count`. */
static inline size_t whole_lanes(size_t count)
{
	return (count + WIDTH - 1) / WIDTH * WIDTH;
}

/* Four components of whole vectors of lanes, `stride` apart, become rows in turned places. */
static inline NT_ALWAYS_INLINE void interleave(const float *in, size_t stride, size_t lane_count, float *out)
{
	for (size_t i = 0; i < lane_count; i += WIDTH) {
		lanes four[4];
		for (size_t j = 0; j < 4; j++)
			four[j] = load_lanes(in + stride * j + i);
		turn(four);
		for (size_t j = 0; j < 4; j++)
			memcpy(out + 4 * i + WIDTH * j, &four[j], sizeof four[j]);
	}
}

#if WIDTH <= 4
/* The rows of one corner of WIDTH triangles, by component, `stride` apart. */
static inline NT_ALWAYS_INLINE void gather_corner(const nt_weld_row *rows, const uint32_t *ids, float *out,
	size_t stride)
{
	for (size_t half = 0; half < 8; half += 4) {
		const float *from[WIDTH];
		lanes four[4];
		for (size_t j = 0; j < WIDTH; j++)
			from[j] = (const float *)&rows[ids[3 * j]] + half;
		load_turned(from, four);
		for (size_t j = 0; j < 4; j++)
			memcpy(out + stride * (half + j), &four[j], sizeof four[j]);
	}
}
#else
/* As many rows as a vector holds: that of one triangle and, in the widest vectors, of the fourth one after it. */
static inline NT_ALWAYS_INLINE lanes load_rows(const nt_weld_row *rows, const uint32_t *ids)
{
	typedef uint32_t one_row __attribute__((vector_size(sizeof(nt_weld_row))));
	one_row first;
	memcpy(&first, &rows[ids[0]], sizeof first);
#if WIDTH == 8
	return first;
#else
	/* by name: gcc 12 loads the second row first, and shuffles */
	return (lanes)_mm512_inserti64x4(_mm512_castsi256_si512((__m256i)first),
		_mm256_loadu_si256((const __m256i *)&rows[ids[3 * 4]]), 1);
#endif
}

/* The rows of one corner of WIDTH triangles, by component, `stride` apart. */
static inline NT_ALWAYS_INLINE void gather_corner(const nt_weld_row *rows, const uint32_t *ids, float *out,
	size_t stride)
{
	lanes low[4], high[4];
	for (size_t j = 0; j < 4; j++) {
		low[j] = load_rows(rows, ids + 3 * j);
		high[j] = load_rows(rows, ids + 3 * (WIDTH / 2 + j));
	}
	turn(low);
	turn(high);
	for (size_t j = 0; j < 4; j++) {
		const lanes first = __builtin_shufflevector(low[j], high[j], EVEN_PARTS);
		const lanes second = __builtin_shufflevector(low[j], high[j], ODD_PARTS);
		memcpy(out + stride * j, &first, sizeof first);
		memcpy(out + stride * (4 + j), &second, sizeof second);
	}
}
#endif

/* Rows of the corners of `count` triangles, [3][8][stride]; up to `lane_count` the lanes behind repeat the last one. */
static void NT_NOINLINE gather_lanes(const nt_weld_row *rows, const uint32_t *ids, size_t count, size_t lane_count,
	float *NT_RESTRICT out, size_t stride)
{
	uint32_t padded[3 * NT_TRIANGLES];
	if (count < lane_count) {
		for (size_t i = 0; i < lane_count; i++)
			memcpy(padded + 3 * i, ids + 3 * (i < count ? i : count - 1), 3 * sizeof *ids);
		ids = padded;
	}
	for (size_t k = 0; k < 3; k++)
		for (size_t lane = 0; lane + WIDTH <= lane_count; lane += WIDTH)
			gather_corner(rows, ids + 3 * lane + k, out + 8 * stride * k + lane, stride);
}

#endif
