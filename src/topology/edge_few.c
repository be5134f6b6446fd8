/* SPDX-License-Identifier: MIT */
/*
 * The question of edge_tail.c for few triangles, nearly all of which are answered with no: scenes have thousands of
 * small meshes, so nothing is allocated, and corners are only listed if a vertex shares its cell. A call for 8
 * triangles takes 560 ns instead of 910, one for 32 takes 1 000 instead of 1 450 (Zen 5, AVX-512). If it stays open,
 * edge_sort.c finds the order: a call for 120 triangles in no order takes 13 us, and took 101 when edge_tail.c was
 * asked as well (Zen 4).
 *
 * The representative of a vertex is between its first and its last corner. The order of the last run can only matter
 * if two of three triangles or more, whose middle representative may be the largest lower end, share the largest.
 */
#include "topology/inside.h"

#include <math.h>
#include <string.h>
#include "base/compiler.h"
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

enum {
	MOST_ROWS = 3 * NT_EDGE_FEW,
	MOST_ENDS = 64,
	MOST_IN_CELL = 63, /* vertices */
	WINDOW = 16,       /* triangles at the end that hold the last run */
	LAST = 4,          /* a vertex of the last triangle that is older than these is likely to be found there */
	BLOCK = 32,        /* rows that are cleared, or compared, at a time */
	LANES = 4,
	MOST_ROUNDS = 3
};

/* The first corner of a row that has none. */
#define NONE UINT16_MAX

/* Corners have the numbers 4 * triangle + k. */
typedef struct few {
	const nt_welded_mesh *mesh;
	const uint32_t *ids;
	nt_grid grid;
	uint32_t count, window;      /* triangles; the first of the last ones */
	uint32_t least;              /* what the largest lower end is at least */
	uint32_t moved;              /* the first corner of all vertices that have another representative */
	uint32_t suspect_count;
	uint16_t low[MOST_ROWS], high[MOST_ROWS]; /* the representative is between; high is 0 in no last triangle */
	uint16_t beside[MOST_ROWS];  /* the largest low of those that a vertex has an edge with, of those that count */
	uint8_t around[MOST_ROWS];   /* suspects that a vertex has */
	uint16_t suspects[NT_EDGE_FEW + 1]; /* triangles whose middle representative may be the largest lower end */
	float along[MOST_ROWS];      /* coordinates on the grid's axis; behind the last row: infinite */
} few;

static uint32_t middle_of(uint32_t a, uint32_t b, uint32_t c)
{
	return nt_most_of(nt_least_of(a, b), nt_least_of(nt_most_of(a, b), c));
}

/* Finds the first corner of each vertex, and the last one if it is in the last triangles. Whether all rows have
 * some. */
static bool find_corners(few *f)
{
	const size_t rows = f->mesh->vertex_count;
	/* blocks of one size need no calls */
	for (size_t v = 0; v < rows; v += BLOCK) {
		memset(f->low + v, 0xff, BLOCK * sizeof *f->low);
		memset(f->high + v, 0, BLOCK * sizeof *f->high);
	}
	const uint32_t *v = f->ids + 3 * f->count;
	for (uint32_t c = 4 * f->count; c > 0;) {
		c -= 4;
		v -= 3;
		f->low[v[2]] = (uint16_t)(c + 2);
		f->low[v[1]] = (uint16_t)(c + 1);
		f->low[v[0]] = (uint16_t)c;
	}
	for (uint32_t t = f->window; t < f->count; t++) {
		v = f->ids + 3 * t;
		f->high[v[0]] = (uint16_t)(4 * t);
		f->high[v[1]] = (uint16_t)(4 * t + 1);
		f->high[v[2]] = (uint16_t)(4 * t + 2);
	}
	/* one by one: a load of more than was stored at once waits for all stores */
	uint32_t bits = 0;
	for (size_t row = 0; row < rows; row++)
		bits |= f->low[row];
	return bits < 4 * NT_EDGE_FEW;
}

static void find_least(few *f)
{
	f->least = 0;
	/* the middle corner of a triangle is not above its second one */
	for (uint32_t t = f->count; t-- > f->window && 4 * t + 1 > f->least;) {
		const uint32_t *v = f->ids + 3 * t;
		const uint32_t middle = middle_of(f->low[v[0]], f->low[v[1]], f->low[v[2]]);
		if (middle > f->least && !nt_welded_is_degenerate(f->mesh, t, v))
			f->least = middle;
	}
}

/* Whether two vertices of a triangle may be at least the largest lower end. */
static bool is_suspect(const few *f, uint32_t t)
{
	const uint32_t *v = f->ids + 3 * t;
	return (f->high[v[0]] >= f->least) + (f->high[v[1]] >= f->least) + (f->high[v[2]] >= f->least) >= 2;
}

/* Lists the suspects. */
static void list_suspects(few *f)
{
	uint32_t from = f->moved;
	for (uint32_t i = f->least / 4 * 3; i < 3 * f->count; i++) {
		const uint32_t v = f->ids[i], low = f->high[v] >= f->least ? f->low[v] : NONE;
		from = nt_least_of(from, low);
	}
	f->suspect_count = 0;
	for (uint32_t t = from / 4; t < f->count; t++) {
		f->suspects[f->suspect_count] = (uint16_t)t;
		f->suspect_count += is_suspect(f, t);
	}
}

/* Finds suspects, those of the round before first. Whether one of their vertices has enough of them. */
static bool find_suspects(few *f, bool of_all)
{
	uint32_t count = 0, most = 0;
	if (of_all)
		list_suspects(f);
	for (uint32_t i = 0; i < f->suspect_count; i++) {
		const uint32_t *v = f->ids + 3 * f->suspects[i];
		f->suspects[count] = f->suspects[i];
		count += of_all ? !nt_welded_is_degenerate(f->mesh, f->suspects[i], v) : is_suspect(f, f->suspects[i]);
		f->beside[v[0]] = f->beside[v[1]] = f->beside[v[2]] = 0;
		f->around[v[0]] = f->around[v[1]] = f->around[v[2]] = 0;
	}
	f->suspect_count = count;
	for (uint32_t i = 0; i < count; i++) {
		const uint32_t *v = f->ids + 3 * f->suspects[i];
		for (int k = 0; k < 3; k++) {
			const uint32_t around = ++f->around[v[k]];
			most = f->high[v[k]] >= f->least ? nt_most_of(most, around) : most;
		}
	}
	return most >= NT_LEAST_EDGES;
}

/* A cell, as representatives.c halves it. Its vertices have numbers from 1 on. */
typedef struct few_cell {
	uint64_t wanted;                      /* a bit for each vertex */
	uint32_t first;                       /* no corner is before */
	uint16_t names[MOST_IN_CELL + 1];     /* of vertices */
	nt_cell_vertex vertices[MOST_IN_CELL + 1];
	nt_cell_corner corners[MOST_ROWS + 1];
	uint32_t order[MOST_IN_CELL], swaps[MOST_ROWS];
	uint8_t below[MOST_IN_CELL + 1];
	nt_part parts[2 * MOST_IN_CELL];
} few_cell;

/* Vertices farther apart are in two cells, whatever is rounded. If a box is so thin that this is 0, each float has a
 * cell of its own. */
static float reach_of(const nt_grid *grid)
{
	return (grid->high - grid->low) * (2.0f / (float)NT_CELLS);
}

/* Compares BLOCK rows, or the rest, with a coordinate: a bit for each that is near. */
static uint32_t near_rows(const few *f, size_t row, float at, float reach)
{
	const size_t left = f->mesh->vertex_count - row, end = left < BLOCK ? left : BLOCK;
	uint32_t bits = 0;
#if defined(__SSE2__)
	const __m128 middle = _mm_set1_ps(at), most = _mm_set1_ps(reach), sign = _mm_set1_ps(-0.0f);
	for (size_t i = 0; i < end; i += LANES) {
		const __m128 distance = _mm_sub_ps(_mm_loadu_ps(f->along + row + i), middle);
		bits |= (uint32_t)_mm_movemask_ps(_mm_cmple_ps(_mm_andnot_ps(sign, distance), most)) << i;
	}
#else
	for (size_t i = 0; i < end; i++)
		bits |= (uint32_t)(fabsf(f->along[row + i] - at) <= reach) << i;
#endif
	return bits;
}

/* Knows the representatives of those of the last triangles' vertices that are alone in their cells: their first
 * corners. If two are not, vertices are likely to lie in rows. */
static void find_alone(few *f)
{
	enum { MOST_IN_ROWS = 2 };
	uint32_t in_rows = 0;
	const float reach = reach_of(&f->grid), *x = f->mesh->positions + f->grid.axis;
	const size_t rows = f->mesh->vertex_count;
	for (size_t v = 0; v < rows; v++, x += f->mesh->step)
		f->along[v] = *x;
	for (size_t v = rows; v % LANES != 0; v++)
		f->along[v] = INFINITY;
	for (uint32_t t = f->count; t-- > 0 && t + LAST >= f->count;)
		for (uint32_t k = 0; k < 3 && in_rows < MOST_IN_ROWS; k++) {
			const uint32_t vertex = f->ids[3 * t + k];
			uint32_t near = 0;
			if (f->high[vertex] != 4 * t + k || f->low[vertex] == f->high[vertex])
				continue;
			for (size_t v = 0; v < rows && near < 2; v += BLOCK) {
				const uint32_t bits = near_rows(f, v, f->along[vertex], reach);
				near += (bits != 0) + ((bits & (bits - 1)) != 0);
			}
			if (near == 1)
				f->high[vertex] = f->low[vertex];
			in_rows += near > 1;
		}
}

/* Lists the vertices of a vertex's cell, and says which are wanted: it, and those of the last triangle. Returns how
 * many there are, up to one more than MOST_IN_CELL. */
static uint32_t list_vertices(const few *f, uint32_t vertex, few_cell *cell)
{
	const nt_grid grid = f->grid;
	const float at = f->along[vertex], reach = reach_of(&grid);
	const uint32_t *last = f->ids + 3 * f->count - 3;
	uint32_t count = 0;
	cell->wanted = 0;
	cell->first = f->moved;
	for (uint32_t row = 0; row < f->mesh->vertex_count; row += BLOCK)
		for (uint32_t left = near_rows(f, row, at, reach); left; left &= left - 1) {
			const uint32_t v = row + (uint32_t)nt_trailing_zeros(left);
			const float other = f->along[v];
			if (f->low[v] == NONE ||
				(other != at && nt_grid_cell(&grid, other) != nt_grid_cell(&grid, at)))
				continue;
			if (count == MOST_IN_CELL)
				return count + 1;
			cell->order[count] = count + 1;
			memcpy(cell->vertices[++count].position, nt_welded_position(f->mesh, v), 3 * sizeof(float));
			cell->vertices[count].corners = 0;
			cell->names[count] = (uint16_t)v;
			cell->first = nt_least_of(cell->first, f->low[v]);
			cell->wanted |= (uint64_t)((v == vertex) | (v == last[0]) | (v == last[1]) | (v == last[2]))
				<< count;
		}
	return count;
}

/* Lists the corners of a cell's vertices. Returns how many there are. */
static uint32_t list_corners(const few *f, uint32_t count, few_cell *cell)
{
	uint8_t owners[MOST_ROWS]; /* a vertex of the cell, or 0 */
	nt_cell_corner *corner = cell->corners;
	for (size_t v = 0; v < f->mesh->vertex_count; v += BLOCK)
		memset(owners + v, 0, BLOCK);
	for (uint32_t i = 1; i <= count; i++)
		owners[cell->names[i]] = (uint8_t)i;
	const uint32_t *v = f->ids + cell->first / 4 * 3;
	for (uint32_t c = cell->first / 4 * 4; c < 4 * f->count; c += 4, v += 3) {
		const uint32_t of[3] = {owners[v[0]], owners[v[1]], owners[v[2]]};
		if (!(of[0] | of[1] | of[2]))
			continue;
		for (uint32_t k = 0; k < 3; k++) {
			*corner = (nt_cell_corner){of[k], c + k};
			corner += of[k] != 0;
		}
	}
	/* not above: those that are none would wait for one another */
	for (const nt_cell_corner *one = cell->corners; one < corner; one++)
		cell->vertices[one->vertex].corners++;
	return (uint32_t)(corner - cell->corners);
}

/* Finds the representative of a vertex, and those of the last triangle's vertices in its cell. False: the
 * cell has too many vertices, or has to be halved too often. */
static bool find(few *f, uint32_t vertex)
{
	few_cell cell;
	const uint32_t count = list_vertices(f, vertex, &cell);
	if (count > MOST_IN_CELL)
		return false;
	nt_part all = {.vertex_count = count, .corner_count = list_corners(f, count, &cell)};
	nt_cells cells = {.vertices = cell.vertices, .corners = cell.corners, .order = cell.order,
		.below = cell.below, .swaps = cell.swaps, .parts = cell.parts, .part_count = 2 * MOST_IN_CELL};
	for (uint64_t left = cell.wanted; left; left &= left - 1) {
		const uint32_t i = (uint32_t)nt_trailing_zeros(left);
		if (!nt_cells_find(&cells, &all, i))
			return false;
		uint16_t *const low = &f->low[cell.names[i]];
		const uint16_t found = (uint16_t)nt_cells_found(&cells, i);
		f->moved = *low != found ? nt_least_of(f->moved, *low) : f->moved;
		*low = f->high[cell.names[i]] = found;
	}
	return true;
}

/* Finds the larger ends of edges whose lower end may be the largest one, at this vertex: no edge of theirs has a larger
 * lower end. Returns how many there are, up to MOST_ENDS + 1. */
static uint32_t find_ends(const few *f, uint32_t middle, uint16_t *ends)
{
	const uint16_t *const low = f->low, *const high = f->high;
	const uint32_t most = high[middle], least = nt_most_of(low[middle], f->least);
	uint32_t count = 0;
	for (uint32_t i = 0; i < f->suspect_count && count < MOST_ENDS; i++) {
		const uint32_t *v = f->ids + 3 * f->suspects[i];
		if (v[0] != middle && v[1] != middle && v[2] != middle)
			continue;
		const uint32_t a = v[v[0] == middle], b = v[2 - (v[2] == middle)];
		ends[count] = (uint16_t)a;
		count += (high[a] > least) & (low[b] < most) & (f->beside[a] <= most);
		ends[count] = (uint16_t)b;
		count += (high[b] > least) & (low[a] < most) & (f->beside[b] <= most);
	}
	return count;
}

/* Whether the order may matter; `unknown` receives a vertex that decides it, or NT_NO_NEIGHBOUR. */
static bool may_matter(few *f, uint32_t *unknown)
{
	const uint16_t *const low = f->low, *const high = f->high;
	uint32_t lowest = UINT32_MAX;
	bool may = false;
	*unknown = NT_NO_NEIGHBOUR;
	for (uint32_t i = 0; i < f->suspect_count; i++) {
		const uint32_t *v = f->ids + 3 * f->suspects[i], a = low[v[0]], b = low[v[1]], c = low[v[2]];
		f->beside[v[0]] = (uint16_t)nt_most_of(f->beside[v[0]], nt_most_of(b, c));
		f->beside[v[1]] = (uint16_t)nt_most_of(f->beside[v[1]], nt_most_of(c, a));
		f->beside[v[2]] = (uint16_t)nt_most_of(f->beside[v[2]], nt_most_of(a, b));
	}
	for (uint32_t c = f->least; c < 4 * f->count; c++) {
		uint16_t ends[MOST_ENDS + 2];
		const uint32_t middle = f->ids[3 * (c / 4) + c % 4 % 3];
		const bool may_be = high[middle] == c && f->around[middle] >= NT_LEAST_EDGES;
		const uint32_t count = may_be ? find_ends(f, middle, ends) : 0;
		if (count >= MOST_ENDS) {
			*unknown = NT_NO_NEIGHBOUR;
			return true;
		}
		for (uint32_t i = 1; count >= NT_LEAST_EDGES && i < count; i++)
			for (uint32_t k = 0; k < i; k++)
				for (int end = 0; end < 2 && ends[i] == ends[k]; end++) {
					const uint32_t v = end ? ends[i] : middle;
					may = true;
					if (low[v] != high[v] && low[v] < lowest) {
						lowest = low[v];
						*unknown = v;
					}
				}
	}
	return may;
}

bool nt_few_edges_are_sorted(const nt_welded_mesh *mesh, nt_grid *grid, bool *limit)
{
	few f;
	if (mesh->triangle_count < NT_LEAST_EDGES) {
		*limit = !nt_grid_of_used(mesh, grid);
		return true;
	}
	f.mesh = mesh;
	f.ids = mesh->triangles->ids;
	f.count = (uint32_t)mesh->triangle_count;
	f.window = f.count > WINDOW ? f.count - WINDOW : 0;
	f.moved = 4 * f.count;
	const bool used = find_corners(&f);
	*limit = !(used && nt_grid_make(mesh, NULL, grid)) && !nt_grid_of_used(mesh, grid);
	if (*limit)
		return true;
	f.grid = *grid;
	find_alone(&f);
	for (uint32_t k = 0; k < 3; k++) {
		const uint32_t vertex = f.ids[3 * f.count - 3 + k];
		const bool is_old = f.low[vertex] + 4u * LAST < 4 * f.count;
		if (f.low[vertex] != f.high[vertex] && is_old && !find(&f, vertex))
			return false;
	}
	for (int round = 0; round < MOST_ROUNDS; round++) {
		uint32_t unknown;
		find_least(&f);
		if (f.least < 4 * f.window)
			return false;
		if (!find_suspects(&f, round == 0) || !may_matter(&f, &unknown))
			return true;
		if (unknown == NT_NO_NEIGHBOUR || !find(&f, unknown))
			return false;
	}
	return false;
}
