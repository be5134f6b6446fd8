/* SPDX-License-Identifier: MIT */
/*
 * bufferViews of a document.
 */
#ifndef NT_GLTF_VIEW_H
#define NT_GLTF_VIEW_H

#include "ext/meshopt.h"
#include "gltf/document.h"

/* How meshoptimizer packed a view. */
typedef struct nt_gltf_packing {
	const char *extension; /* NULL: it is plain */
	uint32_t buffer;       /* that has the packed bytes */
	uint32_t place;        /* the buffer that the view itself names, which may have no bytes */
	uint64_t offset;
	nt_meshopt_view view;
} nt_gltf_packing;

/* For nt_gltf_read_arrays(): a view as its JSON has it, checked against its buffer's byteLength. */
nt_status nt_gltf_read_view(nt_gltf *document, uint32_t index, nt_gltf_view *view, nt_error *error);

/* A view of the source; one that was decompressed lies in a virtual buffer. */
nt_status nt_gltf_get_view(nt_gltf *document, uint64_t index, const char *from, nt_gltf_view *view,
	nt_error *error);

/* The extension object of a compressed view; NULL: none. *name (may be NULL) receives the extension. */
nt_json_value *nt_gltf_compression_of(const nt_json_value *view, const char **name);

/* Decompresses a view of EXT_meshopt_compression or KHR_meshopt_compression: from then on it lies in a
 * virtual buffer. */
nt_status nt_gltf_decompress_view(nt_gltf *document, uint32_t view, nt_error *error);

/* How a view is packed, whether or not it has been decompressed. */
nt_status nt_gltf_get_packing(const nt_gltf *document, uint32_t view, nt_gltf_packing *packing, nt_error *error);

/* The bytes of a view that was decompressed, as they are before its filter; free() gives them back. */
nt_status nt_gltf_unfiltered_view(nt_gltf *document, uint32_t view, unsigned char **bytes, nt_error *error);

/* Bytes of a view, `length` of them from `offset` on; a compressed view is decompressed first. `what` is the
 * JSON pointer of who wants them. */
nt_status nt_gltf_view_bytes(nt_gltf *document, uint32_t view, uint64_t offset, uint64_t length,
	const char *what, const unsigned char **bytes, nt_error *error);

#endif
