/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <float.h>
#include <math.h>
#include "topology/corners.h"

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

/* ---- the diagonal that is written ---- */

/* Corners of a quad in whole numbers, and pointers to them as floats. */
typedef struct quad {
	int64_t p[4][3];
	float position[4][3], texcoord[4][2];
	const float *positions[4], *texcoords[4];
} quad;

static void fill(quad *q)
{
	for (int k = 0; k < 4; k++) {
		for (int i = 0; i < 3; i++)
			q->position[k][i] = (float)q->p[k][i];
		q->positions[k] = q->position[k];
		q->texcoords[k] = q->texcoord[k];
	}
}

/* Whether corners a, b and c run against the Newell normal: 1, 0 (upright) or -1. */
static int turn(const quad *q, int a, int b, int c)
{
	int64_t n[3], t[3], sum = 0;
	for (int i = 0; i < 3; i++) {
		const int j = (i + 1) % 3, k = (i + 2) % 3;
		n[i] = t[i] = 0;
		for (int v = 0; v < 4; v++)
			n[i] += q->p[v][j] * q->p[(v + 1) % 4][k] - q->p[v][k] * q->p[(v + 1) % 4][j];
		t[i] += (q->p[b][j] - q->p[a][j]) * (q->p[c][k] - q->p[a][k]) -
			(q->p[b][k] - q->p[a][k]) * (q->p[c][j] - q->p[a][j]);
	}
	for (int i = 0; i < 3; i++)
		sum += n[i] * t[i];
	return (sum > 0) - (sum < 0);
}

/* A dart, whose corner 2 turns inwards: cut 0-2 it has two good triangles, cut 1-3 one lies outside. In space: in each
 * of its rotations and with either winding, flat and bent, and turned in space by a matrix of whole numbers. Texture
 * coordinates that ask for either diagonal change nothing. */
TEST(a_dart_is_written_along_its_inner_diagonal)
{
	static const int64_t dart[4][2] = {{0, 0}, {8, 2}, {3, 3}, {2, 8}};
	static const int64_t turned[3][3] = {{1, 2, 2}, {2, 1, -2}, {2, -2, 1}};
	for (int i = 0; i < 4 * 2 * 3 * 2 * 2; i++) {
		const int rotation = i % 4, mirrored = i / 4 % 2, bend = i / 8 % 3 - 1, wish = i / 24 % 2;
		quad q = {0};
		for (int k = 0; k < 4; k++) {
			const int from = ((mirrored ? 4 - k : k) + rotation) % 4;
			const int64_t flat[3] = {dart[from][0], dart[from][1], from % 2 ? bend : 0};
			for (int row = 0; row < 3; row++)
				for (int c = 0; c < 3; c++)
					q.p[k][row] += i / 48 ? turned[row][c] * flat[c] : (row == c) * flat[c];
			q.texcoord[k][0] = k % 2 == wish ? 0 : k < 2 ? 1 : -1;
		}
		fill(&q);
		assert_int_equal(nt_quad_diagonal(q.texcoords, q.positions), wish);
		assert_int_equal(nt_written_quad_diagonal(wish, q.positions), rotation % 2);
	}
}

/* At most one corner of a simple outline turns inwards. Two triangles of one that crosses itself do, along either
 * diagonal one triangle is inverted, and MikkTSpace's stays; so it does where it is good. */
TEST(no_written_triangle_of_a_simple_quad_is_inverted)
{
	uint32_t seed = 11;
	size_t changed = 0, crossed = 0;
	for (int i = 0; i < 20000; i++) {
		quad q;
		const int depth = i % 3 ? 64 : 1; /* bent, or flat */
		for (int k = 0; k < 4; k++) {
			for (int c = 0; c < 3; c++)
				q.p[k][c] = (int64_t)(next_random(&seed) % 64) * (c < 2) +
					    (int64_t)(next_random(&seed) % (uint32_t)depth) * (c == 2);
			for (int c = 0; c < 2; c++)
				q.texcoord[k][c] = (float)(next_random(&seed) % 64);
		}
		fill(&q);
		const int mikktspace = nt_quad_diagonal(q.texcoords, q.positions);
		const int written = nt_written_quad_diagonal(mikktspace, q.positions);
		int inwards = 0, inverted[2] = {0, 0};
		for (int k = 0; k < 4; k++) {
			const int inward = turn(&q, (k + 3) % 4, k, (k + 1) % 4) < 0;
			inwards += inward;
			inverted[k % 2 == 0] += inward; /* the diagonal 1-3 cuts off corners 0 and 2 */
		}
		assert_true(inwards <= 2);
		if (inwards < 2)
			assert_int_equal(inverted[written], 0);
		if (inwards == 2 || !inverted[mikktspace])
			assert_int_equal(written, mikktspace);
		changed += written != mikktspace;
		crossed += inwards == 2;
	}
	assert_true(changed > 1000 && crossed > 1000);
}

/* Nothing is known of it. */
TEST(a_quad_without_a_normal_is_written_as_it_is_solved)
{
	for (int i = 0; i < 4; i++) {
		quad q = {.p = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}};
		fill(&q);
		q.position[i][1] = i ? NAN : 0;
		assert_int_equal(nt_written_quad_diagonal(0, q.positions), 0);
		assert_int_equal(nt_written_quad_diagonal(1, q.positions), 1);
	}
}
