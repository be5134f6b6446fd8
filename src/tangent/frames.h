/* SPDX-License-Identifier: MIT */
/*
 * Frames (T, B, N): of a triangle, summed at a vertex; which of them a renderer can use; what takes the place of those
 * that it cannot; and the normals that they stand on.
 */
#ifndef NT_TANGENT_FRAMES_H
#define NT_TANGENT_FRAMES_H

#include <float.h>
#include <math.h>
#include "base/scratch.h"
#include "base/vec.h"
#include "nmtan.h"
#include "tangent/solve.h"

/* ---- frames in double ---- */

/*
 * Summed per welded vertex and exact orientation: the methods besides MikkTSpace, and
 * the answers that repair falls back to.
 *
 * A triangle's directions come from the 2x2 system of its UV edges, with exact differences and exact
 * products wherever they cancel (base/exact.h): a direction is good to a few 2^-53 however thin the
 * triangle is in space or in UV. Later losses are the geometry's: a direction nearly along
 * the normal, directions that cancel in the sum. `sensitivity` measures both.
 */

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

/* ---- usable tangents: usable.c ---- */

/*
 * Which corner tangents can a renderer use, and what is the mesh like?
 *
 * A tangent is usable when at least one triangle gave it to its corner, it is finite and of unit length, it lies
 * across its normal, and its w is the exact orientation of its face and the same on all the face's corners. Across a
 * normal of unit length means within 2^-10 of perpendicular; other normals, which the methods use as given, must
 * not be parallel to it.
 */

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

/* ---- repair: what a method leaves unusable becomes usable ---- */

/*
 * Checks every corner tangent of a solve and counts what the mesh is like; replaces the unusable ones where
 * the solve repairs. Rows that the solve left out (nt_known.ids) stay out.
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_repair(const nt_solve *solve, nmtan_counts *counts);

/* ---- normals, where a source has none ---- */

/*
 * Computes a normal for every corner.
 *
 *   mesh       positions, faces and indices; normals and texcoords are not read. Strides must be filled in
 *   smoothing  [face_count] smoothing group of each face, 0: flat; NULL: all faces are in one group
 *   groups     [corner_count] group of each corner, in place of its face's; NULL: smoothing says it
 *   normals    [corner_count][4] receives unit vectors and a 0, rows that nmtan_split() takes; (0, 0, 1, 0) where a
 *              corner's faces have no area. Instead of the 0 a 1 where the sum cancels
 *
 * A corner's normal is the sum of the face normals of its group at its position, weighted by corner angle
 * (G. Thuermer and C. Wuethrich, "Computing Vertex Normals from Polygonal Facets", 1998), or its own
 * face's in group 0 and where the sum cancels: where it is no longer than 1e-10 times the weights (NT_CANCELLED).
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_corner_normals(const nmtan_mesh *mesh, size_t corner_count, const uint32_t *smoothing,
	const uint32_t *groups, nt_scratch *scratch, float (*normals)[4]);

/*
 * Groups for nt_corner_normals(): corners at one position share a normal if edges lead from one face to the other at
 * each of which two faces meet at less than `degrees`, 0 (all is flat) to 180. groups [corner_count] receives numbers
 * from 1 on. Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_crease_groups(const nmtan_mesh *mesh, size_t corner_count, double degrees, nt_scratch *scratch,
	uint32_t *groups);

/* Unit normal of the face of `size` corners that begins with corner `first`; false: it has no area. */
bool nt_face_normal(const nmtan_mesh *mesh, size_t first, size_t size, nt_dvec3 *normal);

#endif
