/* SPDX-License-Identifier: MIT */
/*
 * Demands of a primitive's materials on tangents. A primitive has its own material, one per variant
 * (KHR_materials_variants) and one per level of detail (MSFT_lod on a material); tangents must serve
 * them all, so slots are united. A material is read once, however many primitives have it. Texture coordinates come
 * from the first slot that names a texture: normalTexture, then the clearcoat normal, then anisotropy.
 */
#include "gltf/load.h"

#include <stdio.h>
#include <string.h>
#include "base/text.h"
#include "scene/values.h"

/* Demands of a slot. */
typedef struct demand {
	bool wanted; /* some material has a texture in it */
	bool mixed;  /* materials differ in the set: mixed_set is another */
	bool mixed_transform;
	bool turns;    /* the transform does something to directions: more than an offset */
	bool animated;
	uint32_t set, mixed_set;
	nt_uv_transform transform; /* KHR_texture_transform, for v up */
	nt_wrap wrap[2];
} demand;

/* The demands of a material, with its levels of detail, or of several. */
typedef struct nt_gltf_material {
	demand demands[3]; /* in the order of enum nt_slot */
	unsigned slots;
	uint32_t sets; /* bits: those of the first 32 sets that something is looked up with, textures of any kind */
	size_t count, unlit_count; /* of the materials */
} nt_gltf_material;

static nt_status read_number(const nt_json_value *value, const char *pointer, const char *key,
	double *number, nt_error *error)
{
	if (!value || nt_json_get_double(value, number))
		return NT_OK;
	char place[NT_GLTF_POINTER * 2];
	snprintf(place, sizeof place, "%.*s/%s", NT_CUT(250, pointer), key);
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
static nt_status read_transform(nt_gltf *document, const nt_json_value *texture, const char *pointer, demand *d,
	uint64_t *set, nt_error *error)
{
	char place[NT_GLTF_POINTER * 2];
	const nt_json_value *json =
		nt_json_find(nt_json_find(texture, "extensions"), "KHR_texture_transform");
	if (!json)
		return NT_OK;
	snprintf(place, sizeof place, "%s/extensions/KHR_texture_transform", pointer);
	nt_status status = nt_gltf_uint(json, place, "texCoord", 1000, *set, set, error);
	nt_uv_transform *uv = &d->transform;
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
	d->animated = nt_name_find(&document->animated, place, strlen(place)) != UINT32_MAX;
	d->turns = d->animated || uv->rotation != 0 || uv->scale[0] != 1 || uv->scale[1] != 1;
	return status;
}

static bool same_transform(const demand *a, const demand *b)
{
	return a->transform.rotation == b->transform.rotation && a->transform.scale[0] == b->transform.scale[0] &&
	       a->transform.scale[1] == b->transform.scale[1];
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

/* Adds what another material wants of the slot. */
static void unite_demands(demand *all, const demand *more)
{
	if (!all->wanted) {
		*all = *more;
		return;
	}
	if (!more->wanted)
		return;
	if (all->set != more->set || more->mixed) {
		all->mixed = true;
		all->mixed_set = all->set != more->set ? more->set : more->mixed_set;
	}
	all->mixed_transform |= more->mixed_transform || !same_transform(all, more);
	all->animated |= more->animated;
}

static void unite(nt_gltf_material *all, const nt_gltf_material *more)
{
	for (int slot = 0; slot < 3; slot++)
		unite_demands(&all->demands[slot], &more->demands[slot]);
	all->slots |= more->slots;
	all->sets |= more->sets;
	all->count += more->count;
	all->unlit_count += more->unlit_count;
}

static const demand untransformed = {.wanted = true, .transform = {.scale = {1, 1}}};

static nt_status note_texture(nt_gltf *document, nt_gltf_material *all, int slot,
	const nt_json_value *texture, const char *material, const char *path, nt_error *error)
{
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "%s/%s", material, path);
	uint64_t set;
	demand d = untransformed;
	nt_status status = nt_gltf_check_object(texture, pointer, error);
	if (!status)
		status = nt_gltf_uint(texture, pointer, "texCoord", 1000, 0, &set, error);
	if (!status)
		status = read_transform(document, texture, pointer, &d, &set, error);
	if (status)
		return status;
	d.set = (uint32_t)set;
	read_wrap(document, texture, d.wrap);
	all->slots |= 1u << slot;
	unite_demands(&all->demands[slot], &d);
	return NT_OK;
}

/* VRM 0: the root says what MToon samples, whatever the material says for other shaders. A normal map lies as the main
 * texture does, whose vector is an offset and a scale. Returns whether the material has one. */
static bool note_vrm_map(const nt_gltf *document, nt_gltf_material *all, uint64_t index)
{
	const nt_json_value *vrm = nt_json_find(nt_gltf_root_member(document, "extensions"), "VRM");
	const nt_json_value *material = nt_json_at(nt_json_find(vrm, "materialProperties"), (size_t)index);
	if (!nt_json_find(nt_json_find(material, "textureProperties"), "_BumpMap"))
		return false;
	const nt_json_value *vector = nt_json_find(nt_json_find(material, "vectorProperties"), "_MainTex");
	demand d = untransformed;
	for (size_t k = 0; k < 2 && nt_json_count(vector) == 4 && !document->keeps_transforms; k++)
		nt_json_get_double(nt_json_at(vector, 2 + k), &d.transform.scale[k]);
	d.turns = d.transform.scale[0] != 1 || d.transform.scale[1] != 1;
	d.wrap[0] = d.wrap[1] = NT_WRAP_REPEAT;
	all->slots |= NT_SLOT_NORMAL;
	all->sets |= 1;
	unite_demands(&all->demands[0], &d);
	return true;
}

static nt_status note_slots(nt_gltf *document, nt_gltf_material *all, const nt_json_value *material, uint64_t index,
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
	if (!status && anisotropy) {
		all->slots |= NT_SLOT_ANISOTROPY;
		all->sets |= !direction; /* without a texture its direction is that of the first set */
	}
	if (!status && direction)
		status = note_texture(document, all, 2, direction, pointer,
			"extensions/KHR_materials_anisotropy/anisotropyTexture", error);
	return status;
}

/* The sets that textures of a material are looked up with: every "...Texture" in it, of extensions, too, but not of
 * extras. */
static uint32_t textured_sets(const nt_json_value *value)
{
	uint32_t sets = 0;
	if (nt_json_type_of(value) != NT_JSON_OBJECT)
		return 0;
	for (size_t i = 0; i < nt_json_count(value); i++) {
		size_t length;
		const char *key = nt_json_key(value, i, &length);
		const nt_json_value *member = nt_json_at(value, i);
		if (length < 6 || memcmp(key + length - 6, "exture", 6) != 0 || !nt_json_find(member, "index")) {
			if (length != 6 || memcmp(key, "extras", 6) != 0)
				sets |= textured_sets(member);
			continue;
		}
		uint64_t set = 0;
		nt_json_find_uint64(member, "texCoord", &set);
		nt_json_find_uint64(nt_json_find(nt_json_find(member, "extensions"), "KHR_texture_transform"),
			"texCoord", &set);
		sets |= set < 32 ? UINT32_C(1) << set : 0;
	}
	return sets;
}

/* A material without its levels of detail. */
static nt_status read_material(nt_gltf *document, nt_gltf_material *all, uint64_t index, const char *from,
	nt_error *error)
{
	const nt_json_value *material;
	char pointer[NT_GLTF_POINTER];
	const nt_status status = nt_gltf_element(document, "materials", index, from, &material, error);
	if (status)
		return status;
	nt_gltf_pointer(pointer, "materials", index);
	all->count++;
	all->sets |= textured_sets(material);
	return note_slots(document, all, material, index, pointer, error);
}

/* Adds the demands of a material of a primitive. */
static nt_status note_material(nt_gltf *document, nt_gltf_material *all, uint64_t index, const char *from,
	nt_error *error)
{
	const nt_json_value *material;
	nt_status status = nt_gltf_element(document, "materials", index, from, &material, error);
	if (status)
		return status;
	if (!document->materials)
		document->materials = nt_calloc(nt_json_count(nt_gltf_root_member(document, "materials")),
			sizeof *document->materials);
	const nt_gltf_material *known = document->materials ? document->materials[index] : NULL;
	if (!known) {
		nt_gltf_material *read =
			document->materials ? nt_arena_alloc(&document->arena, 1, sizeof *read) : NULL;
		char pointer[NT_GLTF_POINTER];
		const nt_json_value *ids = nt_json_find(nt_json_find(nt_json_find(material, "extensions"), "MSFT_lod"),
			"ids");
		uint64_t id;
		if (!read)
			return nt_fail_memory(error);
		*read = (nt_gltf_material){.count = 0};
		nt_gltf_pointer(pointer, "materials", index);
		status = read_material(document, read, index, from, error);
		for (size_t i = 0; !status && i < nt_json_count(ids); i++)
			if (nt_json_get_uint64(nt_json_at(ids, i), &id))
				status = read_material(document, read, id, pointer, error);
		if (status)
			return status;
		document->materials[index] = known = read;
	}
	unite(all, known);
	return NT_OK;
}

static nt_status note_variants(nt_gltf *document, nt_gltf_material *all, const nt_json_value *primitive,
	const char *pointer, nt_error *error)
{
	const nt_json_value *mappings = nt_json_find(
		nt_json_find(nt_json_find(primitive, "extensions"), "KHR_materials_variants"), "mappings");
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < nt_json_count(mappings); i++) {
		char place[NT_GLTF_POINTER];
		snprintf(place, sizeof place, "%.*s/extensions/KHR_materials_variants/mappings/%zu",
			NT_CUT(90, pointer), i);
		uint64_t index;
		status = nt_gltf_uint(nt_json_at(mappings, i), place, "material", UINT32_MAX - 1, NT_GLTF_REQUIRED,
			&index, error);
		if (!status)
			status = note_material(document, all, index, place, error);
	}
	return status;
}

/* ---- texture coordinates ---- */

/* The sentence about a set that the user asks for and that is not there; NULL if there is none at all. */
static nt_status describe_asked_set(nt_scene *scene, nt_mesh *mesh, const nt_json_value *attributes, nt_error *error)
{
	enum { MOST_SETS = 32 };
	char name[32];
	nt_buffer sets = {0}, text = {0};
	for (uint32_t set = 0; set < MOST_SETS; set++) {
		nt_gltf_put_number(nt_gltf_put_text(name, "TEXCOORD_"), set);
		if (nt_json_find(attributes, name))
			nt_buffer_format(&sets, "%s%u", sets.size ? ", " : "", set);
	}
	if (sets.size)
		nt_buffer_format(&text, "--uv asks for set %u; sets of the mesh: %s", mesh->texcoord_set, sets.data);
	mesh->asked_set = text.size ? nt_arena_text(&scene->arena, text.data, text.size) : NULL;
	const bool failed = sets.failed || text.failed || (text.size && !mesh->asked_set);
	nt_buffer_free(&sets);
	nt_buffer_free(&text);
	return failed ? nt_fail_memory(error) : NT_OK;
}

/* The texture coordinates that tangents follow. One set must serve all slots: that of the first that has a texture, or
 * the one that the user asks for. If another slot has another set, that is a conflict. */
static nt_status choose_set(nt_scene *scene, nt_mesh *mesh, const nt_gltf_material *all,
	const nt_json_value *attributes, int asked, nt_error *error)
{
	const demand *first = NULL;
	char name[32];
	bool conflict = false, differ = false;
	for (int slot = 0; slot < 3; slot++) {
		const demand *d = &all->demands[slot];
		if (!d->wanted)
			continue;
		first = first ? first : d;
		differ |= (d == first && d->mixed_transform) || (d->set == first->set && !same_transform(d, first));
		if (!conflict && (d->set != first->set || d->mixed)) {
			conflict = true;
			mesh->texcoord_other_set = d->set != first->set ? d->set : d->mixed_set;
		}
	}
	mesh->texcoord_set = asked >= 0 ? (uint32_t)asked : first ? first->set : 0;
	mesh->texcoord_conflict = conflict && asked < 0;
	mesh->untextured = mesh->texcoord_set < 32 && !(all->sets >> mesh->texcoord_set & 1);
	nt_gltf_put_number(nt_gltf_put_text(name, "TEXCOORD_"), mesh->texcoord_set);
	mesh->has_texcoords = nt_json_find(attributes, name) != NULL;
	mesh->texcoords_transformed = first && (differ || first->animated || first->turns);
	const bool follows = first && first->set == mesh->texcoord_set;
	mesh->transforms_differ = follows && mesh->has_texcoords && differ;
	mesh->transform_animated = follows && mesh->has_texcoords && first->animated;
	for (int axis = 0; first && axis < 2; axis++) {
		mesh->wrap[axis] = first->wrap[axis];
		mesh->wrap_offset[axis] =
			first->wrap[axis] == NT_WRAP_MIRRORED ? (float)first->transform.offset[axis] : 0;
	}
	if (follows && first->turns) {
		nt_uv_transform *kept = nt_arena_alloc(&scene->arena, 1, sizeof *kept);
		if (!kept)
			return nt_fail_memory(error);
		*kept = first->transform;
		mesh->transform = kept;
	}
	return asked < 0 || mesh->has_texcoords ? NT_OK : describe_asked_set(scene, mesh, attributes, error);
}

nt_status nt_gltf_describe_materials(nt_scene *scene, nt_mesh *mesh, const nt_json_value *primitive,
	const char *pointer, const nt_read_options *options, nt_error *error)
{
	nt_gltf *document = scene->source;
	nt_gltf_material all = {.count = 0};
	uint64_t index;
	nt_status status = nt_gltf_uint(primitive, pointer, "material", UINT32_MAX, NT_NONE, &index,
		error);
	if (!status && index != NT_NONE)
		status = note_material(document, &all, index, pointer, error);
	if (!status)
		status = note_variants(document, &all, primitive, pointer, error);
	if (status)
		return status;
	mesh->gltf_material = (uint32_t)index;
	mesh->gltf_material_name = nt_json_find_string(nt_json_at(nt_gltf_root_member(document, "materials"),
		(size_t)index), "name", NULL);
	mesh->slots = all.slots;
	mesh->unlit = all.count > 0 && all.unlit_count == all.count;
	return choose_set(scene, mesh, &all, nt_json_find(primitive, "attributes"), options->texcoord_set, error);
}
