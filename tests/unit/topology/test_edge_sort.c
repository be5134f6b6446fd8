/* SPDX-License-Identifier: MIT */
/* Edges that the published sort leaves unsorted: triangles whose last run follows from the specification by hand. */
#include "test.h"
#include <float.h>
#include <math.h>
#include "budget.h"
#include "topology/edge_sort.h"

/* Vertices in cells of their own, numbered as they come, so that their first corners stand for them. */
enum { C, A, B, D, MOST = 300 };

static float positions[MOST + 1][3];

static void place(void)
{
	memset(positions, 0, sizeof positions);
	for (int v = 0; v < MOST; v++)
		positions[v][0] = (float)v;
}

static nmtan_status ask(
	const uint32_t *ids, size_t triangles, size_t vertices, nt_scratch *scratch, nt_unsorted *unsorted)
{
	const nt_triangles all = {.ids = ids};
	const nt_welded_mesh mesh = {.triangles = &all,
		.triangle_count = triangles,
		.vertex_count = vertices,
		.positions = positions[0],
		.step = 3,
		.threads = 1,
		.scratch = scratch};
	nt_edge_tail tail;
	const nmtan_status status = nt_edge_tail_make(&mesh, &tail);
	*unsorted = (nt_unsorted){.edges = NULL};
	return status ? status : nt_find_unsorted(&mesh, &tail, scratch, unsorted);
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

int main(void)
{
	return run_group("topology/edge_sort");
}
