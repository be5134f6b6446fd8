/* SPDX-License-Identifier: MIT */
/*
 * TANGENT accessors that a document has already: see old_tangents.c.
 */
#ifndef NT_GLTF_EDIT_OLD_TANGENTS_H
#define NT_GLTF_EDIT_OLD_TANGENTS_H

#include "gltf/edit/editor.h"

/* TANGENT accessors that a group's meshes have and nobody else uses. */
typedef struct nt_gltf_old_tangents {
	uint32_t *accessors; /* [count]; none: a new one is appended */
	size_t count;
	bool in_place;       /* the new rows go where the old ones are */
} nt_gltf_old_tangents;

/* The TANGENT accessor of a member; NT_NONE: none. */
uint32_t nt_gltf_tangent_of(const nt_gltf_patcher *patcher, const nt_gltf_cluster *component, size_t member);

nt_status nt_gltf_find_tangents(nt_gltf_patcher *patcher, const nt_gltf_cluster *component,
	uint32_t group, nt_gltf_old_tangents *old);

/* Takes their bytes out of the buffers, where nobody else refers to them. */
nt_status nt_gltf_release_tangents(nt_gltf_patcher *patcher, const nt_gltf_old_tangents *old);

/* Gives them the type that is stored. */
void nt_gltf_retype_tangents(nt_gltf_patcher *patcher, const nt_gltf_old_tangents *old);

/* Lets them refer to `count` rows in a new view. */
void nt_gltf_move_tangents(nt_gltf_patcher *patcher, const nt_gltf_old_tangents *old, uint32_t view,
	size_t count);

#endif
