/* SPDX-License-Identifier: MIT */
/*
 * Which meshes are loaded, and which of them are solved with others: see stages.h.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include "file/watch.h"

typedef struct loading {
	nt_scene *scene;
	const nt_format_entry *reader;
	const nt_settings *settings;
	const nt_read_options *options;
	nt_error *error;
} loading;

/* Writers of other formats than the input's need every mesh, solved or not. */
static bool needs_all(const nt_format_entry *reader, const nt_format_entry *writer)
{
	if (!writer)
		return false;
	const bool gltf_in = nt_format_is_gltf(reader->format);
	const bool gltf_out = nt_format_is_gltf(writer->format);
	return !(gltf_in && gltf_out) && reader->format != writer->format;
}

/* For the report alone: a mesh that cannot be read fails a check, but no conversion that does not need
 * it. */
static nt_status load_for_report(const loading *l, nt_mesh *mesh)
{
	if (mesh->same_as && !mesh->same_as->positions) /* that one could not be read */
		return NT_OK;
	const nt_status status = l->reader->load(l->scene, mesh, l->options, l->error);
	if (!status || l->settings->check || status == NT_ERROR_MEMORY)
		return status;
	mesh->positions = NULL;
	nt_error_clear(l->error);
	return NT_OK;
}

/* Finds what is to be solved together, or, for a report, what could be. */
static nt_status find_joins(const loading *l)
{
	nt_scene *scene = l->scene;
	const bool across = l->settings->across == NT_ACROSS_MESH;
	if (!l->reader->find_joins || !(across || l->settings->report))
		return NT_OK;
	const bool checks_kept = across && l->settings->check && l->settings->report;
	const nt_status status = l->reader->find_joins(scene, across, checks_kept, l->error);
	for (size_t i = 0; !status && across && i < scene->join_count; i++)
		for (size_t k = 0; k < scene->joins[i].part_count; k++)
			scene->joins[i].parts[k]->join = &scene->joins[i];
	return status;
}

/* Loads the copies in joins. For a report alone, what cannot be read is left out. */
static nt_status load_copies(const loading *l)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < l->scene->join_count; i++)
		for (size_t k = 0; !status && k < l->scene->joins[i].part_count; k++) {
			nt_mesh *mesh = l->scene->joins[i].parts[k];
			if (!mesh->transform_of)
				continue;
			if (mesh->same_as && !mesh->same_as->positions) /* that one was not loaded */
				mesh->same_as = NULL;
			status = l->reader->load(l->scene, mesh, l->options, l->error);
			if (!status || mesh->join || status == NT_ERROR_MEMORY)
				continue;
			mesh->positions = NULL;
			nt_error_clear(l->error);
			status = NT_OK;
		}
	return status;
}

/* Whether nobody but an edit of the document asks for what is loaded and solved, and only for results. */
static bool asks_for_results(const loading *l, const nt_format_entry *writer)
{
	const nt_settings *s = l->settings;
	return writer && !needs_all(l->reader, writer) && !s->check && !s->report && !s->verify && !s->bitangents &&
		s->across == NT_ACROSS_PRIMITIVE && s->draco <= NT_DRACO_OFF && s->normals == NT_NORMALS_AUTO &&
		!s->list_meshes;
}

/* Whether an edit of the document compresses what is not compressed: primitives, or normals that are made for some that
 * are. */
static bool compresses(const loading *l, const nt_format_entry *writer)
{
	const nt_settings *s = l->settings;
	return writer && !needs_all(l->reader, writer) &&
		(s->draco > NT_DRACO_OFF || (s->draco == NT_DRACO_KEEP && s->normals != NT_NORMALS_AUTO));
}

/* Whether a mesh is loaded: to be solved or written, or for the report alone. */
static bool is_needed(const loading *l, const nt_mesh *mesh, bool all)
{
	return !mesh->late && (nt_mesh_is_wanted(mesh) ||
		((all || l->settings->report) && mesh->triangles && mesh->has_positions));
}

static nt_status load_meshes(const loading *l, const nt_format_entry *writer, bool all)
{
	nt_scene *scene = l->scene;
	bool *needed = nt_alloc(scene->mesh_count, sizeof *needed);
	if (!needed)
		return nt_fail_memory(l->error);
	for (size_t i = 0; i < scene->mesh_count; i++)
		needed[i] = is_needed(l, &scene->meshes[i], all);
	nt_status status = l->reader->share
		? nt_load_ahead(scene, l->reader, asks_for_results(l, writer) ? writer : NULL,
		l->settings, l->options, needed, l->error) : NT_OK;
	for (size_t i = 0; !status && i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		if (needed[i] && (nt_mesh_is_wanted(mesh) || all))
			status = l->reader->load(scene, mesh, l->options, l->error);
		else if (needed[i])
			status = load_for_report(l, mesh);
	}
	free(needed);
	return status;
}

nt_status nt_stage_load(nt_scene *scene, const nt_format_entry *reader, const nt_format_entry *writer,
	const nt_settings *settings, const nt_read_options *options, nt_error *error)
{
	const loading l = {scene, reader, settings, options, error};
	const bool all = needs_all(reader, writer);
	nt_status status = reader->find_same ? reader->find_same(scene, options, error) : NT_OK;
	if (!status)
		status = find_joins(&l);
	if (!status && reader->find_late && asks_for_results(&l, writer))
		status = reader->find_late(scene, error);
	if (!status && reader->find_quantized && compresses(&l, writer))
		status = reader->find_quantized(scene, options, error);
	if (!status && reader->load)
		status = load_meshes(&l, writer, all);
	return status ? status : load_copies(&l);
}

nt_status nt_check_inputs(nt_scene *scene, nt_status status, nt_error *error)
{
	const nt_status watched = nt_watch_check(error);
	if (!watched)
		return status;
	nt_finding_list_free(&scene->findings);
	scene->findings = (nt_finding_list){0};
	return watched;
}
