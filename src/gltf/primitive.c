/* SPDX-License-Identifier: MIT */
/*
 * Primitives and the accessors they name, those over the same bytes known as one.
 */
#include "gltf/primitive.h"

#include <stdlib.h>
#include "gltf/accessor.h"

bool nt_gltf_is_solved(const nt_mesh *mesh)
{
	return mesh->split.vertex_tangents != NULL || mesh->merged;
}

nt_json_value *nt_gltf_primitive_of(const nt_gltf *document, const nt_mesh *mesh)
{
	const nt_json_value *json =
		nt_json_at(nt_gltf_root_member(document, "meshes"), mesh->gltf_mesh);
	return nt_json_at(nt_json_find(json, "primitives"), mesh->gltf_primitive);
}

bool nt_gltf_next_use(const nt_gltf *document, const nt_json_value *primitive, nt_gltf_use *use)
{
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	for (; use->object <= nt_json_count(targets); use->object++, use->member = 0) {
		use->attributes = use->object ? nt_json_at(targets, use->object - 1)
			: nt_json_find(primitive, "attributes");
		while (use->member < nt_json_count(use->attributes)) {
			uint64_t accessor;
			const nt_json_value *reference = nt_json_at(use->attributes, use->member);
			use->name = nt_json_key(use->attributes, use->member++, NULL);
			if (use->name && nt_json_get_uint64(reference, &accessor) &&
				accessor < document->accessor_count) {
				use->accessor = (uint32_t)accessor;
				return true;
			}
		}
	}
	return false;
}

static nt_status visit_object(nt_json_value *attributes, size_t accessor_count, nt_gltf_visit visit,
	void *context)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < nt_json_count(attributes); i++) {
		uint64_t accessor;
		const char *name = nt_json_key(attributes, i, NULL);
		if (name && nt_json_get_uint64(nt_json_at(attributes, i), &accessor) &&
			accessor < accessor_count)
			status = visit(context, attributes, name, (uint32_t)accessor);
	}
	return status;
}

nt_status nt_gltf_visit_attributes(const nt_json_value *primitive, size_t accessor_count,
	nt_gltf_visit visit, void *context)
{
	nt_status status =
		visit_object(nt_json_find(primitive, "attributes"), accessor_count, visit, context);
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	for (size_t i = 0; !status && i < nt_json_count(targets); i++)
		status = visit_object(nt_json_at(targets, i), accessor_count, visit, context);
	return status;
}

/* ---- accessors over the same bytes ---- */

static int compare_accessors(const void *a, const void *b)
{
	const nt_gltf_accessor *x = a, *y = b;
	const uint64_t xs[] = {x->view, x->offset, x->component_type, x->components, x->count,
		x->normalized, x->index};
	const uint64_t ys[] = {y->view, y->offset, y->component_type, y->components, y->count,
		y->normalized, y->index};
	for (size_t i = 0; i < sizeof xs / sizeof *xs; i++)
		if (xs[i] != ys[i])
			return xs[i] < ys[i] ? -1 : 1;
	return 0;
}

static bool same_bytes(nt_gltf_accessor a, nt_gltf_accessor b)
{
	a.index = b.index = 0;
	return compare_accessors(&a, &b) == 0;
}

/* The view that an accessor names; NT_NONE: none that is there. */
static uint32_t claimed_view(const nt_gltf *document, const nt_json_value *accessors, uint32_t index)
{
	uint64_t view;
	return nt_json_get_uint64(nt_json_find(nt_json_at(accessors, index), "bufferView"), &view) &&
			view < document->view_count ?
		(uint32_t)view : NT_NONE;
}

bool nt_gltf_find_first_aliases(nt_gltf *document, uint32_t *first_alias, size_t accessor_count)
{
	/* Most views have one accessor, about which there is no question. */
	const nt_json_value *accessors = nt_gltf_root_member(document, "accessors");
	uint32_t *users = nt_calloc(document->view_count, sizeof *users);
	size_t shared = 0, count = 0;
	for (uint32_t i = 0; users && i < accessor_count; i++) {
		const uint32_t view = first_alias[i] = claimed_view(document, accessors, i);
		if (view != NT_NONE)
			shared += users[view]++ ? 1 + (users[view] == 2) : 0;
	}
	nt_gltf_accessor *list = users ? nt_alloc(shared, sizeof *list) : NULL;
	for (uint32_t i = 0; list && i < accessor_count; i++) {
		nt_gltf_accessor accessor;
		if (first_alias[i] != NT_NONE && users[first_alias[i]] > 1 &&
			nt_gltf_get_accessor(document, i, "", &accessor, NULL) == NT_OK &&
			accessor.view != NT_NONE && !accessor.sparse_count)
			list[count++] = accessor;
		first_alias[i] = i;
	}
	if (count)
		qsort(list, count, sizeof *list, compare_accessors);
	for (size_t i = 1; i < count; i++)
		if (same_bytes(list[i], list[i - 1]))
			first_alias[list[i].index] = first_alias[list[i - 1].index];
	const bool found = list != NULL;
	free(list);
	free(users);
	return found;
}
