/* SPDX-License-Identifier: MIT */
/*
 * Pools are found with a union-find over the accessors; tangent sets by a key of all that decides a tangent.
 */
#include "gltf/vertex_pools.h"

#include <stdlib.h>
#include <string.h>

/* ---- pools ---- */

typedef struct joining {
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

static void join_user(joining *j, uint32_t accessor)
{
	uint32_t *user = &j->first_user[accessor];
	if (*user == NT_NONE) {
		*user = j->mesh;
		return;
	}
	const uint32_t a = find_root(j->parent, *user), b = find_root(j->parent, j->mesh);
	/* the smaller number is the root, so that pools come in the order of their first mesh */
	j->parent[a < b ? b : a] = a < b ? a : b;
}

/* Numbers pools in the order of their first mesh and lists their meshes. */
static void list_pools(nt_vertex_pools *pools, uint32_t *parent, size_t mesh_count)
{
	uint32_t *const pool_of = pools->of;
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

static void free_pools(void *pools)
{
	nt_vertex_pools *all = pools;
	if (all->free_merges)
		all->free_merges(all);
}

nt_status nt_vertex_pools_find(const nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	nt_gltf *document = scene->source;
	const size_t mesh_count = scene->mesh_count;
	nt_vertex_pools *pools = nt_arena_alloc(&document->arena, 1, sizeof *pools);
	if (!pools)
		return nt_fail_memory(error);
	*pools = (nt_vertex_pools){.scene = scene,
		.bakes_morphs = !options->world && options->morphs == NT_MORPH_BAKE};
	pools->of = nt_arena_alloc(&document->arena, mesh_count, sizeof *pools->of);
	pools->order = nt_arena_alloc(&document->arena, mesh_count, sizeof *pools->order);
	pools->first = nt_arena_alloc(&document->arena, mesh_count + 1, sizeof *pools->first);
	joining j = {.parent = nt_alloc(mesh_count, sizeof *j.parent),
		.first_user = nt_alloc(document->accessor_count, sizeof *j.first_user)};
	const bool found = pools->of && pools->order && pools->first && j.parent && j.first_user &&
		nt_gltf_find_users(document, error) == NT_OK;
	if (found) {
		memset(pools->first, 0, (mesh_count + 1) * sizeof *pools->first);
		memset(j.first_user, 0xFF, document->accessor_count * sizeof *j.first_user);
		for (uint32_t i = 0; i < mesh_count; i++)
			j.parent[i] = i;
		for (j.mesh = 0; j.mesh < mesh_count; j.mesh++) {
			const nt_json_value *primitive = nt_gltf_primitive_of(document, &scene->meshes[j.mesh]);
			for (nt_gltf_use u = {0}; nt_gltf_next_use(document, primitive, &u);)
				join_user(&j, nt_gltf_same(document, u.accessor));
		}
		list_pools(pools, j.parent, mesh_count);
		document->pools = pools;
		document->free_pools = free_pools;
	}
	free(j.parent);
	free(j.first_user);
	return found ? NT_OK : nt_fail_memory(error);
}

/* ---- tangent sets of a pool ---- */

/* How many morph targets get tangents. */
static size_t count_morphs(const nt_vertex_pools *pools, const nt_json_value *primitive, const nt_join *join)
{
	const bool has_normals = nt_json_find(nt_json_find(primitive, "attributes"), "NORMAL");
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	size_t count = 0;
	for (size_t i = 0; pools->bakes_morphs && i < nt_json_count(targets); i++) {
		const nt_json_value *target = nt_json_at(targets, i);
		count += nt_json_find(target, "POSITION") || (has_normals && nt_json_find(target, "NORMAL")) ||
			(join && i < join->target_count && join->moves[i]);
	}
	return count;
}

/*
 * Writes down what decides a tangent: meshes with equal keys form a set. Texture coordinates count as texture
 * transforms turn them; where those do not agree, hardly a tangent does, and a TANGENT for each is less than a copy of
 * every vertex.
 */
static void put_key(nt_key_table *keys, const nt_vertex_pools *pools, const nt_mesh *mesh)
{
	/* what is solved with others has other tangents than alone */
	const nt_join *join = mesh->plan.same_as ? mesh->plan.same_as->plan.join : mesh->plan.join;
	nt_key_put(keys, mesh->decision == NT_DECISION_NORMALS);
	nt_key_put(keys, join ? (uint64_t)(join - pools->scene->joins) + 1 : 0);
	const size_t morph_count = count_morphs(pools, nt_gltf_primitive_of(pools->scene->source, mesh), join);
	nt_key_put(keys, morph_count);
	/* if none gets tangents, they move none */
	nt_geometry_key(keys, pools->scene->source, mesh, morph_count > 0);
}

/* Sets are known before the solve. */
static bool gets_tangents(const nt_mesh *mesh)
{
	return nt_mesh_is_wanted(mesh) || nt_gltf_is_solved(mesh);
}

static bool find_sets(nt_vertex_pool *pool, const nt_vertex_pools *pools)
{
	nt_tangent_sets *sets = &pool->sets;
	uint32_t *last = nt_alloc(pool->user_count, sizeof *last); /* [set] its last user yet */
	nt_key_table keys = {0}; /* numbers are those of the sets */
	bool found = last != NULL;
	for (uint32_t i = 0; found && i < pool->user_count; i++) {
		sets->of[i] = sets->next[i] = NT_NONE;
		if (!gets_tangents(nt_pool_mesh(pool, i)))
			continue;
		put_key(&keys, pools, nt_pool_mesh(pool, i));
		const uint32_t set = nt_key_number(&keys);
		found = set != NT_NONE;
		if (!found)
			break;
		if (set == sets->count)
			sets->first[sets->count++] = i;
		else
			sets->next[last[set]] = i;
		last[set] = i;
		sets->of[i] = set;
	}
	nt_key_table_free(&keys);
	free(last);
	return found;
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
	if (!pool->sets.of || !pool->sets.first || !pool->sets.next)
		return nt_fail_memory(error);
	if (count != 1)
		return find_sets(pool, pools) ? NT_OK : nt_fail_memory(error);
	/* one user, as most have: no key is needed */
	pool->sets.count = gets_tangents(nt_pool_mesh(pool, 0));
	pool->sets.of[0] = pool->sets.count ? 0 : NT_NONE;
	pool->sets.first[0] = 0;
	pool->sets.next[0] = NT_NONE;
	return NT_OK;
}
