/* SPDX-License-Identifier: MIT */
/*
 * Materials of new documents. If there is a map, its own factor counts, else the material's number. A value that
 * glTF takes by default is not written.
 */
#include "gltf/create/model.h"

#include <math.h>

void nt_new_material_use(const nt_material *material, nt_image_set *images)
{
	for (size_t i = 0; i < NT_MATERIAL_MAPS; i++)
		nt_image_set_use(images, material, &material->maps[i]);
}

/* ---- numbers and textures ---- */

static float clamp01(float value)
{
	return value > 0 ? (value < 1 ? value : 1) : 0;
}

static nt_model_use texture_of(const nt_image_set *images, const nt_map *map)
{
	return images && map->name ? nt_image_set_texture(images, map) : (nt_model_use){.texture = NT_MODEL_NONE};
}

static bool is_there(const nt_model_use *use)
{
	return use->texture != NT_MODEL_NONE;
}

/* A number, and the texture of its map. */
static float factor_of(const nt_image_set *images, const nt_map *map, float otherwise, nt_model_use *texture)
{
	*texture = texture_of(images, map);
	return clamp01(is_there(texture) ? map->factor : otherwise);
}

/* Colours, beside a texture none that would hide it. */
static void take_color(const float *from, const nt_model_use *texture, float most, float *to)
{
	const bool hides = is_there(texture) && from[0] == 0 && from[1] == 0 && from[2] == 0;
	for (int i = 0; i < 3; i++)
		to[i] = hides ? 1 : from[i] < most ? from[i] : most;
}

/* ---- members ---- */

static void put_factor(nt_model *model, nt_json_value *object, const char *key, float value, float otherwise)
{
	if (value != otherwise)
		nt_json_set_float(model->json, nt_json_put(model->json, object, key), value);
}

/* A textureInfo; NULL: there is no texture. */
static nt_json_value *put_texture(nt_model *model, nt_json_value *object, const char *key, const nt_model_use *use)
{
	static const char transform[] = "KHR_texture_transform";
	if (!is_there(use))
		return NULL;
	nt_json *json = model->json;
	nt_json_value *info = nt_json_put(json, object, key);
	if (use->moved) {
		nt_gltf_list_extension(model->document, "extensionsUsed", transform);
		nt_json_value *moved = nt_json_put(json, nt_json_put(json, info, "extensions"), transform);
		nt_model_put_floats(model, moved, "offset", use->offset, 2);
		nt_model_put_floats(model, moved, "scale", use->scale, 2);
	}
	nt_model_put_index(model, info, "index", use->texture);
	return info;
}

static nt_json_value *put_extension(nt_model *model, nt_json_value *material, const char *name)
{
	nt_json *json = model->json;
	nt_json_value *extension = nt_json_put(json, nt_json_put(json, material, "extensions"), name);
	nt_json_set_object(json, extension);
	nt_gltf_list_extension(model->document, "extensionsUsed", name);
	return extension;
}

/* glTF's emissiveFactor ends at 1; what is brighter is a factor and a strength, which comes back. */
static float put_emissive(nt_model *model, nt_json_value *material, const nt_material *from,
	const nt_image_set *images)
{
	const nt_model_use texture = texture_of(images, &from->emissive_map);
	float emissive[3], largest = 1, factor[3];
	take_color(from->emissive, &texture, INFINITY, emissive);
	for (int i = 0; i < 3; i++)
		largest = emissive[i] > largest ? emissive[i] : largest;
	for (int i = 0; i < 3; i++)
		factor[i] = emissive[i] > 0 ? emissive[i] / largest : 0;
	if (factor[0] != 0 || factor[1] != 0 || factor[2] != 0)
		nt_model_put_floats(model, material, "emissiveFactor", factor, 3);
	put_texture(model, material, "emissiveTexture", &texture);
	return largest;
}

static void put_extensions(nt_model *model, nt_json_value *material, const nt_material *from,
	const nt_image_set *images, float strength)
{
	const float anisotropy = images ? clamp01(from->anisotropy) : 0;
	nt_model_use coat_texture, roughness_texture, sheen_texture;
	const float coat = factor_of(images, &from->clearcoat_map, from->clearcoat, &coat_texture);
	const float coat_roughness = factor_of(images, &from->clearcoat_roughness_map, from->clearcoat_roughness,
		&roughness_texture);
	const float sheen = factor_of(images, &from->sheen_map, from->sheen, &sheen_texture);
	nt_json_value *extension;
	if (anisotropy != 0) {
		extension = put_extension(model, material, "KHR_materials_anisotropy");
		put_factor(model, extension, "anisotropyRotation", from->anisotropy_rotation, 0);
		put_factor(model, extension, "anisotropyStrength", anisotropy, 0);
	}
	if (coat != 0) {
		extension = put_extension(model, material, "KHR_materials_clearcoat");
		put_factor(model, extension, "clearcoatFactor", coat, 0);
		put_factor(model, extension, "clearcoatRoughnessFactor", coat_roughness, 0);
		put_texture(model, extension, "clearcoatRoughnessTexture", &roughness_texture);
		put_texture(model, extension, "clearcoatTexture", &coat_texture);
	}
	if (strength != 1)
		put_factor(model, put_extension(model, material, "KHR_materials_emissive_strength"),
			"emissiveStrength", strength, 1);
	if (from->ior != 0)
		put_factor(model, put_extension(model, material, "KHR_materials_ior"), "ior", from->ior, 1.5f);
	if (sheen != 0) {
		extension = put_extension(model, material, "KHR_materials_sheen");
		nt_model_put_floats(model, extension, "sheenColorFactor", (const float[]){sheen, sheen, sheen}, 3);
		put_texture(model, extension, "sheenColorTexture", &sheen_texture);
		put_factor(model, extension, "sheenRoughnessFactor", from->sheen_roughness, 0);
	}
}

/* The base colour and its texture, whose image may be there for its alpha alone. */
static nt_alpha_mode take_base_color(const nt_material *from, const nt_image_set *images, float color[4],
	nt_model_use *texture)
{
	nt_model_use alpha;
	*texture = texture_of(images, &from->base_color_map);
	take_color(from->base_color, texture, 1, color);
	color[3] = factor_of(images, &from->alpha_map, from->base_color[3], &alpha);
	if (!is_there(texture))
		*texture = alpha;
	return color[3] < 1 ? NT_ALPHA_BLEND :
		is_there(&alpha) ? nt_image_set_alpha(images, from->alpha_map.request) : NT_ALPHA_OPAQUE;
}

static void put_reflection(nt_model *model, nt_json_value *material, const nt_material *from,
	const nt_image_set *images, const float color[4], const nt_model_use *color_texture)
{
	nt_model_use metallic_texture, roughness_texture;
	const float metallic = factor_of(images, &from->metallic_map, from->metallic, &metallic_texture);
	const float roughness = factor_of(images, &from->roughness_map, from->roughness, &roughness_texture);
	const nt_model_use *texture = is_there(&metallic_texture) ? &metallic_texture : &roughness_texture;
	const bool white = color[0] == 1 && color[1] == 1 && color[2] == 1 && color[3] == 1;
	if (white && !is_there(color_texture) && !is_there(texture) && metallic == 1 && roughness == 1)
		return;
	nt_json_value *pbr = nt_json_put(model->json, material, "pbrMetallicRoughness");
	if (!white)
		nt_model_put_floats(model, pbr, "baseColorFactor", color, 4);
	put_texture(model, pbr, "baseColorTexture", color_texture);
	put_factor(model, pbr, "metallicFactor", metallic, 1);
	put_texture(model, pbr, "metallicRoughnessTexture", texture);
	put_factor(model, pbr, "roughnessFactor", roughness, 1);
}

uint32_t nt_new_material_add(const nt_material *from, const nt_image_set *images, nt_model *model)
{
	static const char *const modes[] = {[NT_ALPHA_MASK] = "MASK", [NT_ALPHA_BLEND] = "BLEND"};
	uint32_t number;
	float color[4];
	nt_model_use color_texture;
	const nt_alpha_mode mode = take_base_color(from, images, color, &color_texture);
	nt_json_value *material = nt_model_append(model, "materials", &number);
	nt_json_set_object(model->json, material);
	if (mode != NT_ALPHA_OPAQUE)
		nt_model_put_string(model, material, "alphaMode", modes[mode]);
	const float strength = put_emissive(model, material, from, images);
	put_extensions(model, material, from, images, strength);
	nt_model_put_string(model, material, "name", from->name);
	const nt_model_use normals = texture_of(images, &from->normal_map);
	const nt_model_use occlusion = texture_of(images, &from->occlusion_map);
	nt_json_value *info = put_texture(model, material, "normalTexture", &normals);
	if (info)
		put_factor(model, info, "scale", from->normal_scale, 1);
	put_texture(model, material, "occlusionTexture", &occlusion);
	put_reflection(model, material, from, images, color, &color_texture);
	return number;
}
