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

/* A part of a cell that is still to be halved. */
typedef struct part {
	nt_welded_point *points;
	size_t count;
	unsigned halvings;
} part;

/* The point at which a part is halved, and along which axis; false: nothing is left to halve. */
static bool find_middle(const part *p, unsigned *axis, float *middle)
{
	enum { STEP = sizeof *p->points / sizeof *p->points->position };
	nt_box b = nothing;
	(void)add_rows(p->points->position, STEP, NULL, 0, p->count, &b);
	*axis = longest_axis(&b);
	*middle = 0.5f * (b.high[*axis] + b.low[*axis]);
	return *middle < b.high[*axis] && *middle > b.low[*axis];
}

enum { WORD = 64 };

/* Bits of at most 64 points that are on the wrong side: those not below from the first on, those below from the last.
 * */
static uint64_t find_wrong(const nt_welded_point *points, size_t count, unsigned axis, float middle, bool below)
{
	uint64_t bits = 0;
	if (below)
		for (size_t i = 0; i < count; i++)
			bits |= (uint64_t)(points[count - 1 - i].position[axis] < middle) << i;
	else
		for (size_t i = 0; i < count; i++)
			bits |= (uint64_t) !(points[i].position[axis] < middle) << i;
	return bits;
}

/* Swaps points until those below the middle come first, and only those that have to: the first that is above with the
 * last that is below, and so on. The order of all others, and which of them are swapped, decides in the end. Returns
 * how many are below. */
static size_t part_points(nt_welded_point *points, size_t count, unsigned axis, float middle)
{
	size_t below = 0;
	for (size_t i = 0; i < count; i++)
		below += points[i].position[axis] < middle;
	size_t left = 0,
	       right = count; /* behind the points that `low` is of, and the first of those that `high` is of */
	for (uint64_t low = 0, high = 0;;) {
		for (; !low; left += WORD) {
			if (left >= below)
				return below;
			low = find_wrong(points + left, below - left < WORD ? below - left : WORD, axis, middle, false);
		}
		for (; !high; right -= WORD) {
			const size_t some = right - below < WORD ? right - below : WORD;
			high = find_wrong(points + (right - some), some, axis, middle, true);
		}
		for (; low && high; low &= low - 1, high &= high - 1) {
			nt_welded_point *const a = &points[left - WORD + (size_t)nt_trailing_zeros(low)];
			nt_welded_point *const b = &points[right + WORD - 1 - (size_t)nt_trailing_zeros(high)];
			const nt_welded_point swapped = *a;
			*a = *b;
			*b = swapped;
		}
	}
}

static void load_points(
	const nt_welded_mesh *mesh, const nt_welded_corner *corners, size_t count, nt_welded_point *points)
{
	for (size_t i = 0; i < count; i++) {
		memcpy(points[i].position, nt_welded_position(mesh, corners[i].vertex), sizeof points->position);
		points[i].index = (uint32_t)i;
	}
}

bool nt_find_representative(const nt_welded_mesh *mesh, const nt_welded_corner *corners, size_t count, uint32_t vertex,
	nt_welded_point *points, uint32_t *found)
{
	const float *const position = nt_welded_position(mesh, vertex);
	part p = {points, count, 0};
	unsigned axis;
	float middle;
	load_points(mesh, corners, count, points);
	while (find_middle(&p, &axis, &middle)) {
		if (++p.halvings > NT_HALVINGS)
			return false;
		const size_t below = part_points(p.points, p.count, axis, middle);
		p = position[axis] < middle ? (part){p.points, below, p.halvings}
					    : (part){p.points + below, p.count - below, p.halvings};
	}
	while (corners[p.points->index].vertex != vertex)
		p.points++;
	*found = corners[p.points->index].corner;
	return true;
}

/* All cells */

typedef struct weld {
	const nt_welded_mesh *mesh;
	nt_welded_corner *corners; /* in their cells, in order */
	nt_welded_point *points;   /* [threads][most corners of a cell] */
	size_t most;
	uint32_t first[NT_CELLS + 1];
	uint32_t *found;
	bool limit; /* set by any thread */
} weld;

/* False: it would have to be halved too often. */
static bool weld_cell(const weld *w, const nt_welded_corner *corners, size_t count, nt_welded_point *points)
{
	part waiting[NT_HALVINGS + 1];
	size_t waiting_count = 0;
	load_points(w->mesh, corners, count, points);
	waiting[waiting_count++] = (part){points, count, 0};
	while (waiting_count > 0) {
		part p = waiting[--waiting_count];
		unsigned axis;
		float middle;
		while (find_middle(&p, &axis, &middle)) {
			if (++p.halvings > NT_HALVINGS)
				return false;
			const size_t below = part_points(p.points, p.count, axis, middle);
			waiting[waiting_count++] = (part){p.points + below, p.count - below, p.halvings};
			p.count = below;
		}
		for (size_t i = p.count; i-- > 0;)
			w->found[corners[p.points[i].index].vertex] = corners[p.points[i].index].corner;
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
			w->corners[counts[cells[v[k]]]++] = (nt_welded_corner){
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
