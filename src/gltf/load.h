/* SPDX-License-Identifier: MIT */
/*
 * The geometry of a primitive, for the table of formats.
 */
#ifndef NT_GLTF_LOAD_H
#define NT_GLTF_LOAD_H

#include "scene/scene.h"

/* Brings the geometry of a mesh of an opened glTF. */
nt_status nt_gltf_load(nt_scene *scene, nt_mesh *mesh, const nt_read_options *options,
	nt_error *error);

/*
 * For the table of formats: what several threads can do before meshes are loaded one after the other. Compressed blocks
 * are decoded, and small meshes loaded.
 *
 *   needed  [mesh_count] meshes that will be loaded; receives false for those that are
 *
 * What fails, or cannot be done by several threads, is left for nt_gltf_load(), so that faults and findings come in the
 * order of the meshes. Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_gltf_load_ahead(nt_scene *scene, bool *needed, const nt_read_options *options, nt_error *error);

#endif
