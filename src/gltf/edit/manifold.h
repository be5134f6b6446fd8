/* SPDX-License-Identifier: MIT */
/*
 * EXT_mesh_manifold follows copied vertices: see manifold.c.
 */
#ifndef NT_GLTF_EDIT_MANIFOLD_H
#define NT_GLTF_EDIT_MANIFOLD_H

#include "gltf/bytes/buffer_edits.h"
#include "gltf/edit/merge_splits.h"

/* Writes the indices of all primitives of the glTF mesh that the pool's user `first` is in, where that is a manifold;
 * they are not `changed` then. If it cannot follow, there is a finding. compressed: by Draco. New views go to
 * `buffer`. */
nt_status nt_gltf_follow_manifold(nt_buffer_edits *edits, uint32_t buffer, nt_scene *scene,
	nt_pool_vertices *vertices, size_t first, bool compressed, nt_error *error);

/* Outlines of the pool's primitives get the edges that their triangles have now, the primitives of manifolds new
 * indices, so that they are not `changed` any more, and FB_ngon_encoding goes where it would say other polygons; for
 * what cannot follow there is a finding. compressed: by Draco, which may give vertices and triangles any order. New
 * views go to `buffer`. */
nt_status nt_gltf_follow_vertices(nt_buffer_edits *edits, uint32_t buffer, nt_scene *scene,
	nt_pool_vertices *vertices, bool compressed, nt_error *error);

/* Takes FB_ngon_encoding off the lists where the last primitive lost it. */
void nt_gltf_drop_polygons(const nt_buffer_edits *edits);

#endif
