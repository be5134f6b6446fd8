/* SPDX-License-Identifier: MIT */
/*
 * Usable tangents: which corner tangents can a renderer use, and what is the mesh like?
 *
 * A tangent is usable when at least one triangle gave it to its corner, it is finite and of unit length, it lies
 * across its normal, and its w is the exact orientation of its face and the same on all the face's corners. Across a
 * normal of unit length means within 2^-10 of perpendicular; other normals, which the methods use as given, must
 * not be parallel to it.
 */
#ifndef NT_TANGENT_USABLE_H
#define NT_TANGENT_USABLE_H

#include <float.h>
#include <math.h>
#include "base/dvec.h"
#include "base/vec.h"
#include "tangent/solve.h"

/* |T|^2 may differ from 1 by this much: 32 units in the last place. Normalising in float is good to 4. */
#define NT_UNIT_TOLERANCE (32 * 1.1920929e-7f)

/* The largest (T . N)^2 there: a sine of 2^-10, 0.056 degrees. If a projection in float is well-conditioned, it is
 * good to 2^-22, so that beyond this a direction has lost more than half of its bits along the normal. */
#define NT_MOST_LEAN_SQUARED 0x1p-20f

/* sin^2 and cos^2 of the angle between T and N below and above which they count as parallel: 0.06 degrees. */
#define NT_PARALLEL_SINE_SQUARED 1e-6f
#define NT_PARALLEL_COSINE_SQUARED 0.999999f

/* nt_is_surely_frame() has no branches: it is used in loops over lanes. */

static inline float nt_squared(const float *v)
{
	return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

/* Whether |N|^2 is good to the last places: it neither vanishes nor overflows. */
static inline bool nt_is_normal_length(float squared)
{
	return (squared >= 0x1p-100f) & (squared <= FLT_MAX);
}

/* Whether T is a unit vector across N; false, too, where N is too long or too short to tell. */
static inline bool nt_is_surely_frame(const float *t, const float *n)
{
	const float squared = nt_squared(t), normal_squared = nt_squared(n);
	const float along = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
	const float from = nt_is_normal_length(normal_squared)
		? NT_PARALLEL_COSINE_SQUARED * normal_squared * squared : -1.0f;
	return (fabsf(squared - 1.0f) <= NT_UNIT_TOLERANCE) &
	       !(along * along > (nt_is_unit_normal(n) ? NT_MOST_LEAN_SQUARED : from));
}

/* Whether T is parallel to N; not where N is zero or not finite. */
static inline bool nt_is_parallel(const float *t, const float *n)
{
	const float along = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
	if (nt_is_normal_length(nt_squared(n)))
		return along * along > NT_PARALLEL_COSINE_SQUARED * nt_squared(n) * nt_squared(t);
	const nt_dvec3 tangent = nt_dvec3_load(t), normal = nt_dvec3_load(n);
	const double exactly = nt_dvec3_dot(tangent, normal), squared = nt_dvec3_dot(normal, normal);
	return squared <= DBL_MAX &&
	       exactly * exactly > NT_PARALLEL_COSINE_SQUARED * squared * nt_dvec3_dot(tangent, tangent);
}

/* Whether T is a unit vector across N. */
static inline bool nt_is_frame(const float *t, const float *n)
{
	return nt_is_surely_frame(t, n) || (!nt_is_normal_length(nt_squared(n)) && !nt_is_parallel(t, n) &&
						   fabsf(nt_squared(t) - 1.0f) <= NT_UNIT_TOLERANCE);
}

/*
 * Checks every face: what the mesh is like and, where the solve repairs, in the repaired_ fields how many corners
 * are unusable and why. These get w = 0, which no method gives, and -0 where their face has no orientation; the rest of
 * their rows stays.
 *
 *   faulty  receives a bit for each face, set where a corner is unusable; NULL where there is none
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_find_unusable(const nt_solve *solve, nmtan_counts *counts, uint64_t **faulty);

#endif
