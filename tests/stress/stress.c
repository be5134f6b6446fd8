/* SPDX-License-Identifier: MIT */
/*
 * make stress: every family at every level, every method, against the oracle.
 *
 *   stress [FAMILY]
 *
 * Prints two tables. Ends with 1 when something that must hold does not:
 *
 *   the default and robust: no zero, non-unit or non-finite tangent; one w on every face; the exact sign on every face
 *     that has one; perpendicular to normals of unit length within 2^-10. (tests/unit/tangent/test_properties.c asks
 *     of the same families that a mirrored or turned mesh has the mirrored or turned answer.)
 *   the default: MikkTSpace's bytes wherever they are usable, and these within the bound that is proved for each corner
 * (bounds.h). Corners without a bound: none where the family says so, and no more than it allows elsewhere. A
 * repaired corner has the exact frame within 2^-23 where its condition is below 2^24
 *   robust: every component within 2^-23 of the oracle where the condition is below 2^24; T perpendicular to N within
 *     2^-21; corner_faults names all corners beyond that condition
 *   sweeps of size: time per triangle within a factor of 8 from 10^4 triangles on
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "bounds.h"
#include "extremes.h"
#include "judge.h"

enum { MOST_LEVELS = 16, ORACLE_TRIANGLES = 120000 };

typedef struct family_scores {
	score at[MOST_LEVELS][COLUMN_COUNT];
} family_scores;

static size_t broken; /* how often something that must hold did not */

static void must_hold(const family *f, double level, const char *method, const char *what, size_t count)
{
	if (count == 0)
		return;
	broken++;
	printf("stress: DOES NOT HOLD: %s at %s %g, %s: %zu %s\n", f->name, f->level_name, level, method, count,
		what);
}

static void check_level(const family *f, size_t l, const score scores[COLUMN_COUNT])
{
	const double level = f->levels[l];
	static const int held[2] = {COLUMN_REPAIRED, COLUMN_ROBUST};
	for (int i = 0; i < 2; i++) {
		const score *s = &scores[held[i]];
		const char *name = columns[held[i]].name;
		must_hold(f, level, name, "zero, non-unit or non-finite tangents", s->zero);
		must_hold(f, level, name, "faces with two values of w", s->mixed_sign);
		must_hold(f, level, name, "faces with a wrong sign", s->wrong_sign);
		must_hold(f, level, name, "corners more than 2^-10 off perpendicular", s->leaning);
	}
	const score *repaired = &scores[COLUMN_REPAIRED];
	must_hold(f, level, "mikktspace", "repaired corners further than 2^-23 from the oracle", repaired->inexact);
	must_hold(f, level, "mikktspace", "kept corners outside of their bound", repaired->beyond_bound);
	const double allowed = l < f->bounded ? 0 : f->most_unbounded;
	must_hold(f, level, "mikktspace", "kept corners without a bound",
		100.0 * (double)repaired->unbounded > allowed * (double)repaired->corners ? repaired->unbounded : 0);
	must_hold(f, level, "mikktspace", "usable corners whose bytes changed", scores[COLUMN_REPAIRED].altered);
	must_hold(f, level, "robust", "corners further than 2^-23 from the oracle", scores[COLUMN_ROBUST].off);
	must_hold(f, level, "robust", "ill-conditioned corners that are not named", scores[COLUMN_ROBUST].unnamed);
	must_hold(f, level, "robust", "corners not perpendicular to their normal", scores[COLUMN_ROBUST].tilted);
}

/* From the first level of at least 10^4 triangles. */
static void check_linear(const family *f, const family_scores *scores)
{
	static const int held[2] = {COLUMN_REPAIRED, COLUMN_ROBUST};
	for (int i = 0; i < 2 && f->linear; i++) {
		double first = 0;
		for (size_t l = 0; l < f->level_count; l++) {
			const double ns = scores->at[l][held[i]].ns_per_triangle;
			if (first == 0 && f->levels[l] >= 1e4)
				first = ns;
			must_hold(f, f->levels[l], columns[held[i]].name, "times the time per triangle of 10^4",
				first > 0 && ns > 8 * first ? (size_t)(ns / first) : 0);
		}
	}
}

static double percent(size_t part, size_t whole)
{
	return whole ? 100.0 * (double)part / (double)whole : 0;
}

/* One line for each family: the worst of all its levels. */
static void write_summary(const family *f, const family_scores *scores)
{
	printf("| %s |", f->name);
	for (int c = 0; c < COLUMN_COUNT; c++) {
		double wrong = 0, unusable = 0, worst = 0, beyond = 0;
		for (size_t l = 0; l < f->level_count; l++) {
			const score *s = &scores->at[l][c];
			wrong = fmax(wrong, percent(s->wrong_sign, s->oriented));
			unusable = fmax(unusable, percent(s->zero + s->parallel, s->corners));
			worst = fmax(worst, s->worst_degrees);
			beyond = fmax(beyond, percent(s->beyond, s->corners));
		}
		printf(" %.3g / %.3g / %.2g", wrong, unusable, worst);
		if (c == COLUMN_ROBUST)
			printf(" | %.3g |\n", beyond);
		else
			printf(" |");
	}
}

/* Tangents that the default keeps or replaces: sums and worst of all levels. */
static void write_default(const family *f, const family_scores *scores)
{
	size_t corners = 0, replaced = 0, unbounded = 0, leaning[2] = {0, 0};
	double degrees = 0, share = 0, units = 0, unbounded_degrees = 0;
	for (size_t l = 0; l < f->level_count; l++) {
		const score *s = &scores->at[l][COLUMN_REPAIRED];
		corners += s->corners;
		replaced += s->replaced;
		unbounded += s->unbounded;
		leaning[0] += scores->at[l][COLUMN_RAW].leaning;
		leaning[1] += s->leaning;
		degrees = fmax(degrees, s->kept_degrees);
		share = fmax(share, s->kept_share);
		units = fmax(units, s->kept_units);
		unbounded_degrees = fmax(unbounded_degrees, s->unbounded_degrees);
	}
	printf("| %s | %zu | %zu | %zu | %zu | %.2g | %.2f | %.2g | %zu | ", f->name, corners, replaced,
		leaning[0], leaning[1], degrees, share, units, unbounded);
	if (unbounded)
		printf("%.3g |\n", unbounded_degrees);
	else
		printf("- |\n");
}

static bool run_family(const family *f, family_scores *scores)
{
	for (size_t l = 0; l < f->level_count; l++) {
		nt_owned mesh = f->make(f->levels[l], 1000 * l);
		if (mesh.mesh.face_count == 0) { /* a model that is not there */
			nt_owned_free(&mesh);
			continue;
		}
		const bool done = judge_mesh(&mesh, mesh.mesh.face_count <= ORACLE_TRIANGLES, scores->at[l]);
		nt_owned_free(&mesh);
		if (!done) {
			printf("stress: %s at %g: the call failed\n", f->name, f->levels[l]);
			return false;
		}
		check_level(f, l, scores->at[l]);
	}
	check_linear(f, scores);
	printf("stress: %s\n", f->name);
	fflush(stdout);
	return true;
}

int main(int argc, char **argv)
{
	if (argc > 2) {
		fprintf(stderr, "usage: stress [FAMILY]\n");
		return 2;
	}
	family_scores *scores = calloc(family_count, sizeof *scores);
	if (!scores)
		return 2;
	bool done = true;
	for (size_t i = 0; i < family_count; i++)
		if (argc < 2 || strcmp(argv[1], families[i].name) == 0)
			done = run_family(&families[i], &scores[i]) && done;
	printf("\n# Numerical stability\n\nThe worst level of each family: wrong signs (%% of the faces that have "
		"an exact one) / corners that are zero, not unit, not finite or along N (%%) / worst angle in "
		"degrees against the 113-bit formula where its condition is below 2^24. The last column is the "
		"share of corners (%%) beyond that.\n\n| family |");
	for (int c = 0; c < COLUMN_COUNT; c++)
		printf(" %s |", columns[c].name);
	printf(" beyond |\n|---|---|---|---|---|---|---|\n");
	for (size_t i = 0; i < family_count; i++)
		if (scores[i].at[0][0].faces)
			write_summary(&families[i], &scores[i]);
	printf("\n## The default against MikkTSpace's formula\n\nCorners over all levels: repaired; more "
		"than 2^-10 off perpendicular to a unit normal, raw and repaired. Of those that keep "
		"MikkTSpace's bytes and have a bound (bounds.h): the worst angle to the exact average of their "
		"group, the largest share of a bound that was used, and in units of 2^-24 times the condition "
		"(%d allowed). Of those without a bound, on which float arithmetic leaves MikkTSpace itself "
		"undetermined: how many, and the worst angle to the average of all triangles of the "
		"orientation.\n\n"
		"| family | corners | repaired | leaning, raw | leaning | kept, degrees | of the bound | units "
		"| no bound | degrees there |\n|---|---|---|---|---|---|---|---|---|---|\n", MOST_UNITS);
	for (size_t i = 0; i < family_count; i++)
		if (scores[i].at[0][0].faces)
			write_default(&families[i], &scores[i]);
	free(scores);
	printf("stress: %zu broken\n", broken);
	return done && broken == 0 ? 0 : 1;
}
