/* SPDX-License-Identifier: MIT */
/*
 * Compressed primitives that got tangents: see draco.c.
 */
#ifndef NT_GLTF_EDIT_DRACO_H
#define NT_GLTF_EDIT_DRACO_H

#include "gltf/edit/draco_block.h"

/* Whether a solved user of the pool is compressed by Draco. */
bool nt_gltf_has_draco(const nt_vertex_pool *pool);

/* Looks up what the block of a pool will hold, which is compressed or to be compressed, for
 * nt_gltf_draco_encode_all(). Names and attributes are in the arena. */
nt_status nt_gltf_draco_look_up(nt_gltf_recoding *recoding, nt_buffer_edits *edits, nt_pool_vertices *vertices,
	const nt_write_options *options, nt_arena *arena, nt_error *error);

/* The beginning of that, which looks at no values: whether an obstacle stands in the way, and what of a plain pool
 * goes into a block. It takes the pool of the vertices and their count in the source. */
nt_status nt_gltf_draco_begin(nt_gltf_recoding *recoding, nt_gltf *document, nt_pool_vertices *vertices,
	const nt_write_options *options, nt_arena *arena, nt_error *error);

/*
 * Writes a pool that was looked up, and perhaps encoded: compressed (again) where that is possible, else plain, with a
 * finding. Other pools may have been written meanwhile: what is in a block belongs to one pool.
 * *done false: plain, and what plain pools need is still to be done; the indices of those that were compressed count as
 * changed. buffer: of new views.
 */
nt_status nt_gltf_write_draco(nt_gltf_recoding *recoding, uint32_t buffer, nt_scene *scene, bool *done,
	nt_error *error);

/* Makes the compressed users of a pool plain; their indices count as changed. */
nt_status nt_gltf_draco_make_plain(nt_buffer_edits *edits, nt_pool_vertices *vertices, nt_error *error);

/* Takes KHR_draco_mesh_compression off the lists where no primitive has it any more. */
void nt_gltf_drop_draco(const nt_scene *scene);

#endif
