/* SPDX-License-Identifier: MIT */
/*
 * Demands of a primitive's materials on tangents. A primitive has its own material, one per variant
 * (KHR_materials_variants) and one per level of detail (MSFT_lod on a material); tangents must serve
 * them all, so slots are united. Texture coordinates come from the first slot that names a texture:
 * normalTexture, then the clearcoat normal, then anisotropy.
 */
#include "gltf/materials.h"

#include <stdio.h>
#include <string.h>
#include "gltf/document.h"

/* Demands of all materials together, per slot. */
typedef struct wishes {
	bool wants[3]; /* in the order of enum nt_slot: the slot names a texture */
	uint32_t set[3];
	bool mixed[3]; /* materials differ in the set of that slot */
	uint32_t mixed_set[3];
	nt_gltf_transform transform[3];
	nt_wrap wrap[3][2];
	bool mixed_transform[3];
	unsigned slots;
	size_t material_count, unlit_count;
} wishes;

static nt_status read_number(const nt_json_value *value, const char *pointer, const char *key,
	double *number, nt_error *error)
{
	if (!value || nt_json_get_double(value, number))
		return NT_OK;
	char place[NT_GLTF_POINTER * 2];
	snprintf(place, sizeof place, "%.250s/%s", pointer, key);
	return nt_fail_pointer(error, NT_ERROR_INPUT, place, "%s, expected a number",
		nt_json_type_text(value));
}

/* Two numbers of a transform, where it has them. */
static nt_status read_pair(const nt_json_value *transform, const char *pointer, const char *key, double numbers[2],
	nt_error *error)
{
	const nt_json_value *pair = nt_json_find(transform, key);
	nt_status status = NT_OK;
	for (size_t k = 0; !status && k < 2 && pair; k++)
		status = read_number(nt_json_count(pair) == 2 ? nt_json_at(pair, k) : pair, pointer, key, &numbers[k],
			error);
	return status;
}

/* Lists the transforms that an animation turns or scales (KHR_animation_pointer). */
static nt_status find_animated(nt_gltf *document, nt_error *error)
{
	static const char *const members[] = {"/rotation", "/scale"};
	const nt_json_value *animations = nt_gltf_root_member(document, "animations");
	if (document->animated_known)
		return NT_OK;
	for (size_t i = 0; i < nt_json_count(animations); i++) {
		const nt_json_value *channels = nt_json_find(nt_json_at(animations, i), "channels");
		for (size_t k = 0; k < nt_json_count(channels); k++) {
			const nt_json_value *extensions = nt_json_find(
				nt_json_find(nt_json_at(channels, k), "target"), "extensions");
			size_t length = 0;
			const char *target = nt_json_find_string(nt_json_find(extensions, "KHR_animation_pointer"),
				"pointer", &length);
			for (size_t m = 0; m < 2 && target; m++) {
				const size_t end = strlen(members[m]);
				if (length > end && memcmp(target + length - end, members[m], end) == 0 &&
					nt_name_add(&document->animated, target, length - end) == UINT32_MAX)
					return nt_fail_memory(error);
			}
		}
	}
	document->animated_known = true;
	return NT_OK;
}

/* The transform of a textureInfo, and the texture coordinate set, which it may override. */
static nt_status read_transform(nt_gltf *document, const nt_json_value *texture,
	const char *pointer, nt_gltf_transform *transform, uint64_t *set, nt_error *error)
{
	char place[NT_GLTF_POINTER * 2];
	*transform = (nt_gltf_transform){.uv = {.scale = {1, 1}}};
	const nt_json_value *json =
		nt_json_find(nt_json_find(texture, "extensions"), "KHR_texture_transform");
	if (!json)
		return NT_OK;
	snprintf(place, sizeof place, "%s/extensions/KHR_texture_transform", pointer);
	nt_status status = nt_gltf_uint(json, place, "texCoord", 1000, *set, set, error);
	nt_uv_transform *uv = &transform->uv;
	if (!status)
		status = read_number(nt_json_find(json, "rotation"), place, "rotation", &uv->rotation, error);
	if (!status)
		status = read_pair(json, place, "scale", uv->scale, error);
	if (!status)
		status = read_pair(json, place, "offset", uv->offset, error);
	uv->offset[1] = -uv->offset[1];
	if (document->keeps_transforms) {
		uv->rotation = 0;
		uv->scale[0] = uv->scale[1] = 1;
		return status;
	}
	if (!status)
		status = find_animated(document, error);
	transform->animated = nt_name_find(&document->animated, place, strlen(place)) != UINT32_MAX;
	transform->turns = transform->animated || uv->rotation != 0 || uv->scale[0] != 1 || uv->scale[1] != 1;
	return status;
}

static bool same_transform(const nt_gltf_transform *a, const nt_gltf_transform *b)
{
	return a->uv.rotation == b->uv.rotation && a->uv.scale[0] == b->uv.scale[0] &&
	       a->uv.scale[1] == b->uv.scale[1];
}

static const nt_json_value *element_of(const nt_gltf *document, const char *array, const nt_json_value *index)
{
	uint64_t i;
	return nt_json_get_uint64(index, &i) ? nt_json_at(nt_gltf_root_member(document, array), (size_t)i) : NULL;
}

/* The wrap modes of the texture that a textureInfo names; a missing or unknown one repeats, as glTF has it. */
static void read_wrap(const nt_gltf *document, const nt_json_value *info, nt_wrap wrap[2])
{
	const nt_json_value *texture = element_of(document, "textures", nt_json_find(info, "index"));
	const nt_json_value *sampler = element_of(document, "samplers", nt_json_find(texture, "sampler"));
	for (int axis = 0; axis < 2; axis++) {
		uint64_t mode = 0;
		nt_json_find_uint64(sampler, axis ? "wrapT" : "wrapS", &mode);
		wrap[axis] = mode == NT_GLTF_CLAMP_TO_EDGE ? NT_WRAP_CLAMP
			: mode == NT_GLTF_MIRRORED_REPEAT ? NT_WRAP_MIRRORED
						  : NT_WRAP_REPEAT;
	}
}

/* Adds the demands of another material of a primitive. */
static void unite(wishes *all, const wishes *more)
{
	for (int slot = 0; slot < 3; slot++) {
		if (!more->wants[slot])
			continue;
		if (!all->wants[slot]) {
			all->wants[slot] = true;
			all->set[slot] = more->set[slot];
			all->transform[slot] = more->transform[slot];
			memcpy(all->wrap[slot], more->wrap[slot], sizeof all->wrap[slot]);
		}
		if (all->set[slot] != more->set[slot] || more->mixed[slot]) {
			all->mixed[slot] = true;
			all->mixed_set[slot] = all->set[slot] != more->set[slot] ? more->set[slot]
				: more->mixed_set[slot];
		}
		all->mixed_transform[slot] |= more->mixed_transform[slot] ||
			!same_transform(&all->transform[slot], &more->transform[slot]);
		all->transform[slot].animated |= more->transform[slot].animated;
	}
	all->slots |= more->slots;
	all->material_count += more->material_count;
	all->unlit_count += more->unlit_count;
}

/* A material samples this set in the slot. */
static void note_use(wishes *all, int slot, uint32_t set, const nt_gltf_transform *transform, const nt_wrap wrap[2])
{
	wishes one = {0};
	one.wants[slot] = true;
	one.set[slot] = set;
	one.transform[slot] = *transform;
	memcpy(one.wrap[slot], wrap, sizeof one.wrap[slot]);
	unite(all, &one);
}

static nt_status note_texture(nt_gltf *document, wishes *all, int slot,
	const nt_json_value *texture, const char *material, const char *path, nt_error *error)
{
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "%s/%s", material, path);
	if (nt_json_type_of(texture) != NT_JSON_OBJECT)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer, "%s, expected an object",
			nt_json_type_text(texture));
	uint64_t set;
	nt_gltf_transform transform;
	nt_status status = nt_gltf_uint(texture, pointer, "texCoord", 1000, 0, &set, error);
	if (!status)
		status = read_transform(document, texture, pointer, &transform, &set, error);
	if (status)
		return status;
	nt_wrap wrap[2];
	all->slots |= 1u << slot;
	read_wrap(document, texture, wrap);
	note_use(all, slot, (uint32_t)set, &transform, wrap);
	return NT_OK;
}

/* VRM 0: the root says what MToon samples, whatever the material says for other shaders. A normal map lies as the main
 * texture does, whose vector is an offset and a scale. Returns whether the material has one. */
static bool note_vrm_map(const nt_gltf *document, wishes *all, uint64_t index)
{
	const nt_json_value *vrm = nt_json_find(nt_gltf_root_member(document, "extensions"), "VRM");
	const nt_json_value *material = nt_json_at(nt_json_find(vrm, "materialProperties"), (size_t)index);
	if (!nt_json_find(nt_json_find(material, "textureProperties"), "_BumpMap"))
		return false;
	const nt_json_value *vector = nt_json_find(nt_json_find(material, "vectorProperties"), "_MainTex");
	nt_gltf_transform transform = {.uv = {.scale = {1, 1}}};
	for (size_t k = 0; k < 2 && nt_json_count(vector) == 4 && !document->keeps_transforms; k++)
		nt_json_get_double(nt_json_at(vector, 2 + k), &transform.uv.scale[k]);
	transform.turns = transform.uv.scale[0] != 1 || transform.uv.scale[1] != 1;
	all->slots |= NT_SLOT_NORMAL;
	note_use(all, 0, 0, &transform, (nt_wrap[2]){NT_WRAP_REPEAT, NT_WRAP_REPEAT});
	return true;
}

static nt_status note_slots(nt_gltf *document, wishes *all, const nt_json_value *material, uint64_t index,
	const char *pointer, nt_error *error)
{
	const nt_json_value *extensions = nt_json_find(material, "extensions");
	if (note_vrm_map(document, all, index))
		return NT_OK;
	/* MToon of VRM 1 takes precedence over its fallback */
	if (nt_json_find(extensions, "KHR_materials_unlit") && !nt_json_find(extensions, "VRMC_materials_mtoon")) {
		all->unlit_count++;
		return NT_OK;
	}
	const nt_json_value *normal = nt_json_find(material, "normalTexture");
	const nt_json_value *clearcoat = nt_json_find(
		nt_json_find(extensions, "KHR_materials_clearcoat"), "clearcoatNormalTexture");
	const nt_json_value *anisotropy = nt_json_find(extensions, "KHR_materials_anisotropy");
	const nt_json_value *direction = nt_json_find(anisotropy, "anisotropyTexture");
	nt_status status = NT_OK;
	if (normal)
		status = note_texture(document, all, 0, normal, pointer, "normalTexture", error);
	if (!status && clearcoat)
		status = note_texture(document, all, 1, clearcoat, pointer,
			"extensions/KHR_materials_clearcoat/clearcoatNormalTexture", error);
	if (!status && anisotropy)
		all->slots |= NT_SLOT_ANISOTROPY;
	if (!status && direction)
		status = note_texture(document, all, 2, direction, pointer,
			"extensions/KHR_materials_anisotropy/anisotropyTexture", error);
	return status;
}

static nt_status note_material(nt_gltf *document, wishes *all, uint64_t index, const char *from,
	bool levels, nt_error *error);

/* A material with its levels of detail, which are many: they are read once, however many primitives have it. */
static nt_status note_levels(nt_gltf *document, wishes *all, uint64_t index, const nt_json_value *ids, const char *from,
	nt_error *error)
{
	if (!document->lod_wishes)
		document->lod_wishes = nt_calloc(nt_json_count(nt_gltf_root_member(document, "materials")),
			sizeof *document->lod_wishes);
	if (!document->lod_wishes)
		return nt_fail_memory(error);
	wishes *known = document->lod_wishes[index];
	if (!known) {
		known = nt_arena_alloc(&document->arena, 1, sizeof *known);
		if (!known)
			return nt_fail_memory(error);
		*known = (wishes){0};
		nt_status status = note_material(document, known, index, from, false, error);
		for (size_t i = 0; !status && i < nt_json_count(ids); i++) {
			char pointer[NT_GLTF_POINTER];
			uint64_t id;
			nt_gltf_pointer(pointer, "materials", index);
			if (nt_json_get_uint64(nt_json_at(ids, i), &id))
				status = note_material(document, known, id, pointer, false, error);
		}
		if (status)
			return status;
		document->lod_wishes[index] = known;
	}
	unite(all, known);
	return NT_OK;
}

static nt_status note_material(nt_gltf *document, wishes *all, uint64_t index, const char *from,
	bool levels, nt_error *error)
{
	const nt_json_value *material;
	nt_status status = nt_gltf_element(document, "materials", index, from, &material, error);
	if (status)
		return status;
	const nt_json_value *ids = !levels ? NULL
		: nt_json_find(nt_json_find(nt_json_find(material, "extensions"), "MSFT_lod"), "ids");
	if (nt_json_count(ids))
		return note_levels(document, all, index, ids, from, error);
	char pointer[NT_GLTF_POINTER];
	nt_gltf_pointer(pointer, "materials", index);
	all->material_count++;
	return note_slots(document, all, material, index, pointer, error);
}

static nt_status note_variants(nt_gltf *document, wishes *all, const nt_json_value *primitive,
	const char *pointer, nt_error *error)
{
	const nt_json_value *mappings = nt_json_find(
		nt_json_find(nt_json_find(primitive, "extensions"), "KHR_materials_variants"), "mappings");
	for (size_t i = 0; i < nt_json_count(mappings); i++) {
		char place[NT_GLTF_POINTER];
		snprintf(place, sizeof place, "%.90s/extensions/KHR_materials_variants/mappings/%zu",
			pointer, i);
		uint64_t index;
		nt_status status = nt_gltf_uint(nt_json_at(mappings, i), place, "material",
			UINT32_MAX - 1, NT_GLTF_REQUIRED, &index, error);
		if (!status)
			status = note_material(document, all, index, place, true, error);
		if (status)
			return status;
	}
	return NT_OK;
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
			shading->transform = all->transform[slot];
			memcpy(shading->wrap, all->wrap[slot], sizeof shading->wrap);
			shading->transforms_differ = all->mixed_transform[slot];
		}
		if (all->set[slot] == shading->set &&
			!same_transform(&all->transform[slot], &shading->transform))
			shading->transforms_differ = true;
		if (!shading->conflict && all->set[slot] != shading->set) {
			shading->conflict = true;
			shading->other_set = all->set[slot];
		} else if (!shading->conflict && all->mixed[slot]) {
			shading->conflict = true;
			shading->other_set = all->mixed_set[slot];
		}
	}
}

nt_status nt_gltf_find_slots(nt_gltf *document, const nt_json_value *primitive,
	const char *pointer, nt_gltf_shading *shading, nt_error *error)
{
	*shading = (nt_gltf_shading){.material = NT_NONE};
	wishes all = {0};
	uint64_t index;
	nt_status status = nt_gltf_uint(primitive, pointer, "material", UINT32_MAX, NT_NONE, &index,
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
	return NT_OK;
}
