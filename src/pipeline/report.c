/* SPDX-License-Identifier: MIT */
/*
 * The report of a run: see stages.h.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include <string.h>
#include "file/input.h"
#include "file/path.h"
#include "format/maps.h"
#include "image/image.h"

/* A base colour in a page: the pixels of its longer side; and a file that is small enough to be there as it is. */
enum { PREVIEW_PIXELS = 1024, PREVIEW_BYTES = 1 << 16 };

/* An image that a mesh before had. */
typedef struct found_image {
	struct found_image *next;
	uint64_t identity[2];
	nt_picture picture;
	nt_image image;
} found_image;

/* Arguments of finding the image of a material's map. */
typedef struct finder {
	const nt_textures *textures; /* NULL: none are made */
	const char *page_folder;     /* NULL: files are not referred to */
	found_image *found;
} finder;

/* The image that a conversion makes of an OBJ's map; NULL: nothing, it is used as it is or not at all. */
static const nt_texture *find_converted(const nt_textures *textures, const nt_map *map)
{
	if (!textures || !map || map->request == NT_NONE)
		return NULL;
	const nt_texture *made = nt_textures_at(textures, nt_textures_result(textures, map->request));
	return made->bytes ? made : NULL;
}

static nt_status copy_image(nt_arena *arena, const unsigned char *bytes, size_t size, nt_image_type type,
	nt_image *image)
{
	void *copy = nt_arena_alloc(arena, size, 1);
	if (!copy)
		return NT_ERROR_MEMORY;
	image->bytes = memcpy(copy, bytes, size);
	image->size = size;
	image->type = nt_image_media_type(type);
	return NT_OK;
}

/* The path from a page to a file, if they have a folder in common that is not the root: then it says nothing of the
 * machine. */
static nt_status refer(nt_arena *arena, const char *page_folder, const char *path, nt_image *image)
{
	nt_error error;
	nt_buffer whole = {0}, uri = {0};
	const nt_status status = nt_path_place(&whole, path, &error);
	if (!status && !whole.failed) {
		const size_t first = 1 + strcspn(whole.data + 1, "/");
		if (whole.data[first] && strncmp(page_folder, whole.data, first) == 0 &&
			(page_folder[first] == '/' || page_folder[first] == '\0'))
			nt_link_uri(&uri, page_folder, whole.data);
	}
	char *copy = uri.size ? nt_arena_alloc(arena, uri.size + 1, 1) : NULL;
	if (copy)
		image->file = memcpy(copy, uri.data, uri.size + 1);
	const bool failed = whole.failed || uri.failed || (uri.size && !copy) || status == NT_ERROR_MEMORY;
	nt_buffer_free(&whole);
	nt_buffer_free(&uri);
	return failed ? NT_ERROR_MEMORY : NT_OK;
}

/* A copy of an image whose bytes a browser shows; of a base colour one that is small. An image that cannot be decoded
 * is left out. */
static nt_status keep_image(nt_arena *arena, const nt_normal_map *map, nt_picture picture, size_t most_bytes,
	nt_image *image)
{
	const bool shown = map->type == NT_IMAGE_PNG || map->type == NT_IMAGE_JPEG || map->type == NT_IMAGE_WEBP;
	if (shown && (picture == NT_PICTURE_NORMAL || map->size <= PREVIEW_BYTES))
		return map->size <= most_bytes ? copy_image(arena, map->bytes, map->size, map->type, image) : NT_OK;
	if (picture == NT_PICTURE_NORMAL || !nt_image_is_decoded(map->type))
		return NT_OK;
	unsigned char *small;
	size_t size;
	nt_error error;
	nt_status status = nt_image_reduce(map->bytes, map->size, PREVIEW_PIXELS, &small, &size, &error);
	if (!status && size <= most_bytes)
		status = copy_image(arena, small, size, NT_IMAGE_JPEG, image);
	free(small);
	return status == NT_ERROR_MEMORY ? status : NT_OK;
}

/* The same image as a mesh before, or a new one, which is noted. */
static nt_status find_image(finder *f, nt_arena *arena, const nt_normal_map *map, nt_picture picture,
	size_t most_bytes, nt_image *image)
{
	found_image *found = f->found;
	while (found && (found->picture != picture || found->identity[0] != map->identity[0] ||
		found->identity[1] != map->identity[1]))
		found = found->next;
	if (found) {
		*image = found->image;
		image->again = true;
		return NT_OK;
	}
	found = nt_arena_alloc(arena, 1, sizeof *found);
	if (!found)
		return NT_ERROR_MEMORY;
	*found = (found_image){f->found, {map->identity[0], map->identity[1]}, picture, {0}};
	f->found = found;
	nt_status status = keep_image(arena, map, picture, most_bytes, &found->image);
	if (!status && map->path && f->page_folder)
		status = refer(arena, f->page_folder, map->path, &found->image);
	*image = found->image;
	return status;
}

/* An image of a mesh for the report, as it is after a conversion. */
static nt_status find_picture(void *user, nt_arena *arena, const nt_scene *scene, const nt_mesh *mesh,
	nt_picture picture, size_t most_bytes, nt_image *image)
{
	finder *f = user;
	const enum nt_slot slot = picture == NT_PICTURE_NORMAL ? NT_SLOT_NORMAL : 0;
	const nt_texture *made = find_converted(f->textures, nt_normal_map_named(scene, mesh, slot));
	nt_normal_map map = {0};
	nt_error error;
	nt_status status = NT_OK;
	*image = (nt_image){0};
	if (made)
		map = (nt_normal_map){.bytes = made->bytes, .size = made->size, .type = NT_IMAGE_PNG,
			.identity = {0, (uint64_t)(uintptr_t)made->bytes}};
	else
		status = nt_normal_map_open(&map, scene, mesh, slot, NULL, &error);
	if (!status && map.bytes)
		status = find_image(f, arena, &map, picture, most_bytes, image);
	nt_normal_map_transform(scene, mesh, slot, image->transform);
	nt_normal_map_close(&map);
	return status;
}

static nt_status find_map_size(void *user, const nt_scene *scene, const nt_mesh *mesh, uint32_t pixels[2])
{
	(void)user;
	nt_normal_map map;
	nt_error error;
	pixels[0] = pixels[1] = 0;
	const nt_status status = nt_normal_map_open(&map, scene, mesh, NT_SLOT_NORMAL, NULL, &error);
	if (!status && map.bytes)
		nt_image_size(map.bytes, map.size, pixels);
	nt_normal_map_close(&map);
	return status;
}

/* A report that could not be made says why, if that much can be said, and what does not depend on it. */
static nt_status build_report(nt_scene *scene, const nt_settings *settings, const nt_report_options *options,
	nt_summary *summary, nt_error *error)
{
	nt_status status = NT_OK;
	if (settings->io.across == NT_ACROSS_PRIMITIVE)
		status = nt_stage_borders(scene, settings, error);
	if (!status && scene->findings.failed)
		status = nt_fail_memory(error);
	if (!status)
		status = nt_report_build(scene, options, &summary->report, error);
	if (status || settings->check)
		status = nt_check_inputs(scene, status, error);
	if (!status)
		return NT_OK;
	if (options->written != NT_FORMAT_UNKNOWN && !settings->check && !settings->dry_run)
		strncat(error->message, "; the output stands", sizeof error->message - strlen(error->message) - 1);
	nt_report_free(summary->report);
	summary->report = nt_report_of_error(scene->path, scene, options, error);
	return status;
}

nt_status nt_check_inputs(nt_scene *scene, nt_status status, nt_error *error)
{
	const nt_status watched = nt_watch_check(error);
	if (!watched)
		return status;
	nt_finding_list_free(&scene->findings);
	scene->findings = (nt_finding_list){0};
	return watched;
}

nt_status nt_stage_report(nt_scene *scene, const nt_settings *settings, nt_format written, const nt_textures *textures,
	nt_status status, nt_summary *summary, nt_error *error)
{
	if (status) {
		summary->report = nt_report_of_error(scene->path, scene, settings->report, error);
		return status;
	}
	nt_report_options options = *settings->report;
	options.written = written;
	finder found_by = {textures, options.page_folder, NULL};
	options.find_user = &found_by;
	options.find_map_size = find_map_size;
	if (options.keep_geometry)
		options.find_picture = find_picture;
	options.threads = settings->io.threads;
	options.quads = settings->quads;
	return build_report(scene, settings, &options, summary, error);
}
