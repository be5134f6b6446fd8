// SPDX-License-Identifier: MIT
//
// tinygltf behind a C header: its loader, as a second opinion on files that we wrote. It searches the current
// directory, decodes images, overflows its stack on deep JSON, knows no compression and checks no accessor: so it
// gets its files through callbacks, an image loader that does nothing and text made for it (tinygltf_text.cpp), and
// its accessors are checked and unpacked here.
#include "ext/modules/guard.hpp"
#include "ext/modules/tinygltf_text.hpp"
#include "ext/tables.h"

#include <cstring>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include <tiny_gltf.h>

struct nt_reread {
	tinygltf::Model document;
	nt::packed_views packed;
	std::map<size_t, std::vector<unsigned char>> unpacked; // by view
	// rows of accessors that do not lie in a buffer as they are
	std::deque<std::vector<unsigned char>> rows;
};

namespace {

const char library[] = "tinygltf";

// ---- loading ----

struct finder {
	nt_reread_find find;
	void *user;

	// tinygltf asks for "./name" after "name".
	bool operator()(const std::string &name, const unsigned char **bytes, size_t *size) const
	{
		return find && find(user, name.c_str(), bytes, size);
	}
};

bool file_exists(const std::string &name, void *user)
{
	const unsigned char *bytes;
	size_t size;
	return (*static_cast<const finder *>(user))(name, &bytes, &size);
}

std::string same_path(const std::string &name, void *)
{
	return name;
}

bool read_file(std::vector<unsigned char> *out, std::string *message, const std::string &name,
	void *user)
{
	const unsigned char *bytes;
	size_t size;
	if (!(*static_cast<const finder *>(user))(name, &bytes, &size)) {
		*message += "not found";
		return false;
	}
	out->assign(bytes, bytes + size);
	return true;
}

bool write_nothing(std::string *, const std::string &, const std::vector<unsigned char> &, void *)
{
	return false;
}

bool decode_nothing(tinygltf::Image *, int, std::string *, std::string *, int, int,
	const unsigned char *, int, void *)
{
	return true;
}

nt_status load(nt_reread &model, const unsigned char *bytes, size_t size, finder files, nt_error *error)
{
	const nt::gltf_text text(bytes, size);
	if (text.is_too_deep())
		return nt_fail(error, NT_ERROR_INPUT, "JSON is nested deeper than %d levels",
			nt::gltf_text::max_depth);
	if (size > 0xffffffffu)
		return nt_fail(error, NT_ERROR_UNSUPPORTED,
			"tinygltf cannot read a file of %zu bytes back, the limit is 4294967295", size);

	tinygltf::TinyGLTF loader;
	loader.SetImageLoader(decode_nothing, nullptr);
	loader.SetFsCallbacks({file_exists, same_path, read_file, write_nothing, &files});
	std::string message, warning;
	const std::string eased = text.eased(model.packed);
	const char *begin = eased.empty() ? reinterpret_cast<const char *>(bytes) : eased.data();
	const unsigned length = static_cast<unsigned>(eased.empty() ? size : eased.size());
	bool loaded = false;
	try {
		loaded = text.is_binary()
			? loader.LoadBinaryFromMemory(&model.document, &message, &warning,
				reinterpret_cast<const unsigned char *>(begin), length)
			: loader.LoadASCIIFromString(&model.document, &message, &warning, begin, length, "");
	} catch (const std::bad_alloc &) {
		throw;
	} catch (const std::exception &thrown) { // it looks for some things behind the end of their array
		message = thrown.what();
	}
	if (loaded && message.empty())
		return NT_OK;
	for (char &c : message)
		c = c == '\n' ? ' ' : c;
	return nt_fail(error, NT_ERROR_INPUT, "tinygltf refuses the document: %s", message.c_str());
}

// ---- accessors ----

// Bytes of a buffer; null where they are not inside of it.
const unsigned char *buffer_bytes(const tinygltf::Model &document, uint64_t buffer, uint64_t offset, uint64_t size)
{
	if (buffer >= document.buffers.size())
		return nullptr;
	const std::vector<unsigned char> &data = document.buffers[buffer].data;
	return offset > data.size() || size > data.size() - offset ? nullptr : data.data() + offset;
}

// The bytes of a view that meshoptimizer packed, unpacked once, and behind them the same before the filter; the message
// of what is wrong with it otherwise.
const char *unpack(nt_reread &model, size_t index, size_t size, const unsigned char **bytes)
{
	const nt::packed_view &packed = model.packed.at(index);
	std::vector<unsigned char> &unpacked = model.unpacked[index];
	if (unpacked.empty()) {
		const nt_meshopt_view view = {packed.mode.c_str(), "NONE", packed.stride, packed.count, packed.size};
		nt_meshopt_view filtered = view;
		filtered.filter = packed.filter.c_str();
		const unsigned char *from =
			buffer_bytes(model.document, packed.buffer, packed.offset, packed.size);
		if (!from || nt_meshopt_module.check(&view, size, "", nullptr) != NT_OK)
			return "the buffer view is packed, and its packed bytes are not as it says";
		std::vector<unsigned char> made(2 * size + 1); // never empty
		if (nt_meshopt_module.unpack(&view, from, made.data(), "", nullptr) != NT_OK)
			return "meshoptimizer cannot unpack the buffer view";
		std::memcpy(made.data() + size, made.data(), size);
		if (packed.mode == "ATTRIBUTES" &&
			nt_meshopt_module.filter(&filtered, made.data(), "", nullptr) != NT_OK)
			return "the buffer view has an unknown filter";
		unpacked = std::move(made);
	}
	*bytes = unpacked.data();
	return nullptr;
}

// The bytes of a view; the message of what is wrong with it otherwise.
const char *view_bytes(nt_reread &model, int index, const unsigned char **bytes, size_t *size, size_t *stride)
{
	const tinygltf::Model &document = model.document;
	if (index < 0 || static_cast<size_t>(index) >= document.bufferViews.size())
		return "the accessor has no buffer view";
	const tinygltf::BufferView &view = document.bufferViews[static_cast<size_t>(index)];
	*size = view.byteLength;
	*stride = view.byteStride;
	if (model.packed.count(static_cast<size_t>(index)))
		return unpack(model, static_cast<size_t>(index), view.byteLength, bytes);
	if (view.buffer < 0)
		return "the buffer view has no buffer";
	*bytes = buffer_bytes(document, static_cast<uint64_t>(view.buffer), view.byteOffset, view.byteLength);
	return *bytes ? nullptr : "the buffer view is not inside its buffer";
}

// Elements an accessor without a view may have; what we read back had its positions somewhere.
constexpr size_t most_zeros = 1 << 24;

// Puts the values of a sparse accessor into its rows.
const char *put_sparse(nt_reread &model, const tinygltf::Accessor &accessor, size_t element,
	std::vector<unsigned char> &rows)
{
	const auto &sparse = accessor.sparse;
	const int width = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(sparse.indices.componentType));
	const unsigned char *indices, *values;
	size_t index_size, value_size, stride;
	const char *fault = view_bytes(model, sparse.indices.bufferView, &indices, &index_size, &stride);
	if (!fault)
		fault = view_bytes(model, sparse.values.bufferView, &values, &value_size, &stride);
	if (fault)
		return fault;
	const size_t count = static_cast<size_t>(sparse.count);
	const size_t index_offset = static_cast<size_t>(sparse.indices.byteOffset);
	const size_t value_offset = static_cast<size_t>(sparse.values.byteOffset);
	if (sparse.count < 0 || width <= 0 || count > accessor.count || sparse.indices.byteOffset < 0 ||
		sparse.values.byteOffset < 0 || index_offset > index_size || value_offset > value_size ||
		count > (index_size - index_offset) / static_cast<size_t>(width) ||
		count > (value_size - value_offset) / element)
		return "the sparse part is not inside its buffer views";
	for (size_t i = 0; i < count; i++) {
		size_t row = 0;
		for (int k = width; k-- > 0;)
			row = row << 8 | indices[index_offset + i * static_cast<size_t>(width) +
				static_cast<size_t>(k)];
		if (row >= accessor.count)
			return "a sparse index is not below the count";
		std::memcpy(rows.data() + row * element, values + value_offset + i * element, element);
	}
	return nullptr;
}

// Fills an array from an accessor; the message of what is wrong with it otherwise. Sparse accessors and those of
// zeros get rows of their own.
const char *resolve(nt_reread &model, int index, nt_reread_array *array)
{
	const tinygltf::Model &document = model.document;
	if (index < 0 || static_cast<size_t>(index) >= document.accessors.size())
		return "there is no such accessor";
	const tinygltf::Accessor &accessor = document.accessors[static_cast<size_t>(index)];
	const int component = tinygltf::GetComponentSizeInBytes(
		static_cast<uint32_t>(accessor.componentType));
	const int components = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
	if (component <= 0 || components <= 0 || components > 4)
		return "the accessor's type is not one of attributes or indices";
	const size_t element = static_cast<size_t>(component) * static_cast<size_t>(components);
	const unsigned char *bytes = nullptr;
	size_t size = 0, stride = 0;
	if (accessor.bufferView >= 0) {
		const char *fault = view_bytes(model, accessor.bufferView, &bytes, &size, &stride);
		if (fault)
			return fault;
		stride = stride ? stride : element;
		if (stride < element)
			return "the stride is less than an element";
		if (accessor.count > 0 &&
			(accessor.byteOffset > size || element > size - accessor.byteOffset ||
				(accessor.count - 1) > (size - accessor.byteOffset - element) / stride))
			return "the accessor is not inside its buffer view";
		bytes += accessor.byteOffset;
	} else if (accessor.count > most_zeros) {
		return "the accessor has no buffer view";
	}
	*array = {bytes, accessor.count, stride, accessor.componentType, components, accessor.normalized, nullptr,
		nullptr, false};
	const auto packed = model.packed.find(static_cast<size_t>(accessor.bufferView));
	array->turned = packed != model.packed.end() && packed->second.mode == "TRIANGLES";
	if (bytes && !accessor.sparse.isSparse && packed != model.packed.end() && packed->second.filter != "NONE") {
		array->filter = packed->second.filter.c_str();
		array->unfiltered = bytes + size;
	}
	if (bytes && !accessor.sparse.isSparse)
		return nullptr;
	std::vector<unsigned char> rows(accessor.count * element + 1);
	for (size_t row = 0; bytes && row < accessor.count; row++)
		std::memcpy(rows.data() + row * element, bytes + row * stride, element);
	const char *fault =
		accessor.sparse.isSparse ? put_sparse(model, accessor, element, rows) : nullptr;
	model.rows.push_back(std::move(rows));
	array->data = model.rows.back().data();
	array->stride_bytes = element;
	return fault;
}

int index_of(const std::map<std::string, int> &attributes, const char *name)
{
	const auto found = attributes.find(name);
	return found == attributes.end() ? -1 : found->second;
}

size_t primitive_count(const nt_reread *model, size_t mesh)
{
	return mesh < model->document.meshes.size() ? model->document.meshes[mesh].primitives.size() : 0;
}

constexpr size_t place_size = 200;

// The array of the accessor that find() gives, -1 for none; it also says where in the primitive that stands.
template <typename Find>
nt_status read_array(nt_reread *model, size_t mesh, size_t primitive, nt_reread_array *array, nt_error *error,
	Find &&find)
{
	*array = {};
	if (primitive >= primitive_count(model, mesh))
		return nt_fail(error, NT_ERROR_INPUT, "mesh %zu has no primitive %zu", mesh, primitive);
	return nt::guard(error, library, [&]() -> nt_status {
		char place[place_size], pointer[place_size + 100];
		const int index = find(model->document.meshes[mesh].primitives[primitive], place);
		const char *fault =
			index < 0 ? nullptr : resolve(*model, index, array);
		if (!fault)
			return NT_OK;
		std::snprintf(pointer, sizeof pointer, "/meshes/%zu/primitives/%zu/%s", mesh, primitive, place);
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer, "%s", fault);
	});
}

// The extension of a compressed primitive; null: none.
const tinygltf::Value *block_of(const nt_reread *model, size_t mesh, size_t primitive)
{
	if (primitive >= primitive_count(model, mesh))
		return nullptr;
	for (const auto &extension : model->document.meshes[mesh].primitives[primitive].extensions)
		if (extension.first == nt::draco_extension && extension.second.IsObject())
			return &extension.second;
	return nullptr;
}

// A member that is an integer, -1 for none. Without a key to look up, which would allocate.
int integer_member(const tinygltf::Value &object, const char *name)
{
	if (object.IsObject())
		for (const auto &member : object.Get<tinygltf::Value::Object>())
			if (member.first == name && member.second.IsInt())
				return member.second.GetNumberAsInt();
	return -1;
}

// ---- the table ----

void free_model(nt_reread *model)
{
	const nt::reserve memory;
	delete model;
}

nt_status open(nt_reread **model, const unsigned char *bytes, size_t size,
	nt_reread_find find, void *user, nt_error *error)
{
	nt_reread *made = nullptr;
	const nt_status status = nt::guard(error, library, [&] {
		made = new nt_reread;
		return load(*made, bytes, size, {find, user}, error);
	});
	if (status == NT_OK)
		*model = made;
	else
		free_model(made);
	return status;
}

size_t mesh_count(const nt_reread *model)
{
	return model->document.meshes.size();
}

nt_status attribute(nt_reread *model, size_t mesh, size_t primitive,
	const char *name, nt_reread_array *array, nt_error *error)
{
	return read_array(model, mesh, primitive, array, error, [&](const tinygltf::Primitive &item, char *place) {
		std::snprintf(place, place_size, "%s%s", name ? "attributes/" : "indices", name ? name : "");
		return name ? index_of(item.attributes, name) : item.indices;
	});
}

nt_status target(nt_reread *model, size_t mesh, size_t primitive, size_t target,
	const char *name, nt_reread_array *array, nt_error *error)
{
	return read_array(model, mesh, primitive, array, error, [&](const tinygltf::Primitive &item, char *place) {
		std::snprintf(place, place_size, "targets/%zu/%s", target, name);
		return target < item.targets.size() ? index_of(item.targets[target], name) : -1;
	});
}

nt_status block(nt_reread *model, size_t mesh, size_t primitive, bool *has_block,
	const unsigned char **bytes, size_t *size, nt_error *error)
{
	const tinygltf::Value *block = block_of(model, mesh, primitive);
	*has_block = block != nullptr;
	*bytes = nullptr;
	*size = 0;
	if (!block)
		return NT_OK;
	return nt::guard(error, library, [&] {
		size_t stride;
		if (view_bytes(*model, integer_member(*block, "bufferView"), bytes, size, &stride))
			*bytes = nullptr, *size = 0;
		return NT_OK;
	});
}

bool block_id(const nt_reread *model, size_t mesh, size_t primitive, const char *name, uint32_t *id)
{
	const tinygltf::Value *block = block_of(model, mesh, primitive);
	if (!block || !block->IsObject())
		return false;
	for (const auto &member : block->Get<tinygltf::Value::Object>()) {
		const int found = member.first == "attributes" ? integer_member(member.second, name) : -1;
		if (found < 0)
			continue;
		*id = static_cast<uint32_t>(found);
		return true;
	}
	return false;
}

} // namespace

const nt_tinygltf_table nt_tinygltf_module = {NT_MODULE_HEAD(nt_tinygltf_table, "tinygltf", nullptr, "MIT",
	&nt::cxx), open, free_model, mesh_count, primitive_count, attribute, target, block, block_id};
