/* SPDX-License-Identifier: MIT */
/*
 * Two questions. Does the order of the last run matter? Most often it has less than three edges, or no two between the
 * same vertices. The run belongs to the vertex that has the largest lower end of all edges; both ends of its edges
 * have a corner behind that, so that the last triangles are looked at, and more of them until such an edge is
 * among them. The representative of a vertex is one of its corners; only where that leaves the question open is it
 * found, from the corners of its cell.
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

/* Triangles at the end that are looked at first, and how many times more the next time: nearly always a dozen are
 * enough. */
enum { FIRST_TRIANGLES = 12, MORE = 3 };

/* Vertices of the last triangles. If they have more, all edges are looked at. */
enum { MOST_MEMBERS = 255 };

/* If the order of the last run matters, it has three edges or more, one of each of its triangles: the largest lower
 * end is the middle one of their representatives, since another edge has a larger lower end where it is the least. */
enum { LEAST_EDGES = 3 };

static size_t corner_count(const nt_welded_mesh *m)
{
	return 3 * m->triangle_count;
}

static const uint32_t *vertices_of(const nt_welded_mesh *m, size_t triangle, uint32_t copy[3])
{
	return nt_triangle_vertices(m->triangles, triangle, 1, copy);
}

/* The last triangles */

/* Takes triangles from the end; halves of a quad stay together. */
static void take_last(const nt_welded_mesh *m, size_t triangles, nt_edge_tail *tail)
{
	size_t first = m->triangle_count > triangles ? m->triangle_count - triangles : 0;
	if (first > 0 && nt_is_cut_between(m->triangles, first - 1))
		first--;
	tail->triangles = triangles;
	tail->first_triangle = first;
	tail->first = (uint32_t)nt_triangle_corner(m->triangles, first, 0);
}

/* Says which corners to look for: all of the cells of the last triangles' vertices. */
static void watch_cells(const nt_welded_mesh *m, nt_edge_tail *tail)
{
	const nt_grid *grid = &tail->grid;
	memset(tail->bins, 0, sizeof tail->bins);
	/* a little less than there are, so that no rounding makes one more: less than half a cell */
	tail->scale = ((float)NT_EDGE_BINS - 0.1f) / (grid->high - grid->low);
	tail->scale = tail->scale <= FLT_MAX ? tail->scale : 0;
	for (size_t t = tail->first_triangle; t < m->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++) {
			const unsigned cell = nt_grid_cell(grid, nt_welded_position(m, v[k])[grid->axis]);
			/* the scale moves the lower one of a bin's cells a little into the bin before */
			const unsigned bin = cell / 2, before = bin - (cell % 2 == 0 && bin > 0);
			tail->bins[bin / 32] |= (uint32_t)1 << bin % 32;
			tail->bins[before / 32] |= (uint32_t)1 << before % 32;
		}
	}
	if (tail->scale == 0)
		tail->bins[0] |= 1;
}

/* The box of rows that have corners, since others made that of all, or may have. */
static void use_box_of_used(const nt_welded_mesh *m, nt_edge_tail *tail)
{
	tail->is_box_used = true;
	tail->limit = !nt_grid_of_used(m, &tail->grid);
}

static bool is_few(const nt_welded_mesh *m)
{
	return m->triangle_count <= NT_EDGE_FEW && m->vertex_count <= 3 * NT_EDGE_FEW && !m->triangles->cuts;
}

/* Says what to look for first. */
static nmtan_status begin_tail(const nt_welded_mesh *m, nt_borrowed *borrowed, nt_edge_tail *tail)
{
	tail->is_box_used = tail->is_noted = false;
	tail->near = nt_borrowed_alloc(borrowed, m->triangle_count, 1);
	/* the boxes' memory is free again at once */
	const nt_scratch_mark mark = nt_scratch_here(m->scratch);
	nt_borrowed left = *borrowed;
	nt_box *boxes = nt_borrowed_alloc(&left, m->vertex_count / NT_BOX_ROWS + 1, sizeof *boxes);
	if (!boxes || !tail->near)
		return NMTAN_ERROR_MEMORY;
	if (!nt_grid_make(m, boxes, &tail->grid))
		use_box_of_used(m, tail);
	nt_scratch_back(m->scratch, mark);
	if (tail->limit) {
		tail->near = NULL;
		return NMTAN_OK;
	}
	take_last(m, FIRST_TRIANGLES, tail);
	watch_cells(m, tail);
	return NMTAN_OK;
}

nmtan_status nt_edge_tail_make(const nt_welded_mesh *m, nt_borrowed *borrowed, nt_edge_tail *tail)
{
	tail->near = NULL;
	tail->limit = corner_count(m) > NT_EDGE_SORT_CORNERS;
	return is_few(m) || tail->limit ? NMTAN_OK : begin_tail(m, borrowed, tail);
}

/* Their corners */

/* A vertex of the last triangles. */
typedef struct edge_member {
	uint32_t vertex, low, high; /* its representative is between these corners; equal: it is known */
	uint32_t beside;            /* the largest `low` of those that it has an edge with */
	uint32_t met;               /* by which member, and whether twice */
} edge_member;

/* An edge between members a and b. */
typedef struct edge_link {
	uint32_t a, b;
} edge_link;

/* Triangles that are near, with all corners of near vertices and some of others. Their corners are numbered
 * 3 * (place in the list) + k. */
typedef struct question {
	const nt_welded_mesh *mesh;
	nt_edge_tail *tail;
	size_t triangle_count, vertex_count;
	uint32_t *triangles;       /* [triangle_count] ascending */
	uint32_t *vertices;        /* [vertex_count] theirs */
	uint32_t *ids;             /* [3 * triangle_count] the vertex of each corner */
	uint32_t *last;            /* [mesh->vertex_count] the last corner of each vertex, or NONE: it is not listed */
	uint32_t *before;          /* [3 * triangle_count] the one before it at the same vertex, or NONE */
	uint32_t *numbers;         /* [mesh->vertex_count] those of members, or in a cell */
	edge_member *members;      /* [member_count] */
	edge_link *links;          /* [link_count] */
	edge_link *twins;          /* [twin_count] b has two edges or more with a: both ways */
	size_t member_count, link_count, twin_count;
	/* room for cells */
	uint64_t *bits;            /* [bit for each corner]; NULL: not made */
	uint16_t *cells;           /* [vertex_count] */
	uint32_t *heads;           /* [head_mask + 1] the first vertex of cells that have a list together, or NONE */
	uint32_t *next;            /* [vertex_count] */
	size_t head_mask;
	nt_cell_vertex *cell_vertices;
	nt_cell cell;
} question;

static uint32_t mesh_corner(const question *q, uint32_t corner)
{
	return (uint32_t)nt_triangle_corner(q->mesh->triangles, q->triangles[corner / 3], corner % 3);
}

/* Notes which triangles are near, if nobody has, and whether the vertices that make the box have corners. */
static void note_near(const nt_welded_mesh *m, nt_edge_tail *tail)
{
	unsigned met = 0;
	for (size_t t = 0; t < m->triangle_count; t++) {
		uint32_t copy[3], near = 0;
		const uint32_t *v = vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++)
			near |= nt_edge_is_near(tail, nt_welded_position(m, v[k])[tail->grid.axis]);
		tail->near[t] = (uint8_t)near;
		for (int i = 0; i < 18 && !tail->is_box_used; i++)
			met |= (unsigned)(v[i % 3] == tail->grid.extremes[i / 3]) << i / 3;
	}
	tail->is_box_used = tail->is_box_used || met == 63;
	tail->is_noted = true;
}

/* The next triangle from t on that is near. */
static size_t next_near(const nt_welded_mesh *m, const nt_edge_tail *tail, size_t t)
{
	for (uint64_t some; t + sizeof some <= m->triangle_count; t += sizeof some) {
		memcpy(&some, tail->near + t, sizeof some);
		if (some != 0)
			break;
	}
	while (t < m->triangle_count && !tail->near[t])
		t++;
	return t;
}

/* Lists the triangles that are near, and their vertices. False when out of memory. */
static bool list_near(question *q)
{
	const nt_welded_mesh *m = q->mesh;
	const nt_edge_tail *tail = q->tail;
	size_t count = 0;
	for (size_t t = 0; t < m->triangle_count; t++)
		count += tail->near[t];
	q->triangle_count = count;
	q->vertex_count = 0;
	q->last = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *q->last);
	q->numbers = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *q->numbers);
	q->triangles = nt_scratch_alloc(m->scratch, count, sizeof *q->triangles);
	q->vertices = nt_scratch_alloc(m->scratch, 3 * count + 1, sizeof *q->vertices);
	q->ids = nt_scratch_alloc(m->scratch, 3 * count, sizeof *q->ids);
	q->before = nt_scratch_alloc(m->scratch, 3 * count, sizeof *q->before);
	q->bits = NULL;
	if (!q->last || !q->numbers || !q->triangles || !q->vertices || !q->ids || !q->before)
		return false;
	memset(q->last, 0xff, m->vertex_count * sizeof *q->last);
	uint32_t c = 0;
	for (size_t t = next_near(m, tail, 0); t < m->triangle_count; t = next_near(m, tail, t + 1)) {
		uint32_t copy[3];
		const uint32_t *v = vertices_of(m, t, copy);
		q->triangles[c / 3] = (uint32_t)t;
		memcpy(q->ids + c, v, 3 * sizeof *v);
		for (size_t k = 0; k < 3; k++, c++) {
			const uint32_t before = q->last[v[k]];
			q->before[c] = before;
			q->last[v[k]] = c;
			q->vertices[q->vertex_count] = v[k];
			q->vertex_count += before == NONE;
		}
	}
	return true;
}

/* Member i has an edge with one more. */
static void meet(question *q, uint32_t i, uint32_t other)
{
	uint32_t *const met = &q->members[other].met;
	if (*met == 2 * i)
		q->twins[q->twin_count++] = (edge_link){i, other};
	*met = *met >> 1 == i ? 2 * i + 1 : 2 * i;
}

/* Finds between which corners the representatives of the last triangles' vertices are, and the edges between these.
 * False when out of memory. */
static bool link_members(question *q)
{
	const nt_welded_mesh *m = q->mesh;
	/* all of the last triangles are listed, behind the others */
	const size_t tail_count = m->triangle_count - q->tail->first_triangle, corners = 3 * q->triangle_count;
	const uint32_t first = (uint32_t)(corners - 3 * tail_count);
	q->members = nt_scratch_alloc(m->scratch, 3 * tail_count, sizeof *q->members);
	q->links = nt_scratch_alloc(m->scratch, 2 * corners, sizeof *q->links);
	if (!q->members || !q->links)
		return false;
	q->twins = q->links + corners;
	q->member_count = q->link_count = q->twin_count = 0;
	for (uint32_t c = first; c < corners; c++) {
		const uint32_t vertex = q->ids[c];
		if (q->last[vertex] != c)
			continue;
		q->numbers[vertex] = (uint32_t)q->member_count;
		q->members[q->member_count++] = (edge_member){.vertex = vertex, .low = NONE, .met = NONE};
	}
	for (uint32_t i = 0; i < q->member_count; i++) {
		edge_member *const member = &q->members[i];
		for (uint32_t c = q->last[member->vertex]; c != NONE; c = q->before[c]) {
			const uint32_t corner = mesh_corner(q, c), k = c % 3, *const v = q->ids + (c - k);
			const uint32_t next = v[k < 2 ? k + 1 : 0], previous = v[k > 0 ? k - 1 : 2];
			member->low = corner < member->low ? corner : member->low;
			member->high = corner > member->high ? corner : member->high;
			const bool has_next = q->last[next] + 1 > first, has_previous = q->last[previous] + 1 > first;
			if ((!has_next && !has_previous) || nt_welded_is_degenerate(m, v))
				continue;
			if (has_next) {
				q->links[q->link_count++] = (edge_link){i, q->numbers[next]};
				meet(q, i, q->numbers[next]);
			}
			if (has_previous)
				meet(q, i, q->numbers[previous]);
		}
	}
	return true;
}

/* Representatives, as far as they are needed */

/* Makes room for what is in a cell, and lists near vertices by cell. False when out of memory. */
static bool make_cells(question *q)
{
	enum { FEW_HEADS = 64 };
	nt_scratch *scratch = q->mesh->scratch;
	const nt_grid grid = q->tail->grid;
	const size_t corners = 3 * q->triangle_count, heads = q->vertex_count < NT_CELLS ? FEW_HEADS : NT_CELLS;
	q->bits = nt_scratch_alloc(scratch, corners / 64 + 1, sizeof *q->bits);
	q->cell_vertices = nt_scratch_alloc(scratch, q->vertex_count, sizeof *q->cell_vertices);
	uint32_t *room = nt_scratch_alloc(scratch, heads + 2 * q->vertex_count, sizeof *room);
	q->cells = nt_scratch_alloc(scratch, q->vertex_count, sizeof *q->cells + 1);
	nt_cell_corner *list = nt_scratch_alloc(scratch, corners, sizeof *list);
	if (!q->bits || !q->cell_vertices || !room || !q->cells || !list)
		return false;
	q->head_mask = heads - 1;
	q->heads = (uint32_t *)memset(room, 0xff, heads * sizeof *room);
	q->next = room + heads;
	q->cell = (nt_cell){q->cell_vertices, list, q->next + q->vertex_count,
		(uint8_t *)(q->cells + q->vertex_count), 0, 0};
	for (uint32_t i = 0; i < q->vertex_count; i++) {
		const float coordinate = nt_welded_position(q->mesh, q->vertices[i])[grid.axis];
		if (!nt_edge_is_near(q->tail, coordinate))
			continue;
		q->cells[i] = (uint16_t)nt_grid_cell(&grid, coordinate);
		uint32_t *const head = &q->heads[q->cells[i] & q->head_mask];
		q->next[i] = *head;
		*head = i;
	}
	return true;
}

/* Finds the representative of a member. */
static nmtan_status find_member(question *q, edge_member *member)
{
	if (!q->bits && !make_cells(q))
		return NMTAN_ERROR_MEMORY;
	const nt_grid *grid = &q->tail->grid;
	nt_cell *cell = &q->cell;
	const size_t words = 3 * q->triangle_count / 64 + 1;
	const unsigned number = nt_grid_cell(grid, nt_welded_position(q->mesh, member->vertex)[grid->axis]);
	uint32_t wanted = 0, found;
	memset(q->bits, 0, words * sizeof *q->bits);
	cell->vertex_count = cell->corner_count = 0;
	for (uint32_t i = q->heads[number & q->head_mask]; i != NONE; i = q->next[i]) {
		const uint32_t v = q->vertices[i];
		if (q->cells[i] != number)
			continue;
		nt_cell_vertex *vertex = &q->cell_vertices[cell->vertex_count];
		memcpy(vertex->position, nt_welded_position(q->mesh, v), sizeof vertex->position);
		vertex->corner_count = 0;
		for (uint32_t c = q->last[v]; c != NONE; c = q->before[c]) {
			q->bits[c / 64] |= (uint64_t)1 << c % 64;
			vertex->corner_count++;
		}
		wanted = v == member->vertex ? (uint32_t)cell->vertex_count : wanted;
		q->numbers[v] = (uint32_t)cell->vertex_count++;
	}
	for (size_t word = 0; word < words; word++)
		for (uint64_t bits = q->bits[word]; bits; bits &= bits - 1) {
			const uint32_t c = (uint32_t)(64 * word) + (uint32_t)nt_trailing_zeros(bits);
			cell->corners[cell->corner_count++] = (nt_cell_corner){q->numbers[q->ids[c]], c};
		}
	q->tail->limit = !nt_find_representative(cell, wanted, &found);
	if (!q->tail->limit)
		member->low = member->high = mesh_corner(q, found);
	return NMTAN_OK;
}

static bool is_known(const edge_member *member)
{
	return member->low == member->high;
}

/* Whether an edge may be in the last run, with `low` as its lower end, which is at least `least`: no edge of the higher
 * end has a larger lower end than that. */
static bool may_run(const edge_member *low, const edge_member *high, uint32_t least)
{
	return high->high > (low->low > least ? low->low : least) && low->high >= least && high->beside <= low->high;
}

static size_t count_edges(const question *q, uint32_t member, uint32_t least)
{
	size_t count = 0;
	for (const edge_link *l = q->links; l < q->links + q->link_count; l++)
		if (l->a == member || l->b == member)
			count += may_run(&q->members[member], &q->members[l->a == member ? l->b : l->a], least);
	return count;
}

/* How many edges the last run may have if its order matters: three or more, two of them between the same vertices; 0:
 * it cannot. `unknown` receives a member that decides whether there are such edges, or is left alone: of both ends the
 * one with more corners before the end, which is likely to be out of question. */
static size_t most_edges(const question *q, uint32_t least, edge_member **unknown)
{
	size_t most = 0, count = 0;
	uint32_t lowest = NONE, counted = NONE;
	for (const edge_link *l = q->twins; l < q->twins + q->twin_count; l++) {
		edge_member *a = &q->members[l->a], *b = &q->members[l->b];
		if (!may_run(a, b, least))
			continue;
		count = l->a == counted ? count : count_edges(q, l->a, least);
		counted = l->a;
		if (count < LEAST_EDGES)
			continue;
		most = count > most ? count : most;
		edge_member *const one = is_known(b) || (!is_known(a) && a->low < b->low) ? a : b;
		if (!is_known(one) && one->low < lowest) {
			lowest = one->low;
			*unknown = one;
		}
	}
	return most;
}

/* Returns what the largest lower end is at least. */
static uint32_t find_least(const question *q)
{
	edge_member *members = q->members;
	uint32_t least = 0;
	for (size_t i = 0; i < q->member_count; i++)
		members[i].beside = 0;
	for (const edge_link *l = q->links; l < q->links + q->link_count; l++) {
		edge_member *a = &members[l->a], *b = &members[l->b];
		const uint32_t low = a->low < b->low ? a->low : b->low;
		least = low > least ? low : least;
		a->beside = b->low > a->beside ? b->low : a->beside;
		b->beside = a->low > b->beside ? a->low : b->beside;
	}
	return least;
}

/* A member that is not known, of the edge whose lower end may be the largest; NULL: that cannot be as large as one that
 * is known. */
static edge_member *find_open(const question *q, uint32_t least)
{
	edge_member *open = NULL;
	uint32_t most = least;
	for (const edge_link *l = q->links; l < q->links + q->link_count; l++) {
		edge_member *a = &q->members[l->a], *b = &q->members[l->b];
		edge_member *lower = a->high < b->high ? a : b, *other = lower == a ? b : a;
		if (lower->high >= most && !(is_known(a) && is_known(b))) {
			most = lower->high;
			open = is_known(lower) ? other : lower;
		}
	}
	return open;
}

/* Asks whether the order matters; `enough` receives false if more triangles are to be looked at, and `count` how many
 * edges the run has, or 0. */
static nmtan_status ask_members(question *q, bool *enough, size_t *count)
{
	for (;;) {
		const uint32_t least = find_least(q);
		edge_member *unknown = NULL;
		*enough = least >= q->tail->first;
		*count = *enough ? most_edges(q, least, &unknown) : 0;
		if (*enough && *count == 0)
			return NMTAN_OK;
		unknown = unknown ? unknown : find_open(q, least);
		const nmtan_status status = unknown ? find_member(q, unknown) : NMTAN_OK;
		if (status || q->tail->limit || !unknown)
			return status;
	}
}

/* Edges whose lower end is one vertex, in the order of triangles, and then in others. */
typedef struct run_edge {
	uint32_t edge, high; /* high: representative of the higher end */
	bool forward;	     /* from the lower end to the higher one */
	uint32_t neighbour;
} run_edge;

/* Ends of an edge as their representatives. */
static run_edge ends_of(const uint32_t *found, const uint32_t v[3], uint32_t edge, uint32_t *low)
{
	const uint32_t k = edge % 3, tail = found[v[k]], head = found[v[k < 2 ? k + 1 : 0]];
	*low = tail < head ? tail : head;
	return (run_edge){edge, tail < head ? head : tail, tail < head, NONE};
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
static size_t make_keys(
	const nt_welded_mesh *m, const uint32_t *found, key_edge *keys, uint32_t *largest, size_t *run_count)
{
	size_t key_count = 0;
	*largest = 0;
	*run_count = 0;
	for (size_t t = 0; t < m->triangle_count; t++) {
		uint32_t copy[3], low;
		const uint32_t *v = vertices_of(m, t, copy);
		if (nt_welded_is_degenerate(m, v))
			continue;
		for (uint32_t k = 0; k < 3; k++) {
			const uint32_t edge = (uint32_t)(3 * t + k);
			ends_of(found, v, edge, &low);
			keys[key_count++] = (key_edge){low, edge};
			if (low >= *largest) {
				*run_count = low > *largest ? 1 : *run_count + 1;
				*largest = low;
			}
		}
	}
	return key_count;
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
			unsorted->edges[unsorted->count++] = (nt_unsorted_edge){
				published[i].edge, published[i].neighbour};
}

/* The order matters, or may: finds it, with all representatives. */
static nmtan_status pair_as_published(const nt_welded_mesh *m, const nt_grid *grid, nt_unsorted *unsorted)
{
	const nt_scratch_mark mark = nt_scratch_here(m->scratch);
	uint32_t *found = nt_scratch_alloc(m->scratch, m->vertex_count, sizeof *found);
	const nt_representatives_end end = found ? nt_representatives(m, grid, found) : NT_REPRESENTATIVES_NO_MEMORY;
	unsorted->limit = end == NT_REPRESENTATIVES_LIMIT;
	key_edge *keys = end == NT_REPRESENTATIVES_FOUND ? nt_scratch_alloc(m->scratch, corner_count(m), sizeof *keys)
							 : NULL;
	uint32_t copy[3], low, largest;
	size_t count = 0;
	const size_t key_count = keys ? make_keys(m, found, keys, &largest, &count) : 0;
	run_edge *run = keys ? nt_scratch_alloc(m->scratch, count + 1, 3 * sizeof *run) : NULL;
	if (run && count >= LEAST_EDGES)
		unsorted->limit = !sort_largest(keys, key_count, largest);
	for (size_t i = 0; run && i < count; i++) {
		const uint32_t edge = keys[key_count - count + i].edge;
		run[i] = ends_of(found, vertices_of(m, edge / 3, copy), edge, &low);
	}
	if (run && count >= LEAST_EDGES && !unsorted->limit)
		pair_both(run, run + count, run + 2 * count, count, unsorted);
	nt_scratch_back(m->scratch, mark);
	return run || unsorted->limit ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

/* The whole */

/* Lists what is near; if tail->limit, nothing is. */
static nmtan_status look(question *q, size_t triangles)
{
	const nt_welded_mesh *m = q->mesh;
	nt_edge_tail *tail = q->tail;
	if (tail->triangles != triangles) {
		take_last(m, triangles, tail);
		watch_cells(m, tail);
		tail->is_noted = false;
	}
	if (!tail->is_noted)
		note_near(m, tail);
	if (!tail->is_box_used) {
		use_box_of_used(m, tail);
		if (tail->limit)
			return NMTAN_OK;
		watch_cells(m, tail);
		note_near(m, tail);
	}
	return list_near(q) ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

/* Asks whether the order matters; `count` receives how many edges the run has, or may have, or 0. */
static nmtan_status ask(const nt_welded_mesh *m, nt_edge_tail *tail, size_t *count)
{
	question q = {.mesh = m, .tail = tail};
	nt_borrowed none = nt_borrow(NULL, 0, m->scratch);
	if (!tail->near && !tail->limit && !nt_few_edges_are_sorted(m, tail) && begin_tail(m, &none, tail))
		return NMTAN_ERROR_MEMORY;
	if (!tail->near || tail->limit || m->triangle_count < LEAST_EDGES)
		return NMTAN_OK;
	for (size_t triangles = FIRST_TRIANGLES;; triangles *= MORE) {
		bool enough;
		nmtan_status status = look(&q, triangles);
		if (!status && !tail->limit)
			status = link_members(&q) ? ask_members(&q, &enough, count) : NMTAN_ERROR_MEMORY;
		if (status || tail->limit || enough)
			return status;
		*count = m->triangle_count;
		if (MORE * 3 * triangles > MOST_MEMBERS)
			return NMTAN_OK;
	}
}

nmtan_status nt_find_unsorted(const nt_welded_mesh *mesh, nt_edge_tail *tail, nt_scratch *memory, nt_unsorted *unsorted)
{
	*unsorted = (nt_unsorted){.edges = NULL};
	if (mesh->triangle_count == 0)
		return NMTAN_OK;
	const nt_scratch_mark mark = nt_scratch_here(mesh->scratch);
	size_t count = 0;
	nmtan_status status = ask(mesh, tail, &count);
	nt_scratch_back(mesh->scratch, mark);
	unsorted->limit = tail->limit;
	if (status || count == 0 || tail->limit)
		return status;
	unsorted->edges = nt_scratch_alloc(memory, count, sizeof *unsorted->edges);
	return unsorted->edges ? pair_as_published(mesh, &tail->grid, unsorted) : NMTAN_ERROR_MEMORY;
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
