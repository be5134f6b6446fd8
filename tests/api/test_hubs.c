/* SPDX-License-Identifier: MIT */
/*
 * Quads around one vertex whose halves have opposite directions: up to the bound of nmtan_tangents() the corners there
 * have MikkTSpace's tangents, past it one sum, which counts and faults tell. With repair off there is no bound.
 */
#include "test.h"
#include <stdbool.h>
#include "nmtan.h"

/* (2 * 8192)^2 directions times members are 2^28, and 4 * 8192 corners may have 256 more each, which 300 quads more
 * need not. */
enum { WITHIN = 8192, BEYOND = 8800 };

static float positions[2 * BEYOND + 2][3], normals[2 * BEYOND + 2][3], texcoords[2 * BEYOND + 2][2];
static uint32_t indices[4 * BEYOND], split_indices[4 * BEYOND], sources[4 * BEYOND];
static uint8_t sizes[BEYOND], faults[4 * BEYOND];
static float tangents[4 * BEYOND][4], others[4 * BEYOND][4], split[6 * BEYOND + 2][4];

static nmtan_mesh make_quads(size_t quads)
{
	for (size_t i = 0; i < 2 * BEYOND + 2; i++)
		memcpy(normals[i], (float[3]){0, 0, 1}, sizeof normals[i]);
	for (size_t i = 0; i <= quads; i++) {
		const float side = i % 2 ? -1 : 1, far = 1 + (float)i / 65536;
		const uint32_t end = (uint32_t)(2 * i + 1);
		memcpy(positions[end], (float[3]){far, 0, 0}, sizeof *positions);
		memcpy(texcoords[end], (float[2]){side, 0}, sizeof *texcoords);
		if (i == quads)
			continue;
		memcpy(positions[end + 1], (float[3]){(float)(i % 7), far, 0}, sizeof *positions);
		memcpy(texcoords[end + 1], (float[2]){0, side}, sizeof *texcoords);
		memcpy(&indices[4 * i], (uint32_t[4]){0, end, end + 1, end + 2}, 4 * sizeof *indices);
		sizes[i] = 4;
	}
	return (nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = quads, .vertex_count = 2 * quads + 2,
		.face_sizes = sizes, .indices = indices, .positions = positions[0], .normals = normals[0],
		.texcoords = texcoords[0]};
}

static nmtan_counts solve(size_t quads, nmtan_repair repair, unsigned threads)
{
	const nmtan_mesh mesh = make_quads(quads);
	const nmtan_options options = {.struct_bytes = sizeof options, .repair = repair, .threads = threads};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0], .corner_faults = faults};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, &counts), NMTAN_OK);
	return counts;
}

TEST(up_to_the_bound_nothing_is_summed)
{
	assert_int_equal(solve(WITHIN, NMTAN_REPAIR_ON, 2).summed_instead, 0);
	for (size_t i = 0; i < 4 * WITHIN; i++)
		assert_false(faults[i] & NMTAN_FAULT_SUMMED);
}

TEST(past_it_the_hub_has_one_tangent)
{
	assert_int_equal(solve(BEYOND, NMTAN_REPAIR_ON, 2).summed_instead, BEYOND);
	for (size_t i = 0; i < 4 * BEYOND; i++) {
		assert_int_equal((faults[i] & NMTAN_FAULT_SUMMED) != 0, i % 4 == 0);
		if (i % 4 == 0)
			assert_memory_equal(tangents[i], tangents[0], 3 * sizeof(float));
	}
	memcpy(others, tangents, sizeof others);
	solve(BEYOND, NMTAN_REPAIR_ON, 1);
	assert_memory_equal(others, tangents, sizeof others);
	const nmtan_mesh mesh = make_quads(BEYOND);
	nmtan_split_output output = {.struct_bytes = sizeof output, .indices = split_indices, .sources = sources,
		.source_capacity = 4 * BEYOND, .vertex_tangents = split[0]};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &output, &counts), NMTAN_OK);
	assert_int_equal(counts.summed_instead, BEYOND);
	for (size_t i = 0; i < 4 * BEYOND; i++)
		assert_memory_equal(split[split_indices[i]], tangents[i], sizeof *tangents);
}

TEST(without_repair_there_is_no_bound)
{
	assert_int_equal(solve(BEYOND, NMTAN_REPAIR_OFF, 2).summed_instead, 0);
	for (size_t i = 0; i < 4 * BEYOND; i++)
		assert_int_equal(faults[i], 0);
}
