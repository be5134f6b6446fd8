/* SPDX-License-Identifier: MIT */
/*
 * make bench: run time against error.
 *
 *   error export FOLDER          writes the meshes for the peers
 *   error judge FOLDER OUTPUT    reads what the peers in FOLDER found, runs our methods on the same meshes
 *
 * Error is measured three ways: against the same formula in 113 bits (arithmetic), against the analytic
 * dP/du of the surface (truth), and by what a normal map looks like (eye). Tables in error.md and error.csv,
 * convergence.csv, bevel.csv, charts as SVG. Times are the best of several runs with a warm
 * workspace, in rounds over all methods.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/cpu.h"
#include "base/parallel.h"
#include "chart.h"
#include "error_eye.h"
#include "error_meshes.h"
#include "error_sweeps.h"
#include "measure.h"
#include "oracle128.h"
#include "api/tangents.h"

enum { MOST_RUNS = 24, WEIGHTS = 3, NO_WEIGHT = -1, ROUNDS = 4 };

/* One way to get tangents: ours, or a peer's file. */
typedef struct run {
	const char *name, *precision;
	nmtan_options options; /* ours */
	bool is_peer;
	int weight; /* enum oracle_weight of its formula; NO_WEIGHT: another formula */
	nt_implementation implementation; /* ours */
} run;

typedef struct result {
	double seconds, triangles; /* of the meshes that are timed */
	measure_pool arithmetic, truth;
	eye_sum baked, tiled;
	bool present;
} result;

typedef struct bench {
	bench_mesh meshes[BENCH_MESH_COUNT];
	oracle_corner *exact[BENCH_MESH_COUNT][WEIGHTS];
	float (*baker[BENCH_MESH_COUNT])[4]; /* MikkTSpace, as bakers have it; eye meshes alone */
	double best[MOST_RUNS][BENCH_MESH_COUNT]; /* seconds; negative: not there */
	run runs[MOST_RUNS];
	result results[MOST_RUNS];
	size_t run_count;
	const char *exchange, *output;
} bench;

/* Export */

static void export_mesh(const char *folder, const bench_mesh *m)
{
	char name[64];
	snprintf(name, sizeof name, "%s.mesh", m->name);
	FILE *f = measure_open(folder, name, "wb");
	const uint32_t head[2] = {(uint32_t)m->mesh.mesh.vertex_count, (uint32_t)m->mesh.corner_count};
	fwrite(head, 4, 2, f);
	fwrite(m->mesh.positions, 12, head[0], f);
	fwrite(m->mesh.normals, 12, head[0], f);
	fwrite(m->mesh.texcoords, 8, head[0], f);
	fwrite(m->mesh.indices, 4, head[1], f);
	fclose(f);
}

/* Runs */

static void add_run(bench *b, const char *name, const char *precision, nmtan_options options, bool is_peer,
	int weight)
{
	b->runs[b->run_count++] = (run){name, precision, options, is_peer, weight, {.isa = NT_ISA_AUTO}};
}

static void list_runs(bench *b)
{
	const nmtan_options one = {.struct_bytes = sizeof one, .threads = 1};
	nmtan_options o = one;
	add_run(b, "mikktspace", "float", o, false, ORACLE_ANGLE);
	o.repair = NMTAN_REPAIR_OFF;
	add_run(b, "mikktspace, repair off", "float", o, false, ORACLE_ANGLE);
	o = one;
	o.threads = 0;
	if (nt_thread_count(0) > 1)
		add_run(b, "mikktspace, all threads", "float", o, false, ORACLE_ANGLE);
	static const char *const sets[3] = {"mikktspace, baseline set", "mikktspace, AVX2",
		"mikktspace, AVX-512"};
	for (int isa = NT_ISA_BASELINE; isa <= NT_ISA_AVX512; isa++) {
		if (!nt_cpu_has((nt_isa)isa))
			continue;
		add_run(b, sets[isa - NT_ISA_BASELINE], "float", one, false, ORACLE_ANGLE);
		b->runs[b->run_count - 1].implementation.isa = (nt_isa)isa;
	}
	add_run(b, "mikktspace, scalar definition", "float", one, false, ORACLE_ANGLE);
	b->runs[b->run_count - 1].implementation.scalar = true;
	static const struct {
		const char *name, *threaded;
		nmtan_method method;
		int weight;
	} sums[3] = {{"area", "area, all threads", NMTAN_METHOD_AREA, ORACLE_AREA},
		{"lengyel", "lengyel, all threads", NMTAN_METHOD_LENGYEL, ORACLE_NONE},
		{"robust", "robust, all threads", NMTAN_METHOD_ROBUST, ORACLE_ANGLE}};
	for (int i = 0; i < 3; i++) {
		o = one;
		o.method = sums[i].method;
		add_run(b, sums[i].name, "double", o, false, sums[i].weight);
		o.threads = 0;
		if (nt_thread_count(0) > 1)
			add_run(b, sums[i].threaded, "double", o, false, sums[i].weight);
	}
	add_run(b, "assimp", "float", one, true, NO_WEIGHT);
	add_run(b, "mikktspace-npm", "float, wasm", one, true, ORACLE_ANGLE);
	add_run(b, "meshoptimizer-npm", "float, wasm", one, true, NO_WEIGHT);
	add_run(b, "meshoptimizer-npm-compatible", "float, wasm", one, true, ORACLE_ANGLE);
}

/* Ours: seconds of the best run; negative on failure. */
static double run_ours(const run *r, const nt_owned *mesh, float (*tangents)[4])
{
	nmtan_options options = r->options;
	options.workspace = nmtan_workspace_create(NULL);
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	double best = INFINITY, total = 0;
	for (int i = 0; i < 100 && (i < 2 || total < 0.04); i++) {
		const double start = measure_seconds();
		const nmtan_status status = nt_tangents(&mesh->mesh, &options, &r->implementation, &output, NULL);
		const double took = measure_seconds() - start;
		if (status) {
			fprintf(stderr, "error: %s: %s\n", r->name, nmtan_status_text(status));
			best = -1;
			break;
		}
		total += took;
		best = fmin(best, took);
	}
	nmtan_workspace_destroy(options.workspace);
	return best;
}

/* A peer's: what its files say; negative when there is nothing. */
static double read_peer(const bench *b, const run *r, const bench_mesh *m, float (*tangents)[4])
{
	char name[128], mesh_name[64], peer[64];
	snprintf(name, sizeof name, "%s.%s.tan", m->name, r->name);
	FILE *f = measure_open(b->exchange, name, "rb");
	if (!f)
		return -1;
	const bool whole = fread(tangents, 16, m->mesh.corner_count, f) == m->mesh.corner_count;
	fclose(f);
	double best = -1, took;
	f = measure_open(b->exchange, "peers.txt", "r");
	while (whole && f && fscanf(f, "%63s %63s %lf", mesh_name, peer, &took) == 3)
		if (strcmp(mesh_name, m->name) == 0 && strcmp(peer, r->name) == 0)
			best = took;
	if (f)
		fclose(f);
	return best;
}

/* Judging */

static const oracle_corner *exact_of(bench *b, size_t mesh, int weight)
{
	oracle_corner **at = &b->exact[mesh][weight];
	if (!*at) {
		*at = measure_room(b->meshes[mesh].mesh.corner_count, sizeof **at);
		if (!oracle_solve(&b->meshes[mesh].mesh.mesh, (oracle_weight)weight, *at))
			exit(4);
	}
	return *at;
}

static void judge_vectors(bench *b, size_t mesh, const run *r, const float (*tangents)[4], result *to)
{
	const bench_mesh *m = &b->meshes[mesh];
	const oracle_corner *exact = r->weight == NO_WEIGHT ? NULL : exact_of(b, mesh, r->weight);
	for (size_t c = 0; c < m->mesh.corner_count; c++) {
		if (exact && exact[c].sign != 0 && exact[c].condition < 1e6)
			measure_pool_add(&to->arithmetic, measure_degrees(tangents[c], exact[c].t));
		if (m->has_truth)
			measure_pool_add(&to->truth, measure_degrees(tangents[c], m->mesh.truth[m->mesh.indices[c]]));
	}
}

/* Times ours in rounds over all runs, so that what else the machine does meets them alike. */
static void time_runs(bench *b)
{
	for (int round = 0; round < ROUNDS; round++) {
		for (size_t i = 0; i < b->run_count; i++) {
			for (size_t m = 0; m < BENCH_MESH_COUNT && !b->runs[i].is_peer; m++) {
				const nt_owned *mesh = &b->meshes[m].mesh;
				if (mesh->mesh.face_count == 0)
					continue;
				float (*tangents)[4] = measure_room(mesh->corner_count, sizeof *tangents);
				const double took = run_ours(&b->runs[i], mesh, tangents);
				b->best[i][m] = round == 0 ? took : fmin(b->best[i][m], took);
				free(tangents);
			}
		}
	}
}

/* Our tangents once more; false on failure. */
static bool solve_ours(const run *r, const nt_owned *mesh, float (*tangents)[4])
{
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	return nt_tangents(&mesh->mesh, &r->options, &r->implementation, &output, NULL) == NMTAN_OK;
}

static void judge_run(bench *b, size_t index)
{
	const run *r = &b->runs[index];
	result *to = &b->results[index];
	for (size_t i = 0; i < BENCH_MESH_COUNT; i++) {
		const bench_mesh *m = &b->meshes[i];
		if (m->mesh.mesh.face_count == 0)
			continue;
		float (*tangents)[4] = measure_room(m->mesh.corner_count, sizeof *tangents);
		const double took = r->is_peer                              ? read_peer(b, r, m, tangents)
				    : solve_ours(r, &m->mesh, tangents) ? b->best[index][i]
									: -1;
		if (took >= 0) {
			to->present = true;
			if (m->is_eye) {
				eye_add(m, b->baker[i], tangents, &to->baked);
				eye_add(m, NULL, tangents, &to->tiled);
			} else {
				to->seconds += took;
				to->triangles += (double)m->mesh.mesh.face_count;
				judge_vectors(b, i, r, tangents, to);
			}
		}
		free(tangents);
	}
	measure_pool_finish(&to->arithmetic);
	measure_pool_finish(&to->truth);
	printf("bench: %s%s\n", r->name, to->present ? "" : " is not there, skipped");
	fflush(stdout);
}

static void make_bakers(bench *b)
{
	for (size_t i = 0; i < BENCH_MESH_COUNT; i++) {
		if (!b->meshes[i].is_eye)
			continue;
		b->baker[i] = measure_room(b->meshes[i].mesh.corner_count, sizeof *b->baker[i]);
		const nmtan_options options = {.struct_bytes = sizeof options, .repair = NMTAN_REPAIR_OFF};
		const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &b->baker[i][0][0]};
		if (nmtan_tangents(&b->meshes[i].mesh.mesh, &options, &output, NULL))
			exit(3);
	}
}

/* Tables */

static void print_cell(FILE *f, const char *format, double value)
{
	if (isfinite(value))
		fprintf(f, format, value);
	else
		fprintf(f, "-");
}

static double nanoseconds(const result *r)
{
	return 1e9 * r->seconds / r->triangles;
}

static void write_results(const bench *b, FILE *md)
{
	FILE *csv = measure_open(b->output, "error.csv", "w");
	fprintf(csv, "method,precision,ns_per_triangle,arithmetic_median,arithmetic_999,arithmetic_worst,"
		"truth_median,truth_999,truth_worst,baked_rms,baked_worst,baked_psnr,tiled_rms,tiled_worst,"
		"tiled_psnr\n");
	fprintf(md, "| method | precision | ns/triangle | arithmetic: median, 99.9 %%, worst | truth: median, 99.9 "
		"%%, worst | baked map: rms, worst, PSNR | tiling map: rms, worst, PSNR |\n"
		"|---|---|---|---|---|---|---|\n");
	for (size_t i = 0; i < b->run_count; i++) {
		const result *r = &b->results[i];
		if (!r->present)
			continue;
		const double values[12] = {r->arithmetic.median, r->arithmetic.high, r->arithmetic.worst,
			r->truth.median, r->truth.high, r->truth.worst, eye_rms_degrees(&r->baked),
			r->baked.worst_degrees, eye_psnr(&r->baked), eye_rms_degrees(&r->tiled),
			r->tiled.worst_degrees, eye_psnr(&r->tiled)};
		fprintf(md, "| %s | %s | %.1f |", b->runs[i].name, b->runs[i].precision, nanoseconds(r));
		fprintf(csv, "\"%s\",\"%s\",%.2f", b->runs[i].name, b->runs[i].precision, nanoseconds(r));
		for (int v = 0; v < 12; v++) {
			print_cell(md, v % 3 == 2 && v > 6 ? " %.1f dB" : " %.2g", values[v]);
			fprintf(md, v % 3 == 2 ? " |" : ",");
			fprintf(csv, ",");
			print_cell(csv, "%.5g", values[v]);
		}
		fprintf(md, "\n");
		fprintf(csv, "\n");
	}
	fclose(csv);
	double standard = NAN, robust = NAN;
	for (size_t i = 0; i < b->run_count; i++) {
		if (strcmp(b->runs[i].name, "mikktspace") == 0)
			standard = nanoseconds(&b->results[i]);
		if (strcmp(b->runs[i].name, "robust") == 0)
			robust = nanoseconds(&b->results[i]);
	}
	fprintf(md, "\nOne thread: robust takes %.2f times as long as the default.\n", robust / standard);
}

/* Charts: one series for each run, three points: median, 99.9 % and worst. */
static void write_chart(const bench *b, const char *name, bool truth)
{
	static const char *const marks[] = {"median", "99.9 %", "worst", NULL};
	double x[MOST_RUNS][3], y[MOST_RUNS][3];
	chart_series series[MOST_RUNS];
	size_t count = 0;
	for (size_t i = 0; i < b->run_count; i++) {
		const result *r = &b->results[i];
		const measure_pool *p = truth ? &r->truth : &r->arithmetic;
		/* single instruction sets would crowd the chart, as would threads, which meshes of this size do
		 * not use: the table has them */
		const bool crowded = strstr(b->runs[i].name, "AVX") || strstr(b->runs[i].name, "baseline") ||
				     strstr(b->runs[i].name, "repair off") ||
				     strstr(b->runs[i].name, "all threads");
		if (!r->present || crowded || !isfinite(p->median))
			continue;
		for (int k = 0; k < 3; k++)
			x[count][k] = nanoseconds(r);
		y[count][0] = p->median;
		y[count][1] = p->high;
		y[count][2] = p->worst;
		series[count] = (chart_series){b->runs[i].name, x[count], y[count], 3};
		count++;
	}
	char path[512];
	snprintf(path, sizeof path, "%s/%s", b->output, name);
	const chart c = {.title = truth ? "Run time against truth" : "Run time against arithmetic error",
		.subtitle = truth ? "angle to the analytic dP/du; five surfaces of 32768 triangles"
				  : "angle to the same formula in 113 bits; seven meshes",
		.x_label = "nanoseconds per triangle (-npm: wasm under node)", .y_label = "degrees", .log_x = true,
		.log_y = true, .points = true, .marks = marks, .series = series, .series_count = count};
	if (!chart_write(path, &c))
		exit(2);
}

static void write_machine(FILE *md)
{
	static const char *const sets[] = {"", "baseline", "AVX2", "AVX-512"};
	char line[256] = "", *model = NULL;
	FILE *f = fopen("/proc/cpuinfo", "r");
	while (f && !model && fgets(line, sizeof line, f))
		if (strncmp(line, "model name", 10) == 0 && (model = strchr(line, ':')))
			model[strcspn(model, "\n")] = 0;
	if (f)
		fclose(f);
	fprintf(md, "# Run time against error\n\n`make bench` on %s, %u processors, best set %s; compiled by %s %s. "
		"Angles in degrees. Arithmetic error is taken against the same formula in 113 bits, truth against the "
		"analytic dP/du, maps against the surface they were made from (8 bits a channel; baked: in "
		"MikkTSpace; tiling: painted for a flat patch). Peers ending in -npm are wasm under node: their "
		"times are not those of native code.\n\n", model ? model + 2 : "a machine", nt_thread_count(0),
		sets[nt_cpu_best()],
#ifdef __clang__
		"clang", __clang_version__
#else
		"gcc", __VERSION__
#endif
	);
}

static void judge(bench *b)
{
	list_runs(b);
	make_bakers(b);
	time_runs(b);
	for (size_t i = 0; i < b->run_count; i++)
		judge_run(b, i);
	FILE *md = measure_open(b->output, "error.md", "w");
	write_machine(md);
	write_results(b, md);
	write_chart(b, "error-arithmetic.svg", false);
	write_chart(b, "error-truth.svg", true);
	sweep_bevels(b->output, md);
	sweep_convergence(b->output, md);
	fclose(md);
	for (size_t i = 0; i < BENCH_MESH_COUNT; i++) {
		free(b->baker[i]);
		for (int w = 0; w < WEIGHTS; w++)
			free(b->exact[i][w]);
	}
}

int main(int argc, char **argv)
{
	static bench b;
	const bool exports = argc == 3 && strcmp(argv[1], "export") == 0;
	if (!exports && !(argc == 4 && strcmp(argv[1], "judge") == 0)) {
		fprintf(stderr, "usage: error export FOLDER | error judge FOLDER OUTPUT\n");
		return 2;
	}
	b.exchange = argv[2];
	b.output = argv[argc - 1];
	bench_meshes_make(b.meshes);
	for (int i = 0; exports && i < BENCH_MESH_COUNT; i++)
		if (b.meshes[i].mesh.mesh.face_count > 0)
			export_mesh(b.exchange, &b.meshes[i]);
	if (!exports)
		judge(&b);
	bench_meshes_free(b.meshes);
	return 0;
}
