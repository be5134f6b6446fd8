/* SPDX-License-Identifier: MIT */
/*
 * A mesh as an HTML page has it: whole, in a few bytes a triangle. page/data.js, in report/render, reads it.
 *
 * Vertices are numbered in the order in which triangles use them. The bytes are streams one after the other, deflated
 * together, behind the length of each in bytes (NT_STREAM_COUNT times uint32, little endian; 0: it is not there):
 *
 *   indices     of each corner a varint: how far its vertex is below the number of the next new one; 0: it is that one
 *   positions   x, y, z: position_origin + code * position_step, 16 bits
 *   normals     as directions, see below
 *   texcoords   u, v, v pointing down: texcoord_origin + code * texcoord_step, 24 bits
 *   authored    tangents of the file: directions, then a byte each: 1 for w > 0, 2 for w < 0, 0: there is none
 *   computed    tangents that nmtan computes, the same
 *   kinds       of each triangle a byte: orientation + 1, and 4 where a position is not finite
 *   islands     of each triangle a varint: its island + 1, 0: none, as a zigzag difference from the triangle before
 *   outlines    see outline.h
 *   seams       of each seam, then of each net of hard edges, a varint: how many edges, then of each edge the vertices
 *               at its ends, unmirrored side first, as zigzag differences from the number before
 *   numbers     where triangles are left out, of each a varint: its number, as difference from the one before
 *
 * Varints have seven bits a byte, the lowest first. A code of 16 or 24 bits is the zigzag difference from the vertex
 * before, modulo 2^16 or 2^24; each component has two or three planes of bytes, the lowest first. A direction is two
 * components of 16 bits: the octahedron |x| + |y| + |z| = 1, its lower half folded out, as 2047 + round(2047 x).
 */
#ifndef NT_REPORT_PACK_PACK_H
#define NT_REPORT_PACK_PACK_H

#include "report/report.h"

enum { NT_STREAM_COUNT = 11 };

typedef struct nt_packed {
	size_t vertex_count, triangle_count;
	bool whole;                  /* nothing was left out */
	double position_origin[3], position_step[3];
	double texcoord_origin[2], texcoord_step;
	size_t raw_bytes;            /* before they were deflated */
	nt_buffer bytes;             /* deflated */
} nt_packed;

/* Packs a mesh whose geometry was kept: the whole of it, or `most` triangles around the findings. packed->bytes is to
 * be freed, after failure too. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_pack_mesh(nt_packed *packed, const nt_report *report, uint32_t mesh, size_t most);

#endif
