/* SPDX-License-Identifier: MIT */
/*
 * Faces of PLY files: the runs of equal faces that are read at once.
 */
#include "ply_file.h"

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
