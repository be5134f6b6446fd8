/* SPDX-License-Identifier: MIT */
/*
 * The question of edge_tail.c for few triangles, nearly all of which are answered with no: scenes have thousands of
 * small meshes, so nothing is allocated, and of all corners only the next of the same vertex is written down. A call
 * for 8 triangles takes 580 ns instead of 910, one for 32 takes 1 030 instead of 1 450 (Zen 5, AVX-512).
 *
 * The representative of a vertex is between its first and its last corner. The order of the last run can only matter
 * if two of three triangles or more, whose middle representative may be the largest lower end, share the largest.
 */
#include "topology/edge_parts.h"

#include <math.h>
#include <string.h>
#include "base/compiler.h"

enum {
	MOST_ROWS = 3 * NT_EDGE_FEW,
	MOST_ENDS = 64,
	MOST_IN_CELL = 63, /* vertices; if corners are no more, each has a bit */
	MOST_CORNERS = 256,
	WINDOW = 16,       /* triangles at the end that hold the last run */
	LAST = 4,          /* a vertex of the last triangle that is older than these is likely to be found there */
	BLOCK = 32,        /* rows that are cleared at a time */
	MOST_ROUNDS = 8
};

/* Behind the last corner of a vertex. */
#define NONE UINT16_MAX

/* Corners have the numbers 4 * triangle + k. */
typedef struct few {
	const nt_welded_mesh *mesh;
	const uint32_t *ids;
	nt_grid grid;
	uint32_t count, window;      /* triangles; the first of the last ones */
	uint32_t least;              /* what the largest lower end is at least */
	uint32_t suspect_count;
	uint16_t first[MOST_ROWS], next[4 * NT_EDGE_FEW]; /* corners of each vertex, ascending */
	uint16_t low[MOST_ROWS], high[MOST_ROWS]; /* the representative is between; high is 0 in no last triangle */
	uint16_t beside[MOST_ROWS];  /* the largest low of those that a vertex has an edge with, of those that count */
	uint8_t around[MOST_ROWS];   /* suspects that a vertex has */
	uint16_t suspects[NT_EDGE_FEW]; /* triangles whose middle representative may be the largest lower end */
} few;

static uint32_t middle_of(uint32_t a, uint32_t b, uint32_t c)
{
	return nt_most_of(nt_least_of(a, b), nt_least_of(nt_most_of(a, b), c));
}

/* Links the corners of each vertex. Whether all rows have some. */
static bool link_corners(few *f)
{
	const size_t rows = f->mesh->vertex_count;
	/* blocks of one size need no calls */
	for (size_t v = 0; v < rows; v += BLOCK) {
		memset(f->first + v, 0xff, BLOCK * sizeof *f->first);
		memset(f->high + v, 0, BLOCK * sizeof *f->high);
	}
	for (uint32_t t = f->count; t-- > 0;) {
		const uint32_t *v = f->ids + 3 * t, a = v[0], b = v[1], c = v[2];
		uint16_t *const next = f->next + 4 * t;
		next[2] = f->first[c];
		f->first[c] = (uint16_t)(4 * t + 2);
		next[1] = f->first[b];
		f->first[b] = (uint16_t)(4 * t + 1);
		next[0] = f->first[a];
		f->first[a] = (uint16_t)(4 * t);
	}
	for (uint32_t t = f->window; t < f->count; t++) {
		const uint32_t *v = f->ids + 3 * t;
		f->high[v[0]] = (uint16_t)(4 * t);
		f->high[v[1]] = (uint16_t)(4 * t + 1);
		f->high[v[2]] = (uint16_t)(4 * t + 2);
	}
	/* one by one: a load of more than was stored at once waits for all stores */
	uint32_t bits = 0;
	for (size_t v = 0; v < rows; v++) {
		const uint32_t first = f->first[v];
		f->low[v] = first & (NONE >> 1);
		bits |= first;
	}
	return bits < 4 * NT_EDGE_FEW;
}

static void find_least(few *f)
{
	f->least = 0;
	/* the middle corner of a triangle is not above its second one */
	for (uint32_t t = f->count; t-- > f->window && 4 * t + 1 > f->least;) {
		const uint32_t *v = f->ids + 3 * t;
		const uint32_t middle = middle_of(f->low[v[0]], f->low[v[1]], f->low[v[2]]);
		if (middle > f->least && !nt_welded_is_degenerate(f->mesh, v))
			f->least = middle;
	}
}

/* Whether two vertices of a triangle may be at least the largest lower end. */
static bool is_suspect(const few *f, uint32_t t)
{
	const uint32_t *v = f->ids + 3 * t;
	return (f->high[v[0]] >= f->least) + (f->high[v[1]] >= f->least) + (f->high[v[2]] >= f->least) >= 2;
}

/* Lists the suspects around vertices that may be at least the largest lower end; false: none has enough of them. */
static bool list_suspects(few *f)
{
	uint64_t seen[NT_EDGE_FEW / 64] = {0};
	uint32_t most = 0;
	for (uint32_t c = f->least; c < 4 * f->count; c++) {
		const uint32_t vertex = f->ids[3 * (c / 4) + c % 4 % 3];
		uint32_t around = 0;
		for (uint32_t at = f->high[vertex] == c ? f->first[vertex] : NONE; at != NONE; at = f->next[at]) {
			const uint32_t t = at / 4, suspect = is_suspect(f, t);
			seen[t / 64] |= (uint64_t)suspect << t % 64;
			around += suspect;
		}
		most = nt_most_of(most, around);
	}
	if (most < NT_LEAST_EDGES)
		return false;
	f->suspect_count = 0;
	for (uint32_t word = 0; word < NT_EDGE_FEW / 64; word++)
		for (uint64_t left = seen[word]; left; left &= left - 1) {
			const uint32_t t = 64 * word + (uint32_t)nt_trailing_zeros(left);
			f->suspects[f->suspect_count] = (uint16_t)t;
			f->suspect_count += !nt_welded_is_degenerate(f->mesh, f->ids + 3 * t);
		}
	return true;
}

/* Finds suspects, those of the round before first. Whether one of their vertices has enough of them. */
static bool find_suspects(few *f, bool of_all)
{
	uint32_t count = 0, most = 0;
	if (of_all && !list_suspects(f))
		return false;
	for (uint32_t i = 0; i < f->suspect_count; i++) {
		const uint32_t *v = f->ids + 3 * f->suspects[i];
		f->suspects[count] = f->suspects[i];
		count += of_all || is_suspect(f, f->suspects[i]);
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

/* A cell: representatives.h says how it is welded. Its corners have places, and each vertex a bit for each of its
 * corners' places. */
typedef struct few_cell {
	uint64_t wanted;                    /* vertices */
	uint64_t has[MOST_IN_CELL];
	const float *positions[MOST_IN_CELL];
	uint16_t names[MOST_IN_CELL];       /* of vertices */
	uint16_t corners[MOST_CORNERS];     /* by place */
	uint16_t found[MOST_IN_CELL];       /* representatives of those that are wanted */
	uint8_t owners[MOST_CORNERS];       /* vertices, by place */
	uint16_t counts[MOST_IN_CELL];      /* of corners */
	uint8_t order[MOST_IN_CELL];        /* vertices by part */
} few_cell;

/* Finds the axis and the point at which some vertices of a cell are halved. False: nothing is left to halve. */
static bool find_middle(const few_cell *c, const uint8_t *order, uint32_t count, unsigned *axis, float *middle)
{
	const float *p = c->positions[order[0]];
	float x0 = p[0], x1 = x0, y0 = p[1], y1 = y0, z0 = p[2], z1 = z0;
	for (uint32_t i = 1; i < count; i++) {
		p = c->positions[order[i]];
		x0 = p[0] < x0 ? p[0] : x0;
		x1 = p[0] > x1 ? p[0] : x1;
		y0 = p[1] < y0 ? p[1] : y0;
		y1 = p[1] > y1 ? p[1] : y1;
		z0 = p[2] < z0 ? p[2] : z0;
		z1 = p[2] > z1 ? p[2] : z1;
	}
	const float x = x1 - x0, y = y1 - y0, z = z1 - z0;
	*axis = y > x && y > z ? 1 : z > x ? 2 : 0;
	const float low = *axis == 0 ? x0 : *axis == 1 ? y0 : z0, high = *axis == 0 ? x1 : *axis == 1 ? y1 : z1;
	*middle = 0.5f * (high + low);
	return *middle < high && *middle > low;
}

/* Swaps the first corner that is above with the last that is below, and so on. */
static void swap_corners(few_cell *c, uint64_t above, uint64_t below)
{
	while (above) {
		const int i = nt_trailing_zeros(above), k = nt_highest_bit(below);
		const uint64_t both = (uint64_t)1 << i | (uint64_t)1 << k;
		const uint8_t owner = c->owners[i];
		const uint16_t corner = c->corners[i];
		c->has[owner] ^= both;
		c->has[c->owners[k]] ^= both;
		c->owners[i] = c->owners[k];
		c->corners[i] = c->corners[k];
		c->owners[k] = owner;
		c->corners[k] = corner;
		above &= ~both;
		below &= ~both;
	}
}

/* Welds a part: vertices order[first, first + count), whose corners' places begin at `place`. False: it has to be
 * halved too often. */
static bool weld_part(few_cell *c, uint32_t first, uint32_t count, uint32_t place, int halvings)
{
	unsigned axis;
	float middle;
	while (count > 1 && find_middle(c, c->order + first, count, &axis, &middle)) {
		uint8_t *const order = c->order + first;
		uint64_t below = 0, all = 0, low = 0;
		uint32_t low_count = 0, left = 0;
		if (halvings++ == NT_HALVINGS)
			return false;
		for (uint32_t i = 0; i < count; i++) {
			const uint8_t one = order[i], other = order[low_count];
			const bool is = c->positions[one][axis] < middle;
			const uint64_t bit = (uint64_t)1 << one, mask = -(uint64_t)is;
			order[i] = is ? other : one;
			order[low_count] = is ? one : other;
			low_count += is;
			left += c->counts[one] & (uint32_t)mask;
			below |= c->has[one] & mask;
			low |= bit & mask;
			all |= bit;
		}
		const uint64_t lower = (((uint64_t)1 << left) - 1) << place;
		const bool low_wanted = low & c->wanted, high_wanted = all & ~low & c->wanted;
		swap_corners(c, lower & ~below, below & ~lower);
		if (low_wanted && high_wanted &&
			!weld_part(c, first + low_count, count - low_count, place + left, halvings))
			return false;
		first += low_wanted ? 0 : low_count;
		place += low_wanted ? 0 : left;
		count = low_wanted ? low_count : count - low_count;
	}
	/* each has the first of its corners here */
	for (uint32_t i = first; i < first + count; i++)
		c->found[c->order[i]] = c->corners[nt_trailing_zeros(c->has[c->order[i]])];
	return true;
}

/* Vertices farther apart are in two cells, whatever is rounded. If a box is so thin that this is 0, each float has a
 * cell of its own. */
static float reach_of(const nt_grid *grid)
{
	return (grid->high - grid->low) * (2.0f / (float)NT_CELLS);
}

/* Knows the representatives of those of the last triangles' vertices that are alone in their cells: their first
 * corners. If two are not, vertices are likely to lie in rows. */
static void find_alone(few *f)
{
	enum { MOST_IN_ROWS = 2 };
	uint32_t in_rows = 0;
	const float reach = reach_of(&f->grid), *x = f->mesh->positions + f->grid.axis;
	const size_t rows = f->mesh->vertex_count;
	float along[MOST_ROWS];
	for (size_t v = 0; v < rows; v++, x += f->mesh->step)
		along[v] = *x;
	for (size_t v = rows; v % BLOCK != 0; v++)
		along[v] = INFINITY;
	for (uint32_t t = f->count; t-- > 0 && t + LAST >= f->count;)
		for (uint32_t k = 0; k < 3 && in_rows < MOST_IN_ROWS; k++) {
			const uint32_t vertex = f->ids[3 * t + k];
			uint32_t near = 0;
			if (f->high[vertex] != 4 * t + k || f->low[vertex] == f->high[vertex])
				continue;
			const float at = along[vertex];
			for (size_t v = 0; v < rows; v += BLOCK)
				for (size_t i = v; i < v + BLOCK; i++)
					near += fabsf(along[i] - at) <= reach;
			if (near == 1)
				f->low[vertex] = f->high[vertex] = f->first[vertex];
			in_rows += near > 1;
		}
}

/* Lists the vertices of a vertex's cell. Returns how many there are, up to one more than MOST_IN_CELL. */
static uint32_t list_vertices(const few *f, uint32_t vertex, few_cell *cell)
{
	const nt_grid grid = f->grid;
	const float at = nt_welded_position(f->mesh, vertex)[grid.axis], reach = reach_of(&grid);
	const unsigned wanted = nt_grid_cell(&grid, at);
	const float *x = f->mesh->positions + grid.axis;
	uint32_t count = 0;
	for (uint32_t v = 0; v < f->mesh->vertex_count; v++, x += f->mesh->step) {
		if (!(fabsf(*x - at) <= reach) || f->first[v] == NONE || nt_grid_cell(&grid, *x) != wanted)
			continue;
		if (count == MOST_IN_CELL)
			return count + 1;
		cell->names[count] = (uint16_t)v;
		cell->positions[count++] = x - grid.axis;
	}
	return count;
}

/* Gives the corners of a cell's vertices their places. Returns how many there are, or more than MOST_CORNERS. */
static uint32_t place_corners(const few *f, uint32_t count, few_cell *cell)
{
	uint64_t owners[4 * NT_EDGE_FEW / 8]; /* in a byte for each corner one more than its vertex, or 0 */
	uint32_t place = 0;
	memset(owners, 0, (f->count + 1) / 2 * sizeof *owners);
	for (uint32_t i = 0; i < count; i++) {
		uint32_t corners = 0;
		for (uint32_t c = f->first[cell->names[i]]; c != NONE; c = f->next[c], corners++)
			owners[c / 8] |= (uint64_t)(i + 1) << 8 * (c % 8);
		place += corners;
		cell->has[i] = 0;
		cell->counts[i] = (uint16_t)corners;
		cell->order[i] = (uint8_t)i;
	}
	if (place > MOST_CORNERS)
		return place;
	place = 0;
	for (uint32_t c = 0; c < 4 * f->count; c += 8)
		for (uint64_t left = owners[c / 8]; left; place++) {
			const uint32_t bit = (uint32_t)nt_trailing_zeros(left) & ~7u, owner = (left >> bit & 255) - 1;
			left &= ~((uint64_t)255 << bit);
			cell->corners[place] = (uint16_t)(c + bit / 8);
			cell->owners[place] = (uint8_t)owner;
			cell->has[owner] |= (uint64_t)1 << place % 64;
		}
	return place;
}

/* Welds a cell of more corners than a word has bits. False: it has to be halved too often. */
static bool weld_large(few_cell *c, uint32_t count, uint32_t corner_count)
{
	nt_cell_vertex vertices[MOST_IN_CELL];
	nt_cell_corner corners[MOST_CORNERS];
	uint32_t order[MOST_IN_CELL], found[MOST_IN_CELL], swaps[MOST_CORNERS];
	uint8_t below[MOST_IN_CELL], wanted[MOST_IN_CELL];
	for (uint32_t i = 0; i < count; i++) {
		memcpy(vertices[i].position, c->positions[i], sizeof vertices->position);
		vertices[i].corner_count = c->counts[i];
		wanted[i] = c->wanted >> i & 1;
	}
	for (uint32_t i = 0; i < corner_count; i++)
		corners[i] = (nt_cell_corner){c->owners[i], c->corners[i]};
	const nt_cell cell = {vertices, corners, order, swaps, below, wanted, found, count, corner_count};
	if (!nt_weld_cell(&cell))
		return false;
	for (uint32_t i = 0; i < count; i++)
		c->found[i] = (uint16_t)found[i];
	return true;
}

/* Finds the representative of a vertex, and those of the last triangle's vertices in its cell. False: the
 * cell has too many corners, or has to be halved too often. */
static bool find(few *f, uint32_t vertex)
{
	few_cell cell;
	const uint32_t count = list_vertices(f, vertex, &cell);
	const uint32_t corner_count = count > MOST_IN_CELL ? UINT32_MAX : place_corners(f, count, &cell);
	if (corner_count > MOST_CORNERS)
		return false;
	const uint32_t *last = f->ids + 3 * f->count - 3;
	cell.wanted = 0;
	for (uint32_t i = 0; i < count; i++) {
		const uint32_t v = cell.names[i];
		cell.wanted |= (uint64_t)((v == vertex) | (v == last[0]) | (v == last[1]) | (v == last[2])) << i;
	}
	if (corner_count > MOST_IN_CELL ? !weld_large(&cell, count, corner_count) : !weld_part(&cell, 0, count, 0, 0))
		return false;
	for (uint32_t i = 0; i < count; i++)
		if (cell.wanted >> i & 1)
			f->low[cell.names[i]] = f->high[cell.names[i]] = cell.found[i];
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

bool nt_few_edges_are_sorted(const nt_welded_mesh *mesh, bool *limit)
{
	few f;
	if (mesh->triangle_count < NT_LEAST_EDGES) {
		*limit = !nt_grid_of_used(mesh, &f.grid);
		return true;
	}
	f.mesh = mesh;
	f.ids = mesh->triangles->ids;
	f.count = (uint32_t)mesh->triangle_count;
	f.window = f.count > WINDOW ? f.count - WINDOW : 0;
	const bool used = link_corners(&f);
	*limit = !(used && nt_grid_make(mesh, NULL, &f.grid)) && !nt_grid_of_used(mesh, &f.grid);
	if (*limit)
		return true;
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
