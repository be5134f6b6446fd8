/* SPDX-License-Identifier: MIT */
/*
 * Decoded Draco blocks of a document, kept for encoding them again.
 */
#ifndef NT_IO_GLTF_DRACO_H
#define NT_IO_GLTF_DRACO_H

#include "ext/draco.h"
#include "io/gltf_document.h"

typedef struct nt_gltf_draco {
	struct nt_gltf_draco *next;
	uint64_t view; /* that holds the block */
	nt_draco *mesh;
} nt_gltf_draco;

/* A primitive's KHR_draco_mesh_compression; NULL: none. */
nt_json_value *nt_gltf_draco_of(const nt_json_value *primitive);

/* The block of a view; NULL: not decoded. */
const nt_draco_mesh *nt_gltf_draco_block(const nt_gltf *document, uint64_t view);

#endif
