/* SPDX-License-Identifier: MIT */
/*
 * The GLB container: a 12-byte header, a JSON chunk, at most one BIN chunk, and whatever other chunks
 * extensions put behind them.
 */
#ifndef NT_GLTF_GLB_H
#define NT_GLTF_GLB_H

#include "base/memory.h"
#include "file/output.h"

/* The place of a chunk's data in the file. */
typedef struct nt_glb_chunk {
	uint32_t type;
	size_t offset;
	size_t size;
} nt_glb_chunk;

typedef struct nt_glb {
	nt_glb_chunk json;
	nt_glb_chunk bin; /* size 0 and offset 0: there is none */
	bool has_bin;
	nt_glb_chunk *others; /* chunks of other types, in order; in the arena */
	size_t other_count;
} nt_glb;

bool nt_glb_has_magic(const unsigned char *bytes, size_t size);

/*
 * Finds the chunks of a GLB. Data behind the declared length is ignored, as viewers do; everything else
 * that is wrong is an error with its byte offset.
 *
 * Returns NT_OK, NT_ERROR_INPUT, NT_ERROR_UNSUPPORTED (another version of the container) or
 * NT_ERROR_MEMORY.
 */
nt_status nt_glb_parse(nt_glb *glb, nt_arena *arena, const unsigned char *bytes, size_t size,
	nt_error *error);

/*
 * Begins a file: header and head of the JSON chunk. The caller then writes exactly json_size bytes of text,
 * nt_glb_end_json(), where there is a BIN chunk exactly bin_size bytes and nt_glb_end_bin(), and chunks with
 * nt_glb_write_chunk().
 *
 *   json_size        of the text; padding is added
 *   has_bin          whether there is a BIN chunk
 *   bin_size         size of its data; padding is added
 *   other_bytes      sum of nt_glb_chunk_bytes() over the chunks that follow
 *
 * Returns NT_OK, NT_ERROR_IO, or NT_ERROR_UNSUPPORTED where the file would reach 4 GiB, which
 * the container cannot say.
 */
nt_status nt_glb_begin(nt_sink *sink, uint64_t json_size, bool has_bin, uint64_t bin_size,
	uint64_t other_bytes, nt_error *error);

/* Pads the JSON chunk with spaces and writes the head of the BIN chunk, if there is one. */
nt_status nt_glb_end_json(nt_sink *sink, uint64_t json_size, bool has_bin, uint64_t bin_size,
	nt_error *error);

/* Pads the BIN chunk. */
nt_status nt_glb_end_bin(nt_sink *sink, uint64_t bin_size, nt_error *error);

/* Bytes that a chunk with `size` bytes of data takes in the file. */
uint64_t nt_glb_chunk_bytes(uint64_t size);

/* Writes a whole chunk, padded with zeros. */
nt_status nt_glb_write_chunk(nt_sink *sink, uint32_t type, const void *data, size_t size,
	nt_error *error);

/* The end of a message about version 1, which Cesium's converter still reads. */
#define NT_GLTF_OLD_ADVICE "; the npm package gltf-pipeline converts it"

#endif
