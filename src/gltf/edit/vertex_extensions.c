/* SPDX-License-Identifier: MIT */
/*
 * Extensions of primitives and meshes whose vertices were copied. What a known one says is computed in
 * gltf/extensions; here it is read from the document and stored in it. The accessor of an outline stays as it is,
 * since others may use it, and the primitive gets another.
 */

#include "gltf/accessor.h"
#include "gltf/edit/manifold.h"
#include "gltf/edit/new_accessors.h"
#include "gltf/extensions/outline.h"
#include "gltf/extensions/references.h"
#include "gltf/pointer.h"

static const char outline_name[] = "CESIUM_primitive_outline";

/* The outline of a user, NULL where it has none. */
static nt_json_value *outline_of(const nt_vertex_pool *pool, size_t user)
{
	return nt_json_find(nt_json_find(nt_pool_primitive(pool, user), "extensions"), outline_name);
}

/* A new accessor of vertex numbers. */
static nt_status add_numbers(nt_buffer_edits *edits, uint32_t buffer, const uint32_t *numbers, size_t count,
	uint32_t *accessor, nt_error *error)
{
	uint32_t view;
	unsigned char *bytes = nt_arena_alloc(&edits->arena, count, sizeof *numbers);
	if (!bytes)
		return nt_fail_memory(error);
	for (size_t i = 0; i < 4 * count; i++)
		bytes[i] = (unsigned char)(numbers[i / 4] >> 8 * (i % 4));
	const nt_status status = nt_edits_add_view(edits, buffer, bytes, count * sizeof *numbers, NT_GLTF_NO_TARGET, 0,
		&view, error);
	if (!status)
		*accessor = nt_gltf_new_accessor(edits->document->json, view, NT_GLTF_UINT, "SCALAR", count, false);
	return status;
}

static nt_status follow_outline(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	size_t user, nt_json_value *outline, nt_error *error)
{
	const nt_mesh *mesh = nt_pool_mesh(vertices->pool, user);
	const nt_copied_triangles triangles = {.vertices = vertices->indices[user], .corner_count = mesh->corner_count,
		.old_count = vertices->old_count, .sources = vertices->sources};
	nt_gltf_accessor accessor;
	uint64_t number;
	uint32_t *edges, *followed, new_accessor = NT_NONE;
	size_t count;
	if (!nt_json_get_uint64(nt_json_find(outline, "indices"), &number))
		return NT_OK;
	nt_status status =
		nt_gltf_get_accessor(edits->document, number, nt_gltf_of_mesh(mesh).pointer, &accessor, error);
	if (!status)
		status = nt_gltf_indices(edits->document, &accessor, vertices->old_count, &edits->arena,
			&edges, error);
	if (!status &&
		nt_outline_follow(edges, (size_t)accessor.count / 2, &triangles, &edits->arena, &followed, &count))
		status = nt_fail_memory(error);
	if (!status)
		status = add_numbers(edits, buffer, followed, 2 * count, &new_accessor, error);
	nt_json *json = edits->document->json;
	if (!status)
		nt_json_set_uint64(json, nt_json_put(json, outline, "indices"), new_accessor);
	return status;
}

static void report_outline(nt_scene *scene, const nt_mesh *mesh)
{
	nt_finding_add(&scene->findings, NT_CODE_EXTENSION_STALE, nt_mesh_place(mesh, &(nt_place){0}), 1, "%s",
		outline_name);
}

nt_status nt_gltf_follow_vertices(nt_buffer_edits *edits, uint32_t buffer, nt_scene *scene,
	nt_pool_vertices *vertices, bool compressed, nt_error *error)
{
	const nt_vertex_pool *pool = vertices->pool;
	uint32_t last_mesh = NT_NONE;
	nt_status status = NT_OK;
	if (vertices->new_count == vertices->old_count && !compressed)
		return NT_OK;
	for (size_t i = 0; !status && i < pool->user_count; i++) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		nt_json_value *outline = outline_of(pool, i);
		if (outline && compressed)
			report_outline(scene, mesh);
		else if (outline && vertices->changed[i])
			status = follow_outline(edits, buffer, vertices, i, outline, error);
		if (!status && nt_extension_references(scene, mesh, vertices->old_count, mesh->gltf_mesh != last_mesh))
			status = nt_fail_memory(error);
		last_mesh = mesh->gltf_mesh;
	}
	for (size_t i = 0; !status && i < pool->user_count; i++)
		if (i == 0 || nt_pool_mesh(pool, i)->gltf_mesh != nt_pool_mesh(pool, i - 1)->gltf_mesh)
			status = nt_gltf_follow_manifold(edits, buffer, scene, vertices, i, compressed, error);
	return status;
}
