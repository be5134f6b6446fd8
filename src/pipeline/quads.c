/* SPDX-License-Identifier: MIT */
/*
 * Where quads are cut, for writers of triangles: as nt_written_quad_diagonal() has it.
 */
#include "pipeline/stages.h"
#include "topology/corners.h"

static uint8_t *cut_quads(nt_scene *scene, const nt_mesh *mesh)
{
	nmtan_stored_uv stored;
	const nmtan_mesh view = nt_mesh_view(mesh, &stored);
	uint8_t *diagonals = nt_arena_alloc(&scene->arena, mesh->face_count, 1);
	for (size_t f = 0, first = 0; diagonals && f < mesh->face_count; first += mesh->face_sizes[f++])
		diagonals[f] = mesh->face_sizes[f] == 4 ? (uint8_t)nt_written_diagonal(&view, first) : 0;
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
