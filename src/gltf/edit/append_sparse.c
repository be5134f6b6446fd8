/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended, in sparse accessors. A copy of an element that the accessor replaces is
 * replaced as well: its number goes to the end of the indices, which stay in order since new elements have
 * the highest numbers, and its element to the end of the values.
 */
#include "gltf/edit/pool_edit.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"

/* One of the two arrays of a sparse accessor, as it is and as it will be. */
typedef struct sparse_array {
	const char *name;
	uint32_t view;
	uint64_t offset, old_size;
	const unsigned char *bytes; /* the whole new array */
	size_t size, width;         /* width: of an element, for its alignment */
	bool extended;              /* the new array begins with the old one */
} sparse_array;

static nt_status move_sparse_array(nt_appending *job, const sparse_array *moved, nt_json_value *json)
{
	uint32_t view;
	const nt_status status = nt_edits_add_view(job->edits, job->buffer, moved->bytes,
		moved->size, 0, 0, &view, job->error);
	nt_json_put_uint64(job->json, json, "bufferView", view);
	nt_json_remove(job->json, json, "byteOffset");
	return status;
}

/* Whether bytes of the pool have been edited: the very same ones, or some of them. */
static void find_edited(const nt_appending *job, uint32_t buffer, uint64_t begin, uint64_t end, bool *same,
	bool *some)
{
	*same = *some = false;
	for (size_t i = 0; i < job->edited_count; i++) {
		const nt_edited_range *e = &job->edited[i];
		if (e->buffer != buffer || e->begin >= end || e->end <= begin)
			continue;
		if (e->begin == begin && e->end == end)
			*same = true;
		else
			*some = true;
	}
}

/* Puts the new array where the old one is; where others use its bytes, into a new view. Morph targets often
 * share one array of indices: they replace the same elements, so it grows once for all of them. */
static nt_status extend_sparse_array(nt_appending *job, const nt_append_target *from, const sparse_array *array)
{
	nt_json_value *json = nt_json_find(nt_json_find(nt_gltf_accessor_json(job->document, from->accessor.index),
		"sparse"), array->name);
	nt_gltf_view view;
	const nt_status status = nt_gltf_get_view(job->document, array->view, "", &view, job->error);
	if (status)
		return status;
	const uint64_t begin = view.offset + array->offset, end = begin + array->old_size;
	bool same, some;
	find_edited(job, view.buffer, begin, end, &same, &some);
	if (some || (!array->extended && begin % array->width) ||
		nt_byte_users_foreign(&job->edits->users, view.buffer, begin, end, job->edits->accessors,
			nt_append_owner(job), NULL, 0))
		return move_sparse_array(job, array, json);
	if (same)
		return NT_OK;
	if (!nt_append_note_edit(job, view.buffer, begin, end))
		return nt_fail_memory(job->error);
	if (!array->extended)
		return nt_edits_replace(job->edits, view.buffer, begin, array->old_size, array->bytes,
			array->size, job->error);
	return nt_edits_replace(job->edits, view.buffer, end, 0, array->bytes + array->old_size,
		array->size - (size_t)array->old_size, job->error);
}

/* Numbers of the elements that are replaced, then those of their copies. */
typedef struct replacement {
	uint32_t *elements;
	unsigned char *values;
	size_t old_count, count;
} replacement;

/* If all that was replaced has the values of others now, the first element is replaced by what it is: a sparse accessor
 * may not be without any. */
static nt_status replace_first(nt_appending *job, const nt_gltf_accessor *a, replacement *out)
{
	const unsigned char *elements;
	const nt_status status = nt_gltf_elements(job->document, a, &elements, job->error);
	if (status)
		return status;
	out->count = 1;
	out->elements[0] = 0;
	if (elements)
		memcpy(out->values, elements + nt_vertex_source(job->vertices, 0) * a->stride, a->element_bytes);
	else
		memset(out->values, 0, a->element_bytes);
	return NT_OK;
}

static nt_status find_replacements(nt_appending *job, const nt_gltf_accessor *a, replacement *out)
{
	const uint32_t *replaced;
	const unsigned char *values;
	const nt_status status =
		nt_gltf_sparse(job->document, a, job->arena, &replaced, &values, job->error);
	if (status)
		return status;
	const nt_pool_vertices *vertices = job->vertices;
	const size_t old_count = (size_t)a->sparse->count, most = old_count + vertices->new_count - vertices->own_count;
	const uint32_t element = a->element_bytes;
	out->elements = nt_arena_alloc(job->arena, most, sizeof *out->elements);
	out->values = nt_arena_alloc(job->arena, most, element);
	uint32_t *position = nt_alloc((size_t)a->count, sizeof *position); /* of an element in replaced */
	if (!out->elements || !out->values || !position) {
		free(position);
		return nt_fail_memory(job->error);
	}
	memset(position, 0xFF, (size_t)a->count * sizeof *position);
	for (size_t i = 0; i < old_count; i++) {
		position[replaced[i]] = (uint32_t)i;
		out->elements[i] = replaced[i];
	}
	memcpy(out->values, values, old_count * element);
	out->old_count = old_count;
	/* welding leaves none where it was */
	out->count = vertices->own_count ? old_count : 0;
	for (size_t vertex = vertices->own_count; vertex < vertices->new_count; vertex++) {
		const uint32_t at = position[nt_vertex_source(vertices, vertex)];
		if (at == NT_NONE)
			continue;
		out->elements[out->count] = (uint32_t)vertex;
		memcpy(out->values + out->count * element, values + (size_t)at * element, element);
		out->count++;
	}
	free(position);
	return out->count ? NT_OK : replace_first(job, a, out);
}

/* Copies of elements that a sparse accessor replaces are replaced too. */
nt_status nt_append_sparse(nt_appending *job, const nt_append_target *from)
{
	const nt_gltf_accessor *a = &from->accessor;
	replacement r = {0};
	nt_status status = find_replacements(job, a, &r);
	const bool grows = job->vertices->own_count;
	if (status || (grows && r.count == r.old_count))
		return status;
	const uint32_t old_width = nt_gltf_component_bytes(a->sparse->index_type);
	const uint32_t type = nt_gltf_index_type(r.elements[r.count - 1], a->sparse->index_type);
	const uint32_t width = nt_gltf_component_bytes(type);
	unsigned char *numbers = nt_arena_alloc(job->arena, r.count, width);
	if (!numbers)
		return nt_fail_memory(job->error);
	nt_gltf_store_indices(r.elements, r.count, width, numbers);

	nt_json_value *sparse = nt_json_find(nt_gltf_accessor_json(job->document, a->index), "sparse");
	nt_json_put_uint64(job->json, sparse, "count", r.count);
	if (type != a->sparse->index_type)
		nt_json_put_uint64(job->json, nt_json_find(sparse, "indices"), "componentType", type);
	status = extend_sparse_array(job, from, &(sparse_array){"indices", a->sparse->index_view,
		a->sparse->index_offset,
		r.old_count * old_width, numbers, r.count * width, width,
		grows && width == old_width});
	if (!status)
		status = extend_sparse_array(job, from, &(sparse_array){"values", a->sparse->value_view,
			a->sparse->value_offset, r.old_count * a->element_bytes, r.values,
			r.count * a->element_bytes, a->component_bytes, grows});
	return status;
}
