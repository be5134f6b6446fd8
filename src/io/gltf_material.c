/* SPDX-License-Identifier: MIT */
/*
 * What the materials of a primitive ask of tangents. A primitive has its own material, one per variant
 * (KHR_materials_variants) and one per level of detail (MSFT_lod on a material); tangents must serve
 * them all, so slots are united. Texture coordinates come from the first slot that names a texture:
 * normalTexture, then the clearcoat normal, then anisotropy.
 */
#include "io/gltf_document.h"

#include <stdio.h>
#include <string.h>

/* What all materials together want, per slot. */
typedef struct wishes {
	bool wants[3]; /* in the order of enum nt_slot: the slot names a texture */
	uint32_t set[3];
	bool mixed[3]; /* materials differ in the set of that slot */
	uint32_t mixed_set[3];
	unsigned slots;
	size_t material_count, unlit_count;
} wishes;

/* The texture coordinate set of a textureInfo; KHR_texture_transform overrides it. */
static nmtan_status read_set(const nt_json_value *texture, const char *pointer, uint64_t *set,
	nt_error *error)
{
	if (nt_json_type_of(texture) != NT_JSON_OBJECT)
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer, "%s, expected an object",
			nt_json_type_text(texture));
	nmtan_status status = nt_gltf_uint(texture, pointer, "texCoord", 1000, 0, set, error);
	if (status)
		return status;
	char place[NT_GLTF_POINTER * 2];
	snprintf(place, sizeof place, "%s/extensions/KHR_texture_transform", pointer);
	const nt_json_value *transform =
		nt_json_find(nt_json_find(texture, "extensions"), "KHR_texture_transform");
	return nt_gltf_uint(transform, place, "texCoord", 1000, *set, set, error);
}

static nmtan_status note_texture(wishes *all, int slot, const nt_json_value *texture,
	const char *material, const char *path, nt_error *error)
{
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "%s/%s", material, path);
	uint64_t set;
	const nmtan_status status = read_set(texture, pointer, &set, error);
	if (status)
		return status;
	all->slots |= 1u << slot;
	if (all->wants[slot] && all->set[slot] != set) {
		all->mixed[slot] = true;
		all->mixed_set[slot] = (uint32_t)set;
	} else if (!all->wants[slot]) {
		all->wants[slot] = true;
		all->set[slot] = (uint32_t)set;
	}
	return NMTAN_OK;
}

static nmtan_status note_slots(wishes *all, const nt_json_value *material, const char *pointer,
	nt_error *error)
{
	const nt_json_value *extensions = nt_json_find(material, "extensions");
	if (nt_json_find(extensions, "KHR_materials_unlit")) {
		all->unlit_count++;
		return NMTAN_OK;
	}
	const nt_json_value *normal = nt_json_find(material, "normalTexture");
	const nt_json_value *clearcoat = nt_json_find(
		nt_json_find(extensions, "KHR_materials_clearcoat"), "clearcoatNormalTexture");
	const nt_json_value *anisotropy = nt_json_find(extensions, "KHR_materials_anisotropy");
	const nt_json_value *direction = nt_json_find(anisotropy, "anisotropyTexture");
	nmtan_status status = NMTAN_OK;
	if (normal)
		status = note_texture(all, 0, normal, pointer, "normalTexture", error);
	if (!status && clearcoat)
		status = note_texture(all, 1, clearcoat, pointer,
			"extensions/KHR_materials_clearcoat/clearcoatNormalTexture", error);
	if (!status && anisotropy)
		all->slots |= NT_SLOT_ANISOTROPY;
	if (!status && direction)
		status = note_texture(all, 2, direction, pointer,
			"extensions/KHR_materials_anisotropy/anisotropyTexture", error);
	return status;
}

static nmtan_status note_material(nt_gltf *document, wishes *all, uint64_t index, const char *from,
	bool levels, nt_error *error)
{
	const nt_json_value *material;
	nmtan_status status = nt_gltf_element(document, "materials", index, from, &material, error);
	if (status)
		return status;
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "/materials/%llu", (unsigned long long)index);
	all->material_count++;
	status = note_slots(all, material, pointer, error);
	const nt_json_value *ids = nt_json_find(
		nt_json_find(nt_json_find(material, "extensions"), "MSFT_lod"), "ids");
	for (size_t i = 0; !status && levels && i < nt_json_count(ids); i++) {
		uint64_t id;
		if (nt_json_get_uint64(nt_json_at(ids, i), &id))
			status = note_material(document, all, id, pointer, false, error);
	}
	return status;
}

static nmtan_status note_variants(nt_gltf *document, wishes *all, const nt_json_value *primitive,
	const char *pointer, nt_error *error)
{
	const nt_json_value *mappings = nt_json_find(
		nt_json_find(nt_json_find(primitive, "extensions"), "KHR_materials_variants"), "mappings");
	for (size_t i = 0; i < nt_json_count(mappings); i++) {
		char place[NT_GLTF_POINTER];
		snprintf(place, sizeof place, "%.90s/extensions/KHR_materials_variants/mappings/%zu",
			pointer, i);
		uint64_t index;
		nmtan_status status = nt_gltf_uint(nt_json_at(mappings, i), place, "material",
			UINT32_MAX - 1, NT_GLTF_REQUIRED, &index, error);
		if (!status)
			status = note_material(document, all, index, place, true, error);
		if (status)
			return status;
	}
	return NMTAN_OK;
}

/* One set must serve all: the first slot that names a texture wins, what differs is a conflict. */
static void choose_set(const wishes *all, nt_gltf_shading *shading)
{
	for (int slot = 0; slot < 3; slot++) {
		if (!all->wants[slot])
			continue;
		if (!shading->has_set) {
			shading->has_set = true;
			shading->set = all->set[slot];
			shading->set_slot = 1u << slot;
		}
		if (!shading->conflict && all->set[slot] != shading->set) {
			shading->conflict = true;
			shading->other_set = all->set[slot];
		} else if (!shading->conflict && all->mixed[slot]) {
			shading->conflict = true;
			shading->other_set = all->mixed_set[slot];
		}
	}
}

nmtan_status nt_gltf_judge_materials(nt_gltf *document, const nt_json_value *primitive,
	const char *pointer, nt_gltf_shading *shading, nt_error *error)
{
	*shading = (nt_gltf_shading){.material = NT_NONE};
	wishes all = {0};
	uint64_t index;
	nmtan_status status = nt_gltf_uint(primitive, pointer, "material", UINT32_MAX, NT_NONE, &index,
		error);
	if (!status && index != NT_NONE) {
		shading->material = (uint32_t)index;
		status = note_material(document, &all, index, pointer, true, error);
	}
	if (!status)
		status = note_variants(document, &all, primitive, pointer, error);
	if (status)
		return status;
	shading->slots = all.slots;
	shading->unlit = all.material_count > 0 && all.unlit_count == all.material_count;
	choose_set(&all, shading);
	return NMTAN_OK;
}
