/* SPDX-License-Identifier: MIT */
/*
 * run_fast GOLDENS COUNT: the fast path against the goldens and, on COUNT nasty meshes, against the definition,
 * without a test library, for processors that are emulated.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "golden.h"
#include "nasty.h"
#include "api/tangents.h"

static size_t passed, failed;

/* Floats with different bits that are not both NaN. */
static size_t count_differences(const float *a, const float *b, size_t count)
{
	size_t differences = 0;
	for (size_t i = 0; i < count; i++)
		differences += memcmp(&a[i], &b[i], sizeof *a) != 0 && !(isnan(a[i]) && isnan(b[i]));
	return differences;
}

static void solve(const nmtan_mesh *mesh, bool scalar, float *tangents)
{
	const nmtan_options options = {.struct_bytes = sizeof options, .repair = NMTAN_REPAIR_OFF,
		.threads = 1};
	const nt_implementation implementation = {.scalar = scalar};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents};
	if (nt_tangents(mesh, &options, &implementation, &output, NULL)) {
		printf("solving failed\n");
		exit(1);
	}
}

static void judge(const char *name, size_t differences)
{
	passed += differences == 0;
	failed += differences != 0;
	if (differences)
		printf("%s: %zu floats differ\n", name, differences);
}

static void check_golden(const char *path, const nt_golden *golden, void *context)
{
	(void)context;
	const nmtan_mesh mesh = nt_golden_mesh(golden);
	float *tangents = malloc(16 * (size_t)golden->corner_count);
	solve(&mesh, false, tangents);
	judge(path, count_differences(tangents, golden->tangents, 4 * (size_t)golden->corner_count));
	free(tangents);
}

static void check_nasty(unsigned seed)
{
	char name[32];
	nt_nasty nasty;
	nt_nasty_make(seed, &nasty);
	float *fast = malloc(16 * nasty.corner_count + 1), *scalar = malloc(16 * nasty.corner_count + 1);
	solve(&nasty.mesh, false, fast);
	solve(&nasty.mesh, true, scalar);
	snprintf(name, sizeof name, "seed %u", seed);
	judge(name, count_differences(fast, scalar, 4 * nasty.corner_count));
	free(fast);
	free(scalar);
	nt_nasty_free(&nasty);
}

int main(int count, char **arguments)
{
	if (count != 3 || nt_golden_each(arguments[1], check_golden, NULL) == 0)
		return 1;
	const unsigned seeds = (unsigned)strtoul(arguments[2], NULL, 10);
	for (unsigned seed = 0; seed < seeds; seed++)
		check_nasty(seed);
	printf("%zu passed, %zu failed\n", passed, failed);
	return failed != 0;
}
