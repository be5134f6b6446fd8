/* SPDX-License-Identifier: MIT */
/*
 * Writing the GLB container. Sizes are known before the first byte, so that everything streams; each
 * chunk's declared length includes its padding, as the specification asks.
 */
#include "io/glb.h"

#include <string.h>

enum { HEADER_BYTES = 12, CHUNK_HEAD_BYTES = 8 };
static const uint32_t type_json = 0x4E4F534A, type_bin = 0x004E4942;

static void store_u32(unsigned char *bytes, uint32_t value)
{
	for (int i = 0; i < 4; i++)
		bytes[i] = (unsigned char)(value >> 8 * i);
}

static uint64_t padding(uint64_t size)
{
	return (4 - size % 4) % 4;
}

uint64_t nt_glb_chunk_bytes(uint64_t size)
{
	return CHUNK_HEAD_BYTES + size + padding(size);
}

static nt_status write_chunk_head(nt_sink *sink, uint32_t type, uint64_t size, nt_error *error)
{
	unsigned char head[CHUNK_HEAD_BYTES];
	store_u32(head, (uint32_t)(size + padding(size)));
	store_u32(head + 4, type);
	return nt_sink_write(sink, head, sizeof head, error);
}

static nt_status write_padding(nt_sink *sink, uint64_t size, char with, nt_error *error)
{
	char bytes[4];
	memset(bytes, with, sizeof bytes);
	return nt_sink_write(sink, bytes, (size_t)padding(size), error);
}

nt_status nt_glb_begin(nt_sink *sink, uint64_t json_size, bool has_bin, uint64_t bin_size,
	uint64_t other_bytes, nt_error *error)
{
	/* Each part is below 2^62, so that their sum cannot wrap. */
	const uint64_t limit = (uint64_t)1 << 62;
	uint64_t total = UINT64_MAX;
	if (json_size < limit && bin_size < limit && other_bytes < limit)
		total = HEADER_BYTES + nt_glb_chunk_bytes(json_size) +
			(has_bin ? nt_glb_chunk_bytes(bin_size) : 0) + other_bytes;
	if (total > UINT32_MAX)
		return nt_fail(error, NT_ERROR_UNSUPPORTED,
			"the output would take 4 GiB or more, which GLB cannot hold; write .gltf");

	unsigned char header[HEADER_BYTES];
	memcpy(header, "glTF", 4);
	store_u32(header + 4, 2);
	store_u32(header + 8, (uint32_t)total);
	const nt_status status = nt_sink_write(sink, header, sizeof header, error);
	return status ? status : write_chunk_head(sink, type_json, json_size, error);
}

nt_status nt_glb_end_json(nt_sink *sink, uint64_t json_size, bool has_bin, uint64_t bin_size, nt_error *error)
{
	nt_status status = write_padding(sink, json_size, ' ', error);
	if (!status && has_bin)
		status = write_chunk_head(sink, type_bin, bin_size, error);
	return status;
}

nt_status nt_glb_end_bin(nt_sink *sink, uint64_t bin_size, nt_error *error)
{
	return write_padding(sink, bin_size, 0, error);
}

nt_status nt_glb_write_chunk(nt_sink *sink, uint32_t type, const void *data, size_t size,
	nt_error *error)
{
	nt_status status = write_chunk_head(sink, type, size, error);
	if (!status)
		status = nt_sink_write(sink, data, size, error);
	if (!status)
		status = write_padding(sink, size, 0, error);
	return status;
}
