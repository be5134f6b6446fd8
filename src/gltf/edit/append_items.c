/* SPDX-License-Identifier: MIT */
/*
 * The accessors of a component to which vertices are appended, and a record of the bytes that were edited for them.
 */
#include "gltf/edit/append_items.h"

#include <stdio.h>
#include <stdlib.h>
#include "gltf/accessor.h"
#include "gltf/primitive.h"
#include "gltf/view.h"

bool nt_gltf_note_edit(nt_gltf_growing *g, uint32_t buffer, uint64_t begin, uint64_t end)
{
	if (!nt_grow((void **)&g->edited, &g->edited_capacity, g->edited_count + 1, sizeof *g->edited))
		return false;
	g->edited[g->edited_count++] = (nt_gltf_edited){buffer, begin, end};
	return true;
}

static nt_status add_item(nt_gltf_growing *g, uint32_t index)
{
	nt_gltf_patcher *p = g->patcher;
	if (!nt_grow((void **)&g->items, &g->item_capacity, g->item_count + 1, sizeof *g->items))
		return nt_fail_memory(p->error);
	nt_gltf_item *added = &g->items[g->item_count];
	*added = (nt_gltf_item){.clone = NT_NONE};
	nt_status status =
		nt_gltf_get_accessor(p->document, index, "/accessors", &added->accessor, p->error);
	if (status)
		return status;
	if (added->accessor.count != g->component->rows.old_count) {
		char pointer[NT_GLTF_POINTER];
		snprintf(pointer, sizeof pointer, "/accessors/%u", index);
		return nt_fail_pointer(p->error, NT_ERROR_INPUT, pointer,
			"%llu elements, but other attributes of the same primitives have %zu",
			(unsigned long long)added->accessor.count, g->component->rows.old_count);
	}
	if (added->accessor.view != NT_NONE) {
		nt_gltf_view view;
		status = nt_gltf_get_view(p->document, added->accessor.view, "", &view, p->error);
		if (status)
			return status;
		added->buffer = view.buffer;
		added->begin = view.offset + added->accessor.offset;
	}
	g->item_count++;
	p->own[p->sharing.canonical[index]] = g->component->number + 1;
	return NT_OK;
}

static nt_status collect_attribute(void *context, nt_json_value *attributes, const char *name,
	uint32_t accessor)
{
	(void)attributes;
	(void)name;
	nt_gltf_growing *g = context;
	if (g->collecting_unsolved)
		g->pinned[accessor] = true;
	if (g->seen[accessor])
		return NT_OK;
	g->seen[accessor] = true;
	return add_item(g, accessor);
}

static int compare_overrides(const void *a, const void *b)
{
	const uint32_t x = ((const nt_gltf_override *)a)->accessor, y = ((const nt_gltf_override *)b)->accessor;
	return (x > y) - (x < y);
}

nt_status nt_gltf_collect_items(nt_gltf_growing *g, nt_gltf_override *overrides, size_t override_count)
{
	const nt_gltf_patcher *p = g->patcher;
	nt_status status = NT_OK;
	if (override_count)
		qsort(overrides, override_count, sizeof *overrides, compare_overrides);
	for (size_t i = 0; i < override_count; i++)
		if (!overrides[i].values)
			g->seen[overrides[i].accessor] = true;
	const bool all = nt_gltf_added_rows(g) || g->decoded_too;
	for (size_t i = 0; !status && all && i < g->component->member_count; i++) {
		const nt_mesh *mesh = &p->scene->meshes[g->component->members[i]];
		g->collecting_unsolved = g->component->rows.group_of[i] == NT_NONE;
		status = nt_gltf_visit_attributes(nt_gltf_primitive_of(p->document, mesh),
			p->sharing.accessor_count, collect_attribute, g);
	}
	for (size_t i = 0; !status && i < override_count; i++) {
		g->collecting_unsolved = false;
		status = collect_attribute(g, NULL, "TANGENT", overrides[i].accessor);
	}
	for (size_t i = 0; !status && override_count && i < g->item_count; i++) {
		const nt_gltf_override key = {.accessor = g->items[i].accessor.index};
		g->items[i].override =
			bsearch(&key, overrides, override_count, sizeof key, compare_overrides);
	}
	return status;
}
