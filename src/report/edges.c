/* SPDX-License-Identifier: MIT */
/*
 * One pass over the edges of a surface: which are open, which are shared by too many triangles or wound
 * inconsistently, across which the texture coordinates continue (that gives the islands), are cut, or
 * change their orientation (that gives the mirror edges, which seams.c puts in order), or continue although the
 * normals are cut (hard_edges.c).
 *
 * Two triangles of an edge continue each other in UV space when both ends have equal texture
 * coordinates on both. On an edge of many triangles all that have the same coordinates do.
 *
 * Threads take the edges of some points. Results go to lists by part, or into sets that do not show who was first.
 */
#include "report/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/parallel.h"
#include "base/vec.h"

/* Points whose edges a thread takes at a time: some 300 KB. */
enum { PART = 4096 };

/* Tallies and sums of a part. */
enum { NON_MANIFOLD, INCONSISTENT };
static const nt_code codes[] = {NT_CODE_MESH_NON_MANIFOLD_EDGE, NT_CODE_MESH_INCONSISTENT_WINDING};
enum { EDGES, UV_SEAMS };

/* Share of the mesh's area up to which nobody sees the triangles at those: slivers. */
static const double SLIVER_SHARE = 0.001;

/* By one thread, in no order. */
enum { BOUNDARY, MIRRORS, HARD, KINDS };

typedef struct edge_lists {
	struct {
		nt_edge *edges;
		size_t count, capacity;
	} of[KINDS];
	nt_edge_side *sides; /* of one point */
	bool failed;         /* out of memory */
} edge_lists;

typedef struct edge_work {
	nt_check *check;
	edge_lists *lists; /* [slots] */
} edge_work;

static void add_edge(edge_lists *lists, int kind, nt_edge edge)
{
	if (nt_grow((void **)&lists->of[kind].edges, &lists->of[kind].capacity, lists->of[kind].count + 1, sizeof edge))
		lists->of[kind].edges[lists->of[kind].count++] = edge;
	else
		lists->failed = true;
}

/* ---- one edge ---- */

/* Unites all triangles of an edge of three and more that have the same coordinates along it. */
static bool unite_many(const nt_check *check, const nt_edge_side *sides, size_t count, bool joint)
{
	const nt_surface *s = &check->surface;
	nt_hash_index met = {0};
	bool done = true;
	for (size_t i = 0; i < count && done; i++) {
		const uint32_t side = sides[i].side, next = nt_side_next(side);
		const float *low = nt_side_texcoord(s, sides[i].ascending ? side : next);
		const float *high = nt_side_texcoord(s, sides[i].ascending ? next : side);
		const uint64_t hash = nt_hash_words(nt_hash_floats(low[0], low[1]), nt_hash_floats(high[0], high[1]));
		size_t at = NT_HASH_BEGIN;
		uint32_t first = sides[0].side;
		while (joint && (first = nt_hash_index_next(&met, hash, &at)) != NT_NONE)
			if (nt_sides_meet(s, side, first))
				break;
		if (first != NT_NONE)
			nt_unite(check->islands, side / 3, first / 3);
		else if (low[0] == low[0] && low[1] == low[1] && high[0] == high[0] && high[1] == high[1])
			done = nt_hash_index_add(&met, hash, side);
	}
	nt_hash_index_free(&met);
	return done;
}

/* Remembers the first unmirrored and the first mirrored side of the edge, if it has both. */
static void find_mirror(const nt_edge_side *sides, size_t count, edge_lists *lists)
{
	const nt_edge_side *found[2] = {NULL, NULL};
	for (size_t i = count; i-- > 0;) {
		const int sign = sides[i].orientation;
		if (sign)
			found[sign < 0] = &sides[i];
	}
	if (!found[0] || !found[1])
		return;
	add_edge(lists, MIRRORS, (nt_edge){.sides = {found[0]->side, found[1]->side},
		.against = sides[0].ascending != found[0]->ascending, .non_manifold = count > 2});
}

/*
 * The cosine of 20 degrees, from which on an edge is hard. 239 of 1 321 public files have edges between different
 * normals inside an island, 112 000 together. Fewest have 15 to 25 degrees (3 096): below are rounded normals and
 * finely faceted spheres, above what was meant to be an edge. Any limit from 15 to 30 names the same 225 files.
 */
static const double HARD_COSINE = 0.9396926207859084;

/* The square of a cosine, with its sign, of the angle between the normals of two corners; 1 if one has no direction. */
static double squared_cosine(const nt_surface *s, uint32_t a, uint32_t b)
{
	const uint32_t va = nt_side_vertex(s, a), vb = nt_side_vertex(s, b);
	if (va == vb)
		return 1.0;
	const nt_dvec3 na = nt_dvec3_load(s->mesh->normals + 3 * (size_t)va);
	const nt_dvec3 nb = nt_dvec3_load(s->mesh->normals + 3 * (size_t)vb);
	const double dot = nt_dvec3_dot(na, nb), both = nt_dvec3_dot(na, na) * nt_dvec3_dot(nb, nb);
	return both > 0.0 && isfinite(both) ? dot * fabs(dot) / both : 1.0;
}

/* Remembers an edge across which texture coordinates continue and normals do not. */
static void find_hard(const nt_check *check, const nt_edge_side *sides, edge_lists *lists)
{
	const nt_surface *s = &check->surface;
	const uint32_t a = sides[0].side, b = sides[1].side;
	if (!sides[0].orientation || !sides[1].orientation || sides[0].ascending == sides[1].ascending)
		return;
	const double first = squared_cosine(s, a, nt_side_next(b)), second = squared_cosine(s, nt_side_next(a), b);
	const double least = first < second ? first : second;
	if (least < HARD_COSINE * HARD_COSINE)
		add_edge(lists, HARD, (nt_edge){.sides = {a, b},
			.cosine = (float)(least < 0.0 ? -sqrt(-least) : sqrt(least))});
}

/* Unites those of an edge of three and more that have one orientation. */
static void unite_patches(const nt_check *check, const nt_edge_side *sides, size_t count)
{
	const nt_edge_side *last[3] = {NULL, NULL, NULL};
	for (size_t i = 0; i < count; i++) {
		const nt_edge_side **before = &last[sides[i].orientation + 1];
		if (!sides[i].orientation)
			continue;
		if (*before)
			nt_unite(check->patches, sides[i].side / 3, (*before)->side / 3);
		*before = &sides[i];
	}
}

static void check_edge(nt_check *check, uint32_t low, const nt_edge_side *sides, size_t count, nt_part *part,
	edge_lists *lists)
{
	part->sums[EDGES]++;
	if (count == 1) {
		add_edge(lists, BOUNDARY, (nt_edge){.sides = {sides[0].side, NT_NONE}});
		return;
	}
	nt_tally *bad = count > 2 ? &part->tallies[NON_MANIFOLD]
		: sides[0].ascending == sides[1].ascending ? &part->tallies[INCONSISTENT] : NULL;
	if (bad)
		nt_tally_side(check, bad, sides[0].side, (double)count);
	for (size_t i = 0; bad && i < count; i++)
		bad->area += nt_triangle_area(&check->surface, sides[i].side / 3);
	if (!check->mesh->texcoords)
		return;
	if (count > 2 || sides[0].orientation != sides[1].orientation)
		find_mirror(sides, count, lists);
	const uint64_t *joints = check->surface.joints;
	const bool joint = nt_bit(joints, low) || nt_bit(joints, sides[0].high);
	const bool meet = count > 2 || !joint || nt_sides_meet(&check->surface, sides[0].side, sides[1].side);
	if (count > 2)
		lists->failed |= !unite_many(check, sides, count, joint);
	else if (meet)
		nt_unite(check->islands, sides[0].side / 3, sides[1].side / 3);
	else
		part->sums[UV_SEAMS]++;
	if (meet && check->patches)
		unite_patches(check, sides, count);
	if (meet && joint && count == 2 && check->mesh->normals)
		find_hard(check, sides, lists);
}

static void check_part(void *context, size_t begin, size_t end, unsigned slot, nt_part *part)
{
	const edge_work *work = context;
	const nt_surface *s = &work->check->surface;
	nt_edge_side *sides = work->lists[slot].sides;
	const size_t total = s->point_count ? s->ends[s->point_count - 1] : 0;
	for (size_t low = begin; low < end; low++) {
		const size_t count = nt_surface_edges(s, (uint32_t)low, sides), next = s->ends[low];
		for (size_t i = 0, after; i < count; i = after) {
			for (after = i + 1; after < count && sides[after].high == sides[i].high;)
				after++;
			if (next + i < total)
				__builtin_prefetch(&work->check->islands[s->sides[next + i] / 3], 1);
			check_edge(work->check, (uint32_t)low, sides + i, after - i, part, &work->lists[slot]);
		}
	}
}

/* ---- the results together ---- */

static void report_edges(nt_check *check, const nt_part *all)
{
	nt_report_mesh *facts = check->facts;
	const nt_tally *non_manifold = &all->tallies[NON_MANIFOLD], *inconsistent = &all->tallies[INCONSISTENT];
	facts->edge_count = (size_t)all->sums[EDGES];
	facts->boundary_edges = check->boundary.count;
	facts->uv_seam_edges = (size_t)all->sums[UV_SEAMS];
	facts->non_manifold_edges = non_manifold->count;
	facts->inconsistent_edges = inconsistent->count;
	const double least = SLIVER_SHARE * check->total_area;
	/* of no matter to a surface without tangents */
	const bool matters = check->mesh->texcoords && nt_needs_tangents(check) && non_manifold->area > least;
	nt_check_report_as(check, non_manifold, matters ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO, NULL);
	nt_check_report_as(check, inconsistent, inconsistent->area > least ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO,
		NULL);
}

/* Puts the edges that threads found in the order of their first sides: a bit for each, and how many are before it.
 * bits, ranks: [nt_bit_words(sides)] */
static nt_status join_lists(nt_check *check, const edge_lists *lists, unsigned slots, int kind, uint64_t *bits,
	uint32_t *ranks, nt_edges *edges)
{
	const size_t sides = 3 * check->surface.triangle_count;
	for (unsigned slot = 0; slot < slots; slot++)
		edges->count += lists[slot].of[kind].count;
	edges->items = nt_scratch_alloc(check->scratch, edges->count, sizeof *edges->items);
	if (!edges->items || !edges->count)
		return edges->items ? NT_OK : NT_ERROR_MEMORY;
	memset(bits, 0, nt_bit_words(sides) * sizeof *bits);
	for (unsigned slot = 0; slot < slots; slot++)
		for (size_t i = 0; i < lists[slot].of[kind].count; i++)
			nt_bit_set(bits, lists[slot].of[kind].edges[i].sides[0]);
	nt_bit_ranks(bits, sides, ranks);
	for (unsigned slot = 0; slot < slots; slot++)
		for (size_t i = 0; i < lists[slot].of[kind].count; i++) {
			const nt_edge *edge = &lists[slot].of[kind].edges[i];
			edges->items[nt_bit_rank(bits, ranks, edge->sides[0])] = *edge;
		}
	return NT_OK;
}

static nt_status allocate(nt_check *check)
{
	const size_t triangles = check->surface.triangle_count;
	check->islands = nt_scratch_alloc(check->scratch, triangles, sizeof *check->islands);
	if (!check->islands)
		return NT_ERROR_MEMORY;
	/* without texture coordinates all triangles may be united at will: there are no islands */
	for (size_t t = 0; t < triangles; t++)
		check->islands[t] = check->mesh->texcoords && nt_has_edges(&check->surface, t) ? (uint32_t)t : NT_NONE;
	if (!check->facts->triangles[0] || !check->facts->triangles[2])
		return NT_OK;
	check->patches = nt_scratch_alloc(check->scratch, triangles, sizeof *check->patches);
	if (!check->patches)
		return NT_ERROR_MEMORY;
	for (size_t t = 0; t < triangles; t++)
		check->patches[t] = check->islands[t] != NT_NONE && check->surface.orientation[t] ? (uint32_t)t
			: NT_NONE;
	return NT_OK;
}

static nt_status check_parts(nt_check *check, unsigned threads)
{
	const nt_surface *s = &check->surface;
	const size_t words = nt_bit_words(3 * s->triangle_count);
	edge_work work = {check, nt_scratch_alloc(check->scratch, threads, sizeof *work.lists)};
	uint64_t *bits = nt_scratch_alloc(check->scratch, words, sizeof *bits);
	uint32_t *ranks = nt_scratch_alloc(check->scratch, words, sizeof *ranks);
	if (!work.lists || !bits || !ranks)
		return NT_ERROR_MEMORY;
	for (unsigned slot = 0; slot < threads; slot++) {
		work.lists[slot] = (edge_lists){.sides = nt_scratch_alloc(check->scratch, s->most_sides,
			sizeof *work.lists->sides)};
		if (!work.lists[slot].sides)
			return NT_ERROR_MEMORY;
	}
	nt_part all;
	bool failed = nt_check_parts(check, s->point_count, PART, codes, sizeof codes / sizeof *codes, check_part,
		&work, &all) != NT_OK;
	nt_edges *const sets[KINDS] = {&check->boundary, &check->mirrors, &check->hard};
	for (int kind = 0; kind < KINDS; kind++)
		failed |= join_lists(check, work.lists, threads, kind, bits, ranks, sets[kind]) != NT_OK;
	for (unsigned slot = 0; slot < threads; slot++) {
		failed |= work.lists[slot].failed;
		for (int kind = 0; kind < KINDS; kind++)
			free(work.lists[slot].of[kind].edges);
	}
	if (!failed)
		report_edges(check, &all);
	return failed ? NT_ERROR_MEMORY : NT_OK;
}

nt_status nt_check_edges(nt_check *check)
{
	const unsigned threads = nt_thread_count(check->options->threads);
	nt_status status = allocate(check);
	if (!status)
		status = nt_surface_list_sides(&check->surface, threads);
	if (!status)
		status = check_parts(check, threads);
	if (!status)
		check->facts->island_count = nt_number_sets(check->islands, check->surface.triangle_count);
	return status;
}
