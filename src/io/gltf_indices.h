/* SPDX-License-Identifier: MIT */
/*
 * Indices of primitives whose vertices were split: see gltf_indices.c.
 */
#ifndef NT_IO_GLTF_INDICES_H
#define NT_IO_GLTF_INDICES_H

#include "io/gltf_editor.h"

/* Writes the indices of the component's solved meshes where they changed. */
nt_status nt_gltf_patch_indices(nt_gltf_patcher *patcher, const nt_gltf_cluster *component);

#endif
