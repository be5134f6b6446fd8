/* SPDX-License-Identifier: MIT */
/*
 * Tangents of morph targets: see morph_targets.c.
 */
#ifndef NT_GLTF_EDIT_MORPH_TARGETS_H
#define NT_GLTF_EDIT_MORPH_TARGETS_H

#include "gltf/edit/append.h"
#include "gltf/edit/merge_splits.h"

/* TANGENT of the morph targets of a set's meshes: what to add to the base's, which are final. Before vertices are
 * appended: accessors to which nothing is to be appended then are added to the overrides. least: as nt_morph_deltas()
 * has it. Their bytes are added to the cost. */
nt_status nt_gltf_add_morphs(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices, uint32_t set,
	float least, nt_override_list *overrides, nt_morph_cost *cost, nt_error *error);

#endif
