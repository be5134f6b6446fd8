/* SPDX-License-Identifier: MIT */
/*
 * Primitives that are solved while they are written: for the table of formats.
 */
#ifndef NT_GLTF_LATE_H
#define NT_GLTF_LATE_H

#include "scene/scene.h"

/* Sets mesh->late, and its vertex_count, after nt_gltf_find_same() and before anything is loaded. For an edit of the
 * document that needs of each of them its split alone, once, in the order of their numbers. Returns NT_OK,
 * NT_ERROR_MEMORY or what is wrong with an accessor. */
nt_status nt_gltf_find_late(nt_scene *scene, nt_error *error);

#endif
