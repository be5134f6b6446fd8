/* SPDX-License-Identifier: MIT */
/*
 * The values of a mesh as a decoder of Draco will have them: see draco_values.c.
 */
#ifndef NT_GLTF_DRACO_VALUES_H
#define NT_GLTF_DRACO_VALUES_H

#include "ext/draco.h"
#include "gltf/document.h"

/* The accessors of what a mesh has, of its vertices; NULL: it has none. */
typedef struct nt_gltf_sources {
	const nt_gltf_accessor *positions, *normals, *texcoords;
} nt_gltf_sources;

/* Whether Draco takes these attributes of a mesh, of which only faces and the number of vertices are asked for; with
 * `whole` also whether faces use all its vertices. Returns NT_OK; what nt_draco_encode() has against it; NT_ERROR_INPUT
 * where a vertex is not used; NT_ERROR_MEMORY, NT_ERROR_MODULE or NT_ERROR_IO. */
nt_status nt_gltf_draco_takes(const nt_mesh *mesh, const nt_draco_attribute *attributes, size_t count, bool whole,
	nt_error *error);

/* The plain floats of a mesh with ->quantized become what a decoder will have of them: nt_gltf_draco_takes() it. After
 * faces are loaded, before texture transforms are applied. One with a block that cannot be made again, since something
 * beside it counts vertices that no face uses, loses ->quantized. */
nt_status nt_gltf_quantize_vertices(nt_scene *scene, nt_mesh *mesh, const nt_gltf_sources *sources,
	const nt_read_options *options, nt_error *error);

/* Normals that were made for meshes with ->quantized: tangents will be solved for what a decoder has of them. */
nt_status nt_gltf_quantize_made_normals(nt_scene *scene, const nt_read_options *options, nt_error *error);

#endif
