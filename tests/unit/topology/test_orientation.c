/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <float.h>
#include <math.h>
#include "topology/orientation.h"

TEST(orientation_is_positive_counterclockwise)
{
	const float a[2] = {0, 0}, b[2] = {1, 0}, c[2] = {0, 1};
	assert_int_equal(nmtan_orientation(a, b, c), 1);
	assert_int_equal(nmtan_orientation(a, c, b), -1);
	assert_int_equal(nmtan_orientation(a, b, b), 0);
}

/* Needles whose float determinant rounds to zero or to the wrong sign. With a = (0, 0), b = (1, 1 + e),
 * c = (1 + e, 1 + 3 e), e = 2^-23: det = 1 + 3e - (1 + e)^2 = e - e^2 > 0. */
TEST(orientation_of_needles_is_exact)
{
	const float e = FLT_EPSILON;
	const float a[2] = {0, 0}, b[2] = {1, 1 + e}, c[2] = {1 + e, 1 + 3 * e};
	assert_int_equal(nt_orientation(a, b, c), 1);
	/* det = (1 + 2e) * 1 - (1 + e)^2 = -e^2: equal in double products too were it not for fma */
	const float f[2] = {1 + e, 1}, g[2] = {1 + 2 * e, 1 + e};
	assert_int_equal(nt_orientation(a, f, g), 1);   /* (1+e)(1+e) - (1+2e) = e^2 */
	assert_int_equal(nt_orientation(a, g, f), -1);
}

/* (b - a) needs 224 bits: only expansions see the 2^-100. det of (2^100, 2^-100), (2^100, 2^-101) about
 * the origin shifted to (2^-120, 0) is 2^100 (2^-101 - 2^-100) + ... < 0 whatever is added. */
TEST(orientation_takes_mixed_exponents)
{
	const float big = ldexpf(1, 100), small = ldexpf(1, -100);
	const float a[2] = {ldexpf(1, -120), 0}, b[2] = {big, small}, c[2] = {big, small / 2};
	assert_int_equal(nt_orientation(a, b, c), -1);
	/* symmetric about the origin: exactly collinear; a nudge of one unit in the last place is seen */
	const float o[2] = {0, 0}, p[2] = {big, small}, q[2] = {-big, -small};
	const float r[2] = {-big, -nextafterf(small, 1)};
	assert_int_equal(nt_orientation(o, p, q), 0);
	assert_int_equal(nt_orientation(o, p, r), -1);
	/* det(p, q, r) = (-2 big)(-(small' + small)) - (-2 small)(-2 big) = 2 big (small' - small) > 0 */
	assert_int_equal(nt_orientation(p, q, r), 1);
}

TEST(orientation_of_values_that_are_not_finite_is_zero)
{
	const float a[2] = {0, 0}, b[2] = {1, 0}, n[2] = {NAN, 1}, i[2] = {0, INFINITY};
	assert_int_equal(nt_orientation(a, b, n), 0);
	assert_int_equal(nt_orientation(a, b, i), 0);
	assert_int_equal(nt_orientation(i, i, b), 0);
}

/* A linear congruential generator: the same numbers everywhere. */
static uint32_t next_random(uint32_t *seed)
{
	*seed = *seed * 1664525u + 1013904223u;
	return *seed >> 8;
}

/* Small integers: the determinant is exact in 64 bits. Scaling by powers of two and swapping keeps or
 * flips the sign; the slow path agrees with the fast one. */
TEST(orientation_agrees_with_integers)
{
	uint32_t seed = 1;
	for (int i = 0; i < 20000; i++) {
		int64_t x[6];
		float v[6], scaled[6];
		for (int k = 0; k < 6; k++) {
			x[k] = (int64_t)(next_random(&seed) % (i % 2 ? 7 : 16777216)) - (i % 2 ? 3 : 8388608);
			v[k] = (float)x[k];
			scaled[k] = ldexpf(v[k], i % 100 - 140);
		}
		const int64_t det = (x[2] - x[0]) * (x[5] - x[1]) - (x[3] - x[1]) * (x[4] - x[0]);
		const int sign = (det > 0) - (det < 0);
		assert_int_equal(nt_orientation(v, v + 2, v + 4), sign);
		assert_int_equal(nt_orientation_slow(v, v + 2, v + 4), sign);
		if (i % 100 - 140 >= -126) /* no bits lost to denormals */
			assert_int_equal(nt_orientation(scaled, scaled + 2, scaled + 4), sign);
		float w[6];
		int64_t other[6];
		for (int k = 0; k < 6; k++) {
			other[k] = (int64_t)(next_random(&seed) % 7) - 3;
			w[k] = (float)other[k];
		}
		const int64_t det2 = (other[2] - other[0]) * (other[5] - other[1]) -
				     (other[3] - other[1]) * (other[4] - other[0]);
		const int64_t a = det < 0 ? -det : det, b = det2 < 0 ? -det2 : det2;
		assert_int_equal(nt_compare_area(v, v + 2, v + 4, w, w + 2, w + 4), (a > b) - (a < b));
	}
}

/* Differences of 53 bits, so that products are rounded and tie: a is 2^-29 times small integers, c = 2 b of 24 bits.
 * (b - a) x (2 b - a) = b x a. */
TEST(orientation_of_ties_is_decided_by_residuals)
{
	uint32_t seed = 7;
	int ties = 0;
	for (int i = 0; i < 20000; i++) {
		const int64_t k[2] = {(int64_t)(next_random(&seed) % 7) - 3, (int64_t)(next_random(&seed) % 7) - 3};
		const int64_t x[2] = {(int64_t)(next_random(&seed) | 1 << 23), (int64_t)(next_random(&seed) | 1 << 23)};
		const float a[2] = {ldexpf((float)k[0], -29), ldexpf((float)k[1], -29)};
		const float b[2] = {(float)x[0], (float)x[1]}, c[2] = {2 * b[0], 2 * b[1]};
		const int64_t det = x[0] * k[1] - x[1] * k[0];
		const int sign = (det > 0) - (det < 0);
		assert_int_equal(nt_orientation(a, b, c), sign);
		assert_int_equal(nt_orientation_slow(a, b, c), sign);
		const double left = ((double)b[0] - a[0]) * ((double)c[1] - a[1]);
		ties += left == ((double)b[1] - a[1]) * ((double)c[0] - a[0]) && sign != 0;
	}
	assert_true(ties > 1000);
}

TEST(quad_diagonal_is_the_shorter_one_in_uv_then_in_space)
{
	const float square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
	const float kite[4][2] = {{0, 0}, {1, 0}, {2, 2}, {0, 1}};
	const float flat[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
	const float tall[4][3] = {{0, 0, 5}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
	const float *uv_square[4] = {square[0], square[1], square[2], square[3]};
	const float *uv_kite[4] = {kite[0], kite[1], kite[2], kite[3]};
	const float *pos_flat[4] = {flat[0], flat[1], flat[2], flat[3]};
	const float *pos_tall[4] = {tall[0], tall[1], tall[2], tall[3]};
	assert_int_equal(nt_quad_diagonal(uv_kite, pos_flat), 1);
	assert_int_equal(nt_quad_diagonal(uv_square, pos_tall), 1);
	assert_int_equal(nt_quad_diagonal(uv_square, pos_flat), 0);
}

int main(void)
{
	return run_group("topology/orientation");
}
