/* SPDX-License-Identifier: MIT */
/*
 * Where quads are cut, for writers of triangles: along MikkTSpace's diagonal, since tangents were
 * computed for these halves.
 */
#include "pipeline/stages.h"
#include "topology/orientation.h"

static uint8_t *cut_quads(nt_scene *scene, const nt_mesh *mesh)
{
	static const float no_texcoord[2];
	uint8_t *diagonals = nt_arena_alloc(&scene->arena, mesh->face_count, 1);
	size_t corner = 0;
	for (size_t f = 0; diagonals && f < mesh->face_count; f++) {
		diagonals[f] = 0;
		if (mesh->face_sizes[f] == 4) {
			const float *texcoords[4], *positions[4];
			for (size_t k = 0; k < 4; k++) {
				const size_t v = mesh->indices ? mesh->indices[corner + k] : corner + k;
				positions[k] = mesh->positions + 3 * v;
				/* equal ones leave the choice to the positions */
				texcoords[k] = mesh->texcoords ? mesh->texcoords + 2 * v : no_texcoord;
			}
			diagonals[f] = (uint8_t)nt_quad_diagonal(texcoords, positions);
		}
		corner += mesh->face_sizes[f];
	}
	return diagonals;
}

nt_status nt_stage_quads(nt_scene *scene, nt_error *error)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		if (!mesh->face_sizes || !mesh->positions)
			continue;
		mesh->face_diagonals = cut_quads(scene, mesh);
		if (!mesh->face_diagonals)
			return nt_fail_memory(error);
	}
	return NT_OK;
}
