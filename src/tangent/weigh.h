/* SPDX-License-Identifier: MIT */
/*
 * The contribution of a triangle to the sum at one of its corners, without a branch: the one formula behind
 * frames.c, which does one triangle after the other, and tangent/sums/kernel.h, which does many at a time.
 *
 * Nothing here has unit length but the normal: scales cancel in the direction, in the angle and in the
 * conditions, so that a corner needs two reciprocal square roots and no division.
 */
#ifndef NT_TANGENT_WEIGH_H
#define NT_TANGENT_WEIGH_H

#include "base/angle.h"
#include "base/vec.h"

/* Sine of the angle between u and the normal below which the projected direction would be noise. */
#define NT_PARALLEL 1e-15

/* A triangle: its direction of growing u and the cross product of its edges. Lengths but `squared` are good to
 * five digits, which conditions need; with area weights those of edges are good to the last. */
typedef struct nt_measured {
	nt_dvec3 u, across;
	double squared;   /* |u|^2 */
	double u_length, across_length;
} nt_measured;

typedef struct nt_weighed {
	nt_dvec3 u;
	double weight, sensitivity;
	double stretch; /* the part of it that changes the weight alone: errors of the angle */
} nt_weighed;

static inline NT_ALWAYS_INLINE nt_measured nt_measure(nt_dvec3 u, nt_dvec3 across)
{
	const double squared = nt_dvec3_dot(u, u);
	return (nt_measured){u, across, squared, nt_sqrt_rough(squared), nt_sqrt_rough(nt_dvec3_dot(across, across))};
}

static inline NT_ALWAYS_INLINE double nt_measure_edge(nt_dvec3 e, int by_area)
{
	const double squared = nt_dvec3_dot(e, e);
	return by_area ? squared * nt_rsqrt(squared) : nt_sqrt_rough(squared);
}

/* The unit vector along a normal, or zero; |n|^2 is inside nt_rsqrt()'s range for all floats but zeros. */
static inline NT_ALWAYS_INLINE nt_dvec3 nt_weigh_normal(double x, double y, double z)
{
	const nt_dvec3 n = {x, y, z};
	return nt_dvec3_scale(nt_rsqrt(nt_dvec3_dot(n, n)), n);
}

/* Whether u of that square has a direction across a normal, without which it is `across`: what is left where it runs
 * along it is noise. */
static inline NT_ALWAYS_INLINE bool nt_is_across(double squared, nt_dvec3 across)
{
	return nt_dvec3_dot(across, across) > NT_PARALLEL * NT_PARALLEL * squared;
}

/*
 * The corner with unit or zero normal n between edge e, to the next vertex, and edge g, from the previous
 * one, of those lengths. Its angle is seen along n; the sine is the part of the triangle's cross
 * product along n, which does not cancel in needles as the cross product of projected edges does:
 * `sine` = |n . across|, or |across| without a normal. An edge along n is seen as a point, and its angle as a right
 * one, as MikkTSpace has it; an edge without length has none.
 */
static inline NT_ALWAYS_INLINE nt_weighed nt_weigh_corner(const nt_measured *m, nt_dvec3 n,
	nt_dvec3 e, nt_dvec3 g, double e_length, double g_length, double sine, int by_area)
{
	const nt_dvec3 d = nt_dvec3_reject(n, m->u);
	const double squared = nt_dvec3_dot(d, d);
	const double lengths = e_length * g_length;
	const double usable = (nt_is_across(m->squared, d) & (lengths > 0.0)) ? 1.0 : 0.0;
	const double cosine = nt_dvec3_dot(n, e) * nt_dvec3_dot(n, g) - nt_dvec3_dot(e, g);
	const double turn = nt_rsqrt(sine * sine + cosine * cosine);
	/* how much an error of the projections moves the angle */
	const double condition = (fabs(cosine) * m->across_length + sine * lengths) * turn * turn;
	const double factor = by_area ? usable * lengths : usable;
	const double weight = factor * nt_angle_on_circle(sine * turn, cosine * turn);
	const double scale = weight * nt_rsqrt(squared);
	const double stretch = factor * condition;
	return (nt_weighed){nt_dvec3_scale(scale, d), weight, scale * m->u_length + stretch, stretch};
}

/* The same for Lengyel's sum: dP/du as it is, u times the inverse determinant, without its part along n. */
static inline NT_ALWAYS_INLINE nt_weighed nt_weigh_nothing(const nt_measured *m, nt_dvec3 n,
	double inverse)
{
	const double length = m->u_length * inverse;
	return (nt_weighed){nt_dvec3_reject(n, nt_dvec3_scale(inverse, m->u)), length, length, 0.0};
}

#endif
