/* SPDX-License-Identifier: MIT */
/*
 * Text of 8 MB, so that it is read in pieces: threads do not show, neither in what is read nor in what is
 * refused and where. The values are those that were written.
 */
#include "ply_file.h"
#include "base/text.h"

enum { VERTICES = 260000, FACES = 150000, MIDDLE = 130001 };

/* Vertex i is at (i, 0.5, -i) and has one number more, so that a face looks like a vertex; row MIDDLE of vertices and
 * of faces is preceded or followed by others. */
static nt_buffer make_file(const char *before_vertex, const char *before_face, const char *line_end)
{
	nt_buffer text = {0};
	nt_buffer_format(&text, "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
		"property float z\nproperty uchar flag\nelement face %d\n"
		"property list uchar int vertex_indices\nend_header\n",
		(int)VERTICES, (int)FACES);
	for (int i = 0; i < VERTICES; i++)
		nt_buffer_format(&text, "%s%d 0.5000000 %d 7%s", i == MIDDLE ? before_vertex : "", i, -i, line_end);
	for (int i = 0; i < FACES; i++)
		nt_buffer_format(&text, "%s3 %d %d %d%s", i == MIDDLE ? before_face : "", i, i + 1, i + 2, line_end);
	assert_false(text.failed);
	return text;
}

static void check_values(const nt_mesh *mesh)
{
	assert_int_equal(mesh->vertex_count, VERTICES);
	assert_int_equal(mesh->face_count, FACES);
	size_t wrong = 0;
	for (int i = 0; i < VERTICES; i++)
		wrong += mesh->positions[3 * i] != (float)i || mesh->positions[3 * i + 1] != 0.5f ||
			mesh->positions[3 * i + 2] != (float)-i;
	for (uint32_t i = 0; i < FACES; i++)
		wrong += mesh->indices[3 * i] != i || mesh->indices[3 * i + 1] != i + 1 ||
			mesh->indices[3 * i + 2] != i + 2;
	assert_int_equal(wrong, 0);
}

TEST(values_are_those_of_the_file)
{
	static const struct {
		const char *before_vertex, *before_face, *line_end;
	} files[] = {{"", "", "\n"}, {"", "", "\r\n"}, {"\n\n", "", "\n"}, {"", " ", "\n"}, {"\t", "\n", "\n"},
		{"", "", " \n"}, {"  ", "", "  \r\n"}};
	for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
		nt_buffer text = make_file(files[i].before_vertex, files[i].before_face, files[i].line_end);
		for (unsigned threads = 1; threads <= 3; threads++) {
			reading r;
			open_by_threads(&r, text.data, text.size, threads);
			assert_int_equal(r.status, NT_OK);
			check_values(r.mesh);
			assert_int_equal(r.scene.findings.count, 0);
			close_reading(&r);
		}
		nt_buffer_free(&text);
	}
}

TEST(faults_are_found_where_they_are)
{
	/* ten lines of header */
	static const struct {
		const char *before_vertex, *before_face;
		size_t line;
	} files[] = {{"1 2\n", "", 11 + MIDDLE}, {"1 2 nan 4\n", "", 11 + MIDDLE}, {"1 2 3 4 5\n", "", 11 + MIDDLE},
		{"", "3 0 1 260000\n", 11 + VERTICES + MIDDLE}, {"", "3 0 1\n", 11 + VERTICES + MIDDLE}};
	for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
		nt_buffer text = make_file(files[i].before_vertex, files[i].before_face, "\n");
		char message[sizeof((nt_error *)NULL)->message];
		for (unsigned threads = 1; threads <= 3; threads++) {
			reading r;
			open_by_threads(&r, text.data, text.size, threads);
			assert_int_equal(r.status, NT_ERROR_INPUT);
			assert_int_equal(r.error.place.line, files[i].line);
			if (threads == 1)
				memcpy(message, r.error.message, sizeof message);
			assert_string_equal(r.error.message, message);
			close_reading(&r);
		}
		nt_buffer_free(&text);
	}
}
