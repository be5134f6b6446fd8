/* SPDX-License-Identifier: MIT */
/*
 * The passes over many triangles against the definition for one: the same bytes and counts, repaired, on every
 * instruction set and thread count, for meshes with and without lanes that the passes cannot do.
 */
#include "test.h"
#include <math.h>
#include "api/tangents.h"
#include "base/cpu.h"
#include "golden.h"
#include "oracle128.h"
#include "surfaces.h"

static void solve(const nmtan_mesh *mesh, nmtan_options options, nt_implementation implementation,
	float *tangents, float *bitangents,
	nmtan_counts *counts)
{
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents,
		.bitangents = bitangents};
	assert_int_equal(nt_tangents(mesh, &options, &implementation, &output, counts), NMTAN_OK);
}

/* Bytes are compared without sanitizers; these see on which memory the passes work. */
#ifdef __SANITIZE_ADDRESS__
enum { FEWEST_THREADS = 3, ALL_MESHES = 0 };
#else
enum { FEWEST_THREADS = 1, ALL_MESHES = 1 };
#endif

static void compare_paths(const nmtan_mesh *mesh, size_t corners)
{
	float *expected = malloc(16 * corners), *got = malloc(16 * corners);
	float *expected_b = malloc(12 * corners), *got_b = malloc(12 * corners);
	for (int method = NMTAN_METHOD_AREA; method <= NMTAN_METHOD_ROBUST; method++) {
		const nmtan_options scalar = {.struct_bytes = sizeof scalar, .method = (nmtan_method)method,
			.threads = 1};
		nmtan_counts a = NMTAN_COUNTS_INIT, b = NMTAN_COUNTS_INIT;
		solve(mesh, scalar, (nt_implementation){.scalar = true}, expected, expected_b, &a);
		for (int isa = NT_ISA_BASELINE; isa <= NT_ISA_AVX512; isa++) {
			for (unsigned threads = FEWEST_THREADS; threads < 4 && nt_cpu_has((nt_isa)isa); threads += 2) {
				const nmtan_options fast = {.struct_bytes = sizeof fast,
					.method = (nmtan_method)method, .threads = threads};
				solve(mesh, fast, (nt_implementation){.isa = (nt_isa)isa}, got, got_b, &b);
				assert_memory_equal(got, expected, 16 * corners);
				assert_memory_equal(got_b, expected_b, 12 * corners);
				assert_memory_equal(&a, &b, sizeof a);
			}
		}
	}
	free(expected);
	free(got);
	free(expected_b);
	free(got_b);
}

static void compare_golden(const char *path, const nt_golden *golden, void *context)
{
	(void)path;
	(void)context;
	const nmtan_mesh mesh = nt_golden_mesh(golden);
	compare_paths(&mesh, golden->corner_count);
}

TEST(all_paths_give_the_same_bytes_on_goldens)
{
	assert_int_equal(nt_golden_each(NT_DATA_DIR "/golden", compare_golden, NULL), 46);
}

/* Large enough for several threads; every seventh vertex has a denormal, an infinity or a far exponent, so
 * that lanes are hard here and there, and every fifth column is mirrored. */
TEST(all_paths_give_the_same_bytes_on_a_large_mesh)
{
	static const float odd[4] = {1e-44f, 1e30f, -1e-30f, INFINITY};
	nt_owned grid = nt_surface_grid(NT_TORUS, 210, 200, 0.3, 3);
	if (ALL_MESHES)
		compare_paths(&grid.mesh, grid.corner_count);
	for (size_t v = 0; v < grid.mesh.vertex_count; v++) {
		if (v % 5 == 0)
			grid.texcoords[v][0] = 1 - grid.texcoords[v][0];
		if (v % 7 == 0)
			grid.positions[v][v % 3] = odd[v % 4];
		if (v % 11 == 0)
			grid.texcoords[v][v % 2] = odd[v % 4];
	}
	if (ALL_MESHES)
		compare_paths(&grid.mesh, grid.corner_count);
	grid.mesh.stored = &(nmtan_stored_uv){.struct_bytes = sizeof(nmtan_stored_uv), .v_offset = 1};
	compare_paths(&grid.mesh, grid.corner_count);
	nt_owned_free(&grid);
}

/* A plane grid of quads: some cells have their texture turned over in one half (folded), some have a corner of
 * theirs collapsed, some normals are zero or not numbers, and every third row is mirrored. */
TEST(all_paths_give_the_same_bytes_on_quads)
{
	enum { N = 190 };
	nt_owned grid = nt_surface_grid(NT_TORUS, N, N, 0.2, 5);
	uint8_t *sizes = malloc(grid.corner_count);
	uint32_t *indices = malloc(4 * grid.corner_count);
	size_t faces = 0, corners = 0;
	for (uint32_t y = 0; y < N; y++) {
		for (uint32_t x = 0; x < N; x++) {
			const uint32_t a = y * (N + 1) + x, odd = x * 7 + y * 13;
			const uint32_t quad[4] = {a, a + 1, odd % 29 == 0 ? a + 1 : a + N + 2, a + N + 1};
			const size_t size = odd % 5 == 0 ? 3 : 4;
			memcpy(indices + corners, quad, size * sizeof *quad);
			sizes[faces++] = (uint8_t)size;
			corners += size;
		}
	}
	for (size_t v = 0; v < grid.mesh.vertex_count; v++) {
		if (v % 31 == 0)
			grid.texcoords[v][0] += 0.02f;
		if (v / (N + 1) % 3 == 0)
			grid.texcoords[v][0] = -grid.texcoords[v][0];
		if (v % 97 == 0)
			memset(grid.normals[v], 0, sizeof grid.normals[v]);
		if (v % 101 == 0)
			grid.normals[v][1] = NAN;
	}
	grid.mesh.face_sizes = sizes;
	grid.mesh.indices = indices;
	grid.mesh.face_count = faces;
	if (ALL_MESHES)
		compare_paths(&grid.mesh, corners);
	grid.mesh.stored = &(nmtan_stored_uv){.struct_bytes = sizeof(nmtan_stored_uv), .v_offset = -1};
	compare_paths(&grid.mesh, corners);
	nt_owned_free(&grid);
	free(indices);
	free(sizes);
}

/* A lattice with normals along its axes: edges along a normal, edges without length, triangles seen from the side. All
 * paths give the same bytes, and robust the oracle's answer. */
TEST(edges_along_normals_weigh_a_right_angle_on_all_paths)
{
	enum { TRIANGLES = 999, CORNERS = 3 * TRIANGLES };
	static float p[CORNERS][3], n[CORNERS][3], t[CORNERS][2];
	nt_random random = nt_random_seed(3);
	for (size_t c = 0; c < CORNERS; c++) {
		for (int k = 0; k < 3; k++)
			p[c][k] = (float)nt_random_below(&random, 3);
		for (int k = 0; k < 2; k++)
			t[c][k] = (float)nt_random_below(&random, 3);
		n[c][nt_random_below(&random, 3)] = nt_random_below(&random, 2) ? 1 : -1;
	}
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = TRIANGLES, .vertex_count = CORNERS,
		.positions = p[0], .normals = n[0], .texcoords = t[0]};
	compare_paths(&mesh, CORNERS);
	static float tangents[CORNERS][4];
	static oracle_corner exact[CORNERS];
	const nmtan_options options = {.struct_bytes = sizeof options, .method = NMTAN_METHOD_ROBUST};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0]};
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
	assert_true(oracle_solve(&mesh, ORACLE_ANGLE, exact));
	size_t judged = 0;
	for (size_t c = 0; c < CORNERS; c++)
		for (int k = 0; k < 3 && exact[c].sign && exact[c].condition < 16777216.0; k++, judged++)
			assert_true(fabs(tangents[c][k] - exact[c].t[k]) <= 1.0 / 8388608);
	assert_true(judged > CORNERS);
}
