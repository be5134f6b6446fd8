/* SPDX-License-Identifier: MIT */
/*
 * Lists of triangles, encoded as they are: see meshopt_triangles.c.
 */
#ifndef NT_EXT_MODULES_MESHOPT_TRIANGLES_H
#define NT_EXT_MODULES_MESHOPT_TRIANGLES_H

#include <stddef.h>
#include <stdint.h>

/* Most bytes of a stream. */
size_t nt_meshopt_triangles_bound(size_t triangle_count);

/*
 * Encodes a list of triangles for mode TRIANGLES. Returns the size of the stream.
 *
 *   indices  [3 * triangle_count]
 *   packed  [nt_meshopt_triangles_bound(triangle_count)]
 */
size_t nt_meshopt_encode_triangles(const uint32_t *indices, size_t triangle_count, unsigned char *packed);

#endif
