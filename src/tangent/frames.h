/* SPDX-License-Identifier: MIT */
/*
 * Frames in double, summed per welded vertex and exact orientation: the methods besides MikkTSpace, and
 * the answers that repair falls back to.
 *
 * A triangle's directions come from the 2x2 system of its UV edges, with exact differences and exact
 * products wherever they cancel (base/exact.h): a direction is good to a few 2^-53 however thin the
 * triangle is in space or in UV. Later losses are the geometry's: a direction nearly along
 * the normal, directions that cancel in the sum. `sensitivity` measures both.
 */
#ifndef NT_TANGENT_FRAMES_H
#define NT_TANGENT_FRAMES_H

#include "base/dvec.h"
#include "tangent/solve.h"

/* How a triangle weighs in the sum at one of its corners. */
typedef enum nt_weight {
	NT_WEIGHT_ANGLE, /* unit direction times the corner's angle seen along the normal */
	NT_WEIGHT_AREA,  /* unit direction times angle and both edge lengths */
	NT_WEIGHT_NONE   /* dP/du as it is: Lengyel's sum */
} nt_weight;

/* The sum at a welded vertex over the triangles of one orientation. */
typedef struct nt_frame_sum {
	nt_dvec3 u;     /* weighted directions of growing u, each perpendicular to the normal */
	double weights; /* sum of the lengths that went in */
	double sensitivity; /* sum of the lengths times their condition: by how much a relative error of
	                       one in the projections could move u */
	double stretch;     /* the part of it that lies along what went in: errors of the angles */
} nt_frame_sum;

#define NT_NO_ID UINT32_MAX

/* Products are kept with their residuals where their difference is that much smaller: 2^-53 then becomes
 * 29 times that in the length of u, which a condition of 2^24 leaves below half of a float's last place. */
#define NT_CANCELLATION 8.0

/* The same where differences of coordinates were rounded too: 23 times 2^-53. Beyond, they are not. */
#define NT_CANCELLATION_INEXACT 2.0

/* Below this share of the summed lengths a sum's direction is rounding noise: 2^-53 per addition and
 * term, with room for a million terms. */
#define NT_CANCELLED 1e-10

/* The condition up to which `robust` promises 2^-23 in each component. */
#define NT_WELL_CONDITIONED 16777216.0

/* Unit normal of a vertex; zero where it has none. */
nt_dvec3 nt_unit_normal(const nmtan_mesh *mesh, size_t vertex);

/* The exact orientation of one triangle, v up; `stored`: of its stored texture coordinates. */
int nt_triangle_orientation(const nmtan_mesh *mesh, const uint32_t corners[3], bool stored);

/* Whether the halves of a quad have different orientations. */
typedef enum nt_fold {
	NT_NOT_FOLDED,
	NT_FOLDED,
	NT_FOLDED_EVENLY /* and neither is the quad's: both are visible, with one area in UV space as floats have it */
} nt_fold;

/*
 * The exact orientation of a face, v up: +1, -1, or 0: it has none. A quad takes the sign of its larger half in UV
 * space, the first if they are equal; a half of which two corners are at one position has no vote beside one that is
 * visible. `fold` may be NULL; `stored`: the stored texture coordinates decide first.
 */
int nt_face_orientation(const nmtan_mesh *mesh, size_t face, size_t first, bool stored, nt_fold *fold);

/* The same of a face that is cut into `count` triangles. */
int nt_cut_orientation(const nmtan_mesh *mesh, uint32_t corners[2][3], unsigned count, bool stored, nt_fold *fold);

/* Whether the outline of the quad with that first corner crosses itself in UV space, as stored: along either diagonal
 * it is cut into halves of different orientations. */
bool nt_outline_crosses(const nmtan_mesh *mesh, size_t first);

/* Adds a triangle's frame to the sums of its corners, of which nt_unit_normal() is known; NULL: the corner is left
 * out. */
void nt_add_triangle(const nmtan_mesh *mesh, nt_weight weight, const uint32_t corners[3], const nt_dvec3 normals[3],
	nt_frame_sum *const sums[3]);

/* The unit tangent of a sum, perpendicular to the unit (or zero) normal n; false where the sum has no
 * direction. */
bool nt_sum_tangent(const nt_frame_sum *sum, nt_dvec3 n, nt_dvec3 *tangent);

#endif
