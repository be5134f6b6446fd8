// SPDX-License-Identifier: MIT
//
// Draco behind a C header, kept at the door: of 9 900 mutated files 508 decoded "ok" with indices out of
// range, and memory reached 5.2 GB. So the number of faces is read from the stream's head and judged before
// Draco sees it, and what it returns is copied into plain arrays with every index and every mapping checked.
//
// Who wants to encode again needs to know how values were quantized (origin, range, bits), so that they do not
// move. Draco tells this only when it leaves attributes as integers, whose own type is lost then: so that takes
// a second decoding.
// Encoding checks what would kill the encoder (values that are not finite) or could not be decoded again (more
// than three points per face), and decodes its result to compare it with the input after quantization.
#include "ext/draco.h"
#include "ext/guard.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

struct nt_draco {
	nt_draco_mesh mesh = {};
	std::vector<uint32_t> indices;
	std::vector<nt_draco_attribute> attributes;
	std::vector<std::vector<unsigned char>> data; // of each attribute
};

namespace {

using draco::AttributeValueIndex;
using draco::PointAttribute;
using draco::PointIndex;

const char library[] = "Draco";

struct component_row {
	int type; // glTF's number
	draco::DataType draco_type;
	size_t size;
};

const component_row component_table[] = {
	{5120, draco::DT_INT8, 1},   {5121, draco::DT_UINT8, 1},  {5122, draco::DT_INT16, 2},
	{5123, draco::DT_UINT16, 2}, {5124, draco::DT_INT32, 4},  {5125, draco::DT_UINT32, 4},
	{5126, draco::DT_FLOAT32, 4},
};

const component_row *row_of_type(int type)
{
	for (const component_row &row : component_table)
		if (row.type == type)
			return &row;
	return nullptr;
}

const component_row *row_of_draco(draco::DataType type)
{
	for (const component_row &row : component_table)
		if (row.draco_type == type)
			return &row;
	return nullptr;
}

// ---- the stream's head ----

// Reads the head of a stream as far as the number of faces (Draco bitstream specification, "Header", "Metadata"
// and "Connectivity").
struct head_reader {
	const unsigned char *at, *end;
	bool failed = false;
	unsigned version = 0; // 0x0202 for 2.2

	uint64_t fixed(int bytes)
	{
		if (end - at < bytes) {
			failed = true;
			return 0;
		}
		uint64_t value = 0;
		for (int i = 0; i < bytes; i++)
			value |= static_cast<uint64_t>(*at++) << (8 * i);
		return value;
	}

	uint64_t variable()
	{
		uint64_t value = 0;
		for (int shift = 0; shift < 35; shift += 7) {
			const uint64_t byte = fixed(1);
			value |= (byte & 0x7f) << shift;
			if (!(byte & 0x80))
				return value;
		}
		failed = true;
		return 0;
	}

	// What was a fixed number in streams before `since` is a variable one from then on.
	uint64_t number(unsigned since) { return version < since ? fixed(4) : variable(); }

	void skip(uint64_t bytes)
	{
		if (static_cast<uint64_t>(end - at) < bytes)
			failed = true;
		else
			at += bytes;
	}

	void skip_metadata(int depth)
	{
		if (depth > 100)
			failed = true;
		const uint64_t entries = variable();
		for (uint64_t i = 0; i < entries && !failed; i++) {
			skip(fixed(1));
			skip(variable());
		}
		const uint64_t children = variable();
		for (uint64_t i = 0; i < children && !failed; i++) {
			skip(fixed(1));
			skip_metadata(depth + 1);
		}
	}

	void skip_all_metadata()
	{
		const uint64_t attributes = variable();
		for (uint64_t i = 0; i < attributes && !failed; i++) {
			variable();
			skip_metadata(0);
		}
		skip_metadata(0);
	}
};

struct stream_head {
	bool is_mesh;
	nt_draco_method method;
	uint64_t faces, points; // points: what the head says, edgebreaker adds some
};

// False: this is not the beginning of a Draco stream.
bool read_head(const unsigned char *bytes, size_t size, stream_head *head)
{
	if (size < 11 || std::memcmp(bytes, "DRACO", 5) != 0)
		return false;
	head_reader reader = {bytes + 5, bytes + size};
	reader.version = static_cast<unsigned>(reader.fixed(1)) << 8;
	reader.version |= static_cast<unsigned>(reader.fixed(1));
	head->is_mesh = reader.fixed(1) == 1;
	const uint64_t method = reader.fixed(1);
	head->method = method == 1 ? NT_DRACO_EDGEBREAKER : NT_DRACO_SEQUENTIAL;
	const uint64_t flags = reader.fixed(2);
	if (!head->is_mesh)
		return true;
	if (reader.version >= 0x0103 && (flags & 0x8000))
		reader.skip_all_metadata();
	if (method == 1) {
		reader.fixed(1); // kind of traversal
		if (reader.version < 0x0202)
			reader.number(0x0200); // new vertices
		head->points = reader.number(0x0200);
		head->faces = reader.number(0x0200);
	} else {
		head->faces = reader.number(0x0202);
		head->points = reader.number(0x0202);
	}
	return !reader.failed && method <= 1;
}

// The best ratios come from large flat grids, some dozens of faces per byte.
size_t plausible_faces(size_t size)
{
	const size_t base = 1u << 20, per_byte = 256, most = 0x7fffffff / 6;
	return size > (most - base) / per_byte ? most : base + per_byte * size;
}

// ---- decoding ----

// `offset`: how far the decoder came.
nmtan_status damaged(nt_error *error, size_t offset, const char *what)
{
	return nt_fail_offset(error, NMTAN_ERROR_INPUT, offset, "damaged Draco data: %s", what);
}

nt_draco_kind kind_of(const PointAttribute &attribute)
{
	switch (attribute.attribute_type()) {
	case draco::GeometryAttribute::POSITION:
		return NT_DRACO_POSITION;
	case draco::GeometryAttribute::NORMAL:
		return NT_DRACO_NORMAL;
	case draco::GeometryAttribute::COLOR:
		return NT_DRACO_COLOR;
	case draco::GeometryAttribute::TEX_COORD:
		return NT_DRACO_TEXCOORD;
	default:
		return NT_DRACO_GENERIC;
	}
}

// How the floats of an attribute had been quantized, from what Draco left as integers. Bits 0: not at all.
nt_draco_quantization quantization_of(const PointAttribute &portable)
{
	nt_draco_quantization result = {};
	const draco::AttributeTransformData *data = portable.GetAttributeTransformData();
	draco::AttributeOctahedronTransform octahedron;
	draco::AttributeQuantizationTransform box;
	if (!data)
		return result;
	if (data->transform_type() == draco::ATTRIBUTE_OCTAHEDRON_TRANSFORM &&
		octahedron.InitFromAttribute(portable)) {
		result.bits = octahedron.quantization_bits();
		result.octahedral = true;
	} else if (data->transform_type() == draco::ATTRIBUTE_QUANTIZATION_TRANSFORM &&
		portable.num_components() <= 4 && box.InitFromAttribute(portable)) {
		result.bits = box.quantization_bits();
		result.explicit_box = true;
		result.range = box.range();
		for (int i = 0; i < portable.num_components(); i++)
			result.origin[i] = box.min_value(i);
	}
	return result;
}

// Whether every point maps to a value that is inside of the attribute's buffer.
bool is_sound(const PointAttribute &attribute, size_t point_count)
{
	const size_t width = static_cast<size_t>(draco::DataTypeLength(attribute.data_type())) *
		static_cast<size_t>(attribute.num_components());
	if (!attribute.buffer() || attribute.byte_offset() != 0 ||
		attribute.byte_stride() != static_cast<int64_t>(width) ||
		attribute.size() > attribute.buffer()->data_size() / width)
		return false;
	if (attribute.is_mapping_identity())
		return attribute.size() >= point_count;
	if (attribute.indices_map_size() < point_count)
		return false;
	for (uint32_t p = 0; p < point_count; p++)
		if (attribute.mapped_index(PointIndex(p)).value() >= attribute.size())
			return false;
	return true;
}

std::vector<unsigned char> copy_values(const PointAttribute &attribute, size_t point_count)
{
	const size_t width = static_cast<size_t>(attribute.byte_stride());
	std::vector<unsigned char> values(width * point_count);
	if (attribute.is_mapping_identity()) {
		if (point_count)
			std::memcpy(values.data(), attribute.GetAddress(AttributeValueIndex(0)), values.size());
		return values;
	}
	for (uint32_t p = 0; p < point_count; p++)
		std::memcpy(values.data() + width * p, attribute.GetAddressOfMappedIndex(PointIndex(p)), width);
	return values;
}

nmtan_status take_attribute(nt_draco &result, const PointAttribute &decoded, nt_error *error)
{
	const size_t point_count = result.mesh.point_count;
	nt_draco_attribute attribute = {};
	attribute.unique_id = decoded.unique_id();
	attribute.kind = kind_of(decoded);
	const component_row *row = row_of_draco(decoded.data_type());
	if (!row || decoded.num_components() < 1 || decoded.num_components() > 4)
		return nt_fail(error, NMTAN_ERROR_UNSUPPORTED,
			"Draco attribute %u has a type that glTF cannot have (type %d, %d components)",
			decoded.unique_id(), static_cast<int>(decoded.data_type()),
			static_cast<int>(decoded.num_components()));
	if (!is_sound(decoded, point_count))
		return nt_fail(error, NMTAN_ERROR_INPUT,
			"damaged Draco data: attribute %u has fewer values than its points refer to",
			decoded.unique_id());
	attribute.component_type = row->type;
	attribute.components = decoded.num_components();
	attribute.normalized = decoded.normalized();
	result.data.push_back(copy_values(decoded, point_count));
	attribute.data = result.data.back().data();
	result.attributes.push_back(attribute);
	return NMTAN_OK;
}

nmtan_status take_mesh(nt_draco &result, const draco::Mesh &mesh, nt_error *error)
{
	result.mesh.face_count = mesh.num_faces();
	result.mesh.point_count = mesh.num_points();
	result.indices.reserve(3 * result.mesh.face_count);
	for (uint32_t f = 0; f < mesh.num_faces(); f++)
		for (const PointIndex &corner : mesh.face(draco::FaceIndex(f))) {
			if (corner.value() >= mesh.num_points())
				return nt_fail(error, NMTAN_ERROR_INPUT,
					"damaged Draco data: face %u refers to point %u of %u", f,
					corner.value(), mesh.num_points());
			result.indices.push_back(corner.value());
		}
	for (int i = 0; i < mesh.num_attributes(); i++) {
		const nmtan_status status = take_attribute(result, *mesh.attribute(i), error);
		if (status != NMTAN_OK)
			return status;
	}
	result.mesh.indices = result.indices.data();
	result.mesh.attributes = result.attributes.data();
	result.mesh.attribute_count = result.attributes.size();
	return NMTAN_OK;
}

// Whether the stream's head is that of a mesh of at most `limit` faces.
nmtan_status judge_head(const unsigned char *bytes, size_t size, size_t limit, stream_head *head,
	nt_error *error)
{
	if (!read_head(bytes, size, head))
		return nt_fail_offset(error, NMTAN_ERROR_INPUT, 0, "not Draco data, or its head is cut off");
	if (!head->is_mesh)
		return nt_fail_offset(error, NMTAN_ERROR_UNSUPPORTED, 0,
			"Draco point cloud: it has no faces, expected a mesh");
	if (head->faces > limit || head->points > 3 * static_cast<uint64_t>(limit))
		return nt_fail_offset(error, NMTAN_ERROR_TOO_LARGE, 0,
			"Draco data of %zu bytes declares %llu faces and %llu points, at most %zu faces are "
			"expected", size, static_cast<unsigned long long>(head->faces),
			static_cast<unsigned long long>(head->points), limit);
	return NMTAN_OK;
}

draco::StatusOr<std::unique_ptr<draco::Mesh>> run_decoder(const unsigned char *bytes, size_t size,
	bool leave_integers, size_t *reached)
{
	draco::Decoder decoder;
	for (int type = 0; leave_integers && type < draco::GeometryAttribute::NAMED_ATTRIBUTES_COUNT; type++)
		decoder.SetSkipAttributeTransform(static_cast<draco::GeometryAttribute::Type>(type));
	draco::DecoderBuffer buffer;
	buffer.Init(reinterpret_cast<const char *>(bytes), size);
	auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
	*reached = static_cast<size_t>(buffer.decoded_size());
	return decoded;
}

nmtan_status decode(nt_draco &result, const unsigned char *bytes, size_t size, size_t limit,
	nt_error *error)
{
	stream_head head = {};
	const nmtan_status status = judge_head(bytes, size, limit, &head, error);
	if (status != NMTAN_OK)
		return status;
	size_t reached = 0;
	const auto decoded = run_decoder(bytes, size, false, &reached);
	if (!decoded.ok())
		return damaged(error, reached, decoded.status().error_msg());
	result.mesh.method = head.method;
	return take_mesh(result, *decoded.value(), error);
}

// The second decoding, for the parameters alone.
nmtan_status add_quantization(nt_draco &result, const unsigned char *bytes, size_t size,
	nt_error *error)
{
	size_t reached = 0;
	const auto decoded = run_decoder(bytes, size, true, &reached);
	if (!decoded.ok() || decoded.value()->num_attributes() != static_cast<int>(result.attributes.size()))
		return damaged(error, reached, "it does not decode twice");
	for (size_t i = 0; i < result.attributes.size(); i++)
		result.attributes[i].quantization =
			quantization_of(*decoded.value()->attribute(static_cast<int>(i)));
	return NMTAN_OK;
}

// ---- encoding ----

bool is_octahedral(const nt_draco_attribute &a)
{
	return a.kind == NT_DRACO_NORMAL && a.components == 3;
}

size_t stride_of(const nt_draco_attribute &a)
{
	return a.stride_bytes ? a.stride_bytes
			      : nt_draco_component_size(a.component_type) * static_cast<size_t>(a.components);
}

const unsigned char *value_of(const nt_draco_attribute &a, size_t point)
{
	return static_cast<const unsigned char *>(a.data) + stride_of(a) * point;
}

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
			const int64_t value = a.component_type == 5124 ? int64_t(int32_t(bits)) : int64_t(bits);
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

nmtan_status check_attribute(const nt_draco_mesh &mesh, const nt_draco_attribute &a, nt_error *error)
{
	const nt_draco_quantization &q = a.quantization;
	if (!row_of_type(a.component_type) || a.components < 1 || a.components > 4 || q.bits < 0 ||
		q.bits > MOST_BITS || (q.bits == 1 && is_octahedral(a)) || (q.bits && a.component_type != 5126))
		return nt_fail(error, NMTAN_ERROR_ARGUMENT,
			"Draco cannot encode attribute %u with type %d, %d components and %d bits",
			a.unique_id, a.component_type, a.components, q.bits);
	if ((a.component_type == 5124 || a.component_type == 5125) && !fits_coder(mesh, a))
		return nt_fail(error, NMTAN_ERROR_ARGUMENT,
			"attribute %u has integers of more than %d bits, which Draco cannot encode in reasonable "
			"memory", a.unique_id, int(MOST_BITS));
	if (!q.bits)
		return NMTAN_OK;
	const bool box = q.explicit_box && !is_octahedral(a);
	// quantized values at the upper end may have rounded past it
	const float slack = box ? q.range * 1e-5f : 0;
	for (size_t p = 0; p < mesh.point_count; p++)
		for (int i = 0; i < a.components; i++) {
			float value;
			std::memcpy(&value, value_of(a, p) + 4 * i, sizeof value);
			if (!std::isfinite(value) || (box && (value < q.origin[i] - slack ||
							     value > q.origin[i] + q.range + slack)))
				return nt_fail(error, NMTAN_ERROR_ARGUMENT,
					"Draco cannot quantize value %g of point %zu in attribute %u",
					static_cast<double>(value), p, a.unique_id);
		}
	if (!is_octahedral(a) && !can_lay_grid(mesh, a))
		return nt_fail(error, NMTAN_ERROR_ARGUMENT,
			"Draco cannot quantize attribute %u: its values span more than a float holds, or next to "
			"nothing", a.unique_id);
	return NMTAN_OK;
}

nmtan_status check_mesh(const nt_draco_mesh &mesh, nt_error *error)
{
	if (mesh.face_count > 0x7fffffff / 6 || mesh.point_count > 0x7fffffff)
		return nt_fail(error, NMTAN_ERROR_TOO_LARGE, "%zu faces are too many for Draco",
			mesh.face_count);
	if (mesh.face_count == 0)
		return nt_fail(error, NMTAN_ERROR_INPUT, "there is no face to encode");
	for (size_t i = 0; i < 3 * mesh.face_count; i++)
		if (mesh.indices[i] >= mesh.point_count)
			return nt_fail(error, NMTAN_ERROR_INDEX, "face %zu refers to point %u of %zu", i / 3,
				mesh.indices[i], mesh.point_count);
	for (size_t i = 0; i < mesh.attribute_count; i++) {
		const nmtan_status status = check_attribute(mesh, mesh.attributes[i], error);
		if (status != NMTAN_OK)
			return status;
	}
	return NMTAN_OK;
}

// The points that faces use, in their order, and their new numbers.
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

draco::GeometryAttribute::Type type_of(nt_draco_kind kind)
{
	switch (kind) {
	case NT_DRACO_POSITION:
		return draco::GeometryAttribute::POSITION;
	case NT_DRACO_NORMAL:
		return draco::GeometryAttribute::NORMAL;
	case NT_DRACO_COLOR:
		return draco::GeometryAttribute::COLOR;
	case NT_DRACO_TEXCOORD:
		return draco::GeometryAttribute::TEX_COORD;
	default:
		return draco::GeometryAttribute::GENERIC;
	}
}

void add_attribute(draco::Mesh &to, const nt_draco_attribute &a, const std::vector<uint32_t> &sources)
{
	const component_row *row = row_of_type(a.component_type);
	draco::GeometryAttribute layout;
	layout.Init(type_of(a.kind), nullptr, static_cast<uint8_t>(a.components), row->draco_type,
		a.normalized, static_cast<int64_t>(row->size) * a.components, 0);
	const int id = to.AddAttribute(layout, true, static_cast<uint32_t>(sources.size()));
	PointAttribute *attribute = to.attribute(id);
	attribute->set_unique_id(a.unique_id);
	for (size_t p = 0; p < sources.size(); p++)
		attribute->SetAttributeValue(AttributeValueIndex(static_cast<uint32_t>(p)),
			value_of(a, sources[p]));
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
			face[k] = PointIndex(numbers[mesh.indices[3 * size_t(f) + k]]);
		made->SetFace(draco::FaceIndex(f), face);
	}
	for (size_t i = 0; i < mesh.attribute_count; i++)
		add_attribute(*made, mesh.attributes[i], sources);
	return made;
}

// Undoes an attribute's transform, as a decoder would.
std::vector<unsigned char> restore(const PointAttribute &portable,
	draco::AttributeTransform &transform, const nt_draco_attribute &a, size_t point_count)
{
	PointAttribute result;
	result.Init(type_of(a.kind), static_cast<int8_t>(a.components), draco::DT_FLOAT32, false,
		point_count);
	return transform.InverseTransformAttribute(portable, &result) ? copy_values(result, point_count)
								      : std::vector<unsigned char>();
}

// What a decoder should return for an attribute, point by point: the values after quantization, as Draco
// itself computes it.
std::vector<unsigned char> expected_values(const PointAttribute &attribute,
	const nt_draco_attribute &a, size_t point_count)
{
	const nt_draco_quantization &q = a.quantization;
	if (!q.bits)
		return copy_values(attribute, point_count);
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
	if (!transform->TransformAttribute(attribute, {}, portable.get()))
		return {};
	return restore(*portable, *transform, a, point_count);
}

// A number for a corner's values, the same for -0 and +0, which Draco may merge.
uint64_t hash_point(const nt_draco_mesh &mesh, uint32_t point)
{
	uint64_t hash = 0x9e3779b97f4a7c15;
	for (size_t i = 0; i < mesh.attribute_count; i++) {
		const nt_draco_attribute &a = mesh.attributes[i];
		const size_t size = nt_draco_component_size(a.component_type);
		for (int c = 0; c < a.components; c++) {
			uint32_t bits = 0;
			std::memcpy(&bits, value_of(a, point) + size * static_cast<size_t>(c), size);
			if (a.component_type == 5126 && bits == 0x80000000)
				bits = 0;
			hash = (hash ^ bits) * 0xff51afd7ed558ccd;
			hash ^= hash >> 32;
		}
	}
	return hash;
}

// A number for a set of faces, in any order, each beginning at any of its corners.
uint64_t hash_faces(const nt_draco_mesh &mesh)
{
	std::vector<uint64_t> points(mesh.point_count);
	for (size_t p = 0; p < points.size(); p++)
		points[p] = hash_point(mesh, static_cast<uint32_t>(p));
	uint64_t sum = 0;
	for (size_t f = 0; f < mesh.face_count; f++) {
		uint64_t best = ~uint64_t(0);
		for (size_t k = 0; k < 3; k++) {
			uint64_t hash = 0;
			for (size_t i = 0; i < 3; i++) {
				hash = (hash ^ points[mesh.indices[3 * f + (k + i) % 3]]) * 0xc4ceb9fe1a85ec53;
				hash ^= hash >> 29;
			}
			best = std::min(best, hash);
		}
		sum += best;
	}
	return sum;
}

// What should come back: the compacted mesh with expected values.
struct expectation {
	nt_draco_mesh mesh = {};
	std::vector<uint32_t> indices;
	std::vector<nt_draco_attribute> attributes;
	std::vector<std::vector<unsigned char>> data;

	expectation(const nt_draco_mesh &from, const draco::Mesh &made,
		const std::vector<uint32_t> &numbers, size_t point_count)
	{
		for (size_t i = 0; i < from.attribute_count; i++) {
			nt_draco_attribute a = from.attributes[i];
			data.push_back(expected_values(*made.attribute(static_cast<int>(i)), a, point_count));
			a.data = data.back().data();
			a.stride_bytes = 0;
			attributes.push_back(a);
		}
		const bool drop = from.method == NT_DRACO_EDGEBREAKER;
		for (size_t f = 0; f < from.face_count; f++)
			if (!drop || !is_degenerate(from, from.indices + 3 * f))
				for (size_t k = 0; k < 3; k++)
					indices.push_back(numbers[from.indices[3 * f + k]]);
		mesh = {from.method, point_count, indices.size() / 3, indices.data(), attributes.data(),
			attributes.size()};
	}

	// Two corners at one point or one position.
	static bool is_degenerate(const nt_draco_mesh &mesh, const uint32_t *face)
	{
		bool equal = face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
		for (size_t i = 0; i < mesh.attribute_count && !equal; i++) {
			const nt_draco_attribute &a = mesh.attributes[i];
			if (a.kind != NT_DRACO_POSITION)
				continue;
			const size_t width = nt_draco_component_size(a.component_type) *
				static_cast<size_t>(a.components);
			for (size_t k = 0; k < 3; k++)
				equal |= std::memcmp(value_of(a, face[k]), value_of(a, face[(k + 1) % 3]),
						 width) == 0;
			break;
		}
		return equal;
	}
};

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

bool came_back(expectation &expected, nt_draco &decoded)
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
	encoder.SetSpeedOptions(5, 5);
}

nmtan_status hand_over(const draco::EncoderBuffer &buffer, const nt_draco &decoded,
	const std::vector<uint32_t> &sources, nt_draco_block *block, nt_error *error)
{
	block->bytes = static_cast<unsigned char *>(std::malloc(buffer.size()));
	if (decoded.mesh.method == NT_DRACO_SEQUENTIAL)
		block->sources = static_cast<uint32_t *>(std::malloc(4 * sources.size()));
	if (!block->bytes || (decoded.mesh.method == NT_DRACO_SEQUENTIAL && !block->sources)) {
		nt_draco_block_free(block);
		return nt_fail_memory(error);
	}
	std::memcpy(block->bytes, buffer.data(), buffer.size());
	if (block->sources)
		std::memcpy(block->sources, sources.data(), 4 * sources.size());
	block->size = buffer.size();
	block->point_count = decoded.mesh.point_count;
	block->face_count = decoded.mesh.face_count;
	return NMTAN_OK;
}

nmtan_status encode(const nt_draco_mesh &mesh, nt_draco_block *block, nt_error *error)
{
	nmtan_status status = check_mesh(mesh, error);
	if (status != NMTAN_OK)
		return status;
	std::vector<uint32_t> numbers;
	const std::vector<uint32_t> sources = compact(mesh, numbers);
	const auto made = make_mesh(mesh, sources, numbers);
	expectation expected(mesh, *made, numbers, sources.size());
	if (expected.mesh.face_count == 0)
		return nt_fail(error, NMTAN_ERROR_INPUT, "every face is degenerate: nothing to encode");
	if (mesh.method == NT_DRACO_EDGEBREAKER) {
		// joins what split vertices separate, so that one surface is encoded as one
		made->DeduplicateAttributeValues();
		made->DeduplicatePointIds();
	}

	draco::ExpertEncoder encoder(*made);
	set_options(encoder, mesh);
	draco::EncoderBuffer buffer;
	const draco::Status encoded = encoder.EncodeToBuffer(&buffer);
	if (!encoded.ok())
		return nt_fail(error, NMTAN_ERROR_INTERNAL, "Draco cannot encode the mesh: %s",
			encoded.error_msg());

	nt_draco decoded;
	status = decode(decoded, reinterpret_cast<const unsigned char *>(buffer.data()), buffer.size(),
		mesh.face_count, error);
	if (status != NMTAN_OK || !came_back(expected, decoded))
		return nt_fail(error, NMTAN_ERROR_INTERNAL,
			"what Draco encoded does not decode to what it was given");
	return hand_over(buffer, decoded, sources, block, error);
}

} // namespace

size_t nt_draco_component_size(int component_type)
{
	const component_row *row = row_of_type(component_type);
	return row ? row->size : 0;
}

nmtan_status nt_draco_decode(nt_draco **result, const unsigned char *bytes, size_t size,
	size_t max_faces, bool with_quantization, nt_error *error)
{
	*result = nullptr;
	nt_draco *made = nullptr;
	const size_t plausible = plausible_faces(size);
	const size_t limit = max_faces && max_faces < plausible ? max_faces : plausible;
	const nmtan_status status = nt::guard(error, library, [&] {
		made = new nt_draco;
		const nmtan_status decoded = decode(*made, bytes, size, limit, error);
		return decoded == NMTAN_OK && with_quantization
			? add_quantization(*made, bytes, size, error) : decoded;
	});
	if (status == NMTAN_OK)
		*result = made;
	else
		delete made;
	return status;
}

void nt_draco_free(nt_draco *result)
{
	delete result;
}

const nt_draco_mesh *nt_draco_get(const nt_draco *result)
{
	return &result->mesh;
}

const nt_draco_attribute *nt_draco_find(const nt_draco_mesh *mesh, uint32_t unique_id)
{
	for (size_t i = 0; i < mesh->attribute_count; i++)
		if (mesh->attributes[i].unique_id == unique_id)
			return &mesh->attributes[i];
	return nullptr;
}

nmtan_status nt_draco_encode(const nt_draco_mesh *mesh, nt_draco_block *block, nt_error *error)
{
	*block = {};
	return nt::guard(error, library, [&] { return encode(*mesh, block, error); });
}

void nt_draco_block_free(nt_draco_block *block)
{
	std::free(block->bytes);
	std::free(block->sources);
	*block = {};
}
