/* SPDX-License-Identifier: MIT */
/*
 * See twins.h. Which comparisons are exact follows from IEEE arithmetic:
 *
 *   mirrored in space, mirrored in UV   a sign changes in each product and sum, or in none
 *   scaled                              by powers of two, as long as no square or product leaves the normal floats
 *   quarter turn about z                x and y change places in dot products, x x + y y + z z, and a + b = b + a
 *   third of a turn about (1,1,1)       not exact: (a + b) + c is not (b + c) + a. The twin's answer must be within the
 *                                       bound of the formula (bounds.h), and w equal
 *
 * Compared are corners whose answer is a sum of frames: MikkTSpace's own, or an average that repair took where the
 * condition is moderate. If a face has no orientation and nothing around it has one, the answer is a perpendicular
 * of the normal that need not turn with the mesh, and w is +1 on both; stress asks that it is unit and across the
 * normal.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "judge.h"
#include "measure.h"
#include "twins.h"

const twin twins[TWIN_COUNT] = {
	{"mirrored in space", {0, 1, 2}, {-1, 1, 1}, 1, 1, 1, 1, 1, true},
	{"mirrored in UV", {0, 1, 2}, {1, 1, 1}, -1, 1, 1, -1, -1, true},
	{"quarter turn", {1, 0, 2}, {-1, 1, 1}, 1, 1, 1, 1, 1, true},
	{"scaled", {0, 1, 2}, {1, 1, 1}, 1, 64, 0.0625f, 1, 1, true},
	{"third of a turn", {1, 2, 0}, {1, 1, 1}, 1, 1, 1, 1, 1, false},
};

/* Condition up to which a repaired corner's average is compared. */
static const double MODERATE = 1e6;

static void turn(const twin *kind, float scale, const float from[3], float to[3])
{
	for (int i = 0; i < 3; i++)
		to[i] = kind->sign[i] * scale * from[kind->axis[i]];
}

/* The twin's arrays in place of the mesh's own; indices and face sizes are shared. */
static nt_owned make_twin(const nt_owned *mesh, const twin *kind)
{
	nt_owned t = *mesh;
	t.positions = measure_room(mesh->mesh.vertex_count, sizeof *t.positions);
	t.normals = measure_room(mesh->mesh.vertex_count, sizeof *t.normals);
	t.texcoords = measure_room(mesh->mesh.vertex_count, sizeof *t.texcoords);
	for (size_t v = 0; v < mesh->mesh.vertex_count; v++) {
		turn(kind, kind->scale, mesh->positions[v], t.positions[v]);
		turn(kind, 1, mesh->normals[v], t.normals[v]);
		t.texcoords[v][0] = kind->u_sign * kind->uv_scale * mesh->texcoords[v][0];
		t.texcoords[v][1] = kind->uv_scale * mesh->texcoords[v][1];
	}
	t.mesh.positions = &t.positions[0][0];
	t.mesh.normals = &t.normals[0][0];
	t.mesh.texcoords = &t.texcoords[0][0];
	return t;
}

/* Denormal numbers have no twin that is smaller. */
static bool is_exact(const nt_owned *mesh, const nt_owned *other, const twin *kind)
{
	bool exact = true;
	for (size_t v = 0; v < mesh->mesh.vertex_count; v++)
		for (int i = 0; i < 3; i++) {
			const float *p = mesh->positions[v], *q = other->positions[v];
			const float from = p[kind->axis[i]], uv = i < 2 ? mesh->texcoords[v][i] : 0;
			const float scaled = i < 2 ? other->texcoords[v][i] : 0;
			exact &= !isfinite(from) || q[i] / kind->scale == kind->sign[i] * from;
			exact &= !isfinite(uv) || scaled / kind->uv_scale == (i ? uv : kind->u_sign * uv);
		}
	return exact;
}

static void free_twin(nt_owned *t)
{
	free(t->positions);
	free(t->normals);
	free(t->texcoords);
}

static bool solve(const nt_owned *mesh, nmtan_method method, nmtan_repair repair, float *tangents)
{
	const nmtan_options options = {.struct_bytes = sizeof options, .method = method, .repair = repair,
		.threads = 1};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents};
	return nmtan_tangents(&mesh->mesh, &options, &output, NULL) == NMTAN_OK;
}

/* The answers of a mesh and its twin, raw and repaired. */
typedef struct answers {
	float (*raw)[4], (*t)[4], (*twin_raw)[4], (*twin_t)[4];
} answers;

/* Whether a corner's answer is a sum of frames. */
static bool is_framed(const float *raw, const float *t, const oracle_corner *exact)
{
	return memcmp(raw, t, 16) == 0 || (exact->sign != 0 && exact->condition < MODERATE);
}

/* Robust and what is repaired are exact but for the last bit; MikkTSpace's own answer is within its bound. */
static bool is_near(const twin *kind, const float *t, bool own, const oracle_corner *exact, const bound *b)
{
	const double *from = own ? b->t : exact->t;
	double expected[3];
	for (int i = 0; i < 3; i++)
		expected[i] = kind->t_sign * kind->sign[i] * from[kind->axis[i]];
	const double last_bit = exact->sign != 0 && exact->condition < MODERATE ? 1e-4 : INFINITY;
	return !(measure_degrees(t, expected) > (own ? 2 * b->degrees : last_bit));
}

static bool differs(const twin *kind, nmtan_method method, const answers *a, size_t c, const oracle_corner *exact,
	const bound *b)
{
	const float *t = a->twin_t[c];
	float expected[3];
	turn(kind, kind->t_sign, a->t[c], expected);
	if (t[3] != kind->w_sign * a->t[c][3] && !(exact->sign == 0 && t[3] == 1 && a->t[c][3] == 1))
		return true;
	if (!is_framed(a->raw[c], a->t[c], exact) || !is_framed(a->twin_raw[c], t, exact))
		return false;
	if (!kind->exact || (kind->scale != 1 && !b->scalable))
		return !is_near(kind, t,
			method == NMTAN_METHOD_MIKKTSPACE && memcmp(a->twin_raw[c], t, 16) == 0, exact, b);
	return !(t[0] == expected[0] && t[1] == expected[1] && t[2] == expected[2]);
}

size_t twin_differences(const nt_owned *mesh, const twin *kind, nmtan_method method, const oracle_corner *exact,
	const bound *bounds)
{
	nt_owned other = make_twin(mesh, kind);
	const size_t count = is_exact(mesh, &other, kind) ? mesh->corner_count : 0;
	answers a = {measure_room(mesh->corner_count, 16), measure_room(mesh->corner_count, 16),
		measure_room(mesh->corner_count, 16), measure_room(mesh->corner_count, 16)};
	bool done = solve(mesh, method, NMTAN_REPAIR_OFF, a.raw[0]) && solve(mesh, method, NMTAN_REPAIR_ON, a.t[0]) &&
		solve(&other, method, NMTAN_REPAIR_OFF, a.twin_raw[0]) &&
		solve(&other, method, NMTAN_REPAIR_ON, a.twin_t[0]);
	size_t differences = 0;
	for (size_t c = 0; done && c < count; c++)
		differences += differs(kind, method, &a, c, &exact[c], &bounds[c]);
	free(a.raw);
	free(a.t);
	free(a.twin_raw);
	free(a.twin_t);
	free_twin(&other);
	return done ? differences : SIZE_MAX;
}
