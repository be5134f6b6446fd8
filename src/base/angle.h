/* SPDX-License-Identifier: MIT */
/*
 * Angles and reciprocal square roots in double that are the same on every machine: libm's inverse functions differ in
 * their last bit from one C library to the next, and weights must not.
 */
#ifndef NT_BASE_ANGLE_H
#define NT_BASE_ANGLE_H

#include <stdint.h>
#include <string.h>
#include "base/compiler.h"

/* ---- angles ---- */

/* A t in [0, 1], the nearest of eight parts, and its arc tangent. */
typedef struct nt_tangent {
	double t, base, arc;
} nt_tangent;

/* The tangent of the angle that nt_angle() has, or of what it lacks to a right angle: in [0, 1]; 1 of what is no
 * number. */
static inline double nt_lesser_tangent(double s, double c)
{
	const double a = c < 0.0 ? -c : c;
	const double small = s <= a ? s : a, large = s <= a ? a : s;
	const double t = small / (large > 0.0 ? large : 1.0);
	return t < 1.0 ? t : 1.0;
}

/* A table, which loops over lanes have by itself: the rest of nt_angle() is vectors there. */
static inline nt_tangent nt_nearest_arc(double t)
{
	static const double arcs[9] = {0.0, 0.12435499454676143503, 0.24497866312686415417, 0.35877067027057222040,
		0.46364760900080611621, 0.55859931534356243597, 0.64350110879328438680, 0.71882999962162450542,
		0.78539816339744830962};
	const int eighths = (int)(t * 8 + 0.5);
	return (nt_tangent){t, eighths * 0.125, arcs[eighths]};
}

/* nt_angle() of a point whose lesser tangent is known. atan(t) is atan(k/8) of the nearest k, plus atan(r) of what is
 * left, r = (t - k/8) / (1 + t k/8) with |r| <= 1/16. The first term left out of its series is r^15 / 15 < 6e-20. */
static inline double nt_angle_by(nt_tangent tangent, double s, double c)
{
	const double half_pi = 1.57079632679489661923, pi = 3.14159265358979323846;
	const double largest = 1.7976931348623157e308;
	const double r = (tangent.t - tangent.base) / (1.0 + tangent.t * tangent.base);
	const double q = r * r;
	const double series = 1.0 / 3 - q * (1.0 / 5 - q * (1.0 / 7 - q * (1.0 / 9 -
			q * (1.0 / 11 - q * (1.0 / 13)))));
	const double arc = tangent.arc + (r - r * q * series);
	const double a = c < 0.0 ? -c : c;
	const double first = s <= a ? arc : half_pi - arc, angle = c < 0.0 ? pi - first : first;
	return s <= largest && a <= largest ? angle : 0.0;
}

/* The angle in [0, pi] of the point (c, s) on the unit circle, s >= 0, to 2^-50 of itself; of (0, 0) a right one, as
 * acos(0) is. Without a division or a branch, for vectors: the nearest k pi/16 is turned away, and what is left,
 * |r| <= sin(pi/32), has an arc sine whose first term left out is r^15 143/10240 < 2^-53 r. */
static inline NT_ALWAYS_INLINE double nt_angle_on_circle(double s, double c)
{
	const double half_pi = 1.57079632679489661923, pi = 3.14159265358979323846;
	const double a = c < 0.0 ? -c : c;
	const double small = s <= a ? s : a, large = s <= a ? a : s;
	double sine = 0.0, cosine = 1.0, arc = 0.0;
#define NT_ARC_STEP(least, new_sine, new_cosine, new_arc) \
	sine = small >= least ? new_sine : sine; \
	cosine = small >= least ? new_cosine : cosine; \
	arc = small >= least ? new_arc : arc
	/* at sin((k - 1/2) pi/16): sine and cosine of k pi/16 */
	NT_ARC_STEP(0.09801714032956060, 0.19509032201612826785, 0.98078528040323044913, 0.19634954084936207740);
	NT_ARC_STEP(0.29028467725446233, 0.38268343236508977173, 0.92387953251128675613, 0.39269908169872415481);
	NT_ARC_STEP(0.47139673682599764, 0.55557023301960222474, 0.83146961230254523708, 0.58904862254808623221);
	NT_ARC_STEP(0.63439328416364549, 0.70710678118654752440, 0.70710678118654752440, 0.78539816339744830962);
#undef NT_ARC_STEP
	const double r = small * cosine - large * sine;
	const double q = r * r;
	const double series = 1.0 / 6 + q * (3.0 / 40 + q * (5.0 / 112 + q * (35.0 / 1152 + q * (63.0 / 2816 +
			q * (231.0 / 13312)))));
	const double turned = arc + (r + r * (q * series));
	const double first = s < a ? turned : half_pi - turned;
	return c < 0.0 ? pi - first : first;
}

/* The angle in [0, pi] whose sine and cosine are proportional to s >= 0 and c: atan2(s, c). 0 where both
 * are zero or one is not finite. */
static inline double nt_angle(double s, double c)
{
	return nt_angle_by(nt_nearest_arc(nt_lesser_tangent(s, c)), s, c);
}

/* ---- reciprocal square roots ---- */

/*
 * By multiplication alone, quick in vectors: halving and negating the exponent (the bits as an integer) is right to
 * 3.5 %, and each step of Newton's method squares the error: 1.8e-3, 4.7e-6, 3.3e-11, then rounding. A square root and
 * a division take longer.
 *
 * For x in [2^-1000, 2^1000]. For 0 and denormals the result is finite and means nothing.
 */

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
