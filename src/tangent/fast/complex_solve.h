/* SPDX-License-Identifier: MIT */
/*
 * Averages of groups at complex vertices: see complex_solve.c.
 */
#ifndef NT_TANGENT_FAST_COMPLEX_SOLVE_H
#define NT_TANGENT_FAST_COMPLEX_SOLVE_H

#include "tangent/fast/complex_groups.h"

/* Writes the corners of complex vertex v, which the batch has, where a group is the only one of its orientation and the
 * vertex's record is its result. Not with quads or further outputs. */
void nt_write_sums(const nt_complex *c, nt_batch *batch, size_t v);

/* Solves all groups of a batch and writes its corners but those that are written. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_solve_batch(const nt_complex *c, const nt_batch *batch);

#endif
