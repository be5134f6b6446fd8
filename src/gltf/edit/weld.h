/* SPDX-License-Identifier: MIT */
/*
 * Welding equal vertices of a pool: see weld.c.
 */
#ifndef NT_GLTF_EDIT_WELD_H
#define NT_GLTF_EDIT_WELD_H

#include "gltf/bytes/bytes.h"
#include "gltf/edit/merge_splits.h"
#include "gltf/tangent_filter.h"

/* Tangents of a set as they will be stored. */
typedef struct nt_stored_tangents {
	nt_gltf_packing packing; /* of new bytes */
	nt_tangent_filter filter;
	const unsigned char *values, *stored; /* as readers have them, and before the filter */
	size_t element_bytes;
} nt_stored_tangents;

/*
 * Makes one vertex of those that are equal in all that the users of the pool have of them: elements of all attributes
 * and targets, bit by bit, and what takes their place. Nothing happens where none are equal, or where something else
 * refers to vertices by their numbers, which becomes a finding.
 *
 *   stored      [pool->sets.count] what takes the place of vertices->sets[].tangents: follows; NULL: nothing does
 *   bitangents  _BITANGENT will be new
 *   scratch     for what only this call needs
 *
 * Returns NT_OK or NT_ERROR_MEMORY; other errors are those of the document.
 */
nt_status nt_pool_weld(nt_buffer_edits *edits, nt_scene *scene, nt_pool_vertices *vertices,
	nt_stored_tangents *stored, bool bitangents, nt_arena *scratch, nt_error *error);

/* The vertices of a pool that stays as it is otherwise: no user of it counts as solved. *can: they can be welded. */
nt_status nt_pool_vertices_plain(const nt_vertex_pools *pools, nt_vertex_pool *pool, nt_arena *tables,
	nt_pool_vertices *vertices, bool *can, nt_error *error);

#endif
