/* SPDX-License-Identifier: MIT */
/*
 * See judge.h. Nothing here calls into the library but nmtan_tangents(); signs and vectors come from the
 * oracle.
 */
#include "judge.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include "bounds.h"
#include "measure.h"
#include "oracle128.h"

const column columns[COLUMN_COUNT] = {
	{"mikktspace raw", NMTAN_METHOD_MIKKTSPACE, NMTAN_REPAIR_OFF},
	{"mikktspace", NMTAN_METHOD_MIKKTSPACE, NMTAN_REPAIR_ON},
	{"area", NMTAN_METHOD_AREA, NMTAN_REPAIR_ON},
	{"lengyel", NMTAN_METHOD_LENGYEL, NMTAN_REPAIR_ON},
	{"robust", NMTAN_METHOD_ROBUST, NMTAN_REPAIR_ON},
};

static const double WELL_CONDITIONED = 16777216.0; /* 2^24 */
static const double ONE_BIT = 1.0 / 8388608.0;     /* 2^-23 */

static oracle_weight weight_of(nmtan_method method)
{
	return method == NMTAN_METHOD_AREA      ? ORACLE_AREA
	       : method == NMTAN_METHOD_LENGYEL ? ORACLE_NONE
						: ORACLE_ANGLE;
}

/* Runs a method with a warm workspace, one thread, until 4 ms or 3 runs have passed; the best run counts. */
static bool run(const nmtan_mesh *mesh, const column *c, nmtan_workspace *workspace, float *tangents,
	uint8_t *faults, score *s)
{
	const nmtan_options options = {.struct_bytes = sizeof options, .method = c->method,
		.repair = c->repair, .threads = 1,
		.workspace = workspace};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents};
	const nmtan_output named = {.struct_bytes = sizeof named, .tangents = tangents, .corner_faults = faults};
	double total = 0, best = INFINITY;
	for (int i = 0; i < 50 && (i < 3 || total < 0.004) && (i < 1 || total < 2); i++) {
		const double start = measure_thread_seconds();
		if (nmtan_tangents(mesh, &options, &output, NULL))
			return false;
		const double took = measure_thread_seconds() - start;
		total += took;
		best = fmin(best, took);
	}
	s->ns_per_triangle = 1e9 * best / (double)oracle_triangle_count(mesh);
	return nmtan_tangents(mesh, &options, &named, NULL) == NMTAN_OK;
}

static const float *normal_of(const nmtan_mesh *mesh, size_t corner)
{
	return mesh->normals + 3 * (mesh->indices ? mesh->indices[corner] : corner);
}

static bool is_unit(const float *t)
{
	const double squared = (double)t[0] * t[0] + (double)t[1] * t[1] + (double)t[2] * t[2];
	return isfinite(squared) && fabs(squared - 1) <= 33 * 1.1920929e-7;
}

/* Cosine of the angle between a unit T and N; 0 where N has no direction. */
static double along_normal(const float *t, const float *n)
{
	const double length = sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]);
	if (!(length > 0) || !isfinite(length))
		return 0;
	return ((double)t[0] * n[0] + (double)t[1] * n[1] + (double)t[2] * n[2]) / length;
}

static bool has_unit_normal(const nmtan_mesh *mesh, size_t corner)
{
	const float *n = normal_of(mesh, corner);
	return fabs((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2] - 1) < 1.0 / 2048 - 1e-6;
}

static bool is_off(const float *t, const oracle_corner *exact)
{
	bool off = false;
	for (int i = 0; i < 3; i++)
		off = off || !(fabs(t[i] - exact->t[i]) <= ONE_BIT);
	return off;
}

static void score_signs(const nmtan_mesh *mesh, const oracle_corner *exact, const float *tangents, score *s)
{
	for (size_t f = 0, first = 0; f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		bool mixed = false, wrong = false;
		for (size_t c = first; c < first + size; c++) {
			mixed = mixed || tangents[4 * c + 3] != tangents[4 * first + 3];
			wrong = wrong || tangents[4 * c + 3] != (float)exact[first].sign;
		}
		s->faces++;
		s->oriented += exact[first].sign != 0;
		s->mixed_sign += mixed;
		s->wrong_sign += wrong && exact[first].sign != 0;
		first += size;
	}
}

static void score_vectors(const nmtan_mesh *mesh, const oracle_corner *exact, bool oracle,
	const float *tangents, const uint8_t *faults, score *s)
{
	for (size_t c = 0; c < s->corners; c++) {
		const float *t = tangents + 4 * c;
		const double cosine = along_normal(t, normal_of(mesh, c));
		s->zero += !is_unit(t);
		s->parallel += is_unit(t) && fabs(cosine) > 1 - 5e-7;
		s->tilted += !(fabs(cosine) <= 4 * ONE_BIT);
		s->leaning += has_unit_normal(mesh, c) && !(fabs(cosine) <= 1.0 / 1024 * (1 + 1.0 / 2048));
		if (exact[c].sign == 0 || !oracle)
			continue;
		if (!(exact[c].condition < WELL_CONDITIONED)) {
			/* the library has conditions to some digits */
			s->unnamed += !(exact[c].condition < 1.01 * WELL_CONDITIONED) &&
				      !(faults[c] & NMTAN_FAULT_ILL_CONDITIONED);
			s->beyond++;
			continue;
		}
		s->off += is_off(t, &exact[c]);
		s->worst_degrees = fmax(s->worst_degrees, measure_degrees(t, exact[c].t));
	}
}

/* MikkTSpace's bytes stay where they are usable: a finite unit vector across N, not the placeholder, in a face whose
 * signs agree and are the exact one. */
static size_t count_altered(const nmtan_mesh *mesh, const oracle_corner *exact, const float *raw,
	const float *repaired)
{
	size_t altered = 0;
	for (size_t f = 0, first = 0; f < mesh->face_count; f++) {
		const size_t size = mesh->face_sizes ? mesh->face_sizes[f] : 3;
		bool agree = true;
		for (size_t c = first; c < first + size; c++)
			agree = agree && raw[4 * c + 3] == (float)exact[first].sign;
		for (size_t c = first; agree && c < first + size; c++)
			altered += is_unit(raw + 4 * c) &&
				   fabs(along_normal(raw + 4 * c, normal_of(mesh, c))) < 1.0 / 1024 - 1e-9 &&
				   !(raw[4 * c] == 1 && raw[4 * c + 3] == -1) &&
				   memcmp(raw + 4 * c, repaired + 4 * c, 16) != 0;
		first += size;
	}
	return altered;
}

/* The default has two kinds of corners: what repair replaced is the exact formula's value, what it kept is within its
 * bound. */
static void score_default(const oracle_corner *exact, const bound *bounds, const float *raw,
	const float *repaired, score *s)
{
	for (size_t c = 0; c < s->corners; c++) {
		const float *t = repaired + 4 * c;
		if (memcmp(raw + 4 * c, t, 16) != 0) {
			s->replaced++;
			s->inexact += exact[c].sign != 0 && exact[c].condition < WELL_CONDITIONED &&
				is_off(t, &exact[c]);
		} else if (bounds[c].degrees == INFINITY) {
			s->unbounded++;
			if (exact[c].condition < WELL_CONDITIONED)
				s->unbounded_degrees = fmax(s->unbounded_degrees, measure_degrees(t, exact[c].t));
		} else {
			const double degrees = measure_degrees(t, bounds[c].t);
			s->kept++;
			s->beyond_bound += !(degrees <= bounds[c].degrees);
			s->kept_degrees = fmax(s->kept_degrees, degrees);
			s->kept_share = fmax(s->kept_share, degrees / bounds[c].degrees);
			if (bounds[c].condition > 0)
				s->kept_units = fmax(s->kept_units,
					degrees / 57.29577951308232 * WELL_CONDITIONED / bounds[c].condition);
		}
	}
}

bool judge_mesh(const nt_owned *owned, bool oracle, score scores[COLUMN_COUNT])
{
	const nmtan_mesh *mesh = &owned->mesh;
	const size_t corner_count = owned->corner_count;
	float *tangents[2] = {malloc(16 * corner_count), malloc(16 * corner_count)}; /* raw, others */
	oracle_corner *exact = malloc(corner_count * sizeof *exact);
	oracle_triangle *triangles = malloc(oracle_triangle_count(mesh) * sizeof *triangles);
	bound *bounds = malloc(corner_count * sizeof *bounds);
	uint8_t *faults = malloc(corner_count);
	nmtan_workspace *workspace = nmtan_workspace_create(NULL);
	bool done = tangents[0] && tangents[1] && exact && triangles && bounds && faults && workspace;
	oracle_weight filled = ORACLE_ANGLE;
	if (done && oracle)
		done = oracle_solve_triangles(mesh, exact, triangles) &&
		       find_bounds(mesh, exact, triangles, corner_count, bounds);
	if (done && !oracle)
		for (size_t c = 0; c < corner_count; c++) /* size sweeps: all faces are wound alike */
			exact[c] = (oracle_corner){.sign = 1};
	for (int i = 0; done && i < COLUMN_COUNT; i++) {
		/* the columns of one weight are visited together: raw, mikktspace, robust, area, lengyel */
		static const int order[COLUMN_COUNT] = {COLUMN_RAW, COLUMN_REPAIRED, COLUMN_ROBUST, COLUMN_AREA,
			COLUMN_LENGYEL};
		const int at = order[i];
		score *s = &scores[at];
		float *to = tangents[at != COLUMN_RAW];
		*s = (score){.corners = corner_count};
		if (oracle && weight_of(columns[at].method) != filled) {
			filled = weight_of(columns[at].method);
			done = oracle_solve(mesh, filled, exact);
		}
		done = done && run(mesh, &columns[at], workspace, to, faults, s);
		if (!done)
			break;
		score_signs(mesh, exact, to, s);
		score_vectors(mesh, exact, oracle, to, faults, s);
		if (at == COLUMN_REPAIRED)
			s->altered = count_altered(mesh, exact, tangents[0], to);
		if (at == COLUMN_REPAIRED && oracle)
			score_default(exact, bounds, tangents[0], to, s);
	}
	nmtan_workspace_destroy(workspace);
	free(tangents[0]);
	free(tangents[1]);
	free(exact);
	free(triangles);
	free(bounds);
	free(faults);
	return done;
}
