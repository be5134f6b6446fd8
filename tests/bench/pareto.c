/* SPDX-License-Identifier: MIT */
/*
 * make bench: run time against the error of an image.
 *
 *   pareto export FOLDER FILE...          writes the meshes for the peers: models FILE (see models.h) and nasty ones
 *   pareto judge FOLDER NMTAN FILE...      runs nmtan, native peers of $PEERS and gltfpack; reads what others left in
 *                                          FOLDER; prints tables in Markdown, leaves marks for chart.py
 *
 * Time is nanoseconds for each triangle of all models, of two kinds: of a call, arrays in and arrays out on one thread
 * with warm memory; of a whole run, from file to file. Programs of one kind take turns; the best of the rounds counts.
 * Error is that of image.h: median and 99.9 % over the points of all models, each in equal number. The front has what
 * no other of its kind beats in both. The maximum is that of all triangles, where B is made per pixel. $ROUNDS: other
 * numbers of rounds, for a try.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/cpu.h"
#include "base/parallel.h"
#include "faults.h"
#include "files.h"
#include "measure.h"
#include "models.h"
#include "native.h"
#include "oracle128.h"
#include "round_trip.h"
#include "api/tangents.h"

enum { MOST_ROWS = 48, MOST_VARIANTS = 4, CALL_ROUNDS = 5, RUN_ROUNDS = 3, MOST_ARGUMENTS = 12 };

/* The time for which a call is repeated in a round, in seconds. */
static const double ROUND = 0.01;

/* Times that are nearer to each other than that are taken as equal: one is not ahead by what a run may differ. */
static const double SAME_TIME = 1.03;

typedef enum kind {
	CALL_NMTAN,
	CALL_NATIVE,
	CALL_OTHER, /* what its files say */
	RUN_TOOL,
	RUN_OTHER
} kind;

/* An nmtan that gives the same bytes in another time. */
typedef struct variant {
	const char *name;
	nt_implementation implementation;
	unsigned threads;
} variant;

typedef struct row {
	char name[96], label[64]; /* in the table; in the chart, empty: not there */
	kind kind;
	nmtan_method method;                   /* CALL_NMTAN */
	const native *peer;                    /* CALL_NATIVE */
	char id[64];                           /* the others: in names of files */
	const char *arguments[MOST_ARGUMENTS]; /* RUN_TOOL: program and options; input and output follow */
	bool output_by_option;                 /* RUN_TOOL: as -i INPUT -o OUTPUT */
	bool nasty;                            /* counted on nasty meshes */
	bool present;
	double seconds[MODEL_MOST][MOST_VARIANTS];
	double ns[MOST_VARIANTS];
	size_t variant_count, one_thread_count; /* the latter come first */
	size_t missing; /* triangles that the tool has not kept */
	measure_pool conventions[IMAGE_CONVENTIONS], bits16, bits8;
	worst_point worst;
	size_t worst_model;
	faults faults;
	bool front_median, front_high;
} row;

typedef struct bench {
	model models[MODEL_MOST];
	nt_owned nasty[NASTY_MOST];
	size_t model_count, nasty_count, nasty_corners;
	variant variants[MOST_VARIANTS];
	size_t variant_count;
	native peers[NATIVE_MOST];
	row rows[MOST_ROWS];
	size_t row_count;
	const char *folder, *nmtan;
	char gltfpack[512];
	char **files; /* [model_count] of the models, NULL: stand-ins */
	int call_rounds, run_rounds;
} bench;

static char *path_of(const bench *b, char path[512], char letter, size_t number, const char *rest)
{
	snprintf(path, 512, "%s/%c%zu.%s", b->folder, letter, number, rest);
	return path;
}

static void export_meshes(const bench *b)
{
	char path[512];
	for (size_t i = 0; i < b->model_count + b->nasty_count; i++) {
		const bool is_model = i < b->model_count;
		const nt_owned *mesh = is_model ? &b->models[i].mesh : &b->nasty[i - b->model_count];
		const size_t number = is_model ? i : i - b->model_count;
		files_write_mesh(path_of(b, path, is_model ? 'm' : 'n', number, "mesh"), mesh);
		files_write_glb(path_of(b, path, is_model ? 'm' : 'n', number, "glb"), mesh);
	}
}

/* Rows */

static row *add_row(bench *b, kind of, bool nasty)
{
	row *r = &b->rows[b->row_count++];
	r->kind = of;
	r->nasty = nasty;
	r->variant_count = 1;
	return r;
}

static const char *const method_names[] = {"mikktspace", "area", "lengyel", "robust"};

static void list_calls(bench *b)
{
	static const char *const sets[] = {"", "baseline set", "AVX2", "AVX-512"};
	for (nt_isa isa = NT_ISA_BASELINE; isa <= NT_ISA_AVX512; isa++)
		if (nt_cpu_has(isa))
			b->variants[b->variant_count++] = (variant){sets[isa], {.isa = isa}, 1};
	const size_t one_thread_count = b->variant_count;
	if (nt_thread_count(0) > 1)
		b->variants[b->variant_count++] = (variant){"all threads", {.isa = NT_ISA_AUTO}, 0};
	for (int m = NMTAN_METHOD_MIKKTSPACE; m <= NMTAN_METHOD_ROBUST; m++) {
		row *r = add_row(b, CALL_NMTAN, true);
		snprintf(r->name, sizeof r->name, "nmtan %s", method_names[m]);
		snprintf(r->label, sizeof r->label, "%s",
			m == NMTAN_METHOD_MIKKTSPACE ? "nmtan" : "");
		r->method = (nmtan_method)m;
		r->variant_count = b->variant_count;
		r->one_thread_count = one_thread_count;
	}
	const size_t peers = native_open(getenv("PEERS"), b->peers);
	for (size_t i = 0; i < peers; i++) {
		row *r = add_row(b, CALL_NATIVE, true);
		snprintf(r->name, sizeof r->name, "%s", b->peers[i].name);
		snprintf(r->label, sizeof r->label, "%s", b->peers[i].name);
		r->peer = &b->peers[i];
	}
}

static void list_runs(bench *b)
{
	static const struct {
		const char *name, *option;
	} outputs[] = {{"float", "--precision=float"}, {"short", "--precision=short"}, {"byte", "--precision=byte"},
		{"Draco", "--draco=sequential"}};
	static char methods[4][32];
	for (int m = 0; m < 4; m++) {
		snprintf(methods[m], sizeof methods[m], "--method=%s", method_names[m]);
		for (int o = 0; o < 4; o++) {
			row *r = add_row(b, RUN_TOOL, m == 0 && o < 3);
			snprintf(r->name, sizeof r->name, "nmtan %s, %s", method_names[m], outputs[o].name);
			if (m == 0)
				snprintf(r->label, sizeof r->label, "nmtan%s%s", o ? ", " : "",
					o ? outputs[o].name : "");
			const char *const arguments[] = {b->nmtan, "-q", "--threads=1", methods[m],
				outputs[o].option, NULL};
			memcpy(r->arguments, arguments, sizeof arguments);
		}
	}
	const char *peers = getenv("PEERS");
	snprintf(b->gltfpack, sizeof b->gltfpack, "%s/gltfpack", peers ? peers : "/usr/bin");
	if (access(b->gltfpack, X_OK) != 0) {
		printf("bench: no %s, skipped\n", b->gltfpack);
		return;
	}
	char version[32] = "";
	char command[600];
	snprintf(command, sizeof command, "%s -v", b->gltfpack);
	FILE *f = popen(command, "r");
	if (f) {
		if (fscanf(f, "gltfpack %31s", version) != 1)
			version[0] = 0;
		pclose(f);
	}
	for (int quantised = 0; quantised < 2; quantised++) {
		row *r = add_row(b, RUN_TOOL, true);
		snprintf(r->name, sizeof r->name, "gltfpack %s -gt %s", version, quantised ? "-vtf" : "-noq");
		if (!quantised)
			snprintf(r->label, sizeof r->label, "gltfpack %s -gt -noq", version);
		const char *const arguments[] = {b->gltfpack, "-gt", quantised ? "-vtf" : "-noq", NULL};
		memcpy(r->arguments, arguments, sizeof arguments);
		r->output_by_option = true;
	}
}

/* Peers that left a line in peers.txt, with the versions of versions.txt. */
static void list_others(bench *b)
{
	char mesh[64], id[64];
	double seconds;
	FILE *f = measure_open(b->folder, "peers.txt", "r");
	while (f && fscanf(f, "%63s %63s %lf", mesh, id, &seconds) == 3) {
		row *r = b->rows;
		while (r < b->rows + b->row_count && strcmp(r->id, id) != 0)
			r++;
		if (r == b->rows + b->row_count) {
			r = add_row(b, strcmp(id, "gltf-transform") == 0 ? RUN_OTHER : CALL_OTHER, true);
			snprintf(r->id, sizeof r->id, "%s", id);
			snprintf(r->name, sizeof r->name, "%s", id);
			snprintf(r->label, sizeof r->label, "%s", id);
		}
		if (mesh[0] == 'm' && (size_t)atoi(mesh + 1) < b->model_count)
			r->seconds[atoi(mesh + 1)][0] = seconds;
	}
	if (f)
		fclose(f);
	f = measure_open(b->folder, "versions.txt", "r");
	char version[32];
	while (f && fscanf(f, "%63s %31s", id, version) == 2)
		for (row *r = b->rows; r < b->rows + b->row_count; r++)
			if (r->id[0] && strncmp(r->id, id, strlen(id)) == 0) {
				snprintf(r->name, sizeof r->name, "%s %.16s (npm)", r->id, version);
				snprintf(r->label, sizeof r->label, "%.56s (npm)", r->id);
			}
	if (f)
		fclose(f);
}

/* Time */

/* Tangents of a call; false: the peer has none for this mesh. */
static bool call(const bench *b, const row *r, size_t v, const nt_owned *mesh, nmtan_workspace *workspace,
	float (*tangents)[4])
{
	if (r->kind == CALL_NATIVE)
		return native_solve(r->peer, mesh, tangents);
	const variant *as = &b->variants[v];
	const nmtan_options options = {.struct_bytes = sizeof options, .method = r->method, .threads = as->threads,
		.workspace = workspace};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	return nt_tangents(&mesh->mesh, &options, &as->implementation, &output, NULL) == NMTAN_OK;
}

static void keep_best(double *best, double took)
{
	if (*best == 0 || took < *best)
		*best = took;
}

static void time_calls(bench *b)
{
	nmtan_workspace *workspace = nmtan_workspace_create(NULL);
	for (int round = 0; round < b->call_rounds; round++) {
		for (size_t m = 0; m < b->model_count; m++) {
			const nt_owned *mesh = &b->models[m].mesh;
			float (*tangents)[4] = measure_room(mesh->corner_count, sizeof *tangents);
			for (row *r = b->rows; r < b->rows + b->row_count; r++) {
				for (size_t v = 0; v < r->variant_count && r->kind <= CALL_NATIVE; v++) {
					const double end = measure_seconds() + ROUND;
					double start;
					do {
						start = measure_seconds();
						call(b, r, v, mesh, workspace, tangents);
						keep_best(&r->seconds[m][v], measure_seconds() - start);
					} while (start < end);
				}
			}
			free(tangents);
		}
	}
	nmtan_workspace_destroy(workspace);
}

/* Runs a tool on mesh `letter``number`; the output's path. */
static double run_tool(const bench *b, const row *r, char letter, size_t number, char output[512])
{
	char input[512], rest[64];
	const char *arguments[MOST_ARGUMENTS + 5];
	size_t n = 0;
	for (; r->arguments[n]; n++)
		arguments[n] = r->arguments[n];
	path_of(b, input, letter, number, "glb");
	snprintf(rest, sizeof rest, "row%zu.glb", (size_t)(r - b->rows));
	path_of(b, output, letter, number, rest);
	if (r->output_by_option)
		arguments[n++] = "-i";
	arguments[n++] = input;
	if (r->output_by_option)
		arguments[n++] = "-o";
	arguments[n++] = output;
	arguments[n] = NULL;
	return files_run(arguments);
}

static void time_runs(bench *b)
{
	char output[512];
	for (int round = 0; round < b->run_rounds; round++) {
		for (size_t m = 0; m < b->model_count; m++) {
			for (row *r = b->rows; r < b->rows + b->row_count; r++) {
				if (r->kind != RUN_TOOL)
					continue;
				const double took = run_tool(b, r, 'm', m, output);
				if (took > 0)
					keep_best(&r->seconds[m][0], took);
				else if (round == 0)
					printf("bench: %s fails on %s\n", r->name, b->models[m].name);
			}
		}
	}
}

/* Error */

static bool read_tangents(const bench *b, const row *r, char letter, size_t number, const nt_owned *mesh,
	float (*tangents)[4])
{
	char path[512], rest[80];
	snprintf(rest, sizeof rest, "%s.tan", r->id);
	FILE *f = fopen(path_of(b, path, letter, number, rest), "rb");
	const bool whole = f && fread(tangents, 16, mesh->corner_count, f) == mesh->corner_count;
	if (f)
		fclose(f);
	return whole;
}

/* The result of a row for a model. */
static bool shade(const bench *b, const row *r, size_t number, nmtan_workspace *workspace, shading *to)
{
	const model *m = &b->models[number];
	char path[512], rest[80];
	if (r->kind >= RUN_TOOL) {
		if (r->kind == RUN_TOOL)
			snprintf(rest, sizeof rest, "row%zu.glb", (size_t)(r - b->rows));
		else
			snprintf(rest, sizeof rest, "%s.glb", r->id);
		return files_read_shading(b->nmtan, path_of(b, path, 'm', number, rest), &m->mesh, m->size, to);
	}
	for (size_t c = 0; c < m->mesh.corner_count; c++)
		memcpy(to->normals[c], m->mesh.normals[m->mesh.indices[c]], 12);
	memset(to->there, 1, m->mesh.mesh.face_count);
	return r->kind == CALL_OTHER ? read_tangents(b, r, 'm', number, &m->mesh, to->tangents)
				     : call(b, r, 0, &m->mesh, workspace, to->tangents);
}

static void judge_row(bench *b, row *r, const round_trip *trips)
{
	nmtan_workspace *workspace = nmtan_workspace_create(NULL);
	size_t triangles = 0;
	for (size_t m = 0; m < b->model_count; m++) {
		shading s = shading_make(&b->models[m].mesh);
		if (r->seconds[m][0] > 0 && shade(b, r, m, workspace, &s)) {
			r->present = true;
			r->missing += s.missing;
			triangles += b->models[m].mesh.mesh.face_count;
			for (size_t v = 0; v < r->variant_count; v++)
				r->ns[v] += 1e9 * r->seconds[m][v];
			const worst_point worst = round_trip_judge(&trips[m], &s, r->conventions);
			if (worst.degrees > r->worst.degrees) {
				r->worst = worst;
				r->worst_model = m;
			}
		} else {
			printf("bench: %s has nothing for %s\n", r->name, b->models[m].name);
		}
		shading_free(&s);
	}
	for (size_t v = 0; v < r->variant_count; v++)
		r->ns[v] /= (double)triangles;
	for (int c = 0; c < IMAGE_CONVENTIONS; c++) {
		measure_pool *all = image_conventions[c].bits == 16 ? &r->bits16 : &r->bits8;
		for (size_t i = 0; i < r->conventions[c].count; i++)
			measure_pool_add(all, r->conventions[c].values[i]);
		measure_pool_finish(&r->conventions[c]);
	}
	measure_pool_finish(&r->bits16);
	measure_pool_finish(&r->bits8);
	nmtan_workspace_destroy(workspace);
}

/* Faults */

static void count_files(const bench *b, row *r)
{
	static char paths[NASTY_MOST][512];
	const char *files[NASTY_MOST];
	char rest[80];
	size_t n = 0;
	snprintf(rest, sizeof rest, "%s.glb", r->id);
	for (size_t i = 0; i < b->nasty_count; i++) {
		files[n] = paths[n];
		if (r->kind == RUN_TOOL ? run_tool(b, r, 'n', i, paths[n]) >= 0
					: access(path_of(b, paths[n], 'n', i, rest), R_OK) == 0)
			n++;
	}
	if (n < b->nasty_count)
		printf("bench: %s does %zu of %zu nasty meshes\n", r->name, n, b->nasty_count);
	if (!faults_add_files(files, n, &r->faults))
		r->nasty = false;
	if (r->faults.corners != b->nasty_corners)
		printf("bench: %s: its files have %zu of %zu nasty corners\n", r->name, r->faults.corners,
			b->nasty_corners);
}

static void count_calls(const bench *b, row *r)
{
	nmtan_workspace *workspace = nmtan_workspace_create(NULL);
	for (size_t i = 0; i < b->nasty_count; i++) {
		float (*tangents)[4] = measure_room(b->nasty[i].corner_count, sizeof *tangents);
		if (r->kind == CALL_OTHER ? read_tangents(b, r, 'n', i, &b->nasty[i], tangents)
					  : call(b, r, 0, &b->nasty[i], workspace, tangents))
			faults_add(&b->nasty[i], tangents, &r->faults);
		else
			printf("bench: %s has nothing for nasty mesh %zu\n", r->name, i);
		free(tangents);
	}
	nmtan_workspace_destroy(workspace);
}

/* The front */

/* Three digits: what differs less is equal. */
static double rounded(double value)
{
	char text[32];
	snprintf(text, sizeof text, "%.2e", value);
	return atof(text);
}

static bool same_kind(const row *a, const row *b)
{
	return (a->kind >= RUN_TOOL) == (b->kind >= RUN_TOOL);
}

/* The best of the instruction sets. */
static double fastest(const row *r)
{
	double best = r->ns[0];
	for (size_t v = 1; v < r->one_thread_count; v++)
		best = fmin(best, r->ns[v]);
	return best;
}

static double error_of(const row *r, bool high)
{
	return rounded(high ? r->bits16.high : r->bits16.median);
}

static bool on_front(const bench *b, const row *r, bool high)
{
	for (const row *o = b->rows; o < b->rows + b->row_count; o++)
		if (o != r && o->present && same_kind(o, r) && fastest(o) <= SAME_TIME * fastest(r) &&
			error_of(o, high) <= error_of(r, high) &&
			(SAME_TIME * fastest(o) < fastest(r) || error_of(o, high) < error_of(r, high)))
			return false;
	return true;
}

/* Tables */

static void print_machine(const bench *b)
{
	printf("\n%s, %u processors, gcc %s. Models:", measure_processor(), nt_thread_count(0),
		__VERSION__);
	for (size_t m = 0; m < b->model_count; m++)
		printf("%s %s (%zu)", m ? "," : "", b->models[m].name, b->models[m].mesh.mesh.face_count);
	printf(".\n\n");
}

static void print_times(const bench *b, const row *r)
{
	if (r->variant_count == 1)
		printf(" %.0f |", r->ns[0]);
	for (size_t v = 0; r->variant_count > 1 && v < r->variant_count; v++)
		printf("%s%s %.0f%s", v ? ", " : " ", b->variants[v].name, r->ns[v],
			v + 1 == r->variant_count ? " |" : "");
}

static void print_rows(const bench *b)
{
	printf("| # | method | ns a triangle | 16 bits: median, 99.9 %% | 8 bits: median, 99.9 %% | maximum: "
		"model, corner | nasty: wrong w | not unit | not perpendicular |\n"
		"|---|---|---|---|---|---|---|---|---|\n");
	size_t number = 0;
	for (const row *r = b->rows; r < b->rows + b->row_count; r++) {
		if (!r->present)
			continue;
		printf("| %zu%s | %s |", ++number, r->front_median || r->front_high ? " *" : "", r->name);
		print_times(b, r);
		printf(" %.2g, %.2g | %.2g, %.2g |", r->bits16.median, r->bits16.high, r->bits8.median, r->bits8.high);
		printf(" %.2g: %s, %zu%s |", r->worst.degrees, b->models[r->worst_model].name, r->worst.corner,
			r->worst.raw_zero ? ", raw tangent is zero" : "");
		if (r->nasty && r->faults.corners)
			printf(" %zu | %zu | %zu |\n", r->faults.wrong, r->faults.zero, r->faults.leaning);
		else
			printf(" - | - | - |\n");
		if (r->missing)
			fprintf(stderr, "bench: %s lost %zu triangles\n", r->name, r->missing);
	}
}

static void print_conventions(const bench *b)
{
	printf("\nThe same by convention, median and 99.9 %%.\n\n| method |");
	for (int c = 0; c < IMAGE_CONVENTIONS; c++)
		printf(" %s |", image_conventions[c].name);
	printf("\n|---|");
	for (int c = 0; c < IMAGE_CONVENTIONS; c++)
		printf("---|");
	for (const row *r = b->rows; r < b->rows + b->row_count; r++) {
		if (!r->present)
			continue;
		printf("\n| %s |", r->name);
		for (int c = 0; c < IMAGE_CONVENTIONS; c++)
			printf(" %.2g, %.2g |", r->conventions[c].median, r->conventions[c].high);
	}
	printf("\n\n");
}

/* Time of lengyel by that of the default, model by model: who is on the front is one sum over all. */
static void print_lengyel(const bench *b)
{
	const row *base = b->rows, *runs = b->rows;
	while (runs->kind != RUN_TOOL)
		runs++;
	const row *const pairs[2][2] = {{base + 2, base}, {runs + 8, runs}};
	for (int of = 0; of < 2; of++) {
		printf("%s / %s:", pairs[of][0]->name, pairs[of][1]->name);
		for (size_t m = 0; m < b->model_count; m++) {
			double best[2];
			for (int i = 0; i < 2; i++) {
				best[i] = pairs[of][i]->seconds[m][0];
				for (size_t v = 1; v < pairs[of][i]->one_thread_count; v++)
					best[i] = fmin(best[i], pairs[of][i]->seconds[m][v]);
			}
			printf("%s %s %.2f", m ? "," : "", b->models[m].name, best[0] / best[1]);
		}
		printf(".\n\n");
	}
}

/* A model as nmtan writes it, its quads solved as quads; NULL tangents: it does not. */
static nt_owned write_quads(const bench *b, size_t number, const char *raw, float (**tangents)[4])
{
	char glb[512], ply[512];
	path_of(b, glb, 'q', number, "glb");
	path_of(b, ply, 'q', number, "ply");
	*tangents = NULL;
	if (files_run((const char *const[]){b->nmtan, "-q", "--only=all", "--existing=replace",
			b->files[number], glb, raw, NULL}) < 0 ||
		files_run((const char *const[]){b->nmtan, "-q", "--existing=keep", glb, ply, NULL}) < 0)
		return (nt_owned){0};
	return model_read_ply(ply, tangents);
}

/* Halves of quads that are wound against mikktspace.c's own w for the quad: what is written by default and with --raw,
 * for a baker that solves quads and keeps that w, and for one that has the triangles as they are written by default. */
static void print_quads(const bench *b)
{
	printf("Halves of quads that are wound against mikktspace.c's w for the quad, B per pixel, 16 bits: median, "
		"maximum.\n\n| model | triangles | of the UV area | baked on quads: default | --raw | "
		"baked on triangles: default | --raw |\n"
		"|---|---|---|---|---|---|---|\n");
	for (size_t m = 0; b->files && m < b->model_count; m++) {
		float (*rows[2])[4];
		nt_owned meshes[2] = {write_quads(b, m, "--raw", &rows[0]),
			write_quads(b, m, NULL, &rows[1])};
		if (rows[0] && rows[1] && meshes[0].corner_count == meshes[1].corner_count) {
			shading s[2];
			for (int i = 0; i < 2; i++) {
				s[i] = shading_make(&meshes[i]);
				for (size_t c = 0; c < meshes[i].corner_count; c++) {
					memcpy(s[i].tangents[c], rows[i][meshes[i].indices[c]], 16);
					memcpy(s[i].normals[c], meshes[i].normals[meshes[i].indices[c]], 12);
				}
			}
			const double size = b->models[m].size;
			sign_errors errors[2][2]; /* baker: of quads, of triangles; written by default, with --raw */
			for (int i = 0; i < 4; i++)
				errors[i / 2][i % 2] =
					round_trip_signs(&meshes[0], size, &s[0], &s[i / 2], &s[1 - i % 2]);
			const sign_errors *of = errors[0];
			if (of->triangles)
				printf("| %s | %zu | %.2g %% | %.2g, %.2g | %.2g, %.2g | %.2g, %.2g | %.2g, %.2g |\n",
					b->models[m].name, of->triangles, 100 * of->uv_share, of[0].pool.median,
					of[0].pool.worst, of[1].pool.median, of[1].pool.worst, of[2].pool.median,
					of[2].pool.worst, of[3].pool.median, of[3].pool.worst);
			shading_free(&s[0]);
			shading_free(&s[1]);
		}
		for (int i = 0; i < 2; i++) {
			if (rows[i])
				nt_owned_free(&meshes[i]);
			free(rows[i]);
		}
	}
	printf("\n");
}

/* The programs that a user chooses between, calls and runs each in a panel of their own: what has a label. */
static void note_marks(const bench *b)
{
	FILE *f = measure_open(b->folder, "marks.tsv", "w");
	for (const row *r = b->rows; f && r < b->rows + b->row_count; r++)
		if (r->present && r->label[0])
			fprintf(f, "%d\t%s\t%.17g\t%.17g\t%.17g\n", r->kind >= RUN_TOOL, r->label, fastest(r),
				r->bits16.median, r->bits16.high);
	if (f)
		fclose(f);
}

static void judge(bench *b)
{
	static round_trip trips[MODEL_MOST];
	list_calls(b);
	list_runs(b);
	list_others(b);
	time_calls(b);
	time_runs(b);
	size_t own = 0, points = 0, all = 0;
	for (size_t m = 0; m < b->model_count; m++) {
		trips[m] = round_trip_make(&b->models[m]);
		own += trips[m].own_groups;
		points += trips[m].pooled * POINTS;
		all += trips[m].count * POINTS;
	}
	for (row *r = b->rows; r < b->rows + b->row_count; r++) {
		judge_row(b, r, trips);
		if (r->nasty && r->kind >= RUN_TOOL)
			count_files(b, r);
		else if (r->nasty)
			count_calls(b, r);
	}
	for (row *r = b->rows; r < b->rows + b->row_count; r++) {
		r->front_median = r->present && on_front(b, r, false);
		r->front_high = r->present && on_front(b, r, true);
	}
	print_machine(b);
	printf("Degrees at %zu points, the maximum at %zu; of %zu corners around them the baker has MikkTSpace's "
		"own frame at %zu. Nasty: %zu meshes with %zu corners. *: on a front.\n\n", points, all,
		3 * (points / POINTS), own, b->nasty_count, b->nasty_corners);
	print_rows(b);
	print_conventions(b);
	print_lengyel(b);
	print_quads(b);
	note_marks(b);
	for (size_t m = 0; m < b->model_count; m++)
		round_trip_free(&trips[m]);
}

int main(int argc, char **argv)
{
	static bench b;
	const bool exports = argc > 2 && strcmp(argv[1], "export") == 0;
	if (!exports && !(argc > 3 && strcmp(argv[1], "judge") == 0)) {
		fprintf(stderr, "usage: pareto export FOLDER FILE... | pareto judge FOLDER NMTAN FILE...\n");
		return 2;
	}
	if (!image_check())
		return 1;
	const int first = exports ? 3 : 4;
	b.folder = argv[2];
	b.files = argc > first ? argv + first : NULL;
	const char *rounds = getenv("ROUNDS");
	b.call_rounds = rounds ? atoi(rounds) : CALL_ROUNDS;
	b.run_rounds = rounds ? atoi(rounds) : RUN_ROUNDS;
	b.model_count = models_make(argv + first, (size_t)(argc - first), b.models);
	b.nasty_count = nasty_make(b.nasty);
	for (size_t i = 0; i < b.nasty_count; i++)
		b.nasty_corners += b.nasty[i].corner_count;
	if (exports)
		export_meshes(&b);
	b.nmtan = argv[3];
	if (!exports)
		judge(&b);
	models_free(b.models, b.model_count);
	for (size_t i = 0; i < b.nasty_count; i++)
		nt_owned_free(&b.nasty[i]);
	return 0;
}
