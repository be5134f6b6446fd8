/* SPDX-License-Identifier: MIT */
/*
 * Which memory the fast path works in: see memory.c.
 */
#ifndef NT_TANGENT_FAST_MEMORY_H
#define NT_TANGENT_FAST_MEMORY_H

#include "tangent/fast/parts.h"

/* For steps 1 to 5. */
typedef struct nt_fast_memory {
	nt_borrowed borrowed;    /* where it is used up, and where it is empty, the scratch follows */
	nt_borrowed none;        /* empty from the beginning */
	nt_borrowed *rows;       /* for rows and cursors: one of these */
	nt_record *bin_sums; /* [3 * triangle_count] for the sums of bins; NULL: take borrowed */
} nt_fast_memory;

/* `binned`: corners go by way of bins. Outputs below `least_bytes` are not borrowed. */
void nt_fast_plan_memory(const nt_fast *fast, bool binned, size_t least_bytes, nt_fast_memory *memory);

/* A binned mesh has gone through step 4: makes the records for those orientations, which are not written. False when
 * out of memory. */
bool nt_fast_place_records(nt_fast *fast, const bool orientations[2]);

/* For step 7: what steps 1 to 5 have left outside of the output. */
nt_borrowed nt_fast_left_memory(const nt_fast *fast);

#endif
