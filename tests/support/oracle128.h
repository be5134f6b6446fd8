/* SPDX-License-Identifier: MIT */
/*
 * The oracle: tangents by their formula in 113-bit arithmetic, exact signs by integers. It shares no code
 * with the library, only the description of a mesh.
 *
 *   T(corner) = sum over the triangles of the corner's orientation at its welded vertex of
 *               weight * project(dP/du), projected along the unit normal; then normalised
 */
#ifndef NT_ORACLE128_H
#define NT_ORACLE128_H

#include <stdbool.h>
#include <stddef.h>
#include "nmtan.h"

typedef enum oracle_weight {
	ORACLE_ANGLE, /* corner angle seen along the normal, unit directions: MikkTSpace, robust */
	ORACLE_AREA,  /* the same times the lengths of the two edges */
	ORACLE_NONE   /* dP/du as it is: Lengyel */
} oracle_weight;

typedef struct oracle_corner {
	double t[3], b[3];  /* unit T and the unit sum of dP/dv */
	double condition;   /* of T: sums and projections; infinite where T does not exist */
	double condition_b;
	double condition_float; /* of T where every difference and product is rounded to float, as MikkTSpace does: its
	                           error is some 2^-24 times this, in radians; infinite where float may lose a sign or
	                           leave its range */
	double own[2][3]; /* T of the corner's own triangle alone; of a quad, for both that have the corner */
	int own_count;
	double own_condition_float;
	double spread_degrees; /* the largest angle from t to a triangle's own. Caps of less than 90 degrees are convex:
	                          the average over any part of the triangles is not further away. 180 from 90 on */
	int sign;           /* exact orientation of the corner's face, 0: none */
} oracle_corner;

/* Exact sign of the determinant of three texture coordinates; 0 where one is not finite. */
int oracle_sign(const float a[2], const float b[2], const float c[2]);

/* Fills corners[corner count]; the mesh is sound and may have strides of 0. False: out of memory. */
bool oracle_solve(const nmtan_mesh *mesh, oracle_weight weight, oracle_corner *corners);

#endif
