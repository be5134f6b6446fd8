/* SPDX-License-Identifier: MIT */
/*
 * Texture coordinates through a texture transform: see values.h.
 *
 * KHR_texture_transform's text says counterclockwise and its code clockwise (v points down); viewers and the sample
 * model do what the text says, and with v up that is the usual rotation.
 */
#include "scene/values.h"

#include <math.h>

nt_status nt_mesh_transform(nt_mesh *mesh, const nt_uv_transform *t, nt_arena *arena, nt_error *error)
{
	mesh->solve_texcoords = nt_arena_alloc(arena, mesh->vertex_count, 2 * sizeof(float));
	if (!mesh->solve_texcoords)
		return nt_fail_memory(error);
	/* turning keeps the orientation; only scales can reverse it */
	for (int k = 0; k < 2; k++) {
		const int sign = (t->scale[k] > 0) - (t->scale[k] < 0);
		mesh->solve_sign = k ? mesh->solve_sign * sign : sign;
	}
	const double c = cos(t->rotation), s = sin(t->rotation);
	for (size_t i = 0; i < mesh->vertex_count; i++) {
		const double u = t->scale[0] * mesh->texcoords[2 * i];
		const double v = t->scale[1] * mesh->texcoords[2 * i + 1];
		mesh->solve_texcoords[2 * i] = (float)(t->rotation != 0 ? c * u - s * v : u);
		mesh->solve_texcoords[2 * i + 1] = (float)(t->rotation != 0 ? s * u + c * v : v);
	}
	return NT_OK;
}
