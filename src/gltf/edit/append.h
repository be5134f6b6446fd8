/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended, and the indices that use them: see append.c and indices.c.
 */
#ifndef NT_GLTF_EDIT_APPEND_H
#define NT_GLTF_EDIT_APPEND_H

#include "gltf/edit/append_targets.h"

/* Gives every accessor of the pool its copied elements, and overridden accessors their new values; `overrides` is
 * sorted for that. buffer: of new views. decoded_too: what was decompressed by Draco goes into plain views. */
nt_status nt_append_vertices(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	nt_override_list *overrides, bool decoded_too, nt_error *error);

/* Writes the indices of a pool's solved users where they changed. buffer: of new views. */
nt_status nt_gltf_write_indices(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	nt_error *error);

#endif
