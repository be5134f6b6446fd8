/* SPDX-License-Identifier: MIT */
/*
 * Version 1 of the vertex codec: see meshopt_vertex.c.
 */
#ifndef NT_EXT_MODULES_MESHOPT_VERTEX_H
#define NT_EXT_MODULES_MESHOPT_VERTEX_H

#include <stdbool.h>
#include <stddef.h>

/* The first byte of a stream. */
enum { NT_MESHOPT_VERTEX_1 = 0xA1 };

/*
 * Decodes a stream of version 1, any bytes.
 *
 *   stride  a multiple of 4, 256 at most
 *   bytes   [count * stride]
 *
 * Returns whether the stream is what the specification describes; bytes are garbage if it is not.
 */
bool nt_meshopt_decode_vertex_1(unsigned char *bytes, size_t count, size_t stride, const unsigned char *packed,
	size_t size);

/* The colour filter, in place. stride: 4 or 8. */
void nt_meshopt_decode_colors(unsigned char *bytes, size_t count, size_t stride);

#endif
