/* SPDX-License-Identifier: MIT */
/*
 * corner_faults: every bit on a mesh that has it, and on random meshes what the header says: a bit is set on as many
 * corners as are counted, and corners without a bit have MikkTSpace's bytes.
 */
#include "test.h"
#include <math.h>
#include <stdbool.h>
#include "nmtan.h"

enum { REASONS = NMTAN_FAULT_ZERO | NMTAN_FAULT_NOT_FINITE | NMTAN_FAULT_PARALLEL | NMTAN_FAULT_SIGN |
	NMTAN_FAULT_UNASSIGNED | NMTAN_FAULT_LEANING };

/* The faults at the corners of a triangle whose three normals are n. */
static void faults_of(const float positions[9], const float n[3], const float uvs[6], const float *stored_uvs,
	nmtan_method method, uint8_t faults[3])
{
	float normals[9], tangents[12];
	for (int i = 0; i < 9; i++)
		normals[i] = n[i % 3];
	nmtan_stored_uv stored = NMTAN_STORED_UV_INIT;
	stored.texcoords = stored_uvs;
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
		.positions = positions, .normals = normals, .texcoords = uvs, .stored = &stored};
	const nmtan_options options = {.struct_bytes = sizeof options, .method = method};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents, .corner_faults = faults};
	memset(faults, 0xff, 3);
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
}

static void expect(const uint8_t faults[3], uint8_t expected)
{
	for (int k = 0; k < 3; k++)
		assert_int_equal(faults[k], expected);
}

static const float flat[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, up[3] = {0, 0, 1}, square[6] = {0, 0, 1, 0, 0, 1};

TEST(a_corner_in_order_has_no_bit)
{
	uint8_t faults[3];
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++) {
		faults_of(flat, up, square, NULL, (nmtan_method)method, faults);
		expect(faults, 0);
	}
}

TEST(every_reason_has_its_bit)
{
	static const float nowhere[6] = {0, 0, 0, 0, 0, 0}, turned[6] = {0, 0, -1, 0, 0, 1};
	/* its determinant is 0 in float, not in truth: the triangle has a frame */
	static const float thin[6] = {0, 0, 1.05f, 0.9f, 0.35f, 0.3f};
	const float along_u[3] = {1, 0, 0}, half[3] = {0.5f, 0, 0}, none[3] = {NAN, 0, 0};
	uint8_t faults[3];
	faults_of(flat, up, nowhere, NULL, NMTAN_METHOD_MIKKTSPACE, faults);
	expect(faults, NMTAN_FAULT_UNASSIGNED | NMTAN_FAULT_NO_AVERAGE);
	faults_of(flat, up, thin, NULL, NMTAN_METHOD_MIKKTSPACE, faults);
	expect(faults, NMTAN_FAULT_UNASSIGNED);
	faults_of(flat, up, square, turned, NMTAN_METHOD_MIKKTSPACE, faults);
	assert_int_equal(faults[0] & REASONS, NMTAN_FAULT_SIGN);
	/* dP/du - (n . dP/du) n: nothing, and three quarters of it, which is along n */
	faults_of(flat, along_u, square, NULL, NMTAN_METHOD_MIKKTSPACE, faults);
	expect(faults, NMTAN_FAULT_ZERO | NMTAN_FAULT_NO_AVERAGE);
	faults_of(flat, half, square, NULL, NMTAN_METHOD_MIKKTSPACE, faults);
	expect(faults, NMTAN_FAULT_PARALLEL | NMTAN_FAULT_NO_AVERAGE);
	faults_of(flat, none, square, NULL, NMTAN_METHOD_MIKKTSPACE, faults);
	assert_int_equal(faults[0] & REASONS, NMTAN_FAULT_NOT_FINITE);
}

/* The triangle stands on (0.6, 0.8, 0), which is its dP/du, and along z; the normal leaves dP/du by `angle`. */
static const float upright[9] = {0, 0, 0, 0.6f, 0.8f, 0, 0, 0, 1};

static void normal_beside_u(float angle, float n[3])
{
	n[0] = 0.6f + 0.8f * angle;
	n[1] = 0.8f - 0.6f * angle;
	n[2] = 0;
}

/* By 1e-6 to 1e-4 radians: what float leaves of the projection is rounded to 2^-24. */
TEST(a_direction_that_float_lost_is_leaning)
{
	size_t leaning = 0;
	for (int i = 1; i <= 100; i++) {
		float n[3];
		uint8_t faults[3];
		normal_beside_u(1e-6f * (float)i, n);
		faults_of(upright, n, square, NULL, NMTAN_METHOD_MIKKTSPACE, faults);
		for (int k = 0; k < 3; k++)
			leaning += faults[k] == NMTAN_FAULT_LEANING;
	}
	assert_in_range(leaning, 30, 300);
}

/* 24 bits cancel at 2^-24 radians. Robust's answer is unit and across them, and says that it is ill-conditioned. */
TEST(robust_tells_which_corners_are_ill_conditioned)
{
	const float beside[3] = {0, -1e-9f, 1}, along_z[9] = {0, 0, 0, 0, 0, 1, 0, 1, 0};
	float n[3];
	uint8_t faults[3];
	faults_of(along_z, beside, square, NULL, NMTAN_METHOD_ROBUST, faults);
	for (int k = 0; k < 3; k++)
		assert_true(faults[k] & NMTAN_FAULT_ILL_CONDITIONED);
	normal_beside_u(1e-3f, n);
	faults_of(upright, n, square, NULL, NMTAN_METHOD_ROBUST, faults);
	expect(faults, 0);
}

/* Seen edge-on an angle has lost 30 bits. That moves a sum of two directions, not one. */
TEST(an_angle_alone_is_not_ill_conditioned)
{
	const float edge_on[3] = {1e-9f, 1, 0}, along_z[9] = {0, 0, 0, 0, 0, 1, 0, 1, 0};
	uint8_t faults[3];
	faults_of(along_z, edge_on, square, NULL, NMTAN_METHOD_ROBUST, faults);
	expect(faults, 0);
	/* the second triangle turns at the vertex that both have: its u runs along x + z */
	const float positions[5][3] = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {1, 0, 1}, {0, 1, 0}};
	const float uvs[5][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {0, 2}};
	const uint32_t indices[6] = {0, 1, 2, 0, 3, 4};
	float normals[5][3], tangents[6][4];
	uint8_t both[6];
	for (int v = 0; v < 5; v++)
		memcpy(normals[v], (float[3]){1e-9f, 1, -1e-9f}, sizeof normals[v]);
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2, .vertex_count = 5, .indices = indices,
		.positions = &positions[0][0], .normals = &normals[0][0], .texcoords = &uvs[0][0]};
	const nmtan_options options = {.struct_bytes = sizeof options, .method = NMTAN_METHOD_ROBUST};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0], .corner_faults = both};
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
	for (int c = 0; c < 6; c++)
		assert_true(!(both[c] & NMTAN_FAULT_ILL_CONDITIONED) == (c % 3 != 0));
}

/* Random meshes: triangles and quads over few points, so that faces collapse, fold and meet. */

enum { POINTS = 40, FACES = 60, CORNERS = 4 * FACES };

typedef struct random_mesh {
	float positions[POINTS][3], normals[POINTS][3], uvs[POINTS][2];
	uint32_t indices[CORNERS];
	uint8_t sizes[FACES];
	nmtan_mesh mesh;
	size_t corner_count;
} random_mesh;

static uint32_t below(uint64_t *state, uint32_t count)
{
	*state = *state * 6364136223846793005u + 1442695040888963407u;
	return (uint32_t)(*state >> 33) % count;
}

static void make_random(uint64_t seed, bool quads, random_mesh *m)
{
	static const float normals[][3] = {{0, 0, 1}, {1, 0, 0}, {0.6f, 0.8f, 0}, {0.5f, 0, 0}, {0, 0, 0}, {NAN, 0, 0},
		{0.6f, 0.8f, 3e-7f}, {0, 0, -1}};
	static const float scales[] = {1, 1, 1, 1e-20f, 1e25f};
	uint64_t state = seed;
	m->corner_count = 0;
	const float scale = scales[below(&state, 5)], uv_scale = scales[below(&state, 4)];
	for (int v = 0; v < POINTS; v++) {
		for (int i = 0; i < 3; i++)
			m->positions[v][i] = scale * (float)below(&state, 5);
		for (int i = 0; i < 2; i++)
			m->uvs[v][i] = uv_scale * 0.1f * (float)below(&state, 6);
		memcpy(m->normals[v], normals[below(&state, below(&state, 2) ? 8 : 1)], 12);
	}
	for (int f = 0; f < FACES; f++) {
		m->sizes[f] = quads && below(&state, 2) ? 4 : 3;
		for (int k = 0; k < m->sizes[f]; k++)
			m->indices[m->corner_count++] = below(&state, POINTS);
	}
	m->mesh = (nmtan_mesh){.struct_bytes = sizeof m->mesh, .face_count = FACES, .vertex_count = POINTS,
		.face_sizes = quads ? m->sizes : NULL, .indices = m->indices, .positions = m->positions[0],
		.normals = m->normals[0], .texcoords = m->uvs[0]};
}

static void check_counts(const uint8_t *faults, size_t count, const nmtan_counts *counts, unsigned *met)
{
	const struct {
		nmtan_fault fault;
		size_t counted;
	} rows[] = {{NMTAN_FAULT_ZERO, counts->repaired_zero}, {NMTAN_FAULT_NOT_FINITE, counts->repaired_not_finite},
		{NMTAN_FAULT_PARALLEL, counts->repaired_parallel}, {NMTAN_FAULT_SIGN, counts->repaired_sign},
		{NMTAN_FAULT_UNASSIGNED, counts->repaired_unassigned}, {NMTAN_FAULT_LEANING, counts->repaired_leaning},
		{NMTAN_FAULT_ILL_CONDITIONED, counts->ill_conditioned}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		size_t found = 0;
		for (size_t c = 0; c < count; c++)
			found += (faults[c] & rows[i].fault) != 0;
		assert_int_equal(found, rows[i].counted);
	}
	for (size_t c = 0; c < count; c++) {
		const unsigned reason = faults[c] & REASONS;
		assert_int_equal(reason & (reason - 1), 0);
		assert_true(reason || !(faults[c] & NMTAN_FAULT_NO_AVERAGE));
		*met |= faults[c];
	}
}

TEST(bits_are_what_is_counted_and_other_corners_keep_their_bytes)
{
	unsigned met = 0;
	for (uint64_t seed = 1; seed <= 400; seed++) {
		random_mesh m;
		make_random(seed, seed % 2, &m);
		for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++) {
			float raw[CORNERS][4], tangents[CORNERS][4];
			uint8_t faults[CORNERS + 1] = {[CORNERS] = 0x5a};
			nmtan_options options = {.struct_bytes = sizeof options, .method = (nmtan_method)method};
			nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[0],
				.corner_faults = faults};
			nmtan_counts counts = NMTAN_COUNTS_INIT;
			faults[m.corner_count] = 0x5a;
			assert_int_equal(nmtan_tangents(&m.mesh, &options, &output, &counts), NMTAN_OK);
			check_counts(faults, m.corner_count, &counts, &met);
			assert_int_equal(faults[m.corner_count], 0x5a);
			uint8_t raw_faults[CORNERS];
			options.repair = NMTAN_REPAIR_OFF;
			output.tangents = raw[0];
			output.corner_faults = raw_faults;
			assert_int_equal(nmtan_tangents(&m.mesh, &options, &output, &counts), NMTAN_OK);
			check_counts(raw_faults, m.corner_count, &counts, &met);
			for (size_t c = 0; c < m.corner_count; c++) {
				if (!(faults[c] & REASONS))
					assert_memory_equal(raw[c], tangents[c], 16);
			}
		}
	}
	assert_int_equal(met, 0xff);
}
