/* SPDX-License-Identifier: MIT */
/*
 * EXT_meshopt_compression and KHR_meshopt_compression: views whose bytes meshoptimizer packed. A view is
 * decompressed when somebody reads it. The decoders are safe on any bytes; what they give is garbage
 * then, which is checked like any other data. Sizes are judged before anything is allocated: no mode
 * packs more than 64 bytes of data into one.
 *
 * meshoptimizer 0.18 knows version 0 of the vertex codec and no colour filter.
 */
#include "io/gltf_document.h"

#include <meshoptimizer.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_RATIO = 128, SLACK_BYTES = 65536, MAX_STRIDE = 256 };

typedef struct packed {
	const char *extension;
	uint64_t buffer, offset, length, stride, count;
	const char *mode, *filter;
} packed;

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

static nmtan_status read_packed(const nt_json_value *view, const char *pointer, packed *p,
	nt_error *error)
{
	const nt_json_value *json = nt_gltf_compression_of(view, &p->extension);
	const uint64_t limit = (uint64_t)1 << 53;
	nmtan_status status = nt_gltf_uint(json, pointer, "buffer", UINT32_MAX - 1, NT_GLTF_REQUIRED,
		&p->buffer, error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteOffset", limit, 0, &p->offset, error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteLength", limit, NT_GLTF_REQUIRED, &p->length,
			error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteStride", MAX_STRIDE, NT_GLTF_REQUIRED,
			&p->stride, error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "count", UINT32_MAX, NT_GLTF_REQUIRED, &p->count,
			error);
	p->mode = nt_json_get_string(nt_json_find(json, "mode"), NULL);
	p->filter = nt_json_get_string(nt_json_find(json, "filter"), NULL);
	p->mode = p->mode ? p->mode : "";
	p->filter = p->filter ? p->filter : "NONE";
	return status;
}

/* What the extension's text demands of strides and counts, so that the decoders' assertions hold. */
static nmtan_status check_packed(const packed *p, const nt_gltf_view *view, const char *pointer,
	nt_error *error)
{
	const bool attributes = strcmp(p->mode, "ATTRIBUTES") == 0;
	const bool triangles = strcmp(p->mode, "TRIANGLES") == 0;
	if (!attributes && !triangles && strcmp(p->mode, "INDICES") != 0)
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer,
			"mode \"%.30s\", expected ATTRIBUTES, TRIANGLES or INDICES", p->mode);
	if (attributes ? p->stride == 0 || p->stride % 4 : p->stride != 2 && p->stride != 4)
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer, "byteStride %llu in mode %s",
			(unsigned long long)p->stride, p->mode);
	if (triangles && p->count % 3)
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer,
			"count %llu is no multiple of 3", (unsigned long long)p->count);
	if (p->count * p->stride != view->length)
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer,
			"%llu elements of %llu bytes, but the view has %llu bytes",
			(unsigned long long)p->count, (unsigned long long)p->stride,
			(unsigned long long)view->length);
	if (view->length > p->length * MAX_RATIO + SLACK_BYTES)
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer,
			"%llu bytes cannot hold %llu elements", (unsigned long long)p->length,
			(unsigned long long)p->count);
	return NMTAN_OK;
}

static nmtan_status apply_filter(const packed *p, unsigned char *bytes, const char *pointer,
	nt_error *error)
{
	const size_t count = (size_t)p->count, stride = (size_t)p->stride;
	if (strcmp(p->filter, "NONE") == 0)
		return NMTAN_OK;
	if (strcmp(p->filter, "OCTAHEDRAL") == 0 && (stride == 4 || stride == 8)) {
		meshopt_decodeFilterOct(bytes, count, stride);
	} else if (strcmp(p->filter, "QUATERNION") == 0 && stride == 8) {
		meshopt_decodeFilterQuat(bytes, count, stride);
	} else if (strcmp(p->filter, "EXPONENTIAL") == 0) {
		meshopt_decodeFilterExp(bytes, count, stride);
	} else {
		return nt_fail_pointer(error, NMTAN_ERROR_UNSUPPORTED, pointer,
			"filter \"%.30s\" with byteStride %zu, which nmtan does not decode", p->filter,
			stride);
	}
	return NMTAN_OK;
}

static nmtan_status unpack(const packed *p, const unsigned char *source, unsigned char *bytes,
	const char *pointer, nt_error *error)
{
	const size_t count = (size_t)p->count, stride = (size_t)p->stride, size = (size_t)p->length;
	int result;
	if (strcmp(p->mode, "ATTRIBUTES") == 0) {
		if (size && source[0] == 0xA1)
			return nt_fail_pointer(error, NMTAN_ERROR_UNSUPPORTED, pointer,
				"%s with version 1 of the vertex codec, which nmtan does not decode",
				p->extension);
		result = meshopt_decodeVertexBuffer(bytes, count, stride, source, size);
	} else if (strcmp(p->mode, "TRIANGLES") == 0) {
		result = meshopt_decodeIndexBuffer(bytes, count, stride, source, size);
	} else {
		result = meshopt_decodeIndexSequence(bytes, count, stride, source, size);
	}
	if (result != 0)
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer,
			"meshoptimizer cannot decode the view's %zu bytes", size);
	return strcmp(p->mode, "ATTRIBUTES") == 0 ? apply_filter(p, bytes, pointer, error) : NMTAN_OK;
}

nmtan_status nt_gltf_decompress_view(nt_gltf *document, uint32_t index, nt_error *error)
{
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "/bufferViews/%u", index);
	nt_gltf_view view;
	const nt_json_value *json;
	packed p = {0};
	nt_gltf_buffer *buffer;
	nmtan_status status = nt_gltf_get_view(document, index, pointer, &view, error);
	if (!status)
		status = nt_gltf_element(document, "bufferViews", index, pointer, &json, error);
	if (status || !view.compression)
		return status;
	snprintf(pointer, sizeof pointer, "/bufferViews/%u/extensions/%s", index, view.compression);
	status = read_packed(json, pointer, &p, error);
	if (!status)
		status = check_packed(&p, &view, pointer, error);
	if (!status)
		status = nt_gltf_open_buffer(document, p.buffer, pointer, &buffer, error);
	if (status)
		return status;
	if (p.offset > buffer->size || p.length > buffer->size - p.offset)
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer,
			"bytes %llu to %llu, but buffer %llu has %zu", (unsigned long long)p.offset,
			(unsigned long long)(p.offset + p.length), (unsigned long long)p.buffer,
			buffer->size);

	unsigned char *bytes = nt_alloc((size_t)view.length, 1);
	if (!bytes || !nt_grow((void **)&document->virtuals, &document->virtual_capacity,
			      document->virtual_count + 1, sizeof *document->virtuals)) {
		free(bytes);
		return nt_fail_memory(error);
	}
	nt_gltf_note_read(document, buffer, p.offset, p.length);
	status = unpack(&p, buffer->bytes + p.offset, bytes, pointer, error);
	if (status) {
		free(bytes);
		return status;
	}
	document->virtuals[document->virtual_count] = (nt_gltf_buffer){.home = NT_GLTF_HOME_NOWHERE,
		.length = view.length, .described = true, .opened = true, .bytes = bytes,
		.size = (size_t)view.length, .decoded = bytes};
	document->virtual_of[index] = NT_GLTF_VIRTUAL + (uint32_t)document->virtual_count++;
	return NMTAN_OK;
}
