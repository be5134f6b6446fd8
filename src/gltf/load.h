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

/* A mesh as a morph target moves it: both are malloc'ed, [vertex_count][3], NULL as the base has them. Nothing changes,
 * so that threads may ask at once. Returns NT_OK or NT_ERROR_MEMORY; to be freed in either case. */
nt_status nt_gltf_move(const nt_mesh *mesh, const nt_morph *morph, float **positions, float **normals);

/* The normals of all vertices of the pool of a mesh that has some, as a load has them; not to be written to. New data
 * is in the arena. */
nt_status nt_gltf_load_normals(nt_gltf *document, const nt_mesh *mesh, nt_arena *arena, float **normals,
	nt_error *error);

/*
 * For the table of formats: opens and decodes what loads of these meshes take. A mesh is `ready` then, or its load will
 * find a fault: loads of ready ones only read the document, each for a scene with an arena of its own.
 *
 *   needed  [mesh_count] meshes that will be loaded; several threads decode their compressed blocks here
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_gltf_prepare(nt_scene *scene, const bool *needed, const nt_read_options *options, nt_error *error);

#endif
