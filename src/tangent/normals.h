/* SPDX-License-Identifier: MIT */
/*
 * Making normals where a source has none.
 */
#ifndef NT_TANGENT_NORMALS_H
#define NT_TANGENT_NORMALS_H

#include "base/scratch.h"
#include "nmtan.h"

/*
 * Computes a normal for every corner.
 *
 *   mesh       positions, faces and indices; normals and texcoords are not read. Strides must be filled in
 *   smoothing  [face_count] smoothing group of each face, 0: flat; NULL: all faces are in one group
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
	nt_scratch *scratch, float (*normals)[4]);

#endif
