/* SPDX-License-Identifier: MIT */
/*
 * The choice of an implementation, which users do not have. That all give the same bytes is tested where
 * they are: test_fast.c, test_sums.c, test_usable.c.
 */
#include "api/tangents.h"
#include "test.h"

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

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(instruction_set_that_the_processor_lacks_is_an_argument_error)};
	return cmocka_run_group_tests_name("api/tangents", tests, NULL, NULL);
}
