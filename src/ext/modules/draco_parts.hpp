// SPDX-License-Identifier: MIT
//
// What encoding with Draco takes of decoding: names of types, values, and the decoder, by which what was encoded comes
// back.
#ifndef NT_EXT_MODULES_DRACO_PARTS_HPP
#define NT_EXT_MODULES_DRACO_PARTS_HPP

#include "ext/draco.h"

#include <vector>

#include <draco/mesh/mesh.h>

namespace nt {

// A mesh with its arrays.
struct draco_arrays : nt_draco {
	draco_arrays() : nt_draco() {}

	std::vector<uint32_t> indices;
	std::vector<nt_draco_attribute> attributes;
	std::vector<std::vector<unsigned char>> data; // of each attribute
};

// What Draco calls a component type of glTF; DT_INVALID: not one.
draco::DataType draco_type_of(int component_type);

draco::GeometryAttribute::Type draco_kind_of(nt_draco_kind kind);

// The values of an attribute, point by point, which must have one for each.
std::vector<unsigned char> copy_values(const draco::PointAttribute &attribute, size_t point_count);

// How the floats of an attribute were quantized, of which Draco has these integers. Bits 0: not at all.
nt_draco_quantization quantization_of(const draco::PointAttribute &portable);

// The floats that those integers stand for, point by point: Draco's arithmetic, with each step rounded.
std::vector<unsigned char> restore(const draco::PointAttribute &portable, const nt_draco_quantization &q,
	size_t point_count);

// Decodes a mesh of at most `face_limit` faces into plain arrays.
nt_status decode_draco(draco_arrays &result, const unsigned char *bytes, size_t size, size_t face_limit,
	nt_error *error);

// nt_draco_decode().
nt_status decode_guarded(nt_draco **result, const unsigned char *bytes, size_t size, size_t max_faces,
	nt_error *error);

} // namespace nt

#endif
