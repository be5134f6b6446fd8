/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "topology/corners.h"

/* Rows of position, normal, texture coordinates; corner c is vertex c. */
static void weld(const float (*rows)[8], size_t count, uint32_t *ids, size_t *welded)
{
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = count / 3, .vertex_count = count,
		.positions = rows[0], .position_stride_bytes = 32, .normals = rows[0] + 3,
		.normal_stride_bytes = 32, .texcoords = rows[0] + 6, .texcoord_stride_bytes = 32};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	assert_int_equal(nt_weld_corners(&mesh, count, &scratch, ids, welded), NMTAN_OK);
	nt_scratch_free(&scratch);
}

TEST(equal_rows_are_one_and_zero_signs_do_not_matter)
{
	const float rows[6][8] = {{0, 1, 2, 0, 0, 1, 5, 6}, {-0.0f, 1, 2, 0, -0.0f, 1, 5, 6},
		{0, 1, 2, 0, 0, 1, 5, 7}, {0, 1, 2, 0, 0, 1, 5, 6}, {0, 1, 2, 1, 0, 0, 5, 6},
		{3, 1, 2, 0, 0, 1, 5, 6}};
	uint32_t ids[6];
	size_t welded;
	weld(rows, 6, ids, &welded);
	const uint32_t expected[6] = {0, 0, 1, 0, 2, 3};
	assert_memory_equal(ids, expected, sizeof ids);
	assert_int_equal(welded, 4);
}

TEST(nan_equals_nothing)
{
	const float rows[3][8] = {{NAN, 0}, {NAN, 0}, {0, NAN}};
	uint32_t ids[3];
	size_t welded;
	weld(rows, 3, ids, &welded);
	assert_int_equal(welded, 3);
}

/* An indexed mesh welds its vertices, but a NaN vertex stays apart at each corner. */
TEST(indexed_corners_take_their_vertex)
{
	const float rows[3][8] = {{1}, {2}, {NAN}};
	const uint32_t indices[6] = {0, 1, 2, 1, 0, 2};
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2, .vertex_count = 3,
		.indices = indices,
		.positions = rows[0], .position_stride_bytes = 32, .normals = rows[0] + 3,
		.normal_stride_bytes = 32, .texcoords = rows[0] + 6, .texcoord_stride_bytes = 32};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	uint32_t ids[6];
	size_t welded;
	assert_int_equal(nt_weld_corners(&mesh, 6, &scratch, ids, &welded), NMTAN_OK);
	const uint32_t expected[6] = {0, 1, 2, 1, 0, 3};
	assert_memory_equal(ids, expected, sizeof ids);
	nt_scratch_free(&scratch);
}
