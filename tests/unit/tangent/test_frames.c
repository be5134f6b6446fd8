/* SPDX-License-Identifier: MIT */
/*
 * The weights of area, lengyel and robust on a ridge whose two sides have different size and texture
 * density, and what robust keeps where float arithmetic loses it.
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
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2, .vertex_count = 6,
		.positions = &positions[0][0],
		.normals = &normals[0][0], .texcoords = &texcoords[0][0]};
	const nmtan_options options = {.struct_bytes = sizeof options, .method = method};
	float tangents[6][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, &counts), NMTAN_OK);
	assert_memory_equal(tangents[0], tangents[3], 16);
	assert_int_equal(counts.mirrored, 0);
	memcpy(tangent, tangents[0], 16);
}

static void assert_along(const float *t, double x, double y)
{
	const double length = sqrt(x * x + y * y);
	assert_true(fabs(t[0] - x / length) < 1e-6 && fabs(t[1] - y / length) < 1e-6);
	assert_true(t[2] == 0.0f && t[3] == 1.0f);
}

TEST(area_weighs_angle_times_both_edges)
{
	float t[4];
	solve(NMTAN_METHOD_AREA, 3, 1, t);
	assert_along(t, 1, 9);
	solve(NMTAN_METHOD_AREA, 0.001f, 5, t);
	assert_along(t, 1, 1e-6);
}

TEST(lengyel_weighs_by_texture_density)
{
	float t[4];
	solve(NMTAN_METHOD_LENGYEL, 3, 1, t);
	assert_along(t, 1, 1);
	solve(NMTAN_METHOD_LENGYEL, 3, 5, t);
	assert_along(t, 1, 5);
}

TEST(robust_weighs_by_angle_alone)
{
	float t[4];
	solve(NMTAN_METHOD_ROBUST, 3, 1, t);
	assert_along(t, 1, 1);
	solve(NMTAN_METHOD_ROBUST, 0.001f, 5, t);
	assert_along(t, 1, 1);
}

/*
 * One triangle whose UVs are a needle: a = (0, 0), b = (1, d), c = (2, 2 d + h) with d = 2^-12 and
 * h = 2^-34, all exact. u = (cv d1 - bv d2) sign, with d1 = (1, 0, 0) and d2 = (2, 1, 0):
 * (2 d + h) (1, 0) - d (2, 1) = (h, -d): the first component is left after 22 bits cancel, and the
 * tangent is (2^-22, -1) but for 2^-45. A float product loses it whole.
 */
TEST(robust_keeps_what_is_left_of_a_needle)
{
	const float d = 1.0f / 4096, h = 1.0f / 4096 / 4194304;
	const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}};
	const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	const float texcoords[3][2] = {{0, 0}, {1, d}, {2, 2 * d + h}};
	assert_true(texcoords[2][1] - 2 * d == h);
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
		.positions = &positions[0][0],
		.normals = &normals[0][0], .texcoords = &texcoords[0][0]};
	const nmtan_options options = {.struct_bytes = sizeof options, .method = NMTAN_METHOD_ROBUST};
	float tangents[3][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, &counts), NMTAN_OK);
	assert_int_equal(counts.ill_conditioned, 0);
	for (int c = 0; c < 3; c++) {
		assert_true(tangents[c][0] == 1.0f / 4194304 && tangents[c][1] == -1.0f);
		assert_true(tangents[c][2] == 0.0f && tangents[c][3] == 1.0f);
	}
}

/* Exponents so far apart that differences need two doubles: b - a = (2^60 - 2^-60, 0), c - a the same in
 * v. u = (1, 0, 0). */
TEST(robust_takes_differences_that_no_double_holds)
{
	const float big = 1152921504606846976.0f, small = 1.0f / 1152921504606846976.0f; /* 2^60, 2^-60 */
	const float positions[3][3] = {{small, 0, 0}, {big, 0, 0}, {small, big, 0}};
	const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	const float texcoords[3][2] = {{small, -small}, {big, -small}, {small, big}};
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
		.positions = &positions[0][0],
		.normals = &normals[0][0], .texcoords = &texcoords[0][0]};
	const nmtan_options options = {.struct_bytes = sizeof options, .method = NMTAN_METHOD_ROBUST};
	float tangents[3][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
	for (int c = 0; c < 3; c++)
		assert_true(tangents[c][0] == 1.0f && tangents[c][1] == 0.0f && tangents[c][3] == 1.0f);
}

/*
 * The second triangle has an edge along the normal, which MikkTSpace sees as a point: its corner there weighs acos(0).
 * At the first vertex the first one has a right angle and u along x, the second u along y: with q1 = (0, 1, .5) at
 * (.25, 1) and q2 = (0, 0, 1) at (-1, .5), 1.125 dP/du = .5 q1 - q2 = (0, .5, -.75). So T is (1, 1) / sqrt 2.
 * Whichever corners the triangles begin with.
 */
TEST(an_edge_along_the_normal_weighs_a_right_angle)
{
	const float positions[4][3] = {{0, 0, 0}, {1, 0, 0.25f}, {0, 1, 0.5f}, {0, 0, 1}};
	const float texcoords[4][2] = {{0, 0}, {1, 0}, {0.25f, 1}, {-1, 0.5f}};
	const uint32_t indices[] = {0, 1, 2, 0, 2, 3, 1, 2, 0, 3, 0, 2, 2, 0, 1, 2, 3, 0};
	const float normals[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++)
		for (int i = 0; i < 3 && method != NMTAN_METHOD_AREA && method != NMTAN_METHOD_LENGYEL; i++) {
			const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2, .vertex_count = 4,
				.indices = indices + 6 * i, .positions = positions[0], .normals = normals[0],
				.texcoords = texcoords[0]};
			const nmtan_options options = {.struct_bytes = sizeof options, .method = (nmtan_method)method};
			float tangents[6][4];
			const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0]};
			nmtan_counts counts = NMTAN_COUNTS_INIT;
			assert_int_equal(nmtan_tangents(&mesh, &options, &output, &counts), NMTAN_OK);
			assert_int_equal(counts.ill_conditioned, 0);
			for (int c = 0; c < 6; c++)
				if (mesh.indices[c] == 0)
					assert_along(tangents[c], 1, 1);
		}
}

/* dP/du along the normal but for 2^-30: what is left in the plane is right, and counted. */
TEST(robust_counts_what_is_lost)
{
	const float d = 1.0f / 1073741824;
	const float positions[3][3] = {{0, 0, 0}, {d, 0, 1}, {0, 1, 0}};
	const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	const float texcoords[3][2] = {{0, 0}, {1, 0}, {0, 1}};
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
		.positions = &positions[0][0],
		.normals = &normals[0][0], .texcoords = &texcoords[0][0]};
	const nmtan_options options = {.struct_bytes = sizeof options, .method = NMTAN_METHOD_ROBUST};
	float tangents[3][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, &counts), NMTAN_OK);
	assert_int_equal(counts.ill_conditioned, 3);
	for (int c = 0; c < 3; c++)
		assert_true(tangents[c][0] == 1.0f && tangents[c][2] == 0.0f && tangents[c][3] == 1.0f);
}
