/* SPDX-License-Identifier: MIT */
/*
 * core [FILE...]: how many million triangles a second the core does: on real meshes, which models.sh has made, beside
 * the native peers of the folder $PEERS (core_real.c), then on each family of meshes, as tables in
 * Markdown. Runs of all columns are interleaved, so that a busy machine hurts all of them; the best counts.
 * Repair is on, output and workspace are warm. The last column is what one thread takes besides the output, in
 * bytes a triangle. One thread is timed by the processor's clock for the thread, more by the wall's.
 *
 * The scalar definition is there to be compared, takes some 20 times as long, and on hubs its time grows
 * with the square of their size. Its column is measured once, on smaller meshes of the family.
 */
#include "core_real.h"
#include "families.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/cpu.h"
#include "base/parallel.h"
#include "base/scratch.h"
#include "measure.h"
#include "api/tangents.h"

enum { RUNS = 3, MOST_COLUMNS = 16, SMALL_COUNT = 2000 };

/* Triangles for the definition. */
enum { DEFINITION_SIZE = 100000, DEFINITION_HUB = 2000 };

typedef struct column {
	const char *name;
	nmtan_method method;
	nt_implementation implementation;
	unsigned threads;
	int runs;
} column;

static void print_machine(void)
{
	static const char *const sets[] = {"", "baseline", "AVX2", "AVX-512"};
	printf("processor: %s\n", measure_processor());
	printf("compiler %s, best instruction set %s, %u processors\n\n", __VERSION__, sets[nt_cpu_best()],
		nt_thread_count(0));
}

/* Meshes that a row of the table is timed on: one mesh, or many small ones in turn. */
typedef struct workload {
	nt_owned *meshes; /* [count] */
	size_t count, triangles, most_corners;
} workload;

static workload make_workload(nt_family family, size_t count, size_t triangles)
{
	workload w = {.meshes = measure_room(count, sizeof *w.meshes), .count = count};
	for (size_t i = 0; i < count; i++) {
		w.meshes[i] = nt_family_make(family, triangles);
		w.triangles += w.meshes[i].mesh.face_count * (w.meshes[i].face_sizes ? 2 : 1);
		if (w.meshes[i].corner_count > w.most_corners)
			w.most_corners = w.meshes[i].corner_count;
	}
	return w;
}

static void free_workload(workload *w)
{
	for (size_t i = 0; i < w->count; i++)
		nt_owned_free(&w->meshes[i]);
	free(w->meshes);
}

/* Seconds for solving every mesh once; what is small is repeated until it takes a while. */
static double time_run(const column *c, const workload *w, const nmtan_output *output, nmtan_workspace *workspace)
{
	const nmtan_options options = {.struct_bytes = sizeof options, .method = c->method,
		.threads = c->threads,
		.workspace = workspace};
	const size_t repeat = !c->implementation.scalar && w->triangles < 100000 ? 400000 / w->triangles : 1;
	double (*clock)(void) = c->threads == 1 ? measure_thread_seconds : measure_seconds;
	const double begin = clock();
	for (size_t i = 0; i < repeat * w->count; i++)
		if (nt_tangents(&w->meshes[i % w->count].mesh, &options, &c->implementation, output, NULL)) {
			fprintf(stderr, "core: solving failed\n");
			exit(1);
		}
	return (clock() - begin) / (double)repeat;
}

/* Bytes for each triangle that one thread takes besides the output; 0 for many meshes, which share a block. */
static double scratch_bytes(const workload *w, const nmtan_output *output)
{
	nmtan_workspace *workspace = nmtan_workspace_create(NULL);
	const nmtan_options options = {.struct_bytes = sizeof options, .threads = 1, .workspace = workspace};
	if (!workspace || nmtan_tangents(&w->meshes[0].mesh, &options, output, NULL))
		exit(1);
	const double bytes = (double)nt_scratch_bytes(&workspace->scratch);
	nmtan_workspace_destroy(workspace);
	return w->count == 1 ? bytes / (double)w->triangles : 0;
}

/* One row of the table; `smaller` is what the definition gets. */
static void time_row(const char *name, const workload *w, const workload *smaller, const column *columns,
	size_t count)
{
	double times[MOST_COLUMNS][RUNS];
	const size_t corners = w->most_corners > smaller->most_corners ? w->most_corners : smaller->most_corners;
	const nmtan_output output = {.struct_bytes = sizeof output,
		.tangents = calloc(corners, 4 * sizeof(float))};
	nmtan_workspace *workspace = nmtan_workspace_create(NULL);
	if (!output.tangents || !workspace)
		exit(1);
	for (int run = 0; run < RUNS; run++)
		for (size_t c = 0; c < count; c++)
			if (run < columns[c].runs)
				times[c][run] = time_run(&columns[c],
					columns[c].implementation.scalar ? smaller : w, &output, workspace);
	printf("| %s, %zu |", name, w->triangles);
	for (size_t c = 0; c < count; c++) {
		qsort(times[c], (size_t)columns[c].runs, sizeof(double), measure_compare);
		const double triangles = (double)(columns[c].implementation.scalar ? smaller : w)->triangles;
		printf(" %.2f |", 1e-6 * triangles / times[c][0]);
	}
	const double bytes = scratch_bytes(w, &output);
	if (bytes > 0)
		printf(" %.1f |\n", bytes);
	else
		printf(" – |\n");
	fflush(stdout);
	nmtan_workspace_destroy(workspace);
	free(output.tangents);
}

static size_t list_columns(column columns[MOST_COLUMNS])
{
	static const char *const sets[] = {"", "baseline", "AVX2", "AVX-512"};
	size_t n = 0;
	columns[n++] = (column){"definition", NMTAN_METHOD_MIKKTSPACE, {.scalar = true}, 1, 1};
	for (nt_isa isa = NT_ISA_BASELINE; isa <= NT_ISA_AVX512; isa++)
		if (nt_cpu_has(isa))
			columns[n++] = (column){sets[isa], NMTAN_METHOD_MIKKTSPACE, {.isa = isa}, 1, RUNS};
	columns[n++] = (column){"all threads", NMTAN_METHOD_MIKKTSPACE, {.isa = NT_ISA_AUTO},
		nt_thread_count(0), RUNS};
	columns[n++] = (column){"area", NMTAN_METHOD_AREA, {.isa = NT_ISA_AUTO}, 1, RUNS};
	columns[n++] = (column){"lengyel", NMTAN_METHOD_LENGYEL, {.isa = NT_ISA_AUTO}, 1, RUNS};
	columns[n++] = (column){"robust", NMTAN_METHOD_ROBUST, {.isa = NT_ISA_AUTO}, 1, RUNS};
	return n;
}

int main(int argument_count, char **arguments)
{
	static const size_t sizes[NT_FAMILY_COUNT] = {1000000, 2000000, 2000000, 1000000, 2000000, 1000000, 1000000,
		1000000, 1000000, 1000000};
	static const struct {
		const char *name;
		nt_family family;
		size_t count, triangles;
	} small[] = {
		{"one mesh", NT_FAMILY_CLEAN, 1, 20000},
		{"one mesh", NT_FAMILY_CLEAN, 1, 2000},
		{"2000 meshes of 200", NT_FAMILY_CLEAN, SMALL_COUNT, 200},
		{"2000 noisy ones of 200", NT_FAMILY_NOISE, SMALL_COUNT, 200},
		{"2000 meshes of 100", NT_FAMILY_CLEAN, SMALL_COUNT, 100},
		{"2000 meshes of 50", NT_FAMILY_CLEAN, SMALL_COUNT, 50},
		{"2000 meshes of 20", NT_FAMILY_CLEAN, SMALL_COUNT, 20},
		{"2000 noisy ones of 20", NT_FAMILY_NOISE, SMALL_COUNT, 20},
	};
	column columns[MOST_COLUMNS];
	const size_t n = list_columns(columns);

	print_machine();
	core_real_table(arguments + 1, (size_t)argument_count - 1, getenv("PEERS"));
	printf("Families of meshes, million triangles a second, best of %d interleaved runs; the definition on "
		"%d triangles (hubs: %d)\n\n| mesh, triangles |", RUNS, DEFINITION_SIZE, DEFINITION_HUB);
	for (size_t c = 0; c < n; c++)
		printf(" %s |", columns[c].name);
	printf(" bytes |\n|---|");
	for (size_t c = 0; c <= n; c++)
		printf("---|");
	printf("\n");
	for (size_t i = 0; i < NT_FAMILY_COUNT; i++) {
		workload w = make_workload((nt_family)i, 1, sizes[i]);
		workload smaller =
			make_workload((nt_family)i, 1, i == NT_FAMILY_HUB ? DEFINITION_HUB : DEFINITION_SIZE);
		time_row(nt_family_names[i], &w, &smaller, columns, n);
		free_workload(&w);
		free_workload(&smaller);
	}
	for (size_t i = 0; i < sizeof small / sizeof *small; i++) {
		workload w = make_workload(small[i].family, small[i].count, small[i].triangles);
		time_row(small[i].name, &w, &w, columns, n);
		free_workload(&w);
	}
	return 0;
}
