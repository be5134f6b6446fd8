/* SPDX-License-Identifier: MIT */
/*
 * What the input's normal maps say about themselves, for a report or on demand. Each image is decoded once, however
 * many meshes share it. Height maps are passed over.
 */
#include "pipeline/stages.h"

#include <stdio.h>
#include <stdlib.h>
#include "base/parallel.h"
#include "format/normal_map.h"
#include "image/examine.h"
#include "image/image.h"

/* What --check-maps=auto decodes; how many images are open at a time. */
enum { MOST_AUTO_BYTES = 16 << 20, MOST_OPEN = 16 };

/* One image. */
typedef struct examined {
	nt_normal_map map;
	const nt_mesh *mesh; /* the first that uses it */
	const char *use;     /* what a glTF's material calls it; "" of others */
	bool decoded;        /* and no height map */
	bool heights;        /* of a glTF, which has normals alone: it is one */
	nt_normal_facts facts;
	nt_error error;
} examined;

typedef struct examination {
	nt_scene *scene;
	const nt_settings *settings;
	nt_hash_index known; /* identities of images */
	uint64_t (*identities)[2];
	size_t count, capacity;
	uint64_t pixels, bytes; /* of images that are decoded, those of materials too */
	examined open[MOST_OPEN];
	size_t open_count;
} examination;

static bool is_wanted(const examination *e, const nt_normal_map *map)
{
	return nt_image_is_decoded(map->type) &&
	       (e->settings->check_maps == NT_CHECK_MAPS_ON || map->size <= MOST_AUTO_BYTES);
}

static void examine(void *context, size_t item, unsigned slot)
{
	(void)slot;
	examination *e = context;
	examined *x = &e->open[item];
	nt_error_clear(&x->error);
	if (is_wanted(e, &x->map))
		x->decoded = nt_examine_image(x->map.bytes, x->map.size, &x->facts, &x->error) == NT_OK &&
			!x->facts.heights;
	x->heights = x->facts.heights && nt_format_is_gltf(e->scene->format);
}

/* ---- what is to be said ---- */

static void tell_facts(nt_finding_list *findings, const nt_place *place, const char *use, const nt_normal_facts *f)
{
	if (f->constant)
		nt_finding_add_as(findings, NT_CODE_NMAP_CONSTANT, f->tilted ? NT_SEVERITY_WARNING : NT_SEVERITY_INFO,
			place, f->tilted ? "it tilts all of the surface one way" : "");
	if (f->object_space)
		nt_finding_add(findings, NT_CODE_NMAP_OBJECT_SPACE, place, 1, NULL);
	else if (f->blue_below > 0.01)
		nt_finding_add(findings, NT_CODE_NMAP_BLUE_BELOW_HALF, place, 1, "%.2g %% of the pixels",
			100 * f->blue_below);
	if (f->not_unit > 0.01)
		nt_finding_add(findings, NT_CODE_NMAP_NOT_UNIT, place, 1, "%.2g %% of the pixels", 100 * f->not_unit);
	if (f->green == NT_GREEN_DOWN || f->green == NT_GREEN_MIXED) {
		char detail[128];
		snprintf(detail, sizeof detail, "%scorrelation %.2f, %.0f %% agree; %zu blocks say up, %zu down",
			use, f->correlation, 100 * f->agreement, f->blocks_up, f->blocks_down);
		nt_finding_add_votes(findings,
			f->green == NT_GREEN_DOWN ? NT_CODE_NMAP_GREEN_DOWN : NT_CODE_NMAP_GREEN_MIXED, place, detail,
			f->votes, NT_GREEN_BLOCKS);
	}
	if (f->banded > 0.5)
		nt_finding_add(findings, NT_CODE_NMAP_BANDED, place, 1, "%.0f %% of the slopes", 100 * f->banded);
}

static void tell(const examination *e, const examined *x)
{
	nt_finding_list *findings = &e->scene->findings;
	const nt_place *place = nt_mesh_place(x->mesh, &(nt_place){0});
	if (!is_wanted(e, &x->map)) {
		const bool large = nt_image_is_decoded(x->map.type);
		nt_finding_add(findings, NT_CODE_NMAP_NOT_EXAMINED, place, 1, "%s%s", nt_image_type_name(x->map.type),
			large ? " of more than 16 MB" : "");
	}
	if (x->error.status == NT_ERROR_MODULE)
		nt_finding_add(findings, NT_CODE_NMAP_NOT_EXAMINED, place, 1, "%.200s", x->error.message);
	else if (x->error.status)
		nt_finding_add(findings, NT_CODE_IMAGE_DAMAGED, place, 1, "normal map (%.200s)", x->error.message);
	if (x->heights)
		nt_finding_add(findings, NT_CODE_NMAP_HEIGHTS, place, 1, NULL);
	if (!x->decoded)
		return;
	tell_facts(findings, place, x->use, &x->facts);
	if (x->facts.srgb)
		nt_finding_add(findings, NT_CODE_NMAP_SRGB, place, 1, NULL);
	if (x->map.type == NT_IMAGE_JPEG)
		nt_finding_add(findings, NT_CODE_NMAP_JPEG, place, 1, NULL);
}

/* ---- the images ---- */

static nt_status flush(examination *e, nt_error *error)
{
	nt_status status = NT_OK;
	nt_parallel_items(nt_thread_count(e->settings->threads), e->open_count, examine, e);
	for (size_t i = 0; i < e->open_count; i++) {
		const nt_error *failure = &e->open[i].error;
		const bool wanted = e->settings->check_maps == NT_CHECK_MAPS_ON;
		if (failure->status == NT_ERROR_MEMORY || (failure->status == NT_ERROR_MODULE && wanted)) {
			*error = *failure;
			status = failure->status;
		} else {
			tell(e, &e->open[i]);
		}
		nt_normal_map_close(&e->open[i].map);
	}
	e->open_count = 0;
	return status;
}

static bool is_known(const examination *e, const uint64_t identity[2], uint64_t hash)
{
	size_t at = NT_HASH_BEGIN;
	for (uint32_t i; (i = nt_hash_index_next(&e->known, hash, &at)) != UINT32_MAX;)
		if (e->identities[i][0] == identity[0] && e->identities[i][1] == identity[1])
			return true;
	return false;
}

static nt_status add_map(examination *e, const nt_mesh *mesh, enum nt_slot slot, nt_normal_map *map, nt_error *error)
{
	const uint64_t hash = nt_hash_bytes(0, map->identity, sizeof map->identity);
	if (!map->bytes || is_known(e, map->identity, hash)) {
		nt_normal_map_close(map);
		return NT_OK;
	}
	if (!nt_grow((void **)&e->identities, &e->capacity, e->count + 1, sizeof *e->identities) ||
		!nt_hash_index_add(&e->known, hash, (uint32_t)e->count)) {
		nt_normal_map_close(map);
		return nt_fail_memory(error);
	}
	uint32_t sides[2];
	if (is_wanted(e, map) && nt_image_size(map->bytes, map->size, sides)) {
		e->pixels += (uint64_t)sides[0] * sides[1];
		e->bytes += map->size;
	}
	const nt_status status = nt_check_pixels(e->pixels, e->settings->max_pixels, e->bytes, error);
	if (status) {
		nt_normal_map_close(map);
		return status;
	}
	e->identities[e->count][0] = map->identity[0];
	e->identities[e->count++][1] = map->identity[1];
	const char *use = !nt_format_is_gltf(e->scene->format) ? ""
		: slot == NT_SLOT_NORMAL ? "normalTexture, " : "clearcoatNormalTexture, ";
	e->open[e->open_count++] = (examined){.map = *map, .mesh = mesh, .use = use};
	return e->open_count == MOST_OPEN ? flush(e, error) : NT_OK;
}

/* The map of a slot, if the mesh has it. */
static nt_status take_map(examination *e, const nt_mesh *mesh, enum nt_slot slot, nt_error *error)
{
	const nt_image_places searched = {.folders = e->settings->texture_paths,
		.folder_count = e->settings->texture_path_count,
		.root = e->settings->root, .confined = e->settings->outside == NT_OUTSIDE_NO,
		.allow_outside = e->settings->outside == NT_OUTSIDE_YES};
	nt_normal_map map;
	if (!(mesh->slots & slot))
		return NT_OK;
	const nt_status status = nt_normal_map_open(&map, e->scene, mesh, slot, &searched, error);
	return status ? status : add_map(e, mesh, slot, &map, error);
}

nt_status nt_stage_maps(nt_scene *scene, const nt_settings *settings, const nt_textures *textures, nt_error *error)
{
	const bool wanted = settings->check_maps == NT_CHECK_MAPS_ON ||
		(settings->check_maps == NT_CHECK_MAPS_AUTO && settings->report);
	examination *e = wanted ? nt_calloc(1, sizeof *e) : NULL;
	if (!e)
		return wanted ? nt_fail_memory(error) : NT_OK;
	e->scene = scene;
	e->settings = settings;
	if (textures)
		e->pixels = nt_textures_pixels(textures, &e->bytes);
	nt_status status = NT_OK;
	for (size_t i = 0; i < scene->mesh_count && !status; i++) {
		status = take_map(e, &scene->meshes[i], NT_SLOT_NORMAL, error);
		if (!status)
			status = take_map(e, &scene->meshes[i], NT_SLOT_CLEARCOAT_NORMAL, error);
	}
	const nt_status flushed = flush(e, error);
	nt_hash_index_free(&e->known);
	free(e->identities);
	free(e);
	return status ? status : flushed;
}
