// SPDX-License-Identifier: MIT
//
// tinygltf behind a C header: its model and writer for new documents, its loader for reading back.
// Debian's libtinygltf has the implementation; the header is not compiled a second time.
//
// What it does not do well is kept from it. Its writer wants the bytes of buffers, so it gets none and
// their one object is appended to the text, where it is cut in two around a data URI. It writes null for
// empty nodes, scenes and attribute lists, so none is made; it throws on invalid UTF-8, so names are
// converted. Its loader searches the current directory, decodes images, overflows its stack on deep
// JSON and checks no accessor: it gets its files through callbacks, an image loader that does nothing, text
// whose depth was counted, and its accessors are checked here.
#include "ext/tinygltf.h"
#include "ext/guard.hpp"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include <tiny_gltf.h>

struct nt_model {
	tinygltf::Model document;
	nmtan_status status = NMTAN_OK; // of the first addition that failed
	nt_error error;
};

struct nt_reread {
	tinygltf::Model document;
	// rows of accessors that do not lie in a buffer as they are
	std::deque<std::vector<unsigned char>> rows;
};

namespace {

const char library[] = "tinygltf";

// ---- a new document ----

// Length of the UTF-8 sequence at the beginning of text, 0 where there is none (RFC 3629: no overlong
// forms, no surrogates, nothing above U+10FFFF).
size_t sequence_length(const unsigned char *text, size_t size)
{
	if (text[0] < 0x80)
		return 1;
	const size_t length = text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : 2;
	if (text[0] < 0xc2 || text[0] > 0xf4 || size < length)
		return 0;
	for (size_t i = 1; i < length; i++)
		if ((text[i] & 0xc0) != 0x80)
			return 0;
	const bool overlong = (text[0] == 0xe0 && text[1] < 0xa0) || (text[0] == 0xf0 && text[1] < 0x90);
	const bool beyond = (text[0] == 0xed && text[1] > 0x9f) || (text[0] == 0xf4 && text[1] > 0x8f);
	return overlong || beyond ? 0 : length;
}

std::string utf8(const char *text)
{
	std::string result;
	const size_t size = text ? std::strlen(text) : 0;
	const auto *bytes = reinterpret_cast<const unsigned char *>(text);
	for (size_t i = 0; i < size;) {
		const size_t length = sequence_length(bytes + i, size - i);
		if (length) {
			result.append(text + i, length);
			i += length;
		} else { // Latin-1: the code point is the byte
			result += static_cast<char>(0xc0 | bytes[i] >> 6);
			result += static_cast<char>(0x80 | (bytes[i] & 0x3f));
			i++;
		}
	}
	return result;
}

// The double with the fewest digits that rounds to this float: 0.8f is written as 0.8, not as
// 0.800000011920929.
double shortest(float value)
{
	char text[32];
	const auto end = std::to_chars(text, text + sizeof text, value).ptr;
	double result = value;
	std::from_chars(text, end, result);
	return result;
}

// Runs an addition, unless an earlier one failed, and remembers its failure.
template <typename Body> uint32_t add(nt_model *model, Body &&body)
{
	if (model->status != NMTAN_OK)
		return NT_MODEL_NONE;
	uint32_t index = NT_MODEL_NONE;
	model->status = nt::guard(&model->error, library, [&] {
		index = static_cast<uint32_t>(body());
		return NMTAN_OK;
	});
	return model->status == NMTAN_OK ? index : NT_MODEL_NONE;
}

template <typename Item> size_t append(std::vector<Item> &items, Item &&item)
{
	items.push_back(std::move(item));
	return items.size() - 1;
}

int reference(uint32_t index)
{
	return index == NT_MODEL_NONE ? -1 : static_cast<int>(index);
}

void use_extension(std::vector<std::string> &names, const char *name)
{
	for (const std::string &known : names)
		if (known == name)
			return;
	names.emplace_back(name);
}

// glTF's emissiveFactor ends at 1; what is brighter is a factor and a strength.
void set_emissive(nt_model *model, tinygltf::Material &material, const float emissive[3])
{
	float largest = 1;
	for (int i = 0; i < 3; i++)
		largest = emissive[i] > largest ? emissive[i] : largest;
	material.emissiveFactor = {0, 0, 0};
	for (size_t i = 0; i < 3; i++)
		material.emissiveFactor[i] = shortest(emissive[i] > 0 ? emissive[i] / largest : 0);
	if (largest == 1)
		return;
	use_extension(model->document.extensionsUsed, "KHR_materials_emissive_strength");
	material.extensions["KHR_materials_emissive_strength"] = tinygltf::Value(
		tinygltf::Value::Object{{"emissiveStrength", tinygltf::Value(shortest(largest))}});
}

bool is_identity(const double matrix[16])
{
	for (int i = 0; i < 16; i++)
		if (matrix[i] != (i % 5 == 0 ? 1 : 0))
			return false;
	return true;
}

// Our images are where their URI says; tinygltf's own writer would encode pixels.
bool keep_image(const std::string *, const std::string *, const tinygltf::Image *, bool, std::string *,
	void *)
{
	return false;
}

// The buffers' member of the root, with the place for the base64 after `cut` bytes.
std::string buffers_member(uint64_t length, nt_model_buffer kind, const char *uri, size_t &cut)
{
	std::string member = ",\"buffers\":[{\"byteLength\":" + std::to_string(length);
	cut = std::string::npos;
	if (kind == NT_MODEL_FILE)
		member += ",\"uri\":\"" + std::string(uri) + "\"";
	if (kind == NT_MODEL_EMBEDDED) {
		member += ",\"uri\":\"data:application/octet-stream;base64,";
		cut = member.size();
		member += "\"";
	}
	return member + "}]";
}

// ---- reading back ----

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

} // namespace

nmtan_status nt_model_create(nt_model **model, const char *generator, nt_error *error)
{
	*model = nullptr;
	return nt::guard(error, library, [&] {
		std::string name = utf8(generator);
		*model = new nt_model;
		(*model)->document.asset.generator = std::move(name);
		return NMTAN_OK;
	});
}

void nt_model_free(nt_model *model)
{
	delete model;
}

uint32_t nt_model_view(nt_model *model, uint64_t offset, uint64_t length, int target)
{
	return add(model, [&] {
		tinygltf::BufferView view;
		view.buffer = 0;
		view.byteOffset = offset;
		view.byteLength = length;
		view.target = target;
		return append(model->document.bufferViews, std::move(view));
	});
}

uint32_t nt_model_add_accessor(nt_model *model, const nt_model_accessor *accessor)
{
	return add(model, [&] {
		static const int types[] = {TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3,
			TINYGLTF_TYPE_VEC4};
		tinygltf::Accessor item;
		item.bufferView = reference(accessor->view);
		item.componentType = accessor->component_type;
		item.type = types[accessor->components - 1];
		item.count = accessor->count;
		item.normalized = accessor->normalized;
		// exactly the float: a reader may compare in double
		if (accessor->min)
			item.minValues.assign(accessor->min, accessor->min + accessor->components);
		if (accessor->max)
			item.maxValues.assign(accessor->max, accessor->max + accessor->components);
		return append(model->document.accessors, std::move(item));
	});
}

uint32_t nt_model_image_uri(nt_model *model, const char *name, const char *uri)
{
	return add(model, [&] {
		tinygltf::Image image;
		image.name = utf8(name);
		image.uri = uri;
		return append(model->document.images, std::move(image));
	});
}

uint32_t nt_model_image_view(nt_model *model, const char *name, uint32_t view,
	const char *media_type)
{
	return add(model, [&] {
		tinygltf::Image image;
		image.name = utf8(name);
		image.bufferView = reference(view);
		image.mimeType = media_type;
		return append(model->document.images, std::move(image));
	});
}

void nt_model_require(nt_model *model, const char *extension)
{
	add(model, [&] {
		use_extension(model->document.extensionsUsed, extension);
		use_extension(model->document.extensionsRequired, extension);
		return 0;
	});
}

uint32_t nt_model_texture(nt_model *model, uint32_t image, const char *extension)
{
	return add(model, [&] {
		tinygltf::Texture texture;
		if (!extension) {
			texture.source = reference(image);
		} else {
			texture.extensions[extension] = tinygltf::Value(
				tinygltf::Value::Object{{"source", tinygltf::Value(reference(image))}});
			use_extension(model->document.extensionsUsed, extension);
			use_extension(model->document.extensionsRequired, extension);
		}
		return append(model->document.textures, std::move(texture));
	});
}

uint32_t nt_model_add_material(nt_model *model, const nt_model_material *material)
{
	return add(model, [&] {
		tinygltf::Material item;
		tinygltf::PbrMetallicRoughness &pbr = item.pbrMetallicRoughness;
		item.name = utf8(material->name);
		for (size_t i = 0; i < 4; i++)
			pbr.baseColorFactor[i] = shortest(material->base_color[i]);
		pbr.metallicFactor = shortest(material->metallic);
		pbr.roughnessFactor = shortest(material->roughness);
		pbr.baseColorTexture.index = reference(material->base_color_texture);
		item.emissiveTexture.index = reference(material->emissive_texture);
		item.normalTexture.index = reference(material->normal_texture);
		item.normalTexture.scale = shortest(material->normal_scale);
		if (material->blend)
			item.alphaMode = "BLEND";
		set_emissive(model, item, material->emissive);
		return append(model->document.materials, std::move(item));
	});
}

uint32_t nt_model_mesh(nt_model *model, const char *name)
{
	return add(model, [&] {
		tinygltf::Mesh mesh;
		mesh.name = utf8(name);
		return append(model->document.meshes, std::move(mesh));
	});
}

void nt_model_primitive(nt_model *model, uint32_t mesh, const nt_model_attribute *attributes,
	size_t attribute_count, uint32_t indices, uint32_t material)
{
	add(model, [&] {
		tinygltf::Primitive primitive;
		primitive.mode = TINYGLTF_MODE_TRIANGLES;
		primitive.indices = reference(indices);
		primitive.material = reference(material);
		for (size_t i = 0; i < attribute_count; i++)
			primitive.attributes[attributes[i].name] = reference(attributes[i].accessor);
		return append(model->document.meshes.at(mesh).primitives, std::move(primitive));
	});
}

uint32_t nt_model_node(nt_model *model, const char *name, uint32_t mesh, const double matrix[16])
{
	return add(model, [&] {
		tinygltf::Node node;
		node.name = utf8(name);
		node.mesh = reference(mesh);
		if (!is_identity(matrix))
			node.matrix.assign(matrix, matrix + 16);
		if (model->document.scenes.empty()) {
			model->document.scenes.emplace_back();
			model->document.defaultScene = 0;
		}
		const size_t index = append(model->document.nodes, std::move(node));
		model->document.scenes[0].nodes.push_back(static_cast<int>(index));
		return index;
	});
}

nmtan_status nt_model_json(nt_model *model, uint64_t buffer_length, nt_model_buffer buffer,
	const char *uri, nt_model_text *text, nt_error *error)
{
	*text = {nullptr, 0, 0};
	if (model->status != NMTAN_OK) {
		if (error)
			*error = model->error;
		return model->status;
	}
	return nt::guard(error, library, [&] {
		tinygltf::TinyGLTF writer;
		writer.SetImageWriter(keep_image, nullptr);
		std::ostringstream stream;
		writer.WriteGltfSceneToStream(&model->document, stream, false, false);
		std::string json = stream.str();
		while (!json.empty() && json.back() != '}')
			json.pop_back();
		json.pop_back();
		size_t cut = std::string::npos;
		const size_t before = json.size();
		if (buffer_length)
			json += buffers_member(buffer_length, buffer, uri, cut);
		json += "}";
		text->data = static_cast<char *>(std::malloc(json.size()));
		if (!text->data)
			throw std::bad_alloc();
		std::memcpy(text->data, json.data(), json.size());
		text->size = json.size();
		text->cut = cut == std::string::npos ? json.size() : before + cut;
		return NMTAN_OK;
	});
}

void nt_model_text_free(nt_model_text *text)
{
	std::free(text->data);
	*text = {nullptr, 0, 0};
}

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
	*array = {};
	if (primitive >= nt_reread_primitive_count(model, mesh))
		return nt_fail(error, NMTAN_ERROR_INPUT, "mesh %zu has no primitive %zu", mesh, primitive);
	return nt::guard(error, library, [&]() -> nmtan_status {
		const tinygltf::Primitive &item = model->document.meshes[mesh].primitives[primitive];
		int index = item.indices;
		if (name) {
			const auto found = item.attributes.find(name);
			if (found == item.attributes.end())
				return NMTAN_OK;
			index = found->second;
		} else if (index < 0) {
			return NMTAN_OK;
		}
		const char *fault = resolve(model->document, model->rows, index, array);
		if (!fault)
			return NMTAN_OK;
		char pointer[256];
		std::snprintf(pointer, sizeof pointer, "/meshes/%zu/primitives/%zu/%s%s", mesh, primitive,
			name ? "attributes/" : "indices", name ? name : "");
		return nt_fail_pointer(error, NMTAN_ERROR_INPUT, pointer, "%s", fault);
	});
}

// The extension of a compressed primitive; null: none.
static const tinygltf::Value *block_of(const nt_reread *model, size_t mesh, size_t primitive)
{
	if (primitive >= nt_reread_primitive_count(model, mesh))
		return nullptr;
	const tinygltf::ExtensionMap &extensions = model->document.meshes[mesh].primitives[primitive].extensions;
	const auto found = extensions.find(draco);
	return found == extensions.end() || !found->second.IsObject() ? nullptr : &found->second;
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
