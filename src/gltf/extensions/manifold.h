/* SPDX-License-Identifier: MIT */
/*
 * EXT_mesh_manifold: see manifold.c.
 */
#ifndef NT_GLTF_EXTENSIONS_MANIFOLD_H
#define NT_GLTF_EXTENSIONS_MANIFOLD_H

#include "gltf/document.h"

/* The corners of all primitives of a glTF mesh, one after the other as they lie in their buffer view. */
typedef struct nt_manifold {
	nt_json_value *extension; /* NULL: the mesh has none */
	const char *obstacle;     /* what of the mesh is not as the extension demands; NULL: nothing */
	size_t corner_count;
	uint32_t component_type;  /* of the indices */
	uint32_t *corners;        /* [corner_count] vertices */
	const uint32_t *merged;   /* [corner_count] the same of the manifold, where vertices at one place are one */
	size_t primitive_count;
	size_t *first;            /* [primitive_count] where its corners begin */
	size_t *count;            /* [primitive_count] */
} nt_manifold;

/* Reads the extension of a glTF mesh into the arena. A mesh that is not as it demands is no error. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_manifold_read(nt_manifold *manifold, nt_gltf *document, size_t mesh, nt_arena *arena);

/* Which corners have another vertex in the manifold, and which: ascending, in the arena. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_manifold_merges(const nt_manifold *manifold, nt_arena *arena, uint32_t **corners, uint32_t **vertices,
	size_t *count);

#endif
