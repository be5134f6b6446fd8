/* SPDX-License-Identifier: MIT */
/*
 * Accessors that a document did not have: for attributes that nmtan computes, over new views, and the members of
 * primitives and morph targets that name them.
 */
#include "gltf/edit/new_accessors.h"

#include <string.h>
#include "base/vec.h"
#include "gltf/accessor.h"

uint32_t nt_gltf_new_accessor(nt_json *json, uint32_t view, uint32_t component_type, const char *type,
	size_t count, bool normalized)
{
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

nt_status nt_gltf_add_attribute(nt_buffer_edits *edits, uint32_t buffer, const void *elements, size_t count,
	size_t element_bytes, uint32_t component_type, const char *type, uint32_t *accessor, nt_error *error)
{
	uint32_t view;
	const nt_status status = nt_edits_add_view(edits, buffer, elements, count * element_bytes,
		NT_GLTF_ARRAY_BUFFER, 0, &view, error);
	if (!status)
		*accessor = nt_gltf_new_accessor(edits->document->json, view, component_type, type, count,
			component_type != NT_GLTF_FLOAT);
	return status;
}

nt_status nt_gltf_add_floats(nt_buffer_edits *edits, uint32_t buffer, const float *elements, size_t count,
	uint32_t width, uint32_t *accessor, nt_error *error)
{
	return nt_gltf_add_attribute(edits, buffer, elements, count, width * sizeof(float), NT_GLTF_FLOAT,
		width == 3 ? "VEC3" : "VEC4", accessor, error);
}

void nt_gltf_set_attribute(nt_json *json, const nt_vertex_pool *pool, uint32_t set, const char *name,
	uint32_t accessor)
{
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i])
		nt_json_set_uint64(json, nt_json_put(json, nt_json_find(nt_pool_primitive(pool, i), "attributes"),
			name), accessor);
}

nt_status nt_gltf_bitangents(const nt_pool_vertices *vertices, uint32_t set, nt_arena *arena, float **result,
	nt_error *error)
{
	const nt_pool_set *of = &vertices->sets[set];
	const nt_mesh *mesh = nt_pool_set_mesh(vertices->pool, set);
	const float *loaded = of->source_normals ? of->source_normals : mesh->normals;
	float *out = nt_arena_alloc(arena, vertices->new_count, 3 * sizeof *out);
	*result = out;
	if (!out)
		return nt_fail_memory(error);
	for (size_t v = 0; v < vertices->new_count; v++)
		nt_bitangent(of->normals ? of->normals + 3 * v : loaded + 3 * nt_vertex_source(vertices, v),
			of->tangents + 4 * v, out + 3 * v);
	return NT_OK;
}

/* A target of every mesh of the set gets an attribute. */
static void set_target(nt_json *json, const nt_vertex_pool *pool, uint32_t set, uint32_t target, const char *name,
	uint32_t accessor)
{
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i]) {
		nt_json_value *attributes =
			nt_json_at(nt_json_find(nt_pool_primitive(pool, i), "targets"), target);
		nt_json_set_uint64(json, nt_json_put(json, attributes, name), accessor);
	}
}

/* Whether a target has these deltas already in all meshes of the set: then nothing has to be written. */
static nt_status find_deltas(nt_buffer_edits *edits, const nt_pool_vertices *vertices, uint32_t set, uint32_t target,
	const float *delta, bool *found)
{
	const nt_vertex_pool *pool = vertices->pool;
	nt_status status = NT_OK;
	*found = vertices->new_count == vertices->old_count;
	for (uint32_t i = pool->sets.first[set]; *found && i != NT_NONE; i = pool->sets.next[i]) {
		const nt_json_value *attributes =
			nt_json_at(nt_json_find(nt_pool_primitive(pool, i), "targets"), target);
		uint64_t index;
		nt_gltf_accessor accessor;
		float *old;
		*found = nt_json_get_uint64(nt_json_find(attributes, "TANGENT"), &index) &&
			 nt_gltf_get_accessor(edits->document, index, "", &accessor, NULL) == NT_OK &&
			 accessor.component_type == NT_GLTF_FLOAT && accessor.components == 3 &&
			 accessor.count == vertices->new_count;
		if (*found)
			status = nt_gltf_floats(edits->document, &accessor, 3, 0, &edits->arena, &old, NULL);
		*found = *found && !status && memcmp(old, delta, vertices->new_count * 3 * sizeof *old) == 0;
	}
	return status == NT_ERROR_MEMORY ? status : NT_OK;
}

nt_status nt_gltf_add_morphs(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	uint32_t set, nt_error *error)
{
	const nt_mesh *mesh = nt_pool_set_mesh(vertices->pool, set);
	const float *base = vertices->sets[set].tangents;
	nt_status status = NT_OK;
	for (size_t m = 0; !status && m < mesh->morph_count; m++) {
		const float *moved = vertices->sets[set].morphs[m];
		float *delta = nt_arena_alloc(&edits->arena, vertices->new_count, 3 * sizeof *delta);
		uint32_t accessor = 0;
		if (!delta)
			return nt_fail_memory(error);
		for (size_t v = 0; v < vertices->new_count; v++)
			for (size_t k = 0; k < 3; k++)
				delta[3 * v + k] = nt_morph_delta(moved[3 * v + k], base[4 * v + k]);
		bool found;
		if (find_deltas(edits, vertices, set, mesh->morphs[m].target, delta, &found))
			return nt_fail_memory(error);
		if (!found)
			status = nt_gltf_add_floats(edits, buffer, delta, vertices->new_count, 3, &accessor, error);
		if (!status && !found)
			set_target(edits->document->json, vertices->pool, set, mesh->morphs[m].target, "TANGENT",
				accessor);
	}
	return status;
}
