/* SPDX-License-Identifier: MIT */
/*
 * Tangent deltas of morph targets, in few bytes. Most targets move a small part of a mesh. If they move nothing,
 * a solve gives the base's tangents again but for the rounding of floats, and what is stored of these may be
 * integers: a delta that is not above either is zero, and a sparse accessor has the others. If the normals of the
 * target are integers, its tangents are integers of that type; these end at 1, and a tangent that turns round takes a
 * delta of 2.
 */
#include "gltf/quantize.h"

#include <math.h>
#include <string.h>
#include "gltf/document.h"

/* Bytes that a sparse accessor takes in JSON beyond a dense one with its view. */
enum { SPARSE_JSON = 64 };

/* nt_precision_round() takes one of the integers on either side. */
float nt_morph_least(nt_precision precision)
{
	return precision == NT_PRECISION_BYTE ? 1.0f / 127.0f :
	       precision == NT_PRECISION_SHORT ? 1.0f / 32767.0f : NT_MORPH_LEAST;
}

/* Half a step: the box of unit vectors is 2 wide at most. */
float nt_morph_least_of_bits(int bits)
{
	return 1.0f / (float)((1u << bits) - 1) + NT_MORPH_LEAST;
}

/* The integer that is decoded to 1; 0: floats. */
static float most_of(uint32_t type)
{
	return type == NT_GLTF_BYTE ? 127.0f : type == NT_GLTF_SHORT ? 32767.0f : 0.0f;
}

size_t nt_morph_deltas(const float *moved, const float *base, size_t count, float least, uint32_t *type, float *deltas)
{
	float largest = 0;
	for (size_t v = 0; v < count; v++) {
		float *delta = deltas + 3 * v, reach = 0;
		for (size_t k = 0; k < 3; k++) {
			delta[k] = nt_morph_delta(moved[3 * v + k], base[4 * v + k]);
			reach = fmaxf(reach, fabsf(delta[k]));
		}
		if (reach <= least)
			memset(delta, 0, 3 * sizeof *delta);
		largest = fmaxf(largest, reach);
	}
	if (largest > 1)
		*type = NT_GLTF_FLOAT;
	const float most = most_of(*type);
	size_t moved_count = 0;
	for (size_t v = 0; v < count; v++) {
		float *delta = deltas + 3 * v;
		for (size_t k = 0; most > 0 && k < 3; k++)
			delta[k] = rintf(delta[k] * most) / most + 0.0f;
		moved_count += delta[0] != 0 || delta[1] != 0 || delta[2] != 0;
	}
	return moved_count;
}

nt_morph_storage nt_morph_choose_storage(uint32_t type, size_t count, size_t moved_count)
{
	const size_t element = 3 * nt_gltf_component_bytes(type);
	nt_morph_storage s = {.type = type, .stride = (element + 3) / 4 * 4,
		.element_count = moved_count ? moved_count : 1, .index_type = nt_gltf_index_type(count, NT_GLTF_UBYTE)};
	s.value_offset = (s.element_count * nt_gltf_component_bytes(s.index_type) + 3) / 4 * 4;
	s.size = s.value_offset + s.element_count * element;
	s.sparse = s.size + SPARSE_JSON < count * s.stride;
	if (!s.sparse)
		s.size = count * s.stride;
	return s;
}

static void store_element(const float *delta, uint32_t type, unsigned char *bytes)
{
	const float most = most_of(type);
	for (size_t k = 0; k < 3; k++) {
		const int16_t value = (int16_t)lrintf(delta[k] * most);
		const int8_t small = (int8_t)value;
		if (type == NT_GLTF_FLOAT)
			memcpy(bytes + 4 * k, &delta[k], 4);
		else if (type == NT_GLTF_SHORT)
			memcpy(bytes + 2 * k, &value, 2);
		else
			memcpy(bytes + k, &small, 1);
	}
}

void nt_morph_store(const nt_morph_storage *s, const float *deltas, size_t count, unsigned char *bytes)
{
	const size_t element = 3 * nt_gltf_component_bytes(s->type);
	const uint32_t index_bytes = nt_gltf_component_bytes(s->index_type);
	size_t stored = 0;
	for (size_t v = 0; v < count; v++) {
		const float *delta = deltas + 3 * v;
		const uint32_t number = (uint32_t)v;
		if (!s->sparse) {
			store_element(delta, s->type, bytes + v * s->stride);
		} else if (delta[0] != 0 || delta[1] != 0 || delta[2] != 0) {
			nt_gltf_store_indices(&number, 1, index_bytes, bytes + stored * index_bytes);
			store_element(delta, s->type, bytes + s->value_offset + stored++ * element);
		}
	}
}
