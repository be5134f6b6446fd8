/* SPDX-License-Identifier: MIT */
/*
 * Differences and products of floats without loss, in double.
 *
 * A difference of two floats is exact in double unless their exponents lie more than 2^29 apart; then it
 * is the sum of two doubles. a b - c d of exact operands is good to 1.5 units in its last place whatever
 * cancels, with one fused residual for each product (W. Kahan; C. Jeannerod, N. Louvet, J. Muller,
 * "Further Analysis of Kahan's Algorithm for the Accurate Computation of 2 x 2 Determinants", 2013). For
 * the rest there are expansions, sums of doubles that are never rounded (J. Shewchuk, "Adaptive Precision
 * Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997).
 *
 * Everything here is a multiple of 2^-298 and below 2^260: nothing overflows, nothing underflows.
 */
#ifndef NT_BASE_EXACT_H
#define NT_BASE_EXACT_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include "base/compiler.h"

/* sum + error = a + b, exactly (Knuth). */
static inline double nt_two_sum(double a, double b, double *error)
{
	const double sum = a + b;
	const double part = sum - a;
	*error = (a - (sum - part)) + (b - part);
	return sum;
}

/* a b + c, rounded once. MinGW's fma() rounds twice; this one adds the errors of product and sums rounded to odd
 * (S. Boldo, G. Melquiond, "Emulation of a FMA and Correctly Rounded Sums", 2008). */
#if defined(__MINGW32__) && !defined(__FMA__)
static inline double nt_fma(double a, double b, double c)
{
	const double product = a * b, as = a * 0x1.0000002p27, bs = b * 0x1.0000002p27;
	const double ah = as - (as - a), al = a - ah, bh = bs - (bs - b), bl = b - bh;
	double tail, low, error;
	const double rest = nt_two_sum(c, al * bl - (((product - ah * bh) - al * bh) - ah * bl), &tail);
	const double sum = nt_two_sum(product, rest, &low);
	double odd = nt_two_sum(low, tail, &error);
	uint64_t bits;
	memcpy(&bits, &odd, sizeof bits);
	if (error != 0.0 && !(bits & 1))
		bits += (error > 0.0) == (odd > 0.0) ? 1 : UINT64_MAX;
	memcpy(&odd, &bits, sizeof bits);
	return sum + odd;
}
#else
#define nt_fma fma
#endif

/* Zero if difference is exactly b - a: an exact difference gives both operands back. Else above, or NaN. Some are added
 * and compared at once, since a branch for each takes longer. */
static inline NT_ALWAYS_INLINE double nt_difference_error(double difference, double a, double b)
{
	return fabs((difference + a) - b) + fabs((b - difference) - a);
}

/* result[0] + result[1] = a - b, exactly. */
static inline void nt_difference(double result[2], float a, float b)
{
	result[0] = nt_two_sum(a, -(double)b, &result[1]);
}

/* a b - c d. */
static inline double nt_product_difference(double a, double b, double c, double d)
{
	const double product = c * d;
	const double residual = nt_fma(-c, d, product);
	return nt_fma(a, b, -product) + residual;
}

enum { NT_PRODUCT_TERMS = 8 }; /* of a product of two differences */

/* The terms of (x[0] + x[1])(y[0] + y[1]) times sign. Returns NT_PRODUCT_TERMS. */
static inline size_t nt_product_terms(double *terms, const double x[2], const double y[2], double sign)
{
	size_t n = 0;
	for (int i = 0; i < 2; i++) {
		for (int k = 0; k < 2; k++) {
			const double product = x[i] * y[k];
			terms[n++] = sign * product;
			terms[n++] = sign * nt_fma(x[i], y[k], -product);
		}
	}
	return n;
}

/* Adds terms[0..count) into an expansion of `count` components, which grow in magnitude. */
static inline void nt_expand(double *expansion, const double *terms, size_t count)
{
	for (size_t n = 0; n < count; n++) {
		double sum = terms[n];
		for (size_t i = 0; i < n; i++)
			sum = nt_two_sum(expansion[i], sum, &expansion[i]);
		expansion[n] = sum;
	}
}

/* x y - z w of differences, rounded once or twice. */
static inline double nt_exact_product_difference(const double x[2], const double y[2], const double z[2],
	const double w[2])
{
	double terms[2 * NT_PRODUCT_TERMS], expansion[2 * NT_PRODUCT_TERMS];
	nt_product_terms(terms, x, y, 1.0);
	nt_product_terms(terms + NT_PRODUCT_TERMS, z, w, -1.0);
	nt_expand(expansion, terms, 2 * NT_PRODUCT_TERMS);
	double sum = 0.0;
	for (size_t i = 0; i < 2 * NT_PRODUCT_TERMS; i++)
		sum += expansion[i];
	return sum;
}

#endif
