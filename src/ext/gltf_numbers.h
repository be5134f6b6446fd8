/* SPDX-License-Identifier: MIT */
/*
 * Numbers of the glTF specification, for the wrappers in ext and for src/gltf.
 */
#ifndef NT_EXT_GLTF_NUMBERS_H
#define NT_EXT_GLTF_NUMBERS_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Values of componentType. */
enum nt_gltf_component {
	NT_GLTF_BYTE = 5120,
	NT_GLTF_UBYTE = 5121,
	NT_GLTF_SHORT = 5122,
	NT_GLTF_USHORT = 5123,
	NT_GLTF_INT = 5124, /* not in glTF, but in Draco */
	NT_GLTF_UINT = 5125,
	NT_GLTF_FLOAT = 5126
};

/* Bytes of a component; 0: not a component type. */
static inline unsigned nt_component_size(int component_type)
{
	switch (component_type) {
	case NT_GLTF_BYTE:
	case NT_GLTF_UBYTE:
		return 1;
	case NT_GLTF_SHORT:
	case NT_GLTF_USHORT:
		return 2;
	case NT_GLTF_INT:
	case NT_GLTF_UINT:
	case NT_GLTF_FLOAT:
		return 4;
	default:
		return 0;
	}
}

/* A component as it is stored, normalized or not. bytes: without alignment. */
static inline double nt_component_number(const unsigned char *bytes, int component_type)
{
	int16_t i16;
	uint16_t u16;
	int32_t i32;
	uint32_t u32;
	float f32;
	switch (component_type) {
	case NT_GLTF_BYTE:
		return (int8_t)bytes[0];
	case NT_GLTF_UBYTE:
		return bytes[0];
	case NT_GLTF_SHORT:
		memcpy(&i16, bytes, sizeof i16);
		return i16;
	case NT_GLTF_USHORT:
		memcpy(&u16, bytes, sizeof u16);
		return u16;
	case NT_GLTF_INT:
		memcpy(&i32, bytes, sizeof i32);
		return i32;
	case NT_GLTF_UINT:
		memcpy(&u32, bytes, sizeof u32);
		return u32;
	default:
		memcpy(&f32, bytes, sizeof f32);
		return (double)f32;
	}
}

/* Least and most of each component of elements, `stride` bytes apart, of 4 components or less: what an accessor's min
 * and max say. NaN is neither; without any other value the least is above the most. */
static inline void nt_component_bounds(const void *elements, size_t stride, size_t count, int component_type,
	size_t components, double bounds[2][4])
{
	const size_t size = nt_component_size(component_type);
	for (size_t k = 0; k < components; k++) {
		bounds[0][k] = (double)INFINITY;
		bounds[1][k] = -(double)INFINITY;
	}
	for (size_t i = 0; i < count; i++)
		for (size_t k = 0; k < components; k++) {
			const double value = nt_component_number(
				(const unsigned char *)elements + i * stride + k * size, component_type);
			bounds[0][k] = value < bounds[0][k] ? value : bounds[0][k];
			bounds[1][k] = value > bounds[1][k] ? value : bounds[1][k];
		}
}

/* Values of a view's target. */
enum nt_gltf_target {
	NT_GLTF_NO_TARGET = 0,
	NT_GLTF_ARRAY_BUFFER = 34962,
	NT_GLTF_ELEMENT_ARRAY_BUFFER = 34963
};

/* Values of a sampler's wrapS and wrapT that are not the default. */
enum nt_gltf_wrap { NT_GLTF_CLAMP_TO_EDGE = 33071, NT_GLTF_MIRRORED_REPEAT = 33648 };

/* Values of a primitive's mode that have faces. */
enum nt_gltf_mode { NT_GLTF_POINTS = 0, NT_GLTF_TRIANGLES = 4, NT_GLTF_STRIP = 5, NT_GLTF_FAN = 6 };

#endif
