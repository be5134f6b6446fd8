/* SPDX-License-Identifier: MIT */
#include "gltf/extensions/extensions.h"
#include "test.h"

static void assert_edges(const uint32_t *edges, size_t count, const nt_copied_triangles *t, const uint32_t *expected,
	size_t expected_count)
{
	nt_arena arena = {0};
	uint32_t *result;
	size_t result_count;
	assert_int_equal(nt_outline_follow(edges, count, t, &arena, &result, &result_count), NT_OK);
	assert_int_equal(result_count, expected_count);
	if (expected_count)
		assert_memory_equal(result, expected, expected_count * 2 * sizeof *result);
	nt_arena_free(&arena);
}

/* Two triangles over the edge 1 2; the second one has copies of 1 and 2:
 *
 *   0 - 1     1' - 3
 *     \ |      | /
 *       2     2'
 */
static const uint32_t vertices[] = {0, 2, 1, 4, 5, 3}, sources[] = {1, 2};
static const nt_copied_triangles pair = {.vertices = vertices, .corner_count = 6, .old_count = 4, .sources = sources};

TEST(shared_edge_becomes_two)
{
	assert_edges((uint32_t[]){1, 2}, 1, &pair, (uint32_t[]){1, 2, 4, 5}, 2);
	assert_edges((uint32_t[]){2, 1}, 1, &pair, (uint32_t[]){2, 1, 5, 4}, 2);
}

TEST(edge_of_a_copy_follows_it)
{
	assert_edges((uint32_t[]){3, 1, 0, 1}, 2, &pair, (uint32_t[]){3, 4, 0, 1}, 2);
}

TEST(edge_of_no_triangle_stays)
{
	assert_edges((uint32_t[]){0, 3, 0, 0}, 2, &pair, (uint32_t[]){0, 3, 0, 0}, 2);
	assert_edges(NULL, 0, &pair, NULL, 0);
}

/* A third triangle over 1 2, on the first one's vertices: the pair is there once. */
TEST(sides_with_the_same_ends_are_one_edge)
{
	const uint32_t three[] = {0, 2, 1, 4, 5, 3, 2, 1, 3};
	const nt_copied_triangles t = {.vertices = three, .corner_count = 9, .old_count = 4, .sources = sources};
	assert_edges((uint32_t[]){1, 2}, 1, &t, (uint32_t[]){1, 2, 4, 5}, 2);
}
