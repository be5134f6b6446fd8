/* SPDX-License-Identifier: MIT */
/*
 * TANGENT accessors that a document has already: see old_tangents.c.
 */
#ifndef NT_GLTF_EDIT_OLD_TANGENTS_H
#define NT_GLTF_EDIT_OLD_TANGENTS_H

#include "gltf/bytes/packed_views.h"

/* TANGENT accessors that a set's meshes have and nobody else uses. */
typedef struct nt_gltf_old_tangents {
	uint32_t *accessors; /* [count]; none: a new one is appended */
	size_t count;
	bool in_place;       /* the new elements go where the old ones are */
} nt_gltf_old_tangents;

/* The TANGENT accessor of a user; NT_NONE: none. */
uint32_t nt_gltf_tangent_of(const nt_vertex_pools *pools, const nt_vertex_pool *pool, size_t user);

/* filter: of the new ones. The result is in the arena. */
nt_status nt_gltf_find_tangents(nt_buffer_edits *edits, const nt_vertex_pools *pools, const nt_vertex_pool *pool,
	uint32_t set, const nt_tangent_filter *filter, nt_arena *arena, nt_gltf_old_tangents *old, nt_error *error);

/* Takes their bytes out of the buffers, where nobody else refers to them. */
nt_status nt_gltf_release_tangents(nt_buffer_edits *edits, const nt_gltf_old_tangents *old, nt_error *error);

/* Gives them the type that is stored. */
void nt_gltf_retype_tangents(nt_gltf *document, const nt_gltf_old_tangents *old, nt_precision precision);

/* Lets them refer to `count` elements in a new view. */
void nt_gltf_move_tangents(nt_gltf *document, const nt_gltf_old_tangents *old, nt_precision precision,
	uint32_t view, uint64_t offset, size_t count);

#endif
