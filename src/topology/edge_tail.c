/* SPDX-License-Identifier: MIT */
/*
 * Does the order of the last run matter? The run belongs to the largest lower end of all edges, the vertex X. If
 * vertices are taken from the largest representative down, X is the first that has an edge with one taken before, a Y.
 * The run has one edge of each triangle that has X and a Y. Its order only matters if it has three edges or more, two
 * of them between the same vertices: nearly always X has one Y, in two triangles.
 *
 * The representative of a vertex is between its first and its last corner. So the last triangles' vertices are looked
 * at, and more of them until an edge of two of them has its lower end among these triangles' corners. If first and last
 * corners leave the answer open, representatives are found from the corners of their cells.
 *
 * That takes the triangles with a corner in one of these cells. The sums note them in passing, since they have every
 * corner's position in lanes.
 */
#include "topology/inside.h"

#include <float.h>
#include <math.h>
#include <string.h>
#include "base/compiler.h"

/* Triangles at the end that are looked at first, and how many times more the next time. SMALL meshes are not looked at
 * again: edge_sort.c finds out. */
enum { FIRST = 9, MORE = 4, SMALL = 4096 };

/* Vertices of the last triangles, and triangles with two of them. If there are more, all edges are looked at. */
enum { MOST_MEMBERS = 120, MOST_NEAR = 1024, MOST_PAIRS = 64 };

/* Notes */

/* The first of so many triangles at the end; halves of a quad stay together. */
static size_t first_of_last(const nt_welded_mesh *m, size_t triangles)
{
	const size_t first = m->triangle_count > triangles ? m->triangle_count - triangles : 0;
	return first - (first > 0 && nt_is_cut_between(m->triangles, first - 1));
}

/* Says which bins the cells of the last triangles' vertices are in. */
static void choose_bins(const nt_welded_mesh *m, size_t first, nt_edge_tail *tail)
{
	const nt_grid *grid = &tail->grid;
	memset(tail->bins, 0, sizeof tail->bins);
	/* a little less than there are, so that no rounding makes one more: less than half a cell */
	tail->scale = ((float)NT_EDGE_BINS - 0.1f) / (grid->high - grid->low);
	tail->scale = tail->scale <= FLT_MAX ? tail->scale : 0;
	tail->bins[0] = tail->scale == 0;
	for (size_t t = first; t < m->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = nt_vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++) {
			const unsigned cell = nt_grid_cell(grid, nt_welded_position(m, v[k])[grid->axis]);
			/* the scale moves the lower one of a bin's cells a little into the bin before */
			const unsigned bin = cell / 2, before = bin - (cell % 2 == 0 && bin > 0);
			tail->bins[bin / 32] |= (uint32_t)1 << bin % 32;
			tail->bins[before / 32] |= (uint32_t)1 << before % 32;
		}
	}
}

nmtan_status nt_edge_tail_make(const nt_welded_mesh *m, const nt_triangle_ranges *ranges, nt_borrowed *memory,
	nt_edge_tail *tail)
{
	tail->notes = NULL;
	tail->ranges = *ranges;
	if (nt_edge_are_few(m) || 3 * m->triangle_count > NT_EDGE_SORT_CORNERS)
		return NMTAN_OK;
	tail->is_grid_of_used = !nt_grid_make(m, tail->extremes, &tail->grid);
	if (tail->is_grid_of_used && !nt_grid_of_used(m, &tail->grid))
		return NMTAN_OK;
	choose_bins(m, first_of_last(m, FIRST), tail);
	tail->notes = nt_borrowed_alloc(memory, m->triangle_count / NT_EDGE_NOTE_LEAST + 2 * ranges->count,
		sizeof *tail->notes);
	return tail->notes ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

/* Notes what the sums have not noted, in the range bounds[0, 1]. */
static void note_all(const nt_welded_mesh *m, const size_t bounds[2], nt_edge_tail *tail)
{
	nt_edge_note *note = tail->notes;
	tail->ranges = (nt_triangle_ranges){.count = 1, .bounds = bounds};
	for (size_t first = 0; first < m->triangle_count; first += NT_EDGE_NOTE_MOST) {
		const size_t left = m->triangle_count - first;
		*note = (nt_edge_note){(uint32_t)first, 0};
		for (size_t i = 0; i < NT_EDGE_NOTE_MOST && i < left; i++) {
			uint32_t copy[3], near = 0;
			const uint32_t *v = nt_vertices_of(m, first + i, copy);
			for (int k = 0; k < 3; k++)
				near |= nt_edge_is_near(tail, nt_welded_position(m, v[k])[tail->grid.axis]);
			note->triangles |= near << i;
		}
		note += note->triangles != 0;
	}
	note->triangles = 0;
}

/* Members */

/* An edge that may be in the run, and in how many triangles. */
typedef struct edge_pair {
	uint32_t low, high, count; /* members */
} edge_pair;

/* Instead of a member's number, from 1 on; instead of a slot. */
enum { NOBODY = 0, NO_SLOT = 255 };

/* The table of members. */
enum { MEMBER_PLACES = 512 };

/* Members are vertices of the last triangles. The representative of each is between two corners; if these are equal, it
 * is known. */
typedef struct question {
	const nt_welded_mesh *mesh;
	nt_edge_tail *tail;
	bool too_many;
	size_t first_triangle;
	uint32_t first;              /* the least corner of the last triangles */
	uint8_t slots[NT_CELLS];     /* of cells */
	uint32_t slot_count, slot_begins[MOST_MEMBERS + 1];
	size_t noted_count;          /* triangles */
	uint32_t *corners;           /* in watched cells, by slot: 3 * triangle + k, ascending; NULL: not listed */
	uint32_t member_count, vertices[MOST_MEMBERS + 1];
	uint8_t firsts[MEMBER_PLACES], next[MOST_MEMBERS + 1]; /* members by the lowest bits of their vertices */
	uint32_t low[MOST_MEMBERS + 1], high[MOST_MEMBERS + 1]; /* first and last corners */
	uint32_t beside[MOST_MEMBERS + 1]; /* the least of the largest lower end if the member is the higher end */
	uint32_t reach[MOST_MEMBERS + 1]; /* the most that the lower ends of its edges may be */
	uint8_t run[MOST_MEMBERS + 1]; /* edges that the run may have if the member is the lower end */
	bool may_be_high[MOST_MEMBERS + 1]; /* whether it may be above the largest lower end */
	uint32_t near_count;
	uint8_t near[MOST_NEAR][3];  /* members of triangles that have two or three, and edges */
} question;

static bool is_known(const question *q, uint32_t member)
{
	return q->low[member] == q->high[member];
}

static uint32_t member_of(const question *q, uint32_t vertex)
{
	uint32_t member = q->firsts[vertex % MEMBER_PLACES];
	while (member != NOBODY && q->vertices[member] != vertex)
		member = q->next[member];
	return member;
}

/* Takes the vertices of the last triangles, and watches their cells. False: they are too many. */
static bool take_last(question *q, size_t triangles)
{
	const nt_welded_mesh *m = q->mesh;
	const nt_grid grid = q->tail->grid;
	q->first_triangle = first_of_last(m, triangles);
	q->first = (uint32_t)nt_triangle_corner(m->triangles, q->first_triangle, 0);
	q->member_count = q->slot_count = 0;
	memset(q->slots, NO_SLOT, sizeof q->slots);
	memset(q->firsts, NOBODY, sizeof q->firsts);
	for (size_t t = q->first_triangle; t < m->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = nt_vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++) {
			if (member_of(q, v[k]) != NOBODY)
				continue;
			if (q->member_count == MOST_MEMBERS)
				return false;
			const uint32_t member = ++q->member_count;
			uint8_t *slot = &q->slots[nt_grid_cell(&grid, nt_welded_position(m, v[k])[grid.axis])];
			uint8_t *other = &q->firsts[v[k] % MEMBER_PLACES];
			*slot = *slot == NO_SLOT ? (uint8_t)q->slot_count++ : *slot;
			q->vertices[member] = v[k];
			q->low[member] = UINT32_MAX;
			q->high[member] = 0;
			q->next[member] = *other;
			*other = (uint8_t)member;
		}
	}
	return true;
}

/* Notes members' first and last corners, and triangles that have two of them. */
static NT_NOINLINE void note_members(question *q, uint32_t t, const uint32_t v[3])
{
	uint32_t count = 0;
	uint8_t *near = q->near[q->near_count];
	for (uint32_t k = 0; k < 3; k++) {
		const uint32_t member = member_of(q, v[k]);
		const uint32_t corner = (uint32_t)nt_triangle_corner(q->mesh->triangles, t, k);
		q->low[member] = nt_least_of(q->low[member], corner); /* nobody's too, which are not looked at */
		q->high[member] = nt_most_of(q->high[member], corner);
		near[k] = (uint8_t)member;
		count += member != NOBODY;
	}
	q->near_count += count > 1 && !nt_welded_is_degenerate(q->mesh, t, v);
	q->too_many |= q->near_count == MOST_NEAR;
}

/* The triangles that are noted, one after the other: begins as {tail}. */
typedef struct noted_triangles {
	const nt_edge_tail *tail;
	const nt_edge_note *next; /* NULL: that of the next range */
	unsigned range;           /* the next one */
	uint32_t first, bits;
} noted_triangles;

static inline NT_ALWAYS_INLINE bool next_noted(noted_triangles *n, uint32_t *triangle)
{
	while (n->bits == 0) {
		if (!n->next) {
			if (n->range == n->tail->ranges.count)
				return false;
			n->next = nt_edge_notes(n->tail, n->range++);
		}
		n->first = n->next->first;
		n->bits = n->next->triangles;
		n->next = n->bits ? n->next + 1 : NULL;
	}
	*triangle = n->first + (uint32_t)nt_trailing_zeros(n->bits);
	n->bits &= n->bits - 1;
	return true;
}

/* Looks for members in the triangles that are noted, and counts these. */
static void note_all_members(question *q)
{
	const uint8_t *const firsts = q->firsts;
	noted_triangles n = {.tail = q->tail};
	q->noted_count = q->near_count = 0;
	for (uint32_t t; next_noted(&n, &t) && !q->too_many; q->noted_count++) {
		uint32_t copy[3];
		const uint32_t *v = nt_vertices_of(q->mesh, t, copy);
		if (firsts[v[0] % MEMBER_PLACES] | firsts[v[1] % MEMBER_PLACES] | firsts[v[2] % MEMBER_PLACES])
			note_members(q, t, v);
	}
}

/* Representatives, as far as they are needed */

/* Lists the corners of all slots, unless they are too many. False when out of memory. */
static bool list_corners(question *q)
{
	const nt_welded_mesh *m = q->mesh;
	const nt_grid grid = q->tail->grid;
	const size_t all = 3 * q->noted_count, enough = m->triangle_count + 3 * NT_EDGE_FEW;
	const size_t most = all < enough ? all : enough;
	uint32_t *const listed = nt_scratch_alloc(m->scratch, 2 * most + 3, sizeof *listed);
	uint8_t *const slots = nt_scratch_alloc(m->scratch, most + 3, 1);
	uint32_t at[NO_SLOT + 1] = {0}, sum = 0;
	size_t count = 0;
	if (!listed || !slots)
		return false;
	noted_triangles n = {.tail = q->tail};
	for (uint32_t t; count <= most && next_noted(&n, &t);) {
		uint32_t copy[3];
		const uint32_t *v = nt_vertices_of(m, t, copy);
		for (uint32_t k = 0; k < 3; k++) {
			const uint8_t slot = q->slots[nt_grid_cell(&grid, nt_welded_position(m, v[k])[grid.axis])];
			listed[count] = 3 * t + k;
			slots[count] = slot;
			count += slot != NO_SLOT;
			at[slot]++;
		}
	}
	q->too_many = count > most;
	if (q->too_many)
		return true;
	for (uint32_t slot = 0; slot <= q->slot_count; slot++) {
		q->slot_begins[slot] = sum;
		sum += at[slot];
		at[slot] = q->slot_begins[slot];
	}
	q->corners = listed + count;
	for (size_t i = 0; i < count; i++)
		q->corners[at[slots[i]]++] = listed[i];
	return true;
}

/* The number of a vertex in a table of those that have one, [mask + 1] of NOBODY; the next one if it has none. */
static uint32_t number_of(uint32_t vertex, uint32_t *table, uint32_t mask, uint32_t *vertices, uint32_t *count)
{
	uint32_t at = (vertex * 0x9e3779b1u >> 7) & mask;
	while (table[at] != NOBODY && vertices[table[at] - 1] != vertex)
		at = (at + 1) & mask;
	if (table[at] == NOBODY) {
		vertices[(*count)++] = vertex;
		table[at] = *count;
	}
	return table[at] - 1;
}

/* Makes the cell of a slot, a part; `vertices` receives the mesh's numbers. False when out of memory. */
static bool make_cell(question *q, unsigned slot, nt_cells *cell, nt_part *all, uint32_t **vertices)
{
	const nt_welded_mesh *m = q->mesh;
	const uint32_t *listed = q->corners + q->slot_begins[slot];
	const uint32_t corner_count = q->slot_begins[slot + 1] - q->slot_begins[slot];
	uint32_t mask = 15, count = 0;
	while (mask < corner_count) /* most have several corners, so that few places are taken */
		mask = 2 * mask + 1;
	nt_cell_corner *corners = nt_scratch_alloc(m->scratch, corner_count, sizeof *corners);
	uint32_t *names = nt_scratch_alloc(m->scratch, (size_t)corner_count + mask + 1, sizeof *names);
	if (!corners || !names)
		return false;
	uint32_t *table = (uint32_t *)memset(names + corner_count, 0, (mask + (size_t)1) * sizeof *table);
	for (size_t i = 0; i < corner_count; i++) {
		const uint32_t corner = nt_mesh_corner(m, listed[i]);
		corners[i] = (nt_cell_corner){number_of(m->triangles->ids[corner], table, mask, names, &count), corner};
	}
	nt_cell_vertex *rows = nt_scratch_alloc(m->scratch, count, sizeof *rows);
	if (!rows || !nt_cells_make(m->scratch, rows, count, corner_count, cell))
		return false;
	for (uint32_t i = 0; i < count; i++) {
		memcpy(rows[i].position, nt_welded_position(m, names[i]), sizeof rows->position);
		rows[i].corners = 0;
		cell->order[i] = i;
	}
	for (size_t i = 0; i < corner_count; i++)
		rows[corners[i].vertex].corners++;
	cell->corners = corners;
	*all = (nt_part){.vertex_count = count, .corner_count = corner_count};
	*vertices = names;
	return true;
}

/* Finds the representatives of all members of a slot. False: out of memory, or its cell cannot be halved so often. */
static bool find_members(question *q, unsigned slot, bool *limit)
{
	const nt_scratch_mark mark = nt_scratch_here(q->mesh->scratch);
	nt_cells cell = {.limit = false};
	nt_part all;
	uint32_t *vertices;
	bool done = make_cell(q, slot, &cell, &all, &vertices);
	for (uint32_t i = 0; done && i < all.vertex_count; i++) {
		const uint32_t member = member_of(q, vertices[i]);
		if (member == NOBODY || is_known(q, member))
			continue;
		done = nt_cells_find(&cell, &all, i);
		q->low[member] = q->high[member] = nt_cells_found(&cell, i);
	}
	*limit = cell.limit;
	nt_scratch_back(q->mesh->scratch, mark);
	return done;
}

/* The answer */

/* Returns what the largest lower end is at least, and finds which members may be above it. */
static uint32_t find_least(question *q)
{
	uint32_t *const low = q->low, *const high = q->high, *const beside = q->beside, least = 0;
	low[NOBODY] = high[NOBODY] = 0; /* below all */
	for (uint32_t i = 0; i <= q->member_count; i++)
		beside[i] = q->reach[i] = 0;
	for (uint32_t i = 0; i < q->near_count; i++)
		for (int k = 0; k < 3; k++) {
			const uint8_t a = q->near[i][k], b = q->near[i][(k + 1) % 3];
			least = nt_most_of(least, nt_least_of(low[a], low[b]));
			beside[a] = nt_most_of(beside[a], low[b]);
			beside[b] = nt_most_of(beside[b], low[a]);
			const uint32_t most = nt_least_of(high[a], high[b]);
			q->reach[a] = nt_most_of(q->reach[a], most);
			q->reach[b] = nt_most_of(q->reach[b], most);
		}
	for (uint32_t i = 0; i <= q->member_count; i++) {
		beside[i] = nt_most_of(beside[i], least);
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
					q->run[low] = (uint8_t)nt_least_of(q->run[low] + 1u, NT_LEAST_EDGES);
				else if (q->run[low] == NT_LEAST_EDGES)
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
		may |= q->run[i] == NT_LEAST_EDGES;
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

/* The member that is not known whose edges may have the largest lower ends; NOBODY: they are not above `most`. */
static uint32_t most_reaching(const question *q, uint32_t most)
{
	uint32_t member = NOBODY;
	for (uint32_t i = 1; i <= q->member_count; i++)
		if (q->reach[i] > most && !is_known(q, i)) {
			most = q->reach[i];
			member = i;
		}
	return member;
}

/* Asks whether the order matters; OPEN: more triangles have to be looked at. False: a limit, or out of memory. */
static bool ask_members(question *q, nt_edge_answer *result, bool *limit)
{
	/* all bounds are looked at after 1, 2, 4 and so on were found */
	for (unsigned batch = 1;; batch *= 2) {
		const uint32_t least = find_least(q);
		const bool is_last = q->first_triangle == 0 || least >= q->first;
		uint32_t unknown = NOBODY;
		*result = !is_last ? NT_EDGE_OPEN : may_matter(q, &unknown) ? NT_EDGE_MAY : NT_EDGE_NO;
		if (*result == NT_EDGE_NO)
			return true;
		/* if none of a pair decides, those that may make the least larger, and most */
		const bool of_pair = unknown != NOBODY;
		unsigned found = 0;
		for (; found < (of_pair ? 1 : batch); found++) {
			if (!of_pair)
				unknown = most_reaching(q, is_last ? least : q->first - 1);
			if (unknown == NOBODY)
				break;
			const float *position = nt_welded_position(q->mesh, q->vertices[unknown]);
			const unsigned slot = q->slots[nt_grid_cell(&q->tail->grid, position[q->tail->grid.axis])];
			if (!q->corners && !list_corners(q))
				return false;
			if (q->too_many)
				return *result = NT_EDGE_MAY, true;
			if (!find_members(q, slot, limit))
				return false;
		}
		if (found == 0)
			return true;
	}
}

/* Asks with the last triangles, and with more of them, until it is known. */
static bool ask(question *q, bool noted, nt_edge_answer *result, bool *limit)
{
	const size_t bounds[2] = {0, q->mesh->triangle_count};
	for (size_t triangles = FIRST;; triangles *= MORE) {
		*result = NT_EDGE_MAY;
		const nt_scratch_mark mark = nt_scratch_here(q->mesh->scratch);
		q->too_many = false;
		q->corners = NULL;
		if (!take_last(q, triangles))
			return true;
		if (triangles > FIRST || !noted) {
			choose_bins(q->mesh, q->first_triangle, q->tail);
			note_all(q->mesh, bounds, q->tail);
		}
		note_all_members(q);
		if (q->too_many)
			return true;
		if (!ask_members(q, result, limit))
			return false;
		if (*result != NT_EDGE_OPEN || q->mesh->triangle_count <= SMALL)
			return true;
		nt_scratch_back(q->mesh->scratch, mark);
	}
}

nmtan_status nt_edge_tail_matters(const nt_welded_mesh *m, const nt_edge_tail *noted, nt_grid *grid,
	nt_edge_answer *answer, bool *limit)
{
	question q;
	nt_edge_tail tail;
	bool is_noted = noted && noted->notes;
	*limit = false;
	*answer = NT_EDGE_NO;
	if (is_noted)
		tail = *noted;
	if (!is_noted || !tail.is_grid_of_used) {
		*limit = !nt_grid_of_used(m, &tail.grid);
		is_noted = is_noted && tail.grid.axis == noted->grid.axis && tail.grid.low == noted->grid.low &&
			tail.grid.high == noted->grid.high;
	}
	*grid = tail.grid;
	if (*limit || m->triangle_count < NT_LEAST_EDGES)
		return NMTAN_OK;
	if (!is_noted)
		tail.notes = nt_scratch_alloc(
			m->scratch, m->triangle_count / NT_EDGE_NOTE_LEAST + 2, sizeof *tail.notes);
	q.mesh = m;
	q.tail = &tail;
	if (!tail.notes || (!ask(&q, is_noted, answer, limit) && !*limit))
		return NMTAN_ERROR_MEMORY;
	return NMTAN_OK;
}
