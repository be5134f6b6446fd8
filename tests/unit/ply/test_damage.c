/* SPDX-License-Identifier: MIT */
/*
 * Faults of a PLY file, and where: header, text, counts, binary rows; every prefix of a file, every
 * byte replaced, and memory that ends.
 */
#include "fail_alloc.h"
#include "ply/ply.h"
#include "ply_file.h"

#include <math.h>

TEST(header_mistakes_have_their_line)
{
	assert_refused("", 1, "not a PLY file: it does not begin with \"ply\"");
	assert_refused("plyx\n", 1, "not a PLY file: it does not begin with \"ply\"");
	assert_refused("ply", 1, "the file ends within the header, end_header was expected");
	assert_refused("ply\nformat ascii 1.0\nelement vertex 3\n", 4,
		"the file ends within the header, end_header was expected");
	assert_refused("ply\nelement vertex 0\nend_header\n", 3, "the header has no format line");
	assert_refused("ply\nformat ascii 1.0\nformat ascii 1.0\n", 3, "a second format line");
	assert_refused("ply\nformat text 1.0\n", 2,
		"found \"text\", expected ascii, binary_little_endian or binary_big_endian");
	assert_refused("ply\nformat ascii\n", 2, "the line ends where the version, 1.0, was expected");
	assert_refused("ply\nformat ascii 1.0\nelments vertex 3\nproperty float x\n", 4,
		"a property before the first element");
	assert_refused("ply\nformat ascii 1.0\nelement vertex 3\nelments face 3\n", 4,
		"found \"elments\", expected comment, obj_info, element, property or end_header");
	assert_refused("ply\nformat ascii 1.0\nelement vertex\n", 3,
		"the line ends where the number of rows was expected");
	assert_refused("ply\nformat ascii 1.0\nelement vertex -3\n", 3,
		"found \"-3\", expected the number of rows");
	assert_refused("ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n", 3,
		"found \"99999999999999999999\", expected the number of rows");
	assert_refused("ply\nformat ascii 1.0\nelement vertex 3 4\n", 3,
		"found \"4\", expected the end of the line");
	assert_refused("ply\nformat ascii 1.0\nproperty float x\n", 3,
		"a property before the first element");
	assert_refused(HEAD("1") "property half q\n", 7, "found \"half\", expected a type (char, uchar, "
		"short, ushort, int, uint, float or double)");
	assert_refused(HEAD("1") "property list float int q\n", 7,
		"found \"float\", expected an integer type for the length of the list");
	assert_refused(HEAD("1") "property float\n", 7,
		"the line ends where the property's name was expected");
	assert_refused(HEAD("1") "element vertex 1\n", 7,
		"a second element \"vertex\": the first is on line 3");
	assert_refused("ply\nformat ascii 1.0\nend_header\n", 3, "the header has no element \"vertex\"");
	assert_refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
		"end_header\n0 0\n", 3, "element \"vertex\" has no properties x, y and z");
	assert_refused(HEAD("1") "element face 1\nproperty list uchar int corners\nend_header\n", 7,
		"element \"face\" has no list vertex_indices or vertex_index");
	assert_refused(HEAD("1") "element face 1\nproperty list uchar float vertex_index\nend_header\n", 8,
		"property \"vertex_index\" is not a list of integers");
	static const char newer[] = "ply\nformat ascii 2.0\n";
	assert_refused_bytes(newer, sizeof newer - 1, NT_ERROR_UNSUPPORTED, 2, NT_NO_OFFSET,
		"PLY version \"2.0\": only 1.0 is known");
}

TEST(text_mistakes_have_their_line)
{
	assert_refused(HEAD("3") FACES("1") "0 0 0\n1 O 0\n0 1 0\n3 0 1 2\n", 11,
		"vertex 1: found \"O\", expected a number for property \"y\"");
	assert_refused(HEAD("3") FACES("1") "0 0 0\n1 0 0x\n0 1 0\n3 0 1 2\n", 11,
		"vertex 1: found \"0x\", expected a number for property \"z\"");
	assert_refused(HEAD("3") FACES("1") "0 0 0\n\n1 0\n0 1 0\n3 0 1 2\n", 12,
		"vertex 1: found the end of the line, expected a number for property \"z\"");
	assert_refused(HEAD("3") FACES("1") "0 0 0\r\n1 0 0 0\r\n0 1 0\n3 0 1 2\n", 11,
		"vertex 1: found \"0\", expected the end of the line");
	assert_refused(HEAD("3") FACES("1") POINTS "3 0 1 3\n", 13,
		"face 0: vertex index 3 is out of range, the file has 3 vertices");
	assert_refused(HEAD("3") FACES("1") POINTS "3 0 1 -1\n", 13,
		"face 0: vertex index -1 is out of range, the file has 3 vertices");
	assert_refused(HEAD("3") FACES("1") POINTS "3 0 1 99999999999999999999\n", 13,
		"face 0: vertex index 99999999999999999 is out of range, the file has 3 vertices");
	assert_refused(HEAD("3") FACES("1") POINTS "3 0 1\n", 13,
		"face 0: found the end of the line, expected another value of list \"vertex_indices\"");
	assert_refused(HEAD("3") FACES("1") POINTS "3 0 1 2.5\n", 13,
		"face 0: found \"2.5\", expected another value of list \"vertex_indices\"");
	assert_refused("ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\n" XYZ "element face 1\n"
		"property list uchar int vertex_indices\nproperty int texnumber\nend_header\n" POINTS "3 0 1 2 1.0\n",
		15, "face 0: found \"1.0\", expected an integer for property \"texnumber\"");
	assert_refused(HEAD("3") FACES("1") POINTS "x 0 1 2\n", 13,
		"face 0: found \"x\", expected the length of list \"vertex_indices\"");
	assert_refused(HEAD("3") FACES("1") POINTS "-1 0 1 2\n", 13,
		"face 0: the length of a list does not fit the file: -1");
	assert_refused(HEAD("3") FACES("1") POINTS "4000000000 0 1 2\n", 13,
		"face 0: the length of a list does not fit the file: 4000000000");
	assert_refused(HEAD("3") WEDGES POINTS "3 0 1 2 6 0 0 1 0 0 1\n3 0 1 2 4 0 0 1 0\n", 15,
		"face 1: list \"texcoord\" has 4 values, expected 6 for 3 corners, or none");
}

TEST(meshes_must_be_finite)
{
	assert_refused(HEAD("3") FACES("1") "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", 11,
		"vertex 1: found \"nan\", expected a finite number for property \"y\"");
	assert_refused(HEAD("3") FACES("1") "0 0 0\n1 0 1e39\n0 1 0\n3 0 1 2\n", 11,
		"vertex 1: found \"1e39\", expected a finite number for property \"z\"");
	for (int with_list = 0; with_list < 2; with_list++) {
		image m = {0};
		put_text(&m, "ply\nformat binary_little_endian 1.0\nelement vertex 600\n" XYZ);
		put_text(&m, with_list ? "property list uchar int stuff\n" : "property uchar stuff\n");
		put_text(&m, "element face 1\nproperty list uchar int vertex_indices\nend_header\n");
		unsigned char *bytes = calloc(m.size + 600 * 13 + 1, 1);
		memcpy(bytes, m.bytes, m.size);
		const size_t at = m.size + 555 * 13 + 8;
		bytes[at + 2] = 0x80; /* 7f 80 00 00: infinity */
		bytes[at + 3] = 0x7f;
		assert_refused_bytes(bytes, m.size + 600 * 13 + 1, NT_ERROR_INPUT, 0, at,
			"vertex 555: property \"z\" is not finite, expected a finite number");
		free(bytes);
	}
	/* tangents are judged elsewhere */
	reading r;
	open_text(&r, HEAD("3") "property float tx\nproperty float ty\nproperty float tz\n"
		"property float tw\n" FACES("1") "0 0 0 nan 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n3 0 1 2\n");
	assert_true(isnan(r.mesh->tangents[0]));
	close_reading(&r);
}

/* One such texture coordinate or normal does not cost the file. */
TEST(texcoords_and_normals_that_are_not_finite_become_zeros)
{
	static const char names[] = "property float nx\nproperty float ny\nproperty float nz\nproperty float s\n"
		"property float t\n";
	for (int form = 0; form < 3; form++) { /* lines, rows of fixed size, rows with a list */
		static const float rows[3][8] = {{0, 0, 0, 0, 0, 1, 0.5f, 0.25f}, {1, 0, 0, 0, NAN, 1, 1, INFINITY},
			{0, 1, 0, 0, 0, 1, NAN, 1}};
		image m = {0};
		reading r;
		put_text(&m, form ? "ply\nformat binary_little_endian 1.0\n" : "ply\nformat ascii 1.0\n");
		put_text(&m, "element vertex 3\n" XYZ);
		put_text(&m, names);
		put_text(&m, form == 2 ? "property list uchar int stuff\n" : "");
		put_text(&m, "element face 1\nproperty list uchar uchar vertex_indices\nend_header\n");
		for (int v = 0; v < 3; v++) {
			for (int k = 0; form == 0 && k < 8; k++)
				m.size += (size_t)sprintf((char *)m.bytes + m.size, "%g%c", rows[v][k],
					k < 7 ? ' ' : '\n');
			if (form)
				memcpy(m.bytes + m.size, rows[v], sizeof rows[v]);
			m.size += form ? sizeof rows[v] + (form == 2) : 0;
		}
		memcpy(m.bytes + m.size, form ? "\3\0\1\2\0\0\0\0" : "3 0 1 2\n", 8);
		m.size += form ? 4 : 8;
		open_sound(&r, m.bytes, m.size);
		const float texcoords[3][2] = {{0.5f, 0.25f}}, normals[3][3] = {{0, 0, 1}, {0}, {0, 0, 1}};
		assert_memory_equal(r.mesh->texcoords, texcoords, sizeof texcoords);
		assert_memory_equal(r.mesh->normals, normals, sizeof normals);
		assert_int_equal(r.scene.findings.count, 2);
		assert_int_equal(r.scene.findings.items[0].code, NT_CODE_MESH_NORMAL_ZERO);
		assert_int_equal(r.scene.findings.items[0].count, 1);
		assert_int_equal(r.scene.findings.items[1].code, NT_CODE_UV_NOT_FINITE);
		assert_int_equal(r.scene.findings.items[1].count, 2);
		close_reading(&r);
	}
	reading r;
	open_text(&r, HEAD("3") WEDGES POINTS "3 0 1 2 6 0 0 1 0 -inf 1\n3 0 1 2 0\n");
	assert_int_equal(r.scene.findings.count, 1);
	assert_true(has_finding(&r, NT_CODE_UV_NOT_FINITE, 14, 1, "faces"));
	assert_floats(r.mesh->texcoords, FLOATS(0, 0, 1, 0, 0, 1));
	close_reading(&r);
}

TEST(counts_that_lie_are_refused)
{
	/* the line of the face is taken for a vertex */
	assert_refused(HEAD("4") FACES("1") POINTS "3 0 1 2\n", 13,
		"vertex 3: found \"2\", expected the end of the line");
	assert_refused(HEAD("3") "end_header\n0.00 0.00 0.00\n1.00 0.00 0.00\n", 10,
		"the file ends where vertex 2 of 3 was expected");
	assert_refused(HEAD("3") FACES("2") POINTS "3 0 1 2\n", 14,
		"the file ends where face 1 of 2 was expected");
	assert_refused(HEAD("3") "element other 2\nproperty int a\nend_header\n" POINTS "12345\n", 14,
		"the file ends where other 1 of 2 was expected");
	/* what cannot be is refused before memory is taken */
	assert_refused(HEAD("4") "end_header\n" POINTS, 8, "4 rows of element \"vertex\" need at least "
		"6 bytes each, the file has 18 bytes left");
	assert_refused(HEAD("4294967294") "end_header\n" POINTS, 8, "4294967294 rows of element "
		"\"vertex\" need at least 6 bytes each, the file has 18 bytes left");
	assert_refused(HEAD("18446744073709551615") "end_header\n" POINTS, 3,
		"18446744073709551615 vertices, expected fewer than 4294967295");
	assert_refused(HEAD("3") FACES("18446744073709551615") POINTS "3 0 1 2\n", 12,
		"18446744073709551615 rows of element \"face\" need at least 2 bytes each, the file has "
		"9 bytes left");
}

#define BINARY_HEAD(vertices, faces, count_type) "ply\nformat binary_little_endian 1.0\n" \
	"element vertex " vertices "\nproperty uchar x\nproperty uchar y\nproperty uchar z\n" \
	"element face " faces "\nproperty list " count_type " short vertex_index\nend_header\n"

static void assert_binary_refused(const char *head, const char *body, size_t size, size_t at,
	const char *message)
{
	image m = {0};
	put_text(&m, head);
	memcpy(m.bytes + m.size, body, size);
	assert_refused_bytes(m.bytes, m.size + size, NT_ERROR_INPUT, 0, m.size + at, message);
}

TEST(binary_mistakes_have_their_offset)
{
	assert_binary_refused(BINARY_HEAD("2", "0", "uchar"), "abcde", 5, 0,
		"2 rows of element \"vertex\" need at least 3 bytes each, the file has 5 bytes left");
	assert_binary_refused(BINARY_HEAD("1", "3", "uchar"), "abc\0\0", 5, 3,
		"3 rows of element \"face\" need at least 1 bytes each, the file has 2 bytes left");
	assert_binary_refused(BINARY_HEAD("1", "2", "uchar"), "abc\3\0\0\0\0\0\0", 10, 10,
		"the file ends where face 1 of 2 was expected");
	assert_binary_refused(BINARY_HEAD("1", "1", "uchar"), "abc\3\0\0\0\0\0", 9, 3,
		"the file ends within property \"vertex_index\" of face 0 of 1: 7 bytes needed, 6 left");
	assert_binary_refused(BINARY_HEAD("1", "1", "char"), "abc\xff\0\0\0\0\0", 9, 3,
		"list \"vertex_index\" of face 0 has the length -1");
	assert_binary_refused(BINARY_HEAD("1", "1", "uint"), "abc\xff\xff\xff\xff\0\0", 9, 3,
		"the file ends within property \"vertex_index\" of face 0 of 1: 8589934594 bytes needed, "
		"6 left");
	assert_binary_refused(BINARY_HEAD("1", "1", "uchar"), "abc\3\0\0\1\0\0\0", 10, 6,
		"face 0: vertex index 1 is out of range, the file has 1 vertices");
	assert_binary_refused(BINARY_HEAD("1", "1", "uchar"), "abc\3\0\0\xff\xff\0\0", 10, 6,
		"face 0: vertex index -1 is out of range, the file has 1 vertices");
}

/* A prefix that lacks nothing but blanks at the end is sound, any other one is refused with a place. */
TEST(every_prefix_is_read_or_refused)
{
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_encoding)encoding);
		for (size_t size = 0; size < m.size; size++) {
			reading r;
			open_bytes(&r, m.bytes, size);
			if (r.status) {
				/* "format ascii 1." is another version */
				assert_true(r.status == NT_ERROR_INPUT ||
					    (r.status == NT_ERROR_UNSUPPORTED &&
						    r.error.place.line == 2));
				assert_true(r.error.place.line > 0 || r.error.place.offset <= size);
			} else {
				assert_true(encoding == PLY_ASCII && size + 6 > m.size);
			}
			close_reading(&r);
		}
	}
}

/* Every byte of the body replaced by others: nothing may be read or written out of bounds. */
TEST(damaged_bytes_do_no_harm)
{
	static const unsigned char values[] = {0, 1, 9, '-', ' ', '\n', '9', 0x7f, 0x80, 0xff};
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_encoding)encoding);
		for (size_t at = 0; at < m.size; at++) {
			const unsigned char kept = m.bytes[at];
			for (size_t i = 0; i < sizeof values; i++) {
				m.bytes[at] = values[i];
				reading r;
				open_bytes(&r, m.bytes, m.size);
				close_reading(&r);
			}
			m.bytes[at] = kept;
		}
	}
}

/* Opens a file, of which the reader says whether it was read as it should be, with ever more allocations. */
static void open_with_few_allocations(const void *bytes, size_t size, bool (*is_right)(const nt_scene *scene))
{
	bool failed = true;
	size_t n = 0;
	for (; failed; n++) {
		nt_scene scene;
		nt_error error;
		nt_error_clear(&error);
		nt_scene_init(&scene, "test.ply");
		scene.bytes = bytes;
		scene.byte_count = size;
		const nt_read_options options = {.texcoord_set = -1, .threads = 1};
		fail_allocations_from(n);
		const nt_status status = nt_ply_open(&scene, &options, &error);
		failed = stop_failing_allocations();
		assert_true(failed ? status == NT_ERROR_MEMORY || scene.findings.failed : !status);
		assert_true(failed || is_right(&scene));
		nt_scene_free(&scene);
	}
	assert_true(n > 20);
}

static bool is_full(const nt_scene *scene)
{
	return scene->meshes[0].face_count == 5 && scene->meshes[0].vertex_count == 9;
}

static bool is_far(const nt_scene *scene)
{
	return scene->instances[0].matrix[12] > 4999999 && scene->meshes[0].face_count == 4;
}

TEST(every_allocation_may_fail)
{
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_encoding)encoding);
		open_with_few_allocations(m.bytes, m.size, is_full);
	}
	/* the second reading of positions that float does not hold, and the second cut of polygons */
	char text[800];
	int size = sprintf(text, "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
		"property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n");
	for (int i = 0; i < 6; i++)
		size += sprintf(text + size, "%d.0%d -5000000.0%d 0\n", 5000000, i, i * i);
	size += sprintf(text + size, "5 0 1 2 3 5\n3 0 1 2\n");
	open_with_few_allocations(text, (size_t)size, is_far);
}
