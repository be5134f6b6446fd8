// SPDX-License-Identifier: MIT
//
// What the files around Draco share: draco_decode.cpp decodes, draco_encode.cpp encodes, draco_compare.cpp tells
// whether what was encoded comes back, draco_quantize.cpp what quantization makes of values.
#ifndef NT_EXT_MODULES_DRACO_PARTS_HPP
#define NT_EXT_MODULES_DRACO_PARTS_HPP

#include "ext/draco.h"

#include <vector>

#include <draco/mesh/mesh.h>

struct nt_draco {
	nt_draco_mesh mesh = {};
	std::vector<uint32_t> indices;
	std::vector<nt_draco_attribute> attributes;
	std::vector<std::vector<unsigned char>> data; // of each attribute
};

namespace nt {

// ---- draco_decode.cpp ----

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
nt_status decode_draco(nt_draco &result, const unsigned char *bytes, size_t size, size_t face_limit,
	nt_error *error);

// nt_draco_decode() and nt_draco_free().
nt_status decode_checked(nt_draco **result, const unsigned char *bytes, size_t size, size_t max_faces,
	nt_error *error);
void free_decoded(nt_draco *result);

// ---- draco_encode.cpp ----

// nt_draco_encode().
nt_status encode_draco(const nt_draco_mesh *mesh, nt_draco_block *block, nt_error *error);

// Whether a mesh may go to Draco: see nt_draco_encode().
nt_status check_mesh(const nt_draco_mesh &mesh, nt_error *error);

// The points that faces use, in their order; receives their new numbers.
std::vector<uint32_t> compact(const nt_draco_mesh &mesh, std::vector<uint32_t> &numbers);

// An attribute with the values of these points.
void add_attribute(draco::Mesh &to, const nt_draco_attribute &a, const std::vector<uint32_t> &sources);

// ---- draco_compare.cpp ----

// What a decoder should return for an attribute, point by point: the values after quantization, as Draco itself
// computes it.
std::vector<unsigned char> expected_values(const draco::PointAttribute &attribute, const nt_draco_attribute &a,
	size_t point_count);

// What a decoder should return for a mesh: without points that no face uses, values as quantization leaves them.
// made: the mesh as the encoder gets it; numbers: of each point of `from` in it.
void expect_back(nt_draco &expected, const nt_draco_mesh &from, const draco::Mesh &made,
	const std::vector<uint32_t> &numbers);

// Whether it is what came back. Sorts attributes by their ids on both sides.
bool came_back(nt_draco &expected, nt_draco &decoded);

// ---- draco_quantize.cpp ----

// nt_draco_quantize().
nt_status quantize_draco(const nt_draco_mesh *mesh, float *const *values, nt_error *error);

// ---- attributes ----

// Draco encodes such normals by their direction.
inline bool is_octahedral(const nt_draco_attribute &a)
{
	return a.kind == NT_DRACO_NORMAL && a.components == 3;
}

inline size_t stride_of(const nt_draco_attribute &a)
{
	return a.stride_bytes ? a.stride_bytes
			      : nt_component_size(a.component_type) * static_cast<size_t>(a.components);
}

inline const unsigned char *value_of(const nt_draco_attribute &a, size_t point)
{
	const size_t owner = a.copied && point >= a.own_count ? a.copied[point - a.own_count] : point;
	return static_cast<const unsigned char *>(a.data) + stride_of(a) * owner;
}

} // namespace nt

#endif
