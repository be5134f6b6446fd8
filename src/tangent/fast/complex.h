/* SPDX-License-Identifier: MIT */
/*
 * Step 7 of the fast path: see complex.c.
 */
#ifndef NT_TANGENT_FAST_COMPLEX_H
#define NT_TANGENT_FAST_COMPLEX_H

#include "tangent/fast/parts.h"

/* Solves the vertices whose records are complex and writes their corners. `memory` is what the passes
 * before have left. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_fast_complex(nt_fast *fast, const nt_kernels *kernels, const nt_settled *settled, nt_borrowed *memory);

#endif
