/* SPDX-License-Identifier: MIT */
/*
 * The new buffers. Each is laid out as the segments of the old one in their order, with what lies between them, and new
 * views behind; offsets in the JSON follow, and the bytes are streamed. Nothing is reordered.
 */
#include "gltf/bytes/bytes.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include "gltf/document.h"

/* ---- laying out ---- */

/* The segments of a buffer that had `old_length` bytes get their places. Returns its new length; *changed: another. */
static uint64_t lay_out(nt_buffer_edits *edits, uint32_t buffer, uint64_t old_length, bool *changed)
{
	/* what lies behind keeps its alignment; in a view that will be packed again there are whole elements */
	const uint64_t alignment = nt_gltf_is_of_view(buffer) && edits->keeps_packed ? 1 : edits->alignment;
	int64_t shift = 0;
	*changed = false;
	for (size_t i = nt_segments_before(edits, buffer, 0);
		i < edits->segment_count && edits->segments[i].buffer == buffer; i++) {
		nt_segment *segment = &edits->segments[i];
		segment->shift = shift;
		if (!segment->changed)
			continue;
		nt_segment_change *change = &edits->changes[i];
		const uint64_t added = change->size - (change->kept ? 0 : segment->end - segment->begin);
		change->padding = segment->end < old_length ? (uint8_t)(-added % alignment) : 0;
		shift += (int64_t)(added + change->padding);
		*changed = true;
	}
	return old_length + (uint64_t)shift;
}

/* Returns where a position of a source buffer lies in the new one, once that is laid out: the begin of something, or
 * its end. */
static uint64_t new_place(nt_buffer_edits *edits, uint32_t buffer, uint64_t position, bool is_end)
{
	const size_t count = nt_segments_before(edits, buffer, position + !is_end);
	const nt_segment *s = count ? &edits->segments[count - 1] : NULL;
	assert(edits->laid_out);
	if (!s || s->buffer != buffer)
		return position;
	const uint64_t moved = position + (uint64_t)s->shift;
	if (!s->changed)
		return moved;
	const nt_segment_change *c = &edits->changes[s - edits->segments];
	const uint64_t new_end = (uint64_t)s->shift + (c->kept ? s->end : s->begin) + c->size + c->padding;
	if (position >= s->end)
		return new_end + (position - s->end);
	/* views of attributes that are interleaved may end before their last vertex does: they go on to its end */
	return is_end && c->stride > s->end - position ? new_end : moved < new_end ? moved : new_end;
}

static void lay_out_additions(nt_buffer_edits *edits, nt_edited_buffer *buffer)
{
	nt_json *json = edits->document->json;
	nt_json_value *views = nt_gltf_root_member(edits->document, "bufferViews");
	for (size_t i = 0; i < buffer->addition_count; i++) {
		nt_buffer_addition *added = &buffer->additions[i];
		added->offset = (buffer->length + 3) / 4 * 4;
		buffer->length = added->offset + added->size;
		if (added->view == NT_NONE)
			continue;
		nt_json_value *view = nt_json_at(views, added->view);
		nt_json_put_uint64(json, added->packed ? nt_gltf_compression_of(view, NULL) : view, "byteOffset",
			added->offset);
	}
}

/* ---- moving offsets ---- */

void nt_gltf_set_number(nt_json *json, nt_json_value *object, const char *key, uint64_t value)
{
	uint64_t old = 0;
	nt_json_find_uint64(object, key, &old);
	if (old != value)
		nt_json_put_uint64(json, object, key, value);
}

/* A packed view: its packed bytes, and its place. */
static void move_packed(nt_buffer_edits *edits, nt_json_value *view)
{
	nt_json_value *const objects[] = {nt_gltf_compression_of(view, NULL), view};
	for (size_t k = 0; k < 2; k++) {
		uint64_t buffer, offset = 0;
		nt_json_find_uint64(objects[k], "byteOffset", &offset);
		if (nt_json_find_uint64(objects[k], "buffer", &buffer) && buffer < edits->document->buffer_count)
			nt_gltf_set_number(edits->document->json, objects[k], "byteOffset",
				new_place(edits, (uint32_t)buffer, offset, false));
	}
}

/* A view of the source that moves, or of which something moves within it; NULL: neither. */
static const nt_gltf_view *moving_view(const nt_buffer_edits *edits, uint64_t index)
{
	const nt_gltf_view *view = nt_gltf_sound_view(edits->document, index);
	return view && !edits->views[index].is_free &&
		(nt_gltf_is_of_view(view->buffer) || edits->buffers[view->buffer].changed) ? view : NULL;
}

static void move_views(nt_buffer_edits *edits)
{
	nt_json *json = edits->document->json;
	nt_json_value *views = nt_gltf_root_member(edits->document, "bufferViews");
	for (uint32_t i = 0; i < edits->view_count; i++) {
		nt_json_value *object = nt_json_at(views, i);
		if (nt_gltf_compression_of(object, NULL)) {
			move_packed(edits, object);
			continue;
		}
		const nt_gltf_view *view = moving_view(edits, i);
		if (!view || nt_gltf_is_of_view(view->buffer))
			continue;
		const uint64_t begin = new_place(edits, view->buffer, view->offset, false);
		const uint64_t end = new_place(edits, view->buffer, view->offset + view->length, true);
		nt_gltf_set_number(json, object, "byteOffset", begin);
		nt_gltf_set_number(json, object, "byteLength", end - begin);
		/* its bytes were another view's too, who has left */
		if (view->length && end == begin)
			edits->free_views[edits->free_count++] = i;
	}
}

/* Moves "byteOffset" of something that lies in the view its "bufferView" names. */
static void move_in_view(nt_buffer_edits *edits, nt_json_value *object)
{
	uint64_t index, offset = 0;
	const nt_gltf_view *view = nt_json_find_uint64(object, "bufferView", &index) ? moving_view(edits, index) : NULL;
	if (!view)
		return;
	nt_json_find_uint64(object, "byteOffset", &offset);
	nt_gltf_set_number(edits->document->json, object, "byteOffset",
		new_place(edits, view->buffer, view->offset + offset, false) -
			new_place(edits, view->buffer, view->offset, false));
}

static void move_accessors(nt_buffer_edits *edits)
{
	nt_json_value *accessors = nt_gltf_root_member(edits->document, "accessors");
	for (size_t i = 0; i < nt_json_count(accessors); i++) {
		nt_json_value *accessor = nt_json_at(accessors, i);
		move_in_view(edits, accessor);
		const nt_json_value *sparse = nt_json_find(accessor, "sparse");
		if (sparse) {
			move_in_view(edits, nt_json_find(sparse, "indices"));
			move_in_view(edits, nt_json_find(sparse, "values"));
		}
	}
}

/* Free views that nothing came for share the first bytes of their buffer. */
static void settle_free_views(const nt_buffer_edits *edits)
{
	nt_json *json = edits->document->json;
	const nt_json_value *views = nt_gltf_root_member(edits->document, "bufferViews");
	for (size_t i = 0; i < edits->free_count; i++) {
		nt_json_value *object = nt_json_at(views, edits->free_views[i]);
		uint64_t buffer = 0;
		nt_json_find_uint64(object, "buffer", &buffer);
		const uint64_t length = edits->buffers[buffer].length;
		nt_json_remove(json, object, "byteStride");
		nt_gltf_set_number(json, object, "byteOffset", 0);
		nt_gltf_set_number(json, object, "byteLength",
			length < NT_FREE_VIEW_BYTES ? length : NT_FREE_VIEW_BYTES);
	}
}

/* ---- writing ---- */

/* A sink, as they are or as base64; or memory. */
struct nt_byte_target {
	nt_sink *sink;
	nt_base64 *base64;
	unsigned char **memory;
	const nt_file *input; /* the document's own file */
};

nt_status nt_target_put(const nt_byte_target *to, const void *bytes, size_t size, nt_error *error)
{
	if (to->memory)
		*to->memory = (unsigned char *)memcpy(*to->memory, bytes, size) + size;
	return to->memory ? NT_OK : to->sink ? nt_sink_write(to->sink, bytes, size, error)
					     : nt_base64_write(to->base64, bytes, size, error);
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
	if (to->base64)
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

/* The segments of a buffer of the source, and what lies between them. */
static nt_status put_segments(nt_buffer_edits *edits, uint32_t index, nt_gltf_buffer *source, uint64_t old_length,
	const nt_byte_target *to, nt_error *error)
{
	enum { RELEASED_BYTES = 2 << 20 };
	uint64_t at = 0, released = 0;
	nt_status status = NT_OK;
	for (size_t i = nt_segments_before(edits, index, 0);
		!status && i < edits->segment_count && edits->segments[i].buffer == index; i++) {
		const nt_segment *s = &edits->segments[i];
		if (!s->changed)
			continue;
		const nt_segment_change *c = &edits->changes[i];
		status = put_source(edits->document, source, to, at, c->kept ? s->end : s->begin, error);
		if (!status && c->size)
			status = nt_target_put(to, c->bytes, c->size, error);
		if (!status)
			status = put_zeros(to, c->padding, error);
		at = s->end;
		/* many small edits come to as much as a large range, which is not kept in memory either */
		if (at - released >= RELEASED_BYTES) {
			release(edits->document, source, to->input, released, at);
			released = at;
		}
	}
	return status ? status : put_source(edits->document, source, to, at, old_length, error);
}

static nt_status put_buffer(nt_buffer_edits *edits, uint32_t index, const nt_byte_target *to, nt_error *error)
{
	const nt_edited_buffer *buffer = &edits->buffers[index];
	nt_gltf_buffer *source = NULL;
	nt_status status = NT_OK;
	uint64_t written = new_place(edits, index, buffer->old_length, true);
	if (buffer->old_length && edits->document->buffers[index].storage == NT_GLTF_STORED_NOWHERE)
		return put_zeros(to, buffer->length, error);
	if (buffer->old_length)
		status = nt_gltf_open_buffer(edits->document, index, "/buffers", &source, error);
	if (!status && source)
		status = put_segments(edits, index, source, buffer->old_length, to, error);
	for (size_t i = 0; !status && i < buffer->addition_count; i++) {
		const nt_buffer_addition *new = &buffer->additions[i];
		status = put_zeros(to, new->offset - written, error);
		if (!status)
			status = new->write ? new->write(new->bytes, to, error) :
					      nt_target_put(to, new->bytes, new->size, error);
		written = new->offset + new->size;
	}
	return status;
}

nt_status nt_edits_write(nt_buffer_edits *edits, uint32_t buffer, const nt_file *input, nt_sink *sink, nt_error *error)
{
	return put_buffer(edits, buffer, &(nt_byte_target){.sink = sink, .input = input}, error);
}

nt_status nt_edits_encode(nt_buffer_edits *edits, uint32_t buffer, nt_base64 *base64, nt_error *error)
{
	return put_buffer(edits, buffer, &(nt_byte_target){.base64 = base64}, error);
}

/* ---- views that were decompressed ---- */

/* One whose bytes have changed is packed again or written plain. */
static nt_status settle_decoded(nt_buffer_edits *edits, uint32_t index, nt_error *error)
{
	nt_gltf *document = edits->document;
	nt_json *json = document->json;
	nt_json_value *view = nt_gltf_view_json(document, index);
	const uint64_t old_length = document->views[index].length;
	const uint32_t own = NT_GLTF_OF_VIEW(index);
	const unsigned char *old = document->views[index].decoded;
	bool changed;
	const size_t size = (size_t)lay_out(edits, own, old_length, &changed);
	if (!changed || edits->views[index].is_free)
		return NT_OK;
	nt_status status = nt_packed_bytes(edits, own, 0, &old, error);
	unsigned char *bytes = nt_arena_alloc(&edits->arena, size, 1), *end = bytes;
	if (status || !bytes)
		return status ? status : nt_fail_memory(error);
	put_segments(edits, own, &(nt_gltf_buffer){.storage = NT_GLTF_STORED_DATA, .bytes = old,
		.size = (size_t)old_length}, old_length, &(nt_byte_target){.memory = &end}, error);
	if (nt_packing_of(edits, index).extension)
		return nt_packed_replace(edits, index, bytes, size, error);

	nt_gltf_packing p;
	uint32_t buffer = NT_NONE;
	status = nt_gltf_get_packing(document, index, &p, error);
	nt_segment *packed = status ? NULL : nt_segment_at(edits, p.buffer, p.offset);
	if (packed && packed->users == 1)
		nt_segment_edit(edits, packed, (nt_segment_change){.size = 0});
	if (!status)
		status = nt_edits_choose_buffer(edits, p.buffer, &buffer, error);
	if (!status)
		status = nt_edits_add_bytes(edits, buffer, index, false, bytes, size, error);
	if (status)
		return status;
	nt_json_put_uint64(json, view, "buffer", buffer);
	nt_json_put_uint64(json, view, "byteLength", size);
	nt_gltf_drop_extension(json, view, p.extension);
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
		const nt_gltf_accessor *a = nt_gltf_sound_accessor(document, i);
		const unsigned char *elements;
		if (!a || edits->accessors[i].seen || nt_gltf_users_of(document, i)->indices ||
			a->view >= edits->view_count || a->sparse || !document->views[a->view].decoded ||
			edits->views[a->view].is_free ||
			nt_gltf_compression_of(nt_gltf_view_json(document, a->view), NULL))
			continue;
		status = nt_gltf_elements(document, a, &elements, error);
		if (!status)
			nt_gltf_measure(document, a, nt_gltf_accessor_json(document, i), elements, a->stride,
				(size_t)a->count, a->component_type);
	}
	return status;
}

/* Takes out a buffer that was added for what then stayed as it was: there is none of no bytes. */
static void drop_unused_buffer(nt_buffer_edits *edits)
{
	const nt_gltf *document = edits->document;
	nt_json_value *buffers = nt_gltf_root_member(document, "buffers");
	if (edits->buffer_count == document->buffer_count || edits->buffers[document->buffer_count].addition_count)
		return;
	nt_json_remove_at(document->json, buffers, --edits->buffer_count);
	if (!edits->buffer_count)
		nt_json_remove(document->json, nt_json_root(document->json), "buffers");
}

/* ---- the whole ---- */

nt_status nt_edits_end(nt_buffer_edits *edits, nt_error *error)
{
	static const unsigned char zeros[NT_FREE_VIEW_BYTES];
	nt_gltf *document = edits->document;
	nt_json *json = document->json;
	nt_status status = NT_OK;
	for (uint32_t i = 0; !status && document->decoded_count && i < edits->view_count; i++)
		if (document->views[i].decoded)
			status = settle_decoded(edits, i, error);
	if (!status)
		status = settle_bounds(edits, error);
	if (!status)
		status = nt_packed_finish(edits, error);
	if (!status)
		drop_unused_buffer(edits);
	bool changes = document->decoded_count > 0;
	for (uint32_t i = 0; !status && i < edits->buffer_count; i++) {
		nt_edited_buffer *buffer = &edits->buffers[i];
		buffer->length = lay_out(edits, i, buffer->old_length, &buffer->changed);
		changes |= buffer->changed;
		/* a buffer must not be empty */
		if (buffer->old_length && !buffer->length && !buffer->addition_count)
			status = nt_edits_add_bytes(edits, i, NT_NONE, false, zeros, sizeof zeros, error);
	}
	if (status)
		return status;
	edits->laid_out = true;

	/* Old data moves; new data comes behind it. */
	if (changes) {
		move_views(edits);
		move_accessors(edits);
	}
	for (size_t i = 0; i < edits->buffer_count; i++) {
		nt_edited_buffer *buffer = &edits->buffers[i];
		lay_out_additions(edits, buffer);
		if (nt_is_edited(buffer))
			nt_gltf_set_number(json, nt_json_at(nt_gltf_root_member(document, "buffers"), i), "byteLength",
				buffer->length);
	}
	settle_free_views(edits);
	drop_unneeded_compression(document);
	return nt_json_failed(json) ? nt_fail_memory(error) : NT_OK;
}
