/* SPDX-License-Identifier: MIT */
/*
 * Judging: which corner tangents can a renderer use, and what is the mesh like?
 *
 * A tangent is usable when it is finite, of unit length, not parallel to its normal, and its w is the exact
 * orientation of its face and the same on all the face's corners.
 */
#ifndef NT_TANGENT_JUDGE_H
#define NT_TANGENT_JUDGE_H

#include "tangent/solve.h"

/* |T|^2 may differ from 1 by this much: 32 units in the last place. Normalising in float is good to 4. */
#define NT_UNIT_TOLERANCE (32 * 1.1920929e-7f)

/* sin^2 of the angle between T and N below which they count as parallel: 0.06 degrees. */
#define NT_PARALLEL_SINE_SQUARED 1e-6f

typedef enum nt_fault {
	NT_FAULT_NONE,
	NT_FAULT_NOT_FINITE,
	NT_FAULT_LENGTH,
	NT_FAULT_PARALLEL,
	NT_FAULT_SIGN
} nt_fault;

/* What a face's corners must agree on, and which do not. */
typedef struct nt_verdict {
	float w;         /* required on every corner */
	int orientation; /* exact, 0: none */
	nt_fault faults[4];
} nt_verdict;

/* Whether T is parallel to N; a normal that is zero or not finite is parallel to nothing. */
static inline bool nt_is_parallel(const float *t, const float *n)
{
	const float x = n[1] * t[2] - n[2] * t[1], y = n[2] * t[0] - n[0] * t[2],
		    z = n[0] * t[1] - n[1] * t[0];
	const float sine_squared = x * x + y * y + z * z;
	const float normal_squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
	/* no branches, for loops over lanes */
	return (normal_squared > 0.0f) & (normal_squared <= 3.4028235e38f) &
	       (sine_squared < NT_PARALLEL_SINE_SQUARED * normal_squared);
}

/* Walks over the faces that have to be looked at. */
typedef struct nt_suspects {
	const nt_solve *solve;
	size_t face, end;
	size_t corner;   /* first corner of `face` */
	size_t triangle; /* first triangle of `face` */
} nt_suspects;

/* A walk over faces [begin, end). */
nt_suspects nt_suspects_among(const nt_solve *solve, size_t begin, size_t end);

/* Goes on to the next suspect at or after s->face; false: there is none. Triangles that are passed over and
 * mirrored are added to *mirrored (may be NULL). To step over the suspect itself: nt_suspects_step. */
bool nt_suspects_find(nt_suspects *s, size_t *mirrored);
void nt_suspects_step(nt_suspects *s);

/* Judges one face. `folded` may be NULL. */
nt_verdict nt_judge_face(const nt_solve *solve, size_t face, size_t first, bool *folded);

/* Unusable corners, by the repaired_ fields, and what sets these to 0. */
size_t nt_fault_count(const nmtan_counts *counts);
void nt_forget_faults(nmtan_counts *counts);

/* Judges every face: what the mesh is like, and in the repaired_ fields how many corners are unusable.
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_judge(const nt_solve *solve, nmtan_counts *counts);

#endif
