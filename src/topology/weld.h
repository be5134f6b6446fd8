/* SPDX-License-Identifier: MIT */
/*
 * The weld of the fast path: which corners are one vertex (spec page, step 2), and each vertex's eight
 * floats as one row of 32 bytes, so that a later pass finds all of a corner in one place.
 *
 * Corners have equal numbers where those of nt_weld_corners() are equal. The numbers have gaps, and where no vertex is
 * equal to another the mesh's own indices are used as they are.
 */
#ifndef NT_TOPOLOGY_WELD_H
#define NT_TOPOLOGY_WELD_H

#include "base/borrowed.h"
#include "topology/weld_row.h"

typedef struct nt_weld {
	const uint32_t *ids;     /* [corner_count] welded vertex of each corner; may be mesh->indices */
	const nt_weld_row *rows; /* [count], of numbers that no corner has too */
	size_t count;
} nt_weld;

/* Corners and vertices that nt_weld can number. */
#define NT_WELD_LIMIT ((size_t)1 << 28)

/*
 * Welds the corners of a mesh whose strides are filled in and whose indices are checked. Linear time.
 *
 *   row_memory, memory
 *            for the rows, and for everything else, which is given back but for ids; may be the same
 *   ranges   threads to use, at least 1. Which corners have equal numbers does not depend on them.
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_weld_mesh(const nmtan_mesh *mesh, size_t corner_count, unsigned ranges, nt_borrowed *row_memory,
	nt_borrowed *memory, nt_weld *weld);

#endif
