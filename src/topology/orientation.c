/* SPDX-License-Identifier: MIT */
/*
 * Exact orientation: the slow half of orientation.h, and the cut of quads.
 *
 * The determinant of a triangle is (bu)(cv) - (bv)(cu). Each difference is a sum of two doubles, each
 * product of two doubles a sum of two, so the determinant is a sum of 16 doubles, all multiples of
 * 2^-298 below 2^260: nothing overflows, nothing underflows, and the expansion is exact.
 */
#include "topology/orientation.h"

#include <math.h>
#include <stddef.h>

enum { DETERMINANT_TERMS = 16 };

/* sum + error = a + b, exactly (Knuth). */
static double two_sum(double a, double b, double *error)
{
	const double sum = a + b;
	const double part = sum - a;
	*error = (a - (sum - part)) + (b - part);
	return sum;
}

/* Adds b to an expansion of n components, which grow in magnitude. */
static size_t grow_expansion(double *expansion, size_t n, double b)
{
	double sum = b;
	for (size_t i = 0; i < n; i++)
		sum = two_sum(expansion[i], sum, &expansion[i]);
	expansion[n] = sum;
	return n + 1;
}

/* Sign of a sum of terms: that of the largest component that is not zero. */
static int sign_of_sum(const double *terms, size_t count)
{
	double expansion[2 * DETERMINANT_TERMS];
	size_t n = 0;
	for (size_t i = 0; i < count; i++)
		n = grow_expansion(expansion, n, terms[i]);
	while (n > 0 && expansion[n - 1] == 0.0)
		n--;
	return n == 0 ? 0 : expansion[n - 1] > 0.0 ? 1 : -1;
}

/* The terms of (xh + xl)(yh + yl) times sign. */
static size_t product_terms(double *terms, const double x[2], const double y[2], double sign)
{
	size_t n = 0;
	for (int i = 0; i < 2; i++) {
		for (int k = 0; k < 2; k++) {
			const double product = x[i] * y[k];
			terms[n++] = sign * product;
			terms[n++] = sign * fma(x[i], y[k], -product);
		}
	}
	return n;
}

static void difference(double result[2], float a, float b)
{
	result[0] = two_sum(a, -(double)b, &result[1]);
}

static int is_finite(const float a[2])
{
	return isfinite(a[0]) && isfinite(a[1]);
}

/* The determinant times sign as a sum of terms; all zero where a value is not finite. */
static void determinant_terms(double terms[DETERMINANT_TERMS], const float a[2], const float b[2],
	const float c[2], double sign)
{
	for (int i = 0; i < DETERMINANT_TERMS; i++)
		terms[i] = 0.0;
	if (!is_finite(a) || !is_finite(b) || !is_finite(c))
		return;
	double bu[2], bv[2], cu[2], cv[2];
	difference(bu, b[0], a[0]);
	difference(bv, b[1], a[1]);
	difference(cu, c[0], a[0]);
	difference(cv, c[1], a[1]);
	const size_t half = product_terms(terms, bu, cv, sign);
	product_terms(terms + half, bv, cu, -sign);
}

int nt_orientation_slow(const float a[2], const float b[2], const float c[2])
{
	double terms[DETERMINANT_TERMS];
	determinant_terms(terms, a, b, c, 1.0);
	return sign_of_sum(terms, DETERMINANT_TERMS);
}

int nmtan_orientation(const float a[2], const float b[2], const float c[2])
{
	return nt_orientation(a, b, c);
}

int nt_compare_area(const float a[2], const float b[2], const float c[2], const float d[2],
	const float e[2], const float f[2])
{
	double terms[2 * DETERMINANT_TERMS];
	determinant_terms(terms, a, b, c, nt_orientation_slow(a, b, c));
	determinant_terms(terms + DETERMINANT_TERMS, d, e, f, -nt_orientation_slow(d, e, f));
	return sign_of_sum(terms, 2 * DETERMINANT_TERMS);
}

const unsigned char nt_quad_triangles[2][2][3] = {
	{{0, 1, 2}, {0, 2, 3}},
	{{0, 1, 3}, {1, 2, 3}},
};

static float squared_distance(const float *a, const float *b, int dimensions)
{
	float sum = 0.0f;
	for (int i = 0; i < dimensions; i++)
		sum += (b[i] - a[i]) * (b[i] - a[i]);
	return sum;
}

int nt_quad_diagonal(const float *const texcoords[4], const float *const positions[4])
{
	const float uv02 = squared_distance(texcoords[0], texcoords[2], 2);
	const float uv13 = squared_distance(texcoords[1], texcoords[3], 2);
	if (uv02 < uv13)
		return 0;
	if (uv13 < uv02)
		return 1;
	return squared_distance(positions[1], positions[3], 3) <
	       squared_distance(positions[0], positions[2], 3);
}
