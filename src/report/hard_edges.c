/* SPDX-License-Identifier: MIT */
/*
 * Hard edges inside a UV island: the normals of both sides differ, the texture coordinates do not. A baker makes the
 * texels of each side for its own normals, and filtering mixes them along the edge. edges.c finds them; here those that
 * hang together at points become a loop, a chain or a net, and all of a mesh one finding. (Every edge of a faceted
 * model is hard: chains that end where three edges meet would be as many as edges.)
 *
 * Linear in the number of hard edges, but for the sort of nets by length, and of points if there are any.
 */
#include "report/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Hard edges that hang together: edges[first] to edges[first + count - 1]. */
typedef struct net {
	size_t first, count, ends; /* ends: points where one edge ends */
	bool forks;                /* more than two edges meet somewhere */
	double length;
	float cosine;              /* of the widest angle between normals */
} net;

typedef struct nets {
	net *items;        /* [count] the longest first */
	size_t count;
	uint32_t *numbers; /* [hard.count] net of each edge, as they were found */
	uint32_t *edges;   /* [hard.count] */
} nets;

/* ---- which edges hang together ---- */

static uint32_t end_of(const nt_check *check, size_t edge, int end)
{
	const uint32_t side = check->hard.items[edge].sides[0];
	return nt_side_point(&check->surface, end ? nt_side_next(side) : side);
}

/* Numbers nets by their lowest edges. degrees: [point_count] hard edges at each point, 3: more than two. */
static nt_status number_nets(const nt_check *check, nets *n, uint8_t *degrees)
{
	const size_t points = check->surface.point_count;
	uint32_t *last = nt_scratch_alloc(check->scratch, points, sizeof *last);
	n->numbers = nt_scratch_alloc(check->scratch, check->hard.count, sizeof *n->numbers);
	if (!last || !n->numbers)
		return NT_ERROR_MEMORY;
	memset(degrees, 0, points);
	memset(last, 0xff, points * sizeof *last);
	for (uint32_t i = 0; i < check->hard.count; i++) {
		n->numbers[i] = i;
		for (int end = 0; end < 2; end++) {
			const uint32_t point = end_of(check, i, end);
			degrees[point] += degrees[point] < 3;
			if (last[point] != NT_NONE)
				nt_unite(n->numbers, last[point], i);
			last[point] = i;
		}
	}
	n->count = nt_number_sets(n->numbers, check->hard.count);
	return NT_OK;
}

static int longest_first(const void *a, const void *b)
{
	const net *x = a, *y = b;
	if (x->length != y->length)
		return x->length > y->length ? -1 : 1;
	return x->first < y->first ? -1 : x->first > y->first;
}

/* Sums up each net, lists its edges, and sorts. */
static void measure_nets(const nt_check *check, nets *n, const uint8_t *degrees)
{
	for (size_t i = 0; i < n->count; i++)
		n->items[i] = (net){.cosine = 1.0f};
	for (size_t i = 0; i < check->hard.count; i++) {
		net *one = &n->items[n->numbers[i]];
		one->count++;
		const uint32_t side = check->hard.items[i].sides[0];
		one->length += nt_world_length(check->facts, nt_side_position(&check->surface, side),
			nt_side_position(&check->surface, nt_side_next(side)));
		one->cosine = fminf(one->cosine, check->hard.items[i].cosine);
		for (int end = 0; end < 2; end++) {
			one->forks |= degrees[end_of(check, i, end)] > 2;
			one->ends += degrees[end_of(check, i, end)] == 1;
		}
	}
	size_t first = 0;
	for (size_t i = 0; i < n->count; i++) {
		n->items[i].first = first;
		first += n->items[i].count;
		n->items[i].count = 0;
	}
	for (size_t i = 0; i < check->hard.count; i++) {
		net *one = &n->items[n->numbers[i]];
		n->edges[one->first + one->count++] = (uint32_t)i;
	}
	qsort(n->items, n->count, sizeof *n->items, longest_first);
}

/* ---- the finding ---- */

/* An info unless a normal map is asked for; a PLY has none. */
static nt_severity severity_of(const nt_check *check)
{
	const bool mapped = nt_is_gltf(check) && check->mesh->slots & (NT_SLOT_NORMAL | NT_SLOT_CLEARCOAT_NORMAL);
	return mapped ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO;
}

/* All nets as a page draws them, the longest first: one seam of the mesh behind the others. */
static nt_status keep_nets(nt_check *check, const nets *n, double length)
{
	nt_report_mesh *facts = check->facts;
	const size_t before = facts->seam_count, count = check->hard.count;
	const size_t kept = count < NT_SEAM_EDGES ? count : NT_SEAM_EDGES;
	nt_seam *all = nt_arena_alloc(&check->report->arena, before + 1, sizeof *all);
	nt_seam_edge *edges = nt_arena_alloc(&check->report->arena, kept, sizeof *edges);
	if (!all || !edges)
		return NT_ERROR_MEMORY;
	if (before)
		memcpy(all, facts->seams, before * sizeof *all);
	all[before] = (nt_seam){.closed = n->count == 1 && !n->items[0].forks && n->items[0].ends == 0,
		.edge_count = count, .length = length, .edges = edges, .box = nt_box_empty()};
	for (size_t k = 0, filled = 0; k < n->count; k++)
		for (size_t i = 0; i < n->items[k].count && filled < kept; i++) {
			const nt_edge *edge = &check->hard.items[n->edges[n->items[k].first + i]];
			edges[filled++] = nt_describe_edge(check, edge, nt_side_point(&check->surface, edge->sides[0]));
		}
	facts->seams = all;
	facts->hard_count = 1;
	return NT_OK;
}

static void tally_edges(const nt_check *check, const nets *n, size_t first, size_t count, nt_tally *tally)
{
	for (size_t i = first; i < first + count; i++) {
		const nt_edge *edge = &check->hard.items[n->edges[i]];
		nt_tally_side(check, tally, edge->sides[0], acos(edge->cosine) * NT_DEGREES);
	}
}

/* One finding for a mesh: an artist goes over all of them at once. Its places are one edge of each net, the longest
 * first, and others of these if there are few. */
static nt_status report_nets(nt_check *check, const nets *n)
{
	nt_tally tally = {.code = NT_CODE_UV_HARD_EDGE, .seam = (uint32_t)check->facts->seam_count + 1};
	const net *longest = &n->items[0];
	float cosine = 1.0f;
	for (size_t k = 0; k < n->count; k++) {
		tally.rank += n->items[k].length;
		cosine = fminf(cosine, n->items[k].cosine);
		tally_edges(check, n, n->items[k].first, 1, &tally);
	}
	for (size_t k = 0; k < n->count; k++)
		tally_edges(check, n, n->items[k].first + 1, n->items[k].count - 1, &tally);
	const double length = tally.rank;
	const char *kind = longest->forks ? "a net" : longest->ends ? "an open chain" : "a closed loop";
	char nets_text[64] = "";
	if (n->count > 1)
		snprintf(nets_text, sizeof nets_text, "%zu nets, the longest ", n->count);
	nt_tally_number(&tally, "length", length);
	nt_tally_number(&tally, "worst_degrees", acos(cosine) * NT_DEGREES);
	nt_check_report_as(check, &tally, severity_of(check), "%s%s of length %.4g; normals up to %.3g degrees apart",
		nets_text, kind, longest->length, acos(cosine) * NT_DEGREES);
	return keep_nets(check, n, length);
}

nt_status nt_check_hard_edges(nt_check *check)
{
	if (!check->hard.count)
		return NT_OK;
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	nets n = {.edges = nt_scratch_alloc(check->scratch, check->hard.count, sizeof *n.edges)};
	uint8_t *degrees = nt_scratch_alloc(check->scratch, check->surface.point_count, 1);
	nt_status status = n.edges && degrees ? number_nets(check, &n, degrees) : NT_ERROR_MEMORY;
	if (!status && !(n.items = nt_scratch_alloc(check->scratch, n.count, sizeof *n.items)))
		status = NT_ERROR_MEMORY;
	if (!status) {
		measure_nets(check, &n, degrees);
		status = report_nets(check, &n);
	}
	nt_scratch_back(check->scratch, mark);
	return status;
}
