/* SPDX-License-Identifier: MIT */
/*
 * EXT_mesh_manifold when vertices of its primitives are copied: the indices of all primitives go to one new view, as
 * the extension demands, and so do those of the manifold, which differ where its sparse accessor says so. All of
 * them get new accessors, since others may use the old ones.
 */
#include "gltf/edit/manifold.h"

#include <stdio.h>
#include <string.h>
#include "base/largest.h"
#include "gltf/accessor.h"
#include "gltf/edit/new_accessors.h"
#include "gltf/extensions/extensions.h"

static const char name[] = "EXT_mesh_manifold";

static void report(nt_scene *scene, const nt_mesh *mesh, const char *obstacle)
{
	nt_place place;
	nt_mesh_place(mesh, &place);
	snprintf(place.pointer, sizeof place.pointer, "/meshes/%u/extensions/%s", mesh->gltf_mesh, name);
	nt_finding_add(&scene->findings, NT_CODE_EXTENSION_STALE, &place, 1, "%s, %s,", name, obstacle);
}

/* Puts the corners that primitives have now in their places. Returns whether there are as many as before. */
static bool take_corners(nt_manifold *m, const nt_pool_vertices *vertices, size_t first, size_t last)
{
	const nt_vertex_pool *pool = vertices->pool;
	for (size_t i = first; i < last; i++) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		if (!vertices->changed[i])
			continue;
		if (mesh->corner_count != m->count[mesh->gltf_primitive])
			return false;
		memcpy(m->corners + m->first[mesh->gltf_primitive], vertices->indices[i],
			mesh->corner_count * sizeof *m->corners);
	}
	return true;
}

/* A view of numbers, as a type has them. */
static nt_status add_numbers(nt_buffer_edits *edits, uint32_t buffer, const uint32_t *numbers, size_t count,
	uint32_t type, uint32_t target, uint32_t *view, nt_error *error)
{
	const uint32_t width = nt_gltf_component_bytes(type);
	unsigned char *bytes = nt_arena_alloc(&edits->arena, count, width);
	if (!bytes)
		return nt_fail_memory(error);
	nt_gltf_store_indices(numbers, count, width, bytes);
	return nt_edits_add_view(edits, buffer, bytes, count * width, target, 0, view, error);
}

/* The indices of every primitive, over the new view. */
static void move_primitives(nt_json *json, nt_json_value *primitives, const nt_manifold *m, uint32_t view,
	uint32_t type)
{
	for (size_t i = 0; i < m->primitive_count; i++) {
		const uint32_t number = nt_gltf_new_accessor(json, view, type, "SCALAR", m->count[i], false);
		nt_json_value *accessor = nt_json_at(nt_json_find(nt_json_root(json), "accessors"), number);
		if (m->first[i])
			nt_json_set_uint64(json, nt_json_put(json, accessor, "byteOffset"),
				m->first[i] * nt_gltf_component_bytes(type));
		nt_json_set_uint64(json, nt_json_put(json, nt_json_at(primitives, i), "indices"), number);
	}
}

/* Names an array of numbers as the extension has it twice: in the sparse accessor, and by an accessor. */
static void set_sparse_array(nt_json *json, nt_json_value *extension, uint32_t manifold, const char *list,
	const char *key, uint32_t view, uint32_t type, size_t count)
{
	const uint32_t number = nt_gltf_new_accessor(json, view, type, "SCALAR", count, false);
	nt_json_value *accessor = nt_json_at(nt_json_find(nt_json_root(json), "accessors"), manifold);
	nt_json_value *object = nt_json_put(json, nt_json_put(json, accessor, "sparse"), list);
	nt_json_set_uint64(json, nt_json_put(json, object, "bufferView"), view);
	if (strcmp(list, "indices") == 0)
		nt_json_set_uint64(json, nt_json_put(json, object, "componentType"), type);
	nt_json_set_uint64(json, nt_json_put(json, extension, key), number);
}

/* The manifold over the same view, with the merges that it needs now. */
static nt_status move_manifold(nt_buffer_edits *edits, uint32_t buffer, const nt_manifold *m, uint32_t view,
	uint32_t type, nt_error *error)
{
	nt_json *json = edits->document->json;
	uint32_t *corners, *vertices, corner_view = 0, vertex_view = 0;
	size_t count;
	if (nt_manifold_merges(m, &edits->arena, &corners, &vertices, &count))
		return nt_fail_memory(error);
	const uint32_t manifold = nt_gltf_new_accessor(json, view, type, "SCALAR", m->corner_count, false);
	nt_json_set_uint64(json,
		nt_json_put(json, nt_json_put(json, m->extension, "manifoldPrimitive"), "indices"), manifold);
	if (!count) {
		nt_json_remove(json, m->extension, "mergeIndices");
		nt_json_remove(json, m->extension, "mergeValues");
		return NT_OK;
	}
	const uint32_t corner_type = nt_gltf_index_type(m->corner_count, NT_GLTF_USHORT);
	nt_status status =
		add_numbers(edits, buffer, corners, count, corner_type, NT_GLTF_NO_TARGET, &corner_view, error);
	if (!status)
		status = add_numbers(edits, buffer, vertices, count, type, NT_GLTF_NO_TARGET, &vertex_view, error);
	if (status)
		return status;
	nt_json_value *accessor = nt_json_at(nt_json_find(nt_json_root(json), "accessors"), manifold);
	nt_json_set_uint64(json, nt_json_put(json, nt_json_put(json, accessor, "sparse"), "count"), count);
	set_sparse_array(json, m->extension, manifold, "indices", "mergeIndices", corner_view, corner_type, count);
	set_sparse_array(json, m->extension, manifold, "values", "mergeValues", vertex_view, type, count);
	return NT_OK;
}

nt_status nt_gltf_follow_manifold(nt_buffer_edits *edits, uint32_t buffer, nt_scene *scene,
	nt_pool_vertices *vertices, size_t first, bool compressed, nt_error *error)
{
	const nt_mesh *mesh = nt_pool_mesh(vertices->pool, first);
	nt_manifold m;
	size_t last = first; /* the users of the same glTF mesh end there */
	bool changed = compressed;
	for (; last < vertices->pool->user_count &&
		nt_pool_mesh(vertices->pool, last)->gltf_mesh == mesh->gltf_mesh; last++)
		changed |= vertices->changed[last];
	if (!changed)
		return NT_OK;
	if (nt_manifold_read(&m, edits->document, mesh->gltf_mesh, &edits->arena))
		return nt_fail_memory(error);
	if (!m.extension)
		return NT_OK;
	if (compressed)
		m.obstacle = "whose primitives are compressed";
	else if (!m.obstacle && !take_corners(&m, vertices, first, last))
		m.obstacle = "a primitive of which has another number of indices now";
	if (m.obstacle) {
		report(scene, mesh, m.obstacle);
		return NT_OK;
	}
	const uint32_t highest = nt_largest(m.corners, m.corner_count);
	const uint32_t type = nt_gltf_index_type((uint64_t)highest + 1, m.component_type);
	uint32_t view;
	const nt_status status = add_numbers(edits, buffer, m.corners, m.corner_count, type,
		NT_GLTF_ELEMENT_ARRAY_BUFFER, &view, error);
	if (status)
		return status;
	nt_json_value *object = nt_json_at(nt_gltf_root_member(edits->document, "meshes"), mesh->gltf_mesh);
	move_primitives(edits->document->json, nt_json_find(object, "primitives"), &m, view, type);
	for (size_t i = first; i < last; i++)
		vertices->changed[i] = false;
	return move_manifold(edits, buffer, &m, view, type, error);
}
