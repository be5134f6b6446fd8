/* SPDX-License-Identifier: MIT */
/*
 * Groups at complex vertices: steps 5 and 6 of the spec page. Edges are paired at each vertex by itself, in order,
 * through a table over all vertices, so that a hub costs as much for each of its corners as any other vertex does.
 */
#include "tangent/fast/complex_groups.h"

#include <string.h>

/* A value of nt_batch.across that is no corner: what is left of it is another edge that waits. */
#define NT_WAITS ((uint32_t)1 << 31)

bool nt_batch_alloc(const nt_complex *c, size_t capacity, nt_batch *batch)
{
	*batch = (nt_batch){0};
	batch->across = nt_borrowed_alloc(c->memory, capacity + 1, 2 * sizeof *batch->across);
	batch->group = nt_borrowed_alloc(c->memory, capacity, sizeof *batch->group);
	return batch->across && batch->group;
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

void nt_pair_vertex(const nt_complex *c, nt_batch *b, uint32_t begin, uint32_t end)
{
	static const uint8_t next[3] = {1, 2, 0}, previous[3] = {2, 0, 1};
	const nt_triangles *triangles = &c->fast->triangles;
	for (uint32_t place = begin; place < end; place++) {
		const uint32_t t = c->corners[place] >> 2, k = c->corners[place] & 3, e = 2 * (place - b->first);
		const uint32_t after = triangles->ids[nt_triangle_corner(triangles, t, next[k])];
		const uint32_t before = triangles->ids[nt_triangle_corner(triangles, t, previous[k])];
		pair_edge(b, &c->waiting[after], 2 * begin, e);
		pair_edge(b, &c->waiting[before], 2 * begin, e + 1);
	}
}

/* Groups */

/* Takes corner i into the group, if it is one, free, and of the group's orientation. */
static bool join_group(const nt_complex *c, nt_batch *b, uint32_t i, unsigned orient)
{
	if (i >= NT_WAITS || b->group[i] != NT_NONE)
		return false;
	uint8_t *flags = &c->fast->flags[b->corners[i] >> 2];
	if ((*flags & NT_TRIANGLE_ANY) && !(*flags & NT_TRIANGLE_DECIDED))
		*flags = (uint8_t)((*flags & ~NT_TRIANGLE_ORIENT) | orient | NT_TRIANGLE_DECIDED);
	if ((*flags & NT_TRIANGLE_ORIENT) != orient)
		return false;
	b->group[i] = b->group_count;
	return true;
}

/* The group that begins at a corner, if that is free and has a frame. Corners form rows or rings: they are
 * followed both ways. */
static void flood_group(const nt_complex *c, nt_batch *b, uint32_t seed)
{
	const unsigned flags = c->fast->flags[b->corners[seed] >> 2];
	if ((flags & NT_TRIANGLE_ANY) || b->group[seed] != NT_NONE)
		return;
	b->group[seed] = b->group_count;
	for (uint32_t way = 0; way < 2; way++)
		for (uint32_t i = b->across[2 * seed + way]; join_group(c, b, i, flags & NT_TRIANGLE_ORIENT);)
			i = b->across[2 * i + way];
	b->group_count++;
}

void nt_find_groups(const nt_complex *c, nt_batch *b)
{
	memset(b->group, 0xff, b->count * sizeof *b->group);
	b->group_count = 0;
	for (uint32_t i = 0; i < b->count; i++)
		flood_group(c, b, i);
}

void nt_find_groups_in_order(const nt_complex *c, nt_batch *all)
{
	for (size_t v = 0; v < c->vertex_count; v++)
		nt_pair_vertex(c, all, c->begin[v], c->begin[v + 1]);
	memset(all->group, 0xff, all->count * sizeof *all->group);
	all->group_count = 0;
	for (size_t i = 0; i < all->count; i++)
		flood_group(c, all, c->order[i]);
}

/* A group begins with its first corner that has a frame. */
void nt_number_groups(const nt_complex *c, nt_batch *b, uint32_t *numbers)
{
	b->group_count = 0;
	for (uint32_t i = 0; i < b->count; i++)
		if (!(c->fast->flags[b->corners[i] >> 2] & NT_TRIANGLE_ANY) && numbers[b->group[i]] == NT_NONE)
			numbers[b->group[i]] = b->group_count++;
	for (uint32_t i = 0; i < b->count; i++)
		b->group[i] = b->group[i] == NT_NONE ? NT_NONE : numbers[b->group[i]];
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
