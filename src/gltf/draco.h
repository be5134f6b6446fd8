/* SPDX-License-Identifier: MIT */
/*
 * KHR_draco_mesh_compression: compressed primitives of a document. Decoded blocks are kept: several primitives may
 * share one, and it may be encoded again.
 */
#ifndef NT_GLTF_DRACO_H
#define NT_GLTF_DRACO_H

#include "ext/draco.h"
#include "gltf/document.h"

/* A primitive's KHR_draco_mesh_compression; NULL: none. */
nt_json_value *nt_gltf_draco_of(const nt_json_value *primitive);

/* Decodes a primitive's KHR_draco_mesh_compression, where it has one: from then on its accessors have
 * their elements. */
nt_status nt_gltf_decode_draco(nt_gltf *document, const nt_json_value *primitive,
	const char *pointer, nt_error *error);

/* Decodes the blocks of several meshes on several threads. needed: [mesh_count]. A block that
 * fails is left for nt_gltf_decode_draco(), which has it alone and says what is wrong. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_gltf_decode_ahead(nt_scene *scene, const bool *needed, const nt_read_options *options, nt_error *error);

/* Quantization of what was not quantized before, as the options have it, or the default. */
int nt_gltf_draco_bits(const int *draco_bits, nt_draco_bits which);

/* Draco's kind of an attribute of that name, and the bits of its floats: 0 for what must come back as it was. */
nt_draco_kind nt_gltf_draco_kind(const char *name);
int nt_gltf_draco_bits_of(const int *draco_bits, const char *name);

/* How an accessor is quantized that was not: on the document's grid for it, or on its own with these bits. */
nt_draco_quantization nt_gltf_draco_grid(const nt_gltf *document, uint32_t accessor, int bits);

/* How a primitive's block has its tangents; NULL: it has none, or is not loaded. */
const nt_draco_quantization *nt_gltf_draco_tangents_of(const nt_gltf *document, const nt_json_value *primitive);

/* The grid of tangents that are encoded: the one that they have where it decodes to -1 and 1 exactly, as w has to be,
 * else one of our own. source: NULL: they have none. */
nt_draco_quantization nt_gltf_draco_tangent_grid(const nt_draco_quantization *source, const int *draco_bits);

/* Whether it is not the mesh that keeps Draco from quantizing or encoding it. */
static inline bool nt_gltf_is_beside_mesh(nt_status status)
{
	return status == NT_ERROR_MEMORY || status == NT_ERROR_MODULE || status == NT_ERROR_IO;
}

/* The block of a view; NULL: not decoded. */
const nt_draco_mesh *nt_gltf_draco_block(const nt_gltf *document, uint64_t view);

/* Gives each content an accessor of its own. Loading finds malformed parts. Returns NT_OK,
 * NT_ERROR_INPUT (nt_gltf_check_dangling()) or NT_ERROR_MEMORY. */
nt_status nt_gltf_separate_draco(nt_gltf *document, nt_error *error);

#endif
