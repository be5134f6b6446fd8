/* SPDX-License-Identifier: MIT */
/*
 * The one definition of "mirrored" and "degenerate" in UV space, and of how a quad is cut.
 */
#ifndef NT_TOPOLOGY_ORIENTATION_H
#define NT_TOPOLOGY_ORIENTATION_H

#include "nmtan.h"

/* Exact sign of the UV determinant of a triangle: see nmtan_orientation(), which calls this. */
int nt_orientation(const float a[2], const float b[2], const float c[2]);

/* Exact comparison of the determinants' magnitudes: -1, 0, +1 as |det(a,b,c)| is less than, equal to or greater than
 * |det(d,e,f)|; values that are not finite count as 0. */
int nt_compare_area(const float a[2], const float b[2], const float c[2], const float d[2],
	const float e[2], const float f[2]);

/* The triangles of a quad: corner numbers 0..3. Row 0 for the diagonal 0-2, row 1 for 1-3, each with
 * MikkTSpace's order and first corners. */
extern const unsigned char nt_quad_triangles[2][2][3];

/* The diagonal MikkTSpace cuts (spec page, 1): row of nt_quad_triangles. Arrays in corner order. */
int nt_quad_diagonal(const float *const texcoords[4], const float *const positions[4]);

#endif
