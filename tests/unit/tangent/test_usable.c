/* SPDX-License-Identifier: MIT */
/*
 * Checking with and without a method that knows its result: the fast path leaves out most faces, the definition
 * none, and both must come to the same counts and the same repaired bytes.
 */
#include "test.h"
#include <math.h>
#include "api/tangents.h"
#include "golden.h"
#include "nasty.h"
#include "nmtan.h"

static size_t count_differences(const float *a, const float *b, size_t count)
{
	size_t differences = 0;
	for (size_t i = 0; i < count; i++)
		differences += memcmp(&a[i], &b[i], sizeof *a) != 0 && !(isnan(a[i]) && isnan(b[i]));
	return differences;
}

static void compare_paths(const nmtan_mesh *given, size_t corner_count, float offset, nmtan_repair repair)
{
	nmtan_mesh mesh = *given;
	const nmtan_stored_uv stored = {.struct_bytes = sizeof stored, .v_offset = offset};
	mesh.stored = &stored;
	const nmtan_output scalar = {.struct_bytes = sizeof scalar, .tangents = malloc(16 * corner_count + 1)};
	nmtan_counts scalar_counts = NMTAN_COUNTS_INIT;
	const nmtan_output fast = {.struct_bytes = sizeof fast, .tangents = malloc(16 * corner_count + 1)};
	nmtan_counts fast_counts = NMTAN_COUNTS_INIT;
	const nmtan_options options = {.struct_bytes = sizeof options, .repair = repair, .threads = 1};
	const nt_implementation one_by_one = {.scalar = true};
	assert_int_equal(nt_tangents(&mesh, &options, &one_by_one, &scalar, &scalar_counts), NMTAN_OK);
	assert_int_equal(nmtan_tangents(&mesh, &options, &fast, &fast_counts), NMTAN_OK);
	assert_int_equal(count_differences(scalar.tangents, fast.tangents, 4 * corner_count), 0);
	assert_memory_equal(&scalar_counts, &fast_counts, sizeof scalar_counts);
	free(scalar.tangents);
	free(fast.tangents);
}

static void compare_golden(const char *path, const nt_golden *golden, void *context)
{
	(void)path;
	(void)context;
	const nmtan_mesh mesh = nt_golden_mesh(golden);
	for (int offset = -1; offset <= 1; offset++)
		compare_paths(&mesh, golden->corner_count, (float)offset, NMTAN_REPAIR_ON);
}

TEST(known_faces_need_no_look_on_goldens)
{
	assert_int_equal(nt_golden_each(NT_DATA_DIR "/golden", compare_golden, NULL), 46);
}

TEST(known_faces_need_no_look_on_nasty_meshes)
{
	for (uint64_t seed = 0; seed < 3000; seed++) {
		nt_nasty nasty;
		nt_nasty_make(seed, &nasty);
		compare_paths(&nasty.mesh, nasty.corner_count, (float)(seed % 3) - 1.0f,
			seed % 4 == 3 ? NMTAN_REPAIR_OFF : NMTAN_REPAIR_ON);
		nt_nasty_free(&nasty);
	}
}

/* Triangles so thin in v that storing it turns some of them: around the bound, on both sides. */
TEST(slivers_around_the_bound_are_told_exactly)
{
	enum { COUNT = 4096 };
	float (*positions)[3] = malloc(3 * COUNT * sizeof *positions);
	float (*normals)[3] = malloc(3 * COUNT * sizeof *normals);
	float (*texcoords)[2] = malloc(3 * COUNT * sizeof *texcoords);
	uint32_t seed = 7;
	size_t differently = 0;
	for (int t = 0; t < COUNT; t++) {
		for (int k = 0; k < 3; k++) {
			seed = seed * 1664525u + 1013904223u;
			const float r = (float)(seed >> 8) * 0x1p-24f;
			const float height = ldexpf(r, -(t % 30));
			memcpy(positions[3 * t + k], (float[3]){(float)(k == 1), (float)(k == 2), (float)t}, 12);
			memcpy(normals[3 * t + k], (float[3]){0, 0, 1}, 12);
			memcpy(texcoords[3 * t + k], (float[2]){(float)k + r, height}, 8);
		}
	}
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = COUNT, .vertex_count = 3 * COUNT,
		.positions = &positions[0][0], .normals = &normals[0][0], .texcoords = &texcoords[0][0]};
	for (int offset = -1; offset <= 1; offset++)
		compare_paths(&mesh, 3 * COUNT, (float)offset, NMTAN_REPAIR_ON);
	const nmtan_stored_uv minus_one = {.struct_bytes = sizeof minus_one, .v_offset = -1};
	nmtan_mesh stored = mesh;
	stored.stored = &minus_one;
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = malloc(48 * COUNT)};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&stored, NULL, &output, &counts), NMTAN_OK);
	for (int t = 0; t < COUNT; t++) {
		float s[3][2];
		for (int k = 0; k < 3; k++) {
			s[k][0] = texcoords[3 * t + k][0];
			s[k][1] = texcoords[3 * t + k][1] - 1.0f;
		}
		const int sign = nmtan_orientation(s[0], s[1], s[2]);
		differently += sign != nmtan_orientation(texcoords[3 * t], texcoords[3 * t + 1],
					       texcoords[3 * t + 2]);
		for (int k = 0; sign && k < 3; k++)
			assert_true(output.tangents[12 * t + 4 * k + 3] == (float)sign);
	}
	assert_true(differently > 100);
	assert_int_equal(counts.stored_differently, differently);
	free(output.tangents);
	free(positions);
	free(normals);
	free(texcoords);
}

/* Whether T is within 0.05 degrees of a normal's line, in double. */
static bool runs_along(const float t[4], const float n[3])
{
	const double largest = fmax(fmax(fabs((double)n[0]), fabs((double)n[1])), fabs((double)n[2]));
	double along = 0, normal = 0, tangent = 0;
	for (int k = 0; k < 3; k++) {
		along += t[k] * (n[k] / largest);
		normal += n[k] / largest * (n[k] / largest);
		tangent += (double)t[k] * t[k];
	}
	return along * along > cos(0.05 * M_PI / 180) * cos(0.05 * M_PI / 180) * normal * tangent;
}

/* Normals of every length that a float has. In float, T less N (N . T) is T where N is tiny, which may run along N,
 * and N itself where N is large; squares are zero and infinite there. */
TEST(tangents_are_not_parallel_to_normals_of_any_length)
{
	static const float directions[][3] = {{1, 0, 0}, {-1, 0, 1e-4f}, {1, 1e-3f, 0}, {1, 1, 0}, {0.3f, 0.4f, 1}};
	const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
	const float texcoords[3][2] = {{0, 0}, {1, 0}, {0, 1}};
	size_t parallel = 0, raw_parallel = 0;
	for (int exponent = -149; exponent < 128; exponent++)
		for (size_t i = 0; i < 3 * sizeof directions / sizeof *directions; i++) {
			float normals[3][3];
			for (size_t k = 0; k < 3; k++)
				for (int j = 0; j < 3; j++)
					normals[k][j] = ldexpf(directions[(i + k) % 5][j], exponent);
			for (size_t k = 0; k < 3 && i >= 5; k++) /* a little along u, much across */
				memcpy(normals[k], (float[3]){i < 10 ? 0.5f : 1e-4f, 0, ldexpf(1, exponent)},
					sizeof normals[k]);
			const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
				.positions = &positions[0][0], .normals = &normals[0][0],
				.texcoords = &texcoords[0][0]};
			compare_paths(&mesh, 3, 0, NMTAN_REPAIR_ON);
			for (int method = 0; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++) {
				float t[3][4];
				nmtan_options options = {.struct_bytes = sizeof options,
					.method = (nmtan_method)method};
				const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &t[0][0]};
				assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
				for (int k = 0; k < 3; k++)
					parallel += runs_along(t[k], normals[k]);
				options.repair = NMTAN_REPAIR_OFF;
				assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
				for (int k = 0; k < 3; k++)
					raw_parallel += runs_along(t[k], normals[k]);
			}
		}
	assert_int_equal(parallel, 0);
	assert_true(raw_parallel > 1000);
}
