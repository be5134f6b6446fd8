/* SPDX-License-Identifier: MIT */
#include "gltf/create/model.h"
#include "test.h"

static const nt_model_use none = {.texture = NT_MODEL_NONE};

#define NO_TEXTURES \
	.base_color_texture = none, .emissive_texture = none, .normal_texture = none, \
	.metallic_roughness_texture = none, .occlusion_texture = none, .clearcoat_texture = none, \
	.clearcoat_roughness_texture = none, .sheen_texture = none

static nt_model *new_model(void)
{
	nt_model *model = nt_model_create("nmtan test");
	assert_non_null(model);
	return model;
}

/* Ends a model, whose text has these parts. */
static void model_says(nt_model *model, uint64_t length, nt_model_buffer buffer, const char *uri,
	const char *const *parts)
{
	nt_model_text text;
	const nt_model_file file = {uri, NULL};
	assert_int_equal(nt_model_json(model, length, buffer, &file, &text, NULL), NT_OK);
	assert_true(text.cut <= text.count);
	char *copy = calloc(text.size + 1, 1), *to = copy;
	for (size_t i = 0; i < text.count; i++) {
		memcpy(to, text.pieces[i].data, text.pieces[i].size);
		to += text.pieces[i].size;
	}
	assert_int_equal(to - copy, text.size);
	nt_model_text_free(&text);
	assert_says(copy, parts);
	free(copy);
	nt_model_free(model);
}

static const double still[3] = {0, 0, 0};

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
	nt_model_primitive(model, &attribute, 1, index_accessor, material);
	assert_int_equal(nt_model_node(model, "", mesh, still), 0);
	return model;
}

TEST(empty_document_is_an_asset_and_nothing_else)
{
	static const char whole[] = "{\"asset\":{\"generator\":\"nmtan test\",\"version\":\"2.0\"}}";
	nt_model *model = new_model();
	nt_model_text text;
	assert_int_equal(nt_model_json(model, 0, NT_MODEL_FILE, NULL, &text, NULL), NT_OK);
	assert_int_equal(text.size, sizeof whole - 1);
	nt_model_text_free(&text);
	model_says(model, 0, NT_MODEL_FILE, NULL, PARTS(whole));
}

TEST(document_has_exact_bounds_and_no_empty_objects)
{
	nt_model *model = triangle_model(NT_MODEL_NONE);
	model_says(model, 42, NT_MODEL_FILE, "a%20b.bin", PARTS(
		"\"buffers\":[{\"byteLength\":42,\"uri\":\"a%20b.bin\"}]}", "\"min\":[0.0,0.0,-2.5]",
		/* 0.1 as a float is this double */
		"\"max\":[0.10000000149011612,1.0,0.0]", "!null", "!translation"));
}

TEST(names_in_latin_1_become_utf_8)
{
	nt_model *model = new_model();
	/* 0xe9: Latin-1's e with acute; c3 a9 is the same in UTF-8; c0 80 is no UTF-8 */
	const nt_model_material material = {.name = "\xe9 \xc3\xa9 \xc0\x80 \"\\",
		.base_color = {0.8f, 0.1f, 1, 1}, .metallic = 0, .roughness = 1, .normal_scale = 1,
		NO_TEXTURES};
	assert_int_equal(nt_model_add_material(model, &material), 0);
	model_says(model, 0, NT_MODEL_CHUNK, NULL, PARTS(
		"\"name\":\"\xc3\xa9 \xc3\xa9 \xc3\x80\xc2\x80 \\\"\\\\\"",
		"\"baseColorFactor\":[0.8,0.1,1.0,1.0]", "\"metallicFactor\":0.0", "!roughness")); /* glTF's default */
}

TEST(control_characters_are_escaped)
{
	nt_model *model = new_model();
	const nt_model_material material = {.name = "a\b\t\n\f\r\x01\x1f\x7f", .base_color = {1, 1, 1, 1},
		.metallic = 1,
		.roughness = 1, .normal_scale = 1, NO_TEXTURES};
	nt_model_add_material(model, &material);
	model_says(model, 0, NT_MODEL_CHUNK, NULL, PARTS(
		"\"materials\":[{\"name\":\"a\\b\\t\\n\\f\\r\\u0001\\u001f\x7f\"}]"));
}

TEST(primitives_follow_their_mesh)
{
	nt_model *model = new_model();
	for (uint32_t m = 0; m < 2; m++) {
		assert_int_equal(nt_model_mesh(model, m ? "b" : ""), m);
		for (uint32_t p = 0; p < 2; p++) {
			const nt_model_attribute attribute = {"POSITION", 2 * m + p};
			nt_model_primitive(model, &attribute, 1, NT_MODEL_NONE, p ? 7 : NT_MODEL_NONE);
		}
	}
	const double moved[3] = {1e-5, 5412347.25, 0};
	nt_model_node(model, "", 0, still);
	nt_model_node(model, "n", 1, moved);
	model_says(model, 0, NT_MODEL_CHUNK, NULL, PARTS(
		"\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":4},"
		"{\"attributes\":{\"POSITION\":1},\"material\":7,\"mode\":4}]},{\"name\":\"b\",\"primitives\":["
		"{\"attributes\":{\"POSITION\":2},\"mode\":4},{\"attributes\":{\"POSITION\":3},\"material\":7,"
		"\"mode\":4}]}],\"nodes\":[{\"mesh\":0},{\"mesh\":1,\"name\":\"n\","
		"\"translation\":[1e-05,5412347.25,0.0]}],\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}]}"));
}

TEST(bright_emission_needs_the_extension)
{
	nt_model *model = new_model();
	nt_model_material material = {.base_color = {1, 1, 1, 0.5f}, .metallic = 1, .roughness = 1,
		.emissive = {4, 2, 0}, .alpha_mode = NT_ALPHA_BLEND, .normal_scale = 0.5f, NO_TEXTURES};
	const uint32_t image = nt_model_image_uri(model, "wood", "tex/wood%20.png");
	material.base_color_texture.texture = material.emissive_texture.texture =
		nt_model_texture(model, image, false, NULL);
	material.normal_texture.texture = nt_model_texture(model,
		nt_model_image_view(model, "n", 0, "image/ktx2"), false, "KHR_texture_basisu");
	nt_model_add_material(model, &material);
	model_says(model, 0, NT_MODEL_CHUNK, NULL, PARTS("\"emissiveFactor\":[1.0,0.5,0.0]",
		"\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4.0}",
		"\"extensionsUsed\":[\"KHR_texture_basisu\",\"KHR_materials_emissive_strength\"]",
		"\"extensionsRequired\":[\"KHR_texture_basisu\"]", "\"alphaMode\":\"BLEND\"",
		"\"normalTexture\":{\"index\":1,\"scale\":0.5}",
		"{\"name\":\"wood\",\"uri\":\"tex/wood%20.png\"}", "\"textures\":[{\"source\":0},"
		"{\"extensions\":{\"KHR_texture_basisu\":{\"source\":1}}}]"));
}

TEST(layers_are_extensions)
{
	nt_model *model = new_model();
	nt_model_material material = {.base_color = {1, 1, 1, 1}, .metallic = 0, .roughness = 0.5f, .normal_scale = 1,
		.alpha_mode = NT_ALPHA_MASK, .clearcoat = 0.5f, .clearcoat_roughness = 0.25f, .sheen = 0.75f,
		.sheen_roughness = 0.5f, .anisotropy = 0.125f, .anisotropy_rotation = 1.5f, .ior = 1.25f, NO_TEXTURES};
	material.clearcoat_texture.texture = material.clearcoat_roughness_texture.texture = 3;
	material.sheen_texture.texture = 4;
	material.metallic_roughness_texture.texture = material.occlusion_texture.texture = 5;
	nt_model_add_material(model, &material);
	nt_model_add_material(model, &material);
	model_says(model, 0, NT_MODEL_CHUNK, NULL, PARTS("{\"alphaMode\":\"MASK\",\"extensions\":{"
		"\"KHR_materials_anisotropy\":{\"anisotropyRotation\":1.5,\"anisotropyStrength\":0.125},"
		"\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.5,\"clearcoatRoughnessFactor\":0.25,"
		"\"clearcoatRoughnessTexture\":{\"index\":3},\"clearcoatTexture\":{\"index\":3}},"
		"\"KHR_materials_ior\":{\"ior\":1.25},"
		"\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.75,0.75,0.75],\"sheenColorTexture\":{\"index\":4},"
		"\"sheenRoughnessFactor\":0.5}},"
		"\"occlusionTexture\":{\"index\":5},\"pbrMetallicRoughness\":{\"metallicFactor\":0.0,"
		"\"metallicRoughnessTexture\":{\"index\":5},\"roughnessFactor\":0.5}}",
		"\"extensionsUsed\":[\"KHR_materials_anisotropy\",\"KHR_materials_clearcoat\","
		"\"KHR_materials_ior\",\"KHR_materials_sheen\"]", "!extensionsRequired"));
}

TEST(embedded_text_is_cut_where_the_base64_goes)
{
	nt_model *model = triangle_model(NT_MODEL_NONE);
	nt_model_text text;
	assert_int_equal(nt_model_json(model, 42, NT_MODEL_EMBEDDED, NULL, &text, NULL), NT_OK);
	static const char before[] = "base64,", after[] = "\"}]}";
	const nt_model_piece last = text.pieces[text.cut - 1];
	assert_memory_equal(last.data + last.size - strlen(before), before, strlen(before));
	assert_int_equal(text.count, text.cut + 1);
	assert_int_equal(text.pieces[text.cut].size, strlen(after));
	assert_memory_equal(text.pieces[text.cut].data, after, strlen(after));
	nt_model_text_free(&text);
	nt_model_free(model);
}

TEST(what_is_moved_or_clamped_says_so)
{
	nt_model *model = new_model();
	const uint32_t image = nt_model_image_uri(model, "n", "n.png");
	nt_model_material material = {.base_color = {1, 1, 1, 1}, .metallic = 1, .roughness = 1, .normal_scale = 0.5f,
		NO_TEXTURES};
	material.base_color_texture.texture = nt_model_texture(model, image, true, NULL);
	material.normal_texture =
		(nt_model_use){nt_model_texture(model, image, false, NULL), true, {-1, 2}, {0.25f, -3}};
	nt_model_texture(model, image, true, "EXT_texture_webp");
	nt_model_add_material(model, &material);
	model_says(model, 0, NT_MODEL_CHUNK, NULL, PARTS(
		"\"extensionsUsed\":[\"EXT_texture_webp\",\"KHR_texture_transform\"]",
		"\"normalTexture\":{\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.25,-3.0],"
		"\"scale\":[-1.0,2.0]}},\"index\":1,\"scale\":0.5}",
		"\"baseColorTexture\":{\"index\":0}", "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33071}]",
		"\"textures\":[{\"sampler\":0,\"source\":0},{\"source\":0},"
		"{\"extensions\":{\"EXT_texture_webp\":{\"source\":0}},\"sampler\":0}]"));
}

TEST(misuse_is_reported_at_the_end)
{
	nt_model *model = new_model();
	nt_model_primitive(model, NULL, 0, NT_MODEL_NONE, NT_MODEL_NONE); /* of no mesh */
	nt_model_text text;
	nt_error error;
	assert_int_equal(nt_model_json(model, 0, NT_MODEL_CHUNK, NULL, &text, &error), NT_ERROR_INTERNAL);
	nt_model_text_free(&text);
	nt_model_free(model);
}
