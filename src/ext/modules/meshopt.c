/* SPDX-License-Identifier: MIT */
/*
 * meshoptimizer's codecs: see ext/meshopt.h.
 */
#include <meshoptimizer.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include "ext/modules/meshopt_vertex.h"
#include "ext/tables.h"

/* Two bits of a block of version 1 say that 256 bytes are like those before them. */
enum { MAX_RATIO = 1024, SLACK_BYTES = 65536 };

/* Checks what the extension's text demands of strides and counts, so that the decoders' assertions hold. */
static nt_status check(const nt_meshopt_view *v, uint64_t size, const char *pointer, nt_error *error)
{
	const bool attributes = strcmp(v->mode, "ATTRIBUTES") == 0;
	const bool triangles = strcmp(v->mode, "TRIANGLES") == 0;
	const unsigned long long count = v->count, stride = v->stride;
	if (!attributes && !triangles && strcmp(v->mode, "INDICES") != 0)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
			"mode \"%.*s\", expected ATTRIBUTES, TRIANGLES or INDICES", NT_CUT(30, v->mode));
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

static nt_status filter(const nt_meshopt_view *v, unsigned char *bytes, const char *pointer, nt_error *error)
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
			"filter \"%.*s\" with byteStride %zu, which nmtan does not decode", NT_CUT(30, v->filter),
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
	return attributes ? filter(v, bytes, pointer, error) : NT_OK;
}

/* ---- packing ---- */

/* The extensions know version 1 of the index codecs alone. It is a variable of the library. */
static void choose_version(void)
{
	meshopt_encodeIndexVersion(1);
}

static uint32_t index_at(const unsigned char *bytes, size_t i, size_t stride)
{
	uint16_t narrow;
	uint32_t wide;
	memcpy(&narrow, bytes + i * stride, sizeof narrow);
	if (stride == sizeof narrow)
		return narrow;
	memcpy(&wide, bytes + i * stride, sizeof wide);
	return wide;
}

/* packed: room for `bound` bytes; 0: what that is. */
static size_t encode(const nt_meshopt_view *v, const unsigned char *bytes, const uint32_t *indices,
	unsigned char *packed, size_t bound)
{
	const size_t count = (size_t)v->count, stride = (size_t)v->stride;
	if (strcmp(v->mode, "ATTRIBUTES") == 0)
		return packed ? meshopt_encodeVertexBuffer(packed, bound, bytes, count, stride)
			      : meshopt_encodeVertexBufferBound(count, stride);
	if (strcmp(v->mode, "TRIANGLES") == 0)
		return packed ? meshopt_encodeIndexBuffer(packed, bound, indices, count)
			      : meshopt_encodeIndexBufferBound(count, (size_t)UINT32_MAX + 1);
	return packed ? meshopt_encodeIndexSequence(packed, bound, indices, count)
		      : meshopt_encodeIndexSequenceBound(count, (size_t)UINT32_MAX + 1);
}

/* Whether a list has the triangles of another, each with any of its corners first: the library turns them so that they
 * begin with an edge that was there lately. */
static bool same_triangles(const unsigned char *a, const unsigned char *b, size_t count, size_t stride)
{
	bool same = true;
	for (size_t i = 0; i < count && same; i += 3) {
		same = false;
		for (size_t turn = 0; turn < 3; turn++)
			same |= index_at(a, i, stride) == index_at(b, i + turn, stride) &&
				index_at(a, i + 1, stride) == index_at(b, i + (turn + 1) % 3, stride) &&
				index_at(a, i + 2, stride) == index_at(b, i + (turn + 2) % 3, stride);
	}
	return same;
}

/* A decoder gives back what was packed. */
static nt_status verify(const nt_meshopt_view *v, const unsigned char *bytes, const unsigned char *packed, size_t size,
	nt_error *error)
{
	nt_meshopt_view plain = *v;
	plain.filter = "NONE";
	plain.packed_size = size;
	unsigned char *back = malloc((size_t)(v->count * v->stride));
	if (!back)
		return nt_fail_memory(error);
	const bool same = size && unpack(&plain, packed, back, "", NULL) == NT_OK &&
		(strcmp(v->mode, "TRIANGLES") == 0
			? same_triangles(bytes, back, (size_t)v->count, (size_t)v->stride)
			: memcmp(back, bytes, (size_t)(v->count * v->stride)) == 0);
	free(back);
	return same ? NT_OK : nt_fail(error, NT_ERROR_INTERNAL, "a view that was packed does not hold what it should");
}

static nt_status pack(const nt_meshopt_view *v, const unsigned char *bytes, unsigned char **packed, size_t *size,
	nt_error *error)
{
	static pthread_once_t chosen = PTHREAD_ONCE_INIT;
	pthread_once(&chosen, choose_version);
	const size_t count = strcmp(v->mode, "ATTRIBUTES") == 0 ? 0 : (size_t)v->count;
	const size_t bound = encode(v, NULL, NULL, NULL, 0);
	uint32_t *indices = malloc((count + 1) * sizeof *indices);
	*packed = malloc(bound);
	nt_status status = indices && *packed ? NT_OK : nt_fail_memory(error);
	for (size_t i = 0; !status && i < count; i++)
		indices[i] = index_at(bytes, i, (size_t)v->stride);
	if (!status) {
		*size = encode(v, bytes, indices, *packed, bound);
		status = verify(v, bytes, *packed, *size, error);
	}
	free(indices);
	if (status) {
		free(*packed);
		*packed = NULL;
	}
	return status;
}

static const char version[] = {'0' + MESHOPTIMIZER_VERSION / 1000, '.', '0' + MESHOPTIMIZER_VERSION / 100 % 10,
	'0' + MESHOPTIMIZER_VERSION / 10 % 10, 0};

const nt_meshopt_table nt_meshopt_module = {NT_MODULE_HEAD(nt_meshopt_table, "meshoptimizer", version, "MIT",
	NULL), check, unpack, filter, pack};
