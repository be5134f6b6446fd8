/* SPDX-License-Identifier: MIT */
/*
 * A faulty file may refer to accessors, views or buffers that it does not have, where nobody looks: in a mesh of no
 * scene, a skin, an image. Elements that an edit adds take the next numbers, and such a reference would come to mean
 * it. So the lowest number of each kind that is referred to in vain is noted before anything is added, and the file
 * is refused if it is taken. Known are the places below: those of glTF 2.0 and of the extensions that are in use.
 * Elements of other arrays (images, materials ...) are never added.
 */
#include "gltf/document.h"

#include <stdio.h>
#include <string.h>

static const char *const arrays[NT_GLTF_GROWING] = {[NT_GLTF_ACCESSORS] = "accessors",
	[NT_GLTF_VIEWS] = "bufferViews", [NT_GLTF_BUFFERS] = "buffers"};

/* A place of references: keys from the root on, * for every element or member. */
typedef struct place {
	const char *path;
	nt_gltf_growing kind; /* of what is referred to */
} place;

/* Names that begin alike stand together: it is looked up once. */
static const place places[] = {
	{"accessors/*/bufferView", NT_GLTF_VIEWS},
	{"accessors/*/sparse/indices/bufferView", NT_GLTF_VIEWS},
	{"accessors/*/sparse/values/bufferView", NT_GLTF_VIEWS},
	{"animations/*/samplers/*/input", NT_GLTF_ACCESSORS},
	{"animations/*/samplers/*/output", NT_GLTF_ACCESSORS},
	{"bufferViews/*/buffer", NT_GLTF_BUFFERS},
	{"bufferViews/*/extensions/EXT_meshopt_compression/buffer", NT_GLTF_BUFFERS},
	{"bufferViews/*/extensions/KHR_meshopt_compression/buffer", NT_GLTF_BUFFERS},
	{"images/*/bufferView", NT_GLTF_VIEWS},
	{"meshes/*/primitives/*/attributes/*", NT_GLTF_ACCESSORS},
	{"meshes/*/primitives/*/indices", NT_GLTF_ACCESSORS},
	{"meshes/*/primitives/*/targets/*/*", NT_GLTF_ACCESSORS},
	{"meshes/*/primitives/*/extensions/CESIUM_primitive_outline/indices", NT_GLTF_ACCESSORS},
	{"meshes/*/primitives/*/extensions/EXT_mesh_primitive_edge_visibility/visibility", NT_GLTF_ACCESSORS},
	{"meshes/*/primitives/*/extensions/EXT_mesh_primitive_edge_visibility/silhouetteNormals", NT_GLTF_ACCESSORS},
	{"meshes/*/primitives/*/extensions/EXT_mesh_primitive_edge_visibility/lineStrings/*/indices",
		NT_GLTF_ACCESSORS},
	{"meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", NT_GLTF_VIEWS},
	{"meshes/*/primitives/*/extensions/KHR_gaussian_splatting/extensions/KHR_gaussian_splatting_compression_spz_2/"
		"bufferView", NT_GLTF_VIEWS},
	{"meshes/*/extensions/EXT_mesh_manifold/manifoldPrimitive/attributes/*", NT_GLTF_ACCESSORS},
	{"meshes/*/extensions/EXT_mesh_manifold/manifoldPrimitive/indices", NT_GLTF_ACCESSORS},
	{"meshes/*/extensions/EXT_mesh_manifold/mergeIndices", NT_GLTF_ACCESSORS},
	{"meshes/*/extensions/EXT_mesh_manifold/mergeValues", NT_GLTF_ACCESSORS},
	{"meshes/*/extensions/EXT_mesh_primitive_restart/primitiveGroups/*/indices", NT_GLTF_ACCESSORS},
	{"nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*", NT_GLTF_ACCESSORS},
	{"skins/*/inverseBindMatrices", NT_GLTF_ACCESSORS},
	{"extensions/EXT_feature_metadata/featureTables/*/properties/*/bufferView", NT_GLTF_VIEWS},
	{"extensions/EXT_feature_metadata/featureTables/*/properties/*/arrayOffsetBufferView", NT_GLTF_VIEWS},
	{"extensions/EXT_feature_metadata/featureTables/*/properties/*/stringOffsetBufferView", NT_GLTF_VIEWS},
	{"extensions/EXT_lights_ies/lights/*/bufferView", NT_GLTF_VIEWS},
	{"extensions/EXT_structural_metadata/propertyTables/*/properties/*/values", NT_GLTF_VIEWS},
	{"extensions/EXT_structural_metadata/propertyTables/*/properties/*/arrayOffsets", NT_GLTF_VIEWS},
	{"extensions/EXT_structural_metadata/propertyTables/*/properties/*/stringOffsets", NT_GLTF_VIEWS},
	{"extensions/KHR_audio/audio/*/bufferView", NT_GLTF_VIEWS},
	{"extensions/KHR_audio_emitter/audio/*/bufferView", NT_GLTF_VIEWS},
};

enum { STARS = 4 }; /* at most, in a path */

#define MEMBER SIZE_MAX /* a star that stands for the member of an object */

static size_t count_in_file(const nt_gltf *document, nt_gltf_growing kind)
{
	return kind == NT_GLTF_ACCESSORS ? document->file_accessor_count :
		kind == NT_GLTF_VIEWS ? document->view_count : document->buffer_count;
}

/* numbers: [STARS] what the path's stars stand for. */
static void note(nt_gltf *document, const nt_json_value *reference, const place *at, const size_t *numbers)
{
	nt_gltf_dangling *lowest = &document->dangling[at->kind];
	uint64_t number;
	if (!nt_json_get_uint64(reference, &number) || number < count_in_file(document, at->kind) ||
		number >= lowest->number)
		return;
	lowest->number = number;
	/* The pointer ends where a key of the file would come, which may be of any length. */
	size_t length = 0;
	for (const char *key = at->path; *key && (*key != '*' || *numbers != MEMBER);) {
		const size_t key_length = strcspn(key, "/");
		const size_t room = sizeof lowest->pointer - length;
		length += (size_t)(*key == '*' ? snprintf(lowest->pointer + length, room, "/%zu", *numbers++) :
			snprintf(lowest->pointer + length, room, "/%.*s", (int)key_length, key));
		key += key_length + (key[key_length] == '/');
	}
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

void nt_gltf_find_dangling(nt_gltf *document)
{
	if (document->dangling_known)
		return;
	document->dangling_known = true;
	for (size_t i = 0; i < NT_GLTF_GROWING; i++)
		document->dangling[i].number = UINT64_MAX;
	size_t numbers[STARS] = {0};
	look_at(document, nt_json_root(document->json), places, places + sizeof places / sizeof *places, 0, numbers, 0);
}

nt_status nt_gltf_check_dangling(const nt_gltf *document, nt_error *error)
{
	for (nt_gltf_growing kind = 0; document->dangling_known && kind < NT_GLTF_GROWING; kind++) {
		const nt_gltf_dangling *lowest = &document->dangling[kind];
		if (lowest->number < nt_json_count(nt_gltf_root_member(document, arrays[kind])))
			return nt_fail_pointer(error, NT_ERROR_INPUT, lowest->pointer,
				"refers to %s[%llu], there are %zu",
				arrays[kind], (unsigned long long)lowest->number, count_in_file(document, kind));
	}
	return NT_OK;
}
