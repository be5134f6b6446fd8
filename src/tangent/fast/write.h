/* SPDX-License-Identifier: MIT */
/*
 * Steps 6 and 8 of the fast path: see write.c.
 */
#ifndef NT_TANGENT_FAST_WRITE_H
#define NT_TANGENT_FAST_WRITE_H

#include "tangent/fast/parts.h"

/* Every corner gets the result of its vertex; with fast->sparse those of suspects only. Marks triangles COMPLEX
 * and COPY. */
void nt_fast_write(nt_fast *fast, const nt_settled *settled);

/* Writes what a sparse solve left out. */
void nt_fast_write_rest(nt_fast *fast);

/* Writes the default to a corner that no group reached (step 10 of the spec page). */
void nt_fast_write_unassigned(const nt_fast *fast, size_t corner);

/* Writes the default to every corner, for a mesh without a sound triangle. */
void nt_fast_write_defaults(const nt_fast *fast);

/* Corners of triangles that are COPY take the values of others, which must have been written. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_fast_write_copies(nt_fast *fast);

#endif
