/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended, in sparse accessors: see gltf_sparse.c.
 */
#ifndef NT_IO_GLTF_SPARSE_H
#define NT_IO_GLTF_SPARSE_H

#include "io/gltf_append_items.h"

/* Appends the rows that are copies of replaced ones to what a sparse accessor replaces. */
nt_status nt_gltf_grow_sparse(nt_gltf_growing *growing, const nt_gltf_item *item);

#endif
