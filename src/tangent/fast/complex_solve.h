/* SPDX-License-Identifier: MIT */
/*
 * Averages of groups at complex vertices: see complex_solve.c.
 */
#ifndef NT_TANGENT_FAST_COMPLEX_SOLVE_H
#define NT_TANGENT_FAST_COMPLEX_SOLVE_H

#include "tangent/fast/complex_groups.h"

/* Writes the corners [begin, end) of a batch, which are those of one vertex, where a group is the only one of its orientation
 * and the vertex's record is its result. Not with quads or further outputs. */
void nt_write_sums(const nt_complex *c, nt_batch *batch, uint32_t begin, uint32_t end);

/* Solves all groups of a batch and writes its corners but those that are written. `results` is NULL, or [count] where the halves of
 * quads have to meet. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_solve_batch(const nt_complex *c, const nt_batch *batch, nt_corner *results);

#endif
