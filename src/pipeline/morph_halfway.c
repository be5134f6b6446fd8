/* SPDX-License-Identifier: MIT */
/*
 * How far a morph target's tangents are off at weight 0.5. A client adds the delta of TANGENT times the weight,
 * which is exact at the ends. Between them dP/du of a triangle moves along a straight line from its old to its new
 * value; the sum of two unit vectors follows the angle, so that the two part where a target stretches what it turns,
 * and the sum has no direction where a target turns by 180 degrees. The right answer is a solve of the mesh as the
 * target moves it at weight 0.5.
 *
 * On one triangle what is right lies between the tangents of the two ends and the client's halfway, so the error is
 * at most half of what the target turns. Averaging over triangles can exceed that a little. Targets that turn no
 * tangent by more than the limit itself are therefore not solved again, which saves most of them the time.
 */
#include "pipeline/morphs.h"

#include <stdlib.h>
#include <string.h>
#include "api/tangents.h"
#include "base/angle.h"
#include "base/dvec.h"

static const double DEGREES = 57.29577951308232;

/* The cosine of 5 degrees, from which on there is a finding. */
static const double LIMIT_COSINE = 0.99619469809174553;

/* Half a sum of two unit vectors that is shorter has lost its direction. */
static const double CANCELLED = 1.0 / 1024;

/* Twice the area of a triangle over the square of its longest edge at either end: what is below has collapsed on
 * its way (positions are rounded), and no direction is right there. */
static const double COLLAPSED = 1e-4;

/* The cosine of the angle between two vectors that are not zero. */
static double cosine_between(nt_dvec3 a, nt_dvec3 b)
{
	return nt_dvec3_dot(a, b) / sqrt(nt_dvec3_dot(a, a) * nt_dvec3_dot(b, b));
}

static double degrees_of(double cosine)
{
	return nt_angle(sqrt(fmax(0, 1 - cosine * cosine)), cosine) * DEGREES;
}

/* As they were solved. */
static const float *base_tangents(const nt_mesh *mesh)
{
	return mesh->solved_tangents ? mesh->solved_tangents : mesh->corner_tangents;
}

bool nt_morphs_turn(const nt_mesh *mesh, const nt_morph *morph)
{
	const float *base = base_tangents(mesh);
	for (size_t c = 0; c < mesh->corner_count; c++)
		if (cosine_between(nt_dvec3_load(base + 4 * c),
			nt_dvec3_load(morph->corner_tangents + 4 * c)) < LIMIT_COSINE)
			return true;
	return false;
}

static float *middle_of(const float *a, const float *b, size_t count)
{
	float *middle = nt_alloc(count, 3 * sizeof *middle);
	for (size_t i = 0; middle && i < 3 * count; i++)
		middle[i] = (float)(((double)a[i] + b[i]) * 0.5);
	return middle;
}

static void normalise_rows(float *rows, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		nt_dvec3 n = nt_dvec3_load(rows + 3 * i);
		nt_dvec3_normalise(&n);
		nt_dvec3_store(n, rows + 3 * i);
	}
}

nt_status nt_morphs_solve_halfway(const nmtan_mesh *base, const nmtan_mesh *moved, const uint8_t *halves,
	const nmtan_options *options, float **tangents)
{
	nmtan_mesh view = *base;
	const float *positions = moved->positions != base->positions ? moved->positions : NULL;
	const float *normals = moved->normals != base->normals ? moved->normals : NULL;
	const size_t corner_count = 3 * base->face_count;
	float *p = positions ? middle_of(base->positions, positions, base->vertex_count) : NULL;
	float *n = normals ? middle_of(base->normals, normals, base->vertex_count) : NULL;
	*tangents = nt_alloc(corner_count, 4 * sizeof **tangents);
	nt_status status = NT_ERROR_MEMORY;
	if (*tangents && (p || !positions) && (n || !normals)) {
		if (p)
			view.positions = p;
		if (n) {
			normalise_rows(n, base->vertex_count);
			view.normals = n;
		}
		nmtan_options untimed = *options;
		untimed.timing = NULL;
		const nmtan_output output = {.struct_bytes = sizeof output, .tangents = *tangents};
		status = nt_status_of(nt_tangents_of_halves(&view, halves, &untimed, &output, NULL));
	}
	free(p);
	free(n);
	return status;
}

static size_t vertex_of(const nmtan_mesh *view, size_t corner)
{
	return view->indices ? view->indices[corner] : corner;
}

/* Twice the area of a triangle between two places, and the square of its longest edge there. */
static double measure(const nmtan_mesh *view, const float *from, const float *to, size_t triangle, double *longest)
{
	nt_dvec3 p[3];
	for (size_t k = 0; k < 3; k++) {
		const size_t v = vertex_of(view, 3 * triangle + k);
		p[k] = nt_dvec3_scale(0.5, nt_dvec3_add(nt_dvec3_load(from + 3 * v), nt_dvec3_load(to + 3 * v)));
	}
	*longest = 0;
	for (size_t k = 0; k < 3; k++) {
		const nt_dvec3 edge = nt_dvec3_sub(p[(k + 1) % 3], p[k]);
		*longest = fmax(*longest, nt_dvec3_dot(edge, edge));
	}
	return nt_dvec3_length(nt_dvec3_cross(nt_dvec3_sub(p[1], p[0]), nt_dvec3_sub(p[2], p[0])));
}

/* Whether the triangle itself has a direction at weight 0.5. */
static bool has_direction(const nmtan_mesh *base, const nmtan_mesh *moved, size_t triangle)
{
	const float *uv[3], *from = base->positions, *to = moved->positions;
	for (size_t k = 0; k < 3; k++)
		uv[k] = base->texcoords + 2 * vertex_of(base, 3 * triangle + k);
	double before, after, now;
	measure(base, from, from, triangle, &before);
	measure(base, to, to, triangle, &after);
	const double area = measure(base, from, to, triangle, &now);
	return area > COLLAPSED * fmax(before, after) && nmtan_orientation(uv[0], uv[1], uv[2]) != 0;
}

/* How far the tangent that a client has at a corner is off, as a cosine. */
static double cosine_at(const nt_mesh *mesh, const nt_morph *morph, const float *halfway, size_t corner,
	bool *cancelled)
{
	const nt_dvec3 client = nt_dvec3_scale(0.5, nt_dvec3_add(nt_dvec3_load(base_tangents(mesh) + 4 * corner),
		nt_dvec3_load(morph->corner_tangents + 4 * corner)));
	*cancelled = nt_dvec3_dot(client, client) < CANCELLED * CANCELLED;
	return *cancelled ? 0 : cosine_between(client, nt_dvec3_load(halfway + 4 * corner));
}

void nt_morphs_compare_halfway(const nt_mesh *mesh, const nmtan_mesh *base, const nmtan_mesh *moved,
	const float *halfway, nt_morph *morph)
{
	double least = 1;
	morph->halfway_triangles = 0;
	for (size_t t = 0; t < mesh->face_count; t++) {
		double worst = 1;
		bool any_cancelled = false;
		for (size_t k = 0; k < 3; k++) {
			bool cancelled;
			worst = fmin(worst, cosine_at(mesh, morph, halfway, 3 * t + k, &cancelled));
			any_cancelled |= cancelled;
		}
		if (worst < LIMIT_COSINE && (any_cancelled || has_direction(base, moved, t))) {
			morph->halfway_triangles++;
			least = fmin(least, worst);
		}
	}
	morph->halfway_degrees = degrees_of(least);
}
