/* SPDX-License-Identifier: MIT */
/*
 * Tangents of morph targets: for pipeline/tangents.c.
 */
#ifndef NT_PIPELINE_MORPHS_H
#define NT_PIPELINE_MORPHS_H

#include "scene/scene.h"

/* Whether authored tangents come back into those of corners once all targets are solved (nt_restore_authored). */
static inline bool nt_morphs_are_restored(const nt_mesh *mesh)
{
	return mesh->decision == NT_DECISION_REPAIR && mesh->tangents && mesh->texcoords;
}

/* Takes the corner tangents of a target, which go, into classes of corners. */
nt_status nt_morphs_classify(nt_mesh *mesh, nt_morph *morph);

/* Solves the mesh as each of its targets moves it: classes, or if authored tangents come back morph->corner_tangents;
 * and mesh->morph_turned. Blocks are malloc'ed. */
nt_status nt_morphs_solve(nt_mesh *mesh, const nmtan_mesh *view, const nmtan_options *options);

/* How many triangles a target turns to the other side of their normals. */
size_t nt_morphs_count_turned(const nmtan_mesh *base, const nt_morph *morph);

/* Adding half of a target's deltas: morph_halfway.c, after the solves of the base and of the target. Whether the target
 * turns any tangent enough for it to matter. */
bool nt_morphs_turn(const nt_mesh *mesh, const nt_morph *morph);

/* Solves a mesh halfway between its own positions and normals and those it is moved to; NULL: as its own. Tangents are
 * malloc'ed, also after failure, or NULL. */
nt_status nt_morphs_solve_halfway(const nmtan_mesh *base, const uint8_t *halves, const float *positions,
	const float *normals, const nmtan_options *options, float **tangents);

/* Fills halfway_triangles and halfway_degrees of a target. */
void nt_morphs_compare_halfway(const nt_mesh *mesh, const nmtan_mesh *base, const float *halfway, nt_morph *morph);

/* Writes to keys [corner_count][4] numbers that are equal for two corners of a vertex exactly where
 * the base's and all targets' tangents are: what splitting goes by. */
nt_status nt_morphs_keys(nt_mesh *mesh, const nmtan_mesh *view, float *keys);

/* After a split by keys: vertex tangents of the base and of every target. Frees the corners' tangents. */
nt_status nt_morphs_finish(nt_mesh *mesh);

/* Frees what is malloc'ed. */
void nt_morphs_free(nt_mesh *mesh);

#endif
