/* SPDX-License-Identifier: MIT */
/*
 * Extensions that refer to vertices: see vertex_extensions.c.
 */
#ifndef NT_GLTF_EDIT_VERTEX_EXTENSIONS_H
#define NT_GLTF_EDIT_VERTEX_EXTENSIONS_H

#include "gltf/bytes/bytes.h"
#include "gltf/edit/merge_splits.h"

/* Adds a finding for each extension of the pool's primitives and their meshes that does not hold any more, and takes
 * FB_ngon_encoding off where it would say other polygons. compressed: by Draco, which may give triangles any order.
 * Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_vertices_tell(nt_buffer_edits *edits, nt_scene *scene, const nt_pool_vertices *vertices, bool compressed,
	nt_error *error);

/* Why the numbers of a primitive's vertices have a meaning: the name of an extension, or a sentence; NULL: they have
 * none. old_count: vertices. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_vertices_find_meaning(nt_scene *scene, const nt_mesh *mesh, size_t old_count, const char **meaning);

/* Whether feature ids of a primitive are the numbers of its vertices (EXT_mesh_features). */
bool nt_vertices_are_ids(const nt_json_value *primitive);

/* After all edits: vertices were copied. Adds a finding for each scene with FB_geometry_metadata, which counts them. */
void nt_vertices_tell_scenes(nt_scene *scene);

/* Takes FB_ngon_encoding off the lists where the last primitive lost it. */
void nt_gltf_drop_polygons(const nt_buffer_edits *edits);

#endif
