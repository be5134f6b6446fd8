/* SPDX-License-Identifier: MIT */
/*
 * Tangent deltas of morph targets: see morph_deltas.c.
 */
#ifndef NT_GLTF_MORPH_DELTAS_H
#define NT_GLTF_MORPH_DELTAS_H

#include "scene/scene.h"

/* Two float solves of one surface, as a target leaves most of a mesh, differ by some units in the last place, which is
 * 2^-24 near 1: what is not more than 8 of them is not shown. */
#define NT_MORPH_LEAST 0x1p-21f

/* The largest component of a delta that counts as zero, by how the base is stored: what storing it does to it. */
float nt_morph_least(nt_precision precision);

/* The same of tangents that Draco quantizes. */
float nt_morph_least_of_bits(int bits);

/*
 * Deltas from the base's tangents to moved ones, as a reader will have them. Elements none of whose components is above
 * `least` are zero.
 *
 *   moved   [count][3]
 *   base    [count][4], as it is stored
 *   type    NT_GLTF_FLOAT, or the normalized NT_GLTF_SHORT or NT_GLTF_BYTE, which becomes NT_GLTF_FLOAT where a
 *           component is beyond 1
 *   deltas  [count][3]
 *
 * Returns how many are not zero.
 */
size_t nt_morph_deltas(const float *moved, const float *base, size_t count, float least, uint32_t *type, float *deltas);

/* How such elements are stored. */
typedef struct nt_morph_storage {
	uint32_t type;
	bool sparse;         /* where that takes less; of one element at least, since some readers refuse an accessor
	                        that has nothing */
	uint32_t index_type; /* of the elements that are not zero */
	size_t element_count;
	size_t value_offset; /* of sparse ones, behind their indices */
	size_t stride, size; /* bytes; stride: of a dense one's element, a multiple of 4 */
} nt_morph_storage;

nt_morph_storage nt_morph_choose_storage(uint32_t type, size_t count, size_t moved_count);

/* bytes: [storage->size], zeros before. */
void nt_morph_store(const nt_morph_storage *storage, const float *deltas, size_t count, unsigned char *bytes);

#endif
