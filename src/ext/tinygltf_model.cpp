// SPDX-License-Identifier: MIT
//
// tinygltf behind a C header: its model and writer for new documents. Reading back is in tinygltf_reread.cpp.
// Debian's libtinygltf has the implementation; the header is not compiled a second time.
//
// What the writer does not do well is kept from it. It wants the bytes of buffers, so it gets none and their one
// object is appended to the text, where it is cut in two around a data URI. It writes null for empty nodes, scenes
// and attribute lists, so none is made; it throws on invalid UTF-8, so names are converted.
#include "ext/tinygltf.h"
#include "base/utf8.h"
#include "ext/guard.hpp"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include <tiny_gltf.h>

struct nt_model {
	tinygltf::Model document;
	nt_status status = NT_OK; // of the first addition that failed
	nt_error error;
};

namespace {

const char library[] = "tinygltf";

// Text that may be any bytes as UTF-8.
std::string utf8(const char *text)
{
	std::string result;
	while (text && *text) {
		const size_t length = nt_utf8_length(text, SIZE_MAX);
		if (length) {
			result.append(text, length);
			text += length;
		} else { // Latin-1: the code point is the byte
			const unsigned byte = static_cast<unsigned char>(*text++);
			result += static_cast<char>(0xc0 | byte >> 6);
			result += static_cast<char>(0x80 | (byte & 0x3f));
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
	if (model->status != NT_OK)
		return NT_MODEL_NONE;
	uint32_t index = NT_MODEL_NONE;
	model->status = nt::guard(&model->error, library, [&] {
		index = static_cast<uint32_t>(body());
		return NT_OK;
	});
	return model->status == NT_OK ? index : NT_MODEL_NONE;
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
std::string buffers_member(uint64_t length, nt_model_buffer kind, const nt_model_file *file, size_t &cut)
{
	std::string member = ",\"buffers\":[{\"byteLength\":" + std::to_string(length);
	cut = std::string::npos;
	if (kind == NT_MODEL_FILE) {
		member += ",\"uri\":\"" + std::string(file->uri) + "\"";
		if (file->extras)
			member += ",\"extras\":" + std::string(file->extras);
	}
	if (kind == NT_MODEL_EMBEDDED) {
		member += ",\"uri\":\"data:application/octet-stream;base64,";
		cut = member.size();
		member += "\"";
	}
	return member + "}]";
}

} // namespace

nt_status nt_model_create(nt_model **model, const char *generator, nt_error *error)
{
	*model = nullptr;
	return nt::guard(error, library, [&] {
		std::string name = utf8(generator);
		*model = new nt_model;
		(*model)->document.asset.generator = std::move(name);
		return NT_OK;
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

nt_status nt_model_json(nt_model *model, uint64_t buffer_length, nt_model_buffer buffer,
	const nt_model_file *file, nt_model_text *text, nt_error *error)
{
	*text = {nullptr, 0, 0};
	if (model->status != NT_OK) {
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
			json += buffers_member(buffer_length, buffer, file, cut);
		json += "}";
		text->data = static_cast<char *>(std::malloc(json.size()));
		if (!text->data)
			throw std::bad_alloc();
		std::memcpy(text->data, json.data(), json.size());
		text->size = json.size();
		text->cut = cut == std::string::npos ? json.size() : before + cut;
		return NT_OK;
	});
}

void nt_model_text_free(nt_model_text *text)
{
	std::free(text->data);
	*text = {nullptr, 0, 0};
}
