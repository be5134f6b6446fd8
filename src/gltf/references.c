/* SPDX-License-Identifier: MIT */
/*
 * References to accessors, views and buffers: one table of the places where glTF 2.0 and the extensions that are in use
 * have them, gone through once. It says how often an accessor is an attribute or indices, whether something else has
 * it, and which views hold images and Draco blocks.
 *
 * A faulty file may refer to accessors, views or buffers that it does not have, where nobody looks: in a mesh of no
 * scene, a skin, an image. Elements that an edit adds take the next numbers, and such a reference would come to mean
 * it. So the lowest number of each kind that is referred to in vain is noted before anything is added, and the file
 * is refused if it is taken. Elements of other arrays (images, materials ...) are never added.
 */
#include "gltf/document.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const arrays[NT_GLTF_GROWING] = {[NT_GLTF_ACCESSORS] = "accessors",
	[NT_GLTF_VIEWS] = "bufferViews", [NT_GLTF_BUFFERS] = "buffers"};

/* The meaning of a reference to those that edit bytes. */
typedef enum use {
	KNOWN, /* nothing: its element is there to be kept as it is */
	ATTRIBUTE,
	INDICES,
	FOREIGN, /* by its elements, as something else than vertices */
	IMAGE,
	BLOCK
} use;

/* A place of references: keys from the root on, * for every element or member. */
typedef struct place {
	const char *path;
	nt_gltf_growing kind; /* of what is referred to */
	use use;
} place;

/* Names that begin alike stand together: it is looked up once. */
static const place places[] = {
	{"accessors/*/bufferView", NT_GLTF_VIEWS, KNOWN},
	{"accessors/*/sparse/indices/bufferView", NT_GLTF_VIEWS, KNOWN},
	{"accessors/*/sparse/values/bufferView", NT_GLTF_VIEWS, KNOWN},
	{"animations/*/samplers/*/input", NT_GLTF_ACCESSORS, FOREIGN},
	{"animations/*/samplers/*/output", NT_GLTF_ACCESSORS, FOREIGN},
	{"bufferViews/*/buffer", NT_GLTF_BUFFERS, KNOWN},
	{"bufferViews/*/extensions/EXT_meshopt_compression/buffer", NT_GLTF_BUFFERS, KNOWN},
	{"bufferViews/*/extensions/KHR_meshopt_compression/buffer", NT_GLTF_BUFFERS, KNOWN},
	{"images/*/bufferView", NT_GLTF_VIEWS, IMAGE},
	{"meshes/*/primitives/*/attributes/*", NT_GLTF_ACCESSORS, ATTRIBUTE},
	{"meshes/*/primitives/*/indices", NT_GLTF_ACCESSORS, INDICES},
	{"meshes/*/primitives/*/targets/*/*", NT_GLTF_ACCESSORS, ATTRIBUTE},
	{"meshes/*/primitives/*/extensions/CESIUM_primitive_outline/indices", NT_GLTF_ACCESSORS, KNOWN},
	{"meshes/*/primitives/*/extensions/EXT_mesh_primitive_edge_visibility/visibility", NT_GLTF_ACCESSORS, KNOWN},
	{"meshes/*/primitives/*/extensions/EXT_mesh_primitive_edge_visibility/silhouetteNormals",
		NT_GLTF_ACCESSORS, KNOWN},
	{"meshes/*/primitives/*/extensions/EXT_mesh_primitive_edge_visibility/lineStrings/*/indices",
		NT_GLTF_ACCESSORS, KNOWN},
	{"meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", NT_GLTF_VIEWS, BLOCK},
	{"meshes/*/primitives/*/extensions/KHR_gaussian_splatting/extensions/KHR_gaussian_splatting_compression_spz_2/"
		"bufferView", NT_GLTF_VIEWS, KNOWN},
	{"meshes/*/extensions/EXT_mesh_manifold/manifoldPrimitive/attributes/*", NT_GLTF_ACCESSORS, KNOWN},
	{"meshes/*/extensions/EXT_mesh_manifold/manifoldPrimitive/indices", NT_GLTF_ACCESSORS, KNOWN},
	{"meshes/*/extensions/EXT_mesh_manifold/mergeIndices", NT_GLTF_ACCESSORS, KNOWN},
	{"meshes/*/extensions/EXT_mesh_manifold/mergeValues", NT_GLTF_ACCESSORS, KNOWN},
	{"meshes/*/extensions/EXT_mesh_primitive_restart/primitiveGroups/*/indices", NT_GLTF_ACCESSORS, KNOWN},
	{"nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", NT_GLTF_ACCESSORS, FOREIGN},
	{"skins/*/inverseBindMatrices", NT_GLTF_ACCESSORS, FOREIGN},
	{"extensions/EXT_feature_metadata/featureTables/*/properties/*/bufferView", NT_GLTF_VIEWS, KNOWN},
	{"extensions/EXT_feature_metadata/featureTables/*/properties/*/arrayOffsetBufferView", NT_GLTF_VIEWS, KNOWN},
	{"extensions/EXT_feature_metadata/featureTables/*/properties/*/stringOffsetBufferView", NT_GLTF_VIEWS, KNOWN},
	{"extensions/EXT_lights_ies/lights/*/bufferView", NT_GLTF_VIEWS, KNOWN},
	{"extensions/EXT_structural_metadata/propertyTables/*/properties/*/values", NT_GLTF_VIEWS, KNOWN},
	{"extensions/EXT_structural_metadata/propertyTables/*/properties/*/arrayOffsets", NT_GLTF_VIEWS, KNOWN},
	{"extensions/EXT_structural_metadata/propertyTables/*/properties/*/stringOffsets", NT_GLTF_VIEWS, KNOWN},
	{"extensions/KHR_audio/audio/*/bufferView", NT_GLTF_VIEWS, KNOWN},
	{"extensions/KHR_audio_emitter/audio/*/bufferView", NT_GLTF_VIEWS, KNOWN},
};

enum { STARS = 4 }; /* at most, in a path */

#define MEMBER SIZE_MAX /* a star that stands for the member of an object */

static size_t count_in_file(const nt_gltf *document, nt_gltf_growing kind)
{
	return kind == NT_GLTF_ACCESSORS ? document->file_accessor_count :
		kind == NT_GLTF_VIEWS ? document->view_count : document->buffer_count;
}

static void count_use(nt_gltf *document, uint64_t number, use how)
{
	switch (how) {
	case ATTRIBUTE:
		document->users[number].attributes++;
		break;
	case INDICES:
		document->users[number].indices++;
		document->users[number].foreign = true;
		break;
	case FOREIGN:
		document->users[number].foreign = true;
		break;
	case IMAGE:
		document->view_users[number].image = true;
		break;
	case BLOCK:
		document->view_users[number].blocks++;
		break;
	case KNOWN:
		break;
	}
}

/* The pointer of a reference ends where a key of the file would come, which may be of any length. */
static void note_dangling(nt_gltf_dangling *lowest, uint64_t number, const char *path, const size_t *numbers)
{
	size_t length = 0;
	lowest->number = number;
	for (const char *key = path; *key && (*key != '*' || *numbers != MEMBER);) {
		const size_t key_length = strcspn(key, "/");
		const size_t room = sizeof lowest->pointer - length;
		length += (size_t)(*key == '*' ? snprintf(lowest->pointer + length, room, "/%zu", *numbers++) :
			snprintf(lowest->pointer + length, room, "/%.*s", (int)key_length, key));
		key += key_length + (key[key_length] == '/');
	}
}

/* numbers: [STARS] what the path's stars stand for. */
static void note(nt_gltf *document, const nt_json_value *reference, const place *at, const size_t *numbers)
{
	uint64_t number;
	if (!nt_json_get_uint64(reference, &number))
		return;
	const size_t count = at->kind == NT_GLTF_ACCESSORS && document->users ? document->accessor_count
									      : count_in_file(document, at->kind);
	if (number < count && document->users)
		count_use(document, number, at->use);
	else if (number >= count && !document->dangling_known && number < document->dangling[at->kind].number)
		note_dangling(&document->dangling[at->kind], number, at->path, numbers);
}

/* Looks at the places from `from` to before `end`, which all begin with the path of the value, of `skip` bytes. `star`
 * of its numbers are known. */
static void look_at(nt_gltf *document, const nt_json_value *value, const place *from, const place *end, size_t skip,
	size_t *numbers, size_t star)
{
	while (from < end) {
		const char *const key = from->path + skip;
		const size_t length = strcspn(key, "/");
		const place *next = from + 1;
		while (next < end && strncmp(next->path + skip, key, length + 1) == 0)
			next++;
		const bool is_star = *key == '*';
		const size_t count = is_star ? nt_json_count(value) : 1;
		for (size_t i = 0; i < count; i++) {
			const nt_json_value *child = is_star
				? nt_json_at(value, i) : nt_json_find_key(value, key, length);
			if (is_star)
				numbers[star] = nt_json_type_of(value) == NT_JSON_ARRAY ? i : MEMBER;
			if (!key[length])
				note(document, child, from, numbers);
			else if (child)
				look_at(document, child, from, next, skip + length + 1, numbers, star + is_star);
		}
		from = next;
	}
}

static void look_at_all(nt_gltf *document)
{
	size_t numbers[STARS] = {0};
	for (size_t i = 0; !document->dangling_known && i < NT_GLTF_GROWING; i++)
		document->dangling[i].number = UINT64_MAX;
	look_at(document, nt_json_root(document->json), places, places + sizeof places / sizeof *places, 0, numbers, 0);
	document->dangling_known = true;
}

void nt_gltf_find_dangling(nt_gltf *document)
{
	if (!document->dangling_known)
		look_at_all(document);
}

nt_status nt_gltf_find_users(nt_gltf *document, nt_error *error)
{
	if (nt_gltf_read_arrays(document, error) || nt_gltf_find_same_bytes(document, error))
		return NT_ERROR_MEMORY;
	document->users = nt_calloc(document->accessor_count, sizeof *document->users);
	document->view_users = nt_calloc(document->view_count, sizeof *document->view_users);
	if (!document->users || !document->view_users)
		return nt_fail_memory(error);
	look_at_all(document);
	/* the first accessor over the same bytes, which comes before them, has the users of all */
	for (uint32_t i = 0; i < document->accessor_count; i++) {
		const nt_gltf_users own = document->users[i];
		nt_gltf_users *all = &document->users[nt_gltf_same(document, i)];
		if (&document->users[i] != all) {
			all->attributes += own.attributes;
			all->indices += own.indices;
			all->foreign |= own.foreign;
		}
		all->idle |= !own.attributes && !own.indices && !own.foreign;
	}
	return NT_OK;
}

nt_status nt_gltf_check_dangling(const nt_gltf *document, nt_error *error)
{
	for (nt_gltf_growing kind = 0; document->dangling_known && kind < NT_GLTF_GROWING; kind++) {
		const nt_gltf_dangling *lowest = &document->dangling[kind];
		if (lowest->number < nt_json_count(nt_gltf_root_member(document, arrays[kind])))
			return nt_gltf_check_index(arrays[kind], lowest->number, count_in_file(document, kind),
				lowest->pointer, error);
	}
	return NT_OK;
}
