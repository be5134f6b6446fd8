/* SPDX-License-Identifier: MIT */
/*
 * bufferViews of a document.
 */
#ifndef NT_GLTF_VIEW_H
#define NT_GLTF_VIEW_H

#include "gltf/document.h"

/* A bufferView, checked against its buffer's byteLength. */
nt_status nt_gltf_get_view(nt_gltf *document, uint64_t index, const char *from, nt_gltf_view *view,
	nt_error *error);

/* The JSON of a view has changed. */
void nt_gltf_view_changed(nt_gltf *document, uint64_t index);

/* The extension object of a compressed view; NULL: none. *name (may be NULL) receives the extension. */
nt_json_value *nt_gltf_compression_of(const nt_json_value *view, const char **name);

/* Decompresses a view of EXT_meshopt_compression or KHR_meshopt_compression: from then on it lies in a
 * virtual buffer. */
nt_status nt_gltf_decompress_view(nt_gltf *document, uint32_t view, nt_error *error);

/* Bytes of a view, `length` of them from `offset` on; a compressed view is decompressed first. `what` is the
 * JSON pointer of who wants them. */
nt_status nt_gltf_view_bytes(nt_gltf *document, uint32_t view, uint64_t offset, uint64_t length,
	const char *what, const unsigned char **bytes, nt_error *error);

#endif
