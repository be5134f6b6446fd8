/* SPDX-License-Identifier: MIT */
/*
 * Seams, islands, boundaries and edges of meshes made by hand; every count is derived beside its test.
 */
#include "hand_mesh.h"

#include <math.h>
#include <string.h>
#include <time.h>

/* Two triangles over one edge, the third corners at the same UV: one is the other's mirror image. */
static hand_mesh *mirrored_pair(bool split)
{
	hand_mesh *h = hand_new();
	const uint32_t a = hand_vertex(h, 0, 0, 0, 0.5f, 0), b = hand_vertex(h, 0, 1, 0, 0.5f, 1);
	const uint32_t left = hand_vertex(h, -1, 0, 0, 0, 0), right = hand_vertex(h, 1, 0, 0, 0, 0);
	const uint32_t c = split ? hand_vertex(h, 0, 0, 0, 0.5f, 0) : a;
	const uint32_t d = split ? hand_vertex(h, 0, 1, 0, 0.5f, 1) : b;
	hand_triangle(h, left, a, b);  /* (0,0) (.5,0) (.5,1): counterclockwise */
	hand_triangle(h, d, c, right); /* (.5,1) (.5,0) (0,0): clockwise */
	return h;
}

TEST(mirrored_pair_has_one_open_seam_of_one_edge)
{
	hand_mesh *h = mirrored_pair(false);
	nt_report *report = hand_report(h, NULL);
	const nt_report_mesh *m = &report->meshes[0];
	assert_int_equal(m->triangles[0], 1);
	assert_int_equal(m->triangles[2], 1);
	assert_int_equal(m->seam_count, 1);
	const nt_seam *seam = &m->seams[0];
	assert_false(seam->closed);
	assert_int_equal(seam->edge_count, 1);
	assert_int_equal(seam->shared_count, 1);
	assert_true(seam->length == 1.0);
	assert_string_equal(seam->plane_text, "x = 0");
	assert_true(seam->dihedral[0] == 0.0 && seam->dihedral[1] == 0.0);
	/* u grows to the right on the left and to the left on the right */
	assert_true(fabs(seam->tangent_angle[1] - 180.0) < 1e-9);
	assert_int_equal(seam->edges[0].triangles[0], 0);
	assert_int_equal(seam->edges[0].triangles[1], 1);
	/* four outer edges, one loop */
	assert_int_equal(m->edge_count, 5);
	assert_int_equal(m->boundary_edges, 4);
	assert_int_equal(m->boundary_loops, 1);
	assert_int_equal(m->boundary_chains, 0);
	/* one island, since the UVs continue; its mirrored half lies point by point on the other */
	assert_int_equal(m->island_count, 1);
	assert_true(m->islands[0].overlaps_itself);
	hand_finding(report, NT_CODE_UV_MIRROR_OVERLAP);
	assert_int_equal(hand_findings(report, NT_CODE_UV_MIXED_WINDING_ISLAND), 0);
	assert_int_equal(hand_finding(report, NT_CODE_TAN_MIRROR_SHARED_VERTEX)->count, 2);
	assert_int_equal(hand_finding(report, NT_CODE_UV_MIRROR_SEAM)->count, 1);
	hand_free(h, report);
}

/*
 * A cube of 2 x 2 x 2, cut by x = 0 into two halves that share their texture: the front, back, top and bottom
 * are two quads each, left and right one each: 10 quads. u = |x| / 2 on the four cut faces, u = a second
 * coordinate on the ends; the half x < 0 is wound the other way.
 */
static void cut_face(hand_mesh *h, float y0, float z0, float y1, float z1)
{
	for (int side = -1; side <= 1; side += 2) {
		const float x = (float)side;
		const uint32_t a = hand_vertex(h, 0, y0, z0, 0, 0), b = hand_vertex(h, x, y0, z0, 0.5f, 0);
		const uint32_t c = hand_vertex(h, x, y1, z1, 0.5f, 1), d = hand_vertex(h, 0, y1, z1, 0, 1);
		if (side > 0)
			hand_quad(h, a, b, c, d);
		else
			hand_quad(h, d, c, b, a);
	}
}

static hand_mesh *mirrored_cube(void)
{
	hand_mesh *h = hand_new();
	cut_face(h, -1, 1, 1, 1);   /* front */
	cut_face(h, 1, 1, 1, -1);   /* top */
	cut_face(h, 1, -1, -1, -1); /* back */
	cut_face(h, -1, -1, -1, 1); /* bottom */
	for (int side = -1; side <= 1; side += 2) {
		const float x = (float)side;
		const uint32_t a = hand_vertex(h, x, -1, 1, 0.5f, 0), b = hand_vertex(h, x, -1, -1, 1, 0);
		const uint32_t c = hand_vertex(h, x, 1, -1, 1, 1), d = hand_vertex(h, x, 1, 1, 0.5f, 1);
		if (side > 0)
			hand_quad(h, a, b, c, d);
		else
			hand_quad(h, d, c, b, a);
	}
	return h;
}

TEST(mirrored_cube_has_one_closed_seam_around_x_0)
{
	hand_mesh *h = mirrored_cube();
	nt_report *report = hand_report(h, NULL);
	const nt_report_mesh *m = &report->meshes[0];
	assert_int_equal(m->triangle_count, 20);
	assert_int_equal(m->triangles[0], 10);
	assert_int_equal(m->triangles[2], 10);
	assert_int_equal(m->seam_count, 1);
	assert_true(m->seams[0].closed);
	assert_int_equal(m->seams[0].edge_count, 4);
	assert_true(m->seams[0].length == 8.0);
	assert_string_equal(m->seams[0].plane_text, "x = 0");
	/* walked in order: each edge begins where the one before ends */
	for (size_t i = 0; i < 4; i++)
		assert_memory_equal(m->seams[0].edges[i].positions[1],
			m->seams[0].edges[(i + 1) % 4].positions[0], 3 * sizeof(float));
	/* closed surface: 3 * 20 / 2 edges, none open */
	assert_int_equal(m->edge_count, 30);
	assert_int_equal(m->boundary_edges, 0);
	assert_int_equal(m->non_manifold_edges, 0);
	/* the four cut faces are one island each, halves joined by the middle line; the front's and the
	 * bottom's v = 0 and the like do not meet: 4 islands and the 2 ends, whose left edges u = 0.5
	 * continue the front (0.5, 0)-(0.5, 1) */
	assert_int_equal(m->island_kinds[NT_ISLAND_MIXED], 4);
	assert_int_equal(m->island_count, 4);
	assert_int_equal(hand_findings(report, NT_CODE_UV_MIXED_WINDING_ISLAND), 0);
	assert_int_equal(hand_finding(report, NT_CODE_UV_MIRROR_OVERLAP)->count, 4);
	hand_free(h, report);
}

/* The severity of warnings once the mesh has a triangle of some thousand times its area. */
static nt_severity worst_beside_much(hand_mesh *h, nt_report *report)
{
	nt_severity worst;
	assert_true(nt_report_worst(report, &worst) && worst == NT_SEVERITY_WARNING);
	nt_report_free(report);
	hand_triangle(h, hand_vertex(h, 0, 0, 9, 9, 9), hand_vertex(h, 500, 0, 9, 10, 9),
		hand_vertex(h, 0, 500, 9, 9, 10));
	report = hand_report(h, NULL);
	assert_true(nt_report_worst(report, &worst));
	hand_free(h, report);
	return worst;
}

/* A strip of n quads, closed with a half turn: vertex (i, side) for i < n, and the last quad joins
 * (n - 1, s) to (0, 1 - s). */
TEST(moebius_strip_has_one_edge_against_the_winding)
{
	enum { N = 12 };
	hand_mesh *h = hand_new();
	for (uint32_t i = 0; i <= N; i++) {
		for (uint32_t s = 0; s < 2; s++) {
			const uint32_t k = i % N, t = i == N ? 1 - s : s; /* position of (N, s) is that of (0, 1 - s) */
			const double a = 6.283185307179586 * k / N, r = 2.0 + (t ? 0.5 : -0.5) * cos(a / 2);
			hand_vertex(h, (float)(r * cos(a)), (float)(r * sin(a)),
				(float)((t ? 0.5 : -0.5) * sin(a / 2)), (float)i / N, (float)s);
		}
	}
	for (uint32_t i = 0; i < N; i++)
		hand_quad(h, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
	nt_report *report = hand_report(h, NULL);
	const nt_report_mesh *m = &report->meshes[0];
	assert_int_equal(m->triangle_count, 2 * N);
	/* N diagonals, N rungs, 2 N rim edges, and the rim is one loop */
	assert_int_equal(m->edge_count, 4 * N);
	assert_int_equal(m->boundary_edges, 2 * N);
	assert_int_equal(m->boundary_loops, 1);
	assert_int_equal(m->boundary_chains, 0);
	assert_int_equal(m->non_manifold_edges, 0);
	/* the rung where it closes: both triangles run along it the same way */
	assert_int_equal(hand_finding(report, NT_CODE_MESH_INCONSISTENT_WINDING)->count, 1);
	assert_int_equal(m->seam_count, 0);
	assert_int_equal(m->uv_seam_edges, 1);
	assert_int_equal(m->island_count, 1);
	assert_int_equal(worst_beside_much(h, report), NT_SEVERITY_INFO);
}

/* Three quads in a row, u = 0, 1, 0.4, 1.4: the middle one runs back over the first, but not onto its
 * corners. */
TEST(fold_is_found_inside_its_island)
{
	static const float u[4] = {0.0f, 1.0f, 0.4f, 1.4f};
	hand_mesh *h = hand_new();
	for (int i = 0; i < 4; i++) {
		hand_vertex(h, (float)i, 0, 0, u[i], 0);
		hand_vertex(h, (float)i, 1, 0, u[i], 1);
	}
	for (uint32_t i = 0; i < 3; i++)
		hand_quad(h, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_finding(report, NT_CODE_UV_MIXED_WINDING_ISLAND)->count, 6);
	assert_int_equal(hand_findings(report, NT_CODE_UV_MIRROR_OVERLAP), 0);
	assert_int_equal(report->meshes[0].triangles[0], 2);
	assert_int_equal(report->meshes[0].seam_count, 2);
	hand_free(h, report);
}

/* The same fold as the second island. */
TEST(corners_of_one_hash_do_not_make_a_fold_symmetric)
{
	static const float u[4] = {0.0f, 1.0f, 0.4f, 1.4f};
	hand_mesh *h = hand_new();
	hand_triangle(h, hand_vertex(h, 9, 0, 0, 9, 0), hand_vertex(h, 10, 0, 0, 10, 0), hand_vertex(h, 9, 1, 0, 9, 1));
	for (int i = 0; i < 4; i++) {
		hand_vertex(h, (float)i, 0, 0, u[i], 0);
		hand_vertex(h, (float)i, 1, 0, u[i], 1);
	}
	for (uint32_t i = 3; i < 9; i += 2)
		hand_quad(h, i, i + 2, i + 3, i + 1);
	nt_report *report = hand_report_by_equal_hashes(h);
	assert_int_equal(hand_finding(report, NT_CODE_UV_MIXED_WINDING_ISLAND)->island, 1);
	hand_free(h, report);
}

/* Over 3e35 tiles, of which few are searched: many small meshes may have such coordinates. */
TEST(search_of_overlap_is_bounded_by_the_triangles)
{
	hand_mesh *h = hand_new();
	const uint32_t a = hand_vertex(h, 0, 0, 0, 0, 0), b = hand_vertex(h, 1, 0, 0, 3e35f, 0);
	const uint32_t c = hand_vertex(h, 0, 1, 0, 0, 3e35f);
	hand_triangle(h, a, b, c);
	hand_triangle(h, hand_vertex(h, 5, 0, 0, 0.2f, 0.1f), hand_vertex(h, 5, 1, 0, 0.1f, 0.2f),
		hand_vertex(h, 6, 0, 0, 0.2f, 0.2f));
	hand_triangle(h, hand_vertex(h, 7, 1, 0, -3e35f, -2e35f), hand_vertex(h, 7, 0, 0, -3e35f, -3e35f),
		hand_vertex(h, 8, 0, 0, -2e35f, -3e35f));
	nt_report *report = NULL;
	clock_t least = CLOCKS_PER_SEC;
	for (int i = 0; i < 5 && least >= CLOCKS_PER_SEC / 4; i++) { /* others may take the caches */
		nt_report_free(report);
		const clock_t begin = clock();
		report = hand_report(h, NULL);
		least = clock() - begin;
	}
	assert_true(least < CLOCKS_PER_SEC / 4); /* 0.02 s; without a bound 0.8 s */
	hand_free(h, report);
}

TEST(bowtie_of_two_triangles_meets_in_a_point_only)
{
	hand_mesh *h = hand_new();
	const uint32_t m = hand_vertex(h, 0, 0, 0, 0.5f, 0.5f);
	const uint32_t a = hand_vertex(h, 1, -1, 0, 1, 0), b = hand_vertex(h, 1, 1, 0, 1, 1);
	const uint32_t c = hand_vertex(h, -1, 1, 0, 0, 1), d = hand_vertex(h, -1, -1, 0, 0, 0);
	hand_triangle(h, m, a, b);
	hand_triangle(h, m, c, d);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(report->meshes[0].island_count, 2);
	assert_int_equal(report->meshes[0].boundary_edges, 6);
	assert_int_equal(report->meshes[0].boundary_loops, 2);
	assert_int_equal(report->meshes[0].non_manifold_edges, 0);
	assert_int_equal(report->finding_count, 0);
	hand_free(h, report);
}

/* Three triangles on one edge, one of them mirrored: the edge is a seam and is not manifold. */
TEST(edge_of_three_triangles_is_reported_and_still_a_seam)
{
	hand_mesh *h = hand_new();
	const uint32_t a = hand_vertex(h, 0, 0, 0, 0, 0), b = hand_vertex(h, 0, 1, 0, 0, 1);
	const uint32_t c = hand_vertex(h, -1, 0, 0, -1, 0), d = hand_vertex(h, 1, 0, 0, 1, 0);
	const uint32_t e = hand_vertex(h, 0, 0, 1, -1, 0);
	hand_triangle(h, c, a, b);
	hand_triangle(h, b, a, d);
	hand_triangle(h, b, a, e);
	nt_report *report = hand_report(h, NULL);
	const nt_report_mesh *m = &report->meshes[0];
	assert_int_equal(hand_finding(report, NT_CODE_MESH_NON_MANIFOLD_EDGE)->count, 1);
	assert_int_equal(m->edge_count, 7);
	assert_int_equal(m->boundary_edges, 6);
	assert_int_equal(m->seam_count, 1);
	assert_int_equal(m->seams[0].edge_count, 1);
	assert_int_equal(m->seams[0].non_manifold_count, 1);
	assert_int_equal(worst_beside_much(h, report), NT_SEVERITY_INFO);
}

/* Two triangles with vertices of their own and the coordinates of a third one, wound the other way: one island. Two
 * elsewhere in the texture are another one, and where it is not known, each is one. */
TEST(edge_of_many_triangles_joins_those_with_the_same_coordinates)
{
	static const float places[] = {0, 0, 5, 0, 5, NAN, NAN};
	hand_mesh *h = hand_new();
	for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
		const float u = places[i], angle = (float)i;
		const uint32_t a = hand_vertex(h, 0, 0, 0, u, 0), b = hand_vertex(h, 0, 1, 0, u, 1);
		const uint32_t c = hand_vertex(h, cosf(angle), 0, sinf(angle), u + 1, 0);
		hand_triangle(h, i % 2 ? b : a, i % 2 ? a : b, c);
	}
	nt_report *report = hand_report(h, NULL);
	const nt_report_mesh *m = &report->meshes[0];
	assert_int_equal(m->non_manifold_edges, 1);
	assert_int_equal(m->island_count, 4);
	assert_int_equal(m->islands[0].triangles[0] + m->islands[0].triangles[2], 3);
	assert_int_equal(m->islands[1].triangles[0] + m->islands[1].triangles[2], 2);
	hand_free(h, report);
}

/* Five triangles with the coordinates (0, 0) at one end of their edge, and one of two at the other. */
TEST(triangles_of_one_hash_are_not_joined)
{
	hand_mesh *h = hand_new();
	for (unsigned i = 0; i < 5; i++) {
		const uint32_t a = hand_vertex(h, 0, 0, 0, 0, 0), b = hand_vertex(h, 0, 1, 0, i % 2 ? 5 : 0, 1);
		const uint32_t c = hand_vertex(h, cosf((float)i), 0, sinf((float)i), 1, 0);
		hand_triangle(h, i % 2 ? b : a, i % 2 ? a : b, c);
	}
	nt_report *report = hand_report_by_equal_hashes(h);
	assert_int_equal(report->meshes[0].island_count, 2);
	hand_free(h, report);
}

/* A square with its back, whose corners have the same positions and texture coordinates; `again`: it is wound as the
 * front is. */
static hand_mesh *double_sheet(bool opposed, bool again, unsigned back_triangles)
{
	static const float corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
	hand_mesh *h = hand_new();
	for (unsigned side = 0; side < 2; side++)
		for (size_t k = 0; k < 4; k++)
			h->normals[hand_vertex(h, corners[k][0], corners[k][1], 0, corners[k][0], corners[k][1])][2] =
				side && opposed ? -1.0f : 1.0f;
	hand_quad(h, 0, 1, 2, 3);
	hand_triangle(h, again ? 4 : 6, 5, again ? 6 : 4);
	if (back_triangles == 2)
		hand_triangle(h, 7, again ? 4 : 6, again ? 6 : 4);
	hand_give_normals(h);
	return h;
}

/* MikkTSpace compares normals: front and back share no edge, and have no mirror seam at their rim. With one normal they
 * are one surface, and so is what hangs on something else, or goes round the same way. */
TEST(front_and_back_of_a_sheet_with_opposite_normals_share_no_edge)
{
	static const struct {
		bool opposed, again;
		unsigned back;
		size_t non_manifold, seams, islands, boundary, loops;
	} rows[] = {
		{true, false, 2, 0, 0, 2, 8, 2},
		{true, true, 2, 1, 0, 1, 0, 0},
		{false, false, 2, 1, 3, 1, 0, 0}, /* the diagonal of four triangles; the rim is shared by two */
		/* the diagonal of three; the corner that has its back is two points, and the front's rim is closed */
		{true, false, 1, 1, 1, 1, 6, 1},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		hand_mesh *h = double_sheet(rows[i].opposed, rows[i].again, rows[i].back);
		nt_report *report = hand_report(h, NULL);
		const nt_report_mesh *m = &report->meshes[0];
		assert_int_equal(m->non_manifold_edges, rows[i].non_manifold);
		assert_int_equal(m->seam_count, rows[i].seams);
		assert_int_equal(m->island_count, rows[i].islands);
		assert_int_equal(m->boundary_edges, rows[i].boundary);
		assert_int_equal(m->boundary_loops, rows[i].loops);
		hand_free(h, report);
	}
}

/* Triangles 0 2 3 and 0 5 1 around a middle have equal products of the numbers at their outer edges. */
TEST(sheets_are_told_apart_by_their_points)
{
	hand_mesh *h = hand_new();
	for (unsigned side = 0; side < 2; side++)
		for (unsigned k = 0; k < 6; k++) {
			const float angle = (float)k, r = k ? 1.0f : 0.0f;
			const float x = r * cosf(angle), y = r * sinf(angle);
			h->normals[hand_vertex(h, x, y, 0, x, y)][2] = side ? -1.0f : 1.0f;
		}
	for (uint32_t side = 0; side < 2; side++)
		for (uint32_t k = 0; k < 5; k++) {
			const uint32_t a = 6 * side + 1 + k, b = 6 * side + 1 + (k + 1) % 5;
			hand_triangle(h, 6 * side, side ? b : a, side ? a : b);
		}
	hand_give_normals(h);
	nt_report *report = hand_report_by_equal_hashes(h);
	assert_int_equal(report->meshes[0].non_manifold_edges, 0);
	assert_int_equal(report->meshes[0].boundary_edges, 10);
	hand_free(h, report);
}

/* The lid of one box and the bottom of another are each other's reverse, but both hang on walls: four edges of four
 * faces, and the diagonal. */
TEST(boxes_that_touch_are_not_opened)
{
	static const float n[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
	hand_mesh *h = hand_new();
	for (size_t box = 0; box < 2; box++)
		for (size_t i = 0; i < 6; i++) {
			const float *a = n[(i + 1) % 3], *b = n[(i + 2) % 3];
			const uint32_t first = (uint32_t)h->mesh.vertex_count;
			for (size_t k = 0; k < 4; k++) {
				const float x = k == 1 || k == 2, y = k > 1;
				float p[3];
				for (int axis = 0; axis < 3; axis++)
					p[axis] = x * a[axis] + y * b[axis] + (i < 3 ? n[i][axis] : 0);
				const uint32_t v = hand_vertex(h, p[0], p[1], p[2] + (float)box, x, y);
				memcpy(h->normals[v], n[i], sizeof h->normals[v]);
			}
			if (i < 3)
				hand_quad(h, first, first + 1, first + 2, first + 3);
			else { /* the other way, cut along the same diagonal */
				hand_triangle(h, first + 2, first + 1, first);
				hand_triangle(h, first + 3, first + 2, first);
			}
		}
	hand_give_normals(h);
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(report->meshes[0].non_manifold_edges, 5);
	assert_int_equal(report->meshes[0].boundary_edges, 0);
	hand_free(h, report);
}
