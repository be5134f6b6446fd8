/* SPDX-License-Identifier: MIT */
#include "test.h"
#include "ext/tinygltf.h"

#include <meshoptimizer.h>

static nt_model *new_model(void)
{
	nt_model *model;
	assert_int_equal(nt_model_create(&model, "nmtan test", NULL), NT_OK);
	return model;
}

/* The whole text of a document as a string. */
static char *text_of(nt_model *model, uint64_t length, nt_model_buffer buffer, const char *uri)
{
	nt_model_text text;
	const nt_model_file file = {uri, NULL};
	assert_int_equal(nt_model_json(model, length, buffer, &file, &text, NULL), NT_OK);
	assert_true(text.cut <= text.size);
	char *copy = calloc(text.size + 1, 1);
	memcpy(copy, text.data, text.size);
	nt_model_text_free(&text);
	return copy;
}

static void empty_document_is_an_asset_and_nothing_else(void **state)
{
	(void)state;
	nt_model *model = new_model();
	char *text = text_of(model, 0, NT_MODEL_FILE, NULL);
	assert_string_equal(text, "{\"asset\":{\"generator\":\"nmtan test\",\"version\":\"2.0\"}}");
	free(text);
	nt_model_free(model);
}

/* One triangle: positions, then 16-bit indices. */
static const float positions[] = {0, 0, 0, 0.1f, 0, 0, 0, 1, -2.5f};
static const uint16_t indices[] = {0, 1, 2};
static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

static nt_model *triangle_model(uint32_t material)
{
	nt_model *model = new_model();
	const float min[] = {0, 0, -2.5f}, max[] = {0.1f, 1, 0};
	const nt_model_accessor position = {
		.view = nt_model_view(model, 0, 36, NT_GLTF_ARRAY_BUFFER),
		.component_type = NT_GLTF_FLOAT, .components = 3, .count = 3, .min = min, .max = max};
	const nt_model_attribute attribute = {"POSITION", nt_model_add_accessor(model, &position)};
	const nt_model_accessor index = {
		.view = nt_model_view(model, 36, 6, NT_GLTF_ELEMENT_ARRAY_BUFFER),
		.component_type = NT_GLTF_USHORT, .components = 1, .count = 3};
	const uint32_t index_accessor = nt_model_add_accessor(model, &index);
	const uint32_t mesh = nt_model_mesh(model, "tri");
	nt_model_primitive(model, mesh, &attribute, 1, index_accessor, material);
	assert_int_equal(nt_model_node(model, "", mesh, identity), 0);
	return model;
}

static void document_has_exact_bounds_and_no_empty_objects(void **state)
{
	(void)state;
	nt_model *model = triangle_model(NT_MODEL_NONE);
	char *text = text_of(model, 42, NT_MODEL_FILE, "a%20b.bin");
	assert_non_null(strstr(text, "\"buffers\":[{\"byteLength\":42,\"uri\":\"a%20b.bin\"}]}"));
	assert_non_null(strstr(text, "\"min\":[0.0,0.0,-2.5]"));
	assert_null(strstr(text, "null"));
	assert_null(strstr(text, "matrix"));
	free(text);
	nt_model_free(model);
}

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

static void reread_finds_attributes_in_companions(void **state)
{
	(void)state;
	nt_model *model = triangle_model(NT_MODEL_NONE);
	char *text = text_of(model, 42, NT_MODEL_FILE, "a%20b.bin");
	named_bytes file = triangle_bytes();
	nt_reread *reread;
	nt_error error;
	assert_int_equal(nt_reread_open(&reread, (const unsigned char *)text, strlen(text), find_bytes,
				 &file, &error), NT_OK);
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
	assert_int_equal(nt_reread_open(&reread, (const unsigned char *)text, strlen(text), find_bytes,
				 &file, &error), NT_ERROR_INPUT);
	assert_null(reread);
	assert_non_null(strstr(error.message, "a b.bin"));
	assert_int_equal(nt_reread_open(&reread, (const unsigned char *)text, strlen(text), NULL, NULL,
				 &error), NT_ERROR_INPUT);
	free(text);
	nt_model_free(model);
}

/* What a document says after one piece of its text was replaced. */
static nt_status status_after(const char *old, const char *new, nt_error *error)
{
	nt_model *model = triangle_model(NT_MODEL_NONE);
	char *text = text_of(model, 42, NT_MODEL_FILE, "a%20b.bin"), changed[2000];
	char *at = strstr(text, old);
	assert_non_null(at);
	snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - text), text, new, at + strlen(old));
	named_bytes file = triangle_bytes();
	nt_reread *reread;
	nt_reread_array array;
	nt_status status = nt_reread_open(&reread, (const unsigned char *)changed, strlen(changed),
		find_bytes, &file, error);
	if (status == NT_OK)
		status = nt_reread_attribute(reread, 0, 0, "POSITION", &array, error);
	nt_reread_free(reread);
	free(text);
	nt_model_free(model);
	return status;
}

static void reread_checks_accessors_against_views_and_buffers(void **state)
{
	(void)state;
	nt_error error;
	assert_int_equal(status_after("\"count\":3", "\"count\":3", &error), NT_OK);
	assert_int_equal(status_after("\"count\":3", "\"count\":4", &error), NT_ERROR_INPUT);
	assert_string_equal(error.place.pointer, "/meshes/0/primitives/0/attributes/POSITION");
	assert_int_equal(status_after("\"count\":3", "\"count\":1000000000000000", &error),
		NT_ERROR_INPUT);
	assert_int_equal(status_after("\"byteLength\":36", "\"byteLength\":43", &error),
		NT_ERROR_INPUT);
	assert_int_equal(status_after("\"bufferView\":0", "\"bufferView\":7", &error), NT_ERROR_INPUT);
	assert_int_equal(status_after("\"POSITION\":0", "\"POSITION\":9", &error), NT_ERROR_INPUT);
	assert_int_equal(status_after("\"buffer\":0", "\"buffer\":3", &error), NT_ERROR_INPUT);
	assert_int_equal(status_after("\"byteLength\":36", "\"byteLength\":36,\"byteStride\":4", &error),
		NT_ERROR_INPUT);
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

static void packed_views_are_unpacked(void **state)
{
	(void)state;
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

static void deep_json_is_refused_before_it_is_parsed(void **state)
{
	(void)state;
	enum { DEPTH = 100000 };
	char *text = malloc(DEPTH + 1);
	memset(text, '[', DEPTH);
	nt_reread *reread;
	nt_error error;
	assert_int_equal(nt_reread_open(&reread, (unsigned char *)text, DEPTH, NULL, NULL, &error),
		NT_ERROR_INPUT);
	assert_non_null(strstr(error.message, "512"));
	assert_null(reread);
	free(text);
	/* brackets in strings do not count */
	const char fine[] = "{\"asset\":{\"version\":\"2.0\",\"generator\":\"[[\\\"{{\"}}";
	assert_int_equal(nt_reread_open(&reread, (const unsigned char *)fine, sizeof fine - 1, NULL,
				 NULL, &error), NT_OK);
	nt_reread_free(reread);
}

static void names_in_latin_1_become_utf_8(void **state)
{
	(void)state;
	nt_model *model = new_model();
	/* 0xe9: Latin-1's e with acute; c3 a9 is the same in UTF-8; c0 80 is no UTF-8 */
	const nt_model_material material = {.name = "\xe9 \xc3\xa9 \xc0\x80 \"\\",
		.base_color = {0.8f, 0.1f, 1, 1}, .metallic = 0, .roughness = 1, .normal_scale = 1,
		.base_color_texture = NT_MODEL_NONE, .emissive_texture = NT_MODEL_NONE,
		.normal_texture = NT_MODEL_NONE};
	assert_int_equal(nt_model_add_material(model, &material), 0);
	char *text = text_of(model, 0, NT_MODEL_CHUNK, NULL);
	assert_non_null(strstr(text, "\"name\":\"\xc3\xa9 \xc3\xa9 \xc3\x80\xc2\x80 \\\"\\\\\""));
	assert_non_null(strstr(text, "\"baseColorFactor\":[0.8,0.1,1.0,1.0]"));
	assert_non_null(strstr(text, "\"metallicFactor\":0.0"));
	assert_null(strstr(text, "roughness")); /* glTF's default */
	free(text);
	nt_model_free(model);
}

static void bright_emission_needs_the_extension(void **state)
{
	(void)state;
	nt_model *model = new_model();
	nt_model_material material = {.base_color = {1, 1, 1, 0.5f}, .metallic = 1, .roughness = 1,
		.emissive = {4, 2, 0}, .blend = true, .normal_scale = 0.5f};
	const uint32_t image = nt_model_image_uri(model, "wood", "tex/wood%20.png");
	material.base_color_texture = material.emissive_texture = nt_model_texture(model, image, NULL);
	material.normal_texture = nt_model_texture(model,
		nt_model_image_view(model, "n", 0, "image/ktx2"), "KHR_texture_basisu");
	nt_model_add_material(model, &material);
	char *text = text_of(model, 0, NT_MODEL_CHUNK, NULL);
	assert_non_null(strstr(text, "\"emissiveFactor\":[1.0,0.5,0.0]"));
	assert_non_null(strstr(text, "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4.0}"));
	assert_non_null(strstr(text,
		"\"extensionsUsed\":[\"KHR_texture_basisu\",\"KHR_materials_emissive_strength\"]"));
	assert_non_null(strstr(text, "\"extensionsRequired\":[\"KHR_texture_basisu\"]"));
	assert_non_null(strstr(text, "\"alphaMode\":\"BLEND\""));
	assert_non_null(strstr(text, "\"normalTexture\":{\"index\":1,\"scale\":0.5}"));
	assert_non_null(strstr(text, "{\"name\":\"wood\",\"uri\":\"tex/wood%20.png\"}"));
	assert_non_null(strstr(text, "\"textures\":[{\"source\":0},"
				     "{\"extensions\":{\"KHR_texture_basisu\":{\"source\":1}}}]"));
	free(text);
	nt_model_free(model);
}

static void embedded_text_is_cut_where_the_base64_goes(void **state)
{
	(void)state;
	nt_model *model = triangle_model(NT_MODEL_NONE);
	nt_model_text text;
	assert_int_equal(nt_model_json(model, 42, NT_MODEL_EMBEDDED, NULL, &text, NULL), NT_OK);
	static const char before[] = "base64,", after[] = "\"}]}";
	assert_memory_equal(text.data + text.cut - strlen(before), before, strlen(before));
	assert_int_equal(text.size - text.cut, strlen(after));
	assert_memory_equal(text.data + text.cut, after, strlen(after));
	nt_model_text_free(&text);
	nt_model_free(model);
}

static void failed_addition_is_reported_at_the_end(void **state)
{
	(void)state;
	nt_model *model = new_model();
	nt_model_primitive(model, 5, NULL, 0, NT_MODEL_NONE, NT_MODEL_NONE); /* no such mesh */
	assert_int_equal(nt_model_mesh(model, "later"), NT_MODEL_NONE);
	nt_model_text text;
	nt_error error;
	assert_int_equal(nt_model_json(model, 0, NT_MODEL_CHUNK, NULL, &text, &error),
		NT_ERROR_INTERNAL);
	assert_non_null(strstr(error.message, "tinygltf"));
	assert_null(text.data);
	nt_model_free(model);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(empty_document_is_an_asset_and_nothing_else),
		cmocka_unit_test(document_has_exact_bounds_and_no_empty_objects),
		cmocka_unit_test(reread_finds_attributes_in_companions),
		cmocka_unit_test(reread_checks_accessors_against_views_and_buffers),
		cmocka_unit_test(packed_views_are_unpacked),
		cmocka_unit_test(deep_json_is_refused_before_it_is_parsed),
		cmocka_unit_test(names_in_latin_1_become_utf_8),
		cmocka_unit_test(bright_emission_needs_the_extension),
		cmocka_unit_test(embedded_text_is_cut_where_the_base64_goes),
		cmocka_unit_test(failed_addition_is_reported_at_the_end),
	};
	return cmocka_run_group_tests_name("ext/tinygltf", tests, NULL, NULL);
}
