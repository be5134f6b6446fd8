/* SPDX-License-Identifier: MIT */
/*
 * Compressed primitives that got tangents: see draco.c.
 */
#ifndef NT_GLTF_EDIT_DRACO_H
#define NT_GLTF_EDIT_DRACO_H

#include "gltf/edit/buffer_edits.h"
#include "gltf/edit/merge_splits.h"

/* Whether a solved user of the pool is compressed by Draco. */
bool nt_gltf_has_draco(const nt_vertex_pool *pool);

/*
 * Writes a pool with compressed users, or one that is to be compressed: compressed (again) where that is
 * possible, else plain, with a finding. *done false: plain, and what plain pools need is still to be done;
 * the indices of those that were compressed count as changed. buffer: of new views.
 */
nt_status nt_gltf_write_draco(nt_buffer_edits *edits, uint32_t buffer, nt_vertex_pools *pools,
	nt_pool_vertices *vertices, const nt_write_options *options, nt_finding_list *findings, bool *done,
	nt_error *error);

/* Takes KHR_draco_mesh_compression off the lists where no primitive has it any more. */
void nt_gltf_drop_draco(const nt_scene *scene);

#endif
