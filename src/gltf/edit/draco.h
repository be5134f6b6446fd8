/* SPDX-License-Identifier: MIT */
/*
 * Compressed primitives that got tangents: see draco.c.
 */
#ifndef NT_GLTF_EDIT_DRACO_H
#define NT_GLTF_EDIT_DRACO_H

#include "gltf/edit/editor.h"

/* Whether a solved member of the component is compressed by Draco. */
bool nt_gltf_has_draco(const nt_gltf_patcher *patcher, const nt_gltf_cluster *component);

/* Writes a component with compressed members: compressed again where that is possible, else plain.
 * *done false: plain, and what plain components need is still to be done. */
nt_status nt_gltf_patch_draco(nt_gltf_patcher *patcher, nt_gltf_cluster *component, bool *done);

/* Takes KHR_draco_mesh_compression off the lists where no primitive has it any more. */
void nt_gltf_drop_draco(nt_gltf_patcher *patcher);

#endif
