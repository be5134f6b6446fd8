/* SPDX-License-Identifier: MIT */
/*
 * The vertices that a primitive uses, of those that it shares with others: see compact.c.
 */
#ifndef NT_GLTF_COMPACT_H
#define NT_GLTF_COMPACT_H

#include "base/error.h"
#include "base/memory.h"

typedef struct nt_compact {
	uint32_t *vertices; /* [count] number of each in the pool, ascending; NULL: the pool's own numbers */
	size_t count;
	uint32_t *indices;  /* [corner_count] of these vertices */
} nt_compact;

/* Numbers the vertices that corners use, of a pool of `vertex_count`; nearly all are taken for all. indices:
 * [corner_count], each below that. All of the view is in the arena, or `indices` themselves. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_compact_vertices(const uint32_t *indices, size_t corner_count, size_t vertex_count, nt_arena *arena,
	nt_compact *view);

/* The rows of a view's vertices, as many floats each; `rows` themselves where the view has the pool's numbers. NULL:
 * memory is exhausted. */
float *nt_compact_rows(const nt_compact *view, const float *rows, size_t floats, nt_arena *arena);

#endif
