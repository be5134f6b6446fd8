/* SPDX-License-Identifier: MIT */
/*
 * Base64 (RFC 4648) into a sink, piece by piece: for data URIs that are larger than one would like to
 * hold in memory.
 */
#ifndef NT_IO_BASE64_WRITE_H
#define NT_IO_BASE64_WRITE_H

#include "io/file.h"

/* Zeroed but for the sink. */
typedef struct nt_base64 {
	nt_sink *sink;
	unsigned char rest[3]; /* bytes that do not fill a group yet */
	unsigned rest_count;
} nt_base64;

nmtan_status nt_base64_write(nt_base64 *base64, const void *bytes, size_t size, nt_error *error);

/* Writes the last group with its padding. */
nmtan_status nt_base64_end(nt_base64 *base64, nt_error *error);

#endif
