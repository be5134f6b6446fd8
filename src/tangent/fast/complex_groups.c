/* SPDX-License-Identifier: MIT */
/*
 * Groups at complex vertices: steps 5 and 6 of the spec page. Edges are paired at each vertex by itself: by comparing
 * its few corners, or, where it is tangled, in order and through a table over all vertices, so that a hub costs as much
 * for each of its corners as any other vertex does.
 */
#include "tangent/fast/complex_groups.h"

#include <string.h>

/* A value of nt_batch.across that is no corner: what is left of it is another edge that waits. */
#define NT_WAITS ((uint32_t)1 << 31)

bool nt_batch_alloc(const nt_complex *c, size_t capacity, nt_batch *batch)
{
	batch->across = nt_borrowed_alloc(c->memory, capacity + 1, 2 * sizeof *batch->across);
	batch->group = nt_borrowed_alloc(c->memory, capacity, sizeof *batch->group);
	const bool quads = c->fast->triangles.cuts;
	batch->results = quads ? nt_borrowed_alloc(c->memory, capacity, sizeof *batch->results) : NULL;
	return batch->across && batch->group && (!quads || batch->results);
}

/* Pairs */

/*
 * Edge `e` meets the first edge in the other direction that waits at its far end; if there is none it waits
 * there itself. Those that wait at one vertex all run the same way. They stand in a ring, each with its
 * follower in `across`, and `waiting` knows the last. There edges are counted over all batches, from 1, so that what
 * has waited there since another vertex's turn has a number that is not above `past`.
 */
static void pair_edge(nt_batch *b, uint32_t *waiting, uint32_t past, uint32_t e)
{
	uint32_t *across = b->across;
	const uint32_t one = 2 * b->first + 1;
	if (*waiting <= past) {
		across[e] = NT_WAITS | e;
		*waiting = e + one;
		return;
	}
	const uint32_t last = *waiting - one, head = across[last] & ~NT_WAITS;
	if ((last ^ e) % 2 == 0) {
		across[e] = across[last];
		across[last] = NT_WAITS | e;
		*waiting = e + one;
		return;
	}
	if (head == last)
		*waiting = 0;
	else
		across[last] = across[head];
	across[head] = e / 2;
	across[e] = head / 2;
}

/* The vertices after and before a corner in its triangle. */
static inline void find_ends(const nt_complex *c, uint32_t corner, uint32_t *after, uint32_t *before)
{
	static const uint8_t next[3] = {1, 2, 0}, previous[3] = {2, 0, 1};
	const nt_triangles *triangles = &c->fast->triangles;
	*after = triangles->ids[nt_triangle_corner(triangles, corner >> 2, next[corner & 3])];
	*before = triangles->ids[nt_triangle_corner(triangles, corner >> 2, previous[corner & 3])];
}

static void pair_tangled(const nt_complex *c, nt_batch *b, uint32_t begin, uint32_t end)
{
	for (uint32_t place = begin; place < end; place++) {
		const uint32_t e = 2 * (place - b->first);
		uint32_t after, before;
		find_ends(c, c->corners[place], &after, &before);
		pair_edge(b, &c->waiting[after], 2 * begin, e);
		pair_edge(b, &c->waiting[before], 2 * begin, e + 1);
	}
}

typedef uint32_t four_ids __attribute__((vector_size(16)));

/* No edge occurs twice in one direction, so that each has one other at most, whatever the order. `fours`: corners / 4,
 * rounded up. */
static inline __attribute__((always_inline)) void pair_plain(const nt_complex *c, nt_batch *b, uint32_t begin,
	uint32_t count, int fours)
{
	uint32_t after[NT_FAN_DEPTH], before[NT_FAN_DEPTH], found[NT_FAN_DEPTH], back[NT_FAN_DEPTH + 1] = {0};
	for (uint32_t i = 0; i < count; i++)
		find_ends(c, c->corners[begin + i], &after[i], &before[i]);
	/* beyond the edge from each corner's next vertex: a corner, counted from 1; 0: none */
	four_ids ends[NT_FAN_DEPTH / 4], beyond[NT_FAN_DEPTH / 4];
	for (int j = 0; j < fours; j++) {
		memcpy(&ends[j], after + 4 * j, sizeof *ends);
		beyond[j] = (four_ids){0};
	}
	for (uint32_t i = 0; i < count; i++)
		for (int j = 0; j < fours; j++)
			beyond[j] |= (four_ids)(ends[j] == before[i]) & (i + 1);
	memcpy(found, beyond, (size_t)fours * sizeof *beyond);
	for (uint32_t i = 0; i < count; i++)
		back[found[i]] = i + 1;
	const uint32_t at = begin - b->first;
	for (uint32_t i = 0; i < count; i++) {
		b->across[2 * (at + i)] = found[i] ? at + found[i] - 1 : NT_NONE;
		b->across[2 * (at + i) + 1] = back[i + 1] ? at + back[i + 1] - 1 : NT_NONE;
	}
}

static void pair_vertex(const nt_complex *c, nt_batch *b, size_t v)
{
	const uint32_t begin = nt_first_place(c, v), end = nt_last_place(c, v);
	if (nt_is_tangled(c, v))
		pair_tangled(c, b, begin, end);
	else if (end - begin <= 4)
		pair_plain(c, b, begin, end - begin, 1);
	else if (end - begin <= 8)
		pair_plain(c, b, begin, end - begin, 2);
	else
		pair_plain(c, b, begin, end - begin, 3);
}

/* Groups */

/* Takes corner i into the group, if it is one, free, and of the group's orientation. A triangle without a frame and
 * undecided is of either. */
static bool join_group(const nt_complex *c, nt_batch *b, uint32_t i, uint32_t group, unsigned orient)
{
	if (i >= NT_WAITS || b->group[i] != NT_NONE)
		return false;
	const unsigned flags = c->fast->flags[b->corners[i] >> 2];
	const bool open = (flags & (NT_TRIANGLE_ANY | NT_TRIANGLE_DECIDED)) == NT_TRIANGLE_ANY;
	if (!open && (flags & NT_TRIANGLE_ORIENT) != orient)
		return false;
	b->group[i] = group;
	return true;
}

static inline void decide(const nt_complex *c, const nt_batch *b, uint32_t i, unsigned orient)
{
	uint8_t *flags = &c->fast->flags[b->corners[i] >> 2];
	if (*flags & NT_TRIANGLE_ANY)
		*flags = (uint8_t)((*flags & ~NT_TRIANGLE_ORIENT) | orient | NT_TRIANGLE_DECIDED);
}

/* The group that begins at a corner, if that is free and has a frame. Corners form rows or rings: they are
 * followed both ways. `decides`: triangles without a frame take its orientation. */
static inline __attribute__((always_inline)) void flood_group(const nt_complex *c, nt_batch *b, uint32_t seed,
	bool decides)
{
	if (b->group[seed] != NT_NONE)
		return;
	const unsigned flags = c->fast->flags[b->corners[seed] >> 2];
	if (flags & NT_TRIANGLE_ANY)
		return;
	b->group[seed] = seed;
	for (uint32_t way = 0; way < 2; way++)
		for (uint32_t i = b->across[2 * seed + way]; join_group(c, b, i, seed, flags & NT_TRIANGLE_ORIENT);) {
			if (decides)
				decide(c, b, i, flags & NT_TRIANGLE_ORIENT);
			i = b->across[2 * i + way];
		}
}

void nt_find_groups(const nt_complex *c, nt_batch *b, size_t v)
{
	const uint32_t begin = nt_first_place(c, v), count = nt_last_place(c, v) - begin, first = begin - b->first;
	uint32_t *group = b->group + first;
	if (c->decided && c->decided[begin] != NT_WRITTEN) {
		for (uint32_t i = 0; i < count; i++)
			group[i] = c->decided[begin + i] == NT_NONE ? NT_NONE : c->decided[begin + i] - b->first;
		return;
	}
	pair_vertex(c, b, v);
	memset(group, 0xff, count * sizeof *group);
	for (uint32_t i = first; i < first + count; i++)
		flood_group(c, b, i, false);
}

void nt_find_groups_in_order(const nt_complex *c, nt_batch *all)
{
	for (size_t v = 0; v < c->vertex_count; v++) {
		const uint32_t begin = nt_first_place(c, v), end = nt_last_place(c, v);
		unsigned flags = 0;
		for (uint32_t i = begin; i < end; i++)
			flags |= c->fast->flags[c->corners[i] >> 2];
		const bool any = flags & NT_TRIANGLE_ANY;
		for (uint32_t i = begin; i < end; i++)
			all->group[i] = any ? NT_NONE : NT_WRITTEN;
		if (any)
			pair_vertex(c, all, v);
	}
	for (size_t i = 0; i < c->corner_count; i++)
		flood_group(c, all, c->order[i], true);
}

void nt_number_groups(nt_batch *b)
{
	uint32_t *numbers = b->across; /* of groups, by the corners that they begin with */
	b->group_count = 0;
	for (uint32_t i = 0; i < b->count; i++)
		if (b->group[i] == i)
			numbers[i] = b->group_count++;
	for (uint32_t i = 0; i < b->count; i++)
		if (b->group[i] < NT_WRITTEN)
			b->group[i] = numbers[b->group[i]];
}

void nt_list_members(nt_batch *b)
{
	b->members = b->across;
	b->bounds = b->across + b->count;
	/* counted two places ahead: filling then moves each bound to where it belongs */
	uint32_t *at = b->bounds + 1;
	memset(b->bounds, 0, (b->group_count + 2) * sizeof *b->bounds);
	for (uint32_t i = 0; i < b->count; i++)
		if (b->group[i] < NT_WRITTEN)
			at[b->group[i] + 1]++;
	for (uint32_t g = 1; g <= b->group_count; g++)
		at[g] += at[g - 1];
	for (uint32_t i = 0; i < b->count; i++)
		if (b->group[i] < NT_WRITTEN)
			b->members[at[b->group[i]]++] = i;
}
