/* SPDX-License-Identifier: MIT */
/*
 * The accessors of a pool to which vertices are appended, and a record of the bytes that were edited for them.
 */
#include "gltf/edit/pool_edit.h"

#include <stdio.h>
#include <stdlib.h>
#include "gltf/document.h"

bool nt_append_note_edit(nt_appending *job, uint32_t buffer, uint64_t begin, uint64_t end)
{
	if (!nt_grow((void **)&job->edited, &job->edited_capacity, job->edited_count + 1, sizeof *job->edited))
		return false;
	job->edited[job->edited_count++] = (nt_edited_range){buffer, begin, end};
	return true;
}

bool nt_override_add(nt_override_list *list, nt_gltf_override override)
{
	if (!nt_grow((void **)&list->items, &list->capacity, list->count + 1, sizeof *list->items))
		return false;
	list->items[list->count++] = override;
	return true;
}

static nt_status add_target(nt_appending *job, uint32_t index, nt_error *error)
{
	if (!nt_grow((void **)&job->targets, &job->target_capacity, job->target_count + 1, sizeof *job->targets))
		return nt_fail_memory(error);
	nt_append_target *added = &job->targets[job->target_count];
	*added = (nt_append_target){.clone = NT_NONE, .new_view = NT_NONE};
	nt_status status =
		nt_gltf_get_accessor(job->document, index, "/accessors", &added->accessor, error);
	if (status)
		return status;
	if (added->accessor.count != job->vertices->old_count) {
		char pointer[NT_GLTF_POINTER];
		snprintf(pointer, sizeof pointer, "/accessors/%u", index);
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"%llu elements, but other attributes of the same primitives have %zu",
			(unsigned long long)added->accessor.count, job->vertices->old_count);
	}
	if (added->accessor.view != NT_NONE) {
		nt_gltf_view view;
		status = nt_gltf_get_view(job->document, added->accessor.view, "", &view, error);
		if (status)
			return status;
		added->buffer = view.buffer;
		added->begin = view.offset + added->accessor.offset;
	}
	job->target_count++;
	job->edits->accessors[added->accessor.same].appended_by = nt_append_owner(job);
	return NT_OK;
}

static nt_status collect_attribute(nt_appending *job, uint32_t accessor)
{
	if (job->collecting_unsolved)
		job->edits->accessors[accessor].pinned = true;
	if (job->edits->accessors[accessor].seen)
		return NT_OK;
	job->edits->accessors[accessor].seen = true;
	nt_error unread;
	const nt_status status = add_target(job, accessor, job->collecting_beside ? &unread : job->error);
	if (job->collecting_beside && status == NT_ERROR_MEMORY)
		return nt_fail_memory(job->error);
	return job->collecting_beside ? NT_OK : status;
}

static int compare_overrides(const void *a, const void *b)
{
	const uint32_t x = ((const nt_gltf_override *)a)->accessor, y = ((const nt_gltf_override *)b)->accessor;
	return (x > y) - (x < y);
}

nt_status nt_append_collect(nt_appending *job, nt_override_list *overrides)
{
	const nt_vertex_pool *pool = job->vertices->pool;
	nt_status status = NT_OK;
	if (overrides->count)
		qsort(overrides->items, overrides->count, sizeof *overrides->items, compare_overrides);
	for (size_t i = 0; i < overrides->count; i++)
		if (!overrides->items[i].values)
			job->edits->accessors[overrides->items[i].accessor].seen = true;
	for (size_t i = 0; !status && i < overrides->count; i++)
		status = collect_attribute(job, overrides->items[i].accessor);
	/* where nothing grows, the others matter as far as overrides are between them */
	job->collecting_beside = !nt_vertices_differ(job->vertices) && !job->decoded_too;
	for (size_t i = 0; !status && i < pool->user_count; i++) {
		job->collecting_unsolved = !nt_pool_is_solved(pool, i);
		for (nt_gltf_use u = {0}; !status && nt_gltf_next_use(job->document, nt_pool_primitive(pool, i), &u);)
			status = collect_attribute(job, u.accessor);
	}
	for (size_t i = 0; !status && overrides->count && i < job->target_count; i++) {
		const nt_gltf_override key = {.accessor = job->targets[i].accessor.index};
		job->targets[i].override =
			bsearch(&key, overrides->items, overrides->count, sizeof key, compare_overrides);
	}
	return status;
}
