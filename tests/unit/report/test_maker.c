/* SPDX-License-Identifier: MIT */
/*
 * Whose tangents a mesh has. Tangents of each method are made by nmtan_tangents() on a bumpy grid, of quads as quads,
 * and put on the triangles that a file has; the maker is found from these.
 */
#include "report/maker.h"
#include "base/bits.h"
#include "report/quads.h"
#include "surfaces.h"
#include "test.h"

#include <math.h>
#include <string.h>

enum { SIDE = 22, QUADS = 400, CORNERS = 6 * QUADS };

static const nmtan_method methods[] = {NMTAN_METHOD_MIKKTSPACE, NMTAN_METHOD_MIKKTSPACE_SORTED, NMTAN_METHOD_AREA,
	NMTAN_METHOD_LENGYEL, NMTAN_METHOD_ROBUST};

typedef struct grid {
	float positions[(SIDE + 1) * (SIDE + 1)][3], normals[(SIDE + 1) * (SIDE + 1)][3],
		texcoords[(SIDE + 1) * (SIDE + 1)][2];
	uint32_t quads[4 * QUADS], triangles[CORNERS];
} grid;

/* Every number is random, so that no two methods agree, and the order of quads, which are cut by their first diagonal.
 * One in six is missing: MikkTSpace takes quads that have only a corner in common as strangers, and the robust method,
 * which has its weights, does not. */
static void make_grid(grid *g, uint64_t seed)
{
	nt_random random = nt_random_seed(seed);
	for (uint32_t v = 0; v < (SIDE + 1) * (SIDE + 1); v++) {
		const double x = v % (SIDE + 1), y = v / (SIDE + 1);
		const double p[3] = {x + 0.6 * nt_random_real(&random), y + 0.6 * nt_random_real(&random),
			0.8 * nt_random_real(&random)};
		const double n[3] = {nt_random_real(&random) - 0.5, nt_random_real(&random) - 0.5, 2.0};
		const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
		for (size_t k = 0; k < 3; k++) {
			g->positions[v][k] = (float)p[k];
			g->normals[v][k] = (float)(n[k] / length);
		}
		g->texcoords[v][0] = (float)((x + 0.6 * nt_random_real(&random)) / SIDE);
		g->texcoords[v][1] = (float)((y + 0.6 * nt_random_real(&random)) / SIDE);
	}
	uint32_t cells[SIDE * SIDE];
	for (uint32_t q = 0; q < SIDE * SIDE; q++) {
		const uint32_t other = nt_random_below(&random, q + 1);
		cells[q] = cells[other];
		cells[other] = q;
	}
	for (uint32_t q = 0; q < QUADS; q++) {
		const uint32_t a = cells[q] / SIDE * (SIDE + 1) + cells[q] % SIDE;
		const uint32_t c[] = {a, a + 1, a + SIDE + 2, a + SIDE + 1};
		memcpy(g->quads + 4 * q, c, sizeof c);
		memcpy(g->triangles + 6 * q, (uint32_t[]){c[0], c[1], c[2], c[0], c[2], c[3]}, 6 * sizeof *c);
	}
}

/* Tangents of the corners of the triangles. */
static void solve(const grid *g, nmtan_method method, bool quads, float (*tangents)[4])
{
	static float of_quads[4 * QUADS][4];
	static const size_t corner_of_quad[] = {0, 1, 2, 0, 2, 3};
	uint8_t sizes[QUADS];
	memset(sizes, 4, sizeof sizes);
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = quads ? QUADS : 2 * QUADS,
		.vertex_count = (SIDE + 1) * (SIDE + 1), .face_sizes = quads ? sizes : NULL,
		.indices = quads ? g->quads : g->triangles, .positions = g->positions[0], .normals = g->normals[0],
		.texcoords = g->texcoords[0]};
	const nmtan_options options = {.struct_bytes = sizeof options, .method = method};
	const nmtan_output output = {.struct_bytes = sizeof output, .tangents = quads ? of_quads[0] : tangents[0]};
	assert_int_equal(nmtan_tangents(&mesh, &options, &output, NULL), NMTAN_OK);
	for (size_t c = 0; quads && c < CORNERS; c++)
		memcpy(tangents[c], of_quads[c / 6 * 4 + corner_of_quad[c % 6]], sizeof *tangents);
}

/* The maker of the triangles with these tangents, each corner a vertex. */
static nt_maker find_with(const grid *g, float (*tangents)[4], bool bytes, bool quads, uint64_t *border)
{
	static float positions[CORNERS][3], normals[CORNERS][3], texcoords[CORNERS][2];
	static uint8_t halves[2 * QUADS];
	for (size_t c = 0; c < CORNERS; c++) {
		memcpy(positions[c], g->positions[g->triangles[c]], sizeof *positions);
		memcpy(normals[c], g->normals[g->triangles[c]], sizeof *normals);
		memcpy(texcoords[c], g->texcoords[g->triangles[c]], sizeof *texcoords);
	}
	const nt_mesh mesh = {.face_count = 2 * QUADS, .corner_count = CORNERS, .vertex_count = CORNERS,
		.source_vertex_count = CORNERS, .positions = positions[0], .normals = normals[0],
		.texcoords = texcoords[0], .tangents = tangents[0], .byte_tangents = bytes};
	nt_maker maker;
	assert_int_equal(nt_pair_quads(&mesh, false, halves), QUADS);
	assert_int_equal(nt_find_maker(&mesh, quads ? halves : NULL, border, 1, &maker), NT_OK);
	return maker;
}

static nt_maker find(const grid *g, float (*tangents)[4], bool bytes, bool quads)
{
	return find_with(g, tangents, bytes, quads, NULL);
}

/* The next grid on which the unfinished sort of MikkTSpace as published shows, or does not. */
static void make_grid_where_sorts(bool differ, grid *g, bool quads)
{
	static float one[CORNERS][4], other[CORNERS][4];
	for (uint64_t seed = 1; seed < 10000; seed++) {
		make_grid(g, seed);
		solve(g, NMTAN_METHOD_MIKKTSPACE, quads, one);
		solve(g, NMTAN_METHOD_MIKKTSPACE_SORTED, quads, other);
		if ((memcmp(one, other, sizeof one) != 0) == differ)
			return;
	}
	fail_msg("the sorts do not show");
}

TEST(every_method_is_found_on_both_kinds_of_faces)
{
	static grid g;
	static float tangents[CORNERS][4];
	for (int quads = 0; quads < 2; quads++) {
		make_grid_where_sorts(true, &g, quads);
		for (size_t i = 0; i < sizeof methods / sizeof *methods; i++) {
			solve(&g, methods[i], quads, tangents);
			const nt_maker maker = find(&g, tangents, false, true);
			assert_true(maker.known);
			assert_int_equal(maker.method, methods[i]);
			assert_int_equal(maker.quads, quads);
			assert_false(maker.inverted);
			assert_true(maker.agreement == 1.0 && maker.degrees == 0.1);
			assert_int_equal(nt_maker_is_mikktspace(&maker), i < 2);
			/* whoever has no quads does not know those of quads */
			assert_int_equal(find(&g, tangents, false, false).known, !quads);
		}
	}
}

/* If the sorts agree, the published one is named. */
TEST(first_of_equals_is_named)
{
	static grid g;
	static float tangents[CORNERS][4];
	make_grid_where_sorts(false, &g, false);
	solve(&g, NMTAN_METHOD_MIKKTSPACE_SORTED, false, tangents);
	assert_int_equal(find(&g, tangents, false, true).method, NMTAN_METHOD_MIKKTSPACE);
}

TEST(inverted_signs_do_not_hide_the_method)
{
	static grid g;
	static float tangents[CORNERS][4];
	make_grid(&g, 1);
	solve(&g, NMTAN_METHOD_AREA, true, tangents);
	for (size_t c = 0; c < CORNERS; c++)
		tangents[c][3] = -tangents[c][3];
	const nt_maker maker = find(&g, tangents, false, true);
	assert_true(maker.known && maker.inverted && maker.quads);
	assert_int_equal(maker.method, NMTAN_METHOD_AREA);
	nt_buffer text = {0};
	nt_maker_text(&maker, &text);
	nt_buffer_append(&text, "", 1);
	assert_says(text.data, (const char *[]){
		"area weights, on quads, w inverted: 99 % of the corners are within", NULL});
	nt_buffer_free(&text);
}

/* Turns a tangent about its normal. */
static void turn(const grid *g, size_t corner, double degrees, float tangent[4])
{
	const float *n = g->normals[g->triangles[corner]];
	const double c = cos(degrees * 0.017453292519943295), s = sin(degrees * 0.017453292519943295);
	const double b[3] = {n[1] * tangent[2] - n[2] * tangent[1], n[2] * tangent[0] - n[0] * tangent[2],
		n[0] * tangent[1] - n[1] * tangent[0]};
	for (size_t k = 0; k < 3; k++)
		tangent[k] = (float)(c * tangent[k] + s * b[k]);
}

TEST(turned_tangents_are_nobodys)
{
	static grid g;
	static float tangents[CORNERS][4];
	nt_random random = nt_random_seed(1);
	make_grid(&g, 1);
	for (int kind = 0; kind < 4; kind++) {
		const double most = (double[]){10, 180, 5, 180}[kind];
		solve(&g, NMTAN_METHOD_MIKKTSPACE, false, tangents);
		for (size_t c = 0; c < CORNERS; c++)
			turn(&g, c, kind < 2 ? most : most * (2 * nt_random_real(&random) - 1), tangents[c]);
		const nt_maker maker = find(&g, tangents, false, true);
		assert_false(maker.known || nt_maker_is_mikktspace(&maker));
		nt_buffer text = {0};
		nt_maker_text(&maker, &text);
		assert_int_equal(text.size, 0);
		nt_buffer_free(&text);
	}
}

/* The share is of 99 %: 23 of 2 400 corners may be others', 25 may not. */
TEST(few_corners_of_others_do_not_hide_the_method)
{
	static grid g;
	static float tangents[CORNERS][4];
	make_grid(&g, 1);
	for (size_t others = 23; others <= 25; others += 2) {
		solve(&g, NMTAN_METHOD_LENGYEL, false, tangents);
		for (size_t c = 0; c < others; c++)
			turn(&g, 90 * c, 90, tangents[90 * c]);
		const nt_maker maker = find(&g, tangents, false, true);
		assert_int_equal(maker.known, others == 23);
		assert_true(maker.agreement == (double)(CORNERS - others) / CORNERS);
	}
}

/* Signed bytes are off by up to half a step of 1/127 in each component: 0.4 degrees. */
TEST(bytes_are_compared_within_a_degree)
{
	static grid g;
	static float tangents[CORNERS][4];
	make_grid(&g, 1);
	solve(&g, NMTAN_METHOD_MIKKTSPACE, true, tangents);
	for (size_t c = 0; c < CORNERS; c++)
		for (size_t k = 0; k < 3; k++)
			tangents[c][k] = roundf(tangents[c][k] * 127.0f) / 127.0f;
	const nt_maker maker = find(&g, tangents, true, true);
	assert_true(maker.known && maker.quads && maker.degrees == 1.0 && maker.agreement == 1.0);
	assert_int_equal(maker.method, NMTAN_METHOD_MIKKTSPACE);
	assert_false(find(&g, tangents, false, true).known);
}

TEST(tangents_that_are_no_numbers_are_nobodys)
{
	static grid g;
	static float tangents[CORNERS][4];
	make_grid(&g, 1);
	for (size_t c = 0; c < CORNERS; c++)
		tangents[c][0] = tangents[c][1] = tangents[c][2] = c % 2 ? NAN : 0;
	assert_false(find(&g, tangents, false, true).known);
}

/* Six triangles around vertex 0, in both windings. One less, or other texture coordinates at one corner, and the fan is
 * open; an edge that three triangles have leaves it closed for nobody. */
TEST(corners_of_a_closed_fan_are_inside)
{
	float positions[8][3] = {{0}}, normals[8][3], texcoords[8][2];
	for (size_t v = 0; v < 8; v++) {
		if (v > 0) {
			positions[v][0] = (float)cos((double)v);
			positions[v][1] = (float)sin((double)v);
		}
		memcpy(normals[v], (float[]){0, 0, 1}, sizeof *normals);
		memcpy(texcoords[v], positions[v], sizeof *texcoords);
	}
	for (uint32_t twin = 0; twin < 2; twin++) {
		uint32_t triangles[3 * 7];
		for (uint32_t t = 0; t < 6; t++)
			memcpy(triangles + 3 * t,
				(uint32_t[]){0, twin ? (t + 1) % 6 + 1 : t + 1, twin ? t + 1 : (t + 1) % 6 + 1},
				3 * sizeof *triangles);
		memcpy(triangles + 18, (uint32_t[]){0, 1, 7}, 3 * sizeof *triangles);
		for (size_t count = 5; count < 8; count++) {
			const nt_mesh mesh = {.face_count = count, .corner_count = 3 * count, .vertex_count = 8,
				.source_vertex_count = 8, .positions = positions[0], .normals = normals[0],
				.texcoords = texcoords[0], .indices = triangles};
			uint64_t border[1];
			assert_int_equal(nt_maker_border(&mesh, border), NT_OK);
			for (size_t c = 0; c < 3 * count; c++)
				assert_int_equal(nt_bit(border, c), c % 3 != 0 || count != 6);
			triangles[3] = 7; /* at the place of 0 with other texture coordinates */
			memcpy(positions[7], positions[0], sizeof *positions);
			assert_int_equal(nt_maker_border(&mesh, border), NT_OK);
			assert_true(nt_bit(border, 0) && nt_bit(border, 3));
			triangles[3] = 0;
		}
	}
}

/* Changes by another primitive at the border do not count; faults inside do. */
TEST(borders_do_not_hide_the_method)
{
	static grid g;
	static float tangents[CORNERS][4];
	uint64_t border[CORNERS / 64 + 1] = {0};
	make_grid(&g, 1);
	solve(&g, NMTAN_METHOD_MIKKTSPACE, true, tangents);
	for (size_t c = 0; c < CORNERS / 2; c++) {
		border[c / 64] |= (uint64_t)1 << c % 64;
		if (c % 3 == 0)
			turn(&g, c, 90, tangents[c]);
	}
	assert_false(find(&g, tangents, false, true).known);
	nt_maker maker = find_with(&g, tangents, false, true, border);
	assert_true(maker.known && maker.across && maker.quads && maker.agreement == 1.0);
	nt_buffer text = {0};
	nt_maker_text(&maker, &text);
	nt_buffer_append(&text, "", 1);
	assert_string_equal(text.data, "MikkTSpace, on quads, across primitives");
	nt_buffer_free(&text);
	for (size_t c = CORNERS / 2; c < CORNERS / 2 + 30; c++)
		turn(&g, c, 90, tangents[c]);
	assert_false(find_with(&g, tangents, false, true, border).known);
	/* where all agree, all count */
	solve(&g, NMTAN_METHOD_MIKKTSPACE, true, tangents);
	maker = find_with(&g, tangents, false, true, border);
	assert_true(maker.known && !maker.across);
}
