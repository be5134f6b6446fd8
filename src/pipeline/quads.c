/* SPDX-License-Identifier: MIT */
/*
 * Where quads are cut, for writers of triangles: as nt_written_quad_diagonal() has it. Solved meshes have it from
 * folded_quads.c.
 */
#include "pipeline/stages.h"
#include "topology/corners.h"

nt_status nt_stage_quads(nt_scene *scene, nt_error *error)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		nmtan_stored_uv stored;
		const nmtan_mesh view = nt_mesh_view(mesh, &stored);
		if (!mesh->face_sizes || !mesh->positions || mesh->face_diagonals)
			continue;
		mesh->face_diagonals = nt_arena_alloc(&scene->arena, mesh->face_count, 1);
		if (!mesh->face_diagonals)
			return nt_fail_memory(error);
		nt_written_diagonals(&view, mesh->face_diagonals);
	}
	return NT_OK;
}
