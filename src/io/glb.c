/* SPDX-License-Identifier: MIT */
/*
 * Reading the GLB container. Quirks of real files that are taken: chunk lengths that are no multiple of
 * 4, padding counted in or left out at the end of the file, JSON padded with NULs, data behind the
 * declared end, extra chunks. A second JSON or BIN chunk is kept as an extra chunk, since only the
 * first one has a meaning.
 */
#include "io/glb.h"

#include <string.h>

enum { HEADER_BYTES = 12, CHUNK_HEAD_BYTES = 8 };
static const uint32_t type_json = 0x4E4F534A, type_bin = 0x004E4942;

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
		return nt_fail_offset(error, NT_ERROR_INPUT, 0, "not a GLB: no \"glTF\" at its begin");
	const uint32_t version = read_u32(bytes + 4), length = read_u32(bytes + 8);
	if (version != 2)
		return nt_fail_offset(error, NT_ERROR_UNSUPPORTED, 4,
			"GLB version %u, expected 2", version);
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
