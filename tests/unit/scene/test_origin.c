/* SPDX-License-Identifier: MIT */
/*
 * The rule of --origin, with positions whose rounding is known: between 2^22 and 2^23 floats are 0.5 apart.
 */
#include "scene/origin.h"
#include "test.h"
#include <string.h>

enum { MOST = 8 };

/* Settles a scene of vertices whose edges are all of one length. */
static nt_scene settle(nt_origin wished, const double *places, size_t count, double edge, float *positions)
{
	double edges[MOST];
	nt_scene scene;
	nt_scene_init(&scene, "t");
	for (size_t i = 0; i < MOST; i++)
		edges[i] = edge;
	for (size_t i = 0; i < 3 * count; i++)
		positions[i] = (float)places[i];
	nt_origin_settle(&scene, &wished, &(nt_exact){places, count, edges, MOST}, positions);
	return scene;
}

static void has(const nt_scene *scene, size_t i, nt_code code, const char *detail, size_t count)
{
	assert_true(i < scene->findings.count);
	assert_int_equal(scene->findings.items[i].code, code);
	assert_string_equal(scene->findings.items[i].detail, detail);
	assert_int_equal(scene->findings.items[i].count, count);
}

static const double far[] = {5000000.125, 0, 0, 5000010.125, 0, 0, 5000010.125, 10, 3};

TEST(the_rounding_of_a_coordinate_is_half_a_step)
{
	assert_true(nt_float_rounding(0) == 0 && nt_float_rounding(INFINITY) == 0);
	assert_true(nt_float_rounding(1) == 0x1p-24);
	assert_true(nt_float_rounding(1.5f) == 0x1p-24);
	assert_true(nt_float_rounding(4194304) == 0.25);
	assert_true(nt_largest_of((const float[]){-3, 2, -0.0f}, 3, 1) == 3);
	assert_true(nt_largest_of((const float[]){0.5f}, 1, 1) == 1);
	assert_true(nt_largest_of((const float[]){1, 2, -9, 3, 4, 5, -6, 7, 8}, 9, 1) == 9);
	assert_true(nt_largest_of((const float[]){1, 2, 3, 4, -5}, 5, 1) == 5);
}

TEST(a_median_of_few_edges_is_doubted_up_to_four_times)
{
	/* 0.25 is a hundredth of 25 */
	assert_true(nt_origin_is_suspected(5000000, (const double[]){99, 99, 1000}, 3, NT_ORIGIN_DOUBT));
	assert_false(nt_origin_is_suspected(5000000, (const double[]){101, 1, 1000}, 3, NT_ORIGIN_DOUBT));
	assert_true(nt_origin_is_suspected(5000000, (const double[]){24, 24, 1000}, 3, 1));
	assert_false(nt_origin_is_suspected(5000000, (const double[]){26, 1, 1000}, 3, 1));
	assert_false(nt_origin_is_suspected(5000000, NULL, 0, 1));
}

TEST(vertices_that_float_moves_by_a_hundredth_of_an_edge_get_an_origin)
{
	float p[9];
	/* an eighth is lost: a hundredth of 12.5 */
	nt_scene scene = settle((nt_origin){0}, far, 3, 12.4, p);
	assert_true(scene.origin[0] == 5000005 && scene.origin[1] == 5 && scene.origin[2] == 2);
	assert_memory_equal(p, ((const float[]){-4.875f, -5, -2, 5.125f, -5, -2, 5.125f, 5, 1}), sizeof p);
	has(&scene, 0, NT_CODE_POS_ORIGIN,
		"5000005,5,2; float would round positions by up to 0.125, which is 0.01 of the median edge 12.4", 1);
	assert_int_equal(scene.findings.count, 1);
	assert_false(scene.positions_rounded);
	static const double moved[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5000005, 5, 2, 1};
	double matrix[16];
	nt_origin_matrix(&scene, matrix);
	assert_memory_equal(matrix, moved, sizeof matrix);
	nt_scene_free(&scene);
	scene = settle((nt_origin){0}, far, 3, 12.6, p);
	assert_false(nt_scene_has_origin(&scene));
	assert_true(p[0] == 5000000);
	assert_int_equal(scene.findings.count, 0);
	nt_scene_free(&scene);
}

TEST(numbers_that_float_holds_need_none)
{
	static const double places[] = {5000000, 0, 0, 5000000.5, 0, 0, 5000000, 0.5, 0};
	float p[9];
	nt_scene scene = settle((nt_origin){0}, places, 3, 0.5, p);
	assert_false(nt_scene_has_origin(&scene));
	assert_int_equal(scene.findings.count, 0);
	nt_scene_free(&scene);
}

TEST(an_origin_is_round_in_the_size_of_the_mesh)
{
	static const double places[] = {431234.1237, 5412345.6789, -0.0004, 431234.1337, 5412345.6789, 0.0003};
	float p[6];
	nt_scene scene = settle((nt_origin){0}, places, 2, 0.001, p);
	char text[NT_ORIGIN_TEXT];
	assert_string_equal(nt_origin_text(scene.origin, text), "431234.129,5412345.679,0");
	assert_false(signbit(scene.origin[2]));
	nt_scene_free(&scene);
	static const double wide[] = {431234123.7, 5412345678.9, 0, 431734123.7, 5412345678.9, 1};
	scene = settle((nt_origin){0}, wide, 2, 100, p);
	assert_string_equal(nt_origin_text(scene.origin, text), "431500000,5412300000,0");
	nt_scene_free(&scene);
}

TEST(kept_positions_are_said_to_be_rounded)
{
	float p[9];
	nt_scene scene = settle((nt_origin){.choice = NT_ORIGIN_KEEP}, far, 3, 1, p);
	assert_false(nt_scene_has_origin(&scene));
	assert_true(scene.positions_rounded && p[3] == 5000010);
	has(&scene, 0, NT_CODE_POS_ROUNDED, "by up to 0.125, which is 0.12 of the median edge 1", 3);
	assert_false(scene.findings.items[0].stays);
	nt_scene_free(&scene);
}

TEST(a_named_origin_is_taken_whether_it_helps_or_not)
{
	float p[9];
	nt_scene scene = settle((nt_origin){NT_ORIGIN_GIVEN, {5000000, 0, 0}}, far, 3, 1000, p);
	has(&scene, 0, NT_CODE_POS_ORIGIN, "5000000,0,0", 1);
	assert_true(p[0] == 0.125f);
	nt_scene_free(&scene);
	scene = settle((nt_origin){NT_ORIGIN_GIVEN, {-5000000, 0, 0}}, far, 3, 1, p);
	assert_int_equal(scene.findings.count, 2);
	has(&scene, 1, NT_CODE_POS_ROUNDED, "by up to 0.125, which is 0.12 of the median edge 1", 3);
	nt_scene_free(&scene);
	scene = settle((nt_origin){.choice = NT_ORIGIN_GIVEN}, far, 3, 1000, p);
	assert_int_equal(scene.findings.count, 0);
	nt_scene_free(&scene);
}

TEST(a_centre_that_moves_more_vertices_is_left)
{
	/* three vertices near 0, one far: what helps the one takes the digits of the others */
	static const double places[] = {0.1, 0, 0, 0.2, 0, 0, 0.3, 0, 0, 800000000.3, 0, 0};
	float p[12];
	nt_scene scene = settle((nt_origin){0}, places, 4, 0.1, p);
	assert_false(nt_scene_has_origin(&scene));
	assert_int_equal(scene.findings.count, 1);
	assert_int_equal(scene.findings.items[0].code, NT_CODE_POS_ROUNDED);
	assert_int_equal(scene.findings.items[0].count, 1);
	assert_true(scene.findings.items[0].stays);
	nt_scene_free(&scene);
}
