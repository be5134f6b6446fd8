/* SPDX-License-Identifier: MIT */
/*
 * An origin for positions that float cannot hold: see values.h.
 */
#include "scene/values.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Rounding may move a vertex by this share of the median edge. */
static const double MOST_SHARE = 0.01;

/* Four at a time: floats without their signs are in the order of their bits. */
float nt_largest_of(const float *values, size_t count, float largest)
{
	typedef int32_t lanes __attribute__((vector_size(16)));
	lanes most = {0};
	size_t i = 0;
	for (; i + 4 <= count; i += 4) {
		lanes bits;
		memcpy(&bits, values + i, sizeof bits);
		bits &= INT32_MAX;
		const lanes greater = bits > most;
		most = (bits & greater) | (most & ~greater);
	}
	float found[4];
	memcpy(found, &most, sizeof found);
	for (size_t k = 0; k < 4; k++)
		largest = fmaxf(largest, found[k]);
	for (; i < count; i++)
		largest = fmaxf(largest, fabsf(values[i]));
	return largest;
}

double nt_edge_length(const float *positions, const double *exact, size_t a, size_t b)
{
	double square = 0;
	for (size_t k = 0; k < 3; k++) {
		const double d = exact ? exact[3 * a + k] - exact[3 * b + k]
			: (double)positions[3 * a + k] - (double)positions[3 * b + k];
		square += d * d;
	}
	return sqrt(square);
}

double nt_float_rounding(float largest)
{
	int exponent;
	frexp((double)largest, &exponent);
	return largest > 0 && isfinite(largest) ? ldexp(1.0, exponent - 25) : 0;
}

bool nt_origin_is_suspected(float largest, const double *edges, size_t edge_count, double doubt)
{
	const double least = doubt * nt_float_rounding(largest) / MOST_SHARE;
	size_t shorter = 0;
	for (size_t i = 0; i < edge_count; i++)
		shorter += edges[i] < least;
	return 2 * shorter > edge_count;
}

/* The effect of float on positions relative to an origin. */
typedef struct rounding {
	double largest; /* of a coordinate */
	size_t count;   /* vertices that it moves by more than `most` along an axis */
} rounding;

static rounding measure(const nt_exact *exact, const double origin[3], double most)
{
	rounding r = {0, 0};
	for (size_t v = 0; v < exact->vertex_count; v++) {
		double worst = 0;
		for (size_t k = 0; k < 3; k++) {
			const double place = exact->positions[3 * v + k] - origin[k];
			worst = fmax(worst, fabs((double)(float)place - place));
		}
		r.largest = fmax(r.largest, worst);
		r.count += worst > most;
	}
	return r;
}

/* The largest power of ten that is at most a size: 10^*exponent. Powers of ten up to 10^22 are exact as doubles. */
static int power_of_ten(double size)
{
	int exponent = 0;
	for (double power = 10; power <= size && exponent < 22; power *= 10)
		exponent++;
	for (double power = 1; size > 0 && power > size * (1 + 1e-12) && exponent > -15; power /= 10)
		exponent--;
	return exponent;
}

static void find_centre(const nt_exact *exact, double centre[3])
{
	double least[3], most[3], half = 0, unit = 1;
	for (size_t k = 0; k < 3; k++) {
		least[k] = INFINITY;
		most[k] = -INFINITY;
		for (size_t v = 0; v < exact->vertex_count; v++) {
			least[k] = fmin(least[k], exact->positions[3 * v + k]);
			most[k] = fmax(most[k], exact->positions[3 * v + k]);
		}
		half = fmax(half, most[k] / 2 - least[k] / 2);
	}
	const int exponent = power_of_ten(half);
	for (int i = 0; i < abs(exponent); i++)
		unit *= 10;
	for (size_t k = 0; k < 3; k++) {
		const double middle = least[k] / 2 + most[k] / 2;
		centre[k] = exponent < 0 ? rint(middle * unit) / unit : rint(middle / unit) * unit;
		centre[k] += 0.0; /* no -0 */
	}
}

static int compare_lengths(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;
	return (x > y) - (x < y);
}

static double median_of(double *lengths, size_t count)
{
	qsort(lengths, count, sizeof *lengths, compare_lengths);
	return count ? lengths[count / 2] : INFINITY;
}

const char *nt_origin_text(const double origin[3], char text[NT_ORIGIN_TEXT])
{
	size_t length = 0;
	for (size_t k = 0; k < 3; k++) {
		char number[32];
		snprintf(number, sizeof number, "%.15g", origin[k]);
		if (strtod(number, NULL) != origin[k])
			snprintf(number, sizeof number, "%.17g", origin[k]);
		length += (size_t)snprintf(text + length, NT_ORIGIN_TEXT - length, "%s%s", k ? "," : "", number);
	}
	return text;
}

/* "by up to 0.25, 1.1 times the median edge of 0.22" */
static void report(nt_scene *scene, nt_code code, const rounding *r, double edge, const nt_exact *exact, bool stays)
{
	char text[NT_ORIGIN_TEXT], detail[320];
	int length = 0;
	if (code == NT_CODE_POS_ORIGIN)
		length = snprintf(detail, sizeof detail, "%s", nt_origin_text(scene->origin, text));
	if (r->count)
		snprintf(detail + length, sizeof detail - (size_t)length,
			"%sby up to %.3g, %.2g times the median edge of %.3g%s",
			length ? "; float would round positions " : "", r->largest, r->largest / edge, edge,
			length || !exact->stored ? ""
			: exact->needless ? "; the PLY keeps its numbers, its normals and its tangents"
					  : "; the PLY keeps its numbers: only what is computed is made of the floats");
	const nt_place place = nt_line_place(scene->path, 0);
	nt_finding_put(&scene->findings, (nt_finding){.code = code, .count = length ? 1 : r->count, .detail = detail,
		.stays = stays, .severity = !length && exact->needless ? 1 + NT_SEVERITY_INFO : 0}, &place);
}

void nt_origin_settle(nt_scene *scene, const nt_origin *wished, const nt_exact *exact, float *positions)
{
	const double edge = median_of(exact->edges, exact->edge_count), none[3] = {0, 0, 0};
	const rounding before = measure(exact, none, MOST_SHARE * edge);
	rounding after = before;
	double origin[3] = {0, 0, 0};
	if (wished->choice == NT_ORIGIN_GIVEN)
		memcpy(origin, wished->at, sizeof origin);
	else if (wished->choice == NT_ORIGIN_AUTO && before.count)
		find_centre(exact, origin);
	if (origin[0] != 0 || origin[1] != 0 || origin[2] != 0)
		after = measure(exact, origin, MOST_SHARE * edge);
	/* one vertex far from all others may have the centre where nothing is */
	if (after.count < before.count || wished->choice == NT_ORIGIN_GIVEN)
		memcpy(scene->origin, origin, sizeof origin);
	else
		after = before;
	if (nt_scene_has_origin(scene)) {
		for (size_t i = 0; i < 3 * exact->vertex_count; i++)
			positions[i] = (float)(exact->positions[i] - origin[i % 3]);
		report(scene, NT_CODE_POS_ORIGIN, &before, edge, exact, true);
	}
	scene->positions_rounded = after.count > 0;
	if (scene->positions_rounded)
		report(scene, NT_CODE_POS_ROUNDED, &after, edge, exact,
			wished->choice == NT_ORIGIN_AUTO || exact->needless);
}
