/* SPDX-License-Identifier: MIT */
/*
 * sRGB: the values of IEC 61966-2-1, computed apart.
 */
#include "scene/values.h"
#include "test.h"
#include <float.h>
#include <math.h>

TEST(bytes_come_back)
{
	nt_srgb srgb;
	nt_srgb_init(&srgb);
	for (int i = 0; i < 256; i++) {
		const float linear = nt_linear_from_srgb(&srgb, (float)i / 255.0f);
		assert_int_equal(nt_srgb_byte(&srgb, linear), i);
		assert_true(fabsf(nt_srgb_from_linear(linear) - (float)i / 255.0f) < 1e-6f);
	}
	assert_int_equal(nt_srgb_byte(&srgb, 0.5f), -1);
	assert_int_equal(nt_srgb_byte(&srgb, -1.0f), -1);
	assert_int_equal(nt_srgb_byte(&srgb, 2.0f), -1);
	assert_int_equal(nt_srgb_byte(&srgb, NAN), -1);
}

TEST(values_are_those_of_the_standard)
{
	nt_srgb srgb;
	nt_srgb_init(&srgb);
	static const float pairs[][2] = {{0, 0}, {1, 1}, {0.5f, 0.21404114f}, {0.04045f, 0.0031308f},
		{0.04f, 0.0030959752f},
		{1.353256f, 2}};
	for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
		assert_true(fabsf(nt_linear_from_srgb(&srgb, pairs[i][0]) - pairs[i][1]) < 1e-6f);
		assert_true(fabsf(nt_srgb_from_linear(pairs[i][1]) - pairs[i][0]) < 1e-5f);
	}
	assert_true(isnan(nt_linear_from_srgb(&srgb, NAN)));
	for (int k = 0; k < 4; k++) {
		float color[4] = {0.5f, 0.5f, 0.5f, 0.5f};
		assert_false(nt_color_mend(color));
		color[k] = k % 2 ? NAN : -INFINITY;
		assert_true(nt_color_mend(color));
		assert_true(color[0] == 1 && color[1] == 1 && color[2] == 1 && color[3] == 1);
	}
	float colors[] = {0.5f, 1, 0, 0.5f, 0, 0, INFINITY, 0.5f, 0, 0, 0, NAN};
	nt_scene scene;
	nt_scene_init(&scene, "t");
	nt_linearise(&scene, &(nt_mesh){.name = "", .gltf_mesh = NT_NONE, .colors = colors}, 3);
	for (int i = 4; i < 12; i++)
		assert_true(colors[i] == 1);
	assert_int_equal(scene.findings.count, 1);
	assert_int_equal(scene.findings.items[0].count, 2);
	assert_string_equal(scene.findings.items[0].detail, "2 not finite, the first of vertex 1");
	nt_finding_list_free(&scene.findings);
	nt_scene_free(&scene);
	assert_true(colors[0] == nt_linear_from_srgb(&srgb, 0.5f) && colors[1] == 1 && colors[2] == 0 &&
		colors[3] == 0.5f);
}

/* 12.92 * -1.7e38 and ((1e20 + 0.055) / 1.055)^2.4 are no floats: PLY and glTF allow no infinite colour. */
TEST(finite_stays_finite)
{
	nt_srgb srgb;
	nt_srgb_init(&srgb);
	assert_true(nt_srgb_from_linear(-1.7e38f) == -FLT_MAX);
	assert_true(nt_linear_from_srgb(&srgb, 1e20f) == FLT_MAX);
	assert_true(isinf(nt_srgb_from_linear(-INFINITY)) && isinf(nt_linear_from_srgb(&srgb, INFINITY)));
	assert_true(isnan(nt_srgb_from_linear(NAN)));
}
