/* SPDX-License-Identifier: MIT */
#include "topology/representatives.h"

#include <float.h>
#include <math.h>
#include <string.h>
#include "base/compiler.h"
#include "base/parallel.h"

#define NONE UINT32_MAX

/* Cells for a thread at least, and vertices whose box is found at a time. */
enum { LEAST_CELLS = 128, BLOCK = 64 };

typedef struct entry {
	uint32_t vertex, corner;
} entry;

/* Corners of a cell, or of a part of it, and the vertices that they have. */
typedef struct half {
	entry *entries;
	uint32_t *vertices;
	size_t entry_count, vertex_count;
} half;

typedef struct box {
	float low[3], high[3];
} box;

typedef struct weld {
	const nt_welded_mesh *mesh;
	entry *entries;
	uint32_t *vertices;
	uint16_t number[NT_CELLS]; /* of each cell that has a corner, from 1 on; 0: none */
	uint32_t cell_count;
	uint32_t *first_entry, *first_vertex; /* [cell_count + 2] by number */
	uint32_t *found;
	bool limit; /* set by any thread */
} weld;

/* The rule by which the published weld chooses an axis. */
static unsigned longest_axis(const box *b)
{
	const float x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
	return y > x && y > z ? 1 : z > x ? 2 : 0;
}

/* The box of vertices [first, end); false where a coordinate is NaN. */
static bool box_of_block(const nt_welded_mesh *mesh, size_t first, size_t end, box *b)
{
	int unordered = 0;
	memcpy(b->low, mesh->positions + mesh->step * first, sizeof b->low);
	memcpy(b->high, b->low, sizeof b->high);
	for (size_t v = first; v < end; v++) {
		const float *p = mesh->positions + mesh->step * v;
		for (int i = 0; i < 3; i++) {
			b->low[i] = p[i] < b->low[i] ? p[i] : b->low[i];
			b->high[i] = p[i] > b->high[i] ? p[i] : b->high[i];
			unordered |= p[i] != p[i];
		}
	}
	return !unordered;
}

/* The first vertex from there on that has this coordinate; there is one. */
static uint32_t find_coordinate(const nt_welded_mesh *mesh, size_t first, int axis, float coordinate)
{
	while (mesh->positions[mesh->step * first + (size_t)axis] != coordinate)
		first++;
	return (uint32_t)first;
}

/* Makes the box; `where` is in which block, or of which vertex, each side is. */
static bool find_box(const nt_welded_mesh *mesh, const uint64_t *used, box *b, size_t where[6])
{
	const size_t step = used ? 1 : BLOCK;
	for (size_t v = 0; v < mesh->vertex_count; v += step) {
		box block;
		if (used && !(used[v / 64] >> v % 64 & 1))
			continue;
		const size_t left = mesh->vertex_count - v;
		if (!box_of_block(mesh, v, v + (left < step ? left : step), &block))
			return false;
		for (int i = 0; i < 3; i++) {
			if (block.low[i] < b->low[i])
				b->low[i] = block.low[i], where[2 * i] = v;
			if (block.high[i] > b->high[i])
				b->high[i] = block.high[i], where[2 * i + 1] = v;
		}
	}
	for (int i = 0; i < 3; i++)
		if (!(b->low[i] > -FLT_MAX / 2 && b->high[i] < FLT_MAX / 2))
			return false;
	return true;
}

bool nt_grid_make(const nt_welded_mesh *mesh, const uint64_t *used, nt_grid *grid)
{
	box b = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
	size_t where[6];
	if (!find_box(mesh, used, &b, where))
		return false;
	for (int i = 0; i < 6; i++)
		grid->extremes[i] = find_coordinate(mesh, where[i], i / 2, i % 2 ? b.high[i / 2] : b.low[i / 2]);
	grid->axis = longest_axis(&b);
	grid->low = b.low[grid->axis];
	grid->high = b.high[grid->axis];
	return true;
}

unsigned nt_grid_cell(const nt_grid *grid, float coordinate)
{
	const float cell = (float)NT_CELLS * ((coordinate - grid->low) / (grid->high - grid->low));
	/* NaN, of a box without extent, is cell 0 */
	return cell >= (float)NT_CELLS ? NT_CELLS - 1 : cell > 0.0f ? (unsigned)cell : 0;
}

static box box_of(const nt_welded_mesh *mesh, const half *h)
{
	box b;
	memcpy(b.low, nt_welded_position(mesh, h->vertices[0]), sizeof b.low);
	memcpy(b.high, b.low, sizeof b.high);
	for (size_t i = 1; i < h->vertex_count; i++) {
		const float *p = nt_welded_position(mesh, h->vertices[i]);
		for (int k = 0; k < 3; k++) {
			b.low[k] = p[k] < b.low[k] ? p[k] : b.low[k];
			b.high[k] = p[k] > b.high[k] ? p[k] : b.high[k];
		}
	}
	return b;
}

/* Swaps entries until those below the middle come first, and only those that have to: the first that is above with the
 * last that is below, and so on. The order of all others, and which of them are swapped, decides in the end. */
static size_t part_entries(entry *entries, size_t count, const float *coordinates, size_t step, float middle)
{
	size_t left = 0, right = count;
	for (;;) {
		while (left < right && coordinates[step * entries[left].vertex] < middle)
			left++;
		while (left < right && !(coordinates[step * entries[right - 1].vertex] < middle))
			right--;
		if (left >= right)
			return left;
		const entry swapped = entries[left];
		entries[left++] = entries[--right];
		entries[right] = swapped;
	}
}

static size_t part_vertices(uint32_t *vertices, size_t count, const float *coordinates, size_t step, float middle)
{
	size_t below = 0;
	for (size_t i = 0; i < count; i++) {
		const uint32_t v = vertices[i];
		vertices[i] = vertices[below];
		vertices[below] = v;
		below += coordinates[step * v] < middle;
	}
	return below;
}

/* Where a part is halved; false where nothing is left to halve. */
static bool find_middle(const nt_welded_mesh *mesh, const half *part, const float **coordinates, float *middle)
{
	const box b = box_of(mesh, part);
	const unsigned axis = longest_axis(&b);
	*middle = 0.5f * (b.high[axis] + b.low[axis]);
	*coordinates = mesh->positions + axis;
	return *middle < b.high[axis] && *middle > b.low[axis];
}

static void halve(const weld *w, const half *whole, const float *coordinates, float middle, half *left, half *right)
{
	const size_t step = w->mesh->step;
	const size_t entries = part_entries(whole->entries, whole->entry_count, coordinates, step, middle);
	const size_t vertices = part_vertices(whole->vertices, whole->vertex_count, coordinates, step, middle);
	*right = (half){whole->entries + entries, whole->vertices + vertices, whole->entry_count - entries,
		whole->vertex_count - vertices};
	*left = (half){whole->entries, whole->vertices, entries, vertices};
}

/* False: it would have to be halved too often. */
static bool weld_cell(const weld *w, const half *cell)
{
	struct {
		half part;
		unsigned halvings;
	} waiting[NT_HALVINGS + 1];
	size_t count = 0;
	waiting[count].part = *cell;
	waiting[count++].halvings = 0;
	while (count > 0) {
		half part = waiting[--count].part, right;
		unsigned halvings = waiting[count].halvings;
		const float *coordinates;
		float middle;
		while (part.vertex_count > 1 && find_middle(w->mesh, &part, &coordinates, &middle)) {
			if (++halvings > NT_HALVINGS)
				return false;
			halve(w, &part, coordinates, middle, &part, &right);
			waiting[count].part = right;
			waiting[count++].halvings = halvings;
		}
		if (part.vertex_count == 1)
			part.entry_count = 1;
		for (size_t i = part.entry_count; i-- > 0;)
			w->found[part.entries[i].vertex] = part.entries[i].corner;
	}
	return true;
}

static void weld_cells(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	weld *w = context;
	for (size_t c = begin + 1; c <= end; c++) {
		const half cell = {w->entries + w->first_entry[c], w->vertices + w->first_vertex[c],
			w->first_entry[c + 1] - w->first_entry[c], w->first_vertex[c + 1] - w->first_vertex[c]};
		if (!weld_cell(w, &cell))
			nt_atomic_store(&w->limit, true, RELAXED);
	}
}

static uint32_t corner_at(const uint32_t *corners, size_t i)
{
	return corners ? corners[i] : (uint32_t)i;
}

static uint32_t vertex_at(const nt_welded_mesh *mesh, uint32_t corner)
{
	return mesh->triangles->ids[nt_triangle_corner(mesh->triangles, corner / 3, corner % 3)];
}

/* Turns counts into where things begin. */
static void add_up(uint32_t *counts, size_t cell_count)
{
	uint32_t sum = 0;
	for (size_t c = 1; c <= cell_count + 1; c++) {
		const uint32_t count = counts[c];
		counts[c] = sum;
		sum += count;
	}
}

/* Moves where things begin back, after each cell has been filled. */
static void move_back(uint32_t *ends, size_t cell_count)
{
	memmove(ends + 2, ends + 1, cell_count * sizeof *ends);
	ends[1] = 0;
}

/* Puts entries and vertices into their cells, the former in order. */
static bool fill_cells(weld *w, const nt_grid *grid, const uint32_t *corners, size_t count)
{
	const nt_welded_mesh *mesh = w->mesh;
	const size_t most = mesh->vertex_count < count ? mesh->vertex_count : count;
	const size_t cells = most < NT_CELLS ? most : NT_CELLS;
	uint16_t *cell_of = nt_scratch_alloc(mesh->scratch, mesh->vertex_count, sizeof *cell_of);
	uint32_t *met = nt_scratch_alloc(mesh->scratch, most, sizeof *met);
	w->vertices = nt_scratch_alloc(mesh->scratch, most, sizeof *w->vertices);
	w->entries = nt_scratch_alloc(mesh->scratch, count, sizeof *w->entries);
	w->first_entry = nt_scratch_alloc(mesh->scratch, 2 * (cells + 2), sizeof *w->first_entry);
	if (!cell_of || !met || !w->vertices || !w->entries || !w->first_entry)
		return false;
	w->first_vertex = w->first_entry + cells + 2;
	memset(w->first_entry, 0, 2 * (cells + 2) * sizeof *w->first_entry);
	size_t met_count = 0;
	for (size_t i = 0; i < count; i++)
		w->found[vertex_at(mesh, corner_at(corners, i))] = NONE;
	for (size_t i = 0; i < count; i++) {
		const uint32_t v = vertex_at(mesh, corner_at(corners, i));
		if (w->found[v] == NONE) {
			uint16_t *number =
				&w->number[nt_grid_cell(grid, nt_welded_position(mesh, v)[grid->axis])];
			if (*number == 0)
				*number = (uint16_t)++w->cell_count;
			w->found[v] = 0;
			met[met_count++] = v;
			cell_of[v] = *number;
			w->first_vertex[*number]++;
		}
		w->first_entry[cell_of[v]]++;
	}
	add_up(w->first_entry, w->cell_count);
	add_up(w->first_vertex, w->cell_count);
	for (size_t i = 0; i < met_count; i++)
		w->vertices[w->first_vertex[cell_of[met[i]]]++] = met[i];
	for (size_t i = 0; i < count; i++) {
		const uint32_t corner = corner_at(corners, i), v = vertex_at(mesh, corner);
		w->entries[w->first_entry[cell_of[v]]++] = (entry){v,
			(uint32_t)nt_triangle_corner(mesh->triangles, corner / 3, corner % 3)};
	}
	move_back(w->first_entry, w->cell_count);
	move_back(w->first_vertex, w->cell_count);
	return true;
}

nt_representatives_end nt_representatives(const nt_welded_mesh *mesh, const nt_grid *grid, const uint32_t *corners,
	size_t count, uint32_t *found)
{
	const nt_scratch_mark mark = nt_scratch_here(mesh->scratch);
	weld w = {.mesh = mesh, .found = found};
	const bool filled = fill_cells(&w, grid, corners, count);
	if (filled)
		nt_parallel_ranges(corners ? 1 : mesh->threads, w.cell_count, LEAST_CELLS, weld_cells, &w);
	nt_scratch_back(mesh->scratch, mark);
	return !filled ? NT_REPRESENTATIVES_NO_MEMORY : w.limit ? NT_REPRESENTATIVES_LIMIT : NT_REPRESENTATIVES_FOUND;
}
