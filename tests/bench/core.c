/* SPDX-License-Identifier: MIT */
/*
 * core [FOLDER]: how many million triangles a second the core does on each family of meshes, as a table for
 * people. Runs of all columns are interleaved, so that a busy machine hurts all of them; best and median.
 * Output and workspace are warm. One thread is timed by the processor's clock for the thread, more by the wall's.
 *
 * With FOLDER the meshes are also written there as FOLDER/NAME.mesh, for the peers that run_core.sh knows.
 */
#include "families.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include "base/cpu.h"
#include "base/parallel.h"

enum { RUNS = 3, SMALL_SIZES = 3 };

typedef struct column {
	const char *name;
	nmtan_method method;
	nmtan_path path;
	nmtan_isa isa;
	unsigned threads;
	int runs;
} column;

static double seconds(clockid_t clock)
{
	struct timespec t;
	clock_gettime(clock, &t);
	return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int compare_doubles(const void *a, const void *b)
{
	const double x = *(const double *)a, y = *(const double *)b;
	return (x > y) - (x < y);
}

static void print_machine(void)
{
	char line[256] = "unknown processor\n";
	FILE *info = fopen("/proc/cpuinfo", "r");
	while (info && fgets(line, sizeof line, info))
		if (strncmp(line, "model name", 10) == 0)
			break;
	if (info)
		fclose(info);
	const char *name = strchr(line, ':');
	static const char *const sets[] = {"", "baseline", "AVX2", "AVX-512"};
	printf("processor%s", name ? name : line);
	printf("compiler %s, best instruction set %s, %u processors\n\n", __VERSION__, sets[nt_cpu_best()],
		nt_thread_count(0));
}

/* Seconds for one solve; small meshes are repeated until it takes a while. */
static double time_run(const column *c, const nt_family_mesh *m, nmtan_output *output, nmtan_workspace *workspace)
{
	const nmtan_options options = {.method = c->method, .repair = NMTAN_REPAIR_OFF, .threads = c->threads,
		.path = c->path, .isa = c->isa, .workspace = workspace};
	const size_t repeat = m->triangle_count < 100000 ? 400000 / m->triangle_count : 1;
	const clockid_t clock = c->threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC;
	const double begin = seconds(clock);
	for (size_t i = 0; i < repeat; i++)
		if (nmtan_tangents(&m->mesh, &options, output)) {
			fprintf(stderr, "core: solving failed\n");
			exit(1);
		}
	return (seconds(clock) - begin) / (double)repeat;
}

static void time_mesh(const char *name, const nt_family_mesh *m, const column *columns, size_t count)
{
	double times[16][RUNS];
	nmtan_output output = {.tangents = calloc(m->corner_count, 4 * sizeof(float))};
	nmtan_workspace *workspace = nmtan_workspace_create(NULL);
	if (!output.tangents || !workspace)
		exit(1);
	for (int run = 0; run < RUNS; run++)
		for (size_t c = 0; c < count; c++)
			if (run < columns[c].runs)
				times[c][run] = time_run(&columns[c], m, &output, workspace);
	printf("%-20s %8zu", name, m->triangle_count);
	for (size_t c = 0; c < count; c++) {
		qsort(times[c], (size_t)columns[c].runs, sizeof(double), compare_doubles);
		const double million = 1e-6 * (double)m->triangle_count;
		printf(" %6.2f %6.2f", million / times[c][0], million / times[c][columns[c].runs / 2]);
	}
	printf("\n");
	fflush(stdout);
	nmtan_workspace_destroy(workspace);
	free(output.tangents);
}

/* The exchange format of peers.mjs: quads have no place in it. */
static void export_mesh(const char *folder, int family, const nt_family_mesh *m)
{
	char path[1024];
	if (m->face_sizes || !m->indices)
		return;
	snprintf(path, sizeof path, "%s/core%d.mesh", folder, family);
	FILE *f = fopen(path, "wb");
	if (!f)
		return;
	const uint32_t head[2] = {(uint32_t)m->mesh.vertex_count, (uint32_t)m->corner_count};
	fwrite(head, sizeof head, 1, f);
	fwrite(m->positions, 12, m->mesh.vertex_count, f);
	fwrite(m->normals, 12, m->mesh.vertex_count, f);
	fwrite(m->texcoords, 8, m->mesh.vertex_count, f);
	fwrite(m->indices, 4, m->corner_count, f);
	if (fclose(f) != 0)
		fprintf(stderr, "core: cannot write %s\n", path);
	printf("%s is %s\n", path, nt_family_names[family]);
}

int main(int count, char **arguments)
{
	static const size_t sizes[NT_FAMILY_COUNT] = {1000000, 2000000, 2000000, 1000000, 2000000, 1000000, 1000000,
		1000000, 1000000, 1000000};
	static const size_t small[SMALL_SIZES] = {200, 2000, 20000};
	column columns[16] = {{"definition", NMTAN_METHOD_MIKKTSPACE, NMTAN_PATH_SCALAR, NMTAN_ISA_AUTO, 1, 1}};
	static const char *const sets[] = {"", "baseline", "AVX2", "AVX-512"};
	size_t n = 1;
	for (nmtan_isa isa = NMTAN_ISA_BASELINE; isa <= NMTAN_ISA_AVX512; isa++)
		if (nt_cpu_has(isa))
			columns[n++] = (column){sets[isa], NMTAN_METHOD_MIKKTSPACE, NMTAN_PATH_FAST, isa, 1, RUNS};
	columns[n++] = (column){"all threads", NMTAN_METHOD_MIKKTSPACE, NMTAN_PATH_FAST, NMTAN_ISA_AUTO,
		nt_thread_count(0), RUNS};
	columns[n++] = (column){"area", NMTAN_METHOD_AREA, NMTAN_PATH_AUTO, NMTAN_ISA_AUTO, 1, 3};
	columns[n++] = (column){"lengyel", NMTAN_METHOD_LENGYEL, NMTAN_PATH_AUTO, NMTAN_ISA_AUTO, 1, 3};

	print_machine();
	printf("million triangles a second, best and median\n%-29s", "");
	for (size_t c = 0; c < n; c++)
		printf(" %13s", columns[c].name);
	printf("\n");
	for (int i = 0; i < NT_FAMILY_COUNT + SMALL_SIZES; i++) {
		const int family = i < NT_FAMILY_COUNT ? i : NT_FAMILY_CLEAN;
		nt_family_mesh m;
		if (!nt_family_make((nt_family)family, i < NT_FAMILY_COUNT ? sizes[i] : small[i - NT_FAMILY_COUNT], &m))
			return 1;
		if (count > 1 && i < NT_FAMILY_COUNT)
			export_mesh(arguments[1], family, &m);
		time_mesh(i < NT_FAMILY_COUNT ? nt_family_names[family] : "clean, small", &m, columns, n);
		nt_family_free(&m);
	}
	return 0;
}
