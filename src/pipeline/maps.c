/* SPDX-License-Identifier: MIT */
/*
 * Examines the input's normal maps, for a report or on demand. Each image is decoded once, however
 * many meshes share it. Height maps are passed over.
 */
#include "pipeline/stages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "format/maps.h"
#include "image/image.h"

/* Largest file that --check-maps=auto decodes; how many images are open at a time. */
enum { MOST_AUTO_BYTES = 16 << 20, MOST_OPEN = 16 };

/* One image. */
typedef struct known_map {
	const nt_mesh *mesh;    /* the first that uses it */
	const nt_material *material; /* not of a glTF, whose place is the mesh; else NULL */
	const char *use;        /* what a glTF's material calls it, or the name of the file */
	nt_normal_map image;    /* open until it is examined */
	bool wanted;            /* it is to be decoded */
	bool examined;          /* it was */
	bool decodable, turnable, paired;
	bool stays; /* somebody has it as a normal map that is not made of heights */
	nt_normal_facts facts;
} known_map;

typedef struct examination {
	nt_scene *scene;
	const nt_settings *settings;
	const nt_textures *textures; /* of materials; NULL: a glTF's, or the output has none */
	nt_image_places searched;
	nt_key_set known; /* identities of images */
	known_map *maps;  /* [count], of the first of them */
	size_t count, capacity;
	bool told; /* what is found; else only pairs are */
	bool *halved; /* [mesh_count] as nt_find_pairs() has it */
	uint64_t pixels, bytes; /* of images that are decoded, those of materials too */
	size_t open;      /* maps from here on are open */
	nt_error errors[MOST_OPEN];
} examination;

static void examine(void *context, size_t item, unsigned slot)
{
	(void)slot;
	examination *e = context;
	known_map *map = &e->maps[e->open + item];
	nt_error *error = &e->errors[item];
	nt_error_clear(error);
	if (map->wanted)
		map->examined = nt_examine_image(map->image.bytes, map->image.size, &map->facts, error) == NT_OK;
	map->decodable = nt_image_is_decoded(map->image.type) && !error->status;
	map->turnable = map->image.turnable;
}

/* ---- what is to be said ---- */

static const nt_place *place_of(const nt_scene *scene, const known_map *map, nt_place *place)
{
	return map->material ? nt_map_place(scene, map->material, &map->material->normal_map, place)
			     : nt_mesh_place(map->mesh, place);
}

static void tell_green(nt_finding_list *findings, nt_code code, const nt_place *place, const char *use,
	const nt_normal_facts *f, bool stays)
{
	char detail[320];
	int8_t *votes = nt_arena_alloc(&findings->arena, sizeof f->votes, 1);
	snprintf(detail, sizeof detail,
		"%.*s, correlation %.2f (green %s) at the surest size of detail, where %.0f %% of the map have its "
		"sign; over all sizes %zu of %d blocks say up, %zu down", NT_CUT(100, use), f->correlation,
		f->correlation < 0 ? "down" : "up", 100 * f->agreement, f->blocks_up,
		NT_GREEN_BLOCKS * NT_GREEN_BLOCKS, f->blocks_down);
	findings->failed |= !votes;
	if (votes)
		nt_finding_put(findings, (nt_finding){.code = code, .count = 1, .detail = detail, .stays = stays,
			.votes = memcpy(votes, f->votes, sizeof f->votes), .votes_side = NT_GREEN_BLOCKS}, place);
}

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
	if (f->green == NT_GREEN_MIXED)
		tell_green(findings, NT_CODE_NMAP_GREEN_MIXED, place, use, f, false);
	if (f->banded > 0.5)
		nt_finding_add(findings, NT_CODE_NMAP_BANDED, place, 1, "%.0f %% of the slopes", 100 * f->banded);
}

static void tell(const examination *e, const known_map *map, const nt_error *error)
{
	nt_finding_list *findings = &e->scene->findings;
	const nt_place *place = place_of(e->scene, map, &(nt_place){0});
	const size_t begin = findings->count;
	const bool normals = map->examined && !map->facts.heights;
	if (!map->wanted)
		nt_finding_add(findings, NT_CODE_NMAP_NOT_EXAMINED, place, 1, "%s%s",
			nt_image_type_name(map->image.type),
			nt_image_is_decoded(map->image.type) ? " of more than 16 MB" : "");
	if (error->status == NT_ERROR_MODULE)
		nt_finding_add(findings, NT_CODE_NMAP_NOT_EXAMINED, place, 1, "%.*s", NT_CUT(200, error->message));
	else if (error->status)
		nt_finding_add(findings, NT_CODE_IMAGE_DAMAGED, place, 1, "normal map (%.*s)",
			NT_CUT(200, error->message));
	if (normals)
		tell_facts(findings, place, map->use, &map->facts);
	if (normals && map->facts.srgb)
		nt_finding_add(findings, NT_CODE_NMAP_SRGB, place, 1, NULL);
	if (normals && map->facts.lossy)
		nt_finding_add(findings, NT_CODE_NMAP_JPEG, place, 1, "%s", nt_image_type_name(map->image.type));
	nt_findings_set_mesh(findings, begin, map->mesh);
}

/* Whether its green points one way; height maps have none. */
static nt_green green_of(const known_map *map)
{
	return map->examined && !map->facts.heights ? map->facts.green : NT_GREEN_UNKNOWN;
}

/* Height maps that nothing converts; and maps whose green points down, but for those of pairs and those that are
 * turned. */
static void tell_unchanged(const examination *e)
{
	const nt_scene *scene = e->scene;
	const bool turns = e->settings->flip_green != NT_FLIP_OFF && (!e->settings->check || e->settings->converts);
	for (size_t i = 0; i < scene->mesh_count; i++)
		for (int slot = 0; slot < 2; slot++) {
			const nt_mesh_map *map = &scene->meshes[i].normal_maps[slot];
			if (map->number && scene->meshes[i].pair)
				e->maps[map->number - 1].paired = true;
		}
	for (size_t i = 0; i < e->count; i++) {
		const known_map *map = &e->maps[i];
		nt_finding_list *findings = &e->scene->findings;
		const nt_place *place = place_of(scene, map, &(nt_place){0});
		const size_t begin = findings->count;
		/* of an OBJ, --bump=height is about map_bump alone */
		if (map->facts.heights && map->stays)
			nt_finding_put(findings, (nt_finding){.code = NT_CODE_NMAP_HEIGHTS, .count = 1,
				.detail = "", .repair = e->textures ? "--bump=auto" : NULL}, place);
		if (green_of(map) == NT_GREEN_DOWN && !map->paired && !(turns && map->turnable))
			tell_green(findings, NT_CODE_NMAP_GREEN_DOWN, place, map->use, &map->facts, !map->turnable);
		nt_findings_set_mesh(findings, begin, map->mesh);
	}
}

/* ---- the images ---- */

static nt_status flush(examination *e, nt_error *error)
{
	nt_status status = NT_OK;
	nt_parallel_items(nt_thread_count(e->settings->io.threads), e->count - e->open, examine, e);
	for (size_t i = 0; e->open < e->count; i++, e->open++) {
		const nt_error *failure = &e->errors[i];
		const bool wanted = e->settings->check_maps == NT_CHECK_MAPS_ON;
		if (failure->status == NT_ERROR_MEMORY || (failure->status == NT_ERROR_MODULE && wanted)) {
			if (!status)
				*error = *failure;
			status = error->status;
		} else if (e->told) {
			tell(e, &e->maps[e->open], failure);
		}
		nt_normal_map_close(&e->maps[e->open].image);
	}
	return status;
}

/* Takes over an image that is open and new. */
static nt_status add_map(examination *e, known_map map, nt_error *error)
{
	const nt_settings *s = e->settings;
	nt_status status = NT_OK;
	map.wanted = nt_image_is_decoded(map.image.type) && s->check_maps != NT_CHECK_MAPS_OFF &&
		(s->check_maps == NT_CHECK_MAPS_ON || map.image.size <= MOST_AUTO_BYTES);
	if (map.wanted) {
		const uint64_t work = nt_image_work(map.image.bytes, map.image.size);
		e->pixels += work;
		e->bytes += work ? map.image.size : 0;
		status = nt_check_image(work, s->max_pixels, map.image.size, NULL, error);
	}
	if (!status)
		status = nt_check_pixels(e->pixels, s->max_pixels, e->bytes, error);
	if (!status && !nt_grow((void **)&e->maps, &e->capacity, e->count + 1, sizeof *e->maps))
		status = nt_fail_memory(error);
	if (status) {
		nt_normal_map_close(&map.image);
		return status;
	}
	e->maps[e->count++] = map;
	return e->count - e->open == MOST_OPEN ? flush(e, error) : NT_OK;
}

/* Takes over an image that is open. m: NULL: of a glTF; stays: it is not converted. */
static nt_status take_map(examination *e, nt_mesh *mesh, const nt_material *m, enum nt_slot slot, nt_normal_map *map,
	bool stays, nt_error *error)
{
	if (!map->bytes)
		return NT_OK;
	const uint32_t number = nt_key_add(&e->known, map->identity, sizeof map->identity);
	nt_status status = NT_OK;
	if (number == UINT32_MAX) {
		nt_normal_map_close(map);
		return nt_fail_memory(error);
	}
	mesh->normal_maps[slot == NT_SLOT_CLEARCOAT_NORMAL] = (nt_mesh_map){.number = number + 1, .image = map->image};
	if (number == e->count)
		status = add_map(e, (known_map){.mesh = mesh, .material = m, .image = *map,
			.use = m ? m->normal_map.name : slot == NT_SLOT_NORMAL ? "normalTexture"
									 : "clearcoatNormalTexture"}, error);
	else
		nt_normal_map_close(map);
	if (!status)
		e->maps[number].stays |= stays;
	return status;
}

static nt_status take_slot(examination *e, nt_mesh *mesh, enum nt_slot slot, nt_error *error)
{
	const nt_settings *s = e->settings;
	nt_normal_map map;
	if (!(mesh->slots & slot))
		return NT_OK;
	const nt_status status = nt_normal_map_open(&map, e->scene, mesh, slot, NULL, error);
	const bool converted = s->bump == NT_BUMP_HEIGHT && (!s->check || s->converts) && map.turnable;
	return status ? status : take_map(e, mesh, NULL, slot, &map, !converted, error);
}

/* Maps of a mesh's materials that the output has; each material is looked at once. */
static nt_status take_named(examination *e, nt_mesh *mesh, bool *seen, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < mesh->primitive_count && e->textures && !status; i++) {
		const uint32_t number = mesh->primitives[i].material;
		const nt_material *m = number < e->scene->material_count ? &e->scene->materials[number] : NULL;
		nt_normal_map map;
		if (!m || seen[number] || !m->normal_map.name || m->normal_map.request == NT_NONE)
			continue;
		seen[number] = true;
		status = nt_normal_map_open_named(&map, e->scene, m, NT_SLOT_NORMAL, &e->searched, error);
		if (!status)
			status = take_map(e, mesh, m, NT_SLOT_NORMAL, &map,
				!nt_textures_of(e->textures, m->normal_map.request)->from_heights, error);
	}
	return status;
}

/* Meshes get what is known of their maps. */
static void share_facts(const examination *e)
{
	for (size_t i = 0; i < e->scene->mesh_count; i++)
		for (int slot = 0; slot < 2; slot++) {
			nt_mesh_map *map = &e->scene->meshes[i].normal_maps[slot];
			if (!map->number)
				continue;
			const known_map *known = &e->maps[map->number - 1];
			map->green = (uint8_t)green_of(known);
			map->examined = known->examined;
			map->decodable = known->decodable;
			map->turnable = known->turnable;
		}
}

static nt_status examine_all(examination *e, nt_error *error)
{
	nt_scene *scene = e->scene;
	const bool gltf = nt_format_is_gltf(scene->format);
	bool *seen = nt_calloc(scene->material_count, sizeof *seen);
	nt_status status = seen ? NT_OK : nt_fail_memory(error);
	for (size_t i = 0; i < scene->mesh_count && !status; i++) {
		status = gltf ? take_slot(e, &scene->meshes[i], NT_SLOT_NORMAL, error)
			: take_named(e, &scene->meshes[i], seen, error);
		if (gltf && !status)
			status = take_slot(e, &scene->meshes[i], NT_SLOT_CLEARCOAT_NORMAL, error);
	}
	free(seen);
	const nt_status flushed = flush(e, status ? &(nt_error){0} : error); /* the first failure is named */
	if (status || flushed)
		return status ? status : flushed;
	share_facts(e);
	if (gltf && nt_find_pairs(scene, e->settings, e->count, e->halved))
		return nt_fail_memory(error);
	if (e->told)
		tell_unchanged(e);
	return NT_OK;
}

nt_status nt_stage_maps(nt_scene *scene, const nt_settings *settings, nt_format written, const nt_textures *textures,
	nt_error *error)
{
	/* a map that the user names is looked at, whatever else is asked for */
	const bool told = written != NT_FORMAT_PLY && (settings->check_maps == NT_CHECK_MAPS_ON ||
		(settings->check_maps == NT_CHECK_MAPS_AUTO &&
			(settings->report || settings->given_maps[NT_GIVEN_NORMAL])));
	const bool needed = told || nt_any_inverted(scene);
	examination *e = needed ? nt_calloc(1, sizeof *e) : NULL;
	bool *halved = e ? nt_calloc(scene->mesh_count, sizeof *halved) : NULL;
	if (!halved) {
		free(e);
		nt_tell_kept(scene, NULL);
		return needed ? nt_fail_memory(error) : NT_OK;
	}
	e->halved = halved;
	e->scene = scene;
	e->settings = settings;
	e->textures = textures;
	e->searched = nt_searched_places(settings);
	e->told = told;
	if (textures)
		e->pixels = nt_textures_pixels(textures, &e->bytes);
	const nt_status status = examine_all(e, error);
	nt_tell_kept(scene, halved);
	free(halved);
	nt_key_set_free(&e->known);
	free(e->maps);
	free(e);
	return status;
}
