/* SPDX-License-Identifier: MIT */
/*
 * Draco: compressed meshes to arrays and back. For KHR_draco_mesh_compression and .drc files.
 *
 * Nothing that Draco returns is believed: sizes are checked before it decodes, and after it every index, every
 * mapping and every attribute's extent is checked. Each block is decoded again and compared with the input, bit for
 * bit after quantization. Functions may run in several threads at once.
 */
#ifndef NT_EXT_DRACO_H
#define NT_EXT_DRACO_H

#include <stdlib.h>
#include <string.h>
#include "base/text.h"
#include "ext/gltf_numbers.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum nt_draco_method { NT_DRACO_SEQUENTIAL, NT_DRACO_EDGEBREAKER } nt_draco_method;

/* Draco's name of an attribute's type; tangents, joints and weights are generic and found by their id. */
typedef enum nt_draco_kind {
	NT_DRACO_POSITION,
	NT_DRACO_NORMAL,
	NT_DRACO_COLOR,
	NT_DRACO_TEXCOORD,
	NT_DRACO_GENERIC
} nt_draco_kind;

/* How floats were, or are to be, turned into integers. */
typedef struct nt_draco_quantization {
	int bits;          /* 1 to 30; 0: not at all */
	bool octahedral;   /* decoding: unit vectors, by direction, without origin and range. Encoding takes
	                      normals of three floats so, whatever this says */
	bool explicit_box; /* encoding: take origin and range as they are instead of the values' box */
	float origin[4], range;
} nt_draco_quantization;

typedef struct nt_draco_attribute {
	uint32_t unique_id;
	nt_draco_kind kind;
	int component_type; /* of ext/gltf_numbers.h */
	int components;     /* 1 to 4 */
	bool normalized;    /* integers that mean [0, 1] or [-1, 1] */
	nt_draco_quantization quantization;
	const void *data;   /* [point_count][components]; aligned for its type when decoded */
	size_t stride_bytes; /* 0: tightly packed, as it is when decoded */
	const uint32_t *copied; /* encoding: points from own_count on have no value of their own, but that of the point
	                           copied[point - own_count], which is below own_count. NULL: all have their own */
	size_t own_count;
} nt_draco_attribute;

typedef struct nt_draco_mesh {
	nt_draco_method method;
	size_t point_count, face_count;
	const uint32_t *indices; /* [face_count][3] */
	const nt_draco_attribute *attributes;
	size_t attribute_count;
	int speed; /* encoding: Draco's level, 0 (smallest) to 10 (fastest) */
} nt_draco_mesh;

/* ---- decoding ---- */

/* A mesh that was decoded. */
typedef struct nt_draco {
	nt_draco_mesh mesh;
	void (*free)(struct nt_draco *draco);
} nt_draco;

/*
 * Decodes a mesh.
 *
 *   max_faces  the context's limit; 0: none but what so many bytes can plausibly hold
 *
 * Returns NT_OK; NT_ERROR_INPUT for what is not Draco or damaged, with Draco's words;
 * NT_ERROR_UNSUPPORTED for point clouds and attributes that glTF cannot have; NT_ERROR_TOO_LARGE when it
 * declares more faces than allowed; NT_ERROR_MEMORY.
 */
nt_status nt_draco_decode(nt_draco **result, const unsigned char *bytes, size_t size,
	size_t max_faces, nt_error *error);

/* NULL is allowed. */
static inline void nt_draco_free(nt_draco *result)
{
	if (result)
		result->free(result);
}

/* The attribute with that id; NULL: none. */
static inline const nt_draco_attribute *nt_draco_find(const nt_draco_mesh *mesh, uint32_t unique_id)
{
	for (size_t i = 0; i < mesh->attribute_count; i++)
		if (mesh->attributes[i].unique_id == unique_id)
			return &mesh->attributes[i];
	return NULL;
}

/* ---- encoding ---- */

typedef struct nt_draco_block {
	unsigned char *bytes;
	size_t size;
	size_t point_count, face_count; /* as a decoder will see them */
	uint32_t *sources; /* [point_count] sequential: the point of the input that each one is. NULL with
	                      edgebreaker, which reorders points and splits them */
	double (*bounds)[2][4]; /* [attribute_count] least and most of each component, as a decoder will see them */
} nt_draco_block;

static inline void nt_draco_block_free(nt_draco_block *block)
{
	free(block->bytes);
	free(block->sources);
	free(block->bounds);
	memset(block, 0, sizeof *block);
}

/*
 * Encodes a mesh. Points that no face uses are left out. Sequential keeps the order of faces and of the
 * remaining points, and degenerate faces; edgebreaker is smaller, reorders, and drops faces with two corners
 * at one position.
 *
 * Returns NT_OK; NT_ERROR_ARGUMENT for types, counts and bits out of range (24 at most, of integers of four
 * bytes too) and quantized values that are not finite or outside of their explicit box; NT_ERROR_INDEX;
 * NT_ERROR_TOO_LARGE; NT_ERROR_INPUT when no face is left to encode; NT_ERROR_INTERNAL when Draco fails or
 * does not give back what it got; NT_ERROR_MEMORY.
 */
nt_status nt_draco_encode(const nt_draco_mesh *mesh, nt_draco_block *block, nt_error *error);

/*
 * A bound of the memory that nt_draco_encode() takes beside the mesh. Bytes of a corner: 4 in the faces that Draco
 * gets, those that are expected, those that it decodes and those that are compared, and 8 in CornerTable or in the
 * symbols of sequential faces. A component: 4 times its own for the same reason, 4 of Draco's integers, 4 of its
 * symbols and the block. An attribute: 8 a point in the maps of what is encoded and decoded; with edgebreaker, whose
 * decoder has them too, those of MeshAttributeCornerTable and MeshAttributeIndicesEncodingData: 12 a corner and 24 a
 * point. And once four bytes for each number that its entropy coder may meet, whose sign costs a bit.
 */
static inline uint64_t nt_draco_encoding_bytes(const nt_draco_mesh *mesh)
{
	const bool has_tables = mesh->method == NT_DRACO_EDGEBREAKER;
	uint64_t corner = 24, point = 0, numbers = 0;
	for (size_t i = 0; i < mesh->attribute_count; i++) {
		const nt_draco_attribute *a = &mesh->attributes[i];
		const size_t size = nt_component_size(a->component_type);
		const int bits = a->component_type == NT_GLTF_FLOAT ? a->quantization.bits
			: size == 4 ? 24 : 8 * (int)size;
		corner += has_tables ? 12 : 0;
		point += (has_tables ? 32 : 8) + (uint64_t)a->components * (4 * size + 8);
		numbers = numbers >> bits > 1 ? numbers : (uint64_t)2 << bits;
	}
	return 3 * corner * mesh->face_count + point * mesh->point_count + 4 * numbers;
}

/*
 * The values that a decoder will have of the quantized attributes of a mesh once it is encoded. They depend neither on
 * the method nor on the other attributes.
 *
 *   values  [attribute_count] of each attribute room for [point_count][components] floats, which may be where its data
 *           is; NULL: it is only looked at, as where its quantization has no bits. Points that no face uses keep
 *           their values
 *
 * Returns what nt_draco_encode() does for meshes that it refuses; NT_ERROR_MEMORY.
 */
nt_status nt_draco_quantize(const nt_draco_mesh *mesh, float *const *values, nt_error *error);

#ifdef __cplusplus
}
#endif
#endif
