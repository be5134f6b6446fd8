/* SPDX-License-Identifier: MIT */
/*
 * Primitives that share vertices: see vertex_pools.c.
 *
 * Primitives that share an attribute accessor share its elements, so their vertices can only be split
 * together: they are the users of one pool of vertices. Users of a pool with the same positions, normals,
 * texture coordinates (as texture transforms turn them) and morph targets form a tangent set: they have one
 * TANGENT.
 */
#ifndef NT_GLTF_VERTEX_POOLS_H
#define NT_GLTF_VERTEX_POOLS_H

#include "base/hash_index.h"
#include "base/text.h"
#include "gltf/document.h"
#include "scene/scene.h"

/* Keys, each of which gets a number. Zeroed: empty. */
typedef struct nt_key_table {
	nt_name_table names;
	nt_arena texts; /* of the names */
	nt_buffer key;  /* the one that is being written */
} nt_key_table;

/* geometry_key.c. Writes a number. */
void nt_key_put(nt_key_table *table, uint64_t number);

/* geometry_key.c. The number of the key that was written, new or not; another one begins. NT_NONE: out of memory. */
uint32_t nt_key_number(nt_key_table *table);
void nt_key_table_free(nt_key_table *table);

/* geometry_key.c. Writes what decides the vertices of a mesh: attributes and the texture transform, and with `bakes`
 * what morph targets do to them. */
void nt_geometry_key(nt_key_table *table, const nt_gltf *document, const nt_mesh *mesh, bool bakes);

/* All pools of a document. Accessors over the same bytes count as one, by `same`. */
typedef struct nt_vertex_pools {
	const nt_scene *scene;
	size_t count;
	uint32_t *of;              /* [mesh count] the pool of each mesh */
	uint32_t *order;           /* [mesh count] numbers of meshes, those of one pool together */
	uint32_t *first;           /* [count + 1] where each pool begins in order */
	bool bakes_morphs;         /* morph targets get tangents */
	struct nt_pool_merge **merges; /* [count] of pools whose splits are merged: merge_splits.c; NULL: none yet */
	void (*free_merges)(struct nt_vertex_pools *pools); /* set with them */
} nt_vertex_pools;

/* Sets are lists of users, so that one is gone through without the others. */
typedef struct nt_tangent_sets {
	size_t count;
	uint32_t *of;    /* [user_count] set of a user; NT_NONE: it is not solved */
	uint32_t *first; /* [count] first user */
	uint32_t *next;  /* [user_count] the next user of the same set; NT_NONE: none */
} nt_tangent_sets;

typedef struct nt_vertex_pool {
	const nt_scene *scene;
	const uint32_t *users; /* [user_count] numbers of meshes, ascending */
	size_t user_count;
	nt_tangent_sets sets;
} nt_vertex_pool;

/* Finds the pools of a document that is read with these options, once the decisions are made: document->pools. */
nt_status nt_vertex_pools_find(const nt_scene *scene, const nt_read_options *options, nt_error *error);

/* One of them, with its sets, in the arena. */
nt_status nt_vertex_pools_get(const nt_vertex_pools *pools, size_t number, nt_arena *arena, nt_vertex_pool *pool,
	nt_error *error);

static inline const nt_mesh *nt_pool_mesh(const nt_vertex_pool *pool, size_t user)
{
	return &pool->scene->meshes[pool->users[user]];
}

/* The first mesh of a set: what sets have in common, it has. */
static inline const nt_mesh *nt_pool_set_mesh(const nt_vertex_pool *pool, uint32_t set)
{
	return nt_pool_mesh(pool, pool->sets.first[set]);
}

static inline nt_json_value *nt_pool_primitive(const nt_vertex_pool *pool, size_t user)
{
	return nt_gltf_primitive_of(pool->scene->source, nt_pool_mesh(pool, user));
}

static inline bool nt_pool_is_solved(const nt_vertex_pool *pool, size_t user)
{
	return pool->sets.of[user] != NT_NONE;
}

/* After the decisions: sets plan.same_as of meshes that will be solved and have the geometry of an earlier one. */
nt_status nt_gltf_find_same(nt_scene *scene, const nt_read_options *options, nt_error *error);

/* Fills scene->joins, after nt_gltf_find_same(). mesh->plan.join is left to the caller. With `solved` they will be
 * solved, and same_as becomes what holds then; else they will be compared, and those whose comparison costs many
 * times the solve are left out. With `kept` the tangents that primitives keep are to be checked, so that these stand
 * for themselves as if they got new ones. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_gltf_find_joins(nt_scene *scene, bool solved, bool kept, nt_error *error);

#endif
