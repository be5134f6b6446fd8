/* SPDX-License-Identifier: MIT */
/*
 * The vertices that the accessors of a pool will have: rows, to tell them from the vertices of the meshes.
 *
 * Each mesh was solved and split by itself. Where several of them use the same vertex, their tangents for it
 * may agree or not. The rows of a vertex form a chain that begins with its own; a mesh takes the row of the
 * chain where its set has the same tangent, else the first one where it has none yet, and appends a row
 * where all have one; by hash, since a hub may have any number of rows. For a mesh that shares nothing this
 * is exactly its own split, which is taken as it is.
 */
#include "gltf/edit/merge_splits.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"

typedef struct merging {
	nt_pool_vertices *rows;
	size_t capacity;      /* of the arrays below, in rows */
	uint32_t *source;     /* row of the source it is a copy of */
	uint32_t *next;       /* next row of the same vertex, NT_NONE */
	uint32_t *last;       /* [old_count] last row of each vertex */
	uint32_t **first_free; /* [set][old_count] before this row the set has a tangent for all of a vertex */
	nt_hash_index known;  /* defined rows behind the first of their vertex, of all sets */
	float **tangents;     /* [set] */
	float **normals;      /* [set] or NULL */
	float ***morphs;      /* [set][morph_counts[set]] */
	size_t *morph_counts; /* [set] */
	bool **defined;       /* [set][row] */
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

static bool reserve_rows(merging *m, size_t needed)
{
	if (needed <= m->capacity)
		return true;
	const size_t old = m->capacity, wanted = needed + needed / 4 + 64;
	bool grown = grow((void **)&m->source, old, wanted, sizeof *m->source) &&
		grow((void **)&m->next, old, wanted, sizeof *m->next);
	for (size_t g = 0; grown && g < m->rows->pool->sets.count; g++) {
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

static bool start_merging(merging *m, nt_pool_vertices *rows)
{
	const nt_vertex_pool *pool = rows->pool;
	*m = (merging){.rows = rows,
		.tangents = nt_calloc(rows->pool->sets.count, sizeof *m->tangents),
		.normals = nt_calloc(rows->pool->sets.count, sizeof *m->normals),
		.defined = nt_calloc(rows->pool->sets.count, sizeof *m->defined),
		.has_normals = nt_calloc(rows->pool->sets.count, sizeof *m->has_normals),
		.morphs = nt_calloc(rows->pool->sets.count, sizeof *m->morphs),
		.morph_counts = nt_calloc(rows->pool->sets.count, sizeof *m->morph_counts)};
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
	m->last = nt_alloc(rows->old_count, sizeof *m->last);
	m->first_free = nt_calloc(rows->pool->sets.count, sizeof *m->first_free);
	if (!m->last || !m->first_free || !reserve_rows(m, rows->old_count))
		return false;
	for (size_t i = 0; i < rows->old_count; i++) {
		m->source[i] = m->last[i] = (uint32_t)i;
		m->next[i] = NT_NONE;
	}
	for (size_t g = 0; g < rows->pool->sets.count; g++) {
		m->first_free[g] = nt_alloc(rows->old_count, sizeof **m->first_free);
		if (!m->first_free[g])
			return false;
		memcpy(m->first_free[g], m->source, rows->old_count * sizeof **m->first_free);
	}
	rows->new_count = rows->old_count;
	return true;
}

static void end_merging(merging *m)
{
	for (size_t g = 0; g < m->rows->pool->sets.count; g++) {
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

static uint32_t source_row(const nt_mesh *mesh, uint32_t vertex)
{
	vertex = before_split(mesh, vertex);
	while (vertex >= mesh->source_vertex_count)
		vertex = mesh->vertex_sources[vertex - mesh->source_vertex_count];
	return vertex;
}

static bool same_morphs(const merging *m, uint32_t set, uint32_t row, const nt_mesh *mesh,
	uint32_t vertex)
{
	for (size_t k = 0; k < m->morph_counts[set]; k++)
		if (memcmp(m->morphs[set][k] + 3 * (size_t)row,
			mesh->morphs[k].vertex_tangents + 3 * (size_t)vertex, 3 * sizeof(float)) != 0)
			return false;
	return true;
}

static void define_morphs(merging *m, uint32_t set, uint32_t row, const nt_mesh *mesh, uint32_t vertex)
{
	for (size_t k = 0; k < m->morph_counts[set]; k++)
		memcpy(m->morphs[set][k] + 3 * (size_t)row,
			mesh->morphs[k].vertex_tangents + 3 * (size_t)vertex, 3 * sizeof(float));
}

static uint64_t hash_row(uint32_t set, uint32_t source, const float *tangent)
{
	const uint32_t place[2] = {set, source};
	return nt_hash_bytes(nt_hash_bytes(0, place, sizeof place), tangent, 4 * sizeof *tangent);
}

static bool row_fits(const merging *m, uint32_t set, uint32_t row, const float *tangent,
	const float *normal)
{
	return memcmp(m->tangents[set] + 4 * (size_t)row, tangent, 4 * sizeof(float)) == 0 &&
		(!normal || memcmp(m->normals[set] + 3 * (size_t)row, normal, 3 * sizeof(float)) == 0);
}

static void define_row(merging *m, uint32_t set, uint32_t row, const float *tangent,
	const float *normal)
{
	m->defined[set][row] = true;
	memcpy(m->tangents[set] + 4 * (size_t)row, tangent, 4 * sizeof(float));
	if (normal)
		memcpy(m->normals[set] + 3 * (size_t)row, normal, 3 * sizeof(float));
}

/* A row of the vertex `source` that has the mesh's tangent already; NT_NONE: none. */
static uint32_t find_row(const merging *m, const nt_mesh *mesh, uint32_t set, uint32_t vertex, uint32_t source,
	uint64_t hash, const float *normal)
{
	const float *tangent = mesh->split.vertex_tangents + 4 * (size_t)vertex;
	if (m->defined[set][source] && row_fits(m, set, source, tangent, normal) &&
		same_morphs(m, set, source, mesh, vertex))
		return source;
	uint32_t row;
	for (size_t at = NT_HASH_BEGIN; (row = nt_hash_index_next(&m->known, hash, &at)) != NT_NONE;)
		if (m->source[row] == source && m->defined[set][row] &&
			row_fits(m, set, row, tangent, normal) && same_morphs(m, set, row, mesh, vertex))
			return row;
	return NT_NONE;
}

/* The first row of a vertex that the set has no tangent for, appended where it has all; NT_NONE when memory
 * is exhausted. */
static uint32_t find_free_row(merging *m, uint32_t set, uint32_t source)
{
	uint32_t row = m->first_free[set][source];
	while (row != NT_NONE && m->defined[set][row])
		row = m->next[row];
	if (row == NT_NONE) {
		if (m->rows->new_count >= NT_NONE - 1 || !reserve_rows(m, m->rows->new_count + 1))
			return NT_NONE;
		row = (uint32_t)m->rows->new_count++;
		m->source[row] = source;
		m->next[row] = NT_NONE;
		m->next[m->last[source]] = row;
		m->last[source] = row;
	}
	m->first_free[set][source] = row;
	return row;
}

/* The row for a vertex of a mesh; NT_NONE when memory is exhausted. */
static uint32_t take_row(merging *m, const nt_mesh *mesh, uint32_t set, uint32_t vertex)
{
	const float *tangent = mesh->split.vertex_tangents + 4 * (size_t)vertex;
	const float *normal =
		mesh->normals_made ? mesh->normals + 3 * (size_t)before_split(mesh, vertex) : NULL;
	const uint32_t source = source_row(mesh, vertex);
	uint64_t hash = hash_row(set, source, tangent);
	for (size_t k = 0; k < m->morph_counts[set]; k++)
		hash = nt_hash_bytes(hash, mesh->morphs[k].vertex_tangents + 3 * (size_t)vertex,
			3 * sizeof(float));
	uint32_t row = find_row(m, mesh, set, vertex, source, hash, normal);
	if (row != NT_NONE)
		return row;
	row = find_free_row(m, set, source);
	if (row == NT_NONE || (row != source && !nt_hash_index_add(&m->known, hash, row)))
		return NT_NONE;
	define_row(m, set, row, tangent, normal);
	define_morphs(m, set, row, mesh, vertex);
	return row;
}

/* The vertex of a corner after the split. */
static uint32_t split_vertex(const nt_mesh *mesh, size_t corner)
{
	const uint32_t *indices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	return indices ? indices[corner] : (uint32_t)corner;
}

static bool merge_mesh(merging *m, const nt_mesh *mesh, uint32_t set, uint32_t *indices)
{
	const size_t vertex_count = mesh->vertex_count + mesh->split.source_count;
	uint32_t *row_of = nt_alloc(vertex_count, sizeof *row_of);
	if (!row_of)
		return false;
	enum { UNUSED = -1, USED = -2 };
	memset(row_of, 0xFF, vertex_count * sizeof *row_of);
	for (size_t c = 0; c < mesh->corner_count; c++)
		row_of[split_vertex(mesh, c)] = (uint32_t)USED;
	bool merged = true;
	for (uint32_t v = 0; merged && v < vertex_count; v++) {
		if (row_of[v] != (uint32_t)USED)
			continue;
		row_of[v] = take_row(m, mesh, set, v);
		merged = row_of[v] != NT_NONE;
	}
	for (size_t c = 0; merged && c < mesh->corner_count; c++)
		indices[c] = row_of[split_vertex(mesh, c)];
	free(row_of);
	return merged;
}

/* Rows that no corner of a set uses get the tangent that splitting gave them, copies that of the row
 * they copy. */
static void fill_unused(merging *m, const nt_mesh *mesh, uint32_t set)
{
	for (size_t row = 0; row < m->rows->new_count; row++) {
		if (m->defined[set][row])
			continue;
		const uint32_t source = m->source[row];
		const bool own = row < m->rows->old_count || !m->defined[set][source];
		const float *tangent = own ? mesh->split.vertex_tangents + 4 * (size_t)source :
					     m->tangents[set] + 4 * (size_t)source;
		const float *normal = NULL;
		if (m->has_normals[set])
			normal = own ? mesh->normals + 3 * (size_t)source :
				       m->normals[set] + 3 * (size_t)source;
		define_row(m, set, (uint32_t)row, tangent, normal);
		for (size_t k = 0; k < m->morph_counts[set]; k++)
			memcpy(m->morphs[set][k] + 3 * row,
				own ? mesh->morphs[k].vertex_tangents + 3 * (size_t)source :
				      m->morphs[set][k] + 3 * (size_t)source, 3 * sizeof(float));
	}
}

/* Hands the results to the arena. */
static bool keep_rows(merging *m, nt_arena *arena)
{
	nt_pool_vertices *rows = m->rows;
	rows->sources = nt_arena_alloc(arena, rows->new_count - rows->old_count, sizeof(uint32_t));
	rows->tangents = nt_arena_alloc(arena, rows->pool->sets.count, sizeof *rows->tangents);
	rows->normals = nt_arena_alloc(arena, rows->pool->sets.count, sizeof *rows->normals);
	rows->morphs = nt_arena_alloc(arena, rows->pool->sets.count, sizeof *rows->morphs);
	if (!rows->sources || !rows->tangents || !rows->normals || !rows->morphs)
		return false;
	for (size_t i = rows->old_count; i < rows->new_count; i++)
		rows->sources[i - rows->old_count] = m->source[i];
	bool kept = true;
	for (size_t g = 0; g < rows->pool->sets.count; g++) {
		rows->tangents[g] = m->tangents[g];
		rows->normals[g] = m->normals[g];
		m->tangents[g] = m->normals[g] = NULL;
		kept &= nt_arena_adopt(arena, rows->tangents[g]);
		kept &= nt_arena_adopt(arena, rows->normals[g]);
		rows->morphs[g] = m->morphs[g];
		m->morphs[g] = NULL;
		for (size_t k = 0; k < m->morph_counts[g]; k++)
			kept &= nt_arena_adopt(arena, rows->morphs[g][k]);
		kept &= nt_arena_adopt(arena, rows->morphs[g]);
	}
	return kept;
}

/* The triangles of a mesh as the source has them. */
static bool same_triangles(const nt_mesh *mesh, const uint32_t *indices)
{
	for (size_t c = 0; c < mesh->corner_count; c++)
		if (indices[c] != (mesh->indices ? mesh->indices[c] : (uint32_t)c))
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

static bool merge_users(merging *m, nt_arena *arena)
{
	nt_pool_vertices *rows = m->rows;
	const nt_vertex_pool *pool = rows->pool;
	for (size_t i = 0; i < pool->user_count; i++) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		rows->indices[i] = NULL;
		rows->changed[i] = false;
		if (!nt_pool_is_solved(pool, i))
			continue;
		const uint32_t same = find_same(pool, mesh);
		if (same != NT_NONE) {
			rows->indices[i] = rows->indices[same];
			rows->changed[i] = rows->changed[same];
			continue;
		}
		rows->indices[i] = nt_arena_alloc(arena, mesh->corner_count, sizeof(uint32_t));
		if (!rows->indices[i] || !merge_mesh(m, mesh, pool->sets.of[i], rows->indices[i]))
			return false;
		/* normals that were made may have given the mesh indices of its own */
		rows->changed[i] = mesh->vertex_count > mesh->source_vertex_count ||
			!same_triangles(mesh, rows->indices[i]);
	}
	for (size_t i = 0; i < pool->user_count; i++)
		if (nt_pool_is_solved(pool, i))
			fill_unused(m, nt_pool_mesh(pool, i), pool->sets.of[i]);
	return true;
}

/* A pool's only solved mesh, which others may be the same as; NULL where there are several, or where vertices
 * are more than its split. */
static const nt_mesh *lone_mesh(const nt_vertex_pool *pool)
{
	const nt_mesh *lone = NULL;
	for (size_t i = 0; i < pool->user_count; i++) {
		const nt_mesh *mesh = nt_pool_mesh(pool, i);
		if (!nt_pool_is_solved(pool, i) || (lone && mesh->same_as == lone))
			continue;
		if (lone || mesh->normals_made || mesh->morph_count ||
			mesh->vertex_count != mesh->source_vertex_count)
			return NULL;
		lone = mesh;
	}
	return lone;
}

/* The triangles of a mesh after its split. */
static uint32_t *split_triangles(const nt_mesh *mesh, nt_arena *arena)
{
	if (mesh->split.indices || mesh->indices)
		return mesh->split.indices ? mesh->split.indices : mesh->indices;
	uint32_t *indices = nt_arena_alloc(arena, mesh->corner_count, sizeof *indices);
	for (size_t c = 0; indices && c < mesh->corner_count; c++)
		indices[c] = (uint32_t)c;
	return indices;
}

/* Vertices of a mesh that shares nothing: its split as it stands, borrowed from the scene. Merging would come
 * to the same in a fifth of the time that the whole conversion of a million triangles takes. */
static bool borrow_split(nt_pool_vertices *rows, const nt_mesh *mesh, nt_arena *arena)
{
	rows->new_count = rows->old_count + mesh->split.source_count;
	rows->sources = mesh->split.sources;
	rows->borrowed = true;
	rows->tangents = nt_arena_alloc(arena, 1, sizeof *rows->tangents);
	rows->normals = nt_arena_alloc(arena, 1, sizeof *rows->normals);
	rows->morphs = nt_arena_alloc(arena, 1, sizeof *rows->morphs);
	if (!rows->tangents || !rows->normals || !rows->morphs)
		return false;
	rows->tangents[0] = mesh->split.vertex_tangents;
	rows->normals[0] = NULL;
	rows->morphs[0] = NULL;
	uint32_t *triangles = split_triangles(mesh, arena);
	for (size_t i = 0; i < rows->pool->user_count; i++) {
		const bool solved = nt_pool_is_solved(rows->pool, i);
		rows->indices[i] = solved ? triangles : NULL;
		rows->changed[i] = solved && mesh->split.source_count > 0;
	}
	return triangles != NULL;
}

/* All users of a pool have the same number of vertices in a sound document. */
static nt_status check_counts(nt_pool_vertices *rows, nt_error *error)
{
	bool first = true;
	for (size_t i = 0; i < rows->pool->user_count; i++) {
		const nt_mesh *mesh = nt_pool_mesh(rows->pool, i);
		if (!nt_pool_is_solved(rows->pool, i))
			continue;
		if (!first && mesh->source_vertex_count != rows->old_count)
			return nt_fail_pointer(error, NT_ERROR_INPUT, mesh->place.pointer,
				"%zu vertices, but a primitive that shares attributes with it has %zu",
				mesh->source_vertex_count, rows->old_count);
		rows->old_count = mesh->source_vertex_count;
		first = false;
	}
	return NT_OK;
}

nt_status nt_merge_splits(nt_pool_vertices *rows, const nt_vertex_pool *pool, nt_arena *arena,
	nt_error *error)
{
	*rows = (nt_pool_vertices){.pool = pool,
		.indices = nt_arena_alloc(arena, pool->user_count, sizeof *rows->indices),
		.changed = nt_arena_alloc(arena, pool->user_count, sizeof *rows->changed)};
	if (!rows->indices || !rows->changed)
		return nt_fail_memory(error);
	nt_status status = check_counts(rows, error);
	if (status)
		return status;
	const nt_mesh *lone = lone_mesh(pool);
	if (lone)
		return borrow_split(rows, lone, arena) ? NT_OK : nt_fail_memory(error);
	merging m;
	const bool merged = start_merging(&m, rows) && merge_users(&m, arena) && keep_rows(&m, arena);
	end_merging(&m);
	return merged ? NT_OK : nt_fail_memory(error);
}
