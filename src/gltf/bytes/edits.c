/* SPDX-License-Identifier: MIT */
/*
 * Edits of a document's buffers, collected: what becomes of segments, and what is new. Nothing moves before all edits
 * are known: see layout.c.
 */
#include "gltf/bytes/bytes.h"

#include <assert.h>
#include <stdlib.h>
#include "gltf/document.h"

/* ---- beginning ---- */

static nt_status decompress_accessor(nt_gltf *document, uint32_t index, nt_error *error)
{
	const nt_gltf_accessor *accessor;
	const nt_status status = nt_gltf_get_accessor(document, index, "/accessors", &accessor, error);
	return status || accessor->view == NT_NONE ? status : nt_gltf_decompress_view(document, accessor->view, error);
}

/* Tangents may be replaced where they are. */
static nt_status decompress_tangents(nt_gltf *document, const nt_mesh *mesh, nt_error *error)
{
	const uint32_t accessor = nt_gltf_reference(document, nt_json_find(nt_gltf_primitive_of(document, mesh),
		"attributes"), "TANGENT");
	return !nt_gltf_is_solved(mesh) || accessor == NT_NONE ? NT_OK : decompress_accessor(document, accessor, error);
}

/* Vertices are appended to all attributes of a pool, even if only some of its users want them. */
static nt_status decompress_pools(nt_gltf *document, const nt_vertex_pools *pools, bool welds, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < pools->count; i++) {
		bool wanted = welds;
		size_t solved = 0; /* two meshes may want copies where none does alone */
		for (uint32_t k = pools->first[i]; !wanted && k < pools->first[i + 1]; k++) {
			const nt_mesh *mesh = &pools->scene->meshes[pools->order[k]];
			wanted = nt_gltf_is_solved(mesh) && (mesh->split.source_count ||
				mesh->vertex_count > mesh->source_vertex_count || (!mesh->plan.same_as && solved++));
		}
		for (uint32_t k = pools->first[i]; !status && k < pools->first[i + 1]; k++) {
			const nt_mesh *mesh = &pools->scene->meshes[pools->order[k]];
			const nt_json_value *primitive = nt_gltf_primitive_of(document, mesh);
			if (!wanted)
				status = decompress_tangents(document, mesh, error);
			for (nt_gltf_use u = {0}; wanted && !status && nt_gltf_next_use(document, primitive, &u);)
				status = decompress_accessor(document, u.accessor, error);
		}
	}
	return status;
}

nt_status nt_edits_create(nt_buffer_edits *edits, const nt_vertex_pools *pools, bool keeps_packed, bool welds,
	nt_error *error)
{
	nt_gltf *document = pools->scene->source;
	*edits = (nt_buffer_edits){.document = document, .alignment = NT_EDITS_ALIGNMENT,
		.keeps_packed = keeps_packed};
	const nt_status status = decompress_pools(document, pools, welds, error);
	if (status)
		return status;
	edits->view_count = nt_json_count(nt_gltf_root_member(document, "bufferViews"));
	edits->buffer_count = document->buffer_count;
	edits->buffers = nt_calloc(document->buffer_count + 1, sizeof *edits->buffers);
	edits->views = nt_calloc(edits->view_count, sizeof *edits->views);
	edits->free_views = nt_alloc(edits->view_count, sizeof *edits->free_views);
	edits->accessors = nt_calloc(document->accessor_count, sizeof *edits->accessors);
	if (!edits->accessors || !edits->buffers || !edits->views || !edits->free_views || !nt_segments_find(edits)) {
		nt_edits_free(edits);
		return nt_fail_memory(error);
	}
	for (size_t i = 0; i < document->buffer_count; i++) {
		nt_gltf_buffer *buffer;
		if (nt_gltf_describe_buffer(document, i, "", &buffer, NULL) == NT_OK)
			edits->buffers[i].old_length = buffer->length;
	}
	return NT_OK;
}

nt_status nt_edits_create_new(nt_buffer_edits *edits, nt_gltf *document, nt_error *error)
{
	*edits = (nt_buffer_edits){.document = document, .alignment = NT_EDITS_ALIGNMENT,
		.buffers = nt_calloc(1, sizeof *edits->buffers)};
	return edits->buffers ? NT_OK : nt_fail_memory(error);
}

void nt_edits_free(nt_buffer_edits *edits)
{
	for (size_t i = 0; edits->buffers && i < edits->buffer_count; i++)
		free(edits->buffers[i].additions);
	for (size_t i = 0; edits->views && edits->document->decoded_count && i < edits->view_count; i++)
		free(edits->views[i].unfiltered);
	for (size_t i = 0; i < edits->packed_count; i++)
		nt_buffer_free(&edits->packed[i].bytes);
	free(edits->packed);
	free(edits->accessors);
	free(edits->free_views);
	free(edits->views);
	free(edits->buffers);
	free(edits->segments);
	free(edits->changes);
	nt_arena_free(&edits->arena);
	*edits = (nt_buffer_edits){0};
}

/* ---- what leaves ---- */

/* Bytes that one user alone has go with it. */
static void drop_alone(nt_buffer_edits *edits, uint32_t buffer, uint64_t position)
{
	nt_segment *segment = nt_segment_at(edits, buffer, position);
	if (segment && segment->users == 1)
		nt_segment_edit(edits, segment, (nt_segment_change){.size = 0});
}

/* A compressed view leaves its packed bytes, and the place of the plain ones. Not where another extension has it. */
static bool leave_packed(nt_buffer_edits *edits, uint32_t index)
{
	nt_json *json = edits->document->json;
	nt_json_value *object = nt_gltf_view_json(edits->document, index);
	nt_gltf_packing p;
	uint64_t offset = 0;
	if (nt_json_count(nt_json_find(object, "extensions")) != 1 ||
		nt_gltf_get_packing(edits->document, index, &p, NULL) != NT_OK ||
		p.buffer >= edits->document->buffer_count)
		return false;
	nt_json_find_uint64(object, "byteOffset", &offset);
	drop_alone(edits, p.buffer, p.offset);
	drop_alone(edits, p.place, offset);
	nt_json_remove(json, object, "extensions");
	nt_json_put_uint64(json, object, "buffer", p.buffer);
	return true;
}

/* With the segments of a view goes what lies between and behind them: unused bytes, and padding. */
static void leave_gaps(nt_buffer_edits *edits, const nt_gltf_view *view)
{
	const uint64_t alignment = edits->alignment, old_length = edits->buffers[view->buffer].old_length;
	const uint64_t padded = view->offset + (view->length + alignment - 1) / alignment * alignment;
	for (size_t i = nt_segments_before(edits, view->buffer, view->offset); i < edits->segment_count; i++) {
		nt_segment *segment = &edits->segments[i];
		if (segment->buffer != view->buffer || segment->begin >= view->offset + view->length)
			break;
		uint64_t end = padded < old_length ? padded : old_length;
		if (i + 1 < edits->segment_count && segment[1].buffer == segment->buffer && segment[1].begin < end)
			end = segment[1].begin;
		if (!segment->users && end > segment->end)
			segment->end = end;
	}
}

void nt_edits_leave(nt_buffer_edits *edits, uint32_t index, uint64_t offset)
{
	const nt_gltf_view *view = nt_gltf_sound_view(edits->document, index);
	if (!view)
		return;
	const bool decoded = nt_gltf_is_of_view(view->buffer);
	nt_edited_view *of = &edits->views[index];
	nt_segment *segment = nt_segment_at(edits, view->buffer, view->offset + offset);
	if (!segment || !segment->users || !of->users ||
		(!decoded && nt_json_find(nt_gltf_view_json(edits->document, index), "extensions")))
		return;
	assert(!edits->laid_out);
	segment->known -= segment->known > 0;
	if (--segment->users == 0)
		nt_segment_edit(edits, segment, (nt_segment_change){.size = 0});
	if (--of->users || (decoded && !leave_packed(edits, index)))
		return;
	if (!decoded)
		leave_gaps(edits, view);
	of->is_free = true;
	edits->free_views[edits->free_count++] = index;
}

void nt_edits_leave_accessor(nt_buffer_edits *edits, uint32_t accessor)
{
	const nt_gltf_accessor *a = &edits->document->accessors[nt_gltf_same(edits->document, accessor)];
	if (a->view != NT_NONE)
		nt_edits_leave(edits, a->view, a->offset);
	if (a->sparse) {
		nt_edits_leave(edits, a->sparse->index_view, a->sparse->index_offset);
		nt_edits_leave(edits, a->sparse->value_view, a->sparse->value_offset);
	}
}

/* ---- what is new ---- */

static nt_status add(nt_buffer_edits *edits, uint32_t index, const nt_buffer_addition *addition, nt_error *error)
{
	nt_edited_buffer *buffer = &edits->buffers[index];
	if (!nt_grow((void **)&buffer->additions, &buffer->addition_capacity,
		buffer->addition_count + 1, sizeof *buffer->additions))
		return nt_fail_memory(error);
	buffer->additions[buffer->addition_count++] = *addition;
	return NT_OK;
}

nt_status nt_edits_add_bytes(nt_buffer_edits *edits, uint32_t index, uint32_t view, bool packed, const void *bytes,
	size_t size, nt_error *error)
{
	const nt_buffer_addition added = {.view = view, .bytes = bytes, .size = size, .packed = packed};
	return add(edits, index, &added, error);
}

nt_status nt_edits_add_written(nt_buffer_edits *edits, uint32_t index, size_t size, nt_view_writer write,
	const void *user, nt_error *error)
{
	const nt_buffer_addition added = {.view = NT_NONE, .write = write, .bytes = user, .size = size};
	return add(edits, index, &added, error);
}

/* The object of a new view: of a free one, with what else it says, or appended. */
static nt_json_value *take_view(nt_buffer_edits *edits, uint32_t *view)
{
	nt_json *json = edits->document->json;
	nt_json_value *views = nt_json_put(json, nt_json_root(json), "bufferViews");
	if (!edits->free_count) {
		*view = (uint32_t)nt_json_count(views);
		return nt_json_append(json, views);
	}
	*view = edits->free_views[--edits->free_count];
	nt_json_value *object = nt_json_at(views, *view);
	nt_json_remove(json, object, "byteStride");
	nt_json_remove(json, object, "target");
	return object;
}

uint32_t nt_edits_new_view(nt_buffer_edits *edits)
{
	uint32_t view;
	take_view(edits, &view);
	return view;
}

nt_status nt_edits_add_view(nt_buffer_edits *edits, uint32_t index, const void *bytes, size_t size,
	uint32_t target, uint32_t stride, uint32_t *view, nt_error *error)
{
	nt_json *json = edits->document->json;
	nt_json_value *object = take_view(edits, view);
	nt_json_put_uint64(json, object, "buffer", index);
	nt_json_put_uint64(json, object, "byteOffset", 0);
	nt_json_put_uint64(json, object, "byteLength", size);
	if (stride)
		nt_json_put_uint64(json, object, "byteStride", stride);
	if (target)
		nt_json_put_uint64(json, object, "target", target);
	return nt_edits_add_bytes(edits, index, *view, false, bytes, size, error);
}

/* Whether a buffer has bytes that can be extended. */
static bool can_extend(const nt_gltf *document, uint32_t index)
{
	return index < document->buffer_count && document->buffers[index].described &&
		document->buffers[index].storage != NT_GLTF_STORED_NOWHERE;
}

nt_status nt_edits_choose_buffer(nt_buffer_edits *edits, uint32_t near, uint32_t *buffer,
	nt_error *error)
{
	const nt_gltf *document = edits->document;
	*buffer = near;
	if (near != NT_NONE && can_extend(document, near))
		return NT_OK;
	if (edits->buffer_count > document->buffer_count) {
		*buffer = (uint32_t)document->buffer_count;
		return NT_OK;
	}
	for (uint32_t i = 0; i < document->buffer_count; i++)
		if (can_extend(document, i)) {
			*buffer = i;
			return NT_OK;
		}
	/* edits->buffers has room for one more */
	nt_json *json = document->json;
	nt_json_value *buffers = nt_json_put(json, nt_json_root(json), "buffers");
	*buffer = (uint32_t)nt_json_count(buffers);
	nt_json_value *object = nt_json_append(json, buffers);
	nt_json_put_uint64(json, object, "byteLength", 0);
	edits->buffer_count++;
	return nt_json_failed(json) ? nt_fail_memory(error) : NT_OK;
}

