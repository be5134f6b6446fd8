/* SPDX-License-Identifier: MIT */
/*
 * Which small meshes have a way of their own, and the way: see tiny.c.
 */
#ifndef NT_TANGENT_FAST_TINY_H
#define NT_TANGENT_FAST_TINY_H

#include "tangent/fast/parts.h"

/* Solves a mesh of at most NT_TINY triangles, none of them of a quad, for tangents alone, from the weld to the writing
 * of all corners. It makes triangles, vertex_count and flags. `done` becomes false where it cannot: a value is NaN.
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_fast_tiny(nt_fast *fast, const nt_kernels *kernels, bool *done);

#endif
