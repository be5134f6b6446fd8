/* SPDX-License-Identifier: MIT */
/*
 * Indices of primitives whose vertices were split: see indices.c.
 */
#ifndef NT_GLTF_EDIT_INDICES_H
#define NT_GLTF_EDIT_INDICES_H

#include "gltf/edit/buffer_edits.h"
#include "gltf/edit/merge_splits.h"

/* Writes the indices of a pool's solved users where they changed. buffer: of new views. */
nt_status nt_gltf_write_indices(nt_buffer_edits *edits, uint32_t buffer, const nt_vertex_pools *pools,
	const nt_pool_vertices *vertices, nt_error *error);

#endif
