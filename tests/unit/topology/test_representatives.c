/* SPDX-License-Identifier: MIT */
/* Which corner stands for a welded vertex: small meshes whose answers follow from the published weld by hand. */
#include "test.h"
#include <float.h>
#include <math.h>
#include "topology/edge_sort.h"

enum { MOST = 20000 };

static float positions[MOST + 1][3]; /* three floats behind the last one can be read */

static nt_welded_mesh mesh_of(const nt_triangles *triangles, size_t triangle_count, size_t vertices)
{
	return (nt_welded_mesh){.triangles = triangles,
		.triangle_count = triangle_count,
		.vertex_count = vertices,
		.positions = positions[0],
		.step = 3};
}

/* Finds what stands for the vertices of a cell, of all or of one. */
static bool weld(const uint32_t *ids, size_t triangles, size_t vertices, const nt_grid *grid, unsigned number,
	uint32_t one, uint32_t *found)
{
	static nt_cell_vertex rows[MOST];
	static nt_cell_corner corners[3 * MOST];
	static uint32_t numbers[MOST];
	nt_part all = {.halves = NULL};
	nt_scratch scratch;
	nt_cells cells;
	for (uint32_t v = 0; v < vertices; v++) {
		if (nt_grid_cell(grid, positions[v][grid->axis]) != number)
			continue;
		memcpy(rows[all.vertex_count].position, positions[v], sizeof *positions);
		rows[all.vertex_count].corners = 0;
		numbers[v] = all.vertex_count++;
	}
	for (uint32_t i = 0; i < 3 * triangles; i++) {
		if (nt_grid_cell(grid, positions[ids[i]][grid->axis]) != number)
			continue;
		rows[numbers[ids[i]]].corners++;
		corners[all.corner_count++] = (nt_cell_corner){numbers[ids[i]], i};
	}
	nt_scratch_init(&scratch, NULL);
	assert_true(nt_cells_make(&scratch, rows, all.vertex_count, all.corner_count, &cells));
	cells.corners = corners;
	const uint32_t rows_count = all.vertex_count;
	all.vertex_count = 0;
	for (uint32_t i = 0; i < rows_count; i++)
		if (rows[i].corners > 0)
			cells.order[all.vertex_count++] = i;
	bool done = true;
	for (uint32_t v = 0; v < vertices && done; v++)
		if (nt_grid_cell(grid, positions[v][grid->axis]) == number && rows[numbers[v]].corners > 0 &&
			(one == UINT32_MAX || one == v)) {
			done = nt_cells_find(&cells, &all, numbers[v]);
			found[v] = nt_cells_found(&cells, numbers[v]);
		}
	assert_true(done == !cells.limit);
	nt_scratch_free(&scratch);
	return done;
}

static bool find(const uint32_t *ids, size_t triangles, size_t vertices, uint32_t *found)
{
	const nt_triangles all = {.ids = ids};
	const nt_welded_mesh mesh = mesh_of(&all, triangles, vertices);
	nt_grid grid;
	assert_true(nt_grid_make(&mesh, NULL, &grid));
	bool done = true;
	for (unsigned cell = 0; cell < NT_CELLS && done; cell++)
		done = weld(ids, triangles, vertices, &grid, cell, UINT32_MAX, found);
	return done;
}

static void put(uint32_t vertex, float x, float y, float z)
{
	memcpy(positions[vertex], (float[3]){x, y, z}, sizeof *positions);
}

/* Vertices by themselves in their cells have their first corners. */
TEST(vertices_alone_have_their_first_corner)
{
	static const uint32_t ids[] = {2, 0, 1, 1, 3, 2};
	uint32_t found[4];
	for (uint32_t v = 0; v < 4; v++)
		put(v, (float)v, 0, 0);
	assert_true(find(ids, 2, 4, found));
	assert_memory_equal(found, ((uint32_t[]){1, 2, 0, 4}), sizeof found);
}

/* x is the longest axis, so that H (y = 1), M (0.25) and L (0) are in cell 0, in the order of corners H0 M1 L2 L3 M4
 * H5. Halved at y = 0.5: H0 changes places with M4, the last one below; what follows is on its side: M4 M1 L2 L3 | H0
 * H5. Halved at 0.125: M4 and L3 change places, then M1 and L2: L3 L2 | M1 M4. The first of each is what is found. */
TEST(corners_that_are_swapped_come_first)
{
	enum { H, M, L, A, B, C };
	static const uint32_t ids[] = {H, M, L, L, M, H, A, B, C};
	uint32_t found[6];
	put(H, 0, 1, 0);
	put(M, 0, 0.25f, 0);
	put(L, 0, 0, 0);
	for (uint32_t v = A; v <= C; v++)
		put(v, 10, (float)v, 0);
	assert_true(find(ids, 3, 6, found));
	assert_memory_equal(found, ((uint32_t[]){0, 1, 3, 6, 7, 8}), sizeof found);

	/* two vertices: H0 L1 L2 H3 becomes L2 L1 | H0 H3, as H0 changes places with the last one below */
	static const uint32_t two[] = {H, L, L, H, A, B};
	assert_true(find(two, 2, 6, found));
	assert_int_equal(found[H], 0);
	assert_int_equal(found[L], 2);
}

/* Nothing is left to halve, so that each has the first corner that is equal in all eight floats: its own. */
TEST(vertices_at_one_position_stay_apart)
{
	static const uint32_t ids[] = {1, 0, 2, 0, 1, 2};
	uint32_t found[3];
	put(0, 1, 1, 1);
	put(1, 1, 1, 1);
	put(2, 3, 1, 1);
	assert_true(find(ids, 2, 3, found));
	assert_memory_equal(found, ((uint32_t[]){1, 0, 2}), sizeof found);
}

TEST(the_box_is_that_of_used_vertices)
{
	const nt_triangles first_three = {.ids = (uint32_t[]){0, 1, 2}};
	const nt_welded_mesh mesh = mesh_of(&first_three, 1, 4);
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

/* Each is nearer to 0 than half of the one before, so that a halving parts one of them from the others, all of which
 * are in cell 0. */
TEST(halvings_have_a_limit)
{
	enum { POINTS = 201 };
	uint32_t ids[POINTS + 3], found[POINTS + 3];
	for (uint32_t v = 0; v < POINTS + 3; v++) {
		ids[v] = v;
		put(v, v < POINTS ? 0 : 0x1p110f, ldexpf(1 - (float)v / 65536, 100 - (int)v), 0);
	}
	assert_false(find(ids, (POINTS + 3) / 3, POINTS + 3, found));
	for (uint32_t v = 99; v < POINTS; v++)
		put(v, 0, 0x1p100f, 0);
	assert_true(find(ids, (POINTS + 3) / 3, POINTS + 3, found));
	assert_memory_equal(found, ids, sizeof found);
}

/* 300 vertices of a lattice, each with some of 6 000 corners, so that parts of more than 64 corners are halved. */
TEST(one_is_found_as_all_are)
{
	enum { VERTICES = 300, TRIANGLES = 2000 };
	static uint32_t ids[3 * TRIANGLES], found[VERTICES];
	uint32_t seed = 1;
	for (uint32_t i = 0; i < 3 * TRIANGLES; i++) {
		seed = seed * 1664525 + 1013904223;
		ids[i] = i < VERTICES ? i : (seed >> 8) % VERTICES;
	}
	for (uint32_t v = 0; v < VERTICES; v++)
		put(v, v % 7 == 0 ? 20 : 0, (float)(v / 7 % 9), (float)(v % 5));
	assert_true(find(ids, TRIANGLES, VERTICES, found));
	const nt_triangles all = {.ids = ids};
	const nt_welded_mesh mesh = mesh_of(&all, TRIANGLES, VERTICES);
	nt_grid grid;
	assert_true(nt_grid_make(&mesh, NULL, &grid));
	for (uint32_t v = 0; v < VERTICES; v++) {
		uint32_t one[VERTICES];
		const unsigned cell = nt_grid_cell(&grid, positions[v][grid.axis]);
		assert_true(weld(ids, TRIANGLES, VERTICES, &grid, cell, v, one));
		assert_int_equal(one[v], found[v]);
	}
}
