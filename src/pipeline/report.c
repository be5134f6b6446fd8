/* SPDX-License-Identifier: MIT */
/*
 * The report of a run: see stages.h.
 */
#include "pipeline/stages.h"

#include <string.h>
#include "file/image_size.h"
#include "format/normal_map.h"
#include "pipeline/joins.h"

/* A copy of a mesh's normal map for the report. */
static nt_status copy_normal_map(nt_arena *arena, const nt_scene *scene, const nt_mesh *mesh, size_t most_bytes,
	nt_image *image)
{
	nt_normal_map map;
	nt_error error;
	nt_status status = nt_normal_map_open(&map, scene, mesh, NT_SLOT_NORMAL, NULL, &error);
	*image = (nt_image){0};
	const bool shown = map.type == NT_IMAGE_PNG || map.type == NT_IMAGE_JPEG;
	if (!status && shown && map.size <= most_bytes) {
		void *copy = nt_arena_alloc(arena, map.size, 1);
		if (copy)
			*image = (nt_image){memcpy(copy, map.bytes, map.size), map.size,
				nt_image_media_type(map.type), {1, 0, 0, 0, 1, 0}};
		else
			status = NT_ERROR_MEMORY;
	}
	nt_normal_map_close(&map);
	return status;
}

static nt_status find_map_size(const nt_scene *scene, const nt_mesh *mesh, uint32_t pixels[2])
{
	nt_normal_map map;
	nt_error error;
	pixels[0] = pixels[1] = 0;
	const nt_status status = nt_normal_map_open(&map, scene, mesh, NT_SLOT_NORMAL, NULL, &error);
	if (!status && map.bytes)
		nt_image_size(map.bytes, map.size, pixels);
	nt_normal_map_close(&map);
	return status;
}

/* A report that could not be made says why, if that much can be said. */
static nt_status build_report(nt_scene *scene, const nt_settings *settings, const nt_report_options *options,
	nt_summary *summary, nt_error *error)
{
	nt_status status = nt_report_build(scene, options, &summary->report, error);
	if (status || settings->check)
		status = nt_check_inputs(scene, status, error);
	if (!status)
		return NT_OK;
	nt_report_free(summary->report);
	summary->report = nt_report_of_error(scene->path, error);
	return status;
}

nt_status nt_stage_report(nt_scene *scene, const nt_settings *settings, nt_format written, nt_status status,
	nt_summary *summary, nt_error *error)
{
	if (!status && settings->across == NT_ACROSS_PRIMITIVE)
		status = nt_stage_borders(scene, settings, error);
	if (status) {
		summary->report = nt_report_of_error(scene->path, error);
		return status;
	}
	nt_report_options options = *settings->report;
	options.written = written;
	options.find_map_size = find_map_size;
	if (options.keep_geometry)
		options.find_normal_map = copy_normal_map;
	options.threads = settings->threads;
	return build_report(scene, settings, &options, summary, error);
}
