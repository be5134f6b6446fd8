/* SPDX-License-Identifier: MIT */
/*
 * The vertices of a pool after all splits: see merge_splits.c.
 */
#ifndef NT_GLTF_EDIT_MERGE_SPLITS_H
#define NT_GLTF_EDIT_MERGE_SPLITS_H

#include "gltf/edit/vertex_pools.h"

typedef struct nt_pool_vertices {
	const nt_vertex_pool *pool;
	size_t old_count;   /* of the source */
	size_t new_count;
	uint32_t *sources;  /* [new_count - old_count] vertex of the source */
	float **tangents;   /* [set][new_count][4] */
	float **normals;    /* [set][new_count][3]: NULL where normals were not made */
	float ***morphs;    /* [set][morph count of its meshes][new_count][3] */
	uint32_t **indices; /* [user][corner count]; NULL: not solved */
	bool *changed;      /* [user] indices differ from the source's triangles */
	bool borrowed;      /* sources, tangents and indices are the scene's: do not write to them */
} nt_pool_vertices;

/* The vertex of the source whose attributes a vertex has. */
static inline size_t nt_vertex_source(const nt_pool_vertices *vertices, size_t vertex)
{
	return vertex < vertices->old_count ? vertex : vertices->sources[vertex - vertices->old_count];
}

/* Merges the splits of a pool's users: a vertex of the source becomes one for each tangent (and made normal)
 * that any of them wants. The pool has a set. What edits may refer to is in `arena`, or borrowed from the scene; tables
 * of it are in `tables`. */
nt_status nt_merge_splits(nt_pool_vertices *vertices, const nt_vertex_pool *pool, nt_arena *arena, nt_arena *tables,
	nt_error *error);

#endif
