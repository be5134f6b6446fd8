/* SPDX-License-Identifier: MIT */
/*
 * Rows of a component: see merge_splits.c.
 */
#ifndef NT_GLTF_EDIT_MERGE_SPLITS_H
#define NT_GLTF_EDIT_MERGE_SPLITS_H

#include "gltf/edit/vertex_pools.h"

/* Merges the splits of a component's meshes: a vertex gets one row for each tangent (and made normal)
 * that any of them wants. members are mesh numbers. Everything is in the arena,
 * or borrowed from the scene. */
nt_status nt_gltf_merge_rows(nt_gltf_rows *rows, const nt_gltf *document, const nt_scene *scene,
	const nt_gltf_sharing *sharing, const uint32_t *members, size_t member_count, nt_arena *arena,
	nt_error *error);

#endif
