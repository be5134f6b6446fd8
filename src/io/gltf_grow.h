/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended: see gltf_grow.c.
 */
#ifndef NT_IO_GLTF_GROW_H
#define NT_IO_GLTF_GROW_H

#include "io/gltf_append_items.h"

/* Gives every accessor of the component its copied rows, and overridden accessors their new values;
 * `overrides` is sorted for that. decoded_too: what was decompressed by Draco goes into plain views. */
nt_status nt_gltf_grow_attributes(nt_gltf_patcher *patcher, const nt_gltf_cluster *component,
	nt_gltf_override *overrides, size_t override_count, bool decoded_too);

#endif
