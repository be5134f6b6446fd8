/* SPDX-License-Identifier: MIT */
/*
 * Primitives that are solved as one mesh: for the table of formats.
 */
#ifndef NT_GLTF_JOINS_H
#define NT_GLTF_JOINS_H

#include "scene/scene.h"

/* Fills scene->joins, after the decisions. mesh->join is left to the caller. With `kept` the tangents that primitives
 * keep are to be checked, so that these stand for themselves as if they got new ones. */
nt_status nt_gltf_find_joins(nt_scene *scene, bool kept, nt_error *error);

#endif
