/* SPDX-License-Identifier: MIT */
/*
 * The fans of as many vertices at a time as a vector has lanes: how many a vertex has, from its corners' neighbours.
 * Included by settle.h.
 */
#ifndef NT_TANGENT_FAST_FAN_LANES_H
#define NT_TANGENT_FAST_FAN_LANES_H

#include "tangent/fast/turn.h"
#include "topology/adjacency.h"

/* The degree of a hub, whose fans are not looked at; more fans than a vertex has. */
#define HUB UINT32_MAX
#define DOUBTFUL ((uint32_t)1 << 16)

/* The loops over a fan are worth their code, but not if each byte of it is sent to a browser, or hardly used. */
#if defined(__wasm__) || defined(NT_SET_LEAST)
#define LEAST_CODE
#define UNROLL
#else
#define UNROLL NT_UNROLL(8)
#endif

/* Large meshes have few blocks of these depths: 8 KB of code for 1 % of their time. */
#ifdef NT_SMALL_CODE
#define RARE_IS_WORTH_CODE(entries) ((entries).are_narrow)
#else
#define RARE_IS_WORTH_CODE(entries) true
#endif

/* Sets of the 16-bit halves of lanes. By name where there are masks: gcc 12 makes vectors of these and masks of vectors
 * at each step, which takes 1.4 times as long. */
#if WIDTH == 16
typedef __mmask32 half_set;
#define ALL_HALVES ((half_set)-1)
#define ARE_ALL(set) ((set) == ALL_HALVES)

/* Leaves those of a set in which a and b are not the same. */
static inline half_set keep_apart(half_set set, lanes a, lanes b)
{
	return _mm512_mask_cmpneq_epi16_mask(set, (__m512i)a, (__m512i)b);
}

/* a with bits that it has not, in the halves in which b and c are the same. */
static inline lanes with_where_same(lanes a, lanes b, lanes c, uint32_t bits)
{
	return (lanes)_mm512_mask_add_epi16((__m512i)a, _mm512_cmpeq_epi16_mask((__m512i)b, (__m512i)c),
		(__m512i)a, _mm512_set1_epi32((int)bits));
}

/* a with those lanes of b that have a bit. */
static inline lanes with_having(lanes a, lanes b, uint32_t bit)
{
	const __mmask16 having = _mm512_test_epi32_mask((__m512i)b, _mm512_set1_epi32((int)bit));
	return (lanes)_mm512_mask_or_epi32((__m512i)a, having, (__m512i)a, (__m512i)b);
}
#else
static inline lanes same_halves(lanes a, lanes b)
{
#if WIDTH > 1
	typedef uint16_t lane_halves __attribute__((vector_size(4 * WIDTH)));
	return (lanes)((lane_halves)a == (lane_halves)b);
#else
	const lanes other = a ^ b;
	return LANES_WHERE((other & 0xffff) == 0) >> 16 | LANES_WHERE(other >> 16 == 0) << 16;
#endif
}

typedef lanes half_set;
#define ALL_HALVES (~(half_set){0})
#define ARE_ALL(set) (!any_lane(~(set)))

static inline half_set keep_apart(half_set set, lanes a, lanes b)
{
	return set & ~same_halves(a, b);
}

static inline lanes with_where_same(lanes a, lanes b, lanes c, uint32_t bits)
{
	return a | (same_halves(b, c) & bits);
}

static inline lanes with_having(lanes a, lanes b, uint32_t bit)
{
	return a | (LANES_WHERE((b & bit) != 0) & b);
}
#endif

/* Entries of vertices that follow one another, from the first one's first: wide or narrow ones. */
typedef struct vertex_entries {
	bool are_narrow;
	const nt_fan_entry *wide;
	const uint32_t *narrow;
	size_t step;
} vertex_entries;

static inline vertex_entries entries_at(const nt_adjacency *a, size_t vertex)
{
	if (nt_adjacency_is_narrow(a))
		return (vertex_entries){.are_narrow = true, .narrow = a->narrow + vertex, .step = a->step};
	return (vertex_entries){.wide = nt_adjacency_block(a, vertex / NT_FAN_LANES) + vertex % NT_FAN_LANES,
		.step = NT_FAN_LANES};
}

/* Corner k of WIDTH vertices of so many corners; where one has fewer, voids above all numbers that accumulate gives to
 * voids. The bits of `mask` count in an entry. The numbers of narrow entries are in the upper halves. */
static inline NT_ALWAYS_INLINE void load_corners(vertex_entries entries, uint32_t k, lanes degree,
	lanes mask, lanes *next, lanes *previous)
{
	const lanes there = LANES_WHERE(degree > k);
	if (entries.are_narrow) {
		const lanes both = load_lanes(entries.narrow + k * entries.step);
		*next = both << 16 & mask;
		*previous = both & 0xffff0000u & mask;
	} else {
		const nt_fan_entry *from = entries.wide + k * NT_FAN_LANES;
#if WIDTH > 1
		const lanes low = load_lanes(from), high = load_lanes(from + WIDTH / 2);
		*next = __builtin_shufflevector(low, high, EVEN) & mask;
		*previous = __builtin_shufflevector(low, high, ODD) & mask;
#else
		*next = from->next & mask;
		*previous = from->previous & mask;
#endif
	}
	*next = (*next & there) | ((NT_ENTRY_VOID | 1u << 28 | k << 16 | k) & ~there);
	*previous = (*previous & there) | ((NT_ENTRY_VOID | 3u << 28 | k << 16 | k) & ~there);
}

/* -1 for vertices at which a directed edge occurs twice, whatever the orientations in bit 31. */
static lanes NT_NOINLINE find_twice(vertex_entries entries, uint32_t depth, lanes degree, lanes mask)
{
	lanes twice = {0};
	for (uint32_t b = 1; b < depth; b++) {
		lanes next, previous;
		load_corners(entries, b, degree, mask, &next, &previous);
		for (uint32_t a = 0; a < b; a++) {
			lanes other_next, other_previous;
			load_corners(entries, a, degree, mask, &other_next, &other_previous);
			twice |= LANES_WHERE(next << 1 == other_next << 1) |
				LANES_WHERE(previous << 1 == other_previous << 1);
		}
	}
	return twice;
}

/* The components of corners that are linked: bit j, times `unit`, of linked[i] for each later neighbour j. Entries
 * with a bit of `voids` do not count. By elimination: a corner hands its links to the later ones it is linked with;
 * one that has none when its turn comes is the last of its component. */
static inline NT_ALWAYS_INLINE lanes count_components(lanes linked[NT_FAN_DEPTH], uint32_t depth,
	uint32_t unit, uint32_t voids)
{
	lanes count = {0};
	UNROLL
	for (uint32_t a = 0; a < depth; a++) {
		const lanes mine = linked[a];
		UNROLL
		for (uint32_t b = a + 1; b < depth; b++)
			linked[b] = with_having(linked[b], mine, unit << b);
		count -= LANES_WHERE((mine & (unit * ((1u << depth) - (2u << a)) | voids)) == 0);
	}
	return count;
}

/*
 * The fans of WIDTH vertices with at most `depth` corners: how many there are, DOUBTFUL added where a directed edge
 * occurs twice, because there pairs depend on order.
 *
 *   degree   corners of each vertex
 *   mask     the bits of entries that count
 */
static inline NT_ALWAYS_INLINE lanes count_wide_fans_of(vertex_entries entries, const uint32_t depth,
	lanes degree, lanes mask)
{
	lanes next[NT_FAN_DEPTH], previous[NT_FAN_DEPTH];
	lanes linked[NT_FAN_DEPTH];
	lanes halves[NT_FAN_DEPTH]; /* those of next and of previous in which vertices differ most, without
	                               orientation */
	half_set distinct = ALL_HALVES;
	UNROLL
	for (uint32_t k = 0; k < depth; k++) {
		load_corners(entries, k, degree, mask, &next[k], &previous[k]);
		halves[k] = (next[k] & 0xffff) | previous[k] << 16;
		linked[k] = (next[k] & NT_ENTRY_VOID) | ((1u << depth) - (2u << k));
	}
	/* links across shared edges; edges whose low halves differ are not the same */
	UNROLL
	for (uint32_t b = 0; b < depth; b++) {
		half_set from_earlier = ALL_HALVES; /* short chains: one for all took 15 to 40 cycles more a block */
		UNROLL
		for (uint32_t a = 0; a < b; a++) {
			const lanes apart = LANES_WHERE(next[a] != previous[b]) & LANES_WHERE(next[b] != previous[a]);
			linked[a] &= ~(apart & 1u << b);
			from_earlier = keep_apart(from_earlier, halves[a], halves[b]);
		}
		distinct &= from_earlier;
	}
	const lanes count = count_components(linked, depth, 1, NT_ENTRY_VOID);
	return ARE_ALL(distinct) ? count : count | (find_twice(entries, depth, degree, mask) & DOUBTFUL);
}

/* The same of narrow entries, as halves of lanes: next and previous of one corner are compared with previous and next
 * of another at once, and a lane has its links in either half. */
static inline NT_ALWAYS_INLINE lanes count_narrow_fans_of(vertex_entries entries, const uint32_t depth,
	lanes degree, lanes mask)
{
	static const uint32_t both_halves = 0x10001, voids = 0x10001 * (NT_ENTRY_VOID >> 16);
	lanes entry[NT_FAN_DEPTH], plain[NT_FAN_DEPTH]; /* plain: without orientation */
	lanes linked[NT_FAN_DEPTH];
	half_set distinct = ALL_HALVES;
	const lanes mask_of_halves = (mask & 0xffff0000u) | mask >> 16;
	UNROLL
	for (uint32_t k = 0; k < depth; k++) {
		const lanes there = LANES_WHERE(degree > k);
		const lanes both =
			(load_lanes(entries.narrow + k * entries.step) & there) |
			((0x70005000u + both_halves * k) & ~there);
		entry[k] = both & mask_of_halves;
		plain[k] = both & ~(both_halves * (NT_ENTRY_ORIENT >> 16));
		linked[k] = both & voids;
	}
	UNROLL
	for (uint32_t b = 1; b < depth; b++) {
		const lanes other_way = entry[b] << 16 | entry[b] >> 16;
		half_set from_others = ALL_HALVES; /* short chains, as above */
		UNROLL
		for (uint32_t a = 0; a < b; a++) {
			linked[a] = with_where_same(linked[a], entry[a], other_way, both_halves << b);
			from_others = keep_apart(from_others, plain[a], plain[b]);
		}
		distinct &= from_others;
	}
	const lanes count = count_components(linked, depth, both_halves, voids);
	return ARE_ALL(distinct) ? count : count | (find_twice(entries, depth, degree, mask) & DOUBTFUL);
}

static inline NT_ALWAYS_INLINE lanes count_fans_of(vertex_entries entries, const uint32_t depth,
	lanes degree, lanes mask)
{
	return entries.are_narrow ? count_narrow_fans_of(entries, depth, degree, mask)
		: count_wide_fans_of(entries, depth, degree, mask);
}

/* The usual depths are worth a loop without branches each. */
static inline NT_ALWAYS_INLINE lanes count_fans_at(vertex_entries entries, uint32_t depth, lanes degree,
	lanes mask)
{
#ifndef LEAST_CODE
	if (RARE_IS_WORTH_CODE(entries) && depth == 3)
		return count_fans_of(entries, 3, degree, mask);
	if (RARE_IS_WORTH_CODE(entries) && depth == 7)
		return count_fans_of(entries, 7, degree, mask);
	if (RARE_IS_WORTH_CODE(entries) && depth == 8)
		return count_fans_of(entries, 8, degree, mask);
#endif
	switch (depth) {
#ifndef LEAST_CODE
	case 2: return count_fans_of(entries, 2, degree, mask);
	case 4: return count_fans_of(entries, 4, degree, mask);
	case 5: return count_fans_of(entries, 5, degree, mask);
	case 6: return count_fans_of(entries, 6, degree, mask);
#endif
	default: return count_fans_of(entries, depth, degree, mask);
	}
}

static lanes NT_NOINLINE count_wide_fans(const nt_fan_entry *entries, uint32_t depth,
	lanes degree, lanes mask)
{
	return count_fans_at((vertex_entries){.wide = entries}, depth, degree, mask);
}

static lanes NT_NOINLINE count_narrow_fans(const uint32_t *entries, size_t step, uint32_t depth,
	lanes degree, lanes mask)
{
	return count_fans_at((vertex_entries){.are_narrow = true, .narrow = entries, .step = step}, depth,
		degree, mask);
}

#endif
