/* SPDX-License-Identifier: MIT */
/*
 * Forms of a PLY file: the header, lines, numbers, types and properties, in all three encodings.
 * Faces are in test_faces.c, files that are wrong in test_damage.c.
 */
#include "file/input.h"
#include "ply/ply.h"
#include "ply_file.h"

#include <dirent.h>
#include <math.h>

TEST(ascii_triangle)
{
	reading r;
	open_text(&r, HEAD("3") FACES("1") POINTS "3 0 1 2\n");
	assert_int_equal(r.mesh->vertex_count, 3);
	assert_int_equal(r.mesh->source_vertex_count, 3);
	assert_floats(r.mesh->positions, FLOATS(0, 0, 0, 1, 0, 0, 0, 1, 0));
	assert_int_equal(r.mesh->face_count, 1);
	assert_int_equal(r.mesh->corner_count, 3);
	assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2));
	assert_null(r.mesh->face_sizes);
	assert_null(r.mesh->normals);
	assert_null(r.mesh->texcoords);
	assert_null(r.mesh->colors);
	assert_true(r.mesh->triangles && r.mesh->reachable && r.mesh->has_positions);
	assert_false(r.mesh->has_normals || r.mesh->has_texcoords || r.mesh->has_tangents);
	assert_int_equal(r.mesh->primitive_count, 1);
	assert_int_equal(r.mesh->primitives[0].face_count, 1);
	assert_int_equal(r.mesh->primitives[0].material, NT_NONE);
	assert_int_equal(r.scene.instance_count, 1);
	assert_int_equal(r.scene.findings.count, 0);
	close_reading(&r);
}

TEST(text_may_end_lines_in_three_ways_and_have_blanks_anywhere)
{
	static const char *const files[] = {
		"ply\r\nformat ascii 1.0\r\nelement vertex 1\r\nproperty float x\r\nproperty float y\r\n"
		"property float z\r\nend_header\r\n1 2 3\r\n",
		"ply\rformat ascii 1.0\relement vertex 1\rproperty float x\rproperty float y\r"
		"property float z\rend_header\r1 2 3\r",
		"ply \n  format\tascii   1.0 \n\nelement vertex\t1\n property float x\nproperty  float y\n"
		"property float z\t\nend_header \n\n \t 1\t 2   +3 \n\n",
		"ply\nformat ascii 1.0\nelement vertex 1\n" XYZ "end_header\n1 2 3",
	};
	for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
		reading r;
		open_text(&r, files[i]);
		assert_floats(r.mesh->positions, FLOATS(1, 2, 3));
		assert_int_equal(r.scene.findings.count, 0);
		close_reading(&r);
	}
}

TEST(binary_after_carriage_returns_may_begin_with_a_line_feed)
{
	image m = {0};
	put_text(&m, "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\r"
		"property uchar y\rproperty uchar z\rend_header\r");
	put_text(&m, "\n\r\n");
	reading r;
	open_sound(&r, m.bytes, m.size);
	assert_floats(r.mesh->positions, FLOATS(10, 13, 10));
	close_reading(&r);
}

TEST(numbers_of_every_kind_are_read)
{
	reading r;
	open_text(&r, HEAD("4") "end_header\n1e3 -2.5E-1 +.5\n0.1 123456789.125 1e-50\n"
		"nan inf -inf\n-0 16777217 3.4028236e38\n");
	const float *p = r.mesh->positions;
	assert_floats(p, FLOATS(1000.0f, -0.25f, 0.5f, 0.1f, 123456789.125f, 0.0f));
	assert_true(isnan(p[6]) && isinf(p[7]) && p[7] > 0 && isinf(p[8]) && p[8] < 0);
	assert_true(p[9] == 0.0f && signbit(p[9]));
	assert_true(p[10] == 16777216.0f);
	close_reading(&r);
}

TEST(binary_types_and_their_aliases_in_both_byte_orders)
{
	static const char *const types[2][8] = {
		{"char", "uchar", "short", "ushort", "int", "uint", "float", "double"},
		{"int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"}};
	for (int variant = 0; variant < 4; variant++) {
		image m = {.big = variant & 1};
		put_text(&m, m.big ? "ply\nformat binary_big_endian 1.0\nelement vertex 1\n"
				   : "ply\nformat binary_little_endian 1.0\nelement vertex 1\n");
		static const char *const names[] = {"tw", "x", "nx", "ny", "nz", "y", "z", "tx"};
		for (int i = 0; i < 8; i++) {
			char line[64];
			snprintf(line, sizeof line, "property %s %s\n", types[variant >> 1][i], names[i]);
			put_text(&m, line);
		}
		put_text(&m, "property float ty\nproperty float tz\nend_header\n");
		put(&m, 0x80, 1);        /* -128 */
		put(&m, 0xFE, 1);        /* 254 */
		put(&m, 0x8001, 2);      /* -32767 */
		put(&m, 0xFFFE, 2);      /* 65534 */
		put(&m, 0xFFFFFFFE, 4);  /* -2 */
		put(&m, 0xFFFFFF00, 4);  /* 4294967040, a float */
		put_float(&m, 0.1f);
		put_double(&m, 0.1);
		put_float(&m, 2.0f);
		put_float(&m, 3.0f);
		reading r;
		open_sound(&r, m.bytes, m.size);
		assert_floats(r.mesh->positions, FLOATS(254.0f, 4294967040.0f, 0.1f));
		assert_floats(r.mesh->normals, FLOATS(-32767.0f, 65534.0f, -2.0f));
		assert_floats(r.mesh->tangents, FLOATS(0.1f, 2.0f, 3.0f, -128.0f));
		assert_true(r.mesh->has_tangents && r.mesh->has_normals);
		close_reading(&r);
	}
}

/* 1.0f is 3f 80 00 00, 2.0f is 40 00 00 00, -0.5f is bf 00 00 00. */
TEST(big_endian_bytes_by_hand)
{
	static const char file[] = "ply\nformat binary_big_endian 1.0\nelement vertex 1\n" XYZ
		"element face 1\nproperty list ushort ushort vertex_index\nend_header\n"
		"\x3f\x80\0\0\x40\0\0\0\xbf\0\0\0"
		"\0\3\0\0\0\0\0";
	reading r;
	open_sound(&r, file, sizeof file); /* the final NUL is the last byte of the third index */
	assert_floats(r.mesh->positions, FLOATS(1.0f, 2.0f, -0.5f));
	assert_numbers(r.mesh->indices, NUMBERS(0, 0, 0));
	close_reading(&r);
}

TEST(properties_come_in_any_order_among_strangers)
{
	reading r;
	open_text(&r, "ply\ncomment made by hand\nformat ascii 1.0\nobj_info any\nelement vertex 3\n"
		"property float z\nproperty list uchar int stuff\nproperty float t\nproperty float nz\n"
		"property float y\nproperty uchar flags\nproperty float s\nproperty float nx\n"
		"property float x\nproperty float ny\n" FACES("1")
		"3 2 8 9 0.7 6 2 200 0.6 4 1 5\n3 0 0.7 6 2 200 0.6 4 1 5\n3 1 7 0.7 6 2 200 0.6 4 1 5\n"
		"3 0 1 2\n");
	assert_floats(r.mesh->positions, FLOATS(1, 2, 3, 1, 2, 3, 1, 2, 3));
	assert_floats(r.mesh->normals, FLOATS(4, 5, 6, 4, 5, 6));
	assert_floats(r.mesh->texcoords, FLOATS(0.6f, 0.7f, 0.6f, 0.7f));
	close_reading(&r);
}

TEST(binary_rows_with_lists_are_walked)
{
	image m = {0};
	put_text(&m, "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n"
		"property list uchar short stuff\nproperty float y\nproperty float z\nend_header\n");
	put_float(&m, 1);
	put(&m, 2, 1);
	put(&m, 77, 2);
	put(&m, 78, 2);
	put_float(&m, 2);
	put_float(&m, 3);
	put_float(&m, 4);
	put(&m, 0, 1);
	put_float(&m, 5);
	put_float(&m, 6);
	reading r;
	open_sound(&r, m.bytes, m.size);
	assert_floats(r.mesh->positions, FLOATS(1, 2, 3, 4, 5, 6));
	assert_false(r.mesh->triangles);
	close_reading(&r);
}

TEST(texcoords_have_four_pairs_of_names)
{
	static const char *const names[][2] = {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"},
		{"texcoord_u", "texcoord_v"}};
	for (size_t i = 0; i < 4; i++) {
		char text[512];
		snprintf(text, sizeof text,
			HEAD("1") "property float %s\nproperty float %s\nend_header\n0 0 0 0.25 0.75\n",
			names[i][0], names[i][1]);
		reading r;
		open_text(&r, text);
		assert_true(r.mesh->has_texcoords);
		assert_floats(r.mesh->texcoords, FLOATS(0.25f, 0.75f));
		close_reading(&r);
	}
	reading r; /* half a pair is none */
	open_text(&r, HEAD("1") "property float u\nproperty float t\nend_header\n0 0 0 0.25 0.75\n");
	assert_false(r.mesh->has_texcoords);
	close_reading(&r);
}

TEST(tangents_without_tw_are_none_and_said)
{
	reading r;
	open_text(&r, HEAD("1") "property float tx\nproperty float ty\nproperty float tz\nend_header\n0 0 0 1 0 0\n");
	assert_false(r.mesh->has_tangents);
	assert_true(has_finding(&r, NT_CODE_STATEMENT_IGNORED, 7, 1,
		"properties tx, ty and tz are no tangents without tw"));
	close_reading(&r);
}

TEST(lines_before_the_first_element_that_are_no_statements_are_said)
{
	reading r;
	open_text(&r, "ply\nformat ascii 1.0\nmade by hand\nand so on\nelement vertex 1\n" XYZ "end_header\n0 0 0\n");
	assert_true(has_finding(&r, NT_CODE_STATEMENT_IGNORED, 3, 2, "lines of the header that are no statements"));
	close_reading(&r);
}

/* sRGB to linear light. */
static float linear(double c)
{
	return (float)(c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4));
}

TEST(colors_are_scaled_by_their_type_and_become_linear)
{
	reading r;
	open_text(&r, HEAD("1") "property uchar red\nproperty uchar green\nproperty ushort blue\n"
		"property float alpha\nend_header\n0 0 0 255 51 65535 0.5\n");
	assert_floats(r.mesh->colors, FLOATS(1.0f, linear(51.0f / 255.0f), 1.0f, 0.5f));
	close_reading(&r);
	open_text(&r, HEAD("1") "property float red\nproperty float green\nproperty float blue\n"
		"end_header\n0 0 0 0.1 0.2 0.3\n");
	assert_floats(r.mesh->colors, FLOATS(linear(0.1f), linear(0.2f), linear(0.3f), 1.0f));
	close_reading(&r);
}

TEST(textures_in_comments_become_materials)
{
	reading r;
	open_text(&r, "ply\nformat ascii 1.0\ncomment TextureFile wood grain.png \n"
		"comment TextureFile unused.png\ncomment TextureFile b.jpg\nelement vertex 3\n" XYZ
		"element face 4\nproperty list uchar int vertex_indices\nproperty int texnumber\n"
		"end_header\n" POINTS "3 0 1 2 2\n3 0 1 2 -1\n3 0 1 2 0\n3 0 1 2 2\n");
	assert_int_equal(r.scene.material_count, 3);
	assert_string_equal(r.scene.materials[0].base_color_map.name, "wood grain.png");
	assert_string_equal(r.scene.materials[0].library, "test.ply");
	assert_true(nt_map_is_plain(&r.scene.materials[0].base_color_map));
	assert_int_equal(r.mesh->primitive_count, 3);
	assert_int_equal(r.mesh->primitives[0].material, 0);
	assert_int_equal(r.mesh->primitives[1].material, 2);
	assert_int_equal(r.mesh->primitives[1].face_count, 2);
	assert_int_equal(r.mesh->primitives[2].material, NT_NONE);
	assert_numbers(r.mesh->face_primitive, NUMBERS(1, 2, 0, 1));
	close_reading(&r);
	open_text(&r, "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\n" XYZ FACES("1")
		POINTS "3 0 1 2\n");
	assert_int_equal(r.mesh->primitive_count, 1);
	assert_int_equal(r.mesh->primitives[0].material, 0);
	assert_null(r.mesh->face_primitive);
	close_reading(&r);
}

TEST(bytes_after_the_last_element_are_said)
{
	reading r;
	open_text(&r, HEAD("3") FACES("1") POINTS "3 0 1 2\n3 0 2 1\n");
	assert_int_equal(r.mesh->face_count, 1);
	assert_int_equal(r.scene.findings.items[0].code, NT_CODE_STATEMENT_IGNORED);
	assert_string_equal(r.scene.findings.items[0].detail, "8 bytes after the last element");
	close_reading(&r);
}

TEST(the_three_encodings_say_the_same)
{
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_encoding)encoding);
		reading r;
		open_sound(&r, m.bytes, m.size);
		/* 5 rows; 0, 1 and 2 lack coordinates in the quad, 3 and 4 are new in the pentagon but 4 */
		assert_int_equal(r.mesh->face_count, 5);
		assert_int_equal(r.mesh->corner_count, 16);
		assert_int_equal(r.mesh->primitive_count, 2);
		assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2, 5, 6, 7, 4));
		assert_int_equal(r.mesh->vertex_count, 9);
		assert_floats(r.mesh->colors, FLOATS(linear(1 / 255.0f), linear(2 / 255.0f), linear(3 / 255.0f), 1));
		close_reading(&r);
	}
}

TEST(shared_models_are_read)
{
	static const char folder[] = "../shared/models/ply";
	DIR *stream = opendir(folder);
	if (!stream) {
		print_message("[  SKIPPED ] %s is not there\n", folder);
		skip();
	}
	size_t count = 0;
	for (const struct dirent *entry; (entry = readdir(stream));) {
		char path[512];
		snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
		nt_error error;
		nt_file file;
		if (entry->d_name[0] == '.' || nt_file_open(&file, path, NT_NAMED_BY_USER, &error))
			continue;
		assert_true(nt_ply_recognise(file.data, file.size));
		reading r;
		open_sound(&r, file.data, file.size);
		assert_true(r.mesh->vertex_count > 0);
		close_reading(&r);
		nt_file_close(&file);
		count++;
	}
	closedir(stream);
	assert_true(count > 0);
}
