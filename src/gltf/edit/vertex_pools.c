/* SPDX-License-Identifier: MIT */
/*
 * Components of primitives that share attribute accessors, found with a union-find over the accessors; and groups of
 * a component: primitives whose tangents are the same, because all that decides them is. Exporters also write several
 * accessors over the same bytes; those count as one.
 */
#include "gltf/edit/vertex_pools.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "gltf/draco.h"
#include "gltf/primitive.h"

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

/* ---- groups of a component ---- */

/* What decides a tangent: meshes with the same three accessors form a group, if morph targets and texture transforms are
 * the same too, which is looked at where their hashes agree. */
typedef struct group_key {
	uint32_t positions, normals, texcoords;
	uint32_t targets;    /* a hash of what the morph targets move */
	uint64_t directions; /* a hash of what a texture transform makes of the texture coordinates; 0: there is none */
} group_key;

static uint32_t canonical_of(const nt_gltf_sharing *sharing, const nt_json_value *attributes,
	const char *name)
{
	uint64_t accessor;
	if (!nt_json_get_uint64(nt_json_find(attributes, name), &accessor) ||
		accessor >= sharing->accessor_count)
		return NT_NONE;
	return sharing->canonical[accessor];
}

static group_key key_of(const nt_gltf *document, const nt_gltf_sharing *sharing, const nt_mesh *mesh)
{
	char name[32];
	snprintf(name, sizeof name, "TEXCOORD_%u", mesh->texcoord_set);
	const nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
	const nt_json_value *attributes = nt_json_find(primitive, "attributes");
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	uint32_t hash = (uint32_t)mesh->morph_count;
	for (size_t i = 0; i < nt_json_count(targets); i++) {
		const nt_json_value *target = nt_json_at(targets, i);
		hash = (hash ^ canonical_of(sharing, target, "POSITION")) * 16777619u;
		hash = (hash ^ canonical_of(sharing, target, "NORMAL")) * 16777619u;
	}
	const uint64_t directions = !mesh->solve_texcoords ? 0 :
		nt_hash_bytes(1, mesh->solve_texcoords, mesh->vertex_count * 2 * sizeof *mesh->solve_texcoords);
	return (group_key){canonical_of(sharing, attributes, "POSITION"),
		canonical_of(sharing, attributes, "NORMAL"), canonical_of(sharing, attributes, name),
		hash, directions};
}

/* Whether the morph targets of two meshes move the same accessors. */
static bool same_targets(const nt_gltf *document, const nt_gltf_sharing *sharing, const nt_mesh *a, const nt_mesh *b)
{
	const nt_json_value *x = nt_json_find(nt_gltf_primitive_of(document, a), "targets");
	const nt_json_value *y = nt_json_find(nt_gltf_primitive_of(document, b), "targets");
	if (a->morph_count != b->morph_count || nt_json_count(x) != nt_json_count(y))
		return false;
	static const char *const names[] = {"POSITION", "NORMAL"};
	for (size_t i = 0; i < 2 * nt_json_count(x); i++)
		if (canonical_of(sharing, nt_json_at(x, i / 2), names[i % 2]) !=
			canonical_of(sharing, nt_json_at(y, i / 2), names[i % 2]))
			return false;
	return true;
}

/* Whether texture transforms do the same to two meshes over the same texture coordinates. Where they do not, hardly a
 * tangent agrees: a TANGENT for each is less than a copy of every row. */
static bool same_directions(const nt_mesh *a, const nt_mesh *b)
{
	const float *x = a->solve_texcoords, *y = b->solve_texcoords;
	if (x == y)
		return true;
	return x && y && a->vertex_count == b->vertex_count &&
		memcmp(x, y, a->vertex_count * 2 * sizeof *x) == 0;
}

/* What is known of the groups while they are found: thousands may share one accessor of positions, so they
 * stand in a table by the hash of their key. */
typedef struct grouping {
	group_key *keys;    /* [group] */
	uint32_t *last;     /* [group] its last member yet */
	uint32_t *table;    /* [table_size] groups or NT_NONE; at most half full */
	size_t table_size;  /* a power of two */
} grouping;

static size_t slot_of(const group_key *key, size_t table_size)
{
	return (size_t)(nt_hash_bytes(0, key, sizeof *key) >> 32) & (table_size - 1);
}

/* Appends a member to its group, which may be a new one. */
static void join_group(grouping *g, nt_gltf_rows *rows, const nt_gltf_sharing *sharing, const nt_scene *scene,
	const uint32_t *members, uint32_t member, const group_key *key)
{
	const nt_mesh *mesh = &scene->meshes[members[member]];
	size_t slot = slot_of(key, g->table_size);
	for (; g->table[slot] != NT_NONE; slot = (slot + 1) & (g->table_size - 1)) {
		const uint32_t group = g->table[slot];
		const nt_mesh *first = &scene->meshes[members[rows->group_first[group]]];
		if (memcmp(&g->keys[group], key, sizeof *key) != 0 || !same_directions(first, mesh) ||
			!same_targets(scene->source, sharing, first, mesh))
			continue;
		rows->next_of[g->last[group]] = member;
		g->last[group] = member;
		rows->group_of[member] = group;
		return;
	}
	const uint32_t group = (uint32_t)rows->group_count++;
	g->table[slot] = group;
	g->keys[group] = *key;
	g->last[group] = rows->group_first[group] = member;
	rows->group_of[member] = group;
}

bool nt_gltf_find_groups(nt_gltf_rows *rows, const nt_gltf *document, const nt_scene *scene,
	const nt_gltf_sharing *sharing, const uint32_t *members, size_t member_count)
{
	grouping g = {.table_size = 2};
	while (g.table_size < 2 * member_count)
		g.table_size *= 2;
	g.keys = nt_alloc(member_count, sizeof *g.keys);
	g.last = nt_alloc(member_count, sizeof *g.last);
	g.table = nt_alloc(g.table_size, sizeof *g.table);
	const bool room = g.keys && g.last && g.table;
	if (room)
		memset(g.table, 0xff, g.table_size * sizeof *g.table);
	rows->group_count = 0;
	for (uint32_t i = 0; room && i < member_count; i++) {
		const nt_mesh *mesh = &scene->meshes[members[i]];
		rows->group_of[i] = rows->next_of[i] = NT_NONE;
		if (!nt_gltf_is_solved(mesh))
			continue;
		const group_key key = key_of(document, sharing, mesh);
		join_group(&g, rows, sharing, scene, members, i, &key);
	}
	free(g.keys);
	free(g.last);
	free(g.table);
	return room;
}
