/* SPDX-License-Identifier: MIT */
/*
 * Base64 (RFC 4648): into a sink, piece by piece, for data URIs that are larger than one would like to
 * hold in memory, and small ones into memory.
 */
#ifndef NT_FILE_BASE64_H
#define NT_FILE_BASE64_H

#include "base/text.h"
#include "file/output.h"

/* Zeroed but for the sink. */
typedef struct nt_base64 {
	nt_sink *sink;
	unsigned char rest[3]; /* bytes that do not fill a group yet */
	unsigned rest_count;
} nt_base64;

nt_status nt_base64_write(nt_base64 *base64, const void *bytes, size_t size, nt_error *error);

/* Writes the last group with its padding. */
nt_status nt_base64_end(nt_base64 *base64, nt_error *error);

/* How many characters that many bytes become; bytes below 2^62. */
static inline uint64_t nt_base64_length(uint64_t bytes)
{
	return (bytes + 2) / 3 * 4;
}

/* Appends the text of `size` bytes, padded. */
void nt_base64_append(nt_buffer *buffer, const void *bytes, size_t size);

#endif
