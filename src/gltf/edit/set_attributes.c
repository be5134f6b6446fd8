/* SPDX-License-Identifier: MIT */
/*
 * Attributes that a tangent set gets, and the accessors of that name that are there already: which of them take the
 * values.
 *
 * An accessor that only the meshes of one set use so keeps its number; one that several sets use goes to the last of
 * them. An accessor that others use too stays, and a new accessor is appended. Unused bytes remain in one case:
 * interleaved elements that become larger leave their slots, since without these the attributes beside them would need
 * another stride.
 */
#include "gltf/bytes/bytes.h"
#include "gltf/edit/pool_edit.h"

#include <string.h>
#include "base/vec.h"
#include "gltf/document.h"

/* The accessor that a user has by that name; NT_NONE: none. */
static uint32_t accessor_of(const nt_gltf *document, const nt_vertex_pool *pool, size_t user, const char *name)
{
	return nt_gltf_reference(document, nt_json_find(nt_pool_primitive(pool, user), "attributes"), name);
}

/* Whether the meshes of this set are the last that use an accessor, and do so as this attribute alone. */
static bool is_own(const nt_buffer_edits *edits, uint32_t same, uint32_t components)
{
	const nt_gltf_users *users = &edits->document->users[same];
	const nt_gltf_accessor *a = nt_gltf_sound_accessor(edits->document, same);
	return a && a->components == components && !users->foreign && !users->idle &&
		edits->accessors[same].replaced == users->attributes;
}

nt_status nt_set_attribute_settle(nt_buffer_edits *edits, const nt_vertex_pool *pool, uint32_t set,
	nt_set_attribute *attribute, nt_override_list *overrides, nt_error *error)
{
	const nt_gltf *document = edits->document;
	attribute->accessor = attribute->view = NT_NONE;
	attribute->first_own = (uint32_t)overrides->count + 1;
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i]) {
		const uint32_t accessor = accessor_of(document, pool, i, attribute->name);
		if (accessor != NT_NONE)
			edits->accessors[nt_gltf_same(document, accessor)].replaced++;
	}
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i]) {
		const uint32_t accessor = accessor_of(document, pool, i, attribute->name);
		const uint32_t same = accessor == NT_NONE ? NT_NONE : nt_gltf_same(document, accessor);
		if (same == NT_NONE || edits->accessors[same].override || !is_own(edits, same, attribute->components))
			continue;
		if (!nt_grow((void **)&overrides->items, &overrides->capacity, overrides->count + 1,
			    sizeof *overrides->items))
			return nt_fail_memory(error);
		overrides->items[overrides->count++] = attribute;
		edits->accessors[same].override = (uint32_t)overrides->count;
		attribute->own_count++;
		attribute->accessor = same < attribute->accessor ? same : attribute->accessor;
	}
	return NT_OK;
}

void nt_gltf_drop_elements(nt_buffer_edits *edits, uint32_t accessor)
{
	static const char *const gone[] = {"bufferView", "byteOffset", "sparse"};
	nt_gltf *document = edits->document;
	nt_edits_leave_accessor(edits, accessor);
	for (uint32_t k = nt_gltf_same(document, accessor); k != NT_NONE; k = document->accessors[k].next) {
		edits->accessors[k].seen = true;
		for (size_t i = 0; i < sizeof gone / sizeof *gone; i++)
			nt_json_remove(document->json, nt_gltf_accessor_json(document, k), gone[i]);
	}
}

/* ---- writing ---- */

uint32_t nt_gltf_new_accessor(nt_json *json, uint32_t view, uint32_t component_type, const char *type,
	size_t count, bool normalized)
{
	nt_json_value *accessors = nt_json_put(json, nt_json_root(json), "accessors");
	const uint32_t number = (uint32_t)nt_json_count(accessors);
	nt_json_value *object = nt_json_append(json, accessors);
	if (view != NT_NONE)
		nt_json_put_uint64(json, object, "bufferView", view);
	nt_json_put_uint64(json, object, "componentType", component_type);
	if (normalized)
		nt_json_set_bool(json, nt_json_put(json, object, "normalized"), true);
	nt_json_put_uint64(json, object, "count", count);
	nt_json_set_string(json, nt_json_put(json, object, "type"), type, strlen(type));
	return number;
}

nt_status nt_set_attribute_place(nt_buffer_edits *edits, uint32_t buffer, nt_set_attribute *attribute, size_t count,
	bool several, nt_error *error)
{
	const nt_stored_tangents *values = &attribute->values;
	nt_gltf_packing packing = values->packing;
	packing.view.filter = values->filter.filter;
	packing.view.stride = values->element_bytes;
	/* a view of several accessors has to say how far apart elements are */
	return attribute->view != NT_NONE ? NT_OK : nt_packed_add(edits, buffer, &packing, values->stored,
		count * values->element_bytes, NT_GLTF_ARRAY_BUFFER, several ? (uint32_t)values->element_bytes : 0,
		&attribute->view, &attribute->offset, error);
}

nt_status nt_set_attribute_write(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	uint32_t set, nt_set_attribute *attribute, nt_error *error)
{
	nt_gltf *document = edits->document;
	nt_json *json = document->json;
	const nt_vertex_pool *pool = vertices->pool;
	const uint32_t type = nt_precision_component_type(attribute->values.filter.precision);
	if (attribute->accessor == NT_NONE) {
		const nt_status status = nt_set_attribute_place(edits, buffer, attribute, vertices->new_count, false,
			error);
		if (status)
			return status;
		attribute->accessor = nt_gltf_new_accessor(json, attribute->view, type,
			attribute->components == 3 ? "VEC3" : "VEC4", vertices->new_count, type != NT_GLTF_FLOAT);
		nt_gltf_set_number(json, nt_gltf_accessor_json(document, attribute->accessor), "byteOffset",
			attribute->offset);
	}
	/* meshes that have none of the set's own get it */
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i]) {
		const uint32_t old = accessor_of(document, pool, i, attribute->name);
		const uint32_t number = old == NT_NONE ? 0 : edits->accessors[nt_gltf_same(document, old)].override;
		if (number < attribute->first_own || number - attribute->first_own >= attribute->own_count)
			nt_json_put_uint64(json, nt_json_find(nt_pool_primitive(pool, i), "attributes"),
				attribute->name, attribute->accessor);
	}
	return NT_OK;
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
