/* SPDX-License-Identifier: MIT */
/*
 * Twins of a mesh: mirrored, scaled and turned copies, whose tangents must be the mirrored, scaled and turned ones.
 */
#ifndef NT_STRESS_TWINS_H
#define NT_STRESS_TWINS_H

#include "bounds.h"
#include "surfaces.h"

typedef struct twin {
	const char *name;
	int axis[3];           /* coordinate i of the twin is axis[i] of the mesh, */
	float sign[3], u_sign; /* times this; and u */
	float scale, uv_scale; /* powers of two */
	float t_sign, w_sign;  /* what becomes of T, beside the turn, and w */
	bool exact;            /* float for float; else each within its own bound of the formula, and w equal */
} twin;

enum { TWIN_COUNT = 5 };
extern const twin twins[TWIN_COUNT];

/* Corners at which a method's answer for the twin is not the twin of its answer. `exact` is the oracle's view of the
 * mesh, for the weights of the method. SIZE_MAX: a call failed. */
size_t twin_differences(const nt_owned *mesh, const twin *kind, nmtan_method method, const oracle_corner *exact,
	const bound *bounds);

#endif
