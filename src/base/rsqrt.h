/* SPDX-License-Identifier: MIT */
/*
 * Reciprocal square roots by multiplication alone, the same on every machine and quick in vectors: halving
 * and negating the exponent (the bits as an integer) is right to 3.5 %, and each step of Newton's method
 * squares the error: 1.8e-3, 4.7e-6, 3.3e-11, then rounding. A square root and a division take longer.
 *
 * For x in [2^-1000, 2^1000]. For 0 and denormals the result is finite and means nothing.
 */
#ifndef NT_BASE_RSQRT_H
#define NT_BASE_RSQRT_H

#include <stdint.h>
#include <string.h>
#include "base/compiler.h"

static inline NT_ALWAYS_INLINE double nt_rsqrt_guess(double x)
{
	uint64_t bits;
	memcpy(&bits, &x, sizeof bits);
	bits = 0x5fe6eb50c7b537a9u - (bits >> 1);
	memcpy(&x, &bits, sizeof x);
	return x;
}

/* 1 / sqrt(x), good to 3 units in the last place. */
static inline NT_ALWAYS_INLINE double nt_rsqrt(double x)
{
	const double half = 0.5 * x;
	double y = nt_rsqrt_guess(x);
	y = y * (1.5 - half * y * y);
	y = y * (1.5 - half * y * y);
	y = y * (1.5 - half * y * y);
	return y * (1.5 - half * y * y);
}

/* sqrt(x) to five digits: for estimates. 0 of 0. */
static inline NT_ALWAYS_INLINE double nt_sqrt_rough(double x)
{
	const double half = 0.5 * x;
	double y = nt_rsqrt_guess(x);
	y = y * (1.5 - half * y * y);
	return x * (y * (1.5 - half * y * y));
}

#endif
