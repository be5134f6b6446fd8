/* SPDX-License-Identifier: MIT */
/*
 * nmtan_vertex_tangents(), here with requests, against nmtan_tangents() followed by nmtan_split(), which it promises
 * to equal.
 */
#include "api/tangents.h"
#include "golden.h"
#include "nasty.h"
#include "nmtan.h"
#include "test.h"

typedef struct split {
	nmtan_split_output out;
	nmtan_counts counts;
} split;

static split split_make(const nmtan_mesh *mesh, size_t corners)
{
	const size_t rows = mesh->vertex_count + corners + 1;
	return (split){
		.out = {.struct_bytes = sizeof(nmtan_split_output), .indices = calloc(corners + 1, 4),
			.sources = calloc(corners + 1, 4), .source_capacity = corners,
			.vertex_tangents = calloc(rows, 16)},
		.counts = NMTAN_COUNTS_INIT};
}

static void split_free(split *s)
{
	free(s->out.indices);
	free(s->out.sources);
	free(s->out.vertex_tangents);
}

/* lent: the room for copies is scratch first. */
static void compare_one(const nmtan_mesh *mesh, size_t corners, const nmtan_options *options, bool lent)
{
	split two = split_make(mesh, corners), one = split_make(mesh, corners);
	const nt_vertex_request request = {.lends_copies = lent};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = malloc(16 * corners + 1)};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(mesh, options, &output, &counts), NMTAN_OK);
	assert_int_equal(nmtan_split(mesh, output.tangents, options, &two.out), NMTAN_OK);
	assert_int_equal(nt_vertex_tangents(mesh, options, &request, &one.out, &one.counts), NMTAN_OK);
	assert_int_equal(one.out.source_count, two.out.source_count);
	const size_t vertices = mesh->vertex_count + one.out.source_count;
	assert_memory_equal(one.out.indices, two.out.indices, 4 * corners);
	assert_memory_equal(one.out.sources, two.out.sources, 4 * one.out.source_count);
	assert_memory_equal(&one.counts, &counts, sizeof one.counts);
	for (size_t i = 0; i < 4 * vertices; i++) {
		const float a = one.out.vertex_tangents[i], b = two.out.vertex_tangents[i];
		assert_true(memcmp(&a, &b, 4) == 0 || (a != a && b != b));
	}
	free(output.tangents);
	split_free(&one);
	split_free(&two);
}

static void compare(const nmtan_mesh *mesh, size_t corners, const nmtan_options *options)
{
	compare_one(mesh, corners, options, false);
	compare_one(mesh, corners, options, true);
}

static void compare_golden(const char *path, const nt_golden *golden, void *context)
{
	(void)path;
	(void)context;
	const nmtan_mesh mesh = nt_golden_mesh(golden);
	compare(&mesh, golden->corner_count, NULL);
}

TEST(goldens_split_the_same)
{
	assert_int_equal(nt_golden_each(NT_DATA_DIR "/golden", compare_golden, NULL), 46);
}

TEST(nasty_meshes_split_the_same)
{
	for (uint64_t seed = 0; seed < 3000; seed++) {
		nt_nasty nasty;
		nt_nasty_make(seed, &nasty);
		const nmtan_options options = {.struct_bytes = sizeof options, .threads = 1,
			.repair = seed % 2 ? NMTAN_REPAIR_OFF : NMTAN_REPAIR_ON,
			.method = (nmtan_method)(seed / 2 % 6 % 4)};
		compare(&nasty.mesh, nasty.corner_count, &options);
		nt_nasty_free(&nasty);
	}
}

/* A torus-like grid, closed in u by a seam, mirrored in a strip: clean but for the mirror edges. */
TEST(clean_grid_with_a_mirror_splits_the_same)
{
	enum { N = 64 };
	static float positions[(N + 1) * (N + 1)][3], normals[(N + 1) * (N + 1)][3];
	static float texcoords[(N + 1) * (N + 1)][2];
	static uint32_t indices[6 * N * N];
	size_t c = 0;
	for (uint32_t y = 0; y <= N; y++) {
		for (uint32_t x = 0; x <= N; x++) {
			const uint32_t v = y * (N + 1) + x;
			memcpy(positions[v], (float[3]){(float)x, (float)y, (float)(x * y) / 500}, 12);
			memcpy(normals[v], (float[3]){0, 0, 1}, 12);
			memcpy(texcoords[v], (float[2]){(float)(x < 40 ? x : 80 - x) / N, (float)y / N}, 8);
			if (x < N && y < N) {
				const uint32_t quad[6] = {v, v + 1, v + N + 2, v, v + N + 2, v + N + 1};
				memcpy(indices + c, quad, sizeof quad);
				c += 6;
			}
		}
	}
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2 * N * N,
		.vertex_count = (N + 1) * (N + 1),
		.indices = indices, .positions = &positions[0][0], .normals = &normals[0][0],
		.texcoords = &texcoords[0][0]};
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++)
		compare(&mesh, 6 * N * N, &(nmtan_options){.struct_bytes = sizeof(nmtan_options),
			.method = (nmtan_method)method});
	split s = split_make(&mesh, 6 * N * N);
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &s.out, &s.counts), NMTAN_OK);
	assert_int_equal(s.out.source_count, N + 1); /* the column of the mirror */
	split_free(&s);
}

TEST(arguments_are_checked)
{
	float rows[3][8] = {{0}, {1}, {0, 1}};
	uint32_t indices[3], sources[3];
	float tangents[6][4];
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
		.positions = rows[0],
		.position_stride_bytes = 32, .normals = rows[0] + 3, .normal_stride_bytes = 32,
		.texcoords = rows[0] + 6, .texcoord_stride_bytes = 32};
	nmtan_split_output out = {.struct_bytes = sizeof out, .indices = indices, .sources = sources,
		.source_capacity = 3};
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &out, NULL), NMTAN_ERROR_ARGUMENT);
	out.vertex_tangents = &tangents[0][0];
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &out, NULL), NMTAN_OK);
	assert_int_equal(nmtan_vertex_tangents(NULL, NULL, &out, NULL), NMTAN_ERROR_ARGUMENT);
	out.indices = NULL; /* nothing is split, then there are no sources */
	assert_int_equal(nmtan_vertex_tangents(&mesh, NULL, &out, NULL), NMTAN_ERROR_ARGUMENT);
}
