/* SPDX-License-Identifier: MIT */
/*
 * Which order has the last run, if it matters (edge_tail.c)? That of the published quicksort, of which only those parts
 * are sorted that hold edges of the run. Its keys are the representatives of all vertices.
 */
#include "topology/edge_parts.h"

#include <stdlib.h>
#include <string.h>
#include "base/compiler.h"
#include "base/parallel.h"

#define NONE NT_NO_NEIGHBOUR

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
	uint32_t *found;         /* [vertex_count] receives representatives */
	nt_cell *rooms;          /* [threads] */
	bool limit;              /* a cell would have to be halved too often */
} cells;

/* Turns counts into places of the first of each cell, and one behind the last; returns the largest count. */
static size_t add_up(uint32_t counts[NT_CELLS + 1])
{
	uint32_t most = 0, sum = 0;
	for (size_t c = 0; c <= NT_CELLS; c++) {
		const uint32_t count = counts[c];
		most = nt_most_of(most, count);
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
		const uint32_t *v = nt_vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++)
			counts[c->places[v[k]].cell]++;
	}
	const size_t most = add_up(counts);
	memcpy(at, counts, sizeof at);
	for (size_t t = 0; t < m->triangle_count; t++) {
		const uint32_t *v = nt_vertices_of(m, t, copy);
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

/* Finds the representatives of the vertices of some cells. False: one would have to be halved too often. */
static bool weld_cells(const cells *c, size_t begin, size_t end, nt_cell *cell)
{
	for (size_t i = begin; i < end; i++) {
		const size_t row = c->vertex_begins[i], corner = c->corner_begins[i];
		nt_cell_vertex *rows = c->rows + row;
		cell->vertices = rows;
		cell->vertex_count = c->vertex_begins[i + 1] - row;
		cell->corners = c->corners + corner;
		cell->corner_count = c->corner_begins[i + 1] - corner;
		if (cell->vertex_count == 1) { /* many are */
			if (cell->corner_count > 0)
				c->found[c->vertices[row]] = nt_mesh_corner(c->mesh, cell->corners->corner);
			continue;
		}
		for (size_t k = 0; k < cell->corner_count; k++)
			rows[cell->corners[k].vertex].corner_count++;
		if (cell->corner_count > 0 && !nt_weld_cell(cell))
			return false;
		for (size_t v = 0; v < cell->vertex_count; v++)
			if (rows[v].corner_count > 0)
				c->found[c->vertices[row + v]] = nt_mesh_corner(c->mesh, cell->found[v]);
	}
	return true;
}

/* Cells that a thread welds at a time, and corners that a thread more should have. */
enum { GROUP = 32, GRAIN = 1 << 16 };

static void weld_group(void *context, size_t group, unsigned slot)
{
	cells *c = context;
	if (!weld_cells(c, group * GROUP, (group + 1) * GROUP, &c->rooms[slot]))
		nt_atomic_store(&c->limit, true, RELAXED);
}

/* Finds the corner of the mesh that stands for each vertex that has some. */
static nmtan_status find_all(
	const nt_welded_mesh *m, const nt_grid *grid, uint32_t *found, bool *is_degenerate, bool *limit)
{
	const unsigned threads = nt_parallel_slots(m->threads, 3 * m->triangle_count, GRAIN);
	cells c = {.mesh = m, .is_degenerate = is_degenerate, .found = found};
	/* first what needs most of what may be left of memory that is lent */
	c.corners = nt_scratch_alloc(m->scratch, 3 * m->triangle_count, sizeof *c.corners);
	c.places = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *c.places);
	c.rows = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *c.rows);
	c.vertices = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *c.vertices);
	c.rooms = nt_scratch_alloc(m->scratch, threads, sizeof *c.rooms);
	if (!c.places || !c.rows || !c.vertices || !c.corners || !c.rooms)
		return NMTAN_ERROR_MEMORY;
	const size_t vertices = place_vertices(&c, grid), corners = place_corners(&c);
	for (unsigned i = 0; i < threads; i++) {
		c.rooms[i] = nt_cell_make(m->scratch, vertices, corners);
		if (!c.rooms[i].order)
			return NMTAN_ERROR_MEMORY;
		memset(c.rooms[i].wanted, 1, vertices);
	}
	nt_parallel_items(threads, (size_t)NT_CELLS / GROUP, weld_group, &c);
	*limit = c.limit;
	return NMTAN_OK;
}

/* Ends of an edge: from corner k of a triangle to the next. */
static void ends_of(const nt_welded_mesh *m, uint32_t edge, uint32_t ends[2])
{
	uint32_t copy[3];
	const uint32_t *v = nt_vertices_of(m, edge / 3, copy), k = edge % 3;
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
		const uint32_t *v = nt_vertices_of(m, t, copy);
		if (is_degenerate[t])
			continue;
		for (int k = 0; k < 3; k++)
			ends[k] = found[v[k]];
		for (uint32_t k = 0; k < 3; k++) {
			const uint32_t low = nt_least_of(ends[k], ends[k < 2 ? k + 1 : 0]);
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
	if (count < NT_LEAST_EDGES)
		return NMTAN_OK;
	unsorted->limit = !sort_largest(keys, key_count, largest);
	return unsorted->limit || pair_both(m, found, keys + key_count - count, count, unsorted)
		? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

nmtan_status nt_find_unsorted(const nt_welded_mesh *mesh, const nt_edge_tail *tail, nt_scratch *memory,
	nt_unsorted *unsorted)
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
	nmtan_status status = nt_edge_tail_matters(mesh, tail, &grid, &matters, &unsorted->limit);
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
