/* SPDX-License-Identifier: MIT */
#include "topology/representatives.h"

#include <float.h>
#include <string.h>
#include "base/compiler.h"
#include "base/parallel.h"
#if NT_VECTORS && defined(__SSE2__)
#include <emmintrin.h>
#endif

/* Cells for a thread at least, and triangles whose vertices are looked up at a time. */
enum { LEAST_CELLS = 128, BATCH = 16 };

/* Boxes */

/* Adds rows [first, end), or those of vertices[first, end), to a box; false if a coordinate is NaN. */
static inline NT_ALWAYS_INLINE bool add_rows(
	const float *rows, size_t step, const uint32_t *vertices, size_t first, size_t end, nt_box *box)
{
#if NT_VECTORS && defined(__SSE2__)
	__m128 low = _mm_loadu_ps(box->low), high = _mm_loadu_ps(box->high), unordered = _mm_setzero_ps();
	for (size_t i = first; i < end; i++) {
		const __m128 p = _mm_loadu_ps(rows + step * (vertices ? vertices[i] : i));
		low = _mm_min_ps(low, p);
		high = _mm_max_ps(high, p);
		unordered = _mm_or_ps(unordered, _mm_cmpunord_ps(p, p));
	}
	_mm_storeu_ps(box->low, low);
	_mm_storeu_ps(box->high, high);
	return !(_mm_movemask_ps(unordered) & 7);
#else
	int unordered = 0;
	for (size_t i = first; i < end; i++) {
		const float *p = rows + step * (vertices ? vertices[i] : i);
		for (int k = 0; k < 3; k++) {
			box->low[k] = p[k] < box->low[k] ? p[k] : box->low[k];
			box->high[k] = p[k] > box->high[k] ? p[k] : box->high[k];
			unordered |= p[k] != p[k];
		}
	}
	return !unordered;
#endif
}

static const nt_box nothing = {{FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX, -FLT_MAX}};

/* The rule by which the published weld chooses an axis. */
static unsigned longest_axis(const nt_box *b)
{
	const float x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
	return y > x && y > z ? 1 : z > x ? 2 : 0;
}

/* Makes the grid of a box, but for its extremes. */
static bool set_grid(const nt_box *b, nt_grid *grid)
{
	for (int i = 0; i < 3; i++)
		if (!(b->low[i] > -FLT_MAX / 2 && b->high[i] < FLT_MAX / 2))
			return false;
	grid->axis = longest_axis(b);
	grid->low = b->low[grid->axis];
	grid->high = b->high[grid->axis];
	return true;
}

/* The first vertex with that coordinate, which is a side of the box. */
static uint32_t find_extreme(const nt_welded_mesh *mesh, const nt_box *boxes, int axis, bool high, float coordinate)
{
	size_t block = 0;
	while ((high ? boxes[block].high : boxes[block].low)[axis] != coordinate)
		block++;
	size_t v = block * NT_BOX_ROWS;
	while (mesh->positions[mesh->step * v + (size_t)axis] != coordinate)
		v++;
	return (uint32_t)v;
}

bool nt_grid_make(const nt_welded_mesh *mesh, nt_box *boxes, nt_grid *grid)
{
	nt_box all = nothing;
	bool ordered = true;
	if (!boxes)
		return add_rows(mesh->positions, mesh->step, NULL, 0, mesh->vertex_count, &all) && set_grid(&all, grid);
	for (size_t v = 0; v < mesh->vertex_count; v += NT_BOX_ROWS) {
		nt_box *box = &boxes[v / NT_BOX_ROWS];
		const size_t left = mesh->vertex_count - v;
		*box = nothing;
		ordered &= add_rows(
			mesh->positions, mesh->step, NULL, v, v + (left < NT_BOX_ROWS ? left : NT_BOX_ROWS), box);
		for (int i = 0; i < 4; i++) {
			all.low[i] = box->low[i] < all.low[i] ? box->low[i] : all.low[i];
			all.high[i] = box->high[i] > all.high[i] ? box->high[i] : all.high[i];
		}
	}
	if (!ordered || !set_grid(&all, grid))
		return false;
	for (int i = 0; i < 6; i++)
		grid->extremes[i] = find_extreme(mesh, boxes, i / 2, i % 2, i % 2 ? all.high[i / 2] : all.low[i / 2]);
	return true;
}

bool nt_grid_of_used(const nt_welded_mesh *mesh, nt_grid *grid)
{
	nt_box all = nothing;
	bool ordered = true;
	for (size_t t = 0, count; t < mesh->triangle_count; t += count) {
		uint32_t copy[3 * BATCH];
		count = mesh->triangle_count - t < BATCH ? mesh->triangle_count - t : BATCH;
		const uint32_t *ids = nt_triangle_vertices(mesh->triangles, t, count, copy);
		ordered &= add_rows(mesh->positions, mesh->step, ids, 0, 3 * count, &all);
	}
	return ordered && set_grid(&all, grid);
}

/* Halving */

/* A corner on its way, with its position: `index` says which. All corners of a cell are halved as such; if only one
 * vertex matters, vertices are, of which there are few. */
typedef struct point {
	float position[3];
	uint32_t index;
} point;

/* The point at which a part is halved, and along which axis; false: nothing is left to halve. */
static bool find_middle(
	const float *positions, const uint32_t *order, size_t count, unsigned *axis, float *middle)
{
	enum { STEP = sizeof(point) / sizeof *positions }; /* nt_cell_vertex has the same size */
	nt_box b = nothing;
	(void)add_rows(positions, STEP, order, 0, count, &b);
	*axis = longest_axis(&b);
	*middle = 0.5f * (b.high[*axis] + b.low[*axis]);
	return *middle < b.high[*axis] && *middle > b.low[*axis];
}

/* Entries to swap: points, or corners whose vertices are known to be below the middle or not. */
typedef struct entries {
	point *points;
	unsigned axis;
	float middle;
	nt_cell_corner *corners;
	const uint8_t *below;
} entries;

static inline NT_ALWAYS_INLINE bool is_below(const entries *e, size_t i)
{
	return e->points ? e->points[i].position[e->axis] < e->middle : e->below[e->corners[i].vertex];
}

static inline NT_ALWAYS_INLINE void swap_entries(const entries *e, size_t a, size_t b)
{
	if (e->points) {
		const point swapped = e->points[a];
		e->points[a] = e->points[b];
		e->points[b] = swapped;
	} else {
		const nt_cell_corner swapped = e->corners[a];
		e->corners[a] = e->corners[b];
		e->corners[b] = swapped;
	}
}

enum { WORD = 64 };

/* Swaps entries until those below the middle come first, and only those that have to: the first that is above with the
 * last that is below, and so on. The order of all others, and which of them are swapped, decides in the end. */
static inline NT_ALWAYS_INLINE void part_entries(const entries *e, size_t count, size_t below)
{
	/* behind the entries that `low` is of, and the first of those that `high` is of */
	size_t left = 0, right = count;
	/* bits of at most 64 entries that are on the wrong side: from the first on, and from the last */
	for (uint64_t low = 0, high = 0;;) {
		for (; !low; left += WORD) {
			if (left >= below)
				return;
			const size_t some = below - left < WORD ? below - left : WORD;
			for (size_t i = 0; i < some; i++)
				low |= (uint64_t)!is_below(e, left + i) << i;
		}
		for (; !high; right -= WORD) {
			const size_t some = right - below < WORD ? right - below : WORD;
			for (size_t i = 0; i < some; i++)
				high |= (uint64_t)is_below(e, right - 1 - i) << i;
		}
		for (; low && high; low &= low - 1, high &= high - 1)
			swap_entries(e, left - WORD + (size_t)nt_trailing_zeros(low),
				right + WORD - 1 - (size_t)nt_trailing_zeros(high));
	}
}

/* A part of a cell: some of its vertices, in any order, and all of their corners. */
typedef struct part {
	uint32_t *order;
	size_t vertex_count;
	nt_cell_corner *corners;
	size_t corner_count;
} part;

/* Leaves the half of a part that a vertex is in. */
static NT_NOINLINE void halve(const nt_cell *cell, part *p, uint32_t vertex, unsigned axis, float middle)
{
	size_t low = 0, corners = 0;
	for (size_t i = 0; i < p->vertex_count; i++) {
		const uint32_t one = p->order[i], other = p->order[low];
		const bool below = cell->vertices[one].position[axis] < middle;
		cell->below[one] = below;
		p->order[i] = below ? other : one;
		p->order[low] = below ? one : other;
		corners += below ? cell->vertices[one].corner_count : 0;
		low += below;
	}
	const entries e = {.corners = p->corners, .below = cell->below};
	part_entries(&e, p->corner_count, corners);
	*p = cell->below[vertex] ? (part){p->order, low, p->corners, corners}
				 : (part){p->order + low, p->vertex_count - low, p->corners + corners,
					   p->corner_count - corners};
}

bool nt_find_representative(const nt_cell *cell, uint32_t vertex, uint32_t *found)
{
	part p = {cell->order, cell->vertex_count, cell->corners, cell->corner_count};
	unsigned axis, halvings = 0;
	float middle;
	for (size_t i = 0; i < cell->vertex_count; i++)
		cell->order[i] = (uint32_t)i;
	while (p.vertex_count > 1 &&
		find_middle(cell->vertices->position, p.order, p.vertex_count, &axis, &middle)) {
		if (halvings++ == NT_HALVINGS)
			return false;
		halve(cell, &p, vertex, axis, middle);
	}
	while (p.corners->vertex != vertex)
		p.corners++;
	*found = p.corners->corner;
	return true;
}

/* All cells */

/* Points that are still to be halved. */
typedef struct points {
	point *first;
	size_t count;
	unsigned halvings;
} points;

typedef struct weld {
	const nt_welded_mesh *mesh;
	nt_cell_corner *corners; /* in their cells, in order, with vertices of the mesh */
	point *points;           /* [threads][most corners of a cell] */
	size_t most;
	uint32_t first[NT_CELLS + 1];
	uint32_t *found;
	bool limit; /* set by any thread */
} weld;

/* False: it would have to be halved too often. */
static bool weld_cell(const weld *w, const nt_cell_corner *corners, size_t count, point *room)
{
	points waiting[NT_HALVINGS + 1];
	size_t waiting_count = 0;
	for (size_t i = 0; i < count; i++) {
		memcpy(room[i].position, nt_welded_position(w->mesh, corners[i].vertex), sizeof room->position);
		room[i].index = (uint32_t)i;
	}
	waiting[waiting_count++] = (points){room, count, 0};
	while (waiting_count > 0) {
		points p = waiting[--waiting_count];
		unsigned axis;
		float middle;
		while (find_middle(p.first->position, NULL, p.count, &axis, &middle)) {
			if (p.halvings++ == NT_HALVINGS)
				return false;
			size_t below = 0;
			for (size_t i = 0; i < p.count; i++)
				below += p.first[i].position[axis] < middle;
			const entries e = {.points = p.first, .axis = axis, .middle = middle};
			part_entries(&e, p.count, below);
			waiting[waiting_count++] = (points){p.first + below, p.count - below, p.halvings};
			p.count = below;
		}
		for (size_t i = p.count; i-- > 0;)
			w->found[corners[p.first[i].index].vertex] = corners[p.first[i].index].corner;
	}
	return true;
}

static void weld_cells(void *context, size_t begin, size_t end, unsigned thread)
{
	weld *w = context;
	for (size_t c = begin; c < end; c++) {
		const size_t count = w->first[c + 1] - w->first[c];
		if (count > 0 && !weld_cell(w, w->corners + w->first[c], count, w->points + thread * w->most))
			nt_atomic_store(&w->limit, true, RELAXED);
	}
}

/* Puts corners into their cells, in order. */
static bool fill_cells(weld *w, const nt_grid *grid)
{
	const nt_welded_mesh *mesh = w->mesh;
	const size_t count = 3 * mesh->triangle_count;
	uint16_t *cells = nt_scratch_alloc(mesh->scratch, mesh->vertex_count, sizeof *cells);
	w->corners = nt_scratch_alloc(mesh->scratch, count, sizeof *w->corners);
	if (!cells || !w->corners)
		return false;
	for (size_t v = 0; v < mesh->vertex_count; v++)
		cells[v] = (uint16_t)nt_grid_cell(grid, mesh->positions[mesh->step * v + grid->axis]);
	uint32_t copy[3], counts[NT_CELLS] = {0};
	for (size_t t = 0; t < mesh->triangle_count; t++) {
		const uint32_t *v = nt_triangle_vertices(mesh->triangles, t, 1, copy);
		for (int k = 0; k < 3; k++)
			counts[cells[v[k]]]++;
	}
	w->first[0] = 0;
	for (size_t c = 0; c < NT_CELLS; c++) {
		w->most = counts[c] > w->most ? counts[c] : w->most;
		w->first[c + 1] = w->first[c] + counts[c];
		counts[c] = w->first[c];
	}
	for (size_t t = 0; t < mesh->triangle_count; t++) {
		const uint32_t *v = nt_triangle_vertices(mesh->triangles, t, 1, copy);
		for (unsigned k = 0; k < 3; k++)
			w->corners[counts[cells[v[k]]]++] = (nt_cell_corner){
				v[k], (uint32_t)nt_triangle_corner(mesh->triangles, t, k)};
	}
	const unsigned slots = nt_parallel_slots(mesh->threads, NT_CELLS, LEAST_CELLS);
	w->points = nt_scratch_alloc(mesh->scratch, slots * w->most, sizeof *w->points);
	return w->points;
}

nt_representatives_end nt_representatives(const nt_welded_mesh *mesh, const nt_grid *grid, uint32_t *found)
{
	const nt_scratch_mark mark = nt_scratch_here(mesh->scratch);
	weld w = {.mesh = mesh, .found = found};
	const bool filled = fill_cells(&w, grid);
	if (filled)
		nt_parallel_ranges(mesh->threads, NT_CELLS, LEAST_CELLS, weld_cells, &w);
	nt_scratch_back(mesh->scratch, mark);
	return !filled ? NT_REPRESENTATIVES_NO_MEMORY : w.limit ? NT_REPRESENTATIVES_LIMIT : NT_REPRESENTATIVES_FOUND;
}
