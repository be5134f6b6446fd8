/* SPDX-License-Identifier: MIT */
/*
 * Deltas of morph targets at weight 0.5, against theory. A square in the plane with (u, v up) = (x, y) has dP/du =
 * (1, 0); a linear map M takes that to the first column m of M. At weight 0.5 the mesh has dP/du = (e + m) / 2, while a
 * client adds unit vectors: e + m / |m|, which halves the angle. With m at the angle a and of length s that is
 *
 *     | a / 2 - atan2(s sin a, 1 + s cos a) |
 *
 * which is 0 for every rigid turn below 180 degrees, where both cancel.
 */
#include "hand_gltf_file.h"
#include <math.h>

enum { MOST_VERTICES = 64 };

static const double PI = 3.14159265358979323846;

/* A grid of columns by 1 quads over (x, y), in the base and as one target moves it. */
typedef struct grid {
	size_t columns, vertex_count;
	float positions[MOST_VERTICES][3], normals[MOST_VERTICES][3], texcoords[MOST_VERTICES][2];
	float moves[MOST_VERTICES][3], turns[MOST_VERTICES][3]; /* deltas */
} grid;

static void make_grid(grid *g, size_t columns)
{
	memset(g, 0, sizeof *g);
	g->columns = columns;
	g->vertex_count = 2 * (columns + 1);
	for (size_t i = 0; i < g->vertex_count; i++) {
		const float x = (float)(i / 2), y = (float)(i % 2);
		memcpy(g->positions[i], (float[]){x, y, 0}, sizeof g->positions[i]);
		g->normals[i][2] = 1;
		g->texcoords[i][0] = x;
		g->texcoords[i][1] = -y; /* v points down in glTF */
	}
}

/* The target is a linear map of the plane with these columns. */
static void map(grid *g, double ux, double uy, double vx, double vy)
{
	for (size_t i = 0; i < g->vertex_count; i++) {
		const double x = g->positions[i][0], y = g->positions[i][1];
		g->moves[i][0] = (float)(ux * x + vx * y - x);
		g->moves[i][1] = (float)(uy * x + vy * y - y);
	}
}

static void put_grid(const grid *g, const char *extras)
{
	const size_t n = g->vertex_count;
	const float (*const rows[])[3] = {g->positions, g->normals, g->moves, g->turns};
	hand_file f = {0};
	nt_buffer members = {0};
	uint16_t corners[MOST_VERTICES / 2][6];
	for (uint16_t i = 0; i < g->columns; i++)
		for (int k = 0; k < 6; k++)
			corners[i][k] = (uint16_t)(2 * i + "\0\2\3\0\3\1"[k]);
	for (size_t i = 0; i < 4; i++)
		put_accessor(&f, rows[i], n, NT_GLTF_FLOAT, "VEC3");
	put_accessor(&f, g->texcoords, n, NT_GLTF_FLOAT, "VEC2");
	put_accessor(&f, corners, 6 * g->columns, NT_GLTF_USHORT, "SCALAR");
	nt_buffer_format(&members, NORMAL_MAP "\"meshes\":[{%s\"primitives\":[{\"attributes\":{\"POSITION\":0,"
		"\"NORMAL\":1,\"TEXCOORD_0\":4},\"indices\":5,\"material\":0,\"targets\":[{\"POSITION\":2,"
		"\"NORMAL\":3}]}]}],", extras);
	put_glb("in.glb", &f, members.data);
	nt_buffer_free(&members);
}

/* Converts; the angle of the finding, 0 where there is none. */
static double found(const grid *g, const char *extras, size_t *triangles, char *detail)
{
	put_grid(g, extras);
	nt_summary summary = convert_file("in.glb", "out.glb", (nt_settings){.threads = 1});
	double angle = 0;
	for (size_t i = 0; i < summary.findings.count; i++) {
		const nt_finding *finding = &summary.findings.items[i];
		if (finding->code != NT_CODE_TAN_MORPH_HALFWAY)
			continue;
		assert_true(angle == 0);
		assert_int_equal(sscanf(strrchr(finding->detail, ',') + 1, "%lf degrees", &angle), 1);
		*triangles = finding->count;
		strcpy(detail, finding->detail);
	}
	nt_summary_free(&summary);
	return angle;
}

static double theory(double degrees, double length)
{
	const double a = degrees * PI / 180;
	return fabs(a / 2 - atan2(length * sin(a), 1 + length * cos(a))) * 180 / PI;
}

/* 0.1 is the last digit of the sentence. */
static void angle_is(const grid *g, double expected)
{
	size_t triangles = 0;
	char detail[256] = "";
	const double angle = found(g, "", &triangles, detail);
	if (fabs(angle - expected) > 0.06)
		fail_msg("%g degrees, expected %g (%s)", angle, expected, detail);
	assert_int_equal(triangles, expected > 0 ? 2 * g->columns : 0);
}

TEST(shear_is_off_by_the_half_angle)
{
	grid g;
	make_grid(&g, 1);
	/* y grows by k x: m = (1, k) */
	for (double k = 0.25; k < 8; k *= 2) {
		map(&g, 1, k, 0, 1);
		const double expected = theory(atan(k) * 180 / PI, sqrt(1 + k * k));
		/* 0.1 degrees at a shear of 1/4, 4.07 at 1, 13.3 at 2 */
		angle_is(&g, expected > 5 ? expected : 0);
	}
	/* x grows by y: u runs as before */
	map(&g, 1, 0, 3, 1);
	angle_is(&g, 0);
}

TEST(a_quarter_turn_is_exact_unless_it_stretches)
{
	grid g;
	make_grid(&g, 1);
	map(&g, 0, 1, -1, 0);
	angle_is(&g, 0);
	map(&g, 0, 2, -2, 0);
	assert_true(fabs(theory(90, 2) - (atan(2) * 180 / PI - 45)) < 1e-9);
	angle_is(&g, theory(90, 2));
	map(&g, 0, 0.5, -1, 0);
	angle_is(&g, theory(90, 0.5));
}

TEST(a_half_turn_leaves_no_direction)
{
	grid g;
	make_grid(&g, 1);
	map(&g, -1, 0, 0, -1);
	angle_is(&g, 90);
	/* stretched, so that what is right points to the other side: still none for the client */
	map(&g, -3, 0, 0, -3);
	angle_is(&g, 90);
	/* about the x axis: u stays, but the square is a line halfway, where nothing is right or wrong */
	map(&g, 1, 0, 0, -1);
	angle_is(&g, 0);
}

/* A strip bent to a polygon about the y axis: each column keeps its width and turns by an angle of its own, the
 * vertices' normals by the mean of their two columns'. Halfway both have half of that angle, so the tangents of the
 * ends lead there although the last column turns by 90 degrees. Stretched by the same bend they do not. */
static void bend(grid *g, double width)
{
	const size_t columns = g->columns;
	double x = 0, z = 0;
	for (size_t i = 0; i <= columns; i++) {
		const double step = PI / 2 / (double)columns, before = (double)i * step, turn = before - step / 2;
		if (i > 0) {
			x += width * cos(turn);
			z += width * sin(turn);
		}
		for (size_t k = 0; k < 2; k++) {
			float *move = g->moves[2 * i + k], *normal = g->turns[2 * i + k];
			move[0] = (float)(x - (double)i);
			move[2] = (float)z;
			normal[0] = (float)-sin(before);
			normal[2] = (float)(cos(before) - 1);
		}
	}
}

TEST(a_bend_that_keeps_lengths_is_exact)
{
	grid g;
	make_grid(&g, 20);
	bend(&g, 1);
	angle_is(&g, 0);
	/* a column of three times its width: its tangent lies across the normal halfway, which has half of the angle
	 * whatever the width is */
	bend(&g, 3);
	angle_is(&g, 0);
	/* normals that stay: T is dP/du without its part along z, (1, 0, 0) at both ends and halfway */
	memset(g.turns, 0, sizeof g.turns);
	angle_is(&g, 0);
}

TEST(the_finding_names_the_target)
{
	grid g;
	size_t triangles = 0;
	char detail[256] = "";
	make_grid(&g, 1);
	map(&g, 0, 2, -2, 0);
	found(&g, "\"extras\":{\"targetNames\":[\"smile\"]},", &triangles, detail);
	assert_string_equal(detail, "target 0 \"smile\", 18.4 degrees");
	found(&g, "\"extras\":{\"targetNames\":3},", &triangles, detail);
	assert_string_equal(detail, "target 0, 18.4 degrees");
}

AROUND_ALL(make_folder, remove_folder)
