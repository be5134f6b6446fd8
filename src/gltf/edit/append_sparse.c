/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended, in sparse accessors. A copy of a row that the accessor replaces is
 * replaced as well: its number goes to the end of the indices, which stay in order since new rows have
 * the highest numbers, and its element to the end of the values.
 */
#include "gltf/edit/append_sparse.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/accessor.h"
#include "gltf/view.h"

/* One of the two arrays of a sparse accessor, as it is and as it will be. */
typedef struct part {
	const char *name;
	uint32_t view;
	uint64_t offset, old_size;
	const unsigned char *bytes; /* the whole new array */
	size_t size, width;         /* width: of an element, for its alignment */
	bool extended;              /* the new array begins with the old one */
} part;

static nt_status move_part(nt_gltf_growing *g, const part *moved, nt_json_value *json)
{
	nt_gltf_patcher *p = g->patcher;
	uint32_t view;
	const nt_status status = nt_edits_add_view(&p->edits, g->component->buffer, moved->bytes,
		moved->size, 0, 0, &view, p->error);
	nt_json_set_uint64(p->json, nt_json_put(p->json, json, "bufferView"), view);
	nt_json_remove(p->json, json, "byteOffset");
	return status;
}

/* Whether bytes of the component have been edited: the very same ones, or some of them. */
static void find_edited(const nt_gltf_growing *g, uint32_t buffer, uint64_t begin, uint64_t end, bool *same,
	bool *some)
{
	*same = *some = false;
	for (size_t i = 0; i < g->edited_count; i++) {
		const nt_gltf_edited *e = &g->edited[i];
		if (e->buffer != buffer || e->begin >= end || e->end <= begin)
			continue;
		if (e->begin == begin && e->end == end)
			*same = true;
		else
			*some = true;
	}
}

/* Puts the new array where the old one is; where others use its bytes, into a new view. Morph targets often
 * share one array of indices: they replace the same rows, so it grows once for all of them. */
static nt_status grow_part(nt_gltf_growing *g, const nt_gltf_item *from, const part *grown)
{
	nt_gltf_patcher *p = g->patcher;
	nt_json_value *json = nt_json_find(nt_json_find(nt_json_at(
		nt_gltf_root_member(p->document, "accessors"), from->accessor.index), "sparse"),
		grown->name);
	nt_gltf_view view;
	const nt_status status = nt_gltf_get_view(p->document, grown->view, "", &view, p->error);
	if (status)
		return status;
	const uint64_t begin = view.offset + grown->offset, end = begin + grown->old_size;
	bool same, some;
	find_edited(g, view.buffer, begin, end, &same, &some);
	if (some || (!grown->extended && begin % grown->width) ||
		nt_byte_users_foreign(&p->edits.users, view.buffer, begin, end, p->own,
			g->component->number + 1))
		return move_part(g, grown, json);
	if (same)
		return NT_OK;
	if (!nt_gltf_note_edit(g, view.buffer, begin, end))
		return nt_fail_memory(p->error);
	if (!grown->extended)
		return nt_edits_replace(&p->edits, view.buffer, begin, grown->old_size, grown->bytes,
			grown->size, p->error);
	return nt_edits_replace(&p->edits, view.buffer, end, 0, grown->bytes + grown->old_size,
		grown->size - (size_t)grown->old_size, p->error);
}

/* Numbers of the rows that are replaced, then those of their copies. */
typedef struct replacement {
	uint32_t *rows;
	unsigned char *values;
	size_t old_count, count;
} replacement;

static nt_status find_replacements(nt_gltf_growing *g, const nt_gltf_accessor *a, replacement *out)
{
	nt_gltf_patcher *p = g->patcher;
	const uint32_t *replaced;
	const unsigned char *values;
	const nt_status status =
		nt_gltf_sparse(p->document, a, p->arena, &replaced, &values, p->error);
	if (status)
		return status;
	const size_t old_count = (size_t)a->sparse_count, added = nt_gltf_added_rows(g);
	const uint32_t element = a->element_bytes;
	out->rows = nt_arena_alloc(p->arena, old_count + added, sizeof *out->rows);
	out->values = nt_arena_alloc(p->arena, old_count + added, element);
	uint32_t *position = nt_alloc((size_t)a->count, sizeof *position); /* of a row in replaced */
	if (!out->rows || !out->values || !position) {
		free(position);
		return nt_fail_memory(p->error);
	}
	memset(position, 0xFF, (size_t)a->count * sizeof *position);
	for (size_t i = 0; i < old_count; i++) {
		position[replaced[i]] = (uint32_t)i;
		out->rows[i] = replaced[i];
	}
	memcpy(out->values, values, old_count * element);
	out->old_count = out->count = old_count;
	for (size_t row = (size_t)a->count; row < a->count + added; row++) {
		const uint32_t at = position[nt_gltf_row_source(g, row)];
		if (at == NT_NONE)
			continue;
		out->rows[out->count] = (uint32_t)row;
		memcpy(out->values + out->count * element, values + (size_t)at * element, element);
		out->count++;
	}
	free(position);
	return NT_OK;
}

/* Copies of rows that a sparse accessor replaces are replaced too. */
nt_status nt_gltf_grow_sparse(nt_gltf_growing *g, const nt_gltf_item *from)
{
	nt_gltf_patcher *p = g->patcher;
	const nt_gltf_accessor *a = &from->accessor;
	replacement r = {0};
	nt_status status = find_replacements(g, a, &r);
	if (status || r.count == r.old_count)
		return status;
	const uint32_t highest = r.rows[r.count - 1];
	const uint32_t old_width = nt_gltf_component_bytes(a->sparse_index_type);
	uint32_t type = a->sparse_index_type;
	if (type == NT_GLTF_UBYTE && highest > 0xFF)
		type = NT_GLTF_USHORT;
	if (type == NT_GLTF_USHORT && highest > 0xFFFF)
		type = NT_GLTF_UINT;
	const uint32_t width = nt_gltf_component_bytes(type);
	unsigned char *numbers = nt_arena_alloc(p->arena, r.count, width);
	if (!numbers)
		return nt_fail_memory(p->error);
	for (size_t i = 0; i < r.count; i++)
		for (uint32_t k = 0; k < width; k++)
			numbers[i * width + k] = (unsigned char)(r.rows[i] >> 8 * k);

	nt_json_value *sparse = nt_json_find(
		nt_json_at(nt_gltf_root_member(p->document, "accessors"), a->index), "sparse");
	nt_json_set_uint64(p->json, nt_json_put(p->json, sparse, "count"), r.count);
	if (type != a->sparse_index_type)
		nt_json_set_uint64(p->json, nt_json_put(p->json, nt_json_find(sparse, "indices"),
			"componentType"), type);
	status = grow_part(g, from, &(part){"indices", a->sparse_index_view, a->sparse_index_offset,
		r.old_count * old_width, numbers, r.count * width, width, width == old_width});
	if (!status)
		status = grow_part(g, from, &(part){"values", a->sparse_value_view,
			a->sparse_value_offset, r.old_count * a->element_bytes, r.values,
			r.count * a->element_bytes, a->component_bytes, true});
	return status;
}
