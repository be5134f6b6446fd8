/* SPDX-License-Identifier: MIT */
/*
 * A primitive on its way into a Draco block: see draco_block.c.
 */
#ifndef NT_GLTF_EDIT_DRACO_BLOCK_H
#define NT_GLTF_EDIT_DRACO_BLOCK_H

#include "gltf/draco.h"
#include "gltf/edit/buffer_edits.h"
#include "gltf/edit/merge_splits.h"

/* A primitive that is to be compressed. */
typedef struct nt_gltf_recoding {
	nt_buffer_edits *edits;
	nt_gltf *document; /* of the edits, as its JSON */
	nt_json *json;
	nt_arena *arena;   /* of the edits */
	const nt_write_options *options;
	nt_vertex_pools *pools;
	const nt_pool_vertices *vertices;
	uint32_t buffer;   /* of new views */
	nt_error *error;
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

/* The attributes of the primitive's block, as they are, with copies of their elements. */
nt_status nt_gltf_draco_gather_block(nt_gltf_recoding *recoding);

/* What nmtan made: NORMAL where it did, TANGENT, _BITANGENT where asked for. */
nt_status nt_gltf_draco_add_own(nt_gltf_recoding *recoding);

/* Compresses what was gathered; the status says whether Draco gives it back. */
nt_status nt_gltf_draco_encode(const nt_gltf_recoding *recoding, nt_draco_method method, nt_draco_block *block,
	nt_error *error);

/* The JSON of the primitive follows what a decoder will see; new accessors have no view, their elements are in the
 * block. */
void nt_gltf_draco_describe(nt_gltf_recoding *recoding, const nt_draco_block *block);

/* So many primitives do not refer to a block any more. Whether nobody does. */
bool nt_gltf_draco_release(nt_vertex_pools *pools, uint64_t view, size_t count);

/* Puts the block where the primitive's was, else into a new view. */
nt_status nt_gltf_draco_store(nt_gltf_recoding *recoding, const nt_draco_block *block);

#endif
