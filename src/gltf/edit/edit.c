/* SPDX-License-Identifier: MIT */
/*
 * glTF from glTF: the source document with tangents put in, and nothing else changed. Component by
 * component: vertices are merged, attributes grow, indices follow, TANGENT comes; then offsets are moved
 * and the container is written. What no solved primitive touches is not even looked at.
 *
 * The solve is made on (u, -v), so its w is glTF's as it stands.
 */
#include "gltf/edit/edit.h"

#include <string.h>
#include "gltf/accessor.h"
#include "gltf/edit/write.h"
#include "gltf/edit/draco.h"
#include "gltf/edit/editor.h"
#include "gltf/edit/extensions.h"
#include "gltf/edit/append.h"
#include "gltf/edit/indices.h"
#include "gltf/edit/new_accessors.h"
#include "gltf/quantize.h"
#include "gltf/primitive.h"
#include "gltf/edit/merge_splits.h"
#include "gltf/edit/old_tangents.h"
#include "gltf/view.h"

/* ---- one component ---- */

/* Tangents as they are stored. */
static nt_status stored_tangents(nt_gltf_patcher *p, const nt_gltf_rows *rows, uint32_t group,
	const unsigned char **bytes)
{
	const nt_precision precision = p->options->precision;
	*bytes = (const unsigned char *)rows->tangents[group];
	if (precision == NT_PRECISION_FLOAT)
		return NT_OK;
	unsigned char *out = nt_arena_alloc(p->arena, rows->new_count, nt_precision_bytes(precision));
	if (!out)
		return nt_fail_memory(p->error);
	nt_precision_encode(precision, rows->tangents[group], rows->new_count, out);
	*bytes = out;
	return NT_OK;
}

/* Rounds the tangents of all groups, so that what is derived from them fits what readers will see. */
static nt_status round_tangents(nt_gltf_patcher *p, nt_gltf_cluster *component)
{
	nt_gltf_rows *rows = &component->rows;
	for (uint32_t group = 0; p->options->precision != NT_PRECISION_FLOAT && group < rows->group_count;
		group++) {
		nt_rounding cost = {0};
		if (rows->borrowed) {
			float *own = nt_arena_alloc(p->arena, rows->new_count, 4 * sizeof *own);
			if (!own)
				return nt_fail_memory(p->error);
			rows->tangents[group] = memcpy(own, rows->tangents[group],
				rows->new_count * 4 * sizeof *own);
		}
		nt_precision_round(p->options->precision, rows->tangents[group], rows->new_count, &cost);
		nt_precision_report(p->scene, p->options->precision, &cost,
			&nt_gltf_first_of_group(p, component, group)->place);
		p->quantized = true;
	}
	return NT_OK;
}

/* Tangents in new bytes: for the accessors that the group's meshes had, or for a new one. */
static nt_status add_tangents(nt_gltf_patcher *p, const nt_gltf_cluster *component, uint32_t group,
	const nt_gltf_old_tangents *old)
{
	const nt_gltf_rows *rows = &component->rows;
	const nt_precision precision = p->options->precision;
	const size_t row_bytes = nt_precision_bytes(precision);
	const unsigned char *bytes;
	uint32_t view, accessor;
	nt_status status = stored_tangents(p, rows, group, &bytes);
	if (!status && old->count) {
		status = nt_edits_add_view(&p->edits, component->buffer, bytes,
			rows->new_count * row_bytes, NT_GLTF_ARRAY_BUFFER, 0, &view, p->error);
		if (!status)
			nt_gltf_move_tangents(p, old, view, rows->new_count);
	} else if (!status) {
		status = nt_gltf_add_attribute(p, component->buffer, bytes, rows->new_count, row_bytes,
			nt_precision_component_type(precision), "VEC4", &accessor);
		if (!status)
			nt_gltf_set_attribute(p, component, group, "TANGENT", accessor);
	}
	return status;
}

/* Meshes of the group that had no tangents take those of the others. */
static void complete_tangents(nt_gltf_patcher *p, const nt_gltf_cluster *component, uint32_t group,
	const nt_gltf_old_tangents *old)
{
	const nt_gltf_rows *rows = &component->rows;
	for (uint32_t i = rows->group_first[group]; old->count && i != NT_NONE; i = rows->next_of[i])
		if (nt_gltf_tangent_of(p, component, i) == NT_NONE)
			nt_json_set_uint64(p->json, nt_json_put(p->json, nt_json_find(nt_gltf_primitive_of(
				p->document, &p->scene->meshes[component->members[i]]), "attributes"),
				"TANGENT"), old->accessors[0]);
}

/* NORMAL where it was made, TANGENT where it is not already in place, _BITANGENT where asked for. */
static nt_status add_group(nt_gltf_patcher *p, const nt_gltf_cluster *component, uint32_t group,
	const nt_gltf_old_tangents *old)
{
	const nt_gltf_rows *rows = &component->rows;
	nt_status status = NT_OK;
	uint32_t accessor;
	if (rows->normals[group]) {
		status = nt_gltf_add_floats(p, component->buffer, rows->normals[group], rows->new_count, 3,
			&accessor);
		if (!status)
			nt_gltf_set_attribute(p, component, group, "NORMAL", accessor);
	}
	if (!status && !old->in_place)
		status = add_tangents(p, component, group, old);
	if (!status && old->in_place)
		nt_gltf_retype_tangents(p, old);
	if (!status)
		complete_tangents(p, component, group, old);
	if (!status)
		status = nt_gltf_add_morphs(p, component, group);
	if (!status && p->options->bitangents) {
		float *bitangents;
		status = nt_gltf_bitangents(p, component, group, &bitangents);
		if (!status)
			status = nt_gltf_add_floats(p, component->buffer, bitangents, rows->new_count, 3,
				&accessor);
		if (!status)
			nt_gltf_set_attribute(p, component, group, "_BITANGENT", accessor);
	}
	return status;
}

/* New views of the component go where its positions are. */
static nt_status choose_buffer(nt_gltf_patcher *p, nt_gltf_cluster *component)
{
	const nt_mesh *mesh = nt_gltf_first_of_group(p, component, 0);
	const nt_json_value *attributes =
		nt_json_find(nt_gltf_primitive_of(p->document, mesh), "attributes");
	uint64_t index;
	nt_gltf_accessor accessor;
	nt_gltf_view view = {.buffer = NT_NONE};
	if (nt_json_get_uint64(nt_json_find(attributes, "POSITION"), &index) &&
		nt_gltf_get_accessor(p->document, index, "", &accessor, NULL) == NT_OK &&
		accessor.view != NT_NONE)
		nt_gltf_get_view(p->document, accessor.view, "", &view, NULL);
	return nt_edits_choose_buffer(&p->edits, view.buffer, &component->buffer, p->error);
}

/* New values for accessors that stay in place; the others lose their bytes. */
static nt_status override_tangents(nt_gltf_patcher *p, const nt_gltf_rows *rows, uint32_t group,
	const nt_gltf_old_tangents *old, nt_gltf_override *overrides, size_t *count)
{
	const unsigned char *values = NULL;
	nt_status status = old->in_place ? stored_tangents(p, rows, group, &values)
					    : nt_gltf_release_tangents(p, old);
	for (size_t i = 0; !status && i < old->count; i++)
		overrides[(*count)++] = (nt_gltf_override){.accessor = old->accessors[i], .values = values,
			.width = (uint32_t)nt_precision_bytes(p->options->precision)};
	return status;
}

static nt_status patch_component(nt_gltf_patcher *p, nt_gltf_cluster *component)
{
	/* One row for each tangent that a vertex has. */
	nt_status status = nt_gltf_merge_rows(&component->rows, p->document, p->scene, &p->sharing,
		component->members, component->member_count, p->arena, p->error);
	if (!status && component->rows.group_count == 0)
		return NT_OK;
	if (!status)
		status = choose_buffer(p, component);
	if (status)
		return status;

	/* Compressed primitives are compressed again, or become plain ones here. */
	const bool draco = nt_gltf_has_draco(p, component);
	bool done = false;
	if (draco || p->options->draco > NT_DRACO_OFF)
		status = nt_gltf_patch_draco(p, component, &done);
	if (status || done)
		return status;

	status = round_tangents(p, component);
	if (status)
		return status;

	/* Tangents that are there keep their accessor, and their place where that will do. */
	const nt_gltf_rows *rows = &component->rows;
	nt_gltf_override *overrides = nt_arena_alloc(p->arena, component->member_count, sizeof *overrides);
	nt_gltf_old_tangents *old = nt_arena_alloc(p->arena, rows->group_count, sizeof *old);
	if (!overrides || !old)
		return nt_fail_memory(p->error);
	size_t override_count = 0;
	for (uint32_t group = 0; !status && group < rows->group_count; group++) {
		status = nt_gltf_find_tangents(p, component, group, &old[group]);
		if (!status)
			status = override_tangents(p, rows, group, &old[group], overrides, &override_count);
	}

	/* The copied rows, the indices that use them, and what is new. */
	if (!status && (draco || override_count || rows->new_count > rows->old_count))
		status = nt_gltf_grow_attributes(p, component, overrides, override_count, draco);
	if (!status)
		status = nt_gltf_patch_indices(p, component);
	for (uint32_t group = 0; !status && group < rows->group_count; group++)
		status = add_group(p, component, group, &old[group]);
	return status;
}

/* ---- the whole ---- */

/* --morph=drop: before anything asks who uses which accessor. The accessors keep their numbers. */
static void drop_target_tangents(nt_gltf_patcher *p)
{
	for (size_t i = 0; i < p->scene->mesh_count; i++) {
		const nt_mesh *mesh = &p->scene->meshes[i];
		if (!nt_gltf_is_solved(mesh))
			continue;
		nt_json_value *targets = nt_json_find(nt_gltf_primitive_of(p->document, mesh), "targets");
		for (size_t t = 0; t < nt_json_count(targets); t++)
			nt_json_remove(p->json, nt_json_at(targets, t), "TANGENT");
	}
}

static bool anything_solved(const nt_scene *scene)
{
	for (size_t i = 0; i < scene->mesh_count; i++)
		if (nt_gltf_is_solved(&scene->meshes[i]))
			return true;
	return false;
}

/* Accessors over the same bytes count as one when it is asked who else uses them. */
static void canonise_users(nt_gltf_patcher *p)
{
	for (size_t i = 0; i < p->edits.users.count; i++) {
		nt_byte_user *user = &p->edits.users.list[i];
		if (user->accessor != NT_NONE)
			user->accessor = p->sharing.canonical[user->accessor];
	}
}

static nt_status patch_components(nt_gltf_patcher *p)
{
	nt_status status = nt_gltf_find_sharing(&p->sharing, p->document, p->scene, p->arena, p->error);
	if (status)
		return status;
	p->own = nt_arena_alloc(p->arena, p->sharing.accessor_count, sizeof *p->own);
	if (!p->own)
		return nt_fail_memory(p->error);
	memset(p->own, 0, p->sharing.accessor_count * sizeof *p->own);
	canonise_users(p);
	for (uint32_t i = 0; !status && i < p->sharing.component_count; i++) {
		nt_gltf_cluster component = {.number = i,
			.members = p->sharing.order + p->sharing.first[i],
			.member_count = p->sharing.first[i + 1] - p->sharing.first[i]};
		status = patch_component(p, &component);
	}
	nt_gltf_drop_draco(p);
	if (!status && p->quantized) {
		nt_gltf_list_extension(p->document, "extensionsUsed", NT_GLTF_QUANTIZATION);
		nt_gltf_list_extension(p->document, "extensionsRequired", NT_GLTF_QUANTIZATION);
	}
	return status;
}

static nt_status decompress_attribute(void *context, nt_json_value *attributes, const char *name,
	uint32_t accessor)
{
	(void)attributes;
	(void)name;
	nt_gltf_patcher *p = context;
	nt_gltf_accessor found;
	nt_gltf_view view = {.compression = NULL};
	const nt_status status =
		nt_gltf_get_accessor(p->document, accessor, "/accessors", &found, p->error);
	if (!status && found.view != NT_NONE)
		nt_gltf_get_view(p->document, found.view, "", &view, NULL);
	return status || !view.compression ? status :
					     nt_gltf_decompress_view(p->document, found.view, p->error);
}

/* Compressed views of attributes that will grow. The edits has to know them before it begins. */
static nt_status decompress_views(nt_gltf_patcher *p)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < p->scene->mesh_count; i++) {
		const nt_mesh *mesh = &p->scene->meshes[i];
		if (nt_gltf_is_solved(mesh) &&
			(mesh->split.source_count || mesh->vertex_count > mesh->source_vertex_count))
			status = nt_gltf_visit_attributes(nt_gltf_primitive_of(p->document, mesh),
				nt_json_count(nt_gltf_root_member(p->document, "accessors")),
				decompress_attribute, p);
	}
	return status;
}

nt_status nt_gltf_patch(nt_scene *scene, const nt_write_options *options, nt_output *output,
	nt_error *error)
{
	/* Nothing to be done: the input as it is. */
	bool written = false;
	const bool solved = anything_solved(scene);
	nt_status status = NT_OK;
	if (!solved)
		status = nt_gltf_copy_unchanged(scene, options, output, &written, error);
	if (status || written)
		return status;

	nt_gltf_patcher patcher = {.scene = scene, .document = scene->source, .options = options,
		.error = error};
	patcher.json = patcher.document->json;
	patcher.arena = &patcher.edits.arena;
	if (options->morphs == NT_MORPH_DROP)
		drop_target_tangents(&patcher);
	status = decompress_views(&patcher);
	if (!status)
		status = nt_edits_create(&patcher.edits, patcher.document, error);
	if (status)
		return status;
	if (solved)
		status = patch_components(&patcher);
	if (!status)
		status = nt_gltf_write_document(scene, &patcher.edits, options, output, error);
	nt_edits_free(&patcher.edits);
	return status;
}
