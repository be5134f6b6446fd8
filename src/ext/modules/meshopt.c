/* SPDX-License-Identifier: MIT */
/*
 * meshoptimizer's decoders: see ext/meshopt.h.
 */
#include <meshoptimizer.h>
#include <string.h>
#include "ext/modules/meshopt_vertex.h"
#include "ext/tables.h"

/* Two bits of a block of version 1 say that 256 bytes are like those before them. */
enum { MAX_RATIO = 1024, SLACK_BYTES = 65536 };

/* What the extension's text demands of strides and counts, so that the decoders' assertions hold. */
static nt_status check(const nt_meshopt_view *v, uint64_t size, const char *pointer, nt_error *error)
{
	const bool attributes = strcmp(v->mode, "ATTRIBUTES") == 0;
	const bool triangles = strcmp(v->mode, "TRIANGLES") == 0;
	const unsigned long long count = v->count, stride = v->stride;
	if (!attributes && !triangles && strcmp(v->mode, "INDICES") != 0)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"mode \"%.30s\", expected ATTRIBUTES, TRIANGLES or INDICES", v->mode);
	if (attributes ? stride == 0 || stride % 4 || stride > 256 : stride != 2 && stride != 4)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer, "byteStride %llu in mode %s", stride,
			v->mode);
	if (triangles && count % 3)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer, "count %llu is no multiple of 3", count);
	if (count > UINT32_MAX || count * stride != size)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"%llu elements of %llu bytes, but the view has %llu bytes", count, stride,
			(unsigned long long)size);
	if (size > SLACK_BYTES && (size - SLACK_BYTES - 1) / MAX_RATIO >= v->packed_size)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"%llu bytes cannot hold %llu elements", (unsigned long long)v->packed_size, count);
	return NT_OK;
}

static nt_status apply_filter(const nt_meshopt_view *v, unsigned char *bytes, const char *pointer,
	nt_error *error)
{
	const size_t count = (size_t)v->count, stride = (size_t)v->stride;
	if (strcmp(v->filter, "NONE") == 0)
		return NT_OK;
	if (strcmp(v->filter, "OCTAHEDRAL") == 0 && (stride == 4 || stride == 8)) {
		meshopt_decodeFilterOct(bytes, count, stride);
	} else if (strcmp(v->filter, "QUATERNION") == 0 && stride == 8) {
		meshopt_decodeFilterQuat(bytes, count, stride);
	} else if (strcmp(v->filter, "EXPONENTIAL") == 0) {
		meshopt_decodeFilterExp(bytes, count, stride);
	} else if (strcmp(v->filter, "COLOR") == 0 && (stride == 4 || stride == 8)) {
		nt_meshopt_decode_colors(bytes, count, stride);
	} else {
		return nt_fail_pointer(error, NT_ERROR_UNSUPPORTED, pointer,
			"filter \"%.30s\" with byteStride %zu, which nmtan does not decode", v->filter,
			stride);
	}
	return NT_OK;
}

static nt_status unpack(const nt_meshopt_view *v, const unsigned char *packed, unsigned char *bytes,
	const char *pointer, nt_error *error)
{
	const size_t count = (size_t)v->count, stride = (size_t)v->stride, size = (size_t)v->packed_size;
	const bool attributes = strcmp(v->mode, "ATTRIBUTES") == 0;
	int result;
	if (attributes && size && packed[0] == NT_MESHOPT_VERTEX_1) {
		result = nt_meshopt_decode_vertex_1(bytes, count, stride, packed, size) ? 0 : -1;
	} else if (attributes) {
		result = meshopt_decodeVertexBuffer(bytes, count, stride, packed, size);
	} else if (strcmp(v->mode, "TRIANGLES") == 0) {
		result = meshopt_decodeIndexBuffer(bytes, count, stride, packed, size);
	} else {
		result = meshopt_decodeIndexSequence(bytes, count, stride, packed, size);
	}
	if (result != 0)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"meshoptimizer cannot decode the view's %zu bytes", size);
	return attributes ? apply_filter(v, bytes, pointer, error) : NT_OK;
}

static const char version[] = {'0' + MESHOPTIMIZER_VERSION / 1000, '.', '0' + MESHOPTIMIZER_VERSION / 100 % 10,
	'0' + MESHOPTIMIZER_VERSION / 10 % 10, 0};

const nt_meshopt_table nt_meshopt_module = {NT_MODULE_HEAD(nt_meshopt_table, "meshoptimizer", version, "MIT",
	NULL), check, unpack};
