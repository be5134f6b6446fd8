/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <math.h>
#include "budget.h"
#include "topology/split.h"

/* A fan of n triangles around vertex 0; the hub's corner in triangle t has the tangent given by it. */
static void split_hub(size_t n, const float (*hub_tangents)[4], uint32_t *hub_indices,
	size_t *source_count)
{
	uint32_t *indices = malloc(12 * n), *out = malloc(12 * n), *sources = malloc(12 * n);
	float (*tangents)[4] = calloc(3 * n, sizeof *tangents);
	for (uint32_t t = 0; t < n; t++) {
		const uint32_t corners[3] = {0, t + 1, t + 2};
		memcpy(indices + 3 * t, corners, sizeof corners);
		memcpy(tangents[3 * t], hub_tangents[t], 16);
	}
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = n, .vertex_count = n + 2,
		.indices = indices};
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = out, .sources = sources,
		.source_capacity = 3 * n};
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], NULL, &split), NMTAN_OK);
	for (size_t t = 0; t < n; t++)
		hub_indices[t] = out[3 * t];
	for (size_t i = 0; i < split.source_count; i++)
		assert_int_equal(sources[i], 0);
	*source_count = split.source_count;
	free(indices);
	free(out);
	free(sources);
	free(tangents);
}

TEST(first_tangent_keeps_the_vertex_and_copies_follow_in_order)
{
	const float a[4] = {1, 0, 0, 1}, b[4] = {1, 0, 0, -1}, c[4] = {0, 1, 0, 1};
	float tangents[6][4];
	const float *order[6] = {b, a, b, c, a, c};
	for (int i = 0; i < 6; i++)
		memcpy(tangents[i], order[i], 16);
	uint32_t hub[6];
	size_t copies;
	split_hub(6, tangents, hub, &copies);
	const uint32_t expected[6] = {0, 8, 0, 9, 8, 9}; /* 8 vertices: copies are 8 and 9 */
	assert_memory_equal(hub, expected, sizeof hub);
	assert_int_equal(copies, 2);
}

TEST(signs_of_zeros_and_nans_do_not_split)
{
	const float tangents[4][4] = {{0.0f, 1, 0, 1}, {-0.0f, 1, 0, 1}, {NAN, 1, 0, 1}, {-NAN, 1, 0, 1}};
	uint32_t hub[4];
	size_t copies;
	split_hub(4, tangents, hub, &copies);
	const uint32_t expected[4] = {0, 0, 6, 6};
	assert_memory_equal(hub, expected, sizeof hub);
	assert_int_equal(copies, 1);
}

/* 200 000 different tangents at one vertex: quadratic search would take minutes. */
TEST(hub_of_many_tangents_is_linear)
{
	enum { COUNT = 200000 };
	float (*tangents)[4] = malloc(COUNT * sizeof *tangents);
	uint32_t *hub = malloc(COUNT * sizeof *hub);
	for (uint32_t i = 0; i < COUNT; i++)
		memcpy(tangents[i], (float[4]){(float)i, 0, 0, 1}, 16);
	size_t copies;
	split_hub(COUNT, (const float (*)[4])tangents, hub, &copies);
	assert_int_equal(copies, COUNT - 1);
	for (uint32_t i = 1; i < COUNT; i++)
		assert_int_equal(hub[i], COUNT + 2 + i - 1);
	free(tangents);
	free(hub);
}

/* Gives each corner its tangent, of `count` that come again and again. */
static nmtan_status split_corners(nt_splitter *s, const float (*tangents)[4], size_t count, const nmtan_mesh *mesh,
	nmtan_split_output *output, nt_scratch *scratch)
{
	nmtan_status status = nt_splitter_begin(s, mesh, 3 * mesh->face_count, output, scratch);
	for (size_t c = 0; !status && c < 3 * mesh->face_count; c++)
		status = nt_splitter_take(s, 0, tangents[c % count], c);
	if (!status)
		nt_splitter_end(s);
	return status;
}

/* Tangents that would have one hash if a word of the key were 0 spread over the table: otherwise all would stand in one
 * run of slots, and each be compared with those before it. */
TEST(tangents_of_one_hash_spread)
{
	enum { KINDS = 20001 };
	float (*tangents)[4] = calloc(KINDS, sizeof *tangents);
	for (uint32_t i = 0; i < KINDS; i++)
		tangents[i][0] = (float)i;
	uint32_t *indices = calloc(KINDS, sizeof *indices), *out = malloc(KINDS * sizeof *out);
	uint32_t *sources = malloc(KINDS * sizeof *sources);
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = KINDS / 3, .vertex_count = 1,
		.indices = indices};
	nmtan_split_output output = {.struct_bytes = sizeof output, .indices = out, .sources = sources,
		.source_capacity = KINDS};
	nt_scratch scratch;
	nt_splitter s;
	nmtan_status status = NMTAN_ERROR_MEMORY;
	for (size_t allowed = 0; status; allowed++) { /* and with fewer allocations than that takes */
		nt_scratch_init(&scratch, &(nmtan_allocator){take_budget, give_back, &(budget){allowed}});
		status = split_corners(&s, (const float (*)[4])tangents, KINDS, &mesh, &output, &scratch);
		assert_true(status == NMTAN_OK ? allowed > 1 : status == NMTAN_ERROR_MEMORY && allowed < 40);
		if (status)
			nt_scratch_free(&scratch);
	}
	size_t run = 0;
	for (size_t at = 0; at < s.table_size; at++) {
		run = s.table[at] == UINT32_MAX ? 0 : run + 1;
		assert_in_range(run, 0, KINDS / 10);
	}
	assert_int_equal(output.source_count, KINDS - 1);
	for (uint32_t c = 0; c < KINDS; c++)
		assert_int_equal(out[c], c);
	nt_scratch_free(&scratch);
	free(tangents);
	free(indices);
	free(out);
	free(sources);
}

TEST(unused_vertices_get_a_unit_tangent)
{
	const uint32_t indices[3] = {0, 1, 2};
	const float normals[5][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}};
	const float tangents[3][4] = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
	float vertex_tangents[8][4];
	uint32_t out[3], sources[3];
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 5,
		.indices = indices,
		.normals = &normals[0][0]};
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = out, .sources = sources,
		.source_capacity = 3,
		.vertex_tangents = &vertex_tangents[0][0]};
	assert_int_equal(nmtan_split(&mesh, &tangents[0][0], NULL, &split), NMTAN_OK);
	const float *t = vertex_tangents[3];
	assert_true(t[0] == 0.0f && fabsf(t[1] * t[1] + t[2] * t[2] - 1.0f) < 1e-6f && t[3] == 1.0f);
	assert_true(vertex_tangents[4][0] == 1.0f && vertex_tangents[4][3] == 1.0f);
}
