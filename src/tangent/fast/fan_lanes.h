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

/* The loops over a fan are worth their code, but not where each byte of it is sent to a browser. */
#ifdef __wasm__
#define UNROLL
#else
#define UNROLL NT_UNROLL(8)
#endif

/* The 16-bit halves of a set in which a and b differ: all bits of such a half, 0 in the others. */
static inline lanes halves_differ(lanes set, lanes a, lanes b)
{
#if WIDTH > 1
	typedef uint16_t lane_halves __attribute__((vector_size(4 * WIDTH)));
	return set & (lanes)((lane_halves)a != (lane_halves)b);
#else
	const lanes other = a ^ b;
	return set & (LANES_WHERE((other & 0xffff) != 0) >> 16 | LANES_WHERE(other >> 16 != 0) << 16);
#endif
}

/* Corner k of WIDTH vertices of so many corners; where one has fewer, voids above all numbers that accumulate gives to
 * voids. Of an entry the bits of `mask` count. */
static inline NT_ALWAYS_INLINE void load_corners(const nt_fan_entry *entries, uint32_t k, lanes degree,
	lanes mask, lanes *next, lanes *previous)
{
	const lanes there = LANES_WHERE(degree > k);
	const nt_fan_entry *from = entries + k * NT_FAN_LANES;
#if WIDTH > 1
	const lanes low = load_lanes(from), high = load_lanes(from + WIDTH / 2);
	*next = __builtin_shufflevector(low, high, EVEN) & mask;
	*previous = __builtin_shufflevector(low, high, ODD) & mask;
#else
	*next = from->next & mask;
	*previous = from->previous & mask;
#endif
	*next = (*next & there) | ((NT_ENTRY_VOID | 1u << 28 | k << 16 | k) & ~there);
	*previous = (*previous & there) | ((NT_ENTRY_VOID | 3u << 28 | k << 16 | k) & ~there);
}

/* -1 for vertices at which a directed edge occurs twice, whatever the orientations in bit 31. */
static lanes NT_NOINLINE find_twice(const nt_fan_entry *entries, uint32_t depth, lanes degree, lanes mask)
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

/* The components of corners that are linked: bit j of linked[i] for each later neighbour j. Voids are none. By
 * elimination: a corner hands its links to the later ones it is linked with; one that has none when its turn comes is
 * the last of its component. */
static inline NT_ALWAYS_INLINE lanes count_components(lanes linked[NT_FAN_DEPTH], uint32_t depth)
{
	lanes count = {0};
	UNROLL
	for (uint32_t a = 0; a < depth; a++) {
		const lanes mine = linked[a];
		UNROLL
		for (uint32_t b = a + 1; b < depth; b++)
			linked[b] |= LANES_WHERE((mine & 1u << b) != 0) & mine;
		count -= LANES_WHERE((mine & (((1u << depth) - (2u << a)) | NT_ENTRY_VOID)) == 0);
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
static inline NT_ALWAYS_INLINE lanes count_fans_of(const nt_fan_entry *entries, const uint32_t depth,
	lanes degree, lanes mask)
{
	lanes next[NT_FAN_DEPTH], previous[NT_FAN_DEPTH];
	lanes linked[NT_FAN_DEPTH];
	lanes halves[NT_FAN_DEPTH]; /* those of next and of previous in which vertices differ most, without
	                               orientation */
	lanes distinct = ~(lanes){0};
	UNROLL
	for (uint32_t k = 0; k < depth; k++) {
		load_corners(entries, k, degree, mask, &next[k], &previous[k]);
		halves[k] = (next[k] & 0xffff) | previous[k] << 16;
		linked[k] = (next[k] & NT_ENTRY_VOID) | ((1u << depth) - (2u << k));
	}
	/* links across shared edges; edges whose low halves differ are not the same */
	UNROLL
	for (uint32_t b = 0; b < depth; b++) {
		lanes from_earlier = ~(lanes){0}; /* short chains: one for all took 15 to 40 cycles more a block */
		UNROLL
		for (uint32_t a = 0; a < b; a++) {
			const lanes apart = LANES_WHERE(next[a] != previous[b]) & LANES_WHERE(next[b] != previous[a]);
			linked[a] &= ~(apart & 1u << b);
			from_earlier = halves_differ(from_earlier, halves[a], halves[b]);
		}
		distinct &= from_earlier;
	}
	const lanes count = count_components(linked, depth);
	return !any_lane(~distinct) ? count : count | (find_twice(entries, depth, degree, mask) & DOUBTFUL);
}

/* The usual depths are worth a loop without branches each. */
static lanes NT_NOINLINE count_fans(const nt_fan_entry *entries, uint32_t depth, lanes degree, lanes mask)
{
	switch (depth) {
#ifndef __wasm__
	case 2: return count_fans_of(entries, 2, degree, mask);
	case 3: return count_fans_of(entries, 3, degree, mask);
	case 4: return count_fans_of(entries, 4, degree, mask);
	case 5: return count_fans_of(entries, 5, degree, mask);
	case 6: return count_fans_of(entries, 6, degree, mask);
	case 7: return count_fans_of(entries, 7, degree, mask);
	case 8: return count_fans_of(entries, 8, degree, mask);
#endif
	default: return count_fans_of(entries, depth, degree, mask);
	}
}

#endif
