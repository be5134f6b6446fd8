/* SPDX-License-Identifier: MIT */
/*
 * Relocation: where bytes of a source buffer lie after its edits, and writing them. A position moves by the
 * sum of what edits that end at or before it have added. Views and accessors are intervals of the buffer, so
 * both ends are mapped and the rest follows. Nothing is reordered.
 */
#include "gltf/bytes/bytes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"

/* The length of a free view that nothing new replaces. */
enum { FREE_VIEW_BYTES = 4 };

/* ---- moving offsets ---- */

static int compare_edits(const void *a, const void *b)
{
	const nt_buffer_edit *x = a, *y = b;
	if (x->at != y->at)
		return x->at < y->at ? -1 : 1;
	return (x->removed > y->removed) - (x->removed < y->removed);
}

/* The new place of a position of a source buffer; one inside of bytes that are replaced, which the unused end of a
 * view may be, stays inside of what comes for them. */
static uint64_t map_position(const nt_relocated_buffer *buffer, uint64_t position)
{
	const nt_buffer_edit *edits = buffer->from->edits;
	size_t low = *buffer->near, high = buffer->from->edit_count;
	/* mostly positions ascend: the next edits are looked at first */
	if (low && edits[low - 1].at + edits[low - 1].removed > position)
		low = 0;
	for (size_t step = 1; step < high - low; step *= 2)
		if (edits[low + step].at + edits[low + step].removed > position)
			high = low + step;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (edits[middle].at + edits[middle].removed <= position)
			low = middle + 1;
		else
			high = middle;
	}
	*buffer->near = low;
	const uint64_t shift = low ? (uint64_t)buffer->shifts[low - 1] : 0;
	if (low < buffer->from->edit_count && edits[low].at < position && edits[low].at + edits[low].size < position)
		position = edits[low].at + edits[low].size;
	return position + shift;
}

/* Puts the edits of a buffer in order; from then on positions can be mapped. */
static nt_status order_edits(nt_buffer_edits *edits, uint32_t index, nt_relocated_buffer *result, nt_error *error)
{
	nt_edited_buffer *from = nt_edits_of(edits, index);
	*result = (nt_relocated_buffer){.from = from,
		.shifts = nt_arena_alloc(&edits->arena, from->edit_count, sizeof *result->shifts),
		.near = nt_arena_alloc(&edits->arena, 1, sizeof *result->near)};
	if (!result->shifts || !result->near)
		return nt_fail_memory(error);
	*result->near = 0;
	bool sorted = true; /* mostly they are */
	for (size_t i = 1; sorted && i < from->edit_count; i++)
		sorted = compare_edits(&from->edits[i - 1], &from->edits[i]) <= 0;
	if (!sorted)
		qsort(from->edits, from->edit_count, sizeof *from->edits, compare_edits);
	int64_t shift = 0;
	for (size_t i = 0; i < from->edit_count; i++) {
		shift += (int64_t)from->edits[i].size - (int64_t)from->edits[i].removed;
		result->shifts[i] = shift;
	}
	return NT_OK;
}

static nt_status place_additions(nt_buffer_edits *edits, nt_relocated_buffer *buffer, nt_error *error)
{
	nt_json *json = edits->document->json;
	nt_json_value *views = nt_gltf_root_member(edits->document, "bufferViews");
	buffer->length = map_position(buffer, buffer->from->old_length);
	buffer->offsets = nt_arena_alloc(&edits->arena, buffer->from->addition_count, sizeof *buffer->offsets);
	if (!buffer->offsets)
		return nt_fail_memory(error);
	for (size_t i = 0; i < buffer->from->addition_count; i++) {
		const nt_buffer_addition *addition = &buffer->from->additions[i];
		buffer->offsets[i] = (buffer->length + 3) / 4 * 4;
		buffer->length = buffer->offsets[i] + addition->size;
		if (addition->view == NT_NONE)
			continue;
		nt_json_value *view = nt_json_at(views, addition->view);
		nt_json_put_uint64(json, addition->packed ? nt_gltf_compression_of(view, NULL) : view, "byteOffset",
			buffer->offsets[i]);
	}
	return NT_OK;
}

/* Sets an offset; a zero that is not written stays so. */
static void set_offset(nt_json *json, nt_json_value *object, const char *key, uint64_t value)
{
	uint64_t old = 0;
	nt_json_find_uint64(object, key, &old);
	if (old != value)
		nt_json_put_uint64(json, object, key, value);
}

/* A buffer must not be empty. */
static nt_status fill_empty_buffer(nt_buffer_edits *edits, uint32_t index, const nt_relocated_buffer *buffer,
	nt_error *error)
{
	static const unsigned char zeros[FREE_VIEW_BYTES];
	const bool emptied = !buffer->from->addition_count && buffer->from->old_length &&
		map_position(buffer, buffer->from->old_length) == 0;
	return emptied ? nt_edits_add_bytes(edits, index, NT_NONE, zeros, sizeof zeros, error) : NT_OK;
}

/* Free views that nothing came for share the first bytes of their buffer. */
static void settle_free_views(const nt_buffer_edits *edits, const nt_relocated *relocated)
{
	nt_json *json = edits->document->json;
	const nt_json_value *views = nt_gltf_root_member(edits->document, "bufferViews");
	for (size_t i = 0; i < edits->free_count; i++) {
		nt_json_value *object = nt_json_at(views, edits->free_views[i]);
		uint64_t buffer = 0;
		nt_json_find_uint64(object, "buffer", &buffer);
		const uint64_t length = relocated->buffers[buffer].length;
		nt_json_remove(json, object, "byteStride");
		set_offset(json, object, "byteOffset", 0);
		set_offset(json, object, "byteLength", length < FREE_VIEW_BYTES ? length : FREE_VIEW_BYTES);
	}
}

/* How a view moves, kept while the offsets of accessors in it are moved. */
typedef struct moved_view {
	const nt_relocated_buffer *buffer; /* NULL: does not move */
	uint64_t old_offset, new_offset;
} moved_view;

/* A packed view: its packed bytes, and its place. */
static void move_packed(const nt_buffer_edits *edits, const nt_relocated_buffer *buffers, nt_json_value *view)
{
	nt_json_value *const objects[] = {nt_gltf_compression_of(view, NULL), view};
	for (size_t k = 0; k < 2; k++) {
		uint64_t buffer, offset = 0;
		nt_json_find_uint64(objects[k], "byteOffset", &offset);
		if (nt_json_find_uint64(objects[k], "buffer", &buffer) && buffer < edits->document->buffer_count)
			set_offset(edits->document->json, objects[k], "byteOffset",
				map_position(&buffers[buffer], offset));
	}
}

static void move_views(nt_buffer_edits *edits, const nt_relocated_buffer *buffers, moved_view *moved)
{
	nt_json *json = edits->document->json;
	nt_json_value *views = nt_gltf_root_member(edits->document, "bufferViews");
	for (size_t i = 0; i < edits->view_count; i++) {
		nt_json_value *object = nt_json_at(views, i);
		nt_gltf_view view;
		if (nt_gltf_compression_of(object, NULL)) {
			move_packed(edits, buffers, object);
			continue;
		}
		if (moved[i].buffer || edits->is_free[i] ||
			nt_gltf_get_view(edits->document, i, "", &view, NULL) != NT_OK ||
			nt_gltf_is_of_view(view.buffer) || edits->buffers[view.buffer].edit_count == 0)
			continue;
		moved[i].buffer = &buffers[view.buffer];
		moved[i].old_offset = view.offset;
		moved[i].new_offset = map_position(moved[i].buffer, view.offset);
		const uint64_t length = map_position(moved[i].buffer, view.offset + view.length) - moved[i].new_offset;
		set_offset(json, object, "byteOffset", moved[i].new_offset);
		set_offset(json, object, "byteLength", length);
		/* emptied accessor by accessor */
		if (view.length && !length)
			edits->free_views[edits->free_count++] = (uint32_t)i;
	}
}

/* Moves "byteOffset" of something that lies in the view its "bufferView" names. */
static void move_in_view(nt_json *json, nt_json_value *object, const moved_view *moved,
	size_t view_count)
{
	uint64_t view, offset = 0;
	if (!nt_json_find_uint64(object, "bufferView", &view) || view >= view_count || !moved[view].buffer)
		return;
	nt_json_find_uint64(object, "byteOffset", &offset);
	set_offset(json, object, "byteOffset",
		map_position(moved[view].buffer, moved[view].old_offset + offset) -
			moved[view].new_offset);
}

static void move_accessors(const nt_buffer_edits *edits, const moved_view *moved)
{
	const size_t view_count = edits->view_count;
	nt_json *json = edits->document->json;
	nt_json_value *accessors = nt_gltf_root_member(edits->document, "accessors");
	for (size_t i = 0; i < nt_json_count(accessors); i++) {
		nt_json_value *accessor = nt_json_at(accessors, i);
		move_in_view(json, accessor, moved, view_count);
		const nt_json_value *sparse = nt_json_find(accessor, "sparse");
		if (sparse) {
			move_in_view(json, nt_json_find(sparse, "indices"), moved, view_count);
			move_in_view(json, nt_json_find(sparse, "values"), moved, view_count);
		}
	}
}

/* ---- writing ---- */

/* A sink, as they are or as base64. */
struct nt_byte_target {
	nt_sink *sink;
	nt_base64 *base64;
	const nt_file *input; /* the document's own file */
};

nt_status nt_target_put(const nt_byte_target *to, const void *bytes, size_t size, nt_error *error)
{
	return to->sink ? nt_sink_write(to->sink, bytes, size, error) : nt_base64_write(to->base64, bytes, size, error);
}

nt_status nt_target_put_file(const nt_byte_target *to, const nt_file *file, nt_error *error)
{
	return to->sink ? nt_sink_copy(to->sink, file, 0, file->size, error) :
			  nt_base64_write(to->base64, file->data, file->size, error);
}

static nt_status put_zeros(const nt_byte_target *to, uint64_t size, nt_error *error)
{
	static const unsigned char zeros[4096];
	nt_status status = NT_OK;
	while (size && !status) {
		const size_t some = size < sizeof zeros ? (size_t)size : sizeof zeros;
		status = nt_target_put(to, zeros, some, error);
		size -= some;
	}
	return status;
}

/* A range of a source buffer: from file to file where that is possible. */
static nt_status put_source(nt_gltf *document, nt_gltf_buffer *buffer,
	const nt_byte_target *to, uint64_t begin, uint64_t end, nt_error *error)
{
	if (begin >= end)
		return NT_OK;
	const uint64_t there = buffer->size < begin ? begin : buffer->size < end ? buffer->size : end;
	const size_t size = (size_t)(there - begin);
	nt_status status = NT_OK;
	if (size && to->sink && buffer->storage == NT_GLTF_STORED_FILE)
		status = nt_sink_copy(to->sink, &buffer->file, (size_t)begin, size, error);
	else if (size && to->sink && buffer->storage == NT_GLTF_STORED_BIN && to->input)
		status = nt_sink_copy(to->sink, to->input,
			document->glb.bin.offset + (size_t)begin, size, error);
	else if (size)
		status = nt_target_put(to, buffer->bytes + begin, size, error);
	if (!to->sink)
		nt_gltf_note_read(document, buffer, begin, size);
	return status ? status : put_zeros(to, end - there, error);
}

/* Pages of a source buffer that was written up to there. */
static void release(const nt_gltf *document, const nt_gltf_buffer *buffer, const nt_file *input, uint64_t begin,
	uint64_t end)
{
	if (buffer->storage == NT_GLTF_STORED_FILE)
		nt_file_release(&buffer->file, (size_t)begin, (size_t)(end - begin));
	else if (buffer->storage == NT_GLTF_STORED_BIN && input)
		nt_file_release(input, document->glb.bin.offset + (size_t)begin, (size_t)(end - begin));
}

static nt_status put_buffer(nt_gltf *document, const nt_relocated_buffer *buffer, uint32_t index,
	const nt_byte_target *to, nt_error *error)
{
	enum { RELEASED_BYTES = 2 << 20 };
	const nt_edited_buffer *from = buffer->from;
	nt_gltf_buffer *source = NULL;
	nt_status status = NT_OK;
	uint64_t at = 0, released = 0, written = map_position(buffer, from->old_length);
	if (from->old_length && document->buffers[index].storage == NT_GLTF_STORED_NOWHERE)
		return put_zeros(to, buffer->length, error);
	if (from->old_length)
		status = nt_gltf_open_buffer(document, index, "/buffers", &source, error);
	for (size_t i = 0; !status && i < from->edit_count; i++) {
		const nt_buffer_edit *edit = &from->edits[i];
		status = put_source(document, source, to, at, edit->at, error);
		if (!status)
			status = nt_target_put(to, edit->bytes, edit->size, error);
		at = edit->at + edit->removed;
		/* many small edits come to as much as a large range, which is not kept in memory either */
		if (source && at - released >= RELEASED_BYTES) {
			release(document, source, to->input, released, at);
			released = at;
		}
	}
	if (!status && source)
		status = put_source(document, source, to, at, from->old_length, error);
	for (size_t i = 0; !status && i < from->addition_count; i++) {
		const nt_buffer_addition *new = &from->additions[i];
		status = put_zeros(to, buffer->offsets[i] - written, error);
		if (!status)
			status = new->write ? new->write(new->bytes, to, error) :
					      nt_target_put(to, new->bytes, new->size, error);
		written = buffer->offsets[i] + new->size;
	}
	return status;
}

/* ---- views that were decompressed ---- */

/* Takes the compressed bytes of a view out, if nobody else refers to them. */
static nt_status remove_compressed(nt_buffer_edits *edits, const nt_json_value *packed, nt_error *error)
{
	uint64_t buffer, offset = 0, length;
	if (!nt_json_find_uint64(packed, "buffer", &buffer) || !nt_json_find_uint64(packed, "byteLength", &length) ||
		buffer >= edits->document->buffer_count)
		return NT_OK;
	nt_json_find_uint64(packed, "byteOffset", &offset);
	const size_t users = nt_byte_users_count(&edits->users, (uint32_t)buffer, offset, offset + length);
	return users == 1 ? nt_edits_replace(edits, (uint32_t)buffer, offset, length,
				    (const unsigned char *)"", 0, error) :
			    NT_OK;
}

/* The bytes of a view after its edits; NULL: memory is exhausted. */
static unsigned char *edit_bytes(nt_arena *arena, const nt_relocated_buffer *view, const unsigned char *bytes,
	size_t *size)
{
	const nt_edited_buffer *from = view->from;
	*size = (size_t)map_position(view, from->old_length);
	unsigned char *const result = nt_arena_alloc(arena, *size, 1), *to = result;
	uint64_t at = 0;
	for (size_t i = 0; to && i <= from->edit_count; i++) {
		const nt_buffer_edit *edit = i < from->edit_count ? &from->edits[i] : NULL;
		const size_t kept = (size_t)((edit ? edit->at : from->old_length) - at);
		memcpy(to, bytes + at, kept);
		to += kept;
		if (!edit)
			break;
		if (edit->size)
			memcpy(to, edit->bytes, edit->size);
		to += edit->size;
		at = edit->at + edit->removed;
	}
	return result;
}

/* A decompressed view whose bytes have changed is packed again or written plain. */
static nt_status settle_decoded(nt_buffer_edits *edits, uint32_t index, moved_view *moved, nt_error *error)
{
	nt_gltf *document = edits->document;
	const bool packs = nt_packing_of(edits, index).extension != NULL;
	const unsigned char *old = document->views[index].decoded;
	nt_relocated_buffer *plain = nt_arena_alloc(&edits->arena, 1, sizeof *plain);
	nt_status status = plain ? order_edits(edits, NT_GLTF_OF_VIEW(index), plain, error) : nt_fail_memory(error);
	if (!status && packs)
		status = nt_packed_bytes(edits, NT_GLTF_OF_VIEW(index), 0, &old, error);
	size_t size = 0;
	unsigned char *bytes = status ? NULL : edit_bytes(&edits->arena, plain, old, &size);
	if (!bytes)
		return status ? status : nt_fail_memory(error);
	*moved = (moved_view){plain, 0, 0};
	if (packs)
		return nt_packed_replace(edits, index, bytes, size, error);
	nt_json_value *view = nt_gltf_view_json(document, index);
	const char *name = "";
	nt_json_value *packed = nt_gltf_compression_of(view, &name);
	uint64_t near = NT_NONE;
	nt_json_find_uint64(packed, "buffer", &near);
	uint32_t buffer = NT_NONE;
	status = remove_compressed(edits, packed, error);
	if (!status)
		status = nt_edits_choose_buffer(edits, (uint32_t)near, &buffer, error);
	if (!status)
		status = nt_edits_add_bytes(edits, buffer, index, bytes, size, error);
	if (status)
		return status;
	nt_json *json = document->json;
	nt_json_put_uint64(json, view, "buffer", buffer);
	nt_json_put_uint64(json, view, "byteLength", size);
	nt_gltf_drop_extension(json, view, name);
	return NT_OK;
}

/* An extension that no view needs any more is not required; its mark on a fallback buffer stays. */
static void drop_unneeded_compression(nt_gltf *document)
{
	static const char *const names[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
	if (document->decoded_count == 0)
		return;
	for (size_t k = 0; k < 2; k++) {
		/* taking a member off the root moves the others */
		const nt_json_value *views = nt_gltf_root_member(document, "bufferViews");
		bool used = false;
		for (size_t i = 0; !used && i < nt_json_count(views); i++)
			used = nt_json_find(nt_json_find(nt_json_at(views, i), "extensions"), names[k]);
		if (!used)
			nt_gltf_remove_extension(document, "extensionsRequired", names[k]);
	}
}

/* Values that a filter moved have other bounds than the encoder said, which everybody sees once the view is plain.
 * Accessors of vertices that were changed have theirs; `seen` says which these are. Indices have theirs too: no filter
 * moves them. */
static nt_status settle_bounds(nt_buffer_edits *edits, nt_error *error)
{
	nt_gltf *document = edits->document;
	nt_status status = NT_OK;
	for (uint32_t i = 0; !status && document->decoded_count && i < document->accessor_count; i++) {
		nt_gltf_accessor a;
		const unsigned char *elements;
		double bounds[2][4];
		const nt_json_value *json = nt_gltf_accessor_json(document, i);
		if (edits->accessors[i].seen || nt_gltf_users_of(document, i)->indices ||
			!nt_json_find(json, "min") ||
			nt_gltf_get_accessor(document, i, "", &a, NULL) || a.view >= edits->view_count ||
			a.sparse || !document->views[a.view].decoded || edits->is_free[a.view] || a.components > 4 ||
			a.element_bytes != a.components * a.component_bytes || nt_packing_of(edits, a.view).extension ||
			!edits->decoded[a.view].edit_count)
			continue;
		status = nt_gltf_elements(document, &a, &elements, error);
		if (status)
			continue;
		nt_component_bounds(elements, a.stride, (size_t)a.count, (int)a.component_type, a.components, bounds);
		nt_gltf_state_bounds(document->json, nt_gltf_accessor_json(document, i), a.components, bounds);
	}
	return status;
}

/* ---- the whole ---- */

/* moved: [view_count] */
static nt_status relocate(nt_buffer_edits *edits, nt_relocated *result, moved_view *moved, nt_error *error)
{
	/* Edits come to an end: views that were decompressed and edited go into buffers, those that have lost all get
	 * a few bytes. */
	nt_status status = settle_bounds(edits, error);
	for (uint32_t i = 0; !status && i < edits->view_count; i++)
		if (edits->decoded[i].edit_count && !edits->is_free[i])
			status = settle_decoded(edits, i, &moved[i], error);
	if (!status)
		status = nt_packed_finish(edits, error);
	bool moves = edits->document->decoded_count > 0;
	*result = (nt_relocated){.document = edits->document, .buffer_count = edits->buffer_count,
		.lists = edits->lists, .list_count = edits->list_count,
		.buffers = nt_arena_alloc(&edits->arena, edits->buffer_count, sizeof *result->buffers)};
	if (!status && !result->buffers)
		status = nt_fail_memory(error);
	for (uint32_t i = 0; !status && i < result->buffer_count; i++) {
		status = order_edits(edits, i, &result->buffers[i], error);
		moves |= edits->buffers[i].edit_count > 0;
		if (!status)
			status = fill_empty_buffer(edits, i, &result->buffers[i], error);
	}
	if (status)
		return status;

	/* Old data moves; new data comes behind it. */
	if (moves) {
		move_views(edits, result->buffers, moved);
		move_accessors(edits, moved);
	}
	nt_json *json = edits->document->json;
	nt_json_value *buffers = nt_gltf_root_member(edits->document, "buffers");
	for (size_t i = 0; !status && i < result->buffer_count; i++) {
		nt_relocated_buffer *buffer = &result->buffers[i];
		status = place_additions(edits, buffer, error);
		if (!status && nt_is_edited(buffer->from))
			set_offset(json, nt_json_at(buffers, i), "byteLength", buffer->length);
	}
	settle_free_views(edits, result);
	drop_unneeded_compression(edits->document);
	return !status && nt_json_failed(json) ? nt_fail_memory(error) : status;
}

nt_status nt_gltf_relocate(nt_buffer_edits *edits, nt_relocated *result, nt_error *error)
{
	moved_view *moved = nt_calloc(edits->view_count, sizeof *moved);
	const nt_status status = moved ? relocate(edits, result, moved, error) : nt_fail_memory(error);
	free(moved);
	return status;
}

nt_status nt_relocated_write(const nt_relocated *relocated, uint32_t buffer, const nt_file *input, nt_sink *sink,
	nt_error *error)
{
	return put_buffer(relocated->document, &relocated->buffers[buffer], buffer,
		&(nt_byte_target){.sink = sink, .input = input}, error);
}

nt_status nt_relocated_encode(const nt_relocated *relocated, uint32_t buffer, nt_base64 *base64, nt_error *error)
{
	return put_buffer(relocated->document, &relocated->buffers[buffer], buffer, &(nt_byte_target){.base64 = base64},
		error);
}
