/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "base/angle.h"

/* The C library's square root, which is rounded correctly, is the judge. */
TEST(reciprocal_square_roots_are_good_to_three_ulps)
{
	double worst = 0, worst_rough = 0;
	for (int i = 0; i < 1000000; i++) {
		const double x = ldexp(1 + (i * 0.618033988749895 - floor(i * 0.618033988749895)), i % 1990 - 995);
		worst = fmax(worst, fabs(nt_rsqrt(x) * sqrt(x) - 1));
		worst_rough = fmax(worst_rough, fabs(nt_sqrt_rough(x) / sqrt(x) - 1));
	}
	assert_true(worst < 4.5 * 0x1p-53 * 2);
	assert_true(worst_rough < 1e-5);
}

TEST(zero_gives_something_finite)
{
	assert_true(isfinite(nt_rsqrt(0)));
	assert_true(isfinite(nt_rsqrt(0x1p-1074)));
	assert_true(nt_sqrt_rough(0) == 0.0);
}
