/* SPDX-License-Identifier: MIT */
/*
 * Indices of primitives whose vertices were split: see indices.c.
 */
#ifndef NT_GLTF_EDIT_INDICES_H
#define NT_GLTF_EDIT_INDICES_H

#include "gltf/edit/editor.h"

/* Writes the indices of the component's solved meshes where they changed. */
nt_status nt_gltf_patch_indices(nt_gltf_patcher *patcher, const nt_gltf_cluster *component);

#endif
