/* SPDX-License-Identifier: MIT */
/*
 * Authored tangents, first of meshes without texture coordinates: what stays, and what the others become. The normal is
 * along z unless a case says otherwise.
 */
#include "test.h"
#include <math.h>
#include "pipeline/stages.h"

static float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
static float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};

static nt_mesh triangle(float tangents[3][4])
{
	return (nt_mesh){.vertex_count = 3,
		.face_count = 1,
		.corner_count = 3,
		.positions = positions[0],
		.normals = normals[0],
		.tangents = tangents[0]};
}

static size_t mend(nt_mesh *mesh, float out[3][4])
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	nt_mend_untextured(mesh, &view, out[0]);
	return mesh->replaced_tangents;
}

static void expect(const float *t, float x, float y, float z, float w)
{
	const float expected[4] = {x, y, z, w};
	for (int i = 0; i < 4; i++)
		if (!(fabsf(t[i] - expected[i]) <= 1e-7f))
			fail_msg("(%g %g %g %g), expected (%g %g %g %g)", t[0], t[1], t[2], t[3], x,
				y, z, w);
}

TEST(valid_tangents_keep_their_bytes)
{
	/* half a degree off, and 0.5 % too long: what the validator and --check accept */
	float tangents[3][4] = {{1, 0, 0, -1}, {0, 1.005f, 0, -1}, {0.99996f, 0, 0.0087f, -1}},
	      out[3][4];
	nt_mesh mesh = triangle(tangents);
	assert_int_equal(mend(&mesh, out), 0);
	assert_memory_equal(out, tangents, sizeof out);
}

TEST(invalid_tangents_become_the_nearest_across_the_normal)
{
	float tangents[3][4] = {{0, 0.6f, 0.8f, -1}, {0, 0, 1, -1}, {0, -3, 0, -1}}, out[3][4];
	nt_mesh mesh = triangle(tangents);
	assert_int_equal(mend(&mesh, out), 3);
	expect(out[0], 0, 1, 0, -1);
	/* nothing is nearest to what runs along the normal */
	assert_true(
		fabsf(out[1][0] * out[1][0] + out[1][1] * out[1][1] - 1) < 1e-6f && out[1][2] == 0);
	assert_true(out[1][3] == -1);
	expect(out[2], 0, -1, 0, -1);
	/* mended ones are valid */
	mesh.tangents = out[0];
	float again[3][4];
	assert_int_equal(mend(&mesh, again), 0);
}

TEST(what_has_no_direction_gets_any)
{
	static const float bad[] = {0, NAN, INFINITY, 1e-40f};
	for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
		float tangents[3][4] = {{1, 0, 0, 1}, {bad[i], 0, 0, 1}, {1, 0, 0, 1}}, out[3][4];
		nt_mesh mesh = triangle(tangents);
		assert_int_equal(mend(&mesh, out), 1);
		expect(out[1], 1, 0, 0, 1);
	}
}

TEST(a_sign_that_corners_do_not_share_becomes_one)
{
	static const float signs[][3] = {
		{1, -1, 1}, {-1, -1, 0}, {0, 0, 0}, {-1, NAN, -1}, {2, 2, 2}};
	for (size_t i = 0; i < sizeof signs / sizeof *signs; i++) {
		float tangents[3][4], out[3][4];
		size_t others = 0;
		for (int k = 0; k < 3; k++) {
			const float t[4] = {1, 0, 0, signs[i][k]};
			memcpy(tangents[k], t, sizeof t);
			others += signs[i][k] != 1;
		}
		nt_mesh mesh = triangle(tangents);
		assert_int_equal(mend(&mesh, out), others);
		for (int k = 0; k < 3; k++)
			expect(out[k], 1, 0, 0, 1);
	}
}

/* About x by 60 degrees, about y by 90, and by half a turn, where the way is not determined. */
TEST(tangents_turn_with_their_normals)
{
	float tangents[3][4] = {{0, 1, 0, -1}, {1, 0, 0, -1}, {0.6f, 0.8f, 0, -1}}, out[3][4];
	float moved_normals[3][3] = {{0, -0.8660254f, 0.5f}, {1, 0, 0}, {0, 0, -1}};
	nt_mesh mesh = triangle(tangents);
	mesh.corner_tangents = tangents[0];
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(&mesh, &stored);
	nmtan_mesh moved = view;
	nt_turn_untextured(&mesh, &view, &moved, out[0]);
	assert_memory_equal(out, tangents, sizeof out);
	moved.normals = moved_normals[0];
	nt_turn_untextured(&mesh, &view, &moved, out[0]);
	expect(out[0], 0, 0.5f, 0.8660254f, -1);
	expect(out[1], 0, 0, -1, -1);
	expect(out[2], 0.6f, 0.8f, 0, -1);
}

/* ---- with texture coordinates ---- */

/* Treatment of a triangle's authored tangents if a solve gives others. */
static nt_mesh restore(float texcoords[3][2], float authored[3][4], float solved[3][4], float step)
{
	nt_mesh mesh = triangle(authored);
	mesh.texcoords = texcoords[0];
	mesh.tangent_step = step;
	nt_restore_authored(&mesh, solved[0], NULL);
	return mesh;
}

/* Without area in UV space a solve may give corners of either w. */
TEST(a_face_that_a_solve_makes_no_better_is_left)
{
	float line[3][2] = {{0, 0}, {1, 0}, {2, 0}};
	float authored[3][4] = {{0, 1, 0, 1}, {0, 1, 0, 1}, {0, 1, 0, -1}};
	float mixed[3][4] = {{1, 0, 0, 1}, {1, 0, 0, -1}, {1, 0, 0, 1}};
	nt_mesh mesh = restore(line, authored, mixed, 0);
	assert_true(mesh.left_tangents == 3 && mesh.replaced_tangents == 0);
	assert_memory_equal(mixed, authored, sizeof mixed);
	float valid[3][4] = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
	mesh = restore(line, authored, valid, 0);
	assert_true(mesh.left_tangents == 0 && mesh.replaced_tangents == 3 && valid[0][0] == 1);
	/* what cannot be drawn goes, whatever comes */
	authored[1][0] = NAN;
	float other[3][4] = {{1, 0, 0, 1}, {1, 0, 0, -1}, {1, 0, 0, 1}};
	mesh = restore(line, authored, other, 0);
	assert_true(mesh.replaced_tangents == 3 && other[1][0] == 1);
}

/* A step of 12 bits of 2 is 0.00049: what is 0.0001 beside -1 was meant to be -1, and is written anew. */
TEST(signs_that_quantization_moved_are_signs)
{
	float square[3][2] = {{0, 0}, {1, 0}, {0, 1}}, solved[3][4] = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
	float authored[3][4] = {{0.9999f, 0.0141f, 0, 1}, {0.9999f, 0.0141f, 0, 1.0001f}, {0.9999f, 0.0141f, 0, 1}};
	nt_mesh mesh = restore(square, authored, solved, 0);
	assert_true(mesh.replaced_tangents == 3 && solved[1][1] == 0);
	mesh = restore(square, authored, solved, 2.0f / 4095);
	assert_true(mesh.replaced_tangents == 1 && solved[1][1] == 0.0141f && solved[1][3] == 1);
}

/* T and B run against u and v, and w is right. */
TEST(reversed_tangents_do_not_stay)
{
	float square[3][2] = {{0, 0}, {1, 0}, {0, 1}}, solved[3][4] = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
	float authored[3][4] = {{-1, 0, 0, 1}, {-1, 0, 0, 1}, {-1, 0, 0, 1}};
	assert_int_equal(restore(square, authored, solved, 0).replaced_tangents, 3);
	for (size_t k = 0; k < 3; k++)
		authored[k][0] = 0, authored[k][1] = 1; /* a right angle is what averaging may do */
	assert_int_equal(restore(square, authored, solved, 0).replaced_tangents, 0);
}
