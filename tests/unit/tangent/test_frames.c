/* SPDX-License-Identifier: MIT */
/*
 * The weights of area and lengyel, on a ridge whose two sides have different size and texture density.
 */
#include "test.h"
#include <math.h>
#include "nmtan.h"

/*
 * Vertex 0 at the origin with normal +z has two triangles in the plane z = 0, each with a right angle at
 * it. Left: edges of length 1 along -x and +y, u grows along (1, 0). Right: edges of length L along +x
 * and +y... the frames differ by a rotation: on the right u grows along (0, 1).
 *
 *   angle (MikkTSpace): both angles 90 degrees, T = (1, 1) / sqrt 2
 *   area: weights 1 * 1 and L * L, T along (1, L^2)
 *   lengyel: dP/du is (1, 0) on the left and (0, s) on the right, where one unit of u is s long
 */
static void solve(nmtan_method method, float length, float s, float tangent[4])
{
	const float positions[6][3] = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 0}, {length, 0, 0},
		{0, length, 0}};
	const float normals[6][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	/* left: u = x, v = y; right: u = y / s, v = -x */
	const float texcoords[6][2] = {{0, 0}, {0, 1}, {-1, 0}, {0, 0}, {0, -length}, {length / s, 0}};
	const nmtan_mesh mesh = {.face_count = 2, .vertex_count = 6, .positions = &positions[0][0],
		.normals = &normals[0][0], .texcoords = &texcoords[0][0]};
	const nmtan_options options = {.method = method};
	float tangents[6][4];
	nmtan_output output = {.tangents = &tangents[0][0]};
	assert_int_equal(nmtan_tangents(&mesh, &options, &output), NMTAN_OK);
	assert_memory_equal(tangents[0], tangents[3], 16);
	assert_int_equal(output.counts.mirrored, 0);
	memcpy(tangent, tangents[0], 16);
}

static void assert_along(const float *t, double x, double y)
{
	const double length = sqrt(x * x + y * y);
	assert_true(fabs(t[0] - x / length) < 1e-6 && fabs(t[1] - y / length) < 1e-6);
	assert_true(t[2] == 0.0f && t[3] == 1.0f);
}

static void area_weighs_angle_times_both_edges(void **state)
{
	(void)state;
	float t[4];
	solve(NMTAN_METHOD_AREA, 3, 1, t);
	assert_along(t, 1, 9);
	solve(NMTAN_METHOD_AREA, 0.001f, 5, t);
	assert_along(t, 1, 1e-6);
}

static void lengyel_weighs_by_texture_density(void **state)
{
	(void)state;
	float t[4];
	solve(NMTAN_METHOD_LENGYEL, 3, 1, t);
	assert_along(t, 1, 1);
	solve(NMTAN_METHOD_LENGYEL, 3, 5, t);
	assert_along(t, 1, 5);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(area_weighs_angle_times_both_edges),
		cmocka_unit_test(lengyel_weighs_by_texture_density),
	};
	return cmocka_run_group_tests_name("tangent/frames", tests, NULL, NULL);
}
