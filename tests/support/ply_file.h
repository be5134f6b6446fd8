/* SPDX-License-Identifier: MIT */
/*
 * PLY files made by hand, in text and in both byte orders, and what the reader makes of them, for the tests of
 * the reader. Bytes are copied into a block of their exact size, so that the sanitizers see a step too far.
 */
#ifndef NT_TEST_PLY_FILE_H
#define NT_TEST_PLY_FILE_H

#include "test.h"
#include "ply/ply.h"
#include "ply/parts.h"

typedef struct reading {
	nt_scene scene;
	nt_error error;
	nt_status status;
	unsigned char *bytes;
	const nt_mesh *mesh; /* NULL after an error */
} reading;

static inline void open_by_threads(reading *r, const void *bytes, size_t size, unsigned threads)
{
	*r = (reading){.bytes = malloc(size ? size : 1)};
	memcpy(r->bytes, bytes, size);
	nt_scene_init(&r->scene, "test.ply");
	r->scene.bytes = r->bytes;
	r->scene.byte_count = size;
	nt_error_clear(&r->error);
	const nt_read_options options = {.texcoord_set = -1, .threads = threads};
	r->status = nt_ply_open(&r->scene, &options, &r->error);
	r->mesh = r->status ? NULL : r->scene.meshes;
}

static inline void open_bytes(reading *r, const void *bytes, size_t size)
{
	open_by_threads(r, bytes, size, 1);
}

static inline void close_reading(reading *r)
{
	nt_scene_free(&r->scene);
	free(r->bytes);
}

static inline void open_sound(reading *r, const void *bytes, size_t size)
{
	open_bytes(r, bytes, size);
	if (r->status)
		print_message("line %zu, offset %lld: %s\n", r->error.place.line,
			(long long)r->error.place.offset, r->error.message);
	assert_int_equal(r->status, NT_OK);
}

static inline void open_text(reading *r, const char *text)
{
	open_sound(r, text, strlen(text));
}

static inline void assert_floats(const float *floats, size_t count, const float *expected)
{
	assert_non_null(floats);
	for (size_t i = 0; i < count; i++)
		assert_true(floats[i] == expected[i]);
}

#define FLOATS(...) sizeof((float[]){__VA_ARGS__}) / sizeof(float), (float[]){__VA_ARGS__}

/* Refused with this message at this line (ASCII, header) or offset (binary; line 0). */
static inline void assert_refused_bytes(const void *bytes, size_t size, nt_status status, size_t line,
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

/* A binary file under construction. */
typedef struct image {
	unsigned char bytes[4096];
	size_t size;
	bool big;
} image;

static inline void put_text(image *m, const char *text)
{
	memcpy(m->bytes + m->size, text, strlen(text));
	m->size += strlen(text);
}

static inline void put(image *m, uint64_t bits, size_t size)
{
	for (size_t i = 0; i < size; i++)
		m->bytes[m->size++] = (unsigned char)(bits >> 8 * (m->big ? size - 1 - i : i));
}

static inline void put_float(image *m, float value)
{
	uint32_t bits;
	memcpy(&bits, &value, sizeof bits);
	put(m, bits, 4);
}

#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define HEAD(vertices) "ply\nformat ascii 1.0\nelement vertex " vertices "\n" XYZ
#define FACES(faces) "element face " faces "\nproperty list uchar int vertex_indices\nend_header\n"
#define POINTS "0 0 0\n1 0 0\n0 1 0\n"

/* A file with everything in it, in the three encodings. */
static inline void make_full(image *m, ply_encoding encoding)
{
	static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
	*m = (image){.big = encoding == PLY_BIG};
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
	if (encoding == PLY_ASCII) {
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

#endif
