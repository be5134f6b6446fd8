/* SPDX-License-Identifier: MIT */
/*
 * Primitives of equal geometry, for the table of formats.
 */
#ifndef NT_GLTF_SAME_GEOMETRY_H
#define NT_GLTF_SAME_GEOMETRY_H

#include "scene/scene.h"

/* After the decisions: sets same_as of meshes that will be solved and have the geometry of an earlier one. */
nt_status nt_gltf_find_same(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif
