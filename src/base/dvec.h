/* SPDX-License-Identifier: MIT */
/*
 * Vectors of three doubles, for the methods that are not bound to MikkTSpace's float arithmetic. Values
 * come from floats, so that products of four of them neither overflow nor vanish.
 */
#ifndef NT_BASE_DVEC_H
#define NT_BASE_DVEC_H

#include <math.h>
#include <stdbool.h>

typedef struct nt_dvec3 {
	double x, y, z;
} nt_dvec3;

static inline nt_dvec3 nt_dvec3_load(const float *p)
{
	return (nt_dvec3){p[0], p[1], p[2]};
}

static inline void nt_dvec3_store(nt_dvec3 v, float *to)
{
	to[0] = (float)v.x;
	to[1] = (float)v.y;
	to[2] = (float)v.z;
}

static inline nt_dvec3 nt_dvec3_add(nt_dvec3 a, nt_dvec3 b)
{
	return (nt_dvec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline nt_dvec3 nt_dvec3_sub(nt_dvec3 a, nt_dvec3 b)
{
	return (nt_dvec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline nt_dvec3 nt_dvec3_scale(double s, nt_dvec3 v)
{
	return (nt_dvec3){s * v.x, s * v.y, s * v.z};
}

static inline double nt_dvec3_dot(nt_dvec3 a, nt_dvec3 b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline nt_dvec3 nt_dvec3_cross(nt_dvec3 a, nt_dvec3 b)
{
	return (nt_dvec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double nt_dvec3_length(nt_dvec3 v)
{
	return sqrt(nt_dvec3_dot(v, v));
}

/* The largest magnitude of a component; of numbers alone. Not fmax(), which is a call. */
static inline double nt_dvec3_largest(nt_dvec3 v)
{
	const double x = fabs(v.x), y = fabs(v.y), z = fabs(v.z), larger = x > y ? x : y;
	return larger > z ? larger : z;
}

/* v scaled to unit length; false, and v as it was, where it is zero or not finite. Scaled by its largest
 * component first, so that squares of tiny vectors do not vanish. */
static inline bool nt_dvec3_normalise(nt_dvec3 *v)
{
	const double largest = nt_dvec3_largest(*v);
	if (!(largest > 0.0) || !isfinite(largest) || !isfinite(v->x + v->y + v->z))
		return false;
	const nt_dvec3 scaled = {v->x / largest, v->y / largest, v->z / largest};
	*v = nt_dvec3_scale(1.0 / sqrt(nt_dvec3_dot(scaled, scaled)), scaled);
	return true;
}

/* v without its part along the unit (or zero) vector n. */
static inline nt_dvec3 nt_dvec3_reject(nt_dvec3 n, nt_dvec3 v)
{
	return nt_dvec3_sub(v, nt_dvec3_scale(nt_dvec3_dot(n, v), n));
}

/* A unit vector perpendicular to n that changes smoothly with it but across n.z = 0 (T. Duff et al.,
 * "Building an Orthonormal Basis, Revisited", 2017). */
static inline nt_dvec3 nt_dvec3_perpendicular(nt_dvec3 n)
{
	const double sign = n.z < 0.0 ? -1.0 : 1.0;
	const double a = -1.0 / (sign + n.z);
	nt_dvec3 t = {1.0 + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
	nt_dvec3_normalise(&t);
	return t;
}

#endif
