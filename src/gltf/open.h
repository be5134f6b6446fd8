/* SPDX-License-Identifier: MIT */
/*
 * A glTF or GLB as a scene, for the table of formats.
 */
#ifndef NT_GLTF_OPEN_H
#define NT_GLTF_OPEN_H

#include "scene/scene.h"

/* Describes the meshes of scene->bytes. */
nt_status nt_gltf_open(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif
