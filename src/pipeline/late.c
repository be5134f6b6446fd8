/* SPDX-License-Identifier: MIT */
/*
 * Some meshes of a scene go through the stages as if they were the scene, with an arena of their own.
 */
#include "pipeline/late.h"

static void set_late(const nt_scene *part, bool late)
{
	for (size_t i = 0; i < part->mesh_count; i++)
		part->meshes[i].late = late;
}

static nt_status solve(const nt_late *l, nt_scene *part, nt_error *error)
{
	nt_status status = NT_OK;
	l->begin_stage(l->run, NT_STAGE_DECODE);
	for (size_t i = 0; !status && i < part->mesh_count; i++)
		status = l->reader->load(part, &part->meshes[i], l->options, error);
	l->begin_stage(l->run, NT_STAGE_NORMALS);
	if (!status)
		status = nt_stage_normals(part, l->settings->normals, l->settings->threads, error);
	l->begin_stage(l->run, NT_STAGE_TANGENTS);
	if (!status)
		status = nt_stage_tangents(part, l->settings, l->output, l->summary, error);
	l->begin_stage(l->run, NT_STAGE_WRITE);
	return status;
}

nt_status nt_late_solve(void *late, size_t first, size_t count, nt_error *error)
{
	nt_late *l = late;
	nt_late_free(l);
	nt_scene part = *l->scene;
	part.meshes += first;
	part.mesh_count = count;
	part.arena = (nt_arena){0};
	set_late(&part, false);
	const nt_status status = solve(l, &part, error);
	set_late(&part, true);
	l->arena = part.arena;
	l->meshes = part.meshes;
	l->mesh_count = part.mesh_count;
	l->scene->findings = part.findings;
	return status;
}

void nt_late_free(nt_late *late)
{
	for (size_t i = 0; i < late->mesh_count; i++)
		nt_mesh_forget(&late->meshes[i]);
	late->mesh_count = 0;
	nt_arena_free(&late->arena);
}
