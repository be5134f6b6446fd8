/* SPDX-License-Identifier: MIT */
/*
 * Moving offsets and writing buffers: see relocate.c.
 */
#ifndef NT_GLTF_EDIT_RELOCATE_H
#define NT_GLTF_EDIT_RELOCATE_H

#include "file/base64.h"
#include "gltf/edit/buffer_edits.h"

/* Moves all offsets in the JSON and sets all lengths. Call once, after the last change. */
nt_status nt_layout_finish(nt_gltf_layout *layout, nt_error *error);

/* Writes the bytes of a buffer as they are after the changes. `input` is the document's own file. */
nt_status nt_layout_write(nt_gltf_layout *layout, uint32_t buffer, const nt_file *input,
	nt_sink *sink, nt_error *error);

/* The same as base64, without the last group's padding. */
nt_status nt_layout_encode(nt_gltf_layout *layout, uint32_t buffer, nt_base64 *base64, nt_error *error);

#endif
