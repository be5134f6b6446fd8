/* SPDX-License-Identifier: MIT */
#include "ext/tinygltf.h"
#include "test.h"

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
static nt_status accept_text(const char *text, named_bytes *file, nt_error *error)
{
	return nt_tinygltf_accept((const unsigned char *)text, strlen(text), file ? find_bytes : NULL, file, error);
}

TEST(sidecars_have_to_be_there)
{
	named_bytes file = triangle_bytes();
	nt_error error;
	assert_int_equal(accept_text(triangle, &file, &error), NT_OK);
	/* the buffer is not there, or shorter than the document says */
	file.size = 41;
	assert_int_equal(accept_text(triangle, &file, &error), NT_ERROR_INPUT);
	file.name = "other.bin";
	assert_int_equal(accept_text(triangle, &file, &error), NT_ERROR_INPUT);
	assert_non_null(strstr(error.message, "a b.bin"));
	assert_int_equal(accept_text(triangle, NULL, &error), NT_ERROR_INPUT);
}

/* A decoder brings the bytes of a buffer that stands for packed views, and the indices that Draco compresses: they do
 * not have to be there. */
TEST(what_is_compressed_is_left_out)
{
	nt_error error;
	assert_int_equal(accept_text("{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[{\"attributes\":"
		"{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,"
		"\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{"
		"\"byteLength\":36,\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}]}", NULL, &error),
		NT_OK);
	assert_int_equal(accept_text("{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[{\"attributes\":{"
		"\"POSITION\":0},\"indices\":1,\"extensions\":{\"KHR_draco_mesh_compression\":{}}}]}],\"accessors\":[{"
		"\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},{\"componentType\":5123,\"count\":3,"
		"\"type\":\"SCALAR\"}]}", NULL, &error), NT_OK);
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
		nt_error error;
		assert_int_equal(accept_text(texts[i], NULL, &error), NT_OK);
	}
}

TEST(deep_json_is_refused_before_it_is_parsed)
{
	enum { DEPTH = 100000 };
	char *text = calloc(DEPTH + 1, 1);
	memset(text, '[', DEPTH);
	nt_error error;
	assert_int_equal(accept_text(text, NULL, &error), NT_ERROR_INPUT);
	assert_non_null(strstr(error.message, "512"));
	free(text);
}
