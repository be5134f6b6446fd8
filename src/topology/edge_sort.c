/* SPDX-License-Identifier: MIT */
/*
 * Two questions. Does the order of the last run matter? The run belongs to the largest lower end of all edges, the
 * vertex X. If vertices are taken from the largest representative down, X is the first that has an edge with one taken
 * before, a Y. The run has one edge of each triangle that has X and a Y. Its order only matters if it has three edges
 * or more, two of them between the same vertices: nearly always X has one Y, in two triangles.
 *
 * The representative of a vertex is between its first and its last corner. So the last triangles' vertices are looked
 * at, and more of them until an edge of two of them has its lower end among these triangles' corners. If first and last
 * corners leave the answer open, representatives are found from the corners of their cells, the last vertices first.
 *
 * And if it does: which order? That of the published quicksort, of which only those parts are sorted that hold edges of
 * the run.
 */
#include "topology/edge_sort.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>
#include "base/compiler.h"

#define NONE NT_NO_NEIGHBOUR

/* Triangles at the end that are looked at first, and how many times more the next time. */
enum { FIRST = 9, MORE = 4 };

/* Vertices of the last triangles, and triangles with two of them. If there are more, all edges are looked at. */
enum { MOST_MEMBERS = 120, MOST_NEAR = 1024, MOST_PAIRS = 64 };

/* If the order of the last run matters, it has three edges or more. */
enum { LEAST_EDGES = 3 };

static const uint32_t *vertices_of(const nt_welded_mesh *m, size_t triangle, uint32_t copy[3])
{
	return nt_triangle_vertices(m->triangles, triangle, 1, copy);
}

/* The corner of the mesh that is corner k of triangle t: 3 * t + k. */
static uint32_t mesh_corner(const nt_welded_mesh *m, uint32_t corner)
{
	return m->triangles->cuts ? (uint32_t)nt_triangle_corner(m->triangles, corner / 3, corner % 3) : corner;
}

static uint32_t vertex_of(const nt_welded_mesh *m, uint32_t corner)
{
	return m->triangles->ids[mesh_corner(m, corner)];
}

static uint32_t most_of(uint32_t a, uint32_t b)
{
	return a < b ? b : a;
}

static uint32_t least_of(uint32_t a, uint32_t b)
{
	return a < b ? a : b;
}

/* A part of a block of memory. */
static nt_memory take(char **at, size_t count, size_t size)
{
	char *const taken = *at;
	*at += (count * size + 7) / 8 * 8;
	return taken;
}

static size_t cell_bytes(size_t vertices, size_t corners)
{
	return vertices * (2 * sizeof(uint32_t) + 2) + corners * (sizeof(nt_cell_corner) + sizeof(uint32_t)) + 48;
}

/* Room for a cell of so many vertices, which are elsewhere, and corners. */
static nt_cell make_cell(char *at, size_t vertices, size_t corners)
{
	nt_cell cell = {.vertex_count = vertices};
	cell.corners = take(&at, corners, sizeof *cell.corners);
	cell.swaps = take(&at, corners, sizeof *cell.swaps);
	cell.order = take(&at, vertices, sizeof *cell.order);
	cell.found = take(&at, vertices, sizeof *cell.found);
	cell.below = take(&at, vertices, 1);
	cell.wanted = take(&at, vertices, 1);
	return cell;
}

/* Does it matter? */

/* An edge that may be in the run, and in how many triangles. */
typedef struct edge_pair {
	uint32_t low, high, count; /* members */
} edge_pair;

/* Marks of vertices: a member's number, from 1 on, or WATCHED and the slot of a cell; NOBODY: neither. */
enum { NOBODY, WATCHED = 128, NO_SLOT = 255 };

/* Members are vertices of the last triangles, and at the sides of the box. The representative of each is between
 * two corners; if these are equal, it is known. Corners of cells that are watched have numbers 3 * triangle + k. */
typedef struct question {
	const nt_welded_mesh *mesh;
	nt_grid grid;
	bool too_many, is_grid_of_used, is_boxed; /* boxed: no row has a NaN, so that all boxes are right */
	size_t first_triangle;
	uint32_t first;           /* the least corner of the last triangles */
	uint8_t *marks;           /* [vertex_count] */
	uint32_t *numbers;        /* [vertex_count] of those in cells that are watched: the number there */
	nt_cell_corner *corners;  /* [corner_count] of these */
	uint8_t *slots;           /* [corner_count] theirs */
	nt_box *boxes;            /* of blocks of rows */
	size_t corner_count, most_corners;
	nt_cell_corner *by_slot;  /* [corner_count] sorted */
	uint32_t slot_vertices[MOST_MEMBERS], slot_corners[MOST_MEMBERS], slot_begins[MOST_MEMBERS], slot_count;
	uint32_t member_count, vertices[WATCHED];
	uint32_t low[WATCHED], high[WATCHED]; /* first and last corners */
	uint32_t beside[WATCHED]; /* the largest lower end is at least this where the member is the higher end */
	uint8_t member_slots[WATCHED], run[WATCHED]; /* edges that the run may have if the member is the lower end */
	bool may_be_high[WATCHED]; /* whether it may be above the largest lower end */
	uint32_t near_count;
	uint8_t near[MOST_NEAR][3]; /* members of triangles that have two or three, and edges */
} question;

static bool is_known(const question *q, uint32_t member)
{
	return q->low[member] == q->high[member];
}

static void add_member(question *q, uint32_t vertex)
{
	const uint32_t member = ++q->member_count;
	q->vertices[member] = vertex;
	q->low[member] = NONE;
	q->high[member] = 0;
	q->member_slots[member] = NO_SLOT;
	q->marks[vertex] = (uint8_t)member;
}

/* Takes the vertices of the last triangles; halves of a quad stay together. False: they are too many. */
static bool take_last(question *q, size_t triangles)
{
	const nt_welded_mesh *m = q->mesh;
	size_t first = m->triangle_count > triangles ? m->triangle_count - triangles : 0;
	if (first > 0 && nt_is_cut_between(m->triangles, first - 1))
		first--;
	q->first_triangle = first;
	q->first = (uint32_t)nt_triangle_corner(m->triangles, first, 0);
	q->member_count = q->near_count = 0;
	for (size_t t = first; t < m->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++) {
			if (q->marks[v[k]])
				continue;
			if (q->member_count == MOST_MEMBERS)
				return false;
			add_member(q, v[k]);
		}
	}
	return true;
}

/* Notes a triangle that has vertices with marks. */
static NT_NOINLINE void note(question *q, size_t t, const uint32_t *v)
{
	const unsigned marks[3] = {q->marks[v[0]], q->marks[v[1]], q->marks[v[2]]};
	unsigned count = 0;
	for (uint32_t k = 0; k < 3; k++) {
		const unsigned member = marks[k] < WATCHED ? marks[k] : NOBODY;
		const uint32_t corner = (uint32_t)nt_triangle_corner(q->mesh->triangles, t, k);
		q->low[member] = least_of(q->low[member], corner); /* nobody's too, which are not looked at */
		q->high[member] = most_of(q->high[member], corner);
		q->near[q->near_count][k] = (uint8_t)member;
		count += member != NOBODY;
	}
	for (uint32_t k = 0; k < 3; k++) {
		const unsigned slot = marks[k] < WATCHED ? q->member_slots[marks[k]] : marks[k] - WATCHED;
		if (slot == NO_SLOT)
			continue;
		q->too_many |= q->corner_count == q->most_corners;
		if (q->too_many)
			return;
		q->slot_corners[slot]++;
		q->slots[q->corner_count] = (uint8_t)slot;
		q->corners[q->corner_count++] = (nt_cell_corner){q->numbers[v[k]], (uint32_t)(3 * t + k)};
	}
	if (count < 2 || nt_welded_is_degenerate(q->mesh, v))
		return;
	q->too_many |= q->near_count + 1 == MOST_NEAR;
	q->near_count += !q->too_many;
}

static void note_marked(question *q)
{
	const nt_welded_mesh *m = q->mesh;
	const uint8_t *const marks = q->marks;
	const size_t count = m->triangle_count;
	uint32_t copy[3];
	q->corner_count = 0;
	q->low[NOBODY] = 0;
	q->member_slots[NOBODY] = NO_SLOT;
	if (m->triangles->cuts) {
		for (size_t t = 0; t < count && !q->too_many; t++)
			if (vertices_of(m, t, copy) && (marks[copy[0]] | marks[copy[1]] | marks[copy[2]]))
				note(q, t, copy);
		return;
	}
	const uint32_t *v = m->triangles->ids;
	for (size_t t = 0; t < count; t++, v += 3)
		if (marks[v[0]] | marks[v[1]] | marks[v[2]]) {
			note(q, t, v);
			if (q->too_many)
				return;
		}
}

/* Whether one of the cells between two coordinates has a bit. */
static bool has_cells(const uint64_t *bits, const nt_grid *grid, float low, float high)
{
	const unsigned first = nt_grid_cell(grid, low), last = nt_grid_cell(grid, high);
	uint64_t here = bits[first / 64] & ~(uint64_t)0 << first % 64;
	for (unsigned word = first / 64; word < last / 64; here = bits[++word])
		if (here)
			return true;
	return here & ~(uint64_t)0 >> (63 - last % 64);
}

/* Watches the cells of the first members: marks the vertices there. */
static void watch(question *q, size_t member_count)
{
	const nt_welded_mesh *m = q->mesh;
	const nt_grid grid = q->grid;
	const float *const rows = m->positions + grid.axis, last = (float)(NT_CELLS - 1);
	/* a product tells the cell or the one before; if there is no factor, all rows are of one */
	const float quotient = last / (grid.high - grid.low), scale = quotient <= FLT_MAX ? quotient : 0;
	uint64_t cells[NT_CELLS / 64] = {0}, about[NT_CELLS / 64] = {0};
	uint8_t slots[NT_CELLS];
	q->slot_count = 0;
	for (size_t i = 1; i <= member_count; i++) {
		const unsigned c = nt_grid_cell(&grid, rows[m->step * q->vertices[i]]);
		if (!(cells[c / 64] >> c % 64 & 1)) {
			cells[c / 64] |= (uint64_t)1 << c % 64;
			q->slot_vertices[q->slot_count] = q->slot_corners[q->slot_count] = 0;
			slots[c] = (uint8_t)q->slot_count++;
		}
		for (unsigned near = c > 0 ? c - 1 : 0; near <= c + 1 && near < NT_CELLS; near++)
			about[near / 64] |= (uint64_t)1 << near % 64;
	}
	about[0] |= scale == 0;
	for (size_t block = 0; block * NT_BOX_ROWS < m->vertex_count; block++) {
		const nt_box *box = &q->boxes[block];
		if (q->is_boxed && !has_cells(cells, &grid, box->low[grid.axis], box->high[grid.axis]))
			continue;
		size_t v = block * NT_BOX_ROWS;
		const size_t end = m->vertex_count - v < NT_BOX_ROWS ? m->vertex_count : v + NT_BOX_ROWS;
		for (; v < end; v++) {
			const float x = rows[m->step * v], cell = (x - grid.low) * scale;
			const float from_zero = cell > 0.0f ? cell : 0.0f; /* rows without corners may be anywhere */
			const unsigned guess = (unsigned)(int)(from_zero < last ? from_zero : last);
			if (!(about[guess / 64] >> guess % 64 & 1))
				continue;
			const unsigned c = nt_grid_cell(&grid, x);
			if (!(cells[c / 64] >> c % 64 & 1))
				continue;
			q->numbers[v] = q->slot_vertices[slots[c]]++;
			if (q->marks[v])
				q->member_slots[q->marks[v]] = slots[c];
			else
				q->marks[v] = (uint8_t)(WATCHED + slots[c]);
		}
	}
}

/* Sorts the corners that are listed by cell. False when out of memory. */
static bool sort_by_slot(question *q)
{
	uint32_t at[MOST_MEMBERS], sum = 0;
	q->by_slot = nt_scratch_alloc(q->mesh->scratch, q->corner_count, sizeof *q->by_slot);
	for (uint32_t i = 0; i < q->slot_count; i++) {
		q->slot_begins[i] = at[i] = sum;
		sum += q->slot_corners[i];
	}
	for (size_t i = 0; q->by_slot && i < q->corner_count; i++)
		q->by_slot[at[q->slots[i]]++] = q->corners[i];
	return q->by_slot;
}

/* Looks at the last triangles: finds their vertices' first and last corners and the triangles around them, and lists
 * what is in their cells. */
static bool look(question *q, size_t triangles, bool *limit)
{
	const nt_welded_mesh *m = q->mesh;
	bool used = q->is_grid_of_used;
	if (!used)
		used = !(q->is_boxed = nt_grid_make(m, q->boxes, &q->grid));
	for (;; used = true) {
		*limit = used && !q->is_grid_of_used && !nt_grid_of_used(m, &q->grid);
		if (*limit)
			return false;
		memset(q->marks, 0, m->vertex_count);
		q->too_many = !take_last(q, triangles);
		if (q->too_many)
			break;
		/* whether vertices that have corners make the box: these are members */
		const uint32_t count = q->member_count;
		for (int i = 0; i < 6 && !used; i++)
			if (!q->marks[q->grid.extremes[i]])
				add_member(q, q->grid.extremes[i]);
		watch(q, count);
		note_marked(q);
		used = true;
		for (uint32_t i = count + 1; i <= q->member_count; i++)
			used &= q->low[i] != NONE;
		if (used || q->too_many)
			break;
	}
	q->is_grid_of_used = used && !q->too_many;
	return !q->too_many;
}

/* Lists the corners of a cell that is watched. */
static void gather(const question *q, unsigned slot, nt_cell *cell, nt_cell_vertex *rows)
{
	const nt_welded_mesh *m = q->mesh;
	const nt_cell_corner *corners = q->by_slot + q->slot_begins[slot];
	cell->corner_count = q->slot_corners[slot];
	memcpy(cell->corners, corners, cell->corner_count * sizeof *corners);
	for (size_t i = 0; i < cell->corner_count; i++) {
		const nt_cell_corner c = corners[i];
		if (rows[c.vertex].corner_count++ == 0)
			memcpy(rows[c.vertex].position, nt_welded_position(m, vertex_of(m, c.corner)),
				sizeof rows->position);
	}
}

/* Finds the representative of a member. False: out of memory, or its cell cannot be halved so often. */
static bool find_member(question *q, uint32_t member, bool *limit)
{
	const nt_welded_mesh *m = q->mesh;
	const nt_scratch_mark mark = nt_scratch_here(m->scratch);
	const unsigned slot = q->member_slots[member];
	const uint32_t vertices = q->slot_vertices[slot], corners = q->slot_corners[slot];
	nt_cell_vertex *rows = nt_scratch_alloc(m->scratch, 1, vertices * sizeof *rows + cell_bytes(vertices, corners));
	if (!rows)
		return false;
	nt_cell cell = make_cell((char *)(rows + vertices), vertices, corners);
	const uint32_t wanted = q->numbers[q->vertices[member]];
	cell.vertices = rows;
	memset(rows, 0, vertices * sizeof *rows);
	gather(q, slot, &cell, rows);
	memset(cell.wanted, 0, cell.vertex_count);
	cell.wanted[wanted] = 1;
	*limit = !nt_weld_cell(&cell);
	if (!*limit)
		q->low[member] = q->high[member] = mesh_corner(m, cell.found[wanted]);
	nt_scratch_back(m->scratch, mark);
	return !*limit;
}

/* Returns what the largest lower end is at least, and finds which members may be above it. */
static uint32_t find_least(question *q)
{
	uint32_t *const low = q->low, *const beside = q->beside, least = 0;
	low[NOBODY] = q->high[NOBODY] = 0; /* below all */
	for (uint32_t i = 0; i <= q->member_count; i++)
		beside[i] = 0;
	for (uint32_t i = 0; i < q->near_count; i++) {
		const uint8_t a = q->near[i][0], b = q->near[i][1], c = q->near[i][2];
		const uint32_t ab = most_of(low[a], low[b]), below = least_of(low[a], low[b]);
		least = most_of(least, most_of(below, least_of(ab, low[c])));
		beside[a] = most_of(beside[a], most_of(low[b], low[c]));
		beside[b] = most_of(beside[b], most_of(low[a], low[c]));
		beside[c] = most_of(beside[c], ab);
	}
	for (uint32_t i = 0; i <= q->member_count; i++) {
		beside[i] = most_of(beside[i], least);
		q->may_be_high[i] = q->high[i] > beside[i];
		q->run[i] = 0;
	}
	return least;
}

/* Adds an edge that may be in the run. */
static void add_pair(edge_pair *pairs, uint32_t *count, uint32_t low, uint32_t high)
{
	uint32_t p = 0;
	while (p < *count && (pairs[p].low != low || pairs[p].high != high))
		p++;
	if (p == MOST_PAIRS)
		return;
	if (p == *count)
		pairs[(*count)++] = (edge_pair){low, high, 0};
	pairs[p].count++;
}

/* Goes over edges that may be in the run: counts them, or lists those of which there are enough; returns how many are
 * listed, up to MOST_PAIRS. */
static uint32_t pass_pairs(question *q, edge_pair *pairs)
{
	uint32_t count = 0;
	for (uint32_t i = 0; i < q->near_count; i++) {
		const uint8_t *v = q->near[i];
		for (uint32_t k = 0; k < 3; k++) {
			const uint32_t high = v[k], others[2] = {v[k < 2 ? k + 1 : 0], v[k > 0 ? k - 1 : 2]};
			for (int end = 0; end < 2 && q->may_be_high[high]; end++) {
				const uint32_t low = others[end];
				if (low == NOBODY || q->high[low] < q->beside[high])
					continue;
				if (!pairs)
					q->run[low] = (uint8_t)least_of(q->run[low] + 1u, LEAST_EDGES);
				else if (q->run[low] == LEAST_EDGES)
					add_pair(pairs, &count, low, high);
			}
		}
	}
	return count;
}

/* Whether the order may matter: three edges or more, two of them between the same vertices. `unknown` receives a member
 * that decides whether there are such edges, or is left alone. */
static bool may_matter(question *q, uint32_t *unknown)
{
	edge_pair pairs[MOST_PAIRS];
	bool may = false;
	pass_pairs(q, NULL);
	for (uint32_t i = 1; i <= q->member_count; i++)
		may |= q->run[i] == LEAST_EDGES;
	const uint32_t count = may ? pass_pairs(q, pairs) : 0;
	may = count == MOST_PAIRS;
	for (uint32_t i = 0; i < count; i++)
		for (int end = 0; end < 2 && pairs[i].count > 1; end++) {
			const uint32_t member = end ? pairs[i].high : pairs[i].low;
			may = true;
			if (!is_known(q, member) && (*unknown == NOBODY || q->high[member] > q->high[*unknown]))
				*unknown = member;
		}
	return may;
}

typedef enum answer { NO, YES, LOOK_AGAIN } answer;

/* Asks whether the order matters; LOOK_AGAIN: at more triangles. False: a limit, or out of memory. */
static bool ask_members(question *q, answer *result, bool *limit)
{
	for (;;) {
		const uint32_t least = find_least(q);
		const bool is_last = q->first_triangle == 0 || least >= q->first;
		uint32_t unknown = NOBODY;
		*result = !is_last ? LOOK_AGAIN : may_matter(q, &unknown) ? YES : NO;
		/* if none of a pair decides, that of the last corner which may make the least larger */
		uint32_t most = is_last ? least : q->first - 1;
		const bool is_open = *result != NO && unknown == NOBODY;
		for (uint32_t i = 1; i <= q->member_count && is_open; i++)
			if (!is_known(q, i) && q->high[i] > most) {
				most = q->high[i];
				unknown = i;
			}
		if (unknown == NOBODY)
			return true;
		if (!find_member(q, unknown, limit))
			return false;
	}
}

/* Asks with the last triangles, and with more of them, until it is known. */
static bool ask(question *q, answer *result, bool *limit)
{
	*result = YES;
	for (size_t triangles = FIRST;; triangles *= MORE) {
		if (!look(q, triangles, limit))
			return !*limit;
		if (!sort_by_slot(q))
			return false;
		if (!ask_members(q, result, limit))
			return false;
		if (*result != LOOK_AGAIN)
			return true;
	}
}

/* Answers it in memory of the mesh. */
static nmtan_status does_matter(const nt_welded_mesh *m, nt_grid *grid, bool *matters, bool *limit)
{
	enum { LEAST_ROOM = 3 * NT_EDGE_FEW };
	question q;
	*limit = *matters = false;
	if (m->triangle_count < LEAST_EDGES) {
		*limit = !nt_grid_of_used(m, grid);
		return NMTAN_OK;
	}
	q.mesh = m;
	q.is_grid_of_used = false;
	q.most_corners = m->triangle_count + m->triangle_count / 2 + LEAST_ROOM;
	q.marks = nt_scratch_alloc(m->scratch, m->vertex_count, 1);
	q.numbers = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *q.numbers);
	q.corners = nt_scratch_alloc(m->scratch, q.most_corners, sizeof *q.corners);
	q.slots = nt_scratch_alloc(m->scratch, q.most_corners, 1);
	q.boxes = nt_scratch_alloc(m->scratch, m->vertex_count / NT_BOX_ROWS + 1, sizeof *q.boxes);
	if (!q.marks || !q.numbers || !q.corners || !q.slots || !q.boxes)
		return NMTAN_ERROR_MEMORY;
	answer result;
	const bool answered = ask(&q, &result, limit);
	*matters = answered && result != NO;
	if (*matters && !q.is_grid_of_used)
		(void)nt_grid_of_used(m, &q.grid);
	*grid = q.grid;
	return answered || *limit ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

/* Which order? */

/* A vertex's cell, and its number there. */
typedef struct place {
	uint32_t cell, number;
} place;

/* All corners, by cell. */
typedef struct cells {
	const nt_welded_mesh *mesh;
	place *places;           /* [vertex_count] */
	uint32_t vertex_begins[NT_CELLS + 1], corner_begins[NT_CELLS + 1];
	nt_cell_vertex *rows;    /* [vertex_count] by cell */
	uint32_t *vertices;      /* [vertex_count] theirs */
	nt_cell_corner *corners; /* [3 * triangle_count] by cell, in order: 3 * triangle + k */
	bool *is_degenerate;     /* [triangle_count] */
} cells;

/* Turns counts into places of the first of each cell, and one behind the last; returns the largest count. */
static size_t add_up(uint32_t counts[NT_CELLS + 1])
{
	uint32_t most = 0, sum = 0;
	for (size_t c = 0; c <= NT_CELLS; c++) {
		const uint32_t count = counts[c];
		most = most_of(most, count);
		counts[c] = sum;
		sum += count;
	}
	return most;
}

/* Puts vertices into their cells; returns the most that one has. */
static size_t place_vertices(cells *c, const nt_grid *grid)
{
	const nt_welded_mesh *m = c->mesh;
	uint32_t *const counts = c->vertex_begins;
	memset(counts, 0, sizeof c->vertex_begins);
	for (size_t v = 0; v < m->vertex_count; v++) {
		const unsigned cell = nt_grid_cell(grid, m->positions[m->step * v + grid->axis]);
		c->places[v] = (place){cell, counts[cell]++};
	}
	const size_t most = add_up(counts);
	for (size_t v = 0; v < m->vertex_count; v++) {
		const size_t row = counts[c->places[v].cell] + c->places[v].number;
		memcpy(c->rows[row].position, nt_welded_position(m, (uint32_t)v), sizeof c->rows->position);
		c->rows[row].corner_count = 0;
		c->vertices[row] = (uint32_t)v;
	}
	return most;
}

/* Puts corners into their cells, in order, and finds degenerate triangles; returns the most that one cell has. */
static size_t place_corners(cells *c)
{
	const nt_welded_mesh *m = c->mesh;
	uint32_t *const counts = c->corner_begins, at[NT_CELLS], copy[3], cell[3];
	memset(counts, 0, sizeof c->corner_begins);
	for (size_t t = 0; t < m->triangle_count; t++) {
		const uint32_t *v = vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++)
			counts[c->places[v[k]].cell]++;
	}
	const size_t most = add_up(counts);
	memcpy(at, counts, sizeof at);
	for (size_t t = 0; t < m->triangle_count; t++) {
		const uint32_t *v = vertices_of(m, t, copy);
		for (uint32_t k = 0; k < 3; k++) {
			const place to = c->places[v[k]];
			c->corners[at[to.cell]++] = (nt_cell_corner){to.number, (uint32_t)(3 * t + k)};
			cell[k] = to.cell;
		}
		/* vertices at one position are in one cell */
		c->is_degenerate[t] = (cell[0] == cell[1] && nt_welded_are_same(m, v[0], v[1])) ||
			(cell[1] == cell[2] && nt_welded_are_same(m, v[1], v[2])) ||
			(cell[2] == cell[0] && nt_welded_are_same(m, v[2], v[0]));
	}
	return most;
}

/* Finds the representatives of the vertices of all cells. False: one would have to be halved too often. */
static bool weld_cells(const cells *c, nt_cell *cell, uint32_t *found)
{
	for (size_t i = 0; i < NT_CELLS; i++) {
		const size_t row = c->vertex_begins[i], corner = c->corner_begins[i];
		nt_cell_vertex *rows = c->rows + row;
		cell->vertices = rows;
		cell->vertex_count = c->vertex_begins[i + 1] - row;
		cell->corners = c->corners + corner;
		cell->corner_count = c->corner_begins[i + 1] - corner;
		if (cell->vertex_count == 1) { /* many are */
			if (cell->corner_count > 0)
				found[c->vertices[row]] = mesh_corner(c->mesh, cell->corners->corner);
			continue;
		}
		for (size_t k = 0; k < cell->corner_count; k++)
			rows[cell->corners[k].vertex].corner_count++;
		if (cell->corner_count > 0 && !nt_weld_cell(cell))
			return false;
		for (size_t v = 0; v < cell->vertex_count; v++)
			if (rows[v].corner_count > 0)
				found[c->vertices[row + v]] = mesh_corner(c->mesh, cell->found[v]);
	}
	return true;
}

/* Finds the corner of the mesh that stands for each vertex that has some. */
static nmtan_status find_all(
	const nt_welded_mesh *m, const nt_grid *grid, uint32_t *found, bool *is_degenerate, bool *limit)
{
	cells c = {.mesh = m, .is_degenerate = is_degenerate};
	/* first what needs most of what may be left of memory that is lent */
	c.corners = nt_scratch_alloc(m->scratch, 3 * m->triangle_count, sizeof *c.corners);
	c.places = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *c.places);
	c.rows = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *c.rows);
	c.vertices = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *c.vertices);
	if (!c.places || !c.rows || !c.vertices || !c.corners)
		return NMTAN_ERROR_MEMORY;
	const size_t vertices = place_vertices(&c, grid), corners = place_corners(&c);
	char *room = nt_scratch_alloc(m->scratch, 1, cell_bytes(vertices, corners));
	if (!room)
		return NMTAN_ERROR_MEMORY;
	nt_cell cell = make_cell(room, vertices, corners);
	memset(cell.wanted, 1, vertices);
	*limit = !weld_cells(&c, &cell, found);
	return NMTAN_OK;
}

/* Ends of an edge: from corner k of a triangle to the next. */
static void ends_of(const nt_welded_mesh *m, uint32_t edge, uint32_t ends[2])
{
	uint32_t copy[3];
	const uint32_t *v = vertices_of(m, edge / 3, copy), k = edge % 3;
	ends[0] = v[k];
	ends[1] = v[k < 2 ? k + 1 : 0];
}

/* An edge by its lower end. */
typedef struct key_edge {
	uint32_t key, edge;
} key_edge;

/* A part of the array that the quicksort has still to sort. */
typedef struct key_range {
	size_t begin, end;
	uint32_t seed;
} key_range;

/* The published quicksort's step: smaller keys come before `*left_end`, larger ones from `*right_begin` on. */
static void part_keys(key_edge *keys, const key_range *range, uint32_t pivot, size_t *left_end, size_t *right_begin)
{
	size_t left = range->begin, right = range->end; /* the latter one behind the reference's */
	do {
		while (keys[left].key < pivot)
			left++;
		while (keys[right - 1].key > pivot)
			right--;
		if (left < right) {
			const key_edge swapped = keys[left];
			keys[left++] = keys[right - 1];
			keys[--right] = swapped;
		}
	} while (left < right);
	*left_end = right;
	*right_begin = left;
}

static bool has_key(const key_edge *keys, size_t begin, size_t end, uint32_t key)
{
	while (begin < end && keys[begin].key != key)
		begin++;
	return begin < end;
}

/* Sorts as the published file does, but only parts that hold the largest key, whose edges come last. False: that takes
 * more than NT_EDGE_SORT_VISITS. */
static bool sort_largest(key_edge *keys, size_t count, uint32_t largest)
{
	/* the smaller part comes first, so that each is half of what waits below it */
	key_range waiting[64] = {{0, count, 39871946u}};
	size_t depth = 1, visits = 0;
	while (depth > 0) {
		key_range range = waiting[--depth];
		const size_t size = range.end - range.begin;
		visits += size;
		if (visits / NT_EDGE_SORT_VISITS > count)
			return false;
		if (size == 2 && keys[range.begin].key > keys[range.begin + 1].key) {
			const key_edge swapped = keys[range.begin];
			keys[range.begin] = keys[range.begin + 1];
			keys[range.begin + 1] = swapped;
		}
		if (size < 3)
			continue;
		const uint32_t turn = range.seed & 31;
		range.seed += (range.seed << turn | range.seed >> ((32 - turn) & 31)) + 3;
		const uint32_t pivot = keys[range.begin + range.seed % (uint32_t)size].key;
		key_range left = range, right = range;
		part_keys(keys, &range, pivot, &left.end, &right.begin);
		if (pivot < largest || !has_key(keys, left.begin, left.end, largest))
			left.end = left.begin;
		const bool is_left_larger = left.end - left.begin > right.end - right.begin;
		waiting[depth++] = is_left_larger ? left : right;
		waiting[depth++] = is_left_larger ? right : left;
	}
	return true;
}

/* Makes the keys of all edges; returns how many there are. `largest`, and how many have it. */
static size_t make_keys(const nt_welded_mesh *m, const uint32_t *found, const bool *is_degenerate, key_edge *keys,
	uint32_t *largest, size_t *run_count)
{
	size_t key_count = 0;
	*largest = 0;
	*run_count = 0;
	for (size_t t = 0; t < m->triangle_count; t++) {
		uint32_t copy[3], ends[3];
		const uint32_t *v = vertices_of(m, t, copy);
		if (is_degenerate[t])
			continue;
		for (int k = 0; k < 3; k++)
			ends[k] = found[v[k]];
		for (uint32_t k = 0; k < 3; k++) {
			const uint32_t low = least_of(ends[k], ends[k < 2 ? k + 1 : 0]);
			keys[key_count++] = (key_edge){low, (uint32_t)(3 * t + k)};
			if (low >= *largest) {
				*run_count = low > *largest ? 1 : *run_count + 1;
				*largest = low;
			}
		}
	}
	return key_count;
}

/* Edges of the run, in the order of triangles, and then in others. */
typedef struct run_edge {
	uint32_t edge, high; /* high: the vertex of the higher end */
	bool forward;	     /* from the lower end to the higher one */
	uint32_t neighbour;
} run_edge;

static int compare_edges(const void *left, const void *right)
{
	const run_edge *a = left, *b = right;
	return (a->edge > b->edge) - (a->edge < b->edge);
}

static int compare_ends(const void *left, const void *right)
{
	const run_edge *a = left, *b = right;
	return a->high != b->high ? (a->high > b->high) - (a->high < b->high) : compare_edges(a, b);
}

/* Pairs edges between the same two vertices: each takes the first later one that is free and runs the other way, so
 * that the n-th of one direction meets the n-th of the other. */
static void pair_equal(run_edge *edges, size_t count)
{
	size_t forward = 0, backward = 0;
	for (;;) {
		while (forward < count && !edges[forward].forward)
			forward++;
		while (backward < count && edges[backward].forward)
			backward++;
		if (forward == count || backward == count)
			return;
		run_edge *f = &edges[forward++], *b = &edges[backward++];
		f->neighbour = b->edge / 3;
		b->neighbour = f->edge / 3;
	}
}

/* Pairs a run in the order that it is in. Equal edges that are neighbours are sorted by triangle, but for the last of
 * the published sort. */
static void pair_run(run_edge *run, size_t count, bool published)
{
	for (size_t begin = 0, end; begin < count; begin = end) {
		for (end = begin + 1; end < count && run[end].high == run[begin].high; end++)
			continue;
		if (!published || end < count)
			qsort(run + begin, end - begin, sizeof *run, compare_edges);
		pair_equal(run + begin, end - begin);
	}
}

/* Pairs the run, the last keys, as published, and as if it were sorted; keeps the edges that differ. False when out of
 * memory. */
static bool pair_both(const nt_welded_mesh *m, const uint32_t *found, const key_edge *last, size_t count,
	nt_unsorted *unsorted)
{
	unsorted->edges = nt_scratch_alloc(m->scratch, count, sizeof *unsorted->edges);
	run_edge *published = nt_scratch_alloc(m->scratch, count, 2 * sizeof *published);
	if (!published || !unsorted->edges)
		return false;
	run_edge *sorted = published + count;
	for (size_t i = 0; i < count; i++) {
		uint32_t v[2];
		ends_of(m, last[i].edge, v);
		const bool forward = found[v[0]] == last[i].key;
		published[i] = (run_edge){last[i].edge, v[forward], forward, NONE};
	}
	memcpy(sorted, published, count * sizeof *sorted);
	pair_run(published, count, true);
	qsort(published, count, sizeof *published, compare_edges);
	qsort(sorted, count, sizeof *sorted, compare_ends);
	pair_run(sorted, count, false);
	qsort(sorted, count, sizeof *sorted, compare_edges);
	for (size_t i = 0; i < count; i++)
		if (published[i].neighbour != sorted[i].neighbour)
			unsorted->edges[unsorted->count++] = (nt_unsorted_edge){
				published[i].edge, published[i].neighbour};
	return true;
}

/* Finds the order, and what is paired otherwise by it. */
static nmtan_status pair_as_published(const nt_welded_mesh *m, const nt_grid *grid, nt_unsorted *unsorted)
{
	uint32_t *found = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *found);
	bool *is_degenerate = nt_scratch_alloc(m->scratch, m->triangle_count, sizeof *is_degenerate);
	const nt_scratch_mark mark = nt_scratch_here(m->scratch);
	const nmtan_status status = found && is_degenerate
		? find_all(m, grid, found, is_degenerate, &unsorted->limit) : NMTAN_ERROR_MEMORY;
	nt_scratch_back(m->scratch, mark);
	if (status || unsorted->limit)
		return status;
	key_edge *keys = nt_scratch_alloc(m->scratch, 3 * m->triangle_count, sizeof *keys);
	if (!keys)
		return NMTAN_ERROR_MEMORY;
	uint32_t largest;
	size_t count;
	const size_t key_count = make_keys(m, found, is_degenerate, keys, &largest, &count);
	if (count < LEAST_EDGES)
		return NMTAN_OK;
	unsorted->limit = !sort_largest(keys, key_count, largest);
	return unsorted->limit || pair_both(m, found, keys + key_count - count, count, unsorted)
		? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

nmtan_status nt_find_unsorted(const nt_welded_mesh *mesh, nt_scratch *memory, nt_unsorted *unsorted)
{
	*unsorted = (nt_unsorted){.limit = 3 * mesh->triangle_count > NT_EDGE_SORT_CORNERS};
	if (mesh->triangle_count == 0 || unsorted->limit)
		return NMTAN_OK;
	if (mesh->triangle_count <= NT_EDGE_FEW && mesh->vertex_count <= 3 * NT_EDGE_FEW &&
		!mesh->triangles->cuts && nt_few_edges_are_sorted(mesh, &unsorted->limit))
		return NMTAN_OK;
	unsorted->limit = false;
	const nt_scratch_mark mark = nt_scratch_here(mesh->scratch);
	nt_grid grid;
	bool matters;
	nmtan_status status = does_matter(mesh, &grid, &matters, &unsorted->limit);
	nt_scratch_back(mesh->scratch, mark);
	if (status || !matters)
		return status;
	status = pair_as_published(mesh, &grid, unsorted);
	nt_scratch_back(mesh->scratch, mark);
	if (!status && unsorted->count > 0) { /* they are still there, in memory that may be the same */
		const nt_unsorted_edge *edges = unsorted->edges;
		unsorted->edges = nt_scratch_alloc(memory, unsorted->count, sizeof *edges);
		if (unsorted->edges)
			memmove(unsorted->edges, edges, unsorted->count * sizeof *edges);
		status = unsorted->edges ? NMTAN_OK : NMTAN_ERROR_MEMORY;
	}
	return status;
}

bool nt_unsorted_neighbour(const nt_unsorted *unsorted, uint32_t edge, uint32_t *neighbour)
{
	size_t low = 0, high = unsorted->count;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (unsorted->edges[middle].edge < edge)
			low = middle + 1;
		else
			high = middle;
	}
	if (low == unsorted->count || unsorted->edges[low].edge != edge)
		return false;
	*neighbour = unsorted->edges[low].neighbour;
	return true;
}
