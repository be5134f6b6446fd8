/* SPDX-License-Identifier: MIT */
/*
 * Guesses from what files say about themselves. The expected numbers are those of the table in need.c.
 */
#include "batch/need.h"
#include "folder.h"
#include "test.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MB = 1 << 20 };

static uint64_t need_of(const char *name)
{
	const nt_settings settings = {0};
	return nt_need_of(in_folder(name), &settings, 0);
}

/* The estimate for text that is no glTF: its bytes, a PLY's also by the elements of its header. */
TEST(text_counts_by_its_bytes)
{
	static const struct {
		const char *name, *text;
		uint64_t each, more;
	} rows[] = {{"a.drc", "DRACO...", 256, 0}, {"empty.obj", "", 2, 0},
		/* five corners, which are two vertices at most, four with texture coordinates, five with normals too */
		{"v.obj", "v 0 0 0\nv 1 0 0\no b\nf 1 2 2\nusemtl m\nf 1 2  \n", 2, 5 * 60 + 2 * 140 + 2 * 2300},
		{"vt.obj", "v 0 0 0\nv 1 0 0\nvt 0 0\nvt 1 1\nf 1/1 2/2 2/1\nf 1/1 2/2\n", 2, 5 * 60 + 4 * 140},
		{"vn.obj", "v 0 0 0\nv 1 0 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\nf 1 2 2\nf 1 2\n", 2,
			5 * 60 + 5 * 140},
		{"a.ply", "ply\nformat ascii 1.0\nelement vertex 1000\nproperty float x\nelement face  20\nend_header\n"
			"element vertex 7\n", 2, 140 * 1020}, {"open.ply", "ply\nelement ", 2, 0}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		put_text_file(rows[i].name, rows[i].text);
		assert_int_equal(need_of(rows[i].name), MB + rows[i].each * strlen(rows[i].text) + rows[i].more);
	}
}

/* 300 faces and 200 vertices, as each method writes them; with metadata, and of an older version, by the bytes. */
TEST(draco_counts_by_its_header)
{
	static const struct {
		const char *bytes;
		size_t size;
		bool told;
	} rows[] = {{"DRACO\2\2\1\0\0\0\254\2\310\1", 15, true}, {"DRACO\2\2\1\1\0\0\0\310\1\254\2", 16, true},
		{"DRACO\2\2\1\0\0\200\254\2\310\1", 15, false}, {"DRACO\2\1\1\0\0\0\254\2\310\1", 15, false}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		put_file("d.drc", rows[i].bytes, rows[i].size);
		assert_int_equal(need_of("d.drc"),
			MB + (rows[i].told ? rows[i].size + 120 * 300 + 190 * 200 : 256 * rows[i].size));
	}
	/* two blocks of a GLB whose JSON says nothing of them */
	static const char blocks[] = "DRACO\2\2\1\0\0\0\254\2\310\1 DRACO\2\2\1\0\0\0\254\2\310\1";
	put_glb_file("d.glb", "{}  ", blocks, sizeof blocks - 1);
	assert_in_range(need_of("d.glb"), MB + 2 * (120 * 300 + 190 * 200), MB + 2 * (120 * 300 + 190 * 200) + 100);
	/* numbers that do not end */
	put_file("d.drc", "DRACO\2\2\1\0\0\0\377\377", 13);
	assert_int_equal(need_of("d.drc"), MB + 13);
}

/* A large file is judged by parts of it. */
TEST(a_large_obj_is_sampled)
{
	enum { FACES = 600000, BYTES = 14 };
	char *text = malloc(FACES * BYTES + 1);
	assert_non_null(text);
	for (size_t i = 0; i < FACES; i++)
		memcpy(text + BYTES * i, i % 2 ? "f 1/1 2/2 3/3\n" : "v 100 200 300\n", BYTES);
	put_file("large.obj", text, FACES * BYTES);
	free(text);
	const uint64_t expected = MB + 2 * FACES * BYTES + FACES / 2 * (3 * 60 + 140);
	assert_in_range(need_of("large.obj"), expected - expected / 50, expected + expected / 50);
}

TEST(gltf_counts_by_its_accessors_wherever_their_bytes_are)
{
	static const char plain[] = "{\"accessors\":[{\"count\": 600 },{ \"count\"\n:30}],\"bufferViews\":[]}";
	static const char draco[] =
		"{\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],\"accessors\":[{\"count\":600}]}";
	put_text_file("a.gltf", plain);
	assert_int_equal(need_of("a.gltf"), MB + 12 * strlen(plain) + 46 * 630);
	put_text_file("d.gltf", draco);
	assert_int_equal(need_of("d.gltf"), MB + 12 * strlen(draco) + 112 * 600);
	const nt_settings compress = {.draco = NT_DRACO_AS_EDGEBREAKER};
	assert_int_equal(nt_need_of(in_folder("a.gltf"), &compress, 0), MB + 12 * strlen(plain) + 112 * 630);
}

/* Each target has the elements of its accessors, which it may share; what only looks like a target has none. */
TEST(morph_targets_count_as_often_as_they_are)
{
	static const char json[] = "{\"targets\":[],\"accessors\":[{\"count\":7,\"sparse\":{\"count\":99}},"
		"{\"x\":\"\\\"count\\\":5\",\"count\" : 600}],\"meshes\":[{\"primitives\":["
		"{\"attributes\":{\"POSITION\":1},\"targets\":[{\"POSITION\":1,\"NORMAL\": 0},{\"POSITION\":1},"
		"{\"TEXCOORD_0\":1}]},{\"targets\":[{\"POSITION\":1}, {\"POSITION\":9}]}]}]}";
	const uint64_t plain = MB + 12 * strlen(json) + 46 * (7 + 99 + 600);
	put_text_file("m.gltf", json);
	assert_int_equal(need_of("m.gltf"), plain + 20 * (3 * 600 + 7));
	const nt_settings keep = {.morphs = NT_MORPH_KEEP}, verify = {.verify = true};
	assert_int_equal(nt_need_of(in_folder("m.gltf"), &verify, 0), plain + 60 * (3 * 600 + 7));
	assert_int_equal(nt_need_of(in_folder("m.gltf"), &keep, 0), plain);
	/* cut anywhere */
	for (size_t size = 1; size < sizeof json - 1; size++) {
		put_file("cut.gltf", json, size);
		assert_true(need_of("cut.gltf") >= MB);
	}
}

TEST(a_glb_counts_its_json_and_its_bytes)
{
	static const char json[] = "{\"accessors\":[{\"count\":600}]}  ", more[] = "\"count\":99999";
	struct stat info;
	put_glb_file("a.glb", json, more, sizeof more - 1);
	assert_int_equal(stat(in_folder("a.glb"), &info), 0);
	const uint64_t padded = (strlen(json) + 3) / 4 * 4;
	assert_int_equal(need_of("a.glb"), MB + 12 * padded + ((uint64_t)info.st_size - 20 - padded) + 46 * 600);
	put_text_file("short.glb", "glTF\2\0\0");
	assert_true(need_of("short.glb") >= MB);
	/* a length beyond the file */
	put_file("long.glb", "glTF\2\0\0\0\30\0\0\0\377\377\377\377JSON{}  ", 24);
	assert_int_equal(need_of("long.glb"), MB + 12 * 4);
}

/* A height map and a TGA of colours, of 256 x 512; a PNG of colours is not converted, and what is elsewhere is not
 * looked at. */
TEST(an_obj_counts_the_largest_images_that_are_converted)
{
	static const char obj[] = "# head\nmtllib m.mtl\r\nv 0 0 0\n";
	static const unsigned char png[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D',
		'R', 0, 0, 1, 0, 0, 0, 2, 0}, tga[] = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 2, 24, 0};
	static const char mtl[] = "newmtl a\n\tmap_Bump -bm 2 h.png \nmap_Bump h.png\nmap_Kd c.tga\n"
		"map_Ke h.png\nmap_Pr ../need/h.png\nnorm none.png";
	put_text_file("i.obj", obj);
	put_file("h.png", png, sizeof png);
	put_file("c.tga", tga, sizeof tga);
	const nt_settings of_two = {.threads = 2}, of_one = {.threads = 1}, ply = {.output_format = NT_FORMAT_PLY};
	const uint64_t bare = MB + 2 * strlen(obj);
	assert_int_equal(nt_need_of(in_folder("i.obj"), &of_two, 1 << 30), bare);
	put_text_file("m.mtl", mtl);
	assert_int_equal(nt_need_of(in_folder("i.obj"), &of_two, 0), bare + 2 * 6 * 256 * 512);
	assert_int_equal(nt_need_of(in_folder("i.obj"), &of_one, 1 << 30), bare + 6 * 256 * 512);
	assert_int_equal(nt_need_of(in_folder("i.obj"), &ply, 0), bare);
}

/* Each half of these is a number, and what it would take: 2 * 2^63, 46 * 2^60. */
TEST(what_is_claimed_beyond_64_bits_is_more_than_there_is)
{
	static const char *const rows[][2] = {
		{"sum.gltf", "{\"accessors\":[{\"count\":9223372036854775808},{\"count\":9223372036854775808}]}"},
		{"product.gltf", "{\"accessors\":[{\"count\":1152921504606846976}]}"},
		{"number.gltf", "{\"accessors\":[{\"count\":340282366920938463463374607431768211456}]}"},
		{"sum.ply", "ply\nelement vertex 192153584101141163\nelement face 1\nend_header\n"}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		put_text_file(rows[i][0], rows[i][1]);
		assert_true(need_of(rows[i][0]) == UINT64_MAX);
	}
}

TEST(where_the_size_says_enough_nothing_is_opened)
{
	const nt_settings settings = {0};
	put_text_file("tiny.glb", "glTF");
	assert_int_equal(nt_need_of(in_folder("tiny.glb"), &settings, 2 * MB), MB + 256 * 4);
	/* the size of a .gltf says nothing about its buffers */
	put_text_file("tiny.gltf", "{\"count\":1000000}");
	assert_int_equal(nt_need_of(in_folder("tiny.gltf"), &settings, 2 * MB), MB + 12 * 17 + 46 * 1000000);
}

TEST(what_has_no_size_is_alone_and_what_is_missing_is_nothing)
{
	assert_int_equal(need_of("nowhere.obj"), 0);
	assert_int_equal(mkfifo(in_folder("pipe.obj"), 0600), 0);
	assert_true(need_of("pipe.obj") == UINT64_MAX);
	const nt_settings settings = {0};
	assert_true(nt_need_of("-", &settings, 0) == UINT64_MAX);
}

AROUND_ALL(make_folder, remove_folder)
