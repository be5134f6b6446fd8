/* SPDX-License-Identifier: MIT */
/*
 * The outlines of UV islands: closed loops around the triangles of one island and one winding. Filled by the rule that
 * counts windings (nonzero), they cover what the triangles cover, at any zoom, and inner edges never show.
 */
#ifndef NT_REPORT_PACK_OUTLINE_H
#define NT_REPORT_PACK_OUTLINE_H

#include "report/report.h"

/* Triangles as they are drawn. */
typedef struct nt_outlined {
	size_t vertex_count, triangle_count;
	const uint32_t *indices;    /* [triangle_count][3] */
	const float *texcoords;     /* [vertex_count][2] */
	const int8_t *orientation;  /* [triangle_count]; 0: not outlined */
	const uint32_t *islands;    /* [triangle_count]; NT_NONE: not outlined. NULL: all one */
} nt_outlined;

/*
 * Appends, as varints: how many regions; of each, 2 * island + 1 where it is mirrored as a zigzag difference from the
 * region before, and how many loops; of each loop how many points, and these as zigzag differences of vertices from
 * the point before (the first one from the last of the loop before). Regions ascend.
 *
 * Time is n log n at worst, in the edges of the outline; linear in the triangles. Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_outline_islands(const nt_outlined *mesh, nt_buffer *out);

#endif
