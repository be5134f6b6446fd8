/* SPDX-License-Identifier: MIT */
#include "test.h"
#include <stdio.h>
#include "base/text.h"
#include "gltf/document.h"

/* `,"meshes":[{"primitives":[9]}]` for "/meshes/0/primitives/0": nothing stands beside what the path names. */
static void put_path(nt_buffer *text, const char *path)
{
	char closing[256];
	size_t open = 0;
	for (const char *key = path; *key; open++) {
		const size_t length = strcspn(++key, "/");
		if (*key == '0')
			nt_buffer_text(text, "[");
		else
			nt_buffer_format(text, "%s\"%.*s\":", open ? "{" : ",", (int)length, key);
		closing[open] = *key == '0' ? ']' : '}';
		key += length;
	}
	nt_buffer_text(text, "9");
	while (open > 1)
		nt_buffer_format(text, "%c", closing[--open]);
}

static nt_gltf *create(nt_scene *scene, const char *text, size_t size)
{
	nt_gltf *document = NULL;
	nt_error error;
	nt_scene_init(scene, "test.gltf");
	scene->bytes = (const unsigned char *)text;
	scene->byte_count = size;
	assert_int_equal(nt_gltf_create(&document, scene, false, &error), NT_OK);
	assert_int_equal(nt_gltf_read_arrays(document, &error), NT_OK);
	scene->source = document;
	scene->free_source = nt_gltf_free;
	return document;
}

/* The document with what a path names; the dangling references of it are known. */
static const nt_gltf *find_dangling(nt_scene *scene, nt_buffer *text, const char *path)
{
	nt_buffer_text(text, "{\"asset\":{\"version\":\"2.0\"}");
	put_path(text, path);
	nt_buffer_text(text, "}");
	nt_gltf *document = create(scene, text->data, text->size);
	nt_gltf_find_dangling(document);
	return document;
}

/* From glTF 2.0 and the schemas of the extensions. */
static const struct {
	nt_gltf_growing kind;
	const char *pointer, *rest; /* rest: what the pointer leaves out, beginning with a key that the file chooses */
} references[] = {
	{NT_GLTF_VIEWS, "/accessors/0/bufferView", ""},
	{NT_GLTF_VIEWS, "/accessors/0/sparse/indices/bufferView", ""},
	{NT_GLTF_VIEWS, "/accessors/0/sparse/values/bufferView", ""},
	{NT_GLTF_ACCESSORS, "/animations/0/samplers/0/input", ""},
	{NT_GLTF_ACCESSORS, "/animations/0/samplers/0/output", ""},
	{NT_GLTF_BUFFERS, "/bufferViews/0/buffer", ""},
	{NT_GLTF_BUFFERS, "/bufferViews/0/extensions/EXT_meshopt_compression/buffer", ""},
	{NT_GLTF_BUFFERS, "/bufferViews/0/extensions/KHR_meshopt_compression/buffer", ""},
	{NT_GLTF_VIEWS, "/images/0/bufferView", ""},
	{NT_GLTF_ACCESSORS, "/meshes/0/primitives/0/attributes", "/NORMAL"},
	{NT_GLTF_ACCESSORS, "/meshes/0/primitives/0/indices", ""},
	{NT_GLTF_ACCESSORS, "/meshes/0/primitives/0/targets/0", "/NORMAL"},
	{NT_GLTF_ACCESSORS, "/meshes/0/primitives/0/extensions/CESIUM_primitive_outline/indices", ""},
	{NT_GLTF_ACCESSORS, "/meshes/0/primitives/0/extensions/EXT_mesh_primitive_edge_visibility/visibility", ""},
	{NT_GLTF_ACCESSORS,
		"/meshes/0/primitives/0/extensions/EXT_mesh_primitive_edge_visibility/silhouetteNormals", ""},
	{NT_GLTF_ACCESSORS,
		"/meshes/0/primitives/0/extensions/EXT_mesh_primitive_edge_visibility/lineStrings/0/indices", ""},
	{NT_GLTF_VIEWS, "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView", ""},
	{NT_GLTF_VIEWS, "/meshes/0/primitives/0/extensions/KHR_gaussian_splatting/extensions/"
		"KHR_gaussian_splatting_compression_spz_2/bufferView", ""},
	{NT_GLTF_ACCESSORS, "/meshes/0/extensions/EXT_mesh_manifold/manifoldPrimitive/attributes", "/POSITION"},
	{NT_GLTF_ACCESSORS, "/meshes/0/extensions/EXT_mesh_manifold/manifoldPrimitive/indices", ""},
	{NT_GLTF_ACCESSORS, "/meshes/0/extensions/EXT_mesh_manifold/mergeIndices", ""},
	{NT_GLTF_ACCESSORS, "/meshes/0/extensions/EXT_mesh_manifold/mergeValues", ""},
	{NT_GLTF_ACCESSORS, "/meshes/0/extensions/EXT_mesh_primitive_restart/primitiveGroups/0/indices", ""},
	{NT_GLTF_ACCESSORS, "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes", "/TRANSLATION"},
	{NT_GLTF_ACCESSORS, "/skins/0/inverseBindMatrices", ""},
	{NT_GLTF_VIEWS, "/extensions/EXT_feature_metadata/featureTables", "/trees/properties/height/bufferView"},
	{NT_GLTF_VIEWS, "/extensions/EXT_feature_metadata/featureTables",
		"/trees/properties/height/arrayOffsetBufferView"},
	{NT_GLTF_VIEWS, "/extensions/EXT_feature_metadata/featureTables",
		"/trees/properties/name/stringOffsetBufferView"},
	{NT_GLTF_VIEWS, "/extensions/EXT_lights_ies/lights/0/bufferView", ""},
	{NT_GLTF_VIEWS, "/extensions/EXT_structural_metadata/propertyTables/0/properties", "/height/values"},
	{NT_GLTF_VIEWS, "/extensions/EXT_structural_metadata/propertyTables/0/properties", "/height/arrayOffsets"},
	{NT_GLTF_VIEWS, "/extensions/EXT_structural_metadata/propertyTables/0/properties", "/name/stringOffsets"},
	{NT_GLTF_VIEWS, "/extensions/KHR_audio/audio/0/bufferView", ""},
	{NT_GLTF_VIEWS, "/extensions/KHR_audio_emitter/audio/0/bufferView", ""},
	/* numbers that refer to nothing that an edit adds: to materials, to images, or they are the file's own words */
	{NT_GLTF_GROWING, "/meshes/0/primitives/0/material", ""},
	{NT_GLTF_GROWING, "/meshes/0/extras/indices", ""},
	{NT_GLTF_GROWING, "/textures/0/extensions/KHR_texture_basisu/source", ""},
	{NT_GLTF_GROWING, "/nodes/0/mesh", ""},
	{NT_GLTF_GROWING, "/accessors/0/extras/bufferView", ""},
	{NT_GLTF_GROWING, "/meshes/0/primitives/0/extensions/EXT_mesh_primitive_edge_visibility/material", ""},
	{NT_GLTF_GROWING, "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION", ""},
};

/* Each is found with its kind and its place, and nothing else is. */
TEST(references_are_found_with_kind_and_place)
{
	for (size_t i = 0; i < sizeof references / sizeof *references; i++) {
		const nt_gltf_growing own = references[i].kind;
		char path[256];
		snprintf(path, sizeof path, "%s%s", references[i].pointer, references[i].rest);
		nt_scene scene;
		nt_buffer text = {0};
		const nt_gltf *document = find_dangling(&scene, &text, path);
		for (nt_gltf_growing kind = 0; kind < NT_GLTF_GROWING; kind++)
			if (document->dangling[kind].number != (kind == own ? 9 : UINT64_MAX))
				fail_msg("%s: %llu of kind %d", path,
					(unsigned long long)document->dangling[kind].number, kind);
		if (own < NT_GLTF_GROWING)
			assert_string_equal(document->dangling[own].pointer, references[i].pointer);
		nt_scene_free(&scene);
		nt_buffer_free(&text);
	}
}

/* A view of a buffer that is not there has no bytes, also when an edit has added a buffer of that number. */
TEST(an_added_buffer_is_not_what_the_file_refers_to)
{
	static const char text[] =
		"{\"asset\":{\"version\":\"2.0\"},\"bufferViews\":[{\"buffer\":0,\"byteLength\":4}]}";
	nt_scene scene;
	nt_error error;
	nt_gltf *document = create(&scene, text, sizeof text - 1);
	for (int added = 0; added < 2; added++) {
		const nt_gltf_view *view;
		assert_int_equal(nt_gltf_get_view(document, 0, "/accessors/0", &view, &error), NT_ERROR_INPUT);
		assert_string_equal(error.message, "refers to buffers[0], there are 0");
		assert_string_equal(error.place.pointer, "/bufferViews/0");
		nt_json *json = document->json;
		nt_json_value *buffer = nt_json_append(json, nt_json_put(json, nt_json_root(json), "buffers"));
		nt_json_set_uint64(json, nt_json_put(json, buffer, "byteLength"), 8);
	}
	nt_scene_free(&scene);
}

/* Accessors 0 and 1 lie over the same bytes: a primitive and a target have the first, nobody the second. 2 is indices
 * twice, 3 belongs to an animation, 4 to an extension whose accessors are kept as they are. */
TEST(users_of_accessors_over_the_same_bytes_are_counted_together)
{
	static const char text[] = "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":96}],"
		"\"bufferViews\":[{\"buffer\":0,\"byteLength\":96},{\"buffer\":0,\"byteLength\":8}],"
		"\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3},"
		"{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":3},"
		"{\"bufferView\":0,\"componentType\":5125,\"type\":\"SCALAR\",\"count\":3},"
		"{\"bufferView\":0,\"componentType\":5126,\"type\":\"SCALAR\",\"count\":3},"
		"{\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC2\",\"count\":3}],"
		"\"images\":[{\"bufferView\":1}],\"animations\":[{\"samplers\":[{\"input\":3,\"output\":99}]}],"
		"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2,"
		"\"targets\":[{\"POSITION\":0}],"
		"\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0},"
		"\"EXT_mesh_primitive_edge_visibility\":{\"silhouetteNormals\":4}}},{\"indices\":2}]}]}";
	static const nt_gltf_users expected[] = {{.attributes = 2, .idle = true}, {.attributes = 2, .idle = true},
		{.indices = 2, .foreign = true}, {.foreign = true}, {.idle = true}};
	nt_scene scene;
	nt_error error;
	nt_gltf *document = create(&scene, text, sizeof text - 1);
	assert_int_equal(nt_gltf_find_users(document, &error), NT_OK);
	for (uint32_t i = 0; i < 5; i++) {
		const nt_gltf_users *found = nt_gltf_users_of(document, i);
		assert_int_equal(found->attributes, expected[i].attributes);
		assert_int_equal(found->indices, expected[i].indices);
		assert_int_equal(found->foreign, expected[i].foreign);
		assert_int_equal(found->idle, expected[i].idle);
	}
	assert_int_equal(document->view_users[0].blocks, 1);
	assert_true(document->view_users[1].image && !document->view_users[0].image);
	assert_int_equal(document->dangling[NT_GLTF_ACCESSORS].number, 99);
	nt_scene_free(&scene);
}
