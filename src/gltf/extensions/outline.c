/* SPDX-License-Identifier: MIT */
/*
 * CESIUM_primitive_outline lists edges as pairs of vertices, and a client draws those sides of triangles that have
 * both. A triangle whose vertices were copied has other numbers, so that each edge becomes all the pairs that its sides
 * have now; an edge that no triangle has stays as it is. By sorting: n log n in edges and corners.
 */
#include "gltf/extensions/extensions.h"

#include <stdlib.h>
#include <string.h>

/* An edge of the outline by its ends. */
typedef struct outline_edge {
	uint64_t key;    /* the ends, smaller first */
	size_t number;
} outline_edge;

/* A side of a triangle that is on an edge: what it is now, from the edge's first end to its second. */
typedef struct found_side {
	size_t number; /* of the edge */
	uint32_t ends[2];
} found_side;

static uint64_t key_of(uint32_t a, uint32_t b)
{
	return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static int compare_edges(const void *a, const void *b)
{
	const outline_edge *x = a, *y = b;
	if (x->key != y->key)
		return x->key < y->key ? -1 : 1;
	return x->number < y->number ? -1 : x->number > y->number;
}

static int compare_sides(const void *a, const void *b)
{
	const found_side *x = a, *y = b;
	if (x->number != y->number)
		return x->number < y->number ? -1 : 1;
	for (int i = 0; i < 2; i++)
		if (x->ends[i] != y->ends[i])
			return x->ends[i] < y->ends[i] ? -1 : 1;
	return 0;
}

static uint32_t source_of(const nt_copied_triangles *t, uint32_t vertex)
{
	return vertex < t->old_count ? vertex : t->sources[vertex - t->old_count];
}

/* The first edge with that key; NULL: none. */
static const outline_edge *find_edge(const outline_edge *edges, size_t count, uint64_t key)
{
	size_t low = 0, high = count;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (edges[middle].key < key)
			low = middle + 1;
		else
			high = middle;
	}
	return low < count && edges[low].key == key ? &edges[low] : NULL;
}

/* All sides on edges, sorted by edge, each once. */
static size_t find_sides(const uint32_t *edges, const outline_edge *sorted, size_t edge_count,
	const nt_copied_triangles *t, found_side *sides)
{
	size_t count = 0;
	for (size_t c = 0; c < t->corner_count; c++) {
		const uint32_t a = t->vertices[c], b = t->vertices[c % 3 == 2 ? c - 2 : c + 1];
		const uint32_t from = source_of(t, a);
		const outline_edge *edge = find_edge(sorted, edge_count, key_of(from, source_of(t, b)));
		if (!edge)
			continue;
		const bool along = edges[2 * edge->number] == from;
		sides[count++] = (found_side){edge->number, {along ? a : b, along ? b : a}};
	}
	qsort(sides, count, sizeof *sides, compare_sides);
	size_t kept = 0;
	for (size_t i = 0; i < count; i++)
		if (i == 0 || compare_sides(&sides[i], &sides[kept - 1]) != 0)
			sides[kept++] = sides[i];
	return kept;
}

/* Edges in their order: as their sides have them, else as they were. */
static size_t list_edges(const uint32_t *edges, size_t edge_count, const found_side *sides, size_t side_count,
	uint32_t *out)
{
	size_t side = 0, count = 0;
	for (size_t e = 0; e < edge_count; e++) {
		const size_t before = count;
		for (; side < side_count && sides[side].number == e; side++)
			memcpy(out + 2 * count++, sides[side].ends, sizeof sides[side].ends);
		if (count == before)
			memcpy(out + 2 * count++, edges + 2 * e, 2 * sizeof *edges);
	}
	return count;
}

nt_status nt_outline_follow(const uint32_t *edges, size_t edge_count, const nt_copied_triangles *triangles,
	nt_arena *arena, uint32_t **result, size_t *result_count)
{
	outline_edge *sorted = nt_alloc(edge_count, sizeof *sorted);
	found_side *sides = nt_alloc(triangles->corner_count, sizeof *sides);
	nt_status status = NT_ERROR_MEMORY;
	if (sorted && sides) {
		for (size_t e = 0; e < edge_count; e++)
			sorted[e] = (outline_edge){key_of(edges[2 * e], edges[2 * e + 1]), e};
		qsort(sorted, edge_count, sizeof *sorted, compare_edges);
		const size_t side_count = find_sides(edges, sorted, edge_count, triangles, sides);
		*result = nt_arena_alloc(arena, edge_count + side_count, 2 * sizeof **result);
		if (*result) {
			*result_count = list_edges(edges, edge_count, sides, side_count, *result);
			status = NT_OK;
		}
	}
	free(sorted);
	free(sides);
	return status;
}
