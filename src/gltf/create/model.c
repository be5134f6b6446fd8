/* SPDX-License-Identifier: MIT */
/*
 * A new document: see model.h. It begins with all members of the root, so that these have their order; what is still
 * empty at the end goes. A view's bytes are noted, and written when all is known.
 *
 * Accessors, views, meshes and nodes are text from the beginning, since an OBJ may have any number of them: as JSON
 * values, those of 100 000 objects took 1.7 times the memory of the whole conversion, and twice its time.
 */
#include "gltf/create/model.h"

#include <string.h>
#include "base/text.h"
#include "ext/linked.h"

static const char *const root_members[] = {"accessors", "asset", "bufferViews", "extensionsRequired", "extensionsUsed",
	"images", "materials", "meshes", "nodes", "samplers", "scene", "scenes", "textures", "buffers"};

nt_status nt_model_create(nt_model *model, nt_error *error)
{
	*model = (nt_model){.document = nt_calloc(1, sizeof *model->document)};
	if (!model->document)
		return nt_fail_memory(error);
	nt_status status = nt_json_parse(&model->document->json, "{}", 2, NULL, error);
	nt_json *json = model->json = model->document->json;
	for (size_t i = 0; !status && i < sizeof root_members / sizeof *root_members; i++)
		nt_json_put(json, nt_json_root(json), root_members[i]);
	if (!status)
		status = nt_edits_create_new(&model->edits, model->document, error);
	if (!status)
		status = nt_edits_choose_buffer(&model->edits, NT_NONE, &model->buffer, error);
	if (status)
		return status;
	nt_json_value *asset = nt_gltf_root_member(model->document, "asset");
	nt_model_put_string(model, asset, "generator", "nmtan " NMTAN_VERSION_STRING);
	nt_model_put_string(model, asset, "version", "2.0");
	return NT_OK;
}

void nt_model_free(nt_model *model)
{
	if (model->edits.document)
		nt_edits_free(&model->edits);
	for (int i = 0; i < NT_MODEL_LISTS; i++)
		nt_buffer_free(&model->lists[i]);
	nt_gltf_free(model->document);
}

/* Lets the text of a list be the elements of an array. */
static void open_list(nt_model *model, nt_model_list list, nt_json_value *array)
{
	if (model->counts[list])
		nt_json_set_open_array(model->json, array);
	model->failed |= model->lists[list].failed;
}

nt_status nt_model_finish(nt_model *model, nt_error *error)
{
	nt_json *json = model->json;
	nt_json_value *root = nt_json_root(json);
	model->edits.lists = model->lists;
	model->edits.list_count = NT_MODEL_LISTS;
	if (model->in_mesh)
		nt_buffer_text(&model->lists[NT_MODEL_MESHES], "]}");
	open_list(model, NT_MODEL_ACCESSORS, nt_json_find(root, "accessors"));
	open_list(model, NT_MODEL_VIEWS, nt_json_find(root, "bufferViews"));
	open_list(model, NT_MODEL_MESHES, nt_json_find(root, "meshes"));
	open_list(model, NT_MODEL_NODES, nt_json_find(root, "nodes"));
	if (model->counts[NT_MODEL_ROOTS]) {
		nt_json_set_uint64(json, nt_json_find(root, "scene"), 0);
		nt_json_value *scene = nt_json_append(json, nt_json_find(root, "scenes"));
		open_list(model, NT_MODEL_ROOTS, nt_json_put(json, scene, "nodes"));
	}
	for (size_t i = 0; i < sizeof root_members / sizeof *root_members; i++)
		if (nt_json_type_of(nt_json_find(root, root_members[i])) == NT_JSON_NULL)
			nt_json_remove(json, root, root_members[i]);
	return model->failed || nt_json_failed(json) ? nt_fail_memory(error) : NT_OK;
}

/* ---- members ---- */

nt_json_value *nt_model_append(nt_model *model, const char *array, uint32_t *number)
{
	nt_json_value *elements = nt_gltf_root_member(model->document, array);
	*number = (uint32_t)nt_json_count(elements);
	return nt_json_append(model->json, elements);
}

void nt_model_put_index(nt_model *model, nt_json_value *object, const char *key, uint32_t index)
{
	if (index != NT_MODEL_NONE)
		nt_json_put_uint64(model->json, object, key, index);
}

/* Bytes that are no UTF-8 are Latin-1, where the code point is the byte. */
static void make_utf8(nt_buffer *out, const char *text)
{
	for (size_t length; *text; text += length ? length : 1) {
		const unsigned byte = (unsigned char)*text;
		length = nt_utf8_length(text, SIZE_MAX);
		if (length)
			nt_buffer_append(out, text, length);
		else
			nt_buffer_append(out, (char[]){(char)(0xc0 | byte >> 6), (char)(0x80 | (byte & 0x3f))}, 2);
	}
}

void nt_model_put_string(nt_model *model, nt_json_value *object, const char *key, const char *text)
{
	if (!text || !*text)
		return;
	nt_buffer utf8 = {0};
	make_utf8(&utf8, text);
	if (!utf8.failed)
		nt_json_set_string(model->json, nt_json_put(model->json, object, key), utf8.data, utf8.size);
	model->failed |= utf8.failed;
	nt_buffer_free(&utf8);
}

void nt_model_put_floats(nt_model *model, nt_json_value *object, const char *key, const float *values, size_t count)
{
	nt_json_value *array = nt_json_put(model->json, object, key);
	for (size_t i = 0; i < count; i++)
		nt_json_set_float(model->json, nt_json_append(model->json, array), values[i]);
}

void nt_model_require(nt_model *model, const char *extension)
{
	nt_gltf_list_extension(model->document, "extensionsUsed", extension);
	nt_gltf_list_extension(model->document, "extensionsRequired", extension);
}

uint32_t nt_model_texture(nt_model *model, uint32_t image, bool clamp, const char *extension)
{
	uint32_t number, sampler = clamp ? 0 : NT_MODEL_NONE;
	nt_json *json = model->json;
	nt_json_value *texture = nt_model_append(model, "textures", &number);
	nt_json_set_object(json, texture);
	if (extension) {
		nt_json_put_uint64(json, nt_json_put(json, nt_json_put(json, texture, "extensions"), extension),
			"source", image);
		nt_model_require(model, extension);
	}
	/* the only sampler that is needed: what repeats has none */
	if (clamp && !nt_json_count(nt_gltf_root_member(model->document, "samplers"))) {
		nt_json_value *clamped = nt_model_append(model, "samplers", &sampler);
		nt_json_put_uint64(json, clamped, "wrapS", NT_GLTF_CLAMP_TO_EDGE);
		nt_json_put_uint64(json, clamped, "wrapT", NT_GLTF_CLAMP_TO_EDGE);
	}
	nt_model_put_index(model, texture, "sampler", sampler);
	nt_model_put_index(model, texture, "source", extension ? NT_MODEL_NONE : image);
	return number;
}

/* ---- lists of text ---- */

/* Both end what is written at `end`, where there is room: a member with its key and what is before it. */
static char *put_index(char *end, const char *key, uint64_t number)
{
	return nt_gltf_put_number(nt_gltf_put_text(end, key), number);
}

static char *put_doubles(char *end, const char *key, const double *values, int count)
{
	end = nt_gltf_put_text(end, key);
	for (int i = 0; i < count; i++) {
		*end++ = i ? ',' : '[';
		end = nt_write_json_double(end, values[i]);
	}
	return nt_gltf_put_text(end, "]");
}

/* Exactly the floats: a reader may compare in double. */
static char *put_bounds(char *end, const char *key, const float *values, int count)
{
	double exact[4];
	for (int i = 0; values && i < count; i++)
		exact[i] = values[i];
	return values ? put_doubles(end, key, exact, count) : end;
}

/* Appends text, and says the number of the element that it begins. */
static uint32_t add_element(nt_model *model, nt_model_list list, const char *text, const char *end)
{
	nt_buffer *out = &model->lists[list];
	if (model->counts[list])
		nt_buffer_text(out, ",");
	nt_buffer_append(out, text, (size_t)(end - text));
	return model->counts[list]++;
}

/* A "name" and what comes behind it, as a string of JSON; nothing, without a name. */
static void put_name(nt_model *model, nt_buffer *out, const char *name, const char *behind)
{
	char made[NT_JSON_ESCAPE];
	nt_buffer utf8 = {0};
	if (!name || !*name)
		return;
	make_utf8(&utf8, name);
	nt_buffer_text(out, "\"name\":\"");
	for (size_t i = 0; i < utf8.size; i++) {
		const size_t length = nt_json_escape((unsigned char)utf8.data[i], made);
		nt_buffer_append(out, length ? made : &utf8.data[i], length ? length : 1);
	}
	nt_buffer_text(out, "\"");
	nt_buffer_text(out, behind);
	model->failed |= utf8.failed;
	nt_buffer_free(&utf8);
}

uint32_t nt_model_view(nt_model *model, uint64_t length, int target, nt_view_writer write, const void *user)
{
	char text[160], *end = text;
	const uint64_t offset = (model->buffer_size + 3) & ~(uint64_t)3;
	end = put_index(end, "{\"buffer\":", model->buffer);
	end = put_index(end, ",\"byteLength\":", length);
	if (offset)
		end = put_index(end, ",\"byteOffset\":", offset);
	if (target != NT_GLTF_NO_TARGET)
		end = put_index(end, ",\"target\":", (uint64_t)target);
	end = nt_gltf_put_text(end, "}");
	model->buffer_size = offset + length;
	model->failed |= nt_edits_add_written(&model->edits, model->buffer, (size_t)length, write, user, NULL) != NT_OK;
	return add_element(model, NT_MODEL_VIEWS, text, end);
}

uint32_t nt_model_add_accessor(nt_model *model, const nt_model_accessor *accessor)
{
	static const char *const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
	char text[192 + 2 * 4 * NT_NUMBER_TEXT], *end = text;
	end = put_index(end, "{\"bufferView\":", accessor->view);
	end = put_index(end, ",\"componentType\":", (uint64_t)accessor->component_type);
	end = put_index(end, ",\"count\":", accessor->count);
	end = put_bounds(end, ",\"max\":", accessor->max, accessor->components);
	end = put_bounds(end, ",\"min\":", accessor->min, accessor->components);
	if (accessor->normalized)
		end = nt_gltf_put_text(end, ",\"normalized\":true");
	end = nt_gltf_put_text(nt_gltf_put_text(end, ",\"type\":\""), types[accessor->components - 1]);
	return add_element(model, NT_MODEL_ACCESSORS, text, nt_gltf_put_text(end, "\"}"));
}

uint32_t nt_model_mesh(nt_model *model, const char *name)
{
	static const char begin[] = "{";
	nt_buffer *out = &model->lists[NT_MODEL_MESHES];
	if (model->in_mesh)
		nt_buffer_text(out, "]}");
	const uint32_t number = add_element(model, NT_MODEL_MESHES, begin, begin + 1);
	put_name(model, out, name, ",");
	nt_buffer_text(out, "\"primitives\":[");
	model->in_mesh = true;
	return number;
}

void nt_model_primitive(nt_model *model, const nt_model_attribute *attributes, size_t attribute_count,
	uint32_t indices, uint32_t material)
{
	char text[512], *end = text;
	nt_buffer *out = &model->lists[NT_MODEL_MESHES];
	if (out->size && out->data[out->size - 1] == '}')
		nt_buffer_text(out, ",");
	end = nt_gltf_put_text(end, "{\"attributes\":{");
	for (size_t i = 0; i < attribute_count; i++) {
		end = nt_gltf_put_text(nt_gltf_put_text(end, i ? ",\"" : "\""), attributes[i].name);
		end = put_index(end, "\":", attributes[i].accessor);
	}
	end = nt_gltf_put_text(end, "}");
	if (indices != NT_MODEL_NONE)
		end = put_index(end, ",\"indices\":", indices);
	end = put_index(end, ",\"material\":", material);
	end = nt_gltf_put_text(put_index(end, ",\"mode\":", NT_GLTF_TRIANGLES), "}");
	nt_buffer_append(out, text, (size_t)(end - text));
}

void nt_model_node(nt_model *model, const char *name, uint32_t mesh, const double translation[3])
{
	char text[64 + 3 * NT_NUMBER_TEXT], *end = put_index(text, "{\"mesh\":", mesh);
	nt_buffer *out = &model->lists[NT_MODEL_NODES];
	if (name && *name)
		*end++ = ',';
	const uint32_t number = add_element(model, NT_MODEL_NODES, text, end);
	put_name(model, out, name, "");
	end = text;
	if (translation[0] != 0 || translation[1] != 0 || translation[2] != 0)
		end = put_doubles(end, ",\"translation\":", translation, 3);
	end = nt_gltf_put_text(end, "}");
	nt_buffer_append(out, text, (size_t)(end - text));
	add_element(model, NT_MODEL_ROOTS, text, nt_gltf_put_number(text, number));
}
