/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "budget.h"
#include "topology/corners.h"

/* Rows of position, normal, texture coordinates; corner c is vertex c. */
static void weld(const float (*rows)[8], size_t count, uint32_t *ids, size_t *welded)
{
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = count / 3, .vertex_count = count,
		.positions = rows[0], .position_stride_bytes = 32, .normals = rows[0] + 3,
		.normal_stride_bytes = 32, .texcoords = rows[0] + 6, .texcoord_stride_bytes = 32};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	assert_int_equal(nt_weld_corners(&mesh, count, &scratch, ids, welded), NMTAN_OK);
	nt_scratch_free(&scratch);
}

static void equal_rows_are_one_and_zero_signs_do_not_matter(void **state)
{
	(void)state;
	const float rows[6][8] = {{0, 1, 2, 0, 0, 1, 5, 6}, {-0.0f, 1, 2, 0, -0.0f, 1, 5, 6},
		{0, 1, 2, 0, 0, 1, 5, 7}, {0, 1, 2, 0, 0, 1, 5, 6}, {0, 1, 2, 1, 0, 0, 5, 6},
		{3, 1, 2, 0, 0, 1, 5, 6}};
	uint32_t ids[6];
	size_t welded;
	weld(rows, 6, ids, &welded);
	const uint32_t expected[6] = {0, 0, 1, 0, 2, 3};
	assert_memory_equal(ids, expected, sizeof ids);
	assert_int_equal(welded, 4);
}

static void nan_equals_nothing(void **state)
{
	(void)state;
	const float rows[3][8] = {{NAN, 0}, {NAN, 0}, {0, NAN}};
	uint32_t ids[3];
	size_t welded;
	weld(rows, 3, ids, &welded);
	assert_int_equal(welded, 3);
}

/* An indexed mesh welds its vertices, but a NaN vertex stays apart at each corner. */
static void indexed_corners_take_their_vertex(void **state)
{
	(void)state;
	const float rows[3][8] = {{1}, {2}, {NAN}};
	const uint32_t indices[6] = {0, 1, 2, 1, 0, 2};
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2, .vertex_count = 3,
		.indices = indices,
		.positions = rows[0], .position_stride_bytes = 32, .normals = rows[0] + 3,
		.normal_stride_bytes = 32, .texcoords = rows[0] + 6, .texcoord_stride_bytes = 32};
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	uint32_t ids[6];
	size_t welded;
	assert_int_equal(nt_weld_corners(&mesh, 6, &scratch, ids, &welded), NMTAN_OK);
	const uint32_t expected[6] = {0, 1, 2, 1, 0, 3};
	assert_memory_equal(ids, expected, sizeof ids);
	nt_scratch_free(&scratch);
}

/* The weld of rows as it is, and with ever fewer allocations. */
static void weld_or_fail(const float (*rows)[8], size_t count, uint32_t *ids, size_t *welded)
{
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = count / 3, .vertex_count = count,
		.positions = rows[0], .position_stride_bytes = 32, .normals = rows[0] + 3,
		.normal_stride_bytes = 32, .texcoords = rows[0] + 6, .texcoord_stride_bytes = 32};
	nmtan_status status = NMTAN_ERROR_MEMORY;
	for (size_t allowed = 0; status; allowed++) {
		budget b = {allowed};
		nt_scratch scratch;
		nt_scratch_init(&scratch, &(nmtan_allocator){take_budget, give_back, &b});
		status = nt_weld_corners(&mesh, count, &scratch, ids, welded);
		assert_true(status == NMTAN_OK || status == NMTAN_ERROR_MEMORY);
		assert_true(status == NMTAN_OK ? allowed > 1 : allowed < 10);
		nt_scratch_free(&scratch);
	}
}

/* Each of so many rows would be compared with all before it: 5 thousand million steps. hash_row() is undone from
 * behind: its last step, hash ^= hash >> 32, undoes itself, and the factor is odd. */
static void rows_of_one_hash_are_numbered_without_it(void **state)
{
	(void)state;
	enum { COUNT = 99999 };
	const uint64_t factor = 0xff51afd7ed558ccdu, wanted = 0x123456789abcdef0u;
	uint64_t inverse = factor; /* to 3 bits; each step doubles them */
	for (int i = 0; i < 5; i++)
		inverse *= 2 - factor * inverse;
	float (*rows)[8] = calloc(COUNT, sizeof *rows);
	uint32_t *ids = malloc(COUNT * sizeof *ids);
	for (uint32_t i = 0, number = 1; i < COUNT; number++) {
		uint64_t hash = 0x9e3779b97f4a7c15u, words[4] = {number, 7, 7};
		for (int k = 0; k < 3; k++) {
			hash = (hash ^ words[k]) * factor;
			hash ^= hash >> 32;
		}
		words[3] = (wanted ^ wanted >> 32) * inverse ^ hash;
		memcpy(rows[i], words, sizeof words);
		i += rows[i][6] == rows[i][6] && rows[i][7] == rows[i][7]; /* no NaN */
	}
	memcpy(rows[COUNT - 1], rows[77], sizeof *rows);
	rows[5][1] = NAN;
	size_t welded;
	weld_or_fail((const float (*)[8])rows, COUNT, ids, &welded);
	for (uint32_t i = 0; i + 1 < COUNT; i++)
		assert_int_equal(ids[i], i);
	assert_int_equal(ids[COUNT - 1], 77);
	assert_int_equal(welded, COUNT - 1);
	free(rows);
	free(ids);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(equal_rows_are_one_and_zero_signs_do_not_matter),
		cmocka_unit_test(nan_equals_nothing),
		cmocka_unit_test(indexed_corners_take_their_vertex),
		cmocka_unit_test(rows_of_one_hash_are_numbered_without_it),
	};
	return cmocka_run_group_tests_name("topology/corners", tests, NULL, NULL);
}
