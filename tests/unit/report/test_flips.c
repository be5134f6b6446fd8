/* SPDX-License-Identifier: MIT */
/*
 * A few triangles that are wound against their surroundings, on a grid of 5 x 5 quads (50 triangles of one size) whose
 * UVs are its positions.
 */
#include <math.h>
#include "hand_mesh.h"

enum { N = 5 };

static uint32_t at(uint32_t x, uint32_t y)
{
	return y * (N + 1) + x;
}

static hand_mesh *make_grid(void)
{
	hand_mesh *h = hand_new();
	for (int y = 0; y <= N; y++)
		for (int x = 0; x <= N; x++)
			hand_vertex(h, (float)x, (float)y, 0, (float)x, (float)y);
	for (uint32_t y = 0; y < N; y++)
		for (uint32_t x = 0; x < N; x++)
			hand_quad(h, at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
	h->mesh.wrap[0] = h->mesh.wrap[1] = NT_WRAP_CLAMP;
	return h;
}

static void set_uv(hand_mesh *h, uint32_t vertex, float u, float v)
{
	h->texcoords[vertex][0] = u;
	h->texcoords[vertex][1] = v;
}

/* Gives a triangle vertices of its own, with the coordinates of its corners in the order given. */
static void cut_out(hand_mesh *h, uint32_t triangle, const float uv[3][2])
{
	for (uint32_t k = 0; k < 3; k++) {
		uint32_t *vertex = &h->indices[3 * triangle + k];
		const float *p = h->positions[*vertex];
		*vertex = hand_vertex(h, p[0], p[1], p[2], uv[k][0], uv[k][1]);
	}
}

/* The code for a mirrored part of any size. */
static size_t mirror_findings(const nt_report *report)
{
	return hand_findings(report, NT_CODE_UV_MIRROR_SEAM) + hand_findings(report, NT_CODE_UV_MIRROR_OVERLAP) +
		hand_findings(report, NT_CODE_UV_MIRROR_LONE) + hand_findings(report, NT_CODE_UV_MIXED_WINDING_ISLAND) +
		hand_findings(report, NT_CODE_TAN_MIRROR_SHARED_VERTEX);
}

/* Like line 2289 of tinyrenderer's boggie/head.obj. */
TEST(one_flipped_triangle_is_one_finding_at_its_own_place)
{
	hand_mesh *h = make_grid();
	set_uv(h, at(N, 0), N - 0.75f, 0.75f); /* over the diagonal of its quad */
	nt_report *report = hand_report(h, NULL);
	const nt_report_finding *found = hand_finding(report, NT_CODE_UV_FLIPPED_TRIANGLE);
	assert_string_equal(found->message, "1 of 50 triangles, 2 % of the area, is flipped");
	assert_int_equal(found->severity, NT_SEVERITY_WARNING);
	assert_int_equal(found->spot_count, 1);
	assert_int_equal(found->spots[0].triangle, 2 * (N - 1));
	assert_int_equal(found->island, 0);
	assert_int_equal(mirror_findings(report), 0);
	assert_int_equal(report->meshes[0].triangles[0], 1);
	assert_int_equal(report->meshes[0].seam_count, 0);
	assert_int_equal(report->meshes[0].islands[0].kind, NT_ISLAND_NORMAL);
	hand_free(h, report);
}

/* Up to a thousandth of the area nobody exports a model again. */
TEST(a_small_one_is_an_info)
{
	for (int large = 0; large < 2; large++) {
		hand_mesh *h = make_grid();
		set_uv(h, at(N, 0), N - 0.75f, 0.75f);
		/* a square beside the grid: the triangle is 1/2 of 25 + 460 or of 25 + 480 */
		const float side = sqrtf(large ? 480.0f : 460.0f);
		for (uint32_t k = 0; k < 4; k++)
			hand_vertex(h, 100 + side * (k & 1), side * (float)(k >> 1), 0, 100 + side * (k & 1),
				side * (float)(k >> 1));
		const uint32_t first = (N + 1) * (N + 1);
		hand_triangle(h, first, first + 1, first + 3);
		hand_triangle(h, first, first + 3, first + 2);
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(hand_finding(report, NT_CODE_UV_FLIPPED_TRIANGLE)->severity,
			large ? NT_SEVERITY_INFO : NT_SEVERITY_WARNING);
		hand_free(h, report);
	}
}

TEST(so_is_one_with_coordinates_of_its_own)
{
	static const uint32_t middle = 2 * (2 * N + 2); /* corners (2, 2), (3, 2), (3, 3) */
	const float swapped[3][2] = {{2, 2}, {3, 3}, {3, 2}};
	hand_mesh *h = make_grid();
	cut_out(h, middle, swapped);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(report->meshes[0].island_count, 2);
	const nt_report_finding *found = hand_finding(report, NT_CODE_UV_FLIPPED_TRIANGLE);
	assert_int_equal(found->count, 1);
	assert_int_equal(found->spots[0].triangle, middle);
	assert_int_equal(mirror_findings(report), 0);
	hand_free(h, report);
}

/* The same triangle with the texels of another one: a mirrored detail, which is meant. */
TEST(a_small_island_that_has_a_twin_is_mirrored)
{
	const float twin[3][2] = {{0, 0}, {1, 1}, {1, 0}};
	hand_mesh *h = make_grid();
	cut_out(h, 2 * (2 * N + 2), twin);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE), 0);
	assert_int_equal(hand_finding(report, NT_CODE_UV_MIRROR_OVERLAP)->count, 1);
	assert_int_equal(hand_findings(report, NT_CODE_UV_MIRROR_SEAM), 1);
	hand_free(h, report);
}

/* Bits of 1 and 4 have the sum of those of 2 and 2: the triangle (3,2) (4,2) (4,3) is no twin. */
TEST(what_has_the_hash_of_a_twin_is_none)
{
	const float other[3][2] = {{3, 1}, {4, 4}, {4, 3}};
	hand_mesh *h = make_grid();
	cut_out(h, 2 * (2 * N + 2), other);
	nt_report *report = hand_report_by_equal_hashes(h);
	assert_int_equal(hand_finding(report, NT_CODE_UV_FLIPPED_TRIANGLE)->count, 1);
	hand_free(h, report);
}

/* All of it, or one quad of it, which would be few enough to be flipped. */
TEST(the_back_of_a_doubled_sheet_shares_texels)
{
	for (uint32_t doubled = 2; doubled <= 2 * N * N; doubled += 2 * N * N - 2) {
		hand_mesh *h = make_grid();
		for (const uint32_t *i = h->indices; i < h->indices + 3 * doubled; i += 3)
			hand_triangle(h, i[0], i[2], i[1]);
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE), 0);
		assert_int_equal(hand_findings(report, NT_CODE_UV_MIXED_WINDING_ISLAND), 0);
		assert_int_equal(hand_finding(report, NT_CODE_UV_MIRROR_OVERLAP)->numbers[0].value, doubled);
		hand_free(h, report);
	}
}

/* 20 triangles before the fold, 29 behind it, and one there that runs back. */
TEST(what_is_wound_like_two_fifths_of_its_island_is_not_flipped)
{
	hand_mesh *h = make_grid();
	for (uint32_t y = 0; y <= N; y++)
		for (uint32_t x = 2; x <= N; x++)
			set_uv(h, at(x, y), 4.0f - (float)x, (float)y);
	set_uv(h, at(N, 0), -0.25f, 0.75f);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(report->meshes[0].triangles[0], 29);
	assert_int_equal(hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE), 0);
	assert_int_equal(hand_findings(report, NT_CODE_UV_MIXED_WINDING_ISLAND), 1);
	hand_free(h, report);
}

/* Moves the texture coordinates of the first rows, which become an island of their own. */
static void move_rows(hand_mesh *h, uint32_t rows, float du)
{
	for (uint32_t t = 0; t < 2 * N * rows; t++) {
		float uv[3][2];
		for (uint32_t k = 0; k < 3; k++) {
			uv[k][0] = h->texcoords[h->indices[3 * t + k]][0] + du;
			uv[k][1] = h->texcoords[h->indices[3 * t + k]][1];
		}
		cut_out(h, t, uv);
	}
}

/* A single triangle is wound the other way in each. */
TEST(area_texels_and_the_island_around_say_whether_one_is_flipped)
{
	enum { SEVENTH, FIFTH, HALF_OF_AREA, MANY_TEXELS, LONE, BETWEEN_HALVES, BETWEEN_ISLANDS, INVISIBLE, NEEDLE,
		WIDER, COUNT };
	static const size_t flipped[COUNT] = {[SEVENTH] = 1, [LONE] = 1, [WIDER] = 1};
	/* of the column that is folded over, of the triangle, of both folded rows and the triangle */
	static const size_t seams[COUNT] = {[SEVENTH] = 1, [FIFTH] = 1, [HALF_OF_AREA] = 1, [MANY_TEXELS] = 1,
		[BETWEEN_HALVES] = 3};
	static const float swapped[3][2] = {{2, 2}, {3, 3}, {3, 2}}; /* with coordinates of its own */
	for (int i = 0; i < COUNT; i++) {
		hand_mesh *h = make_grid();
		if (i <= HALF_OF_AREA || i == INVISIBLE)
			set_uv(h, at(0, N), 0.75f, N - 0.75f);
		/* 6 more are mirrored, at the other side: 7 of 50; or 10 */
		for (uint32_t y = i == FIFTH ? 0 : 2; y < N && i <= HALF_OF_AREA; y++)
			set_uv(h, at(N, y), N - 1.6f, (float)y);
		for (uint32_t y = 0; y <= N && i == HALF_OF_AREA; y++)
			h->positions[at(N, y)][0] = 2 * N - 2;
		if (i == MANY_TEXELS) /* nearly half of them all */
			set_uv(h, at(N, 0), -16, 21);
		for (uint32_t v = 0; v <= at(N, N) && i == BETWEEN_HALVES; v++)
			if (h->texcoords[v][1] < 2 || h->texcoords[v][1] > 3)
				h->texcoords[v][1] = (h->texcoords[v][1] < 2 ? 1 : 7.5f) - h->texcoords[v][1];
		if (i >= LONE && i <= BETWEEN_ISLANDS)
			cut_out(h, 2 * (2 * N + 2), swapped);
		if (i == BETWEEN_ISLANDS) /* below it is another one */
			move_rows(h, 2, 200);
		/* the longest side is a root of two long; over it the third corner is 0.009 or 0.011 of that high */
		if (i == NEEDLE || i == WIDER)
			set_uv(h, at(0, N), i == NEEDLE ? 0.509f : 0.511f, i == NEEDLE ? N - 0.509f : N - 0.511f);
		if (i == INVISIBLE) { /* beside a square of 62 500: the triangle is 0.5 of that and 25 more */
			for (uint32_t k = 0; k < 4; k++)
				hand_vertex(h, 250.0f * (float)(1 + k % 2), 250.0f * (float)(k / 2), 0,
					(float)(100 + k % 2), (float)(k / 2));
			const uint32_t first = (N + 1) * (N + 1);
			hand_quad(h, first, first + 1, first + 3, first + 2);
		}
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE), flipped[i]);
		assert_int_equal(hand_findings(report, NT_CODE_UV_MIRROR_SEAM), seams[i]);
		hand_free(h, report);
	}
}

/* Two islands of 29 quads each; a quad between them is mirrored, and lies against the first one at three sides. */
TEST(which_island_is_around_follows_from_sides_and_not_from_the_order_of_faces)
{
	enum { WIDE = 12, HIGH = 5 };
	enum { FIRST, SECOND, BETWEEN };
	for (int backwards = 0; backwards < 2; backwards++) {
		hand_mesh *h = hand_new();
		uint32_t vertices[BETWEEN + 1][WIDE + 1][HIGH + 1];
		for (int island = FIRST; island <= BETWEEN; island++)
			for (int x = 0; x <= WIDE; x++)
				for (int y = 0; y <= HIGH; y++)
					vertices[island][x][y] = hand_vertex(h, (float)x, (float)y, 0,
						(float)(100 * island + (island == BETWEEN ? -x : x)), (float)y);
		for (int i = 0; i < WIDE * HIGH - 1; i++) { /* all but the last */
			const int place = backwards ? WIDE * HIGH - 2 - i : i, x = place / HIGH, y = place % HIGH;
			const int island = x == 5 && y == 2 ? BETWEEN : x < WIDE / 2 ? FIRST : SECOND;
			uint32_t (*const of)[HIGH + 1] = vertices[island];
			hand_quad(h, of[x][y], of[x + 1][y], of[x + 1][y + 1], of[x][y + 1]);
		}
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(report->meshes[0].island_count, 3);
		assert_int_equal(hand_finding(report, NT_CODE_UV_FLIPPED_TRIANGLE)->count, 2);
		hand_free(h, report);
	}
}

/* A column of 10 triangles folded over: a fifth of the island. */
TEST(what_is_larger_is_a_fold)
{
	hand_mesh *h = make_grid();
	for (uint32_t y = 0; y <= N; y++)
		set_uv(h, at(N, y), N - 1.6f, (float)y);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(report->meshes[0].triangles[0], 2 * N);
	assert_int_equal(hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE), 0);
	assert_int_equal(hand_findings(report, NT_CODE_UV_MIXED_WINDING_ISLAND), 1);
	assert_int_equal(hand_findings(report, NT_CODE_UV_MIRROR_SEAM), 1);
	hand_free(h, report);
}

/* A corner on the line between its neighbours but for one unit in the last place. */
TEST(a_needle_whose_winding_is_rounding_is_nearly_degenerate_and_nothing_else)
{
	hand_mesh *h = make_grid();
	set_uv(h, at(N, 0), nextafterf(N - 0.5f, 0), 0.5f);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(report->meshes[0].triangles[0], 1);
	assert_int_equal(hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE), 0);
	assert_int_equal(hand_finding(report, NT_CODE_UV_NEAR_DEGENERATE)->count, 1);
	assert_int_equal(mirror_findings(report), 0);
	hand_free(h, report);
}
