/* SPDX-License-Identifier: MIT */
/*
 * Images of an edited document. They are linked where they are, so that none is opened, unless they have
 * to move into the output or beside it: where that is wanted, or where the output's folder does not have them. An image
 * that cannot be read is a finding and keeps its name, since clients refuse names that leave a folder.
 */
#include "gltf/edit/edit.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/hash_index.h"
#include "file/input.h"
#include "file/path.h"

/* ---- external files of a document, named from another folder ---- */

const char *nt_gltf_external_uri(const nt_json_value *object, size_t *length)
{
	const char *uri = nt_json_find_string(object, "uri", length);
	return uri && !nt_uri_is_data(uri, *length) ? uri : NULL;
}

nt_status nt_gltf_link_prefix(nt_arena *arena, const char *from, const char *to, const char **prefix,
	nt_error *error)
{
	nt_buffer from_folder = {0}, to_folder = {0}, way = {0};
	nt_error failure;
	nt_status status = nt_link_folder(&from_folder, from, &failure);
	if (!status)
		status = nt_link_folder(&to_folder, to, &failure);
	if (!status) {
		if (to_folder.size != 1) /* the root's path ends in a slash already */
			nt_buffer_text(&to_folder, "/");
		if (!to_folder.failed)
			nt_link_uri(&way, from_folder.data, to_folder.data);
	}
	*prefix = nt_arena_text(arena, way.data ? way.data : "", way.size);
	const bool failed = to_folder.failed || way.failed || !*prefix;
	nt_buffer_free(&from_folder);
	nt_buffer_free(&to_folder);
	nt_buffer_free(&way);
	if (failed)
		return nt_fail_memory(error);
	if (status == NT_OK || status == NT_ERROR_MISSING)
		return NT_OK;
	*error = failure;
	return status;
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

/* Whether the steps of a path lead out of the folder where they begin. */
static bool leads_out(const char *path)
{
	size_t depth = 0;
	for (const char *step = path; *step;) {
		const size_t length = strcspn(step, "/\\");
		const bool up = length == 2 && memcmp(step, "..", 2) == 0;
		if (up && depth == 0)
			return true;
		if (up)
			depth--;
		else if (length > 1 || (length == 1 && *step != '.'))
			depth++;
		step += length + (step[length] != '\0');
	}
	return false;
}

bool nt_gltf_link_leaves(const nt_json_value *object, const char *prefix)
{
	size_t length;
	const char *uri = nt_gltf_external_uri(object, &length);
	if (!uri || !*prefix || !is_relative(uri, length))
		return false;
	nt_buffer path = {0};
	nt_uri_append_decoded(&path, prefix, strlen(prefix));
	nt_uri_append_decoded(&path, uri, length);
	const bool leaves = path.failed || leads_out(path.data);
	nt_buffer_free(&path);
	return leaves;
}

void nt_gltf_tell(nt_scene *scene, const char *array, size_t index, nt_code code, const char *text)
{
	nt_place place;
	nt_place_clear(&place);
	snprintf(place.pointer, sizeof place.pointer, "/%s/%zu", array, index);
	nt_finding_add(&scene->findings, code, &place, 1, "%s", text);
}

nt_status nt_gltf_link(nt_json *json, nt_json_value *object, const char *prefix, nt_error *error)
{
	size_t length;
	const char *uri = nt_gltf_external_uri(object, &length);
	if (!uri || !*prefix || !is_relative(uri, length))
		return NT_OK;
	nt_buffer text = {0};
	nt_buffer_text(&text, prefix);
	nt_buffer_append(&text, uri, length);
	if (!text.failed)
		nt_json_set_string(json, nt_json_put(json, object, "uri"), text.data, text.size);
	const bool failed = text.failed;
	nt_buffer_free(&text);
	return failed ? nt_fail_memory(error) : NT_OK;
}

/* ---- images ---- */

nt_images nt_gltf_images_choice(const nt_write_options *options, const nt_gltf *document)
{
	const bool becomes_glb = options->format == NT_FORMAT_GLB && !document->is_glb;
	return options->images == NT_IMAGES_DEFAULT && becomes_glb ? NT_IMAGES_EMBED : options->images;
}

/* ---- reading ---- */

/* The destination of a file: images that name it, by whatever name, have it together. */
typedef struct moved_file {
	uint32_t view;   /* NT_NONE: into none */
	const char *uri; /* NULL: not beside the output */
} moved_file;

/* Destinations of a document's images. */
typedef struct moving {
	nt_scene *scene;
	nt_buffer_edits *edits;
	nt_json *json;
	const nt_gltf_output *output;
	nt_open_images *images;
	nt_key_set files;  /* of nt_file_id */
	moved_file *moved; /* [count] of each */
	size_t count, capacity;
	nt_error *error;
} moving;

/* By content; NULL: not a kind that glTF or extensions of the document carry. */
static const char *media_type(const nt_gltf *document, const nt_file *file)
{
	const nt_image_type type = nt_image_type_of_bytes(file->data, file->size);
	const char *extension = nt_image_extension(type);
	if (nt_image_is_carried(type) && (!extension || nt_gltf_uses(document, extension)))
		return nt_image_media_type(type);
	if (file->size >= 12 && memcmp(file->data + 4, "ftypavif", 8) == 0)
		return "image/avif"; /* EXT_texture_avif */
	if (file->size >= 4 && memcmp(file->data, "DDS ", 4) == 0)
		return "image/vnd-ms.dds"; /* MSFT_texture_dds */
	return NULL;
}

/* Opens the file of an image. A message that names no file gets the URI. */
static nt_status open_file(nt_gltf *document, const char *uri, size_t length, nt_file *file, const char **path,
	nt_error *failure)
{
	nt_error_clear(failure);
	nt_status status = nt_uri_resolve(&document->arena, document->path, uri, length, document->allow_outside, path,
		failure);
	if (status)
		return status;
	status = nt_file_open(file, *path, NT_NAMED_BY_DOCUMENT, failure);
	if (status) {
		const nt_error opening = *failure;
		snprintf(failure->message, sizeof failure->message, "\"%.*s\": %.*s",
			NT_CUT(120, uri), NT_CUT(300, opening.message));
	}
	return status;
}

/* Opens the file of an image; *path is NULL, after a finding, if that is not possible. */
static nt_status open_image(moving *m, size_t index, const nt_json_value *image, nt_file *file, const char **path)
{
	size_t length;
	const char *uri = nt_gltf_external_uri(image, &length);
	nt_error error;
	const nt_status status = open_file(m->edits->document, uri, length, file, path, &error);
	if (!status)
		return NT_OK;
	*path = NULL;
	if (status == NT_ERROR_MEMORY || status == NT_ERROR_IO) {
		*m->error = error;
		snprintf(m->error->place.pointer, sizeof m->error->place.pointer, "/images/%zu", index);
		return status;
	}
	nt_gltf_tell(m->scene, "images", index, NT_CODE_IMAGE_MISSING, error.message);
	return NT_OK;
}

/* A file is not read for this, unless it is so small that it may be Git LFS's pointer to another. */
static nt_status look_for_image(nt_scene *scene, size_t index, bool linked, nt_error *error)
{
	enum { MOST_OF_POINTER = 1024 };
	nt_gltf *document = scene->source;
	size_t length;
	const char *path = "",
		*uri = nt_gltf_external_uri(nt_json_at(nt_gltf_root_member(document, "images"), index), &length);
	nt_error failure;
	struct stat info;
	nt_file file;
	if (!uri)
		return NT_OK;
	nt_status status = nt_uri_resolve(&document->arena, document->path, uri, length, document->allow_outside, &path,
		&failure);
	if (linked && (status == NT_ERROR_INPUT || status == NT_ERROR_UNSUPPORTED))
		return NT_OK;
	if (!status && stat(path, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > MOST_OF_POINTER &&
		access(path, R_OK) == 0)
		return NT_OK;
	status = open_file(document, uri, length, &file, &path, &failure);
	if (!status)
		nt_file_close(&file);
	/* a file that may be read and cannot is the system's fault, as it is if the image is to be embedded */
	if (status == NT_ERROR_MEMORY || (status == NT_ERROR_IO && (access(path, R_OK) == 0 || errno != EACCES))) {
		*error = failure;
		snprintf(error->place.pointer, sizeof error->place.pointer, "/images/%zu", index);
		return status;
	}
	if (status)
		nt_gltf_tell(scene, "images", index, NT_CODE_IMAGE_MISSING, failure.message);
	return NT_OK;
}

nt_status nt_gltf_look_for_images(nt_scene *scene, bool linked, nt_error *error)
{
	const size_t count = nt_json_count(nt_gltf_root_member(scene->source, "images"));
	nt_status status = NT_OK;
	for (size_t i = 0; i < count && !status; i++)
		status = look_for_image(scene, i, linked, error);
	return status;
}

/* The destination of a file, which has none yet if no earlier image names it. NULL: memory is exhausted. */
static moved_file *destination_of(moving *m, const nt_file *file)
{
	const nt_file_id id = {file->device, file->inode};
	const uint32_t number = nt_key_add(&m->files, &id, sizeof id);
	if (number == UINT32_MAX || !nt_grow((void **)&m->moved, &m->capacity, m->files.count, sizeof *m->moved)) {
		nt_fail_memory(m->error);
		return NULL;
	}
	if (number == m->count)
		m->moved[m->count++] = (moved_file){NT_NONE, NULL};
	return &m->moved[number];
}

/* Keeps a file open until the output is written. */
static nt_status keep_open(moving *m, const nt_file *file)
{
	nt_open_images *images = m->images;
	if (!nt_grow((void **)&images->files, &images->capacity, images->count + 1, sizeof *images->files))
		return nt_fail_memory(m->error);
	images->files[images->count++] = *file;
	return NT_OK;
}

/* ---- moving ---- */

static void refer_to_view(moving *m, nt_json_value *image, uint32_t view, const char *type)
{
	nt_json_remove(m->json, image, "uri");
	nt_json_set_string(m->json, nt_json_put(m->json, image, "mimeType"), type, strlen(type));
	nt_json_put_uint64(m->json, image, "bufferView", view);
}

static nt_status embed_in_view(moving *m, nt_json_value *image, const nt_file *file, const char *type, uint32_t *view)
{
	uint32_t buffer;
	nt_status status =
		nt_edits_choose_buffer(m->edits, 0, &buffer, m->error);
	if (!status)
		status = nt_edits_add_view(m->edits, buffer, file->data, file->size, 0, 0, view, m->error);
	if (!status)
		refer_to_view(m, image, *view, type);
	return status;
}

static nt_status embed_as_data(moving *m, nt_json_value *image, const nt_file *file,
	const char *type)
{
	nt_buffer uri = {0};
	nt_uri_append_data(&uri, type, file->data, file->size);
	if (!uri.failed)
		nt_json_set_string(m->json, nt_json_put(m->json, image, "uri"), uri.data, uri.size);
	const bool failed = uri.failed;
	nt_buffer_free(&uri);
	return failed ? nt_fail_memory(m->error) : NT_OK;
}

static nt_status refer_to_file(moving *m, nt_json_value *image, const char *uri)
{
	nt_json_set_string(m->json, nt_json_put(m->json, image, "uri"), uri, strlen(uri));
	return NT_OK;
}

/* A file of an image beside the output, under this name where that is to be had; *uri: what it is called. */
static nt_status write_beside(moving *m, nt_json_value *image, const nt_file *file, const char *name, const char **uri)
{
	const char *folder_end = strrchr(m->output->options->path, '/');
	const size_t folder = folder_end ? (size_t)(folder_end - m->output->options->path) + 1 : 0;
	nt_buffer path = {0}, text = {0};
	nt_sink *sink;
	nt_buffer_append(&path, m->output->options->path, folder);
	nt_buffer_text(&path, name);
	nt_status status = path.failed ? nt_fail_memory(m->error)
		: nt_output_add(m->output->set, path.data, NT_ROLE_IMAGE, &sink, m->error);
	nt_buffer_free(&path);
	if (!status)
		status = nt_sink_copy(sink, file, 0, file->size, m->error);
	if (!status)
		status = nt_output_settle(m->output->set, sink, m->error);
	if (status)
		return status;
	nt_uri_append_path(&text, nt_sink_name(sink, false));
	*uri = text.failed ? NULL : nt_arena_text(&m->edits->arena, text.data, text.size);
	nt_buffer_free(&text);
	return *uri ? refer_to_file(m, image, *uri) : nt_fail_memory(m->error);
}

/* New pixels take the place of the old ones: in a view, a data URI or a file. */
static nt_status place_turned(moving *m, nt_json_value *image, const nt_turned_image *turned)
{
	static const char type[] = "image/png";
	const bool to_glb = m->output->options->format == NT_FORMAT_GLB;
	const bool embeds = nt_gltf_images_choice(m->output->options, m->edits->document) == NT_IMAGES_EMBED;
	const nt_file file = nt_file_of_bytes(turned->bytes, turned->size);
	size_t length;
	uint64_t view;
	const char *uri = nt_gltf_external_uri(image, &length), *path;
	if (nt_json_find(image, "mimeType"))
		nt_json_set_string(m->json, nt_json_put(m->json, image, "mimeType"), type, sizeof type - 1);
	if (uri && !embeds && !m->output->is_stream) {
		nt_status status = nt_uri_resolve(&m->edits->arena, m->edits->document->path, uri, length, true, &path,
			m->error);
		const char *name = status ? "" : nt_last_part(path), *dot = strrchr(name, '.');
		nt_buffer text = {0};
		nt_buffer_format(&text, "%.*s%s.png", dot ? (int)(dot - name) : (int)strlen(name), name,
			turned->suffix);
		if (!status)
			status = text.failed ? nt_fail_memory(m->error)
				: write_beside(m, image, &file, text.data, &uri);
		nt_buffer_free(&text);
		return status;
	}
	if (!to_glb && nt_json_find(image, "uri"))
		return embed_as_data(m, image, &file, type);
	if (turned->replaces && nt_json_find_uint64(image, "bufferView", &view) && view < m->edits->view_count)
		nt_edits_leave(m->edits, (uint32_t)view, 0);
	uint32_t new_view;
	return embed_in_view(m, image, &file, type, &new_view);
}

/* Copies an image's file beside the output, under its own name where that is to be had; one that is there already is
 * referred to. */
static nt_status copy_file(moving *m, nt_json_value *image, const nt_file *file, const char *path)
{
	moved_file *moved = destination_of(m, file);
	if (!moved)
		return NT_ERROR_MEMORY;
	return moved->uri ? refer_to_file(m, image, moved->uri)
			  : write_beside(m, image, file, nt_last_part(path), &moved->uri);
}

static nt_status copy_image(moving *m, size_t index, nt_json_value *image)
{
	if (!*m->output->link_prefix) /* it is there already */
		return look_for_image(m->scene, index, true, m->error);
	nt_file file;
	const char *path;
	nt_status status = open_image(m, index, image, &file, &path);
	if (!path)
		return status;
	status = copy_file(m, image, &file, path);
	nt_file_close(&file);
	return status;
}

static nt_status embed_file(moving *m, size_t index, nt_json_value *image, const nt_file *file, const char *path,
	bool *is_kept)
{
	const char *type = media_type(m->edits->document, file);
	*is_kept = false;
	if (!type) {
		nt_gltf_tell(m->scene, "images", index, NT_CODE_IMAGE_TYPE, "it stays a file");
		return m->output->is_stream ? nt_gltf_link(m->json, image, m->output->link_prefix, m->error)
			: *m->output->link_prefix ? copy_file(m, image, file, path) : NT_OK;
	}
	if (m->output->options->format != NT_FORMAT_GLB)
		return embed_as_data(m, image, file, type);
	moved_file *moved = destination_of(m, file);
	if (!moved)
		return NT_ERROR_MEMORY;
	if (moved->view != NT_NONE) {
		refer_to_view(m, image, moved->view, type);
		return NT_OK;
	}
	const nt_status status = keep_open(m, file);
	*is_kept = !status;
	return status ? status : embed_in_view(m, image, file, type, &moved->view);
}

static nt_status embed_image(moving *m, size_t index, nt_json_value *image)
{
	nt_file file;
	const char *path;
	bool is_kept;
	nt_status status = open_image(m, index, image, &file, &path);
	if (!path)
		return status;
	status = embed_file(m, index, image, &file, path, &is_kept);
	if (!is_kept)
		nt_file_close(&file);
	return status;
}

static nt_status link_image(moving *m, size_t index, nt_json_value *image)
{
	const nt_status status = look_for_image(m->scene, index, true, m->error);
	return status ? status : nt_gltf_link(m->json, image, m->output->link_prefix, m->error);
}

/* The turned images by their numbers; NULL: there are none. */
static nt_status list_turned(const nt_turned_images *turned, size_t count, const nt_turned_image ***list,
	nt_error *error)
{
	*list = NULL;
	if (!turned || !turned->count)
		return NT_OK;
	*list = nt_calloc(count, sizeof **list);
	for (size_t i = 0; *list && i < turned->count; i++)
		if (turned->items[i].image < count && !(*list)[turned->items[i].image])
			(*list)[turned->items[i].image] = &turned->items[i];
	return *list ? NT_OK : nt_fail_memory(error);
}

nt_status nt_gltf_move_images(nt_scene *scene, nt_buffer_edits *edits, const nt_gltf_output *output,
	nt_open_images *images, nt_error *error)
{
	const nt_gltf *document = edits->document;
	moving m = {.scene = scene, .edits = edits, .json = document->json, .output = output, .images = images,
		.error = error};
	const nt_images choice = nt_gltf_images_choice(output->options, document);
	const size_t count = nt_json_count(nt_gltf_root_member(document, "images"));
	const nt_turned_image **turned_of;
	nt_status status = list_turned(output->options->turned, count, &turned_of, error);
	for (size_t i = 0; !status && i < count; i++) {
		/* embedding may give the root its first view, which moves the root's members */
		nt_json_value *image = nt_json_at(nt_gltf_root_member(document, "images"), i);
		const nt_turned_image *turned = turned_of ? turned_of[i] : NULL;
		size_t length;
		if (turned) {
			status = place_turned(&m, image, turned);
			continue;
		}
		if (!nt_gltf_external_uri(image, &length))
			continue;
		const bool leaves = !output->is_stream && nt_gltf_link_leaves(image, output->link_prefix);
		if (choice == NT_IMAGES_LINK && leaves)
			nt_gltf_tell(scene, "images", i, NT_CODE_LINK_LEAVES, "as --images=link asks");
		if (choice == NT_IMAGES_EMBED)
			status = embed_image(&m, i, image);
		else if ((choice == NT_IMAGES_COPY && !output->is_stream) || (choice == NT_IMAGES_DEFAULT && leaves))
			status = copy_image(&m, i, image);
		else
			status = link_image(&m, i, image);
	}
	free(turned_of);
	free(m.moved);
	nt_key_set_free(&m.files);
	return status;
}

void nt_open_images_close(nt_open_images *images)
{
	for (size_t i = 0; i < images->count; i++)
		nt_file_close(&images->files[i]);
	free(images->files);
}
