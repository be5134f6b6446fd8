/* SPDX-License-Identifier: MIT */
/*
 * Which order has the last run, if it matters (edge_tail.c)? That of the published quicksort, of which only those parts
 * are sorted that hold edges of the run. Its keys are representatives of vertices, which lie between the first and the
 * last corner: that decides most comparisons. The others find representatives, each in its cell.
 */
#include "topology/inside.h"

#include <stdlib.h>
#include <string.h>
#include "base/compiler.h"

#define NONE NT_NO_NEIGHBOUR

/* Edges of eight triangles, and what their keys are between: a block that a pivot is not in is skipped. */
enum { BLOCK_TRIANGLES = 8, BLOCK = 3 * BLOCK_TRIANGLES };

typedef struct block {
	uint32_t least, most;
} block;

/* A vertex of the mesh. */
typedef struct vertex {
	uint32_t least, most; /* what its representative is between; equal: it is this one */
	uint32_t number;      /* in the cells; until then, how many corners it has */
	uint32_t cell;        /* its name; 0: no corners */
} vertex;

/* The array that is sorted. */
typedef struct edge_array {
	const nt_welded_mesh *mesh;
	const nt_grid *grid;
	vertex *vertices;        /* [vertex_count] */
	uint32_t cell_count;     /* of those that have vertices, which are named from 1 on */
	uint32_t used_count;     /* vertices that have corners */
	nt_cells cells;
	bool many;               /* all representatives are to be found before the array is sorted */
	nt_part *parts;          /* [cell_count + 1] by name */
	uint32_t *edges;         /* [count] 3 * triangle + k, from corner k to the next; of none that is degenerate */
	uint32_t *keys;          /* [count] their lower ends, in the place of the corners; NULL: not all are known */
	block *blocks;           /* [count / BLOCK + 1] */
	size_t count;
	bool failed;             /* out of memory, or a limit */
} edge_array;

/* Vertices and corners by cell */

/* Counts the corners of vertices, and finds the first and the last one of each. */
static void count_corners(const nt_welded_mesh *m, vertex *vertices)
{
	for (size_t v = 0; v < m->vertex_count; v++)
		vertices[v] = (vertex){.least = UINT32_MAX};
	for (size_t t = 0; t < m->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = nt_vertices_of(m, t, copy);
		for (unsigned k = 0; k < 3; k++) {
			vertex *one = &vertices[v[k]];
			const uint32_t corner = (uint32_t)nt_triangle_corner(m->triangles, t, k);
			one->least = nt_least_of(one->least, corner);
			one->most = nt_most_of(one->most, corner);
			one->number++;
		}
	}
}

/* If a pivot leaves one of so many vertices open, all of them are found first. */
enum { MANY = 8 };

/* Makes cells of the vertices that have corners. A vertex that is alone in its cell has its first corner. */
static void make_cells(edge_array *e)
{
	const nt_welded_mesh *m = e->mesh;
	uint16_t names[NT_CELLS] = {0};
	struct { uint32_t vertices, corners; } counts[NT_CELLS + 1];
	nt_part next = {.vertex_count = 0};
	uint64_t sum = 0;
	counts[0].vertices = 0;
	for (size_t v = 0; v < m->vertex_count; v++) {
		const unsigned cell = nt_grid_cell(e->grid, m->positions[m->step * v + e->grid->axis]);
		const uint32_t corners = e->vertices[v].number;
		if (corners == 0)
			continue;
		if (names[cell] == 0) {
			names[cell] = (uint16_t)++e->cell_count;
			counts[e->cell_count].vertices = counts[e->cell_count].corners = 0;
		}
		const uint32_t name = names[cell];
		counts[name].vertices++;
		counts[name].corners += corners;
		e->vertices[v].cell = name;
	}
	for (size_t c = 1; c <= e->cell_count; c++) {
		next.vertex_count = counts[c].vertices;
		next.corner_count = counts[c].corners;
		e->parts[c] = next;
		next.vertices += next.vertex_count;
		next.corners += next.corner_count;
	}
	e->used_count = next.vertices;
	for (size_t v = 0; v < m->vertex_count; v++) {
		vertex *one = &e->vertices[v];
		one->most = counts[one->cell].vertices > 1 ? one->most : one->least;
		sum += one->most - one->least;
	}
	/* about so many vertices are open at each pivot */
	e->many = MANY * sum / (3 * m->triangle_count) > e->used_count;
}

static void place_vertices(const edge_array *e, nt_cell_vertex *rows)
{
	const nt_welded_mesh *m = e->mesh;
	uint32_t places[NT_CELLS + 1];
	for (size_t c = 1; c <= e->cell_count; c++)
		places[c] = e->parts[c].vertices;
	for (uint32_t v = 0; v < m->vertex_count; v++) {
		vertex *one = &e->vertices[v];
		if (one->cell == 0)
			continue;
		const uint32_t number = places[one->cell]++;
		memcpy(rows[number].position, nt_welded_position(m, v), sizeof rows->position);
		rows[number].corners = one->number;
		one->number = e->cells.order[number] = number;
	}
}

static void place_corners(const edge_array *e)
{
	const nt_welded_mesh *m = e->mesh;
	const vertex *const vertices = e->vertices;
	nt_cell_corner *const corners = e->cells.corners;
	uint32_t places[NT_CELLS + 1];
	for (size_t c = 1; c <= e->cell_count; c++)
		places[c] = e->parts[c].corners;
	for (size_t t = 0; t < m->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = nt_vertices_of(m, t, copy);
		for (unsigned k = 0; k < 3; k++) {
			const uint32_t corner = (uint32_t)nt_triangle_corner(m->triangles, t, k);
			corners[places[vertices[v[k]].cell]++] = (nt_cell_corner){vertices[v[k]].number, corner};
		}
	}
}

static inline void ends_of(const nt_welded_mesh *m, uint32_t edge, uint32_t ends[2])
{
	uint32_t copy[3];
	const uint32_t *v = nt_vertices_of(m, edge / 3, copy), k = edge % 3;
	ends[0] = v[k];
	ends[1] = v[k < 2 ? k + 1 : 0];
}

static inline block bounds_of(const edge_array *e, size_t place)
{
	uint32_t v[2];
	ends_of(e->mesh, e->edges[place], v);
	const vertex *a = &e->vertices[v[0]], *b = &e->vertices[v[1]];
	return (block){nt_least_of(a->least, b->least), nt_least_of(a->most, b->most)};
}

/* Places vertices and corners in their cells, if they are not there. False when out of memory. */
static bool place(edge_array *e)
{
	const nt_welded_mesh *m = e->mesh;
	uint32_t most_corners = 0;
	if (e->cells.corners)
		return true;
	for (const nt_part *part = e->parts + 1; part <= e->parts + e->cell_count; part++)
		most_corners = nt_most_of(most_corners, part->corner_count);
	nt_cell_corner *corners = nt_scratch_alloc(m->scratch, 3 * m->triangle_count, sizeof *corners);
	nt_cell_vertex *rows = nt_scratch_alloc(m->scratch, e->used_count, sizeof *rows);
	if (!corners || !rows || !nt_cells_make(m->scratch, rows, e->used_count, most_corners, &e->cells))
		return false;
	e->cells.corners = corners;
	place_vertices(e, rows);
	place_corners(e);
	return true;
}

/* Finds all representatives, cell by cell. If one cannot be found, keys are not used, since the run may not need it.
 * False when out of memory. */
static bool find_all(edge_array *e)
{
	nt_cells *c = &e->cells;
	vertex *const vertices = e->vertices;
	bool done = true;
	if (!place(e))
		return false;
	for (nt_part *cell = e->parts + 1; cell <= e->parts + e->cell_count; cell++) {
		if (cell->vertex_count == 1) /* many have one */
			continue;
		/* as corners lie in memory; a cell that has been halved may lack some of its vertices here */
		for (uint32_t i = cell->vertices, end = i + cell->vertex_count; i < end && done; i++)
			done = nt_cells_find(c, cell, i);
	}
	for (size_t v = 0; v < e->mesh->vertex_count && done; v++)
		if (vertices[v].least < vertices[v].most) {
			done = nt_cells_find(c, &e->parts[vertices[v].cell], vertices[v].number);
			if (done)
				vertices[v].least = vertices[v].most = nt_cells_found(c, vertices[v].number);
		}
	c->limit = false;
	e->keys = done ? (uint32_t *)(void *)c->corners : NULL;
	return true;
}

/* Makes the array of edges. Returns what the largest key is at least. */
static uint32_t list_edges(edge_array *e)
{
	const nt_welded_mesh *m = e->mesh;
	const vertex *const vertices = e->vertices;
	uint32_t *const edges = e->edges, *const keys = e->keys, all_least = 0;
	size_t count = 0;
	for (uint32_t t = 0; t < m->triangle_count;) {
		block b = {UINT32_MAX, 0};
		const size_t begin = count;
		for (; count < begin + BLOCK && t < m->triangle_count; t++) {
			uint32_t copy[3], least[3], most[3];
			const uint32_t *v = nt_vertices_of(m, t, copy);
			if (nt_welded_is_degenerate(m, t, v))
				continue;
			for (uint32_t k = 0; k < 3; k++) {
				least[k] = vertices[v[k]].least;
				most[k] = vertices[v[k]].most;
				edges[count + k] = 3 * t + k;
			}
			if (keys) {
				keys[count] = nt_least_of(least[0], least[1]);
				keys[count + 1] = nt_least_of(least[1], least[2]);
				keys[count + 2] = nt_least_of(least[2], least[0]);
			}
			b.least = nt_least_of(b.least, nt_least_of(nt_least_of(least[0], least[1]), least[2]));
			b.most = nt_most_of(b.most, nt_middle_of(most));
			all_least = nt_most_of(all_least, nt_middle_of(least));
			count += 3;
		}
		if (count > begin)
			e->blocks[begin / BLOCK] = b;
	}
	e->count = count;
	return all_least;
}

/* Makes the array. False when out of memory.
 *
 *   asked   the order may matter, so that all representatives are found first if they are many */
static bool make_array(edge_array *e, bool asked, uint32_t *least)
{
	const nt_welded_mesh *m = e->mesh;
	e->edges = nt_scratch_alloc(m->scratch, 3 * m->triangle_count, sizeof *e->edges);
	e->vertices = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *e->vertices);
	e->blocks = nt_scratch_alloc(m->scratch, m->triangle_count / BLOCK_TRIANGLES + 1, sizeof *e->blocks);
	e->parts = nt_scratch_alloc(m->scratch, (m->vertex_count < NT_CELLS ? m->vertex_count : NT_CELLS) + 1,
		sizeof *e->parts);
	if (!e->edges || !e->vertices || !e->blocks || !e->parts)
		return false;
	count_corners(m, e->vertices);
	make_cells(e);
	if (asked && e->many && !find_all(e))
		return false;
	*least = list_edges(e);
	return true;
}

/* Keys */

/* Finds the representative of a vertex, unless that failed before. */
static NT_NOINLINE void find(edge_array *e, vertex *v)
{
	if (v->least == v->most || e->failed)
		return;
	e->failed = !place(e) || !nt_cells_find(&e->cells, &e->parts[v->cell], v->number);
	if (!e->failed)
		v->least = v->most = nt_cells_found(&e->cells, v->number);
}

/* Less than 0: the key is less than the pivot; and so on. If it failed, it is 0. */
static inline NT_ALWAYS_INLINE int compare_key(edge_array *e, size_t place, uint32_t pivot)
{
	uint32_t ends[2], key;
	if (e->keys)
		return (e->keys[place] > pivot) - (e->keys[place] < pivot);
	ends_of(e->mesh, e->edges[place], ends);
	vertex *a = &e->vertices[ends[0]], *b = &e->vertices[ends[1]];
	if (nt_least_of(a->least, b->least) > pivot)
		return 1;
	if (nt_least_of(a->most, b->most) < pivot)
		return -1;
	if (a->least <= pivot && a->most >= pivot)
		find(e, a);
	if (a->least >= pivot && b->least <= pivot && b->most >= pivot)
		find(e, b);
	key = nt_least_of(a->least, b->least);
	return e->failed ? 0 : (key > pivot) - (key < pivot);
}

static uint32_t key_of(edge_array *e, size_t place)
{
	uint32_t ends[2];
	ends_of(e->mesh, e->edges[place], ends);
	vertex *a = &e->vertices[ends[0]], *b = &e->vertices[ends[1]];
	if (a->least < b->most)
		find(e, a);
	if (b->least < a->most)
		find(e, b);
	return nt_least_of(a->least, b->least);
}

/* The largest key, if it is at least `least`, and how many edges have it. */
static uint32_t find_largest(edge_array *e, uint32_t least, size_t *run_count)
{
	*run_count = 0;
	/* the last edges are likely to have it */
	for (size_t b = (e->count + BLOCK - 1) / BLOCK; b-- > 0;) {
		const size_t end = e->count < (b + 1) * BLOCK ? e->count : (b + 1) * BLOCK;
		for (size_t i = b * BLOCK; i < end && e->blocks[b].most >= least && !e->failed; i++) {
			const uint32_t key = bounds_of(e, i).most < least ? 0 : key_of(e, i);
			*run_count = key > least ? 1 : *run_count + (key == least);
			least = nt_most_of(least, key);
		}
	}
	return least;
}

/* The published quicksort */

/* A part of the array that the quicksort has still to sort. */
typedef struct key_range {
	size_t begin, end;
	uint32_t seed;
} key_range;

/* The first in [begin, end) whose key is not less than the pivot; end: there is none. */
static inline NT_ALWAYS_INLINE size_t skip_less(edge_array *e, size_t begin, size_t end, uint32_t pivot)
{
	const uint32_t *const keys = e->keys;
	while (keys && begin < end && keys[begin] < pivot)
		begin++;
	if (keys)
		return begin;
	while (begin < end) {
		const size_t next = (begin / BLOCK + 1) * BLOCK, stop = next < end ? next : end;
		if (e->blocks[begin / BLOCK].most < pivot)
			begin = stop;
		for (; begin < stop; begin++)
			if (compare_key(e, begin, pivot) >= 0)
				return begin;
	}
	return begin;
}

/* The same from the end: behind the last whose key is not greater. */
static inline NT_ALWAYS_INLINE size_t skip_greater(edge_array *e, size_t begin, size_t end, uint32_t pivot)
{
	const uint32_t *const keys = e->keys;
	while (keys && end > begin && keys[end - 1] > pivot)
		end--;
	if (keys)
		return end;
	while (begin < end) {
		const size_t first = (end - 1) / BLOCK * BLOCK, stop = first > begin ? first : begin;
		if (e->blocks[(end - 1) / BLOCK].least > pivot)
			end = stop;
		for (; end > stop; end--)
			if (compare_key(e, end - 1, pivot) <= 0)
				return end;
	}
	return end;
}

/* Adds the edge at a place to its block. */
static inline void widen(edge_array *e, size_t place)
{
	block *to = &e->blocks[place / BLOCK], b = bounds_of(e, place);
	to->least = nt_least_of(to->least, b.least);
	to->most = nt_most_of(to->most, b.most);
}

static inline void swap_numbers(uint32_t *a, uint32_t *b)
{
	const uint32_t swapped = *a;
	*a = *b;
	*b = swapped;
}

static inline void swap_edges(edge_array *e, size_t i, size_t k)
{
	swap_numbers(&e->edges[i], &e->edges[k]);
	if (e->keys)
		swap_numbers(&e->keys[i], &e->keys[k]);
	else {
		widen(e, i);
		widen(e, k);
	}
}

/* The published quicksort's step: smaller keys come before `*left_end`, larger ones from `*right_begin` on. */
static void part_keys(edge_array *e, const key_range *range, uint32_t pivot, size_t *left_end, size_t *right_begin)
{
	size_t left = range->begin, right = range->end; /* the latter one behind the reference's */
	do {
		left = skip_less(e, left, range->end, pivot);
		right = skip_greater(e, range->begin, right, pivot);
		if (left < right)
			swap_edges(e, left++, --right);
	} while (left < right && !e->failed);
	*left_end = right;
	*right_begin = left;
}

/* Sorts as the published file does, but only parts that hold the largest key, whose edges come last. False: that takes
 * more than NT_EDGE_SORT_VISITS, or it failed. */
static bool sort_largest(edge_array *e, uint32_t largest)
{
	/* the smaller part comes first, so that each is half of what waits below it */
	key_range waiting[64] = {{0, e->count, 39871946u}};
	size_t depth = 1, visits = 0;
	while (depth > 0 && !e->failed) {
		key_range range = waiting[--depth];
		const size_t size = range.end - range.begin;
		visits += size;
		if (visits / NT_EDGE_SORT_VISITS > e->count)
			return false;
		if (size == 2 && compare_key(e, range.begin, key_of(e, range.begin + 1)) > 0)
			swap_edges(e, range.begin, range.begin + 1);
		if (size < 3)
			continue;
		const uint32_t turn = range.seed & 31;
		range.seed += (range.seed << turn | range.seed >> ((32 - turn) & 31)) + 3;
		const uint32_t pivot = key_of(e, range.begin + range.seed % (uint32_t)size);
		key_range left = range, right = range;
		part_keys(e, &range, pivot, &left.end, &right.begin);
		if (pivot < largest || skip_less(e, left.begin, left.end, largest) == left.end)
			left.end = left.begin;
		const bool is_left_larger = left.end - left.begin > right.end - right.begin;
		waiting[depth++] = is_left_larger ? left : right;
		waiting[depth++] = is_left_larger ? right : left;
	}
	return !e->failed;
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

/* Pairs the run, the last edges, as published, and as if it were sorted; keeps the edges that differ. False when out of
 * memory. */
static bool pair_both(const nt_welded_mesh *m, uint32_t largest, const uint32_t *last, size_t count,
	nt_unsorted *unsorted)
{
	const uint32_t low = m->triangles->ids[largest];
	unsorted->edges = nt_scratch_alloc(m->scratch, count, sizeof *unsorted->edges);
	run_edge *published = nt_scratch_alloc(m->scratch, count, 2 * sizeof *published);
	if (!published || !unsorted->edges)
		return false;
	run_edge *sorted = published + count;
	for (size_t i = 0; i < count; i++) {
		uint32_t v[2];
		ends_of(m, last[i], v);
		published[i] = (run_edge){last[i], v[v[0] == low], v[0] == low, NONE};
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

/* Finds the order, and what is paired otherwise by it. Not in line: few triangles would have its large frame. */
static nmtan_status NT_NOINLINE pair_as_published(const nt_welded_mesh *m, const nt_grid *grid, bool asked,
	nt_unsorted *unsorted)
{
	edge_array e = {.mesh = m, .grid = grid};
	uint32_t least;
	size_t count;
	if (!make_array(&e, asked, &least))
		return NMTAN_ERROR_MEMORY;
	const uint32_t largest = find_largest(&e, least, &count);
	if (!e.failed && count < NT_LEAST_EDGES)
		return NMTAN_OK;
	if (!e.failed && e.many && !asked) {
		if (!find_all(&e))
			return NMTAN_ERROR_MEMORY;
		list_edges(&e);
	}
	const bool sorted = !e.failed && sort_largest(&e, largest);
	unsorted->limit = !sorted && (!e.failed || e.cells.limit);
	return unsorted->limit || (sorted && pair_both(m, largest, e.edges + e.count - count, count, unsorted))
		? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

nmtan_status nt_find_unsorted(const nt_welded_mesh *mesh, const nt_edge_tail *tail, nt_scratch *memory,
	nt_unsorted *unsorted)
{
	*unsorted = (nt_unsorted){.limit = 3 * mesh->triangle_count > NT_EDGE_SORT_CORNERS};
	if (mesh->triangle_count == 0 || unsorted->limit)
		return NMTAN_OK;
	nt_grid grid;
	nt_edge_answer answer = NT_EDGE_OPEN;
	nmtan_status status = NMTAN_OK;
	const bool few = nt_edge_are_few(mesh), is_known = !few && tail && tail->notes && tail->is_grid_of_used;
	if (few)
		unsorted->limit = !nt_grid_make(mesh, NULL, &grid) && !nt_grid_of_used(mesh, &grid);
	else if (is_known)
		grid = tail->grid;
	if (unsorted->limit || (few && mesh->triangle_count < NT_LEAST_EDGES))
		return NMTAN_OK;
	if ((few || (is_known && mesh->adjacency && !mesh->triangles->cuts)) &&
		nt_edges_are_sorted(mesh, grid, is_known))
		return NMTAN_OK;
	const nt_scratch_mark mark = nt_scratch_here(mesh->scratch);
	if (few)
		(void)nt_grid_of_used(mesh, &grid);
	else
		status = nt_edge_tail_matters(mesh, tail, &grid, &answer, &unsorted->limit);
	nt_scratch_back(mesh->scratch, mark);
	if (status || unsorted->limit || answer == NT_EDGE_NO)
		return status;
	status = pair_as_published(mesh, &grid, answer == NT_EDGE_MAY, unsorted);
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
