/* SPDX-License-Identifier: MIT */
/*
 * make stress: every family at every level, every method, against the oracle.
 *
 *   stress FOLDER [FAMILY]
 *
 * With $PEERS, the folder of native peers (tests/bench/native.h), their wrong signs, zeros and leaning tangents too.
 *
 * Writes stress.csv, stress.md, samples.txt for check_fractions.py and two charts for each family (what is
 * unusable or has a wrong sign; the worst angle). Ends with 1 when something that must hold does not:
 *
 *   the default and robust: no zero, non-unit or non-finite tangent; one w on every face; the exact sign on every face
 *     that has one; perpendicular to normals of unit length within 2^-10; the mirrored, scaled, turned answer for the
 *     mirrored, scaled, turned mesh (twins.h)
 *   the default: MikkTSpace's bytes wherever they are usable, and these within the bound that is proved for each corner
 *     (bounds.h). Corners without a bound: none where the family says so, and no more than it allows elsewhere. What
 *     was repaired has the exact frame within 2^-23 where its condition is below 2^24
 *   robust: every component within 2^-23 of the oracle where the condition is below 2^24; T perpendicular to N within
 *     2^-21; corner_faults names all corners beyond that condition
 *   sweeps of size: time per triangle within a factor of 8 from 10^4 triangles on
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "chart.h"
#include "families.h"
#include "judge.h"
#include "peers.h"
#include "sample.h"

enum { MOST_LEVELS = 16, ORACLE_TRIANGLES = 120000 };

typedef struct family_scores {
	score at[MOST_LEVELS][COLUMN_COUNT];
	peer_counts faults;
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
		for (int k = 0; k < TWIN_COUNT; k++) {
			char what[64];
			snprintf(what, sizeof what, "corners of the twin that is %s", twins[k].name);
			must_hold(f, level, name, what, s->twins[k]);
		}
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

static void write_csv(FILE *csv, const family *f, size_t l, const score scores[COLUMN_COUNT])
{
	for (int c = 0; c < COLUMN_COUNT; c++) {
		const score *s = &scores[c];
		fprintf(csv, "%s,%g,%s,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%.3g,%zu,%.4g,%.4g,"
			"%.4g,%.1f\n", f->name,
			f->levels[l], columns[c].name, s->faces, s->oriented, s->wrong_sign, s->mixed_sign,
			s->corners, s->zero, s->parallel, s->judged, s->beyond, s->off, s->leaning, s->inexact,
			s->kept, s->kept_units, s->altered,
			s->median_degrees, s->high_degrees, s->worst_degrees, s->ns_per_triangle);
	}
}

static void write_table(FILE *md, const family *f, const family_scores *scores)
{
	fprintf(md, "\n## %s\n\nWrong signs (%% of faces that have one) / unusable corners (%%) / worst degrees / "
		"ns per triangle.\n\n| %s |", f->name, f->level_name);
	for (int c = 0; c < COLUMN_COUNT; c++)
		fprintf(md, " %s |", columns[c].name);
	fprintf(md, "\n|---|---|---|---|---|---|\n");
	for (size_t l = 0; l < f->level_count; l++) {
		fprintf(md, "| %g |", f->levels[l]);
		for (int c = 0; c < COLUMN_COUNT; c++) {
			const score *s = &scores->at[l][c];
			fprintf(md, " %.3g / %.3g / ", percent(s->wrong_sign, s->oriented),
				percent(s->zero + s->parallel, s->corners));
			if (s->judged)
				fprintf(md, "%.2g", s->worst_degrees);
			else
				fprintf(md, "-");
			fprintf(md, " / %.0f |", s->ns_per_triangle);
		}
		fprintf(md, "\n");
	}
}

/* One line for each family: the worst of all its levels. */
static void write_summary(FILE *md, const family *f, const family_scores *scores)
{
	fprintf(md, "| %s |", f->name);
	for (int c = 0; c < COLUMN_COUNT; c++) {
		double wrong = 0, unusable = 0, worst = 0, beyond = 0;
		for (size_t l = 0; l < f->level_count; l++) {
			const score *s = &scores->at[l][c];
			wrong = fmax(wrong, percent(s->wrong_sign, s->oriented));
			unusable = fmax(unusable, percent(s->zero + s->parallel, s->corners));
			worst = fmax(worst, s->worst_degrees);
			beyond = fmax(beyond, percent(s->beyond, s->corners));
		}
		fprintf(md, " %.3g / %.3g / %.2g", wrong, unusable, worst);
		if (c == COLUMN_ROBUST)
			fprintf(md, " | %.3g |\n", beyond);
		else
			fprintf(md, " |");
	}
}

/* What the default keeps and what it replaces: sums and worst of all levels. */
static void write_default(FILE *md, const family *f, const family_scores *scores)
{
	size_t corners = 0, replaced = 0, unbounded = 0, leaning[2] = {0, 0}, differing = 0;
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
		for (int k = 0; k < TWIN_COUNT; k++)
			differing += s->twins[k];
	}
	fprintf(md, "| %s | %zu | %zu | %zu | %zu | %.2g | %.2f | %.2g | %zu | ", f->name, corners, replaced,
		leaning[0], leaning[1], degrees, share, units, unbounded);
	if (unbounded)
		fprintf(md, "%.3g", unbounded_degrees);
	else
		fprintf(md, "-");
	fprintf(md, " | %zu |\n", differing);
}

static void write_chart(const char *folder, const family *f, const family_scores *scores, bool angles)
{
	double y[COLUMN_COUNT][MOST_LEVELS];
	chart_series series[COLUMN_COUNT];
	for (int c = 0; c < COLUMN_COUNT; c++) {
		for (size_t l = 0; l < f->level_count; l++) {
			const score *s = &scores->at[l][c];
			y[c][l] = angles ? (s->judged ? fmax(s->worst_degrees, 1e-7) : NAN)
					 : fmax(percent(s->wrong_sign, s->oriented),
						   percent(s->zero + s->parallel, s->corners));
		}
		series[c] = (chart_series){columns[c].name, f->levels, y[c], f->level_count, NULL};
	}
	char path[512], title[128];
	snprintf(title, sizeof title, angles ? "%s: worst angle" : "%s: wrong sign or unusable", f->name);
	const chart_panel panel = {NULL, series, COLUMN_COUNT};
	const chart ch = {.title = title, .subtitle = angles
			? "against the 113-bit formula, where its condition is below 2^24 (1e-7 stands for less)"
			: "the larger share: faces with a wrong w, corners that are not a unit vector beside N",
		.x_label = f->level_name, .y_label = angles ? "degrees" : "per cent", .log_x = f->logarithmic,
		.log_y = angles, .panels = &panel, .panel_count = 1};
	snprintf(path, sizeof path, "%s/%s-%s.svg", folder, f->name, angles ? "angle" : "unusable");
	for (char *p = path + strlen(folder); *p; p++)
		*p = *p == ' ' ? '-' : *p;
	if (!chart_write(path, &ch))
		broken++;
}

static bool run_family(const family *f, const peers *p, family_scores *scores, FILE *csv, FILE *samples)
{
	for (size_t l = 0; l < f->level_count; l++) {
		nt_owned mesh = f->make(f->levels[l], 1000 * l);
		if (mesh.mesh.face_count == 0) { /* a model that is not there */
			nt_owned_free(&mesh);
			continue;
		}
		const bool done = judge_mesh(&mesh, mesh.mesh.face_count <= ORACLE_TRIANGLES, scores->at[l]);
		sample_triangles(&mesh, samples);
		peers_add(p, &mesh, &scores->faults);
		nt_owned_free(&mesh);
		if (!done) {
			printf("stress: %s at %g: the call failed\n", f->name, f->levels[l]);
			return false;
		}
		write_csv(csv, f, l, scores->at[l]);
		check_level(f, l, scores->at[l]);
	}
	check_linear(f, scores);
	printf("stress: %s\n", f->name);
	fflush(stdout);
	return true;
}

static FILE *open_in(const char *folder, const char *name)
{
	char path[512];
	snprintf(path, sizeof path, "%s/%s", folder, name);
	FILE *f = fopen(path, "w");
	if (!f)
		printf("stress: cannot write %s\n", path);
	return f;
}

int main(int argc, char **argv)
{
	if (argc < 2 || argc > 3) {
		fprintf(stderr, "usage: stress FOLDER [FAMILY]\n");
		return 2;
	}
	FILE *csv = open_in(argv[1], "stress.csv"), *md = open_in(argv[1], "stress.md");
	FILE *samples = open_in(argv[1], "samples.txt");
	family_scores *scores = calloc(family_count, sizeof *scores);
	if (!csv || !md || !samples || !scores)
		return 2;
	fprintf(csv, "family,level,method,faces,oriented,wrong_sign,mixed_sign,corners,zero,parallel,judged,"
		"beyond,off,leaning,inexact,kept,kept_units,altered,median_degrees,high_degrees,worst_degrees,"
		"ns_per_triangle\n");
	bool done = true;
	peers p;
	peers_open(&p);
	for (size_t i = 0; i < family_count; i++)
		if (argc < 3 || strcmp(argv[2], families[i].name) == 0)
			done = run_family(&families[i], &p, &scores[i], csv, samples) && done;
	fprintf(md, "# Numerical stability\n\nThe worst level of each family: wrong signs (%% of the faces that have "
		"an exact one) / corners that are zero, not unit, not finite or along N (%%) / worst angle in "
		"degrees against the 113-bit formula where its condition is below 2^24. The last column is the "
		"share of corners (%%) beyond that.\n\n| family |");
	for (int c = 0; c < COLUMN_COUNT; c++)
		fprintf(md, " %s |", columns[c].name);
	fprintf(md, " beyond |\n|---|---|---|---|---|---|---|\n");
	for (size_t i = 0; i < family_count; i++)
		if (scores[i].at[0][0].faces)
			write_summary(md, &families[i], &scores[i]);
	fprintf(md, "\n## The default against MikkTSpace's formula\n\nCorners over all levels: repaired; more "
		"than 2^-10 off perpendicular to a unit normal, raw and repaired. Of those that keep "
		"MikkTSpace's bytes and have a bound (bounds.h): the worst angle to the exact average of their "
		"group, the largest share of a bound that was used, and in units of 2^-24 times the condition "
		"(%d allowed). Of those without a bound, on which float arithmetic leaves MikkTSpace itself "
		"undetermined: how many, and the worst angle to the average of all triangles of the "
		"orientation. Corners whose mirrored, scaled or turned twin differs.\n\n"
		"| family | corners | repaired | leaning, raw | leaning | kept, degrees | of the bound | units "
		"| no bound | degrees there | twins |\n|---|---|---|---|---|---|---|---|---|---|---|\n", MOST_UNITS);
	for (size_t i = 0; i < family_count; i++)
		if (scores[i].at[0][0].faces)
			write_default(md, &families[i], &scores[i]);
	peers_write_head(&p, md);
	for (size_t i = 0; i < family_count; i++)
		peers_write_row(&p, families[i].name, &scores[i].faults, md);
	for (size_t i = 0; i < family_count; i++) {
		if (!scores[i].at[0][0].faces)
			continue;
		write_table(md, &families[i], &scores[i]);
		write_chart(argv[1], &families[i], &scores[i], true);
		write_chart(argv[1], &families[i], &scores[i], false);
	}
	fprintf(md, "\n%s\n", broken ? "SOMETHING THAT MUST HOLD DOES NOT: see the output of make stress."
				      : "Everything that must hold holds.");
	done = fclose(csv) == 0 && fclose(md) == 0 && fclose(samples) == 0 && done;
	free(scores);
	printf("stress: %zu broken\n", broken);
	return done && broken == 0 ? 0 : 1;
}
