/* SPDX-License-Identifier: MIT */
/*
 * Extensions of primitives and meshes whose vertices were copied. The values of a known one are computed in
 * gltf/extensions; here it is read from the document and stored in it. The accessor of an outline stays as it is,
 * since others may use it, and the primitive gets another. FB_ngon_encoding, a mark that says which triangles are one
 * polygon, goes where it would not say the same any more.
 */

#include "gltf/accessor.h"
#include "gltf/document.h"
#include "gltf/edit/manifold.h"
#include "gltf/edit/new_accessors.h"
#include "gltf/extensions/extensions.h"
#include "gltf/pointer.h"

static const char outline_name[] = "CESIUM_primitive_outline", polygons_name[] = "FB_ngon_encoding";

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
		.old_count = vertices->own_count, .sources = vertices->sources};
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

/* Whether triangles that follow each other have one first vertex where they had, and nowhere else. */
static bool keeps_polygons(const nt_pool_vertices *vertices, size_t user)
{
	const uint32_t *indices = vertices->indices[user];
	const size_t count = nt_pool_mesh(vertices->pool, user)->corner_count;
	for (size_t c = 3; indices && c < count; c += 3)
		if (indices[c] != indices[c - 3] &&
			nt_vertex_source(vertices, indices[c]) == nt_vertex_source(vertices, indices[c - 3]))
			return false;
	return true;
}

static void drop_polygons(nt_scene *scene, nt_buffer_edits *edits, nt_json_value *primitive, const nt_mesh *mesh)
{
	nt_json *json = edits->document->json;
	nt_json_value *extensions = nt_json_find(primitive, "extensions");
	nt_json_remove(json, extensions, polygons_name);
	if (nt_json_count(extensions) == 0)
		nt_json_remove(json, primitive, "extensions");
	edits->polygons_dropped = true;
	nt_finding_add(&scene->findings, NT_CODE_POLYGONS_DROPPED, nt_mesh_place(mesh, &(nt_place){0}), 1, "%s",
		polygons_name);
}

void nt_gltf_drop_polygons(const nt_buffer_edits *edits)
{
	nt_gltf *document = edits->document;
	const nt_json_value *meshes = nt_gltf_root_member(document, "meshes");
	if (!edits->polygons_dropped)
		return;
	for (size_t i = 0; i < nt_json_count(meshes); i++) {
		const nt_json_value *primitives = nt_json_find(nt_json_at(meshes, i), "primitives");
		for (size_t k = 0; k < nt_json_count(primitives); k++)
			if (nt_json_find(nt_json_find(nt_json_at(primitives, k), "extensions"), polygons_name))
				return;
	}
	nt_gltf_remove_extension(document, "extensionsRequired", polygons_name);
	nt_gltf_remove_extension(document, "extensionsUsed", polygons_name);
}

nt_status nt_gltf_follow_vertices(nt_buffer_edits *edits, uint32_t buffer, nt_scene *scene,
	nt_pool_vertices *vertices, bool compressed, nt_error *error)
{
	const nt_vertex_pool *pool = vertices->pool;
	uint32_t last_mesh = NT_NONE;
	nt_status status = NT_OK;
	if (!nt_vertices_differ(vertices) && !compressed)
		return NT_OK;
	edits->vertices_copied |= nt_vertices_differ(vertices);
	for (size_t i = 0; !status && i < pool->user_count; i++) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		nt_json_value *primitive = nt_pool_primitive(pool, i);
		nt_json_value *outline = nt_json_find(nt_json_find(primitive, "extensions"), outline_name);
		if (outline && compressed)
			nt_finding_add(&scene->findings, NT_CODE_EXTENSION_STALE, nt_mesh_place(mesh, &(nt_place){0}),
				1, "%s", outline_name);
		else if (outline && vertices->changed[i])
			status = follow_outline(edits, buffer, vertices, i, outline, error);
		if (nt_pool_is_solved(pool, i) && nt_json_find(nt_json_find(primitive, "extensions"), polygons_name) &&
			(compressed || !keeps_polygons(vertices, i)))
			drop_polygons(scene, edits, primitive, mesh);
		if (!status && nt_extension_references(scene, mesh, vertices->old_count, mesh->gltf_mesh != last_mesh))
			status = nt_fail_memory(error);
		last_mesh = mesh->gltf_mesh;
	}
	for (size_t i = 0; !status && i < pool->user_count; i++)
		if (i == 0 || nt_pool_mesh(pool, i)->gltf_mesh != nt_pool_mesh(pool, i - 1)->gltf_mesh)
			status = nt_gltf_follow_manifold(edits, buffer, scene, vertices, i, compressed, error);
	return status;
}
