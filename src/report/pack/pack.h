/* SPDX-License-Identifier: MIT */
/*
 * A mesh as an HTML page has it: whole, in a few bytes a triangle. page/data.js, in report/render, reads it.
 *
 * It is arrays of whole numbers, one after the other in this order, deflated together; of those that are empty nothing
 * is there. Vertices are numbered in the order in which triangles use them:
 *
 *   numbers                       if triangles are left out: the file's number of each
 *   corners                       of each corner how far its vertex is below the number of the next new one; 0: it is
 *                                 that one
 *   x y z                         of each vertex: position_origin + code * position_step, 16 bits
 *   nx ny                         its normal as a direction, see below
 *   u v                           its texture coordinates, v pointing down: texcoord_origin + code * texcoord_step, 18
 *                                 bits
 *   ax ay aw                      its tangent in the file: a direction, then 1 for w > 0, 2 for w < 0, 0: there is none
 *   cx cy cw                      the one that nmtan computes, the same
 *   kinds                         of each triangle orientation + 1, and 4 if a position is not finite
 *   islands                       its island + 1, 0: none
 *   seam_edges                    of each seam, then of each net of hard edges: how many edges
 *   seam_ends                     of each edge the vertices at its ends, unmirrored side first
 *
 * An array is stored as differences from the number before, as zigzag, in planes: the lowest byte of each, then the
 * second one, as many as its greatest number has, modulo what these hold. A direction is two components of 12 bits: the
 * octahedron |x| + |y| + |z| = 1, its lower half folded out, as 2047 + round(2047 x).
 */
#ifndef NT_REPORT_PACK_PACK_H
#define NT_REPORT_PACK_PACK_H

#include "report/report.h"

enum { NT_PACKED_ARRAYS = 19 };

/* Texture coordinates beyond this are no place in a texture; they would leave the others without precision. */
#define NT_MOST_TEXCOORD 1e6f

typedef struct nt_packed_array {
	const char *name; /* static */
	size_t count;
	unsigned planes;   /* 0: it is empty */
} nt_packed_array;

typedef struct nt_packed {
	size_t vertex_count, triangle_count, seam_count;
	bool whole;                  /* nothing was left out */
	double position_origin[3], position_step[3];
	double texcoord_origin[2], texcoord_step;
	nt_packed_array arrays[NT_PACKED_ARRAYS]; /* in the order of their bytes */
	unsigned array_count;
	nt_buffer bytes;             /* deflated */
} nt_packed;

/* Packs a mesh whose geometry was kept: the whole of it, or `most` triangles around the findings. packed->bytes is to
 * be freed, after failure too. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_pack_mesh(nt_packed *packed, const nt_report *report, uint32_t mesh, size_t most);

/* ---- small pictures of a mesh and of its layout, for a list of many ---- */

/* Pixels. */
enum { NT_THUMB_WIDTH = 112, NT_THUMB_HEIGHT = 80 };

/* Appends, deflated, a byte for each pixel, rows from the top, 0 where nothing is: of a mesh, from where the page first
 * looks at it, 1 (dark) to 255. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_thumb_model(const nt_report_geometry *geometry, nt_buffer *out);

/* The same of its triangles in the texture, 1 for unmirrored ones and 2 for mirrored ones, which lie on those. v_down:
 * of the texture coordinates. Nothing if there are none. */
nt_status nt_thumb_layout(const nt_report_geometry *geometry, bool v_down, nt_buffer *out);

#endif
