/* SPDX-License-Identifier: MIT */
/*
 * The question of edge_sort.c for few triangles, nearly all of which are answered with no: scenes have thousands of
 * small meshes, so nothing is listed, and nothing is allocated.
 *
 * The representative of a vertex is between its first and its last corner. The order of the last run can only matter
 * if two of three triangles or more, whose middle representative may be the largest lower end, share the largest.
 */
#include "topology/edge_sort.h"

#include <math.h>
#include <string.h>
#include "base/compiler.h"

enum {
	MOST_ROWS = 3 * NT_EDGE_FEW,
	MOST_PAIRS = 64,
	WINDOW = 16,    /* triangles at the end that hold the last run */
	LAST = 4,       /* a vertex of the last triangle that is older than these is likely to be found there */
	MOST_ROUNDS = 8,
	LEAST_EDGES = 3 /* of a run whose order matters */
};

typedef struct few {
	const nt_welded_mesh *mesh;
	const nt_grid *grid;
	const uint32_t *ids;
	uint32_t count, window;    /* triangles; the first of the last ones */
	uint32_t low[MOST_ROWS], high[MOST_ROWS]; /* the representative is between; high is 0 in no last triangle */
	uint32_t beside[MOST_ROWS];  /* the largest low of those that a vertex has an edge with, of those that count */
	uint32_t suspects[NT_EDGE_FEW]; /* triangles whose middle representative may be the largest lower end */
	uint32_t suspect_count;
	uint32_t least;            /* what the largest lower end is at least */
	uint32_t oldest;           /* the first triangle that has a vertex of the last ones */
} few;

static uint32_t least_of(uint32_t a, uint32_t b)
{
	return a < b ? a : b;
}

static uint32_t most_of(uint32_t a, uint32_t b)
{
	return a < b ? b : a;
}

static uint32_t middle_of(uint32_t a, uint32_t b, uint32_t c)
{
	return most_of(least_of(a, b), least_of(most_of(a, b), c));
}

/* Finds first and last corners. Whether all rows have some. */
static bool find_bounds(few *f)
{
	const size_t rows = f->mesh->vertex_count;
	memset(f->low, 0xff, rows * sizeof *f->low);
	memset(f->high, 0, rows * sizeof *f->high);
	for (uint32_t c = 3 * f->count; c-- > 0;)
		f->low[f->ids[c]] = c;
	f->oldest = f->window;
	for (uint32_t c = 3 * f->window; c < 3 * f->count; c++) {
		f->high[f->ids[c]] = c;
		f->oldest = least_of(f->oldest, f->low[f->ids[c]] / 3);
	}
	bool used = true;
	for (size_t v = 0; v < rows; v++)
		used &= f->low[v] != UINT32_MAX;
	return used;
}

static void find_least(few *f)
{
	f->least = 0;
	for (uint32_t t = f->count; t-- > f->window;) {
		const uint32_t *v = f->ids + 3 * t;
		const uint32_t middle = middle_of(f->low[v[0]], f->low[v[1]], f->low[v[2]]);
		if (middle > f->least && !nt_welded_is_degenerate(f->mesh, v))
			f->least = middle;
	}
}

/* Triangles that count, of all, or of those before. Two vertices of each are of the last triangles. */
static void find_suspects(few *f, bool of_all)
{
	const uint32_t all = of_all ? f->count : f->suspect_count;
	uint32_t count = 0;
	for (uint32_t i = of_all ? f->oldest : 0; i < all; i++) {
		const uint32_t t = of_all ? i : f->suspects[i], *const v = f->ids + 3 * t;
		f->suspects[count] = t;
		count += middle_of(f->high[v[0]], f->high[v[1]], f->high[v[2]]) >= f->least;
	}
	f->suspect_count = 0;
	for (uint32_t i = 0; i < count; i++) {
		const uint32_t t = f->suspects[i];
		f->suspects[f->suspect_count] = t;
		f->suspect_count += !of_all || !nt_welded_is_degenerate(f->mesh, f->ids + 3 * t);
	}
}

/* Finds the representative of a vertex, and those of the last triangle's vertices in its cell. False: the cell has to
 * be halved too often. */
static bool find(few *f, uint32_t vertex)
{
	enum { ALONE = MOST_ROWS };
	nt_cell_vertex vertices[MOST_ROWS + 1];
	nt_cell_corner corners[MOST_ROWS];
	uint32_t order[MOST_ROWS], swaps[MOST_ROWS], found[MOST_ROWS];
	uint16_t numbers[MOST_ROWS];
	uint8_t below[MOST_ROWS], is_wanted[MOST_ROWS];
	nt_cell cell = {vertices, corners, order, swaps, below, is_wanted, found, 0, 0};
	const nt_grid grid = *f->grid;
	const float at = nt_welded_position(f->mesh, vertex)[grid.axis];
	const unsigned wanted = nt_grid_cell(&grid, at);
	/* two cells, so that no rounding matters; if a box is so thin that this is 0, each float has its own cell */
	const float reach = (grid.high - grid.low) * (2.0f / NT_CELLS);
	for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
		const float *position = nt_welded_position(f->mesh, v);
		numbers[v] = ALONE;
		if (!(fabsf(position[grid.axis] - at) <= reach) || nt_grid_cell(&grid, position[grid.axis]) != wanted ||
			f->low[v] == UINT32_MAX)
			continue;
		memcpy(vertices[cell.vertex_count].position, position, sizeof vertices->position);
		vertices[cell.vertex_count].corner_count = 0;
		is_wanted[cell.vertex_count] = 0;
		numbers[v] = (uint16_t)cell.vertex_count++;
	}
	for (uint32_t c = 0; c < 3 * f->count; c += 3) {
		const uint32_t *v = f->ids + c;
		if ((numbers[v[0]] == ALONE) & (numbers[v[1]] == ALONE) & (numbers[v[2]] == ALONE))
			continue;
		for (uint32_t k = 0; k < 3; k++) {
			const uint32_t number = numbers[v[k]];
			corners[cell.corner_count] = (nt_cell_corner){number, c + k};
			cell.corner_count += number != ALONE;
			vertices[number].corner_count++;
		}
	}
	const uint32_t *last = f->ids + 3 * f->count - 3, all[4] = {vertex, last[0], last[1], last[2]};
	bool is[4];
	for (int i = 0; i < 4; i++) {
		is[i] = numbers[all[i]] != ALONE && f->low[all[i]] != f->high[all[i]];
		if (is[i])
			is_wanted[numbers[all[i]]] = 1;
	}
	if (!nt_weld_cell(&cell))
		return false;
	for (int i = 0; i < 4; i++)
		if (is[i])
			f->low[all[i]] = f->high[all[i]] = found[numbers[all[i]]];
	return true;
}

/* Whether the order may matter; `unknown` receives a vertex that decides it, or NT_NO_NEIGHBOUR. */
static bool may_matter(few *f, uint32_t *unknown)
{
	const uint32_t least = f->least, *const low = f->low, *const high = f->high;
	struct {
		uint32_t middle, largest;
	} pairs[MOST_PAIRS + 6];
	uint32_t count = 0, lowest = UINT32_MAX;
	for (uint32_t i = 0; i < 3 * f->suspect_count; i++)
		f->beside[f->ids[3 * f->suspects[i / 3] + i % 3]] = 0;
	for (uint32_t i = 0; i < f->suspect_count; i++) {
		const uint32_t *v = f->ids + 3 * f->suspects[i], a = low[v[0]], b = low[v[1]], c = low[v[2]];
		f->beside[v[0]] = most_of(f->beside[v[0]], most_of(b, c));
		f->beside[v[1]] = most_of(f->beside[v[1]], most_of(c, a));
		f->beside[v[2]] = most_of(f->beside[v[2]], most_of(a, b));
	}
	/* which vertices of a triangle may be the middle one and the largest: no edge of the latter has a larger lower
	 * end than the middle one */
	*unknown = NT_NO_NEIGHBOUR;
	for (uint32_t i = 0; i < f->suspect_count; i++) {
		const uint32_t *v = f->ids + 3 * f->suspects[i];
		uint32_t lows[3], highs[3], beside[3];
		for (int k = 0; k < 3; k++) {
			lows[k] = low[v[k]];
			highs[k] = high[v[k]];
			beside[k] = f->beside[v[k]];
		}
		NT_UNROLL(6)
		for (int way = 0; way < 6; way++) {
			const int m = way / 2, l = (m + 1 + way % 2) % 3;
			pairs[count].middle = v[m];
			pairs[count].largest = v[l];
			count += (highs[m] >= least) & (highs[l] > most_of(lows[m], least)) &
				(lows[3 - m - l] < highs[m]) & (beside[l] <= highs[m]);
		}
		if (count > MOST_PAIRS)
			return true;
	}
	bool may = false;
	for (uint32_t i = 1; i < count; i++)
		for (uint32_t k = 0; k < i; k++) {
			if ((pairs[i].middle != pairs[k].middle) | (pairs[i].largest != pairs[k].largest))
				continue;
			uint32_t edges = 0;
			for (uint32_t e = 0; e < count; e++)
				edges += pairs[e].middle == pairs[i].middle;
			may |= edges >= LEAST_EDGES;
			for (int end = 0; end < 2 && edges >= LEAST_EDGES; end++) {
				const uint32_t v = end ? pairs[i].largest : pairs[i].middle;
				if (low[v] != high[v] && low[v] < lowest) {
					lowest = low[v];
					*unknown = v;
				}
			}
		}
	return may;
}

bool nt_few_edges_are_sorted(const nt_welded_mesh *mesh, bool *limit)
{
	few f;
	nt_grid grid;
	if (mesh->triangle_count < LEAST_EDGES) {
		*limit = !nt_grid_of_used(mesh, &grid);
		return true;
	}
	f.mesh = mesh;
	f.grid = &grid;
	f.ids = mesh->triangles->ids;
	f.count = (uint32_t)mesh->triangle_count;
	f.window = f.count > WINDOW ? f.count - WINDOW : 0;
	const bool used = find_bounds(&f);
	*limit = !(used && nt_grid_make(mesh, NULL, &grid)) && !nt_grid_of_used(mesh, &grid);
	if (*limit)
		return true;
	for (uint32_t c = 3 * f.count - 3; c < 3 * f.count; c++) {
		const uint32_t vertex = f.ids[c];
		if (f.low[vertex] + 3 * LAST < 3 * f.count && f.high[vertex] == c && !find(&f, vertex))
			return false;
	}
	for (int round = 0; round < MOST_ROUNDS; round++) {
		uint32_t unknown;
		find_least(&f);
		if (f.least < 3 * f.window)
			return false;
		find_suspects(&f, round == 0);
		if (!may_matter(&f, &unknown))
			return true;
		if (unknown == NT_NO_NEIGHBOUR || !find(&f, unknown))
			return false;
	}
	return false;
}
