/* SPDX-License-Identifier: MIT */
/*
 * Hard edges inside islands: squares of side 1 folded along their common edges. The expected numbers are the angle and
 * the length of what was folded.
 */
#include "hand_mesh.h"

#include <math.h>
#include <string.h>

static void set_normal(hand_mesh *h, uint32_t vertex, double x, double y, double z)
{
	h->normals[vertex][0] = (float)x;
	h->normals[vertex][1] = (float)y;
	h->normals[vertex][2] = (float)z;
}

/* Two squares whose normals are `degrees` apart at x = 1. cut: the texture coordinates of the second begin elsewhere.
 * smooth: both have the first one's normals there. */
static hand_mesh *folded(double degrees, bool cut, bool smooth)
{
	hand_mesh *h = hand_new();
	const double a = degrees * 0.017453292519943295, x = 1 + cos(a), z = -sin(a);
	const float u = cut ? 3 : 1;
	hand_vertex(h, 0, 0, 0, 0, 0);
	hand_vertex(h, 1, 0, 0, 1, 0);
	hand_vertex(h, 1, 1, 0, 1, 1);
	hand_vertex(h, 0, 1, 0, 0, 1);
	hand_quad(h, 0, 1, 2, 3);
	hand_vertex(h, 1, 0, 0, u, 0);
	hand_vertex(h, (float)x, 0, (float)z, u + 1, 0);
	hand_vertex(h, (float)x, 1, (float)z, u + 1, 1);
	hand_vertex(h, 1, 1, 0, u, 1);
	hand_quad(h, 4, 5, 6, 7);
	for (uint32_t v = 4; v < 8; v++)
		if (!smooth || v == 5 || v == 6)
			set_normal(h, v, sin(a), 0, cos(a));
	hand_give_normals(h);
	h->mesh.slots = NT_SLOT_NORMAL;
	h->scene.format = NT_FORMAT_GLB;
	return h;
}

TEST(an_edge_is_hard_if_normals_are_cut_and_texture_coordinates_are_not)
{
	static const struct {
		double degrees;
		bool cut, smooth;
		unsigned slots;
		const char *says; /* NULL: nothing */
		nt_severity severity;
	} rows[] = {
		{90, false, false, NT_SLOT_NORMAL, "an open chain of length 1; normals up to 90 degrees apart",
			NT_SEVERITY_WARNING},
		{90, false, false, NT_SLOT_CLEARCOAT_NORMAL, "normals up to 90 degrees apart", NT_SEVERITY_WARNING},
		{90, false, false, NT_SLOT_ANISOTROPY, "normals up to 90 degrees apart", NT_SEVERITY_INFO},
		{90, false, false, 0, "normals up to 90 degrees apart", NT_SEVERITY_INFO},
		{150, false, false, NT_SLOT_NORMAL, "normals up to 150 degrees apart", NT_SEVERITY_WARNING},
		{21, false, false, NT_SLOT_NORMAL, "normals up to 21 degrees apart", NT_SEVERITY_WARNING},
		{19, false, false, NT_SLOT_NORMAL, NULL, 0},
		{90, true, false, NT_SLOT_NORMAL, NULL, 0},  /* cut as it should be */
		{90, true, true, NT_SLOT_NORMAL, NULL, 0},   /* a seam across which normals are smooth is right */
		{90, false, true, NT_SLOT_NORMAL, NULL, 0},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		hand_mesh *h = folded(rows[i].degrees, rows[i].cut, rows[i].smooth);
		h->mesh.slots = rows[i].slots;
		nt_report *report = hand_report(h, NULL);
		assert_int_equal(hand_findings(report, NT_CODE_UV_HARD_EDGE), rows[i].says != NULL);
		if (rows[i].says) {
			const nt_report_finding *finding = hand_finding(report, NT_CODE_UV_HARD_EDGE);
			assert_int_equal(finding->severity, rows[i].severity);
			assert_int_equal(finding->count, 1);
			assert_non_null(strstr(finding->message, rows[i].says));
		}
		hand_free(h, report);
	}
}

/* A lid and the four walls below it, unfolded into a cross: the walls meet in space, but not in the texture. */
TEST(hard_edges_around_a_lid_are_a_closed_loop)
{
	static const float corners[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
	hand_mesh *h = hand_new();
	for (size_t i = 0; i < 4; i++)
		hand_vertex(h, corners[i][0], corners[i][1], 0, corners[i][0], corners[i][1]);
	hand_quad(h, 0, 1, 2, 3);
	for (size_t i = 0; i < 4; i++) {
		const float *a = corners[i], *b = corners[i + 1], out[2] = {b[1] - a[1], a[0] - b[0]};
		const uint32_t first = (uint32_t)h->mesh.vertex_count;
		hand_vertex(h, b[0], b[1], 0, b[0], b[1]);
		hand_vertex(h, a[0], a[1], 0, a[0], a[1]);
		hand_vertex(h, a[0], a[1], -1, a[0] + out[0], a[1] + out[1]);
		hand_vertex(h, b[0], b[1], -1, b[0] + out[0], b[1] + out[1]);
		hand_quad(h, first, first + 1, first + 2, first + 3);
		for (uint32_t v = first; v < first + 4; v++)
			set_normal(h, v, out[0], out[1], 0);
	}
	hand_give_normals(h);
	nt_report *report = hand_report(h, NULL);
	const nt_report_finding *finding = hand_finding(report, NT_CODE_UV_HARD_EDGE);
	assert_int_equal(finding->count, 4);
	assert_non_null(strstr(finding->message, "a closed loop of length 4; normals up to 90 degrees apart"));
	assert_int_equal(report->meshes[0].island_count, 1);
	assert_int_equal(report->meshes[0].hard_count, 1);
	assert_true(report->meshes[0].seams[finding->seam].closed);
	hand_free(h, report);
}

/* Three squares around the corner of a cube, as a picture of it shows them; and a fold far from it. */
TEST(all_hard_edges_are_one_finding_the_longest_net_first)
{
	static const float n[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
	hand_mesh *h = folded(90, false, false);
	for (size_t i = 0; i < 3; i++) {
		const float *a = n[(i + 1) % 3], *b = n[(i + 2) % 3];
		const uint32_t first = (uint32_t)h->mesh.vertex_count;
		for (size_t k = 0; k < 4; k++) {
			const float s = k == 1 || k == 2 ? -1 : 0, t = k == 2 || k == 3 ? -1 : 0;
			float p[3];
			for (int axis = 0; axis < 3; axis++)
				p[axis] = s * a[axis] + t * b[axis];
			hand_vertex(h, p[0] + 9, p[1], p[2], p[0] - p[1] + 9, p[0] + p[1] - 2 * p[2]);
			set_normal(h, first + (uint32_t)k, n[i][0], n[i][1], n[i][2]);
		}
		hand_quad(h, first, first + 1, first + 2, first + 3);
	}
	nt_report *report = hand_report(h, NULL);
	assert_int_equal(hand_findings(report, NT_CODE_UV_HARD_EDGE), 1);
	const nt_report_finding *finding = hand_finding(report, NT_CODE_UV_HARD_EDGE);
	assert_int_equal(finding->count, 4);
	assert_non_null(strstr(finding->message,
		"2 nets, the longest a net of length 3; normals up to 90 degrees apart"));
	/* an edge of each, the longest first */
	assert_int_equal(finding->spot_count, 4);
	assert_true(finding->spots[0].positions[0][0] > 7 && finding->spots[1].positions[0][0] < 3);
	assert_int_equal(report->meshes[0].hard_count, 1);
	assert_int_equal(report->meshes[0].seams[finding->seam].edge_count, 4);
	hand_free(h, report);
}
