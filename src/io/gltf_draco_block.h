/* SPDX-License-Identifier: MIT */
/*
 * A primitive on its way into a Draco block.
 */
#ifndef NT_IO_GLTF_DRACO_BLOCK_H
#define NT_IO_GLTF_DRACO_BLOCK_H

#include "io/gltf_draco.h"
#include "io/gltf_patch.h"

/* A primitive that is to be compressed. */
typedef struct nt_gltf_recoding {
	nt_gltf_patcher *patcher;
	const nt_gltf_cluster *component;
	const nt_mesh *mesh;
	nt_json_value *primitive, *extension;
	uint64_t view;
	const nt_draco_mesh *source; /* NULL: the primitive is plain */
	nt_draco_attribute *attributes;
	size_t attribute_count;
	const char **names;
	bool outside; /* something of the primitive is not in the block */
	const char *obstacle; /* why it cannot be compressed; NULL: nothing is known to stand in the way */
} nt_gltf_recoding;

/* Attributes that nmtan may add to those of the source: NORMAL, TANGENT, _BITANGENT. */
enum { NT_GLTF_OWN_ATTRIBUTES = 3 };

/* Quantization as the options have it, or the default. */
int nt_gltf_draco_bits(const nt_write_options *options, nt_draco_bits which);

/* There is room for what the primitive has and NT_GLTF_OWN_ATTRIBUTES. */
void nt_gltf_draco_add(nt_gltf_recoding *recoding, const char *name, nt_draco_attribute attribute);

/* ---- gltf_draco_plain.c ---- */

/* The attributes of a plain primitive; recoding->obstacle where it cannot be compressed. */
nt_status nt_gltf_draco_gather_plain(nt_gltf_recoding *recoding);

/* Takes what the block holds out of the buffers, and gives the primitive its extension. */
nt_status nt_gltf_draco_take_out(nt_gltf_recoding *recoding, const nt_draco_block *block);

#endif
