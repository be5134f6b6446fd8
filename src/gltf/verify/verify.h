/* SPDX-License-Identifier: MIT */
/*
 * A second look at glTF output before it takes its name: another parser takes it, and what the reader finds in
 * every corner is the position and tangent that were to be written.
 */
#ifndef NT_GLTF_VERIFY_VERIFY_H
#define NT_GLTF_VERIFY_VERIFY_H

#include "base/error.h"
#include "file/output.h"
#include "scene/scene.h"

/*
 * Reads back the glTF or GLB `path` of an output set that is complete but not committed, and compares it
 * with the scene it was written from, morph targets included; what Draco or a filter of meshoptimizer changes
 * within that, and vertices of a block in any order if the method is edgebreaker. An output that is written
 * through cannot be read back: nothing is done then. threads: 0 for one per processor; several compare meshes, with
 * the same result. If tinygltf refuses
 * an output, the scene gets the finding NOT_VERIFIED.
 *
 * Returns NT_OK; NT_ERROR_INTERNAL where the output is not what it should be, which says mesh and
 * corner; NT_ERROR_IO, NT_ERROR_MEMORY; NT_ERROR_UNSUPPORTED for what tinygltf cannot take (4 GB and
 * more).
 */
nt_status nt_verify_gltf(nt_scene *scene, nt_output *output, const char *path, unsigned threads,
	nt_error *error);

/* ---- vertices of a Draco block, in any order: vertices.c ---- */

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
