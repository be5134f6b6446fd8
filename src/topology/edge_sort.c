/* SPDX-License-Identifier: MIT */
/*
 * Two questions. Does the order of the last run matter? Most often it has less than three edges, or no two between the
 * same vertices. The run belongs to the vertex that has the largest lower end of all edges; both ends of its edges
 * have a corner behind that, so that the last triangles are looked at, and more of them until such an edge is
 * among them. Their vertices' representatives are found from the corners of the cells that they are in.
 *
 * And if it does: which order? That of the published quicksort, of which only those parts are sorted that hold edges of
 * the run.
 */
#include "topology/edge_sort.h"

#include <stdlib.h>
#include <string.h>
#include "base/compiler.h"

#define NONE NT_NO_NEIGHBOUR

/* Triangles at the end that are looked at first, and how many times more the next time. */
enum { FIRST_TRIANGLES = 4, MORE = 4 };

/* Corners that are looked up at a time. */
enum { BATCH_TRIANGLES = 8, BATCH = 3 * BATCH_TRIANGLES };

enum { MARKS = 1 << 15 };

static size_t corner_count(const nt_welded_mesh *m)
{
	return 3 * m->triangle_count;
}

static bool has(const uint64_t *bits, uint32_t vertex)
{
	return bits[vertex / 64] >> vertex % 64 & 1;
}

static void add(uint64_t *bits, uint32_t vertex)
{
	bits[vertex / 64] |= (uint64_t)1 << vertex % 64;
}

static uint64_t *make_bits(const nt_welded_mesh *m)
{
	const size_t words = m->vertex_count / 64 + 1;
	uint64_t *bits = nt_scratch_alloc(m->scratch, words, sizeof *bits);
	if (bits)
		memset(bits, 0, words * sizeof *bits);
	return bits;
}

static bool is_degenerate(const nt_welded_mesh *m, const uint32_t v[3])
{
	const float *p[3];
	for (int k = 0; k < 3; k++)
		p[k] = nt_welded_position(m, v[k]);
	for (int k = 0; k < 3; k++) {
		const float *a = p[k], *b = p[(k + 1) % 3];
		if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2])
			return true;
	}
	return false;
}

static const uint32_t *vertices_of(const nt_welded_mesh *m, size_t triangle, uint32_t copy[3])
{
	return nt_triangle_vertices(m->triangles, triangle, 1, copy);
}

/* The last run */

/* Edges whose lower end is one vertex, in the order of triangles, and then in others. */
typedef struct run_edge {
	uint32_t edge, high; /* high: representative of the higher end */
	bool forward;        /* from the lower end to the higher one */
	uint32_t neighbour;
} run_edge;

typedef struct question {
	const nt_welded_mesh *mesh;
	nt_grid grid;
	uint32_t first;    /* the least corner of the last triangles */
	uint64_t *last;    /* vertices of the last triangles */
	uint32_t *members; /* [member_count] the same */
	size_t member_count;
	uint64_t *listed;  /* vertices of their cells */
	uint32_t *corners; /* [corner_count] all corners of these, ascending 3 * triangle + k */
	size_t corner_count;
	uint32_t *found;   /* their representatives */
	uint32_t lowest;   /* the largest lower end of an edge between members, or NONE */
	run_edge *run;
	size_t run_count;
	bool limit;
} question;

/* Takes triangles from the end; halves of a quad stay together. */
static bool take_last(question *q, size_t triangles)
{
	const nt_welded_mesh *m = q->mesh;
	size_t first = m->triangle_count > triangles ? m->triangle_count - triangles : 0;
	if (first > 0 && nt_is_cut_between(m->triangles, first - 1))
		first--;
	q->members = nt_scratch_alloc(m->scratch, m->triangle_count - first, 3 * sizeof *q->members);
	q->last = make_bits(m);
	if (!q->members || !q->last)
		return false;
	q->first = (uint32_t)nt_triangle_corner(m->triangles, first, 0);
	q->member_count = 0;
	for (size_t t = first; t < m->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++) {
			if (!has(q->last, v[k]))
				q->members[q->member_count++] = v[k];
			add(q->last, v[k]);
		}
	}
	return true;
}

static bool list_vertices(question *q)
{
	const nt_welded_mesh *m = q->mesh;
	const float *coordinates = m->positions + q->grid.axis;
	uint64_t wanted[NT_CELLS / 64] = {0};
	q->listed = make_bits(m);
	if (!q->listed)
		return false;
	for (size_t i = 0; i < q->member_count; i++)
		add(wanted, nt_grid_cell(&q->grid, coordinates[m->step * q->members[i]]));
	for (size_t v = 0; v < m->vertex_count; v++)
		if (has(wanted, nt_grid_cell(&q->grid, coordinates[m->step * v])))
			add(q->listed, (uint32_t)v);
	/* so that it is known whether they have corners */
	for (int i = 0; i < 6; i++)
		add(q->listed, q->grid.extremes[i]);
	return true;
}

/* Marks vertices in a map of bytes that fits the first-level cache: a byte stands for several vertices. Returns what of
 * a vertex's number is the byte's. */
static uint32_t fill_marks(const question *q, uint8_t marks[MARKS])
{
	uint32_t count = 64;
	while (count < q->mesh->vertex_count && count < MARKS)
		count *= 2;
	memset(marks, 0, count);
	for (size_t word = 0; word <= q->mesh->vertex_count / 64; word++)
		for (uint64_t bits = q->listed[word]; bits; bits &= bits - 1)
			marks[(64 * word + (size_t)nt_trailing_zeros(bits)) & (count - 1)] = 1;
	return count - 1;
}

static inline bool has_marked(const uint8_t marks[MARKS], uint32_t mask, const uint32_t *vertices, size_t count)
{
	unsigned any = 0;
	NT_UNROLL(16)
	for (size_t i = 0; i < count; i++)
		any |= marks[vertices[i] & mask];
	return any;
}

/* Lists at most `capacity` corners of listed vertices; returns how many there are. */
static size_t list_corners(const question *q, uint32_t *corners, size_t capacity)
{
	const nt_welded_mesh *m = q->mesh;
	uint8_t marks[MARKS];
	size_t count = 0;
	const uint32_t mask = fill_marks(q, marks);
	for (size_t t = 0; t < m->triangle_count; t += BATCH_TRIANGLES) {
		uint32_t copy[BATCH];
		const size_t left = m->triangle_count - t, triangles = left < BATCH_TRIANGLES ? left : BATCH_TRIANGLES;
		const uint32_t *v = nt_triangle_vertices(m->triangles, t, triangles, copy);
		if (triangles == BATCH_TRIANGLES && !has_marked(marks, mask, v, BATCH))
			continue;
		for (size_t i = 0; i < 3 * triangles; i++)
			if (marks[v[i] & mask] && has(q->listed, v[i])) {
				if (count < capacity)
					corners[count] = (uint32_t)(3 * t + i);
				count++;
			}
	}
	return count;
}

/* Whether the vertices that make the box have corners. */
static bool is_box_used(const question *q)
{
	const nt_welded_mesh *m = q->mesh;
	unsigned met = 0;
	for (size_t i = 0; i < q->corner_count && met != 63; i++) {
		uint32_t copy[3];
		const uint32_t v = vertices_of(m, q->corners[i] / 3, copy)[q->corners[i] % 3];
		for (unsigned e = 0; e < 6; e++)
			met |= (unsigned)(v == q->grid.extremes[e]) << e;
	}
	return met == 63;
}

/* A mesh of which some rows have no corner: the box is that of the others. False when out of memory. */
static bool make_grid_of_used(question *q)
{
	const nt_welded_mesh *m = q->mesh;
	uint64_t *used = make_bits(m);
	if (!used)
		return false;
	for (size_t t = 0; t < m->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++)
			add(used, v[k]);
	}
	q->limit = !nt_grid_make(m, used, &q->grid);
	return true;
}

/* Lists the corners of the cells of the last triangles' vertices. */
static bool list_cells(question *q)
{
	enum { FIRST_CAPACITY = 1024 };
	size_t capacity = FIRST_CAPACITY;
	if (!list_vertices(q))
		return false;
	for (;;) {
		q->corners = nt_scratch_alloc(q->mesh->scratch, capacity, sizeof *q->corners);
		if (!q->corners)
			return false;
		q->corner_count = list_corners(q, q->corners, capacity);
		if (q->corner_count <= capacity)
			return true;
		capacity = q->corner_count;
	}
}

static nmtan_status find_representatives(const nt_welded_mesh *m, const nt_grid *grid, const uint32_t *corners,
	size_t count, uint32_t **found, bool *limit)
{
	*found = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof **found);
	const nt_representatives_end end =
		*found ? nt_representatives(m, grid, corners, count, *found) : NT_REPRESENTATIVES_NO_MEMORY;
	*limit |= end == NT_REPRESENTATIVES_LIMIT;
	return end == NT_REPRESENTATIVES_NO_MEMORY ? NMTAN_ERROR_MEMORY : NMTAN_OK;
}

/* Ends of an edge as their representatives. */
static run_edge ends_of(const uint32_t *found, const uint32_t v[3], uint32_t edge, uint32_t *low)
{
	const uint32_t k = edge % 3, tail = found[v[k]], head = found[v[k < 2 ? k + 1 : 0]];
	*low = tail < head ? tail : head;
	return (run_edge){edge, tail < head ? head : tail, tail < head, NONE};
}

/* Finds the largest lower end of edges between the last triangles' vertices, and lists its edges. */
static bool list_run(question *q)
{
	const nt_welded_mesh *m = q->mesh;
	q->run = nt_scratch_alloc(m->scratch, q->corner_count, sizeof *q->run);
	if (!q->run)
		return false;
	q->lowest = NONE;
	q->run_count = 0;
	for (size_t i = 0; i < q->corner_count; i++) {
		const uint32_t edge = q->corners[i];
		uint32_t copy[3], low;
		const uint32_t *v = vertices_of(m, edge / 3, copy);
		if (!has(q->last, v[edge % 3]) || !has(q->last, v[(edge + 1) % 3]) || is_degenerate(m, v))
			continue;
		const run_edge e = ends_of(q->found, v, edge, &low);
		if (q->lowest == NONE || low > q->lowest) {
			q->lowest = low;
			q->run_count = 0;
		}
		if (low == q->lowest)
			q->run[q->run_count++] = e;
	}
	return true;
}

/* One try with so many triangles; `run` is not NULL where they were enough. */
static nmtan_status try_last(question *q, size_t triangles)
{
	nmtan_status status = NMTAN_ERROR_MEMORY;
	q->run = NULL;
	if (!take_last(q, triangles) || !list_cells(q))
		return status;
	if (!is_box_used(q)) {
		if (!make_grid_of_used(q))
			return status;
		if (q->limit)
			return NMTAN_OK;
		if (!list_cells(q))
			return status;
	}
	status = find_representatives(q->mesh, &q->grid, q->corners, q->corner_count, &q->found, &q->limit);
	if (status || q->limit)
		return status;
	if (!list_run(q))
		return NMTAN_ERROR_MEMORY;
	if (q->first > 0 && (q->lowest == NONE || q->lowest < q->first))
		q->run = NULL;
	return NMTAN_OK;
}

/* Pairs */

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

/* Whether the order may matter. */
static bool has_equal(const run_edge *run, size_t count)
{
	for (size_t i = 1; i < count; i++)
		if (run[i].high == run[i - 1].high)
			return count > 2;
	return false;
}

/* The published order */

typedef struct key_edge {
	uint32_t key, edge;
} key_edge;

/* A part of the array that the quicksort has still to sort. */
typedef struct key_range {
	size_t begin, end;
	uint32_t seed;
} key_range;

/* The published quicksort's step: smaller keys come before `*left_end`, larger ones from `*right_begin` on. */
static void part_keys(key_edge *keys, const key_range *range, uint32_t pivot, size_t *left_end,
	size_t *right_begin)
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

/* Puts the run, of `count` edges, into the published order. False: out of memory. */
static bool order_run(const nt_welded_mesh *m, const uint32_t *found, run_edge *run, size_t count, bool *limit)
{
	key_edge *keys = nt_scratch_alloc(m->scratch, corner_count(m), sizeof *keys);
	if (!keys)
		return false;
	size_t key_count = 0;
	uint32_t copy[3], low, largest = 0;
	for (size_t t = 0; t < m->triangle_count; t++) {
		const uint32_t *v = vertices_of(m, t, copy);
		if (is_degenerate(m, v))
			continue;
		for (uint32_t k = 0; k < 3; k++) {
			const uint32_t edge = (uint32_t)(3 * t + k);
			ends_of(found, v, edge, &low);
			keys[key_count++] = (key_edge){low, edge};
			largest = low > largest ? low : largest;
		}
	}
	*limit = !sort_largest(keys, key_count, largest);
	for (size_t i = 0; i < count; i++) {
		const uint32_t edge = keys[key_count - count + i].edge;
		run[i] = ends_of(found, vertices_of(m, edge / 3, copy), edge, &low);
	}
	return true;
}

/* Pairs the run as published, and as if it were sorted; keeps the edges that differ. */
static void pair_both(const run_edge *run, run_edge *published, run_edge *sorted, size_t count, nt_unsorted *unsorted)
{
	memcpy(published, run, count * sizeof *run);
	memcpy(sorted, run, count * sizeof *run);
	pair_run(published, count, true);
	qsort(published, count, sizeof *published, compare_edges);
	qsort(sorted, count, sizeof *sorted, compare_ends);
	pair_run(sorted, count, false);
	qsort(sorted, count, sizeof *sorted, compare_edges);
	for (size_t i = 0; i < count; i++)
		if (published[i].neighbour != sorted[i].neighbour)
			unsorted->edges[unsorted->count++] =
				(nt_unsorted_edge){published[i].edge, published[i].neighbour};
}

/* The order matters: finds it, with all representatives. `count`: edges of the run. */
static nmtan_status pair_as_published(const nt_welded_mesh *m, const nt_grid *grid, size_t count,
	nt_unsorted *unsorted)
{
	run_edge *run = nt_scratch_alloc(m->scratch, count, 3 * sizeof *run);
	if (!run)
		return NMTAN_ERROR_MEMORY;
	const nt_scratch_mark mark = nt_scratch_here(m->scratch);
	uint32_t *found;
	nmtan_status status = find_representatives(m, grid, NULL, corner_count(m), &found, &unsorted->limit);
	if (!status && !unsorted->limit && !order_run(m, found, run, count, &unsorted->limit))
		status = NMTAN_ERROR_MEMORY;
	nt_scratch_back(m->scratch, mark);
	if (!status && !unsorted->limit)
		pair_both(run, run + count, run + 2 * count, count, unsorted);
	return status;
}

/* Where the order of the last run matters, it has three edges or more, one of each of its triangles: the largest lower
 * end is the middle one of their representatives, since another edge has a larger lower end where it is the least. */
enum { LEAST_TRIANGLES = 3 };

/* Asks whether the order matters; `count` receives the edges of the run, or 0. */
static nmtan_status ask(const nt_welded_mesh *m, nt_grid *grid, size_t *count, bool *limit)
{
	question q = {.mesh = m};
	if (!nt_grid_make(m, NULL, &q.grid) && !make_grid_of_used(&q))
		return NMTAN_ERROR_MEMORY;
	if (m->triangle_count < LEAST_TRIANGLES) {
		*limit = q.limit;
		return NMTAN_OK;
	}
	const nt_scratch_mark mark = nt_scratch_here(m->scratch);
	for (size_t triangles = FIRST_TRIANGLES; !q.run && !q.limit; triangles *= MORE) {
		nt_scratch_back(m->scratch, mark);
		const nmtan_status status = try_last(&q, triangles);
		if (status)
			return status;
	}
	*limit = q.limit;
	*grid = q.grid;
	if (q.limit)
		return NMTAN_OK;
	const size_t run_count = q.run_count;
	qsort(q.run, run_count, sizeof *q.run, compare_ends);
	*count = has_equal(q.run, run_count) ? run_count : 0;
	return NMTAN_OK;
}

nmtan_status nt_find_unsorted(const nt_welded_mesh *mesh, nt_scratch *memory, nt_unsorted *unsorted)
{
	*unsorted = (nt_unsorted){.limit = corner_count(mesh) > NT_EDGE_SORT_CORNERS};
	if (mesh->triangle_count == 0 || unsorted->limit)
		return NMTAN_OK;
	const nt_scratch_mark mark = nt_scratch_here(mesh->scratch);
	nt_grid grid;
	size_t count = 0;
	const nmtan_status status = ask(mesh, &grid, &count, &unsorted->limit);
	nt_scratch_back(mesh->scratch, mark);
	if (status || count == 0)
		return status;
	unsorted->edges = nt_scratch_alloc(memory, count, sizeof *unsorted->edges);
	return unsorted->edges ? pair_as_published(mesh, &grid, count, unsorted) : NMTAN_ERROR_MEMORY;
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
