/* SPDX-License-Identifier: MIT */
/*
 * Tangents of morph targets: for pipeline/tangents.c.
 */
#ifndef NT_PIPELINE_MORPHS_H
#define NT_PIPELINE_MORPHS_H

#include "scene/scene.h"

/* Authored tangents come back into those that were solved (nt_restore_authored), if they stay with --existing=repair.
 * targets: they will be solved. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_morphs_restore(nt_mesh *mesh, bool targets);

/* Takes the corner tangents of a target, which go, into classes of corners. */
nt_status nt_morphs_classify(nt_mesh *mesh, nt_morph *morph);

/* Solves the mesh as each of its targets moves it, one after the other: classes, and mesh->morph_turned. Blocks are
 * malloc'ed. */
nt_status nt_morphs_solve(nt_mesh *mesh, const nmtan_mesh *view, const nmtan_options *options);

/* How many triangles a target turns to the other side of their normals. */
size_t nt_morphs_count_turned(const nmtan_mesh *base, const nmtan_mesh *moved);

/* Adding half of a target's deltas: morph_halfway.c, after the solves of the base and of the target. Whether the target
 * turns any tangent enough for it to matter. */
bool nt_morphs_turn(const nt_mesh *mesh, const nt_morph *morph);

/* Solves a mesh halfway between its own positions and normals and those it is moved to; the same pointers: as its own.
 * Tangents are malloc'ed, also after failure, or NULL. */
nt_status nt_morphs_solve_halfway(const nmtan_mesh *base, const nmtan_mesh *moved, const uint8_t *halves,
	const nmtan_options *options, float **tangents);

/* Fills halfway_triangles and halfway_degrees of a target. */
void nt_morphs_compare_halfway(const nt_mesh *mesh, const nmtan_mesh *base, const nmtan_mesh *moved,
	const float *halfway, nt_morph *morph);

/* Writes to keys [corner_count][4] numbers that are equal for two corners of a vertex exactly where
 * the base's and all targets' tangents are: what splitting goes by. */
nt_status nt_morphs_keys(nt_mesh *mesh, const nmtan_mesh *view, float *keys);

/* After a split by keys: vertex tangents of the base, and what nt_morph_read() takes those of targets from. */
nt_status nt_morphs_finish(nt_mesh *mesh);

/* The results become the arena's. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_morphs_keep(nt_mesh *mesh, nt_arena *arena);

/* Frees what is malloc'ed, and after a failure the results, too. */
void nt_morphs_free(nt_mesh *mesh, bool failed);

#endif
