/* SPDX-License-Identifier: MIT */
/*
 * Extensions follow copied vertices: see vertex_extensions.c.
 */
#ifndef NT_GLTF_EDIT_VERTEX_EXTENSIONS_H
#define NT_GLTF_EDIT_VERTEX_EXTENSIONS_H

#include "gltf/edit/buffer_edits.h"
#include "gltf/edit/merge_splits.h"

/* Outlines of the pool's primitives get the edges that their triangles have now, the primitives of manifolds new
 * indices, so that they are not `changed` any more; for what cannot follow there is a finding. compressed: by Draco,
 * which may give vertices any order. New views go to `buffer`. */
nt_status nt_gltf_follow_vertices(nt_buffer_edits *edits, uint32_t buffer, nt_scene *scene,
	nt_pool_vertices *vertices, bool compressed, nt_error *error);

#endif
