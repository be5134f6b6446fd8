/* SPDX-License-Identifier: MIT */
/*
 * Pools are found with a union-find over the accessors; tangent sets by a hash of all that decides a tangent.
 */
#include "gltf/edit/vertex_pools.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "gltf/draco.h"

/* ---- other users ---- */

static void mark_foreign(nt_vertex_pools *pools, const nt_json_value *reference)
{
	uint64_t accessor;
	if (nt_json_get_uint64(reference, &accessor) && accessor < pools->accessor_count)
		pools->foreign[pools->first_alias[accessor]] = true;
}

static void find_foreign(nt_vertex_pools *pools)
{
	const nt_gltf *document = pools->scene->source;
	const nt_json_value *animations = nt_gltf_root_member(document, "animations");
	for (size_t i = 0; i < nt_json_count(animations); i++) {
		const nt_json_value *samplers = nt_json_find(nt_json_at(animations, i), "samplers");
		for (size_t k = 0; k < nt_json_count(samplers); k++) {
			mark_foreign(pools, nt_json_find(nt_json_at(samplers, k), "input"));
			mark_foreign(pools, nt_json_find(nt_json_at(samplers, k), "output"));
		}
	}
	const nt_json_value *skins = nt_gltf_root_member(document, "skins");
	for (size_t i = 0; i < nt_json_count(skins); i++)
		mark_foreign(pools, nt_json_find(nt_json_at(skins, i), "inverseBindMatrices"));
	const nt_json_value *nodes = nt_gltf_root_member(document, "nodes");
	for (size_t i = 0; i < nt_json_count(nodes); i++) {
		const nt_json_value *extensions = nt_json_find(nt_json_at(nodes, i), "extensions");
		const nt_json_value *attributes = nt_json_find(
			nt_json_find(extensions, "EXT_mesh_gpu_instancing"), "attributes");
		for (size_t k = 0; k < nt_json_count(attributes); k++)
			mark_foreign(pools, nt_json_at(attributes, k));
	}
}

/* ---- pools ---- */

typedef struct joining {
	const nt_vertex_pools *pools;
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
	j->pools->attribute_users[j->pools->first_alias[accessor]]++;
	uint32_t *user = &j->first_user[j->pools->first_alias[accessor]];
	if (*user == NT_NONE) {
		*user = j->mesh;
		return NT_OK;
	}
	const uint32_t a = find_root(j->parent, *user), b = find_root(j->parent, j->mesh);
	/* the smaller number is the root, so that pools come in the order of their first mesh */
	j->parent[a < b ? b : a] = a < b ? a : b;
	return NT_OK;
}

/* Numbers pools in the order of their first mesh and lists their meshes. pool_of: [mesh_count] scratch. */
static void list_pools(nt_vertex_pools *pools, uint32_t *parent, uint32_t *pool_of, size_t mesh_count)
{
	for (uint32_t i = 0; i < mesh_count; i++) {
		const uint32_t root = find_root(parent, i);
		pool_of[i] = root == i ? (uint32_t)pools->count++ : pool_of[root];
	}
	for (uint32_t i = 0; i < mesh_count; i++)
		pools->first[pool_of[i] + 1]++;
	for (size_t i = 0; i < pools->count; i++)
		pools->first[i + 1] += pools->first[i];
	/* parent is free now: it counts what each pool has got */
	memset(parent, 0, mesh_count * sizeof *parent);
	for (uint32_t i = 0; i < mesh_count; i++)
		pools->order[pools->first[pool_of[i]] + parent[pool_of[i]]++] = i;
}

static uint32_t *zeroed(nt_arena *arena, size_t count)
{
	uint32_t *numbers = nt_arena_alloc(arena, count, sizeof *numbers);
	return numbers ? memset(numbers, 0, count * sizeof *numbers) : NULL;
}

static bool allocate(nt_vertex_pools *pools, nt_arena *arena)
{
	const nt_gltf *document = pools->scene->source;
	const size_t mesh_count = pools->scene->mesh_count;
	pools->accessor_count = nt_json_count(nt_gltf_root_member(document, "accessors"));
	pools->first_alias = zeroed(arena, pools->accessor_count);
	pools->foreign = nt_arena_alloc(arena, pools->accessor_count, sizeof *pools->foreign);
	pools->attribute_users = zeroed(arena, pools->accessor_count);
	pools->index_users = zeroed(arena, pools->accessor_count);
	pools->block_users = zeroed(arena, document->view_count);
	pools->order = zeroed(arena, mesh_count);
	pools->first = zeroed(arena, mesh_count + 1);
	if (pools->foreign)
		memset(pools->foreign, 0, pools->accessor_count * sizeof *pools->foreign);
	return pools->first_alias && pools->foreign && pools->attribute_users && pools->index_users &&
		pools->block_users && pools->order && pools->first;
}

/* What a primitive uses. */
static void join_primitive(nt_vertex_pools *pools, joining *j)
{
	const nt_gltf *document = pools->scene->source;
	const nt_json_value *primitive = nt_gltf_primitive_of(document, &pools->scene->meshes[j->mesh]);
	nt_gltf_visit_attributes(primitive, pools->accessor_count, join_user, j);
	uint64_t indices, view;
	if (nt_json_get_uint64(nt_json_find(nt_gltf_draco_of(primitive), "bufferView"), &view) &&
		view < document->view_count)
		pools->block_users[view]++;
	if (nt_json_get_uint64(nt_json_find(primitive, "indices"), &indices) && indices < pools->accessor_count) {
		pools->foreign[pools->first_alias[indices]] = true;
		pools->index_users[pools->first_alias[indices]]++;
	}
}

nt_status nt_vertex_pools_find(nt_vertex_pools *pools, const nt_scene *scene, nt_arena *arena, nt_error *error)
{
	*pools = (nt_vertex_pools){.scene = scene};
	if (!nt_gltf_has_solved(scene))
		return NT_OK;
	const size_t mesh_count = scene->mesh_count;
	joining j = {.pools = pools, .parent = nt_alloc(mesh_count, sizeof *j.parent)};
	uint32_t *pool_of = nt_alloc(mesh_count, sizeof *pool_of);
	bool found = allocate(pools, arena) && j.parent && pool_of &&
		nt_gltf_find_first_aliases(scene->source, pools->first_alias, pools->accessor_count);
	j.first_user = nt_alloc(pools->accessor_count, sizeof *j.first_user);
	found = found && j.first_user;
	if (found) {
		memset(j.first_user, 0xFF, pools->accessor_count * sizeof *j.first_user);
		for (uint32_t i = 0; i < mesh_count; i++)
			j.parent[i] = i;
		find_foreign(pools);
		for (j.mesh = 0; j.mesh < mesh_count; j.mesh++)
			join_primitive(pools, &j);
		list_pools(pools, j.parent, pool_of, mesh_count);
	}
	free(j.parent);
	free(j.first_user);
	free(pool_of);
	return found ? NT_OK : nt_fail_memory(error);
}

/* ---- tangent sets of a pool ---- */

/* What decides a tangent: meshes with the same three accessors form a set, if morph targets and texture
 * transforms are the same too, which is looked at where their hashes agree. */
typedef struct set_key {
	uint32_t positions, normals, texcoords;
	uint32_t targets;    /* a hash of what the morph targets move */
	uint64_t join;       /* what is solved with others has other tangents than alone: 0, or the join's number + 1 */
	uint64_t directions; /* a hash of what a texture transform makes of the texture coordinates; 0: there is none */
} set_key;

static uint32_t alias_of(const nt_vertex_pools *pools, const nt_json_value *attributes,
	const char *name)
{
	uint64_t accessor;
	if (!nt_json_get_uint64(nt_json_find(attributes, name), &accessor) ||
		accessor >= pools->accessor_count)
		return NT_NONE;
	return pools->first_alias[accessor];
}

static set_key key_of(const nt_vertex_pools *pools, const nt_mesh *mesh)
{
	char name[32];
	snprintf(name, sizeof name, "TEXCOORD_%u", mesh->texcoord_set);
	const nt_json_value *primitive = nt_gltf_primitive_of(pools->scene->source, mesh);
	const nt_json_value *attributes = nt_json_find(primitive, "attributes");
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	uint32_t hash = (uint32_t)mesh->morph_count;
	for (size_t i = 0; i < nt_json_count(targets); i++) {
		const nt_json_value *target = nt_json_at(targets, i);
		hash = (hash ^ alias_of(pools, target, "POSITION")) * 16777619u;
		hash = (hash ^ alias_of(pools, target, "NORMAL")) * 16777619u;
	}
	const uint64_t join = mesh->join ? (uint64_t)(mesh->join - pools->scene->joins) + 1 : 0;
	const uint64_t directions = !mesh->solve_texcoords ? 0 :
		nt_hash_bytes(1, mesh->solve_texcoords, mesh->vertex_count * 2 * sizeof *mesh->solve_texcoords);
	return (set_key){alias_of(pools, attributes, "POSITION"),
		alias_of(pools, attributes, "NORMAL"), alias_of(pools, attributes, name),
		hash, join, directions};
}

/* Whether the morph targets of two meshes move the same accessors. */
static bool same_targets(const nt_vertex_pools *pools, const nt_mesh *a, const nt_mesh *b)
{
	const nt_gltf *document = pools->scene->source;
	const nt_json_value *x = nt_json_find(nt_gltf_primitive_of(document, a), "targets");
	const nt_json_value *y = nt_json_find(nt_gltf_primitive_of(document, b), "targets");
	if (a->morph_count != b->morph_count || nt_json_count(x) != nt_json_count(y))
		return false;
	static const char *const names[] = {"POSITION", "NORMAL"};
	for (size_t i = 0; i < 2 * nt_json_count(x); i++)
		if (alias_of(pools, nt_json_at(x, i / 2), names[i % 2]) !=
			alias_of(pools, nt_json_at(y, i / 2), names[i % 2]))
			return false;
	return true;
}

/* Whether texture transforms do the same to two meshes over the same texture coordinates. Where they do not,
 * hardly a tangent agrees: a TANGENT for each is less than a copy of every row. */
static bool same_directions(const nt_mesh *a, const nt_mesh *b)
{
	const float *x = a->solve_texcoords, *y = b->solve_texcoords;
	if (x == y)
		return true;
	return x && y && a->vertex_count == b->vertex_count &&
		memcmp(x, y, a->vertex_count * 2 * sizeof *x) == 0;
}

/* What is known of the sets while they are found: thousands may share one accessor of positions, so they
 * stand in a table by the hash of their key. */
typedef struct set_table {
	set_key *keys;      /* [set] */
	uint32_t *last;     /* [set] its last user yet */
	uint32_t *slots;    /* [slot_count] sets or NT_NONE; at most half full */
	size_t slot_count;  /* a power of two */
} set_table;

static size_t slot_of(const set_key *key, size_t slot_count)
{
	return (size_t)(nt_hash_bytes(0, key, sizeof *key) >> 32) & (slot_count - 1);
}

/* Appends a user to its set, which may be a new one. */
static void join_set(set_table *table, nt_vertex_pool *pool, const nt_vertex_pools *pools, uint32_t user)
{
	nt_tangent_sets *sets = &pool->sets;
	const nt_mesh *mesh = nt_pool_mesh(pool, user);
	const set_key key = key_of(pools, mesh);
	size_t slot = slot_of(&key, table->slot_count);
	for (; table->slots[slot] != NT_NONE; slot = (slot + 1) & (table->slot_count - 1)) {
		const uint32_t set = table->slots[slot];
		const nt_mesh *first = nt_pool_set_mesh(pool, set);
		if (memcmp(&table->keys[set], &key, sizeof key) != 0 || !same_directions(first, mesh) ||
			!same_targets(pools, first, mesh))
			continue;
		sets->next[table->last[set]] = user;
		table->last[set] = user;
		sets->of[user] = set;
		return;
	}
	const uint32_t set = (uint32_t)sets->count++;
	table->slots[slot] = set;
	table->keys[set] = key;
	table->last[set] = sets->first[set] = user;
	sets->of[user] = set;
}

static bool find_sets(nt_vertex_pool *pool, const nt_vertex_pools *pools)
{
	const size_t count = pool->user_count;
	set_table table = {.slot_count = 2};
	while (table.slot_count < 2 * count)
		table.slot_count *= 2;
	table.keys = nt_alloc(count, sizeof *table.keys);
	table.last = nt_alloc(count, sizeof *table.last);
	table.slots = nt_alloc(table.slot_count, sizeof *table.slots);
	const bool room = table.keys && table.last && table.slots;
	if (room)
		memset(table.slots, 0xff, table.slot_count * sizeof *table.slots);
	for (uint32_t i = 0; room && i < count; i++) {
		pool->sets.of[i] = pool->sets.next[i] = NT_NONE;
		if (nt_gltf_is_solved(nt_pool_mesh(pool, i)))
			join_set(&table, pool, pools, i);
	}
	free(table.keys);
	free(table.last);
	free(table.slots);
	return room;
}

nt_status nt_vertex_pools_get(const nt_vertex_pools *pools, size_t number, nt_arena *arena, nt_vertex_pool *pool,
	nt_error *error)
{
	const size_t count = pools->first[number + 1] - pools->first[number];
	*pool = (nt_vertex_pool){.scene = pools->scene, .users = pools->order + pools->first[number],
		.user_count = count,
		.sets = {.of = nt_arena_alloc(arena, count, sizeof *pool->sets.of),
			.first = nt_arena_alloc(arena, count, sizeof *pool->sets.first),
			.next = nt_arena_alloc(arena, count, sizeof *pool->sets.next)}};
	const bool room = pool->sets.of && pool->sets.first && pool->sets.next;
	return room && find_sets(pool, pools) ? NT_OK : nt_fail_memory(error);
}
