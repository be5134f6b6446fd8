/* SPDX-License-Identifier: MIT */
/*
 * TANGENT accessors that are there already: which of them are to be written anew, and where.
 *
 * An accessor that only the meshes of one set use as TANGENT keeps its number. Elements of the same type are
 * replaced where they are, and so are interleaved ones that become smaller: their place between other
 * attributes stays as it is, since these are not ours to move. For another type the old bytes are taken
 * out and the accessor gets a new place; so it does where it was sparse, had no bytes or was compressed by Draco. An
 * accessor that others use too stays, and a new accessor is appended. Bytes that nobody uses are left in one case
 * only: interleaved tangents that become larger, whose slots could not go without another stride for attributes that
 * are to stay as they are.
 */
#include "gltf/edit/old_tangents.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/accessor.h"

uint32_t nt_gltf_tangent_of(const nt_vertex_pools *pools, const nt_vertex_pool *pool, size_t user)
{
	return nt_gltf_reference(pools->scene->source, nt_json_find(nt_pool_primitive(pool, user), "attributes"),
		"TANGENT");
}

/* Whether nobody uses an accessor but the `known` meshes of a set that have it as TANGENT. */
static bool is_own(const nt_vertex_pools *pools, uint32_t index, size_t known)
{
	const nt_gltf_users *users = nt_gltf_users_of(pools->scene->source, index);
	const nt_gltf_accessor *accessor = nt_gltf_sound_accessor(pools->scene->source, index);
	return !users->foreign && users->attributes == known && accessor &&
		accessor->components == 4;
}

/* Whether the new elements go where the old ones are. */
static bool fits_in_place(const nt_buffer_edits *edits, uint32_t index, const nt_tangent_filter *filter)
{
	const nt_precision precision = filter->precision;
	const nt_gltf_packing packing = nt_packing_of_accessor(edits, index);
	const nt_gltf_accessor *a = nt_gltf_sound_accessor(edits->document, index);
	nt_gltf_view view;
	if (!a || a->view == NT_NONE || a->sparse_count ||
		nt_gltf_get_view(edits->document, a->view, "", &view, NULL) != NT_OK ||
		strcmp(packing.extension ? packing.view.filter : "NONE", filter->filter) != 0)
		return false;
	if (a->component_type == nt_precision_component_type(precision) &&
		(a->component_type == NT_GLTF_FLOAT || a->normalized))
		return true;
	const uint64_t begin = view.offset + a->offset, end = begin + (a->count - 1) * a->stride + a->element_bytes;
	return a->stride > a->element_bytes && nt_precision_bytes(precision) <= a->element_bytes &&
		nt_byte_users_count(&edits->users, view.buffer, begin, end) > 1;
}

static int compare_indices(const void *a, const void *b)
{
	const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
	return (x > y) - (x < y);
}

/* The TANGENT accessors of a set's meshes, in ascending order, each as often as it is used. */
static nt_status list_tangents(const nt_vertex_pools *pools, const nt_vertex_pool *pool, uint32_t set,
	nt_arena *arena, uint32_t **list, size_t *count, nt_error *error)
{
	size_t users = 0;
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i])
		users++;
	*list = nt_arena_alloc(arena, users, sizeof **list);
	if (!*list)
		return nt_fail_memory(error);
	*count = 0;
	for (uint32_t i = pool->sets.first[set]; i != NT_NONE; i = pool->sets.next[i]) {
		const uint32_t index = nt_gltf_tangent_of(pools, pool, i);
		if (index != NT_NONE)
			(*list)[(*count)++] = index;
	}
	qsort(*list, *count, sizeof **list, compare_indices);
	return NT_OK;
}

nt_status nt_gltf_find_tangents(nt_buffer_edits *edits, const nt_vertex_pools *pools, const nt_vertex_pool *pool,
	uint32_t set, const nt_tangent_filter *filter, nt_arena *arena, nt_gltf_old_tangents *old, nt_error *error)
{
	uint32_t *list;
	size_t count = 0;
	*old = (nt_gltf_old_tangents){.in_place = true};
	const nt_status status = list_tangents(pools, pool, set, arena, &list, &count, error);
	if (status)
		return status;
	old->accessors = list; /* what is kept overtakes nothing that is still to be read */
	for (size_t i = 0, end; i < count; i = end) {
		for (end = i + 1; end < count && list[end] == list[i];)
			end++;
		if (!is_own(pools, list[i], end - i)) {
			old->count = 0;
			break;
		}
		old->in_place &= fits_in_place(edits, list[i], filter);
		old->accessors[old->count++] = list[i];
	}
	old->in_place &= old->count > 0;
	return NT_OK;
}

nt_status nt_gltf_release_tangents(nt_buffer_edits *edits, const nt_gltf_old_tangents *old, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < old->count; i++) {
		nt_gltf_accessor a;
		status = nt_gltf_get_accessor(edits->document, old->accessors[i], "", &a, error);
		if (!status && a.view != NT_NONE)
			status = nt_packed_release(edits, a.view, a.offset,
				(a.count - 1) * a.stride + a.element_bytes, error);
		if (!status && a.sparse_count)
			status = nt_edits_release(edits, a.sparse_index_view, a.sparse_index_offset,
				a.sparse_count * nt_gltf_component_bytes(a.sparse_index_type), error);
		if (!status && a.sparse_count)
			status = nt_edits_release(edits, a.sparse_value_view, a.sparse_value_offset,
				a.sparse_count * a.element_bytes, error);
	}
	return status;
}

/* The type that is stored. */
static void set_type(nt_json *json, nt_json_value *accessor, nt_precision precision)
{
	const uint32_t type = nt_precision_component_type(precision);
	uint64_t old = 0;
	nt_json_get_uint64(nt_json_find(accessor, "componentType"), &old);
	if (old != type)
		nt_json_set_uint64(json, nt_json_put(json, accessor, "componentType"), type);
	if (type == NT_GLTF_FLOAT)
		nt_json_remove(json, accessor, "normalized");
	else
		nt_json_set_bool(json, nt_json_put(json, accessor, "normalized"), true);
}

void nt_gltf_retype_tangents(nt_gltf *document, const nt_gltf_old_tangents *old, nt_precision precision)
{
	for (size_t i = 0; i < old->count; i++) {
		nt_json_value *accessor = nt_gltf_accessor_json(document, old->accessors[i]);
		uint64_t type = 0;
		nt_json_get_uint64(nt_json_find(accessor, "componentType"), &type);
		if (type != nt_precision_component_type(precision))
			set_type(document->json, accessor, precision);
	}
}

void nt_gltf_move_tangents(nt_gltf *document, const nt_gltf_old_tangents *old, nt_precision precision,
	uint32_t view, uint64_t offset, size_t count)
{
	nt_json *json = document->json;
	for (size_t i = 0; i < old->count; i++) {
		nt_json_value *accessor = nt_gltf_accessor_json(document, old->accessors[i]);
		nt_gltf_place_accessor(json, accessor, view, offset);
		nt_json_set_uint64(json, nt_json_put(json, accessor, "count"), count);
		set_type(json, accessor, precision);
		nt_json_remove(json, accessor, "min");
		nt_json_remove(json, accessor, "max");
	}
}
