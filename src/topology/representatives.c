/* SPDX-License-Identifier: MIT */
#include "topology/representatives.h"

#include <float.h>
#include <string.h>
#include "base/compiler.h"
#if NT_VECTORS && defined(__SSE2__)
#include <emmintrin.h>
#endif

static const nt_box nothing = {{FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX, -FLT_MAX}};

/* Adds rows [0, count), or those of vertices[0, count), to a box; false if a coordinate is NaN. */
static inline NT_ALWAYS_INLINE bool add_rows(
	const float *rows, size_t step, const uint32_t *vertices, size_t count, nt_box *b)
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
static bool set_grid(const nt_box *b, nt_grid *grid)
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
	nt_box all = nothing;
	bool ordered = true;
	size_t blocks[6] = {0}; /* where the sides are */
	if (!extremes && mesh->box)
		return set_grid(mesh->box, grid);
	if (!extremes)
		return add_rows(mesh->positions, mesh->step, NULL, mesh->vertex_count, &all) && set_grid(&all, grid);
	for (size_t v = 0; v < mesh->vertex_count; v += BLOCK) {
		const size_t left = mesh->vertex_count - v;
		nt_box box = all;
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
	nt_box all = nothing;
	bool ordered = true;
	for (size_t t = 0, count; t < mesh->triangle_count; t += count) {
		uint32_t copy[3 * BATCH];
		count = mesh->triangle_count - t < BATCH ? mesh->triangle_count - t : BATCH;
		const uint32_t *ids = nt_triangle_vertices(mesh->triangles, t, count, copy);
		ordered &= add_rows(mesh->positions, mesh->step, ids, 3 * count, &all);
	}
	return ordered && set_grid(&all, grid);
}

nt_cell nt_cell_make(nt_scratch *scratch, size_t vertices, size_t corners)
{
	nt_cell cell = {.vertex_count = vertices, .corner_count = corners};
	uint32_t *room = nt_scratch_alloc(scratch, 1, (2 * vertices + corners) * sizeof *room + 2 * vertices);
	if (!room)
		return cell;
	cell.order = room;
	cell.found = cell.order + vertices;
	cell.swaps = cell.found + vertices;
	cell.below = (uint8_t *)(cell.swaps + corners);
	cell.wanted = cell.below + vertices;
	return cell;
}

/* A part of a cell: some of its vertices, in any order, and all of their corners. */
typedef struct part {
	uint32_t *order;
	nt_cell_corner *corners;
	size_t vertex_count, corner_count;
	unsigned halvings;
} part;

/* The point at which a part is halved, and along which axis; false: nothing is left to halve. */
static inline bool find_middle(const nt_cell *cell, const part *p, unsigned *axis, float *middle)
{
	enum { STEP = sizeof *cell->vertices / sizeof *cell->vertices->position };
	nt_box b = nothing;
	(void)add_rows(cell->vertices->position, STEP, p->order, p->vertex_count, &b);
	*axis = nt_longest_axis(&b);
	*middle = 0.5f * (b.high[*axis] + b.low[*axis]);
	return *middle < b.high[*axis] && *middle > b.low[*axis];
}

/* Halves a part, and leaves of it what is below the middle; `wanted` receives whether halves have vertices that are
 * wanted. Corners are swapped until those below come first, and only those that have to: the first that is above with
 * the last that is below, and so on. The order of all others, and which of them are swapped, decides in the end. */
static part halve(const nt_cell *cell, part *p, unsigned axis, float middle, bool wanted[2])
{
	const nt_cell_vertex *const vertices = cell->vertices;
	const uint8_t *const is_wanted = cell->wanted;
	uint8_t *const is_below = cell->below;
	uint32_t *const order = p->order;
	nt_cell_corner *const corners = p->corners;
	const size_t vertex_count = p->vertex_count;
	uint32_t low = 0, left = 0, count = 0, wanted_low = 0, swap_count = 0, other_count = 0;
	for (size_t i = 0; i < vertex_count; i++) {
		const uint32_t one = order[i], other = order[low], corner_count = vertices[one].corner_count;
		const bool below = vertices[one].position[axis] < middle;
		const uint32_t want = is_wanted[one];
		is_below[one] = below;
		order[i] = below ? other : one;
		order[low] = below ? one : other;
		left += below ? corner_count : 0;
		count += want;
		wanted_low += below ? want : 0;
		low += below;
	}
	wanted[0] = wanted_low > 0;
	wanted[1] = wanted_low < count;
	uint32_t *const above = cell->swaps, *const below = above + left;
	for (uint32_t i = 0; i < left; i++) {
		above[swap_count] = i;
		swap_count += !is_below[corners[i].vertex];
	}
	for (uint32_t i = (uint32_t)p->corner_count; i-- > left && other_count < swap_count;) {
		below[other_count] = i;
		other_count += is_below[corners[i].vertex];
	}
	for (uint32_t i = 0; i < swap_count; i++) {
		const nt_cell_corner swapped = corners[above[i]];
		corners[above[i]] = corners[below[i]];
		corners[below[i]] = swapped;
	}
	const part rest = {order + low, corners + left, p->vertex_count - low, p->corner_count - left, p->halvings};
	p->vertex_count = low;
	p->corner_count = left;
	return rest;
}

/* A part of two vertices at different places: the same as if it were halved. */
static void find_two(const nt_cell *cell, const part *p, unsigned axis)
{
	const nt_cell_vertex *const vertices = cell->vertices;
	const nt_cell_corner *const corners = p->corners;
	const bool second = vertices[p->order[1]].position[axis] < vertices[p->order[0]].position[axis];
	const uint32_t below = p->order[second], above = p->order[!second];
	const size_t left = vertices[below].corner_count;
	size_t first = 0;
	for (first = corners->vertex == below ? 0 : p->corner_count - 1; corners[first].vertex != below;)
		first--;
	cell->found[below] = corners[first].corner;
	for (first = corners[left].vertex == above ? left : left - 1; corners[first].vertex != above;)
		first--;
	cell->found[above] = corners[first].corner;
}

bool nt_weld_cell(const nt_cell *cell)
{
	part waiting[NT_HALVINGS + 1];
	size_t waiting_count = 1, count = 0;
	for (size_t i = 0; i < cell->vertex_count; i++) {
		cell->order[count] = (uint32_t)i;
		count += cell->vertices[i].corner_count > 0;
	}
	waiting[0] = (part){cell->order, cell->corners, count, cell->corner_count, 0};
	while (waiting_count > 0) {
		part p = waiting[--waiting_count];
		unsigned axis;
		float middle;
		bool is_halved = false;
		while (p.vertex_count > 1 && find_middle(cell, &p, &axis, &middle)) {
			bool wanted[2];
			is_halved = p.vertex_count == 2;
			if (p.halvings++ == NT_HALVINGS)
				return false;
			if (p.vertex_count == 2)
				break;
			const part above = halve(cell, &p, axis, middle, wanted);
			if (wanted[0] && wanted[1])
				waiting[waiting_count++] = above;
			else if (wanted[1])
				p = above;
		}
		/* each has the first of its corners here */
		if (p.vertex_count == 1)
			cell->found[*p.order] = p.corners->corner;
		else if (p.vertex_count == 2 && is_halved)
			find_two(cell, &p, axis);
		else
			for (size_t i = p.corner_count; i-- > 0;)
				cell->found[p.corners[i].vertex] = p.corners[i].corner;
	}
	return true;
}
