/* SPDX-License-Identifier: MIT */
/*
 * Texture coordinates as a texture transform makes them: what a sampler sees, and what tangents therefore follow.
 */
#ifndef NT_SCENE_TRANSFORM_H
#define NT_SCENE_TRANSFORM_H

#include "scene/scene.h"

/* KHR_texture_transform, or -s and -o of MTL, with v up: (u, v) is scaled, turned counterclockwise, moved. */
typedef struct nt_uv_transform {
	double rotation, scale[2], offset[2];
} nt_uv_transform;

/*
 * Gives a mesh with texcoords its solve_texcoords, in the arena, and solve_sign: scaled and turned, rounded to float
 * once. The offset moves all triangles alike, so that no tangent knows of it.
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_mesh_transform(nt_mesh *mesh, const nt_uv_transform *transform, nt_arena *arena, nt_error *error);

#endif
