/* SPDX-License-Identifier: MIT */
/*
 * Accessors that a document did not have: for attributes that nmtan computes, over new views, and the members of
 * primitives and morph targets that name them.
 */
#include "gltf/edit/new_accessors.h"

#include <string.h>
#include "base/vec.h"
#include "gltf/primitive.h"

uint32_t nt_gltf_new_accessor(nt_gltf_patcher *p, uint32_t view, uint32_t component_type, const char *type,
	size_t count, bool normalized)
{
	nt_json *json = p->json;
	nt_json_value *accessors = nt_json_put(json, nt_json_root(json), "accessors");
	const uint32_t number = (uint32_t)nt_json_count(accessors);
	nt_json_value *object = nt_json_append(json, accessors);
	if (view != NT_NONE)
		nt_json_set_uint64(json, nt_json_put(json, object, "bufferView"), view);
	nt_json_set_uint64(json, nt_json_put(json, object, "componentType"), component_type);
	if (normalized)
		nt_json_set_bool(json, nt_json_put(json, object, "normalized"), true);
	nt_json_set_uint64(json, nt_json_put(json, object, "count"), count);
	nt_json_set_string(json, nt_json_put(json, object, "type"), type, strlen(type));
	return number;
}

nt_status nt_gltf_add_attribute(nt_gltf_patcher *p, uint32_t buffer, const void *rows, size_t count,
	size_t row_bytes, uint32_t component_type, const char *type, uint32_t *accessor)
{
	uint32_t view;
	const nt_status status = nt_edits_add_view(&p->edits, buffer, rows, count * row_bytes,
		NT_GLTF_ARRAY_BUFFER, 0, &view, p->error);
	if (!status)
		*accessor = nt_gltf_new_accessor(p, view, component_type, type, count,
			component_type != NT_GLTF_FLOAT);
	return status;
}

nt_status nt_gltf_add_floats(nt_gltf_patcher *p, uint32_t buffer, const float *rows, size_t count,
	uint32_t width, uint32_t *accessor)
{
	return nt_gltf_add_attribute(p, buffer, rows, count, width * sizeof(float), NT_GLTF_FLOAT,
		width == 3 ? "VEC3" : "VEC4", accessor);
}

void nt_gltf_set_attribute(nt_gltf_patcher *p, const nt_gltf_cluster *component, uint32_t group,
	const char *name, uint32_t accessor)
{
	const nt_gltf_rows *rows = &component->rows;
	for (uint32_t i = rows->group_first[group]; i != NT_NONE; i = rows->next_of[i]) {
		nt_json_value *attributes = nt_json_find(nt_gltf_primitive_of(p->document,
			&p->scene->meshes[component->members[i]]), "attributes");
		nt_json_set_uint64(p->json, nt_json_put(p->json, attributes, name), accessor);
	}
}

const nt_mesh *nt_gltf_first_of_group(const nt_gltf_patcher *p, const nt_gltf_cluster *component,
	uint32_t group)
{
	return &p->scene->meshes[component->members[component->rows.group_first[group]]];
}

nt_status nt_gltf_bitangents(nt_gltf_patcher *p, const nt_gltf_cluster *component, uint32_t group,
	float **result)
{
	const nt_gltf_rows *rows = &component->rows;
	const nt_mesh *mesh = nt_gltf_first_of_group(p, component, group);
	float *out = nt_arena_alloc(p->arena, rows->new_count, 3 * sizeof *out);
	*result = out;
	if (!out)
		return nt_fail_memory(p->error);
	for (size_t row = 0; row < rows->new_count; row++) {
		const uint32_t source = row < rows->old_count ? (uint32_t)row :
								rows->sources[row - rows->old_count];
		const float *n = rows->normals[group] ? rows->normals[group] + 3 * row :
							mesh->normals + 3 * (size_t)source;
		const float *t = rows->tangents[group] + 4 * row;
		const nt_vec3 b = nt_vec3_scale(t[3], nt_vec3_cross((nt_vec3){n[0], n[1], n[2]},
			(nt_vec3){t[0], t[1], t[2]}));
		memcpy(out + 3 * row, &b, 3 * sizeof *out);
	}
	return NT_OK;
}

/* A target of every mesh of the group gets an attribute. */
static void set_target(nt_gltf_patcher *p, const nt_gltf_cluster *component, uint32_t group,
	uint32_t target, const char *name, uint32_t accessor)
{
	const nt_gltf_rows *rows = &component->rows;
	for (uint32_t i = rows->group_first[group]; i != NT_NONE; i = rows->next_of[i]) {
		nt_json_value *attributes = nt_json_at(nt_json_find(nt_gltf_primitive_of(p->document,
			&p->scene->meshes[component->members[i]]), "targets"), target);
		nt_json_set_uint64(p->json, nt_json_put(p->json, attributes, name), accessor);
	}
}

nt_status nt_gltf_add_morphs(nt_gltf_patcher *p, const nt_gltf_cluster *component, uint32_t group)
{
	const nt_gltf_rows *rows = &component->rows;
	const nt_mesh *mesh = nt_gltf_first_of_group(p, component, group);
	nt_status status = NT_OK;
	for (size_t m = 0; !status && m < mesh->morph_count; m++) {
		float *delta = nt_arena_alloc(p->arena, rows->new_count, 3 * sizeof *delta);
		uint32_t accessor = 0;
		if (!delta)
			return nt_fail_memory(p->error);
		for (size_t row = 0; row < rows->new_count; row++)
			for (size_t k = 0; k < 3; k++)
				delta[3 * row + k] = rows->morphs[group][m][3 * row + k] -
					rows->tangents[group][4 * row + k];
		status = nt_gltf_add_floats(p, component->buffer, delta, rows->new_count, 3, &accessor);
		if (!status)
			set_target(p, component, group, mesh->morphs[m].target, "TANGENT", accessor);
	}
	return status;
}
