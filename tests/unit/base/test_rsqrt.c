/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "base/rsqrt.h"

/* The C library's square root, which is rounded correctly, is the judge. */
static void reciprocal_square_roots_are_good_to_three_ulps(void **state)
{
	(void)state;
	double worst = 0, worst_rough = 0;
	for (int i = 0; i < 1000000; i++) {
		const double x = ldexp(1 + (i * 0.618033988749895 - floor(i * 0.618033988749895)), i % 1990 - 995);
		worst = fmax(worst, fabs(nt_rsqrt(x) * sqrt(x) - 1));
		worst_rough = fmax(worst_rough, fabs(nt_sqrt_rough(x) / sqrt(x) - 1));
	}
	assert_true(worst < 4.5 * 0x1p-53 * 2);
	assert_true(worst_rough < 1e-5);
}

static void zero_gives_something_finite(void **state)
{
	(void)state;
	assert_true(isfinite(nt_rsqrt(0)));
	assert_true(isfinite(nt_rsqrt(0x1p-1074)));
	assert_true(nt_sqrt_rough(0) == 0.0);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(reciprocal_square_roots_are_good_to_three_ulps),
		cmocka_unit_test(zero_gives_something_finite),
	};
	return cmocka_run_group_tests_name("base/rsqrt", tests, NULL, NULL);
}
