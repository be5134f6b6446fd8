/* SPDX-License-Identifier: MIT */
/*
 * The PLY reader on files made by hand, in all three encodings. Bytes are copied into a block of their
 * exact size, so that the sanitizers see a step too far.
 */
#include "test.h"
#include "fail_alloc.h"
#include "io/format.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>

typedef struct reading {
	nt_scene scene;
	nt_error error;
	nmtan_status status;
	unsigned char *bytes;
	const nt_mesh *mesh; /* NULL after an error */
} reading;

static void open_bytes(reading *r, const void *bytes, size_t size)
{
	*r = (reading){.bytes = malloc(size ? size : 1)};
	memcpy(r->bytes, bytes, size);
	nt_scene_init(&r->scene, "test.ply");
	r->scene.bytes = r->bytes;
	r->scene.byte_count = size;
	nt_error_clear(&r->error);
	const nt_read_options options = {.texcoord_set = -1, .threads = 1};
	r->status = nt_ply_open(&r->scene, &options, &r->error);
	r->mesh = r->status ? NULL : r->scene.meshes;
}

static void close_reading(reading *r)
{
	nt_scene_free(&r->scene);
	free(r->bytes);
}

static void open_sound(reading *r, const void *bytes, size_t size)
{
	open_bytes(r, bytes, size);
	if (r->status)
		print_message("line %zu, offset %lld: %s\n", r->error.place.line,
			(long long)r->error.place.offset, r->error.message);
	assert_int_equal(r->status, NMTAN_OK);
}

static void open_text(reading *r, const char *text)
{
	open_sound(r, text, strlen(text));
}

static void assert_floats(const float *floats, size_t count, const float *expected)
{
	assert_non_null(floats);
	for (size_t i = 0; i < count; i++)
		assert_true(floats[i] == expected[i]);
}

static void assert_numbers(const uint32_t *numbers, size_t count, const uint32_t *expected)
{
	assert_non_null(numbers);
	for (size_t i = 0; i < count; i++)
		assert_int_equal(numbers[i], expected[i]);
}

#define FLOATS(...) sizeof((float[]){__VA_ARGS__}) / sizeof(float), (float[]){__VA_ARGS__}
#define NUMBERS(...) sizeof((uint32_t[]){__VA_ARGS__}) / sizeof(uint32_t), (uint32_t[]){__VA_ARGS__}

/* Refused with this message at this line (ASCII, header) or offset (binary; line 0). */
static void assert_refused_bytes(const void *bytes, size_t size, nmtan_status status, size_t line,
	uint64_t offset, const char *message)
{
	reading r;
	open_bytes(&r, bytes, size);
	assert_int_equal(r.status, status);
	assert_string_equal(r.error.message, message);
	assert_int_equal(r.error.place.line, line);
	assert_int_equal(r.error.place.offset, offset);
	assert_string_equal(r.error.place.file, "test.ply");
	close_reading(&r);
}

static void assert_refused(const char *text, size_t line, const char *message)
{
	assert_refused_bytes(text, strlen(text), NMTAN_ERROR_INPUT, line, NT_NO_OFFSET, message);
}

static bool has_finding(const reading *r, nt_code code, size_t line, size_t count, const char *detail)
{
	for (size_t i = 0; i < r->scene.findings.count; i++) {
		const nt_finding *f = &r->scene.findings.items[i];
		if (f->code == code && f->place.line == line && f->count == count &&
			strcmp(f->detail, detail) == 0)
			return true;
	}
	return false;
}

/* A binary file under construction. */
typedef struct image {
	unsigned char bytes[4096];
	size_t size;
	bool big;
} image;

static void put_text(image *m, const char *text)
{
	memcpy(m->bytes + m->size, text, strlen(text));
	m->size += strlen(text);
}

static void put(image *m, uint64_t bits, size_t size)
{
	for (size_t i = 0; i < size; i++)
		m->bytes[m->size++] = (unsigned char)(bits >> 8 * (m->big ? size - 1 - i : i));
}

static void put_float(image *m, float value)
{
	uint32_t bits;
	memcpy(&bits, &value, sizeof bits);
	put(m, bits, 4);
}

static void put_double(image *m, double value)
{
	uint64_t bits;
	memcpy(&bits, &value, sizeof bits);
	put(m, bits, 8);
}

typedef enum ply_test_encoding { ENCODING_ASCII, ENCODING_LITTLE, ENCODING_BIG } ply_test_encoding;

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define HEAD(vertices) "ply\nformat ascii 1.0\nelement vertex " vertices "\n" XYZ
#define FACES(faces) "element face " faces "\nproperty list uchar int vertex_indices\nend_header\n"
#define POINTS "0 0 0\n1 0 0\n0 1 0\n"

/* What a file can look like. */

static void ascii_triangle(void **state)
{
	(void)state;
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

static void text_may_end_lines_in_three_ways_and_have_blanks_anywhere(void **state)
{
	(void)state;
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

static void binary_after_carriage_returns_may_begin_with_a_line_feed(void **state)
{
	(void)state;
	image m = {0};
	put_text(&m, "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\r"
		"property uchar y\rproperty uchar z\rend_header\r");
	put_text(&m, "\n\r\n");
	reading r;
	open_sound(&r, m.bytes, m.size);
	assert_floats(r.mesh->positions, FLOATS(10, 13, 10));
	close_reading(&r);
}

static void numbers_of_every_kind_are_read(void **state)
{
	(void)state;
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

static void binary_types_and_their_aliases_in_both_byte_orders(void **state)
{
	(void)state;
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
static void big_endian_bytes_by_hand(void **state)
{
	(void)state;
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

static void properties_come_in_any_order_among_strangers(void **state)
{
	(void)state;
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

static void binary_rows_with_lists_are_walked(void **state)
{
	(void)state;
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

static void texcoords_have_four_pairs_of_names(void **state)
{
	(void)state;
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

static void colors_are_scaled_by_their_type(void **state)
{
	(void)state;
	reading r;
	open_text(&r, HEAD("1") "property uchar red\nproperty uchar green\nproperty ushort blue\n"
		"property float alpha\nend_header\n0 0 0 255 51 65535 0.5\n");
	assert_floats(r.mesh->colors, FLOATS(1.0f, 51.0f / 255.0f, 1.0f, 0.5f));
	close_reading(&r);
	open_text(&r, HEAD("1") "property float red\nproperty float green\nproperty float blue\n"
		"end_header\n0 0 0 0.1 0.2 0.3\n");
	assert_floats(r.mesh->colors, FLOATS(0.1f, 0.2f, 0.3f, 1.0f));
	close_reading(&r);
}

static void faces_may_come_before_vertices(void **state)
{
	(void)state;
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
	assert_true(has_finding(&r, NT_CODE_STATEMENT_IGNORED, 6, 1, "element \"junk\""));
	close_reading(&r);
}

static void binary_faces_before_vertices(void **state)
{
	(void)state;
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

static void quads_stay_and_larger_polygons_are_cut(void **state)
{
	(void)state;
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

static void faces_of_fewer_than_three_corners_are_skipped_and_said(void **state)
{
	(void)state;
	reading r;
	open_text(&r, HEAD("3") FACES("4") POINTS "2 0 1\n0\n3 0 1 2\n1 2\n");
	assert_int_equal(r.mesh->face_count, 1);
	assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2));
	assert_true(has_finding(&r, NT_CODE_STATEMENT_IGNORED, 13, 3, "faces of fewer than three corners"));
	close_reading(&r);
}

static void polygons_without_area_are_cut_and_said(void **state)
{
	(void)state;
	reading r;
	open_text(&r, HEAD("3") FACES("1") POINTS "5 0 0 0 0 0\n");
	assert_int_equal(r.mesh->face_count, 3);
	assert_true(has_finding(&r, NT_CODE_POLYGON_DEGENERATE, 13, 1, ""));
	close_reading(&r);
}

static void files_without_faces_are_points(void **state)
{
	(void)state;
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
static void triangle_strips_become_triangles(void **state)
{
	(void)state;
	reading r;
	open_text(&r, HEAD("4") "element tristrips 2\nproperty list int int vertex_indices\nend_header\n"
		POINTS "1 1 0\n9 0 1 2 3 -1 3 1 0 0\n2 0 1\n");
	assert_int_equal(r.mesh->face_count, 3);
	assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2, 2, 1, 3, 3, 1, 0));
	close_reading(&r);
}

#define WEDGES "element face 2\nproperty list uchar int vertex_indices\n" \
	"property list uchar float texcoord\nend_header\n"

/* Vertices 1 and 2 are shared; 2 has other coordinates in the second face and becomes a copy. */
static void wedges_with_other_texcoords_become_vertices(void **state)
{
	(void)state;
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

static void wedges_that_lack_are_marked(void **state)
{
	(void)state;
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
static void wedges_of_one_vertex_may_be_many(void **state)
{
	(void)state;
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

static void binary_wedges(void **state)
{
	(void)state;
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

static void textures_in_comments_become_materials(void **state)
{
	(void)state;
	reading r;
	open_text(&r, "ply\nformat ascii 1.0\ncomment TextureFile wood grain.png \n"
		"comment TextureFile unused.png\ncomment TextureFile b.jpg\nelement vertex 3\n" XYZ
		"element face 4\nproperty list uchar int vertex_indices\nproperty int texnumber\n"
		"end_header\n" POINTS "3 0 1 2 2\n3 0 1 2 -1\n3 0 1 2 0\n3 0 1 2 2\n");
	assert_int_equal(r.scene.material_count, 3);
	assert_string_equal(r.scene.materials[0].base_color_map, "wood grain.png");
	assert_string_equal(r.scene.materials[0].library, "test.ply");
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

static void bytes_after_the_last_element_are_said(void **state)
{
	(void)state;
	reading r;
	open_text(&r, HEAD("3") FACES("1") POINTS "3 0 1 2\n3 0 2 1\n");
	assert_int_equal(r.mesh->face_count, 1);
	assert_int_equal(r.scene.findings.items[0].code, NT_CODE_STATEMENT_IGNORED);
	assert_string_equal(r.scene.findings.items[0].detail, "8 bytes after the last element");
	close_reading(&r);
}

/* What is wrong with a file. */

static void header_mistakes_have_their_line(void **state)
{
	(void)state;
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
	assert_refused("ply\nformat ascii 1.0\nelments vertex 3\n", 3,
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
	assert_refused_bytes(newer, sizeof newer - 1, NMTAN_ERROR_UNSUPPORTED, 2, NT_NO_OFFSET,
		"PLY version \"2.0\": only 1.0 is known");
}

static void text_mistakes_have_their_line(void **state)
{
	(void)state;
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
	assert_refused(HEAD("3") FACES("1") POINTS "3 0 1 2 1\n", 13,
		"face 0: found \"1\", expected the end of the line");
	assert_refused(HEAD("3") FACES("1") POINTS "3 0 1 2.5\n", 13,
		"face 0: found \"2.5\", expected another value of list \"vertex_indices\"");
	assert_refused(HEAD("3") FACES("1") POINTS "x 0 1 2\n", 13,
		"face 0: found \"x\", expected the length of list \"vertex_indices\"");
	assert_refused(HEAD("3") FACES("1") POINTS "-1 0 1 2\n", 13,
		"face 0: the length of a list does not fit the file: -1");
	assert_refused(HEAD("3") FACES("1") POINTS "4000000000 0 1 2\n", 13,
		"face 0: the length of a list does not fit the file: 4000000000");
	assert_refused(HEAD("3") WEDGES POINTS "3 0 1 2 6 0 0 1 0 0 1\n3 0 1 2 4 0 0 1 0\n", 15,
		"face 1: list \"texcoord\" has 4 values, expected 6 for 3 corners, or none");
}

static void meshes_must_be_finite(void **state)
{
	(void)state;
	assert_refused(HEAD("3") FACES("1") "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", 11,
		"vertex 1: found \"nan\", expected a finite number for property \"y\"");
	assert_refused(HEAD("3") FACES("1") "0 0 0\n1 0 1e39\n0 1 0\n3 0 1 2\n", 11,
		"vertex 1: found \"1e39\", expected a finite number for property \"z\"");
	assert_refused(HEAD("3") WEDGES POINTS "3 0 1 2 6 0 0 1 0 -inf 1\n3 0 1 2 0\n", 14,
		"face 0: found \"-inf\", expected a finite number in list \"texcoord\"");
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
		assert_refused_bytes(bytes, m.size + 600 * 13 + 1, NMTAN_ERROR_INPUT, 0, at,
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

static void counts_that_lie_are_refused(void **state)
{
	(void)state;
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
	assert_refused_bytes(m.bytes, m.size + size, NMTAN_ERROR_INPUT, 0, m.size + at, message);
}

static void binary_mistakes_have_their_offset(void **state)
{
	(void)state;
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

/* A file with everything in it, in the three encodings. */
static void make_full(image *m, ply_test_encoding encoding)
{
	static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
	*m = (image){.big = encoding == ENCODING_BIG};
	char line[64];
	snprintf(line, sizeof line, "ply\nformat %s 1.0\n", names[encoding]);
	put_text(m, line);
	put_text(m, "comment TextureFile a.png\nelement vertex 5\n" XYZ "property float s\n"
		"property float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
		"element face 3\nproperty list uchar int vertex_indices\n"
		"property list uchar float texcoord\nproperty int texnumber\n"
		"element other 1\nproperty list uchar uchar bytes\nend_header\n");
	static const char body[] = "0 0 0 0 0 1 2 3\n2 0 0 0 0 1 2 3\n2 2 0 0 0 1 2 3\n1 3 0 0 0 1 2 3\n"
		"0 2 0 0 0 1 2 3\n3 0 1 2 6 0 0 1 0 1 1 0\n4 0 1 2 4 0 -1\n"
		"5 0 1 2 3 4 10 0 0 1 0 1 1 .5 2 0 1 0\n2 7 8\n";
	if (encoding == ENCODING_ASCII) {
		put_text(m, body);
		return;
	}
	/* types of the values in the order of the text: f float, b byte, i int */
	static const char types[] = "fffffbbb" "fffffbbb" "fffffbbb" "fffffbbb" "fffffbbb"
		"biii" "bffffff" "i" "biiii" "b" "i" "biiiii" "bffffffffff" "i" "bbb";
	const char *p = body;
	for (size_t i = 0; types[i]; i++) {
		char *end;
		const double value = strtod(p, &end);
		p = end;
		if (types[i] == 'f')
			put_float(m, (float)value);
		else
			put(m, (uint64_t)(int64_t)value, types[i] == 'b' ? 1 : 4);
	}
}

static void the_three_encodings_say_the_same(void **state)
{
	(void)state;
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_test_encoding)encoding);
		reading r;
		open_sound(&r, m.bytes, m.size);
		/* 5 rows; 0, 1 and 2 lack coordinates in the quad, 3 and 4 are new in the pentagon but 4 */
		assert_int_equal(r.mesh->face_count, 5);
		assert_int_equal(r.mesh->corner_count, 16);
		assert_int_equal(r.mesh->primitive_count, 2);
		assert_numbers(r.mesh->indices, NUMBERS(0, 1, 2, 5, 6, 7, 4));
		assert_int_equal(r.mesh->vertex_count, 9);
		assert_floats(r.mesh->colors, FLOATS(1 / 255.0f, 2 / 255.0f, 3 / 255.0f, 1));
		close_reading(&r);
	}
}

/* A prefix that lacks nothing but blanks at the end is sound, any other one is refused with a place. */
static void every_prefix_is_read_or_refused(void **state)
{
	(void)state;
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_test_encoding)encoding);
		for (size_t size = 0; size < m.size; size++) {
			reading r;
			open_bytes(&r, m.bytes, size);
			if (r.status) {
				/* "format ascii 1." is another version */
				assert_true(r.status == NMTAN_ERROR_INPUT ||
					    (r.status == NMTAN_ERROR_UNSUPPORTED &&
						    r.error.place.line == 2));
				assert_true(r.error.place.line > 0 || r.error.place.offset <= size);
			} else {
				assert_true(encoding == ENCODING_ASCII && size + 6 > m.size);
			}
			close_reading(&r);
		}
	}
}

/* Every byte of the body replaced by others: nothing may be read or written out of bounds. */
/* 300 faces over 9 vertices, triangles and quads by turns of 50, with CR before LF in text; the index of
 * one corner can be replaced. Returns where that index stands: line or offset. */
static size_t make_runs(unsigned char *bytes, size_t *size, ply_test_encoding encoding, int bad_face,
	int bad_index)
{
	image m = {.big = encoding == ENCODING_BIG};
	put_text(&m, encoding == ENCODING_ASCII ? "ply\nformat ascii 1.0\n"
			: m.big ? "ply\nformat binary_big_endian 1.0\n"
				: "ply\nformat binary_little_endian 1.0\n");
	put_text(&m, "element vertex 9\nproperty uchar x\nproperty uchar y\nproperty uchar z\n"
		"element face 300\n");
	put_text(&m, encoding == ENCODING_ASCII ? "" : "property short before\n");
	put_text(&m, "property list uchar uint vertex_indices\n");
	put_text(&m, encoding == ENCODING_ASCII ? "end_header\n" : "property uchar after\nend_header\n");
	size_t place = 0, at = m.size;
	memcpy(bytes, m.bytes, m.size);
	for (int v = 0; v < 9; v++) {
		if (encoding == ENCODING_ASCII)
			at += (size_t)sprintf((char *)bytes + at, "%d 0 %d\r\n", v, v * v);
		else
			memcpy(bytes + at, (unsigned char[]){(unsigned char)v, 0, (unsigned char)(v * v)}, 3);
		at += encoding == ENCODING_ASCII ? 0 : 3;
	}
	for (int f = 0; f < 300; f++) {
		const int corners = f / 50 % 2 ? 4 : 3;
		m.size = 0;
		if (encoding == ENCODING_ASCII)
			at += (size_t)sprintf((char *)bytes + at, "%d", corners);
		else
			put(&m, 7, 2), put(&m, (uint64_t)corners, 1);
		for (int k = 0; k < corners; k++) {
			const int index = f == bad_face && k == 1 ? bad_index : (f + 2 * k) % 9;
			if (f == bad_face && k == 1)
				place = encoding == ENCODING_ASCII ? 19 + (size_t)f : at + m.size;
			if (encoding == ENCODING_ASCII)
				at += (size_t)sprintf((char *)bytes + at, " %d", index);
			else
				put(&m, (uint64_t)index, 4);
		}
		if (encoding == ENCODING_ASCII)
			at += (size_t)sprintf((char *)bytes + at, "\r\n");
		else
			put(&m, 5, 1);
		memcpy(bytes + at, m.bytes, m.size);
		at += m.size;
	}
	*size = at;
	return place;
}

static void runs_of_triangles_and_quads_are_read_in_order(void **state)
{
	(void)state;
	unsigned char *bytes = malloc(20000);
	for (int encoding = 0; encoding < 3; encoding++) {
		size_t size;
		make_runs(bytes, &size, (ply_test_encoding)encoding, -1, 0);
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

static void runs_end_at_an_index_out_of_range(void **state)
{
	(void)state;
	unsigned char *bytes = malloc(20000);
	for (int encoding = 0; encoding < 3; encoding++) {
		for (int face = 0; face < 300; face += 33) {
			size_t size;
			char message[128];
			const size_t place =
				make_runs(bytes, &size, (ply_test_encoding)encoding, face, 9);
			snprintf(message, sizeof message,
				"face %d: vertex index 9 is out of range, the file has 9 vertices", face);
			const bool ascii = encoding == ENCODING_ASCII;
			assert_refused_bytes(bytes, size, NMTAN_ERROR_INPUT, ascii ? place : 0,
				ascii ? NT_NO_OFFSET : place, message);
		}
	}
	free(bytes);
}

static void damaged_bytes_do_no_harm(void **state)
{
	(void)state;
	static const unsigned char values[] = {0, 1, 9, '-', ' ', '\n', '9', 0x7f, 0x80, 0xff};
	for (int encoding = 0; encoding < 3; encoding++) {
		image m;
		make_full(&m, (ply_test_encoding)encoding);
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

static void every_allocation_may_fail(void **state)
{
	(void)state;
	image m;
	make_full(&m, ENCODING_LITTLE);
	bool failed = true;
	size_t n = 0;
	for (; failed; n++) {
		nt_scene scene;
		nt_error error;
		nt_error_clear(&error);
		nt_scene_init(&scene, "test.ply");
		scene.bytes = m.bytes;
		scene.byte_count = m.size;
		const nt_read_options options = {.texcoord_set = -1, .threads = 1};
		fail_allocations_from(n);
		const nmtan_status status = nt_ply_open(&scene, &options, &error);
		failed = stop_failing_allocations();
		assert_true(failed ? status == NMTAN_ERROR_MEMORY || scene.findings.failed : !status);
		nt_scene_free(&scene);
	}
	assert_true(n > 20);
}

static void shared_models_are_read(void **state)
{
	(void)state;
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
		if (entry->d_name[0] == '.' || nt_file_open(&file, path, &error))
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

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(ascii_triangle),
		cmocka_unit_test(text_may_end_lines_in_three_ways_and_have_blanks_anywhere),
		cmocka_unit_test(binary_after_carriage_returns_may_begin_with_a_line_feed),
		cmocka_unit_test(numbers_of_every_kind_are_read),
		cmocka_unit_test(binary_types_and_their_aliases_in_both_byte_orders),
		cmocka_unit_test(big_endian_bytes_by_hand),
		cmocka_unit_test(properties_come_in_any_order_among_strangers),
		cmocka_unit_test(binary_rows_with_lists_are_walked),
		cmocka_unit_test(texcoords_have_four_pairs_of_names),
		cmocka_unit_test(colors_are_scaled_by_their_type),
		cmocka_unit_test(faces_may_come_before_vertices),
		cmocka_unit_test(binary_faces_before_vertices),
		cmocka_unit_test(quads_stay_and_larger_polygons_are_cut),
		cmocka_unit_test(faces_of_fewer_than_three_corners_are_skipped_and_said),
		cmocka_unit_test(polygons_without_area_are_cut_and_said),
		cmocka_unit_test(files_without_faces_are_points),
		cmocka_unit_test(triangle_strips_become_triangles),
		cmocka_unit_test(wedges_with_other_texcoords_become_vertices),
		cmocka_unit_test(wedges_that_lack_are_marked),
		cmocka_unit_test(wedges_of_one_vertex_may_be_many),
		cmocka_unit_test(binary_wedges),
		cmocka_unit_test(textures_in_comments_become_materials),
		cmocka_unit_test(bytes_after_the_last_element_are_said),
		cmocka_unit_test(header_mistakes_have_their_line),
		cmocka_unit_test(text_mistakes_have_their_line),
		cmocka_unit_test(meshes_must_be_finite),
		cmocka_unit_test(counts_that_lie_are_refused),
		cmocka_unit_test(binary_mistakes_have_their_offset),
		cmocka_unit_test(the_three_encodings_say_the_same),
		cmocka_unit_test(every_prefix_is_read_or_refused),
		cmocka_unit_test(runs_of_triangles_and_quads_are_read_in_order),
		cmocka_unit_test(runs_end_at_an_index_out_of_range),
		cmocka_unit_test(damaged_bytes_do_no_harm),
		cmocka_unit_test(every_allocation_may_fail),
		cmocka_unit_test(shared_models_are_read),
	};
	return cmocka_run_group_tests_name("io/ply", tests, NULL, NULL);
}
