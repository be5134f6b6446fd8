/* SPDX-License-Identifier: MIT */
/*
 * Edits of a document's buffers, collected. A source buffer is a string of bytes; an edit replaces some of
 * them; new views come behind its end. Nothing moves before all edits are known: see relocate.c.
 *
 * Views are never removed or renumbered, since extensions we do not know may refer to them, and they may not
 * be empty; but they need not keep bytes that nobody reads. The bytes are taken out, and the number waits
 * for a new view: see take_view().
 */
#include "gltf/bytes/bytes.h"

#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"

/* Alignment of insertions if a view's user is unknown: it may be data of an extension that wants 8-byte alignment
 * (EXT_structural_metadata does). */
enum { CAREFUL_ALIGNMENT = 8 };

/* ---- beginning ---- */

static nt_status decompress_accessor(nt_gltf *document, uint32_t index, nt_error *error)
{
	nt_gltf_accessor accessor;
	const nt_status status = nt_gltf_get_accessor(document, index, "/accessors", &accessor, error);
	return status || accessor.view == NT_NONE ? status : nt_gltf_decompress_view(document, accessor.view, error);
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
	edits->decoded = nt_calloc(edits->view_count, sizeof *edits->decoded);
	edits->is_free = nt_calloc(edits->view_count, sizeof *edits->is_free);
	edits->free_views = nt_alloc(edits->view_count, sizeof *edits->free_views);
	edits->accessors = nt_calloc(document->accessor_count, sizeof *edits->accessors);
	if (!edits->accessors || !edits->buffers || !edits->decoded || !edits->is_free || !edits->free_views ||
		!nt_byte_users_find(&edits->users, document)) {
		nt_edits_free(edits);
		return nt_fail_memory(error);
	}
	if (edits->users.unknown)
		edits->alignment = CAREFUL_ALIGNMENT;
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
	for (size_t i = 0; edits->buffers && i < edits->buffer_count; i++) {
		free(edits->buffers[i].edits);
		free(edits->buffers[i].additions);
	}
	for (size_t i = 0; edits->decoded && edits->document->decoded_count && i < edits->view_count; i++) {
		free(edits->decoded[i].edits);
		free(edits->decoded[i].unfiltered);
	}
	for (size_t i = 0; i < edits->packed_count; i++)
		nt_buffer_free(&edits->packed[i].bytes);
	free(edits->packed);
	free(edits->accessors);
	free(edits->is_free);
	free(edits->free_views);
	free(edits->decoded);
	free(edits->buffers);
	free(edits->users.list);
	nt_arena_free(&edits->arena);
	*edits = (nt_buffer_edits){0};
}

/* ---- edits ---- */

nt_edited_buffer *nt_edits_of(nt_buffer_edits *edits, uint32_t buffer)
{
	if (!nt_gltf_is_of_view(buffer))
		return &edits->buffers[buffer];
	const uint32_t view = buffer - NT_GLTF_OF_VIEW(0);
	edits->decoded[view].old_length = edits->document->views[view].length;
	return &edits->decoded[view];
}

nt_status nt_edits_replace(nt_buffer_edits *edits, uint32_t index, uint64_t at, uint64_t removed,
	const unsigned char *bytes, size_t size, nt_error *error)
{
	nt_edited_buffer *buffer = nt_edits_of(edits, index);
	/* Bytes behind keep their alignment; in a view that will be packed again there are whole elements. */
	const bool pads = at + removed < buffer->old_length && !(nt_gltf_is_of_view(index) && edits->keeps_packed);
	const size_t excess = pads ? (size_t)((size - removed) % edits->alignment) : 0;
	if (excess) {
		const size_t padded = size + edits->alignment - excess;
		unsigned char *copy = nt_arena_alloc(&edits->arena, padded, 1);
		if (!copy)
			return nt_fail_memory(error);
		memcpy(copy, bytes, size);
		memset(copy + size, 0, padded - size);
		bytes = copy;
		size = padded;
	}
	if (!nt_grow((void **)&buffer->edits, &buffer->edit_capacity, buffer->edit_count + 1,
		sizeof *buffer->edits))
		return nt_fail_memory(error);
	buffer->edits[buffer->edit_count++] = (nt_buffer_edit){at, removed, bytes, size};
	return NT_OK;
}

static nt_status add_bytes(nt_buffer_edits *edits, uint32_t index, const nt_buffer_addition *addition,
	nt_error *error)
{
	nt_edited_buffer *buffer = &edits->buffers[index];
	if (!nt_grow((void **)&buffer->additions, &buffer->addition_capacity,
		buffer->addition_count + 1, sizeof *buffer->additions))
		return nt_fail_memory(error);
	buffer->additions[buffer->addition_count++] = *addition;
	return NT_OK;
}

nt_status nt_edits_add_bytes(nt_buffer_edits *edits, uint32_t index, uint32_t view, const void *bytes,
	size_t size, nt_error *error)
{
	return add_bytes(edits, index, &(nt_buffer_addition){.view = view, .bytes = bytes, .size = size}, error);
}

nt_status nt_edits_add_written(nt_buffer_edits *edits, uint32_t index, size_t size, nt_view_writer write,
	const void *user, nt_error *error)
{
	const nt_buffer_addition added = {.view = NT_NONE, .write = write, .bytes = user, .size = size};
	return add_bytes(edits, index, &added, error);
}

nt_status nt_edits_add_packed(nt_buffer_edits *edits, uint32_t index, uint32_t view, const void *bytes, size_t size,
	nt_error *error)
{
	const nt_buffer_addition added = {.view = view, .bytes = bytes, .size = size, .packed = true};
	return add_bytes(edits, index, &added, error);
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
	return nt_edits_add_bytes(edits, index, *view, bytes, size, error);
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

/* ---- views whose content is gone ---- */

static bool is_plain(const nt_buffer_edits *edits, uint32_t index, nt_gltf_view *view)
{
	const nt_json_value *json = nt_gltf_view_json(edits->document, index);
	return nt_gltf_get_view(edits->document, index, "", view, NULL) == NT_OK &&
		!nt_gltf_is_of_view(view->buffer) && !nt_json_find(json, "extensions");
}

nt_status nt_edits_release_view(nt_buffer_edits *edits, uint32_t index, size_t users, nt_error *error)
{
	nt_gltf_view view;
	if (!is_plain(edits, index, &view) || edits->is_free[index])
		return NT_OK;
	const uint64_t begin = view.offset, end = begin + view.length, alignment = edits->alignment;
	if (nt_byte_users_count(&edits->users, view.buffer, begin, end) != users)
		return NT_OK;
	/* padding behind it has no purpose any more */
	const uint64_t padded = begin + (view.length + alignment - 1) / alignment * alignment;
	const bool pads = padded <= edits->buffers[view.buffer].old_length &&
		nt_byte_users_count(&edits->users, view.buffer, end, padded) == 0;
	edits->is_free[index] = true;
	edits->free_views[edits->free_count++] = index;
	return nt_edits_replace(edits, view.buffer, begin, (pads ? padded : end) - begin,
		(const unsigned char *)"", 0, error);
}

nt_status nt_edits_release(nt_buffer_edits *edits, uint32_t index, uint64_t offset, uint64_t length,
	nt_error *error)
{
	nt_gltf_view view;
	const nt_status status = nt_edits_release_view(edits, index, 1, error);
	if (status || edits->is_free[index] || !is_plain(edits, index, &view))
		return status;
	const uint64_t begin = view.offset + offset;
	if (length == view.length || nt_byte_users_count(&edits->users, view.buffer, begin, begin + length) != 1)
		return NT_OK;
	return nt_edits_replace(edits, view.buffer, begin, length, (const unsigned char *)"", 0, error);
}
