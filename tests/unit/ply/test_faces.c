/* SPDX-License-Identifier: MIT */
/*
 * Faces of PLY files: before and after the vertices, triangles, quads, polygons, strips, texture coordinates by
 * corner, and the runs of equal faces that are read at once.
 */
#include "ply_file.h"

TEST(faces_may_come_before_vertices)
{
	static const char *const text = "ply\nformat ascii 1.0\nelement face 2\n"
		"property list uchar uint vertex_index\nproperty uchar red\nelement junk 2\n"
		"property list int float values\nelement vertex 5\n" XYZ "end_header\n"
		"3 0 1 2 9\n5 0 1 3 4 2 9\n2 0.5 0.5\n0\n0 0 0\n2 0 0\n0 2 0\n2 2 0\n1 3 0\n";
	reading r;
	open_text(&r, text);
	/* the polygon needs the positions */
	assert_int_equal(r.mesh->face_count, 4);
	assert_numbers(r.mesh->face_polygon, NUMBERS(0, 1, 1, 1));
	assert_floats(r.mesh->positions, FLOATS(0, 0, 0, 2, 0, 0));
	assert_string_equal(r.scene.left_out.data, "face red, element junk (2)");
	assert_int_equal(r.scene.left_out_line, 5);
	close_reading(&r);
}

TEST(binary_faces_before_vertices)
{
	image m = {.big = true};
	put_text(&m, "ply\nformat binary_big_endian 1.0\nelement face 1\n"
		"property list uint int vertex_index\nelement vertex 3\n" XYZ "end_header\n");
	put(&m, 3, 4);
	for (uint32_t k = 0; k < 3; k++)
		put(&m, 2 - k, 4);
	for (int k = 0; k < 9; k++)
		put_float(&m, (float)k);
	reading r;
	open_sound(&r, m.bytes, m.size);
	assert_numbers(r.mesh->indices, NUMBERS(2, 1, 0));
	assert_floats(r.mesh->positions, FLOATS(0, 1, 2, 3, 4, 5, 6, 7, 8));
	close_reading(&r);
}

TEST(quads_stay_and_larger_polygons_are_cut)
{
	reading r;
	open_text(&r, HEAD("5") FACES("3") "0 0 0\n2 0 0\n2 2 0\n1 3 0\n0 2 0\n"
		"3 0 1 2\n4 0 1 2 4\n5 0 1 2 3 4\n");
	assert_int_equal(r.mesh->face_count, 5);
	assert_int_equal(r.mesh->corner_count, 16);
	const uint8_t sizes[] = {3, 4, 3, 3, 3};
	assert_memory_equal(r.mesh->face_sizes, sizes, 5);
	assert_numbers(r.mesh->face_polygon, NUMBERS(0, 1, 2, 2, 2));
	assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2, 0, 1, 2, 4));
	/* area of the pentagon: 2 * 2 + 1; each triangle is counterclockwise */
	float area = 0.0f;
	for (size_t c = 7; c < 16; c += 3) {
		const float *a = r.mesh->positions + 3 * r.mesh->indices[c];
		const float *b = r.mesh->positions + 3 * r.mesh->indices[c + 1];
		const float *d = r.mesh->positions + 3 * r.mesh->indices[c + 2];
		const float twice = (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0]);
		assert_true(twice > 0.0f);
		area += twice / 2.0f;
	}
	assert_true(area == 5.0f);
	close_reading(&r);
}

TEST(faces_of_fewer_than_three_corners_are_skipped_and_said)
{
	reading r;
	open_text(&r, HEAD("3") FACES("4") POINTS "2 0 1\n0\n3 0 1 2\n1 2\n");
	assert_int_equal(r.mesh->face_count, 1);
	assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2));
	assert_string_equal(r.scene.left_out.data, "faces of fewer than three corners (3)");
	assert_int_equal(r.scene.left_out_line, 13);
	close_reading(&r);
}

/* As MeshLab and trimesh read them: the header says what a face has, more values are passed over. */
TEST(faces_with_more_values_than_the_header_names_are_read)
{
	reading r;
	open_text(&r, HEAD("3") FACES("4") POINTS "3 0 1 2\n3 0 1 2 6 0 0 1 0 0 1\n3 1 2 0\n3 2 1 0 7\n");
	assert_int_equal(r.mesh->face_count, 4);
	assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2, 0, 1, 2, 1, 2, 0, 2, 1, 0));
	assert_string_equal(r.scene.left_out.data, "values of faces beyond those that the header names (2)");
	assert_int_equal(r.scene.left_out_line, 14);
	close_reading(&r);
}

TEST(empty_lists_are_read_in_all_encodings)
{
	for (int encoding = 0; encoding < 3; encoding++) {
		static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
		image m = {.big = encoding == PLY_BIG};
		char line[64];
		snprintf(line, sizeof line, "ply\nformat %s 1.0\nelement vertex 1\n", names[encoding]);
		put_text(&m, line);
		put_text(&m, "property uchar x\nproperty uchar y\nproperty uchar z\nelement face 2\n"
			"property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n");
		if (encoding == PLY_ASCII)
			put_text(&m, "1 2 3\n0 0\n0 0\n");
		else
			put(&m, 0, 7);
		reading r;
		open_sound(&r, m.bytes, m.size);
		assert_true(r.mesh->triangles);
		assert_int_equal(r.mesh->face_count, 0);
		assert_string_equal(r.scene.left_out.data, "faces of fewer than three corners (2)");
		close_reading(&r);
	}
}

TEST(polygons_without_area_are_cut_and_said)
{
	reading r;
	open_text(&r, HEAD("3") FACES("1") POINTS "5 0 0 0 0 0\n");
	assert_int_equal(r.mesh->face_count, 3);
	assert_true(has_finding(&r, NT_CODE_POLYGON_DEGENERATE, 13, 1, ""));
	close_reading(&r);
}

TEST(files_without_faces_are_points)
{
	reading r;
	open_text(&r, HEAD("3") "end_header\n" POINTS);
	assert_false(r.mesh->triangles);
	assert_int_equal(r.mesh->vertex_count, 3);
	close_reading(&r);
	open_text(&r, HEAD("3") FACES("0") POINTS);
	assert_false(r.mesh->triangles);
	close_reading(&r);
	open_text(&r, HEAD("0") "end_header\n");
	assert_int_equal(r.mesh->vertex_count, 0);
	close_reading(&r);
}

/* 0-1-2, then 2 1 3 turned round to keep the winding; after the restart 3-1-0; 0 0 joins. */
TEST(triangle_strips_become_triangles)
{
	reading r;
	open_text(&r, HEAD("4") "element tristrips 2\nproperty list int int vertex_indices\nend_header\n"
		POINTS "1 1 0\n9 0 1 2 3 -1 3 1 0 0\n2 0 1\n");
	assert_int_equal(r.mesh->face_count, 3);
	assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2, 2, 1, 3, 3, 1, 0));
	close_reading(&r);
}

/* Vertices 1 and 2 are shared; 2 has other coordinates in the second face and becomes a copy. */
TEST(wedges_with_other_texcoords_become_vertices)
{
	reading r;
	open_text(&r, HEAD("4") "property float nx\nproperty float ny\nproperty float nz\n" WEDGES
		"0 0 0 1 0 0\n1 0 0 2 0 0\n0 1 0 3 0 0\n1 1 0 4 0 0\n"
		"3 0 1 2 6 0 0 1 0 0 1\n3 2 1 3 6 0.5 0.5 1 0 1 1\n");
	assert_int_equal(r.mesh->vertex_count, 5);
	assert_int_equal(r.mesh->source_vertex_count, 5);
	assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2, 4, 1, 3));
	assert_floats(r.mesh->texcoords, FLOATS(0, 0, 1, 0, 0, 1, 1, 1, 0.5f, 0.5f));
	assert_floats(r.mesh->positions + 12, FLOATS(0, 1, 0));
	assert_floats(r.mesh->normals + 12, FLOATS(3, 0, 0));
	assert_true(r.mesh->has_texcoords);
	assert_null(r.mesh->vertex_lacks);
	close_reading(&r);
}

TEST(wedges_that_lack_are_marked)
{
	reading r;
	open_text(&r, HEAD("3") WEDGES POINTS "3 0 1 2 6 0 0 1 0 0 1\n3 0 2 1 0\n");
	assert_int_equal(r.mesh->vertex_count, 6);
	assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2, 3, 4, 5));
	const uint8_t lacks[] = {0, 0, 0, NT_LACKS_TEXCOORD, NT_LACKS_TEXCOORD, NT_LACKS_TEXCOORD};
	assert_memory_equal(r.mesh->vertex_lacks, lacks, 6);
	close_reading(&r);
	/* empty lists everywhere are no texture coordinates */
	open_text(&r, HEAD("3") WEDGES POINTS "3 0 1 2 0\n3 0 2 1 0\n");
	assert_int_equal(r.mesh->vertex_count, 3);
	assert_false(r.mesh->has_texcoords);
	close_reading(&r);
}

/* 2000 faces around vertex 0, each with other coordinates there: more than the first hash table. */
TEST(wedges_of_one_vertex_may_be_many)
{
	enum { FACES = 2000 };
	char *text = malloc(200000), *p = text;
	p += sprintf(p, HEAD("3") "element face %d\nproperty list uchar int vertex_indices\n"
		"property list uchar float texcoord\nend_header\n" POINTS, FACES);
	for (int i = 0; i < FACES; i++)
		p += sprintf(p, "3 0 1 2 6 %d 0 1 0 0 1\n", i / 2);
	reading r;
	open_text(&r, text);
	assert_int_equal(r.mesh->vertex_count, 3 + FACES / 2 - 1);
	for (uint32_t i = 0; i < FACES; i++) {
		const uint32_t v = r.mesh->indices[3 * i];
		assert_int_equal(v, i < 2 ? 0 : 2 + i / 2);
		assert_true(r.mesh->texcoords[2 * v] == (float)(i / 2));
	}
	close_reading(&r);
	free(text);
}

TEST(binary_wedges)
{
	image m = {0};
	put_text(&m, "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" XYZ
		"element face 1\nproperty list uchar float texcoord\nproperty uchar flag\n"
		"property list uchar int vertex_indices\nend_header\n");
	for (int k = 0; k < 9; k++)
		put_float(&m, (float)k);
	put(&m, 6, 1);
	for (int k = 0; k < 6; k++)
		put_float(&m, (float)k / 8);
	put(&m, 9, 1);
	put(&m, 3, 1);
	for (uint32_t k = 0; k < 3; k++)
		put(&m, k, 4);
	reading r;
	open_sound(&r, m.bytes, m.size);
	assert_floats(r.mesh->texcoords, FLOATS(0, 0.125f, 0.25f, 0.375f, 0.5f, 0.625f));
	close_reading(&r);
}

/* 300 faces over 9 vertices, triangles and quads by turns of 50, with CR before LF in text; the index of
 * one corner can be replaced. Returns where that index stands: line or offset. */
static size_t make_runs(unsigned char *bytes, size_t *size, ply_encoding encoding, int bad_face,
	int bad_index)
{
	image m = {.big = encoding == PLY_BIG};
	put_text(&m, encoding == PLY_ASCII ? "ply\nformat ascii 1.0\n"
			: m.big ? "ply\nformat binary_big_endian 1.0\n"
				: "ply\nformat binary_little_endian 1.0\n");
	put_text(&m, "element vertex 9\nproperty uchar x\nproperty uchar y\nproperty uchar z\n"
		"element face 300\n");
	put_text(&m, encoding == PLY_ASCII ? "" : "property short before\n");
	put_text(&m, "property list uchar uint vertex_indices\n");
	put_text(&m, encoding == PLY_ASCII ? "end_header\n" : "property uchar after\nend_header\n");
	size_t place = 0, at = m.size;
	memcpy(bytes, m.bytes, m.size);
	for (int v = 0; v < 9; v++) {
		if (encoding == PLY_ASCII)
			at += (size_t)sprintf((char *)bytes + at, "%d 0 %d\r\n", v, v * v);
		else
			memcpy(bytes + at, (unsigned char[]){(unsigned char)v, 0, (unsigned char)(v * v)}, 3);
		at += encoding == PLY_ASCII ? 0 : 3;
	}
	for (int f = 0; f < 300; f++) {
		const int corners = f / 50 % 2 ? 4 : 3;
		m.size = 0;
		if (encoding == PLY_ASCII)
			at += (size_t)sprintf((char *)bytes + at, "%d", corners);
		else
			put(&m, 7, 2), put(&m, (uint64_t)corners, 1);
		for (int k = 0; k < corners; k++) {
			const int index = f == bad_face && k == 1 ? bad_index : (f + 2 * k) % 9;
			if (f == bad_face && k == 1)
				place = encoding == PLY_ASCII ? 19 + (size_t)f : at + m.size;
			if (encoding == PLY_ASCII)
				at += (size_t)sprintf((char *)bytes + at, " %d", index);
			else
				put(&m, (uint64_t)index, 4);
		}
		if (encoding == PLY_ASCII)
			at += (size_t)sprintf((char *)bytes + at, "\r\n");
		else
			put(&m, 5, 1);
		memcpy(bytes + at, m.bytes, m.size);
		at += m.size;
	}
	*size = at;
	return place;
}

TEST(runs_of_triangles_and_quads_are_read_in_order)
{
	unsigned char *bytes = malloc(20000);
	for (int encoding = 0; encoding < 3; encoding++) {
		size_t size;
		make_runs(bytes, &size, (ply_encoding)encoding, -1, 0);
		reading r;
		open_sound(&r, bytes, size);
		assert_int_equal(r.mesh->face_count, 300);
		assert_int_equal(r.mesh->corner_count, 150 * 3 + 150 * 4);
		assert_floats(r.mesh->positions + 24, FLOATS(8, 0, 64));
		const uint32_t *index = r.mesh->indices;
		for (int f = 0; f < 300; f++) {
			assert_int_equal(r.mesh->face_sizes[f], f / 50 % 2 ? 4 : 3);
			for (int k = 0; k < r.mesh->face_sizes[f]; k++)
				assert_int_equal(*index++, (f + 2 * k) % 9);
		}
		close_reading(&r);
	}
	free(bytes);
}

TEST(runs_end_at_an_index_out_of_range)
{
	unsigned char *bytes = malloc(20000);
	for (int encoding = 0; encoding < 3; encoding++) {
		for (int face = 0; face < 300; face += 33) {
			size_t size;
			char message[128];
			const size_t place =
				make_runs(bytes, &size, (ply_encoding)encoding, face, 9);
			snprintf(message, sizeof message,
				"face %d: vertex index 9 is out of range, the file has 9 vertices", face);
			const bool ascii = encoding == PLY_ASCII;
			assert_refused_bytes(bytes, size, NT_ERROR_INPUT, ascii ? place : 0,
				ascii ? NT_NO_OFFSET : place, message);
		}
	}
	free(bytes);
}
