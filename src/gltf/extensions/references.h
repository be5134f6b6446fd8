/* SPDX-License-Identifier: MIT */
/*
 * Extensions that refer to vertices: see references.c.
 */
#ifndef NT_GLTF_EXTENSIONS_REFERENCES_H
#define NT_GLTF_EXTENSIONS_REFERENCES_H

#include "gltf/document.h"

/* Adds a finding for each extension of a primitive, whose vertices were copied, and, with_mesh, of its glTF mesh that
 * seems to refer to its vertices and that nobody makes follow. old_count: vertices before. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_extension_references(nt_scene *scene, const nt_mesh *mesh, size_t old_count, bool with_mesh);

/* Vertices were copied: adds a finding for each scene with FB_geometry_metadata, which counts them. */
void nt_extension_scenes(nt_scene *scene);

#endif
