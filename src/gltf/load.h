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

#endif
