/* SPDX-License-Identifier: MIT */
#include "fail_alloc.h"
#include "gltf/extensions/extensions.h"
#include "test.h"

/* Three corners of a triangle: of 3, which the manifold merges with 0, of 1, and of 4, a copy of 2. */
static uint32_t corners[] = {3, 1, 4};
static const uint32_t merged[] = {0, 1, 2};

TEST(corners_that_differ_are_merged)
{
	const nt_manifold m = {.corner_count = 3, .corners = corners, .merged = merged};
	nt_arena arena = {0};
	uint32_t *places, *vertices;
	size_t count;
	assert_int_equal(nt_manifold_merges(&m, &arena, &places, &vertices, &count), NT_OK);
	assert_int_equal(count, 2);
	assert_memory_equal(places, ((uint32_t[]){0, 2}), 8);
	assert_memory_equal(vertices, ((uint32_t[]){0, 2}), 8);
	nt_arena_free(&arena);
}

TEST(a_manifold_without_merges_has_none)
{
	const nt_manifold m = {.corner_count = 3, .corners = corners, .merged = corners};
	nt_arena arena = {0};
	uint32_t *places, *vertices;
	size_t count = 7;
	assert_int_equal(nt_manifold_merges(&m, &arena, &places, &vertices, &count), NT_OK);
	assert_int_equal(count, 0);
	nt_arena_free(&arena);
	fail_allocations_from(0);
	const nt_status status = nt_manifold_merges(&m, &arena, &places, &vertices, &count);
	stop_failing_allocations();
	assert_int_equal(status, NT_ERROR_MEMORY);
	nt_arena_free(&arena);
}
