/* SPDX-License-Identifier: MIT */
/*
 * CESIUM_primitive_outline: see outline.c.
 */
#ifndef NT_GLTF_EXTENSIONS_OUTLINE_H
#define NT_GLTF_EXTENSIONS_OUTLINE_H

#include "base/memory.h"
#include "base/status.h"

/* Triangles whose vertices were copied. */
typedef struct nt_copied_triangles {
	const uint32_t *vertices; /* [corner_count] after copying, three a triangle */
	size_t corner_count;
	size_t old_count;         /* vertices before; vertex old_count + i is a copy of sources[i] */
	const uint32_t *sources;
} nt_copied_triangles;

/* The edges of an outline, two vertices each, after copying: in the arena. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_outline_follow(const uint32_t *edges, size_t edge_count, const nt_copied_triangles *triangles,
	nt_arena *arena, uint32_t **result, size_t *result_count);

#endif
