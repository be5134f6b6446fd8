/* SPDX-License-Identifier: MIT */
/*
 * Triangles whose tangents run against their texture coordinates: see reversed.c.
 */
#ifndef NT_TOPOLOGY_REVERSED_H
#define NT_TOPOLOGY_REVERSED_H

#include <stdbool.h>
#include <stddef.h>

/* A triangle with what its corners have. */
typedef struct nt_tangent_triangle {
	const float *positions[3], *normals[3], *texcoords[3];
	const float *tangents[3]; /* of four numbers */
	int orientation;          /* of the texture coordinates, not 0 */
	bool other_w;             /* w is negated */
} nt_tangent_triangle;

/* Whether all three tangents run against growing u and all bitangents against growing v although the normals agree with
 * the winding. Asked of triangles whose w is right. */
bool nt_is_reversed(const nt_tangent_triangle *triangle);

#endif
