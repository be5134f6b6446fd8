/* SPDX-License-Identifier: MIT */
/*
 * Documents, their buffers, and primitives with the accessors that they name. Buffers are opened when the first byte of
 * them is wanted: an external file is mapped, a data URI decoded, the BIN chunk pointed at.
 */
#include "gltf/document.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "file/output.h"
#include "file/path.h"

bool nt_gltf_recognise(const unsigned char *bytes, size_t size)
{
	size_t at = size >= 3 && memcmp(bytes, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
	while (at < size && at < 4096 &&
		(bytes[at] == ' ' || bytes[at] == '\t' || bytes[at] == '\n' || bytes[at] == '\r'))
		at++;
	return at < size && bytes[at] == '{';
}

bool nt_glb_recognise(const unsigned char *bytes, size_t size)
{
	return nt_glb_has_magic(bytes, size);
}

/* ---- members ---- */

nt_json_value *nt_gltf_root_member(const nt_gltf *document, const char *name)
{
	return nt_json_find(nt_json_root(document->json), name);
}

static bool is_listed(const nt_gltf *document, const char *list, const char *extension)
{
	const nt_json_value *names = nt_gltf_root_member(document, list);
	for (size_t i = 0; i < nt_json_count(names); i++) {
		const char *name = nt_json_get_string(nt_json_at(names, i), NULL);
		if (name && strcmp(name, extension) == 0)
			return true;
	}
	return false;
}

bool nt_gltf_uses(const nt_gltf *document, const char *extension)
{
	return is_listed(document, "extensionsUsed", extension);
}

void nt_gltf_list_extension(nt_gltf *document, const char *list, const char *name)
{
	nt_json *json = document->json;
	if (!is_listed(document, list, name))
		nt_json_set_string(json, nt_json_append(json, nt_json_put(json, nt_json_root(json), list)), name,
			strlen(name));
}

void nt_gltf_remove_extension(nt_gltf *document, const char *list, const char *name)
{
	nt_json_value *names = nt_gltf_root_member(document, list);
	for (size_t i = nt_json_count(names); i-- > 0;) {
		const char *text = nt_json_get_string(nt_json_at(names, i), NULL);
		if (text && strcmp(text, name) == 0)
			nt_json_remove_at(document->json, names, i);
	}
	/* an empty list is not valid */
	if (names && nt_json_count(names) == 0)
		nt_json_remove(document->json, nt_json_root(document->json), list);
}

/* A member of the root that is there must be an array. */
static nt_status check_array(const nt_gltf *document, const char *name, nt_error *error)
{
	const nt_json_value *elements = nt_gltf_root_member(document, name);
	if (!elements || nt_json_type_of(elements) == NT_JSON_ARRAY)
		return NT_OK;
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "/%s", name);
	return nt_fail_pointer(error, NT_ERROR_INPUT, pointer, "%s, expected an array", nt_json_type_text(elements));
}

nt_status nt_gltf_check_index(const char *array, uint64_t index, size_t count, const char *from, nt_error *error)
{
	return index < count ? NT_OK : nt_fail_pointer(error, NT_ERROR_INPUT, from, "refers to %s[%llu], there are %zu",
		array, (unsigned long long)index, count);
}

nt_status nt_gltf_check_object(const nt_json_value *element, const char *pointer, nt_error *error)
{
	return nt_json_type_of(element) == NT_JSON_OBJECT ? NT_OK : nt_fail_pointer(error, NT_ERROR_INPUT, pointer,
		"%s, expected an object", nt_json_type_text(element));
}

nt_status nt_gltf_element(const nt_gltf *document, const char *array, uint64_t index,
	const char *from, const nt_json_value **element, nt_error *error)
{
	const nt_json_value *elements = nt_gltf_root_member(document, array);
	char pointer[NT_GLTF_POINTER];
	if (elements && nt_json_type_of(elements) != NT_JSON_ARRAY)
		return check_array(document, array, error);
	const nt_status status = nt_gltf_check_index(array, index, nt_json_count(elements), from, error);
	if (status)
		return status;
	*element = nt_json_at(elements, (size_t)index);
	nt_gltf_pointer(pointer, array, index);
	return nt_gltf_check_object(*element, pointer, error);
}

nt_status nt_gltf_uint(const nt_json_value *object, const char *pointer, const char *key,
	uint64_t limit, uint64_t otherwise, uint64_t *value, nt_error *error)
{
	const nt_json_value *member = nt_json_find(object, key);
	if (!member && otherwise != NT_GLTF_REQUIRED) {
		*value = otherwise;
		return NT_OK;
	}
	if (!member)
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer, "\"%s\" is missing", key);
	const bool whole = nt_json_get_uint64(member, value);
	if (whole && *value <= limit)
		return NT_OK;
	/* made for faults alone: a document asks for millions of numbers */
	char place[NT_GLTF_POINTER * 2];
	snprintf(place, sizeof place, "%s/%s", pointer, key);
	if (!whole)
		return nt_fail_pointer(error, NT_ERROR_INPUT, place,
			"%s, expected a whole number of at least 0", nt_json_type_text(member));
	return nt_fail_pointer(error, NT_ERROR_INPUT, place, "%llu, expected at most %llu",
		(unsigned long long)*value, (unsigned long long)limit);
}

/* ---- documents ---- */

/* "2.1" is version 2 of glTF; a minVersion beyond 2.0 asks for what we do not know. */
static nt_status check_version(const nt_gltf *document, nt_error *error)
{
	const nt_json_value *root = nt_json_root(document->json);
	if (nt_json_type_of(root) != NT_JSON_OBJECT)
		return nt_fail_pointer(error, NT_ERROR_INPUT, "", "%s, expected an object",
			nt_json_type_text(root));
	const nt_json_value *asset = nt_json_find(root, "asset");
	const char *version = nt_json_find_string(asset, "version", NULL);
	if (!version)
		return nt_fail_pointer(error, NT_ERROR_INPUT, "/asset/version",
			"%s, expected the version of glTF as a string",
			nt_json_type_text(nt_json_find(asset, "version")));
	const bool old = strncmp(version, "1.", 2) == 0 || strncmp(version, "0.", 2) == 0;
	if (strncmp(version, "2.", 2) != 0)
		return nt_fail_pointer(error, NT_ERROR_UNSUPPORTED, "/asset/version",
			"glTF version \"%.*s\", expected 2.0%s", NT_CUT(20, version), old ? NT_GLTF_OLD_ADVICE : "");
	const char *minimum = nt_json_find_string(asset, "minVersion", NULL);
	if (minimum && strcmp(minimum, "2.0") != 0)
		return nt_fail_pointer(error, NT_ERROR_UNSUPPORTED, "/asset/minVersion",
			"needs glTF %.*s, expected 2.0", NT_CUT(20, minimum));
	return NT_OK;
}

static nt_status parse_json(nt_gltf *document, nt_error *error)
{
	const char *text = (const char *)document->bytes;
	size_t size = document->byte_count, begin = 0;
	if (document->is_glb) {
		begin = document->glb.json.offset;
		size = document->glb.json.size;
		/* the chunk's padding is no part of the document: the next one has its own */
		while (size && text[begin + size - 1] == ' ')
			size--;
	}
	const nt_status status = nt_json_parse(&document->json, text + begin, size, "extras", error);
	if (status && error && error->place.offset != NT_NO_OFFSET)
		error->place.offset += begin;
	return status;
}

nt_status nt_gltf_create(nt_gltf **result, const nt_scene *scene, bool allow_outside,
	nt_error *error)
{
	*result = NULL;
	nt_gltf *document = nt_calloc(1, sizeof *document);
	if (!document)
		return nt_fail_memory(error);
	document->path = scene->path;
	document->bytes = scene->bytes;
	document->byte_count = scene->byte_count;
	document->allow_outside = allow_outside;
	document->written = scene->written;
	document->is_glb = nt_glb_has_magic(scene->bytes, scene->byte_count) ||
		scene->format == NT_FORMAT_GLB;
	nt_status status = NT_OK;
	if (document->is_glb)
		status = nt_glb_parse(&document->glb, &document->arena, document->bytes,
			document->byte_count, error);
	if (!status)
		status = parse_json(document, error);
	if (!status)
		status = check_version(document, error);
	/* what new elements may be appended to */
	static const char *const arrays[] = {"accessors", "bufferViews", "buffers"};
	for (size_t i = 0; !status && i < sizeof arrays / sizeof *arrays; i++)
		status = check_array(document, arrays[i], error);
	if (!status) {
		document->buffer_count = nt_json_count(nt_gltf_root_member(document, "buffers"));
		document->buffers = nt_calloc(document->buffer_count, sizeof *document->buffers);
		document->view_count = nt_json_count(nt_gltf_root_member(document, "bufferViews"));
		document->views = nt_calloc(document->view_count, sizeof *document->views);
		document->file_accessor_count = nt_json_count(nt_gltf_root_member(document, "accessors"));
		document->accessor_count = document->file_accessor_count;
		if (!document->buffers || !document->views)
			status = nt_fail_memory(error);
		for (size_t i = 0; !status && i < document->buffer_count; i++)
			document->buffers[i].number = i;
	}
	if (status) {
		nt_gltf_free(document);
		return status;
	}
	*result = document;
	return NT_OK;
}

void nt_gltf_free(void *source)
{
	nt_gltf *document = source;
	if (!document)
		return;
	for (size_t i = 0; document->buffers && i < document->buffer_count; i++) {
		nt_gltf_buffer *buffer = &document->buffers[i];
		free(buffer->decoded);
		if (buffer->opened && buffer->storage == NT_GLTF_STORED_FILE)
			nt_file_close(&buffer->file);
	}
	for (size_t i = 0; document->views && i < document->view_count; i++)
		free(document->views[i].decoded);
	if (document->free_pools)
		document->free_pools(document->pools);
	if (document->free_blocks)
		document->free_blocks(document);
	free(document->views);
	free(document->accessors);
	free(document->floats);
	free(document->users);
	free(document->view_users);
	free(document->grids);
	free(document->materials);
	nt_name_table_free(&document->animated);
	free(document->buffers);
	nt_json_free(document->json);
	nt_arena_free(&document->arena);
	free(document);
}

/* ---- buffers ---- */

/* A buffer as its JSON has it. */
static nt_status read_buffer(const nt_gltf *document, size_t index, nt_gltf_buffer *buffer, nt_error *error)
{
	const nt_json_value *json = nt_json_at(nt_gltf_root_member(document, "buffers"), index);
	char pointer[NT_GLTF_POINTER];
	nt_gltf_pointer(pointer, "buffers", buffer->number);
	nt_status status = nt_gltf_check_object(json, pointer, error);
	if (!status)
		status = nt_gltf_uint(json, pointer, "byteLength", (uint64_t)1 << 53, NT_GLTF_REQUIRED,
			&buffer->length, error);
	if (status)
		return status;
	const nt_json_value *uri = nt_json_find(json, "uri");
	size_t length = 0;
	const char *text = nt_json_get_string(uri, &length);
	if (uri && !text) {
		strcat(pointer, "/uri");
		return nt_fail_pointer(error, NT_ERROR_INPUT, pointer, "%s, expected a string",
			nt_json_type_text(uri));
	}
	if (text)
		buffer->storage = nt_uri_is_data(text, length) ? NT_GLTF_STORED_DATA : NT_GLTF_STORED_FILE;
	else if (index == 0 && document->is_glb && document->glb.has_bin)
		buffer->storage = NT_GLTF_STORED_BIN;
	else
		buffer->storage = NT_GLTF_STORED_NOWHERE;
	buffer->described = true;
	return NT_OK;
}

nt_status nt_gltf_describe_buffer(nt_gltf *document, uint64_t index, const char *from, nt_gltf_buffer **result,
	nt_error *error)
{
	const nt_status status = nt_gltf_check_index("buffers", index, document->buffer_count, from, error);
	if (status)
		return status;
	*result = &document->buffers[index];
	return (*result)->described ? NT_OK : read_buffer(document, (size_t)index, *result, error);
}

/* Names the buffer in an error of a lower room that knows no document. */
static nt_status place_error(nt_error *error, nt_status status, const char *pointer)
{
	if (error && status != NT_ERROR_MEMORY)
		snprintf(error->place.pointer, sizeof error->place.pointer, "%s", pointer);
	return status;
}

nt_status nt_gltf_resolve(nt_gltf *document, const char *uri, size_t length, const char **path, nt_error *error)
{
	const char *written = NULL;
	nt_status status = nt_uri_resolve(&document->arena, document->path, uri, length, document->allow_outside, path,
		error);
	if (!status && document->written)
		status = nt_output_written(document->written, *path, &written, error);
	*path = written ? written : *path;
	return status;
}

static nt_status open_file(nt_gltf *document, nt_gltf_buffer *buffer, const char *uri, size_t length,
	nt_error *error)
{
	nt_error ignored; /* who wants none here: below, an error carries the status */
	error = error ? error : &ignored;
	const char *path;
	nt_status status = nt_gltf_resolve(document, uri, length, &path, error);
	if (!status)
		status = nt_file_open(&buffer->file, path, NT_NAMED_BY_DOCUMENT, error);
	if (status)
		return status;
	buffer->path = path;
	buffer->bytes = buffer->file.data;
	buffer->size = buffer->file.size;
	return NT_OK;
}

static nt_status open_bytes(nt_gltf *document, nt_gltf_buffer *buffer, const nt_json_value *json,
	nt_error *error)
{
	size_t length = 0;
	const char *uri = nt_json_find_string(json, "uri", &length);
	nt_status status = NT_OK;
	switch (buffer->storage) {
	case NT_GLTF_STORED_BIN:
		buffer->bytes = document->bytes + document->glb.bin.offset;
		buffer->size = document->glb.bin.size;
		break;
	case NT_GLTF_STORED_DATA:
		status = nt_uri_decode_data(uri, length, &buffer->decoded, &buffer->size, error);
		buffer->bytes = buffer->decoded;
		break;
	case NT_GLTF_STORED_FILE:
		status = open_file(document, buffer, uri, length, error);
		break;
	case NT_GLTF_STORED_NOWHERE:
		return nt_fail(error, NT_ERROR_INPUT, document->is_glb ?
			"the buffer has no uri and there is no BIN chunk for it" :
			"the buffer has no uri");
	}
	return status;
}

nt_status nt_gltf_open_buffer(nt_gltf *document, uint64_t index, const char *from,
	nt_gltf_buffer **result, nt_error *error)
{
	nt_gltf_buffer *buffer;
	nt_status status = nt_gltf_describe_buffer(document, index, from, &buffer, error);
	if (status)
		return status;
	*result = buffer;
	if (buffer->opened)
		return NT_OK;
	char pointer[NT_GLTF_POINTER];
	snprintf(pointer, sizeof pointer, "/buffers/%zu", buffer->number);
	const nt_json_value *json = nt_json_at(nt_gltf_root_member(document, "buffers"), (size_t)index);
	status = open_bytes(document, buffer, json, error);
	if (status)
		return place_error(error, status, pointer);
	if (buffer->size > buffer->length)
		buffer->size = (size_t)buffer->length;
	if (buffer->storage == NT_GLTF_STORED_BIN || buffer->storage == NT_GLTF_STORED_FILE) {
		/* without memory a figure is missing, nothing else */
		const size_t words = buffer->size / NT_GLTF_PAGE / 64 + 1;
		buffer->pages = nt_arena_alloc(&document->arena, words, sizeof *buffer->pages);
		if (buffer->pages)
			memset(buffer->pages, 0, words * sizeof *buffer->pages);
	}
	buffer->opened = true;
	return NT_OK;
}

/* If several threads come to the same page, one counts it. */
void nt_gltf_note_read(nt_gltf *document, nt_gltf_buffer *buffer, uint64_t begin, uint64_t length)
{
	if (length == 0 || !buffer->pages)
		return;
	for (uint64_t page = begin / NT_GLTF_PAGE; page <= (begin + length - 1) / NT_GLTF_PAGE; page++) {
		uint64_t *const word = &buffer->pages[page / 64];
		const uint64_t bit = (uint64_t)1 << page % 64;
		if (__atomic_load_n(word, __ATOMIC_RELAXED) & bit ||
			__atomic_fetch_or(word, bit, __ATOMIC_RELAXED) & bit)
			continue;
		const uint64_t left = buffer->size - page * NT_GLTF_PAGE;
		__atomic_fetch_add(&document->bytes_read, left < NT_GLTF_PAGE ? left : NT_GLTF_PAGE, __ATOMIC_RELAXED);
	}
}

uint64_t nt_gltf_bytes_read(const nt_gltf *document)
{
	return (document->is_glb ? document->glb.json.offset + document->glb.json.size : document->byte_count) +
		document->bytes_read;
}

/* ---- primitives ---- */

bool nt_gltf_is_solved(const nt_mesh *mesh)
{
	return mesh->split.vertex_tangents != NULL || mesh->merged;
}

nt_json_value *nt_gltf_primitive_of(const nt_gltf *document, const nt_mesh *mesh)
{
	const nt_json_value *json =
		nt_json_at(nt_gltf_root_member(document, "meshes"), mesh->gltf_mesh);
	return nt_json_at(nt_json_find(json, "primitives"), mesh->gltf_primitive);
}

uint64_t nt_gltf_mode(const nt_json_value *primitive)
{
	uint64_t mode = NT_GLTF_TRIANGLES;
	nt_json_find_uint64(primitive, "mode", &mode);
	return mode;
}

size_t nt_gltf_vertex_bytes(const nt_gltf *document, const nt_json_value *primitive)
{
	size_t bytes = nt_json_find(nt_json_find(primitive, "attributes"), "TANGENT") ? 0 : 4 * sizeof(float);
	for (nt_gltf_use u = {0}; nt_gltf_next_use(document, primitive, &u) && !u.object;) {
		const nt_gltf_accessor *a = nt_gltf_sound_accessor(document, u.accessor);
		bytes += a ? a->element_bytes : 0;
	}
	return bytes;
}

void nt_gltf_drop_extension(nt_json *json, nt_json_value *object, const char *name)
{
	nt_json_value *extensions = nt_json_find(object, "extensions");
	nt_json_remove(json, extensions, name);
	if (nt_json_count(extensions) == 0)
		nt_json_remove(json, object, "extensions");
}

bool nt_gltf_next_use(const nt_gltf *document, const nt_json_value *primitive, nt_gltf_use *use)
{
	const nt_json_value *targets = nt_json_find(primitive, "targets");
	for (; use->object <= nt_json_count(targets); use->object++, use->member = 0) {
		use->attributes = use->object ? nt_json_at(targets, use->object - 1)
			: nt_json_find(primitive, "attributes");
		while (use->member < nt_json_count(use->attributes)) {
			uint64_t accessor;
			const nt_json_value *reference = nt_json_at(use->attributes, use->member);
			use->name = nt_json_key(use->attributes, use->member++, NULL);
			if (use->name && nt_json_get_uint64(reference, &accessor) &&
				accessor < document->accessor_count) {
				use->accessor = (uint32_t)accessor;
				return true;
			}
		}
	}
	return false;
}

uint32_t nt_gltf_reference(const nt_gltf *document, const nt_json_value *object, const char *name)
{
	uint64_t accessor;
	return nt_json_find_uint64(object, name, &accessor) && accessor < document->accessor_count ? (uint32_t)accessor
		: NT_NONE;
}

void nt_gltf_unlist_unused(nt_gltf *document, const char *name)
{
	const nt_json_value *meshes = nt_gltf_root_member(document, "meshes");
	for (size_t i = 0; i < nt_json_count(meshes); i++) {
		const nt_json_value *primitives = nt_json_find(nt_json_at(meshes, i), "primitives");
		for (size_t k = 0; k < nt_json_count(primitives); k++)
			if (nt_json_find(nt_json_find(nt_json_at(primitives, k), "extensions"), name))
				return;
	}
	nt_gltf_remove_extension(document, "extensionsRequired", name);
	nt_gltf_remove_extension(document, "extensionsUsed", name);
}
