/* SPDX-License-Identifier: MIT */
/*
 * Text of 8 MB, so that it is read in pieces: threads do not show, neither in what is read nor in what is
 * refused and where. The values are those that were written.
 */
#include "ply_file.h"
#include "base/buffer.h"
#include "ply/source.h"

enum { VERTICES = 260000, FACES = 150000, MIDDLE = 130001 };

/* Vertex i is at (i, 0.5, -i); row MIDDLE of vertices and of faces is preceded or followed by others. */
static nt_buffer make_file(const char *before_vertex, const char *before_face, const char *line_end)
{
	nt_buffer text = {0};
	nt_buffer_format(&text, "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
		"property float z\nelement face %d\nproperty list uchar int vertex_indices\nend_header\n",
		(int)VERTICES, (int)FACES);
	for (int i = 0; i < VERTICES; i++)
		nt_buffer_format(&text, "%s%d 0.5000000 %d%s", i == MIDDLE ? before_vertex : "", i, -i, line_end);
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
	} files[] = {{"", "", "\n"}, {"", "", "\r\n"}, {"\n\n", "", "\n"}, {"", " ", "\n"}, {"\t", "\n", "\n"}};
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
	/* nine lines of header */
	static const struct {
		const char *before_vertex, *before_face;
		size_t line;
	} files[] = {{"1 2\n", "", 10 + MIDDLE}, {"1 2 nan\n", "", 10 + MIDDLE}, {"1 2 3 4\n", "", 10 + MIDDLE},
		{"", "3 0 1 260000\n", 10 + VERTICES + MIDDLE}, {"", "3 0 1\n", 10 + VERTICES + MIDDLE}};
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

/* Takes lines of one letter; an 'x' is none. */
static size_t take_letters(void *user, ply_cursor *cursor, size_t first, size_t rows)
{
	char *rows_of = user;
	size_t taken = 0;
	for (; taken < rows && cursor->end - cursor->at >= 2 && *cursor->at != 'x' && cursor->at[1] == '\n'; taken++) {
		rows_of[first + taken] = (char)*cursor->at;
		cursor->at += 2;
	}
	return taken;
}

/* The run ends with the last row that is wanted, or before the first that is no such row, and after that one thread
 * goes on alone. */
TEST(runs_end_at_the_first_other_row)
{
	enum { LINES = 3 << 20 };
	char *text = malloc(2 * LINES), *read = calloc(LINES, 1);
	for (size_t i = 0; i < LINES; i++)
		memcpy(text + 2 * i, i % 3 ? "a\n" : "b\n", 2);
	const size_t ends[] = {LINES, 7, 1 << 20, LINES - 1, 2000000};
	for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
		const unsigned char *begin = (const unsigned char *)text;
		ply_cursor cursor = {.begin = begin, .at = begin, .end = begin + 2 * LINES, .threads = 3};
		assert_int_equal(ply_take_pieces(&cursor, ends[i], take_letters, read), ends[i]);
		assert_ptr_equal(cursor.at, begin + 2 * ends[i]);
		assert_int_equal(cursor.threads, 3);
		if (ends[i] == LINES)
			continue;
		text[2 * ends[i]] = 'x';
		cursor.at = begin;
		assert_int_equal(ply_take_pieces(&cursor, LINES, take_letters, read), ends[i]);
		assert_ptr_equal(cursor.at, begin + 2 * ends[i]);
		assert_int_equal(cursor.threads, 1);
		text[2 * ends[i]] = ends[i] % 3 ? 'a' : 'b';
	}
	size_t wrong = 0;
	for (size_t i = 0; i < LINES; i++)
		wrong += read[i] != (i % 3 ? 'a' : 'b');
	assert_int_equal(wrong, 0);
	free(text);
	free(read);
}
