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
#include "base/vec.h"
#include "tangent/solve.h"

/* |T|^2 may differ from 1 by this much: 32 units in the last place. Normalising in float is good to 4. */
#define NT_UNIT_TOLERANCE (32 * 1.1920929e-7f)

/* The largest (T . N)^2 there: a sine of 2^-10, 0.056 degrees. Where a projection in float is well-conditioned it is
 * good to 2^-22, so that beyond this a direction has lost more than half of its bits along the normal. */
#define NT_MOST_LEAN_SQUARED 0x1p-20f

/* sin^2 and cos^2 of the angle between T and N below and above which they count as parallel: 0.06 degrees. */
#define NT_PARALLEL_SINE_SQUARED 1e-6f
#define NT_PARALLEL_COSINE_SQUARED 0.999999f

/* The predicates have no branches: they are used in loops over lanes. */

static inline float nt_squared(const float *v)
{
	return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

/* (T . N)^2 from which on T and N are parallel; none where the normal is zero or not finite. */
static inline float nt_parallel_from(float tangent_squared, float normal_squared)
{
	const bool has_length = (normal_squared > 0.0f) & (normal_squared <= FLT_MAX);
	return has_length ? NT_PARALLEL_COSINE_SQUARED * normal_squared * tangent_squared : INFINITY;
}

/* Whether T is parallel to N. */
static inline bool nt_is_parallel(const float *t, const float *n)
{
	const float along = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
	return along * along > nt_parallel_from(nt_squared(t), nt_squared(n));
}

/* Whether T is a unit vector across N. */
static inline bool nt_is_frame(const float *t, const float *n)
{
	const float squared = nt_squared(t), from = nt_parallel_from(squared, nt_squared(n));
	const float along = t[0] * n[0] + t[1] * n[1] + t[2] * n[2];
	return (fabsf(squared - 1.0f) <= NT_UNIT_TOLERANCE) &
	       !(along * along > (nt_is_unit_normal(n) ? NT_MOST_LEAN_SQUARED : from));
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
