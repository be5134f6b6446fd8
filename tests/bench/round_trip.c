/* SPDX-License-Identifier: MIT */
/* See round_trip.h. */
#include "round_trip.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "../stress/bounds.h"
#include "oracle128.h"

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
		to->raw_zero[k] = raw[c][0] == 0 && raw[c][1] == 0 && raw[c][2] == 0;
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
	if (to->pooled)
		*own_groups += own_count;
	return true;
}

round_trip round_trip_make(const model *m)
{
	const size_t corners = m->mesh.corner_count, faces = m->mesh.mesh.face_count;
	const size_t step = faces / POOLED + 1;
	round_trip r = {.triangles = measure_room(faces, sizeof *r.triangles)};
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
	for (size_t t = 0; t < faces; t++) {
		sampled *to = &r.triangles[r.count];
		to->pooled = t % step == 0;
		if (sample(m, t, exact, bounds, raw, repaired, to, &r.own_groups)) {
			r.pooled += to->pooled;
			r.count++;
		}
	}
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

/* The corner whose tangent is furthest from the baker's, or has another sign. */
static size_t worst_corner(const image_triangle *baker, const shading *shader, size_t triangle)
{
	size_t worst = 0;
	double most = -1;
	for (size_t k = 0; k < 3; k++) {
		const float *t = shader->tangents[3 * triangle + k];
		const double degrees = measure_degrees(t, baker->t[k]) + 180 * fabs(t[3] - baker->w[k]);
		if (degrees > most) {
			most = degrees;
			worst = k;
		}
	}
	return worst;
}

worst_point round_trip_judge(const round_trip *r, const shading *shader, measure_pool pools[IMAGE_CONVENTIONS])
{
	worst_point worst = {0};
	for (size_t i = 0; i < r->count; i++) {
		const sampled *at = &r->triangles[i];
		if (!shader->there[at->triangle])
			continue;
		const image_triangle triangle = shader_triangle(shader, at->triangle);
		for (int point = 0; point < POINTS; point++) {
			double weights[3];
			weights_of(point, weights);
			for (int c = 0; c < (at->pooled ? IMAGE_CONVENTIONS : 1); c++) {
				const double error = image_error(&at->baker, &triangle, weights, at->m[point],
					&image_conventions[c]);
				if (!isnan(error) && at->pooled)
					measure_pool_add(&pools[c], error);
				if (c == 0 && error > worst.degrees)
					worst = (worst_point){.degrees = error, .triangle = at->triangle, .corner = i};
			}
		}
	}
	if (worst.degrees > 0) {
		const sampled *at = &r->triangles[worst.corner];
		const size_t k = worst_corner(&at->baker, shader, at->triangle);
		worst.corner = 3 * at->triangle + k;
		worst.raw_zero = at->raw_zero[k];
	}
	return worst;
}

static double uv_area(const nt_owned *mesh, size_t triangle)
{
	const float *a = mesh->texcoords[mesh->indices[3 * triangle]],
		    *b = mesh->texcoords[mesh->indices[3 * triangle + 1]],
		    *c = mesh->texcoords[mesh->indices[3 * triangle + 2]];
	return fabs(((double)b[0] - a[0]) * ((double)c[1] - a[1]) - ((double)b[1] - a[1]) * ((double)c[0] - a[0]));
}

sign_errors round_trip_signs(const nt_owned *mesh, double size, const shading *raw, const shading *baker,
	const shading *shader)
{
	sign_errors errors = {0};
	const model m = {.mesh = *mesh, .size = size};
	double all = 0;
	for (size_t t = 0; t < mesh->mesh.face_count; t++) {
		const uint32_t *v = mesh->indices + 3 * t;
		const int sign = oracle_sign(mesh->texcoords[v[0]], mesh->texcoords[v[1]], mesh->texcoords[v[2]]);
		bool differs = sign != 0;
		for (size_t c = 3 * t; c < 3 * t + 3; c++)
			differs = differs && raw->tangents[c][3] == (float)-sign;
		all += uv_area(mesh, t);
		if (!differs)
			continue;
		errors.triangles++;
		errors.uv_share += uv_area(mesh, t);
		const image_triangle baked = shader_triangle(baker, t), shown = shader_triangle(shader, t);
		for (int point = 0; point < POINTS; point++) {
			double weights[3], p[3], n[3], field[3];
			weights_of(point, weights);
			if (!surface_point(&m, t, weights, p, n))
				continue;
			image_field(p, n, field);
			const double error = image_error(&baked, &shown, weights, field, &image_conventions[0]);
			if (!isnan(error))
				measure_pool_add(&errors.pool, error);
		}
	}
	errors.uv_share /= all;
	measure_pool_finish(&errors.pool);
	return errors;
}
