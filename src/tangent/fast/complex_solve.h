/* SPDX-License-Identifier: MIT */
/*
 * Averages of groups at complex vertices: see complex_solve.c.
 */
#ifndef NT_TANGENT_FAST_COMPLEX_SOLVE_H
#define NT_TANGENT_FAST_COMPLEX_SOLVE_H

#include "tangent/fast/complex_groups.h"

/* Solves all groups of a batch and writes its corners. `results` is NULL, or [count] where the halves of
 * quads have to meet. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_solve_batch(const nt_complex *c, const nt_batch *batch, nt_corner *results);

#endif
