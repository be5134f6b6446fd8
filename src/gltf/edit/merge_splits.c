/* SPDX-License-Identifier: MIT */
/*
 * Rows of a component: the vertices its accessors will have.
 *
 * Each mesh was solved and split by itself. Where several of them use the same vertex, their tangents
 * for it may agree or not. The rows of a vertex form a chain that begins with its own; a mesh takes the
 * row of the chain where its group has the same tangent, else the first one where it has none yet, and
 * appends a row where all have one; by hash, since a hub may have any number of rows. For a mesh that shares nothing
 * this is exactly its own split, which is taken as it is.
 */
#include "gltf/edit/merge_splits.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"

typedef struct merging {
	nt_gltf_rows *rows;
	size_t capacity;      /* of the arrays below, in rows */
	uint32_t *source;     /* row of the source it is a copy of */
	uint32_t *next;       /* next row of the same vertex, NT_NONE */
	uint32_t *last;       /* [old_count] last row of each vertex */
	uint32_t **first_free; /* [group][old_count] before this row the group has a tangent for all of a vertex */
	nt_hash_index known;  /* defined rows behind the first of their vertex, of all groups */
	float **tangents;     /* [group] */
	float **normals;      /* [group] or NULL */
	float ***morphs;      /* [group][morph_counts[group]] */
	size_t *morph_counts; /* [group] */
	bool **defined;       /* [group][row] */
	bool *has_normals;    /* [group] */
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
	for (size_t g = 0; grown && g < m->rows->group_count; g++) {
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

static bool start_merging(merging *m, nt_gltf_rows *rows, const nt_scene *scene,
	const uint32_t *members, size_t member_count)
{
	*m = (merging){.rows = rows,
		.tangents = nt_calloc(rows->group_count, sizeof *m->tangents),
		.normals = nt_calloc(rows->group_count, sizeof *m->normals),
		.defined = nt_calloc(rows->group_count, sizeof *m->defined),
		.has_normals = nt_calloc(rows->group_count, sizeof *m->has_normals),
		.morphs = nt_calloc(rows->group_count, sizeof *m->morphs),
		.morph_counts = nt_calloc(rows->group_count, sizeof *m->morph_counts)};
	if (!m->tangents || !m->normals || !m->defined || !m->has_normals || !m->morphs ||
		!m->morph_counts)
		return false;
	for (size_t i = 0; i < member_count; i++) {
		const nt_mesh *mesh = &scene->meshes[members[i]];
		const uint32_t group = rows->group_of[i];
		if (group == NT_NONE)
			continue;
		m->has_normals[group] |= mesh->normals_made;
		if (m->morphs[group])
			continue;
		m->morphs[group] = nt_calloc(mesh->morph_count, sizeof *m->morphs[group]);
		if (!m->morphs[group])
			return false;
		m->morph_counts[group] = mesh->morph_count;
	}
	m->last = nt_alloc(rows->old_count, sizeof *m->last);
	m->first_free = nt_calloc(rows->group_count, sizeof *m->first_free);
	if (!m->last || !m->first_free || !reserve_rows(m, rows->old_count))
		return false;
	for (size_t i = 0; i < rows->old_count; i++) {
		m->source[i] = m->last[i] = (uint32_t)i;
		m->next[i] = NT_NONE;
	}
	for (size_t g = 0; g < rows->group_count; g++) {
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
	for (size_t g = 0; g < m->rows->group_count; g++) {
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

static bool same_morphs(const merging *m, uint32_t group, uint32_t row, const nt_mesh *mesh,
	uint32_t vertex)
{
	for (size_t k = 0; k < m->morph_counts[group]; k++)
		if (memcmp(m->morphs[group][k] + 3 * (size_t)row,
			mesh->morphs[k].vertex_tangents + 3 * (size_t)vertex, 3 * sizeof(float)) != 0)
			return false;
	return true;
}

static void define_morphs(merging *m, uint32_t group, uint32_t row, const nt_mesh *mesh, uint32_t vertex)
{
	for (size_t k = 0; k < m->morph_counts[group]; k++)
		memcpy(m->morphs[group][k] + 3 * (size_t)row,
			mesh->morphs[k].vertex_tangents + 3 * (size_t)vertex, 3 * sizeof(float));
}

static uint64_t hash_row(uint32_t group, uint32_t source, const float *tangent)
{
	const uint32_t place[2] = {group, source};
	return nt_hash_bytes(nt_hash_bytes(0, place, sizeof place), tangent, 4 * sizeof *tangent);
}

static bool row_fits(const merging *m, uint32_t group, uint32_t row, const float *tangent,
	const float *normal)
{
	return memcmp(m->tangents[group] + 4 * (size_t)row, tangent, 4 * sizeof(float)) == 0 &&
		(!normal || memcmp(m->normals[group] + 3 * (size_t)row, normal, 3 * sizeof(float)) == 0);
}

static void define_row(merging *m, uint32_t group, uint32_t row, const float *tangent,
	const float *normal)
{
	m->defined[group][row] = true;
	memcpy(m->tangents[group] + 4 * (size_t)row, tangent, 4 * sizeof(float));
	if (normal)
		memcpy(m->normals[group] + 3 * (size_t)row, normal, 3 * sizeof(float));
}

/* A row of the vertex `source` that has the mesh's tangent already; NT_NONE: none. */
static uint32_t find_row(const merging *m, const nt_mesh *mesh, uint32_t group, uint32_t vertex, uint32_t source,
	uint64_t hash, const float *normal)
{
	const float *tangent = mesh->split.vertex_tangents + 4 * (size_t)vertex;
	if (m->defined[group][source] && row_fits(m, group, source, tangent, normal) &&
		same_morphs(m, group, source, mesh, vertex))
		return source;
	uint32_t row;
	for (size_t at = NT_HASH_BEGIN; (row = nt_hash_index_next(&m->known, hash, &at)) != NT_NONE;)
		if (m->source[row] == source && m->defined[group][row] &&
			row_fits(m, group, row, tangent, normal) && same_morphs(m, group, row, mesh, vertex))
			return row;
	return NT_NONE;
}

/* The first row of a vertex that the group has no tangent for, appended where it has all; NT_NONE when memory
 * is exhausted. */
static uint32_t find_free_row(merging *m, uint32_t group, uint32_t source)
{
	uint32_t row = m->first_free[group][source];
	while (row != NT_NONE && m->defined[group][row])
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
	m->first_free[group][source] = row;
	return row;
}

/* The row for a vertex of a mesh; NT_NONE when memory is exhausted. */
static uint32_t take_row(merging *m, const nt_mesh *mesh, uint32_t group, uint32_t vertex)
{
	const float *tangent = mesh->split.vertex_tangents + 4 * (size_t)vertex;
	const float *normal =
		mesh->normals_made ? mesh->normals + 3 * (size_t)before_split(mesh, vertex) : NULL;
	const uint32_t source = source_row(mesh, vertex);
	uint64_t hash = hash_row(group, source, tangent);
	for (size_t k = 0; k < m->morph_counts[group]; k++)
		hash = nt_hash_bytes(hash, mesh->morphs[k].vertex_tangents + 3 * (size_t)vertex,
			3 * sizeof(float));
	uint32_t row = find_row(m, mesh, group, vertex, source, hash, normal);
	if (row != NT_NONE)
		return row;
	row = find_free_row(m, group, source);
	if (row == NT_NONE || (row != source && !nt_hash_index_add(&m->known, hash, row)))
		return NT_NONE;
	define_row(m, group, row, tangent, normal);
	define_morphs(m, group, row, mesh, vertex);
	return row;
}

/* The vertex of a corner after the split. */
static uint32_t split_vertex(const nt_mesh *mesh, size_t corner)
{
	const uint32_t *indices = mesh->split.indices ? mesh->split.indices : mesh->indices;
	return indices ? indices[corner] : (uint32_t)corner;
}

static bool merge_mesh(merging *m, const nt_mesh *mesh, uint32_t group, uint32_t *indices)
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
		row_of[v] = take_row(m, mesh, group, v);
		merged = row_of[v] != NT_NONE;
	}
	for (size_t c = 0; merged && c < mesh->corner_count; c++)
		indices[c] = row_of[split_vertex(mesh, c)];
	free(row_of);
	return merged;
}

/* Rows that no corner of a group uses get the tangent that splitting gave them, copies that of the row
 * they copy. */
static void fill_unused(merging *m, const nt_mesh *mesh, uint32_t group)
{
	for (size_t row = 0; row < m->rows->new_count; row++) {
		if (m->defined[group][row])
			continue;
		const uint32_t source = m->source[row];
		const bool own = row < m->rows->old_count || !m->defined[group][source];
		const float *tangent = own ? mesh->split.vertex_tangents + 4 * (size_t)source :
					     m->tangents[group] + 4 * (size_t)source;
		const float *normal = NULL;
		if (m->has_normals[group])
			normal = own ? mesh->normals + 3 * (size_t)source :
				       m->normals[group] + 3 * (size_t)source;
		define_row(m, group, (uint32_t)row, tangent, normal);
		for (size_t k = 0; k < m->morph_counts[group]; k++)
			memcpy(m->morphs[group][k] + 3 * row,
				own ? mesh->morphs[k].vertex_tangents + 3 * (size_t)source :
				      m->morphs[group][k] + 3 * (size_t)source, 3 * sizeof(float));
	}
}

/* Hands the results to the arena. */
static bool keep_rows(merging *m, nt_arena *arena)
{
	nt_gltf_rows *rows = m->rows;
	rows->sources = nt_arena_alloc(arena, rows->new_count - rows->old_count, sizeof(uint32_t));
	rows->tangents = nt_arena_alloc(arena, rows->group_count, sizeof *rows->tangents);
	rows->normals = nt_arena_alloc(arena, rows->group_count, sizeof *rows->normals);
	rows->morphs = nt_arena_alloc(arena, rows->group_count, sizeof *rows->morphs);
	if (!rows->sources || !rows->tangents || !rows->normals || !rows->morphs)
		return false;
	for (size_t i = rows->old_count; i < rows->new_count; i++)
		rows->sources[i - rows->old_count] = m->source[i];
	bool kept = true;
	for (size_t g = 0; g < rows->group_count; g++) {
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

/* The member of the component that a mesh shares its geometry with: members are in the order of their
 * numbers. NT_NONE: none, or of another component. */
static uint32_t find_same(const nt_scene *scene, const uint32_t *members, size_t member_count,
	const nt_mesh *mesh)
{
	size_t low = 0, high = member_count;
	const uint32_t wanted = mesh->same_as ? (uint32_t)(mesh->same_as - scene->meshes) : NT_NONE;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (members[middle] < wanted)
			low = middle + 1;
		else
			high = middle;
	}
	return low < member_count && members[low] == wanted ? (uint32_t)low : NT_NONE;
}

static bool merge_members(merging *m, const nt_scene *scene, const uint32_t *members,
	size_t member_count, nt_arena *arena)
{
	nt_gltf_rows *rows = m->rows;
	for (size_t i = 0; i < member_count; i++) {
		const nt_mesh *mesh = &scene->meshes[members[i]];
		rows->indices[i] = NULL;
		rows->changed[i] = false;
		if (rows->group_of[i] == NT_NONE)
			continue;
		const uint32_t same = find_same(scene, members, member_count, mesh);
		if (same != NT_NONE) {
			rows->indices[i] = rows->indices[same];
			rows->changed[i] = rows->changed[same];
			continue;
		}
		rows->indices[i] = nt_arena_alloc(arena, mesh->corner_count, sizeof(uint32_t));
		if (!rows->indices[i] || !merge_mesh(m, mesh, rows->group_of[i], rows->indices[i]))
			return false;
		/* normals that were made may have given the mesh indices of its own */
		rows->changed[i] = mesh->vertex_count > mesh->source_vertex_count ||
			!same_triangles(mesh, rows->indices[i]);
	}
	for (size_t i = 0; i < member_count; i++)
		if (rows->group_of[i] != NT_NONE)
			fill_unused(m, &scene->meshes[members[i]], rows->group_of[i]);
	return true;
}

/* A component's only solved mesh, which others may be the same as; NULL where there are several, or where rows
 * are more than its split. */
static const nt_mesh *lone_mesh(const nt_gltf_rows *rows, const nt_scene *scene, const uint32_t *members,
	size_t member_count)
{
	const nt_mesh *lone = NULL;
	for (size_t i = 0; i < member_count; i++) {
		const nt_mesh *mesh = &scene->meshes[members[i]];
		if (rows->group_of[i] == NT_NONE || (lone && mesh->same_as == lone))
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

/* Rows of a mesh that shares nothing: its split as it stands, borrowed from the scene. Merging would come
 * to the same in a fifth of the time that the whole conversion of a million triangles takes. */
static bool borrow_rows(nt_gltf_rows *rows, const nt_mesh *mesh, size_t member_count, nt_arena *arena)
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
	for (size_t i = 0; i < member_count; i++) {
		const bool solved = rows->group_of[i] != NT_NONE;
		rows->indices[i] = solved ? triangles : NULL;
		rows->changed[i] = solved && mesh->split.source_count > 0;
	}
	return triangles != NULL;
}

/* All meshes of a component have the same number of vertices in a sound document. */
static nt_status check_counts(nt_gltf_rows *rows, const nt_scene *scene, const uint32_t *members,
	size_t member_count, nt_error *error)
{
	bool first = true;
	for (size_t i = 0; i < member_count; i++) {
		const nt_mesh *mesh = &scene->meshes[members[i]];
		if (rows->group_of[i] == NT_NONE)
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

nt_status nt_gltf_merge_rows(nt_gltf_rows *rows, const nt_gltf *document, const nt_scene *scene,
	const nt_gltf_sharing *sharing, const uint32_t *members, size_t member_count, nt_arena *arena,
	nt_error *error)
{
	*rows = (nt_gltf_rows){
		.group_of = nt_arena_alloc(arena, member_count, sizeof *rows->group_of),
		.group_first = nt_arena_alloc(arena, member_count, sizeof *rows->group_first),
		.next_of = nt_arena_alloc(arena, member_count, sizeof *rows->next_of),
		.indices = nt_arena_alloc(arena, member_count, sizeof *rows->indices),
		.changed = nt_arena_alloc(arena, member_count, sizeof *rows->changed),
	};
	if (!rows->group_of || !rows->group_first || !rows->next_of || !rows->indices || !rows->changed ||
		!nt_gltf_find_groups(rows, document, scene, sharing, members, member_count))
		return nt_fail_memory(error);
	nt_status status = check_counts(rows, scene, members, member_count, error);
	if (status)
		return status;
	const nt_mesh *lone = lone_mesh(rows, scene, members, member_count);
	if (lone)
		return borrow_rows(rows, lone, member_count, arena) ? NT_OK : nt_fail_memory(error);
	merging m;
	const bool merged = start_merging(&m, rows, scene, members, member_count) &&
		merge_members(&m, scene, members, member_count, arena) && keep_rows(&m, arena);
	end_merging(&m);
	return merged ? NT_OK : nt_fail_memory(error);
}
