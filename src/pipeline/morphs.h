/* SPDX-License-Identifier: MIT */
/*
 * Tangents of morph targets: for pipeline/tangents.c.
 */
#ifndef NT_PIPELINE_MORPHS_H
#define NT_PIPELINE_MORPHS_H

#include "scene/scene.h"

/* Solves the mesh as each of its targets moves it: morph->corner_tangents, and
 * mesh->morph_turned. Blocks are malloc'ed. */
nt_status nt_morphs_solve(nt_mesh *mesh, const nmtan_mesh *view, const nmtan_options *options);

/* Fills halfway_triangles and halfway_degrees of a target, after the solves of the base and of the target: morph_halfway.c. */
nt_status nt_morphs_halfway(const nt_mesh *mesh, nt_morph *morph, const nmtan_mesh *base,
	const nmtan_options *options);

/* Writes to keys [corner_count][4] numbers that are equal for two corners of a vertex exactly where
 * the base's and all targets' tangents are: what splitting goes by. */
nt_status nt_morphs_keys(const nt_mesh *mesh, const nmtan_mesh *view, float *keys);

/* After a split by keys: vertex tangents of the base and of every target. Frees the corners' tangents. */
nt_status nt_morphs_finish(nt_mesh *mesh);

/* Frees what is malloc'ed. */
void nt_morphs_free(nt_mesh *mesh);

#endif
