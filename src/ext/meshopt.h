/* SPDX-License-Identifier: MIT */
/*
 * meshoptimizer's codecs for compressed views of glTF. Decoders are safe on any bytes; what they give is garbage
 * then, which is checked like any other data. Sizes are checked before anything is allocated: no mode packs more
 * than 1024 bytes of data into one.
 *
 * meshoptimizer 0.18 knows version 0 of the vertex codec and no colour filter; version 1 and that filter are
 * nmtan's own (modules/meshopt_vertex.c).
 */
#ifndef NT_EXT_MESHOPT_H
#define NT_EXT_MESHOPT_H

#include "base/text.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A view as KHR_meshopt_compression describes it. */
typedef struct nt_meshopt_view {
	const char *mode;   /* ATTRIBUTES, TRIANGLES or INDICES */
	const char *filter; /* NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL or COLOR */
	uint64_t stride, count;
	uint64_t packed_size; /* bytes that are packed */
} nt_meshopt_view;

/*
 * Whether a view is one that the decoders take: `size` bytes when it is unpacked.
 *
 *   pointer  where the description stands, for the error
 *
 * Returns NT_OK or NT_ERROR_INPUT.
 */
nt_status nt_meshopt_check(const nt_meshopt_view *view, uint64_t size, const char *pointer, nt_error *error);

/*
 * Unpacks a view that was checked.
 *
 *   packed  [packed_size]
 *   bytes   [count * stride], aligned as malloc does
 *
 * Returns NT_OK; NT_ERROR_INPUT for what meshoptimizer cannot decode; NT_ERROR_UNSUPPORTED for codecs
 * and filters that it does not know.
 */
nt_status nt_meshopt_unpack(const nt_meshopt_view *view, const unsigned char *packed, unsigned char *bytes,
	const char *pointer, nt_error *error);

/*
 * The second half of that: applies the filter of a view that was checked to bytes that were unpacked without.
 *
 *   bytes  [count * stride]
 *
 * Returns NT_OK or NT_ERROR_UNSUPPORTED.
 */
nt_status nt_meshopt_filter(const nt_meshopt_view *view, unsigned char *bytes, const char *pointer, nt_error *error);

/*
 * Packs bytes to which the filter is still to be applied, with version 0 of the vertex codec, which all decoders know.
 * The result is decoded again and compared.
 *
 *   view  checked; packed_size is not looked at
 *   bytes  [count * stride]
 *   packed  receives what free() gives back
 *
 * Returns NT_OK, NT_ERROR_MEMORY, or NT_ERROR_INTERNAL where it is not what was packed.
 */
nt_status nt_meshopt_pack(const nt_meshopt_view *view, const unsigned char *bytes, unsigned char **packed,
	size_t *size, nt_error *error);

#ifdef __cplusplus
}
#endif
#endif
