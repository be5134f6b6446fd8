/* SPDX-License-Identifier: MIT */
/*
 * Repair: what must hold on any mesh, and what is left alone. The meshes are the goldens (slivers,
 * collapsed triangles, soups) and hand-made ones whose MikkTSpace answer is known to be unusable.
 */
#include "test.h"
#include <math.h>
#include <stdio.h>
#include "golden.h"
#include "measure.h"
#include "oracle128.h"
#include "surfaces.h"
#include "tangent/frames.h"
#include "tangent/weigh.h"
#include "topology/corners.h"

/* |T| within 32 units in the last place of 1, finite. */
static bool is_unit(const float *t)
{
	const double squared = (double)t[0] * t[0] + (double)t[1] * t[1] + (double)t[2] * t[2];
	return isfinite(squared) && fabs(squared - 1.0) <= 33 * 1.1920929e-7;
}

static bool is_parallel(const float *t, const float *n)
{
	const double x = (double)n[1] * t[2] - (double)n[2] * t[1];
	const double y = (double)n[2] * t[0] - (double)n[0] * t[2];
	const double z = (double)n[0] * t[1] - (double)n[1] * t[0];
	const double squared = (double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2];
	return squared > 0 && isfinite(squared) && x * x + y * y + z * z < 1e-6 * squared;
}

/* More than 2^-10 off perpendicular to a normal of unit length. */
static bool leans(const float *t, const float *n)
{
	const double along = (double)n[0] * t[0] + (double)n[1] * t[1] + (double)n[2] * t[2];
	const double squared = (double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2];
	return fabs(squared - 1) <= 1.0 / 2048 && fabs(along) > 1.0 / 1024 + 1e-9;
}

/* MikkTSpace's default if no triangle contributes; one may give the same. */
static bool may_be_unassigned(const float *t)
{
	return t[0] == 1 && t[1] == 0 && t[2] == 0 && t[3] == -1;
}

typedef struct tally {
	size_t corners, repaired, leaning;
} tally;

/* Solves a mesh with and without repair and checks every promise of nmtan.h on every face. */
static void check_promises(const nmtan_mesh *given, size_t corner_count, nmtan_method method, tally *sum)
{
	nmtan_mesh mesh = *given;
	mesh.position_stride_bytes = mesh.normal_stride_bytes = 12;
	mesh.texcoord_stride_bytes = 8;
	const nmtan_output raw = {.struct_bytes = sizeof raw, .tangents = malloc(16 * corner_count)};
	const nmtan_output mended = {.struct_bytes = sizeof mended, .tangents = malloc(16 * corner_count)};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	const nmtan_options off = {.struct_bytes = sizeof off, .method = method, .repair = NMTAN_REPAIR_OFF};
	const nmtan_options on = {.struct_bytes = sizeof on, .method = method};
	assert_int_equal(nmtan_tangents(&mesh, &off, &raw, NULL), NMTAN_OK);
	assert_int_equal(nmtan_tangents(&mesh, &on, &mended, &counts), NMTAN_OK);
	size_t first = 0, changed = 0;
	for (size_t face = 0; face < mesh.face_count; face++) {
		const size_t size = nt_face_size(&mesh, face);
		nt_fold fold;
		const int orientation = nt_face_orientation(&mesh, face, first, false, &fold);
		const int sign = fold == NT_FOLDED_EVENLY ? 0 : orientation;
		bool agree = true;
		for (size_t c = first; c < first + size; c++)
			agree = agree && raw.tangents[4 * c + 3] == raw.tangents[4 * first + 3] &&
				(sign == 0 || raw.tangents[4 * c + 3] == (float)sign);
		for (size_t c = first; c < first + size; c++) {
			const float *before = raw.tangents + 4 * c, *after = mended.tangents + 4 * c;
			const float *n = nt_normal(&mesh, nt_vertex_of(&mesh, c));
			assert_true(is_unit(after));
			assert_false(is_parallel(after, n));
			assert_false(leans(after, n));
			assert_true(after[3] == mended.tangents[4 * first + 3]);
			assert_true(fabsf(after[3]) == 1.0f && (sign == 0 || after[3] == (float)sign));
			const bool sound = is_unit(before) && !is_parallel(before, n);
			/* a sum of one orientation for a face without one is a choice that a mirrored twin makes,
			 * too */
			const bool chosen = orientation == 0 && method != NMTAN_METHOD_MIKKTSPACE &&
				method != NMTAN_METHOD_MIKKTSPACE_SORTED;
			if (agree && sound && !leans(before, n) && !may_be_unassigned(before) && !chosen)
				assert_memory_equal(before, after, 16);
			changed += memcmp(before, after, 16) != 0;
			sum->leaning += sound && leans(before, n) && !may_be_unassigned(before);
		}
		first += size;
	}
	const nmtan_counts *c = &counts;
	const size_t counted = c->repaired_zero + c->repaired_not_finite + c->repaired_parallel +
			       c->repaired_sign + c->repaired_unassigned + c->repaired_leaning;
	assert_true(changed <= counted);
	sum->corners += corner_count;
	sum->repaired += counted;
	free(raw.tangents);
	free(mended.tangents);
}

static void check_golden(const char *path, const nt_golden *golden, void *context)
{
	(void)path;
	const nmtan_mesh mesh = nt_golden_mesh(golden);
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++)
		check_promises(&mesh, golden->corner_count, (nmtan_method)method, context);
}

/* 68: counted in the reference's own bytes, which lie in the goldens, by another program (issue 12). */
static void leaning_answers_of_the_reference_are_counted(const char *path, const nt_golden *golden, void *context)
{
	(void)path;
	const nmtan_mesh mesh = nt_golden_mesh(golden);
	const nmtan_output output = {.struct_bytes = sizeof output,
		.tangents = malloc(16 * (size_t)golden->corner_count)};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, &counts), NMTAN_OK);
	size_t *sums = context;
	sums[0] += counts.repaired_leaning;
	for (size_t c = 0; c < golden->corner_count; c++) {
		const float *t = golden->tangents + 4 * c, *n = golden->normals + 3 * c;
		sums[1] += leans(t, n) && is_unit(t) && !is_parallel(t, n) && !may_be_unassigned(t);
	}
	free(output.tangents);
}

TEST(the_reference_leans_on_68_corners)
{
	size_t sums[2] = {0, 0};
	assert_int_equal(nt_golden_each(NT_DATA_DIR "/golden", leaning_answers_of_the_reference_are_counted, sums), 46);
	assert_int_equal(sums[0], 68);
	assert_int_equal(sums[1], 68);
}

TEST(promises_hold_on_every_golden_mesh)
{
	tally sum = {0};
	assert_int_equal(nt_golden_each(NT_DATA_DIR "/golden", check_golden, &sum), 46);
	assert_true(sum.repaired > 0);
}

/* A 2x2 grid in the plane z = 0 with u along +x and v along +y, texture coordinates and positions
 * scaled: the frame is (1,0,0) with w = 1 whatever the scale. */
static void check_scaled_grid(float uv_scale, float scale)
{
	float positions[9][3], normals[9][3], texcoords[9][2];
	uint32_t indices[24];
	for (int v = 0; v < 9; v++) {
		const float x = (float)(v % 3), y = (float)(v / 3);
		memcpy(positions[v], (float[3]){x * scale, y * scale, 0}, 12);
		memcpy(normals[v], (float[3]){0, 0, 1}, 12);
		memcpy(texcoords[v], (float[2]){x * uv_scale, y * uv_scale}, 8);
	}
	size_t n = 0;
	for (uint32_t y = 0; y < 2; y++) {
		for (uint32_t x = 0; x < 2; x++) {
			const uint32_t a = 3 * y + x;
			const uint32_t corners[6] = {a, a + 1, a + 4, a, a + 4, a + 3};
			memcpy(indices + n, corners, sizeof corners);
			n += 6;
		}
	}
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 8, .vertex_count = 9,
		.indices = indices,
		.positions = &positions[0][0], .normals = &normals[0][0], .texcoords = &texcoords[0][0]};
	float tangents[24][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, NULL), NMTAN_OK);
	for (int c = 0; c < 24; c++) {
		assert_true(fabsf(tangents[c][0] - 1.0f) < 1e-6f);
		assert_true(fabsf(tangents[c][1]) < 1e-6f && fabsf(tangents[c][2]) < 1e-6f);
		assert_true(tangents[c][3] == 1.0f);
	}
}

TEST(frames_survive_extreme_scales)
{
	for (int exponent = -30; exponent <= 30; exponent += 5) {
		check_scaled_grid(powf(10.0f, (float)exponent), 1.0f);
		check_scaled_grid(1.0f, powf(10.0f, (float)exponent));
		check_scaled_grid(powf(10.0f, (float)exponent), powf(10.0f, (float)-exponent));
	}
}

/* All texture coordinates equal: no direction is right, but the answer is a unit vector perpendicular to
 * the normal, for every normal. */
TEST(missing_texture_space_gives_a_perpendicular)
{
	for (int i = 0; i < 200; i++) {
		const float a = (float)i * 0.7f, z = (float)(i % 21 - 10) / 10.0f;
		const float r = sqrtf(1.0f - z * z);
		float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, normals[3][3];
		float texcoords[3][2] = {{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}};
		for (int v = 0; v < 3; v++)
			memcpy(normals[v], (float[3]){r * cosf(a), r * sinf(a), z}, 12);
		const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
			.positions = &positions[0][0], .normals = &normals[0][0],
			.texcoords = &texcoords[0][0]};
		tally sum = {0};
		check_promises(&mesh, 3, NMTAN_METHOD_MIKKTSPACE, &sum);
		float tangents[3][4];
		const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
		nmtan_counts counts = NMTAN_COUNTS_INIT;
		assert_int_equal(nmtan_tangents(&mesh, NULL, &output, &counts), NMTAN_OK);
		assert_int_equal(counts.repaired_unassigned, 3);
	}
}

/* Vertices that differ in the sign of a zero alone are one vertex, which has one tangent: that of the first normal,
 * whichever it is. Each corner has no average. */
TEST(missing_texture_space_gives_equal_vertices_one_tangent)
{
	for (int zeros = 0; zeros < 3; zeros++) {
		const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, texcoords[4][2] = {{0, 0}};
		const float normals[4][3] = {{zeros == 1 ? -0.0f : 0.0f, 0.6f, 0.8f}, {0, 0, -1}, {0.6f, 0.8f, 0},
			{zeros == 2 ? -0.0f : 0.0f, 0.6f, 0.8f}};
		const unsigned indices[6] = {0, 1, 2, 3, 2, 1};
		const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 2, .vertex_count = 4,
			.positions = &positions[0][0], .normals = &normals[0][0], .texcoords = &texcoords[0][0],
			.indices = indices};
		float tangents[6][4];
		uint8_t faults[6];
		const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0],
			.corner_faults = faults};
		assert_int_equal(nmtan_tangents(&mesh, NULL, &output, NULL), NMTAN_OK);
		for (int c = 0; c < 6; c++) {
			const float *n = normals[c == 3 ? 0 : indices[c]];
			const nt_dvec3 t = nt_dvec3_perpendicular(nt_weigh_normal(n[0], n[1], n[2]));
			assert_memory_equal(tangents[c], ((float[4]){(float)t.x, (float)t.y, (float)t.z, 1.0f}), 16);
			assert_int_equal(faults[c], NMTAN_FAULT_UNASSIGNED | NMTAN_FAULT_NO_AVERAGE);
		}
	}
}

typedef struct three {
	float positions[3][3], normals[3][3], texcoords[3][2];
} three;

static nmtan_mesh three_mesh(const three *t)
{
	return (nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = 1, .vertex_count = 3,
		.positions = &t->positions[0][0],
		.normals = &t->normals[0][0], .texcoords = &t->texcoords[0][0]};
}

/* The triangle lies across N = (.8, .6, 0), beside which MikkTSpace's placeholder (1, 0, 0) leans by .8. In float its
 * UV determinant is 0, exactly it is 1.05 * .3 - .9 * .35 in the floats next to these, whose sign the integers of the
 * oracle know. */
TEST(a_triangle_without_a_float_determinant_is_repaired)
{
	const three plain = {{{0, 0, 0}, {-.6f, .8f, 0}, {0, 0, 1}}, {{.8f, .6f, 0}, {.8f, .6f, 0}, {.8f, .6f, 0}},
		{{0, 0}, {1.05f, -.9f}, {.35f, -.3f}}};
	three swapped = plain;
	memcpy(swapped.texcoords[1], plain.texcoords[2], 8);
	memcpy(swapped.texcoords[2], plain.texcoords[1], 8);
	three without = plain;
	memset(without.texcoords, 0, sizeof without.texcoords);
	const three *all[] = {&plain, &swapped, &without};
	for (int i = 0; i < 3; i++) {
		const nmtan_mesh mesh = three_mesh(all[i]);
		const int sign = oracle_sign(all[i]->texcoords[0], all[i]->texcoords[1], all[i]->texcoords[2]);
		assert_int_equal(sign != 0, i < 2);
		for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++) {
			tally sum = {0};
			float tangents[3][4];
			const nmtan_output output = {.struct_bytes = sizeof output,
				.tangents = &tangents[0][0]};
			nmtan_counts counts = NMTAN_COUNTS_INIT;
			const nmtan_options options = {.struct_bytes = sizeof options,
				.method = (nmtan_method)method};
			check_promises(&mesh, 3, (nmtan_method)method, &sum);
			assert_int_equal(nmtan_tangents(&mesh, &options, &output, &counts), NMTAN_OK);
			oracle_corner exact[3];
			assert_true(oracle_solve(&mesh, ORACLE_ANGLE, exact));
			for (int c = 0; c < 3 && sign; c++)
				for (int k = 0; k < 3; k++)
					assert_true(fabs(tangents[c][k] - exact[c].t[k]) < 1e-6);
			if (method == NMTAN_METHOD_MIKKTSPACE || method == NMTAN_METHOD_MIKKTSPACE_SORTED)
				assert_int_equal(counts.repaired_unassigned, 3);
		}
	}
}

/* A torus at scales where MikkTSpace's determinants are 0 or its directions vanish, and its mirrored twin. 0.02
 * degrees: what rounding 16 by 16 texture coordinates to floats of any scale may do to a direction is below 0.0001,
 * the corners that stay MikkTSpace's own are within this. */
TEST(twins_at_tiny_scales_are_repaired_alike)
{
	const float scales[][2] = {{1, 1}, {1e-18f, 1}, {1e-30f, 1}, {1, 1e-25f}};
	for (int i = 0; i < 4; i++) {
		nt_owned torus = nt_surface_grid(NT_TORUS, 16, 16, 0, 1);
		assert_int_equal(torus.corner_count, 1536);
		size_t repaired[2];
		float tangents[2][1536][4];
		for (int mirrored = 0; mirrored < 2; mirrored++) {
			for (size_t v = 0; v < torus.mesh.vertex_count; v++) {
				for (int k = 0; k < 2 && !mirrored; k++)
					torus.texcoords[v][k] *= scales[i][0];
				for (int k = 0; k < 3 && !mirrored; k++)
					torus.positions[v][k] *= scales[i][1];
				torus.texcoords[v][0] *= mirrored ? -1 : 1;
			}
			const nmtan_output output = {.struct_bytes = sizeof output,
				.tangents = &tangents[mirrored][0][0]};
			nmtan_counts counts = NMTAN_COUNTS_INIT;
			assert_int_equal(nmtan_tangents(&torus.mesh, NULL, &output, &counts), NMTAN_OK);
			const nmtan_counts *n = &counts;
			repaired[mirrored] = n->repaired_zero + n->repaired_not_finite + n->repaired_parallel +
					     n->repaired_sign + n->repaired_unassigned + n->repaired_leaning;
			oracle_corner exact[1536];
			assert_true(oracle_solve(&torus.mesh, ORACLE_ANGLE, exact));
			for (int c = 0; c < 1536; c++) {
				assert_true(measure_degrees(tangents[mirrored][c], exact[c].t) < 0.02);
				assert_true(tangents[mirrored][c][3] == (float)exact[c].sign);
			}
		}
		assert_int_equal(repaired[0], repaired[1]);
		assert_int_equal(repaired[0], i ? 1536 : 0);
		for (int c = 0; c < 1536; c++)
			for (int k = 0; k < 4; k++)
				assert_true(tangents[1][c][k] == -tangents[0][c][k]);
		nt_owned_free(&torus);
	}
}

/* A sliver in v that turns when 1 is taken from it. det = (v3 - v1) - (v2 - v1) / 2 with v1 = 0 is positive for
 * v2 = 2.75 and v3 = 1.45 units of 2^-24; v - 1 has steps of one unit, so that they become 3 and 1, and the
 * determinant -0.5. */
TEST(stored_texture_coordinates_decide_the_sign)
{
	const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
	const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	const float unit = 5.9604645e-8f;
	const float texcoords[3][2] = {{0, 0}, {1, 2.75f * unit}, {0.5f, 1.45f * unit}};
	const nmtan_stored_uv stored = {.struct_bytes = sizeof stored, .v_offset = -1};
	nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
		.positions = &positions[0][0],
		.normals = &normals[0][0], .texcoords = &texcoords[0][0], .stored = &stored};
	float tangents[3][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, &counts), NMTAN_OK);
	for (int c = 0; c < 3; c++)
		assert_true(tangents[c][3] == -1.0f);
	assert_int_equal(counts.stored_differently, 1);
	mesh.stored = NULL;
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, &counts), NMTAN_OK);
	assert_true(tangents[0][3] == 1.0f);
	assert_int_equal(counts.stored_differently, 0);
}

/* u is scaled by 3 and rounded. In units of 2^-23 b is at u = 1 + 3 and c at 0.875 + 2.5, with v = 1 and 0.875:
 * det = 0.875 * 3 - 2.5 = 0.125 is positive. Floats from 2 to 4 have steps of 2 units: 3 b = 3 + 9 is a tie
 * and becomes 3 + 8, 3 c = 2.625 + 7.5 becomes 2.625 + 8, and the determinant 0.875 * 8 - 8 = -1. */
TEST(coordinates_before_a_transform_decide_the_sign)
{
	const float positions[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
	const float normals[3][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	const float unit = 1.1920929e-7f;
	const float exact[3][2] = {{0, 0}, {1 + 3 * unit, 1}, {0.875f + 2.5f * unit, 0.875f}};
	float scaled[3][2];
	for (int k = 0; k < 3; k++) {
		scaled[k][0] = 3 * exact[k][0];
		scaled[k][1] = exact[k][1];
	}
	assert_int_equal(nmtan_orientation(exact[0], exact[1], exact[2]), 1);
	assert_int_equal(nmtan_orientation(scaled[0], scaled[1], scaled[2]), -1);
	for (int method = NMTAN_METHOD_MIKKTSPACE; method <= NMTAN_METHOD_MIKKTSPACE_SORTED; method++)
		for (int mirrored = 0; mirrored < 2; mirrored++) {
			const nmtan_stored_uv stored = {.struct_bytes = sizeof stored,
				.texcoords = &exact[0][0], .mirrored = mirrored};
			nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 3,
				.positions = &positions[0][0],
				.normals = &normals[0][0], .texcoords = &scaled[0][0], .stored = &stored};
			const nmtan_options options = {.struct_bytes = sizeof options,
				.method = (nmtan_method)method};
			float tangents[3][4], split[6][4];
			uint32_t indices[3], sources[3];
			const nmtan_output output = {.struct_bytes = sizeof output,
				.tangents = &tangents[0][0]};
			nmtan_split_output vertices = {.struct_bytes = sizeof vertices, .indices = indices,
				.sources = sources,
				.source_capacity = 3, .vertex_tangents = &split[0][0]};
			assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
			assert_int_equal(nmtan_vertex_tangents(&mesh, &options, &vertices, NULL), NMTAN_OK);
			for (int c = 0; c < 3; c++) {
				assert_true(tangents[c][3] == (mirrored ? -1.0f : 1.0f));
				assert_memory_equal(split[indices[c]], tangents[c], sizeof tangents[c]);
			}
		}
}

/* With the fourth corner at (.75, .5) the shorter diagonal is 1-3, and the determinants of (0,0) (1,0) (.75,.5) and
 * (1,0) (1,1) (.75,.5) are .5 and .25. At (1.25, .5) the second is -.25, and along 0-2 they are 1 and -.75: the outline
 * crosses itself. An arrowhead does not: along its shorter diagonal, which lies outside, they are 16 and -2. */
TEST(folded_quad_takes_the_sign_of_its_larger_half)
{
	const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
	const float normals[4][3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
	float texcoords[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0.75f, 0.5f}};
	const uint8_t four = 4;
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 4,
		.face_sizes = &four,
		.positions = &positions[0][0], .normals = &normals[0][0],
		.texcoords = &texcoords[0][0]};
	float tangents[4][4];
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = &tangents[0][0]};
	nmtan_counts counts = NMTAN_COUNTS_INIT;
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, &counts), NMTAN_OK);
	assert_int_equal(counts.folded_quads, 0);
	texcoords[3][0] = 1.25f;
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, &counts), NMTAN_OK);
	assert_int_equal(counts.folded_quads, 1);
	for (int c = 0; c < 4; c++)
		assert_true(tangents[c][3] == 1.0f);
	const float arrowhead[4][2] = {{0, 8}, {-1, 0}, {0, 1}, {1, 0}};
	memcpy(texcoords, arrowhead, sizeof texcoords);
	assert_int_equal(nmtan_tangents(&mesh, NULL, &output, &counts), NMTAN_OK);
	assert_int_equal(counts.folded_quads, 0);
	assert_int_equal(counts.mirrored, 1);
	for (int c = 0; c < 4; c++)
		assert_true(tangents[c][3] == 1.0f);
}

/* Solves one quad that lies in z = 0, its corners from `begin` on, texture coordinates mirrored in u or not. */
static void solve_quad(const float p[4][2], const float uv[4][2], int begin, bool mirrored, nmtan_repair repair,
	float tangents[4][4])
{
	float positions[4][3], normals[4][3], texcoords[4][2], rows[4][4];
	for (int k = 0; k < 4; k++) {
		const int from = (begin + k) % 4;
		memcpy(positions[k], (float[3]){p[from][0], p[from][1], 0}, 12);
		memcpy(normals[k], (float[3]){0, 0, 1}, 12);
		memcpy(texcoords[k], (float[2]){mirrored ? -uv[from][0] : uv[from][0], uv[from][1]}, 8);
	}
	const uint8_t four = 4;
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = 1, .vertex_count = 4, .face_sizes = &four,
		.positions = positions[0], .normals = normals[0], .texcoords = texcoords[0]};
	const nmtan_options options = {.struct_bytes = sizeof options, .repair = repair};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = rows[0]};
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
	for (int k = 0; k < 4; k++)
		memcpy(tangents[(begin + k) % 4], rows[k], sizeof rows[k]);
}

/* The quad is cut along 0-2, since its diagonals are equal in UV space. Its second and third corners are at one place,
 * so that 0-2-3 alone is visible; its determinant is 1 * 1 - 0 * 1, that of the other half -1, and dP/du is (1, 0, 0).
 * With the third and fourth corner at one place 0-1-2 is, with (0, 1), (1, 0) at (1, 0), (0, 1): dP/du is (0, 1, 0). */
TEST(a_collapsed_half_of_a_quad_has_no_vote)
{
	static const float bow_tie[4][2] = {{0, 0}, {0, 1}, {1, 0}, {1, 1}};
	static const float places[][4][2] = {{{0, 0}, {1, 0}, {1, 0}, {0, 1}}, {{0, 0}, {1, 0}, {0, 1}, {0, 1}}};
	for (int i = 0; i < 16; i++) {
		const int second = i / 8;
		const bool mirrored = i / 4 % 2;
		const float sign = (second ? -1.0f : 1.0f) * (mirrored ? -1.0f : 1.0f), u = mirrored ? -1.0f : 1.0f;
		float raw[4][4], tangents[4][4];
		solve_quad(places[second], bow_tie, i % 4, mirrored, NMTAN_REPAIR_OFF, raw);
		solve_quad(places[second], bow_tie, i % 4, mirrored, NMTAN_REPAIR_ON, tangents);
		for (int c = 0; c < 4; c++) {
			assert_true(tangents[c][3] == sign);
			if (c == (second ? 3 : 1))
				continue; /* of the collapsed half alone */
			assert_memory_equal(tangents[c], ((float[4]){second ? 0 : u, second ? u : 0, 0, sign}), 16);
			assert_memory_equal(tangents[c], raw[c], 16);
		}
	}
}

/* Halves of one area in UV space, exactly and but for rounding: four tenths and three tenths are no floats. */
TEST(a_tie_of_halves_changes_nothing)
{
	static const float square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
	static const float ties[][4][2] = {{{0, 0}, {0, 1}, {1, 0}, {1, 1}}, {{0, 0}, {1, 0}, {0, 1}, {1, 1}},
		{{1, 0.4f}, {0.3f, 0.1f}, {0.6f, 0.6f}, {0.5f, 0}}, {{0.7f, 0.3f}, {0.2f, 0.4f}, {1, 0}, {0, 0.6f}}};
	for (int i = 0; i < 32; i++) {
		float raw[4][4], tangents[4][4];
		solve_quad(square, ties[i / 8], i % 4, i / 4 % 2, NMTAN_REPAIR_OFF, raw);
		solve_quad(square, ties[i / 8], i % 4, i / 4 % 2, NMTAN_REPAIR_ON, tangents);
		for (int c = 0; c < 4; c++) { /* where the halves meet they may cancel */
			assert_true(tangents[c][3] == raw[c][3]);
			if (is_unit(raw[c]))
				assert_memory_equal(tangents[c], raw[c], sizeof raw[c]);
		}
	}
}

/* Quads on a lattice, and normals along the dP/du of three of their corners, as floats have it: what is left of such a
 * direction across its normal is rounding, which the sums may take for a direction. 8 of 100 000 such quads had a
 * tangent along its normal. */
TEST(noise_along_the_normal_is_no_answer)
{
	enum { QUADS = 500, MESHES = 120, CORNERS = 4 * QUADS };
	static const float places[] = {-1, 0, 1}, coordinates[] = {0, -1, 1, 16777216, -999999, -1000000.38f};
	static float p[CORNERS][3], n[CORNERS][3], t[CORNERS][2];
	static uint8_t sizes[QUADS];
	nt_random random = nt_random_seed(48);
	memset(sizes, 4, sizeof sizes);
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = QUADS, .vertex_count = CORNERS,
		.face_sizes = sizes, .positions = p[0], .normals = n[0], .texcoords = t[0]};
	tally sum = {0};
	for (int m = 0; m < MESHES; m++) {
		for (size_t c = 0; c < CORNERS; c++) {
			for (int k = 0; k < 3; k++)
				p[c][k] = places[nt_random_below(&random, 3)];
			for (int k = 0; k < 2; k++)
				t[c][k] = coordinates[nt_random_below(&random, 6)];
		}
		for (size_t first = 0; first < CORNERS; first += 4) {
			const size_t k = nt_random_below(&random, 4);
			const size_t a = first + k, b = first + (k + 1) % 4, c = first + (k + 2) % 4;
			const double v1 = (double)t[b][1] - t[a][1], v2 = (double)t[c][1] - t[a][1];
			const nt_dvec3 d1 = nt_dvec3_sub(nt_dvec3_load(p[b]), nt_dvec3_load(p[a]));
			const nt_dvec3 d2 = nt_dvec3_sub(nt_dvec3_load(p[c]), nt_dvec3_load(p[a]));
			nt_dvec3 u = nt_dvec3_sub(nt_dvec3_scale(v2, d1), nt_dvec3_scale(v1, d2));
			if (!nt_dvec3_normalise(&u))
				u = (nt_dvec3){0, 0, 1};
			for (size_t i = first; i < first + 4; i++)
				nt_dvec3_store(nt_dvec3_scale(nt_random_below(&random, 2) ? 1 : -1, u), n[i]);
		}
		check_promises(&mesh, CORNERS, (nmtan_method)(m % (NMTAN_METHOD_MIKKTSPACE_SORTED + 1)), &sum);
	}
	assert_true(sum.repaired > 0);
}

/* A sheet with normals along dP/du at half of its vertices, and texture coordinates that have collapsed in places: all
 * of triangles, and of quads too. */
TEST(threads_repair_the_same)
{
	enum { SIDE = 100, VERTICES = (SIDE + 1) * (SIDE + 1), CORNERS = 6 * SIDE * SIDE };
	static float p[VERTICES][3], n[VERTICES][3], t[VERTICES][2];
	static uint32_t indices[CORNERS];
	static uint8_t sizes[2 * SIDE * SIDE];
	nt_random random = nt_random_seed(26);
	for (uint32_t v = 0; v < VERTICES; v++) {
		memcpy(p[v], (float[3]){(float)(v % (SIDE + 1)), (float)(v / (SIDE + 1)), 0}, sizeof *p);
		memcpy(n[v], (float[3]){(float)(v % 2), 0, (float)((v + 1) % 2)}, sizeof *n);
		memcpy(t[v], nt_random_below(&random, 5) ? p[v] : p[0], sizeof *t);
	}
	for (int quads = 0; quads < 2; quads++) {
		size_t faces = 0, corners = 0;
		for (uint32_t q = 0; q < SIDE * SIDE; q++) {
			const uint32_t a = q / SIDE * (SIDE + 1) + q % SIDE, d = a + SIDE + 1;
			const bool quad = quads && q % 3 == 0;
			const uint32_t of_quad[4] = {a, a + 1, d + 1, d}, halves[6] = {a, a + 1, d + 1, a, d + 1, d};
			memcpy(indices + corners, quad ? of_quad : halves, (quad ? 4 : 6) * sizeof *indices);
			corners += quad ? 4 : 6;
			sizes[faces] = quad ? 4 : 3;
			sizes[faces + 1] = 3;
			faces += quad ? 1 : 2;
		}
		const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = faces, .vertex_count = VERTICES,
			.face_sizes = quads ? sizes : NULL, .indices = indices, .positions = p[0], .normals = n[0],
			.texcoords = t[0]};
		float *tangents[2] = {malloc(16 * corners), malloc(16 * corners)};
		nmtan_counts counts[2] = {NMTAN_COUNTS_INIT, NMTAN_COUNTS_INIT};
		for (unsigned i = 0; i < 2; i++) {
			const nmtan_options options = {.struct_bytes = sizeof options, .threads = 1 + 4 * i};
			const nmtan_output output = {.struct_bytes = sizeof output, .tangents = tangents[i]};
			assert_int_equal(nmtan_tangents(&mesh, &options, &output, &counts[i]), NMTAN_OK);
		}
		assert_true(counts[0].repaired_parallel + counts[0].repaired_zero > SIDE * SIDE / 2);
		assert_memory_equal(&counts[0], &counts[1], sizeof *counts);
		assert_memory_equal(tangents[0], tangents[1], 16 * corners);
		free(tangents[0]);
		free(tangents[1]);
	}
}
