/* SPDX-License-Identifier: MIT */
/*
 * The definition against the reference: data/golden holds what mikktspace.c gives.
 */
#include "test.h"
#include <math.h>
#include <stdio.h>
#include "api/tangents.h"
#include "golden.h"

/* Floats with equal bits, or both NaN. */
static size_t count_differences(const float *a, const float *b, size_t count)
{
	size_t differences = 0;
	for (size_t i = 0; i < count; i++)
		differences += memcmp(&a[i], &b[i], sizeof *a) != 0 && !(isnan(a[i]) && isnan(b[i]));
	return differences;
}

static void compare_file(const char *path, const nt_golden *golden, void *context)
{
	size_t *total = context;
	const nmtan_mesh mesh = nt_golden_mesh(golden);
	const nmtan_options options = {.struct_bytes = sizeof options, .repair = NMTAN_REPAIR_OFF};
	const nt_implementation scalar = {.scalar = true};
	const nmtan_output output = {.struct_bytes = sizeof output,
		.tangents = malloc(16 * (size_t)golden->corner_count)};
	assert_int_equal(nt_tangents(&mesh, &options, &scalar, &output, NULL), NMTAN_OK);
	const size_t differences =
		count_differences(output.tangents, golden->tangents, 4 * (size_t)golden->corner_count);
	if (differences)
		print_error("%s: %zu of %u floats differ\n", path, differences, 4 * golden->corner_count);
	*total += differences;
	free(output.tangents);
}

static void goldens_are_byte_identical(void **state)
{
	(void)state;
	size_t differences = 0;
	assert_int_equal(nt_golden_each(NT_DATA_DIR "/golden", compare_file, &differences), 46);
	assert_int_equal(differences, 0);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(goldens_are_byte_identical),
	};
	return cmocka_run_group_tests_name("tangent/mikktspace", tests, NULL, NULL);
}
