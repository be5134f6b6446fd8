/* SPDX-License-Identifier: MIT */
/*
 * Compact views. Primitives that share one vertex buffer are loaded with the vertices that their own corners use, so
 * that each costs what it uses and not what all of them have together. Vertices keep their order: a pass through
 * them in ascending order meets them as in the buffer. One that uses nearly all vertices takes them as they are.
 *
 * A table over the range from the least to the greatest index gives each vertex its number. If corners are few in a
 * wide range, they are sorted instead: the cost is bounded by corners alone.
 */
#include "gltf/load.h"

#include <stdlib.h>
#include <string.h>

enum {
	SPARSE = 8, /* vertices of the range for each corner, from which on corners are sorted */
	MOST = 8    /* all vertices but one in so many are nearly all */
};

typedef struct range {
	uint32_t least, most;
} range;

static range find_range(const uint32_t *indices, size_t count)
{
	range r = {UINT32_MAX, 0};
	for (size_t c = 0; c < count; c++) {
		r.least = indices[c] < r.least ? indices[c] : r.least;
		r.most = indices[c] > r.most ? indices[c] : r.most;
	}
	return r;
}

static nt_status number_by_table(const uint32_t *indices, size_t corner_count, size_t vertex_count, range r,
	nt_arena *arena, nt_compact *view)
{
	const size_t size = (size_t)r.most - r.least + 1;
	uint32_t *table = nt_calloc(size, sizeof *table);
	if (!table)
		return NT_ERROR_MEMORY;
	for (size_t c = 0; c < corner_count; c++)
		table[indices[c] - r.least] = 1;
	for (size_t v = 0; v < size; v++)
		view->count += table[v];
	const bool most = view->count >= vertex_count - vertex_count / MOST;
	if (most)
		view->count = vertex_count;
	view->vertices = most ? NULL : nt_arena_alloc(arena, view->count, sizeof *view->vertices);
	view->indices = most ? NULL : nt_arena_alloc(arena, corner_count, sizeof *view->indices);
	const bool numbered = view->vertices && view->indices;
	for (size_t v = 0, number = 0; numbered && v < size; v++)
		if (table[v]) {
			view->vertices[number] = r.least + (uint32_t)v;
			table[v] = (uint32_t)number++;
		}
	for (size_t c = 0; numbered && c < corner_count; c++)
		view->indices[c] = table[indices[c] - r.least];
	free(table);
	return most || numbered ? NT_OK : NT_ERROR_MEMORY;
}

static int compare_numbers(const void *a, const void *b)
{
	const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
	return (x > y) - (x < y);
}

static nt_status number_by_sorting(const uint32_t *indices, size_t corner_count, nt_arena *arena, nt_compact *view)
{
	view->vertices = nt_arena_alloc(arena, corner_count, sizeof *view->vertices);
	view->indices = nt_arena_alloc(arena, corner_count, sizeof *view->indices);
	if (!view->vertices || !view->indices)
		return NT_ERROR_MEMORY;
	memcpy(view->vertices, indices, corner_count * sizeof *indices);
	qsort(view->vertices, corner_count, sizeof *view->vertices, compare_numbers);
	for (size_t c = 0; c < corner_count; c++)
		if (c == 0 || view->vertices[c] != view->vertices[view->count - 1])
			view->vertices[view->count++] = view->vertices[c];
	for (size_t c = 0; c < corner_count; c++) {
		const uint32_t *found = bsearch(&indices[c], view->vertices, view->count, sizeof *indices,
			compare_numbers);
		view->indices[c] = (uint32_t)(found - view->vertices);
	}
	return NT_OK;
}

nt_status nt_compact_vertices(const uint32_t *indices, size_t corner_count, size_t vertex_count, nt_arena *arena,
	nt_compact *view)
{
	*view = (nt_compact){.count = 0};
	memcpy(&view->indices, &indices, sizeof indices);
	if (corner_count == 0) {
		view->count = vertex_count;
		return NT_OK;
	}
	view->indices = NULL;
	const range r = find_range(indices, corner_count);
	const nt_status status = ((size_t)r.most - r.least) / SPARSE >= corner_count
		? number_by_sorting(indices, corner_count, arena, view)
		: number_by_table(indices, corner_count, vertex_count, r, arena, view);
	if (!status && !view->vertices)
		memcpy(&view->indices, &indices, sizeof indices);
	return status;
}

float *nt_compact_rows(const nt_compact *view, const float *rows, size_t floats, nt_arena *arena)
{
	float *own = NULL;
	if (!view->vertices) {
		memcpy(&own, &rows, sizeof own);
		return own;
	}
	own = nt_arena_alloc(arena, view->count, floats * sizeof *own);
	for (size_t v = 0; own && v < view->count; v++)
		memcpy(own + floats * v, rows + floats * view->vertices[v], floats * sizeof *own);
	return own;
}
