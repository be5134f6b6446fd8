/* SPDX-License-Identifier: MIT */
/*
 * Places of faces in an OBJ: lines are counted by hand in the comments, corners as they stand in the text.
 */
#include "fail_alloc.h"
#include "obj_file.h"

/* Face `face` of mesh `mesh` stands in that line and has these corners. */
static void assert_place(const reading *r, uint32_t mesh, uint32_t face, size_t line, const char *corners)
{
	nt_arena arena = {0};
	nt_face_place place = {.mesh = mesh, .face = face};
	assert_int_equal(r->scene.locate_faces(&r->scene, &place, 1, &arena), NT_OK);
	assert_int_equal(place.line, line);
	assert_string_equal(place.corners, corners);
	nt_arena_free(&arena);
}

TEST(locate_faces_by_the_lines_of_their_file)
{
	static const struct {
		const char *text;
		struct {
			uint32_t mesh, face;
			size_t line;
			const char *corners;
		} places[4];
	} cases[] = {
		/* what is no face is not counted: a triangle has its own line, whatever stands before it */
		{TRIANGLE             /* lines 1 to 3 */
			"f 1 2\n"     /* 4: two corners */
			"f 1 2 3\n"   /* 5: face 0 */
			"f\n"         /* 6 */
			"f 2\n"       /* 7 */
			"f 3 1 2\n",  /* 8: face 1 */
			{{0, 0, 5, "1 2 3"}, {0, 1, 8, "3 1 2"}}},
		{"v 0 0 0\rv 1 0 0\rv 0 1 0\r" /* 1 to 3 */
			"# f 9 9 9\r"          /* 4 */
			"f 1 2 3\r"            /* 5: face 0 */
			"\r"                   /* 6 */
			"f 2 3 1",             /* 7: face 1, without an end */
			{{0, 0, 5, "1 2 3"}, {0, 1, 7, "2 3 1"}}},
		{"\xEF\xBB\xBFv 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\n" /* 1 to 3 */
			"\r\n"                                   /* 4 */
			"f 1 2 3\r\n",                           /* 5: face 0 */
			{{0, 0, 5, "1 2 3"}}},
		/* a pentagon becomes three triangles and stays one face of the source */
		{"v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 3 0\nv -1 1 0\n" /* 1 to 5 */
			"f 1 2 3\n"     /* 6: face 0 */
			"f 1 2 3 4 5\n" /* 7: face 1 */
			"f 1 2 3 4\n"   /* 8: face 2 */
			"f 3 4 5\n",    /* 9: face 3 */
			{{0, 1, 7, "1 2 3 4 5"}, {0, 2, 8, "1 2 3 4"}, {0, 3, 9, "3 4 5"}}},
		/* a statement stands where its first word does */
		{"v 0 \\\n0 0\nv 1 0 0\nv 0 1 0\n" /* 1 and 2, 3, 4 */
			"f 1 \\\n"      /* 5: face 0 */
			"\t2 \\\r\n"    /* 6 */
			"3 # f 1 1 1\n" /* 7 */
			" \\\n"         /* 8 */
			"f\t3  1 2#\n"  /* 9: face 1 */
			"fo 2 3 1\n",   /* 10: face 2 */
			{{0, 0, 5, "1 2 3"}, {0, 1, 9, "3 1 2"}, {0, 2, 10, "2 3 1"}}},
		/* faces count from the first of their object, which is a mesh */
		{TRIANGLE "vt 0 0\nvn 0 0 1\n"           /* 1 to 5 */
			"o first\nf 1/1/1 2/1/1 3/1/1\n" /* 6, 7: mesh 0 face 0 */
			"f 1 2\n"                        /* 8 */
			"o empty\no second\n"            /* 9, 10 */
			"f -3//-1 -2//-1 -1//-1\n"       /* 11: mesh 1 face 0 */
			"g other\nf 1/1 2/1 3/1\n",      /* 12, 13: mesh 1 face 1 */
			{{0, 0, 7, "1/1/1 2/1/1 3/1/1"}, {1, 0, 11, "-3//-1 -2//-1 -1//-1"},
				{1, 1, 13, "1/1 2/1 3/1"}}},
	};
	for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
		reading r;
		open_text(&r, cases[i].text);
		assert_int_equal(r.status, NT_OK);
		assert_int_equal(r.scene.mesh_count, strstr(cases[i].text, "o second") ? 2 : 1);
		for (size_t k = 0; k < 4 && cases[i].places[k].line; k++)
			assert_place(&r, cases[i].places[k].mesh, cases[i].places[k].face, cases[i].places[k].line,
				cases[i].places[k].corners);
		close_reading(&r);
	}
}

/* ZBrush writes them. The face before them ends where they begin. */
TEST(locate_before_zero_bytes)
{
	static const char text[] = TRIANGLE /* 1 to 3 */
		"f 1 2 3\0\0";              /* 4: face 0 */
	reading r;
	open_bytes(&r, text, sizeof text, 1);
	assert_int_equal(r.status, NT_OK);
	assert_place(&r, 0, 0, 4, "1 2 3");
	close_reading(&r);
}

/* Corners that do not fit are left out whole. */
TEST(locate_long_polygon)
{
	enum { SIZE = 200 };
	char text[20000], *p = text;
	for (int i = 0; i < SIZE; i++)
		p += sprintf(p, "v %d %d 0\n", i, i * i);
	p += sprintf(p, "f");
	for (int i = 1; i <= SIZE; i++)
		p += sprintf(p, " %d", i);
	sprintf(p, "\n");
	/* " 1" to " 9", " 10" to " 99", then four characters each, without the first blank: 9*2 + 90*3 + 4k - 1 */
	char expected[600] = "1";
	for (int i = 2; i <= 154; i++) /* 507 characters; with 155 they are 511 of 511, which leaves none for " ..." */
		sprintf(expected + strlen(expected), " %d", i);
	assert_int_equal(strlen(expected), 18 + 270 + 4 * 55 - 1);
	strcat(expected, " ...");
	reading r;
	only_mesh(&r, text);
	assert_place(&r, 0, 0, SIZE + 1, expected);
	close_reading(&r);
}

/* Many chunks, with lines that are no faces; asked for all at once, some twice. */
TEST(locate_in_large_files)
{
	enum { GROUPS = 60000, ASKED = 40 };
	char *text = malloc((size_t)GROUPS * 80), *p = text;
	p += sprintf(p, TRIANGLE); /* 1 to 3 */
	for (int i = 0; i < GROUPS; i++) /* 3 lines for each: 4 + 3 i is a comment, 5 + 3 i has face i */
		p += sprintf(p, "# comment number %d, to fill the file\nf 1 2 3\nf 1 2\n", i);
	assert_true(p - text > 3 << 20); /* chunks have 1 MiB */
	reading r;
	open_bytes(&r, text, (size_t)(p - text), 2);
	assert_int_equal(r.status, NT_OK);
	nt_face_place faces[2 * ASKED];
	for (uint32_t i = 0; i < 2 * ASKED; i++)
		faces[i] = (nt_face_place){.face = (GROUPS - 1) / (ASKED - 1) * (i / 2)};
	nt_arena arena = {0};
	assert_int_equal(r.scene.locate_faces(&r.scene, faces, 2 * ASKED, &arena), NT_OK);
	for (size_t i = 0; i < 2 * ASKED; i++) {
		assert_int_equal(faces[i].line, 5 + 3 * (size_t)faces[i].face);
		assert_string_equal(faces[i].corners, "1 2 3");
	}
	assert_place(&r, 0, GROUPS - 1, 5 + 3 * (GROUPS - 1), "1 2 3");
	nt_arena_free(&arena);
	close_reading(&r);
	free(text);
}

TEST(locate_out_of_memory)
{
	reading r;
	only_mesh(&r, TRIANGLE "f 1 2 3\nf 2 3 1\n");
	nt_status status;
	size_t count = 0;
	do {
		nt_arena arena = {0};
		nt_face_place faces[2] = {{.face = 0}, {.face = 1}};
		fail_allocations_from(count++);
		status = r.scene.locate_faces(&r.scene, faces, 2, &arena);
		stop_failing_allocations();
		assert_true(status == NT_OK || status == NT_ERROR_MEMORY);
		nt_arena_free(&arena);
	} while (status);
	assert_true(count > 5); /* the lines, the table of corners, positions, corners, faces, the result */
	close_reading(&r);
}
