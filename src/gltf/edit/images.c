/* SPDX-License-Identifier: MIT */
/*
 * Images of a patched document. They are linked where they are, so that none is opened, unless they have
 * to move into the output or beside it. An image that cannot be read is a finding and stays a link.
 */
#include "gltf/edit/images.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "file/uri.h"

nt_images nt_gltf_images_choice(const nt_write_options *options, bool same_container)
{
	if (options->images != NT_IMAGES_DEFAULT)
		return options->images;
	return options->format == NT_FORMAT_GLB && !same_container ? NT_IMAGES_EMBED : NT_IMAGES_LINK;
}

const char *nt_gltf_external_uri(const nt_json_value *object, size_t *length)
{
	const char *uri = nt_json_get_string(nt_json_find(object, "uri"), length);
	return uri && !nt_uri_is_data(uri, *length) ? uri : NULL;
}

/* ---- the way from folder to folder ---- */

/* Real path of a file's folder; NULL: cannot be found. */
static char *real_folder(nt_arena *arena, const char *path, bool *exhausted)
{
	const char *slash = strrchr(path, '/');
	char *folder = nt_arena_text(arena, path, slash ? (size_t)(slash - path) + 1 : 0);
	*exhausted |= !folder;
	return folder ? realpath(*folder ? folder : ".", NULL) : NULL;
}

static size_t common_length(const char *a, const char *b)
{
	size_t common = 0;
	for (size_t i = 0;; i++) {
		const bool a_ends = a[i] == '\0' || a[i] == '/', b_ends = b[i] == '\0' || b[i] == '/';
		if (a_ends && b_ends)
			common = i;
		if (a[i] != b[i] || a[i] == '\0')
			return common;
	}
}

static void append_way(nt_buffer *way, const char *from, const char *to)
{
	/* The root is the only folder whose path ends in a slash. */
	from = strcmp(from, "/") == 0 ? "" : from;
	to = strcmp(to, "/") == 0 ? "" : to;
	const size_t common = common_length(from, to);
	for (const char *at = from + common; *at; at++)
		if (*at == '/')
			nt_buffer_text(way, "../");
	if (to[common] == '/') {
		nt_uri_append_path(way, to + common + 1);
		nt_buffer_text(way, "/");
	}
}

nt_status nt_gltf_link_prefix(nt_arena *arena, const char *from, const char *to, const char **prefix,
	nt_error *error)
{
	bool exhausted = false;
	char *from_folder = real_folder(arena, from, &exhausted);
	char *to_folder = real_folder(arena, to, &exhausted);
	nt_buffer way = {0};
	if (from_folder && to_folder && strcmp(from_folder, to_folder) != 0)
		append_way(&way, from_folder, to_folder);
	*prefix = nt_arena_text(arena, way.data ? way.data : "", way.size);
	exhausted |= way.failed || !*prefix;
	nt_buffer_free(&way);
	free(from_folder);
	free(to_folder);
	return exhausted ? nt_fail_memory(error) : NT_OK;
}

/* Whether a URI is taken from the document's folder: not "/x", nor anything with a colon in its first
 * segment, which is a scheme, a drive, or no URI at all (":"), and means the same from everywhere. */
static bool is_relative(const char *uri, size_t length)
{
	size_t first = 0;
	while (first < length && !strchr("/?#", uri[first]))
		first++;
	return length > 0 && uri[0] != '/' && !memchr(uri, ':', first);
}

nt_status nt_gltf_link(nt_gltf_container *c, nt_json_value *object)
{
	size_t length;
	const char *uri = nt_gltf_external_uri(object, &length);
	if (!uri || !*c->link_prefix || !is_relative(uri, length))
		return NT_OK;
	nt_buffer text = {0};
	nt_buffer_text(&text, c->link_prefix);
	nt_buffer_append(&text, uri, length);
	if (!text.failed)
		nt_json_set_string(c->json, nt_json_put(c->json, object, "uri"), text.data, text.size);
	const bool failed = text.failed;
	nt_buffer_free(&text);
	return failed ? nt_fail_memory(c->error) : NT_OK;
}

/* ---- reading ---- */

/* By content; NULL: not a kind that glTF or its extensions carry. */
static const char *media_type(const nt_file *file)
{
	static const struct {
		const char *bytes;
		size_t at, size;
		const char *type;
	} kinds[] = {
		{"\x89PNG\r\n\x1a\n", 0, 8, "image/png"},
		{"\xff\xd8\xff", 0, 3, "image/jpeg"},
		{"WEBP", 8, 4, "image/webp"},
		{"\xabKTX 20\xbb", 0, 8, "image/ktx2"},
		{"ftypavif", 4, 8, "image/avif"},
		{"DDS ", 0, 4, "image/vnd-ms.dds"},
	};
	for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
		if (file->size >= kinds[i].at + kinds[i].size &&
			memcmp(file->data + kinds[i].at, kinds[i].bytes, kinds[i].size) == 0)
			return kinds[i].type;
	return NULL;
}

/* Opens the file of an image; a finding and *file NULL where that is not possible. */
static nt_status open_image(nt_gltf_container *c, size_t index, const char *uri, size_t length,
	const nt_file **file)
{
	*file = NULL;
	const char *path;
	nt_file opened;
	nt_error error;
	nt_error_clear(&error);
	nt_status status = nt_uri_resolve(&c->arena, c->document->path, uri, length,
		c->document->allow_outside, &path, &error);
	if (!status)
		status = nt_file_open(&opened, path, &error);
	if (status == NT_ERROR_MEMORY)
		return nt_fail_memory(c->error);
	if (status) {
		nt_place place;
		nt_place_clear(&place);
		snprintf(place.pointer, sizeof place.pointer, "/images/%zu", index);
		nt_finding_add(&c->patcher->scene->findings, NT_CODE_IMAGE_MISSING, &place, 1, "%s",
			error.message);
		return NT_OK;
	}
	if (!nt_grow((void **)&c->images, &c->image_capacity, c->image_count + 1, sizeof *c->images)) {
		nt_file_close(&opened);
		return nt_fail_memory(c->error);
	}
	c->images[c->image_count] = opened;
	*file = &c->images[c->image_count++];
	return NT_OK;
}

/* ---- moving ---- */

static nt_status embed_in_view(nt_gltf_container *c, nt_json_value *image, const nt_file *file,
	const char *type)
{
	uint32_t buffer, view;
	nt_status status =
		nt_layout_choose_buffer(&c->patcher->layout, 0, &buffer, c->error);
	if (!status)
		status = nt_layout_add_view(&c->patcher->layout, buffer, file->data, file->size, 0, 0,
			&view, c->error);
	if (status)
		return status;
	nt_json_remove(c->json, image, "uri");
	nt_json_set_string(c->json, nt_json_put(c->json, image, "mimeType"), type, strlen(type));
	nt_json_set_uint64(c->json, nt_json_put(c->json, image, "bufferView"), view);
	return NT_OK;
}

static nt_status embed_as_data(nt_gltf_container *c, nt_json_value *image, const nt_file *file,
	const char *type)
{
	nt_buffer uri = {0};
	nt_uri_append_data(&uri, type, file->data, file->size);
	if (!uri.failed)
		nt_json_set_string(c->json, nt_json_put(c->json, image, "uri"), uri.data, uri.size);
	const bool failed = uri.failed;
	nt_buffer_free(&uri);
	return failed ? nt_fail_memory(c->error) : NT_OK;
}

static nt_status embed_image(nt_gltf_container *c, size_t index, nt_json_value *image)
{
	size_t length;
	const char *uri = nt_gltf_external_uri(image, &length);
	const nt_file *file;
	const nt_status status = open_image(c, index, uri, length, &file);
	if (status)
		return status;
	const char *type = file ? media_type(file) : NULL;
	if (!type)
		return nt_gltf_link(c, image);
	return c->to_glb ? embed_in_view(c, image, file, type) : embed_as_data(c, image, file, type);
}

/* Copies an image beside the output, under its own name where that is to be had. */
static nt_status copy_image(nt_gltf_container *c, size_t index, nt_json_value *image)
{
	size_t length;
	const char *uri = nt_gltf_external_uri(image, &length);
	if (!*c->link_prefix)
		return NT_OK; /* it is there already */
	const nt_file *file;
	nt_status status = open_image(c, index, uri, length, &file);
	if (status || !file)
		return status ? status : nt_gltf_link(c, image);
	const char *source;
	status = nt_uri_resolve(&c->arena, c->document->path, uri, length, c->document->allow_outside,
		&source, c->error);
	if (status)
		return status;
	const char *slash = strrchr(source, '/'), *name = slash ? slash + 1 : source;
	const char *folder_end = strrchr(c->options->path, '/');
	const size_t folder = folder_end ? (size_t)(folder_end - c->options->path) + 1 : 0;
	char *path = nt_arena_alloc(&c->arena, folder + strlen(name) + 1, 1);
	if (!path)
		return nt_fail_memory(c->error);
	memcpy(path, c->options->path, folder);
	strcpy(path + folder, name);
	nt_sink *sink;
	status = nt_output_add(c->output, path, NT_ROLE_IMAGE, &sink, c->error);
	if (!status)
		status = nt_sink_copy(sink, file, 0, file->size, c->error);
	if (!status)
		status = nt_output_settle(c->output, sink, c->error);
	if (status)
		return status;
	nt_buffer new_uri = {0};
	nt_uri_append_path(&new_uri, nt_sink_name(sink, false));
	const bool failed = new_uri.failed;
	if (!failed)
		nt_json_set_string(c->json, nt_json_put(c->json, image, "uri"), new_uri.data, new_uri.size);
	nt_buffer_free(&new_uri);
	return failed ? nt_fail_memory(c->error) : NT_OK;
}

nt_status nt_gltf_move_images(nt_gltf_container *c)
{
	const nt_images choice = nt_gltf_images_choice(c->options, c->same_container);
	const size_t count = nt_json_count(nt_gltf_root_member(c->document, "images"));
	nt_status status = NT_OK;
	for (size_t i = 0; !status && i < count; i++) {
		/* embedding may give the root its first view, which moves the root's members */
		nt_json_value *image = nt_json_at(nt_gltf_root_member(c->document, "images"), i);
		size_t length;
		if (!nt_gltf_external_uri(image, &length))
			continue;
		if (choice == NT_IMAGES_EMBED)
			status = embed_image(c, i, image);
		else if (choice == NT_IMAGES_COPY)
			status = copy_image(c, i, image);
		else
			status = nt_gltf_link(c, image);
	}
	return status;
}
