/* SPDX-License-Identifier: MIT */
/*
 * Primitives that are solved as one mesh: for the table of formats.
 */
#ifndef NT_GLTF_JOINS_H
#define NT_GLTF_JOINS_H

#include "scene/scene.h"

/* Fills scene->joins, after nt_gltf_find_same(). mesh->join is left to the caller. With `solved` they will be solved,
 * and same_as becomes what holds then; else they will be compared, and those whose comparison costs many times the
 * solve are left out. With `kept` the tangents that primitives keep are to be checked, so that these stand for
 * themselves as if they got new ones. Returns NT_OK, NT_ERROR_MEMORY or what is wrong with a material. */
nt_status nt_gltf_find_joins(nt_scene *scene, bool solved, bool kept, nt_error *error);

#endif
