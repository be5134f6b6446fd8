/* SPDX-License-Identifier: MIT */
/*
 * The vertices that the accessors of a pool will have: its vertices, to tell them from those of its meshes.
 *
 * Each mesh was solved and split by itself. Where several of them use the same vertex, their tangents for it
 * may agree or not. The vertices of a vertex form a chain that begins with its own; a mesh takes the pool_vertex of the
 * chain where its set has the same tangent, else the first one where it has none yet, and appends a pool_vertex
 * where all have one; by hash, since a hub may have any number of vertices. For a mesh that shares nothing this
 * is exactly its own split, which is taken as it is.
 */
#include "gltf/edit/merge_splits.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "gltf/load.h"
#include "gltf/pointer.h"

typedef struct merging {
	nt_pool_vertices *vertices;
	size_t capacity;      /* of the arrays below, in vertices */
	uint32_t *source;     /* vertex of the source it is a copy of */
	uint32_t *next;       /* next copy of the same vertex, NT_NONE */
	uint32_t *last;       /* [old_count] last copy of each vertex, or itself */
	uint32_t **first_free; /* [set][old_count] before this one the set has tangents for all copies of a vertex */
	nt_hash_index known;  /* copies with a tangent, of all sets */
	float **tangents;     /* [set] */
	float **normals;      /* [set] or NULL */
	float ***morphs;      /* [set][morph_counts[set]] */
	size_t *morph_counts; /* [set] */
	bool **defined;       /* [set][vertex] */
	bool *has_normals;    /* [set] */
} merging;

static bool grow(void **block, size_t old_count, size_t new_count, size_t size)
{
	void *grown = nt_alloc(new_count, size);
	if (!grown)
		return false;
	if (old_count)
		memcpy(grown, *block, old_count * size);
	memset((char *)grown + old_count * size, 0, (new_count - old_count) * size);
	free(*block);
	*block = grown;
	return true;
}

static bool reserve_vertices(merging *m, size_t needed)
{
	if (needed <= m->capacity)
		return true;
	const size_t old = m->capacity, wanted = needed + needed / 4 + 64;
	bool grown = grow((void **)&m->source, old, wanted, sizeof *m->source) &&
		grow((void **)&m->next, old, wanted, sizeof *m->next);
	for (size_t g = 0; grown && g < m->vertices->pool->sets.count; g++) {
		grown = grow((void **)&m->tangents[g], old, wanted, 4 * sizeof(float)) &&
			grow((void **)&m->defined[g], old, wanted, sizeof(bool));
		if (grown && m->has_normals[g])
			grown = grow((void **)&m->normals[g], old, wanted, 3 * sizeof(float));
		for (size_t k = 0; grown && k < m->morph_counts[g]; k++)
			grown = grow((void **)&m->morphs[g][k], old, wanted, 3 * sizeof(float));
	}
	if (grown)
		m->capacity = wanted;
	return grown;
}

static bool start_merging(merging *m, nt_pool_vertices *vertices)
{
	const nt_vertex_pool *pool = vertices->pool;
	*m = (merging){.vertices = vertices,
		.tangents = nt_calloc(vertices->pool->sets.count, sizeof *m->tangents),
		.normals = nt_calloc(vertices->pool->sets.count, sizeof *m->normals),
		.defined = nt_calloc(vertices->pool->sets.count, sizeof *m->defined),
		.has_normals = nt_calloc(vertices->pool->sets.count, sizeof *m->has_normals),
		.morphs = nt_calloc(vertices->pool->sets.count, sizeof *m->morphs),
		.morph_counts = nt_calloc(vertices->pool->sets.count, sizeof *m->morph_counts)};
	if (!m->tangents || !m->normals || !m->defined || !m->has_normals || !m->morphs ||
		!m->morph_counts)
		return false;
	for (size_t i = 0; i < pool->user_count; i++) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		const uint32_t set = pool->sets.of[i];
		if (set == NT_NONE)
			continue;
		m->has_normals[set] |= mesh->normals_made;
		if (m->morphs[set])
			continue;
		m->morphs[set] = nt_calloc(mesh->morph_count, sizeof *m->morphs[set]);
		if (!m->morphs[set])
			return false;
		m->morph_counts[set] = mesh->morph_count;
	}
	m->last = nt_alloc(vertices->old_count, sizeof *m->last);
	m->first_free = nt_calloc(vertices->pool->sets.count, sizeof *m->first_free);
	if (!m->last || !m->first_free || !reserve_vertices(m, vertices->old_count))
		return false;
	for (size_t i = 0; i < vertices->old_count; i++) {
		m->source[i] = m->last[i] = (uint32_t)i;
		m->next[i] = NT_NONE;
	}
	for (size_t g = 0; g < vertices->pool->sets.count; g++) {
		m->first_free[g] = nt_alloc(vertices->old_count, sizeof **m->first_free);
		if (!m->first_free[g])
			return false;
		memcpy(m->first_free[g], m->source, vertices->old_count * sizeof **m->first_free);
	}
	vertices->new_count = vertices->old_count;
	return true;
}

static void end_merging(merging *m)
{
	for (size_t g = 0; g < m->vertices->pool->sets.count; g++) {
		if (m->tangents)
			free(m->tangents[g]);
		if (m->normals)
			free(m->normals[g]);
		if (m->defined)
			free(m->defined[g]);
		if (m->first_free)
			free(m->first_free[g]);
		for (size_t k = 0; m->morphs && m->morphs[g] && k < m->morph_counts[g]; k++)
			free(m->morphs[g][k]);
		if (m->morphs)
			free(m->morphs[g]);
	}
	free(m->morphs);
	free(m->morph_counts);
	free(m->tangents);
	free(m->normals);
	free(m->defined);
	free(m->has_normals);
	free(m->source);
	free(m->next);
	free(m->last);
	free(m->first_free);
	nt_hash_index_free(&m->known);
}

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
	return vertex;
}

static bool same_morphs(const merging *m, uint32_t set, uint32_t pool_vertex, const nt_mesh *mesh,
	uint32_t vertex)
{
	for (size_t k = 0; k < m->morph_counts[set]; k++)
		if (memcmp(m->morphs[set][k] + 3 * (size_t)pool_vertex,
			mesh->morphs[k].vertex_tangents + 3 * (size_t)vertex, 3 * sizeof(float)) != 0)
			return false;
	return true;
}

static void define_morphs(merging *m, uint32_t set, uint32_t pool_vertex, const nt_mesh *mesh, uint32_t vertex)
{
	for (size_t k = 0; k < m->morph_counts[set]; k++)
		memcpy(m->morphs[set][k] + 3 * (size_t)pool_vertex,
			mesh->morphs[k].vertex_tangents + 3 * (size_t)vertex, 3 * sizeof(float));
}

static uint64_t hash_vertex(uint32_t set, uint32_t source, const float *tangent)
{
	const uint32_t place[2] = {set, source};
	return nt_hash_bytes(nt_hash_bytes(0, place, sizeof place), tangent, 4 * sizeof *tangent);
}

static bool vertex_fits(const merging *m, uint32_t set, uint32_t pool_vertex, const float *tangent,
	const float *normal)
{
	return memcmp(m->tangents[set] + 4 * (size_t)pool_vertex, tangent, 4 * sizeof(float)) == 0 &&
		(!normal || memcmp(m->normals[set] + 3 * (size_t)pool_vertex, normal, 3 * sizeof(float)) == 0);
}

static void define_vertex(merging *m, uint32_t set, uint32_t pool_vertex, const float *tangent,
	const float *normal)
{
	m->defined[set][pool_vertex] = true;
	memcpy(m->tangents[set] + 4 * (size_t)pool_vertex, tangent, 4 * sizeof(float));
	if (normal)
		memcpy(m->normals[set] + 3 * (size_t)pool_vertex, normal, 3 * sizeof(float));
}

/* The vertex `source`, or a copy of it, that has the mesh's tangent already; NT_NONE: none. */
static uint32_t find_vertex(const merging *m, const nt_mesh *mesh, uint32_t set, uint32_t vertex,
	uint32_t source, uint64_t hash, const float *normal)
{
	const float *tangent = mesh->split.vertex_tangents + 4 * (size_t)vertex;
	if (m->defined[set][source] && vertex_fits(m, set, source, tangent, normal) &&
		same_morphs(m, set, source, mesh, vertex))
		return source;
	uint32_t pool_vertex;
	for (size_t at = NT_HASH_BEGIN; (pool_vertex = nt_hash_index_next(&m->known, hash, &at)) != NT_NONE;)
		if (m->source[pool_vertex] == source && m->defined[set][pool_vertex] &&
			vertex_fits(m, set, pool_vertex, tangent, normal) &&
			same_morphs(m, set, pool_vertex, mesh, vertex))
			return pool_vertex;
	return NT_NONE;
}

/* The first of a vertex and its copies that the set has no tangent for. Where it has them all a copy is
 * appended; NT_NONE when memory is exhausted. */
static uint32_t find_free_vertex(merging *m, uint32_t set, uint32_t source)
{
	uint32_t pool_vertex = m->first_free[set][source];
	while (pool_vertex != NT_NONE && m->defined[set][pool_vertex])
		pool_vertex = m->next[pool_vertex];
	if (pool_vertex == NT_NONE) {
		if (m->vertices->new_count >= NT_NONE - 1 || !reserve_vertices(m, m->vertices->new_count + 1))
			return NT_NONE;
		pool_vertex = (uint32_t)m->vertices->new_count++;
		m->source[pool_vertex] = source;
		m->next[pool_vertex] = NT_NONE;
		m->next[m->last[source]] = pool_vertex;
		m->last[source] = pool_vertex;
	}
	m->first_free[set][source] = pool_vertex;
	return pool_vertex;
}

/* The pool's vertex for a vertex of a mesh; NT_NONE when memory is exhausted. */
static uint32_t take_vertex(merging *m, const nt_mesh *mesh, uint32_t set, uint32_t vertex)
{
	const float *tangent = mesh->split.vertex_tangents + 4 * (size_t)vertex;
	const float *normal =
		mesh->normals_made ? mesh->normals + 3 * (size_t)before_split(mesh, vertex) : NULL;
	const uint32_t source = source_vertex(mesh, vertex);
	uint64_t hash = hash_vertex(set, source, tangent);
	for (size_t k = 0; k < m->morph_counts[set]; k++)
		hash = nt_hash_bytes(hash, mesh->morphs[k].vertex_tangents + 3 * (size_t)vertex,
			3 * sizeof(float));
	uint32_t pool_vertex = find_vertex(m, mesh, set, vertex, source, hash, normal);
	if (pool_vertex != NT_NONE)
		return pool_vertex;
	pool_vertex = find_free_vertex(m, set, source);
	if (pool_vertex == NT_NONE || (pool_vertex != source &&
		!nt_hash_index_add(&m->known, hash, pool_vertex)))
		return NT_NONE;
	define_vertex(m, set, pool_vertex, tangent, normal);
	define_morphs(m, set, pool_vertex, mesh, vertex);
	return pool_vertex;
}

/* The vertex of a corner; triangles: NULL: corner c is vertex c. */
static uint32_t vertex_of(const uint32_t *triangles, size_t corner)
{
	return triangles ? triangles[corner] : (uint32_t)corner;
}

/* triangles: of the mesh after its split; indices: receives them with the pool's vertices. */
static bool merge_mesh(merging *m, const nt_mesh *mesh, uint32_t set, const uint32_t *triangles, uint32_t *indices)
{
	const size_t vertex_count = mesh->vertex_count + mesh->split.source_count;
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
		pool_vertex_of[v] = take_vertex(m, mesh, set, v);
		merged = pool_vertex_of[v] != NT_NONE;
	}
	for (size_t c = 0; merged && c < mesh->corner_count; c++)
		indices[c] = pool_vertex_of[vertex_of(triangles, c)];
	free(pool_vertex_of);
	return merged;
}

/* Vertices that no corner of a set uses have the tangent that splitting its first mesh gave them. They stay
 * undefined, so that others take them. */
static void set_unused(merging *m, const nt_mesh *mesh, uint32_t set)
{
	for (size_t v = 0; v < m->vertices->old_count; v++) {
		if (m->defined[set][v])
			continue;
		memcpy(m->tangents[set] + 4 * v, mesh->split.vertex_tangents + 4 * v, 4 * sizeof(float));
		if (m->has_normals[set])
			memcpy(m->normals[set] + 3 * v, mesh->normals + 3 * v, 3 * sizeof(float));
		for (size_t k = 0; k < m->morph_counts[set]; k++)
			memcpy(m->morphs[set][k] + 3 * v, mesh->morphs[k].vertex_tangents + 3 * v, 3 * sizeof(float));
	}
}

/* Copies that no corner of a set uses have that of the vertex they copy. */
static void set_unused_copies(merging *m, uint32_t set)
{
	for (size_t copy = m->vertices->old_count; copy < m->vertices->new_count; copy++) {
		const size_t source = m->source[copy];
		if (m->defined[set][copy])
			continue;
		define_vertex(m, set, (uint32_t)copy, m->tangents[set] + 4 * source,
			m->has_normals[set] ? m->normals[set] + 3 * source : NULL);
		for (size_t k = 0; k < m->morph_counts[set]; k++)
			memcpy(m->morphs[set][k] + 3 * copy, m->morphs[set][k] + 3 * source, 3 * sizeof(float));
	}
}

/* Hands the results to the arenas. */
static bool keep_vertices(merging *m, nt_arena *arena, nt_arena *tables)
{
	nt_pool_vertices *vertices = m->vertices;
	vertices->sources = nt_arena_alloc(tables, vertices->new_count - vertices->old_count, sizeof(uint32_t));
	vertices->tangents = nt_arena_alloc(tables, vertices->pool->sets.count, sizeof *vertices->tangents);
	vertices->normals = nt_arena_alloc(tables, vertices->pool->sets.count, sizeof *vertices->normals);
	vertices->morphs = nt_arena_alloc(tables, vertices->pool->sets.count, sizeof *vertices->morphs);
	if (!vertices->sources || !vertices->tangents || !vertices->normals || !vertices->morphs)
		return false;
	for (size_t i = vertices->old_count; i < vertices->new_count; i++)
		vertices->sources[i - vertices->old_count] = m->source[i];
	bool kept = true;
	for (size_t g = 0; g < vertices->pool->sets.count; g++) {
		vertices->tangents[g] = m->tangents[g];
		vertices->normals[g] = m->normals[g];
		m->tangents[g] = m->normals[g] = NULL;
		kept &= nt_arena_adopt(arena, vertices->tangents[g]);
		kept &= nt_arena_adopt(arena, vertices->normals[g]);
		vertices->morphs[g] = m->morphs[g];
		m->morphs[g] = NULL;
		for (size_t k = 0; k < m->morph_counts[g]; k++)
			kept &= nt_arena_adopt(arena, vertices->morphs[g][k]);
		kept &= nt_arena_adopt(arena, vertices->morphs[g]);
	}
	return kept;
}

static bool same_triangles(const nt_mesh *mesh, const uint32_t *triangles, const uint32_t *indices)
{
	for (size_t c = 0; c < mesh->corner_count; c++)
		if (indices[c] != vertex_of(triangles, c))
			return false;
	return true;
}

/* The user that a mesh shares its geometry with: users are in the order of their numbers. NT_NONE: none, or
 * of another pool. */
static uint32_t find_same(const nt_vertex_pool *pool, const nt_mesh *mesh)
{
	size_t low = 0, high = pool->user_count;
	const uint32_t wanted = mesh->same_as ? (uint32_t)(mesh->same_as - pool->scene->meshes) : NT_NONE;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (pool->users[middle] < wanted)
			low = middle + 1;
		else
			high = middle;
	}
	return low < pool->user_count && pool->users[low] == wanted ? (uint32_t)low : NT_NONE;
}

/* The users behind `user` that are late and can be solved with it: meshes in a row. */
static uint32_t count_late(const nt_vertex_pool *pool, uint32_t user)
{
	uint32_t count = 0;
	size_t corners = 0;
	while (user + count < pool->user_count && pool->users[user + count] == pool->users[user] + count) {
		const nt_mesh *mesh = nt_pool_mesh(pool, user + count);
		corners += mesh->same_as ? 0 : 3 * mesh->face_count;
		if (!mesh->late || (count && corners > NT_LATE_CORNERS))
			break;
		count++;
	}
	return count;
}

/* The triangles of a mesh after its split: those that it left are read again. NULL: corner c is vertex c. */
static nt_status find_triangles(const merging *m, const nt_mesh *mesh, nt_arena *passing, uint32_t **triangles,
	nt_error *error)
{
	*triangles = mesh->split.indices ? mesh->split.indices : mesh->indices;
	return nt_mesh_left_triangles(mesh) ?
		nt_gltf_load_triangles(m->vertices->pool->scene->source, mesh, passing, triangles, error) : NT_OK;
}

/* Merges one solved user; what it holds is not needed any more. */
static nt_status merge_user(merging *m, uint32_t user, nt_arena *arena, nt_error *error)
{
	nt_pool_vertices *vertices = m->vertices;
	const nt_vertex_pool *pool = vertices->pool;
	const nt_mesh *mesh = nt_pool_mesh(pool, user);
	const uint32_t set = pool->sets.of[user], same = find_same(pool, mesh);
	if (same != NT_NONE && pool->sets.of[same] == set) {
		vertices->indices[user] = vertices->indices[same];
		vertices->changed[user] = vertices->changed[same];
		return NT_OK;
	}
	uint32_t *triangles, *const indices = nt_arena_alloc(arena, mesh->corner_count, sizeof *indices);
	nt_arena passing = {0};
	nt_status status = indices ? find_triangles(m, mesh, &passing, &triangles, error) : nt_fail_memory(error);
	if (!status && !merge_mesh(m, mesh, set, triangles, indices))
		status = nt_fail_memory(error);
	if (!status && pool->sets.first[set] == user)
		set_unused(m, mesh, set);
	vertices->indices[user] = indices;
	/* a copy differs from what it copies; normals that were made may have given the mesh indices of its own */
	vertices->changed[user] = !status &&
		(mesh->split.source_count || mesh->vertex_count > mesh->source_vertex_count ||
		!same_triangles(mesh, triangles, indices));
	nt_arena_free(&passing);
	return status;
}

static nt_status merge_users(merging *m, nt_arena *arena, nt_error *error)
{
	nt_pool_vertices *vertices = m->vertices;
	const nt_vertex_pool *pool = vertices->pool;
	const nt_scene *scene = pool->scene;
	for (uint32_t i = 0, ready = 0; i < pool->user_count; i++) {
		vertices->indices[i] = NULL;
		vertices->changed[i] = false;
		if (!nt_pool_is_solved(pool, i))
			continue;
		if (nt_pool_mesh(pool, i)->late && i >= ready) {
			const uint32_t count = count_late(pool, i);
			const nt_status status = scene->solve_late(scene->late, pool->users[i], count, error);
			if (status)
				return status;
			ready = i + count;
		}
		const nt_status status = merge_user(m, i, arena, error);
		if (status)
			return status;
	}
	for (uint32_t set = 0; set < pool->sets.count; set++)
		set_unused_copies(m, set);
	return NT_OK;
}

/* A pool's only solved mesh, which others of its set may be the same as; NULL where there are several, or where
 * vertices are more than its split. */
static const nt_mesh *lone_mesh(const nt_vertex_pool *pool)
{
	const nt_mesh *lone = NULL;
	for (size_t i = 0; i < pool->user_count && pool->sets.count == 1; i++) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		if (!nt_pool_is_solved(pool, i) || (lone && mesh->same_as == lone))
			continue;
		if (lone || mesh->late || mesh->normals_made || mesh->morph_count ||
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
	vertices->new_count = vertices->old_count + mesh->split.source_count;
	vertices->sources = mesh->split.sources;
	vertices->borrowed = true;
	vertices->tangents = nt_arena_alloc(tables, 1, sizeof *vertices->tangents);
	vertices->normals = nt_arena_alloc(tables, 1, sizeof *vertices->normals);
	vertices->morphs = nt_arena_alloc(tables, 1, sizeof *vertices->morphs);
	if (!vertices->tangents || !vertices->normals || !vertices->morphs)
		return false;
	vertices->tangents[0] = mesh->split.vertex_tangents;
	vertices->normals[0] = NULL;
	vertices->morphs[0] = NULL;
	uint32_t *triangles = split_triangles(mesh, tables);
	for (size_t i = 0; i < vertices->pool->user_count; i++) {
		const bool solved = nt_pool_is_solved(vertices->pool, i);
		vertices->indices[i] = solved ? triangles : NULL;
		vertices->changed[i] = solved && mesh->split.source_count > 0;
	}
	return triangles || nt_mesh_left_triangles(mesh);
}

/* All users of a pool have the same number of vertices in a sound document. */
static nt_status check_counts(nt_pool_vertices *vertices, nt_error *error)
{
	bool first = true;
	for (size_t i = 0; i < vertices->pool->user_count; i++) {
		const nt_mesh *mesh = nt_pool_mesh(vertices->pool, i);
		if (!nt_pool_is_solved(vertices->pool, i))
			continue;
		if (!first && mesh->source_vertex_count != vertices->old_count)
			return nt_fail_pointer(error, NT_ERROR_INPUT, nt_gltf_of_mesh(mesh).pointer,
				"%zu vertices, but a primitive that shares attributes with it has %zu",
				mesh->source_vertex_count, vertices->old_count);
		vertices->old_count = mesh->source_vertex_count;
		first = false;
	}
	return NT_OK;
}

nt_status nt_merge_splits(nt_pool_vertices *vertices, const nt_vertex_pool *pool, nt_arena *arena, nt_arena *tables,
	nt_error *error)
{
	*vertices = (nt_pool_vertices){.pool = pool,
		.indices = nt_arena_alloc(tables, pool->user_count, sizeof *vertices->indices),
		.changed = nt_arena_alloc(tables, pool->user_count, sizeof *vertices->changed)};
	if (!vertices->indices || !vertices->changed)
		return nt_fail_memory(error);
	nt_status status = check_counts(vertices, error);
	if (status)
		return status;
	const nt_mesh *lone = lone_mesh(pool);
	if (lone)
		return borrow_split(vertices, lone, tables) ? NT_OK : nt_fail_memory(error);
	merging m;
	status = start_merging(&m, vertices) ? merge_users(&m, arena, error) : nt_fail_memory(error);
	if (!status && !keep_vertices(&m, arena, tables))
		status = nt_fail_memory(error);
	end_merging(&m);
	return status;
}
