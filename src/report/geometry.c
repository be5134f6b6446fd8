/* SPDX-License-Identifier: MIT */
/*
 * Triangles and normals by themselves: what is not finite, has no area in space or in UV space, nearly has
 * none, or is lit from behind.
 *
 * How near to degenerate is too near? With e1, e2 the UV edges of a triangle as the rows of M and P its
 * edges in space, the frame X = M^-1 P. Each UV coordinate is known to half a unit in the last place, so
 * M is known up to D with |D| <= 2 sqrt(2) d, d = 2^-24 max |uv| (a difference of two coordinates has
 * two such errors). To first order the tangent changes by |M^-1| |D| |X|, |M^-1| = s1 / |det M| with
 * s1 the larger singular value, and turns by at most the arc sine of that over the tangent's length.
 */
#include "report/check.h"

#include <math.h>
#include <string.h>
#include "base/dvec.h"

/* Sine of the rounding error from which on a triangle counts as nearly degenerate: of one degree. */
static const double NEAR_DEGENERATE_SINE = 0.017452406437283512;

/* Share of the mesh's area from which on degenerate triangles are a warning. */
static const double VISIBLE_SHARE = 0.01;

/* The tolerance of the Khronos validator. */
static const double UNIT_TOLERANCE = 0.00674;

static const double DEGREES = 57.29577951308232;

typedef struct triangle_tallies {
	nt_tally flat, no_uv_area, near;
	size_t coincident, collinear;
	size_t from_neighbour; /* corners of degenerate triangles that take a neighbour's tangent */
	double no_uv_share, near_share; /* area */
	double worst_bound, worst_determinant;
	float *determinants; /* relative; of triangles with an orientation */
	size_t determinant_count;
	size_t *histogram; /* [65536] for their median */
} triangle_tallies;

static bool is_finite(const float *values, size_t count)
{
	for (size_t i = 0; i < count; i++)
		if (!isfinite(values[i]))
			return false;
	return true;
}

/* Bound of the sine of how far rounding of the texture coordinates may turn the tangent. `determinant`
 * receives |det| / (|e1| |e2|). */
static double rounding_bound(const nt_surface *s, size_t t, double *determinant)
{
	const float *ta = nt_side_texcoord(s, (uint32_t)(3 * t));
	const float *tb = nt_side_texcoord(s, (uint32_t)(3 * t + 1));
	const float *tc = nt_side_texcoord(s, (uint32_t)(3 * t + 2));
	const double e1[2] = {(double)tb[0] - ta[0], (double)tb[1] - ta[1]};
	const double e2[2] = {(double)tc[0] - ta[0], (double)tc[1] - ta[1]};
	const double n1 = e1[0] * e1[0] + e1[1] * e1[1], n2 = e2[0] * e2[0] + e2[1] * e2[1];
	const double det = fabs(e1[0] * e2[1] - e1[1] * e2[0]);
	*determinant = det / sqrt(n1 * n2);

	const double half = 0.5 * (n1 + n2);
	const double largest = sqrt(half + sqrt(fmax(half * half - det * det, 0.0)));
	const nt_dvec3 a = nt_dvec3_load(nt_side_position(s, (uint32_t)(3 * t)));
	const nt_dvec3 d1 = nt_dvec3_sub(nt_dvec3_load(nt_side_position(s, (uint32_t)(3 * t + 1))), a);
	const nt_dvec3 d2 = nt_dvec3_sub(nt_dvec3_load(nt_side_position(s, (uint32_t)(3 * t + 2))), a);
	const nt_dvec3 u = nt_dvec3_sub(nt_dvec3_scale(e2[1], d1), nt_dvec3_scale(e1[1], d2));
	const nt_dvec3 v = nt_dvec3_sub(nt_dvec3_scale(e1[0], d2), nt_dvec3_scale(e2[0], d1));
	const double uu = nt_dvec3_dot(u, u), vv = nt_dvec3_dot(v, v);
	double size = 0.0;
	for (int i = 0; i < 2; i++)
		size = fmax(size, fmax(fabs(ta[i]), fmax(fabs(tb[i]), fabs(tc[i]))));
	const double error = 2.0 * 1.4142135623730951 * size * 0x1p-24;
	return error * largest / det * sqrt((uu + vv) / uu);
}

/* How many corners of a degenerate triangle share their vertex with a sound one, whose tangent they take;
 * the others get a vector perpendicular to their normal. */
static size_t corners_with_neighbour(const nt_check *check, const uint8_t *sound_vertex, size_t t)
{
	size_t count = 0;
	for (size_t k = 0; k < 3; k++)
		count += sound_vertex[check->surface.vertices[3 * t + k]];
	return count;
}

static void check_triangle(nt_check *check, size_t t, const uint8_t *sound_vertex, triangle_tallies *tt)
{
	const nt_surface *s = &check->surface;
	const bool flat = s->flatness[t] == NT_COINCIDENT || s->flatness[t] == NT_COLLINEAR;
	if (flat) {
		tt->coincident += s->flatness[t] == NT_COINCIDENT;
		tt->collinear += s->flatness[t] == NT_COLLINEAR;
		nt_tally_triangle(check, &tt->flat, t, s->areas[t]);
	}
	if (!check->mesh->texcoords)
		return;
	if (s->orientation[t] == 0) {
		nt_tally_triangle(check, &tt->no_uv_area, t, s->areas[t]);
		tt->no_uv_share += s->areas[t];
		tt->from_neighbour += corners_with_neighbour(check, sound_vertex, t);
		return;
	}
	double determinant;
	const double sine = rounding_bound(s, t, &determinant);
	if (isfinite(determinant))
		tt->determinants[tt->determinant_count++] = (float)determinant;
	if (!flat && !(sine <= NEAR_DEGENERATE_SINE)) {
		const double bound = sine < 1.0 ? asin(sine) * DEGREES : 90.0;
		nt_tally_triangle(check, &tt->near, t, bound);
		tt->near_share += s->areas[t];
		tt->worst_bound = fmax(tt->worst_bound, bound);
		tt->worst_determinant = fmin(tt->worst_determinant, determinant);
	}
}

static uint32_t bits_of(float value)
{
	uint32_t bits;
	memcpy(&bits, &value, sizeof bits);
	return bits;
}

/* The k-th smallest of values that are not negative, whose bits are in the order of their values: a count of
 * upper halves, then of the lower halves in the one that holds it. Linear whatever the values, which
 * quickselect is not. `histogram` has room for 65536 counts. */
static float select_value(const float *values, size_t count, size_t k, size_t *histogram)
{
	uint32_t upper = 0;
	for (int pass = 0; pass < 2; pass++) {
		memset(histogram, 0, 65536 * sizeof *histogram);
		for (size_t i = 0; i < count; i++) {
			const uint32_t bits = bits_of(values[i]);
			if (pass == 0)
				histogram[bits >> 16]++;
			else if (bits >> 16 == upper)
				histogram[bits & 65535]++;
		}
		uint32_t at = 0;
		while (at < 65535 && k >= histogram[at])
			k -= histogram[at++];
		if (pass == 0)
			upper = at;
		else
			upper = upper << 16 | at;
	}
	float value;
	memcpy(&value, &upper, sizeof value);
	return value;
}

static void find_determinants(nt_report_mesh *facts, const triangle_tallies *tt)
{
	const size_t count = tt->determinant_count;
	if (count == 0)
		return;
	float least = tt->determinants[0], greatest = least;
	for (size_t i = 1; i < count; i++) {
		least = fminf(least, tt->determinants[i]);
		greatest = fmaxf(greatest, tt->determinants[i]);
	}
	facts->relative_determinant[0] = least;
	facts->relative_determinant[1] = select_value(tt->determinants, count, count / 2, tt->histogram);
	facts->relative_determinant[2] = greatest;
}

static nt_severity severity_by_share(const nt_check *check, double area)
{
	return area > VISIBLE_SHARE * check->total_area ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO;
}

static void report_triangles(nt_check *check, triangle_tallies *tt)
{
	const double total = check->total_area > 0.0 ? check->total_area : 1.0;
	nt_tally_number(&tt->flat, "coincident_corners", (double)tt->coincident);
	nt_tally_number(&tt->flat, "collinear_corners", (double)tt->collinear);
	nt_check_report(check, &tt->flat, NULL);

	nt_tally *no_area = &tt->no_uv_area;
	nt_tally_number(no_area, "area_share", tt->no_uv_share / total);
	nt_tally_number(no_area, "corners_from_neighbour", (double)tt->from_neighbour);
	nt_tally_number(no_area, "corners_from_normal", (double)(3 * no_area->count - tt->from_neighbour));
	nt_check_report_as(check, no_area, severity_by_share(check, tt->no_uv_share),
		"%.3g %% of the area; %zu corners take a neighbour's tangent, %zu one made from their normal",
		100.0 * tt->no_uv_share / total, tt->from_neighbour,
		3 * no_area->count - tt->from_neighbour);

	nt_tally_number(&tt->near, "area_share", tt->near_share / total);
	nt_tally_number(&tt->near, "least_relative_determinant", tt->worst_determinant);
	nt_tally_number(&tt->near, "greatest_error_degrees", tt->worst_bound);
	nt_check_report_as(check, &tt->near, severity_by_share(check, tt->near_share),
		"relative determinant down to %.2g, error up to %.2g degrees", tt->worst_determinant,
		tt->worst_bound);
}

static nt_status check_triangles(nt_check *check)
{
	const nt_surface *s = &check->surface;
	triangle_tallies *tt = nt_scratch_alloc(check->scratch, 1, sizeof *tt);
	uint8_t *sound_vertex = nt_scratch_alloc(check->scratch, check->mesh->vertex_count, 1);
	if (!tt || !sound_vertex)
		return NT_ERROR_MEMORY;
	*tt = (triangle_tallies){.flat = {.code = NT_CODE_POS_DEGENERATE_TRIANGLE},
		.no_uv_area = {.code = NT_CODE_UV_DEGENERATE_TRIANGLE},
		.near = {.code = NT_CODE_UV_NEAR_DEGENERATE},
		.worst_determinant = INFINITY,
		.determinants = nt_scratch_alloc(check->scratch, s->triangle_count, sizeof(float)),
		.histogram = nt_scratch_alloc(check->scratch, 65536, sizeof(size_t))};
	if (!tt->determinants || !tt->histogram)
		return NT_ERROR_MEMORY;
	memset(sound_vertex, 0, check->mesh->vertex_count);
	for (size_t c = 0; c < 3 * s->triangle_count; c++)
		if (s->orientation[c / 3] && s->flatness[c / 3] != NT_COINCIDENT)
			sound_vertex[s->vertices[c]] = 1;
	for (size_t t = 0; t < s->triangle_count; t++)
		check_triangle(check, t, sound_vertex, tt);
	find_determinants(check->facts, tt);
	report_triangles(check, tt);
	return NT_OK;
}

/* Each vertex that a triangle uses, once. */
static nt_status check_vertices(nt_check *check)
{
	const nt_surface *s = &check->surface;
	const nt_mesh *mesh = check->mesh;
	uint8_t *seen = nt_scratch_alloc(check->scratch, mesh->vertex_count, 1);
	if (!seen)
		return NT_ERROR_MEMORY;
	memset(seen, 0, mesh->vertex_count);
	nt_tally position = {.code = NT_CODE_POS_NOT_FINITE};
	nt_tally texcoord = {.code = NT_CODE_UV_NOT_FINITE};
	nt_tally zero = {.code = NT_CODE_MESH_NORMAL_ZERO};
	nt_tally non_unit = {.code = NT_CODE_MESH_NORMAL_NON_UNIT};
	double worst = 1.0;
	for (size_t c = 0; c < 3 * s->triangle_count; c++) {
		const uint32_t v = s->vertices[c];
		if (seen[v])
			continue;
		seen[v] = 1;
		if (!is_finite(mesh->positions + 3 * (size_t)v, 3))
			nt_tally_vertex(check, &position, v, NAN);
		if (mesh->texcoords && !is_finite(mesh->texcoords + 2 * (size_t)v, 2))
			nt_tally_vertex(check, &texcoord, v, NAN);
		if (!mesh->normals)
			continue;
		const nt_dvec3 n = nt_dvec3_load(mesh->normals + 3 * (size_t)v);
		const double length = sqrt(nt_dvec3_dot(n, n));
		if (!(length > 0.0) || !isfinite(length)) {
			nt_tally_vertex(check, &zero, v, length);
		} else if (fabs(length - 1.0) > UNIT_TOLERANCE) {
			nt_tally_vertex(check, &non_unit, v, length);
			if (fabs(length - 1.0) > fabs(worst - 1.0))
				worst = length;
		}
	}
	nt_tally_number(&non_unit, "worst_length", worst);
	nt_check_report(check, &position, NULL);
	nt_check_report(check, &texcoord, NULL);
	nt_check_report(check, &zero, NULL);
	nt_check_report(check, &non_unit, "the worst has length %.4g", worst);
	return NT_OK;
}

/* Triangles whose corner normals, summed, point to their back. */
static void check_winding(nt_check *check)
{
	const nt_surface *s = &check->surface;
	nt_tally against = {.code = NT_CODE_MESH_NORMAL_AGAINST_FACE};
	double area = 0.0;
	for (size_t t = 0; check->mesh->normals && t < s->triangle_count; t++) {
		if (s->flatness[t] != NT_SOUND)
			continue;
		const nt_dvec3 a = nt_dvec3_load(nt_side_position(s, (uint32_t)(3 * t)));
		const nt_dvec3 b = nt_dvec3_load(nt_side_position(s, (uint32_t)(3 * t + 1)));
		const nt_dvec3 c = nt_dvec3_load(nt_side_position(s, (uint32_t)(3 * t + 2)));
		const nt_dvec3 face = nt_dvec3_cross(nt_dvec3_sub(b, a), nt_dvec3_sub(c, a));
		nt_dvec3 sum = {0, 0, 0};
		for (size_t k = 0; k < 3; k++)
			sum = nt_dvec3_add(sum,
				nt_dvec3_load(check->mesh->normals + 3 * (size_t)s->vertices[3 * t + k]));
		if (nt_dvec3_dot(face, sum) < 0.0) {
			nt_tally_triangle(check, &against, t, NAN);
			area += s->areas[t];
		}
	}
	nt_tally_number(&against, "area_share", check->total_area > 0.0 ? area / check->total_area : 0.0);
	nt_check_report(check, &against, NULL);
}

nt_status nt_check_geometry(nt_check *check)
{
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	nt_status status = check_triangles(check);
	if (!status)
		status = check_vertices(check);
	if (!status)
		check_winding(check);
	nt_scratch_back(check->scratch, mark);
	return status;
}
