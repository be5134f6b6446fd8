/* SPDX-License-Identifier: MIT */
/*
 * One triangle after the other: the definition of what sums.c computes for many at a time, and what repair
 * asks for a few. See frames.h.
 */
#include "tangent/frames.h"

#include <string.h>
#include "base/exact.h"
#include "tangent/weigh.h"
#include "topology/corners.h"

nt_dvec3 nt_unit_normal(const nmtan_mesh *mesh, size_t vertex)
{
	const float *n = nt_normal(mesh, vertex);
	const bool finite = isfinite(n[0]) && isfinite(n[1]) && isfinite(n[2]);
	return finite ? nt_weigh_normal(n[0], n[1], n[2]) : (nt_dvec3){0, 0, 0};
}

/* The texture coordinates of a triangle, as given or as stored. */
static void load_texcoords(const nmtan_mesh *mesh, const uint32_t corners[3], bool stored, float t[3][2])
{
	for (int k = 0; k < 3; k++) {
		const size_t vertex = nt_vertex_of(mesh, corners[k]);
		if (stored && nt_has_stored(mesh))
			nt_stored_texcoord(mesh, vertex, t[k]);
		else
			memcpy(t[k], nt_texcoord(mesh, vertex), sizeof t[k]);
	}
}

int nt_triangle_orientation(const nmtan_mesh *mesh, const uint32_t corners[3], bool stored)
{
	if (!stored || !nt_has_stored(mesh))
		return nt_orientation(nt_texcoord(mesh, nt_vertex_of(mesh, corners[0])),
			nt_texcoord(mesh, nt_vertex_of(mesh, corners[1])),
			nt_texcoord(mesh, nt_vertex_of(mesh, corners[2])));
	float t[3][2];
	load_texcoords(mesh, corners, stored, t);
	const int sign = nt_orientation(t[0], t[1], t[2]);
	return nt_has_stored_texcoords(mesh) && mesh->stored->mirrored ? -sign : sign;
}

/* Twice the area of a triangle in UV space, and the sum of the products behind it. */
static double measure_area(float t[3][2], double *magnitude)
{
	const double left = ((double)t[1][0] - t[0][0]) * ((double)t[2][1] - t[0][1]);
	const double right = ((double)t[1][1] - t[0][1]) * ((double)t[2][0] - t[0][0]);
	*magnitude = fabs(left) + fabs(right);
	return fabs(left - right);
}

/* Which half of a quad has the larger area in UV space: 1 the first, -1 the second, 0: they are equal. *even: they are,
 * as far as MikkTSpace's floats can tell, which makes four roundings of each. */
static int compare_halves(const nmtan_mesh *mesh, uint32_t corners[2][3], bool stored, bool *even)
{
	float t[2][3][2];
	double magnitudes[2];
	load_texcoords(mesh, corners[0], stored, t[0]);
	load_texcoords(mesh, corners[1], stored, t[1]);
	const double first = measure_area(t[0], &magnitudes[0]), second = measure_area(t[1], &magnitudes[1]);
	*even = fabs(first - second) <= 0x1p-22 * (magnitudes[0] + magnitudes[1]);
	return nt_compare_area(t[0][0], t[0][1], t[0][2], t[1][0], t[1][1], t[1][2]);
}

/* The orientation of a quad whose halves have the given, different signs. */
static int choose_half(const nmtan_mesh *mesh, uint32_t corners[2][3], bool stored, const int signs[2], nt_fold *fold)
{
	const bool collapsed[2] = {nt_is_collapsed(mesh, corners[0]), nt_is_collapsed(mesh, corners[1])};
	if (collapsed[0] != collapsed[1])
		return signs[collapsed[0]];
	if (!signs[0] || !signs[1])
		return signs[0] + signs[1];
	bool even;
	const int larger = compare_halves(mesh, corners, stored, &even);
	*fold = even && !collapsed[0] ? NT_FOLDED_EVENLY : NT_FOLDED;
	return signs[larger < 0];
}

int nt_cut_orientation(const nmtan_mesh *mesh, uint32_t corners[2][3], unsigned count, bool stored, nt_fold *fold)
{
	int signs[2] = {nt_triangle_orientation(mesh, corners[0], stored), 0};
	int sign = signs[0];
	nt_fold is = NT_NOT_FOLDED;
	if (count == 2) {
		signs[1] = nt_triangle_orientation(mesh, corners[1], stored);
		is = signs[0] * signs[1] < 0 ? NT_FOLDED : NT_NOT_FOLDED;
		if (signs[0] != signs[1])
			sign = choose_half(mesh, corners, stored, signs, &is);
	}
	if (fold)
		*fold = is;
	return sign || !stored || !nt_has_stored(mesh)
		? sign : nt_cut_orientation(mesh, corners, count, false, NULL);
}

int nt_face_orientation(const nmtan_mesh *mesh, size_t face, size_t first, bool stored, nt_fold *fold)
{
	uint32_t corners[2][3];
	const unsigned count = nt_face_triangles(mesh, face, first, corners);
	return nt_cut_orientation(mesh, corners, count, stored, fold);
}

bool nt_outline_crosses(const nmtan_mesh *mesh, size_t first)
{
	bool crosses = true;
	for (int cut = 0; cut < 2 && crosses; cut++) {
		int product = 1;
		for (int half = 0; half < 2; half++) {
			const unsigned char *k = nt_quad_triangles[cut][half];
			const uint32_t c = (uint32_t)first, corners[3] = {c + k[0], c + k[1], c + k[2]};
			product *= nt_triangle_orientation(mesh, corners, true);
		}
		crosses = product < 0;
	}
	return crosses;
}

/* Data of a triangle for the sums. */
typedef struct solved {
	nt_dvec3 u;          /* dP/du times |determinant|: growing u */
	nt_dvec3 across;     /* cross product of the edges from the first corner */
	nt_dvec3 edge[3];    /* from corner k to k + 1 */
	double determinant;  /* of the UV edges, magnitude */
} solved;

/* A difference p - q of products, or of their largest components, that loses more than `most` bits' worth. */
static bool cancels(double most, double p, double q, double difference)
{
	return most * difference < (p > q ? p : q);
}

/* s a - t b as rounded products have it; false where they cancel. */
static bool combine(double most, double s, nt_dvec3 a, double t, nt_dvec3 b, nt_dvec3 *difference)
{
	const nt_dvec3 p = nt_dvec3_scale(s, a), q = nt_dvec3_scale(t, b);
	*difference = nt_dvec3_sub(p, q);
	return !cancels(most, nt_dvec3_largest(p), nt_dvec3_largest(q), nt_dvec3_largest(*difference));
}

/* a x b, the same. */
static bool cross(double most, nt_dvec3 a, nt_dvec3 b, nt_dvec3 *difference)
{
	const nt_dvec3 p = {a.y * b.z, a.z * b.x, a.x * b.y}, q = {a.z * b.y, a.x * b.z, a.y * b.x};
	*difference = nt_dvec3_sub(p, q);
	return !cancels(most, nt_dvec3_largest(p), nt_dvec3_largest(q), nt_dvec3_largest(*difference));
}

static nt_dvec3 combine_exactly(double s, nt_dvec3 a, double t, nt_dvec3 b)
{
	return (nt_dvec3){nt_product_difference(s, a.x, t, b.x), nt_product_difference(s, a.y, t, b.y),
		nt_product_difference(s, a.z, t, b.z)};
}

static nt_dvec3 cross_exactly(nt_dvec3 a, nt_dvec3 b)
{
	return (nt_dvec3){nt_product_difference(a.y, b.z, a.z, b.y),
		nt_product_difference(a.z, b.x, a.x, b.z), nt_product_difference(a.x, b.y, a.y, b.x)};
}

static inline NT_ALWAYS_INLINE double error3(nt_dvec3 difference, const float *a, const float *b)
{
	return nt_difference_error(difference.x, a[0], b[0]) + nt_difference_error(difference.y, a[1], b[1]) +
	       nt_difference_error(difference.z, a[2], b[2]);
}

/* The same values by expansions, for triangles whose exponents lie so far apart that a difference is not
 * a double, and whose products cancel. */
static void solve_by_expansions(const float *const p[3], const float *const t[3], solved *f)
{
	double d1[3][2], d2[3][2], bu[2], bv[2], cu[2], cv[2];
	for (int i = 0; i < 3; i++) {
		nt_difference(d1[i], p[1][i], p[0][i]);
		nt_difference(d2[i], p[2][i], p[0][i]);
	}
	nt_difference(bu, t[1][0], t[0][0]);
	nt_difference(bv, t[1][1], t[0][1]);
	nt_difference(cu, t[2][0], t[0][0]);
	nt_difference(cv, t[2][1], t[0][1]);
	double u[3], across[3];
	for (int i = 0; i < 3; i++) {
		const int j = (i + 1) % 3, k = (i + 2) % 3;
		u[i] = nt_exact_product_difference(cv, d1[i], bv, d2[i]);
		across[i] = nt_exact_product_difference(d1[j], d2[k], d1[k], d2[j]);
	}
	f->u = (nt_dvec3){u[0], u[1], u[2]};
	f->across = (nt_dvec3){across[0], across[1], across[2]};
	f->determinant = nt_exact_product_difference(bu, cv, bv, cu);
}

/* The edges from a triangle's first corner. */
typedef struct edges {
	const float *p[3], *t[3];  /* positions, texture coordinates */
	nt_uv_edges uv;
	bool exact, exact_uv;      /* differences are doubles: all; those of texture coordinates */
	double most;               /* by which products may cancel */
} edges;

/* The direction of growing u, from differences that are doubles, or nearly; false where that is not enough. */
static bool solve_direction(const edges *e, solved *f)
{
	const nt_dvec3 d1 = f->edge[0], d2 = nt_dvec3_scale(-1.0, f->edge[2]);
	if (combine(e->most, e->uv.cv, d1, e->uv.bv, d2, &f->u))
		return true;
	if (e->exact)
		f->u = combine_exactly(e->uv.cv, d1, e->uv.bv, d2);
	return e->exact;
}

/* The same of all else. */
static bool solve_rest(const edges *e, solved *f)
{
	const nt_dvec3 d1 = f->edge[0], d2 = nt_dvec3_scale(-1.0, f->edge[2]);
	if (!cross(e->most, d1, d2, &f->across)) {
		if (!e->exact)
			return false;
		f->across = cross_exactly(d1, d2);
	}
	const double p = e->uv.bu * e->uv.cv, q = e->uv.bv * e->uv.cu;
	f->determinant = p - q;
	if (cancels(e->exact_uv ? NT_CANCELLATION : NT_CANCELLATION_INEXACT, fabs(p), fabs(q), fabs(f->determinant))) {
		if (!e->exact_uv)
			return false;
		f->determinant = nt_product_difference(e->uv.bu, e->uv.cv, e->uv.bv, e->uv.cu);
	}
	return true;
}

/* Edges, and those of `f`. Returns the exact sign of the determinant; 0 where a value is not finite, too. */
static int make_edges(const nmtan_mesh *mesh, const uint32_t corners[3], edges *e, solved *f)
{
	float not_finite = 0.0f; /* 0 or NaN */
	for (int k = 0; k < 3; k++) {
		const size_t vertex = nt_vertex_of(mesh, corners[k]);
		e->p[k] = nt_position(mesh, vertex);
		e->t[k] = nt_texcoord(mesh, vertex);
		not_finite += 0.0f * e->p[k][0] + 0.0f * e->p[k][1] + 0.0f * e->p[k][2];
	}
	const float *const *p = e->p, *const *t = e->t;
	e->uv = nt_uv_edges_of(t[0], t[1], t[2]);
	const int sign = nt_orientation_by(&e->uv, t[0], t[1], t[2]); /* 0 where one is not finite */
	if (sign == 0 || not_finite != 0.0f)
		return 0;
	for (int k = 0; k < 3; k++)
		f->edge[k] = nt_dvec3_sub(nt_dvec3_load(p[(k + 1) % 3]), nt_dvec3_load(p[k]));
	e->exact_uv = e->uv.error == 0.0;
	e->exact = e->exact_uv && error3(f->edge[0], p[0], p[1]) +
			error3(nt_dvec3_scale(-1.0, f->edge[2]), p[0], p[2]) == 0.0;
	e->most = e->exact ? NT_CANCELLATION : NT_CANCELLATION_INEXACT;
	return sign;
}

/* Which corners a direction adds to; what has no weight adds no condition either. False: to none. */
static inline NT_ALWAYS_INLINE bool find_corners(nt_weight weight, nt_dvec3 u, const nt_dvec3 normals[3],
	nt_frame_sum *const sums[3], bool adds[3])
{
	const double squared = nt_dvec3_dot(u, u);
	for (int k = 0; k < 3; k++)
		adds[k] = sums[k] &&
			(weight == NT_WEIGHT_NONE || nt_is_across(squared, nt_dvec3_reject(normals[k], u)));
	return adds[0] || adds[1] || adds[2];
}

static void add_corner(const solved *f, const nt_measured *m, const double lengths[3], nt_weight weight, nt_dvec3 n,
	int k, nt_frame_sum *sum)
{
	const int before = (k + 2) % 3, by_area = weight == NT_WEIGHT_AREA;
	const bool has_normal = n.x != 0.0 || n.y != 0.0 || n.z != 0.0;
	const double sine = has_normal ? fabs(nt_dvec3_dot(n, f->across)) : nt_dvec3_length(f->across);
	const nt_weighed w = weight == NT_WEIGHT_NONE
		? nt_weigh_nothing(m, n, 1.0 / f->determinant)
		: nt_weigh_corner(m, n, f->edge[k], f->edge[before], lengths[k], lengths[before], sine, by_area);
	sum->u = nt_dvec3_add(sum->u, w.u);
	sum->weights += w.weight;
	sum->sensitivity += w.sensitivity;
	sum->stretch += w.stretch;
}

void nt_add_triangle(const nmtan_mesh *mesh, nt_weight weight, const uint32_t corners[3], const nt_dvec3 normals[3],
	nt_frame_sum *const sums[3])
{
	solved f;
	edges e;
	bool adds[3];
	const int sign = make_edges(mesh, corners, &e, &f);
	if (!sign)
		return;
	const bool by_doubles = solve_direction(&e, &f);
	/* a direction from exact differences stays: whether it adds something is known before the rest is */
	const bool stays = by_doubles && e.exact;
	if (stays && !find_corners(weight, f.u, normals, sums, adds))
		return;
	if (!by_doubles || !solve_rest(&e, &f))
		solve_by_expansions(e.p, e.t, &f);
	f.u = nt_dvec3_scale(sign, f.u);
	f.determinant = fabs(f.determinant);
	if (!stays && !find_corners(weight, f.u, normals, sums, adds))
		return;
	const nt_measured m = nt_measure(f.u, f.across);
	double lengths[3];
	for (int k = 0; k < 3; k++)
		lengths[k] = nt_measure_edge(f.edge[k], weight == NT_WEIGHT_AREA);
	for (int k = 0; k < 3; k++)
		if (adds[k])
			add_corner(&f, &m, lengths, weight, normals[k], k, sums[k]);
}

bool nt_sum_tangent(const nt_frame_sum *sum, nt_dvec3 n, nt_dvec3 *tangent)
{
	if (!(nt_dvec3_length(sum->u) > NT_CANCELLED * sum->weights))
		return false;
	*tangent = nt_dvec3_reject(n, sum->u);
	return nt_dvec3_normalise(tangent);
}
