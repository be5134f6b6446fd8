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

/* A part of a cell that is still to be halved. */
typedef struct part {
	uint32_t *order; /* its vertices, in any order */
	size_t vertex_count;
	nt_cell_corner *corners;
	size_t corner_count;
	unsigned halvings;
} part;

static part whole(const nt_cell *cell)
{
	for (size_t i = 0; i < cell->vertex_count; i++)
		cell->order[i] = (uint32_t)i;
	return (part){cell->order, cell->vertex_count, cell->corners, cell->corner_count, 0};
}

/* The point at which a part is halved, and along which axis; false: nothing is left to halve. */
static bool find_middle(const nt_cell *cell, const part *p, unsigned *axis, float *middle)
{
	enum { STEP = sizeof *cell->vertices / sizeof *cell->vertices->position };
	nt_box b = nothing;
	if (p->vertex_count < 2)
		return false;
	(void)add_rows(cell->vertices->position, STEP, p->order, 0, p->vertex_count, &b);
	*axis = longest_axis(&b);
	*middle = 0.5f * (b.high[*axis] + b.low[*axis]);
	return *middle < b.high[*axis] && *middle > b.low[*axis];
}

enum { WORD = 64 };

/* Bits of at most 64 corners that are on the wrong side: those not below from the first on, those below from the last.
 * */
static uint64_t find_wrong(const uint8_t *below, const nt_cell_corner *corners, size_t count, bool from_last)
{
	uint64_t bits = 0;
	if (from_last)
		for (size_t i = 0; i < count; i++)
			bits |= (uint64_t)below[corners[count - 1 - i].vertex] << i;
	else
		for (size_t i = 0; i < count; i++)
			bits |= (uint64_t)!below[corners[i].vertex] << i;
	return bits;
}

/* Swaps corners until those of vertices below the middle come first, and only those that have to: the first that is
 * above with the last that is below, and so on. The order of all others, and which of them are swapped, decides in the
 * end. */
static void part_corners(const uint8_t *is_below, nt_cell_corner *corners, size_t count, size_t below)
{
	/* behind the corners that `low` is of, and the first of those that `high` is of */
	size_t left = 0, right = count;
	for (uint64_t low = 0, high = 0;;) {
		for (; !low; left += WORD) {
			if (left >= below)
				return;
			low = find_wrong(is_below, corners + left, below - left < WORD ? below - left : WORD, false);
		}
		for (; !high; right -= WORD) {
			const size_t some = right - below < WORD ? right - below : WORD;
			high = find_wrong(is_below, corners + (right - some), some, true);
		}
		for (; low && high; low &= low - 1, high &= high - 1) {
			nt_cell_corner *const a = &corners[left - WORD + (size_t)nt_trailing_zeros(low)];
			nt_cell_corner *const b = &corners[right + WORD - 1 - (size_t)nt_trailing_zeros(high)];
			const nt_cell_corner swapped = *a;
			*a = *b;
			*b = swapped;
		}
	}
}

/* Parts a part: it becomes what is not below the middle. Returns what is. */
static part halve(const nt_cell *cell, part *p, unsigned axis, float middle)
{
	part low = *p;
	low.vertex_count = low.corner_count = 0;
	for (size_t i = 0; i < p->vertex_count; i++) {
		const uint32_t vertex = p->order[i], other = p->order[low.vertex_count];
		const bool below = cell->vertices[vertex].position[axis] < middle;
		cell->below[vertex] = below;
		p->order[i] = below ? other : vertex;
		p->order[low.vertex_count] = below ? vertex : other;
		low.corner_count += below ? cell->vertices[vertex].corner_count : 0;
		low.vertex_count += below;
	}
	part_corners(cell->below, p->corners, p->corner_count, low.corner_count);
	low.halvings = p->halvings + 1;
	*p = (part){p->order + low.vertex_count, p->vertex_count - low.vertex_count, p->corners + low.corner_count,
		p->corner_count - low.corner_count, low.halvings};
	return low;
}

bool nt_find_representative(const nt_cell *cell, uint32_t vertex, uint32_t *found)
{
	part p = whole(cell);
	unsigned axis;
	float middle;
	while (find_middle(cell, &p, &axis, &middle)) {
		if (p.halvings == NT_HALVINGS)
			return false;
		const part low = halve(cell, &p, axis, middle);
		p = cell->below[vertex] ? low : p;
	}
	while (p.corners->vertex != vertex)
		p.corners++;
	*found = p.corners->corner;
	return true;
}

/* All cells */

/* A vertex's cell, and its number there. */
typedef struct cell_place {
	uint32_t cell, number;
} cell_place;

typedef struct weld {
	const nt_welded_mesh *mesh;
	nt_cell_vertex *vertices;  /* in their cells */
	uint32_t *ids;             /* their numbers in the mesh */
	nt_cell_corner *corners;   /* in their cells, in order */
	uint32_t *order;           /* [threads][most vertices of a cell] */
	uint8_t *below;            /* as many */
	size_t most;
	uint32_t first_vertex[NT_CELLS + 1], first_corner[NT_CELLS + 1];
	uint32_t *found;
	bool limit; /* set by any thread */
} weld;

/* False: it would have to be halved too often. */
static bool weld_cell(const weld *w, const nt_cell *cell, const uint32_t *ids)
{
	part waiting[NT_HALVINGS + 1];
	size_t waiting_count = 0;
	waiting[waiting_count++] = whole(cell);
	while (waiting_count > 0) {
		part p = waiting[--waiting_count];
		unsigned axis;
		float middle;
		while (find_middle(cell, &p, &axis, &middle)) {
			if (p.halvings == NT_HALVINGS)
				return false;
			const part low = halve(cell, &p, axis, middle);
			waiting[waiting_count++] = p;
			p = low;
		}
		/* one vertex has its first corner */
		for (size_t i = p.vertex_count > 1 ? p.corner_count : 1; i-- > 0;)
			w->found[ids[p.corners[i].vertex]] = p.corners[i].corner;
	}
	return true;
}

static void weld_cells(void *context, size_t begin, size_t end, unsigned thread)
{
	weld *w = context;
	for (size_t c = begin; c < end; c++) {
		const size_t vertex = w->first_vertex[c], corner = w->first_corner[c];
		const nt_cell cell = {w->vertices + vertex, w->corners + corner, w->order + thread * w->most,
			w->below + thread * w->most, w->first_vertex[c + 1] - vertex,
			w->first_corner[c + 1] - corner};
		if (cell.vertex_count > 0 && !weld_cell(w, &cell, w->ids + vertex))
			nt_atomic_store(&w->limit, true, RELAXED);
	}
}

/* Puts vertices and corners into their cells, in order. */
static bool fill_cells(weld *w, const nt_grid *grid)
{
	const nt_welded_mesh *mesh = w->mesh;
	const size_t count = 3 * mesh->triangle_count;
	uint32_t *corner_counts = nt_scratch_alloc(mesh->scratch, mesh->vertex_count, sizeof *corner_counts);
	cell_place *places = nt_scratch_alloc(mesh->scratch, mesh->vertex_count, sizeof *places);
	w->vertices = nt_scratch_alloc(mesh->scratch, mesh->vertex_count, sizeof *w->vertices);
	w->ids = nt_scratch_alloc(mesh->scratch, mesh->vertex_count, sizeof *w->ids);
	w->corners = nt_scratch_alloc(mesh->scratch, count, sizeof *w->corners);
	if (!corner_counts || !places || !w->vertices || !w->ids || !w->corners)
		return false;
	memset(corner_counts, 0, mesh->vertex_count * sizeof *corner_counts);
	uint32_t copy[3], vertices[NT_CELLS] = {0}, corners[NT_CELLS] = {0};
	for (size_t t = 0; t < mesh->triangle_count; t++) {
		const uint32_t *v = nt_triangle_vertices(mesh->triangles, t, 1, copy);
		for (int k = 0; k < 3; k++)
			corner_counts[v[k]]++;
	}
	for (size_t v = 0; v < mesh->vertex_count; v++) {
		const uint32_t cell = nt_grid_cell(grid, mesh->positions[mesh->step * v + grid->axis]);
		places[v] = (cell_place){cell, vertices[cell]};
		vertices[cell] += corner_counts[v] > 0;
		corners[cell] += corner_counts[v];
	}
	w->first_vertex[0] = w->first_corner[0] = 0;
	for (size_t c = 0; c < NT_CELLS; c++) {
		w->most = vertices[c] > w->most ? vertices[c] : w->most;
		w->first_vertex[c + 1] = w->first_vertex[c] + vertices[c];
		w->first_corner[c + 1] = w->first_corner[c] + corners[c];
		corners[c] = w->first_corner[c];
	}
	for (size_t v = 0; v < mesh->vertex_count; v++) {
		if (corner_counts[v] == 0)
			continue;
		const size_t at = w->first_vertex[places[v].cell] + places[v].number;
		memcpy(w->vertices[at].position, nt_welded_position(mesh, (uint32_t)v), sizeof w->vertices->position);
		w->vertices[at].corner_count = corner_counts[v];
		w->ids[at] = (uint32_t)v;
	}
	for (size_t t = 0; t < mesh->triangle_count; t++) {
		const uint32_t *v = nt_triangle_vertices(mesh->triangles, t, 1, copy);
		for (unsigned k = 0; k < 3; k++) {
			const cell_place place = places[v[k]];
			w->corners[corners[place.cell]++] = (nt_cell_corner){
				place.number, (uint32_t)nt_triangle_corner(mesh->triangles, t, k)};
		}
	}
	const unsigned slots = nt_parallel_slots(mesh->threads, NT_CELLS, LEAST_CELLS);
	w->order = nt_scratch_alloc(mesh->scratch, slots * w->most, sizeof *w->order);
	w->below = nt_scratch_alloc(mesh->scratch, slots * w->most, 1);
	return w->order && w->below;
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
