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
	assert_string_equal(found->message, "1 triangle is flipped: 2 % of the area of 50");
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

/* A triangle with texture coordinates of its own is an island: of the other winding than those around it is mirrored,
 * lone or not, and has a seam. In a mirrored mesh that is what lies around. */
TEST(one_with_coordinates_of_its_own_is_no_flipped_triangle)
{
	enum { LONE, TWIN, IN_A_MIRRORED_MESH, COUNT };
	static const float places[COUNT][3][2] = {{{2, 2}, {3, 3}, {3, 2}}, {{0, 0}, {1, 1}, {1, 0}},
		{{2, 2}, {3, 3}, {3, 2}}};
	for (int i = 0; i < COUNT; i++) {
		hand_mesh *h = make_grid();
		cut_out(h, 2 * (2 * N + 2), places[i]); /* corners (2, 2), (3, 2), (3, 3) */
		for (uint32_t v = 0; v < h->mesh.vertex_count && i == IN_A_MIRRORED_MESH; v++)
			h->texcoords[v][0] = N - h->texcoords[v][0];
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(report->meshes[0].island_count, 2);
		assert_int_equal(hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE), 0);
		assert_int_equal(hand_findings(report, NT_CODE_UV_MIRROR_OVERLAP), i == TWIN);
		assert_int_equal(hand_findings(report, NT_CODE_UV_MIRROR_LONE), i != TWIN);
		assert_int_equal(hand_findings(report, NT_CODE_UV_MIRROR_SEAM), 1);
		hand_free(h, report);
	}
}

/* Under that key the hash of a corner with v = 0 is its u's bits by its point's number, with the last bit changed. The
 * point at (4, 0) has number 8 and that at (5, 0) 10: 11 more there and 9 less here are the same sum. */
TEST(what_has_the_hash_of_a_twin_is_none)
{
	hand_mesh *h = make_grid();
	set_uv(h, at(N, 0), N - 1.25f, 0);
	float a = N - 1, b = N - 1.25f;
	for (int i = 0; i < 8 + 3; i++)
		a = nextafterf(a, N);
	for (int i = 0; i < 10 - 1; i++)
		b = nextafterf(b, 0);
	const uint32_t back[2] = {hand_vertex(h, N - 1, 0, 0, a, 0), hand_vertex(h, N, 0, 0, b, 0)};
	hand_triangle(h, back[1], back[0], at(N, 1));
	nt_report *report = hand_report_by_equal_hashes(h);
	assert_int_equal(report->meshes[0].island_count, 2);
	assert_int_equal(hand_finding(report, NT_CODE_UV_FLIPPED_TRIANGLE)->count, 1);
	hand_free(h, report);
}

/* All of it, a quad or a triangle of it, which would be few enough to be flipped; the back before the front or behind
 * it, with any corner first, once or twice; of a mirrored sheet, too. */
TEST(the_back_of_a_doubled_sheet_shares_texels)
{
	for (uint32_t i = 0; i < 72; i++) {
		const uint32_t doubled = (const uint32_t[]){2 * N * N, 2, 1}[i % 3], turn = i / 3 % 3;
		const uint32_t backs = i / 9 % 2 && i % 3 ? 2 * doubled : doubled;
		const bool before = i / 18 % 2, mirrored = i / 36 % 2;
		hand_mesh *h = make_grid();
		for (uint32_t t = 0; t < backs; t++) {
			const uint32_t *of = h->indices + 3 * (t % doubled);
			hand_triangle(h, of[(turn + 2) % 3], of[(turn + 1) % 3], of[turn]);
		}
		const uint32_t last = 3 * (uint32_t)(h->mesh.face_count - 1);
		for (uint32_t c = 0; c < 3 && before; c++) {
			const uint32_t other = h->indices[c];
			h->indices[c] = h->indices[last + c];
			h->indices[last + c] = other;
		}
		for (uint32_t v = 0; v < h->mesh.vertex_count && mirrored; v++)
			h->texcoords[v][0] = N - h->texcoords[v][0];
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE), 0);
		if (!mirrored) {
			assert_int_equal(hand_findings(report, NT_CODE_UV_MIXED_WINDING_ISLAND), 0);
			assert_int_equal(hand_finding(report, NT_CODE_UV_MIRROR_OVERLAP)->numbers[0].value, backs);
		}
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

/* One corner or more of the grid moved: what is told of it; of a seventh it makes no seam. 50 triangles of area and UV
 * area 1/2 each. */
TEST(triangles_area_and_texels_say_whether_one_is_flipped)
{
	enum { SEVENTH, EIGHT, TWO, THREE, HALF_OF_AREA, MANY_TEXELS, TEN, NINE, INVISIBLE, VISIBLE, TWO_INVISIBLE,
		HIGH, LOW, NEEDLE, WIDER, REVERSED, FOLDED, OPEN, UNMIRRORED, COUNT };
	static const size_t flipped[COUNT] = {[TWO] = 2, [TEN] = 1, [VISIBLE] = 1, [HIGH] = 1,
		[WIDER] = 1, [OPEN] = 1, [UNMIRRORED] = 1};
	/* of the column that is folded over, and of triangles that are too large a share */
	static const size_t seams[COUNT] = {[SEVENTH] = 1, [EIGHT] = 3, [THREE] = 1, [HALF_OF_AREA] = 2,
		[MANY_TEXELS] = 1, [NINE] = 1};
	for (int row = 0; row < 3 * COUNT; row++) {
		const int i = row % COUNT;
		hand_mesh *h = make_grid();
		if (i <= EIGHT || i == HALF_OF_AREA || (i >= TEN && i <= TWO_INVISIBLE) || i == UNMIRRORED)
			set_uv(h, at(0, N), 0.75f, N - 0.75f);
		/* 6 more are mirrored, at the other side, and one or two: 7 or 8 of 50 */
		for (uint32_t y = 2; y < N && (i <= EIGHT || i == HALF_OF_AREA); y++)
			set_uv(h, at(N, y), N - 1.6f, (float)y);
		if (i == EIGHT)
			set_uv(h, at(N, 0), N - 0.75f, 0.75f);
		for (uint32_t y = 0; y <= N && i == HALF_OF_AREA; y++)
			h->positions[at(N, y)][0] = 2 * N - 2;
		if (i == TWO) /* both triangles at that corner, or all three */
			set_uv(h, at(0, 0), 1.25f, 1.5f);
		if (i == THREE) {
			set_uv(h, at(1, 0), 2.1f, 2.2f);
			h->positions[at(1, 0)][1] = 0.7f; /* 0.15, 0.5 and 0.15 of 24.3 */
		}
		if (i == MANY_TEXELS) /* nearly half of them all */
			set_uv(h, at(N, 0), -16, 21);
		/* the last row alone: 10 triangles; or without a triangle */
		if (i == TEN || i == NINE) {
			h->mesh.face_count = i == TEN ? 2 * N : 2 * N - 1;
			memmove(h->indices, h->indices + 3 * 2 * N * (N - 1), sizeof(uint32_t[3]) * 2 * N);
			if (i == NINE) /* the one before the last, which nothing hangs on */
				memmove(h->indices + 3 * (2 * N - 2), h->indices + 3 * (2 * N - 1),
					sizeof(uint32_t[3]));
			h->mesh.corner_count = 3 * h->mesh.face_count;
			set_uv(h, at(0, N), 0.75f, N - 0.75f);
		}
		/* beside a square of 62 500 or 49 952: the triangle is 0.5 of that and 25 more */
		if (i >= INVISIBLE && i <= TWO_INVISIBLE) {
			const float side = i == VISIBLE ? 223.5f : 250;
			for (uint32_t k = 0; k < 4; k++)
				hand_vertex(h, 250 + side * (float)(k % 2), side * (float)(k / 2), 0,
					(float)(100 + k % 2), (float)(k / 2));
			const uint32_t first = (N + 1) * (N + 1);
			hand_quad(h, first, first + 1, first + 3, first + 2);
		}
		if (i == TWO_INVISIBLE)
			set_uv(h, at(N, 0), N - 0.75f, 0.75f);
		/* `over` the diagonal of a square that is `side` texels wide: over * side * root 2 texels high */
		if (i == HIGH || i == LOW) {
			const float side = 512, over = 8 / sqrtf(2) / side;
			const float most = 0.5f + (i == HIGH ? 1.001f : 0.999f) * over;
			set_uv(h, at(N, 0), N - most, most);
			for (uint32_t v = 0; v < h->mesh.vertex_count; v++)
				set_uv(h, v, side / 2048 * h->texcoords[v][0], side / 2048 * h->texcoords[v][1]);
		}
		/* the face at the corner is folded over its diagonal in space, too, but for 89 or 91 degrees */
		if (i == FOLDED || i == OPEN) {
			const float angle = (i == FOLDED ? 89.0f : 91.0f) * (float)(3.14159265358979 / 180.0);
			set_uv(h, at(N, 0), N - 0.75f, 0.75f);
			h->positions[at(N, 0)][0] = N - 0.5f - 0.5f * cosf(angle);
			h->positions[at(N, 0)][1] = 0.5f + 0.5f * cosf(angle);
			h->positions[at(N, 0)][2] = sqrtf(0.5f) * sinf(angle);
		}
		if (i == REVERSED) { /* that face */
			uint32_t *c = h->indices + 3 * (2 * (N - 1));
			const uint32_t second = c[1];
			c[1] = c[2];
			c[2] = second;
		}
		/* in space, 1 long and 1/20 high, or more */
		if (i == NEEDLE || i == WIDER) {
			set_uv(h, at(N, 0), N - 0.75f, 0.75f);
			h->positions[at(N, 0)][0] = N - 0.5f;
			h->positions[at(N, 0)][1] = 0.5f - (i == NEEDLE ? 0.999f : 1.001f) * 0.05f;
			h->positions[at(N - 1, 0)][1] = h->positions[at(N, 1)][1] = 0.5f;
		}
		for (uint32_t v = 0; v < h->mesh.vertex_count && i == UNMIRRORED; v++)
			h->texcoords[v][0] = -h->texcoords[v][0];
		for (uint32_t t = 0; t < h->mesh.face_count; t++) { /* whichever corner is the first */
			uint32_t *c = h->indices + 3 * t;
			const uint32_t of[3] = {c[0], c[1], c[2]};
			for (int k = 0; k < 3; k++)
				c[k] = of[(k + row / COUNT) % 3];
		}
		nt_report *report = hand_report(h, NULL);
		const size_t told = hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE)
			? hand_finding(report, NT_CODE_UV_FLIPPED_TRIANGLE)->count : 0;
		if (told != flipped[i] || hand_findings(report, NT_CODE_UV_MIRROR_SEAM) != seams[i])
			fail_msg("row %d: %zu flipped, %zu seams", i, told,
				hand_findings(report, NT_CODE_UV_MIRROR_SEAM));
		hand_free(h, report);
	}
}

/* Beside a flipped triangle, whose area is 1/2, other faults of the layout: a little less than that, and more. */
TEST(in_a_layout_that_is_out_of_order_a_flipped_triangle_is_no_news)
{
	enum { FOLDED, WITHOUT_UV_AREA, IN_ANOTHER_ISLAND, TOO_SMALL, INCONSISTENT, COUNT };
	for (int row = 0; row < 2 * COUNT; row++) {
		const int i = row / 2;
		const float size = row % 2 ? 0.501f : 0.499f;
		hand_mesh *h = make_grid();
		set_uv(h, at(N, 0), N - 0.75f, 0.75f);
		if (i == FOLDED) { /* beside the grid: two that share a side, which lie on each other in UV space */
			const uint32_t first = hand_vertex(h, 10, 0, 0, 10, 0);
			hand_vertex(h, 10, 1, 0, 10, 1);
			hand_triangle(h, first, first + 1, hand_vertex(h, 10 - 2 * size, 0, 0, 9, 0));
			hand_triangle(h, first + 1, first, hand_vertex(h, 12, 0, 0, 9, 0.5f));
		}
		if (i == WITHOUT_UV_AREA || i == IN_ANOTHER_ISLAND) { /* at the lowest side at the left */
			const uint32_t end = i == WITHOUT_UV_AREA ? at(0, 1) : hand_vertex(h, 0, 1, 0, 0, 4);
			hand_triangle(h, at(0, 0), end, hand_vertex(h, -2 * size, 0, 0, 0, 0.5f));
		}
		if (i == TOO_SMALL) { /* the opposite corner is 7.99 texels over its diagonal, where a side has 512 */
			const float over = 0.5f + 7.99f / sqrtf(2) / 512, out = 2 * size - 1;
			set_uv(h, at(0, N), over, N - over);
			h->positions[at(0, N)][0] = -out / 2;
			h->positions[at(0, N)][1] = N + out / 2;
			for (uint32_t v = 0; v < h->mesh.vertex_count; v++)
				set_uv(h, v, h->texcoords[v][0] / 4, h->texcoords[v][1] / 4);
		}
		for (int k = 0; k <= row % 2 && i == INCONSISTENT; k++) { /* two that use a side in one direction */
			const float x = 10.0f * (float)(k + 1);
			for (int t = 0; t < 2; t++) {
				const uint32_t first = hand_vertex(h, x, 0, 0, x + (float)t, 0);
				hand_vertex(h, x + 1, 0, 0, x + 1 + (float)t, 0);
				hand_triangle(h, first, first + 1, hand_vertex(h, x, t ? -1 : 1, 0, x + (float)t, 1));
			}
		}
		nt_report *report = hand_report(h, NULL);
		if (hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE) != (row % 2 == 0 || i == IN_ANOTHER_ISLAND))
			fail_msg("row %d: %zu findings", row, hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE));
		hand_free(h, report);
	}
}

/*
 * Coordinates that lie on a grid were rounded to it, by up to half a step. The grid's quads are 16 steps wide;
 * triangles beside them have one value more, or two. A corner at (71, 8) is over the line from (64, 0) to (80, 16): the
 * determinant is 7 * 16 - 8 * 16 = -16, and rounding changes it by a step times 16 + 16, to first order; of (71, 9) it
 * is -32, of (70, 9) -48.
 */
TEST(what_rounding_to_a_grid_may_have_turned_is_not_flipped)
{
	static const struct {
		const char *label;
		float u, v;         /* of the corner */
		int values, last;   /* beside the quads: how many, and the greatest */
		float scale, offset;
		size_t flipped;
	} rows[] = {
		{"within", 71, 8, 1, 255, 1, 0, 0},
		{"at the bound", 71, 9, 1, 255, 1, 0, 0},
		{"above it", 70, 9, 1, 255, 1, 0, 1},
		{"too few steps", 71, 8, 1, 254, 1, 0, 1},
		{"and with another origin", 71, 8, 1, 254, 1, 1, 1},
		{"eight values: -2 * 16, up to 16 and 18", 62, 0, 2, 255, 1, 0, 0},
		{"seven of v: -2 * 16, above 16", 62, 0, 1, 255, 1, 0, 1},
		{"v is not on the grid: 7 * 16 - 8.3 * 16 = -20.8, above 16", 71, 8.3f, 2, 255, 1, 0, 1},
		{"nor is u: -20.8", 70.7f, 8, 2, 255, 1, 0, 1},
		{"steps of which floats are roundings", 71, 8, 2, 255, 1 / 120.0f, 0.37f, 0},
		{"and one above", 70, 9, 2, 255, 1 / 120.0f, 0.37f, 1},
		{"a step of 2^-17 of the values", 71, 8, 2, 255, 1, 0x1p17f, 0},
		{"a step of 2^-18, which may be rounding of floats", 71, 8, 2, 255, 1, 0x1p18f, 1}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		hand_mesh *h = make_grid();
		for (uint32_t v = 0; v <= at(N, N); v++)
			set_uv(h, v, 16 * h->texcoords[v][0], 16 * h->texcoords[v][1]);
		set_uv(h, at(N, 0), rows[i].u, rows[i].v);
		float before = 80;
		for (int k = 0; k < rows[i].values; k++) {
			const float x = (float)(k + 1 < rows[i].values ? 97 : rows[i].last);
			const uint32_t first = hand_vertex(h, before, 0, 0, before, before);
			hand_vertex(h, x, 0, 0, x, before);
			hand_triangle(h, first, first + 1, hand_vertex(h, x, 1, 0, x, x));
			before = x;
		}
		for (uint32_t v = 0; v < h->mesh.vertex_count; v++)
			set_uv(h, v, rows[i].scale * h->texcoords[v][0] + rows[i].offset,
				rows[i].scale * h->texcoords[v][1] + rows[i].offset);
		nt_report *report = hand_report(h, NULL);
		if (hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE) != rows[i].flipped ||
			mirror_findings(report))
			fail_msg("%s: %zu flipped", rows[i].label, hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE));
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

/* A corner on the line between its neighbours but for one unit in the last place; in all triangles, or in six of the
 * first row, of which one is no small share. */
TEST(a_needle_whose_winding_is_rounding_is_nearly_degenerate_and_nothing_else)
{
	for (int all = 0; all < 2; all++) {
		hand_mesh *h = make_grid();
		set_uv(h, at(N, 0), nextafterf(N - 0.5f, 0), 0.5f);
		if (!all) {
			memmove(h->indices, h->indices + 3 * 4, sizeof(uint32_t[3]) * 6);
			h->mesh.face_count = 6;
			h->mesh.corner_count = 18;
		}
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(report->meshes[0].triangles[0], 1);
		assert_int_equal(hand_findings(report, NT_CODE_UV_FLIPPED_TRIANGLE), 0);
		assert_int_equal(hand_finding(report, NT_CODE_UV_NEAR_DEGENERATE)->count, 1);
		assert_int_equal(mirror_findings(report), 0);
		hand_free(h, report);
	}
}
