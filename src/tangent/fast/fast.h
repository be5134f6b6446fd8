/* SPDX-License-Identifier: MIT */
/*
 * MikkTSpace, fast: the bytes of mikktspace.c at the speed of memory. See fast.c.
 */
#ifndef NT_TANGENT_FAST_FAST_H
#define NT_TANGENT_FAST_FAST_H

#include "tangent/solve.h"

/* Choices that depend on a mesh's size and order; tests choose it themselves, so that small meshes go every way. */
typedef struct nt_fast_plan {
	size_t grain;      /* least triangles for a thread */
	size_t least_two;  /* triangles from which on two threads share a mesh that is too small for the grain;
	                      0: none */
	unsigned bin_bits; /* log2 of the vertices of a bin, from 4 on; 0: bins where the mesh is scattered */
	size_t least_borrowed_bytes; /* smaller outputs do not serve as scratch */
	bool small;              /* few triangles: small.c */
	size_t most_places;      /* for corners and padding, see adjacency.h; 0: NT_ADJACENCY_PLACES */
	size_t most_narrow;      /* vertices of a mesh whose corners are not counted first, see there */
} nt_fast_plan;

/* Whether this file can: it knows the default angular threshold alone, since others split most groups, and less
 * than 2^28 corners and vertices. nt_mikktspace_scalar() does the rest. */
bool nt_fast_can(const nt_solve *solve);

/* The bytes of nt_mikktspace_scalar(), where nt_fast_can(). Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_mikktspace_fast(const nt_solve *solve);

/* The same by another plan. */
nmtan_status nt_mikktspace_fast_as(const nt_solve *solve, const nt_fast_plan *plan);

#endif
