// SPDX-License-Identifier: MIT
//
// tinygltf behind a C header: its loader, as a second opinion on files that we wrote. It searches the current
// directory, decodes images, overflows its stack on deep JSON and checks no accessor: so it gets its files through
// callbacks, an image loader that does nothing and text whose depth was counted, and its accessors are checked
// here. New documents are in tinygltf_model.cpp.
#include "ext/tinygltf.h"
#include "ext/guard.hpp"

#include <algorithm>
#include <cstring>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <tiny_gltf.h>

struct nt_reread {
	tinygltf::Model document;
	// rows of accessors that do not lie in a buffer as they are
	std::deque<std::vector<unsigned char>> rows;
};

namespace {

const char library[] = "tinygltf";

// ---- loading ----

constexpr int max_depth = 512;

// Extensions whose accessors and buffers have no bytes of their own, which tinygltf takes for a fault.
const char *const compressions[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
const char draco[] = "KHR_draco_mesh_compression";

// How deep arrays and objects are nested, counted outside of strings. Whether the text is JSON at all is not
// decided here.
bool is_too_deep(const char *text, size_t size)
{
	int depth = 0;
	bool in_string = false;
	for (size_t i = 0; i < size; i++) {
		const char c = text[i];
		if (in_string) {
			if (c == '\\')
				i++;
			else if (c == '"')
				in_string = false;
		} else if (c == '"') {
			in_string = true;
		} else if (c == '[' || c == '{') {
			if (++depth > max_depth)
				return true;
		} else if (c == ']' || c == '}') {
			depth--;
		}
	}
	return false;
}

uint32_t little_endian(const unsigned char *bytes)
{
	return static_cast<uint32_t>(bytes[0]) | static_cast<uint32_t>(bytes[1]) << 8 |
		static_cast<uint32_t>(bytes[2]) << 16 | static_cast<uint32_t>(bytes[3]) << 24;
}

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

// tinygltf refuses primitives whose indices have no buffer view, which is how compressed ones have them. It
// gets a text without these; who asks for the primitive's block reads them there. Text that is not JSON is left
// to tinygltf.
bool take_out_compressed_indices(std::string &text)
{
	nlohmann::ordered_json document = nlohmann::ordered_json::parse(text, nullptr, false);
	if (!document.is_object() || !document.contains("meshes"))
		return false;
	for (auto &mesh : document["meshes"]) {
		if (!mesh.is_object() || !mesh.contains("primitives"))
			continue;
		for (auto &primitive : mesh["primitives"])
			if (primitive.is_object() && primitive.contains("extensions") &&
				primitive["extensions"].is_object() && primitive["extensions"].contains(draco))
				primitive.erase("indices");
	}
	text = document.dump();
	return true;
}

void put_little_endian(std::string &out, uint32_t value)
{
	for (int shift = 0; shift < 32; shift += 8)
		out += static_cast<char>(value >> shift & 0xff);
}

// A document without the indices of compressed primitives; empty where there is nothing to take out.
std::string without_compressed_indices(const unsigned char *bytes, size_t size, bool binary, const char *json,
	size_t json_size)
{
	if (!memmem(json, json_size, draco, sizeof draco - 1))
		return {};
	std::string text(json, json_size);
	if (!take_out_compressed_indices(text) || !binary)
		return binary ? std::string() : text;
	text.append(-text.size() & 3, ' ');
	const size_t rest = size - 20 - json_size;
	std::string out(reinterpret_cast<const char *>(bytes), 8);
	put_little_endian(out, static_cast<uint32_t>(20 + text.size() + rest));
	put_little_endian(out, static_cast<uint32_t>(text.size()));
	out.append(reinterpret_cast<const char *>(bytes) + 16, 4);
	out += text;
	return out.append(reinterpret_cast<const char *>(bytes) + 20 + json_size, rest);
}

nmtan_status load(tinygltf::Model &document, const unsigned char *bytes, size_t size, finder files,
	nt_error *error)
{
	const bool binary = size >= 20 && std::memcmp(bytes, "glTF", 4) == 0;
	const char *json = reinterpret_cast<const char *>(bytes);
	size_t json_size = size;
	if (binary) {
		json += 20;
		json_size = std::min<size_t>(little_endian(bytes + 12), size - 20);
	}
	if (is_too_deep(json, json_size))
		return nt_fail(error, NMTAN_ERROR_INPUT, "JSON is nested deeper than %d levels", max_depth);
	if (size > 0xffffffffu)
		return nt_fail(error, NMTAN_ERROR_UNSUPPORTED,
			"tinygltf cannot read a file of %zu bytes back, the limit is 4294967295", size);

	tinygltf::TinyGLTF loader;
	loader.SetImageLoader(decode_nothing, nullptr);
	loader.SetFsCallbacks({file_exists, same_path, read_file, write_nothing, &files});
	std::string message, warning;
	const std::string plain = without_compressed_indices(bytes, size, binary, json, json_size);
	const char *text = plain.empty() ? reinterpret_cast<const char *>(bytes) : plain.data();
	const unsigned length = static_cast<unsigned>(plain.empty() ? size : plain.size());
	const bool loaded = binary
		? loader.LoadBinaryFromMemory(&document, &message, &warning,
			reinterpret_cast<const unsigned char *>(text), length)
		: loader.LoadASCIIFromString(&document, &message, &warning, text, length, "");
	if (loaded && message.empty())
		return NMTAN_OK;
	for (const char *extension : compressions)
		if (memmem(json, json_size, extension, std::strlen(extension)))
			return nt_fail(error, NMTAN_ERROR_UNSUPPORTED,
				"tinygltf cannot read documents with %s back", extension);
	for (char &c : message)
		c = c == '\n' ? ' ' : c;
	return nt_fail(error, NMTAN_ERROR_INPUT, "tinygltf refuses the document: %s", message.c_str());
}

// ---- accessors ----

// The bytes of a view; the message of what is wrong with it otherwise.
const char *view_bytes(const tinygltf::Model &document, int index, const unsigned char **bytes, size_t *size,
	size_t *stride)
{
	if (index < 0 || static_cast<size_t>(index) >= document.bufferViews.size())
		return "the accessor has no buffer view";
	const tinygltf::BufferView &view = document.bufferViews[static_cast<size_t>(index)];
	if (!view.extensions.empty())
		return "the buffer view has an extension";
	if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= document.buffers.size())
		return "the buffer view has no buffer";
	const std::vector<unsigned char> &data = document.buffers[static_cast<size_t>(view.buffer)].data;
	if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
		return "the buffer view is not inside its buffer";
	*bytes = data.data() + view.byteOffset;
	*size = view.byteLength;
	*stride = view.byteStride;
	return nullptr;
}

// Elements an accessor without a view may have; what we read back had its positions somewhere.
constexpr size_t most_zeros = 1 << 24;

// Puts the values of a sparse accessor into its rows.
const char *put_sparse(const tinygltf::Model &document, const tinygltf::Accessor &accessor, size_t element,
	std::vector<unsigned char> &rows)
{
	const auto &sparse = accessor.sparse;
	const int width = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(sparse.indices.componentType));
	const unsigned char *indices, *values;
	size_t index_size, value_size, stride;
	const char *fault = view_bytes(document, sparse.indices.bufferView, &indices, &index_size, &stride);
	if (!fault)
		fault = view_bytes(document, sparse.values.bufferView, &values, &value_size, &stride);
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
// zeros get rows in `owner`.
const char *resolve(const tinygltf::Model &document, std::deque<std::vector<unsigned char>> &owner, int index,
	nt_reread_array *array)
{
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
		const char *fault = view_bytes(document, accessor.bufferView, &bytes, &size, &stride);
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
	*array = {bytes, accessor.count, stride, accessor.componentType, components, accessor.normalized};
	if (bytes && !accessor.sparse.isSparse)
		return nullptr;
	std::vector<unsigned char> rows(accessor.count * element + 1);
	for (size_t row = 0; bytes && row < accessor.count; row++)
		std::memcpy(rows.data() + row * element, bytes + row * stride, element);
	const char *fault =
		accessor.sparse.isSparse ? put_sparse(document, accessor, element, rows) : nullptr;
	owner.push_back(std::move(rows));
	array->data = owner.back().data();
	array->stride_bytes = element;
	return fault;
}

int index_of(const std::map<std::string, int> &attributes, const char *name)
{
	const auto found = attributes.find(name);
	return found == attributes.end() ? -1 : found->second;
}

constexpr size_t place_size = 200;

// The array of the accessor that find() gives, -1 for none; it also says where in the primitive that stands.
template <typename Find>
nmtan_status read_array(nt_reread *model, size_t mesh, size_t primitive, nt_reread_array *array, nt_error *error,
	Find &&find)
{
	*array = {};
	if (primitive >= nt_reread_primitive_count(model, mesh))
		return nt_fail(error, NMTAN_ERROR_INPUT, "mesh %zu has no primitive %zu", mesh, primitive);
	return nt::guard(error, library, [&]() -> nmtan_status {
		char place[place_size], pointer[place_size + 100];
		const int index = find(model->document.meshes[mesh].primitives[primitive], place);
		const char *fault =
			index < 0 ? nullptr : resolve(model->document, model->rows, index, array);
		if (!fault)
			return NMTAN_OK;
		std::snprintf(pointer, sizeof pointer, "/meshes/%zu/primitives/%zu/%s", mesh, primitive, place);
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer, "%s", fault);
	});
}

// The extension of a compressed primitive; null: none.
const tinygltf::Value *block_of(const nt_reread *model, size_t mesh, size_t primitive)
{
	if (primitive >= nt_reread_primitive_count(model, mesh))
		return nullptr;
	const tinygltf::ExtensionMap &extensions = model->document.meshes[mesh].primitives[primitive].extensions;
	const auto found = extensions.find(draco);
	return found == extensions.end() || !found->second.IsObject() ? nullptr : &found->second;
}

} // namespace

nmtan_status nt_reread_open(nt_reread **model, const unsigned char *bytes, size_t size,
	nt_reread_find find, void *user, nt_error *error)
{
	*model = nullptr;
	nt_reread *made = nullptr;
	const nmtan_status status = nt::guard(error, library, [&] {
		made = new nt_reread;
		return load(made->document, bytes, size, {find, user}, error);
	});
	if (status == NMTAN_OK)
		*model = made;
	else
		delete made;
	return status;
}

void nt_reread_free(nt_reread *model)
{
	delete model;
}

size_t nt_reread_mesh_count(const nt_reread *model)
{
	return model->document.meshes.size();
}

size_t nt_reread_primitive_count(const nt_reread *model, size_t mesh)
{
	return mesh < model->document.meshes.size() ? model->document.meshes[mesh].primitives.size() : 0;
}

nmtan_status nt_reread_attribute(nt_reread *model, size_t mesh, size_t primitive,
	const char *name, nt_reread_array *array, nt_error *error)
{
	return read_array(model, mesh, primitive, array, error, [&](const tinygltf::Primitive &item, char *place) {
		std::snprintf(place, place_size, "%s%s", name ? "attributes/" : "indices", name ? name : "");
		return name ? index_of(item.attributes, name) : item.indices;
	});
}

nmtan_status nt_reread_target(nt_reread *model, size_t mesh, size_t primitive, size_t target,
	const char *name, nt_reread_array *array, nt_error *error)
{
	return read_array(model, mesh, primitive, array, error, [&](const tinygltf::Primitive &item, char *place) {
		std::snprintf(place, place_size, "targets/%zu/%s", target, name);
		return target < item.targets.size() ? index_of(item.targets[target], name) : -1;
	});
}

bool nt_reread_block(const nt_reread *model, size_t mesh, size_t primitive, const unsigned char **bytes,
	size_t *size)
{
	const tinygltf::Value *block = block_of(model, mesh, primitive);
	if (!block)
		return false;
	size_t stride;
	const int view = block->Get("bufferView").IsInt() ? block->Get("bufferView").GetNumberAsInt() : -1;
	if (view_bytes(model->document, view, bytes, size, &stride))
		*bytes = nullptr, *size = 0;
	return true;
}

bool nt_reread_block_id(const nt_reread *model, size_t mesh, size_t primitive, const char *name, uint32_t *id)
{
	const tinygltf::Value *block = block_of(model, mesh, primitive);
	if (!block || !block->Get("attributes").IsObject() || !block->Get("attributes").Get(name).IsInt())
		return false;
	*id = static_cast<uint32_t>(block->Get("attributes").Get(name).GetNumberAsInt());
	return true;
}
