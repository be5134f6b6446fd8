/* SPDX-License-Identifier: MIT */
/*
 * Triangles that may come in another order, and values that were rounded: what compressed primitives are
 * compared by.
 */
#ifndef NT_GLTF_VERIFY_FACES_H
#define NT_GLTF_VERIFY_FACES_H

#include "base/error.h"

typedef struct nt_verify_corner {
	float position[3], tangent[4];
} nt_verify_corner;

/* How far a value may be from the one it was made of. */
typedef struct nt_verify_tolerance {
	float position, tangent;
} nt_verify_tolerance;

bool nt_verify_close(const nt_verify_corner *a, const nt_verify_corner *b, const nt_verify_tolerance *tolerance);

/*
 * Whether two lists of triangles, of 3 corners each, are the same surface: each triangle has one in the other
 * list that differs by no more than the tolerance, with the same winding. *first receives a triangle of `a` that
 * has none, or SIZE_MAX. threads: at least 1; each direction is one's work.
 *
 * Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_verify_faces(const nt_verify_corner *a, size_t a_faces, const nt_verify_corner *b, size_t b_faces,
	const nt_verify_tolerance *tolerance, unsigned threads, size_t *first);

#endif
