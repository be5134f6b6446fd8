/* SPDX-License-Identifier: MIT */
/*
 * Faults of an OBJ file, and in which line; every prefix of a file, and every byte replaced.
 */
#include "obj_file.h"

TEST(file_without_faces_is_refused)
{
	static const char *const texts[] = {"", "\n", "# only a comment", "\xEF\xBB\xBF"};
	for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++)
		assert_fails(texts[i], 0, "found no faces, expected a mesh");
	/* points and lines are sound */
	reading r;
	open_text(&r, TRIANGLE "o a\nl 1 2\n");
	assert_int_equal(r.status, NT_ERROR_UNSUPPORTED);
	assert_string_equal(r.error.message, "found no faces, expected a mesh");
	close_reading(&r);
	assert_fails(TRIANGLE "f 1 2\nf\n", 4,
		"found a face of 2 corners and no larger one in the file, expected at least 3");
}

TEST(damaged_lines_are_named)
{
	assert_fails("v 0 0\n", 1, "found the end of the line, expected 3 coordinates");
	assert_fails("v 0 0 0\nv 0 x 0\n", 2, "found \"x\", expected a number");
	assert_fails("v 0 0 1..2\n", 1, "found \"1..2\", expected a number");
	assert_fails("v 0 0 1.#IND\n", 1, "found \"1.#IND\", expected a number");
	assert_fails("v 0 0 0x10\n", 1, "found \"0x10\", expected a number");
	assert_fails("v 0 0 1,5\n", 1, "found \"1,5\", expected a number");
	assert_fails("v 0 0 -\n", 1, "found \"-\", expected a number");
	assert_fails("v 0 0 +-1\n", 1, "found \"+-1\", expected a number");
	assert_fails("v 0 0 0 1 1\n", 1,
		"found the end of the line, expected 3 coordinates, with a weight or a colour of 3 or 4 numbers");
	assert_fails("v 0 0 0 1 1 1 1 1\n", 1,
		"found \"1\", expected 3 coordinates, with a weight or a colour of 3 or 4 numbers");
	assert_fails("vt\n", 1, "found the end of the line, expected a texture coordinate");
	assert_fails("vt 0 0 0 0\n", 1, "found \"0\", expected at most 3 texture coordinates");
	assert_fails("vn 0 0\n", 1, "found the end of the line, expected 3 components of a normal");
	assert_fails("\n\ns x\n", 3, "found \"x\", expected a smoothing group, on or off");
	assert_fails("s 4294967296\n", 1, "found \"4294967296\", expected a smoothing group, on or off");
	assert_fails(TRIANGLE "f 1 2 x\n", 4,
		"found \"x\", expected the number of a vertex, as in 3, 3/1, 3//2 or 3/1/2");
	assert_fails(TRIANGLE "f 1/x 2 3\n", 4,
		"found \"x\", expected the number of a vertex, as in 3, 3/1, 3//2 or 3/1/2");
	assert_fails(TRIANGLE "f 1/1/1/1 2 3\n", 4, "found \"/1\", expected a blank behind the corner of a face");
	assert_fails(TRIANGLE "f 1.0 2 3\n", 4, "found \".0\", expected a blank behind the corner of a face");
	/* the line of a number behind `\` is its own */
	assert_fails("v 0 \\\n0 \\\nx\n", 3, "found \"x\", expected a number");
	assert_fails("# 1\r# 2\r\n# 3\nv x\n", 4, "found \"x\", expected a number");
}

TEST(numbers_that_are_not_finite_are_refused)
{
	assert_fails("v inf 0 0\n", 1, "found \"inf\", expected a finite number");
	assert_fails("v 0 -nan 0\n", 1, "found \"-nan\", expected a finite number");
	assert_fails("v 0 0 1e39\n", 1, "found \"1e39\", expected a finite number");
	assert_fails("v 0 0 0 nan\n", 1, "found \"nan\", expected a finite number");
	assert_fails("v 0 \\\n0 \\\n0 nan\n", 3, "found \"nan\", expected a finite number");
}

/* One such vt or vn does not cost the file; the finding has the line of the first and the number of all. */
TEST(texcoords_and_normals_that_are_not_finite_become_zeros)
{
	reading r;
	open_text(&r, TRIANGLE "vt 0.5 0.5\nvt NaN 0\nvt 1 1e39\nvn 0 0 +Inf\nvn 0 1 0\nvt 1 0 nan\n"
		"f 1/1/1 2/2/2 3/3/2\n");
	const nt_mesh *m = &r.scene.meshes[0];
	const float texcoords[3][2] = {{0.5f, 0.5f}}, normals[3][3] = {{0}, {0, 1, 0}, {0, 1, 0}};
	assert_memory_equal(m->texcoords, texcoords, sizeof texcoords);
	assert_memory_equal(m->normals, normals, sizeof normals);
	assert_int_equal(r.scene.findings.count, 2);
	const nt_finding *uv = &r.scene.findings.items[0], *normal = &r.scene.findings.items[1];
	assert_int_equal(uv->code, NT_CODE_UV_NOT_FINITE);
	assert_int_equal(uv->count, 2);
	assert_int_equal(uv->place.line, 5);
	assert_int_equal(normal->code, NT_CODE_MESH_NORMAL_ZERO);
	assert_int_equal(normal->count, 1);
	assert_int_equal(normal->place.line, 7);
	close_reading(&r);
	/* one number is u */
	m = only_mesh(&r, TRIANGLE "vt inf\nvt 0.5\nf 1/1 2/2 3/1\n");
	assert_true(m->texcoords[0] == 0 && m->texcoords[2] == 0.5f);
	assert_int_equal(r.scene.findings.items[0].code, NT_CODE_UV_NOT_FINITE);
	close_reading(&r);
}

TEST(indices_out_of_range_are_named)
{
	assert_fails(TRIANGLE "f 0 1 2\n", 4,
		"found \"0\", expected an index, which begins at 1 or counts back from -1");
	assert_fails(TRIANGLE "f 1 2 -0\n", 4,
		"found \"-0\", expected an index, which begins at 1 or counts back from -1");
	assert_fails(TRIANGLE "f 1 2 3\nf 1 2 4\n", 5,
		"face refers to \"v\" number 4, but the file has 3");
	assert_fails(TRIANGLE "vt 0 0\nf 1/1 2/2 3\n", 5,
		"face refers to \"vt\" number 2, but the file has 1");
	assert_fails(TRIANGLE "vn 0 0 1\nf 1//1 2//2 3//3\n", 5, "face refers to \"vn\" number 2, but the file has 1");
	assert_fails(TRIANGLE "f 1 2 99999999\n", 4,
		"face refers to \"v\" number 99999999, but the file has 3");
	assert_fails(TRIANGLE "f 1 2 2147483647\n", 4,
		"face refers to \"v\" number 2147483647, but the file has 3");
	assert_fails(TRIANGLE "f 1 2 2147483648\n", 4,
		"found \"2147483648\", expected an index that a file can hold");
	assert_fails(TRIANGLE "f 1 2 99999999999999999999999\n", 4,
		"found \"99999999999999999999999\", expected an index that a file can hold");
	assert_fails(TRIANGLE "f -1 -2 -4\n", 4,
		"face refers to \"v\" number -4, but 3 precede it");
	assert_fails(TRIANGLE "f -1 -2 -1073741824\n", 4,
		"face refers to \"v\" number -1073741824, but 3 precede it");
	assert_fails("f -1 -2 -3\n" TRIANGLE, 1,
		"face refers to \"v\" number -1, but 0 precede it");
	assert_fails(TRIANGLE "vn 0 0 1\nf 1//-1 2//-1 3//-2\nvn 0 0 1\n", 5,
		"face refers to \"vn\" number -2, but 1 precede it");
	assert_fails(TRIANGLE "f -1 -2 -1073741825\n", 4,
		"found \"-1073741825\", expected an index that a file can hold");
	/* a face of two corners is not used, and its indices are not looked up */
	reading r;
	only_mesh(&r, TRIANGLE "f 7 8\nf 1 2 3\n");
	close_reading(&r);
}

TEST(bytes_that_are_no_text_are_refused)
{
	reading r;
	open_bytes(&r, "v 0 0 0\n\0\0x\n", 12, 1);
	assert_int_equal(r.status, NT_ERROR_INPUT);
	assert_int_equal(r.error.place.line, 2);
	assert_string_equal(r.error.message,
		"found \"\\x00\\x00x\", expected a statement of an OBJ file");
	close_reading(&r);
	open_bytes(&r, "v 0 0\0000\n", 9, 1);
	assert_int_equal(r.status, NT_ERROR_INPUT);
	assert_string_equal(r.error.message, "found \"0\\x000\", expected a number");
	close_reading(&r);
	open_bytes(&r, "o a\0b\n", 6, 1);
	assert_int_equal(r.status, NT_ERROR_INPUT);
	assert_string_equal(r.error.message, "found \"\\x00b\", expected a name in text");
	close_reading(&r);
	assert_fails("\xFF\xFEv\n", 1, "found \"\\xff\\xfev\", expected a statement of an OBJ file");
	assert_fails("# fine\n\x7F" "ELF\n", 2, "found \"\\x7fELF\", expected a statement of an OBJ file");
}

/* A line of a few NUL, which ZBrush writes, is counted; a hole in a file is none. */
TEST(lines_of_nul_alone_are_passed_over)
{
	static const char text[] = TRIANGLE "\0\nf 1 2 3\n\0 \0\r\n";
	char hole[4096 + sizeof text] = {0};
	reading r;
	open_bytes(&r, text, sizeof text - 1, 1);
	assert_int_equal(r.status, NT_OK);
	assert_int_equal(r.scene.findings.count, 1);
	assert_int_equal(r.scene.findings.items[0].code, NT_CODE_STATEMENT_IGNORED);
	assert_int_equal(r.scene.findings.items[0].count, 2);
	assert_int_equal(r.scene.findings.items[0].place.line, 4);
	close_reading(&r);
	memcpy(hole + 4096, "\n" TRIANGLE "f 1 2 3\n", sizeof "\n" TRIANGLE "f 1 2 3\n");
	open_bytes(&r, hole, 4096 + strlen("\n" TRIANGLE "f 1 2 3\n"), 1);
	assert_int_equal(r.status, NT_ERROR_INPUT);
	close_reading(&r);
}

/* Cut anywhere, the file it is read or refused with a line; the sanitizers watch. */
TEST(every_prefix_is_survived)
{
	static const char text[] = "\xEF\xBB\xBFmtllib a.mtl b.mtl\no a\nv 0 0 0\nv 1 0 0 1 1 1\r\nv 1 1 1e-3\n"
		"v 0.12345678901234567890 1 0 \\\n 1\nv -1 0.5 0\nvt 0.5\nvt 1 1\nvn 0 0 1\nusemtl m\ns 1\n"
		"f 1/1/1 2/2/1 3//1\nf -1 -2 -3 -4 -5\n# comment \\\nl 1 2\nf 1 2 3 \\\n4 # end\ng x\ns off\n"
		"f 5 4 3";
	for (size_t size = 0; size < sizeof text; size++) {
		reading r;
		open_bytes(&r, text, size, 1);
		assert_true(r.status == NT_OK || r.status == NT_ERROR_INPUT || r.status == NT_ERROR_UNSUPPORTED);
		close_reading(&r);
	}
	reading r;
	open_bytes(&r, text, sizeof text - 1, 1);
	assert_int_equal(r.status, NT_OK);
	close_reading(&r);
}

/* Every byte of a small file replaced by every other: read or refused. */
TEST(every_changed_byte_is_survived)
{
	static const char good[] = "o a\nv 0 0 0\nv 1. 0 -1\nv 0 1 0\nvt 0 1\nf 1/1 -2/1 3//\ns 1\nf 3 2 1 \\\n2\n";
	char text[sizeof good];
	for (size_t at = 0; at + 1 < sizeof good; at++)
		for (int c = 0; c < 256; c++) {
			memcpy(text, good, sizeof good);
			text[at] = (char)c;
			reading r;
			open_bytes(&r, text, sizeof good - 1, 1);
			assert_true(r.status == NT_OK || r.status == NT_ERROR_INPUT);
			close_reading(&r);
		}
}
