/* SPDX-License-Identifier: MIT */
/*
 * Blocks that are decoded before the primitives are loaded: which, and what becomes of those that cannot be.
 */
#include "hand_gltf_file.h"
#include "gltf/draco.h"
#include "gltf/load.h"

enum { BLOCKS = 5, BROKEN = 2, UNASKED = 3 };

static nt_draco_block triangle(float size)
{
	const float positions[9] = {0, 0, 0, size, 0, 0, 0, size, 0};
	static const uint32_t indices[3] = {0, 1, 2};
	const nt_draco_attribute position = {.kind = NT_DRACO_POSITION, .component_type = NT_GLTF_FLOAT,
		.components = 3, .quantization = {.bits = 14}, .data = positions};
	const nt_draco_mesh mesh = {.method = NT_DRACO_SEQUENTIAL, .point_count = 3, .face_count = 1,
		.indices = indices, .attributes = &position, .attribute_count = 1};
	nt_draco_block block;
	nt_error error;
	assert_int_equal(nt_draco_encode(&mesh, &block, &error), NT_OK);
	return block;
}

/* A document of BLOCKS primitives, each with a block in a data URI; the head of one is damaged. */
static nt_buffer make_document(void)
{
	nt_buffer json = {0}, views = {0}, accessors = {0}, primitives = {0};
	nt_buffer_text(&json, "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],"
		"\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"buffers\":[");
	for (int i = 0; i < BLOCKS; i++) {
		const char *comma = i ? "," : "";
		nt_draco_block block = triangle((float)(i + 1));
		if (i == BROKEN)
			block.bytes[0] = 0;
		nt_buffer_text(&json, comma);
		append_buffer(&json, block.bytes, block.size);
		nt_buffer_format(&views, "%s{\"buffer\":%d,\"byteLength\":%zu}", comma, i, block.size);
		nt_buffer_format(&accessors, "%s{\"componentType\":5126,\"type\":\"VEC3\",\"count\":3}", comma);
		nt_buffer_format(&primitives, "%s{\"attributes\":{\"POSITION\":%d},\"extensions\":"
			"{\"KHR_draco_mesh_compression\":{\"bufferView\":%d,\"attributes\":{\"POSITION\":0}}}}",
			comma, i, i);
		nt_draco_block_free(&block);
	}
	nt_buffer_format(&json, "],\"bufferViews\":[%s],\"accessors\":[%s],\"meshes\":[{\"primitives\":[%s]}],"
		"\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]}", views.data, accessors.data, primitives.data);
	nt_buffer_free(&views);
	nt_buffer_free(&accessors);
	nt_buffer_free(&primitives);
	return json;
}

static void decode_with(unsigned threads)
{
	nt_buffer json = make_document();
	const nt_read_options options = {.texcoord_set = -1, .threads = threads};
	bool needed[BLOCKS];
	nt_scene scene;
	nt_error error;
	assert_int_equal(open_bytes(&scene, json.data, json.size, &options, &error), NT_OK);
	assert_int_equal(scene.mesh_count, BLOCKS);
	for (size_t i = 0; i < BLOCKS; i++)
		needed[i] = i != UNASKED;
	assert_int_equal(nt_gltf_decode_ahead(&scene, needed, &options, &error), NT_OK);
	for (size_t i = 0; i < BLOCKS; i++) {
		const nt_draco_mesh *block = nt_gltf_draco_block(scene.source, i);
		assert_int_equal(block != NULL, threads > 1 && i != UNASKED && i != BROKEN);
		if (block)
			assert_int_equal(nt_draco_find(block, 0)->quantization.bits, 14);
	}

	/* loading finds them, has what was not asked for, and says what is wrong */
	for (size_t i = 0; i < BLOCKS; i++) {
		nt_mesh *mesh = &scene.meshes[i];
		const nt_draco_mesh *block = nt_gltf_draco_block(scene.source, i);
		const nt_status status = nt_gltf_load(&scene, mesh, &options, &error);
		assert_int_equal(status, i == BROKEN ? NT_ERROR_INPUT : NT_OK);
		if (i == BROKEN) {
			assert_string_equal(error.place.pointer, "/bufferViews/2");
			continue;
		}
		assert_true(!block || block == nt_gltf_draco_block(scene.source, i));
		assert_int_equal(mesh->vertex_count, 3);
		assert_true(mesh->positions[3] == (float)(i + 1));
	}
	nt_scene_free(&scene);
	nt_buffer_free(&json);
}

TEST(blocks_are_decoded_ahead_on_several_threads)
{
	for (unsigned threads = 1; threads <= 8; threads *= 2)
		decode_with(threads);
}

/* w is -1 or 1 in every file, and bytes of 1 say so to every decoder. */
TEST(the_grid_of_tangents_has_both_signs)
{
	static const float tangents[3][4] = {{1, 0, 0, 1}, {0, -1, 0, -1}, {0.6f, 0, -0.8f, 1}};
	static const uint32_t face[3] = {0, 1, 2};
	for (int bits = 2; bits <= 24; bits++) {
		const int choice[NT_DRACO_BITS_COUNT] = {0, 0, 0, bits};
		const nt_draco_quantization grid = nt_gltf_draco_tangent_grid(NULL, choice);
		const nt_draco_attribute attribute = {.kind = NT_DRACO_GENERIC, .component_type = NT_GLTF_FLOAT,
			.components = 4, .quantization = grid, .data = tangents};
		const nt_draco_mesh mesh = {.point_count = 3, .face_count = 1, .indices = face,
			.attributes = &attribute, .attribute_count = 1};
		float decoded[3][4], *values = decoded[0];
		assert_int_equal(nt_draco_quantize(&mesh, &values, NULL), NT_OK);
		assert_true(decoded[0][3] == 1 && decoded[1][3] == -1 && decoded[0][0] == 1 && decoded[1][1] == -1);
		/* it stays the next time; one that begins beside -1 does not, but for its bits */
		nt_draco_quantization source = grid, next = nt_gltf_draco_tangent_grid(&source, choice);
		assert_true(next.bits == grid.bits && next.range == grid.range && next.origin[0] == grid.origin[0]);
		source.origin[3] = -0.99f;
		source.bits = 14;
		next = nt_gltf_draco_tangent_grid(&source, choice);
		assert_true(next.origin[3] == -1 && next.range == 2 && next.bits >= 14);
	}
}
