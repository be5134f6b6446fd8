/* SPDX-License-Identifier: MIT */
/*
 * Groups at complex vertices: steps 5 and 6 of the spec page. Edges are paired at each vertex by itself: by comparing
 * its few corners, or, where it is tangled, in order and through a table over all vertices, so that a hub costs as much
 * for each of its corners as any other vertex does.
 */
#include "tangent/fast/complex.h"

#include <string.h>

/* In place of the group of a vertex's first corner: they have to be found. */
#define NT_UNKNOWN (NT_NONE - 1)

/* Pairs */

/*
 * Edge `e` meets the first edge in the other direction that waits at its far end; if there is none it waits
 * there itself. Groups that wait at one vertex all run the same way. They stand in a ring, each with its
 * follower in `across`, and `waiting` knows the last. Its number is counted from `zero`, which is above all numbers of
 * earlier windows; a number below `first` is left from an earlier vertex.
 */
static inline void pair_edge(uint32_t *across, uint32_t *waiting, uint32_t zero, uint32_t first, uint32_t e)
{
	if (*waiting < zero + first) {
		across[e] = NT_WAITS | e;
		*waiting = zero + e;
		return;
	}
	const uint32_t last = *waiting - zero, head = across[last] & ~NT_WAITS;
	if ((last ^ e) % 2 == 0) {
		across[e] = across[last];
		across[last] = NT_WAITS | e;
		*waiting = zero + e;
		return;
	}
	if (head == last)
		*waiting = 0;
	else
		across[last] = across[head];
	across[head] = e / 2;
	across[e] = head / 2;
}

static void pair_tangled(const nt_complex *c, uint32_t begin, uint32_t end)
{
	const uint32_t zero = 2 * c->base + 1;
	for (uint32_t e = 2 * begin; e < 2 * end; e += 2) {
		const uint32_t corner = c->corners[e / 2] & NT_COMPLEX_CORNER, k = corner & 3;
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&c->fast->triangles, corner >> 2, 1, copy);
		pair_edge(c->across, &c->waiting[v[k < 2 ? k + 1 : 0]], zero, 2 * begin, e);
		pair_edge(c->across, &c->waiting[v[k > 0 ? k - 1 : 2]], zero, 2 * begin, e + 1);
	}
}

/* The place of a triangle's corner, if it has one among these. */
static uint32_t place_of(const nt_complex *c, uint32_t begin, uint32_t end, uint32_t triangle)
{
	for (uint32_t count = end - begin; count > 0;) {
		const uint32_t middle = begin + count / 2;
		if ((c->corners[middle] & NT_COMPLEX_CORNER) >> 2 < triangle) {
			begin = middle + 1;
			count -= count / 2 + 1;
		} else {
			count /= 2;
		}
	}
	return begin < end && (c->corners[begin] & NT_COMPLEX_CORNER) >> 2 == triangle ? begin : NT_WAITS;
}

/* Edges that the published sort pairs otherwise. */
static void pair_unsorted(const nt_complex *c, uint32_t begin, uint32_t end)
{
	for (uint32_t e = 2 * begin; e < 2 * end; e++) {
		const uint32_t corner = c->corners[e / 2] & NT_COMPLEX_CORNER, k = corner & 3;
		const uint32_t edge = 3 * (corner >> 2) + (e % 2 == 0 ? k : k > 0 ? k - 1 : 2);
		uint32_t neighbour;
		if (nt_unsorted_neighbour(&c->fast->unsorted, edge, &neighbour))
			c->across[e] = place_of(c, begin, end, neighbour);
	}
}

/* No edge occurs twice in one direction, so that each has one other at most, whatever the order. */
static void pair_plain(const nt_complex *c, uint32_t begin, uint32_t count)
{
	uint32_t *across = c->across + 2 * begin, after[NT_FAN_DEPTH], before[NT_FAN_DEPTH];
	for (uint32_t i = 0; i < count; i++) {
		after[i] = across[2 * i];
		before[i] = across[2 * i + 1];
	}
	for (uint32_t i = 0; i < count; i++) {
		uint32_t next = NT_NONE, previous = NT_NONE;
		for (uint32_t j = 0; j < count; j++) {
			next = after[i] == before[j] ? begin + j : next;
			previous = before[i] == after[j] ? begin + j : previous;
		}
		across[2 * i] = next;
		across[2 * i + 1] = previous;
	}
}

static void pair_vertex(const nt_complex *c, size_t v, uint32_t begin, uint32_t end)
{
	if (nt_is_tangled(c, v)) {
		pair_tangled(c, begin, end);
		if (c->fast->unsorted.count > 0)
			pair_unsorted(c, begin, end);
	} else {
		pair_plain(c, begin, end - begin);
	}
}

/* Groups */

/* Takes corner i, if it is one, free, and of this orientation, into the group that begins at `seed`. A triangle without
 * a frame takes the orientation, unless it has one already. */
static inline bool join_group(const nt_complex *c, uint32_t i, uint32_t seed, uint32_t plus, bool decides)
{
	if (i >= NT_WAITS || c->group[i] != NT_NONE)
		return false;
	uint32_t *corner = &c->corners[i];
	if (*corner & NT_COMPLEX_ANY) {
		uint8_t *flags = &c->fast->flags[(*corner & NT_COMPLEX_CORNER) >> 2];
		const unsigned orient = plus ? NT_TRIANGLE_ORIENT : 0;
		if (decides && *flags & NT_TRIANGLE_DECIDED && (*flags & NT_TRIANGLE_ORIENT) != orient)
			return false;
		if (decides)
			*flags = (uint8_t)((*flags & ~NT_TRIANGLE_ORIENT) | orient | NT_TRIANGLE_DECIDED);
		*corner = (*corner & ~NT_COMPLEX_PLUS) | plus;
	} else if ((*corner & NT_COMPLEX_PLUS) != plus) {
		return false;
	}
	c->group[i] = seed;
	return true;
}

/* The group that begins at a corner, if that is free and has a frame. Corners form rows or rings: they are
 * followed both ways. `decides`: triangles without a frame have both orientations to choose from. */
static inline NT_ALWAYS_INLINE void flood_group(const nt_complex *c, uint32_t seed, bool decides)
{
	const uint32_t corner = c->corners[seed];
	if (c->group[seed] != NT_NONE || corner & NT_COMPLEX_ANY)
		return;
	c->group[seed] = seed;
	for (uint32_t way = 0; way < 2; way++)
		for (uint32_t i = c->across[2 * seed + way]; join_group(c, i, seed, corner & NT_COMPLEX_PLUS, decides);)
			i = c->across[2 * i + way];
}

void nt_find_groups(const nt_complex *c, size_t v)
{
	const uint32_t begin = nt_first_place(c, v), end = nt_last_place(c, v);
	if (c->order && c->group[begin] != NT_UNKNOWN)
		return;
	pair_vertex(c, v, begin, end);
	memset(c->group + begin, 0xff, (end - begin) * sizeof *c->group);
	for (uint32_t i = begin; i < end; i++)
		flood_group(c, i, false);
}

void nt_find_groups_in_order(nt_complex *c)
{
	for (size_t v = 0; v < c->vertex_count; v++) {
		const uint32_t begin = nt_first_place(c, v), end = nt_last_place(c, v);
		uint32_t kinds = 0;
		for (uint32_t i = begin; i < end; i++)
			kinds |= c->corners[i];
		if (!(kinds & NT_COMPLEX_ANY)) {
			c->group[begin] = NT_UNKNOWN;
			continue;
		}
		pair_vertex(c, v, begin, end);
		memset(c->group + begin, 0xff, (end - begin) * sizeof *c->group);
		for (uint32_t i = begin; i < end; i++)
			c->corners[i] |= c->corners[i] & NT_COMPLEX_ANY ? 0 : NT_COMPLEX_SEED;
	}
	for (size_t i = 0; i < c->corner_count; i++)
		if (c->corners[c->order[i]] & NT_COMPLEX_SEED)
			flood_group(c, c->order[i], true);
}
