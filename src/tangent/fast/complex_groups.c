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

void nt_list_members(nt_batch *b)
{
	b->members = b->across;
	b->bounds = b->across + b->count;
	/* counted two places ahead: filling then moves each bound to where it belongs */
	uint32_t *at = b->bounds + 1;
	memset(b->bounds, 0, (b->group_count + 2) * sizeof *b->bounds);
	for (uint32_t i = 0; i < b->count; i++)
		if (b->group[i] != NT_NONE)
			at[b->group[i] + 1]++;
	for (uint32_t g = 1; g <= b->group_count; g++)
		at[g] += at[g - 1];
	for (uint32_t i = 0; i < b->count; i++)
		if (b->group[i] != NT_NONE)
			b->members[at[b->group[i]]++] = i;
}

void nt_find_groups(const nt_complex *c, nt_batch *b)
{
	memset(b->group, 0xff, b->count * sizeof *b->group);
	b->group_count = 0;
	for (uint32_t i = 0; i < b->count; i++)
		flood_group(c, b, i);
	nt_list_members(b);
}

/* Triangles without a frame */

/* Pairs the corners of vertices that touch a triangle without a frame; these get their first place, others
 * NT_NONE. */
static void pair_undecided(const nt_complex *c, nt_batch *b, uint32_t *places)
{
	for (size_t v = 0; v < c->vertex_count; v++) {
		bool any = false;
		for (uint32_t place = c->begin[v]; place < c->begin[v + 1] && !any; place++)
			any = c->fast->flags[c->corners[place] >> 2] & NT_TRIANGLE_ANY;
		places[v] = any ? c->begin[v] : NT_NONE;
		if (any)
			nt_pair_vertex(c, b, c->begin[v], c->begin[v + 1]);
	}
}

/* Floods in the order of triangles, for what that does to flags: afterwards the vertices do not depend on each
 * other. */
nmtan_status nt_decide_any(const nt_complex *c)
{
	const nt_fast *fast = c->fast;
	const nt_scratch_mark mark = nt_scratch_here(c->memory->scratch);
	const nt_borrowed memory = *c->memory;
	nt_batch b;
	uint32_t *at = nt_borrowed_alloc(c->memory, c->vertex_count, sizeof *at);
	if (!at || !nt_batch_alloc(c, c->corner_count, &b))
		return NMTAN_ERROR_MEMORY;
	b.corners = c->corners;
	memset(b.group, 0xff, c->corner_count * sizeof *b.group);
	pair_undecided(c, &b, at);
	for (size_t t = nt_next_complex(c, 0); t < fast->triangle_count; t = nt_next_complex(c, t + 1)) {
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(&fast->triangles, t, 1, copy);
		for (size_t k = 0; k < 3; k++) {
			const uint32_t number = nt_complex_number(c, v[k]);
			if (number != NT_NONE && at[number] != NT_NONE)
				flood_group(c, &b, at[number]++);
		}
	}
	nt_scratch_back(c->memory->scratch, mark);
	*c->memory = memory;
	memset(c->waiting, 0, fast->vertex_count * sizeof *c->waiting);
	return NMTAN_OK;
}
