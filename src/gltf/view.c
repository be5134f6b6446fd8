/* SPDX-License-Identifier: MIT */
/*
 * bufferViews, plain ones and those of EXT_meshopt_compression and KHR_meshopt_compression, whose bytes
 * meshoptimizer packed. A view is decompressed when somebody reads it.
 */
#include "gltf/document.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include "ext/meshopt.h"

nt_json_value *nt_gltf_compression_of(const nt_json_value *view, const char **name)
{
	static const char *const names[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
	const nt_json_value *extensions = nt_json_find(view, "extensions");
	for (size_t i = 0; i < 2; i++) {
		nt_json_value *found = nt_json_find(extensions, names[i]);
		if (found && name)
			*name = names[i];
		if (found)
			return found;
	}
	return NULL;
}

/* A view as its JSON has it, checked against its buffer's byteLength. A faulty one has the buffer NT_NONE. */
static nt_status read_view(nt_gltf *document, size_t index, nt_gltf_view *view, nt_error *error)
{
	const nt_json_value *json = nt_gltf_view_json(document, index);
	char pointer[NT_GLTF_POINTER];
	nt_gltf_pointer(pointer, "bufferViews", index);
	const uint64_t limit = (uint64_t)1 << 53;
	uint64_t buffer_index = 0, stride = 0;
	view->buffer = NT_NONE;
	nt_status status = nt_gltf_check_object(json, pointer, error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "buffer", UINT32_MAX - 1, NT_GLTF_REQUIRED, &buffer_index,
			error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteOffset", limit, 0, &view->offset, error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteLength", limit, NT_GLTF_REQUIRED,
			&view->length, error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteStride", 65535, 0, &stride, error);
	nt_gltf_buffer *buffer = NULL;
	if (!status)
		status = nt_gltf_describe_buffer(document, buffer_index, pointer, &buffer, error);
	if (status)
		return status;
	if (view->offset > buffer->length || view->length > buffer->length - view->offset)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"bytes %llu to %llu, but buffer %llu has %llu", (unsigned long long)view->offset,
			(unsigned long long)(view->offset + view->length),
			(unsigned long long)buffer_index, (unsigned long long)buffer->length);
	view->buffer = (uint32_t)buffer_index;
	view->stride = (uint16_t)stride;
	view->compressed = nt_gltf_compression_of(json, NULL) != NULL;
	return NT_OK;
}

void nt_gltf_read_views(nt_gltf *document)
{
	nt_gltf_buffer *buffer;
	for (size_t i = 0; i < document->buffer_count; i++)
		nt_gltf_describe_buffer(document, i, "", &buffer, NULL);
	for (size_t i = 0; i < document->view_count; i++)
		read_view(document, i, &document->views[i], NULL);
}

nt_status nt_gltf_get_view(nt_gltf *document, uint64_t index, const char *from, const nt_gltf_view **view,
	nt_error *error)
{
	nt_gltf_view faulty = {.buffer = NT_NONE};
	const nt_status status = nt_gltf_check_index("bufferViews", index, document->view_count, from, error);
	*view = nt_gltf_sound_view(document, index);
	/* a faulty one is read again, to tell what is wrong */
	return status || *view ? status : read_view(document, (size_t)index, &faulty, error);
}

/* ---- decompression ---- */

enum { MAX_STRIDE = 256 };

static nt_status read_packing(const nt_json_value *view, const char *pointer, nt_gltf_packing *p,
	nt_error *error)
{
	const nt_json_value *json = nt_gltf_compression_of(view, &p->extension);
	const uint64_t limit = (uint64_t)1 << 53;
	uint64_t buffer = 0, place = 0;
	nt_status status = nt_gltf_uint(json, pointer, "buffer", UINT32_MAX - 1, NT_GLTF_REQUIRED,
		&buffer, error);
	nt_json_find_uint64(view, "buffer", &place);
	p->buffer = (uint32_t)buffer;
	p->place = (uint32_t)place;
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteOffset", limit, 0, &p->offset, error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteLength", limit, NT_GLTF_REQUIRED, &p->view.packed_size,
			error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteStride", MAX_STRIDE, NT_GLTF_REQUIRED,
			&p->view.stride, error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "count", UINT32_MAX, NT_GLTF_REQUIRED, &p->view.count,
			error);
	const char *mode = nt_json_find_string(json, "mode", NULL);
	const char *filter = nt_json_find_string(json, "filter", NULL);
	p->view.mode = mode ? mode : "";
	p->view.filter = filter ? filter : "NONE";
	return status;
}

nt_status nt_gltf_get_packing(const nt_gltf *document, uint32_t index, nt_gltf_packing *p, nt_error *error)
{
	char pointer[NT_GLTF_POINTER];
	const nt_json_value *json;
	*p = (nt_gltf_packing){.extension = NULL};
	nt_status status = nt_gltf_element(document, "bufferViews", index, "", &json, error);
	if (status || !nt_gltf_compression_of(json, &p->extension))
		return status;
	snprintf(pointer, sizeof pointer, "/bufferViews/%u/extensions/%s", index, p->extension);
	return read_packing(json, pointer, p, error);
}

/* The bytes of a compressed view, `length` of them, which free() gives back. */
static nt_status unpack_view(nt_gltf *document, uint32_t index, uint64_t length, const nt_meshopt_view *view,
	const nt_gltf_packing *p, unsigned char **bytes, nt_error *error)
{
	char pointer[NT_GLTF_POINTER];
	nt_gltf_buffer *buffer;
	snprintf(pointer, sizeof pointer, "/bufferViews/%u/extensions/%s", index, p->extension);
	nt_status status = nt_meshopt_check(view, length, pointer, error);
	if (!status)
		status = nt_gltf_open_buffer(document, p->buffer, pointer, &buffer, error);
	if (status)
		return status;
	if (p->offset > buffer->size || view->packed_size > buffer->size - p->offset)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"bytes %llu to %llu, but buffer %u has %zu", (unsigned long long)p->offset,
			(unsigned long long)(p->offset + view->packed_size), p->buffer, buffer->size);
	*bytes = nt_alloc((size_t)length, 1);
	if (!*bytes)
		return nt_fail_memory(error);
	nt_gltf_note_read(document, buffer, p->offset, view->packed_size);
	status = nt_meshopt_unpack(view, buffer->bytes + p->offset, *bytes, pointer, error);
	if (status)
		free(*bytes);
	return status;
}

nt_status nt_gltf_decompress_view(nt_gltf *document, uint32_t index, nt_error *error)
{
	char pointer[NT_GLTF_POINTER];
	nt_gltf_pointer(pointer, "bufferViews", index);
	const nt_gltf_view *found;
	nt_gltf_packing p;
	unsigned char *bytes;
	nt_status status = nt_gltf_get_view(document, index, pointer, &found, error);
	if (status || !found->compressed)
		return status;
	nt_gltf_view *view = &document->views[index];
	status = nt_gltf_get_packing(document, index, &p, error);
	if (!status)
		status = unpack_view(document, index, view->length, &p.view, &p, &bytes, error);
	if (status)
		return status;
	*view = (nt_gltf_view){.length = view->length, .decoded = bytes, .buffer = NT_GLTF_OF_VIEW(index),
		.stride = view->stride};
	document->decoded_count++;
	return NT_OK;
}

nt_status nt_gltf_unfiltered_view(nt_gltf *document, uint32_t index, unsigned char **bytes, nt_error *error)
{
	nt_gltf_packing p;
	const nt_status status = nt_gltf_get_packing(document, index, &p, error);
	nt_meshopt_view plain = p.view;
	plain.filter = "NONE";
	return status ? status : unpack_view(document, index, plain.count * plain.stride, &plain, &p, bytes, error);
}

/* ---- bytes ---- */

nt_status nt_gltf_view_bytes(nt_gltf *document, uint32_t index, uint64_t offset, uint64_t length,
	const char *what, const unsigned char **bytes, nt_error *error)
{
	const nt_gltf_view *view;
	nt_status status = nt_gltf_get_view(document, index, what, &view, error);
	if (!status && view->compressed)
		status = nt_gltf_decompress_view(document, index, error);
	if (status)
		return status;
	assert(offset <= view->length && length <= view->length - offset);
	if (view->decoded) {
		*bytes = view->decoded + offset;
		return NT_OK;
	}
	char pointer[NT_GLTF_POINTER];
	nt_gltf_buffer *buffer;
	nt_gltf_pointer(pointer, "bufferViews", index);
	status = nt_gltf_open_buffer(document, view->buffer, pointer, &buffer, error);
	if (status)
		return status;
	if (view->offset + offset > buffer->size || length > buffer->size - (view->offset + offset)) {
		snprintf(pointer, sizeof pointer, "/buffers/%u", view->buffer);
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"byteLength is %llu, but only %zu bytes are there",
			(unsigned long long)buffer->length, buffer->size);
	}
	*bytes = buffer->bytes + view->offset + offset;
	nt_gltf_note_read(document, buffer, view->offset + offset, length);
	return NT_OK;
}
