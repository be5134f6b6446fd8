/* SPDX-License-Identifier: MIT */
/*
 * Vectors of three floats, and of three doubles.
 */
#ifndef NT_BASE_VEC_H
#define NT_BASE_VEC_H

#include <float.h>
#include <math.h>
#include <stdbool.h>

/* ---- floats ---- */

/* MikkTSpace's arithmetic: every operation rounds to float, sums go left to right, nothing is contracted. Bytes depend
 * on it; do not reorder. */

typedef struct nt_vec3 {
	float x, y, z;
} nt_vec3;

static inline nt_vec3 nt_vec3_sub(nt_vec3 a, nt_vec3 b)
{
	return (nt_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline nt_vec3 nt_vec3_add(nt_vec3 a, nt_vec3 b)
{
	return (nt_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline nt_vec3 nt_vec3_scale(float s, nt_vec3 v)
{
	return (nt_vec3){s * v.x, s * v.y, s * v.z};
}

static inline float nt_vec3_dot(nt_vec3 a, nt_vec3 b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* The same of plain arrays. */
static inline float nt_dot3(const float a[3], const float b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline nt_vec3 nt_vec3_cross(nt_vec3 a, nt_vec3 b)
{
	return (nt_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* The third axis of a frame: cross(n, t) * w. b may lie over t. */
static inline void nt_bitangent(const float n[3], const float t[4], float b[3])
{
	const nt_vec3 cross = nt_vec3_cross((nt_vec3){n[0], n[1], n[2]}, (nt_vec3){t[0], t[1], t[2]});
	const float w = t[3];
	b[0] = cross.x * w;
	b[1] = cross.y * w;
	b[2] = cross.z * w;
}

static inline float nt_vec3_length(nt_vec3 v)
{
	return sqrtf(nt_vec3_dot(v, v));
}

/* MikkTSpace's NotZero: larger than the smallest normal float; false for NaN. */
static inline bool nt_not_zero(float x)
{
	return fabsf(x) > FLT_MIN;
}

static inline bool nt_vec3_not_zero(nt_vec3 v)
{
	return nt_not_zero(v.x) || nt_not_zero(v.y) || nt_not_zero(v.z);
}

/* One division, then three multiplications, as the reference does. */
static inline nt_vec3 nt_vec3_normalise(nt_vec3 v)
{
	return nt_vec3_scale(1.0f / nt_vec3_length(v), v);
}

static inline nt_vec3 nt_vec3_normalise_safe(nt_vec3 v)
{
	return nt_vec3_not_zero(v) ? nt_vec3_normalise(v) : v;
}

/* v without its part along the unit normal n, normalised where it is not zero. */
static inline nt_vec3 nt_vec3_project(nt_vec3 n, nt_vec3 v)
{
	return nt_vec3_normalise_safe(nt_vec3_sub(v, nt_vec3_scale(nt_vec3_dot(n, v), n)));
}

/* |N|^2 of a normal of unit length may differ from 1 by this much: floats that were rounded to 12 bits pass, and
 * T . N then says the sine of the angle to within 2^-12 of itself. */
#define NT_UNIT_NORMAL_TOLERANCE 0x1p-11f

/* Whether |N| counts as 1. */
static inline bool nt_is_unit_normal(const float n[3])
{
	return fabsf(nt_dot3(n, n) - 1.0f) <= NT_UNIT_NORMAL_TOLERANCE;
}

/* ---- doubles ---- */

/* For the methods that are not bound to MikkTSpace's float arithmetic. Values come from floats, so that products of
 * four of them neither overflow nor vanish. */

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
