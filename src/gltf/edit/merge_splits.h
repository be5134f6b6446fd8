/* SPDX-License-Identifier: MIT */
/*
 * The vertices of a pool after all splits: see merge_splits.c.
 */
#ifndef NT_GLTF_EDIT_MERGE_SPLITS_H
#define NT_GLTF_EDIT_MERGE_SPLITS_H

#include "gltf/vertex_pools.h"

/* Shared data of the meshes of a tangent set, for all vertices of their pool. */
typedef struct nt_pool_set {
	float *tangents;      /* [new_count][4] */
	float *normals;       /* [new_count][3]: NULL where normals were not made */
	float *source_normals; /* [old_count][3] of pooled meshes whose normals were not made; not to be written to */
	size_t morph_count;
	const nt_mesh *lone;  /* gives all vertices the tangents of targets: scene/morphs.h; NULL: several do */
	uint32_t *givers;     /* [new_count] the user that gives them; NT_NONE: they are the base's; NULL: lone */
	uint32_t *given;      /* [new_count] its vertex there; NULL: the same one of lone */
	uint64_t *digests;    /* [vertex][2] while splits are merged: of the tangents of all targets */
	bool *defined;        /* [vertex] while splits are merged: whether a corner of the set has it */
	uint32_t *first_free; /* [old_count] while splits are merged: before this one the set has tangents for all
	                         copies of a vertex */
} nt_pool_set;

typedef struct nt_pool_vertices {
	const nt_vertex_pool *pool;
	size_t old_count;   /* of the source */
	size_t own_count;   /* first ones that are the source's as they stand: old_count, or 0 after welding */
	size_t new_count;
	uint32_t *sources;  /* [new_count - own_count] vertex of the source */
	nt_pool_set *sets;  /* [pool->sets.count] */
	uint32_t **indices; /* [user][corner count]; NULL: not solved */
	bool *changed;      /* [user] indices differ from the source's triangles */
	size_t *counts;     /* [user] of indices; NULL: as many as the mesh has corners */
	bool *renumbered;   /* [user] indices are the source's with other numbers, of any mode; NULL: of none */
	bool welded;        /* equal ones were looked for */
	bool borrowed;      /* sources, tangents and indices are the scene's: do not write to them */
} nt_pool_vertices;

/* The vertex of the source whose attributes a vertex has. */
static inline size_t nt_vertex_source(const nt_pool_vertices *vertices, size_t vertex)
{
	return vertex < vertices->own_count ? vertex : vertices->sources[vertex - vertices->own_count];
}

/* Whether vertices are not just those of the source. */
static inline bool nt_vertices_differ(const nt_pool_vertices *vertices)
{
	return vertices->new_count != vertices->own_count;
}

/* How many indices a user has. */
static inline size_t nt_pool_index_count(const nt_pool_vertices *vertices, size_t user)
{
	return vertices->counts ? vertices->counts[user] : nt_pool_mesh(vertices->pool, user)->corner_count;
}

/* For the table of formats. Merges the split of a pooled mesh, in the order of the scene's meshes, with those of its
 * pool before it: a vertex of the source becomes one for each tangent (and made normal) that any of them wants. The
 * mesh is `merged` then; what it holds is not asked for again. */
nt_status nt_gltf_merge(nt_scene *scene, nt_mesh *mesh, nt_error *error);

/* The vertices of a pool, all of whose solved meshes are there; it has a set. Data that edits may refer to lives as
 * long as the document, or is borrowed from the scene; tables of it are in `tables`. */
nt_status nt_pool_vertices_get(nt_vertex_pools *pools, size_t number, const nt_vertex_pool *pool, nt_arena *tables,
	nt_pool_vertices *vertices, nt_error *error);

/* The tangents of a set as the m-th target moves it, in the arena: [new_count][3]. NULL: memory is exhausted. */
const float *nt_pool_read_target(const nt_pool_vertices *vertices, uint32_t set, size_t m, nt_arena *scratch);

#endif
