/* SPDX-License-Identifier: MIT */
/*
 * Marked edges in walking order: each end of an edge is linked with the end that a chain goes on from, and chains are
 * walks along the links. If no more than two marked edges meet in a point, and no two triangles use an edge in one
 * direction, points say which ends are linked. Else OpenMesh walks first (ext/openmesh.h), which knows around which
 * side of a point an edge goes on; it gets only the triangles that touch a marked edge's ends, which is all that a walk
 * around these points needs and a small part of most meshes. It cannot take edges that more than two triangles share,
 * triangles against the winding of the others (the last face of a Moebius strip), and fans that only meet in a point:
 * these are linked by points, wherever exactly two ends meet, so that nothing is dropped.
 */
#include "report/surface/surface.h"

#include <string.h>
#include "ext/openmesh.h"

/* End 2 * i is where the first side of edge i begins, 2 * i + 1 where that side ends. */
typedef struct tracing {
	const nt_surface *s;
	const nt_edges *edges;
	uint32_t *links;   /* [ends] NT_NONE: a chain ends there */
	uint32_t *seeds;   /* [edges->count] the end at which the walk through an edge begins */
	uint8_t *degrees;  /* [point_count] ends; 3: more than two */
} tracing;

static uint32_t point_of(const tracing *t, uint32_t end)
{
	const uint32_t side = t->edges->items[end / 2].sides[0];
	return nt_side_point(t->s, end % 2 ? nt_side_next(side) : side);
}

static void link_ends(const tracing *t, uint32_t a, uint32_t b)
{
	t->links[a] = b;
	t->links[b] = a;
}

/* ---- OpenMesh's walks ---- */

static bool has_end(const tracing *t, size_t triangle)
{
	return t->degrees[nt_side_point(t->s, 3 * triangle)] || t->degrees[nt_side_point(t->s, 3 * triangle + 1)] ||
		t->degrees[nt_side_point(t->s, 3 * triangle + 2)];
}

/* Side k of the n-th of the triangles that have edges and an end is 3 * n + k. */
static nt_status find_vicinity(const tracing *t, nt_scratch *scratch, nt_walked_mesh *mesh)
{
	const nt_surface *s = t->s;
	const size_t words = nt_bit_words(s->triangle_count), point_words = nt_bit_words(s->point_count);
	uint64_t *near = nt_scratch_alloc(scratch, words, sizeof *near);
	uint64_t *points = nt_scratch_alloc(scratch, point_words, sizeof *points);
	uint32_t *ranks = nt_scratch_alloc(scratch, words, sizeof *ranks);
	nt_edge_side *around = nt_scratch_alloc(scratch, s->most_sides, sizeof *around);
	if (!near || !points || !ranks || !around)
		return NT_ERROR_MEMORY;
	memset(near, 0, words * sizeof *near);
	memset(points, 0, point_words * sizeof *points);
	for (size_t triangle = 0; triangle < s->triangle_count; triangle++) {
		if (!has_end(t, triangle) || !nt_has_edges(s, triangle))
			continue;
		nt_bit_set(near, triangle);
		for (size_t side = 3 * triangle; side < 3 * triangle + 3; side++)
			nt_bit_set(points, nt_side_point(s, side));
	}
	*mesh = (nt_walked_mesh){.triangle_count = nt_bit_ranks(near, s->triangle_count, ranks)};
	uint32_t *sides = nt_scratch_alloc(scratch, 3 * mesh->triangle_count, sizeof *sides);
	uint32_t *marks = nt_scratch_alloc(scratch, 3 * mesh->triangle_count, sizeof *marks);
	if (!sides || !marks)
		return NT_ERROR_MEMORY;
	memset(marks, 0xff, 3 * mesh->triangle_count * sizeof *marks);
	for (size_t i = 0; i < t->edges->count; i++) {
		const uint32_t side = t->edges->items[i].sides[0];
		marks[3 * (size_t)nt_bit_rank(near, ranks, side / 3) + side % 3] = (uint32_t)i;
	}
	for (size_t p = 0; (p = nt_bit_next(points, p, s->point_count)) < s->point_count; p++) {
		const size_t count = nt_surface_edges(s, (uint32_t)p, around);
		for (size_t i = 0; i < count; i++) {
			mesh->edge_count += i == 0 || around[i].high != around[i - 1].high;
			const uint32_t side = around[i].side;
			if (nt_bit(near, side / 3))
				sides[3 * (size_t)nt_bit_rank(near, ranks, side / 3) + side % 3] =
					(uint32_t)(2 * (mesh->edge_count - 1)) + around[i].ascending;
		}
	}
	mesh->sides = sides;
	mesh->marks = marks;
	return NT_OK;
}

/* Step 2 * i goes along the first side of edge i, 2 * i + 1 against it: steps are the ends at which they begin. */
static void take_walk(void *context, const uint32_t *steps, size_t count, bool closed)
{
	const tracing *t = context;
	for (size_t i = 0; i < count; i++) {
		t->seeds[steps[i] / 2] = steps[0];
		if (i > 0)
			link_ends(t, steps[i - 1] ^ 1, steps[i]);
	}
	if (closed)
		link_ends(t, steps[count - 1] ^ 1, steps[0]);
}

/* ---- chains ---- */

/* Links the ends that meet at points where there are two. others: [point_count] */
static void link_at_points(const tracing *t, uint32_t *others)
{
	memset(others, 0xff, t->s->point_count * sizeof *others);
	for (uint32_t end = 0; end < 2 * t->edges->count; end++) {
		const uint32_t point = point_of(t, end);
		if (t->links[end] != NT_NONE || t->degrees[point] != 2)
			continue;
		if (others[point] != NT_NONE)
			link_ends(t, others[point], end);
		others[point] = end;
	}
}

/* Walks back from a seed to where its chain begins, then forward to its end. */
static void add_chain(const tracing *t, uint32_t seed, uint64_t *used, nt_chains *chains)
{
	uint32_t begin = seed;
	bool closed = false;
	while (!closed && t->links[begin] != NT_NONE) {
		begin = t->links[begin] ^ 1;
		closed = begin == seed;
	}
	size_t n = chains->first[chains->count];
	for (uint32_t end = begin; end != NT_NONE && !nt_bit(used, end / 2); end = t->links[end ^ 1]) {
		nt_bit_set(used, end / 2);
		chains->edges[n] = end / 2;
		chains->reversed[n++] = end % 2;
	}
	chains->closed[chains->count++] = closed;
	chains->first[chains->count] = n;
}

nt_status nt_chains_trace(const nt_surface *s, const nt_edges *edges, bool conflicts, nt_scratch *scratch,
	nt_chains *chains, nt_error *error)
{
	const size_t count = edges->count;
	bool walks = conflicts;
	*chains = (nt_chains){.first = nt_scratch_alloc(scratch, count + 1, sizeof *chains->first),
		.closed = nt_scratch_alloc(scratch, count, sizeof *chains->closed),
		.edges = nt_scratch_alloc(scratch, count, sizeof *chains->edges),
		.reversed = nt_scratch_alloc(scratch, count, sizeof *chains->reversed)};
	tracing t = {s, edges, nt_scratch_alloc(scratch, 2 * count, sizeof *t.links),
		nt_scratch_alloc(scratch, count, sizeof *t.seeds), nt_scratch_alloc(scratch, s->point_count, 1)};
	uint64_t *used = nt_scratch_alloc(scratch, nt_bit_words(count), sizeof *used);
	uint32_t *others = nt_scratch_alloc(scratch, s->point_count, sizeof *others);
	if (!chains->first || !chains->closed || !chains->edges || !chains->reversed || !t.links || !t.seeds ||
		!t.degrees || !used || !others)
		return NT_ERROR_MEMORY;
	chains->first[0] = 0;
	memset(used, 0, nt_bit_words(count) * sizeof *used);
	memset(t.links, 0xff, 2 * count * sizeof *t.links);
	memset(t.degrees, 0, s->point_count);
	for (uint32_t end = 0; end < 2 * count; end++) {
		uint8_t *degree = &t.degrees[point_of(&t, end)];
		*degree += *degree < 3;
		walks |= *degree == 3;
	}
	for (size_t i = 0; i < count; i++)
		t.seeds[i] = (uint32_t)(2 * i) + edges->items[i].against;
	if (walks && count) {
		nt_walked_mesh mesh;
		nt_status status = find_vicinity(&t, scratch, &mesh);
		if (!status)
			status = nt_walk_marked(&mesh, take_walk, &t, &chains->left_out, error);
		if (status)
			return status;
	}
	link_at_points(&t, others);
	for (size_t i = 0; i < count; i++)
		if (!nt_bit(used, i))
			add_chain(&t, t.seeds[i], used, chains);
	return NT_OK;
}
