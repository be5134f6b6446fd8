/* SPDX-License-Identifier: MIT */
/*
 * The GLB container, read and written. Quirks of real files that are taken: chunk lengths that are no multiple of
 * 4, padding counted in or left out at the end of the file, JSON padded with NULs, data behind the
 * declared end, extra chunks. A second JSON or BIN chunk is kept as an extra chunk, since only the
 * first one has a meaning. When writing, sizes are known before the first byte, so that everything streams; each
 * chunk's declared length includes its padding, as the specification asks.
 */
#include "gltf/document.h"

#include <string.h>

enum { HEADER_BYTES = 12, CHUNK_HEAD_BYTES = 8 };
static const uint32_t type_json = 0x4E4F534A, type_bin = 0x004E4942;

/* ---- reading ---- */

static uint32_t read_u32(const unsigned char *bytes)
{
	return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
		(uint32_t)bytes[3] << 24;
}

bool nt_glb_has_magic(const unsigned char *bytes, size_t size)
{
	return size >= 4 && memcmp(bytes, "glTF", 4) == 0;
}

/* The header; *end receives where the container ends. */
static nt_status read_header(const unsigned char *bytes, size_t size, size_t *end, nt_error *error)
{
	if (size < HEADER_BYTES)
		return nt_fail_offset(error, NT_ERROR_INPUT, size,
			"the file ends within the 12-byte GLB header");
	if (!nt_glb_has_magic(bytes, size))
		return nt_fail_offset(error, NT_ERROR_INPUT, 0, "not a GLB: no \"glTF\" at its beginning");
	const uint32_t version = read_u32(bytes + 4), length = read_u32(bytes + 8);
	if (version != 2)
		return nt_fail_offset(error, NT_ERROR_UNSUPPORTED, 4,
			"GLB version %u, expected 2%s", version, version == 1 ? NT_GLTF_OLD_ADVICE : "");
	if (length < HEADER_BYTES + CHUNK_HEAD_BYTES)
		return nt_fail_offset(error, NT_ERROR_INPUT, 8,
			"the GLB header declares %u bytes, too few for a JSON chunk", length);
	if (length > size)
		return nt_fail_offset(error, NT_ERROR_INPUT, 8,
			"the GLB header declares %u bytes, the file has %zu", length, size);
	*end = length;
	return NT_OK;
}

static nt_status read_chunk(const unsigned char *bytes, size_t at, size_t end, nt_glb_chunk *chunk,
	nt_error *error)
{
	if (end - at < CHUNK_HEAD_BYTES)
		return nt_fail_offset(error, NT_ERROR_INPUT, at,
			"%zu bytes left, a GLB chunk begins with 8", end - at);
	const uint32_t length = read_u32(bytes + at);
	*chunk = (nt_glb_chunk){read_u32(bytes + at + 4), at + CHUNK_HEAD_BYTES, length};
	if (length > end - chunk->offset)
		return nt_fail_offset(error, NT_ERROR_INPUT, at,
			"a GLB chunk declares %u bytes, %zu are left", length, end - chunk->offset);
	return NT_OK;
}

static bool keep_other(nt_glb *glb, nt_arena *arena, size_t *capacity, const nt_glb_chunk *chunk)
{
	if (glb->other_count == *capacity) {
		const size_t wanted = *capacity ? *capacity * 2 : 4;
		nt_glb_chunk *grown = nt_arena_alloc(arena, wanted, sizeof *grown);
		if (!grown)
			return false;
		if (glb->other_count)
			memcpy(grown, glb->others, glb->other_count * sizeof *grown);
		glb->others = grown;
		*capacity = wanted;
	}
	glb->others[glb->other_count++] = *chunk;
	return true;
}

/* Padding at the end of the container that is no chunk: fewer bytes than a chunk's head, all zero. */
static bool only_padding(const unsigned char *bytes, size_t at, size_t end)
{
	if (end - at >= 4)
		return false;
	while (at < end)
		if (bytes[at++] != 0)
			return false;
	return true;
}

nt_status nt_glb_parse(nt_glb *glb, nt_arena *arena, const unsigned char *bytes, size_t size,
	nt_error *error)
{
	*glb = (nt_glb){0};
	size_t end = 0;
	nt_status status = read_header(bytes, size, &end, error);
	if (status)
		return status;

	/* The JSON comes first. */
	status = read_chunk(bytes, HEADER_BYTES, end, &glb->json, error);
	if (status)
		return status;
	if (glb->json.type != type_json)
		return nt_fail_offset(error, NT_ERROR_INPUT, HEADER_BYTES + 4,
			"the first GLB chunk has type 0x%08x, expected JSON (0x4e4f534a)", glb->json.type);
	size_t at = glb->json.offset + glb->json.size;
	while (glb->json.size > 0 && bytes[glb->json.offset + glb->json.size - 1] == 0)
		glb->json.size--;
	if (glb->json.size == 0)
		return nt_fail_offset(error, NT_ERROR_INPUT, HEADER_BYTES,
			"the JSON chunk of the GLB is empty");

	/* BIN must be second to count; whatever else there is stays as it is. */
	size_t capacity = 0;
	for (bool second = true; at < end && !only_padding(bytes, at, end); second = false) {
		nt_glb_chunk chunk;
		status = read_chunk(bytes, at, end, &chunk, error);
		if (status)
			return status;
		if (second && chunk.type == type_bin) {
			glb->bin = chunk;
			glb->has_bin = true;
		} else if (!keep_other(glb, arena, &capacity, &chunk)) {
			return nt_fail_memory(error);
		}
		at = chunk.offset + chunk.size;
	}
	return NT_OK;
}

/* ---- writing ---- */

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
	nt_sink_expect(sink, total);
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
