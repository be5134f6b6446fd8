/* SPDX-License-Identifier: MIT */
/*
 * Representatives of vertices, by halving cells: see edge_sort.h.
 */
#include "topology/edge_sort.h"

#include <float.h>
#include <string.h>
#include "base/compiler.h"
#if NT_VECTORS && defined(__SSE2__)
#include <emmintrin.h>
#endif

static const nt_row_box nothing = {{FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX, -FLT_MAX}};

/* Adds rows [0, count), or those of vertices[0, count), to a box; false if a coordinate is NaN. */
static inline NT_ALWAYS_INLINE bool add_rows(
	const float *rows, size_t step, const uint32_t *vertices, size_t count, nt_row_box *b)
{
#if NT_VECTORS && defined(__SSE2__)
	__m128 low = _mm_loadu_ps(b->low), high = _mm_loadu_ps(b->high), unordered = _mm_setzero_ps();
	for (size_t i = 0; i < count; i++) {
		const __m128 p = _mm_loadu_ps(rows + step * (vertices ? vertices[i] : i));
		low = _mm_min_ps(low, p);
		high = _mm_max_ps(high, p);
		unordered = _mm_or_ps(unordered, _mm_cmpunord_ps(p, p));
	}
	_mm_storeu_ps(b->low, low);
	_mm_storeu_ps(b->high, high);
	return !(_mm_movemask_ps(unordered) & 7);
#else
	int unordered = 0;
	for (size_t i = 0; i < count; i++) {
		const float *p = rows + step * (vertices ? vertices[i] : i);
		for (int k = 0; k < 3; k++) {
			b->low[k] = p[k] < b->low[k] ? p[k] : b->low[k];
			b->high[k] = p[k] > b->high[k] ? p[k] : b->high[k];
			unordered |= p[k] != p[k];
		}
	}
	return !unordered;
#endif
}

/* Makes the grid of a box. */
static bool set_grid(const nt_row_box *b, nt_grid *grid)
{
	for (int i = 0; i < 3; i++)
		if (!(b->low[i] > -FLT_MAX / 2 && b->high[i] < FLT_MAX / 2))
			return false;
	grid->axis = nt_longest_axis(b);
	grid->low = b->low[grid->axis];
	grid->high = b->high[grid->axis];
	grid->inverse = 1 / (double)(grid->high - grid->low);
	return true;
}

bool nt_grid_make(const nt_welded_mesh *mesh, uint32_t extremes[6], nt_grid *grid)
{
	enum { BLOCK = 64 };
	nt_row_box all = nothing;
	bool ordered = true;
	size_t blocks[6] = {0}; /* where the sides are */
	if (!extremes && mesh->box)
		return set_grid(mesh->box, grid);
	if (!extremes)
		return add_rows(mesh->positions, mesh->step, NULL, mesh->vertex_count, &all) && set_grid(&all, grid);
	for (size_t v = 0; v < mesh->vertex_count; v += BLOCK) {
		const size_t left = mesh->vertex_count - v;
		nt_row_box box = all;
		ordered &= add_rows(
			mesh->positions + mesh->step * v, mesh->step, NULL, left < BLOCK ? left : BLOCK, &box);
		for (int i = 0; i < 3; i++) {
			blocks[2 * i] = box.low[i] < all.low[i] ? v : blocks[2 * i];
			blocks[2 * i + 1] = box.high[i] > all.high[i] ? v : blocks[2 * i + 1];
		}
		all = box;
	}
	if (!ordered || !set_grid(&all, grid))
		return false;
	for (int i = 0; i < 6; i++) {
		const float side = (i % 2 ? all.high : all.low)[i / 2];
		while (nt_welded_position(mesh, (uint32_t)blocks[i])[i / 2] != side)
			blocks[i]++;
		extremes[i] = (uint32_t)blocks[i];
	}
	return true;
}

bool nt_grid_of_used(const nt_welded_mesh *mesh, nt_grid *grid)
{
	enum { BATCH = 16 }; /* triangles */
	nt_row_box all = nothing;
	bool ordered = true;
	for (size_t t = 0, count; t < mesh->triangle_count; t += count) {
		uint32_t copy[3 * BATCH];
		count = mesh->triangle_count - t < BATCH ? mesh->triangle_count - t : BATCH;
		const uint32_t *ids = nt_triangle_vertices(mesh->triangles, t, count, copy);
		ordered &= add_rows(mesh->positions, mesh->step, ids, 3 * count, &all);
	}
	return ordered && set_grid(&all, grid);
}

bool nt_cells_make(nt_scratch *scratch, nt_cell_vertex *vertices, size_t vertex_count, size_t most_corners,
	nt_cells *cells)
{
	uint32_t *room = nt_scratch_alloc(scratch, 1, (vertex_count + most_corners) * sizeof *room + vertex_count);
	if (!room)
		return false;
	*cells = (nt_cells){.vertices = vertices, .order = room, .scratch = scratch};
	cells->swaps = cells->order + vertex_count;
	cells->below = (uint8_t *)(cells->swaps + most_corners);
	return true;
}

bool nt_cells_find_middle(const nt_cells *c, nt_part *p)
{
	enum { STEP = sizeof *c->vertices / sizeof *c->vertices->position };
	nt_row_box b = nothing;
	(void)add_rows(c->vertices->position, STEP, c->order + p->vertices, p->vertex_count, &b);
	p->axis = (uint8_t)nt_longest_axis(&b);
	p->middle = 0.5f * (b.high[p->axis] + b.low[p->axis]);
	return p->middle < b.high[p->axis] && p->middle > b.low[p->axis];
}

/* Two parts; NULL when out of memory. */
static nt_part *take_parts(nt_cells *c)
{
	enum { PARTS = 512 };
	if (c->part_count < 2) {
		c->parts = nt_scratch_alloc(c->scratch, PARTS, sizeof *c->parts);
		c->part_count = c->parts ? PARTS : 0;
	}
	nt_part *two = c->parts;
	if (!two)
		return NULL;
	c->parts += 2;
	c->part_count -= 2;
	return two;
}

/* Halves a part; a half of one vertex is found at once, and the part becomes the other. False when out of memory.
 * Corners are swapped until those below the middle come first, and only those that have to: the first that is above
 * with the last that is below, and so on. The order of all others, and which are swapped, decides in the end. */
static bool halve(nt_cells *c, nt_part *p)
{
	nt_cell_vertex *const vertices = c->vertices;
	uint8_t *const is_below = c->below;
	uint32_t *const order = c->order + p->vertices;
	nt_cell_corner *const corners = c->corners + p->corners;
	const uint32_t vertex_count = p->vertex_count, corner_count = p->corner_count, axis = p->axis;
	const float middle = p->middle;
	uint32_t low = 0, left = 0, swap_count = 0, other_count = 0;
	for (uint32_t i = 0; i < vertex_count; i++) {
		const uint32_t one = order[i], other = order[low];
		const bool below = vertices[one].position[axis] < middle;
		const uint32_t mask = -(uint32_t)below, changed = (one ^ other) & mask;
		is_below[one] = below;
		order[i] = one ^ changed;
		order[low] = other ^ changed;
		left += vertices[one].corners & mask;
		low += below;
	}
	uint32_t *const above = c->swaps, *const below = above + left;
	for (uint32_t i = 0; i < left; i++) {
		above[swap_count] = i;
		swap_count += !is_below[corners[i].vertex];
	}
	for (uint32_t i = corner_count; other_count < swap_count;) { /* as many are below */
		below[other_count] = --i;
		other_count += is_below[corners[i].vertex];
	}
	for (uint32_t i = 0; i < swap_count; i++) {
		const nt_cell_corner swapped = corners[above[i]];
		corners[above[i]] = corners[below[i]];
		corners[below[i]] = swapped;
	}
	const nt_part lower = {.vertices = p->vertices, .corners = p->corners, .vertex_count = low,
		.corner_count = left, .halvings = (uint8_t)(p->halvings + 1)};
	const nt_part upper = {.vertices = p->vertices + low, .corners = p->corners + left,
		.vertex_count = vertex_count - low, .corner_count = corner_count - left,
		.halvings = lower.halvings};
	if (low == 1) {
		vertices[order[0]].corners = NT_CELL_FOUND | corners[0].corner;
		*p = upper;
	} else if (low + 1 == vertex_count) {
		vertices[order[low]].corners = NT_CELL_FOUND | corners[left].corner;
		*p = lower;
	} else if ((p->halves = take_parts(c))) {
		p->halves[0] = lower;
		p->halves[1] = upper;
	} else
		return false;
	return true;
}

/* A part of two vertices at different places: the same as if it were halved. */
static void find_two(const nt_cells *c, const nt_part *p)
{
	nt_cell_vertex *const vertices = c->vertices;
	const uint32_t *const order = c->order + p->vertices;
	const nt_cell_corner *const corners = c->corners + p->corners;
	const bool second = vertices[order[1]].position[p->axis] < vertices[order[0]].position[p->axis];
	const uint32_t below = order[second], above = order[!second], left = vertices[below].corners;
	size_t first = corners->vertex == below ? 0 : p->corner_count - 1;
	while (corners[first].vertex != below)
		first--;
	vertices[below].corners = NT_CELL_FOUND | corners[first].corner;
	first = corners[left].vertex == above ? left : left - 1;
	while (corners[first].vertex != above)
		first--;
	vertices[above].corners = NT_CELL_FOUND | corners[first].corner;
}

bool nt_cells_find(nt_cells *c, nt_part *p, uint32_t vertex)
{
	while (!(c->vertices[vertex].corners & NT_CELL_FOUND))
		if (p->halves)
			p = &p->halves[!(c->vertices[vertex].position[p->axis] < p->middle)];
		else if (p->vertex_count == 1 || !nt_cells_find_middle(c, p))
			/* each has the first of its corners here */
			for (uint32_t i = p->vertex_count > 1 ? p->corner_count : 1; i-- > 0;) {
				const nt_cell_corner *corner = &c->corners[p->corners + i];
				c->vertices[corner->vertex].corners = NT_CELL_FOUND | corner->corner;
			}
		else if ((c->limit = p->halvings == NT_HALVINGS))
			return false;
		else if (p->vertex_count == 2)
			find_two(c, p);
		else if (!halve(c, p))
			return false;
	return true;
}
