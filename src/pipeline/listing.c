/* SPDX-License-Identifier: MIT */
/*
 * The outcome of each mesh, for those who want to see it: copied out of the scene, which is gone when the run
 * is over.
 */
#include "base/memory.h"
#include "pipeline/stages.h"

nt_status nt_stage_listing(const nt_scene *scene, nt_summary *summary, nt_error *error)
{
	summary->lines = nt_calloc(scene->mesh_count, sizeof *summary->lines);
	if (!summary->lines)
		return nt_fail_memory(error);
	summary->line_count = scene->mesh_count;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		const nt_mesh *solved = mesh->plan.same_as ? mesh->plan.same_as : mesh;
		nt_mesh_line *line = &summary->lines[i];
		*line = (nt_mesh_line){.decision = mesh->decision,
			.same = mesh->plan.same_as && nt_mesh_is_wanted(mesh),
			.triangle_count = solved->triangles ? nt_mesh_triangle_count(solved) : 0,
			.vertex_count = solved->unused_vertices + solved->source_vertex_count};
		nt_mesh_place(mesh, &line->place);
		if (solved->vertex_count > solved->source_vertex_count)
			line->appended = solved->vertex_count - solved->source_vertex_count;
		line->appended += solved->split.source_count;
	}
	return NT_OK;
}
