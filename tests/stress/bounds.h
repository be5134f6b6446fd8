/* SPDX-License-Identifier: MIT */
/*
 * How far MikkTSpace's own bytes may be from its formula: what can be proved of each corner.
 *
 * MikkTSpace's tangent is the average of the directions dP/du, across the normal, of a group of triangles: those of one
 * orientation that meet around a vertex over edges. In float arithmetic, whose unit is e = 2^-24,
 *
 *   a direction is off by at most MOST_UNITS e times its condition: the two products of UV and position differences
 *   over
 *     what is left of their difference, over what the normal leaves of that (numbers of oracle128.c);
 *   a weight is an angle, never negative;
 *   the sign of a UV determinant is what one line of float arithmetic says: the exact one; none, and the triangle gives
 *     nothing but connects others; or the wrong one.
 *
 * So there are three kinds of bounds, of which the smallest counts:
 *
 *   SUM   the group is certain, weights are within their own condition, nothing leaves the range of float: the exact
 *         average of the group, off by MOST_UNITS e times the condition of the sum
 *   CAP   only directions are certain: whatever the weights, the average lies within the smallest cap of the sphere
 *         around the exact average that has all of them, as long as this is less than a hemisphere. For a triangle
 *         alone the cap is a point. The same where a part of the group may be missing, and where a corner of a triangle
 *         without size takes the answer of another at its vertex
 *   NONE  the sign of some triangle of the group is the wrong one, so that its direction counts backwards; or two of
 *         its directions may be opposite, which MikkTSpace keeps apart, and together they cancel; or a bound above is a
 *         quarter turn or more
 *
 * Corners with NONE are those on which MikkTSpace itself is undetermined in float: its bytes are kept, because they are
 * its bytes, and nothing but unit length, perpendicularity and w can be said of them. They are counted, and how many
 * there may be is said by family (extremes.c).
 */
#ifndef NT_STRESS_BOUNDS_H
#define NT_STRESS_BOUNDS_H

#include "oracle128.h"

/* A difference of texture coordinates, one of positions, their product and the sum of two products: four roundings of a
 * unit each; normalising and projecting take as many. */
enum { MOST_UNITS = 8 };

typedef struct bound {
	double t[3];      /* what the answer is held to */
	double condition; /* SUM: bound_degrees is MOST_UNITS * 2^-24 times this; else 0 */
	double degrees;   /* the bound; infinite: NONE */
} bound;

/* bounds: [corner count], triangles as oracle_solve_triangles() has them. False: out of memory. */
bool find_bounds(const nmtan_mesh *mesh, const oracle_corner *exact, const oracle_triangle *triangles,
	size_t corner_count, bound *bounds);

#endif
