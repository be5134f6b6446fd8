/* SPDX-License-Identifier: MIT */
/*
 * The split of a sparse solve: see vertex_split.c.
 */
#ifndef NT_API_VERTEX_SPLIT_H
#define NT_API_VERTEX_SPLIT_H

#include "tangent/solve.h"
#include "topology/split.h"

/* Takes the tangents of all corners of triangles from solve->known, which has ids, and from solve->tangents where
 * a triangle is suspect. Returns NMTAN_OK, NMTAN_ERROR_MEMORY or NMTAN_ERROR_TOO_LARGE. */
nmtan_status nt_split_shared(const nt_solve *solve, nt_splitter *splitter);

#endif
