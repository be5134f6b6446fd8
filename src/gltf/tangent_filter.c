/* SPDX-License-Identifier: MIT */
/*
 * Tangents before the filters of KHR_meshopt_compression (appendix B of its text).
 *
 * OCTAHEDRAL has a direction as a point of the octahedron |x| + |y| + |z| = 1, its lower half folded outwards, on a
 * grid of so many bits, and gives integers; w passes as it is. As with integers alone (quantize.c) the best of the
 * grid's points around a direction is taken whose result has a length that passes. EXPONENTIAL gives m 2^e; all
 * components have the one exponent with which 1 is a mantissa of one bit, so that w is exact and the mantissas are
 * such integers.
 */
#include "gltf/quantize.h"

#include <math.h>
#include <string.h>
#include "base/vec.h"
#include "ext/meshopt.h"
#include "gltf/document.h"

static const double LENGTH_TOLERANCE = 0.0065; /* quantize.c */

static bool is(const nt_tangent_filter *f, const char *name)
{
	return f->filter && strcmp(f->filter, name) == 0;
}

/* ---- octahedron ---- */

/* The place of a direction in the square. */
static void fold(nt_dvec3 t, double *u, double *v)
{
	const double sum = fabs(t.x) + fabs(t.y) + fabs(t.z);
	*u = t.x / sum;
	*v = t.y / sum;
	if (t.z < 0) {
		const double x = *u;
		*u = copysign(1 - fabs(*v), x);
		*v = copysign(1 - fabs(x), *v);
	}
}

/* The integers that a point of the square gives. */
static nt_dvec3 unfold(double u, double v, double most)
{
	nt_dvec3 t = {u, v, 1 - fabs(u) - fabs(v)};
	const double below = fmin(t.z, 0);
	t.x -= copysign(below, t.x);
	t.y -= copysign(below, t.y);
	const double length = nt_dvec3_length(t);
	return (nt_dvec3){round(t.x / length * most), round(t.y / length * most), round(t.z / length * most)};
}

/* The best point of the grid for a direction of unit length. exact: integers that some point may give; NULL: none. */
static void find_point(nt_dvec3 t, const nt_dvec3 *exact, double one, double most, double point[2])
{
	double u, v, best = -2;
	fold(t, &u, &v);
	/* integers that a view had lie up to a step beside the point that gave them */
	const int width = exact ? 4 : 2;
	const double from[2] = {floor(u * one) - (exact != NULL), floor(v * one) - (exact != NULL)};
	for (int corner = 0; corner < width * width; corner++) {
		const double p[2] = {fmax(fmin(from[0] + corner % width, one), -one),
			fmax(fmin(from[1] + corner / width, one), -one)};
		const nt_dvec3 q = unfold(p[0] / one, p[1] / one, most);
		const double length = nt_dvec3_length(q);
		double score = nt_dvec3_dot(q, t) / length - !(fabs(length / most - 1) <= LENGTH_TOLERANCE);
		if (exact && q.x == exact->x && q.y == exact->y && q.z == exact->z)
			score = 2;
		if (score > best) {
			best = score;
			memcpy(point, p, sizeof p);
		}
	}
}

static void put_integer(unsigned char *bytes, size_t size, size_t k, double value)
{
	const int32_t integer = (int32_t)value;
	for (size_t i = 0; i < size; i++)
		bytes[k * size + i] = (unsigned char)((uint32_t)integer >> 8 * i);
}

static double get_integer(const unsigned char *bytes, size_t size, size_t k)
{
	return size == 1 ? (int8_t)bytes[k] : (int16_t)(bytes[2 * k] | bytes[2 * k + 1] << 8);
}

static void add_cost(nt_rounding *cost, nt_dvec3 before, const float *after)
{
	const nt_dvec3 t = nt_dvec3_load(after), cross = nt_dvec3_cross(before, t);
	const double angle = atan2(nt_dvec3_length(cross), nt_dvec3_dot(before, t));
	cost->count++;
	cost->sum_radians += angle;
	cost->worst_radians = fmax(cost->worst_radians, angle);
}

static nt_status store_octahedral(const nt_tangent_filter *f, float *tangents, size_t count, unsigned char *stored,
	unsigned char *values, nt_rounding *cost, nt_error *error)
{
	const size_t bytes = nt_precision_bytes(f->precision), size = bytes / 4;
	const double one = (1 << (f->bits - 1)) - 1, most = size == 1 ? 127 : 32767;
	const nt_meshopt_view view = {.mode = "ATTRIBUTES", .filter = f->filter, .stride = bytes, .count = count,
		.packed_size = UINT64_MAX};
	nt_status status = nt_meshopt_check(&view, count * bytes, "", error); /* which opens the module */
	for (size_t i = 0; !status && i < count; i++) {
		unsigned char *to = stored + i * bytes;
		nt_dvec3 t = nt_dvec3_load(tangents + 4 * i);
		double point[2] = {one, 0};
		const nt_dvec3 exact = {round(t.x * most), round(t.y * most), round(t.z * most)};
		const bool has = nt_precision_has(tangents + 4 * i, most);
		if (nt_dvec3_normalise(&t))
			find_point(t, has ? &exact : NULL, one, most, point);
		put_integer(to, size, 0, point[0]);
		put_integer(to, size, 1, point[1]);
		put_integer(to, size, 2, one);
		put_integer(to, size, 3, tangents[4 * i + 3] < 0 ? -most : most);
	}
	if (status)
		return status;
	memcpy(values, stored, count * bytes);
	status = nt_meshopt_filter(&view, values, "", error);
	for (size_t i = 0; !status && i < count; i++) {
		const nt_dvec3 before = nt_dvec3_load(tangents + 4 * i);
		for (size_t k = 0; k < 4; k++)
			tangents[4 * i + k] = (float)(get_integer(values + i * bytes, size, k) / most);
		if (cost)
			add_cost(cost, before, tangents + 4 * i);
	}
	return status;
}

/* ---- powers of two ---- */

static void store_exponential(const nt_tangent_filter *f, float *tangents, size_t count, unsigned char *stored,
	unsigned char *values)
{
	const int32_t exponent = 1 - f->bits;
	const double most = ldexp(1, -exponent);
	for (size_t i = 0; i < count; i++) {
		float *tangent = tangents + 4 * i;
		const nt_dvec3 q = nt_nearest_direction(tangent, most);
		const int32_t mantissas[4] = {(int32_t)q.x, (int32_t)q.y, (int32_t)q.z,
			(int32_t)(tangent[3] < 0 ? -most : most)};
		for (size_t k = 0; k < 4; k++) {
			const uint32_t word = (uint32_t)exponent << 24 | ((uint32_t)mantissas[k] & 0xFFFFFF);
			tangent[k] = (float)ldexp(mantissas[k], exponent);
			memcpy(stored + (4 * i + k) * sizeof word, &word, sizeof word);
		}
		memcpy(values + 4 * i * sizeof *tangent, tangent, 4 * sizeof *tangent);
	}
}

/* ---- the whole ---- */

nt_status nt_tangents_store(const nt_tangent_filter *f, float *tangents, size_t count, unsigned char *stored,
	unsigned char *values, nt_rounding *cost, nt_error *error)
{
	if (is(f, "OCTAHEDRAL"))
		return store_octahedral(f, tangents, count, stored, values, cost, error);
	if (is(f, "EXPONENTIAL")) {
		store_exponential(f, tangents, count, stored, values);
		return NT_OK;
	}
	nt_precision_round(f->precision, tangents, count, cost);
	nt_precision_encode(f->precision, tangents, count, stored);
	return NT_OK;
}

/* A step of the octahedron's grid is up to sqrt(3) of one on the sphere, half of it is lost, twice where the point
 * beside it is taken for its length; and half an integer. */
float nt_tangent_filter_least(const nt_tangent_filter *f)
{
	const float none = nt_morph_least(f->precision);
	if (!f->bits || !(is(f, "OCTAHEDRAL") || is(f, "EXPONENTIAL")))
		return none;
	return is(f, "OCTAHEDRAL") ? none + 2 / (float)((1 << (f->bits - 1)) - 1) : ldexpf(1, 1 - f->bits);
}

static int bit_length(uint32_t value)
{
	int bits = 0;
	for (; value; value >>= 1)
		bits++;
	return bits;
}

int nt_filter_bits(const char *filter, const unsigned char *elements, size_t count, size_t stride, int component_type,
	unsigned components)
{
	const size_t size = component_type == NT_GLTF_BYTE ? 1 : component_type == NT_GLTF_SHORT ? 2 : 4;
	const bool octahedral = strcmp(filter, "OCTAHEDRAL") == 0;
	uint32_t most = 0; /* of the third component, which is 1; of all mantissas */
	for (size_t i = 0; i < count; i++)
		for (size_t k = octahedral ? 2 : 0; k < (octahedral ? 3 : components); k++) {
			uint32_t word = 0;
			memcpy(&word, elements + i * stride + k * size, size);
			const uint32_t mantissa = word & 0xFFFFFF;
			word = size < 4 ? word : mantissa >> 23 ? (1 << 24) - mantissa : mantissa;
			most = word > most ? word : most;
		}
	/* a mantissa may be rounded up to the next power of two */
	const int bits = bit_length(octahedral || !most ? most : most - 1) + 1;
	return bits >= 2 && bits <= (size == 1 ? 8 : size == 2 ? 16 : 23) ? bits : 0;
}
