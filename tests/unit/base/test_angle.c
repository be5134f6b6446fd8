/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "base/angle.h"

/* atan2 of the C library, which glibc computes to less than one unit in the last place, is the judge. */
TEST(angle_is_atan2_to_three_ulps)
{
	for (int i = 0; i <= 200000; i++) {
		const double a = 3.14159265358979323846 * i / 200000.0;
		const double s = sin(a) * (1 + i % 7), c = cos(a) * (1 + i % 7);
		const double expected = atan2(s < 0 ? 0 : s, c);
		assert_true(fabs(nt_angle(s < 0 ? 0 : s, c) - expected) <= 3 * 2.3e-16 * expected);
	}
}

TEST(tiny_angles_keep_their_relative_precision)
{
	for (int e = -300; e < 0; e += 7) {
		const double t = ldexp(1.25, e);
		assert_true(fabs(nt_angle(t, 1) / atan(t) - 1) < 4e-16);
	}
}

TEST(axes_and_nonsense_have_their_values)
{
	assert_true(nt_angle(0, 1) == 0.0);
	assert_true(nt_angle(1, 0) == 1.57079632679489661923);
	assert_true(nt_angle(0, -1) == 3.14159265358979323846);
	assert_true(nt_angle(0, 0) == 0.0);
	assert_true(nt_angle(NAN, 1) == 0.0);
	assert_true(nt_angle(1, NAN) == 0.0);
}

/* To 2^-50 of itself, for points a little off the circle too: the caller's sine and cosine are rounded. */
TEST(angle_of_a_point_on_the_circle_is_atan2)
{
	for (int i = 0; i <= 200000; i++) {
		const double a = 3.14159265358979323846 * i / 200000.0;
		const double s = fabs(sin(a)), c = cos(a), scale = 1 + (i % 3 - 1) * 4.4e-16;
		const double expected = atan2(s, c);
		assert_true(fabs(nt_angle_on_circle(s * scale, c * scale) - expected) <= 0x1p-50 * expected);
	}
	for (int e = -300; e < 0; e += 7) {
		const double t = ldexp(1.25, e), length = hypot(t, 1);
		assert_true(fabs(nt_angle_on_circle(t / length, 1 / length) / atan(t) - 1) < 0x1p-50);
	}
	assert_true(nt_angle_on_circle(0, 0) == 1.57079632679489661923);
	assert_true(nt_angle_on_circle(0, -1) == 3.14159265358979323846);
}
