/* SPDX-License-Identifier: MIT */
/*
 * Images of new documents: see images.h. Names in an MTL are somebody else's text, so they are
 * confined: no file outside the MTL's folder is looked at, also not through a symbolic link, unless the
 * user allows it. Absolute names that lead to nothing here, which MTLs from other machines are full of, are
 * looked for by their last part in the MTL's folder.
 *
 * Files are opened to see their type and closed again, so that a thousand images do not need a thousand
 * descriptors; who reads them later checks that they are still the same.
 */
#include "gltf/create/images.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "file/image_type.h"
#include "file/lookup.h"
#include "file/relative_path.h"
#include "file/uri.h"

/* One file, or one name that leads to none. */
typedef struct image_entry {
	char *path;         /* absolute */
	nt_image_type type; /* NT_IMAGE_OTHER: not used */
	bool exists;
	bool embedded;
	nt_file identity;   /* closed: size, device and inode */
	uint64_t offset;    /* in the buffer */
	const nt_sink *copy; /* NULL: none */
	uint32_t texture;
} image_entry;

/* What a name in a material led to, so that it is looked for once. */
typedef struct image_name {
	const char *library, *name; /* of the scene */
	size_t entry;               /* NO_ENTRY: to nothing */
} image_name;

#define NO_ENTRY SIZE_MAX

struct nt_image_set {
	nt_scene *scene;
	nt_write_options options;
	char *folder; /* of the output, absolute */
	image_entry *entries;
	size_t entry_count, entry_capacity;
	image_name *names;
	size_t name_count, name_capacity;
};

nt_status nt_image_set_create(nt_image_set **set, nt_scene *scene,
	const nt_write_options *options, nt_error *error)
{
	nt_buffer folder = {0};
	*set = nt_calloc(1, sizeof **set);
	const nt_status status = *set ? nt_link_folder(&folder, options->path, error) : nt_fail_memory(error);
	if (!status) {
		**set = (nt_image_set){.scene = scene, .options = *options, .folder = folder.data};
		return NT_OK;
	}
	nt_buffer_free(&folder);
	free(*set);
	*set = NULL;
	if (status != NT_ERROR_MISSING)
		return status;
	nt_fail(error, NT_ERROR_IO, "cannot write: the folder does not exist");
	return nt_error_in_file(error, options->path);
}

void nt_image_set_free(nt_image_set *set)
{
	if (!set)
		return;
	for (size_t i = 0; i < set->entry_count; i++) {
		free(set->entries[i].path);
	}
	free(set->entries);
	free(set->names);
	free(set->folder);
	free(set);
}

/* ---- finding ---- */

static const char *last_part(const char *name)
{
	const char *part = name;
	for (; *name; name++)
		if (*name == '/' || *name == '\\')
			part = name + 1;
	return part;
}

static nt_status is_file(const char *path, bool *is, nt_error *error)
{
	struct stat info;
	const nt_status status = nt_lookup_found(path, &info, is, error);
	*is = *is && S_ISREG(info.st_mode);
	return status;
}

static void report(nt_image_set *set, nt_code code, const nt_material *material, const char *name,
	const char *why)
{
	nt_place place;
	nt_place_clear(&place);
	snprintf(place.file, sizeof place.file, "%s",
		material->library ? material->library : set->scene->path);
	place.line = material->line;
	snprintf(place.object, sizeof place.object, "material \"%s\"",
		material->name ? material->name : "");
	nt_finding_add(&set->scene->findings, code, &place, 1, "%s%s", name, why);
}

/* The same below a folder that is there. */
static nt_status confine_to(const nt_image_set *set, const char *folder, const char *name, nt_buffer *path,
	const char **why, nt_error *error)
{
	const bool absolute = nt_link_is_absolute(name), allowed = set->options.allow_outside;
	bool as_it_is = !absolute;
	if (absolute && allowed) {
		const nt_status status = is_file(name, &as_it_is, error);
		if (status)
			return status;
	}
	nt_link_join(path, folder, as_it_is ? name : last_part(name));
	if (path->failed)
		return nt_fail_memory(error);
	if (allowed)
		return NT_OK;
	char *real;
	const nt_status status = nt_lookup_real_found(path->data, &real, error);
	if (status)
		return status;
	if (!nt_link_is_inside(path->data, folder) || !(real ? nt_link_is_inside(real, folder) : !absolute))
		*why = " (it is outside of the folder of its MTL file, see --allow-outside)";
	free(real);
	return NT_OK;
}

/* The absolute path that a name leads to, in `path`; in *why the reason when it may not be looked at. */
static nt_status confine(const nt_image_set *set, const nt_material *material, const char *name,
	nt_buffer *path, const char **why, nt_error *error)
{
	nt_buffer folder = {0};
	nt_error failure;
	*why = NULL;
	nt_status status =
		nt_link_folder(&folder, material->library ? material->library : set->scene->path, &failure);
	if (!status) {
		status = confine_to(set, folder.data, name, path, why, error);
	} else if (status == NT_ERROR_MISSING) {
		*why = " (the folder of its MTL file does not exist)";
		status = NT_OK;
	} else {
		*error = failure;
	}
	nt_buffer_free(&folder);
	return status;
}

/* Looks into the file for its type and identity, if there is one. */
static nt_status inspect(image_entry *entry, nt_error *error)
{
	nt_file file;
	nt_status status = is_file(entry->path, &entry->exists, error);
	if (!status && entry->exists)
		status = nt_file_open(&file, entry->path, error);
	if (status || !entry->exists)
		return status;
	entry->type = nt_image_type_of_bytes(file.data, file.size);
	entry->identity = (nt_file){.size = file.size, .fd = -1, .device = file.device,
		.inode = file.inode};
	nt_file_close(&file);
	return NT_OK;
}

static size_t entry_of_path(const nt_image_set *set, const char *path)
{
	for (size_t i = 0; i < set->entry_count; i++)
		if (strcmp(set->entries[i].path, path) == 0)
			return i;
	return NO_ENTRY;
}

/* A new entry, which takes the path over. */
static nt_status add_path(nt_image_set *set, nt_buffer *path, size_t *index, nt_error *error)
{
	if (!nt_grow((void **)&set->entries, &set->entry_capacity, set->entry_count + 1, sizeof *set->entries))
		return nt_fail_memory(error);
	*index = set->entry_count++;
	set->entries[*index] = (image_entry){.path = path->data, .texture = NT_MODEL_NONE};
	*path = (nt_buffer){0};
	return inspect(&set->entries[*index], error);
}

/* The entry for a name, new or known; NO_ENTRY, with a finding, when the document goes without. A link may
 * lead to a file that is not there yet. */
static nt_status look_up(nt_image_set *set, const nt_material *material, const char *name,
	nt_output *output, size_t *index, nt_error *error)
{
	nt_buffer path = {0};
	const char *why;
	*index = NO_ENTRY;
	nt_status status = confine(set, material, name, &path, &why, error);
	if (!status && !why)
		*index = entry_of_path(set, path.data);
	const bool known = *index != NO_ENTRY;
	if (!status && why)
		report(set, NT_CODE_IMAGE_MISSING, material, name, why);
	else if (!status && !known)
		status = add_path(set, &path, index, error);
	nt_buffer_free(&path);
	if (status || known || why)
		return status;
	image_entry *entry = &set->entries[*index];
	if (!entry->exists) {
		report(set, NT_CODE_IMAGE_MISSING, material, name, "");
		if (set->options.images == NT_IMAGES_LINK)
			entry->type = nt_image_type_of_name(entry->path);
		return NT_OK;
	}
	if (entry->type == NT_IMAGE_OTHER)
		report(set, NT_CODE_IMAGE_TYPE, material, name, "");
	return nt_output_protect(output, entry->path, NULL, error);
}

static const image_name *known_name(const nt_image_set *set, const nt_material *material,
	const char *name)
{
	for (size_t i = 0; i < set->name_count; i++) {
		const image_name *known = &set->names[i];
		const bool same_library = known->library == material->library ||
			(known->library && material->library &&
				strcmp(known->library, material->library) == 0);
		if (same_library && strcmp(known->name, name) == 0)
			return known;
	}
	return NULL;
}

nt_status nt_image_set_find(nt_image_set *set, const nt_material *material, nt_output *output,
	nt_error *error)
{
	const char *const names[] = {material->base_color_map, material->emissive_map,
		material->normal_map};
	for (size_t i = 0; i < 3; i++) {
		const char *name = names[i];
		if (!name || !*name || set->options.images == NT_IMAGES_NONE ||
			known_name(set, material, name))
			continue;
		size_t entry;
		const nt_status status = look_up(set, material, name, output, &entry, error);
		if (status)
			return status;
		if (!nt_grow((void **)&set->names, &set->name_capacity, set->name_count + 1, sizeof *set->names))
			return nt_fail_memory(error);
		set->names[set->name_count++] = (image_name){material->library, name, entry};
	}
	return NT_OK;
}

/* ---- adding ---- */

static nt_status copy_image(nt_image_set *set, image_entry *entry, nt_output *output,
	nt_error *error)
{
	nt_buffer path = {0};
	nt_buffer_format(&path, "%s/%s", set->folder, last_part(entry->path));
	nt_sink *sink;
	nt_file file;
	nt_status status = path.failed ? nt_fail_memory(error) : NT_OK;
	if (status || nt_file_is(&entry->identity, path.data)) { /* where it is there, a link does */
		nt_buffer_free(&path);
		return status;
	}
	status = nt_output_add(output, path.data, NT_ROLE_IMAGE, &sink, error);
	nt_buffer_free(&path);
	if (status == NT_OK)
		status = nt_file_open(&file, entry->path, error);
	if (status != NT_OK)
		return status;
	status = nt_sink_copy(sink, &file, 0, file.size, error);
	nt_file_close(&file);
	if (status == NT_OK)
		status = nt_output_settle(output, sink, error);
	entry->copy = sink;
	return status;
}

/* Name of an image in the document: the file's, without its ending. */
static char *image_title(const image_entry *entry)
{
	const char *name = last_part(entry->path), *dot = strrchr(name, '.');
	return strndup(name, dot ? (size_t)(dot - name) : strlen(name));
}

static nt_status add_entry(nt_image_set *set, image_entry *entry, nt_model *model,
	uint64_t *buffer_size, nt_output *output, nt_error *error)
{
	entry->embedded = set->options.images == NT_IMAGES_EMBED;
	if ((entry->embedded || set->options.images == NT_IMAGES_COPY) && !entry->exists)
		return NT_OK;
	if (set->options.images == NT_IMAGES_COPY) {
		const nt_status status = copy_image(set, entry, output, error);
		if (status != NT_OK)
			return status;
	}
	nt_buffer uri = {0};
	char *title = image_title(entry);
	uint32_t image = NT_MODEL_NONE;
	if (entry->embedded) {
		entry->offset = (*buffer_size + 3) & ~(uint64_t)3;
		*buffer_size = entry->offset + entry->identity.size;
		const uint32_t view = nt_model_view(model, entry->offset, entry->identity.size,
			NT_GLTF_NO_TARGET);
		image = nt_model_image_view(model, title, view, nt_image_media_type(entry->type));
	} else {
		if (entry->copy)
			nt_uri_append_path(&uri, nt_sink_name(entry->copy, false));
		else
			nt_link_uri(&uri, set->folder, entry->path);
		if (!uri.failed)
			image = nt_model_image_uri(model, title, uri.data);
	}
	entry->texture = nt_model_texture(model, image, nt_image_extension(entry->type));
	const bool failed = uri.failed || !title;
	nt_buffer_free(&uri);
	free(title);
	return failed ? nt_fail_memory(error) : NT_OK;
}

nt_status nt_image_set_add(nt_image_set *set, nt_model *model, uint64_t *buffer_size,
	nt_output *output, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < set->entry_count && status == NT_OK; i++)
		if (set->entries[i].type != NT_IMAGE_OTHER)
			status = add_entry(set, &set->entries[i], model, buffer_size, output, error);
	return status;
}

uint32_t nt_image_set_texture(const nt_image_set *set, const nt_material *material,
	const char *name)
{
	const image_name *known = name ? known_name(set, material, name) : NULL;
	return known && known->entry != NO_ENTRY ? set->entries[known->entry].texture : NT_MODEL_NONE;
}

/* ---- writing ---- */

static bool is_written(const image_entry *entry)
{
	return entry->embedded && entry->texture != NT_MODEL_NONE;
}

size_t nt_image_set_embedded_count(const nt_image_set *set)
{
	size_t count = 0;
	for (size_t i = 0; i < set->entry_count; i++)
		count += is_written(&set->entries[i]);
	return count;
}

nt_status nt_image_set_open(const nt_image_set *set, size_t index, nt_file *file,
	uint64_t *offset, nt_error *error)
{
	const image_entry *entry = set->entries;
	while (!is_written(entry) || index-- > 0)
		entry++;
	const nt_status status = nt_file_open(file, entry->path, error);
	if (status != NT_OK)
		return status;
	*offset = entry->offset;
	if (file->size == entry->identity.size)
		return NT_OK;
	nt_file_close(file);
	nt_fail(error, NT_ERROR_IO, "the image changed while it was read");
	return nt_error_in_file(error, entry->path);
}
