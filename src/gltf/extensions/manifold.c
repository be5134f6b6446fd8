/* SPDX-License-Identifier: MIT */
/*
 * EXT_mesh_manifold has the triangles of a mesh's primitives a second time, as one solid: over the same indices, of
 * which a sparse accessor replaces those whose vertex is one of several at a place. When vertices are copied the
 * manifold stays what it was, a copy being at the place of its vertex; what changes is which indices of the primitives
 * differ from its own.
 */
#include "gltf/extensions/extensions.h"

#include <string.h>
#include "gltf/accessor.h"

enum { TRIANGLES = 4 };

/* A faulty member is an obstacle, exhausted memory is not. */
static nt_status obstruct(nt_manifold *m, nt_status status, const char *obstacle)
{
	if (status == NT_ERROR_MEMORY)
		return status;
	if (!m->obstacle)
		m->obstacle = obstacle;
	return NT_OK;
}

static bool get_indices(nt_gltf *document, const nt_json_value *primitive, nt_gltf_accessor *accessor)
{
	uint64_t number;
	return nt_json_get_uint64(nt_json_find(primitive, "indices"), &number) &&
		nt_gltf_get_accessor(document, number, "", accessor, NULL) == NT_OK && accessor->view != NT_NONE &&
		accessor->stride == accessor->element_bytes;
}

static bool get_positions(nt_gltf *document, const nt_json_value *primitive, nt_gltf_accessor *accessor)
{
	uint64_t number;
	return nt_json_get_uint64(nt_json_find(nt_json_find(primitive, "attributes"), "POSITION"), &number) &&
		nt_gltf_get_accessor(document, number, "", accessor, NULL) == NT_OK;
}

/* The first corner of a primitive among those of the manifold. */
static void place_primitive(nt_manifold *m, nt_gltf *document, const nt_json_value *primitive, size_t index,
	const nt_gltf_accessor *all, const nt_gltf_accessor *positions)
{
	nt_gltf_accessor own, own_positions;
	uint64_t mode = TRIANGLES;
	nt_json_get_uint64(nt_json_find(primitive, "mode"), &mode);
	if (mode != TRIANGLES)
		m->obstacle = "a primitive of which is no list of triangles";
	else if (!get_indices(document, primitive, &own) || own.sparse_count || own.view != all->view ||
		own.component_type != all->component_type || own.offset < all->offset ||
		(own.offset - all->offset) % own.stride ||
		(own.offset - all->offset) / own.stride + own.count > all->count)
		m->obstacle = "a primitive of which has other indices than the manifold";
	else if (!get_positions(document, primitive, &own_positions) || own_positions.index != positions->index)
		m->obstacle = "a primitive of which has another POSITION than the manifold";
	if (m->obstacle)
		return;
	m->first[index] = (size_t)((own.offset - all->offset) / own.stride);
	m->count[index] = (size_t)own.count;
}

/* Whether the primitives have all corners of the manifold, each once. */
static nt_status check_cover(nt_manifold *m, size_t corner_count, nt_arena *arena)
{
	size_t sum = 0;
	bool *taken = nt_arena_alloc(arena, corner_count, sizeof *taken), covered = true;
	if (!taken)
		return NT_ERROR_MEMORY;
	memset(taken, 0, corner_count);
	for (size_t i = 0; covered && i < m->primitive_count; i++) {
		sum += m->count[i];
		covered = sum <= corner_count;
		for (size_t c = m->first[i]; covered && c < m->first[i] + m->count[i]; c++) {
			covered = !taken[c];
			taken[c] = true;
		}
	}
	return covered && sum == corner_count
		? NT_OK : obstruct(m, NT_OK, "whose manifold has other triangles than its primitives");
}

/* The corners of the manifold, before and after its merges. */
static nt_status read_corners(nt_manifold *m, nt_gltf *document, const nt_gltf_accessor *all, size_t vertex_count,
	nt_arena *arena)
{
	nt_gltf_accessor plain = *all;
	uint32_t *before, *after;
	plain.sparse_count = 0;
	nt_status status = nt_gltf_indices(document, &plain, vertex_count, arena, &before, NULL);
	if (!status)
		status = nt_gltf_indices(document, all, vertex_count, arena, &after, NULL);
	if (status)
		return obstruct(m, status, "whose indices are faulty");
	m->corner_count = (size_t)all->count;
	m->merged = after;
	m->corners = nt_arena_alloc(arena, m->corner_count, sizeof *m->corners);
	if (!m->corners)
		return NT_ERROR_MEMORY;
	memcpy(m->corners, before, m->corner_count * sizeof *m->corners);
	return NT_OK;
}

nt_status nt_manifold_read(nt_manifold *m, nt_gltf *document, size_t mesh, nt_arena *arena)
{
	const nt_json_value *object = nt_json_at(nt_gltf_root_member(document, "meshes"), mesh);
	const nt_json_value *primitives = nt_json_find(object, "primitives");
	*m = (nt_manifold){.extension = nt_json_find(nt_json_find(object, "extensions"), "EXT_mesh_manifold"),
		.primitive_count = nt_json_count(primitives)};
	if (!m->extension)
		return NT_OK;
	const nt_json_value *manifold = nt_json_find(m->extension, "manifoldPrimitive");
	nt_gltf_accessor all, positions;
	if (!get_indices(document, manifold, &all))
		return obstruct(m, NT_OK, "whose manifold has no indices");
	if (!get_positions(document, manifold, &positions))
		return obstruct(m, NT_OK, "whose manifold has no POSITION");
	m->component_type = all.component_type;
	m->first = nt_arena_alloc(arena, m->primitive_count, sizeof *m->first);
	m->count = nt_arena_alloc(arena, m->primitive_count, sizeof *m->count);
	if (!m->first || !m->count)
		return NT_ERROR_MEMORY;
	for (size_t i = 0; !m->obstacle && i < m->primitive_count; i++)
		place_primitive(m, document, nt_json_at(primitives, i), i, &all, &positions);
	nt_status status = m->obstacle ? NT_OK : check_cover(m, (size_t)all.count, arena);
	if (!status && !m->obstacle)
		status = read_corners(m, document, &all, (size_t)positions.count, arena);
	return status;
}

nt_status nt_manifold_merges(const nt_manifold *m, nt_arena *arena, uint32_t **corners, uint32_t **vertices,
	size_t *count)
{
	size_t differing = 0;
	for (size_t c = 0; c < m->corner_count; c++)
		differing += m->corners[c] != m->merged[c];
	*corners = nt_arena_alloc(arena, differing, sizeof **corners);
	*vertices = nt_arena_alloc(arena, differing, sizeof **vertices);
	*count = 0;
	if (!*corners || !*vertices)
		return NT_ERROR_MEMORY;
	for (size_t c = 0; c < m->corner_count; c++) {
		if (m->corners[c] == m->merged[c])
			continue;
		(*corners)[*count] = (uint32_t)c;
		(*vertices)[(*count)++] = m->merged[c];
	}
	return NT_OK;
}
