/* SPDX-License-Identifier: MIT */
/*
 * Marked edges in walking order: see chains.h.
 *
 * If no more than two marked edges meet in a point, and no two triangles use an edge in one direction, the ends of
 * the edges tell their order. Elsewhere OpenMesh walks (ext/openmesh.h), which knows around which side of a point an
 * edge goes on; it gets only the triangles that touch a marked edge's ends, which is
 * all that a walk around these points needs and a small part of most meshes. Edges that it cannot take come back in
 * pieces: edges that more than two triangles share, triangles against the winding of the others (the last face of a
 * Moebius strip), fans that only meet in a point. The pieces, and edges it does not know, are then joined wherever
 * exactly two ends meet, so that nothing is dropped.
 */
#include "report/surface/chains.h"

#include <stdlib.h>
#include <string.h>
#include "ext/openmesh.h"

/* A run of edges in walking order, in the arrays of `runs`. */
typedef struct run {
	size_t first, count;
	uint32_t ends[2]; /* points */
	bool closed, used;
} run;

typedef struct runs {
	run *items;
	size_t count;
	uint32_t *sides;
	bool *reversed;
	size_t side_count;
} runs;

/* ---- the ends of marked edges ---- */

typedef struct ends {
	const nt_surface *s;
	uint32_t *degrees; /* [point_count] marked edges; 0: the point is no end */
	bool forks;        /* more than two meet somewhere */
} ends;

static uint32_t end_of(const ends *e, uint32_t side)
{
	return nt_side_point(e->s, nt_side_next(side));
}

/* The marked side from `side` on; as many as there are sides: none. */
static size_t next_marked(const nt_surface *s, const nt_marks *marks, size_t side)
{
	return nt_bit_next(marks->sides, side, 3 * s->triangle_count);
}

static nt_status find_ends(const nt_surface *s, const nt_marks *marks, nt_scratch *scratch, ends *e)
{
	*e = (ends){.s = s, .degrees = nt_scratch_alloc(scratch, s->point_count, sizeof *e->degrees)};
	if (!e->degrees)
		return NT_ERROR_MEMORY;
	memset(e->degrees, 0, s->point_count * sizeof *e->degrees);
	for (size_t side = 0; (side = next_marked(s, marks, side)) < 3 * s->triangle_count; side++) {
		e->forks |= ++e->degrees[nt_side_point(s, side)] > 2;
		e->forks |= ++e->degrees[end_of(e, (uint32_t)side)] > 2;
	}
	return NT_OK;
}

/* ---- the triangles around the marked edges ---- */

/* Triangles that have edges and an end, and the edges of their points. */
typedef struct vicinity {
	uint64_t *near, *points;  /* [triangle_count of the surface], [point_count] bits: triangles, their points */
	uint32_t *ranks, *origin; /* numbers of triangles, and back */
	uint32_t *sides;          /* [3 * triangle_count] as nt_walked_mesh has them */
	uint8_t *marked;          /* [3 * triangle_count] */
	size_t triangle_count, edge_count;
} vicinity;

static bool has_end(const ends *e, size_t t)
{
	return e->degrees[nt_side_point(e->s, 3 * t)] || e->degrees[nt_side_point(e->s, 3 * t + 1)] ||
		e->degrees[nt_side_point(e->s, 3 * t + 2)];
}

/* Numbers the edges of a point, lower ones of their two, of which near triangles have a side. */
static void number_edges(const nt_surface *s, uint32_t low, nt_edge_side *edges, vicinity *v)
{
	const size_t count = nt_surface_edges(s, low, edges);
	for (size_t i = 0; i < count; i++) {
		v->edge_count += i == 0 || edges[i].high != edges[i - 1].high;
		const uint32_t side = edges[i].side, t = side / 3;
		if (nt_bit(v->near, t))
			v->sides[3 * nt_bit_rank(v->near, v->ranks, t) + side % 3] =
				(uint32_t)(2 * (v->edge_count - 1)) + edges[i].ascending;
	}
}

static nt_status find_vicinity(const ends *e, const nt_marks *marks, nt_scratch *scratch, vicinity *v)
{
	const nt_surface *s = e->s;
	const size_t words = nt_bit_words(s->triangle_count), point_words = nt_bit_words(s->point_count);
	*v = (vicinity){.near = nt_scratch_alloc(scratch, words, sizeof *v->near),
		.points = nt_scratch_alloc(scratch, point_words, sizeof *v->points),
		.ranks = nt_scratch_alloc(scratch, words, sizeof *v->ranks)};
	nt_edge_side *edges = nt_scratch_alloc(scratch, s->most_sides, sizeof *edges);
	if (!v->near || !v->points || !v->ranks || !edges)
		return NT_ERROR_MEMORY;
	memset(v->near, 0, words * sizeof *v->near);
	memset(v->points, 0, point_words * sizeof *v->points);
	for (size_t t = 0; t < s->triangle_count; t++) {
		if (!has_end(e, t) || !nt_has_edges(s, t))
			continue;
		nt_bit_set(v->near, t);
		for (size_t side = 3 * t; side < 3 * t + 3; side++)
			nt_bit_set(v->points, nt_side_point(s, side));
	}
	v->triangle_count = nt_bit_ranks(v->near, s->triangle_count, v->ranks);
	v->origin = nt_scratch_alloc(scratch, v->triangle_count, sizeof *v->origin);
	v->sides = nt_scratch_alloc(scratch, 3 * v->triangle_count, sizeof *v->sides);
	v->marked = nt_scratch_alloc(scratch, 3 * v->triangle_count, 1);
	if (!v->origin || !v->sides || !v->marked)
		return NT_ERROR_MEMORY;
	for (size_t n = 0, t = 0; (t = nt_bit_next(v->near, t, s->triangle_count)) < s->triangle_count; n++, t++) {
		v->origin[n] = (uint32_t)t;
		for (size_t k = 0; k < 3; k++)
			v->marked[3 * n + k] = nt_bit(marks->sides, 3 * t + k);
	}
	for (size_t p = 0; (p = nt_bit_next(v->points, p, s->point_count)) < s->point_count; p++)
		number_edges(s, (uint32_t)p, edges, v);
	return NT_OK;
}

/* ---- OpenMesh's walks as runs ---- */

static void add_run(runs *r, const ends *e, size_t first, bool closed)
{
	const size_t count = r->side_count - first;
	const uint32_t a = r->sides[first], b = r->sides[r->side_count - 1];
	r->items[r->count++] = (run){.first = first, .count = count, .closed = closed,
		.ends = {r->reversed[first] ? end_of(e, a) : nt_side_point(e->s, a),
			r->reversed[r->side_count - 1] ? nt_side_point(e->s, b) : end_of(e, b)}};
}

typedef struct walk_taking {
	const ends *e;
	const vicinity *v;
	uint64_t *taken;
	runs *r;
} walk_taking;

static void take_walk(void *context, const uint32_t *steps, size_t count, bool closed)
{
	const walk_taking *t = context;
	runs *r = t->r;
	const size_t first = r->side_count;
	for (size_t i = 0; i < count; i++) {
		const uint32_t near = steps[i] / 2, side = 3 * t->v->origin[near / 3] + near % 3;
		nt_bit_set(t->taken, side);
		r->sides[r->side_count] = side;
		r->reversed[r->side_count++] = steps[i] % 2;
	}
	add_run(r, t->e, first, closed);
}

/* ---- joining ---- */

/* Ends of runs, 2 * run + end, in two slots for each point. joints: [2 * point_count] */
static void find_joints(const ends *e, const runs *r, uint32_t *joints)
{
	memset(joints, 0xff, 2 * e->s->point_count * sizeof *joints);
	for (size_t i = 0; i < r->count; i++) {
		for (size_t end = 0; end < 2 && !r->items[i].closed; end++) {
			uint32_t *slots = joints + 2 * (size_t)r->items[i].ends[end];
			slots[slots[0] != NT_NONE] = (uint32_t)(2 * i + end);
		}
	}
}

/* The run end that meets this one at a joint; NT_NONE at an open end or a junction. A run may pass another's end. */
static uint32_t partner_of(const ends *e, const runs *r, const uint32_t *joints, uint32_t end)
{
	const uint32_t point = r->items[end / 2].ends[end % 2];
	if (e->degrees[point] != 2)
		return NT_NONE;
	const uint32_t *slots = joints + 2 * (size_t)point;
	return slots[0] == end ? slots[1] : slots[0];
}

static void append_run(const runs *r, const run *piece, bool backwards, nt_chains *chains, size_t *n)
{
	for (size_t i = 0; i < piece->count; i++) {
		const size_t at = piece->first + (backwards ? piece->count - 1 - i : i);
		chains->sides[*n] = r->sides[at];
		chains->reversed[(*n)++] = r->reversed[at] != backwards;
	}
}

/* Walks back from a run to where its chain begins, then forward to its end. */
static void join_from(const ends *e, runs *r, const uint32_t *joints, size_t start, nt_chains *chains, size_t *n)
{
	uint32_t entry = (uint32_t)(2 * start); /* the end through which the walk enters a run */
	bool closed = r->items[start].closed;
	while (!closed) {
		const uint32_t before = partner_of(e, r, joints, entry);
		if (before == NT_NONE)
			break;
		entry = before ^ 1u;
		if (entry / 2 == start) {
			closed = true;
			entry = (uint32_t)(2 * start);
		}
	}
	for (uint32_t end = entry;;) {
		run *piece = &r->items[end / 2];
		piece->used = true;
		append_run(r, piece, end % 2 == 1, chains, n);
		const uint32_t next = piece->closed ? NT_NONE : partner_of(e, r, joints, end ^ 1u);
		if (next == NT_NONE || r->items[next / 2].used)
			break;
		end = next;
	}
	chains->closed[chains->count++] = closed;
	chains->first[chains->count] = *n;
}

static int by_lowest_side(const void *a, const void *b)
{
	const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
	return x < y ? -1 : x > y;
}

/* Joins runs, in the order of their lowest sides. */
static nt_status join_runs(const ends *e, runs *r, nt_scratch *scratch, nt_chains *chains)
{
	uint64_t *order = nt_scratch_alloc(scratch, r->count, sizeof *order);
	uint32_t *joints = nt_scratch_alloc(scratch, 2 * e->s->point_count, sizeof *joints);
	if (!order || !joints)
		return NT_ERROR_MEMORY;
	find_joints(e, r, joints);
	for (size_t i = 0; i < r->count; i++) {
		uint32_t lowest = NT_NONE;
		for (size_t k = 0; k < r->items[i].count; k++)
			if (r->sides[r->items[i].first + k] < lowest)
				lowest = r->sides[r->items[i].first + k];
		order[i] = (uint64_t)lowest << 32 | i;
	}
	qsort(order, r->count, sizeof *order, by_lowest_side);
	size_t n = 0;
	chains->first[0] = 0;
	for (size_t i = 0; i < r->count; i++) {
		const size_t index = (size_t)(order[i] & UINT32_MAX);
		if (!r->items[index].used)
			join_from(e, r, joints, index, chains, &n);
	}
	return NT_OK;
}

static nt_status allocate(nt_scratch *scratch, size_t edges, runs *r, nt_chains *chains)
{
	*r = (runs){.items = nt_scratch_alloc(scratch, edges, sizeof *r->items),
		.sides = nt_scratch_alloc(scratch, edges, sizeof *r->sides),
		.reversed = nt_scratch_alloc(scratch, edges, sizeof *r->reversed)};
	*chains = (nt_chains){.first = nt_scratch_alloc(scratch, edges + 1, sizeof *chains->first),
		.closed = nt_scratch_alloc(scratch, edges, sizeof *chains->closed),
		.sides = nt_scratch_alloc(scratch, edges, sizeof *chains->sides),
		.reversed = nt_scratch_alloc(scratch, edges, sizeof *chains->reversed)};
	const bool complete = r->items && r->sides && r->reversed && chains->first && chains->closed &&
		chains->sides && chains->reversed;
	return complete ? NT_OK : NT_ERROR_MEMORY;
}

nt_status nt_chains_trace(const nt_surface *surface, const nt_marks *marks, nt_scratch *scratch, nt_chains *chains,
	nt_error *error)
{
	const size_t sides = 3 * surface->triangle_count, words = nt_bit_words(sides);
	runs r;
	nt_status status = allocate(scratch, marks->count, &r, chains);
	if (status)
		return status;
	chains->first[0] = 0;
	if (marks->count == 0)
		return NT_OK;

	ends e;
	status = find_ends(surface, marks, scratch, &e);
	uint64_t *taken = status ? NULL : nt_scratch_alloc(scratch, words, sizeof *taken);
	if (!taken)
		return NT_ERROR_MEMORY;
	memset(taken, 0, words * sizeof *taken);
	if (marks->conflicts || e.forks) {
		vicinity v;
		status = find_vicinity(&e, marks, scratch, &v);
		walk_taking taking = {&e, &v, taken, &r};
		if (!status)
			status = nt_walk_marked(&(nt_walked_mesh){v.edge_count, v.triangle_count, v.sides, v.marked},
				take_walk, &taking, &chains->left_out, error);
		if (status)
			return status;
	}

	/* edges that OpenMesh does not know, or was not asked about, are runs by themselves, the way their lowest sides
	 * go */
	for (size_t side = 0; (side = next_marked(surface, marks, side)) < sides; side++) {
		if (nt_bit(taken, side))
			continue;
		const size_t first = r.side_count;
		r.sides[first] = (uint32_t)side;
		r.reversed[r.side_count++] = marks->against && nt_bit(marks->against, side);
		add_run(&r, &e, first, false);
	}
	return join_runs(&e, &r, scratch, chains);
}
