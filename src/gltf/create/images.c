/* SPDX-License-Identifier: MIT */
/*
 * Images of new documents. Each result that its materials use (image/textures.h) is linked, copied or embedded. An
 * image that was made has no file yet: if others are linked, it is written beside the output. An image that several
 * materials use is one image, and a texture for each of its samplers. Files that are as they were found are opened
 * when their bytes are needed; that they are still the same is checked then.
 */
#include "gltf/create/model.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "file/path.h"
#include "image/textures.h"

/* Treatment of one result of the textures. */
typedef struct image_entry {
	const nt_texture *image;
	const nt_material *material; /* the first that uses it */
	size_t line;                 /* there */
	bool used;
	bool wants[2];       /* a texture that repeats, one that is clamped */
	const nt_sink *file; /* of the output; NULL: none */
	uint32_t textures[2]; /* repeating and clamped; NT_MODEL_NONE: nobody wants it */
} image_entry;

struct nt_image_set {
	nt_write_options options;
	nt_images choice; /* the default: linked in the output's folder, copied from elsewhere */
	char *folder; /* of the output, absolute */
	image_entry *entries; /* [entry_count] */
	size_t entry_count;
};

static nt_status fill(nt_image_set *set, nt_error *error)
{
	nt_buffer folder = {0};
	set->entry_count = set->options.textures ? nt_textures_count(set->options.textures) : 0;
	set->entries = nt_alloc(set->entry_count, sizeof *set->entries);
	if (!set->entries)
		return nt_fail_memory(error);
	for (size_t i = 0; i < set->entry_count; i++)
		set->entries[i] = (image_entry){.image = nt_textures_at(set->options.textures, i),
			.textures = {NT_MODEL_NONE, NT_MODEL_NONE}};
	const nt_status status = nt_link_folder(&folder, set->options.path, error);
	set->folder = folder.data;
	if (status != NT_ERROR_MISSING)
		return status;
	return nt_fail_file(error, NT_ERROR_IO, set->options.path, "cannot write: the folder does not exist");
}

nt_status nt_image_set_create(nt_image_set **set, const nt_write_options *options, nt_error *error)
{
	*set = nt_calloc(1, sizeof **set);
	if (!*set)
		return nt_fail_memory(error);
	const bool alone = options->format == NT_FORMAT_GLB || options->buffers == NT_BUFFERS_EMBED;
	(*set)->options = *options;
	(*set)->choice = options->images == NT_IMAGES_DEFAULT && alone ? NT_IMAGES_EMBED : options->images;
	const nt_status status = fill(*set, error);
	if (status) {
		nt_image_set_free(*set);
		*set = NULL;
	}
	return status;
}

void nt_image_set_free(nt_image_set *set)
{
	if (!set)
		return;
	free(set->entries);
	free(set->folder);
	free(set);
}

/* ---- which ---- */

static image_entry *entry_of(const nt_image_set *set, uint32_t request)
{
	if (request == NT_MODEL_NONE || !set->options.textures)
		return NULL;
	return &set->entries[nt_textures_result(set->options.textures, request)];
}

void nt_image_set_use(nt_image_set *set, const nt_material *material, const nt_map *map)
{
	image_entry *entry = entry_of(set, map->request);
	/* only who asks for links gets one that leads to nothing */
	if (!entry || entry->image->type == NT_IMAGE_OTHER ||
		(entry->image->sources[0]->found == NT_IMAGE_MISSING && set->options.images != NT_IMAGES_LINK))
		return;
	entry->wants[map->placement.clamp] = true;
	if (entry->used)
		return;
	entry->used = true;
	entry->material = material;
	entry->line = map->line;
}

/* ---- adding ---- */

/* The bytes of an image: those that were made, or its file. */
static nt_status open_image(const nt_texture *image, nt_file *file, nt_error *error)
{
	if (image->made) {
		*file = nt_file_of_bytes(image->bytes, image->size);
		return NT_OK;
	}
	const nt_texture_source *source = image->sources[0];
	const nt_status status = nt_file_open(file, source->path, NT_NAMED_BY_DOCUMENT, error);
	if (status || file->size == source->identity.size)
		return status;
	nt_file_close(file);
	return nt_fail_file(error, NT_ERROR_IO, source->path, "the image changed while it was read");
}

static void close_image(const nt_texture *image, nt_file *file)
{
	nt_file_close(file);
	nt_texture_release_pages(image);
}

static nt_status write_file(nt_image_set *set, image_entry *entry, nt_output *output, nt_error *error)
{
	nt_buffer path = {0};
	nt_buffer_format(&path, "%s/%s", set->folder, entry->image->name);
	nt_sink *sink;
	nt_file file;
	nt_status status = path.failed ? nt_fail_memory(error) : NT_OK;
	/* it is there: a link does; or nobody has made it, and nothing is written */
	const nt_texture *image = entry->image;
	if (status || (image->made ? !image->bytes : nt_file_is(&image->sources[0]->identity, path.data))) {
		nt_buffer_free(&path);
		return status;
	}
	status = nt_output_add(output, path.data, NT_ROLE_IMAGE, &sink, error);
	nt_buffer_free(&path);
	if (status == NT_OK)
		status = open_image(entry->image, &file, error);
	if (status != NT_OK)
		return status;
	status = nt_sink_copy(sink, &file, 0, file.size, error);
	close_image(entry->image, &file);
	if (status == NT_OK)
		status = nt_output_settle(output, sink, error);
	entry->file = sink;
	return status;
}

/* For nt_model_view(). */
static nt_status write_embedded(const void *user, const nt_byte_target *to, nt_error *error)
{
	const image_entry *entry = user;
	nt_file file;
	nt_status status = open_image(entry->image, &file, error);
	if (status)
		return status;
	status = nt_target_put_file(to, &file, error);
	close_image(entry->image, &file);
	return status;
}

static nt_status add_entry(nt_image_set *set, image_entry *entry, nt_scene *scene, nt_model *model, nt_output *output,
	nt_error *error)
{
	const nt_texture *from = entry->image;
	const bool embedded = set->choice == NT_IMAGES_EMBED;
	const bool leaves = !from->made && !nt_link_is_inside(from->sources[0]->path, set->folder);
	if (leaves && set->choice == NT_IMAGES_LINK) {
		const nt_place place = nt_material_place(scene, entry->material, entry->line);
		nt_finding_add(&scene->findings, NT_CODE_LINK_LEAVES, &place, 1, "%s, as --images=link asks",
			from->name);
	}
	if (from->made ? !embedded
		: set->choice == NT_IMAGES_COPY || (set->choice == NT_IMAGES_DEFAULT && leaves)) {
		const nt_status status = write_file(set, entry, output, error);
		if (status != NT_OK)
			return status;
	}
	/* its name in the document: the file's, without its ending */
	const char *dot = strrchr(from->name, '.');
	nt_buffer uri = {0}, title = {0};
	nt_buffer_append(&title, from->name, dot ? (size_t)(dot - from->name) : strlen(from->name));
	uint32_t number;
	nt_json_value *image = nt_model_append(model, "images", &number);
	if (embedded) {
		const uint64_t size = from->made ? from->size : from->sources[0]->identity.size;
		nt_model_put_index(model, image, "bufferView",
			nt_model_view(model, size, NT_GLTF_NO_TARGET, write_embedded, entry));
		nt_model_put_string(model, image, "mimeType", nt_image_media_type(from->type));
	} else if (entry->file) {
		nt_uri_append_path(&uri, nt_sink_name(entry->file, false));
	} else {
		nt_link_uri(&uri, set->folder, from->sources[0]->path);
	}
	nt_model_put_string(model, image, "name", title.data);
	nt_model_put_string(model, image, "uri", uri.data);
	for (int clamp = 0; clamp < 2; clamp++)
		if (entry->wants[clamp])
			entry->textures[clamp] = nt_model_texture(model, number, clamp, nt_image_extension(from->type));
	const bool failed = uri.failed || title.failed;
	nt_buffer_free(&uri);
	nt_buffer_free(&title);
	return failed ? nt_fail_memory(error) : NT_OK;
}

/* The line about the result says what was made of what. */
static void note_made(const nt_image_set *set, nt_output *output)
{
	enum { NAMES_SHOWN = 3 };
	size_t count = 0;
	for (size_t i = 0; i < set->entry_count; i++) {
		const image_entry *entry = &set->entries[i];
		if (!entry->used || !entry->image->made || count++ >= NAMES_SHOWN)
			continue;
		nt_output_note(output, "%s", count == 1 ? ";" : ",");
		for (size_t k = 0; k < entry->image->source_count; k++)
			nt_output_note(output, "%s %s", k ? " and" : "", nt_last_part(entry->image->sources[k]->path));
		nt_output_note(output, "%s became %s%s", entry->image->from_heights ? ", taken as heights," : "",
			entry->file ? nt_sink_name(entry->file, false) : entry->image->name,
			set->choice == NT_IMAGES_EMBED ? " (embedded)" : "");
	}
	if (count > NAMES_SHOWN)
		nt_output_note(output, ", and %zu more", count - NAMES_SHOWN);
}

nt_status nt_image_set_add(nt_image_set *set, nt_scene *scene, nt_model *model, nt_output *output, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < set->entry_count && status == NT_OK; i++)
		if (set->entries[i].used)
			status = add_entry(set, &set->entries[i], scene, model, output, error);
	if (status == NT_OK)
		note_made(set, output);
	return status;
}

nt_alpha_mode nt_image_set_alpha(const nt_image_set *set, uint32_t request)
{
	return entry_of(set, request) ? nt_textures_of(set->options.textures, request)->alpha : NT_ALPHA_OPAQUE;
}

nt_model_use nt_image_set_texture(const nt_image_set *set, const nt_map *map)
{
	const image_entry *entry = entry_of(set, map->request);
	const nt_placement *p = &map->placement;
	nt_model_use use = {.texture = entry ? entry->textures[p->clamp] : NT_MODEL_NONE, .moved = p->moved};
	if (!use.moved)
		return use;
	use.scale[0] = p->scale[0];
	use.scale[1] = p->scale[1];
	use.offset[0] = p->offset[0];
	/* glTF's v is 1 - v: it samples at 1 - (s v + o) = s (1 - v) + 1 - s - o */
	use.offset[1] = (float)fmax(fmin(1.0 - p->scale[1] - p->offset[1], FLT_MAX), -FLT_MAX);
	return use;
}
