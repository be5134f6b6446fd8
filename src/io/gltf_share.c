/* SPDX-License-Identifier: MIT */
/*
 * Components of primitives that share attribute accessors, found with a union-find over the accessors.
 * Exporters also write several accessors over the same bytes; those count as one.
 */
#include "io/gltf_share.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "io/gltf_draco.h"

bool nt_gltf_is_solved(const nt_mesh *mesh)
{
	return mesh->split.vertex_tangents != NULL;
}

nt_json_value *nt_gltf_primitive_of(const nt_gltf *document, const nt_mesh *mesh)
{
	const nt_json_value *json =
		nt_json_at(nt_gltf_root_member(document, "meshes"), mesh->gltf_mesh);
	return nt_json_at(nt_json_find(json, "primitives"), mesh->gltf_primitive);
}

static nt_status visit_object(nt_json_value *attributes, size_t accessor_count, nt_gltf_visit visit,
	void *context)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < nt_json_count(attributes); i++) {
		uint64_t accessor;
		const char *name = nt_json_key(attributes, i, NULL);
		if (name && nt_json_get_uint64(nt_json_at(attributes, i), &accessor) &&
			accessor < accessor_count)
			status = visit(context, attributes, name, (uint32_t)accessor);
	}
	return status;
}

nt_status nt_gltf_visit_attributes(const nt_json_value *primitive, size_t accessor_count,
	nt_gltf_visit visit, void *context)
{
	nt_status status =
		visit_object(nt_json_find(primitive, "attributes"), accessor_count, visit, context);
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	for (size_t i = 0; !status && i < nt_json_count(targets); i++)
		status = visit_object(nt_json_at(targets, i), accessor_count, visit, context);
	return status;
}

/* ---- accessors over the same bytes ---- */

static int compare_accessors(const void *a, const void *b)
{
	const nt_gltf_accessor *x = a, *y = b;
	const uint64_t xs[] = {x->view, x->offset, x->component_type, x->components, x->count,
		x->normalized, x->index};
	const uint64_t ys[] = {y->view, y->offset, y->component_type, y->components, y->count,
		y->normalized, y->index};
	for (size_t i = 0; i < sizeof xs / sizeof *xs; i++)
		if (xs[i] != ys[i])
			return xs[i] < ys[i] ? -1 : 1;
	return 0;
}

static bool same_bytes(nt_gltf_accessor a, nt_gltf_accessor b)
{
	a.index = b.index = 0;
	return compare_accessors(&a, &b) == 0;
}

bool nt_gltf_find_canonical(nt_gltf *document, uint32_t *canonical, size_t accessor_count)
{
	nt_gltf_accessor *list = nt_alloc(accessor_count, sizeof *list);
	if (!list)
		return false;
	size_t count = 0;
	for (uint32_t i = 0; i < accessor_count; i++) {
		canonical[i] = i;
		nt_gltf_accessor accessor;
		if (nt_gltf_get_accessor(document, i, "", &accessor, NULL) == NT_OK &&
			accessor.view != NT_NONE && !accessor.sparse_count)
			list[count++] = accessor;
	}
	if (count)
		qsort(list, count, sizeof *list, compare_accessors);
	for (size_t i = 1; i < count; i++)
		if (same_bytes(list[i], list[i - 1]))
			canonical[list[i].index] = canonical[list[i - 1].index];
	free(list);
	return true;
}

/* ---- other users ---- */

static void mark_foreign(nt_gltf_sharing *sharing, const nt_json_value *reference)
{
	uint64_t accessor;
	if (nt_json_get_uint64(reference, &accessor) && accessor < sharing->accessor_count)
		sharing->foreign[sharing->canonical[accessor]] = true;
}

static void find_foreign(nt_gltf_sharing *sharing, const nt_gltf *document)
{
	const nt_json_value *animations = nt_gltf_root_member(document, "animations");
	for (size_t i = 0; i < nt_json_count(animations); i++) {
		const nt_json_value *samplers = nt_json_find(nt_json_at(animations, i), "samplers");
		for (size_t k = 0; k < nt_json_count(samplers); k++) {
			mark_foreign(sharing, nt_json_find(nt_json_at(samplers, k), "input"));
			mark_foreign(sharing, nt_json_find(nt_json_at(samplers, k), "output"));
		}
	}
	const nt_json_value *skins = nt_gltf_root_member(document, "skins");
	for (size_t i = 0; i < nt_json_count(skins); i++)
		mark_foreign(sharing, nt_json_find(nt_json_at(skins, i), "inverseBindMatrices"));
	const nt_json_value *nodes = nt_gltf_root_member(document, "nodes");
	for (size_t i = 0; i < nt_json_count(nodes); i++) {
		const nt_json_value *extensions = nt_json_find(nt_json_at(nodes, i), "extensions");
		const nt_json_value *attributes = nt_json_find(
			nt_json_find(extensions, "EXT_mesh_gpu_instancing"), "attributes");
		for (size_t k = 0; k < nt_json_count(attributes); k++)
			mark_foreign(sharing, nt_json_at(attributes, k));
	}
}

/* ---- components ---- */

typedef struct joining {
	const nt_gltf_sharing *sharing;
	uint32_t *parent;     /* [mesh count] union-find */
	uint32_t *first_user; /* [accessor_count] */
	uint32_t mesh;
} joining;

static uint32_t find_root(uint32_t *parent, uint32_t mesh)
{
	while (parent[mesh] != mesh) {
		parent[mesh] = parent[parent[mesh]];
		mesh = parent[mesh];
	}
	return mesh;
}

static nt_status join_user(void *context, nt_json_value *attributes, const char *name,
	uint32_t accessor)
{
	(void)attributes;
	(void)name;
	joining *j = context;
	j->sharing->attribute_users[j->sharing->canonical[accessor]]++;
	uint32_t *user = &j->first_user[j->sharing->canonical[accessor]];
	if (*user == NT_NONE) {
		*user = j->mesh;
		return NT_OK;
	}
	const uint32_t a = find_root(j->parent, *user), b = find_root(j->parent, j->mesh);
	/* the smaller number is the root, so that components come in the order of their first mesh */
	j->parent[a < b ? b : a] = a < b ? a : b;
	return NT_OK;
}

/* Numbers components in the order of their first mesh and lists their meshes. */
static void list_components(nt_gltf_sharing *sharing, uint32_t *parent, size_t mesh_count)
{
	sharing->component_count = 0;
	for (uint32_t i = 0; i < mesh_count; i++) {
		const uint32_t root = find_root(parent, i);
		sharing->component[i] =
			root == i ? (uint32_t)sharing->component_count++ : sharing->component[root];
	}
	memset(sharing->first, 0, (sharing->component_count + 1) * sizeof *sharing->first);
	for (uint32_t i = 0; i < mesh_count; i++)
		sharing->first[sharing->component[i] + 1]++;
	for (size_t i = 0; i < sharing->component_count; i++)
		sharing->first[i + 1] += sharing->first[i];
	/* parent is free now: it counts what each component has got */
	memset(parent, 0, mesh_count * sizeof *parent);
	for (uint32_t i = 0; i < mesh_count; i++) {
		const uint32_t c = sharing->component[i];
		sharing->order[sharing->first[c] + parent[c]++] = i;
	}
}

nt_status nt_gltf_find_sharing(nt_gltf_sharing *sharing, nt_gltf *document, const nt_scene *scene,
	nt_arena *arena, nt_error *error)
{
	const size_t accessor_count = nt_json_count(nt_gltf_root_member(document, "accessors"));
	*sharing = (nt_gltf_sharing){
		.accessor_count = accessor_count,
		.canonical = nt_arena_alloc(arena, accessor_count, sizeof(uint32_t)),
		.foreign = nt_arena_alloc(arena, accessor_count, sizeof(bool)),
		.attribute_users = nt_arena_alloc(arena, accessor_count, sizeof(uint32_t)),
		.index_users = nt_arena_alloc(arena, accessor_count, sizeof(uint32_t)),
		.block_users = nt_arena_alloc(arena, document->view_count, sizeof(uint32_t)),
		.order = nt_arena_alloc(arena, scene->mesh_count, sizeof(uint32_t)),
		.component = nt_arena_alloc(arena, scene->mesh_count, sizeof(uint32_t)),
		.first = nt_arena_alloc(arena, scene->mesh_count + 1, sizeof(uint32_t)),
	};
	joining j = {.sharing = sharing, .parent = nt_alloc(scene->mesh_count, sizeof(uint32_t)),
		.first_user = nt_alloc(accessor_count, sizeof(uint32_t))};
	const bool allocated = sharing->canonical && sharing->foreign && sharing->attribute_users &&
		sharing->index_users && sharing->block_users && sharing->order && sharing->component &&
		sharing->first && j.parent && j.first_user;
	if (!allocated || !nt_gltf_find_canonical(document, sharing->canonical, accessor_count)) {
		free(j.parent);
		free(j.first_user);
		return nt_fail_memory(error);
	}
	memset(sharing->foreign, 0, accessor_count * sizeof *sharing->foreign);
	memset(sharing->attribute_users, 0, accessor_count * sizeof *sharing->attribute_users);
	memset(sharing->index_users, 0, accessor_count * sizeof *sharing->index_users);
	memset(sharing->block_users, 0, document->view_count * sizeof *sharing->block_users);
	memset(j.first_user, 0xFF, accessor_count * sizeof *j.first_user);
	find_foreign(sharing, document);
	for (uint32_t i = 0; i < scene->mesh_count; i++)
		j.parent[i] = i;
	for (j.mesh = 0; j.mesh < scene->mesh_count; j.mesh++) {
		const nt_json_value *primitive =
			nt_gltf_primitive_of(document, &scene->meshes[j.mesh]);
		nt_gltf_visit_attributes(primitive, accessor_count, join_user, &j);
		uint64_t indices, view;
		if (nt_json_get_uint64(nt_json_find(nt_gltf_draco_of(primitive), "bufferView"), &view) &&
			view < document->view_count)
			sharing->block_users[view]++;
		if (nt_json_get_uint64(nt_json_find(primitive, "indices"), &indices) &&
			indices < accessor_count) {
			sharing->foreign[sharing->canonical[indices]] = true;
			sharing->index_users[sharing->canonical[indices]]++;
		}
	}
	list_components(sharing, j.parent, scene->mesh_count);
	free(j.parent);
	free(j.first_user);
	return NT_OK;
}
