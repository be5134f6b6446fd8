/* SPDX-License-Identifier: MIT */
/*
 * One pass over the edges of a surface: which are open, which are shared by too many triangles or wound
 * inconsistently, across which the texture coordinates continue (that gives the islands), are cut, or
 * change their orientation (that gives the mirror edges, which seams.c puts in order).
 *
 * Two triangles of an edge continue each other in UV space when both ends have equal texture
 * coordinates on both. On an edge of many triangles all that have the same coordinates do.
 *
 * Threads take bins of edges. Results go to lists by bin, or into sets that do not show who was first.
 */
#include "report/check.h"

#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "report/surface/edge_bins.h"

/* ---- islands by union and find, the lower number on top ---- */

/* Parents only ever become lower, whatever other threads unite at the same time. */
static uint32_t find_root(uint32_t *parents, uint32_t t)
{
	for (;;) {
		const uint32_t parent = __atomic_load_n(&parents[t], __ATOMIC_RELAXED);
		if (parent == t)
			return t;
		const uint32_t above = __atomic_load_n(&parents[parent], __ATOMIC_RELAXED);
		if (above != parent)
			__atomic_store_n(&parents[t], above, __ATOMIC_RELAXED);
		t = above;
	}
}

static void unite(uint32_t *parents, uint32_t a, uint32_t b)
{
	for (;;) {
		a = find_root(parents, a);
		b = find_root(parents, b);
		if (a == b)
			return;
		uint32_t high = a > b ? a : b;
		const uint32_t low = a > b ? b : a;
		if (__atomic_compare_exchange_n(&parents[high], &high, low, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
			return;
	}
}

/* Sides by which triangles are prefetched before they are united. */
enum { AHEAD = 16 };

/* ---- what is found ---- */

/* In one bin. */
typedef struct bin_result {
	size_t edges, boundary, uv_seams;
	nt_tally non_manifold, inconsistent;
	double areas[2]; /* of the triangles at inconsistent and at non-manifold edges */
} bin_result;

/* Share of the mesh's area up to which nobody sees those: slivers. */
static const double SLIVER_SHARE = 0.001;

/* By one thread, in no order. */
typedef struct mirror_list {
	nt_mirror_edge *edges;
	size_t count, capacity;
	bool failed; /* out of memory */
} mirror_list;

typedef struct edge_work {
	nt_check *check;
	bin_result *results;  /* [bins] */
	mirror_list *mirrors; /* [slots] */
} edge_work;

/* ---- one edge ---- */

/* Texture coordinates of a side's ends, the lower point first, for sorting. */
typedef struct side_key {
	float uv[4];
	uint32_t side;
} side_key;

static int by_key(const void *a, const void *b)
{
	const side_key *x = a, *y = b;
	for (int i = 0; i < 4; i++) {
		if (x->uv[i] < y->uv[i] || x->uv[i] > y->uv[i])
			return x->uv[i] < y->uv[i] ? -1 : 1;
	}
	return x->side < y->side ? -1 : x->side > y->side;
}

static side_key key_of(const nt_surface *s, const nt_edge_side *side)
{
	const uint32_t first = side->side, next = nt_side_next(first);
	const bool ascending = side->low & NT_EDGE_ASCENDING;
	const float *low = nt_side_texcoord(s, ascending ? first : next);
	const float *high = nt_side_texcoord(s, ascending ? next : first);
	return (side_key){{low[0], low[1], high[0], high[1]}, first};
}

static bool same_coordinates(const side_key *a, const side_key *b)
{
	return a->uv[0] == b->uv[0] && a->uv[1] == b->uv[1] && a->uv[2] == b->uv[2] &&
		a->uv[3] == b->uv[3];
}

/* Unites all triangles of an edge of three and more that have the same coordinates along it. */
static bool unite_many(const nt_check *check, const nt_edge_side *sides, size_t count)
{
	if (!(sides[0].low & NT_EDGE_JOINT)) {
		for (size_t i = 1; i < count; i++)
			unite(check->islands, sides[i].side / 3, sides[0].side / 3);
		return true;
	}
	side_key *keys = nt_alloc(count, sizeof *keys);
	if (!keys)
		return false;
	for (size_t i = 0; i < count; i++)
		keys[i] = key_of(&check->surface, &sides[i]);
	qsort(keys, count, sizeof *keys, by_key);
	for (size_t i = 1; i < count; i++)
		if (same_coordinates(&keys[i], &keys[i - 1]))
			unite(check->islands, keys[i].side / 3, keys[i - 1].side / 3);
	free(keys);
	return true;
}

/* Remembers the first unmirrored and the first mirrored side of the edge, if it has both. */
static void find_mirror(const nt_edge_side *sides, size_t count, mirror_list *list)
{
	const nt_edge_side *found[2] = {NULL, NULL};
	for (size_t i = count; i-- > 0;) {
		const int sign = nt_edge_orientation(&sides[i]);
		if (sign)
			found[sign < 0] = &sides[i];
	}
	if (!found[0] || !found[1])
		return;
	if (nt_grow((void **)&list->edges, &list->capacity, list->count + 1, sizeof *list->edges))
		list->edges[list->count++] = (nt_mirror_edge){.sides = {found[0]->side, found[1]->side},
			.non_manifold = count > 2, .against = !nt_edge_same_way(&sides[0], found[0])};
	else
		list->failed = true;
}

/* Unites those of an edge of three and more that have one orientation. */
static void unite_patches(const nt_check *check, const nt_edge_side *sides, size_t count)
{
	const nt_edge_side *last[3] = {NULL, NULL, NULL};
	for (size_t i = 0; i < count && check->patches; i++) {
		const nt_edge_side **before = &last[nt_edge_orientation(&sides[i]) + 1];
		if (*before)
			unite(check->patches, sides[i].side / 3, (*before)->side / 3);
		*before = &sides[i];
	}
}

static void check_edge(nt_check *check, const nt_edge_side *sides, size_t count, bin_result *result,
	mirror_list *mirrors)
{
	result->edges++;
	if (count == 1) {
		result->boundary++;
		nt_bit_set(check->boundary, sides[0].side);
		return;
	}
	const bool bad = count > 2 || nt_edge_same_way(&sides[0], &sides[1]);
	if (bad)
		nt_tally_side(check, count > 2 ? &result->non_manifold : &result->inconsistent, sides[0].side,
			(double)count);
	for (size_t i = 0; bad && i < count; i++)
		result->areas[count > 2] += nt_triangle_area(&check->surface, sides[i].side / 3);
	if (!check->mesh->texcoords)
		return;
	if (count > 2 || nt_edge_orientation(&sides[0]) != nt_edge_orientation(&sides[1]))
		find_mirror(sides, count, mirrors);
	if (count > 2)
		mirrors->failed |= !unite_many(check, sides, count);
	else if (!(sides[0].low & NT_EDGE_JOINT) || nt_sides_meet(&check->surface, sides[0].side, sides[1].side))
		unite(check->islands, sides[0].side / 3, sides[1].side / 3);
	else
		result->uv_seams++;
	if (count > 2 || nt_sides_meet(&check->surface, sides[0].side, sides[1].side))
		unite_patches(check, sides, count);
}

static void check_bin(void *context, size_t bin, const nt_edge_side *sides, size_t count, unsigned slot)
{
	const edge_work *work = context;
	const uint32_t *islands = work->check->islands;
	bin_result *result = &work->results[bin];
	*result = (bin_result){.non_manifold = {.code = NT_CODE_MESH_NON_MANIFOLD_EDGE},
		.inconsistent = {.code = NT_CODE_MESH_INCONSISTENT_WINDING}};
	for (size_t i = 0, end; i < count; i = end) {
		for (end = i + 1; end < count && nt_edge_same(&sides[i], &sides[end]); end++)
			if (end + AHEAD < count)
				__builtin_prefetch(&islands[sides[end + AHEAD].side / 3], 1);
		check_edge(work->check, sides + i, end - i, result, &work->mirrors[slot]);
	}
}

/* ---- the results together ---- */

static void join_results(nt_check *check, const bin_result *results, size_t count)
{
	nt_report_mesh *facts = check->facts;
	nt_tally non_manifold = {.code = NT_CODE_MESH_NON_MANIFOLD_EDGE};
	nt_tally inconsistent = {.code = NT_CODE_MESH_INCONSISTENT_WINDING};
	double areas[2] = {0.0, 0.0};
	for (size_t bin = 0; bin < count; bin++) {
		facts->edge_count += results[bin].edges;
		facts->boundary_edges += results[bin].boundary;
		facts->uv_seam_edges += results[bin].uv_seams;
		nt_tally_join(&non_manifold, &results[bin].non_manifold);
		nt_tally_join(&inconsistent, &results[bin].inconsistent);
		areas[0] += results[bin].areas[0];
		areas[1] += results[bin].areas[1];
	}
	facts->non_manifold_edges = non_manifold.count;
	facts->inconsistent_edges = inconsistent.count;
	const double least = SLIVER_SHARE * check->total_area;
	/* of no matter to a surface without tangents */
	const bool matters = check->mesh->texcoords && nt_needs_tangents(check) && areas[1] > least;
	nt_check_report_as(check, &non_manifold, matters ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO, NULL);
	nt_check_report_as(check, &inconsistent, areas[0] > least ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO, NULL);
}

/* One list of mirror edges, by their unmirrored sides. */
static nt_status join_mirrors(nt_check *check, const mirror_list *lists, unsigned count)
{
	const size_t sides = 3 * check->surface.triangle_count;
	for (unsigned slot = 0; slot < count; slot++) {
		check->mirror_edge_count += lists[slot].count;
		if (lists[slot].failed)
			return NT_ERROR_MEMORY;
	}
	if (!check->mirror_edge_count)
		return NT_OK;
	check->mirror_edges = nt_scratch_alloc(check->scratch, check->mirror_edge_count, sizeof *check->mirror_edges);
	check->mirrors = nt_scratch_alloc(check->scratch, nt_bit_words(sides), sizeof *check->mirrors);
	check->mirrors_against = nt_scratch_alloc(check->scratch, nt_bit_words(sides), sizeof *check->mirrors_against);
	check->mirror_ranks = nt_scratch_alloc(check->scratch, nt_bit_words(sides), sizeof *check->mirror_ranks);
	if (!check->mirror_edges || !check->mirrors || !check->mirrors_against || !check->mirror_ranks)
		return NT_ERROR_MEMORY;
	memset(check->mirrors, 0, nt_bit_words(sides) * sizeof *check->mirrors);
	memset(check->mirrors_against, 0, nt_bit_words(sides) * sizeof *check->mirrors_against);
	for (unsigned slot = 0; slot < count; slot++) {
		for (size_t i = 0; i < lists[slot].count; i++) {
			const nt_mirror_edge *edge = &lists[slot].edges[i];
			nt_bit_set(check->mirrors, edge->sides[0]);
			if (edge->against)
				nt_bit_set(check->mirrors_against, edge->sides[0]);
		}
	}
	nt_bit_ranks(check->mirrors, sides, check->mirror_ranks);
	for (unsigned slot = 0; slot < count; slot++)
		for (size_t i = 0; i < lists[slot].count; i++)
			*nt_mirror_edge_of(check, lists[slot].edges[i].sides[0]) = lists[slot].edges[i];
	return NT_OK;
}

/* From parents to the numbers of islands, which count by their lowest triangles. */
static void number_islands(nt_check *check)
{
	const nt_surface *s = &check->surface;
	uint32_t count = 0;
	for (size_t t = 0; t < s->triangle_count; t++) {
		const uint32_t parent = check->islands[t]; /* if it is a lower one it has its number */
		if (!nt_has_edges(s, t) || !check->mesh->texcoords)
			check->islands[t] = NT_NONE;
		else
			check->islands[t] = parent == t ? count++ : check->islands[parent];
	}
	check->facts->island_count = count;
}

static nt_status allocate(nt_check *check)
{
	const size_t triangles = check->surface.triangle_count, words = nt_bit_words(3 * triangles);
	check->boundary = nt_scratch_alloc(check->scratch, words, sizeof *check->boundary);
	check->islands = nt_scratch_alloc(check->scratch, triangles, sizeof *check->islands);
	if (!check->boundary || !check->islands)
		return NT_ERROR_MEMORY;
	memset(check->boundary, 0, words * sizeof *check->boundary);
	for (size_t t = 0; t < triangles; t++)
		check->islands[t] = (uint32_t)t;
	if (!check->facts->triangles[0] || !check->facts->triangles[2])
		return NT_OK;
	check->patches = nt_scratch_alloc(check->scratch, triangles, sizeof *check->patches);
	if (check->patches)
		memcpy(check->patches, check->islands, triangles * sizeof *check->patches);
	return check->patches ? NT_OK : NT_ERROR_MEMORY;
}

static nt_status check_bins(nt_check *check, const nt_edge_bins *bins)
{
	edge_work work = {.check = check,
		.results = nt_scratch_alloc(check->scratch, bins->count, sizeof *work.results),
		.mirrors = nt_scratch_alloc(check->scratch, bins->slots, sizeof *work.mirrors)};
	if (!work.results || !work.mirrors)
		return NT_ERROR_MEMORY;
	memset(work.mirrors, 0, bins->slots * sizeof *work.mirrors);
	nt_status status = nt_edge_bins_visit(bins, check->scratch, check_bin, &work);
	if (!status)
		join_results(check, work.results, bins->count);
	if (!status)
		status = join_mirrors(check, work.mirrors, bins->slots);
	for (unsigned slot = 0; slot < bins->slots; slot++)
		free(work.mirrors[slot].edges);
	return status;
}

nt_status nt_check_edges(nt_check *check)
{
	nt_status status = allocate(check);
	nt_edge_bins bins;
	if (!status)
		status = nt_edge_bins_make(&bins, &check->surface, nt_thread_count(check->options->threads),
			check->scratch);
	if (!status)
		status = check_bins(check, &bins);
	if (!status)
		number_islands(check);
	return status;
}
