/* SPDX-License-Identifier: MIT */
/*
 * Making normals where a source has none.
 */
#ifndef NT_TANGENT_NORMALS_H
#define NT_TANGENT_NORMALS_H

#include "base/dvec.h"
#include "base/scratch.h"
#include "nmtan.h"

/*
 * Computes a normal for every corner.
 *
 *   mesh       positions, faces and indices; normals and texcoords are not read. Strides must be filled in
 *   smoothing  [face_count] smoothing group of each face, 0: flat; NULL: all faces are in one group
 *   groups     [corner_count] group of each corner, in place of its face's; NULL: smoothing says it
 *   normals    [corner_count][4] receives unit vectors and a 0, rows that nmtan_split() takes; (0, 0, 1, 0) where a
 *              corner's faces have no area. Instead of the 0 a 1 where the sum cancels
 *
 * A corner's normal is the sum of the face normals of its group at its position, weighted by corner angle
 * (G. Thuermer and C. Wuethrich, "Computing Vertex Normals from Polygonal Facets", 1998), or its own
 * face's in group 0 and where the sum cancels: where it is no longer than 1e-10 times the weights (NT_CANCELLED).
 *
 * Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_corner_normals(const nmtan_mesh *mesh, size_t corner_count, const uint32_t *smoothing,
	const uint32_t *groups, nt_scratch *scratch, float (*normals)[4]);

/*
 * Groups for nt_corner_normals(): corners at one position share a normal if edges lead from one face to the other at
 * each of which two faces meet at less than `degrees`, 0 (all is flat) to 180. groups [corner_count] receives numbers
 * from 1 on. Returns NMTAN_OK or NMTAN_ERROR_MEMORY.
 */
nmtan_status nt_crease_groups(const nmtan_mesh *mesh, size_t corner_count, double degrees, nt_scratch *scratch,
	uint32_t *groups);

/* Unit normal of the face of `size` corners that begins with corner `first`; false: it has no area. */
bool nt_face_normal(const nmtan_mesh *mesh, size_t first, size_t size, nt_dvec3 *normal);

#endif
