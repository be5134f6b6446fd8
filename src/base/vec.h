/* SPDX-License-Identifier: MIT */
/*
 * Vectors of three floats in MikkTSpace's arithmetic: every operation rounds to float, sums go left to
 * right, nothing is contracted. Bytes depend on it; do not reorder.
 */
#ifndef NT_BASE_VEC_H
#define NT_BASE_VEC_H

#include <float.h>
#include <math.h>
#include <stdbool.h>

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

#endif
