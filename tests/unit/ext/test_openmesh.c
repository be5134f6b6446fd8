/* SPDX-License-Identifier: MIT */
#include "growth.h"
#include "test.h"
#include <time.h>
#include "ext/openmesh.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

enum { MOST_STEPS = 16 };

/* The walks, as vertices where steps begin and end. */
typedef struct walks {
	const nt_walked_mesh *mesh;
	const uint32_t *triangles; /* [][3] vertices */
	size_t count, left_out, step_count;
	size_t ends[MOST_STEPS]; /* step behind the last one of a walk */
	bool closed[MOST_STEPS];
	uint32_t sides[MOST_STEPS], from[MOST_STEPS], to[MOST_STEPS];
	bool is_large; /* only counted */
} walks;

/* Steps are of marked sides and connected; a closed walk ends where it begins. */
static void take(void *context, const uint32_t *steps, size_t count, bool closed)
{
	walks *w = context;
	uint32_t first = 0, before = 0;
	assert_true(count > 0);
	for (size_t i = 0; i < count; i++) {
		const uint32_t side = steps[i] / 2, a = w->triangles[side],
			b = w->triangles[side % 3 == 2 ? side - 2 : side + 1];
		const uint32_t from = steps[i] % 2 ? b : a;
		assert_int_equal(w->mesh->marks[side], side);
		if (i > 0)
			assert_int_equal(from, before);
		else
			first = from;
		before = steps[i] % 2 ? a : b;
		if (w->is_large)
			continue;
		w->sides[w->step_count] = side;
		w->from[w->step_count] = from;
		w->to[w->step_count++] = before;
	}
	assert_true(!closed || before == first);
	w->closed[w->count] = closed;
	w->ends[w->count++] = w->is_large ? count : w->step_count;
}

/* The side from a to b; as many as there are: none. */
static size_t side_between(const uint32_t (*triangles)[3], size_t count, uint32_t a, uint32_t b)
{
	size_t s = 0;
	while (s < 3 * count && (triangles[s / 3][s % 3] != a || triangles[s / 3][(s + 1) % 3] != b))
		s++;
	return s;
}

/* Each edge is known by its first side, either way. */
static walks walks_of(const uint32_t (*triangles)[3], size_t count, const uint8_t *marked)
{
	uint32_t sides[64], marks[64];
	assert_true(3 * count <= 64);
	for (size_t s = 0; s < 3 * count; s++) {
		const uint32_t a = triangles[s / 3][s % 3], b = triangles[s / 3][(s + 1) % 3];
		const size_t along = side_between(triangles, count, a, b), back = side_between(triangles, count, b, a);
		sides[s] = (uint32_t)(along <= back ? 2 * along : 2 * back + 1);
		marks[s] = marked[s] ? (uint32_t)s : UINT32_MAX;
	}
	const nt_walked_mesh mesh = {3 * count, count, sides, marks};
	walks w = {.mesh = &mesh, .triangles = &triangles[0][0]};
	nt_error error;
	assert_int_equal(nt_walk_marked(&mesh, take, &w, &w.left_out, &error), NT_OK);
	w.mesh = NULL;
	return w;
}

/* 3-4-5
 * |/|/|  sides of triangle t: 3t, 3t+1, 3t+2
 * 0-1-2 */
static const uint32_t strip[][3] = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};

/* The walks along sides that no other is opposite to. */
static walks boundary_of(const uint32_t (*triangles)[3], size_t count)
{
	uint8_t marked[64] = {0};
	assert_true(3 * count <= sizeof marked);
	for (size_t s = 0; s < 3 * count; s++)
		marked[s] = side_between(triangles, count, triangles[s / 3][(s + 1) % 3], triangles[s / 3][s % 3]) ==
			3 * count;
	return walks_of(triangles, count, marked);
}

TEST(strip_has_one_boundary_loop_in_order)
{
	const walks loops = boundary_of(strip, COUNT(strip));
	assert_int_equal(loops.left_out, 0);
	assert_int_equal(loops.count, 1);
	assert_true(loops.closed[0]);
	static const uint32_t expected[] = {0, 1, 2, 5, 4, 3};
	assert_int_equal(loops.ends[0], 6);
	assert_memory_equal(loops.from, expected, sizeof expected);
}

/* A closed box: corner b has x = bit 0, y = bit 1, z = bit 2. */
static const uint32_t cube[][3] = {
	{0, 2, 3}, {0, 3, 1}, /* z = 0 */
	{4, 5, 7}, {4, 7, 6}, /* z = 1 */
	{0, 1, 5}, {0, 5, 4}, /* y = 0 */
	{2, 6, 7}, {2, 7, 3}, /* y = 1 */
	{0, 4, 6}, {0, 6, 2}, /* x = 0 */
	{1, 3, 7}, {1, 7, 5}, /* x = 1 */
};

TEST(open_chain_is_ordered_from_end_to_end)
{
	uint8_t marked[36] = {0};
	marked[side_between(cube, 12, 7, 6)] = 1;
	marked[side_between(cube, 12, 1, 5)] = 1;
	marked[side_between(cube, 12, 5, 7)] = 1;
	const walks w = walks_of(cube, 12, marked);
	assert_int_equal(w.count, 1);
	assert_false(w.closed[0]);
	/* lowest side: 7, 5-7 of triangle 2, so the chain runs 1-5-7-6 */
	static const uint32_t expected[] = {1, 5, 7};
	assert_int_equal(w.ends[0], 3);
	assert_memory_equal(w.from, expected, sizeof expected);
	assert_int_equal(w.to[2], 6);
}

TEST(degenerate_and_third_triangles_are_left_out)
{
	static const uint32_t soup[][3] = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {2, 2, 3}, {1, 0, 5}};
	uint8_t marked[15];
	memset(marked, 1, sizeof marked);
	const walks w = walks_of(soup, COUNT(soup), marked);
	assert_int_equal(w.left_out, 3);
	assert_int_equal(w.step_count, 5); /* the edges of the first two */
}

TEST(fans_that_touch_in_a_vertex_have_loops_of_their_own)
{
	static const uint32_t bowtie[][3] = {{0, 1, 2}, {0, 3, 4}};
	const walks loops = boundary_of(bowtie, COUNT(bowtie));
	assert_int_equal(loops.count, 2);
	assert_int_equal(loops.ends[0], 3);
	assert_int_equal(loops.ends[1], 6);
}

TEST(empty_mesh_and_bad_index_are_handled)
{
	assert_int_equal(boundary_of(strip, 0).count, 0);

	nt_error error;
	nt_walked_mesh bad = {2, 1, (const uint32_t[]){0, 2, 4}, NULL};
	size_t left_out;
	assert_int_equal(nt_walk_marked(&bad, take, NULL, &left_out, &error), NT_ERROR_INDEX);
	assert_non_null(strstr(error.message, "edge 2 of 2"));
	bad.triangle_count = SIZE_MAX / 3;
	assert_int_equal(nt_walk_marked(&bad, take, NULL, &left_out, &error), NT_ERROR_TOO_LARGE);
}

/* One vertex with many triangles, given in an order that hops around: without care each of them costs
 * a walk around the vertex, and 60 000 took 16 s. */
static double walk_hub(size_t spokes)
{
	uint32_t(*triangles)[3] = malloc(sizeof *triangles * spokes), (*sides)[3] = malloc(sizeof *sides * spokes);
	uint32_t *rim = malloc(sizeof *rim * 3 * spokes);
	for (size_t i = 0; i < spokes; i++) {
		const uint32_t at = (uint32_t)(i * 30011 % spokes); /* 30011 is prime */
		triangles[i][0] = 1 + at;
		triangles[i][1] = 1 + (at + 1) % (uint32_t)spokes;
		triangles[i][2] = 0;
		/* an edge of the rim, and two spokes */
		sides[i][0] = 2 * at;
		sides[i][1] = 2 * ((uint32_t)spokes + (at + 1) % (uint32_t)spokes);
		sides[i][2] = 2 * ((uint32_t)spokes + at) + 1;
		rim[3 * i] = 3 * (uint32_t)i;
		rim[3 * i + 1] = rim[3 * i + 2] = UINT32_MAX;
	}
	const nt_walked_mesh mesh = {2 * spokes, spokes, &sides[0][0], rim};
	walks loops = {.mesh = &mesh, .triangles = &triangles[0][0], .is_large = true};
	const clock_t begin = clock();
	assert_int_equal(nt_walk_marked(&mesh, take, &loops, &loops.left_out, NULL), NT_OK);
	const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
	assert_int_equal(loops.count, 1);
	assert_int_equal(loops.ends[0], spokes);
	free(triangles);
	free(sides);
	free(rim);
	return seconds;
}

TEST(hub_is_not_quadratic)
{
	assert_true(grows_slowly(walk_hub, 7500));
}
