/* SPDX-License-Identifier: MIT */
/*
 * Angles in double that are the same on every machine: libm's inverse functions differ in their last bit
 * from one C library to the next, and weights must not.
 */
#ifndef NT_BASE_ANGLE_H
#define NT_BASE_ANGLE_H

/* atan(t) for t in [0, 1]: atan(k/8) of the nearest k, plus atan(r) of what is left,
 * r = (t - k/8) / (1 + t k/8) with |r| <= 1/16. The first term left out of its series is
 * r^15 / 15 < 6e-20. */
static inline double nt_atan_unit(double t)
{
	static const double atan_eighths[9] = {0.0, 0.12435499454676143503, 0.24497866312686415417,
		0.35877067027057222040, 0.46364760900080611621, 0.55859931534356243597,
		0.64350110879328438680, 0.71882999962162450542, 0.78539816339744830962};
	const int k = (int)(t * 8.0 + 0.5);
	const double base = k / 8.0;
	const double r = (t - base) / (1.0 + t * base);
	const double q = r * r;
	const double series = 1.0 / 3 - q * (1.0 / 5 - q * (1.0 / 7 - q * (1.0 / 9 -
			q * (1.0 / 11 - q * (1.0 / 13)))));
	return atan_eighths[k] + (r - r * q * series);
}

/* The angle in [0, pi] whose sine and cosine are proportional to s >= 0 and c: atan2(s, c). 0 where both
 * are zero or one is NaN. */
static inline double nt_angle(double s, double c)
{
	const double half_pi = 1.57079632679489661923, pi = 3.14159265358979323846;
	const double a = c < 0.0 ? -c : c;
	if (!(s > 0.0) && !(a > 0.0))
		return 0.0;
	if (s != s || a != a)
		return 0.0;
	const double first = s <= a ? nt_atan_unit(s / a) : half_pi - nt_atan_unit(a / s);
	return c < 0.0 ? pi - first : first;
}

#endif
