/* SPDX-License-Identifier: MIT */
/*
 * Accessors that are read again are what they were, until they are changed; indices of all types, read and stored.
 */
#include "hand_gltf_file.h"

/* Bytes of a view that all accessors lie in; nobody reads them. */
#define VIEWS "\"buffers\":[{\"byteLength\":8000000000}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":8000000000}," \
	"{\"buffer\":0,\"byteLength\":8000,\"byteStride\":400}]"

static const char document_text[] = "{\"asset\":{\"version\":\"2.0\"}," VIEWS ",\"accessors\":["
	"{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"type\":\"VEC3\",\"count\":7},"
	"{\"bufferView\":0,\"componentType\":5121,\"type\":\"MAT2\",\"count\":3},"
	"{\"bufferView\":0,\"byteOffset\":5000000000,\"componentType\":5126,\"type\":\"VEC2\",\"count\":2},"
	"{\"bufferView\":1,\"componentType\":5123,\"normalized\":true,\"type\":\"VEC4\",\"count\":2},"
	"{\"componentType\":5125,\"type\":\"SCALAR\",\"count\":9},"
	"{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":5,\"sparse\":{\"count\":2,"
	"\"indices\":{\"bufferView\":0,\"byteOffset\":64,\"componentType\":5121},"
	"\"values\":{\"bufferView\":0,\"byteOffset\":128}}}]}";

/* As the specification has it: columns of matrices begin at multiples of 4 bytes. */
static const nt_gltf_accessor expected[] = {
	{.component_type = 5126, .component_bytes = 4, .components = 3, .element_bytes = 12, .count = 7,
		.offset = 12, .stride = 12},
	{.component_type = 5121, .component_bytes = 1, .components = 4, .element_bytes = 8, .count = 3, .stride = 8},
	{.component_type = 5126, .component_bytes = 4, .components = 2, .element_bytes = 8, .count = 2,
		.offset = 5000000000,
		.stride = 8},
	{.component_type = 5123, .component_bytes = 2, .components = 4, .element_bytes = 8, .normalized = true,
		.count = 2,
		.view = 1, .stride = 400},
	{.component_type = 5125, .component_bytes = 4, .components = 1, .element_bytes = 4, .count = 9, .view = NT_NONE,
		.stride = 4},
	{.component_type = 5126, .component_bytes = 4, .components = 3, .element_bytes = 12, .count = 5, .stride = 12,
		.sparse = &(nt_gltf_sparse_arrays){.count = 2}},
};
enum { ACCESSORS = sizeof expected / sizeof *expected };

static void check_accessor(nt_gltf *document, uint32_t index, uint64_t count)
{
	const nt_gltf_accessor *a;
	const nt_gltf_accessor *e = &expected[index];
	assert_int_equal(nt_gltf_get_accessor(document, index, "", &a, NULL), NT_OK);
	assert_int_equal(a->index, index);
	assert_int_equal(a->component_type, e->component_type);
	assert_int_equal(a->component_bytes, e->component_bytes);
	assert_int_equal(a->components, e->components);
	assert_int_equal(a->element_bytes, e->element_bytes);
	assert_int_equal(a->normalized, e->normalized);
	assert_int_equal(a->count, count);
	assert_int_equal(a->view, e->view);
	assert_int_equal(a->offset, e->offset);
	assert_int_equal(a->stride, e->stride);
	assert_int_equal(a->sparse ? a->sparse->count : 0, e->sparse ? e->sparse->count : 0);
	assert_null(a->decoded);
}

/* They stay those of the source, whatever an edit writes. */
TEST(accessors_are_read_once_when_somebody_asks)
{
	nt_scene scene;
	nt_error error;
	assert_int_equal(open_bytes(&scene, document_text, sizeof document_text - 1,
		&(nt_read_options){.texcoord_set = -1, .threads = 1}, &error), NT_OK);
	nt_gltf *document = scene.source;
	assert_null(document->accessors);
	assert_int_equal(nt_gltf_read_arrays(document, &error), NT_OK);
	for (uint32_t i = 0; i < ACCESSORS; i++)
		check_accessor(document, i, expected[i].count);
	for (uint32_t i = 0; i < ACCESSORS; i++) {
		nt_json_value *json = nt_gltf_accessor_json(document, i);
		nt_json_set_uint64(document->json, nt_json_put(document->json, json, "count"), 11);
	}
	assert_int_equal(nt_gltf_read_arrays(document, &error), NT_OK);
	for (uint32_t i = 0; i < ACCESSORS; i++)
		check_accessor(document, i, expected[i].count);
	assert_null(nt_gltf_accessor_json(document, ACCESSORS));
	nt_scene_free(&scene);
}

/* Every count up to some vectors, at every alignment: as bytes, the lowest first. */
TEST(indices_are_stored_and_read)
{
	static const uint32_t types[] = {5121, 5123, 5125}, widths[] = {1, 2, 4};
	enum { MOST = 40 };
	for (size_t k = 0; k < 3; k++)
		for (size_t count = 0; count <= MOST; count++) {
			uint32_t numbers[MOST + 1], *read = NULL;
			unsigned char bytes[4 * MOST + 8];
			const size_t at = 1 + count % 4;
			memset(bytes, 0xEE, sizeof bytes);
			for (size_t i = 0; i < count; i++)
				numbers[i] = (uint32_t)(i * 2654435761u + 77) >> (33 - 8 * widths[k]);
			nt_gltf_store_indices(numbers, count, widths[k], bytes + at);
			for (size_t i = 0; i < count * widths[k]; i++)
				assert_int_equal(bytes[at + i], numbers[i / widths[k]] >> 8 * (i % widths[k]) & 0xFF);
			for (size_t i = at + count * widths[k]; i < sizeof bytes; i++)
				assert_int_equal(bytes[i], 0xEE);
			nt_arena arena = {0};
			nt_gltf document = {.json = NULL};
			const nt_gltf_accessor accessor = {.component_type = types[k],
				.component_bytes = widths[k], .components = 1,
				.element_bytes = widths[k], .stride = widths[k], .count = count, .decoded = bytes + at};
			assert_int_equal(nt_gltf_indices(&document, &accessor, UINT32_MAX, &arena, &read,
				NULL), NT_OK);
			for (size_t i = 0; i < count; i++)
				assert_int_equal(read[i], numbers[i]);
			nt_arena_free(&arena);
		}
}
