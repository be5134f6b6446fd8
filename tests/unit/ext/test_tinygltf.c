/* SPDX-License-Identifier: MIT */
#include "ext/tinygltf.h"
#include "test.h"

#include <meshoptimizer.h>

/* One triangle: positions, then 16-bit indices. */
static const float positions[] = {0, 0, 0, 0.1f, 0, 0, 0, 1, -2.5f};
static const uint16_t indices[] = {0, 1, 2};
static const char triangle[] = "{\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
	"\"max\":[0.1,1,0],\"min\":[0,0,-2.5],\"type\":\"VEC3\"},{\"bufferView\":1,\"componentType\":5123,"
	"\"count\":3,\"type\":\"SCALAR\"}],\"asset\":{\"version\":\"2.0\"},\"bufferViews\":[{\"buffer\":0,"
	"\"byteLength\":36},{\"buffer\":0,\"byteLength\":6,\"byteOffset\":36}],\"meshes\":[{\"primitives\":[{"
	"\"attributes\":{\"POSITION\":0},\"indices\":1,\"mode\":4}]}],\"buffers\":[{\"byteLength\":42,"
	"\"uri\":\"a%20b.bin\"}]}";

/* Base64 of 36 + 6 bytes would be long: the loader gets the pieces of a .gltf with a file. */
typedef struct named_bytes {
	const char *name;
	unsigned char bytes[128];
	size_t size;
} named_bytes;

static bool find_bytes(void *user, const char *uri, const unsigned char **bytes, size_t *size)
{
	named_bytes *file = user;
	if (strcmp(uri, file->name) != 0)
		return false;
	*bytes = file->bytes;
	*size = file->size;
	return true;
}

static named_bytes triangle_bytes(void)
{
	named_bytes file = {.name = "a b.bin", .size = 42};
	memcpy(file.bytes, positions, 36);
	memcpy(file.bytes + 36, indices, 6);
	return file;
}

/* With this one sidecar; NULL: with none. */
static nt_status open_text(nt_reread **reread, const char *text, named_bytes *file, nt_error *error)
{
	return nt_reread_open(reread, (const unsigned char *)text, strlen(text), file ? find_bytes : NULL, file, error);
}

TEST(reread_finds_attributes_in_sidecars)
{
	named_bytes file = triangle_bytes();
	nt_reread *reread;
	nt_error error;
	assert_int_equal(open_text(&reread, triangle, &file, &error), NT_OK);
	assert_int_equal(nt_reread_mesh_count(reread), 1);
	assert_int_equal(nt_reread_primitive_count(reread, 0), 1);
	assert_int_equal(nt_reread_primitive_count(reread, 1), 0);
	nt_reread_array array;
	assert_int_equal(nt_reread_attribute(reread, 0, 0, "POSITION", &array, &error), NT_OK);
	assert_int_equal(array.count, 3);
	assert_int_equal(array.stride_bytes, 12);
	assert_int_equal(array.components, 3);
	assert_memory_equal(array.data, positions, sizeof positions);
	assert_int_equal(nt_reread_attribute(reread, 0, 0, NULL, &array, &error), NT_OK);
	assert_int_equal(array.component_type, NT_GLTF_USHORT);
	assert_memory_equal(array.data, indices, sizeof indices);
	assert_int_equal(nt_reread_attribute(reread, 0, 0, "TANGENT", &array, &error), NT_OK);
	assert_null(array.data);
	assert_int_equal(nt_reread_attribute(reread, 0, 1, NULL, &array, &error), NT_ERROR_INPUT);
	nt_reread_free(reread);

	/* the buffer is not there, or shorter than the document says */
	file.name = "other.bin";
	assert_int_equal(open_text(&reread, triangle, &file, &error), NT_ERROR_INPUT);
	assert_null(reread);
	assert_non_null(strstr(error.message, "a b.bin"));
	assert_int_equal(open_text(&reread, triangle, NULL, &error), NT_ERROR_INPUT);
}

/* The result of a document after one piece of its text was replaced. */
static nt_status status_after(const char *old, const char *new, nt_error *error)
{
	char changed[2000];
	const char *at = strstr(triangle, old);
	assert_non_null(at);
	snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - triangle), triangle, new, at + strlen(old));
	named_bytes file = triangle_bytes();
	nt_reread *reread;
	nt_reread_array array;
	nt_status status = open_text(&reread, changed, &file, error);
	if (status == NT_OK)
		status = nt_reread_attribute(reread, 0, 0, "POSITION", &array, error);
	nt_reread_free(reread);
	return status;
}

TEST(reread_checks_accessors_against_views_and_buffers)
{
	nt_error error;
	assert_int_equal(status_after("", "", &error), NT_OK);
	static const char *const changes[][2] = {{"\"count\":3", "\"count\":4"},
		{"\"count\":3", "\"count\":1000000000000000"}, {"\"byteLength\":36", "\"byteLength\":43"},
		{"\"bufferView\":0", "\"bufferView\":7"}, {"\"POSITION\":0", "\"POSITION\":9"},
		{"\"buffer\":0", "\"buffer\":3"}, {"\"byteLength\":36", "\"byteLength\":36,\"byteStride\":4"}};
	for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
		assert_int_equal(status_after(changes[i][0], changes[i][1], &error), NT_ERROR_INPUT);
		if (i == 0)
			assert_string_equal(error.place.pointer, "/meshes/0/primitives/0/attributes/POSITION");
	}
}

/* Positions packed by meshoptimizer: the view lies in a buffer that has no bytes. The JSON says how many bytes are
 * packed, and which part of the other buffer they are. */
static nt_reread *open_packed(named_bytes *file, size_t packed, size_t offset, const char *mode)
{
	char text[1000];
	const int size = snprintf(text, sizeof text, "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":["
		"\"EXT_meshopt_compression\"],\"extensionsRequired\":[\"EXT_meshopt_compression\"],\"meshes\":[{"
		"\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,"
		"\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":1,"
		"\"byteLength\":36,\"byteStride\":12,\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,"
		"\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":12,\"count\":3,\"mode\":\"%s\"}}}],"
		"\"buffers\":[{\"byteLength\":%zu,\"uri\":\"a.bin\"},{\"byteLength\":36,\"extensions\":{"
		"\"EXT_meshopt_compression\":{\"fallback\":true}}}]}", offset, packed, mode, sizeof file->bytes);
	nt_reread *reread;
	nt_error error;
	if (nt_reread_open(&reread, (unsigned char *)text, (size_t)size, find_bytes, file, &error))
		fail_msg("%s", error.message);
	return reread;
}

TEST(packed_views_are_unpacked)
{
	named_bytes file = {.name = "a.bin", .size = sizeof file.bytes};
	unsigned char packed[sizeof file.bytes];
	const size_t size = meshopt_encodeVertexBuffer(packed, sizeof packed, positions, 3, 12);
	assert_true(size > 0);
	memcpy(file.bytes, packed, size);
	nt_reread *reread = open_packed(&file, size, 0, "ATTRIBUTES");
	nt_reread_array array;
	nt_error error;
	for (int twice = 0; twice < 2; twice++) {
		assert_int_equal(nt_reread_attribute(reread, 0, 0, "POSITION", &array, &error), NT_OK);
		assert_int_equal(array.count, 3);
		assert_memory_equal(array.data, positions, sizeof positions);
	}
	nt_reread_free(reread);

	/* cut, elsewhere, beyond the buffer, of another kind */
	const struct {
		size_t size, offset;
		const char *mode, *message;
	} faults[] = {{size - 1, 0, "ATTRIBUTES", "cannot unpack"}, {size - 1, 1, "ATTRIBUTES", "cannot unpack"},
		{size, sizeof file.bytes, "ATTRIBUTES", "packed bytes"}, {size, 0, "CHAOS", "packed bytes"}};
	for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
		reread = open_packed(&file, faults[i].size, faults[i].offset, faults[i].mode);
		assert_int_equal(nt_reread_attribute(reread, 0, 0, "POSITION", &array, &error), NT_ERROR_INPUT);
		assert_non_null(strstr(error.message, faults[i].message));
		nt_reread_free(reread);
	}
}

/* Other people's numbers may be any; what is in quotes is none. */
TEST(numbers_beyond_double_are_taken)
{
	static const char *const texts[] = {
		"{\"asset\":{\"version\":\"2.0\"},\"extras\":{\"n\":1e400,\"m\":[-1E+999,1e-999],\"s\":\"\\\"1e400\"}}",
		"{\"asset\":{\"version\":\"2.0\"},\"extras\":1e400,"
		"\"extensionsUsed\":[\"KHR_draco_mesh_compression\"]}",
		/* brackets in strings do not count */
		"{\"asset\":{\"version\":\"2.0\",\"generator\":\"[[\\\"{{\"}}",
	};
	for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
		nt_reread *reread;
		nt_error error;
		assert_int_equal(open_text(&reread, texts[i], NULL, &error), NT_OK);
		nt_reread_free(reread);
	}
}

TEST(deep_json_is_refused_before_it_is_parsed)
{
	enum { DEPTH = 100000 };
	char *text = calloc(DEPTH + 1, 1);
	memset(text, '[', DEPTH);
	nt_reread *reread;
	nt_error error;
	assert_int_equal(open_text(&reread, text, NULL, &error), NT_ERROR_INPUT);
	assert_non_null(strstr(error.message, "512"));
	assert_null(reread);
	free(text);
}
