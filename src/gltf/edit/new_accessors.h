/* SPDX-License-Identifier: MIT */
/*
 * New accessors: see new_accessors.c.
 */
#ifndef NT_GLTF_EDIT_NEW_ACCESSORS_H
#define NT_GLTF_EDIT_NEW_ACCESSORS_H

#include "gltf/edit/append_targets.h"
#include "gltf/edit/merge_splits.h"
#include "gltf/bytes/packed_views.h"

/* Appends the JSON of an accessor; view NT_NONE: without one. Returns its number. */
uint32_t nt_gltf_new_accessor(nt_json *json, uint32_t view, uint32_t component_type, const char *type,
	size_t count, bool normalized);

/* An attribute's accessor over new elements. packing: with the filter to which they are made; its stride is theirs. */
nt_status nt_gltf_add_attribute(nt_buffer_edits *edits, uint32_t buffer, const nt_gltf_packing *packing,
	const void *elements, size_t count, size_t element_bytes, uint32_t component_type, const char *type,
	uint32_t *accessor, nt_error *error);

/* A VEC3 or VEC4 of floats, to which no filter is applied. */
nt_status nt_gltf_add_floats(nt_buffer_edits *edits, uint32_t buffer, const nt_gltf_packing *packing,
	const float *elements, size_t count, uint32_t width, uint32_t *accessor, nt_error *error);

/* Every primitive of a tangent set gets the attribute. */
void nt_gltf_set_attribute(nt_json *json, const nt_vertex_pool *pool, uint32_t set, const char *name,
	uint32_t accessor);

/* cross(N, T) w of every vertex of a set, glTF's own definition of the bitangent; in the arena. */
nt_status nt_gltf_bitangents(const nt_pool_vertices *vertices, uint32_t set, nt_arena *arena, float **result,
	nt_error *error);

/* TANGENT of the morph targets of a set's meshes: what to add to the base's, which are final. Before vertices are
 * appended: accessors to which nothing is to be appended then are added to the overrides, which have room for as many
 * as the set's mesh has targets. least: as nt_morph_deltas() has it. Their bytes are added to the cost. */
nt_status nt_gltf_add_morphs(nt_buffer_edits *edits, uint32_t buffer, const nt_vertex_pools *pools,
	const nt_pool_vertices *vertices, uint32_t set, float least, nt_gltf_override *overrides,
	size_t *override_count, nt_morph_cost *cost, nt_error *error);

#endif
