/* SPDX-License-Identifier: MIT */
/*
 * Merges the splits of meshes into one list of vertices for each pool.
 *
 * Each mesh was solved and split by itself. If several of them use the same vertex, their tangents for it may
 * agree or not. The copies of a vertex form a chain that begins with itself. For each vertex, a mesh searches the
 * copies: it takes one that has its tangent, else one whose tangent is still unset, else it appends a copy. Copies are
 * found by hash, since a hub may have any number of them. For a mesh that shares nothing the result is exactly its own
 * split, which is taken as it is.
 *
 * The tangents of morph targets stay with the mesh that gave them (scene/values.h), so that one target at a time is
 * unpacked. Two vertices have the same if 128 bits of keyed hashes are equal: to compare them themselves, all targets
 * would have to be there at once.
 */
#include "gltf/edit/edit.h"
#include "gltf/edit/pool_edit.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/vec.h"
#include "gltf/document.h"
#include "gltf/load.h"
#include "scene/values.h"

/* A pool whose meshes are merged one after the other. */
typedef struct nt_pool_merge {
	nt_vertex_pool pool;
	nt_pool_vertices vertices;
	nt_arena *arena;      /* of the document */
	size_t capacity;      /* of the arrays below and those of sets, in vertices */
	uint32_t *source;     /* vertex of the source it is a copy of */
	uint32_t *next;       /* next copy of the same vertex, NT_NONE */
	uint32_t *last;       /* [old_count] last copy of each vertex, or itself */
	nt_hash_index known;  /* copies with a tangent, of all sets */
	uint64_t *digests;    /* [vertex][2] of the mesh that is merged: of the tangents of its targets; NULL: none */
} nt_pool_merge;

/* ---- room ---- */

static bool grow(void **block, size_t old_count, size_t new_count, size_t size)
{
	void *grown = nt_calloc(new_count, size);
	if (!grown)
		return false;
	if (old_count)
		memcpy(grown, *block, old_count * size);
	free(*block);
	*block = grown;
	return true;
}

static bool grow_set(nt_pool_set *set, size_t old, size_t wanted)
{
	bool grown = grow((void **)&set->tangents, old, wanted, 4 * sizeof(float)) &&
		grow((void **)&set->defined, old, wanted, sizeof(bool));
	if (grown && set->normals)
		grown = grow((void **)&set->normals, old, wanted, 3 * sizeof(float));
	if (grown && set->morph_count)
		grown = grow((void **)&set->givers, old, wanted, sizeof *set->givers) &&
			grow((void **)&set->given, old, wanted, sizeof *set->given) &&
			grow((void **)&set->digests, old, wanted, 2 * sizeof *set->digests);
	return grown;
}

static bool reserve_vertices(nt_pool_merge *m, size_t needed)
{
	if (needed <= m->capacity)
		return true;
	const size_t old = m->capacity, wanted = needed + needed / 4 + 64;
	bool grown = grow((void **)&m->source, old, wanted, sizeof *m->source) &&
		grow((void **)&m->next, old, wanted, sizeof *m->next);
	for (size_t g = 0; grown && g < m->pool.sets.count; g++)
		if (m->vertices.sets[g].tangents)
			grown = grow_set(&m->vertices.sets[g], old, wanted);
	if (grown)
		m->capacity = wanted;
	return grown;
}

/* The first mesh of a set says what all of them have. */
static bool start_set(nt_pool_merge *m, nt_pool_set *set, const nt_mesh *mesh)
{
	const size_t old_count = m->vertices.old_count;
	set->morph_count = mesh->morph_count;
	set->normals = mesh->normals_made ? nt_calloc(m->capacity, 3 * sizeof(float)) : NULL;
	set->first_free = nt_alloc(old_count, sizeof *set->first_free);
	if ((mesh->normals_made && !set->normals) || !set->first_free || !grow_set(set, 0, m->capacity))
		return false;
	memcpy(set->first_free, m->source, old_count * sizeof *set->first_free);
	return true;
}

static bool start_merging(nt_pool_merge *m, size_t old_count)
{
	nt_pool_vertices *vertices = &m->vertices;
	vertices->old_count = vertices->own_count = vertices->new_count = old_count;
	vertices->sets = nt_arena_alloc(m->arena, m->pool.sets.count, sizeof *vertices->sets);
	if (vertices->sets)
		memset(vertices->sets, 0, m->pool.sets.count * sizeof *vertices->sets);
	m->last = nt_alloc(old_count, sizeof *m->last);
	if (!vertices->sets || !m->last || !reserve_vertices(m, old_count))
		return false;
	for (size_t i = 0; i < old_count; i++) {
		m->source[i] = m->last[i] = (uint32_t)i;
		m->next[i] = NT_NONE;
	}
	return true;
}

static void free_merge(nt_pool_merge *m)
{
	for (size_t g = 0; m->vertices.sets && g < m->pool.sets.count; g++) {
		nt_pool_set *set = &m->vertices.sets[g];
		free(set->tangents);
		free(set->normals);
		free(set->defined);
		free(set->first_free);
		free(set->givers);
		free(set->given);
		free(set->digests);
	}
	free(m->source);
	free(m->next);
	free(m->last);
	nt_hash_index_free(&m->known);
	free(m);
}

/* ---- vertices ---- */

/* Vertices of a mesh: the source's, those that made normals appended, those that the split appended. */
static uint32_t before_split(const nt_mesh *mesh, uint32_t vertex)
{
	return vertex < mesh->vertex_count ? vertex : mesh->split.sources[vertex - mesh->vertex_count];
}

static uint32_t source_vertex(const nt_mesh *mesh, uint32_t vertex)
{
	vertex = before_split(mesh, vertex);
	while (vertex >= mesh->source_vertex_count)
		vertex = mesh->vertex_sources[vertex - mesh->source_vertex_count];
	return nt_mesh_pool_vertex(mesh, vertex);
}

static bool vertex_fits(const nt_pool_merge *m, const nt_pool_set *set, uint32_t pool_vertex, const nt_mesh *mesh,
	uint32_t vertex, const float *normal)
{
	if (!set->defined[pool_vertex] || memcmp(set->tangents + 4 * (size_t)pool_vertex,
		mesh->split.vertex_tangents + 4 * (size_t)vertex, 4 * sizeof(float)) != 0 ||
		(normal && memcmp(set->normals + 3 * (size_t)pool_vertex, normal, 3 * sizeof(float)) != 0))
		return false;
	return !m->digests || memcmp(set->digests + 2 * (size_t)pool_vertex, m->digests + 2 * (size_t)vertex,
		2 * sizeof *m->digests) == 0;
}

/* The vertex of the pool becomes that of a mesh, which is `user`. */
static void set_vertex(const nt_pool_merge *m, nt_pool_set *set, uint32_t pool_vertex, const nt_mesh *mesh,
	uint32_t user, uint32_t vertex, const float *normal)
{
	memcpy(set->tangents + 4 * (size_t)pool_vertex, mesh->split.vertex_tangents + 4 * (size_t)vertex,
		4 * sizeof(float));
	if (normal)
		memcpy(set->normals + 3 * (size_t)pool_vertex, normal, 3 * sizeof(float));
	if (!m->digests)
		return;
	set->givers[pool_vertex] = user;
	set->given[pool_vertex] = vertex;
	memcpy(set->digests + 2 * (size_t)pool_vertex, m->digests + 2 * (size_t)vertex, 2 * sizeof *m->digests);
}

static uint64_t hash_vertex(const nt_pool_merge *m, uint32_t number, uint32_t source, const nt_mesh *mesh,
	uint32_t vertex)
{
	const uint32_t place[2] = {number, source};
	const uint64_t hash = nt_hash_bytes(nt_hash_bytes(0, place, sizeof place),
		mesh->split.vertex_tangents + 4 * (size_t)vertex, 4 * sizeof(float));
	return m->digests ? nt_hash_words(hash, m->digests[2 * (size_t)vertex]) : hash;
}

/* The first of a vertex and its copies that the set has no tangent for. If all have one, a copy is appended; NT_NONE
 * when memory is exhausted. */
static uint32_t find_free_vertex(nt_pool_merge *m, nt_pool_set *set, uint32_t source)
{
	uint32_t pool_vertex = set->first_free[source];
	while (pool_vertex != NT_NONE && set->defined[pool_vertex])
		pool_vertex = m->next[pool_vertex];
	if (pool_vertex == NT_NONE) {
		if (m->vertices.new_count >= NT_NONE - 1 || !reserve_vertices(m, m->vertices.new_count + 1))
			return NT_NONE;
		pool_vertex = (uint32_t)m->vertices.new_count++;
		m->source[pool_vertex] = source;
		m->next[pool_vertex] = NT_NONE;
		m->next[m->last[source]] = pool_vertex;
		m->last[source] = pool_vertex;
	}
	set->first_free[source] = pool_vertex;
	return pool_vertex;
}

/* The pool's vertex for a vertex of a mesh; NT_NONE when memory is exhausted. */
static uint32_t take_vertex(nt_pool_merge *m, const nt_mesh *mesh, uint32_t user, uint32_t vertex)
{
	const uint32_t number = m->pool.sets.of[user];
	nt_pool_set *set = &m->vertices.sets[number];
	const float *normal = mesh->normals_made && set->normals
		? mesh->normals + 3 * (size_t)before_split(mesh, vertex) : NULL;
	const uint32_t source = source_vertex(mesh, vertex);
	if (vertex_fits(m, set, source, mesh, vertex, normal))
		return source;
	uint32_t pool_vertex = source;
	if (set->defined[source]) {
		const uint64_t hash = hash_vertex(m, number, source, mesh, vertex);
		for (size_t at = NT_HASH_BEGIN; (pool_vertex = nt_hash_index_next(&m->known, hash, &at)) != NT_NONE;)
			if (m->source[pool_vertex] == source && vertex_fits(m, set, pool_vertex, mesh, vertex, normal))
				return pool_vertex;
		const size_t before = m->vertices.new_count;
		pool_vertex = find_free_vertex(m, set, source);
		if (m->vertices.new_count > before && normal && vertex < mesh->vertex_count &&
			memcmp(set->normals + 3 * (size_t)source, normal, 3 * sizeof *normal) != 0)
			m->vertices.normal_copies++;
		if (pool_vertex == NT_NONE || !nt_hash_index_add(&m->known, hash, pool_vertex))
			return NT_NONE;
	}
	set->defined[pool_vertex] = true;
	set_vertex(m, set, pool_vertex, mesh, user, vertex, normal);
	return pool_vertex;
}

/* The vertex of a corner; triangles: NULL: corner c is vertex c. */
static uint32_t vertex_of(const uint32_t *triangles, size_t corner)
{
	return triangles ? triangles[corner] : (uint32_t)corner;
}

static const uint32_t *triangles_of(const nt_mesh *mesh)
{
	return mesh->split.indices ? mesh->split.indices : mesh->indices;
}

/* indices: receives the mesh's triangles with the pool's vertices. */
static bool merge_mesh(nt_pool_merge *m, const nt_mesh *mesh, uint32_t user, uint32_t *indices)
{
	const size_t vertex_count = mesh->vertex_count + mesh->split.source_count;
	const uint32_t *triangles = triangles_of(mesh);
	uint32_t *pool_vertex_of = nt_alloc(vertex_count, sizeof *pool_vertex_of);
	if (!pool_vertex_of)
		return false;
	enum { UNUSED = -1, USED = -2 };
	memset(pool_vertex_of, 0xFF, vertex_count * sizeof *pool_vertex_of);
	for (size_t c = 0; c < mesh->corner_count; c++)
		pool_vertex_of[vertex_of(triangles, c)] = (uint32_t)USED;
	bool merged = true;
	for (uint32_t v = 0; merged && v < vertex_count; v++) {
		if (pool_vertex_of[v] != (uint32_t)USED)
			continue;
		pool_vertex_of[v] = take_vertex(m, mesh, user, v);
		merged = pool_vertex_of[v] != NT_NONE;
	}
	for (size_t c = 0; merged && c < mesh->corner_count; c++)
		indices[c] = pool_vertex_of[vertex_of(triangles, c)];
	free(pool_vertex_of);
	return merged;
}

/* ---- vertices that no corner uses ---- */

/* Any tangent across the normal, as the split of a mesh gives it to a vertex that no corner uses. The solve takes
 * normals of unit length. */
static void set_any_tangent(nt_pool_set *set, size_t vertex, const float *normal)
{
	nt_dvec3 n = nt_dvec3_load(normal), t = {1, 0, 0};
	float unit[3] = {normal[0], normal[1], normal[2]};
	if (!nt_is_unit_normal(normal) && nt_dvec3_normalise(&n))
		nt_dvec3_store(n, unit);
	n = nt_dvec3_load(unit);
	if (nt_dvec3_normalise(&n))
		t = nt_dvec3_perpendicular(n);
	float *tangent = set->tangents + 4 * vertex;
	nt_dvec3_store(t, tangent);
	tangent[3] = 1.0f;
	if (set->morph_count)
		set->givers[vertex] = NT_NONE;
}

static const float up[3] = {0, 0, 1}; /* the normal that making normals gives such vertices */

/* Vertices that no corner of a set uses have the tangent that splitting its first mesh gave them, or would have given
 * them. They stay undefined, so that others take them. */
static nt_status set_unused(nt_pool_merge *m, const nt_mesh *mesh, uint32_t user, nt_error *error)
{
	nt_pool_set *set = &m->vertices.sets[m->pool.sets.of[user]];
	nt_status status = mesh->pool_vertices && !set->normals
		? nt_gltf_load_normals(m->pool.scene->source, mesh, m->arena, &set->source_normals, error) : NT_OK;
	for (size_t v = 0; !status && v < m->vertices.old_count; v++) {
		if (set->defined[v])
			continue;
		if (!mesh->pool_vertices) {
			set_vertex(m, set, (uint32_t)v, mesh, user, (uint32_t)v,
				set->normals ? mesh->normals + 3 * v : NULL);
			continue;
		}
		set_any_tangent(set, v, set->normals ? up : set->source_normals + 3 * v);
		if (set->normals)
			memcpy(set->normals + 3 * v, up, sizeof up);
	}
	return status;
}

/* Copies that no corner of a set uses have what a run on the output would give them: any tangent. */
static void set_unused_copies(const nt_pool_merge *m, uint32_t number)
{
	nt_pool_set *set = &m->vertices.sets[number];
	const nt_mesh *mesh = nt_pool_set_mesh(&m->pool, number);
	const float *loaded = set->source_normals ? set->source_normals : mesh->normals;
	for (size_t copy = m->vertices.old_count; copy < m->vertices.new_count; copy++) {
		const size_t source = m->source[copy];
		if (set->defined[copy])
			continue;
		if (set->normals)
			memcpy(set->normals + 3 * copy, set->normals + 3 * source, 3 * sizeof(float));
		const float *normals = set->normals ? set->normals : loaded;
		set_any_tangent(set, copy, normals ? normals + 3 * source : up);
	}
}

/* ---- one mesh ---- */

/* Digests of the targets of a mesh, for as long as it is merged. Returns NT_OK or NT_ERROR_MEMORY. */
static nt_status digest_targets(nt_pool_merge *m, const nt_mesh *mesh)
{
	const size_t vertex_count = mesh->vertex_count + mesh->split.source_count;
	if (!mesh->morph_count)
		return NT_OK;
	size_t *at = nt_alloc(mesh->morph_tangents->class_count, sizeof *at);
	m->digests = nt_calloc(vertex_count, 2 * sizeof *m->digests);
	const nt_status status = at && m->digests ? NT_OK : NT_ERROR_MEMORY;
	for (size_t k = 0; !status && k < mesh->morph_count; k++) {
		nt_morph_find_rows(mesh, k, at);
		for (size_t v = 0; v < vertex_count; v++) {
			uint64_t *digest = m->digests + 2 * v;
			digest[0] = nt_hash_bytes(digest[0], nt_morph_row(mesh, at, v), 3 * sizeof(float));
			digest[1] = nt_hash_bytes(~digest[1], nt_morph_row(mesh, at, v), 3 * sizeof(float));
		}
	}
	free(at);
	return status;
}

/* A copy differs from what it copies; normals that were made may have given the mesh indices of its own. */
static bool is_changed(const nt_mesh *mesh, const uint32_t *indices)
{
	const uint32_t *triangles = triangles_of(mesh);
	bool changed = mesh->split.source_count || mesh->vertex_count > mesh->source_vertex_count;
	for (size_t c = 0; !changed && c < mesh->corner_count; c++)
		changed = indices[c] != nt_mesh_pool_vertex(mesh, vertex_of(triangles, c));
	return changed;
}

/* The user that is a mesh of the scene: users are in the order of their numbers. NT_NONE: none. */
static uint32_t find_user(const nt_vertex_pool *pool, const nt_mesh *mesh)
{
	size_t low = 0, high = pool->user_count;
	const uint32_t wanted = (uint32_t)(mesh - pool->scene->meshes);
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (pool->users[middle] < wanted)
			low = middle + 1;
		else
			high = middle;
	}
	return low < pool->user_count && pool->users[low] == wanted ? (uint32_t)low : NT_NONE;
}

/* All meshes of a pool have the same number of vertices in a sound document. */
static nt_status check_count(const nt_pool_merge *m, const nt_mesh *mesh, nt_error *error)
{
	const size_t count = mesh->source_vertex_count + mesh->unused_vertices;
	return count == m->vertices.old_count ? NT_OK : nt_fail_pointer(error, NT_ERROR_INPUT,
		nt_gltf_of_mesh(mesh).pointer, "%zu vertices, but a primitive that shares attributes with it has %zu",
		count, m->vertices.old_count);
}

static nt_status merge_user(nt_pool_merge *m, uint32_t user, nt_error *error)
{
	nt_pool_vertices *vertices = &m->vertices;
	const nt_vertex_pool *pool = &m->pool;
	const nt_mesh *mesh = nt_pool_mesh(pool, user);
	const nt_mesh *same_as = mesh->plan.same_as;
	const uint32_t set = pool->sets.of[user], same = same_as ? find_user(pool, same_as) : NT_NONE;
	if (same != NT_NONE && pool->sets.of[same] == set) {
		vertices->users[user] = vertices->users[same];
		return NT_OK;
	}
	if (!m->last && !start_merging(m, mesh->source_vertex_count + mesh->unused_vertices))
		return nt_fail_memory(error);
	nt_status status = check_count(m, mesh, error);
	const bool first = pool->sets.first[set] == user;
	if (!status && ((first && !start_set(m, &vertices->sets[set], mesh)) || digest_targets(m, mesh)))
		status = nt_fail_memory(error);
	uint32_t *indices = status ? NULL : nt_arena_alloc(m->arena, mesh->corner_count, sizeof *indices);
	if (!status && (!indices || !merge_mesh(m, mesh, user, indices)))
		status = nt_fail_memory(error);
	if (!status && first)
		status = set_unused(m, mesh, user, error);
	free(m->digests);
	m->digests = NULL;
	if (!status)
		vertices->users[user] = (nt_user_indices){.numbers = indices, .count = mesh->corner_count,
			.changed = is_changed(mesh, indices)};
	return status;
}

/* ---- one pool ---- */

static nt_pool_merge *new_merge(nt_vertex_pools *pools, size_t number, nt_error *error)
{
	nt_gltf *document = pools->scene->source;
	nt_pool_merge *m = nt_calloc(1, sizeof *m);
	if (!m) {
		nt_fail_memory(error);
		return NULL;
	}
	m->arena = &document->arena;
	m->vertices.pool = &m->pool;
	if (nt_vertex_pools_get(pools, number, m->arena, &m->pool, error)) {
		free(m);
		return NULL;
	}
	const size_t count = m->pool.user_count;
	m->vertices.users = nt_arena_alloc(m->arena, count, sizeof *m->vertices.users);
	if (!m->vertices.users) {
		nt_fail_memory(error);
		free(m);
		return NULL;
	}
	memset(m->vertices.users, 0, count * sizeof *m->vertices.users);
	return m;
}

static void free_merges(nt_vertex_pools *pools)
{
	for (size_t i = 0; i < pools->count; i++)
		if (pools->merges && pools->merges[i])
			free_merge(pools->merges[i]);
	free(pools->merges);
}

/* The merge of a pool, begun where there is none. NULL: memory is exhausted. */
static nt_pool_merge *merge_of(nt_vertex_pools *pools, size_t number, nt_error *error)
{
	if (!pools->merges) {
		pools->merges = nt_calloc(pools->count, sizeof *pools->merges);
		pools->free_merges = free_merges;
	}
	if (!pools->merges) {
		nt_fail_memory(error);
		return NULL;
	}
	if (!pools->merges[number])
		pools->merges[number] = new_merge(pools, number, error);
	return pools->merges[number];
}

nt_status nt_gltf_merge(nt_scene *scene, nt_mesh *mesh, nt_error *error)
{
	const nt_gltf *document = scene->source;
	nt_vertex_pools *pools = document->pools;
	nt_pool_merge *m = merge_of(pools, pools->of[mesh - scene->meshes], error);
	const nt_status status = m ? merge_user(m, find_user(&m->pool, mesh), error) : NT_ERROR_MEMORY;
	mesh->merged = !status;
	return status;
}

/* A pool's only solved mesh, which others of its set may be the same as; NULL where there are several, or where
 * vertices are more than its split. */
static const nt_mesh *lone_mesh(const nt_vertex_pool *pool)
{
	const nt_mesh *lone = NULL;
	for (size_t i = 0; i < pool->user_count && pool->sets.count == 1; i++) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		if (!nt_pool_is_solved(pool, i) || (lone && mesh->plan.same_as == lone))
			continue;
		if (lone || mesh->merged || mesh->normals_made ||
			mesh->vertex_count != mesh->source_vertex_count)
			return NULL;
		lone = mesh;
	}
	return lone;
}

/* The triangles of a mesh after its split. NULL: memory is exhausted, or nobody asks, since the mesh left them. */
static uint32_t *split_triangles(const nt_mesh *mesh, nt_arena *tables)
{
	if (mesh->split.indices || mesh->indices || nt_mesh_left_triangles(mesh))
		return mesh->split.indices ? mesh->split.indices : mesh->indices;
	uint32_t *indices = nt_arena_alloc(tables, mesh->corner_count, sizeof *indices);
	for (size_t c = 0; indices && c < mesh->corner_count; c++)
		indices[c] = (uint32_t)c;
	return indices;
}

/* Vertices of a mesh that shares nothing: its split as it stands, borrowed from the scene. Merging would come
 * to the same in a fifth of the time that the whole conversion of a million triangles takes. */
static bool borrow_split(nt_pool_vertices *vertices, const nt_mesh *mesh, nt_arena *tables)
{
	const size_t user_count = vertices->pool->user_count;
	vertices->old_count = vertices->own_count = mesh->source_vertex_count;
	vertices->new_count = vertices->old_count + mesh->split.source_count;
	vertices->sources = mesh->split.sources;
	vertices->borrowed = true;
	vertices->users = nt_arena_alloc(tables, user_count, sizeof *vertices->users);
	vertices->sets = nt_arena_alloc(tables, 1, sizeof *vertices->sets);
	if (!vertices->users || !vertices->sets)
		return false;
	vertices->sets[0] = (nt_pool_set){.tangents = mesh->split.vertex_tangents, .lone = mesh,
		.morph_count = mesh->morph_count};
	uint32_t *triangles = split_triangles(mesh, tables);
	for (size_t i = 0; i < user_count; i++)
		vertices->users[i] = nt_pool_is_solved(vertices->pool, i) ? (nt_user_indices){.numbers = triangles,
			.count = mesh->corner_count, .changed = mesh->split.source_count > 0}
			: (nt_user_indices){.numbers = NULL};
	return triangles || nt_mesh_left_triangles(mesh);
}

nt_status nt_pool_vertices_get(nt_vertex_pools *pools, size_t number, const nt_vertex_pool *pool, nt_arena *tables,
	nt_pool_vertices *vertices, nt_error *error)
{
	const nt_mesh *lone = lone_mesh(pool);
	*vertices = (nt_pool_vertices){.pool = pool};
	if (lone)
		return borrow_split(vertices, lone, tables) ? NT_OK : nt_fail_memory(error);
	nt_pool_merge *m = merge_of(pools, number, error);
	nt_status status = m ? NT_OK : NT_ERROR_MEMORY;
	for (uint32_t i = 0; !status && i < pool->user_count; i++)
		if (nt_pool_is_solved(pool, i) && !m->vertices.users[i].numbers)
			status = merge_user(m, i, error);
	if (status)
		return status;
	for (uint32_t set = 0; set < pool->sets.count; set++)
		set_unused_copies(m, set);
	/* an edit may put other arrays in their place */
	nt_pool_set *sets = nt_arena_alloc(tables, pool->sets.count, sizeof *sets);
	if (!sets)
		return nt_fail_memory(error);
	*vertices = m->vertices;
	vertices->pool = pool;
	vertices->sources = m->source + m->vertices.old_count;
	vertices->sets = memcpy(sets, m->vertices.sets, pool->sets.count * sizeof *sets);
	return NT_OK;
}

/* ---- targets ---- */

/* The rows of a mesh for a target. NULL: memory is exhausted. */
static const size_t *rows_of(const nt_mesh *mesh, size_t m, nt_arena *scratch)
{
	nt_morph_tangents *all = mesh->morph_tangents;
	if (!all->rows && (all->rows = nt_arena_alloc(scratch, all->class_count, sizeof *all->rows)))
		nt_morph_find_rows(mesh, m, all->rows);
	return all->rows;
}

const float *nt_pool_read_target(const nt_pool_vertices *vertices, uint32_t set, size_t m, nt_arena *scratch)
{
	const nt_vertex_pool *pool = vertices->pool;
	const nt_pool_set *of = &vertices->sets[set];
	float *moved = nt_arena_alloc(scratch, vertices->new_count, 3 * sizeof *moved);
	if (moved && !of->given)
		return nt_morph_read(of->lone, m, moved) == NT_OK ? moved : NULL;
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i])
		nt_pool_mesh(pool, i)->morph_tangents->rows = NULL;
	for (size_t v = 0; moved && v < vertices->new_count; v++) {
		const nt_mesh *mesh = of->lone;
		if (!mesh && of->givers[v] != NT_NONE)
			mesh = nt_pool_mesh(pool, of->givers[v]);
		const size_t *rows = mesh ? rows_of(mesh, m, scratch) : NULL;
		if (mesh && !rows)
			return NULL;
		memcpy(moved + 3 * v, mesh ? nt_morph_row(mesh, rows, of->given[v]) : of->tangents + 4 * v,
			3 * sizeof *moved);
	}
	return moved;
}
