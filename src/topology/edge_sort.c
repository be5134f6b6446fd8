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
 * enough. In few triangles everything is near, and to look again costs little. */
enum { FIRST_TRIANGLES = 12, FIRST_OF_FEW = 4, MORE = 3 };

/* So few triangles have all corners listed. */
enum { LEAST_WATCHED = 16, FEW = 1024 };

/* Vertices of the last triangles. If they have more, all edges are looked at. */
enum { MOST_MEMBERS = 255, LEAST_SLOT_BITS = 6 };

/* If the order of the last run matters, it has three edges or more, one of each of its triangles: the largest lower
 * end is the middle one of their representatives, since another edge has a larger lower end where it is the least. */
enum { LEAST_EDGES = 3 };

static size_t corner_count(const nt_welded_mesh *m)
{
	return 3 * m->triangle_count;
}

static bool has(const uint64_t *bits, uint32_t bit)
{
	return bits[bit / 64] >> bit % 64 & 1;
}

static void add(uint64_t *bits, uint32_t bit)
{
	bits[bit / 64] |= (uint64_t)1 << bit % 64;
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

/* The last triangles */

/* The place of a member's number, or NONE. */
static uint32_t *slot_of(const nt_edge_tail *tail, uint32_t vertex)
{
	uint32_t at = vertex * 0x9e3779b1u >> tail->slot_shift;
	while (tail->slots[at] != NONE && tail->members[tail->slots[at]].vertex != vertex)
		at = (at + 1) & (UINT32_MAX >> tail->slot_shift);
	return &tail->slots[at];
}

/* Takes triangles from the end; halves of a quad stay together. False when out of memory. */
static bool take_last(const nt_welded_mesh *m, size_t triangles, nt_edge_tail *tail)
{
	size_t first = m->triangle_count > triangles ? m->triangle_count - triangles : 0;
	if (first > 0 && nt_is_cut_between(m->triangles, first - 1))
		first--;
	const size_t most = 3 * (m->triangle_count - first);
	unsigned bits = LEAST_SLOT_BITS;
	while ((size_t)1 << bits < 2 * most)
		bits++;
	tail->slot_shift = 32 - bits;
	tail->slots = nt_scratch_alloc(m->scratch, (size_t)1 << bits, sizeof *tail->slots);
	tail->members = nt_scratch_alloc(m->scratch, most, sizeof *tail->members);
	tail->are_members = make_bits(m);
	if (!tail->members || !tail->slots || !tail->are_members)
		return false;
	memset(tail->slots, 0xff, sizeof *tail->slots << bits);
	tail->triangles = triangles;
	tail->first = (uint32_t)nt_triangle_corner(m->triangles, first, 0);
	tail->member_count = 0;
	for (size_t t = first; t < m->triangle_count; t++) {
		uint32_t copy[3];
		const uint32_t *v = vertices_of(m, t, copy);
		for (int k = 0; k < 3; k++) {
			uint32_t *slot = slot_of(tail, v[k]);
			if (*slot == NONE) {
				*slot = (uint32_t)tail->member_count;
				tail->members[tail->member_count++] = (nt_edge_member){.vertex = v[k], .low = NONE};
				add(tail->are_members, v[k]);
			}
		}
	}
	return true;
}

/* Says which corners to look for: all of the members' cells. */
static void watch_cells(const nt_welded_mesh *m, nt_edge_tail *tail)
{
	const nt_grid *grid = &tail->grid;
	memset(tail->bins, 0, sizeof tail->bins);
	/* a little less than there are, so that no rounding makes one more: less than half a cell */
	tail->scale = ((float)NT_EDGE_BINS - 0.1f) / (grid->high - grid->low);
	tail->scale = tail->scale <= FLT_MAX ? tail->scale : 0;
	for (size_t i = 0; i < tail->member_count; i++) {
		const unsigned cell = nt_grid_cell(grid, nt_welded_position(m, tail->members[i].vertex)[grid->axis]);
		const unsigned bin = cell / 2, beside = cell % 2 ? bin + 1 : bin - 1;
		tail->bins[bin / 32] |= (uint32_t)1 << bin % 32;
		if (beside < NT_EDGE_BINS)
			tail->bins[beside / 32] |= (uint32_t)1 << beside % 32;
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

static size_t first_triangles(const nt_welded_mesh *m)
{
	return m->triangle_count < FEW ? FIRST_OF_FEW : FIRST_TRIANGLES;
}

nmtan_status nt_edge_tail_make(const nt_welded_mesh *m, nt_borrowed *borrowed, nt_edge_tail *tail)
{
	*tail = (nt_edge_tail){.limit = corner_count(m) > NT_EDGE_SORT_CORNERS};
	if (m->triangle_count < LEAST_WATCHED || tail->limit)
		return NMTAN_OK;
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
	if (!take_last(m, first_triangles(m), tail))
		return NMTAN_ERROR_MEMORY;
	watch_cells(m, tail);
	return NMTAN_OK;
}

/* Their corners */

/* An edge between members a and b. */
typedef struct edge_link {
	uint32_t a, b;
} edge_link;

typedef struct question {
	const nt_welded_mesh *mesh;
	nt_edge_tail *tail;
	nt_welded_corner *corners; /* [corner_count] as 3 * triangle + k, ascending */
	uint16_t *cells;           /* [corner_count] of each */
	uint32_t *next;            /* [corner_count] the next one of the cells that have a list together, or NONE */
	uint32_t *heads;           /* [head_mask + 1] the first one */
	size_t corner_count, head_mask;
	nt_welded_corner *chosen;  /* [corner_count] those of one cell; NULL: not made */
	nt_welded_point *points;   /* [corner_count] */
	edge_link *links;               /* [link_count] */
	size_t link_count;
} question;

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
}

/* The next triangle from t on that is near. */
static size_t next_near(const nt_welded_mesh *m, const nt_edge_tail *tail, size_t t)
{
	if (!tail->near)
		return t;
	for (uint64_t some; t + sizeof some <= m->triangle_count; t += sizeof some) {
		memcpy(&some, tail->near + t, sizeof some);
		if (some != 0)
			break;
	}
	while (t < m->triangle_count && !tail->near[t])
		t++;
	return t;
}

/* Coordinates whose cells are found at a time, and lists of corners by cell if there are few. */
enum { STEP = 16, FEW_HEADS = 64 };

/* Lists the corners that are near, or all of few triangles. False when out of memory. */
static bool list_corners(question *q)
{
	const nt_welded_mesh *m = q->mesh;
	nt_edge_tail *tail = q->tail;
	if (tail->near && !tail->is_noted)
		note_near(m, tail);
	size_t most = tail->near ? 0 : m->triangle_count;
	for (size_t t = 0; tail->near && t < m->triangle_count; t++)
		most += tail->near[t];
	float *coordinates = nt_scratch_alloc(m->scratch, 3 * most + STEP, sizeof *coordinates);
	q->corners = nt_scratch_alloc(m->scratch, 3 * most + STEP, sizeof *q->corners);
	q->cells = nt_scratch_alloc(m->scratch, 3 * most + STEP, sizeof *q->cells);
	q->next = nt_scratch_alloc(m->scratch, 3 * most + STEP, sizeof *q->next);
	q->head_mask = (3 * most < NT_CELLS ? FEW_HEADS : NT_CELLS) - 1;
	q->heads = nt_scratch_alloc(m->scratch, q->head_mask + 1, sizeof *q->heads);
	q->chosen = NULL;
	if (!coordinates || !q->corners || !q->cells || !q->next || !q->heads)
		return false;
	const nt_grid grid = tail->grid;
	size_t count = 0;
	for (size_t t = next_near(m, tail, 0); t < m->triangle_count; t = next_near(m, tail, t + 1)) {
		uint32_t copy[3];
		const uint32_t *v = vertices_of(m, t, copy);
		for (uint32_t k = 0; k < 3; k++) {
			q->corners[count] = (nt_welded_corner){v[k], (uint32_t)(3 * t) + k};
			coordinates[count] = nt_welded_position(m, v[k])[grid.axis];
			count += !tail->near || nt_edge_is_near(tail, coordinates[count]);
		}
	}
	for (size_t i = 0; i < STEP; i++)
		coordinates[count + i] = grid.low;
	for (size_t i = 0; i < count; i += STEP)
		for (size_t k = 0; k < STEP; k++)
			q->cells[i + k] = (uint16_t)nt_grid_cell(&grid, coordinates[i + k]);
	q->corner_count = count;
	memset(q->heads, 0xff, (q->head_mask + 1) * sizeof *q->heads);
	for (size_t i = count; i-- > 0;) {
		uint32_t *head = &q->heads[q->cells[i] & q->head_mask];
		q->next[i] = *head;
		*head = (uint32_t)i;
	}
	return true;
}

/* Finds between which corners the representatives of members are, and the edges between members. False when out of
 * memory. */
static bool link_members(question *q)
{
	const nt_welded_mesh *m = q->mesh;
	const nt_edge_tail *tail = q->tail;
	q->links = nt_scratch_alloc(m->scratch, 3 * q->corner_count, sizeof *q->links);
	if (!q->links)
		return false;
	q->link_count = 0;
	size_t last = SIZE_MAX;
	bool degenerate = false;
	for (size_t i = 0; i < q->corner_count; i++) {
		if (!has(tail->are_members, q->corners[i].vertex))
			continue;
		const size_t t = q->corners[i].corner / 3, k = q->corners[i].corner % 3;
		const uint32_t number = *slot_of(tail, q->corners[i].vertex);
		const uint32_t corner = (uint32_t)nt_triangle_corner(m->triangles, t, (unsigned)k);
		nt_edge_member *member = &tail->members[number];
		member->low = corner < member->low ? corner : member->low;
		member->high = corner > member->high ? corner : member->high;
		uint32_t copy[3];
		const uint32_t *v = vertices_of(m, t, copy), next = v[k < 2 ? k + 1 : 0];
		if (!has(tail->are_members, next))
			continue;
		degenerate = t == last ? degenerate : is_degenerate(m, v);
		last = t;
		if (!degenerate)
			q->links[q->link_count++] = (edge_link){number, *slot_of(tail, next)};
	}
	return true;
}

/* Representatives, as far as they are needed */

/* Finds the representative of a member. */
static nmtan_status find_member(question *q, nt_edge_member *member)
{
	const nt_welded_mesh *m = q->mesh;
	if (!q->chosen) {
		q->chosen = nt_scratch_alloc(m->scratch, q->corner_count + 1, sizeof *q->chosen);
		q->points = nt_scratch_alloc(m->scratch, q->corner_count, sizeof *q->points);
		if (!q->chosen || !q->points)
			return NMTAN_ERROR_MEMORY;
	}
	const nt_grid *grid = &q->tail->grid;
	const uint16_t cell = (uint16_t)nt_grid_cell(grid, nt_welded_position(m, member->vertex)[grid->axis]);
	size_t count = 0;
	for (uint32_t i = q->heads[cell & q->head_mask]; i != NONE; i = q->next[i]) {
		q->chosen[count] = q->corners[i];
		count += q->cells[i] == cell;
	}
	uint32_t found;
	if (!nt_find_representative(m, q->chosen, count, member->vertex, q->points, &found)) {
		q->tail->limit = true;
		return NMTAN_OK;
	}
	member->low = member->high = (uint32_t)nt_triangle_corner(m->triangles, found / 3, found % 3);
	return NMTAN_OK;
}

static bool is_known(const nt_edge_member *member)
{
	return member->low == member->high;
}

/* Whether an edge may be in the last run, with `low` as its lower end, which is at least `least`. */
static bool may_run(const nt_edge_member *low, const nt_edge_member *high, uint32_t least)
{
	return high->high > (low->low > least ? low->low : least) && low->high >= least;
}

/* How many edges the last run may have if its order matters: three or more, two of them between the same vertices; 0:
 * it cannot. `unknown` receives a member that decides whether there are such edges, or is left alone. */
static size_t most_edges(const question *q, uint32_t least, nt_edge_member **unknown)
{
	nt_edge_member *members = q->tail->members;
	for (size_t i = 0; i < q->tail->member_count; i++)
		members[i].edges = 0;
	for (const edge_link *l = q->links; l < q->links + q->link_count; l++) {
		nt_edge_member *a = &members[l->a], *b = &members[l->b];
		a->edges += may_run(a, b, least);
		b->edges += may_run(b, a, least);
	}
	size_t most = 0;
	for (uint32_t i = 0; i < q->tail->member_count; i++) {
		if (members[i].edges < LEAST_EDGES || members[i].edges <= most)
			continue;
		for (size_t k = 0; k < q->tail->member_count; k++)
			members[k].is_met = false;
		nt_edge_member *twin = NULL;
		for (const edge_link *l = q->links; l < q->links + q->link_count && !twin; l++) {
			nt_edge_member *other = l->a == i ? &members[l->b] : &members[l->a];
			if ((l->a != i && l->b != i) || !may_run(&members[i], other, least))
				continue;
			twin = other->is_met ? other : NULL;
			other->is_met = true;
		}
		if (!twin)
			continue;
		most = members[i].edges;
		if (is_known(twin))
			twin = &members[i];
		*unknown = is_known(twin) ? *unknown : twin;
	}
	return most;
}

/* The edge of members, not both of them known, whose lower end may be the largest; NULL: none can be as large as one of
 * which both are. `least` receives what the largest lower end is at least. */
static const edge_link *find_open(const question *q, uint32_t *least)
{
	const nt_edge_member *members = q->tail->members;
	const edge_link *open = NULL;
	uint32_t most = 0;
	*least = 0;
	for (const edge_link *l = q->links; l < q->links + q->link_count; l++) {
		const nt_edge_member *a = &members[l->a], *b = &members[l->b];
		const uint32_t low = a->low < b->low ? a->low : b->low, high = a->high < b->high ? a->high : b->high;
		*least = low > *least ? low : *least;
		if (high >= most && !(is_known(a) && is_known(b))) {
			most = high;
			open = l;
		}
	}
	return most >= *least ? open : NULL;
}

/* Asks whether the order matters; `enough` receives false if more triangles are to be looked at, and `count` how many
 * edges the run has, or 0. */
static nmtan_status ask_members(question *q, bool *enough, size_t *count)
{
	for (;;) {
		uint32_t least;
		const edge_link *open = find_open(q, &least);
		*enough = least >= q->tail->first;
		nt_edge_member *unknown = NULL;
		*count = *enough ? most_edges(q, least, &unknown) : 0;
		if (!open || (*enough && *count == 0))
			return NMTAN_OK;
		nt_edge_member *a = &q->tail->members[open->a], *b = &q->tail->members[open->b];
		nt_edge_member *lower = a->high < b->high ? a : b, *other = lower == a ? b : a;
		const nmtan_status status = find_member(q, unknown ? unknown : is_known(lower) ? other : lower);
		if (status || q->tail->limit)
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
		if (is_degenerate(m, v))
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

/* Asks whether the order matters; `count` receives how many edges the run has, or may have, or 0. */
static nmtan_status ask(const nt_welded_mesh *m, nt_edge_tail *tail, size_t *count)
{
	question q = {.mesh = m, .tail = tail};
	if (!tail->near && !tail->limit)
		use_box_of_used(m, tail);
	if (m->triangle_count < LEAST_EDGES || tail->limit)
		return NMTAN_OK;
	for (size_t triangles = first_triangles(m);; triangles *= MORE) {
		if (tail->triangles != triangles) {
			if (!take_last(m, triangles, tail))
				return NMTAN_ERROR_MEMORY;
			if (tail->near)
				watch_cells(m, tail);
			tail->is_noted = false;
		}
		if (!list_corners(&q))
			return NMTAN_ERROR_MEMORY;
		if (!tail->is_box_used) {
			use_box_of_used(m, tail);
			if (tail->limit)
				return NMTAN_OK;
			watch_cells(m, tail);
			tail->is_noted = false;
			if (!list_corners(&q))
				return NMTAN_ERROR_MEMORY;
		}
		bool enough;
		const nmtan_status status = link_members(&q) ? ask_members(&q, &enough, count) : NMTAN_ERROR_MEMORY;
		if (status || enough || tail->limit)
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
