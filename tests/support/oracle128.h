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
	int sign;           /* exact orientation of the corner's face, 0: none */
} oracle_corner;

/* A triangle of the mesh, and what it gives its corners. Quads are two. */
typedef struct oracle_triangle {
	size_t corner[3], vertex[3]; /* of the mesh; welded: the first corner with the same eight floats */
	int sign, side;              /* exact orientation: its own; that of its face */
	bool sound;                  /* no two positions are equal */
	int float_sign;      /* of its UV determinant in MikkTSpace's arithmetic; 0: below the smallest normal
	                        float, or NaN */
	double least, largest; /* of the determinant, the lengths of dP/du and dP/dv, and these times the determinant */
	double least_square, largest_square; /* of the lengths of edges, and of dP/du times the determinant */
	struct {
		double t[3], b[3]; /* dP/du and dP/dv across the normal, unit; zero where they have no such part */
		double angle;
		double t_condition, b_condition; /* when differences and products are rounded to float: relative
		                                    errors of 2^-24 */
		double angle_condition; /* of the angle as acos() of a cosine, in radians */
	} at[3];
} oracle_triangle;

/* Exact sign of the determinant of three texture coordinates; 0 where one is not finite. */
int oracle_sign(const float a[2], const float b[2], const float c[2]);

/* Fills corners[corner count]; the mesh is sound and may have strides of 0. False: out of memory. */
bool oracle_solve(const nmtan_mesh *mesh, oracle_weight weight, oracle_corner *corners);

/* The same by angle, and [oracle_triangle_count()] triangles in the order of the faces. */
size_t oracle_triangle_count(const nmtan_mesh *mesh);
bool oracle_solve_triangles(const nmtan_mesh *mesh, oracle_corner *corners, oracle_triangle *triangles);

#endif
