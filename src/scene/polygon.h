/* SPDX-License-Identifier: MIT */
/*
 * Polygons of five and more corners become triangles by ear clipping in the polygon's own plane.
 */
#ifndef NT_SCENE_POLYGON_H
#define NT_SCENE_POLYGON_H

#include "base/text.h"

/*
 * Triangulates one polygon.
 *
 *   points     positions
 *   vertices   [count] which of them its corners are, in order; NULL: the first ones
 *   count      at least 3
 *   triangles  [3 * (count - 2)] receives corner numbers of the polygon, each triangle wound as it is
 *   sound      receives false when no proper triangulation was found (self-intersecting, collinear,
 *              not finite): it is then finished somehow, still with count - 2 triangles
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_polygon_triangulate(const float (*points)[3], const uint32_t *vertices, size_t count, uint32_t *triangles,
	bool *sound);

#endif
