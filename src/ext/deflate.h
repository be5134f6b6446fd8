/* SPDX-License-Identifier: MIT */
/*
 * Deflate without a header, by libdeflate: what a browser's DecompressionStream("deflate-raw") reads.
 */
#ifndef NT_EXT_DEFLATE_H
#define NT_EXT_DEFLATE_H

#include "base/text.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Appends `size` bytes, compressed; out->failed tells of exhausted memory. */
void nt_deflate(const void *bytes, size_t size, nt_buffer *out);

#ifdef __cplusplus
}
#endif

#endif
