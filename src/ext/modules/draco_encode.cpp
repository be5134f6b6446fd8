// SPDX-License-Identifier: MIT
//
// Encoding with Draco. Refuses input that would kill the encoder (values that are not finite), take it beyond memory,
// or could not be decoded again (more than three points per face); and its result is decoded and compared with the
// input after quantization, since what it cannot keep it does not tell.
//
// Expected are the values after quantization by Draco's own transforms, and what decoding makes of them. Sequential
// encoding keeps the order of points and faces, so that bytes are compared; edgebreaker reorders both and joins and
// splits points, so that a sum of hashes over faces stands for the set of them.
#include "base/hash.h"
#include "ext/modules/draco_parts.hpp"
#include "ext/modules/guard.hpp"
#include "ext/tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>

#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/expert_encode.h>
#include <draco/core/draco_version.h>

namespace {

using draco::PointAttribute;

// ---- attributes ----

// Draco encodes such normals by their direction.
bool is_octahedral(const nt_draco_attribute &a)
{
	return a.kind == NT_DRACO_NORMAL && a.components == 3;
}

size_t stride_of(const nt_draco_attribute &a)
{
	return a.stride_bytes ? a.stride_bytes
			      : nt_component_size(a.component_type) * static_cast<size_t>(a.components);
}

const unsigned char *value_of(const nt_draco_attribute &a, size_t point)
{
	const size_t owner = a.copied && point >= a.own_count ? a.copied[point - a.own_count] : point;
	return static_cast<const unsigned char *>(a.data) + stride_of(a) * owner;
}

// ---- what Draco must not get ----

// Draco's entropy coder takes a table of four bytes for every number up to the largest it meets, whose sign costs a
// bit: 30 bits take 4 GB and half a minute for one triangle, 32 its life. 24 take 130 MB at most.
enum { MOST_BITS = 24 };

// Whether integers of four bytes are small enough for the entropy coder.
bool fits_coder(const nt_draco_mesh &mesh, const nt_draco_attribute &a)
{
	const int64_t limit = int64_t(1) << MOST_BITS;
	for (size_t p = 0; p < mesh.point_count; p++)
		for (int i = 0; i < a.components; i++) {
			uint32_t bits;
			std::memcpy(&bits, value_of(a, p) + 4 * i, sizeof bits);
			const int64_t value = a.component_type == NT_GLTF_INT ? int64_t(int32_t(bits)) : int64_t(bits);
			if (value > limit || value < -limit)
				return false;
		}
	return true;
}

// Whether Draco can lay its grid over the values: it counts cells by their range in float, so that a range beyond
// float, or so small that the cells in one unit are, gives integers out of nothing.
bool can_lay_grid(const nt_draco_mesh &mesh, const nt_draco_attribute &a)
{
	float range = a.quantization.explicit_box ? a.quantization.range : 0;
	for (int i = 0; i < a.components && !a.quantization.explicit_box; i++) {
		float least = std::numeric_limits<float>::max(), most = -least;
		for (size_t p = 0; p < mesh.point_count; p++) {
			float value;
			std::memcpy(&value, value_of(a, p) + 4 * i, sizeof value);
			least = std::min(least, value);
			most = std::max(most, value);
		}
		range = std::max(range, most - least);
	}
	const float cells = static_cast<float>((1u << a.quantization.bits) - 1);
	if (range == 0) // Draco takes 1 then, but leaves a given range alone
		return !a.quantization.explicit_box;
	return std::isfinite(range) && range > 0 && std::isfinite(cells / range);
}

nt_status check_attribute(const nt_draco_mesh &mesh, const nt_draco_attribute &a, nt_error *error)
{
	const nt_draco_quantization &q = a.quantization;
	const bool is_float = a.component_type == NT_GLTF_FLOAT;
	if (nt::draco_type_of(a.component_type) == draco::DT_INVALID || a.components < 1 || a.components > 4 ||
		q.bits < 0 || q.bits > MOST_BITS || (q.bits == 1 && is_octahedral(a)) || (q.bits && !is_float))
		return nt_fail(error, NT_ERROR_ARGUMENT,
			"Draco cannot encode attribute %u with type %d, %d components and %d bits",
			a.unique_id, a.component_type, a.components, q.bits);
	if ((a.component_type == NT_GLTF_INT || a.component_type == NT_GLTF_UINT) && !fits_coder(mesh, a))
		return nt_fail(error, NT_ERROR_ARGUMENT,
			"attribute %u has integers of more than %d bits, which Draco cannot encode in reasonable "
			"memory", a.unique_id, int(MOST_BITS));
	if (!q.bits)
		return NT_OK;
	const bool box = q.explicit_box && !is_octahedral(a);
	// quantized values at the upper end may have rounded past it
	const float slack = box ? q.range * 1e-5f : 0;
	for (size_t p = 0; p < mesh.point_count; p++)
		for (int i = 0; i < a.components; i++) {
			float value;
			std::memcpy(&value, value_of(a, p) + 4 * i, sizeof value);
			if (!std::isfinite(value) || (box && (value < q.origin[i] - slack ||
							     value > q.origin[i] + q.range + slack)))
				return nt_fail(error, NT_ERROR_ARGUMENT,
					"Draco cannot quantize value %g of point %zu in attribute %u",
					static_cast<double>(value), p, a.unique_id);
		}
	if (!is_octahedral(a) && !can_lay_grid(mesh, a))
		return nt_fail(error, NT_ERROR_ARGUMENT,
			"Draco cannot quantize attribute %u: its values span more than a float holds, or next to "
			"nothing", a.unique_id);
	return NT_OK;
}

// Edgebreaker's encoder takes every attribute but one for another kind, and reads what it never made where two are
// positions.
nt_status check_positions(const nt_draco_mesh &mesh, nt_error *error)
{
	const auto count = std::count_if(mesh.attributes, mesh.attributes + mesh.attribute_count,
		[](const nt_draco_attribute &a) { return a.kind == NT_DRACO_POSITION; });
	return mesh.method != NT_DRACO_EDGEBREAKER || count == 1 ? NT_OK : nt_fail(error, NT_ERROR_ARGUMENT,
		"Edgebreaker cannot encode %zu attributes of positions, expected one", static_cast<size_t>(count));
}

// Whether a mesh may go to Draco: see nt_draco_encode().
nt_status check_mesh(const nt_draco_mesh &mesh, nt_error *error)
{
	if (mesh.face_count > 0x7fffffff / 6 || mesh.point_count > 0x7fffffff)
		return nt_fail(error, NT_ERROR_TOO_LARGE, "%zu faces are too many for Draco",
			mesh.face_count);
	if (mesh.face_count == 0)
		return nt_fail(error, NT_ERROR_INPUT, "there is no face to encode");
	for (size_t i = 0; i < 3 * mesh.face_count; i++)
		if (mesh.indices[i] >= mesh.point_count)
			return nt_fail(error, NT_ERROR_INDEX, "face %zu refers to point %u of %zu", i / 3,
				mesh.indices[i], mesh.point_count);
	for (size_t i = 0; i < mesh.attribute_count; i++) {
		const nt_status status = check_attribute(mesh, mesh.attributes[i], error);
		if (status != NT_OK)
			return status;
	}
	return check_positions(mesh, error);
}

// ---- the mesh as Draco wants it ----

// The points that faces use, in their order; receives their new numbers.
std::vector<uint32_t> compact(const nt_draco_mesh &mesh, std::vector<uint32_t> &numbers)
{
	std::vector<uint32_t> sources;
	numbers.assign(mesh.point_count, 0);
	for (size_t i = 0; i < 3 * mesh.face_count; i++)
		numbers[mesh.indices[i]] = 1;
	for (size_t p = 0; p < mesh.point_count; p++)
		if (numbers[p]) {
			numbers[p] = static_cast<uint32_t>(sources.size());
			sources.push_back(static_cast<uint32_t>(p));
		}
	return sources;
}

// An attribute with the values of these points.
void add_attribute(draco::Mesh &to, const nt_draco_attribute &a, const std::vector<uint32_t> &sources)
{
	const size_t width = nt_component_size(a.component_type) * static_cast<size_t>(a.components);
	draco::GeometryAttribute layout;
	layout.Init(nt::draco_kind_of(a.kind), nullptr, static_cast<uint8_t>(a.components),
		nt::draco_type_of(a.component_type), a.normalized, static_cast<int64_t>(width), 0);
	const int id = to.AddAttribute(layout, true, static_cast<uint32_t>(sources.size()));
	draco::PointAttribute *attribute = to.attribute(id);
	attribute->set_unique_id(a.unique_id);
	unsigned char *values = attribute->buffer()->data();
	for (size_t p = 0; p < sources.size(); p++)
		std::memcpy(values + width * p, value_of(a, sources[p]), width);
}

std::unique_ptr<draco::Mesh> make_mesh(const nt_draco_mesh &mesh,
	const std::vector<uint32_t> &sources, const std::vector<uint32_t> &numbers)
{
	auto made = std::make_unique<draco::Mesh>();
	made->set_num_points(static_cast<uint32_t>(sources.size()));
	made->SetNumFaces(mesh.face_count);
	for (uint32_t f = 0; f < mesh.face_count; f++) {
		draco::Mesh::Face face;
		for (size_t k = 0; k < 3; k++)
			face[k] = draco::PointIndex(numbers[mesh.indices[3 * size_t(f) + k]]);
		made->SetFace(draco::FaceIndex(f), face);
	}
	for (size_t i = 0; i < mesh.attribute_count; i++)
		add_attribute(*made, mesh.attributes[i], sources);
	return made;
}

// Numbers things by their first equal, in the order in which they come. Half of the hash stands beside each number, so
// that hardly a thing is looked at that is not equal; slots are asked for some things ahead, since each is a cache
// miss.
class numbering {
public:
	enum { AHEAD = 16 };

	explicit numbering(size_t count)
	{
		size_t size = 16;
		while (size < 2 * count)
			size *= 2;
		slots.resize(size);
	}

	void prefetch(uint64_t hash) const { __builtin_prefetch(&slots[hash & (slots.size() - 1)]); }

	// The number of a thing; `next` where it is the first of its kind, which has that number then.
	template <typename Equal> uint32_t number(uint64_t hash, uint32_t next, Equal &&is_equal)
	{
		const uint32_t tag = static_cast<uint32_t>(hash >> 32);
		for (size_t at = hash & (slots.size() - 1);; at = (at + 1) & (slots.size() - 1)) {
			slot &s = slots[at];
			if (!s.used) {
				s = {tag, next + 1};
				return next;
			}
			if (s.tag == tag && is_equal(s.used - 1))
				return s.used - 1;
		}
	}

private:
	struct slot {
		uint32_t tag, used; // 0: not; else a number and 1
	};
	std::vector<slot> slots;
};

// Does the work of the attribute's DeduplicateValues(), whose tables take a third of the whole time: values that are
// equal bit for bit become one, in the order in which they come first. Each point has a value of its own before.
// Returns whether all differ.
bool join_values(PointAttribute &attribute, uint32_t count)
{
	const size_t width = static_cast<size_t>(attribute.byte_stride());
	unsigned char *values = attribute.buffer()->data();
	numbering numbers(count);
	std::vector<uint32_t> ids(count);
	uint64_t hashes[numbering::AHEAD] = {};
	uint32_t unique = 0;
	for (uint32_t p = 0; p < count + numbering::AHEAD; p++) {
		uint64_t &hash = hashes[p % numbering::AHEAD];
		if (p >= numbering::AHEAD) {
			const uint32_t here = p - numbering::AHEAD;
			const unsigned char *value = values + width * here;
			ids[here] = numbers.number(hash, unique, [&](uint32_t other) {
				return std::memcmp(values + width * other, value, width) == 0;
			});
			if (ids[here] == unique && unique++ != here)
				std::memcpy(values + width * ids[here], value, width);
		}
		if (p < count) {
			hash = nt_hash_bytes(0, values + width * p, width);
			numbers.prefetch(hash);
		}
	}
	if (unique == count)
		return true;
	attribute.SetExplicitMapping(count);
	for (uint32_t p = 0; p < count; p++)
		attribute.SetPointMapEntry(draco::PointIndex(p), draco::AttributeValueIndex(ids[p]));
	attribute.Resize(unique);
	return false;
}

// Whether no two points have the same values in all attributes, as most files have it. May say no where it is so.
bool points_differ(const draco::Mesh &mesh)
{
	numbering numbers(mesh.num_points());
	std::vector<uint64_t> hashes(mesh.num_points(), 0);
	for (int i = 0; i < mesh.num_attributes(); i++)
		for (uint32_t p = 0; p < mesh.num_points(); p++) {
			const uint32_t id = mesh.attribute(i)->mapped_index(draco::PointIndex(p)).value();
			hashes[p] = nt_hash_words(hashes[p], id);
		}
	for (uint32_t p = 0; p < mesh.num_points(); p++) {
		if (p + numbering::AHEAD < mesh.num_points())
			numbers.prefetch(hashes[p + numbering::AHEAD]);
		if (numbers.number(hashes[p], p, [&](uint32_t other) { return hashes[other] == hashes[p]; }) != p)
			return false;
	}
	return true;
}

// Joins what split vertices separate, so that one surface is encoded as one. Draco's own search for equal points takes
// long, and there is nothing to find where no two are equal.
void join_points(draco::Mesh &mesh)
{
	bool differ = false;
	for (int i = 0; i < mesh.num_attributes(); i++)
		differ |= join_values(*mesh.attribute(i), mesh.num_points());
	if (!differ && !points_differ(mesh))
		mesh.DeduplicatePointIds();
}

// Whether edgebreaker finds its edges in reasonable time: Draco looks for the other side of an edge among all sides
// that begin at a vertex, so that triangles repeated or gathered there cost their square. A surface has 36 for each
// vertex; the bound is a tenth of a second, and more for what is large.
bool edges_are_found_soon(const draco::Mesh &mesh)
{
	const PointAttribute *positions = mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
	std::vector<uint32_t> sides(positions->size(), 0);
	uint64_t looks = 0;
	for (draco::FaceIndex f(0); f < mesh.num_faces(); f++)
		for (int k = 0; k < 3; k++)
			looks += 2 * uint64_t{sides[positions->mapped_index(mesh.face(f)[k]).value()]++} + 1;
	return looks < (uint64_t{1} << 28) + 256 * static_cast<uint64_t>(3 * mesh.num_faces());
}

// ---- what a decoder will have ----

// Computes what a decoder should return for an attribute, point by point: the values after quantization, by Draco's
// own transforms.
std::vector<unsigned char> expected_values(const draco::PointAttribute &attribute,
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

// Computes what a decoder should return for a mesh: without points that no face uses, values as quantization leaves
// them. made: the mesh as the encoder gets it; numbers: of each point of `from` in it.
void expect_back(nt::draco_arrays &expected, const nt_draco_mesh &from, const draco::Mesh &made,
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

// ---- whether it came back ----

// A number for a corner's values.
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

// Whether it is what came back. Sorts attributes by their ids on both sides.
bool came_back(nt::draco_arrays &expected, nt::draco_arrays &decoded)
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

// ---- encoding ----

// A float as text that gives it back.
std::string exact_text(float value)
{
	char text[32];
	std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
	return text;
}

// Draco keeps options as text, and its own setters write six decimals: an explicit box set through them is not the
// one that was meant, and values move. So the texts are ours.
draco::Options box_options(const nt_draco_attribute &a)
{
	const nt_draco_quantization &q = a.quantization;
	draco::Options options;
	options.SetInt("quantization_bits", q.bits);
	if (!q.explicit_box || is_octahedral(a))
		return options;
	std::string origin;
	for (int i = 0; i < a.components; i++)
		origin += (i ? " " : "") + exact_text(q.origin[i]);
	options.SetString("quantization_origin", origin);
	options.SetString("quantization_range", exact_text(q.range));
	return options;
}

void set_options(draco::ExpertEncoder &encoder, const nt_draco_mesh &mesh)
{
	draco::EncoderOptions options = draco::EncoderOptions::CreateDefaultOptions();
	for (size_t i = 0; i < mesh.attribute_count; i++)
		if (mesh.attributes[i].quantization.bits)
			options.SetAttributeOptions(static_cast<int>(i), box_options(mesh.attributes[i]));
	encoder.Reset(options);
	encoder.SetEncodingMethod(mesh.method == NT_DRACO_SEQUENTIAL ? draco::MESH_SEQUENTIAL_ENCODING
								     : draco::MESH_EDGEBREAKER_ENCODING);
	encoder.SetSpeedOptions(mesh.speed, mesh.speed);
}

nt_status hand_over(const draco::EncoderBuffer &buffer, const nt_draco_mesh &mesh, const nt::draco_arrays &decoded,
	const std::vector<uint32_t> &sources, nt_draco_block *block, nt_error *error)
{
	block->bytes = static_cast<unsigned char *>(std::malloc(buffer.size()));
	block->bounds = static_cast<double(*)[2][4]>(std::calloc(mesh.attribute_count, sizeof *block->bounds));
	if (mesh.method == NT_DRACO_SEQUENTIAL)
		block->sources = static_cast<uint32_t *>(std::malloc(4 * sources.size()));
	if (!block->bytes || !block->bounds || (mesh.method == NT_DRACO_SEQUENTIAL && !block->sources)) {
		nt_draco_block_free(block);
		return nt_fail_memory(error);
	}
	std::memcpy(block->bytes, buffer.data(), buffer.size());
	if (block->sources)
		std::memcpy(block->sources, sources.data(), 4 * sources.size());
	for (size_t i = 0; i < mesh.attribute_count; i++)
		for (const nt_draco_attribute &a : decoded.attributes)
			if (a.unique_id == mesh.attributes[i].unique_id) {
				const auto width = static_cast<size_t>(a.components);
				nt_component_bounds(a.data, width * nt_component_size(a.component_type),
					decoded.mesh.point_count, a.component_type, width, block->bounds[i]);
			}
	block->size = buffer.size();
	block->point_count = decoded.mesh.point_count;
	block->face_count = decoded.mesh.face_count;
	return NT_OK;
}

nt_status encode(const nt_draco_mesh &mesh, nt_draco_block *block, nt_error *error)
{
	nt_status status = check_mesh(mesh, error);
	if (status != NT_OK)
		return status;
	std::vector<uint32_t> numbers;
	const std::vector<uint32_t> sources = compact(mesh, numbers);
	const auto made = make_mesh(mesh, sources, numbers);
	nt::draco_arrays expected;
	expect_back(expected, mesh, *made, numbers);
	if (expected.mesh.face_count == 0)
		return nt_fail(error, NT_ERROR_INPUT, "every face is degenerate: nothing to encode");
	if (mesh.method == NT_DRACO_EDGEBREAKER) {
		join_points(*made);
		if (!edges_are_found_soon(*made))
			return nt_fail(error, NT_ERROR_INPUT, "too many triangles at one vertex for edgebreaker");
	}

	draco::ExpertEncoder encoder(*made);
	set_options(encoder, mesh);
	draco::EncoderBuffer buffer;
	const draco::Status encoded = encoder.EncodeToBuffer(&buffer);
	if (!encoded.ok())
		return nt_fail(error, NT_ERROR_INTERNAL, "Draco cannot encode the mesh: %s",
			encoded.error_msg());

	nt::draco_arrays decoded;
	status = nt::decode_draco(decoded, reinterpret_cast<const unsigned char *>(buffer.data()), buffer.size(),
		mesh.face_count, error);
	if (status != NT_OK || !came_back(expected, decoded))
		return nt_fail(error, NT_ERROR_INTERNAL,
			"Draco does not decode its own block to the values that it encoded");
	return hand_over(buffer, mesh, decoded, sources, block, error);
}

// ---- quantization alone ----

nt_status quantize(const nt_draco_mesh &mesh, float *const *values, nt_error *error)
{
	const nt_status status = check_mesh(mesh, error);
	if (status != NT_OK)
		return status;
	std::vector<uint32_t> numbers;
	const std::vector<uint32_t> sources = compact(mesh, numbers);
	for (size_t i = 0; i < mesh.attribute_count; i++) {
		const nt_draco_attribute &a = mesh.attributes[i];
		if (!values[i])
			continue;
		draco::Mesh alone;
		alone.set_num_points(static_cast<uint32_t>(sources.size()));
		add_attribute(alone, a, sources);
		const auto back = expected_values(*alone.attribute(0), a, sources.size());
		if (back.empty())
			return nt_fail(error, NT_ERROR_INTERNAL, "Draco cannot quantize attribute %u", a.unique_id);
		const size_t components = static_cast<size_t>(a.components), width = sizeof(float) * components;
		for (size_t p = 0; p < mesh.point_count && sources.size() < mesh.point_count; p++)
			std::memmove(values[i] + components * p, value_of(a, p), width);
		for (size_t p = 0; p < sources.size(); p++)
			std::memcpy(values[i] + components * sources[p], back.data() + width * p, width);
	}
	return NT_OK;
}

// ---- the table ----

nt_status encode_guarded(const nt_draco_mesh *mesh, nt_draco_block *block, nt_error *error)
{
	const nt_status status = nt::guard(error, "Draco", [&] { return encode(*mesh, block, error); });
	if (status != NT_OK)
		nt_draco_block_free(block);
	return status;
}

nt_status quantize_guarded(const nt_draco_mesh *mesh, float *const *values, nt_error *error)
{
	return nt::guard(error, "Draco", [&] { return quantize(*mesh, values, error); });
}

} // namespace

const nt_draco_table nt_draco_module = {NT_MODULE_HEAD(nt_draco_table, "Draco", draco::kDracoVersion,
	"Apache-2.0", &nt::cxx), nt::decode_guarded, encode_guarded, quantize_guarded};
