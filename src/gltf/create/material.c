/* SPDX-License-Identifier: MIT */
/*
 * Materials of new documents. If there is a map, its own factor counts, else the material's number.
 */
#include "gltf/create/model.h"

#include <math.h>

nt_status nt_new_material_use(const nt_material *material, nt_image_set *images, nt_output *output, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < NT_MATERIAL_MAPS && !status; i++)
		status = nt_image_set_use(images, material, &material->maps[i], output, error);
	return status;
}

static float clamp01(float value)
{
	return value > 0 ? (value < 1 ? value : 1) : 0;
}

static nt_model_use texture_of(const nt_image_set *images, const nt_map *map)
{
	return images && map->name ? nt_image_set_texture(images, map) : (nt_model_use){.texture = NT_MODEL_NONE};
}

/* A number, and the texture of its map. */
static float factor_of(const nt_image_set *images, const nt_map *map, float otherwise, nt_model_use *texture)
{
	*texture = texture_of(images, map);
	return clamp01(texture->texture == NT_MODEL_NONE ? otherwise : map->factor);
}

/* Colours, beside a texture none that would hide it. */
static void take_color(const float *from, const nt_model_use *texture, float most, float *to)
{
	const bool hides = texture->texture != NT_MODEL_NONE && from[0] == 0 && from[1] == 0 && from[2] == 0;
	for (int i = 0; i < 3; i++)
		to[i] = hides ? 1 : from[i] < most ? from[i] : most;
}

/* The image of the base colour may be there for its alpha alone. */
static void take_base_color(const nt_material *from, const nt_image_set *images, nt_model_material *m)
{
	nt_model_use alpha;
	m->base_color_texture = texture_of(images, &from->base_color_map);
	take_color(from->base_color, &m->base_color_texture, 1, m->base_color);
	m->base_color[3] = factor_of(images, &from->alpha_map, from->base_color[3], &alpha);
	if (m->base_color[3] < 1)
		m->alpha_mode = NT_ALPHA_BLEND;
	else if (alpha.texture != NT_MODEL_NONE)
		m->alpha_mode = nt_image_set_alpha(images, from->alpha_map.request);
	if (m->base_color_texture.texture == NT_MODEL_NONE)
		m->base_color_texture = alpha;
}

uint32_t nt_new_material_add(const nt_material *from, const nt_image_set *images, nt_model *model)
{
	nt_model_material m = {
		.name = from->name,
		.normal_scale = from->normal_scale,
		.ior = from->ior,
		.anisotropy = images ? clamp01(from->anisotropy) : 0,
		.anisotropy_rotation = from->anisotropy_rotation,
		.sheen_roughness = from->sheen_roughness,
		.emissive_texture = texture_of(images, &from->emissive_map),
		.normal_texture = texture_of(images, &from->normal_map),
		.occlusion_texture = texture_of(images, &from->occlusion_map),
	};
	take_base_color(from, images, &m);
	take_color(from->emissive, &m.emissive_texture, INFINITY, m.emissive);
	nt_model_use metallic, roughness;
	m.metallic = factor_of(images, &from->metallic_map, from->metallic, &metallic);
	m.roughness = factor_of(images, &from->roughness_map, from->roughness, &roughness);
	m.metallic_roughness_texture = metallic.texture != NT_MODEL_NONE ? metallic : roughness;
	m.clearcoat = factor_of(images, &from->clearcoat_map, from->clearcoat, &m.clearcoat_texture);
	m.clearcoat_roughness = factor_of(images, &from->clearcoat_roughness_map, from->clearcoat_roughness,
		&m.clearcoat_roughness_texture);
	m.sheen = factor_of(images, &from->sheen_map, from->sheen, &m.sheen_texture);
	return nt_model_add_material(model, &m);
}
