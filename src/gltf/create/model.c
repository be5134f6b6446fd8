/* SPDX-License-Identifier: MIT */
/*
 * The JSON of a new document: see model.h. Every root array is text from the beginning: an addition appends its
 * object to the array's buffer, so that memory is the text itself and time is linear in it, whatever a hostile
 * input asks for. Members come in alphabetical order, "buffers" last.
 */
#include "gltf/create/model.h"

#include <stdlib.h>
#include <string.h>
#include "base/buffer.h"
#include "base/utf8.h"
#include "ext/number.h"

/* The arrays, in the order in which they are written. */
enum { ACCESSORS, VIEWS, IMAGES, MATERIALS, MESHES, NODES, SAMPLERS, ROOTS, TEXTURES, ARRAY_COUNT };

enum { MOST_EXTENSIONS = 16 };

typedef struct name_list {
	const char *names[MOST_EXTENSIONS];
	size_t count;
} name_list;

struct nt_model {
	const char *generator;
	nt_buffer arrays[ARRAY_COUNT]; /* objects with commas between them */
	uint32_t counts[ARRAY_COUNT];
	bool in_mesh;      /* the last mesh has no end yet */
	bool has_primitive; /* it has one */
	bool misused;
	name_list used, required;
};

/* ---- values ---- */

static void put_uint(nt_buffer *out, uint64_t value)
{
	char digits[20];
	size_t at = sizeof digits;
	do {
		digits[--at] = (char)('0' + value % 10);
	} while (value /= 10);
	nt_buffer_append(out, digits + at, sizeof digits - at);
}

static void put_float(nt_buffer *out, float value)
{
	char text[NT_NUMBER_TEXT];
	nt_buffer_append(out, text, (size_t)(nt_write_json_float(text, value) - text));
}

static void put_double(nt_buffer *out, double value)
{
	char text[NT_NUMBER_TEXT];
	nt_buffer_append(out, text, (size_t)(nt_write_json_double(text, value) - text));
}

/* One character of a string, which is ASCII. */
static void put_ascii(nt_buffer *out, char c)
{
	static const char letters[] = {['\b'] = 'b', ['\t'] = 't', ['\n'] = 'n', ['\f'] = 'f', ['\r'] = 'r'};
	if (c == '"' || c == '\\')
		nt_buffer_format(out, "\\%c", c);
	else if ((unsigned char)c < sizeof letters && letters[(unsigned char)c])
		nt_buffer_format(out, "\\%c", letters[(unsigned char)c]);
	else if ((unsigned char)c < 0x20)
		nt_buffer_format(out, "\\u%04x", (unsigned)c);
	else
		nt_buffer_append(out, &c, 1);
}

/* A string of any bytes; those that are no UTF-8 are Latin-1, where the code point is the byte. */
static void put_string(nt_buffer *out, const char *text)
{
	nt_buffer_text(out, "\"");
	while (*text) {
		const size_t length = nt_utf8_length(text, SIZE_MAX);
		const unsigned byte = (unsigned char)*text;
		if (length == 1)
			put_ascii(out, *text);
		else if (length)
			nt_buffer_append(out, text, length);
		else
			nt_buffer_append(out, (char[]){(char)(0xc0 | byte >> 6), (char)(0x80 | (byte & 0x3f))}, 2);
		text += length ? length : 1;
	}
	nt_buffer_text(out, "\"");
}

/* ---- members ---- */

/* Begins an object of an array, and says its number. */
static nt_buffer *begin_object(nt_model *model, int array, uint32_t *number)
{
	nt_buffer *out = &model->arrays[array];
	*number = model->counts[array]++;
	nt_buffer_text(out, *number ? ",{" : "{");
	return out;
}

/* A member's key, with a comma before it where something stands there already. */
static void put_key(nt_buffer *out, const char *key)
{
	const char last = out->size ? out->data[out->size - 1] : '{';
	nt_buffer_text(out, last == '{' ? "\"" : ",\"");
	nt_buffer_text(out, key);
	nt_buffer_text(out, "\":");
}

static void put_index(nt_buffer *out, const char *key, uint32_t index)
{
	if (index == NT_MODEL_NONE)
		return;
	put_key(out, key);
	put_uint(out, index);
}

static void put_name(nt_buffer *out, const char *name)
{
	if (!name || !*name)
		return;
	put_key(out, "name");
	put_string(out, name);
}

/* Exactly the floats: a reader may compare in double. */
static void put_bounds(nt_buffer *out, const char *key, const float *values, int count)
{
	if (!values)
		return;
	put_key(out, key);
	for (int i = 0; i < count; i++) {
		nt_buffer_text(out, i ? "," : "[");
		put_double(out, values[i]);
	}
	nt_buffer_text(out, "]");
}

static void put_floats(nt_buffer *out, const char *key, const float *values, int count)
{
	put_key(out, key);
	for (int i = 0; i < count; i++) {
		nt_buffer_text(out, i ? "," : "[");
		put_float(out, values[i]);
	}
	nt_buffer_text(out, "]");
}

/* A number that is not the one which is meant where none stands. */
static void put_factor(nt_buffer *out, const char *key, float value, float otherwise)
{
	if (value == otherwise)
		return;
	put_key(out, key);
	put_float(out, value);
}

static void add_name(nt_model *model, name_list *list, const char *name)
{
	for (size_t i = 0; i < list->count; i++)
		if (strcmp(list->names[i], name) == 0)
			return;
	if (list->count == MOST_EXTENSIONS)
		model->misused = true;
	else
		list->names[list->count++] = name;
}

/* A textureInfo, which the caller ends. */
static void begin_texture(nt_model *model, nt_buffer *out, const char *key, const nt_model_use *use)
{
	static const char transform[] = "KHR_texture_transform";
	put_key(out, key);
	nt_buffer_text(out, "{");
	if (use->moved) {
		add_name(model, &model->used, transform);
		nt_buffer_format(out, "\"extensions\":{\"%s\":{", transform);
		put_floats(out, "offset", use->offset, 2);
		put_floats(out, "scale", use->scale, 2);
		nt_buffer_text(out, "}}");
	}
	put_index(out, "index", use->texture);
}

static void put_texture(nt_model *model, nt_buffer *out, const char *key, const nt_model_use *use)
{
	if (use->texture == NT_MODEL_NONE)
		return;
	begin_texture(model, out, key, use);
	nt_buffer_text(out, "}");
}

/* ---- additions ---- */

nt_model *nt_model_create(const char *generator)
{
	nt_model *model = calloc(1, sizeof *model);
	if (model)
		model->generator = generator;
	return model;
}

void nt_model_free(nt_model *model)
{
	for (int i = 0; model && i < ARRAY_COUNT; i++)
		nt_buffer_free(&model->arrays[i]);
	free(model);
}

void nt_model_require(nt_model *model, const char *extension)
{
	add_name(model, &model->used, extension);
	add_name(model, &model->required, extension);
}

uint32_t nt_model_view(nt_model *model, uint64_t offset, uint64_t length, int target)
{
	uint32_t number;
	nt_buffer *out = begin_object(model, VIEWS, &number);
	nt_buffer_text(out, "\"buffer\":0,\"byteLength\":");
	put_uint(out, length);
	if (offset) {
		put_key(out, "byteOffset");
		put_uint(out, offset);
	}
	if (target != NT_GLTF_NO_TARGET)
		put_index(out, "target", (uint32_t)target);
	nt_buffer_text(out, "}");
	return number;
}

uint32_t nt_model_add_accessor(nt_model *model, const nt_model_accessor *accessor)
{
	static const char *const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
	uint32_t number;
	nt_buffer *out = begin_object(model, ACCESSORS, &number);
	put_index(out, "bufferView", accessor->view);
	put_index(out, "componentType", (uint32_t)accessor->component_type);
	put_key(out, "count");
	put_uint(out, accessor->count);
	put_bounds(out, "max", accessor->max, accessor->components);
	put_bounds(out, "min", accessor->min, accessor->components);
	if (accessor->normalized)
		nt_buffer_text(out, ",\"normalized\":true");
	put_key(out, "type");
	put_string(out, types[accessor->components - 1]);
	nt_buffer_text(out, "}");
	return number;
}

uint32_t nt_model_image_uri(nt_model *model, const char *name, const char *uri)
{
	uint32_t number;
	nt_buffer *out = begin_object(model, IMAGES, &number);
	put_name(out, name);
	put_key(out, "uri");
	put_string(out, uri);
	nt_buffer_text(out, "}");
	return number;
}

uint32_t nt_model_image_view(nt_model *model, const char *name, uint32_t view, const char *media_type)
{
	uint32_t number;
	nt_buffer *out = begin_object(model, IMAGES, &number);
	put_index(out, "bufferView", view);
	put_key(out, "mimeType");
	put_string(out, media_type);
	put_name(out, name);
	nt_buffer_text(out, "}");
	return number;
}

uint32_t nt_model_texture(nt_model *model, uint32_t image, bool clamp, const char *extension)
{
	uint32_t number;
	nt_buffer *out = begin_object(model, TEXTURES, &number);
	if (extension) {
		nt_buffer_format(out, "\"extensions\":{\"%s\":{\"source\":%u}}", extension, image);
		nt_model_require(model, extension);
	}
	/* the only sampler that is needed: what repeats has none */
	uint32_t sampler = clamp ? 0 : NT_MODEL_NONE;
	if (clamp && !model->counts[SAMPLERS])
		nt_buffer_format(begin_object(model, SAMPLERS, &sampler), "\"wrapS\":%d,\"wrapT\":%d}",
			NT_GLTF_CLAMP_TO_EDGE, NT_GLTF_CLAMP_TO_EDGE);
	put_index(out, "sampler", sampler);
	put_index(out, "source", extension ? NT_MODEL_NONE : image);
	nt_buffer_text(out, "}");
	return number;
}

/* glTF's emissiveFactor ends at 1; what is brighter is a factor and a strength, which comes back. */
static float put_emissive(nt_buffer *out, const float emissive[3])
{
	float largest = 1, factor[3];
	for (int i = 0; i < 3; i++)
		largest = emissive[i] > largest ? emissive[i] : largest;
	for (int i = 0; i < 3; i++)
		factor[i] = emissive[i] > 0 ? emissive[i] / largest : 0;
	if (factor[0] != 0 || factor[1] != 0 || factor[2] != 0)
		put_floats(out, "emissiveFactor", factor, 3);
	return largest;
}

static void put_reflection(nt_model *model, nt_buffer *out, const nt_model_material *m)
{
	const float *color = m->base_color;
	const bool white = color[0] == 1 && color[1] == 1 && color[2] == 1 && color[3] == 1;
	if (white && m->base_color_texture.texture == NT_MODEL_NONE &&
		m->metallic_roughness_texture.texture == NT_MODEL_NONE &&
		m->metallic == 1 && m->roughness == 1)
		return;
	put_key(out, "pbrMetallicRoughness");
	nt_buffer_text(out, "{");
	if (!white)
		put_floats(out, "baseColorFactor", color, 4);
	put_texture(model, out, "baseColorTexture", &m->base_color_texture);
	put_factor(out, "metallicFactor", m->metallic, 1);
	put_texture(model, out, "metallicRoughnessTexture", &m->metallic_roughness_texture);
	put_factor(out, "roughnessFactor", m->roughness, 1);
	nt_buffer_text(out, "}");
}

/* Begins an extension of a material, which is the first where nothing stands in `out`. */
static void begin_extension(nt_model *model, nt_buffer *out, const char *name)
{
	add_name(model, &model->used, name);
	nt_buffer_text(out, out->size ? "}" : "{");
	put_key(out, name);
	nt_buffer_text(out, "{");
}

/* The object of a material's extensions, without its end; nothing, where it has none. */
static void put_material_extensions(nt_model *model, nt_buffer *out, const nt_model_material *m, float strength)
{
	if (m->anisotropy != 0) {
		begin_extension(model, out, "KHR_materials_anisotropy");
		put_factor(out, "anisotropyRotation", m->anisotropy_rotation, 0);
		put_factor(out, "anisotropyStrength", m->anisotropy, 0);
	}
	if (m->clearcoat != 0) {
		begin_extension(model, out, "KHR_materials_clearcoat");
		put_factor(out, "clearcoatFactor", m->clearcoat, 0);
		put_factor(out, "clearcoatRoughnessFactor", m->clearcoat_roughness, 0);
		put_texture(model, out, "clearcoatRoughnessTexture", &m->clearcoat_roughness_texture);
		put_texture(model, out, "clearcoatTexture", &m->clearcoat_texture);
	}
	if (strength != 1) {
		begin_extension(model, out, "KHR_materials_emissive_strength");
		put_factor(out, "emissiveStrength", strength, 1);
	}
	if (m->ior != 0) {
		begin_extension(model, out, "KHR_materials_ior");
		put_factor(out, "ior", m->ior, 1.5f);
	}
	if (m->sheen != 0) {
		begin_extension(model, out, "KHR_materials_sheen");
		put_floats(out, "sheenColorFactor", (const float[]){m->sheen, m->sheen, m->sheen}, 3);
		put_texture(model, out, "sheenColorTexture", &m->sheen_texture);
		put_factor(out, "sheenRoughnessFactor", m->sheen_roughness, 0);
	}
}

uint32_t nt_model_add_material(nt_model *model, const nt_model_material *material)
{
	static const char *const modes[] = {[NT_ALPHA_MASK] = "MASK", [NT_ALPHA_BLEND] = "BLEND"};
	uint32_t number;
	nt_buffer extensions = {0};
	nt_buffer *out = begin_object(model, MATERIALS, &number);
	if (material->alpha_mode != NT_ALPHA_OPAQUE) {
		put_key(out, "alphaMode");
		put_string(out, modes[material->alpha_mode]);
	}
	const float strength = put_emissive(out, material->emissive);
	put_texture(model, out, "emissiveTexture", &material->emissive_texture);
	put_material_extensions(model, &extensions, material, strength);
	if (extensions.size) {
		put_key(out, "extensions");
		nt_buffer_append(out, extensions.data, extensions.size);
		nt_buffer_text(out, "}}");
	}
	put_name(out, material->name);
	if (material->normal_texture.texture != NT_MODEL_NONE) {
		begin_texture(model, out, "normalTexture", &material->normal_texture);
		put_factor(out, "scale", material->normal_scale, 1);
		nt_buffer_text(out, "}");
	}
	put_texture(model, out, "occlusionTexture", &material->occlusion_texture);
	put_reflection(model, out, material);
	nt_buffer_text(out, "}");
	out->failed |= extensions.failed;
	nt_buffer_free(&extensions);
	return number;
}

/* Ends the mesh that is open. */
static void end_mesh(nt_model *model)
{
	if (model->in_mesh)
		nt_buffer_text(&model->arrays[MESHES], "]}");
	model->in_mesh = false;
}

uint32_t nt_model_mesh(nt_model *model, const char *name)
{
	uint32_t number;
	end_mesh(model);
	nt_buffer *out = begin_object(model, MESHES, &number);
	put_name(out, name);
	put_key(out, "primitives");
	nt_buffer_text(out, "[");
	model->in_mesh = true;
	model->has_primitive = false;
	return number;
}

void nt_model_primitive(nt_model *model, const nt_model_attribute *attributes, size_t attribute_count,
	uint32_t indices, uint32_t material)
{
	nt_buffer *out = &model->arrays[MESHES];
	if (!model->in_mesh) {
		model->misused = true;
		return;
	}
	nt_buffer_text(out, model->has_primitive ? ",{\"attributes\":{" : "{\"attributes\":{");
	model->has_primitive = true;
	for (size_t i = 0; i < attribute_count; i++)
		put_index(out, attributes[i].name, attributes[i].accessor);
	nt_buffer_text(out, "}");
	put_index(out, "indices", indices);
	put_index(out, "material", material);
	put_index(out, "mode", NT_GLTF_TRIANGLES);
	nt_buffer_text(out, "}");
}

uint32_t nt_model_node(nt_model *model, const char *name, uint32_t mesh, const double translation[3])
{
	uint32_t number;
	nt_buffer *out = begin_object(model, NODES, &number);
	put_index(out, "mesh", mesh);
	put_name(out, name);
	if (translation[0] != 0 || translation[1] != 0 || translation[2] != 0) {
		put_key(out, "translation");
		for (int i = 0; i < 3; i++) {
			nt_buffer_text(out, i ? "," : "[");
			put_double(out, translation[i]);
		}
		nt_buffer_text(out, "]");
	}
	nt_buffer_text(out, "}");
	nt_buffer_text(&model->arrays[ROOTS], model->counts[ROOTS]++ ? "," : "");
	put_uint(&model->arrays[ROOTS], number);
	return number;
}

/* ---- the text ---- */

static void add_piece(nt_model_text *text, const char *data, size_t size)
{
	text->pieces[text->count++] = (nt_model_piece){data, size};
	text->size += size;
}

static void add_array(nt_model_text *text, const nt_model *model, int array, const char *begin, const char *end)
{
	const nt_buffer *items = &model->arrays[array];
	if (items->size == 0)
		return;
	add_piece(text, begin, strlen(begin));
	add_piece(text, items->data, items->size);
	add_piece(text, end, strlen(end));
}

static void put_extensions(nt_buffer *out, const char *key, const name_list *list)
{
	for (size_t i = 0; i < list->count; i++) {
		if (i == 0)
			nt_buffer_format(out, ",\"%s\":[\"%s\"", key, list->names[i]);
		else
			nt_buffer_format(out, ",\"%s\"", list->names[i]);
	}
	nt_buffer_text(out, list->count ? "]" : "");
}

/* The buffers' member and the document's end; where the base64 goes is after *cut bytes. */
static void put_buffers(nt_buffer *out, uint64_t length, nt_model_buffer kind, const nt_model_file *file, size_t *cut)
{
	nt_buffer_text(out, ",\"buffers\":[{\"byteLength\":");
	put_uint(out, length);
	if (kind == NT_MODEL_FILE)
		nt_buffer_format(out, ",\"uri\":\"%s\"", file->uri);
	if (kind == NT_MODEL_FILE && file->extras)
		nt_buffer_format(out, ",\"extras\":%s", file->extras);
	if (kind == NT_MODEL_EMBEDDED)
		nt_buffer_text(out, ",\"uri\":\"data:application/octet-stream;base64,");
	*cut = out->size;
	nt_buffer_text(out, kind == NT_MODEL_EMBEDDED ? "\"}]" : "}]");
}

nt_status nt_model_json(nt_model *model, uint64_t buffer_length, nt_model_buffer buffer,
	const nt_model_file *file, nt_model_text *text, nt_error *error)
{
	*text = (nt_model_text){0};
	end_mesh(model);
	nt_buffer *own = &text->own;
	nt_buffer_format(own, "\"asset\":{\"generator\":\"%s\",\"version\":\"2.0\"}", model->generator);
	const size_t asset = own->size;
	put_extensions(own, "extensionsRequired", &model->required);
	put_extensions(own, "extensionsUsed", &model->used);
	const size_t extensions = own->size;
	size_t cut = own->size;
	if (buffer_length)
		put_buffers(own, buffer_length, buffer, file, &cut);
	nt_buffer_text(own, "}");
	bool failed = own->failed;
	for (int i = 0; i < ARRAY_COUNT; i++)
		failed |= model->arrays[i].failed;
	if (failed)
		return nt_fail_memory(error);
	if (model->misused)
		return nt_fail(error, NT_ERROR_INTERNAL, "the new document is put together in a wrong way");
	add_piece(text, "{", 1);
	add_array(text, model, ACCESSORS, "\"accessors\":[", "],");
	add_piece(text, own->data, asset);
	add_array(text, model, VIEWS, ",\"bufferViews\":[", "]");
	add_piece(text, own->data + asset, extensions - asset);
	add_array(text, model, IMAGES, ",\"images\":[", "]");
	add_array(text, model, MATERIALS, ",\"materials\":[", "]");
	add_array(text, model, MESHES, ",\"meshes\":[", "]");
	add_array(text, model, NODES, ",\"nodes\":[", "]");
	add_array(text, model, SAMPLERS, ",\"samplers\":[", "]");
	add_array(text, model, ROOTS, ",\"scene\":0,\"scenes\":[{\"nodes\":[", "]}]");
	add_array(text, model, TEXTURES, ",\"textures\":[", "]");
	add_piece(text, own->data + extensions, cut - extensions);
	text->cut = text->count;
	add_piece(text, own->data + cut, own->size - cut);
	return NT_OK;
}

void nt_model_text_free(nt_model_text *text)
{
	nt_buffer_free(&text->own);
	*text = (nt_model_text){0};
}

static nt_status write_pieces(const nt_model_text *text, size_t begin, size_t end, nt_sink *sink, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = begin; i < end && status == NT_OK; i++)
		status = nt_sink_write(sink, text->pieces[i].data, text->pieces[i].size, error);
	return status;
}

nt_status nt_model_text_begin(const nt_model_text *text, nt_sink *sink, nt_error *error)
{
	return write_pieces(text, 0, text->cut, sink, error);
}

nt_status nt_model_text_end(const nt_model_text *text, nt_sink *sink, nt_error *error)
{
	return write_pieces(text, text->cut, text->count, sink, error);
}
