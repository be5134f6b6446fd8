/* SPDX-License-Identifier: MIT */
/*
 * Exact orientation: the slow half of corners.h, and the cut of quads; and triangles whose tangents run against it.
 */
#include "topology/corners.h"

#include <math.h>
#include <stddef.h>
#include "base/exact.h"
#include "base/vec.h"

/* ---- orientation ---- */

/* The determinant of a triangle is (bu)(cv) - (bv)(cu). Each difference is a sum of two doubles, each product of two
 * doubles a sum of two, so the determinant is a sum of 16 doubles, all multiples of 2^-298 below 2^260: nothing
 * overflows, nothing underflows, and the expansion is exact. */

enum { DETERMINANT_TERMS = 2 * NT_PRODUCT_TERMS };

/* Sign of a sum of terms: that of the largest component that is not zero. */
static int sign_of_sum(const double *terms, size_t count)
{
	double expansion[2 * DETERMINANT_TERMS];
	size_t n = count;
	nt_expand(expansion, terms, count);
	while (n > 0 && expansion[n - 1] == 0.0)
		n--;
	return n == 0 ? 0 : expansion[n - 1] > 0.0 ? 1 : -1;
}

static int is_finite(const float a[2])
{
	return isfinite(a[0]) && isfinite(a[1]);
}

/* The determinant times sign as a sum of terms; all zero where a value is not finite. */
static void determinant_terms(double terms[DETERMINANT_TERMS], const float a[2], const float b[2],
	const float c[2], double sign)
{
	for (int i = 0; i < DETERMINANT_TERMS; i++)
		terms[i] = 0.0;
	if (!is_finite(a) || !is_finite(b) || !is_finite(c))
		return;
	double bu[2], bv[2], cu[2], cv[2];
	nt_difference(bu, b[0], a[0]);
	nt_difference(bv, b[1], a[1]);
	nt_difference(cu, c[0], a[0]);
	nt_difference(cv, c[1], a[1]);
	const size_t half = nt_product_terms(terms, bu, cv, sign);
	nt_product_terms(terms + half, bv, cu, -sign);
}

int nt_orientation_slow(const float a[2], const float b[2], const float c[2])
{
	double terms[DETERMINANT_TERMS];
	determinant_terms(terms, a, b, c, 1.0);
	return sign_of_sum(terms, DETERMINANT_TERMS);
}

int nmtan_orientation(const float a[2], const float b[2], const float c[2])
{
	return nt_orientation(a, b, c);
}

int nt_compare_area(const float a[2], const float b[2], const float c[2], const float d[2],
	const float e[2], const float f[2])
{
	double terms[2 * DETERMINANT_TERMS];
	determinant_terms(terms, a, b, c, nt_orientation_slow(a, b, c));
	determinant_terms(terms + DETERMINANT_TERMS, d, e, f, -nt_orientation_slow(d, e, f));
	return sign_of_sum(terms, 2 * DETERMINANT_TERMS);
}

const unsigned char nt_quad_triangles[2][2][3] = {
	{{0, 1, 2}, {0, 2, 3}},
	{{0, 1, 3}, {1, 2, 3}},
};

static float squared_distance(const float *a, const float *b, int dimensions)
{
	float sum = 0.0f;
	for (int i = 0; i < dimensions; i++)
		sum += (b[i] - a[i]) * (b[i] - a[i]);
	return sum;
}

int nt_quad_diagonal(const float *const texcoords[4], const float *const positions[4])
{
	const float uv02 = squared_distance(texcoords[0], texcoords[2], 2);
	const float uv13 = squared_distance(texcoords[1], texcoords[3], 2);
	if (uv02 < uv13)
		return 0;
	if (uv13 < uv02)
		return 1;
	return squared_distance(positions[1], positions[3], 3) <
	       squared_distance(positions[0], positions[2], 3);
}

/* Newell's normal of a quad is the cross product of its diagonals: twice the area of its shadows. For coordinates
 * with 24 bits of one scale the cross products are exact; if they are not, a triangle that is judged wrongly stands
 * upright on the quad, to 2^-50. */
static bool has_inverted(const float *const positions[4], int diagonal)
{
	const nt_dvec3 from = nt_dvec3_load(positions[diagonal]), right = nt_dvec3_load(positions[diagonal + 1]),
		       left = nt_dvec3_load(positions[(diagonal + 3) % 4]);
	const nt_dvec3 along = nt_dvec3_sub(nt_dvec3_load(positions[diagonal + 2]), from);
	const nt_dvec3 normal = nt_dvec3_cross(along, nt_dvec3_sub(left, right));
	return (nt_dvec3_dot(nt_dvec3_cross(nt_dvec3_sub(right, from), along), normal) < 0) ||
	       (nt_dvec3_dot(nt_dvec3_cross(along, nt_dvec3_sub(left, from)), normal) < 0);
}

int nt_written_quad_diagonal(int solved, const float *const positions[4])
{
	return has_inverted(positions, solved) && !has_inverted(positions, !solved) ? !solved : solved;
}

/* ---- tangents that run against texture coordinates ---- */

/* Tangents may be wrong by 180 degrees while their w is right: then the bitangent is wrong by 180 degrees too, and
 * bumps look like dents. So it is where a file's tangents were made for texture coordinates that were turned since, or
 * are those of a triangle that rounding has turned over. */

/* dP/du (of v, `which` 1) or -dP/dv (of u, 0) of a triangle, but for its length. */
static nt_dvec3 direction(const nt_tangent_triangle *t, int which, nt_dvec3 d1, nt_dvec3 d2)
{
	const double a = t->texcoords[0][which], sign = t->orientation;
	return nt_dvec3_sub(nt_dvec3_scale(sign * (t->texcoords[2][which] - a), d1),
		nt_dvec3_scale(sign * (t->texcoords[1][which] - a), d2));
}

bool nt_is_reversed(const nt_tangent_triangle *t)
{
	/* at most cos 120 degrees between a tangent and where u grows, and a bitangent and where v does: reversed
	 * beyond what averaging does. One of them alone says little: it may be far off where u and v grow almost the
	 * same way */
	const double least_reversed = -0.5;
	const nt_dvec3 a = nt_dvec3_load(t->positions[0]);
	const nt_dvec3 d1 = nt_dvec3_sub(nt_dvec3_load(t->positions[1]), a);
	const nt_dvec3 d2 = nt_dvec3_sub(nt_dvec3_load(t->positions[2]), a);
	nt_dvec3 u = direction(t, 1, d1, d2);
	/* nearly all triangles end here, without a root */
	if (nt_dvec3_dot(nt_dvec3_load(t->tangents[0]), u) > 0.0 || !nt_dvec3_normalise(&u))
		return false;
	nt_dvec3 v = nt_dvec3_scale(-1.0, direction(t, 0, d1, d2));
	if (!nt_dvec3_normalise(&v))
		return false;
	const nt_dvec3 face = nt_dvec3_cross(d1, d2);
	for (size_t k = 0; k < 3; k++) {
		const nt_dvec3 normal = nt_dvec3_load(t->normals[k]);
		nt_dvec3 tangent = nt_dvec3_load(t->tangents[k]);
		const double w = t->other_w ? -t->tangents[k][3] : t->tangents[k][3];
		nt_dvec3 bitangent = nt_dvec3_scale(w, nt_dvec3_cross(normal, tangent));
		if (!(nt_dvec3_dot(face, normal) > 0.0) || !nt_dvec3_normalise(&bitangent) ||
			nt_dvec3_dot(bitangent, v) > least_reversed || !nt_dvec3_normalise(&tangent) ||
			nt_dvec3_dot(tangent, u) > least_reversed)
			return false;
	}
	return true;
}
