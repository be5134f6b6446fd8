/* SPDX-License-Identifier: MIT */
/*
 * The box whose cells decide which corner stands for a welded vertex. Which corner that is follows from the
 * specification in test_edge_sort.c.
 */
#include "test.h"
#include <float.h>
#include <math.h>
#include "topology/edge_sort.h"

static float positions[5][3]; /* three floats behind the last one can be read */

static void put(uint32_t vertex, float x, float y, float z)
{
	memcpy(positions[vertex], (float[3]){x, y, z}, sizeof *positions);
}

TEST(the_box_is_that_of_used_vertices)
{
	const nt_triangles first_three = {.ids = (uint32_t[]){0, 1, 2}};
	const nt_welded_mesh mesh = {.triangles = &first_three, .triangle_count = 1, .vertex_count = 4,
		.positions = positions[0], .step = 3};
	nt_grid grid;
	put(0, -1, 0, 0);
	put(1, 0, 2, 0);
	put(2, 1, 1, 0);
	put(3, 0, 1, 50);
	uint32_t extremes[6];
	assert_true(nt_grid_make(&mesh, extremes, &grid));
	assert_int_equal(grid.axis, 2);
	assert_true(grid.low == 0 && grid.high == 50);
	assert_memory_equal(extremes, ((uint32_t[]){0, 2, 0, 1, 0, 3}), sizeof extremes);
	assert_true(nt_grid_of_used(&mesh, &grid));
	assert_int_equal(grid.axis, 0); /* y is as long, and not longer */
	assert_true(grid.low == -1 && grid.high == 1);
	assert_int_equal(nt_grid_cell(&grid, -1), 0);
	assert_int_equal(nt_grid_cell(&grid, 0), NT_CELLS / 2);
	assert_int_equal(nt_grid_cell(&grid, 1), NT_CELLS - 1);
	static const float wrong[] = {NAN, INFINITY, -INFINITY, FLT_MAX / 2, -FLT_MAX / 2};
	for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
		put(3, 0, wrong[i], 0);
		assert_false(nt_grid_make(&mesh, extremes, &grid));
		assert_true(nt_grid_of_used(&mesh, &grid));
	}
	put(3, 0, nextafterf(FLT_MAX / 2, 0), 0);
	assert_true(nt_grid_make(&mesh, NULL, &grid));
}
