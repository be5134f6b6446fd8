/* SPDX-License-Identifier: MIT */
/*
 * Tangents across normals: what repair gives corners that have nothing around them. Many at a time, with the bytes that
 * one at a time has.
 */
#ifndef NT_TANGENT_ACROSS_H
#define NT_TANGENT_ACROSS_H

#include "base/dvec.h"
#include "nmtan.h"

enum { NT_ACROSS_LANES = 16 };

/* A corner without a tangent, and the first and the last one of the same face with one. */
typedef struct nt_beside {
	uint32_t corner, from, last;
} nt_beside;

/* Unit vectors perpendicular to the normals of up to NT_ACROSS_LANES vertices: those listed or, without a list, those
 * from the first on. The last number of each is 1. */
void nt_perpendiculars(const nmtan_mesh *mesh, size_t first, const uint32_t *vertices, size_t count,
	float across[NT_ACROSS_LANES][4]);

/* The unit tangents across the normals of up to NT_ACROSS_LANES corners that the rows of `from`, of [corner_count][4],
 * have. The last number of each is that row's, 0 where it has no part across the normal. */
void nt_borrow_tangents(const nmtan_mesh *mesh, const float *tangents, const nt_beside *corners, size_t count,
	float across[NT_ACROSS_LANES][4]);

#endif
