/* SPDX-License-Identifier: MIT */
/*
 * A run counts and lists its meshes here, for those who called it. Nothing changes a mesh.
 */
#include "pipeline/run.h"

#include <stdlib.h>
#include "pipeline/stages.h"

/* Whether any mesh gets tangents. */
bool nt_count_decisions(nt_summary *summary, const nt_scene *scene)
{
	size_t wanted = 0;
	summary->mesh_count = scene->mesh_count;
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const bool is_wanted = nt_mesh_is_wanted(&scene->meshes[i]);
		summary->skipped[scene->meshes[i].decision] += !is_wanted;
		wanted += is_wanted;
	}
	return wanted > 0;
}

/* The outcome of each mesh, copied out of the scene, which is gone when the run is over. */
nt_status nt_list_meshes(nt_summary *summary, const nt_scene *scene, nt_error *error)
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

/* Counts meshes that are written without normals, although a word would make some, those without tangents for which
 * they were made, and primitives of a new glTF. */
static void count_written(nt_summary *s, const nt_scene *scene, const nt_settings *settings)
{
	const bool matters = (settings->normals != NT_NORMALS_AUTO) == nt_format_is_gltf(scene->format);
	for (size_t i = 0; i < scene->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		const bool shaded = mesh->normals_made && !nt_mesh_gets_tangents(mesh);
		s->without_normals += matters && mesh->triangles && mesh->face_count && !mesh->has_normals;
		s->shaded_count += shaded;
		s->made_normals += mesh->normals_made;
		s->kept_normals += mesh->triangles && mesh->has_normals && !mesh->normals_made;
		s->shaded_copies += shaded ? mesh->vertex_count - mesh->source_vertex_count : 0;
		s->made.count += mesh->made_primitives;
		s->made.solved += nt_mesh_gets_tangents(mesh) ? mesh->made_primitives : 0;
		s->made.copies += nt_mesh_gets_tangents(mesh) ? mesh->made_copies : 0;
		s->made.skipped[mesh->decision] += nt_mesh_is_wanted(mesh) ? 0 : mesh->made_primitives;
	}
}

/* Whether tangents stayed of which a stage or the report found that they are wrong. */
static bool keeps_wrong(const nt_summary *summary)
{
	bool any = false;
	for (size_t i = 0; i < summary->findings.count; i++)
		any |= nt_code_is_of_kept(summary->findings.items[i].code);
	for (size_t i = 0; summary->report && i < summary->report->finding_count; i++) {
		const nt_report_finding *f = &summary->report->findings[i];
		any |= f->mesh != NT_NONE && f->severity > NT_SEVERITY_INFO && nt_code_is_of_kept(f->code);
	}
	return any;
}

/* Vertices that several meshes share are counted once, and copies that they share too. */
static void count_once(const nt_shared_vertices *shared, nt_summary *summary)
{
	summary->vertex_count += shared->actual.vertices - shared->counted.vertices;
	summary->appended_normals += shared->actual.normal_copies - shared->counted.normal_copies;
	summary->appended_tangents += shared->actual.tangent_copies - shared->counted.tangent_copies;
}

void nt_summarise(nt_summary *summary, nt_scene *scene, const nt_settings *settings, nt_status status)
{
	summary->findings = scene->findings;
	summary->input_format = scene->format;
	summary->rounding = scene->rounding;
	summary->morph_cost = scene->morph_cost;
	if (!status) /* else meshes may be without content */
		count_written(summary, scene, settings);
	summary->welded = scene->welded;
	summary->packed = scene->packed;
	count_once(&scene->shared, summary);
	summary->keeps_wrong = !settings->check && keeps_wrong(summary);
	scene->findings = (nt_finding_list){0};
}

void nt_summary_free(nt_summary *summary)
{
	nt_finding_list_free(&summary->findings);
	nt_report_free(summary->report);
	free(summary->lines);
	free(summary->note);
	nt_trace_free(&summary->trace);
	summary->lines = NULL;
	summary->note = NULL;
	summary->report = NULL;
}

const char *nt_stage_name(nt_stage stage)
{
	static const char *const names[NT_STAGE_COUNT] = {
		[NT_STAGE_MAP] = "map",
		[NT_STAGE_PARSE] = "parse",
		[NT_STAGE_INDEX] = "index",
		[NT_STAGE_DECODE] = "decode",
		[NT_STAGE_TEXTURES] = "textures",
		[NT_STAGE_NORMALS] = "normals",
		[NT_STAGE_WELD] = "weld",
		[NT_STAGE_TANGENTS] = "tangents",
		[NT_STAGE_SPLIT] = "split",
		[NT_STAGE_WRITE] = "write",
		[NT_STAGE_VERIFY] = "verify",
		[NT_STAGE_REPORT] = "report",
	};
	return names[stage];
}
