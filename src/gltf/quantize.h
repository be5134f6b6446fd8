/* SPDX-License-Identifier: MIT */
/*
 * Numbers as accessors and views store them: normalized integers, tangents as integers, filters.
 */
#ifndef NT_GLTF_QUANTIZE_H
#define NT_GLTF_QUANTIZE_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include "base/vec.h"
#include "ext/gltf_numbers.h"
#include "scene/scene.h"

static inline float nt_signed_fraction(float value, float most)
{
	return value < -most ? -1.0f : value / most;
}

/* bytes: those of the component, without alignment. type: one of nt_gltf_component. */
static inline float nt_component_value(const unsigned char *bytes, int type, bool normalised)
{
	int8_t i8;
	int16_t i16;
	uint16_t u16;
	int32_t i32;
	uint32_t u32;
	float f32;
	switch (type) {
	case NT_GLTF_BYTE:
		memcpy(&i8, bytes, sizeof i8);
		return normalised ? nt_signed_fraction((float)i8, 127.0f) : (float)i8;
	case NT_GLTF_UBYTE:
		return normalised ? (float)bytes[0] / 255.0f : (float)bytes[0];
	case NT_GLTF_SHORT:
		memcpy(&i16, bytes, sizeof i16);
		return normalised ? nt_signed_fraction((float)i16, 32767.0f) : (float)i16;
	case NT_GLTF_USHORT:
		memcpy(&u16, bytes, sizeof u16);
		return normalised ? (float)u16 / 65535.0f : (float)u16;
	case NT_GLTF_INT:
		memcpy(&i32, bytes, sizeof i32);
		return normalised ? (float)(i32 / 2147483647.0) : (float)i32;
	case NT_GLTF_UINT:
		memcpy(&u32, bytes, sizeof u32);
		return normalised ? (float)(u32 / 4294967295.0) : (float)u32;
	default:
		memcpy(&f32, bytes, sizeof f32);
		return f32;
	}
}

/* ---- tangents as integers: quantize.c ---- */

#define NT_GLTF_QUANTIZATION "KHR_mesh_quantization"

/* Bytes of a tangent, a multiple of 4 as glTF wants it; componentType. */
size_t nt_precision_bytes(nt_precision precision);
uint32_t nt_precision_component_type(nt_precision precision);

/*
 * Rounds tangents to what the integers can say; afterwards they hold what a reader will decode. w becomes
 * +-1 exactly. Takes the one with the least angle of the up to eight integer vectors around T, if its length is
 * within what the Khronos validator lets pass. A tangent that the integers represent stays as it is. Tangents without
 * a direction become zero. Not for NT_PRECISION_FLOAT.
 *
 *   tangents  [count][4]
 *   cost  what the rounding does to the directions is added to it; may be NULL
 */
void nt_precision_round(nt_precision precision, float *tangents, size_t count, nt_rounding *cost);

/* Whether a direction is one that integers say, of which `most` is 1; the best integers for it. */
bool nt_precision_has(const float *direction, double most);
nt_dvec3 nt_nearest_direction(const float *direction, double most);

/* The integers of rounded tangents: count * nt_precision_bytes() bytes. Not for NT_PRECISION_FLOAT. */
void nt_precision_encode(nt_precision precision, const float *tangents, size_t count, unsigned char *bytes);

/* Adds a cost to the scene's, and the finding that tells it. */
void nt_precision_report(nt_scene *scene, nt_precision precision, const nt_rounding *cost,
	const nt_place *place);

/* ---- filters of meshoptimizer: tangent_filter.c ---- */

/* Filters of numbers on their way into a view. */
typedef struct nt_tangent_filter {
	nt_precision precision;
	const char *filter; /* NONE; of integers OCTAHEDRAL, of floats EXPONENTIAL; NULL: NONE, too */
	int bits;           /* of a component before the filter: 2 to 8 of bytes, to 16 of shorts, to 23 of floats */
} nt_tangent_filter;

/*
 * Rounds tangents to what the integers or the filter can say, as nt_precision_round() does; afterwards they hold what a
 * reader will decode. w is +-1 exactly.
 *
 *   tangents  [count][4]
 *   stored  [count * nt_precision_bytes()], what the filter will be applied to
 *   values  the same size, what it gives; `stored` where there is none
 *   cost  may be NULL
 *
 * Returns NT_OK or what opening the module of meshoptimizer gives.
 */
nt_status nt_tangents_store(const nt_tangent_filter *filter, float *tangents, size_t count, unsigned char *stored,
	unsigned char *values, nt_rounding *cost, nt_error *error);

/* By how much storing may change a component: nt_morph_least(). */
float nt_tangent_filter_least(const nt_tangent_filter *filter);

/* The bits that elements before a filter have, 0: none that make sense. elements: [count], `stride` bytes apart, each
 * of `components` numbers of a type. */
int nt_filter_bits(const char *filter, const unsigned char *elements, size_t count, size_t stride, int component_type,
	unsigned components);

/* ---- tangent deltas of morph targets: load_targets.c ---- */

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
