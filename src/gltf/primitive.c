/* SPDX-License-Identifier: MIT */
/*
 * Primitives and the accessors they name.
 */
#include "gltf/document.h"


bool nt_gltf_is_solved(const nt_mesh *mesh)
{
	return mesh->split.vertex_tangents != NULL || mesh->merged;
}

nt_json_value *nt_gltf_primitive_of(const nt_gltf *document, const nt_mesh *mesh)
{
	const nt_json_value *json =
		nt_json_at(nt_gltf_root_member(document, "meshes"), mesh->gltf_mesh);
	return nt_json_at(nt_json_find(json, "primitives"), mesh->gltf_primitive);
}

uint64_t nt_gltf_mode(const nt_json_value *primitive)
{
	uint64_t mode = NT_GLTF_TRIANGLES;
	nt_json_find_uint64(primitive, "mode", &mode);
	return mode;
}

size_t nt_gltf_vertex_bytes(const nt_gltf *document, const nt_json_value *primitive)
{
	size_t bytes = nt_json_find(nt_json_find(primitive, "attributes"), "TANGENT") ? 0 : 4 * sizeof(float);
	for (nt_gltf_use u = {0}; nt_gltf_next_use(document, primitive, &u) && !u.object;) {
		const nt_gltf_accessor *a = nt_gltf_sound_accessor(document, u.accessor);
		bytes += a ? a->element_bytes : 0;
	}
	return bytes;
}

void nt_gltf_drop_extension(nt_json *json, nt_json_value *object, const char *name)
{
	nt_json_value *extensions = nt_json_find(object, "extensions");
	nt_json_remove(json, extensions, name);
	if (nt_json_count(extensions) == 0)
		nt_json_remove(json, object, "extensions");
}

bool nt_gltf_next_use(const nt_gltf *document, const nt_json_value *primitive, nt_gltf_use *use)
{
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	for (; use->object <= nt_json_count(targets); use->object++, use->member = 0) {
		use->attributes = use->object ? nt_json_at(targets, use->object - 1)
			: nt_json_find(primitive, "attributes");
		while (use->member < nt_json_count(use->attributes)) {
			uint64_t accessor;
			const nt_json_value *reference = nt_json_at(use->attributes, use->member);
			use->name = nt_json_key(use->attributes, use->member++, NULL);
			if (use->name && nt_json_get_uint64(reference, &accessor) &&
				accessor < document->accessor_count) {
				use->accessor = (uint32_t)accessor;
				return true;
			}
		}
	}
	return false;
}

uint32_t nt_gltf_reference(const nt_gltf *document, const nt_json_value *object, const char *name)
{
	uint64_t accessor;
	return nt_json_find_uint64(object, name, &accessor) && accessor < document->accessor_count ? (uint32_t)accessor
		: NT_NONE;
}

const nt_gltf_accessor *nt_gltf_sound_accessor(const nt_gltf *document, uint32_t index)
{
	const bool sound = index < document->accessor_count && document->accessors[index].index != NT_NONE;
	return sound ? &document->accessors[index] : NULL;
}
