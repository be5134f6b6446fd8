/* SPDX-License-Identifier: MIT */
/*
 * Every prefix of an OBJ file and of a library, and every byte replaced; tests/cli/texts.tsv has each fault and its
 * line.
 */
#include "obj_file.h"
#include "obj/parts.h"

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

TEST(every_prefix_of_a_library_is_survived)
{
	static const char text[] = "\xEF\xBB\xBFnewmtl a\r\nKd 1 1 1\nd -halo 0.5\nmap_Kd -bm 1 -s 1 1 a b.png\n"
		"bump \"b.png\" -bm 0.5\nxyz\nnewmtl b\nKe 1";
	for (size_t size = 0; size < sizeof text; size++) {
		unsigned char *bytes = malloc(size ? size : 1);
		nt_scene scene;
		nt_mtl mtl = {0};
		nt_error error;
		memcpy(bytes, text, size);
		nt_scene_init(&scene, "a.obj");
		assert_int_equal(nt_mtl_parse(&scene, "a.mtl", bytes, size, &mtl, &error), NT_OK);
		nt_mtl_free(&mtl);
		nt_scene_free(&scene);
		free(bytes);
	}
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
