/* SPDX-License-Identifier: MIT */
/*
 * Triangles of the sums that go by the definition in frames.c, one by one.
 */
#ifndef NT_TANGENT_SUMS_HARD_H
#define NT_TANGENT_SUMS_HARD_H

#include "tangent/sums/parts.h"

/* Does triangle t by the definition: its lane of the block, and its sign. */
void nt_sums_do_hard(const nt_sums *s, size_t t, int lane, nt_sum_block *block);

/* Flags of the face of triangle t, two triangles for a quad, by the exact sign of what is stored. */
void nt_sums_orient(const nt_sums *s, size_t t);

#endif
