/* SPDX-License-Identifier: MIT */
/*
 * Attributes that a tangent set gets: see set_attributes.c.
 */
#ifndef NT_GLTF_EDIT_SET_ATTRIBUTES_H
#define NT_GLTF_EDIT_SET_ATTRIBUTES_H

#include "gltf/edit/append.h"
#include "gltf/edit/weld.h"

/* NORMAL, TANGENT or _BITANGENT of a set: its values, and where they go. */
typedef struct nt_set_attribute {
	const char *name;
	uint32_t components;
	nt_stored_tangents values;
	uint32_t *own; /* [own_count] accessors that take them, each for all over its bytes; none: a new one does */
	size_t own_count;
	bool in_place; /* they go where the old ones are */
} nt_set_attribute;

/* Finds the accessors that take the values: those that the set's meshes have and nobody else uses. Before vertices are
 * appended: they become overrides, and what will not be in place leaves its bytes. Lists are in the arena. */
nt_status nt_set_attribute_settle(nt_buffer_edits *edits, const nt_vertex_pool *pool, uint32_t set, nt_arena *arena,
	nt_set_attribute *attribute, nt_override_list *overrides, nt_error *error);

/* After that: writes the values that are not in place, and lets all of the set's meshes have them. buffer: of new
 * views. */
nt_status nt_set_attribute_write(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	uint32_t set, const nt_set_attribute *attribute, nt_error *error);

/* Takes the elements of an accessor, and of others over the same bytes, out of the buffers. */
nt_status nt_gltf_release_elements(nt_buffer_edits *edits, uint32_t accessor, nt_error *error);

/* The same, of accessors that nobody uses any more: they keep their numbers, without a view. */
nt_status nt_gltf_drop_elements(nt_buffer_edits *edits, uint32_t accessor, nt_error *error);

/* Appends the JSON of an accessor; view NT_NONE: without one. Returns its number. */
uint32_t nt_gltf_new_accessor(nt_json *json, uint32_t view, uint32_t component_type, const char *type,
	size_t count, bool normalized);

/* cross(N, T) w of every vertex of a set, glTF's own definition of the bitangent; in the arena. */
nt_status nt_gltf_bitangents(const nt_pool_vertices *vertices, uint32_t set, nt_arena *arena, float **result,
	nt_error *error);

#endif
