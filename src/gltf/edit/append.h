/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended: see append.c.
 */
#ifndef NT_GLTF_EDIT_APPEND_H
#define NT_GLTF_EDIT_APPEND_H

#include "gltf/edit/append_items.h"

/* Gives every accessor of the component its copied rows, and overridden accessors their new values;
 * `overrides` is sorted for that. decoded_too: what was decompressed by Draco goes into plain views. */
nt_status nt_gltf_grow_attributes(nt_gltf_patcher *patcher, const nt_gltf_cluster *component,
	nt_gltf_override *overrides, size_t override_count, bool decoded_too);

#endif
