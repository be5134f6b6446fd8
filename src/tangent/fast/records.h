/* SPDX-License-Identifier: MIT */
/*
 * Step 4 of the fast path without bins: see records.c.
 */
#ifndef NT_TANGENT_FAST_RECORDS_H
#define NT_TANGENT_FAST_RECORDS_H

#include "tangent/fast/parts.h"

/* Adds all triangles to the records of their vertices. The adjacency is made. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_fast_add(nt_fast *fast, const nt_kernels *kernels);

#endif
