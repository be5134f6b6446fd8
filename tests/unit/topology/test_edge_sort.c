/* SPDX-License-Identifier: MIT */
/* Edges that the published sort leaves unsorted: triangles whose last run follows from the specification by hand. */
#include "test.h"
#include <float.h>
#include <math.h>
#include "budget.h"
#include "topology/inside.h"

/* Vertices in cells of their own, numbered as they come, so that their first corners stand for them. */
enum { C, A, B, D, MOST = 4 * NT_EDGE_FEW + 1024 };

static float positions[MOST + 1][3];

static void place(void)
{
	memset(positions, 0, sizeof positions);
	for (int v = 0; v < MOST; v++)
		positions[v][0] = (float)v;
}

static nmtan_status ask_of(
	const nt_triangles *all, size_t triangles, size_t vertices, nt_scratch *scratch, nt_unsorted *unsorted)
{
	const nt_welded_mesh mesh = {.triangles = all,
		.triangle_count = triangles,
		.vertex_count = vertices,
		.positions = positions[0],
		.step = 3,
		.scratch = scratch};
	return nt_find_unsorted(&mesh, NULL, scratch, unsorted);
}

static bool are_same(const float (*rows)[3], uint32_t a, uint32_t b)
{
	return memcmp(rows[a], rows[b], sizeof *rows) == 0;
}

/* The corners around each vertex, as the sums enter them. */
static nmtan_status surround(const nt_triangles *all, const float (*rows)[3], size_t triangles, size_t vertices,
	size_t most_narrow, nt_scratch *scratch, nt_adjacency *result)
{
	const size_t bounds[2] = {0, triangles};
	const nt_triangle_ranges ranges = {.count = 1, .bounds = bounds};
	nt_borrowed none = nt_borrow(NULL, 0, scratch);
	nt_adjacency a;
	const nmtan_status status = nt_adjacency_make(
		all, &ranges, vertices, NT_ADJACENCY_PLACES, most_narrow, &none, &none, &a);
	for (size_t t = 0; !status && t < triangles; t++) {
		uint32_t copy[3];
		const uint32_t *v = nt_triangle_vertices(all, t, 1, copy);
		const bool degenerate =
			are_same(rows, v[0], v[1]) || are_same(rows, v[1], v[2]) || are_same(rows, v[2], v[0]);
		for (uint32_t k = 0; k < 3; k++) {
			const uint32_t place = nt_adjacency_next(&a, &a.cursors[v[k]]);
			nt_fan_entry entry = {v[(k + 1) % 3] | NT_ENTRY_ORIENT, v[(k + 2) % 3] | NT_ENTRY_ORIENT};
			if (degenerate)
				entry.next = entry.previous = NT_ENTRY_VOID;
			if (!(place & NT_CURSOR_HUB))
				nt_adjacency_store(&a, place, entry);
		}
	}
	*result = a;
	return status;
}

static nmtan_status ask_around(const nt_triangles *all, size_t triangles, size_t vertices, size_t most_narrow,
	nt_scratch *scratch, nt_unsorted *unsorted)
{
	nt_adjacency a;
	const nmtan_status status = surround(all, positions, triangles, vertices, most_narrow, scratch, &a);
	const nt_welded_mesh mesh = {.triangles = all, .triangle_count = triangles, .vertex_count = vertices,
		.positions = positions[0], .step = 3, .adjacency = &a, .scratch = scratch};
	return status ? status : nt_find_unsorted(&mesh, NULL, scratch, unsorted);
}

static nmtan_status ask_narrow(
	const nt_triangles *all, size_t triangles, size_t vertices, nt_scratch *scratch, nt_unsorted *unsorted)
{
	return ask_around(all, triangles, vertices, NT_NARROW_LIMIT, scratch, unsorted);
}

static nmtan_status ask_wide(
	const nt_triangles *all, size_t triangles, size_t vertices, nt_scratch *scratch, nt_unsorted *unsorted)
{
	return ask_around(all, triangles, vertices, 0, scratch, unsorted);
}

static nmtan_status ask(
	const uint32_t *ids, size_t triangles, size_t vertices, nt_scratch *scratch, nt_unsorted *unsorted)
{
	const nt_triangles all = {.ids = ids};
	return ask_narrow(&all, triangles, vertices, scratch, unsorted);
}

static void expect(const uint32_t *ids, size_t triangles, size_t vertices, const nt_unsorted_edge *edges, size_t count)
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_unsorted unsorted;
	assert_int_equal(ask(ids, triangles, vertices, &scratch, &unsorted), NMTAN_OK);
	assert_false(unsorted.limit);
	assert_int_equal(unsorted.count, count);
	for (size_t i = 0; i < count; i++) {
		uint32_t neighbour;
		assert_int_equal(unsorted.edges[i].edge, edges[i].edge);
		assert_true(nt_unsorted_neighbour(&unsorted, edges[i].edge, &neighbour));
		assert_int_equal(neighbour, edges[i].neighbour);
		assert_false(nt_unsorted_neighbour(&unsorted, edges[i].edge + 1, &neighbour));
	}
	nt_scratch_free(&scratch);
}

static bool is_limit(const uint32_t *ids, size_t triangles, size_t vertices)
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_unsorted unsorted;
	assert_int_equal(ask(ids, triangles, vertices, &scratch, &unsorted), NMTAN_OK);
	assert_true(!unsorted.limit || unsorted.count == 0);
	nt_scratch_free(&scratch);
	return unsorted.limit;
}

TEST(two_edges_are_sorted)
{
	place();
	expect((uint32_t[]){C, A, B, C, B, A}, 2, 3, NULL, 0);
	expect(NULL, 0, 0, NULL, 0);
}

/* Lower ends of the nine edges, by their representatives: 0 1 0 0 1 0 0 1 0. The last run are edges 1, 4 and 7, all
 * between A and B. The seed is 39871946, turned by 39871946 mod 32 = 10 bits; added, and 3: mod 9 it is 1, so that the
 * pivot is edge 1. From both ends 1 changes places with 8, then 4 with 7; the parts are places 0 to 6, of which one
 * has a 1, edge 7, and places 7 and 8, edges 4 and 1, which are equal and stay. So the order is 7 4 1, and since the
 * run is the last of all it is not sorted by triangle either: triangles 2 and 1 meet, and 0 has no neighbour there.
 * Sorted, 0 and 1 meet. */
static const uint32_t three[] = {C, A, B, C, B, A, C, A, B};
static const nt_unsorted_edge three_edges[] = {{1, NT_NO_NEIGHBOUR}, {4, 2}, {7, 1}};

TEST(three_equal_edges_meet_from_the_end)
{
	place();
	expect(three, 3, 3, three_edges, 3);
}

/* 0 1 0 four times: the pivot is edge 10 (the same seed mod 12), a 1. 1 changes places with 11, 4 with 10, and 7 with
 * 9: places 0 to 8 have edge 10 alone, places 9 to 11 edges 7, 4 and 1. In these the next seed chooses a 1 again; 7 and
 * 1 change places. The order is 10 1 4 7: between A and D, B, D, B. Equal ones are not neighbours and do not meet. */
TEST(equal_edges_that_are_apart_do_not_meet)
{
	static const uint32_t ids[] = {C, A, B, C, A, D, C, B, A, C, D, A};
	static const nt_unsorted_edge edges[] = {
		{1, NT_NO_NEIGHBOUR}, {4, NT_NO_NEIGHBOUR}, {7, NT_NO_NEIGHBOUR}, {10, NT_NO_NEIGHBOUR}};
	place();
	expect(ids, 4, 4, edges, 4);
}

/* A triangle with two corners at one position is no part of the array, but has its number. */
TEST(degenerate_triangles_have_no_edges)
{
	static const uint32_t ids[] = {C, A, B, A, D, B, C, B, A, C, A, B};
	static const nt_unsorted_edge edges[] = {{1, NT_NO_NEIGHBOUR}, {7, 3}, {10, 2}};
	place();
	positions[D][0] = positions[A][0];
	expect(ids, 4, 4, edges, 3);
	for (int v = A; v <= D; v++)
		positions[v][0] = positions[C][0];
	expect(ids, 4, 4, NULL, 0);
}

TEST(rows_without_corners_are_not_looked_at)
{
	static const float unused[] = {1e30f, -5, NAN, INFINITY};
	for (size_t i = 0; i < sizeof unused / sizeof *unused; i++)
		for (int k = 0; k < 3; k++) {
			place();
			positions[D][k] = unused[i];
			expect(three, 3, 4, three_edges, 3);
		}
}

TEST(positions_that_are_not_welded_are_a_limit)
{
	static const float wrong[] = {NAN, INFINITY, -INFINITY, FLT_MAX / 2, -FLT_MAX / 2};
	for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
		for (int k = 0; k < 3; k++) {
			place();
			positions[A][k] = wrong[i];
			assert_true(is_limit(three, 3, 3));
		}
	place();
	positions[B][0] = nextafterf(FLT_MAX / 2, 0);
	assert_false(is_limit(three, 3, 3));
}

/* See test_representatives.c: each halving parts one point from the others. The last triangles are those of the three
 * that are parted last, so that it shows which of their corners come first. */
TEST(too_many_halvings_are_a_limit)
{
	enum { POINTS = 201, CORNERS = POINTS + 3, LAST = 9 };
	uint32_t ids[CORNERS + LAST];
	place();
	for (uint32_t v = 0; v < CORNERS; v++) {
		ids[v] = v;
		positions[v][0] = v < POINTS ? 0 : 0x1p110f;
		positions[v][1] = ldexpf(1 - (float)v / 65536, 100 - (int)v);
	}
	for (uint32_t i = 0; i < LAST; i++)
		ids[CORNERS + i] = POINTS - 3 + three[i];
	assert_true(is_limit(ids, (CORNERS + LAST) / 3, CORNERS));
	for (uint32_t v = 0; v < 100; v++)
		positions[v][0] = 0x1p109f;
	assert_false(is_limit(ids, (CORNERS + LAST) / 3, CORNERS));
}

/* The specification, step by step, on everything: what the search leaves out decides nothing. */

enum { APART = 2048, MOST_TRIANGLES = 4400, MOST_CORNERS = 3 * MOST_TRIANGLES };

typedef struct edge {
	uint32_t low, high, number; /* representatives; 3 * triangle + k */
	bool forward;
} edge;

static uint32_t entries[MOST_CORNERS], entry_vertices[MOST_CORNERS], values[MOST_CORNERS]; /* entries: 3 * t + k */
static uint32_t representatives[MOST];

static float coordinate_of(uint32_t entry, int axis)
{
	return positions[entry_vertices[entry]][axis];
}

static int find_axis(const uint32_t *list, size_t count, float low[3], float high[3])
{
	for (int i = 0; i < 3; i++) {
		low[i] = high[i] = coordinate_of(list[0], i);
		for (size_t e = 1; e < count; e++) {
			low[i] = fminf(low[i], coordinate_of(list[e], i));
			high[i] = fmaxf(high[i], coordinate_of(list[e], i));
		}
	}
	const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
	return y > x && y > z ? 1 : z > x ? 2 : 0;
}

static void weld_all(uint32_t *list, size_t count)
{
	float low[3], high[3];
	if (count == 0)
		return;
	const int axis = find_axis(list, count, low, high);
	const float middle = 0.5f * (high[axis] + low[axis]);
	if (middle >= high[axis] || middle <= low[axis]) {
		for (size_t e = count; e-- > 0;)
			representatives[entry_vertices[list[e]]] = values[list[e]];
		return;
	}
	size_t left = 0, right = count - 1;
	while (left < right) {
		while (left < right && coordinate_of(list[left], axis) < middle)
			left++;
		while (left < right && !(coordinate_of(list[right], axis) < middle))
			right--;
		if (left < right) {
			const uint32_t swapped = list[left];
			list[left++] = list[right];
			list[right--] = swapped;
		}
	}
	if (left == right && coordinate_of(list[left], axis) < middle)
		left++;
	weld_all(list, left);
	weld_all(list + left, count - left);
}

static void sort_as_published(edge *edges, long low, long high, uint32_t seed)
{
	const long count = high - low + 1;
	if (count < 2)
		return;
	if (count == 2) {
		if (edges[low].low > edges[high].low) {
			const edge swapped = edges[low];
			edges[low] = edges[high];
			edges[high] = swapped;
		}
		return;
	}
	const uint32_t turn = seed & 31;
	seed += (turn ? seed << turn | seed >> (32 - turn) : seed) + 3;
	const uint32_t pivot = edges[low + (long)(seed % (uint32_t)count)].low;
	long left = low, right = high;
	do {
		while (edges[left].low < pivot)
			left++;
		while (edges[right].low > pivot)
			right--;
		if (left <= right) {
			const edge swapped = edges[left];
			edges[left++] = edges[right];
			edges[right--] = swapped;
		}
	} while (left <= right);
	sort_as_published(edges, low, right, seed);
	sort_as_published(edges, left, high, seed);
}

static int by_number(const void *left, const void *right)
{
	const edge *a = left, *b = right;
	return (a->number > b->number) - (a->number < b->number);
}

static int by_all(const void *left, const void *right)
{
	const edge *a = left, *b = right;
	return a->low != b->low ? (a->low > b->low ? 1 : -1)
	     : a->high != b->high ? (a->high > b->high ? 1 : -1) : by_number(left, right);
}

static void pair_all(const edge *edges, size_t count, uint32_t *neighbours)
{
	for (size_t i = 0; i < count; i++)
		for (size_t k = i + 1; k < count && neighbours[edges[i].number] == NT_NO_NEIGHBOUR &&
			edges[k].low == edges[i].low && edges[k].high == edges[i].high; k++)
			if (edges[k].forward != edges[i].forward && neighbours[edges[k].number] == NT_NO_NEIGHBOUR) {
				neighbours[edges[i].number] = edges[k].number / 3;
				neighbours[edges[k].number] = edges[i].number / 3;
			}
}

static bool is_collapsed(const uint32_t v[3])
{
	for (int k = 0; k < 3; k++)
		if (memcmp(positions[v[k]], positions[v[(k + 1) % 3]], sizeof *positions) == 0)
			return true;
	return false;
}

/* Writes the edges that are paired otherwise; returns how many. */
static size_t pair_by_specification(const nt_triangles *all, size_t triangles, nt_unsorted_edge *expected)
{
	static edge edges[MOST_CORNERS], sorted[MOST_CORNERS];
	static uint32_t cells[2048][MOST_CORNERS / 8], published[MOST_CORNERS], usual[MOST_CORNERS];
	static size_t counts[2048];
	float low[3], high[3];
	size_t count = 0, differ = 0;
	for (uint32_t e = 0; e < 3 * triangles; e++) {
		entries[e] = e;
		values[e] = (uint32_t)nt_triangle_corner(all, e / 3, e % 3);
		entry_vertices[e] = all->ids[values[e]];
	}
	const int axis = find_axis(entries, 3 * triangles, low, high);
	memset(counts, 0, sizeof counts);
	for (uint32_t e = 0; e < 3 * triangles; e++) {
		const float cell = 2048 * ((coordinate_of(e, axis) - low[axis]) / (high[axis] - low[axis]));
		const size_t c = cell >= 2048 ? 2047 : cell > 0 ? (size_t)cell : 0;
		assert_true(counts[c] < MOST_CORNERS / 8);
		cells[c][counts[c]++] = e;
	}
	for (size_t c = 0; c < 2048; c++)
		weld_all(cells[c], counts[c]);
	for (uint32_t t = 0; t < triangles; t++)
		for (uint32_t k = 0; k < 3 && !is_collapsed(entry_vertices + 3 * t); k++) {
			const uint32_t a = representatives[entry_vertices[3 * t + k]];
			const uint32_t b = representatives[entry_vertices[3 * t + (k + 1) % 3]];
			edges[count++] = (edge){a < b ? a : b, a < b ? b : a, 3 * t + k, a < b};
		}
	memcpy(sorted, edges, count * sizeof *edges);
	qsort(sorted, count, sizeof *sorted, by_all);
	sort_as_published(edges, 0, (long)count - 1, 39871946);
	size_t run = count;
	while (run > 0 && edges[run - 1].low == edges[count - 1].low)
		run--;
	qsort(edges, run, sizeof *edges, by_all);
	for (size_t begin = run, end; begin < count; begin = end) {
		for (end = begin; end < count && edges[end].high == edges[begin].high; end++)
			continue;
		if (end < count)
			qsort(edges + begin, end - begin, sizeof *edges, by_number);
	}
	memset(published, 0xff, sizeof published);
	memset(usual, 0xff, sizeof usual);
	pair_all(edges, count, published);
	pair_all(sorted, count, usual);
	for (uint32_t e = 0; e < 3 * triangles; e++)
		if (published[e] != usual[e])
			expected[differ++] = (nt_unsorted_edge){e, published[e]};
	return differ;
}

static uint32_t chance;

static uint32_t below(uint32_t limit)
{
	chance = chance * 1664525 + 1013904223;
	return (chance >> 8) % limit;
}

/* How a mesh ends. QUADS: of two halves, one collapsed; SHUFFLED: in no order, and in some of these meshes each halving
 * of a cell parts one vertex from the others; MANY: doubles, and behind them more triangles of old vertices than are
 * looked at first, of a mesh that is then looked at again. */
typedef enum tail_form {
	PLAIN,
	OLD_VERTICES,
	HUB,
	DOUBLES,
	COLLAPSED,
	QUADS,
	THREE_VERTICES,
	SHUFFLED,
	MANY,
	FORMS
} tail_form;

/* A sheet of cells, most of whose rows of vertices are in one cell of the grid, and a tail. */
static size_t make_tail(tail_form form, uint32_t *ids, uint32_t *cuts)
{
	const uint32_t columns = form == MANY ? 62 : 1 + below(10), rows = form == MANY ? 34 : 1 + below(9);
	const bool turned = below(2), lattice = below(2), uneven = form == SHUFFLED && below(2);
	size_t count = 0;
	for (uint32_t v = 0; v < MOST; v++) {
		const float noise = lattice ? 0 : (float)below(64) / 8192;
		positions[v][turned] = (float)(v % (columns + 1)) + noise;
		const uint32_t row = v / (columns + 1);
		positions[v][!turned] = uneven ? ldexpf(1, -(int)row) : (float)row * 0.25f;
		positions[v][2] = noise;
	}
	for (uint32_t q = 0; q < columns * rows; q++) {
		const uint32_t a = q / columns * (columns + 1) + q % columns, d = a + columns + 1;
		const uint32_t halves[6] = {a, a + 1, d + 1, a, d + 1, d}, quad[4] = {a, a + 1, d + 1, d};
		const size_t corners = form == QUADS ? 4 : 6;
		memcpy(ids + count, form == QUADS ? quad : halves, corners * sizeof *ids);
		count += corners;
	}
	const uint32_t vertices = (columns + 1) * (rows + 1), least = form == MANY ? 12 : 1;
	const uint32_t times = least + below(form == COLLAPSED ? 60 : 12);
	uint32_t *tail = ids + count;
	for (uint32_t i = 0; i < times; i++, tail += 3) {
		const uint32_t old[3] = {below(vertices), below(vertices), below(vertices)};
		memcpy(tail, old, sizeof old);
		if (form == HUB)
			tail[2] = vertices;
		if (form == DOUBLES || (form == MANY && i < 3))
			for (uint32_t k = 0; k < 3; k++)
				tail[k] = i == 0 ? k + vertices - 3 : *(tail - 3 + (below(4) ? k : k * 2 % 3));
		if (form == COLLAPSED)
			tail[1] = tail[2 * below(2)];
	}
	count += form == PLAIN || form == QUADS || form == SHUFFLED ? 0 : 3 * times;
	for (size_t i = 0; form == THREE_VERTICES && i < count; i++)
		ids[i] = (i + (i / 3 + below(2)) % 2 * (i % 3)) % 3;
	for (size_t t = count / 3 - 1; form == SHUFFLED && t > 0; t--) {
		const size_t other = below((uint32_t)t + 1);
		uint32_t swapped[3];
		memcpy(swapped, ids + 3 * t, sizeof swapped);
		memcpy(ids + 3 * t, ids + 3 * other, sizeof swapped);
		memcpy(ids + 3 * other, swapped, sizeof swapped);
	}
	if (form != QUADS)
		return count / 3;
	for (uint32_t first = 0; first < count; first += 4) {
		const uint32_t half = below(4);
		if (half < 2) /* the first or the second half collapses */
			ids[first + (half ? 2 : 1)] = ids[first + (half ? 3 : 0)];
		const uint32_t halves[2][2][3] = {{{0, 1, 2}, {0, 2, 3}}, {{0, 1, 3}, {1, 2, 3}}}, way = below(2);
		for (uint32_t h = 0; h < 2; h++) {
			uint32_t corners[3];
			for (int k = 0; k < 3; k++)
				corners[k] = first + halves[way][h][k];
			cuts[first / 2 + h] = nt_cut_of(first, corners);
		}
	}
	return count / 2;
}

/* Asks after the triangles of two ranges are noted, as the sums do, 31 or 32 at a time. */
static nmtan_status ask_noted(
	const nt_triangles *all, size_t triangles, size_t vertices, nt_scratch *scratch, nt_unsorted *unsorted)
{
	const nt_welded_mesh mesh = {.triangles = all, .triangle_count = triangles, .vertex_count = vertices,
		.positions = positions[0], .step = 3, .scratch = scratch};
	const size_t middle = triangles / 3 - (triangles / 3 > 0 && nt_is_cut_between(all, triangles / 3 - 1));
	const size_t bounds[3] = {0, middle, triangles};
	const nt_triangle_ranges ranges = {.count = 2, .bounds = bounds};
	nt_borrowed none = nt_borrow(NULL, 0, scratch);
	nt_edge_tail tail;
	assert_int_equal(nt_edge_tail_make(&mesh, &ranges, &none, &tail), NMTAN_OK);
	for (unsigned range = 0; range < 2 && tail.notes; range++) {
		nt_edge_note *note = nt_edge_notes(&tail, range);
		size_t count = 31;
		for (size_t first = bounds[range]; first < bounds[range + 1]; first += count, count ^= 31 ^ 32) {
			*note = (nt_edge_note){(uint32_t)first, 0};
			for (size_t i = 0; i < count && first + i < bounds[range + 1]; i++)
				for (unsigned k = 0; k < 3; k++) {
					const uint32_t v = all->ids[nt_triangle_corner(all, first + i, k)];
					const uint32_t near = nt_edge_is_near(&tail, positions[v][tail.grid.axis]);
					note->triangles |= near << i;
				}
			note += note->triangles != 0;
		}
		note->triangles = 0;
	}
	return nt_find_unsorted(&mesh, &tail, scratch, unsorted);
}

/* Whether the last triangles alone say that the order does not matter. Some vertices get numbers that are larger by
 * `apart`, whose lowest bits may be those of another. */
static bool is_known_from_last(const uint32_t *ids, size_t triangles, size_t rows, uint32_t apart)
{
	static float moved[MOST + APART + 1][3];
	static uint32_t renamed[MOST_CORNERS];
	const nt_triangles all = {.ids = renamed};
	for (size_t i = 0; i < 3 * triangles; i++) {
		renamed[i] = apart && ids[i] % 7 == 1 ? ids[i] - 1 + apart : ids[i];
		memcpy(moved[renamed[i]], positions[ids[i]], sizeof *moved);
	}
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_adjacency a;
	assert_int_equal(surround(&all, moved, triangles, rows, triangles % 2 * NT_NARROW_LIMIT, &scratch, &a),
		NMTAN_OK);
	const nt_welded_mesh mesh = {.triangles = &all, .triangle_count = triangles, .vertex_count = rows,
		.positions = moved[0], .step = 3, .adjacency = &a, .scratch = &scratch};
	nt_grid grid;
	assert_true(nt_grid_of_used(&mesh, &grid));
	const bool known = nt_edges_are_sorted(&mesh, grid, true);
	nt_scratch_free(&scratch);
	return known;
}

TEST(every_form_of_a_tail_is_as_specified)
{
	static uint32_t ids[MOST_CORNERS], cuts[MOST_TRIANGLES];
	static nt_unsorted_edge expected[MOST_CORNERS];
	for (int form = 0; form < FORMS; form++) {
		size_t shown = 0, known = 0;
		for (chance = 0; chance < (form == MANY ? 30 : 600); chance++) {
			const uint32_t seed = chance;
			chance *= 7919;
			const size_t triangles = make_tail((tail_form)form, ids, cuts);
			chance = seed;
			const nt_triangles all = {.ids = ids, .cuts = form == QUADS ? cuts : NULL};
			const size_t count = pair_by_specification(&all, triangles, expected);
			shown += count > 0;
			uint32_t last = 0;
			for (size_t e = 0; e < 3 * triangles; e++)
				last = entry_vertices[e] > last ? entry_vertices[e] : last;
			/* many rows; more with one place; as many as there are places, of few triangles too */
			const size_t sizes[] = {MOST, MOST + APART, 4 * NT_EDGE_FEW};
			for (size_t i = 0; form != QUADS && i < (form == MANY ? 2 : 3); i++)
				if (is_known_from_last(ids, triangles, sizes[i], i == 1 ? APART : 0)) {
					assert_int_equal(count, 0);
					known++;
				}
			/* rows that have corners, some that have none, too many for edge_few.c */
			const size_t few = form == MANY ? last + 1 : 3 * NT_EDGE_FEW;
			const struct {
				nmtan_status (*ask)(const nt_triangles *, size_t, size_t, nt_scratch *, nt_unsorted *);
				size_t rows;
			} ways[] = {{ask_narrow, last + 1}, {ask_narrow, few}, {ask_wide, last + 1}, {ask_wide, few},
				{ask_of, last + 1}, {ask_of, MOST}, {ask_noted, last + 1}, {ask_noted, MOST}};
			for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
				nt_scratch scratch;
				nt_scratch_init(&scratch, NULL);
				nt_unsorted unsorted;
				assert_int_equal(ways[i].ask(&all, triangles, ways[i].rows, &scratch, &unsorted),
					NMTAN_OK);
				assert_false(unsorted.limit);
				assert_int_equal(unsorted.count, count);
				if (count > 0)
					assert_memory_equal(unsorted.edges, expected, count * sizeof *expected);
				nt_scratch_free(&scratch);
			}
		}
		assert_true(shown > 0 || form == PLAIN);
		assert_true(known > 0 || form != PLAIN);
	}
}

/* Many triangles, none of which shares an edge with another. The last ten are two degenerate ones, three plain ones
 * and five degenerate ones. These seven have all corners of a hub, which shares its cell with one old vertex, so that
 * its first corner stands for it: it is below the plain ones. Its cell is only searched among the last triangles'
 * corners, since those of all would not fit. */
TEST(a_hub_of_many_triangles_is_found_from_the_last)
{
	enum { OLD = 20000, LAST = 10, FIRST_PLAIN = 2, END_PLAIN = 5 };
	enum { HUB_VERTEX = 3 * OLD, VERTICES = HUB_VERTEX + 10 };
	static uint32_t ids[3 * (OLD + LAST)];
	static float rows[VERTICES + 1][3];
	for (uint32_t v = 0; v < VERTICES; v++)
		rows[v][0] = (float)(v + (v >= HUB_VERTEX - 1 ? 100 : 0) + (v > HUB_VERTEX ? 100 : 0));
	for (uint32_t i = 0; i < 3 * OLD; i++)
		ids[i] = i;
	for (uint32_t t = 0, next = HUB_VERTEX + 1; t < LAST; t++)
		for (uint32_t k = 0; k < 3; k++)
			ids[3 * (OLD + t) + k] = t >= FIRST_PLAIN && t < END_PLAIN ? next++ : k < 2 ? HUB_VERTEX : t;
	const nt_triangles all = {.ids = ids};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_adjacency a;
	assert_int_equal(surround(&all, rows, OLD + LAST, VERTICES, 0, &scratch, &a), NMTAN_OK);
	assert_true(a.cursors[HUB_VERTEX] & NT_CURSOR_HUB);
	const nt_welded_mesh mesh = {.triangles = &all, .triangle_count = OLD + LAST, .vertex_count = VERTICES,
		.positions = rows[0], .step = 3, .adjacency = &a, .scratch = &scratch};
	nt_grid grid;
	assert_true(nt_grid_of_used(&mesh, &grid));
	assert_true(nt_edges_are_sorted(&mesh, grid, true));
	nt_scratch_free(&scratch);
}

/* Memory that says nothing useful. */
static void *take_dirty(void *user, size_t bytes)
{
	(void)user;
	void *block = malloc(bytes);
	return block ? memset(block, 0xff, bytes) : NULL;
}

/* Triangles from one end of the box to the other, the last three of which have the vertices 2, 1 and 0, at sizes at
 * which bounds of cells overflow or are lost: positions are multiples of a step, so that they are in the same cells.
 * Another program that follows the specification sorts the run as 256 259 253: triangles 85 and 86 meet, not 84 and
 * 85. */
TEST(size_does_not_matter)
{
	enum { VERTICES = 255, TRIANGLES = VERTICES / 3 + 2, SIZES = 6 };
	static const float steps[SIZES] = {
		1, FLT_MAX / VERTICES * 0.999f, 0x1p-149f, 0x1p-148f, 10 * 0x1p-149f, 0x1p-120f};
	static const nt_unsorted_edge expected[] = {{253, NT_NO_NEIGHBOUR}, {256, 86}, {259, 85}};
	uint32_t ids[3 * TRIANGLES];
	for (uint32_t i = 0; i < VERTICES; i++)
		ids[i] = VERTICES - 1 - i;
	memcpy(ids + VERTICES, (uint32_t[]){2, 0, 1, 2, 1, 0}, 6 * sizeof *ids);
	for (int turned = 0; turned < 2; turned++)
		for (int i = 0; i < SIZES; i++) {
			const nmtan_allocator allocator = {take_dirty, give_back, NULL};
			nt_scratch scratch;
			nt_scratch_init(&scratch, &allocator);
			nt_unsorted unsorted;
			place();
			for (int v = 0; v < VERTICES; v++) {
				const int x = v < 4 ? 3 - v : v;
				positions[v][0] = (float)((turned ? VERTICES - 1 - x : x) - VERTICES / 2) * steps[i];
			}
			/* the ends of the box are vertices of other triangles */
			for (int axis = 1; axis < 3; axis++) {
				positions[3][axis] = steps[i];
				positions[100][axis] = -steps[i];
			}
			assert_int_equal(ask(ids, TRIANGLES, VERTICES, &scratch, &unsorted), NMTAN_OK);
			assert_false(unsorted.limit);
			assert_int_equal(unsorted.count, 3);
			assert_memory_equal(unsorted.edges, expected, sizeof expected);
			nt_scratch_free(&scratch);
		}
}

/* The same three triangles many times: every array is needed. */
TEST(every_failed_allocation_is_told)
{
	enum { TIMES = 3000 };
	static uint32_t ids[9 * TIMES];
	for (size_t i = 0; i < TIMES; i++)
		memcpy(ids + 9 * i, three, sizeof three);
	place();
	size_t allowed = 0, found = 0;
	for (nmtan_status status = NMTAN_ERROR_MEMORY; status; allowed++) {
		budget b = {allowed};
		const nmtan_allocator allocator = {take_budget, give_back, &b};
		nt_scratch scratch;
		nt_scratch_init(&scratch, &allocator);
		nt_unsorted unsorted;
		status = ask(ids, 3 * TIMES, 3, &scratch, &unsorted);
		assert_true(status == NMTAN_OK || status == NMTAN_ERROR_MEMORY);
		found = status ? 0 : unsorted.count;
		nt_scratch_free(&scratch);
	}
	assert_in_range(allowed, 5, 100);
	assert_true(found > 0);
}
