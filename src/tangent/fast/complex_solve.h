/* SPDX-License-Identifier: MIT */
/*
 * Averages of groups at complex vertices: see complex_solve.c.
 */
#ifndef NT_TANGENT_FAST_COMPLEX_SOLVE_H
#define NT_TANGENT_FAST_COMPLEX_SOLVE_H

#include "tangent/fast/complex_groups.h"

/* Corners that are solved at a time, but for a vertex that has more. */
enum { NT_BATCH = 512 };

/* The corners of some vertices that have to be solved. They and their groups have been moved together: both are where
 * those of the first vertex were. */
typedef struct nt_batch {
	uint32_t first, count; /* places */
	uint32_t group_count;  /* groups are numbered from 0 in the order in which they begin */
	nt_corner *results;    /* [capacity] where the halves of quads have to meet; NULL: there are no quads */
} nt_batch;

/* Makes an empty batch, with results for `capacity` corners; false: there is no memory. */
bool nt_batch_make(const nt_complex *c, size_t capacity, nt_batch *batch);

/* Sees to it that complex vertex v, whose groups have been found, gets its corners written. Step 6 has done so where a
 * group is the only one of its orientation and the vertex's record is its result, but not at triangles without a frame;
 * not with quads or further outputs. The other corners go to the batch, which is solved before it becomes larger than
 * NT_BATCH. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_take_vertex(const nt_complex *c, nt_batch *batch, size_t v);

/* Solves all groups of a batch and writes its corners; then it is empty. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_solve_batch(const nt_complex *c, nt_batch *batch);

#endif
