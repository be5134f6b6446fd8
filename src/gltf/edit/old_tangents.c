/* SPDX-License-Identifier: MIT */
/*
 * TANGENT accessors that are there already: which of them are to be written anew, and where.
 *
 * An accessor that only the meshes of one group use as TANGENT keeps its number. Rows of the same type are
 * replaced where they are, and so are interleaved ones that become smaller: their place between other
 * attributes stays as it is, since these are not ours to move. For another type the old bytes are taken
 * out and the accessor gets a new view; so it does where it was sparse, had no bytes or was compressed. What
 * others use too stays, and a new accessor is appended. Bytes that nobody uses are left in one case only:
 * interleaved tangents that become larger, whose slots could not go without another stride for attributes
 * that are to stay as they are.
 */
#include "gltf/edit/old_tangents.h"

#include <stdlib.h>
#include "gltf/accessor.h"
#include "gltf/quantize.h"
#include "gltf/primitive.h"
#include "gltf/view.h"

uint32_t nt_gltf_tangent_of(const nt_gltf_patcher *p, const nt_gltf_cluster *component, size_t member)
{
	uint64_t accessor;
	const nt_json_value *attributes = nt_json_find(nt_gltf_primitive_of(p->document,
		&p->scene->meshes[component->members[member]]), "attributes");
	if (!nt_json_get_uint64(nt_json_find(attributes, "TANGENT"), &accessor) ||
		accessor >= p->sharing.accessor_count)
		return NT_NONE;
	return (uint32_t)accessor;
}

/* Whether nobody uses an accessor but the `known` meshes of a group that have it as TANGENT. */
static bool is_own(const nt_gltf_patcher *p, uint32_t index, size_t known)
{
	const uint32_t canonical = p->sharing.canonical[index];
	nt_gltf_accessor accessor;
	return !p->sharing.foreign[canonical] && p->sharing.attribute_users[canonical] == known &&
		nt_gltf_get_accessor(p->document, index, "", &accessor, NULL) == NT_OK &&
		accessor.components == 4;
}

/* Whether the new rows go where the old ones are. */
static bool fits_in_place(const nt_gltf_patcher *p, uint32_t index)
{
	const nt_precision precision = p->options->precision;
	nt_gltf_accessor a;
	nt_gltf_view view;
	if (nt_gltf_get_accessor(p->document, index, "", &a, NULL) != NT_OK || a.view == NT_NONE ||
		a.sparse_count || nt_gltf_get_view(p->document, a.view, "", &view, NULL) != NT_OK)
		return false;
	if (a.component_type == nt_precision_component_type(precision) &&
		(a.component_type == NT_GLTF_FLOAT || a.normalized))
		return true;
	const uint64_t begin = view.offset + a.offset, end = begin + (a.count - 1) * a.stride + a.element_bytes;
	return a.stride > a.element_bytes && nt_precision_bytes(precision) <= a.element_bytes &&
		nt_byte_users_count(&p->edits.users, view.buffer, begin, end) > 1;
}

static int compare_indices(const void *a, const void *b)
{
	const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
	return (x > y) - (x < y);
}

/* The TANGENT accessors of a group's meshes, in ascending order, each as often as it is used. */
static nt_status list_tangents(nt_gltf_patcher *p, const nt_gltf_cluster *component, uint32_t group,
	uint32_t **list, size_t *count)
{
	const nt_gltf_rows *rows = &component->rows;
	size_t members = 0;
	for (uint32_t i = rows->group_first[group]; i != NT_NONE; i = rows->next_of[i])
		members++;
	*list = nt_arena_alloc(p->arena, members, sizeof **list);
	if (!*list)
		return nt_fail_memory(p->error);
	*count = 0;
	for (uint32_t i = rows->group_first[group]; i != NT_NONE; i = rows->next_of[i]) {
		const uint32_t index = nt_gltf_tangent_of(p, component, i);
		if (index != NT_NONE)
			(*list)[(*count)++] = index;
	}
	qsort(*list, *count, sizeof **list, compare_indices);
	return NT_OK;
}

nt_status nt_gltf_find_tangents(nt_gltf_patcher *p, const nt_gltf_cluster *component, uint32_t group,
	nt_gltf_old_tangents *old)
{
	uint32_t *list;
	size_t count = 0;
	*old = (nt_gltf_old_tangents){.in_place = true};
	const nt_status status = list_tangents(p, component, group, &list, &count);
	if (status)
		return status;
	old->accessors = list; /* what is kept overtakes nothing that is still to be read */
	for (size_t i = 0, end; i < count; i = end) {
		for (end = i + 1; end < count && list[end] == list[i];)
			end++;
		if (!is_own(p, list[i], end - i)) {
			old->count = 0;
			break;
		}
		old->in_place &= fits_in_place(p, list[i]);
		old->accessors[old->count++] = list[i];
	}
	old->in_place &= old->count > 0;
	return NT_OK;
}

nt_status nt_gltf_release_tangents(nt_gltf_patcher *p, const nt_gltf_old_tangents *old)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < old->count; i++) {
		nt_gltf_accessor a;
		status = nt_gltf_get_accessor(p->document, old->accessors[i], "", &a, p->error);
		if (!status && a.view != NT_NONE)
			status = nt_edits_release(&p->edits, a.view, a.offset,
				(a.count - 1) * a.stride + a.element_bytes, p->error);
		if (!status && a.sparse_count)
			status = nt_edits_release(&p->edits, a.sparse_index_view, a.sparse_index_offset,
				a.sparse_count * nt_gltf_component_bytes(a.sparse_index_type), p->error);
		if (!status && a.sparse_count)
			status = nt_edits_release(&p->edits, a.sparse_value_view, a.sparse_value_offset,
				a.sparse_count * a.element_bytes, p->error);
	}
	return status;
}

/* The type that is stored. */
static void set_type(nt_gltf_patcher *p, nt_json_value *accessor)
{
	const uint32_t type = nt_precision_component_type(p->options->precision);
	uint64_t old = 0;
	nt_json_get_uint64(nt_json_find(accessor, "componentType"), &old);
	if (old != type)
		nt_json_set_uint64(p->json, nt_json_put(p->json, accessor, "componentType"), type);
	if (type == NT_GLTF_FLOAT)
		nt_json_remove(p->json, accessor, "normalized");
	else
		nt_json_set_bool(p->json, nt_json_put(p->json, accessor, "normalized"), true);
}

void nt_gltf_retype_tangents(nt_gltf_patcher *p, const nt_gltf_old_tangents *old)
{
	for (size_t i = 0; i < old->count; i++) {
		nt_json_value *json = nt_json_at(nt_gltf_root_member(p->document, "accessors"), old->accessors[i]);
		uint64_t type = 0;
		nt_json_get_uint64(nt_json_find(json, "componentType"), &type);
		if (type != nt_precision_component_type(p->options->precision))
			set_type(p, json);
	}
}

void nt_gltf_move_tangents(nt_gltf_patcher *p, const nt_gltf_old_tangents *old, uint32_t view, size_t count)
{
	for (size_t i = 0; i < old->count; i++) {
		nt_json_value *json = nt_json_at(nt_gltf_root_member(p->document, "accessors"), old->accessors[i]);
		nt_json_set_uint64(p->json, nt_json_put(p->json, json, "bufferView"), view);
		nt_json_set_uint64(p->json, nt_json_put(p->json, json, "count"), count);
		set_type(p, json);
		static const char *const gone[] = {"byteOffset", "sparse", "min", "max"};
		for (size_t k = 0; k < sizeof gone / sizeof *gone; k++)
			nt_json_remove(p->json, json, gone[k]);
	}
}
