/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "gltf/quantize.h"

TEST(axes_and_signs_are_exact)
{
	float tangents[3][4] = {{1, 0, 0, 1}, {0, -1, 0, -1}, {0, 0, 1, -1}};
	const float same[3][4] = {{1, 0, 0, 1}, {0, -1, 0, -1}, {0, 0, 1, -1}};
	const int16_t shorts[3][4] = {{32767, 0, 0, 32767}, {0, -32767, 0, -32767}, {0, 0, 32767, -32767}};
	const int8_t bytes[3][4] = {{127, 0, 0, 127}, {0, -127, 0, -127}, {0, 0, 127, -127}};
	unsigned char out[3 * 8];
	nt_rounding cost = {0};
	nt_precision_round(NT_PRECISION_SHORT, tangents[0], 3, &cost);
	assert_memory_equal(tangents, same, sizeof same);
	nt_precision_encode(NT_PRECISION_SHORT, tangents[0], 3, out);
	assert_memory_equal(out, shorts, sizeof shorts);
	nt_precision_round(NT_PRECISION_BYTE, tangents[0], 3, &cost);
	nt_precision_encode(NT_PRECISION_BYTE, tangents[0], 3, out);
	assert_memory_equal(out, bytes, sizeof bytes);
	assert_int_equal(cost.count, 6);
	assert_true(cost.worst_radians == 0 && cost.sum_radians == 0);
}

/* (3, 4, 0) / 5 of 32767 is (19660.2, 26213.6, 0). The nearest vector, (19660, 26214), is off by
 * |4 * 19660 - 3 * 26214| = 2; (19660, 26213) by 1, with a sine of 1 / (5 * 32766.4) = 6.104e-6. */
TEST(the_nearest_direction_is_taken_not_the_nearest_vector)
{
	float row[4] = {0.6f, 0.8f, 0, 1};
	int16_t out[4];
	nt_rounding cost = {0};
	nt_precision_round(NT_PRECISION_SHORT, row, 1, &cost);
	nt_precision_encode(NT_PRECISION_SHORT, row, 1, (unsigned char *)out);
	assert_int_equal(out[0], 19660);
	assert_int_equal(out[1], 26213);
	assert_int_equal(out[2], 0);
	/* 0.6f and 0.8f are 3 : 4 to 6e-8 */
	assert_true(fabs(cost.worst_radians - 6.104e-6) < 1e-7);
	assert_true(cost.sum_radians == cost.worst_radians && cost.count == 1);
}

/* 127 / sqrt 3 = 73.32: (73, 73, 73) has the direction and a length of 126.44 / 127 = 1 - 0.0044;
 * (74, 74, 74) has it too and is too long by 0.0092. */
TEST(lengths_stay_within_the_validators_tolerance)
{
	float row[4] = {-0.57735027f, 0.57735027f, 0.57735027f, 1};
	int8_t out[4];
	nt_rounding cost = {0};
	nt_precision_round(NT_PRECISION_BYTE, row, 1, &cost);
	nt_precision_encode(NT_PRECISION_BYTE, row, 1, (unsigned char *)out);
	assert_memory_equal(out, ((int8_t[]){-73, 73, 73, 127}), 4);
	assert_true(cost.worst_radians < 1e-7);

	/* a spiral over the sphere; plain rounding is off by sqrt(3) / 2 of 127 = 0.0068 at worst */
	for (int precision = NT_PRECISION_SHORT; precision <= NT_PRECISION_BYTE; precision++) {
		const double step = precision == NT_PRECISION_SHORT ? 1 / 32767.0 : 1 / 127.0;
		for (int i = 0; i < 100000; i++) {
			const double z = (i + 0.5) / 50000 - 1, angle = 2.399963 * i, r = sqrt(1 - z * z);
			float t[4] = {(float)(r * cos(angle)), (float)(r * sin(angle)), (float)z, i % 2 ? 1 : -1};
			cost = (nt_rounding){0};
			nt_precision_round((nt_precision)precision, t, 1, &cost);
			const float length = sqrtf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
			assert_true(fabsf(length - 1) <= 0.00674f);
			assert_true(t[3] == (i % 2 ? 1.0f : -1.0f));
			/* no farther than the farthest a cell's nearest corner can be */
			assert_true(cost.count == 1 && cost.worst_radians <= 0.8661 * step);
		}
	}
}

TEST(what_has_no_direction_becomes_zero)
{
	float tangents[3][4] = {{0, 0, 0, 1}, {NAN, 0, 1, -1}, {1, 0, 0, NAN}};
	int8_t out[3][4];
	nt_rounding cost = {0};
	nt_precision_round(NT_PRECISION_BYTE, tangents[0], 3, &cost);
	nt_precision_encode(NT_PRECISION_BYTE, tangents[0], 3, (unsigned char *)out);
	assert_memory_equal(out, ((int8_t[]){0, 0, 0, 127, 0, 0, 0, -127, 127, 0, 0, 127}), 12);
	assert_int_equal(cost.count, 1);
}
