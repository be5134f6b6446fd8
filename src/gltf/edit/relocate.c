/* SPDX-License-Identifier: MIT */
/*
 * Relocation: where bytes of a source buffer lie after its edits, and writing them. A position moves by the sum of what
 * edits that end at or before it have added. Views and accessors are intervals of the buffer, so both ends are mapped
 * and the rest follows. Nothing is reordered.
 */
#include "gltf/edit/relocate.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "gltf/edit/extensions.h"
#include "gltf/view.h"

/* Of a vacant view that nothing new came for. */
enum { VACANT_BYTES = 4 };

/* ---- moving offsets ---- */

static int compare_edits(const void *a, const void *b)
{
	const nt_gltf_edit *x = a, *y = b;
	if (x->at != y->at)
		return x->at < y->at ? -1 : 1;
	return (x->removed > y->removed) - (x->removed < y->removed);
}

/* Where a position of a source buffer goes. */
static uint64_t map_position(const nt_gltf_buffer_layout *buffer, uint64_t position)
{
	size_t low = 0, high = buffer->edit_count;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (buffer->edits[middle].at + buffer->edits[middle].removed <= position)
			low = middle + 1;
		else
			high = middle;
	}
	return low ? position + (uint64_t)buffer->edits[low - 1].shift : position;
}

static void sort_edits(nt_gltf_buffer_layout *buffer)
{
	if (buffer->edit_count)
		qsort(buffer->edits, buffer->edit_count, sizeof *buffer->edits, compare_edits);
	int64_t shift = 0;
	for (size_t i = 0; i < buffer->edit_count; i++) {
		nt_gltf_edit *edit = &buffer->edits[i];
		shift += (int64_t)edit->size - (int64_t)edit->removed;
		edit->shift = shift;
	}
}

static void place_additions(nt_gltf_layout *layout, nt_gltf_buffer_layout *buffer)
{
	nt_json *json = layout->document->json;
	nt_json_value *views = nt_gltf_root_member(layout->document, "bufferViews");
	uint64_t length = map_position(buffer, buffer->old_length);
	for (size_t i = 0; i < buffer->addition_count; i++) {
		nt_gltf_addition *addition = &buffer->additions[i];
		addition->offset = (length + 3) / 4 * 4;
		length = addition->offset + addition->size;
		if (addition->view != NT_NONE)
			nt_json_set_uint64(json, nt_json_put(json, nt_json_at(views, addition->view),
				"byteOffset"), addition->offset);
	}
	buffer->new_length = length;
}

/* Sets an offset; a zero that is not written stays so. */
static void set_offset(nt_json *json, nt_json_value *object, const char *key, uint64_t value)
{
	uint64_t old = 0;
	nt_json_get_uint64(nt_json_find(object, key), &old);
	if (old != value)
		nt_json_set_uint64(json, nt_json_put(json, object, key), value);
}

/* A buffer must not be empty. */
static nt_status fill_empty_buffers(nt_gltf_layout *layout, nt_error *error)
{
	static const unsigned char zeros[VACANT_BYTES];
	nt_status status = NT_OK;
	for (uint32_t i = 0; !status && i < layout->buffer_count; i++) {
		const nt_gltf_buffer_layout *buffer = &layout->buffers[i];
		if (buffer->touched && !buffer->addition_count && buffer->old_length &&
			map_position(buffer, buffer->old_length) == 0)
			status = nt_layout_add_bytes(layout, i, NT_NONE, zeros, sizeof zeros, error);
	}
	return status;
}

/* Vacant views that nothing came for share the first bytes of their buffer. */
static void settle_vacancies(nt_gltf_layout *layout)
{
	nt_json *json = layout->document->json;
	const nt_json_value *views = nt_gltf_root_member(layout->document, "bufferViews");
	for (size_t i = 0; i < layout->vacancy_count; i++) {
		nt_json_value *object = nt_json_at(views, layout->vacancies[i]);
		uint64_t buffer = 0;
		nt_json_get_uint64(nt_json_find(object, "buffer"), &buffer);
		const uint64_t length = layout->buffers[buffer].new_length;
		nt_json_remove(json, object, "byteStride");
		set_offset(json, object, "byteOffset", 0);
		set_offset(json, object, "byteLength", length < VACANT_BYTES ? length : VACANT_BYTES);
	}
}

/* How a view moves, kept while the offsets of accessors in it are moved. */
typedef struct moved_view {
	const nt_gltf_buffer_layout *buffer; /* NULL: does not move */
	uint64_t old_offset, new_offset;
} moved_view;

static void move_views(nt_gltf_layout *layout, moved_view *moved, size_t view_count)
{
	nt_json *json = layout->document->json;
	nt_json_value *views = nt_gltf_root_member(layout->document, "bufferViews");
	for (size_t i = 0; i < view_count; i++) {
		nt_json_value *object = nt_json_at(views, i);
		nt_gltf_view view;
		nt_json_value *part = nt_gltf_compression_of(object, NULL);
		uint64_t buffer, offset = 0;
		if (part && nt_json_get_uint64(nt_json_find(part, "buffer"), &buffer) &&
			buffer < layout->document->buffer_count) {
			nt_json_get_uint64(nt_json_find(part, "byteOffset"), &offset);
			set_offset(json, part, "byteOffset",
				map_position(&layout->buffers[buffer], offset));
		}
		if (moved[i].buffer || layout->vacant[i] ||
			nt_gltf_get_view(layout->document, i, "", &view, NULL) != NT_OK ||
			view.buffer >= NT_GLTF_VIRTUAL || layout->buffers[view.buffer].edit_count == 0)
			continue;
		moved[i].buffer = &layout->buffers[view.buffer];
		moved[i].old_offset = view.offset;
		moved[i].new_offset = map_position(moved[i].buffer, view.offset);
		set_offset(json, object, "byteOffset", moved[i].new_offset);
		set_offset(json, object, "byteLength",
			map_position(moved[i].buffer, view.offset + view.length) - moved[i].new_offset);
	}
}

/* Moves "byteOffset" of something that lies in the view its "bufferView" names. */
static void move_in_view(nt_json *json, nt_json_value *object, const moved_view *moved,
	size_t view_count)
{
	uint64_t view, offset = 0;
	if (!nt_json_get_uint64(nt_json_find(object, "bufferView"), &view) || view >= view_count ||
		!moved[view].buffer)
		return;
	nt_json_get_uint64(nt_json_find(object, "byteOffset"), &offset);
	set_offset(json, object, "byteOffset",
		map_position(moved[view].buffer, moved[view].old_offset + offset) -
			moved[view].new_offset);
}

static void move_accessors(nt_gltf_layout *layout, const moved_view *moved, size_t view_count)
{
	nt_json *json = layout->document->json;
	nt_json_value *accessors = nt_gltf_root_member(layout->document, "accessors");
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

/* Where the bytes of a buffer go: a sink as they are or as base64, or memory. */
typedef struct target {
	nt_sink *sink;
	nt_base64 *base64;
	nt_buffer *memory;
	const nt_file *input; /* the document's own file */
} target;

static nt_status put_bytes(const target *to, const void *bytes, size_t size, nt_error *error)
{
	if (to->sink)
		return nt_sink_write(to->sink, bytes, size, error);
	if (to->base64)
		return nt_base64_write(to->base64, bytes, size, error);
	nt_buffer_append(to->memory, bytes, size);
	return to->memory->failed ? nt_fail_memory(error) : NT_OK;
}

static nt_status put_zeros(const target *to, uint64_t size, nt_error *error)
{
	static const unsigned char zeros[4096];
	nt_status status = NT_OK;
	while (size && !status) {
		const size_t part = size < sizeof zeros ? (size_t)size : sizeof zeros;
		status = put_bytes(to, zeros, part, error);
		size -= part;
	}
	return status;
}

/* A range of a source buffer: from file to file where that is possible. */
static nt_status put_source(const nt_gltf_layout *layout, nt_gltf_buffer *buffer,
	const target *to, uint64_t begin, uint64_t end, nt_error *error)
{
	if (begin >= end)
		return NT_OK;
	const uint64_t there = buffer->size < begin ? begin : buffer->size < end ? buffer->size : end;
	const size_t size = (size_t)(there - begin);
	nt_status status = NT_OK;
	if (size && to->sink && buffer->home == NT_GLTF_HOME_FILE)
		status = nt_sink_copy(to->sink, &buffer->file, (size_t)begin, size, error);
	else if (size && to->sink && buffer->home == NT_GLTF_HOME_BIN && to->input)
		status = nt_sink_copy(to->sink, to->input,
			layout->document->glb.bin.offset + (size_t)begin, size, error);
	else if (size)
		status = put_bytes(to, buffer->bytes + begin, size, error);
	if (!to->sink)
		nt_gltf_note_read(layout->document, buffer, begin, size);
	return status ? status : put_zeros(to, end - there, error);
}

static nt_status put_buffer(nt_gltf_layout *layout, uint32_t index, const target *to, nt_error *error)
{
	const nt_gltf_buffer_layout *plan = nt_layout_plan_of(layout, index);
	nt_gltf_buffer *source = NULL;
	nt_status status = NT_OK;
	uint64_t at = 0, written = map_position(plan, plan->old_length);
	if (plan->old_length && index < NT_GLTF_VIRTUAL &&
		layout->document->buffers[index].home == NT_GLTF_HOME_NOWHERE)
		return put_zeros(to, plan->old_length, error);
	if (plan->old_length)
		status = nt_gltf_open_buffer(layout->document, index, "/buffers", &source, error);
	/* A length that lies must not become that many zeros; padding may lack. */
	if (!status && source && plan->old_length - source->size >= NT_LAYOUT_ALIGNMENT) {
		char pointer[NT_GLTF_POINTER];
		snprintf(pointer, sizeof pointer, "/buffers/%u", index);
		status = nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"byteLength is %llu, but only %zu bytes are there",
			(unsigned long long)plan->old_length, source->size);
	}
	for (size_t i = 0; !status && i < plan->edit_count; i++) {
		const nt_gltf_edit *edit = &plan->edits[i];
		status = put_source(layout, source, to, at, edit->at, error);
		if (!status)
			status = put_bytes(to, edit->bytes, edit->size, error);
		at = edit->at + edit->removed;
	}
	if (!status && source)
		status = put_source(layout, source, to, at, plan->old_length, error);
	for (size_t i = 0; !status && i < plan->addition_count; i++) {
		const nt_gltf_addition *addition = &plan->additions[i];
		status = put_zeros(to, addition->offset - written, error);
		if (!status)
			status = put_bytes(to, addition->bytes, addition->size, error);
		written = addition->offset + addition->size;
	}
	return status;
}

/* ---- views that were decompressed ---- */

/* Takes the compressed bytes of a view out, if nobody else refers to them. */
static nt_status remove_compressed(nt_gltf_layout *layout, const nt_json_value *part, nt_error *error)
{
	uint64_t buffer, offset = 0, length;
	if (!nt_json_get_uint64(nt_json_find(part, "buffer"), &buffer) ||
		!nt_json_get_uint64(nt_json_find(part, "byteLength"), &length) ||
		buffer >= layout->document->buffer_count)
		return NT_OK;
	nt_json_get_uint64(nt_json_find(part, "byteOffset"), &offset);
	const size_t users = nt_byte_users_count(&layout->users, (uint32_t)buffer, offset, offset + length);
	return users == 1 ? nt_layout_edit(layout, (uint32_t)buffer, offset, length,
				    (const unsigned char *)"", 0, error) :
			    NT_OK;
}

/* A decompressed view whose bytes have changed is written plain. */
static nt_status settle_virtual(nt_gltf_layout *layout, uint32_t index, moved_view *moved,
	nt_error *error)
{
	nt_gltf *document = layout->document;
	nt_gltf_buffer_layout *plan = nt_layout_plan_of(layout, document->virtual_of[index]);
	sort_edits(plan);
	nt_buffer bytes = {0};
	nt_status status =
		put_buffer(layout, document->virtual_of[index], &(target){.memory = &bytes}, error);
	const size_t size = bytes.size;
	if (status || !nt_arena_adopt(&layout->arena, bytes.data)) {
		if (status)
			nt_buffer_free(&bytes);
		return status ? status : nt_fail_memory(error);
	}
	nt_json_value *view = nt_json_at(nt_gltf_root_member(document, "bufferViews"), index);
	const char *name = "";
	nt_json_value *part = nt_gltf_compression_of(view, &name);
	uint64_t near = NT_NONE;
	nt_json_get_uint64(nt_json_find(part, "buffer"), &near);
	uint32_t buffer = NT_NONE;
	status = remove_compressed(layout, part, error);
	if (!status)
		status = nt_layout_choose_buffer(layout, (uint32_t)near, &buffer, error);
	if (!status)
		status = nt_layout_add_bytes(layout, buffer, index, bytes.data, size, error);
	if (status)
		return status;
	nt_json *json = document->json;
	nt_json_set_uint64(json, nt_json_put(json, view, "buffer"), buffer);
	nt_json_set_uint64(json, nt_json_put(json, view, "byteLength"), size);
	nt_json_value *extensions = nt_json_find(view, "extensions");
	nt_json_remove(json, extensions, name);
	if (nt_json_count(extensions) == 0)
		nt_json_remove(json, view, "extensions");
	*moved = (moved_view){plan, 0, 0};
	return NT_OK;
}

/* An extension that no view needs any more is not required; its mark on a fallback buffer stays. */
static void drop_unneeded_compression(nt_gltf *document)
{
	static const char *const names[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
	if (document->virtual_count == 0)
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

/* ---- the whole ---- */

nt_status nt_layout_finish(nt_gltf_layout *layout, nt_error *error)
{
	nt_gltf *document = layout->document;
	const size_t view_count = layout->view_count;
	moved_view *moved = nt_calloc(view_count, sizeof *moved);
	if (!moved)
		return nt_fail_memory(error);
	nt_status status = NT_OK;
	bool shifted = false;
	for (uint32_t i = 0; !status && i < view_count; i++)
		if (document->virtual_of[i] != NT_NONE && nt_layout_plan_of(layout, document->virtual_of[i])->touched) {
			status = settle_virtual(layout, i, &moved[i], error);
			shifted = true;
		}
	if (status) {
		free(moved);
		return status;
	}
	for (size_t i = 0; i < layout->buffer_count; i++) {
		sort_edits(&layout->buffers[i]);
		shifted |= layout->buffers[i].edit_count > 0;
	}
	status = fill_empty_buffers(layout, error);
	if (status) {
		free(moved);
		return status;
	}
	if (shifted) {
		move_views(layout, moved, view_count);
		move_accessors(layout, moved, view_count);
	}
	free(moved);
	nt_json *json = document->json;
	for (size_t i = 0; i < layout->buffer_count; i++) {
		nt_gltf_buffer_layout *buffer = &layout->buffers[i];
		if (!buffer->touched)
			continue;
		place_additions(layout, buffer);
		nt_json_value *buffers = nt_gltf_root_member(document, "buffers");
		set_offset(json, nt_json_at(buffers, i), "byteLength", buffer->new_length);
	}
	settle_vacancies(layout);
	drop_unneeded_compression(document);
	return nt_json_failed(json) ? nt_fail_memory(error) : NT_OK;
}

nt_status nt_layout_write(nt_gltf_layout *layout, uint32_t buffer, const nt_file *input,
	nt_sink *sink, nt_error *error)
{
	return put_buffer(layout, buffer, &(target){.sink = sink, .input = input}, error);
}

nt_status nt_layout_encode(nt_gltf_layout *layout, uint32_t buffer, nt_base64 *base64, nt_error *error)
{
	return put_buffer(layout, buffer, &(target){.base64 = base64}, error);
}
