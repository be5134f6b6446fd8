/* SPDX-License-Identifier: MIT */
/*
 * Triangles and normals by themselves: what is not finite, has no area in space or in UV space, nearly has
 * none, or is lit from behind.
 *
 * How near to degenerate is too near? The tangent runs along the line of equal v: T = (v2 d1 - v1 d2) / det, with d1,
 * d2 the edges from the first corner in space, v1, v2 in v, and B alike. An error of v at the three corners, each up
 * to d = 2^-24 max |v|, turns T towards B, to first order by the sine of d (|v1| + |v2| + |v1 - v2|) / |det| times
 * the part of B across T over |T|, which is |d1 x d2| |det| / |v2 d1 - v1 d2|^2. An error of u only makes T longer or
 * shorter. If rounding may turn the sign of det, w and all of T are uncertain.
 *
 * Nothing is said of a triangle that is as thin in space: no unwrap makes it wider, and nobody sees it.
 */
#include "report/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/vec.h"

/* Sine of the rounding error from which on a triangle counts as nearly degenerate: of one degree. */
static const double NEAR_DEGENERATE_SINE = 0.017452406437283512;

/* A triangle is as thin in space if its height over its longest side is at most so many times that in UV space. */
static const double FAITHFUL_STRETCH = 2.0;

/* Share of the mesh's area from which on degenerate triangles, and triangles lit from behind, are a warning. */
static const double VISIBLE_SHARE = 0.01;

/* The tolerance of the Khronos validator. */
static const double UNIT_TOLERANCE = 0.00674;

/* Triangles that a thread takes at a time. */
enum { PART = 128 * NT_BLOCK };

/* Tallies, sums and greatest values of a part. */
enum { FLAT, MISSING, NO_AREA, NEAR, AGAINST };
static const nt_code codes[] = {NT_CODE_POS_DEGENERATE_TRIANGLE, NT_CODE_UV_MISSING, NT_CODE_UV_DEGENERATE_TRIANGLE,
	NT_CODE_UV_NEAR_DEGENERATE, NT_CODE_MESH_NORMAL_AGAINST_FACE};
enum { COINCIDENT, COLLINEAR, NEARLY_COINCIDENT, UNDECIDED, FLAT_IN_BOTH };
enum { BOUND, DETERMINANT }; /* the least one's negative */

typedef struct triangle_work {
	nt_check *check;
	float *determinants; /* [triangle_count] relative; NaN where a triangle has no orientation */
} triangle_work;

static bool is_finite(const float *values, size_t count)
{
	for (size_t i = 0; i < count; i++)
		if (!isfinite(values[i]))
			return false;
	return true;
}

/* A triangle's UV edges, and its tangent times the determinant. */
typedef struct uv_frame {
	double n1, n2, n3;          /* squares of its sides: |e1|^2, |e2|^2, |e1 - e2|^2 */
	double determinant;         /* |det M| */
	double uu;                  /* |det M|^2 |T|^2 */
	double range, size;         /* of v: greatest difference, max |v| */
	double reach;               /* greatest |u| or |v| */
	double uncertain;           /* |det M| from which on rounding does not turn its sign */
} uv_frame;

static double greater(double a, double b)
{
	return a > b ? a : b;
}

static uv_frame measure_frame(const float *const t[3], nt_dvec3 d1, nt_dvec3 d2)
{
	const double e1[2] = {(double)t[1][0] - t[0][0], (double)t[1][1] - t[0][1]};
	const double e2[2] = {(double)t[2][0] - t[0][0], (double)t[2][1] - t[0][1]};
	const nt_dvec3 u = nt_dvec3_sub(nt_dvec3_scale(e2[1], d1), nt_dvec3_scale(e1[1], d2));
	const double width = greater(fabs(t[0][0]), greater(fabs(t[1][0]), fabs(t[2][0])));
	const double size = greater(fabs(t[0][1]), greater(fabs(t[1][1]), fabs(t[2][1])));
	const double x = greater(greater(fabs(e1[0]), fabs(e2[0])), fabs(e1[0] - e2[0]));
	const double y = greater(greater(fabs(e1[1]), fabs(e2[1])), fabs(e1[1] - e2[1]));
	const double e3[2] = {e1[0] - e2[0], e1[1] - e2[1]};
	return (uv_frame){e1[0] * e1[0] + e1[1] * e1[1], e2[0] * e2[0] + e2[1] * e2[1], e3[0] * e3[0] + e3[1] * e3[1],
		fabs(e1[0] * e2[1] - e1[1] * e2[0]), nt_dvec3_dot(u, u),
		y, size, greater(width, size), 2.0 * 0x1p-24 * (width * y + size * x)}; /* as nt_is_sliver() has it */
}

/* The sine of how far rounding of the texture coordinates may turn the tangent; across: |d1 x d2|. */
static double rounding_sine(const nt_surface *s, size_t t, const uv_frame *f, double across)
{
	double error = 0.0;
	for (size_t k = 0; k < 3; k++)
		error += nt_half_unit(nt_side_texcoord(s, 3 * t + k)[1]) *
			fabs((double)nt_side_texcoord(s, 3 * t + (k + 1) % 3)[1] -
				nt_side_texcoord(s, 3 * t + (k + 2) % 3)[1]);
	return nt_is_sliver(s, t) ? INFINITY : error * across / f->uu;
}

/* Whether that is below the limit for certain, by the largest coordinate and without a root or a quotient. For the
 * rest, values too small or too large to be squared included, the sine itself decides. */
static bool is_far_from_degenerate(const uv_frame *f, nt_dvec3 face)
{
	const double error = 0x1p-24 * f->size * 2.0 * f->range;
	const double left = error * error * nt_dvec3_dot(face, face);
	const double right = 0.9 * NEAR_DEGENERATE_SINE * NEAR_DEGENERATE_SINE * f->uu * f->uu;
	return left < right && right > 1e-200 && f->determinant > f->uncertain;
}

/* Whether rounding may turn a side of that squared length by more than the limit: its ends are at one place. */
static bool is_coincident(const uv_frame *f, double square)
{
	const double error = 0x1p-24 * f->reach; /* of each end along each axis */
	return square * NEAR_DEGENERATE_SINE * NEAR_DEGENERATE_SINE <= 8.0 * error * error;
}

/* Whether a triangle is as thin in space, or so thin that it would be nearly degenerate if it were mapped without
 * stretch, unless all its coordinates are at one place. across: |d1 x d2| */
static bool is_thin_in_space(const uv_frame *f, nt_dvec3 d1, nt_dvec3 d2, double across)
{
	const nt_dvec3 d3 = nt_dvec3_sub(d1, d2);
	const double longest = greater(nt_dvec3_dot(d1, d1), greater(nt_dvec3_dot(d2, d2), nt_dvec3_dot(d3, d3)));
	const double uv_longest = greater(f->n1, greater(f->n2, f->n3));
	const double width = greater(FAITHFUL_STRETCH * f->determinant, f->uncertain / NEAR_DEGENERATE_SINE);
	return across * uv_longest <= width * longest && !is_coincident(f, uv_longest);
}

/* Notes a triangle whose tangent rounding may turn by `sine` and more than the limit. */
static void note_near_degenerate(const nt_check *check, size_t t, const uv_frame *f, double sine, nt_part *part)
{
	const double bound = sine < 1.0 ? asin(sine) * NT_DEGREES : 90.0;
	/* that of the two longest sides, whichever corner is the first */
	const double two_longest = greater(f->n1 * f->n2, f->n3 * greater(f->n1, f->n2));
	const double shortest = -greater(-f->n1, greater(-f->n2, -f->n3));
	nt_tally_triangle(check, &part->tallies[NEAR], t, bound);
	part->tallies[NEAR].area += nt_triangle_area(&check->surface, t);
	part->sums[NEARLY_COINCIDENT] += is_coincident(f, shortest);
	part->sums[UNDECIDED] += !(sine < 1.0);
	if (sine < 1.0)
		part->greatest[BOUND] = fmax(part->greatest[BOUND], bound);
	part->greatest[DETERMINANT] = fmax(part->greatest[DETERMINANT], -f->determinant / sqrt(two_longest));
}

/* Whether the file has no texture coordinates for a triangle, but for others. */
static bool lacks_texcoords(const nt_check *check, const uint32_t v[3])
{
	const uint8_t *lacks = check->mesh->vertex_lacks;
	return lacks && lacks[v[0]] & lacks[v[1]] & lacks[v[2]] & NT_LACKS_TEXCOORD;
}

/* Whether a triangle has no area in space: no unwrap gives it one in UV space that anybody sees. */
static bool is_flat(const nt_surface *s, size_t t)
{
	return s->flatness[t] == NT_COINCIDENT || s->flatness[t] == NT_COLLINEAR;
}

/* face: d1 x d2 */
static void check_texcoords(const triangle_work *work, size_t t, const uint32_t v[3], nt_dvec3 d1, nt_dvec3 d2,
	nt_dvec3 face, nt_part *part)
{
	nt_check *check = work->check;
	const nt_surface *s = &check->surface;
	work->determinants[t] = NAN;
	if (s->orientation[t] == 0) {
		const bool lacks = lacks_texcoords(check, v);
		const double area = nt_triangle_area(s, t);
		nt_tally *tally = &part->tallies[lacks ? MISSING : NO_AREA];
		if (!lacks && is_flat(s, t)) {
			part->sums[FLAT_IN_BOTH]++;
			return;
		}
		nt_tally_triangle(check, tally, t, area);
		tally->area += area;
		return;
	}
	const float *const uv[3] = {s->texcoords + 2 * (size_t)v[0], s->texcoords + 2 * (size_t)v[1],
		s->texcoords + 2 * (size_t)v[2]};
	const uv_frame frame = measure_frame(uv, d1, d2);
	const double determinant = frame.determinant / sqrt(frame.n1 * frame.n2);
	if (isfinite(determinant))
		work->determinants[t] = (float)determinant;
	if (is_far_from_degenerate(&frame, face) || is_flat(s, t))
		return;
	const double across = nt_dvec3_length(face), sine = rounding_sine(s, t, &frame, across);
	if (!(sine <= NEAR_DEGENERATE_SINE) && !is_thin_in_space(&frame, d1, d2, across))
		note_near_degenerate(check, t, &frame, sine, part);
}

/* Whether the normals of all corners point to the back, and with them what is interpolated at each pixel. If one does
 * not, a part is lit from the front: what smooth normals do at sharp bends. */
static bool is_against_normals(const float *normals, const uint32_t v[3], nt_dvec3 face)
{
	for (size_t k = 0; k < 3; k++)
		if (!(nt_dvec3_dot(face, nt_dvec3_load(normals + 3 * (size_t)v[k])) < 0.0))
			return false;
	return true;
}

static void check_triangle(const triangle_work *work, size_t t, nt_part *part)
{
	nt_check *check = work->check;
	const nt_surface *s = &check->surface;
	const nt_flatness flatness = s->flatness[t];
	/* POS_ROUNDED says what happened to the file's positions: the triangle may have an area there */
	if (is_flat(s, t) && !check->scene->positions_rounded) {
		part->sums[flatness == NT_COINCIDENT ? COINCIDENT : COLLINEAR]++;
		nt_tally_triangle(check, &part->tallies[FLAT], t, nt_triangle_area(s, t));
	}
	const uint32_t v[3] = {nt_side_vertex(s, 3 * t), nt_side_vertex(s, 3 * t + 1), nt_side_vertex(s, 3 * t + 2)};
	const float *positions = check->mesh->positions;
	const nt_dvec3 a = nt_dvec3_load(positions + 3 * (size_t)v[0]);
	const nt_dvec3 d1 = nt_dvec3_sub(nt_dvec3_load(positions + 3 * (size_t)v[1]), a);
	const nt_dvec3 d2 = nt_dvec3_sub(nt_dvec3_load(positions + 3 * (size_t)v[2]), a);
	const nt_dvec3 face = nt_dvec3_cross(d1, d2);
	if (check->mesh->texcoords)
		check_texcoords(work, t, v, d1, d2, face, part);
	if (check->mesh->normals && flatness == NT_SOUND && is_against_normals(check->mesh->normals, v, face)) {
		nt_tally_triangle(check, &part->tallies[AGAINST], t, NAN);
		part->tallies[AGAINST].area += nt_triangle_area(s, t);
	}
}

static void check_part(void *context, size_t begin, size_t end, unsigned slot, nt_part *part)
{
	const triangle_work *work = context;
	(void)slot;
	for (size_t t = begin; t < end; t++) {
		if (t % NT_BLOCK == 0)
			nt_surface_measure(&work->check->surface, t / NT_BLOCK);
		check_triangle(work, t, part);
	}
}

/* ---- least, median and greatest determinant ---- */

static uint32_t bits_of(float value)
{
	uint32_t bits;
	memcpy(&bits, &value, sizeof bits);
	return bits;
}

/* The bits of floats that are not negative are in the order of the values: the median's digits are found from the upper
 * one on, by counts of the values that have those above. Small meshes have small digits: there may be many of them. */
static void find_determinants(nt_report_mesh *facts, const float *values, size_t count)
{
	float least = INFINITY, greatest = -INFINITY, median;
	uint32_t bits = 0;
	size_t rank = 0;
	for (size_t t = 0; t < count; t++) {
		least = values[t] < least ? values[t] : least;
		greatest = values[t] > greatest ? values[t] : greatest;
		rank += values[t] == values[t];
	}
	if (!rank)
		return;
	rank /= 2;
	const int width = count > 1024 ? 8 : 4;
	for (int shift = 32 - width; shift >= 0; shift -= width) {
		uint32_t counts[256], digit = 0;
		memset(counts, 0, sizeof *counts << width);
		for (size_t t = 0; t < count; t++)
			if (values[t] == values[t] && (uint64_t)bits_of(values[t]) >> shift >> width == bits)
				counts[bits_of(values[t]) >> shift & ((1u << width) - 1)]++;
		while (counts[digit] <= rank)
			rank -= counts[digit++];
		bits = bits << width | digit;
	}
	memcpy(&median, &bits, sizeof median);
	memcpy(facts->relative_determinant, (double[3]){least, median, greatest}, sizeof facts->relative_determinant);
}

static void sum_blocks(nt_check *check)
{
	const nt_surface *s = &check->surface;
	nt_report_mesh *facts = check->facts;
	for (size_t b = 0; b < nt_block_count(s); b++) {
		for (int i = 0; i < 3; i++) {
			facts->triangles[i] += s->blocks[b].triangles[i];
			facts->areas[i] += s->blocks[b].areas[i];
		}
		nt_box_join(&facts->box, &s->blocks[b].box);
	}
	for (int i = 0; i < 3; i++)
		check->total_area += facts->areas[i];
}

/* How many corners of degenerate triangles that have texture coordinates share their vertex with a sound one, whose
 * tangent they take; the others get a vector perpendicular to their normal. */
static nt_status count_neighbours(const nt_check *check, size_t *count)
{
	const nt_surface *s = &check->surface;
	const size_t words = nt_bit_words(check->mesh->vertex_count);
	*count = 0;
	if (!check->mesh->texcoords || !check->facts->triangles[1])
		return NT_OK;
	uint64_t *sound = nt_scratch_alloc(check->scratch, words, sizeof *sound);
	if (!sound)
		return NT_ERROR_MEMORY;
	memset(sound, 0, words * sizeof *sound);
	for (size_t c = 0; c < 3 * s->triangle_count; c++)
		if (s->orientation[c / 3] && s->flatness[c / 3] != NT_COINCIDENT)
			nt_bit_set(sound, nt_side_vertex(s, c));
	for (size_t c = 0; c < 3 * s->triangle_count; c++) {
		const uint32_t v = nt_side_vertex(s, c);
		const bool lacks = check->mesh->vertex_lacks && check->mesh->vertex_lacks[v] & NT_LACKS_TEXCOORD;
		*count += !s->orientation[c / 3] && !is_flat(s, c / 3) && !lacks && nt_bit(sound, v);
	}
	return NT_OK;
}

static void report_near_degenerate(nt_check *check, nt_part *all, nt_severity severity, double percent)
{
	nt_tally *near = &all->tallies[NEAR];
	const size_t coincident = (size_t)all->sums[NEARLY_COINCIDENT], undecided = (size_t)all->sums[UNDECIDED];
	const double degrees = all->greatest[BOUND]; /* infinite if all are undecided */
	char kinds[80] = "collinear", error[96];
	nt_tally_number(near, "least_relative_determinant", -all->greatest[DETERMINANT]);
	nt_tally_number(near, "greatest_error_degrees", degrees);
	nt_tally_number(near, "coincident_corners", (double)coincident);
	nt_tally_number(near, "undecided_tangents", (double)undecided);
	if (coincident == near->count)
		snprintf(kinds, sizeof kinds, "coincident");
	else if (coincident)
		snprintf(kinds, sizeof kinds, "collinear (%zu) or coincident (%zu)",
			near->count - coincident, coincident);
	if (undecided == near->count)
		snprintf(error, sizeof error, "decides %s", undecided == 1 ? "the tangent" : "their tangents");
	else if (undecided)
		snprintf(error, sizeof error, "decides the tangent%s of %zu and turns others by up to %.2g degrees",
			undecided == 1 ? "" : "s", undecided, degrees);
	else
		snprintf(error, sizeof error, "turns tangents by up to %.2g degrees", degrees);
	nt_check_report_as(check, near, severity, "nearly %s coordinates, %.3g %% of the area; rounding %s", kinds,
		percent, error);
}

/* from_neighbour: corners of degenerate triangles that take a neighbour's tangent. */
static void report_triangles(nt_check *check, nt_part *all, size_t from_neighbour)
{
	const double total = check->total_area > 0.0 ? check->total_area : 1.0;
	/* rounding is seen in tangents alone, what has no area in a texture as well */
	const bool of_tangents = nt_needs_tangents(check) || check->stored != NT_STORED_NONE;
	nt_tally *tallies = all->tallies;
	nt_severity severities[NT_PART_TALLIES];
	for (size_t k = MISSING; k <= AGAINST; k++) {
		severities[k] = tallies[k].area > VISIBLE_SHARE * check->total_area ? NT_SEVERITY_WARNING
			: NT_SEVERITY_INFO; /* slivers that nobody sees */
		if (k != AGAINST)
			severities[k] = nt_texcoord_severity(check, severities[k]);
		nt_tally_number(&tallies[k], "area_share", tallies[k].area / total);
	}

	nt_tally_number(&tallies[FLAT], "coincident_corners", all->sums[COINCIDENT]);
	nt_tally_number(&tallies[FLAT], "collinear_corners", all->sums[COLLINEAR]);
	nt_check_report(check, &tallies[FLAT], NULL);

	nt_check_report_as(check, &tallies[MISSING], severities[MISSING],
		"%zu of %zu triangles %s no texture coordinates", tallies[MISSING].count,
		check->surface.triangle_count, tallies[MISSING].count == 1 ? "has" : "have");

	nt_tally *no_area = &tallies[NO_AREA];
	const size_t from_normal = 3 * no_area->count - from_neighbour;
	nt_tally_number(no_area, "corners_from_neighbour", (double)from_neighbour);
	nt_tally_number(no_area, "corners_from_normal", (double)from_normal);
	if (no_area->count && no_area->count + (size_t)all->sums[FLAT_IN_BOTH] == check->surface.triangle_count) {
		no_area->code = NT_CODE_UV_UNMAPPED;
		nt_check_report_as(check, no_area, severities[NO_AREA], NULL);
	} else if (nt_is_visible(check, no_area->area) && (of_tangents || !check->untextured)) {
		/* nobody gets any where none are made */
		const bool made = check->mesh->decision == NT_DECISION_SOLVE;
		char neighbours[80] = "", normals[80] = "";
		if (made && from_neighbour)
			snprintf(neighbours, sizeof neighbours, "; %zu %s a neighbour's tangent", from_neighbour,
				from_neighbour == 1 ? "corner takes" : "corners take");
		if (made && from_normal)
			snprintf(normals, sizeof normals, "%s %zu %s a tangent made from the normal",
				from_neighbour ? "," : ";", from_normal,
				from_normal == 1 ? "corner gets" : "corners get");
		nt_check_report_as(check, no_area, severities[NO_AREA], "%.3g %% of the area%s%s",
			100.0 * no_area->area / total, neighbours, normals);
	}

	if (nt_is_visible(check, tallies[NEAR].area) && of_tangents)
		report_near_degenerate(check, all, severities[NEAR], 100.0 * tallies[NEAR].area / total);

	nt_check_report_as(check, &tallies[AGAINST], severities[AGAINST], "%.3g %% of the area",
		100.0 * tallies[AGAINST].area / total);
}

static nt_status check_triangles(nt_check *check)
{
	const size_t triangles = check->surface.triangle_count;
	triangle_work work = {check, nt_scratch_alloc(check->scratch, triangles, sizeof *work.determinants)};
	nt_part all;
	size_t from_neighbour;
	nt_status status = work.determinants ? nt_check_parts(check, triangles, PART, codes,
		sizeof codes / sizeof *codes, check_part, &work, &all) : NT_ERROR_MEMORY;
	if (status)
		return status;
	sum_blocks(check);
	if (check->mesh->texcoords)
		find_determinants(check->facts, work.determinants, triangles);
	status = count_neighbours(check, &from_neighbour);
	if (!status)
		report_triangles(check, &all, from_neighbour);
	return status;
}

/* ---- vertices ---- */

/* Normals whose squared length lies between these have unit length for certain. */
static const double LEAST_UNIT = 0.987, GREATEST_UNIT = 1.0134;

/* Whether there may be something to say about a vertex. */
static bool is_odd(const nt_mesh *mesh, size_t v)
{
	if (!is_finite(mesh->positions + 3 * v, 3) || (mesh->texcoords && !is_finite(mesh->texcoords + 2 * v, 2)))
		return true;
	if (!mesh->normals)
		return false;
	const nt_dvec3 n = nt_dvec3_load(mesh->normals + 3 * v);
	const double square = nt_dvec3_dot(n, n);
	return !(square > LEAST_UNIT && square < GREATEST_UNIT);
}

/* Each vertex that a triangle uses, once. */
static nt_status check_vertices(nt_check *check)
{
	const nt_surface *s = &check->surface;
	const nt_mesh *mesh = check->mesh;
	const size_t words = nt_bit_words(mesh->vertex_count);
	uint64_t *odd = nt_scratch_alloc(check->scratch, words, sizeof *odd);
	bool any = false;
	if (!odd)
		return NT_ERROR_MEMORY;
	memset(odd, 0, words * sizeof *odd);
	for (size_t v = 0; v < mesh->vertex_count; v++)
		if (s->points[v] != NT_NONE && is_odd(mesh, v)) {
			nt_bit_set(odd, v);
			any = true;
		}
	nt_tally position = {.code = NT_CODE_POS_NOT_FINITE};
	nt_tally texcoord = {.code = NT_CODE_UV_NOT_FINITE};
	nt_tally zero = {.code = NT_CODE_MESH_NORMAL_ZERO};
	nt_tally non_unit = {.code = NT_CODE_MESH_NORMAL_NON_UNIT};
	double worst = 1.0;
	for (size_t c = 0; any && c < 3 * s->triangle_count; c++) {
		const uint32_t v = nt_side_vertex(s, c);
		if (!nt_bit(odd, v))
			continue;
		nt_bit_clear(odd, v);
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
	/* what is made of other formats has unit normals */
	const bool stays = nt_format_is_gltf(check->scene->format);
	nt_check_report_as(check, &zero, stays ? NT_SEVERITY_ERROR : NT_SEVERITY_WARNING, NULL);
	nt_check_report_as(check, &non_unit, stays ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO,
		"the worst has length %.4g", worst);
	return NT_OK;
}

nt_status nt_check_geometry(nt_check *check)
{
	const nt_scratch_mark mark = nt_scratch_here(check->scratch);
	nt_status status = check_triangles(check);
	if (!status)
		status = check_vertices(check);
	nt_scratch_back(check->scratch, mark);
	return status;
}
