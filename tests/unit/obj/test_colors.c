/* SPDX-License-Identifier: MIT */
/*
 * Colours in comments. The expected values follow from sRGB's definition: 0 and 255 are 0 and 1, and 188 is
 * ((188 / 255 + 0.055) / 1.055)^2.4 = 0.5029.
 */
#include "obj_file.h"

#include <math.h>

static void assert_color(const nt_mesh *mesh, size_t vertex, float r, float g, float b)
{
	const float expected[4] = {r, g, b, 1};
	for (size_t k = 0; k < 4; k++)
		assert_true(fabsf(mesh->colors[4 * vertex + k] - expected[k]) < 1e-4f);
}

TEST(colors_of_lines_and_blocks)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r, TRIANGLE
		"#The following MRGB block contains ZBrush Vertex Color (Polypaint) ...\n"
		"#MRGB ffff0000ff00FF00\n"
		"# End of the first line\n"
		"#MRGB  000000bc \r\n"
		"v 2 0 0\n"
		"#MRGB ff00ffff\n"
		"f 1 2 3\nf 4 3 2\n");
	assert_color(mesh, 0, 1, 0, 0);
	assert_color(mesh, 1, 0, 1, 0);
	assert_color(mesh, 2, 0, 0, 0.5029f); /* its mask is no opacity */
	assert_color(mesh, 3, 0, 1, 1);
	assert_int_equal(r.scene.findings.count, 0);
	close_reading(&r);
}

TEST(colors_of_vertices_come_first)
{
	reading r;
	const nt_mesh *mesh =
		only_mesh(&r, "v 0 0 0 1 0 1\nv 1 0 0\nv 0 1 0\n#MRGB ff00ff00ff00ff00ff00ff00\nf 1 2 3\n");
	assert_color(mesh, 0, 1, 0, 1);
	assert_color(mesh, 1, 1, 1, 1);
	close_reading(&r);
}

/* ZBrush writes it of what nobody painted. */
TEST(white_all_over_is_no_color)
{
	reading r;
	const nt_mesh *mesh = only_mesh(&r, TRIANGLE "#MRGB ffffffffffffffffffffffff\nf 1 2 3\n");
	assert_null(mesh->colors);
	assert_int_equal(r.scene.findings.count, 0);
	close_reading(&r);
}

TEST(what_is_malformed_is_doubtful_and_white)
{
	static const struct {
		const char *lines, *detail;
		float color[3][3];
	} cases[] = {
		{"#MRGB ffff0000ff00xx00ff0000ff\n",
			"#MRGB: found something else, expected 8 hexadecimal digits for each vertex",
			{{1, 0, 0}, {1, 1, 1}, {0, 0, 1}}},
		{"#MRGB ffff0000ff00ff00ff0000\n",
			"#MRGB: found something else, expected 8 hexadecimal digits for each vertex",
			{{1, 0, 0}, {0, 1, 0}, {1, 1, 1}}},
		{"#MRGB ff00ff00ff0000ff\n", "#MRGB: 2 colours for 3 vertices", {{1, 1, 1}, {0, 1, 0}, {0, 0, 1}}},
		{"#MRGB ffff0000ff00ff00ff0000ffff123456\n", "#MRGB: 4 colours for 3 vertices",
			{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
	};
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		char text[256];
		snprintf(text, sizeof text, TRIANGLE "%sf 1 2 3\n", cases[i].lines);
		reading r;
		const nt_mesh *mesh = only_mesh(&r, text);
		assert_int_equal(r.scene.findings.count, 1);
		assert_int_equal(r.scene.findings.items[0].code, NT_CODE_COLORS_DOUBTFUL);
		assert_string_equal(r.scene.findings.items[0].detail, cases[i].detail);
		assert_int_equal(r.scene.findings.items[0].place.line, 4);
		for (size_t v = 0; v < 3; v++)
			assert_color(mesh, v, cases[i].color[v][0], cases[i].color[v][1], cases[i].color[v][2]);
		close_reading(&r);
	}
	reading r;
	assert_null(only_mesh(&r, "#MRGB ff000000\n#MRGB\n#MRGB \n" TRIANGLE "f 1 2 3\n")->colors); /* of no vertices */
	assert_int_equal(r.scene.findings.count, 1);
	close_reading(&r);
}

/* Findings of nonsense do not grow with it. */
TEST(many_blocks_are_few_findings)
{
	enum { COUNT = 1000 };
	char *text = malloc(COUNT * 32 + 64), *to = text;
	for (int i = 0; i < COUNT; i++)
		to += sprintf(to, "v %d 0 0\n#MRGB zz\n#MRGB 0\n", i);
	sprintf(to, "f 1 2 3\n");
	reading r;
	only_mesh(&r, text);
	assert_int_equal(r.scene.findings.count, 3);
	close_reading(&r);
	free(text);
}

/* A file of several chunks, whose colours stand in other chunks than their vertices. */
TEST(colors_reach_over_chunks)
{
	enum { COUNT = 150000, OF_LINE = 64 };
	char *text = malloc((size_t)COUNT * 64), *to = text;
	for (int i = 0; i < COUNT; i++)
		to += sprintf(to, "v %d %d 0.000001\n", i, i % 7);
	for (int i = 0; i < COUNT; i++)
		to += sprintf(to, "%sff%06x%s", i % OF_LINE ? "" : "#MRGB ", (unsigned)i,
			i % OF_LINE == OF_LINE - 1 ? "\n" : "");
	to += sprintf(to, "\n");
	for (int i = 1; i + 2 <= COUNT; i++)
		to += sprintf(to, "f %d %d %d\n", i, i + 1, i + 2);
	for (unsigned threads = 1; threads <= 4; threads += 3) {
		reading r;
		open_bytes(&r, text, (size_t)(to - text), threads);
		assert_int_equal(r.status, NT_OK);
		assert_int_equal(r.scene.findings.count, 0);
		for (size_t i = 0; i < COUNT; i++) {
			const float expected[] = {(float)(i >> 16), (float)(i >> 8 & 255), (float)(i & 255)};
			for (size_t k = 0; k < 3; k++) {
				const float c = expected[k] / 255;
				const float linear = c <= 0.04045f ? c / 12.92f : powf((c + 0.055f) / 1.055f, 2.4f);
				assert_true(fabsf(r.scene.meshes[0].colors[4 * i + k] - linear) < 1e-5f);
			}
		}
		close_reading(&r);
	}
	free(text);
}
