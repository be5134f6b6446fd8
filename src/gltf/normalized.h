/* SPDX-License-Identifier: MIT */
/*
 * One component of an accessor as a float: what it says, or in [0, 1] or [-1, 1] what a normalised integer means
 * (glTF 2.0, section 3.6.2.2; the lowest of a signed type means -1 as its neighbour does).
 */
#ifndef NT_GLTF_NORMALIZED_H
#define NT_GLTF_NORMALIZED_H

#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include "ext/gltf_numbers.h"

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

#endif
