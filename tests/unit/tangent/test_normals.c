/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "tangent/normals.h"

/* Two quads that meet at a right angle along the y axis: one in z = 0 (normal +z), one in x = 0 below
 * it (normal +x). Vertices of the edge are separate, as at a texture seam. */
static const float positions[8][3] = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {0, 0, 0}, {0, 0, -1},
	{0, 1, -1}, {0, 1, 0}};
static const uint8_t quads[2] = {4, 4};
static const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2, .vertex_count = 8,
	.face_sizes = quads,
	.positions = &positions[0][0], .position_stride_bytes = 12};

static void make(const uint32_t *smoothing, float (*normals)[3])
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	assert_int_equal(nt_corner_normals(&mesh, 8, smoothing, &scratch, normals), NMTAN_OK);
	nt_scratch_free(&scratch);
}

static void assert_near(const float *n, float x, float y, float z)
{
	assert_true(fabsf(n[0] - x) < 1e-6f && fabsf(n[1] - y) < 1e-6f && fabsf(n[2] - z) < 1e-6f);
}

/* Both corner angles are 90 degrees: the edge's normal is the bisector. */
static void smooth_normals_meet_across_separate_vertices(void **state)
{
	(void)state;
	float n[8][3];
	const float h = sqrtf(0.5f);
	make(NULL, n);
	assert_near(n[0], 0, 0, 1);
	assert_near(n[1], h, 0, h);
	assert_near(n[4], h, 0, h);
	assert_near(n[2], h, 0, h);
	assert_near(n[7], h, 0, h);
	assert_near(n[5], 1, 0, 0);
}

static void groups_keep_apart_and_group_zero_is_flat(void **state)
{
	(void)state;
	const uint32_t apart[2] = {1, 2}, flat[2] = {0, 0};
	const uint32_t *both[2] = {apart, flat};
	for (int i = 0; i < 2; i++) {
		float n[8][3];
		make(both[i], n);
		for (int c = 0; c < 4; c++)
			assert_near(n[c], 0, 0, 1);
		for (int c = 4; c < 8; c++)
			assert_near(n[c], 1, 0, 0);
	}
}

/* A cube's corner: one face is cut into two triangles at it, which must not weigh twice. With angle weights
 * the normal is the diagonal (1,1,1)/sqrt 3. */
static void angle_weights_do_not_depend_on_the_cut(void **state)
{
	(void)state;
	const float p[12][3] = {{0, 0, 0}, {0, -1, 0}, {-1, 0, 0}, /* z = 0, first half would be 45 */
		{0, 0, 0}, {0, 0, -1}, {0, -1, -1}, {0, 0, 0}, {0, -1, -1}, {0, -1, 0}, /* x = 0, cut */
		{0, 0, 0}, {-1, 0, 0}, {0, 0, -1}};                                    /* y = 0 */
	const nmtan_mesh cube = {.struct_bytes = sizeof cube, .face_count = 4, .vertex_count = 12,
		.positions = &p[0][0],
		.position_stride_bytes = 12};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	float n[12][3];
	assert_int_equal(nt_corner_normals(&cube, 12, NULL, &scratch, n), NMTAN_OK);
	nt_scratch_free(&scratch);
	const float d = fabsf(n[0][0]);
	assert_true(fabsf(d - 0.57735027f) < 1e-6f);
	for (int i = 0; i < 3; i++)
		assert_true(fabsf(fabsf(n[0][i]) - d) < 1e-6f);
}

static void faces_without_area_give_a_unit_vector(void **state)
{
	(void)state;
	const float p[3][3] = {{1, 1, 1}, {1, 1, 1}, {2, 2, 2}};
	const nmtan_mesh sliver = {.struct_bytes = sizeof sliver, .face_count = 1, .vertex_count = 3,
		.positions = &p[0][0],
		.position_stride_bytes = 12};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	float n[3][3];
	assert_int_equal(nt_corner_normals(&sliver, 3, NULL, &scratch, n), NMTAN_OK);
	nt_scratch_free(&scratch);
	for (int c = 0; c < 3; c++)
		assert_near(n[c], 0, 0, 1);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(smooth_normals_meet_across_separate_vertices),
		cmocka_unit_test(groups_keep_apart_and_group_zero_is_flat),
		cmocka_unit_test(angle_weights_do_not_depend_on_the_cut),
		cmocka_unit_test(faces_without_area_give_a_unit_vector),
	};
	return cmocka_run_group_tests_name("tangent/normals", tests, NULL, NULL);
}
