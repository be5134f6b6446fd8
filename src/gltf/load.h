/* SPDX-License-Identifier: MIT */
/*
 * The geometry of a primitive, for the table of formats.
 */
#ifndef NT_GLTF_LOAD_H
#define NT_GLTF_LOAD_H

#include "gltf/document.h"

/* Brings the geometry of a mesh of an opened glTF. */
nt_status nt_gltf_load(nt_scene *scene, nt_mesh *mesh, const nt_read_options *options,
	nt_error *error);

/* The normals of all vertices of the pool of a mesh that has some, as a load has them; not to be written to. New data
 * is in the arena. */
nt_status nt_gltf_load_normals(nt_gltf *document, const nt_mesh *mesh, nt_arena *arena, float **normals,
	nt_error *error);

/*
 * For the table of formats: between these two several threads may load, each with a copy of the scene that has an arena
 * of its own. A step that would add a finding or change the document fails silently: it is to be loaded afterwards.
 *
 *   needed  [mesh_count] meshes that will be loaded; several threads decode their compressed blocks here
 *
 * Returns NT_OK or NT_ERROR_MEMORY, and then nothing is shared.
 */
nt_status nt_gltf_share(nt_scene *scene, const bool *needed, const nt_read_options *options, nt_error *error);
void nt_gltf_unshare(nt_scene *scene);

#endif
