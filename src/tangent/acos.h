/* SPDX-License-Identifier: MIT */
/*
 * The arc cosine of a corner's angle, without libm, so that a loop over lanes can hold it.
 *
 * MikkTSpace's weight is (float)acos((double)c) with a float c in [-1, 1]. With z = c^2 for |c| <= 1/2
 * and z = (1 - |c|) / 2 otherwise, asin(sqrt z) = sqrt z + z sqrt z P(z) on [0, 1/4], and
 *
 *     acos(c) = pi/2 - asin(c)              |c| <= 1/2
 *     acos(c) = 2 asin(sqrt z)              c > 1/2
 *     acos(c) = pi - 2 asin(sqrt z)         c < -1/2
 *
 * P has ten terms, the minimax fit (Remez, equal ripples of 5.1e-14) of (asin(sqrt z) / sqrt z - 1) / z. After
 * rounding to float the result equals glibc 2.36's for every one of the 2 130 706 434 floats of [-1, 1]
 * (make soak tries them all); NaN gives NaN.
 */
#ifndef NT_TANGENT_ACOS_H
#define NT_TANGENT_ACOS_H

#include <math.h>
#include "base/compiler.h"

/* One term of the polynomial. If the instruction set has FMA, the rounding differs, and with it about one
 * bit in 2^53; the float that comes out is the same, which was tried for all of them as well. */
#if defined(__FMA__) || defined(NT_SET_AVX2) || defined(__aarch64__)
#define NT_ACOS_TERM(p, z, coefficient) fma(p, z, coefficient)
#else
#define NT_ACOS_TERM(p, z, coefficient) ((p) * (z) + (coefficient))
#endif

static inline float nt_acos(float c)
{
	const double pi = 3.14159265358979323846;
	const double x = (double)c, a = fabs(x);
	const double z = a <= 0.5 ? x * x : (1.0 - a) * 0.5;
	const double s = a <= 0.5 ? x : sqrt(z);
	double p = 0x1.ccdb4239f45a1p-6;
	p = NT_ACOS_TERM(p, z, -0x1.a1e9daa4c0240p-9);
	p = NT_ACOS_TERM(p, z, 0x1.02bc50399d2b2p-6);
	p = NT_ACOS_TERM(p, z, 0x1.af2e385b113bdp-7);
	p = NT_ACOS_TERM(p, z, 0x1.1dd5027c5c2b6p-6);
	p = NT_ACOS_TERM(p, z, 0x1.6e7085416ab91p-6);
	p = NT_ACOS_TERM(p, z, 0x1.f1c82fafb0b11p-6);
	p = NT_ACOS_TERM(p, z, 0x1.6db6d8ab0fd67p-5);
	p = NT_ACOS_TERM(p, z, 0x1.33333335f1756p-4);
	p = NT_ACOS_TERM(p, z, 0x1.5555555554e25p-3);
	const double asin_s = NT_ACOS_TERM(s * z, p, s);
	const double far = x < 0.0 ? pi - 2.0 * asin_s : 2.0 * asin_s;
	return (float)(a <= 0.5 ? pi * 0.5 - asin_s : far);
}

#endif
