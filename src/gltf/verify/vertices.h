/* SPDX-License-Identifier: MIT */
/*
 * Vertices that may come in another order, and values that were rounded: what compressed primitives are compared by.
 */
#ifndef NT_GLTF_VERIFY_VERTICES_H
#define NT_GLTF_VERIFY_VERTICES_H

#include "base/error.h"

typedef struct nt_verify_vertex {
	float position[3], tangent[4];
} nt_verify_vertex;

/* How far a value may be from the one it was made of. */
typedef struct nt_verify_tolerance {
	float position, tangent;
} nt_verify_tolerance;

bool nt_verify_close(const nt_verify_vertex *a, const nt_verify_vertex *b, const nt_verify_tolerance *tolerance);

/*
 * Whether each vertex of one list has one in the other that differs by no more than the tolerance, both ways, however
 * often it is there. *first receives a vertex of `a` that has none, 0 if one of `b` has none, or SIZE_MAX.
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_verify_vertices(const nt_verify_vertex *a, size_t a_count, const nt_verify_vertex *b, size_t b_count,
	const nt_verify_tolerance *tolerance, size_t *first);

#endif
