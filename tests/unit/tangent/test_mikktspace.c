/* SPDX-License-Identifier: MIT */
/*
 * The definition against the reference: data/golden holds what mikktspace.c gives, as published and with its sort of
 * edges completed.
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

typedef struct comparison {
	nmtan_method method;
	bool other;                /* the files are of the other dialect */
	size_t differences, files; /* files: that differ */
} comparison;

static void compare_file(const char *path, const nt_golden *golden, void *context)
{
	comparison *c = context;
	const nmtan_mesh mesh = nt_golden_mesh(golden);
	const nmtan_options options = {.struct_bytes = sizeof options, .method = c->method, .repair = NMTAN_REPAIR_OFF};
	const nt_implementation scalar = {.scalar = true};
	const nmtan_output output = {.struct_bytes = sizeof output,
		.tangents = malloc(16 * (size_t)golden->corner_count)};
	assert_int_equal(nt_tangents(&mesh, &options, &scalar, &output, NULL), NMTAN_OK);
	const size_t differences =
		count_differences(output.tangents, golden->tangents, 4 * (size_t)golden->corner_count);
	if (differences && !c->other)
		print_error("%s, method %d: %zu of %u floats differ\n", path, (int)c->method, differences,
			4 * golden->corner_count);
	c->differences += differences;
	c->files += differences > 0;
	free(output.tangents);
}

TEST(goldens_are_byte_identical)
{
	for (int i = 0; i < 2; i++) {
		comparison c = {i ? NMTAN_METHOD_MIKKTSPACE_SORTED : NMTAN_METHOD_MIKKTSPACE, false, 0, 0};
		assert_int_equal(nt_golden_each(NT_DATA_DIR "/golden", compare_file, &c), 46);
		assert_int_equal(c.differences, 0);
	}
}

TEST(each_dialect_has_its_bytes)
{
	enum { FILES = 18 };
	static const char *const folders[] = {NT_DATA_DIR "/golden/edge_sort/published",
		NT_DATA_DIR "/golden/edge_sort/sorted"};
	for (int i = 0; i < 2; i++)
		for (int m = 0; m < 2; m++) {
			comparison c = {m ? NMTAN_METHOD_MIKKTSPACE_SORTED : NMTAN_METHOD_MIKKTSPACE, i != m, 0, 0};
			assert_int_equal(nt_golden_each(folders[i], compare_file, &c), FILES);
			assert_int_equal(c.files, i == m ? 0 : FILES);
		}
}

/* A position that is not finite, of a corner or of no corner, by the definition and the fast path. */
TEST(limits_are_counted)
{
	float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {NAN, 0, 0}}, tangents[3][4];
	const float normals[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	const float texcoords[4][2] = {{0, 0}, {1, 0}, {0, 1}, {0, 0}};
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 4,
		.positions = positions[0], .normals = normals[0], .texcoords = texcoords[0]};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0]};
	for (int of_corner = 0; of_corner < 2; of_corner++) {
		positions[2][1] = of_corner ? INFINITY : 1;
		for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++)
			for (int scalar = 0; scalar < 2; scalar++) {
				const nmtan_options options = {.struct_bytes = sizeof options,
					.method = (nmtan_method)method};
				const nt_implementation implementation = {.scalar = scalar};
				nmtan_counts counts = NMTAN_COUNTS_INIT;
				assert_int_equal(nt_tangents(&mesh, &options, &implementation, &output, &counts),
					NMTAN_OK);
				assert_int_equal(counts.sorted_instead,
					of_corner && method == NMTAN_METHOD_MIKKTSPACE);
			}
	}
}
