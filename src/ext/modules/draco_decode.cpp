// SPDX-License-Identifier: MIT
//
// Draco behind a C header, kept at the door: of 9 900 mutated files 508 decoded "ok" with indices out of
// range, and memory reached 5.2 GB. So the number of faces is read from the stream's head and checked before
// Draco sees it, and what it returns is copied into plain arrays with every index and every mapping checked.
//
// Floats that were quantized are made here of the integers that the decoder has of them (its portable attributes),
// since the library rounds where its compiler likes: Debian's for arm64 multiplies and adds in one step, and has a w
// that is neither 1 nor -1.
// Encoding, and the module's table, are in draco_encode.cpp.
#include "ext/modules/draco_parts.hpp"
#include "ext/modules/guard.hpp"

#include <cstring>
#include <memory>

#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/attributes/normal_compression_utils.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>

namespace {

using draco::AttributeValueIndex;
using draco::PointAttribute;
using draco::PointIndex;

struct component_row {
	int type; // glTF's number
	draco::DataType draco_type;
};

const component_row component_table[] = {
	{NT_GLTF_BYTE, draco::DT_INT8},
	{NT_GLTF_UBYTE, draco::DT_UINT8},
	{NT_GLTF_SHORT, draco::DT_INT16},
	{NT_GLTF_USHORT, draco::DT_UINT16},
	{NT_GLTF_INT, draco::DT_INT32},
	{NT_GLTF_UINT, draco::DT_UINT32},
	{NT_GLTF_FLOAT, draco::DT_FLOAT32},
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

	// A fixed number in streams before `since` is a variable one from then on.
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
nt_status damaged(nt_error *error, size_t offset, const char *what)
{
	return nt_fail_offset(error, NT_ERROR_INPUT, offset, "damaged Draco data: %s", what);
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

// portable: the integers of floats that were quantized; null where Draco has none.
nt_status take_attribute(nt::draco_arrays &result, const PointAttribute &decoded, const PointAttribute *portable,
	nt_error *error)
{
	const size_t point_count = result.mesh.point_count;
	nt_draco_attribute attribute = {};
	attribute.unique_id = decoded.unique_id();
	attribute.kind = kind_of(decoded);
	const component_row *row = row_of_draco(decoded.data_type());
	if (!row || decoded.num_components() < 1 || decoded.num_components() > 4)
		return nt_fail(error, NT_ERROR_UNSUPPORTED,
			"Draco attribute %u has a type that glTF cannot have (type %d, %d components)",
			decoded.unique_id(), static_cast<int>(decoded.data_type()),
			static_cast<int>(decoded.num_components()));
	attribute.quantization = portable ? nt::quantization_of(*portable) : nt_draco_quantization{};
	const bool quantized = attribute.quantization.bits > 0;
	if (!is_sound(quantized ? *portable : decoded, point_count))
		return nt_fail(error, NT_ERROR_INPUT,
			"damaged Draco data: attribute %u has fewer values than its points refer to",
			decoded.unique_id());
	attribute.component_type = row->type;
	attribute.components = decoded.num_components();
	attribute.normalized = decoded.normalized();
	result.data.push_back(quantized ? nt::restore(*portable, attribute.quantization, point_count)
		: nt::copy_values(decoded, point_count));
	attribute.data = result.data.back().data();
	result.attributes.push_back(attribute);
	return NT_OK;
}

nt_status take_mesh(nt::draco_arrays &result, draco::MeshDecoder &decoder, nt_error *error)
{
	const draco::Mesh &mesh = *decoder.mesh();
	result.mesh.face_count = mesh.num_faces();
	result.mesh.point_count = mesh.num_points();
	result.indices.reserve(3 * result.mesh.face_count);
	for (uint32_t f = 0; f < mesh.num_faces(); f++)
		for (const PointIndex &corner : mesh.face(draco::FaceIndex(f))) {
			if (corner.value() >= mesh.num_points())
				return nt_fail(error, NT_ERROR_INPUT,
					"damaged Draco data: face %u refers to point %u of %u", f,
					corner.value(), mesh.num_points());
			result.indices.push_back(corner.value());
		}
	for (int i = 0; i < mesh.num_attributes(); i++) {
		const nt_status status =
			take_attribute(result, *mesh.attribute(i), decoder.GetPortableAttribute(i), error);
		if (status != NT_OK)
			return status;
	}
	result.mesh.indices = result.indices.data();
	result.mesh.attributes = result.attributes.data();
	result.mesh.attribute_count = result.attributes.size();
	return NT_OK;
}

// Whether the stream's head is that of a mesh of at most `limit` faces.
nt_status check_head(const unsigned char *bytes, size_t size, size_t limit, stream_head *head,
	nt_error *error)
{
	if (!read_head(bytes, size, head))
		return nt_fail_offset(error, NT_ERROR_INPUT, 0, "not Draco data, or its head is cut off");
	if (!head->is_mesh)
		return nt_fail_offset(error, NT_ERROR_UNSUPPORTED, 0,
			"Draco point cloud: it has no faces, expected a mesh");
	if (head->faces > limit || head->points > 3 * static_cast<uint64_t>(limit))
		return nt_fail_offset(error, NT_ERROR_TOO_LARGE, 0,
			"Draco data of %zu bytes declares %llu faces and %llu points, at most %zu faces are "
			"expected", size, static_cast<unsigned long long>(head->faces),
			static_cast<unsigned long long>(head->points), limit);
	return NT_OK;
}

void free_arrays(nt_draco *result)
{
	const nt::reserve memory;
	delete static_cast<nt::draco_arrays *>(result);
}

} // namespace

draco::DataType nt::draco_type_of(int component_type)
{
	const component_row *row = row_of_type(component_type);
	return row ? row->draco_type : draco::DT_INVALID;
}

draco::GeometryAttribute::Type nt::draco_kind_of(nt_draco_kind kind)
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

nt_draco_quantization nt::quantization_of(const PointAttribute &portable)
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

std::vector<unsigned char> nt::copy_values(const PointAttribute &attribute, size_t point_count)
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

std::vector<unsigned char> nt::restore(const PointAttribute &portable, const nt_draco_quantization &q,
	size_t point_count)
{
	const size_t components = q.octahedral ? 3 : static_cast<size_t>(portable.num_components());
	std::vector<unsigned char> result(sizeof(float) * components * point_count);
	draco::OctahedronToolBox octahedron; // its arithmetic is inline, and compiled as ours
	if (q.octahedral)
		octahedron.SetQuantizationBits(q.bits);
	const float step = q.range / static_cast<float>((1u << q.bits) - 1);
	for (size_t p = 0; p < point_count; p++) {
		int32_t from[4];
		float to[4];
		portable.GetMappedValue(PointIndex(static_cast<uint32_t>(p)), from);
		if (q.octahedral)
			octahedron.QuantizedOctahedralCoordsToUnitVector(from[0], from[1], to);
		else
			for (size_t i = 0; i < components; i++)
				to[i] = static_cast<float>(from[i]) * step + q.origin[i];
		std::memcpy(result.data() + sizeof(float) * components * p, to, sizeof(float) * components);
	}
	return result;
}

nt_status nt::decode_draco(nt::draco_arrays &result, const unsigned char *bytes, size_t size, size_t face_limit,
	nt_error *error)
{
	stream_head head = {};
	const nt_status status = check_head(bytes, size, face_limit, &head, error);
	if (status != NT_OK)
		return status;
	draco::Mesh mesh;
	draco::DecoderBuffer buffer;
	buffer.Init(reinterpret_cast<const char *>(bytes), size);
	draco::MeshSequentialDecoder sequential;
	draco::MeshEdgebreakerDecoder edgebreaker;
	draco::MeshDecoder *decoder = &sequential;
	if (head.method == NT_DRACO_EDGEBREAKER)
		decoder = &edgebreaker;
	const draco::Status decoded = decoder->Decode({}, &buffer, &mesh);
	if (!decoded.ok())
		return damaged(error, static_cast<size_t>(buffer.decoded_size()), decoded.error_msg());
	result.mesh.method = head.method;
	return take_mesh(result, *decoder, error);
}

nt_status nt::decode_guarded(nt_draco **result, const unsigned char *bytes, size_t size, size_t max_faces,
	nt_error *error)
{
	draco_arrays *made = nullptr;
	const size_t plausible = plausible_faces(size);
	const size_t limit = max_faces && max_faces < plausible ? max_faces : plausible;
	const nt_status status = nt::guard(error, "Draco", [&] {
		made = new draco_arrays;
		made->free = free_arrays;
		return nt::decode_draco(*made, bytes, size, limit, error);
	});
	if (status == NT_OK)
		*result = made;
	else
		free_arrays(made);
	return status;
}
