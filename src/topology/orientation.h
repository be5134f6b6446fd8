/* SPDX-License-Identifier: MIT */
/*
 * The one definition of "mirrored" and "degenerate" in UV space, and of how a quad is cut: as MikkTSpace does where it
 * is solved, inside where it is written as triangles.
 *
 * The sign is exact. A difference of two floats is exact in double unless their exponents lie more
 * than 2^29 apart; rounding a product is monotone, so two rounded products that differ compare as the
 * exact ones do; and where they are equal the residuals, which fma gives exactly, decide. The rest (inexact
 * differences) is summed as an expansion (J. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
 * Geometric Predicates", 1997).
 */
#ifndef NT_TOPOLOGY_ORIENTATION_H
#define NT_TOPOLOGY_ORIENTATION_H

#include "base/exact.h"
#include "nmtan.h"

/* The same as nt_orientation for any input, by expansions alone. */
int nt_orientation_slow(const float a[2], const float b[2], const float c[2]);

/* The same for equal products p = fl(bu cv) = fl(bv cu) of exact differences: the residuals decide. */
static inline int nt_orientation_residual(double bu, double bv, double cu, double cv, double p)
{
	const double left = nt_fma(bu, cv, -p), right = nt_fma(bv, cu, -p);
	return p == 0.0 ? 0 : (left > right) - (left < right);
}

/* The edges of a triangle in UV space from its first corner, and 0.0 if they are exact. */
typedef struct nt_uv_edges {
	double bu, bv, cu, cv, error;
} nt_uv_edges;

static inline nt_uv_edges nt_uv_edges_of(const float a[2], const float b[2], const float c[2])
{
	const double bu = (double)b[0] - a[0], bv = (double)b[1] - a[1];
	const double cu = (double)c[0] - a[0], cv = (double)c[1] - a[1];
	return (nt_uv_edges){bu, bv, cu, cv, nt_difference_error(bu, a[0], b[0]) + nt_difference_error(bv, a[1], b[1]) +
		nt_difference_error(cu, a[0], c[0]) + nt_difference_error(cv, a[1], c[1])};
}

/* Exact sign of the UV determinant of a triangle, which has these edges: see nmtan_orientation(). */
static inline int nt_orientation_by(const nt_uv_edges *e, const float a[2], const float b[2], const float c[2])
{
	const double p = e->bu * e->cv, r = e->bv * e->cu;
	if (e->error == 0.0)
		return p != r ? p > r ? 1 : -1 : nt_orientation_residual(e->bu, e->bv, e->cu, e->cv, p);
	return nt_orientation_slow(a, b, c);
}

static inline int nt_orientation(const float a[2], const float b[2], const float c[2])
{
	const nt_uv_edges edges = nt_uv_edges_of(a, b, c);
	return nt_orientation_by(&edges, a, b, c);
}

/* Exact comparison of the determinants' magnitudes: -1, 0, +1 as |det(a, b, c)| is less than, equal to
 * or greater than |det(d, e, f)|. A triangle with a value that is not finite counts as 0. */
int nt_compare_area(const float a[2], const float b[2], const float c[2], const float d[2],
	const float e[2], const float f[2]);

/* The triangles of a quad as corner numbers 0..3: row 0 for the diagonal 0-2, row 1 for 1-3, each with
 * MikkTSpace's order and first corners. */
extern const unsigned char nt_quad_triangles[2][2][3];

/* The diagonal along which MikkTSpace cuts a quad, as a row of nt_quad_triangles: the shorter one in UV
 * space; where those are equal or not comparable, the shorter one in space, 0-2 when in doubt. */
int nt_quad_diagonal(const float *const texcoords[4], const float *const positions[4]);

/* The diagonal along which a quad is written as triangles. It is that of the solve, unless one triangle is inverted by
 * it (it lies outside of the quad in space) and none by the other diagonal. Inverted means against the quad's Newell
 * normal. A simple outline has at most one corner that turns inwards, so one diagonal inverts nothing; an outline that
 * crosses itself has an inverted triangle either way. */
int nt_written_quad_diagonal(int solved, const float *const positions[4]);

#endif
