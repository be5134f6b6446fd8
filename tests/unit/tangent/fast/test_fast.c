/* SPDX-License-Identifier: MIT */
/*
 * The fast path against the definition, byte by byte: goldens and nasty meshes, for every instruction set
 * of this machine and several thread counts, with all outputs.
 *
 * NT_NASTY_FROM and NT_NASTY_COUNT in the environment choose other seeds (make soak tries 100 000).
 */
#include "test.h"
#include <math.h>
#include <stdio.h>
#include "api/tangents.h"
#include "base/cpu.h"
#include "definition.h"
#include "golden.h"
#include "nasty.h"
#include "surfaces.h"
#include "tangent/fast/bins.h"
#include "tangent/fast/fast.h"
#include "tangent/fast/parts.h"
#include "tangent/frames.h"
#include "topology/corners.h"

typedef struct golden_comparison {
	bool sorted;
	size_t differences;
} golden_comparison;

static void compare_golden(const char *path, const nt_golden *golden, void *context)
{
	golden_comparison *c = context;
	const nmtan_mesh loose = nt_golden_mesh(golden), mesh = nt_filled(&loose);
	const nt_result expected = {golden->tangents, NULL, NULL, c->sorted};
	c->differences += nt_compare_variants(path, &mesh, golden->corner_count, &expected, false);
}

TEST(goldens_are_byte_identical)
{
	for (int sorted = 0; sorted < 2; sorted++) {
		golden_comparison c = {.sorted = sorted};
		assert_int_equal(nt_golden_each(NT_DATA_DIR "/golden", compare_golden, &c), 46);
		assert_int_equal(nt_golden_each(sorted ? NT_DATA_DIR "/golden/edge_sort/sorted"
						       : NT_DATA_DIR "/golden/edge_sort/published",
			compare_golden, &c), 18);
		assert_int_equal(c.differences, 0);
	}
}

/* With repair, which relies on what the fast path knows of its result, by vertices and by groups. */
static size_t compare_repairs(const char *name, const nmtan_mesh *mesh, size_t corners)
{
	static const nt_fast_plan plans[] = {{.grain = 1}, {.grain = 1, .bin_bits = 4},
		{.grain = 1, .most_narrow = NT_NARROW_LIMIT, .small = true}};
	enum { PLANS = sizeof plans / sizeof *plans };
	nt_result results[PLANS + 1]; /* the definition's is the last */
	nmtan_counts counts[PLANS + 1];
	size_t differences = 0;
	for (size_t i = PLANS + 1; i-- > 0;) {
		results[i] = nt_result_make(corners);
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		nt_known known = {0};
		nt_solve solve = nt_result_solve(mesh, corners, &scratch, &results[i], false);
		solve.repair = true;
		solve.known = nt_has_stored_texcoords(mesh) ? NULL : &known;
		assert_int_equal(i == PLANS
			? nt_mikktspace_scalar(&solve) : nt_mikktspace_fast_as(&solve, &plans[i]), NMTAN_OK);
		assert_int_equal(nt_repair(&solve, &counts[i]), NMTAN_OK);
		assert_memory_equal(&counts[i], &counts[PLANS], sizeof *counts);
		differences += nt_result_differences(&results[PLANS], &results[i], corners, false);
		nt_scratch_free(&scratch);
	}
	for (size_t i = 0; i <= PLANS; i++)
		nt_result_free(&results[i]);
	if (differences)
		print_error("%s, repaired: %zu floats differ\n", name, differences);
	return differences;
}

static size_t compare_nasty(uint64_t seed)
{
	char name[64];
	nt_nasty nasty;
	nt_nasty_make(seed, &nasty);
	const nmtan_mesh mesh = nt_filled(&nasty.mesh);
	const bool more = seed % 2;
	nt_result expected = nt_result_define(&mesh, nasty.corner_count, more);
	snprintf(name, sizeof name, "seed %llu", (unsigned long long)seed);
	const size_t differences = nt_compare_variants(name, &mesh, nasty.corner_count, &expected, more) +
		compare_repairs(name, &mesh, nasty.corner_count);
	nt_result_free(&expected);
	nt_nasty_free(&nasty);
	return differences;
}

static uint64_t environment(const char *name, uint64_t otherwise)
{
	const char *text = getenv(name);
	return text ? strtoull(text, NULL, 10) : otherwise;
}

/* Bytes are compared without sanitizers; these see on which memory the passes work. Each grid takes them two seconds:
 * make soak sets NT_ALL_GRIDS. */
#ifdef __SANITIZE_ADDRESS__
enum { NASTY_COUNT = 500, ALL_GRIDS = 0 };
#else
enum { NASTY_COUNT = 2000, ALL_GRIDS = 1 };
#endif

TEST(nasty_meshes_are_byte_identical)
{
	const uint64_t from = environment("NT_NASTY_FROM", 0), count = environment("NT_NASTY_COUNT", NASTY_COUNT);
	size_t wrong = 0;
	for (uint64_t seed = from; seed < from + count && wrong < 10; seed++)
		wrong += compare_nasty(seed) > 0;
	assert_int_equal(wrong, 0);
}

/* Many nasty meshes as one, with vertices and corners enough for the threads of complex vertices (complex.c). Every
 * second one has its coordinates in other units, so that not all of them weld. */
typedef struct joined {
	nmtan_mesh mesh;
	size_t corner_count;
	float *rows[3]; /* positions, normals, texture coordinates */
	uint32_t *indices;
	uint8_t *sizes;
} joined;

static void copy_rows(const float *from, size_t stride_bytes, size_t floats, size_t count, float scale, float *to)
{
	for (size_t i = 0; i < count; i++)
		for (size_t k = 0; k < floats; k++)
			to[i * floats + k] = scale * from[i * stride_bytes / sizeof *from + k];
}

static void join(joined *j, const nt_nasty *part, float unit)
{
	const nmtan_mesh m = nt_filled(&part->mesh);
	const size_t vertices = j->mesh.vertex_count, faces = j->mesh.face_count;
	for (int i = 0; i < 3; i++)
		assert_non_null(j->rows[i] = realloc(j->rows[i], (vertices + m.vertex_count) * 12 + 1));
	assert_non_null(j->indices =
		realloc(j->indices, (j->corner_count + part->corner_count) * sizeof *j->indices + 1));
	assert_non_null(j->sizes = realloc(j->sizes, faces + m.face_count + 1));
	copy_rows(m.positions, m.position_stride_bytes, 3, m.vertex_count, 1, j->rows[0] + 3 * vertices);
	copy_rows(m.normals, m.normal_stride_bytes, 3, m.vertex_count, 1, j->rows[1] + 3 * vertices);
	copy_rows(m.texcoords, m.texcoord_stride_bytes, 2, m.vertex_count, unit, j->rows[2] + 2 * vertices);
	for (size_t c = 0; c < part->corner_count; c++)
		j->indices[j->corner_count + c] = (uint32_t)vertices + (m.indices ? m.indices[c] : (uint32_t)c);
	for (size_t f = 0; f < m.face_count; f++)
		j->sizes[faces + f] = m.face_sizes ? m.face_sizes[f] : 3;
	j->corner_count += part->corner_count;
	j->mesh.vertex_count += m.vertex_count;
	j->mesh.face_count += m.face_count;
}

/* All even triangles, then all odd ones, as if they were halves of quads: several threads do each half in a sweep. */
static void put_odd_last(joined *j)
{
	uint32_t *indices = malloc(j->corner_count * sizeof *indices), *to = indices;
	assert_non_null(indices);
	for (size_t odd = 0; odd < 2; odd++)
		for (size_t t = odd; t < j->mesh.face_count; t += 2, to += 3)
			memcpy(to, j->indices + 3 * t, 3 * sizeof *to);
	free(j->indices);
	j->indices = indices;
}

static void check_joined(bool triangles)
{
	static const unsigned threads[] = {1, 2, 4};
	joined j = {.mesh = {.struct_bytes = sizeof j.mesh}};
	for (uint64_t seed = 0; seed < 400; seed++) {
		nt_nasty part;
		nt_nasty_make(seed, &part);
		if (!triangles || part.corner_count == 3 * part.mesh.face_count)
			join(&j, &part, ldexpf(1, (int)(seed % 2 * (seed % 32))));
		nt_nasty_free(&part);
	}
	if (triangles)
		put_odd_last(&j);
	j.mesh.positions = j.rows[0];
	j.mesh.normals = j.rows[1];
	j.mesh.texcoords = j.rows[2];
	j.mesh.indices = j.indices;
	j.mesh.face_sizes = triangles ? NULL : j.sizes;
	const nmtan_mesh mesh = nt_filled(&j.mesh);
	nt_result expected = nt_result_define(&mesh, j.corner_count, true);
	size_t differences = 0;
	for (int more = 0; more < 2; more++)
		for (int i = 0; i < 3; i++)
			differences += nt_compare_run("joined", &mesh, j.corner_count, &expected, more,
				nt_cpu_best(), threads[i], &nt_usual_plan);
	assert_int_equal(differences, 0);
	nt_result_free(&expected);
	for (int i = 0; i < 3; i++)
		free(j.rows[i]);
	free(j.indices);
	free(j.sizes);
}

TEST(nasty_meshes_joined_are_byte_identical)
{
	check_joined(false);
}

TEST(nasty_triangles_of_which_the_odd_ones_come_last_are_byte_identical)
{
	check_joined(true);
}

/* A grid large enough for the plan to choose bins by itself; vertices and faces are numbered by a stride that is
 * prime to their count. */
enum { GRID_SIDE = 300, STRIDE = 39119, GRID_VERTICES = GRID_SIDE * GRID_SIDE,
	CELLS = (GRID_SIDE - 1) * (GRID_SIDE - 1) };

typedef struct grid {
	bool quads;
	bool mixed; /* both orientations, and triangles without UV area; otherwise one orientation */
	bool lost;  /* in the flat part some normals, not of unit length, lie along their tangents */
} grid;

static void fill_vertices(grid g, float *p, float *n, float *t)
{
	assert_in_range(GRID_VERTICES, NT_BINS_LEAST, SIZE_MAX);
	for (size_t i = 0; i < GRID_VERTICES; i++) {
		const size_t v = i * STRIDE % GRID_VERTICES;
		const float x = (float)(i % GRID_SIDE), y = (float)(i / GRID_SIDE);
		memcpy(p + 3 * v, (float[3]){x, y, x > 200.0f ? 0.0f : 0.3f * sinf(x) * cosf(2 * y)}, 12);
		memcpy(n + 3 * v, g.lost && i % 1009 == 5 ? (float[3]){0.5f, 0, 0} : (float[3]){0, 0, 1}, 12);
		memcpy(t + 2 * v,
			g.mixed ? (float[2]){fabsf(x - 150.0f), i % 97 == 0 ? 0.0f : y} : (float[2]){x, y}, 8);
	}
}

/* Two triangles for each cell, or a quad; returns the number of corners. */
static size_t fill_faces(bool quads, unsigned *indices)
{
	static const size_t triangles[6] = {0, 1, GRID_SIDE + 1, 0, GRID_SIDE + 1, GRID_SIDE},
			    quad[4] = {0, 1, GRID_SIDE + 1, GRID_SIDE};
	const size_t size = quads ? 4 : 3, faces = quads ? CELLS : 2 * CELLS;
	for (size_t i = 0; i < faces; i++) {
		const size_t number = quads ? i : i / 2, cell = number + number / (GRID_SIDE - 1),
			     face = i * STRIDE % faces;
		for (size_t k = 0; k < size; k++) {
			const size_t corner = quads ? quad[k] : triangles[3 * (i % 2) + k];
			indices[size * face + k] = (unsigned)((cell + corner) * STRIDE % GRID_VERTICES);
		}
	}
	return size * faces;
}

/* Tangents by vertex, which the split of a sparse solve reads from the records. */
static void compare_vertices(const nmtan_mesh *mesh, size_t corners, const nmtan_options *options,
	const float *expected)
{
	nmtan_split_output split = {.struct_bytes = sizeof split, .indices = malloc(corners * 4),
		.sources = malloc(corners * 4),
		.source_capacity = corners, .vertex_tangents = malloc((mesh->vertex_count + corners) * 16)};
	assert_int_equal(nmtan_vertex_tangents(mesh, options, &split, NULL), NMTAN_OK);
	size_t differences = 0;
	for (size_t i = 0; i < 4 * corners; i++)
		differences += split.vertex_tangents[4 * (size_t)split.indices[i / 4] + i % 4] != expected[i];
	assert_int_equal(differences, 0);
	free(split.indices);
	free(split.sources);
	free(split.vertex_tangents);
}

/* With repair, which relies on what the fast path knows of its result. */
static void compare_repaired(const nmtan_mesh *mesh, size_t corners, bool lost)
{
	nt_result expected = nt_result_make(corners);
	const nmtan_output wanted = {.struct_bytes = sizeof wanted, .tangents = expected.tangents};
	nmtan_counts wanted_counts = NMTAN_COUNTS_INIT;
	const nt_implementation scalar = {.scalar = true};
	assert_int_equal(nt_tangents(mesh, NULL, &scalar, &wanted, &wanted_counts), NMTAN_OK);
	assert_int_equal(wanted_counts.repaired_parallel > 0, lost);
	for (unsigned threads = 1; threads <= 2; threads++) {
		nt_result got = nt_result_make(corners);
		const nmtan_output output = {.struct_bytes = sizeof output, .tangents = got.tangents};
		nmtan_counts counts = NMTAN_COUNTS_INIT;
		const nmtan_options options = {.struct_bytes = sizeof options, .threads = threads};
		assert_int_equal(nmtan_tangents(mesh, &options, &output, &counts), NMTAN_OK);
		assert_memory_equal(got.tangents, expected.tangents, corners * 16);
		assert_memory_equal(&counts, &wanted_counts, sizeof wanted_counts);
		compare_vertices(mesh, corners, &options, expected.tangents);
		nt_result_free(&got);
	}
	nt_result_free(&expected);
}

static void compare_scattered(grid g)
{
	const bool quads = g.quads;
	float *p = malloc(GRID_VERTICES * 12), *n = malloc(GRID_VERTICES * 12), *t = malloc(GRID_VERTICES * 8);
	unsigned *indices = malloc(2 * CELLS * 12);
	uint8_t *sizes = malloc(CELLS);
	fill_vertices(g, p, n, t);
	memset(sizes, 4, CELLS);
	const size_t corners = fill_faces(quads, indices);
	const nmtan_mesh loose = {.struct_bytes = sizeof loose, .face_count = quads ? CELLS : 2 * CELLS,
		.vertex_count = GRID_VERTICES, .positions = p,
		.normals = n, .texcoords = t, .indices = indices, .face_sizes = quads ? sizes : NULL};
	const nmtan_mesh mesh = nt_filled(&loose);
	nt_result expected = nt_result_define(&mesh, corners, true);
	for (unsigned threads = 1; threads <= 2; threads++)
		for (int more = 0; more < 2; more++)
			assert_int_equal(nt_compare_run("scattered", &mesh, corners, &expected, more,
				nt_cpu_best(), threads,
					&nt_usual_plan), 0);
	compare_repaired(&mesh, corners, g.lost);
	nt_result_free(&expected);
	free(sizes);
	free(p);
	free(n);
	free(t);
	free(indices);
}

TEST(scattered_meshes_are_byte_identical)
{
	compare_scattered((grid){.mixed = true, .lost = true});
	compare_scattered((grid){.quads = true, .mixed = true, .lost = true});
	compare_scattered((grid){0});
	if (!environment("NT_ALL_GRIDS", ALL_GRIDS))
		return;
	compare_scattered((grid){.lost = true});
	compare_scattered((grid){.mixed = true});
}

/* A grid in a plane through the normal, so that u, or v, and some edges lie along it; or one of which
 * all texture coordinates are equal; or one that turns back and leaves the plane in the middle, so that vertices there
 * have usable triangles, too, and antiparallel directions of v. With one more cell, beside them, that is ordinary:
 * `mixed`. */
typedef enum hopeless { ALONG_U, ALONG_V, ONE_POINT, HALF_ALONG } hopeless;
enum { ROW = 10, HOPELESS_CELLS = (ROW - 1) * (ROW - 1), HOPELESS_VERTICES = ROW * ROW + 4 };

static nmtan_mesh make_hopeless(hopeless kind, bool mixed, float (*p)[3], float (*n)[3], float (*t)[2],
	unsigned *indices)
{
	size_t v = 0, corner = 0;
	for (; v < HOPELESS_VERTICES; v++) {
		const size_t own = HOPELESS_VERTICES - 4, width = v < own ? ROW : 2, i = v < own ? v : v - own;
		const float a = (float)(i % width) / 8, b = (float)(i / width) / 8;
		memcpy(n[v], (float[3]){0, 0, 1}, 12);
		memcpy(t[v], v < own && kind == ONE_POINT ? (float[2]){0.5f, 0.5f} : (float[2]){a, b}, 8);
		const bool by_u = kind == ALONG_U || kind == HALF_ALONG;
		memcpy(p[v], v >= own ? (float[3]){a, b, 2} : by_u ? (float[3]){b, 0, a} : (float[3]){a, 0, b}, 12);
		if (v < own && kind == HALF_ALONG && i / width > 4)
			memcpy(p[v], (float[3]){1 - b, (b - 0.5f) * (a - 0.5f), a}, 12);
	}
	for (unsigned cell = 0; cell < HOPELESS_CELLS + (mixed ? 1u : 0); cell++) {
		const bool last = cell == HOPELESS_CELLS;
		const unsigned i = last ? ROW * ROW : cell / (ROW - 1) * ROW + cell % (ROW - 1), up = last ? 2 : ROW;
		memcpy(indices + corner, (unsigned[6]){i, i + 1, i + up + 1, i, i + up + 1, i + up}, 24);
		corner += 6;
	}
	return (nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = corner / 3,
		.vertex_count = HOPELESS_VERTICES,
		.positions = p[0], .normals = n[0], .texcoords = t[0], .indices = indices};
}

/* The result for callers, faults and counts too, is the definition's with every instruction set. */
static void compare_calls(const nmtan_mesh *mesh, nmtan_repair repair)
{
	const size_t corners = 3 * mesh->face_count;
	const nmtan_options options = {.struct_bytes = sizeof options, .threads = 1, .repair = repair};
	nt_result expected = nt_result_make(corners), got = nt_result_make(corners);
	uint8_t *faults = malloc(2 * corners);
	nmtan_counts wanted = NMTAN_COUNTS_INIT, counts = NMTAN_COUNTS_INIT;
	const nmtan_output to_expected = {.struct_bytes = sizeof to_expected, .tangents = expected.tangents,
		.corner_faults = faults};
	const nmtan_output to_got = {.struct_bytes = sizeof to_got, .tangents = got.tangents,
		.corner_faults = faults + corners};
	const nt_implementation definition = {.scalar = true};
	assert_int_equal(nt_tangents(mesh, &options, &definition, &to_expected, &wanted), NMTAN_OK);
	for (nt_isa isa = NT_ISA_BASELINE; isa <= NT_ISA_AVX512; isa++) {
		const nt_implementation set = {.isa = isa};
		if (!nt_cpu_has(isa))
			continue;
		memset(got.tangents, 0xab, corners * 16);
		assert_int_equal(nt_tangents(mesh, &options, &set, &to_got, &counts), NMTAN_OK);
		assert_memory_equal(got.tangents, expected.tangents, corners * 16);
		assert_memory_equal(faults + corners, faults, corners);
		assert_memory_equal(&counts, &wanted, sizeof wanted);
	}
	compare_vertices(mesh, corners, &options, expected.tangents);
	free(faults);
	nt_result_free(&expected);
	nt_result_free(&got);
}

TEST(unusable_vertices_are_byte_identical)
{
	float p[HOPELESS_VERTICES][3], n[HOPELESS_VERTICES][3], t[HOPELESS_VERTICES][2];
	unsigned indices[6 * (HOPELESS_CELLS + 1)];
	for (hopeless kind = ALONG_U; kind <= HALF_ALONG; kind++)
		for (int mixed = 0; mixed < 2; mixed++) {
			const nmtan_mesh mesh = make_hopeless(kind, mixed, p, n, t, indices), full = nt_filled(&mesh);
			const size_t corners = 3 * mesh.face_count;
			nt_result expected = nt_result_define(&full, corners, true);
			for (int more = 0; more < 2; more++)
				assert_int_equal(nt_compare_variants("unusable", &full, corners, &expected, more), 0);
			nt_result_free(&expected);
			compare_calls(&mesh, NMTAN_REPAIR_ON);
			compare_calls(&mesh, NMTAN_REPAIR_OFF);
		}
}

/* Triangles of which u runs along the normal, and a quad seen nearly as a line: mikktspace.c's values where squares of
 * lengths are below floats, or a magnitude is above them. An edge whose square is 0 is divided by 0, which makes the
 * weight no number; one that is not above FLT_MIN is not divided. An infinite magnitude of weight 0 is no number, so
 * that the halves of the quad do not have the same result, and theirs is normalised once more. */
TEST(squares_out_of_range_are_byte_identical)
{
	static const struct {
		float unit;    /* of the triangle's edges across the normal; 0: the quad */
		float tangent; /* each component, at each corner of the triangle */
	} rows[] = {{1.5e-38f, NAN}, {1e-38f, 0}, {2e-23f, NAN}, {4e-23f, 0}, {0, 0}};
	static const float quad[4][3] = {{0, 0, 0}, {1e19f, 9e9f, 0}, {3e19f, 1.3e10f, 0}, {0, 1e10f, 0}};
	static const float quad_uv[4][2] = {{0, 0}, {1, 6e-23f}, {0.5f, 4e-23f}, {0.75f, 7e-23f}};
	static float of_quad[4][4] = {{1, 4.28570408e-11f, 0, 1}, {0.999997973f, -0.00206158031f, 0, 1},
		{0.999997854f, -0.00206158007f, 0, 1}, {0.999999464f, -0.00103079062f, 0, 1}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		const float unit = rows[i].unit, along = unit != 0;
		const float triangle[3][3] = {{1, 0, 0}, {1.5f, 0, unit}, {-1, 0, unit}};
		const float uv[3][2] = {{0, 0}, {0, 1}, {1, 1}};
		const float normals[4][3] = {{along, 0, 1 - along}, {along, 0, 1 - along}, {along, 0, 1 - along},
			{0, 0, 1}};
		const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = unit ? 3 : 4,
			.positions = unit ? triangle[0] : quad[0], .normals = normals[0],
			.texcoords = unit ? uv[0] : quad_uv[0], .face_sizes = unit ? NULL : (const uint8_t[]){4}};
		const nmtan_mesh full = nt_filled(&mesh);
		float of_triangle[3][4];
		for (int k = 0; k < 3; k++)
			memcpy(of_triangle[k], (float[4]){rows[i].tangent, rows[i].tangent, rows[i].tangent, -1}, 16);
		const nt_result expected = {.tangents = unit ? of_triangle[0] : of_quad[0]};
		assert_int_equal(nt_compare_variants("squares", &full, mesh.vertex_count, &expected, false), 0);
	}
}

/* A sheet of 8 x 8 cells, bent and mirrored in the middle, whose triangles are beyond doubt but for one beside which
 * they are not marked: repair has to see those around it all the same. */
enum { SHEET = 9, MIDDLE = 4 };

/* The determinant of these is 2.3e-10 in float and negative in truth. */
static const float misjudged[3][2] = {{0.0827391148f, 0.0331479087f}, {0.00360275805f, 0.00178954005f},
	{0.000188201055f, 0.000436497037f}};

TEST(what_is_around_faults_is_seen)
{
	for (int by_sign = 0; by_sign < 2; by_sign++) {
		float p[SHEET * SHEET + 2][3] = {{0}}, n[SHEET * SHEET + 2][3] = {{0}}, t[SHEET * SHEET + 2][2] = {{0}};
		unsigned indices[6 * (SHEET - 1) * (SHEET - 1) + 3], count = 0;
		for (int i = 0; i < SHEET * SHEET; i++) {
			const int x = i % SHEET, y = i / SHEET, beyond = x > MIDDLE ? x - MIDDLE : 0;
			const float beside = fabsf((float)(x - MIDDLE)), lean = by_sign ? 0.033f : 0.0f;
			memcpy(p[i], (float[3]){(float)(x - beyond), (float)y, (float)-beyond}, sizeof p[i]);
			n[i][0] = n[i][2] = sqrtf(0.5f); /* across neither side */
			memcpy(t[i], (float[2]){0.08f * (beside - 1),
				lean * (beside - 1) + 0.05f * (float)(y - MIDDLE)}, sizeof t[i]);
			const unsigned at = (unsigned)i,
				cell[6] = {at, at + 1, at + SHEET + 1, at, at + SHEET + 1, at + SHEET};
			if (x + 1 < SHEET && y + 1 < SHEET)
				memcpy(indices + 6 * count++, cell, sizeof cell);
		}
		const unsigned v = MIDDLE * SHEET + (by_sign ? 2 : MIDDLE);
		count *= 2;
		if (by_sign) {
			memcpy(t[v], misjudged[0], sizeof t[v]);
			memcpy(t[v + 1], misjudged[1], sizeof t[v]);
			memcpy(t[v + SHEET + 1], misjudged[2], sizeof t[v]);
			assert_int_equal(nt_orientation(misjudged[0], misjudged[1], misjudged[2]), -1);
		} else {
			/* along the tangents of one side; a triangle without any area takes either side's */
			memcpy(n[v], (float[3]){0.5f, 0, 0}, sizeof n[v]);
			n[SHEET * SHEET][0] = n[SHEET * SHEET + 1][1] = 1;
			memcpy(indices + 3 * count++, (unsigned[3]){v, SHEET * SHEET, SHEET * SHEET + 1}, 12);
		}
		compare_calls(&(nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = count,
			.vertex_count = SHEET * SHEET + 2, .positions = p[0], .normals = n[0], .texcoords = t[0],
			.indices = indices}, NMTAN_REPAIR_ON);
	}
}

/* Beside a sheet, triangles without a UV area, most of whose corners have nothing around them: these take a tangent of
 * their triangle's first corner that has one with a part across their normal, or what the normal alone says. */
TEST(what_is_bare_takes_from_its_triangle)
{
	enum { SIDE = 6, OWN = SIDE * SIDE, VERTICES = OWN + 9 };
	static const unsigned added[][3] = {{1, 0, OWN}, {OWN, 0, OWN + 1}, {OWN + 1, 0, OWN + 2},
		{OWN + 3, OWN + 4, OWN + 5},
		{OWN + 6, OWN + 7, OWN + 8}, {OWN + 3, OWN + 7, OWN + 8}};
	enum { ADDED = sizeof added / sizeof *added };
	float p[VERTICES][3] = {{0}}, n[VERTICES][3] = {{0}}, t[VERTICES][2] = {{0}};
	unsigned indices[6 * OWN + 3 * ADDED], count = 0;
	for (unsigned i = 0; i < OWN; i++) {
		n[i][2] = 1;
		t[i][0] = p[i][0] = (float)(i % SIDE), t[i][1] = p[i][1] = (float)(i / SIDE);
		const unsigned cell[6] = {i, i + 1, i + SIDE + 1, i, i + SIDE + 1, i + SIDE};
		if (i % SIDE + 1 < SIDE && i / SIDE + 1 < SIDE)
			memcpy(indices + 6 * count++, cell, sizeof cell);
	}
	count *= 2;
	for (unsigned i = OWN; i < VERTICES; i++)
		memcpy(p[i], (float[3]){(float)i, (float)(i * i), 1}, sizeof *p);
	n[1][0] = 0.6f, n[1][2] = 0.8f; /* its tangent is (.8, 0, -.6), that of 0 is x */
	n[OWN][0] = 1, n[OWN + 1][0] = -3; /* along x */
	n[OWN + 2][1] = 1, n[OWN + 3][2] = -1, n[OWN + 5][0] = NAN, n[OWN + 6][1] = -2, n[OWN + 7][0] = 1e-30f;
	n[OWN + 8][2] = INFINITY;
	memcpy(indices + 3 * count, added, sizeof added);
	count += ADDED;
	for (int turn = 0; turn < 3; turn++) {
		for (size_t c = 3 * (count - ADDED); c < 3 * count; c += 3)
			memcpy(indices + c, (unsigned[3]){indices[c + 1], indices[c + 2], indices[c]},
				3 * sizeof *indices);
		compare_calls(&(nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = count,
			.vertex_count = VERTICES,
			.positions = p[0], .normals = n[0], .texcoords = t[0], .indices = indices}, NMTAN_REPAIR_ON);
	}
}

/* Meshes with edges that the published sort leaves unsorted, and rows far away that no corner has: the cells that
 * decide how the edges are paired are those of the others. */
TEST(rows_without_corners_move_no_cells)
{
	enum { COLUMNS = 16, ROWS = 10, QUADS = COLUMNS * ROWS, USED = (COLUMNS + 1) * (ROWS + 1) };
	enum { SEEDS = 400, TAIL = 12, TRIANGLES = 2 * QUADS + TAIL };
	static float p[USED + 2][3], n[USED + 2][3], t[USED + 2][2];
	static unsigned indices[TRIANGLES][3];
	const nmtan_mesh lattice = {.struct_bytes = sizeof lattice, .face_count = TRIANGLES, .vertex_count = USED + 2,
		.positions = p[0], .normals = n[0], .texcoords = t[0], .indices = indices[0]};
	const nmtan_mesh mesh = nt_filled(&lattice);
	size_t differ = 0;
	for (uint64_t seed = 0; seed < SEEDS; seed++) {
		nt_random random = nt_random_seed(seed);
		for (unsigned v = 0; v < USED + 2; v++) {
			const float x = (float)(v % (COLUMNS + 1)), y = (float)(v / (COLUMNS + 1)) / 4;
			memcpy(p[v], (float[3]){x, y, 0}, sizeof *p);
			memcpy(n[v], (float[3]){0, 0, 1}, sizeof *n);
			for (int i = 0; i < 2; i++)
				t[v][i] = (float)nt_random_below(&random, 64) / 64;
		}
		p[USED][0] = -9.0f * (float)(1 + seed % 3);
		p[USED + 1][1] = 40.0f * (float)(seed % 5);
		for (unsigned q = 0; q < QUADS; q++) {
			const unsigned a = q / COLUMNS * (COLUMNS + 1) + q % COLUMNS, d = a + COLUMNS + 1;
			memcpy(indices[2 * q], (unsigned[6]){a, a + 1, d + 1, a, d + 1, d}, 2 * sizeof *indices);
		}
		for (unsigned i = 2 * QUADS; i < TRIANGLES; i++)
			for (int k = 0; k < 3; k++)
				indices[i][k] = nt_random_below(&random, USED);
		nt_result expected = nt_result_define(&mesh, 3 * TRIANGLES, false);
		differ += nt_compare_run("rows without corners", &mesh, 3 * TRIANGLES, &expected, false, nt_cpu_best(),
			1, &nt_usual_plan);
		nt_result_free(&expected);
	}
	assert_int_equal(differ, 0);
}

/* Scratch comes in blocks of 64 KiB, so the meshes are made large enough for many of them: a grid beside
 * which every nasty mesh is placed. */
TEST(every_failed_allocation_is_told)
{
	enum { SIDE = 150 };
	const size_t corners = 6 * SIDE * SIDE;
	float *p = malloc(corners * 12), *n = malloc(corners * 12), *t = malloc(corners * 8);
	for (size_t c = 0; c < corners; c++) {
		static const unsigned char at[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
		const size_t cell = c / 6;
		const float x = (float)(cell % SIDE + at[c % 6][0]), y = (float)(cell / SIDE + at[c % 6][1]);
		/* folds, so that there are both orientations, undecided and complex vertices, collapsed faces */
		memcpy(p + 3 * c, (float[3]){x, y, cell % 7 == 0 ? 0.0f : 0.1f * x}, 12);
		memcpy(n + 3 * c, (float[3]){0, 0, 1}, 12);
		memcpy(t + 2 * c, (float[2]){cell % 11 == 0 ? 0.0f : fabsf(x - 40.0f), cell % 13 == 0 ? x : y}, 8);
	}
	memcpy(p + 3 * 300, p, 12 * 2);
	memcpy(p, p + 3, 12);
	const nmtan_mesh loose = {.struct_bytes = sizeof loose, .face_count = corners / 3,
		.vertex_count = corners, .positions = p, .normals = n,
		.texcoords = t};
	const nmtan_mesh mesh = nt_filled(&loose);
	nt_result r = nt_result_make(corners);
	for (unsigned i = 0; i < 4; i++) {
		const unsigned threads = i % 2 ? 3 : 1, bin_bits = i < 2 ? 0 : 9;
		const nt_fast_plan plan = {.grain = 1, .bin_bits = bin_bits};
		size_t allowed = 0;
		while (nt_solve_within(&mesh, corners, &r, i < 2, allowed, threads, &plan) == NMTAN_ERROR_MEMORY)
			allowed++;
		assert_int_equal(nt_solve_within(&mesh, corners, &r, i < 2, allowed, threads, &plan), NMTAN_OK);
		assert_in_range(allowed, 8, 100);
	}
	nt_result_free(&r);
	free(p);
	free(n);
	free(t);
}
