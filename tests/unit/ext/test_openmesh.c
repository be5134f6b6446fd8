/* SPDX-License-Identifier: MIT */
#include "growth.h"
#include "test.h"
#include <time.h>
#include "ext/openmesh.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static nt_halfedges *built(size_t vertex_count, const uint32_t (*triangles)[3], size_t count)
{
	nt_halfedges *mesh;
	nt_error error;
	assert_int_equal(nt_halfedges_build(&mesh, vertex_count, &triangles[0][0], count, &error),
		NT_OK);
	return mesh;
}

/* Walks are connected, end where they say, and each step's sides name its two vertices. */
static void assert_sound(const nt_walks *walks, const uint32_t (*triangles)[3])
{
	const uint32_t *corners = &triangles[0][0];
	for (size_t w = 0; w < walks->count; w++) {
		assert_true(walks->first[w] < walks->first[w + 1]);
		for (size_t s = walks->first[w]; s < walks->first[w + 1]; s++) {
			const uint32_t l = walks->left[s], r = walks->right[s];
			assert_true(l != NT_OPEN || r != NT_OPEN);
			if (l != NT_OPEN) {
				assert_int_equal(corners[l], walks->from[s]);
				assert_int_equal(corners[l / 3 * 3 + (l + 1) % 3], walks->to[s]);
			}
			if (r != NT_OPEN) {
				assert_int_equal(corners[r], walks->to[s]);
				assert_int_equal(corners[r / 3 * 3 + (r + 1) % 3], walks->from[s]);
			}
			if (s > walks->first[w])
				assert_int_equal(walks->from[s], walks->to[s - 1]);
		}
		const size_t begin = walks->first[w], end = walks->first[w + 1] - 1;
		if (walks->closed[w])
			assert_int_equal(walks->from[begin], walks->to[end]);
	}
}

/* 3-4-5
 * |/|/|  sides of triangle t: 3t, 3t+1, 3t+2
 * 0-1-2 */
static const uint32_t strip[][3] = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};

static uint32_t side_between(const uint32_t (*triangles)[3], size_t count, uint32_t a, uint32_t b)
{
	for (uint32_t s = 0; s < 3 * count; s++)
		if (triangles[s / 3][s % 3] == a && triangles[s / 3][(s + 1) % 3] == b)
			return s;
	return NT_OPEN;
}

/* The chains of marked sides. */
static nt_walks chains_of(const nt_halfedges *mesh, const uint8_t *marked, const uint32_t (*triangles)[3])
{
	nt_walks walks;
	assert_int_equal(nt_halfedges_chains(mesh, marked, &walks, NULL), NT_OK);
	assert_sound(&walks, triangles);
	return walks;
}

/* The walks along sides that no other is opposite to. */
static nt_walks boundary_of(const nt_halfedges *mesh, const uint32_t (*triangles)[3], size_t count)
{
	uint8_t marked[64] = {0};
	assert_true(3 * count <= sizeof marked);
	for (size_t s = 0; s < 3 * count; s++)
		marked[s] = side_between(triangles, count, triangles[s / 3][(s + 1) % 3], triangles[s / 3][s % 3]) ==
			NT_OPEN;
	return chains_of(mesh, marked, triangles);
}

TEST(strip_has_one_boundary_loop_in_order)
{
	nt_halfedges *mesh = built(6, strip, COUNT(strip));
	const uint32_t *left_out;
	assert_int_equal(nt_halfedges_left_out(mesh, &left_out), 0);
	nt_walks loops = boundary_of(mesh, strip, COUNT(strip));
	assert_int_equal(loops.count, 1);
	assert_true(loops.closed[0]);
	static const uint32_t expected[] = {0, 1, 2, 5, 4, 3};
	assert_int_equal(loops.first[1], 6);
	assert_memory_equal(loops.from, expected, sizeof expected);
	for (size_t step = 0; step < 6; step++)
		assert_int_equal(loops.right[step], NT_OPEN);
	nt_walks_free(&loops);
	nt_halfedges_free(mesh);
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

TEST(closed_seams_are_walked_round)
{
	nt_halfedges *mesh = built(8, cube, COUNT(cube));
	/* the rim of z = 1: 4-5-7-6, marked in no particular order and from either side */
	uint8_t marked[36] = {0};
	marked[side_between(cube, 12, 7, 6)] = 1;
	marked[side_between(cube, 12, 5, 4)] = 1;
	marked[side_between(cube, 12, 5, 7)] = 1;
	marked[side_between(cube, 12, 4, 6)] = 1;
	nt_walks walks = chains_of(mesh, marked, cube);
	assert_int_equal(walks.count, 1);
	assert_true(walks.closed[0]);
	static const uint32_t rim[] = {4, 5, 7, 6}; /* lowest side: 6, which is 4-5 of triangle 2 */
	assert_int_equal(walks.first[1], 4);
	assert_int_equal(walks.left[0], 6);
	assert_memory_equal(walks.from, rim, sizeof rim);
	nt_walks_free(&walks);

	/* the rim and one upright edge: vertex 4 is a junction, so the rim begins there */
	marked[side_between(cube, 12, 0, 4)] = 1;
	walks = chains_of(mesh, marked, cube);
	assert_int_equal(walks.count, 2);
	assert_true(walks.closed[0]);
	assert_int_equal(walks.from[0], 4);
	assert_false(walks.closed[1]);
	assert_int_equal(walks.first[2] - walks.first[1], 1);
	nt_walks_free(&walks);
	nt_halfedges_free(mesh);
}

TEST(open_chain_is_ordered_from_end_to_end)
{
	nt_halfedges *mesh = built(8, cube, COUNT(cube));
	uint8_t marked[36] = {0};
	marked[side_between(cube, 12, 7, 6)] = 1;
	marked[side_between(cube, 12, 1, 5)] = 1;
	marked[side_between(cube, 12, 5, 7)] = 1;
	nt_walks walks = chains_of(mesh, marked, cube);
	assert_int_equal(walks.count, 1);
	assert_false(walks.closed[0]);
	/* lowest side: 7, 5-7 of triangle 2, so the chain runs 1-5-7-6 */
	static const uint32_t expected[] = {1, 5, 7};
	assert_int_equal(walks.first[1], 3);
	assert_memory_equal(walks.from, expected, sizeof expected);
	assert_int_equal(walks.to[2], 6);
	nt_walks_free(&walks);
	nt_halfedges_free(mesh);
}

TEST(moebius_strip_loses_nothing)
{
	/* Five triangles (i, i+1, i+2) mod 5, every other one turned: the strip closes with a twist, and
	 * since 5 is odd the last and the first use an edge in the same direction. */
	static const uint32_t band[][3] = {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}};
	nt_halfedges *mesh = built(5, band, COUNT(band));
	const uint32_t *left_out;
	assert_int_equal(nt_halfedges_left_out(mesh, &left_out), 1);
	assert_int_equal(left_out[0], 4); /* uses 0-1 again, as triangle 0 does */
	uint8_t marked[15] = {0};
	marked[14] = 1; /* a side of the triangle left out is not lost */
	nt_walks walks = chains_of(mesh, marked, band);
	assert_int_equal(walks.count, 1);
	assert_int_equal(walks.left[0], 14);
	nt_walks_free(&walks);
	nt_halfedges_free(mesh);
}

TEST(degenerate_and_third_triangles_are_left_out)
{
	static const uint32_t soup[][3] = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {2, 2, 3}, {1, 0, 5}};
	nt_halfedges *mesh = built(6, soup, COUNT(soup));
	const uint32_t *left_out;
	assert_int_equal(nt_halfedges_left_out(mesh, &left_out), 3);
	assert_memory_equal(left_out, ((uint32_t[]){2, 3, 4}), 12);
	nt_halfedges_free(mesh);
}

TEST(fans_that_touch_in_a_vertex_have_loops_of_their_own)
{
	static const uint32_t bowtie[][3] = {{0, 1, 2}, {0, 3, 4}};
	nt_halfedges *mesh = built(5, bowtie, COUNT(bowtie));
	nt_walks loops = boundary_of(mesh, bowtie, COUNT(bowtie));
	assert_int_equal(loops.count, 2);
	assert_int_equal(loops.first[1], 3);
	assert_int_equal(loops.first[2], 6);
	nt_walks_free(&loops);
	nt_halfedges_free(mesh);
}

TEST(empty_mesh_and_bad_index_are_handled)
{
	nt_halfedges *mesh = built(0, strip, 0);
	nt_walks walks = boundary_of(mesh, strip, 0);
	assert_int_equal(walks.count, 0);
	nt_walks_free(&walks);
	nt_halfedges_free(mesh);

	nt_error error;
	assert_int_equal(nt_halfedges_build(&mesh, 5, &strip[0][0], 4, &error), NT_ERROR_INDEX);
	assert_null(mesh);
	assert_non_null(strstr(error.message, "vertex 5 of 5"));
	assert_int_equal(nt_halfedges_build(&mesh, 5, &strip[0][0], SIZE_MAX / 3, &error),
		NT_ERROR_TOO_LARGE);
}

/* One vertex with many triangles, given in an order that hops around: without care each of them costs
 * a walk around the vertex, and 60 000 took 16 s. */
static double build_hub(size_t spokes)
{
	uint32_t(*triangles)[3] = malloc(sizeof *triangles * spokes);
	uint8_t *rim = calloc(spokes, 3);
	for (size_t i = 0; i < spokes; i++) {
		const uint32_t at = (uint32_t)(i * 30011 % spokes); /* 30011 is prime */
		triangles[i][0] = 1 + at;
		triangles[i][1] = 1 + (at + 1) % (uint32_t)spokes;
		triangles[i][2] = 0;
		rim[3 * i] = 1;
	}
	const clock_t begin = clock();
	nt_halfedges *mesh = built(spokes + 1, (const uint32_t(*)[3])triangles, spokes);
	nt_walks loops;
	assert_int_equal(nt_halfedges_chains(mesh, rim, &loops, NULL), NT_OK);
	const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
	assert_int_equal(loops.count, 1);
	assert_int_equal(loops.first[1], spokes);
	assert_sound(&loops, (const uint32_t(*)[3])triangles);
	nt_walks_free(&loops);
	nt_halfedges_free(mesh);
	free(triangles);
	free(rim);
	return seconds;
}

TEST(hub_is_not_quadratic)
{
	assert_true(grows_slowly(build_hub, 7500));
}

int main(void)
{
	return run_group("ext/openmesh");
}
