// SPDX-License-Identifier: MIT
//
// Whether what Draco encoded comes back. Expected are the values after quantization by Draco's own transforms, and what
// decoding makes of them. Sequential encoding keeps the order of points and faces, so that bytes are compared;
// edgebreaker reorders both and joins and splits points, so that a sum of hashes over faces stands for the set of them.
#include "ext/modules/draco_parts.hpp"

#include <algorithm>
#include <cstring>

#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>

namespace {

using nt::stride_of;
using nt::value_of;

// A number for a corner's values, the same for -0 and +0, which Draco may merge.
uint64_t hash_point(const nt_draco_mesh &mesh, uint32_t point)
{
	uint64_t hash = 0x9e3779b97f4a7c15;
	for (size_t i = 0; i < mesh.attribute_count; i++) {
		const nt_draco_attribute &a = mesh.attributes[i];
		const size_t size = nt_component_size(a.component_type);
		const unsigned char *at = value_of(a, point);
		for (int c = 0; c < a.components; c++, at += size) {
			uint32_t bits = 0;
			if (size == sizeof bits)
				std::memcpy(&bits, at, sizeof bits);
			else
				std::memcpy(&bits, at, size);
			if (a.component_type == NT_GLTF_FLOAT && bits == 0x80000000)
				bits = 0;
			hash = (hash ^ bits) * 0xff51afd7ed558ccd;
			hash ^= hash >> 32;
		}
	}
	return hash;
}

uint64_t mix(uint64_t hash)
{
	hash = (hash ^ hash >> 29) * 0xc4ceb9fe1a85ec53;
	return hash ^ hash >> 32;
}

// A number for a side that runs from one point to the other.
uint64_t hash_side(uint64_t from, uint64_t to)
{
	return mix(from * 0xff51afd7ed558ccd + to);
}

// A number for a set of faces, in any order, each beginning at any of its corners.
uint64_t hash_faces(const nt_draco_mesh &mesh)
{
	std::vector<uint64_t> points(mesh.point_count);
	for (size_t p = 0; p < points.size(); p++)
		points[p] = hash_point(mesh, static_cast<uint32_t>(p));
	uint64_t sum = 0;
	for (size_t f = 0; f < mesh.face_count; f++) {
		const uint32_t *face = mesh.indices + 3 * f;
		const uint64_t a = points[face[0]], b = points[face[1]], c = points[face[2]];
		sum += mix(hash_side(a, b) + hash_side(b, c) + hash_side(c, a));
	}
	return sum;
}

// Two corners at one point or one position.
bool is_degenerate(const nt_draco_attribute &positions, const uint32_t *face)
{
	const size_t width =
		nt_component_size(positions.component_type) * static_cast<size_t>(positions.components);
	bool equal = false;
	for (size_t k = 0; k < 3 && !equal; k++)
		equal = std::memcmp(value_of(positions, face[k]), value_of(positions, face[(k + 1) % 3]), width) == 0;
	return equal;
}

bool same_attributes(const nt_draco_mesh &a, const nt_draco_mesh &b)
{
	if (a.attribute_count != b.attribute_count)
		return false;
	for (size_t i = 0; i < a.attribute_count; i++)
		if (a.attributes[i].unique_id != b.attributes[i].unique_id ||
			a.attributes[i].component_type != b.attributes[i].component_type ||
			a.attributes[i].components != b.attributes[i].components)
			return false;
	return true;
}

// Attributes in the order of their ids: Draco groups them as it likes.
void sort_attributes(std::vector<nt_draco_attribute> &attributes)
{
	std::sort(attributes.begin(), attributes.end(),
		[](const nt_draco_attribute &a, const nt_draco_attribute &b) {
			return a.unique_id < b.unique_id;
		});
}

} // namespace

std::vector<unsigned char> nt::expected_values(const draco::PointAttribute &attribute,
	const nt_draco_attribute &a, size_t point_count)
{
	const nt_draco_quantization &q = a.quantization;
	if (!q.bits)
		return nt::copy_values(attribute, point_count);
	draco::AttributeOctahedronTransform octahedron;
	draco::AttributeQuantizationTransform box;
	draco::AttributeTransform *transform = &box;
	if (is_octahedral(a)) {
		octahedron.SetParameters(q.bits);
		transform = &octahedron;
	} else if (q.explicit_box) {
		box.SetParameters(q.bits, q.origin, a.components, q.range);
	} else {
		box.ComputeParameters(attribute, q.bits);
	}
	const auto portable =
		transform->InitTransformedAttribute(attribute, static_cast<int>(point_count));
	if (!transform->TransformAttribute(attribute, {}, portable.get()) ||
		!transform->TransferToAttribute(portable.get()))
		return {};
	return nt::restore(*portable, nt::quantization_of(*portable), point_count);
}

void nt::expect_back(nt_draco &expected, const nt_draco_mesh &from, const draco::Mesh &made,
	const std::vector<uint32_t> &numbers)
{
	const size_t point_count = made.num_points();
	for (size_t i = 0; i < from.attribute_count; i++) {
		nt_draco_attribute a = from.attributes[i];
		expected.data.push_back(
			expected_values(*made.attribute(static_cast<int>(i)), a, point_count));
		a.data = expected.data.back().data();
		a.stride_bytes = 0;
		a.copied = nullptr;
		expected.attributes.push_back(a);
	}
	const nt_draco_attribute *positions = from.attributes; // edgebreaker's input has them
	while (from.method == NT_DRACO_EDGEBREAKER && positions->kind != NT_DRACO_POSITION)
		positions++;
	expected.indices.reserve(3 * from.face_count);
	for (size_t f = 0; f < from.face_count; f++)
		if (from.method == NT_DRACO_SEQUENTIAL || !is_degenerate(*positions, from.indices + 3 * f))
			for (size_t k = 0; k < 3; k++)
				expected.indices.push_back(numbers[from.indices[3 * f + k]]);
	expected.mesh = {from.method, point_count, expected.indices.size() / 3, expected.indices.data(),
		expected.attributes.data(), expected.attributes.size(), from.speed};
}

bool nt::came_back(nt_draco &expected, nt_draco &decoded)
{
	sort_attributes(expected.attributes);
	sort_attributes(decoded.attributes);
	const nt_draco_mesh &a = expected.mesh, &b = decoded.mesh;
	if (a.face_count != b.face_count || !same_attributes(a, b))
		return false;
	if (a.method == NT_DRACO_EDGEBREAKER)
		return hash_faces(a) == hash_faces(b);
	if (a.point_count != b.point_count ||
		std::memcmp(a.indices, b.indices, 12 * a.face_count) != 0)
		return false;
	for (size_t i = 0; i < a.attribute_count; i++)
		if (std::memcmp(a.attributes[i].data, b.attributes[i].data,
			    stride_of(a.attributes[i]) * a.point_count) != 0)
			return false;
	return true;
}
