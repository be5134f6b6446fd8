/* SPDX-License-Identifier: MIT */
/*
 * Groups that are their sums: see complex_sums.c.
 */
#ifndef NT_TANGENT_FAST_COMPLEX_SUMS_H
#define NT_TANGENT_FAST_COMPLEX_SUMS_H

#include "tangent/fast/complex_groups.h"

/* Corners that are added up at a time. */
enum { NT_SUMMED = 128 };

/* The corners of some groups, each group's in order. */
typedef struct nt_summed {
	uint32_t count, group_count;
	uint32_t corners[NT_SUMMED + 1]; /* as in nt_complex */
	uint8_t group[NT_SUMMED + 1];
} nt_summed;

/* The three rows of each corner's triangle, from the mesh. */
void nt_load_rows(const nt_complex *c, const uint32_t *corners, size_t count, nt_weld_row *rows);

/* Adds the corners of complex vertex v to `s`, but for those of groups of an orientation that is done, and for those
 * without a group. Before, it writes what is there already, if both would be too many. The vertex has NT_RESULT_SUM and
 * NT_FAN_DEPTH corners at most. */
void nt_take_sums(const nt_complex *c, nt_summed *s, size_t v, const bool done[2]);

/* Writes the corners; then there are none. */
void nt_write_sums(const nt_complex *c, nt_summed *s);

#endif
