/* SPDX-License-Identifier: MIT */
/*
 * The choice of an implementation, which users do not have. That all give the same bytes is tested where
 * they are: test_fast.c, test_sums.c, test_usable.c.
 */
#include "api/tangents.h"
#include "test.h"
#include <limits.h>
#include <stdlib.h>
#include <sys/resource.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define MALLOC_IS_OTHER 1
#else
#define MALLOC_IS_OTHER 0
#endif

static const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
static const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
static const float texcoords[3][2] = {{0, 0}, {1, 0}, {0, 1}};

static nmtan_status solve(nt_isa isa)
{
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
		.positions = &positions[0][0],
		.normals = &normals[0][0], .texcoords = &texcoords[0][0]};
	float tangents[3][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	const nt_implementation implementation = {.isa = isa};
	return nt_tangents(&mesh, NULL, &implementation, &output, NULL);
}

static void instruction_set_that_the_processor_lacks_is_an_argument_error(void **state)
{
	(void)state;
	for (int isa = NT_ISA_AUTO; isa <= NT_ISA_AVX512 + 1; isa++)
		assert_int_equal(solve((nt_isa)isa), nt_cpu_has((nt_isa)isa) ? NMTAN_OK : NMTAN_ERROR_ARGUMENT);
	assert_int_equal(solve((nt_isa)9), NMTAN_ERROR_ARGUMENT);
}

static long minor_faults(void)
{
	struct rusage usage;
	getrusage(RUSAGE_SELF, &usage);
	return usage.ru_minflt;
}

/* Calls without a workspace: malloc keeps what one call gave back for the next, since it is nearly all in one block. A
 * strip, mirrored at each column. */
static void a_second_call_has_no_fresh_pages(void **state)
{
	(void)state;
	enum { MOST = 30000 };
	float *rows = calloc(MOST + 2, 8 * sizeof *rows), *tangents = malloc((size_t)MOST * 48);
	uint32_t *corners = malloc((size_t)MOST * 12);
	for (uint32_t i = 0; i < MOST + 2; i++)
		memcpy(rows + 8 * i,
			(float[8]){(float)(i / 2), (float)(i % 2), 0, 0, 0, 1, (float)(i / 2 % 2), (float)(i % 2)}, 32);
	for (uint32_t i = 0; i < MOST; i++)
		memcpy(corners + 3 * i, (uint32_t[3]){i, i % 2 ? i + 2 : i + 1, i % 2 ? i + 1 : i + 2}, 12);
	for (size_t triangles = 500; triangles <= MOST; triangles = triangles * 3 / 2) {
		const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = triangles,
			.vertex_count = triangles + 2,
			.indices = corners, .positions = rows, .position_stride_bytes = 32, .normals = rows + 3,
			.normal_stride_bytes = 32,
			.texcoords = rows + 6, .texcoord_stride_bytes = 32};
		const nmtan_options options = {.struct_bytes = sizeof options, .threads = 1};
		const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents};
		/* the kernel may take pages away to see who uses them, or needs them itself: not each time */
		long fewest = LONG_MAX;
		for (int try = 0; try < 10 && fewest >= 32; try++) {
			long before = 0;
			for (int call = 0; call < 6; call++) {
				before = call == 2 ? minor_faults() : before;
				assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
			}
			fewest = minor_faults() - before < fewest ? minor_faults() - before : fewest;
		}
		assert_true(MALLOC_IS_OTHER || fewest < 32);
	}
	free(rows);
	free(tangents);
	free(corners);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_second_call_has_no_fresh_pages),
		cmocka_unit_test(instruction_set_that_the_processor_lacks_is_an_argument_error)};
	return cmocka_run_group_tests_name("api/tangents", tests, NULL, NULL);
}
