/* SPDX-License-Identifier: MIT */
/* See round_trip.h. */
#include "round_trip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "../stress/bounds.h"

/* Barycentric weights of a point, all inside. */
static void weights_of(int point, double weights[3])
{
	int i = 0;
	while (point >= STEPS - i)
		point -= STEPS - i++;
	weights[0] = (i + 1.0 / 3) / STEPS;
	weights[1] = (point + 1.0 / 3) / STEPS;
	weights[2] = 1 - weights[0] - weights[1];
}

/* The baker's tangent; false: there is none. */
static bool baker_tangent(const oracle_corner *exact, const bound *b, const float raw[4], const float repaired[4],
	double t[3], bool *own)
{
	if (exact->sign == 0)
		return false;
	const bool usable = memcmp(raw, repaired, 16) == 0;
	*own = usable && !(b->condition > 0 && measure_degrees(raw, exact->t) <= b->degrees);
	for (int i = 0; i < 3; i++)
		t[i] = *own ? raw[i] : exact->t[i];
	return *own || isfinite(exact->condition);
}

/* Position and unit normal of a point of a triangle; false: no normal. */
static bool surface_point(const model *m, size_t triangle, const double weights[3], double p[3], double n[3])
{
	double length = 0;
	for (int i = 0; i < 3; i++) {
		p[i] = n[i] = 0;
		for (size_t k = 0; k < 3; k++) {
			const uint32_t v = m->mesh.indices[3 * triangle + k];
			p[i] += weights[k] * m->mesh.positions[v][i] / m->size;
			n[i] += weights[k] * m->mesh.normals[v][i];
		}
		length += n[i] * n[i];
	}
	for (int i = 0; i < 3; i++)
		n[i] /= sqrt(length);
	return length > 1e-6;
}

static bool sample(const model *m, size_t triangle, const oracle_corner *exact, const bound *bounds,
	const float (*raw)[4], const float (*repaired)[4], sampled *to, size_t *own_groups)
{
	to->triangle = triangle;
	size_t own_count = 0;
	for (size_t k = 0; k < 3; k++) {
		const size_t c = 3 * triangle + k;
		bool own;
		if (!baker_tangent(&exact[c], &bounds[c], raw[c], repaired[c], to->baker.t[k], &own))
			return false;
		own_count += own;
		to->baker.w[k] = exact[c].sign;
		for (int i = 0; i < 3; i++)
			to->baker.n[k][i] = m->mesh.normals[m->mesh.indices[c]][i];
	}
	for (int point = 0; point < POINTS; point++) {
		double weights[3], p[3], n[3];
		weights_of(point, weights);
		if (!surface_point(m, triangle, weights, p, n))
			return false;
		image_field(p, n, to->m[point]);
	}
	*own_groups += own_count;
	return true;
}

round_trip round_trip_make(const model *m)
{
	const size_t corners = m->mesh.corner_count, faces = m->mesh.mesh.face_count;
	const size_t step = faces / SAMPLED + 1;
	round_trip r = {.triangles = measure_room(faces / step + 1, sizeof *r.triangles)};
	oracle_corner *exact = measure_room(corners, sizeof *exact);
	oracle_triangle *triangles = measure_room(faces, sizeof *triangles);
	bound *bounds = measure_room(corners, sizeof *bounds);
	float (*raw)[4] = measure_room(corners, sizeof *raw), (*repaired)[4] = measure_room(corners, sizeof *repaired);
	const nmtan_options off = {.struct_bytes = sizeof off, .repair = NMTAN_REPAIR_OFF};
	const nmtan_output to_raw = {.struct_bytes = sizeof to_raw, .tangents = &raw[0][0]};
	const nmtan_output to_repaired = {.struct_bytes = sizeof to_repaired, .tangents = &repaired[0][0]};
	if (!oracle_solve_triangles(&m->mesh.mesh, exact, triangles) ||
		!find_bounds(&m->mesh.mesh, exact, triangles, corners, bounds) ||
		nmtan_tangents(&m->mesh.mesh, &off, &to_raw, NULL) ||
		nmtan_tangents(&m->mesh.mesh, NULL, &to_repaired, NULL))
		exit(4);
	for (size_t t = 0; t < faces; t += step)
		r.count += sample(m, t, exact, bounds, raw, repaired, &r.triangles[r.count], &r.own_groups);
	free(exact);
	free(triangles);
	free(bounds);
	free(raw);
	free(repaired);
	return r;
}

void round_trip_free(round_trip *r)
{
	free(r->triangles);
	*r = (round_trip){0};
}

static image_triangle shader_triangle(const shading *s, size_t triangle)
{
	image_triangle to;
	for (size_t k = 0; k < 3; k++) {
		const size_t c = 3 * triangle + k;
		for (int i = 0; i < 3; i++) {
			to.t[k][i] = s->tangents[c][i];
			to.n[k][i] = s->normals[c][i];
		}
		to.w[k] = s->tangents[c][3];
	}
	return to;
}

void round_trip_judge(const round_trip *r, const shading *shader, measure_pool pools[IMAGE_CONVENTIONS])
{
	for (size_t i = 0; i < r->count; i++) {
		const sampled *at = &r->triangles[i];
		if (!shader->there[at->triangle])
			continue;
		const image_triangle triangle = shader_triangle(shader, at->triangle);
		for (int point = 0; point < POINTS; point++) {
			double weights[3];
			weights_of(point, weights);
			for (int c = 0; c < IMAGE_CONVENTIONS; c++) {
				const double error = image_error(&at->baker, &triangle, weights, at->m[point],
					&image_conventions[c]);
				if (!isnan(error))
					measure_pool_add(&pools[c], error);
			}
		}
	}
}
