/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended, in sparse accessors: see append_sparse.c.
 */
#ifndef NT_GLTF_EDIT_APPEND_SPARSE_H
#define NT_GLTF_EDIT_APPEND_SPARSE_H

#include "gltf/edit/append_targets.h"

/* Appends the elements that are copies of replaced ones to what a sparse accessor replaces. */
nt_status nt_append_sparse(nt_appending *appending, const nt_append_target *target);

#endif
