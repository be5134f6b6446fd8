/* SPDX-License-Identifier: MIT */
/*
 * One pass over the edges of a surface: which are open, which are shared by too many triangles or wound
 * inconsistently, across which the texture coordinates continue (that gives the islands), are cut, or
 * change their orientation (that gives the mirror edges, which seams.c puts in order).
 *
 * Two triangles of an edge continue each other in UV space when both ends have equal texture
 * coordinates on both. On an edge of many triangles all that have the same coordinates do.
 */
#include "report/check.h"

#include <stdlib.h>
#include <string.h>

/* ---- islands by union and find, the lower number on top ---- */

static uint32_t find_root(uint32_t *parents, uint32_t t)
{
	while (parents[t] != t) {
		parents[t] = parents[parents[t]];
		t = parents[t];
	}
	return t;
}

static void unite(uint32_t *parents, uint32_t a, uint32_t b)
{
	a = find_root(parents, a);
	b = find_root(parents, b);
	if (a < b)
		parents[b] = a;
	else
		parents[a] = b;
}

/* ---- one edge ---- */

typedef struct edge_tallies {
	nt_tally non_manifold, inconsistent;
} edge_tallies;

static bool same_way(const nt_surface *s, uint32_t a, uint32_t b)
{
	return s->points[a] == s->points[b];
}

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

static side_key key_of(const nt_surface *s, uint32_t side)
{
	const uint32_t next = nt_side_next(side);
	const bool ascending = s->points[side] < s->points[next];
	const float *low = nt_side_texcoord(s, ascending ? side : next);
	const float *high = nt_side_texcoord(s, ascending ? next : side);
	return (side_key){{low[0], low[1], high[0], high[1]}, side};
}

static bool same_coordinates(const side_key *a, const side_key *b)
{
	return a->uv[0] == b->uv[0] && a->uv[1] == b->uv[1] && a->uv[2] == b->uv[2] &&
		a->uv[3] == b->uv[3];
}

/* Unites all triangles of an edge of three and more that have the same coordinates along it. */
static nt_status unite_many(const nt_surface *s, const uint32_t *sides, size_t count,
	uint32_t *parents)
{
	side_key *keys = nt_alloc(count, sizeof *keys);
	if (!keys)
		return NT_ERROR_MEMORY;
	for (size_t i = 0; i < count; i++)
		keys[i] = key_of(s, sides[i]);
	qsort(keys, count, sizeof *keys, by_key);
	for (size_t i = 1; i < count; i++)
		if (same_coordinates(&keys[i], &keys[i - 1]))
			unite(parents, keys[i].side / 3, keys[i - 1].side / 3);
	free(keys);
	return NT_OK;
}

/* Remembers the first unmirrored and the first mirrored side of the edge, if it has both. */
static void find_mirror(nt_check *check, const uint32_t *sides, size_t count)
{
	uint32_t found[2] = {NT_NONE, NT_NONE};
	for (size_t i = count; i-- > 0;) {
		const int sign = check->surface.orientation[sides[i] / 3];
		if (sign)
			found[sign < 0] = sides[i];
	}
	if (found[0] == NT_NONE || found[1] == NT_NONE)
		return;
	const uint32_t index = (uint32_t)check->mirror_edge_count++;
	check->mirror_edges[index] = (nt_mirror_edge){{found[0], found[1]}, count > 2};
	check->seam_edge[found[0]] = check->seam_edge[found[1]] = index;
}

static nt_status check_edge(nt_check *check, const uint32_t *sides, size_t count, uint32_t *parents,
	edge_tallies *tallies)
{
	nt_report_mesh *facts = check->facts;
	const nt_surface *s = &check->surface;
	if (count == 1) {
		facts->boundary_edges++;
		check->boundary[sides[0]] = 1;
		return NT_OK;
	}
	if (count > 2)
		nt_tally_side(check, &tallies->non_manifold, sides[0], (double)count);
	else if (same_way(s, sides[0], sides[1]))
		nt_tally_side(check, &tallies->inconsistent, sides[0], (double)count);
	if (!check->mesh->texcoords)
		return NT_OK;
	find_mirror(check, sides, count);
	if (count > 2)
		return unite_many(s, sides, count, parents);
	if (nt_sides_meet(s, sides[0], sides[1]))
		unite(parents, sides[0] / 3, sides[1] / 3);
	else
		facts->uv_seam_edges++;
	return NT_OK;
}

/* Numbers islands by their lowest triangle. */
static void number_islands(nt_check *check, uint32_t *parents)
{
	const nt_surface *s = &check->surface;
	uint32_t count = 0;
	for (size_t t = 0; t < s->triangle_count; t++) {
		const bool has_edges = s->flatness[t] == NT_SOUND || s->flatness[t] == NT_COLLINEAR;
		const uint32_t root = find_root(parents, (uint32_t)t);
		if (!has_edges || !check->mesh->texcoords)
			check->islands[t] = NT_NONE;
		else
			check->islands[t] = root == t ? count++ : check->islands[root];
	}
	check->facts->island_count = count;
}

static nt_status allocate(nt_check *check)
{
	const size_t sides = 3 * check->surface.triangle_count;
	check->boundary = nt_scratch_alloc(check->scratch, sides, sizeof *check->boundary);
	check->seam_edge = nt_scratch_alloc(check->scratch, sides, sizeof *check->seam_edge);
	check->mirror_edges = nt_scratch_alloc(check->scratch, check->surface.edge_count,
		sizeof *check->mirror_edges);
	check->islands = nt_scratch_alloc(check->scratch, sides / 3, sizeof *check->islands);
	if (!check->boundary || !check->seam_edge || !check->mirror_edges || !check->islands)
		return NT_ERROR_MEMORY;
	memset(check->boundary, 0, sides * sizeof *check->boundary);
	return NT_OK;
}

nt_status nt_check_edges(nt_check *check)
{
	const nt_surface *s = &check->surface;
	nt_status status = allocate(check);
	if (status)
		return status;
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	uint32_t *parents = nt_scratch_alloc(check->scratch, s->triangle_count, sizeof *parents);
	if (!parents)
		return NT_ERROR_MEMORY;
	for (size_t t = 0; t < s->triangle_count; t++)
		parents[t] = (uint32_t)t;

	edge_tallies tallies = {{.code = NT_CODE_MESH_NON_MANIFOLD_EDGE},
		{.code = NT_CODE_MESH_INCONSISTENT_WINDING}};
	for (size_t e = 0; e < s->edge_count && !status; e++)
		status = check_edge(check, s->sides + s->edge_first[e],
			s->edge_first[e + 1] - s->edge_first[e], parents, &tallies);
	if (status)
		return status;
	number_islands(check, parents);
	nt_scratch_back(check->scratch, mark);

	check->facts->edge_count = s->edge_count;
	check->facts->non_manifold_edges = tallies.non_manifold.count;
	check->facts->inconsistent_edges = tallies.inconsistent.count;
	nt_check_report(check, &tallies.non_manifold, NULL);
	nt_check_report(check, &tallies.inconsistent, NULL);
	return NT_OK;
}
