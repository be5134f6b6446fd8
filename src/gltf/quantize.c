/* SPDX-License-Identifier: MIT */
/*
 * Tangents as integers: see quantize.h.
 *
 * Rounding each component to the nearest integer gives the nearest vector, which is not the nearest
 * direction, and with bytes its length can be off by sqrt(3)/2 of a step, 0.0068, where the validator allows
 * 0.00674. So all corners of the integer cell around T are compared. One of them always passes: seen along T
 * they stand at the sums of subsets of T's components, neighbours among which are at most a step apart, so
 * that one is within half a step of the sphere, and the bend of the sphere inside the cell adds 0.012 of one.
 * The validator allows 0.856 of a step of bytes.
 */
#include "gltf/quantize.h"

#include <math.h>
#include <string.h>
#include "base/vec.h"
#include "gltf/document.h"

/* How far the decoded length may be from 1: below the validator's 0.00674, with room for its float
 * arithmetic. */
static const double LENGTH_TOLERANCE = 0.0065;

/* By nt_precision. */
static const struct {
	const char *name;
	uint32_t component_type;
	size_t bytes;
	double most; /* the integer that is decoded to 1 */
} kinds[] = {
	[NT_PRECISION_AUTO] = {"float", NT_GLTF_FLOAT, 16, 1},
	{"float", NT_GLTF_FLOAT, 16, 1},
	{"short", NT_GLTF_SHORT, 8, 32767},
	{"byte", NT_GLTF_BYTE, 4, 127},
};

size_t nt_precision_bytes(nt_precision precision)
{
	return kinds[precision].bytes;
}

uint32_t nt_precision_component_type(nt_precision precision)
{
	return kinds[precision].component_type;
}

bool nt_precision_has(const float *direction, double most)
{
	bool has = true;
	for (size_t k = 0; has && k < 3; k++)
		has = (float)(round(direction[k] * most) / most) == direction[k];
	return has;
}

nt_dvec3 nt_nearest_direction(const float *direction, double most)
{
	nt_dvec3 t = nt_dvec3_load(direction);
	if (nt_precision_has(direction, most))
		return (nt_dvec3){round(t.x * most), round(t.y * most), round(t.z * most)};
	if (!nt_dvec3_normalise(&t))
		return (nt_dvec3){0, 0, 0};
	const double from[3] = {floor(t.x * most), floor(t.y * most), floor(t.z * most)};
	nt_dvec3 best = {0, 0, 0};
	double best_cosine = -2;
	for (int corner = 0; corner < 8; corner++) {
		const nt_dvec3 q = {fmin(from[0] + (corner & 1), most), fmin(from[1] + (corner >> 1 & 1), most),
			fmin(from[2] + (corner >> 2), most)};
		const double length = sqrt(nt_dvec3_dot(q, q));
		if (!(fabs(length / most - 1) <= LENGTH_TOLERANCE))
			continue;
		const double cosine = nt_dvec3_dot(q, t) / length;
		if (cosine > best_cosine) {
			best_cosine = cosine;
			best = q;
		}
	}
	return best;
}

static double angle_between(nt_dvec3 a, nt_dvec3 b)
{
	const nt_dvec3 cross = nt_dvec3_cross(a, b);
	return atan2(sqrt(nt_dvec3_dot(cross, cross)), nt_dvec3_dot(a, b));
}

void nt_precision_round(nt_precision precision, float *tangents, size_t count, nt_rounding *cost)
{
	const double most = kinds[precision].most;
	for (size_t i = 0; i < count; i++) {
		float *tangent = tangents + 4 * i;
		nt_dvec3 t = nt_dvec3_load(tangent);
		const nt_dvec3 q = nt_nearest_direction(tangent, most);
		if (nt_dvec3_normalise(&t)) {
			const double angle = angle_between(t, q);
			if (cost) {
				cost->count++;
				cost->sum_radians += angle;
				cost->worst_radians = fmax(cost->worst_radians, angle);
			}
		}
		tangent[0] = (float)(q.x / most);
		tangent[1] = (float)(q.y / most);
		tangent[2] = (float)(q.z / most);
		tangent[3] = tangent[3] < 0 ? -1.0f : 1.0f;
	}
}

void nt_precision_encode(nt_precision precision, const float *tangents, size_t count, unsigned char *bytes)
{
	const float most = (float)kinds[precision].most;
	for (size_t i = 0; precision == NT_PRECISION_SHORT && i < 4 * count; i++) {
		const int16_t value = (int16_t)lrintf(tangents[i] * most);
		memcpy(bytes + i * sizeof value, &value, sizeof value);
	}
	for (size_t i = 0; precision == NT_PRECISION_BYTE && i < 4 * count; i++) {
		const int8_t value = (int8_t)lrintf(tangents[i] * most);
		memcpy(bytes + i, &value, sizeof value);
	}
}

void nt_precision_report(nt_scene *scene, nt_precision precision, const nt_rounding *cost,
	const nt_place *place)
{
	if (cost->count == 0)
		return;
	scene->rounding.count += cost->count;
	scene->rounding.sum_radians += cost->sum_radians;
	scene->rounding.worst_radians = fmax(scene->rounding.worst_radians, cost->worst_radians);
	const double degrees = 180 / M_PI;
	nt_finding_add(&scene->findings, NT_CODE_TAN_QUANTIZED, place, cost->count,
		"%s, %.2g degrees at most, %.2g on average", kinds[precision].name,
		cost->worst_radians * degrees, cost->sum_radians / (double)cost->count * degrees);
}
