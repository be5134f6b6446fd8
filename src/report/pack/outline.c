/* SPDX-License-Identifier: MIT */
/*
 * Outlines: see outline.h. Every triangle that spans an area gives three directed edges between points of UV space,
 * counterclockwise; edges of one region that run against each other cancel, and what remains is the boundary. It
 * enters and leaves each point equally often, so that walking along it ends where it began.
 */
#include "report/pack/outline.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "report/pack/varint.h"

/* An edge at its lower point. */
typedef struct half_edge {
	uint32_t far, region;
	int32_t upward; /* 1: it begins at the lower point, -1: it ends there */
} half_edge;

typedef struct outline_edge {
	uint32_t region, from, to;
} outline_edge;

typedef struct outlining {
	const nt_outlined *mesh;
	uint32_t *points;      /* [vertex_count] the first vertex with the same texture coordinates */
	uint32_t *first;       /* [vertex_count + 1] where a point's half edges begin; then, in put_loops(), its
	                          edges */
	half_edge *halves;     /* [3 * triangle_count] */
	nt_buffer edges;       /* outline_edge */
} outlining;

/* ---- points ---- */

static nt_status weld_points(outlining *o)
{
	nt_hash_index index = {0};
	bool added = true;
	for (uint32_t v = 0; v < o->mesh->vertex_count && added; v++) {
		const float *uv = o->mesh->texcoords + 2 * (size_t)v;
		const uint64_t bits = nt_hash_floats(uv[0], uv[1]), hash = nt_hash_words(bits, 0);
		uint32_t other;
		for (size_t at = NT_HASH_BEGIN; (other = nt_hash_index_next(&index, hash, &at)) != NT_NONE;) {
			/* as bits: NaN equals itself here */
			const float *known = o->mesh->texcoords + 2 * (size_t)other;
			if (nt_hash_floats(known[0], known[1]) == bits)
				break;
		}
		o->points[v] = other == NT_NONE ? v : other;
		added = other != NT_NONE || nt_hash_index_add(&index, hash, v);
	}
	nt_hash_index_free(&index);
	return added ? NT_OK : NT_ERROR_MEMORY;
}

/* ---- edges ---- */

static bool is_outlined(const nt_outlined *mesh, size_t t)
{
	return mesh->orientation[t] != 0 && (!mesh->islands || mesh->islands[t] != NT_NONE);
}

static uint32_t region_of(const nt_outlined *mesh, size_t t)
{
	return 2 * (mesh->islands ? mesh->islands[t] : 0) + (mesh->orientation[t] < 0);
}

/* The ends of edge k of a triangle, as points, so that it runs counterclockwise. */
static void edge_ends(const outlining *o, size_t t, unsigned k, uint32_t ends[2])
{
	const uint32_t *v = o->mesh->indices + 3 * t;
	const bool turned = o->mesh->orientation[t] < 0;
	ends[turned] = o->points[v[k]];
	ends[!turned] = o->points[v[(k + 1) % 3]];
}

/* Sorts the edges of all triangles by their lower point. */
static void list_halves(outlining *o)
{
	const nt_outlined *mesh = o->mesh;
	uint32_t ends[2];
	memset(o->first, 0, (mesh->vertex_count + 1) * sizeof *o->first);
	for (size_t t = 0; t < mesh->triangle_count; t++)
		for (unsigned k = 0; k < 3 && is_outlined(mesh, t); k++) {
			edge_ends(o, t, k, ends);
			o->first[(ends[0] < ends[1] ? ends[0] : ends[1]) + 1]++;
		}
	for (size_t v = 0; v < mesh->vertex_count; v++)
		o->first[v + 1] += o->first[v];
	for (size_t t = 0; t < mesh->triangle_count; t++)
		for (unsigned k = 0; k < 3 && is_outlined(mesh, t); k++) {
			edge_ends(o, t, k, ends);
			const bool upward = ends[0] < ends[1];
			o->halves[o->first[ends[!upward]]++] =
				(half_edge){ends[upward], region_of(mesh, t), upward ? 1 : -1};
		}
	/* filling moved each beginning to its end, which is the next one's beginning */
	memmove(o->first + 1, o->first, mesh->vertex_count * sizeof *o->first);
	o->first[0] = 0;
}

static int compare_halves(const void *a, const void *b)
{
	const half_edge *x = a, *y = b;
	if (x->far != y->far)
		return x->far < y->far ? -1 : 1;
	return x->region < y->region ? -1 : x->region > y->region;
}

/* Cancels the half edges of a point, and keeps what remains. */
static void keep_boundary(outlining *o, uint32_t point)
{
	half_edge *begin = o->halves + o->first[point], *end = o->halves + o->first[point + 1];
	qsort(begin, (size_t)(end - begin), sizeof *begin, compare_halves);
	while (begin < end) {
		const half_edge *group = begin;
		int32_t winding = 0;
		for (; begin < end && compare_halves(begin, group) == 0; begin++)
			winding += begin->upward;
		const outline_edge edge = {group->region, winding > 0 ? point : group->far,
			winding > 0 ? group->far : point};
		for (int32_t i = abs(winding); i > 0; i--)
			nt_buffer_append(&o->edges, &edge, sizeof edge);
	}
}

/* ---- loops ---- */

static int compare_edges(const void *a, const void *b)
{
	const outline_edge *x = a, *y = b;
	if (x->region != y->region)
		return x->region < y->region ? -1 : 1;
	if (x->from != y->from)
		return x->from < y->from ? -1 : 1;
	return x->to < y->to ? -1 : x->to > y->to;
}

/* Walks once around, from an edge that was not used. leaving[p]: the first of the region's edges that begin at point p.
 * used[i]: how many of the edges that begin where edge i begins are used, at the first of them. */
static void put_loop(const outline_edge *edges, const uint32_t *leaving, uint32_t *used, uint32_t start,
	uint32_t *before, nt_buffer *out)
{
	nt_buffer points = {0};
	uint32_t point_count = 0;
	for (uint32_t first = start;;) {
		const outline_edge *edge = &edges[first + used[first]++];
		nt_put_varint(nt_zigzag(edge->from - *before), &points);
		*before = edge->from;
		point_count++;
		if (edge->to == edges[start].from)
			break;
		first = leaving[edge->to];
	}
	nt_put_varint(point_count, out);
	nt_buffer_append(out, points.data, points.size);
	nt_buffer_free_into(&points, out);
}

static uint32_t put_loops(const outline_edge *edges, uint32_t count, uint32_t *leaving, uint32_t *used,
	uint32_t *before, nt_buffer *out)
{
	uint32_t loops = 0;
	for (uint32_t i = count; i-- > 0;)
		leaving[edges[i].from] = i;
	for (uint32_t i = 0, next; i < count; i = next) {
		for (next = i; next < count && edges[next].from == edges[i].from; next++)
			;
		while (i + used[i] < next) {
			put_loop(edges, leaving, used, i, before, out);
			loops++;
		}
	}
	return loops;
}

static nt_status put_regions(outlining *o, nt_buffer *out)
{
	outline_edge *edges = (outline_edge *)(void *)o->edges.data;
	const size_t count = o->edges.size / sizeof *edges;
	uint32_t *used = nt_calloc(count, sizeof *used);
	if (!used)
		return NT_ERROR_MEMORY;
	if (count)
		qsort(edges, count, sizeof *edges, compare_edges);
	nt_buffer regions = {0};
	uint32_t region_count = 0, before = 0, region = 0;
	for (size_t i = 0, next; i < count; i = next) {
		nt_buffer loops = {0};
		for (next = i; next < count && edges[next].region == edges[i].region; next++)
			;
		const uint32_t loop_count =
			put_loops(edges + i, (uint32_t)(next - i), o->first, used + i, &before, &loops);
		nt_put_varint(nt_zigzag(edges[i].region - region), &regions);
		nt_put_varint(loop_count, &regions);
		nt_buffer_append(&regions, loops.data, loops.size);
		nt_buffer_free_into(&loops, &regions);
		region = edges[i].region;
		region_count++;
	}
	nt_put_varint(region_count, out);
	nt_buffer_append(out, regions.data, regions.size);
	nt_buffer_free_into(&regions, out);
	free(used);
	return out->failed ? NT_ERROR_MEMORY : NT_OK;
}

nt_status nt_outline_islands(const nt_outlined *mesh, nt_buffer *out)
{
	outlining o = {.mesh = mesh, .points = nt_alloc(mesh->vertex_count, sizeof *o.points),
		.first = nt_alloc(mesh->vertex_count + 1, sizeof *o.first),
		.halves = nt_alloc(3 * mesh->triangle_count, sizeof *o.halves)};
	nt_status status = o.points && o.first && o.halves ? weld_points(&o) : NT_ERROR_MEMORY;
	if (!status) {
		list_halves(&o);
		for (uint32_t v = 0; v < mesh->vertex_count; v++)
			keep_boundary(&o, v);
		status = o.edges.failed ? NT_ERROR_MEMORY : put_regions(&o, out);
	}
	nt_buffer_free(&o.edges);
	free(o.points);
	free(o.first);
	free(o.halves);
	return status;
}
