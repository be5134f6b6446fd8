/* SPDX-License-Identifier: MIT */
/*
 * Tangents as integers: what KHR_mesh_quantization allows for TANGENT, a VEC4 of normalized SHORT or BYTE.
 */
#ifndef NT_GLTF_QUANTIZE_H
#define NT_GLTF_QUANTIZE_H

#include "base/dvec.h"
#include "scene/scene.h"

#define NT_GLTF_QUANTIZATION "KHR_mesh_quantization"

/* Bytes of a tangent, a multiple of 4 as glTF wants it; componentType. */
size_t nt_precision_bytes(nt_precision precision);
uint32_t nt_precision_component_type(nt_precision precision);

/*
 * Rounds tangents to what the integers can say; afterwards they hold what a reader will decode. w becomes
 * +-1 exactly. Takes the one with the least angle of the up to eight integer vectors around T, if its length is
 * within what the Khronos validator lets pass. A tangent that the integers represent stays as it is. Tangents without
 * a direction become zero. NT_PRECISION_FLOAT changes nothing.
 *
 *   tangents  [count][4]
 *   cost  what the rounding does to the directions is added to it; may be NULL
 */
void nt_precision_round(nt_precision precision, float *tangents, size_t count, nt_rounding *cost);

/* Whether a direction is one that integers say, of which `most` is 1; the best integers for it. */
bool nt_precision_has(const float *direction, double most);
nt_dvec3 nt_nearest_direction(const float *direction, double most);

/* The integers of rounded tangents: count * nt_precision_bytes() bytes. */
void nt_precision_encode(nt_precision precision, const float *tangents, size_t count, unsigned char *bytes);

/* Adds a cost to the scene's, and the finding that tells it. */
void nt_precision_report(nt_scene *scene, nt_precision precision, const nt_rounding *cost,
	const nt_place *place);

#endif
