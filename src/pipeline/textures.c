/* SPDX-License-Identifier: MIT */
/*
 * The images of materials (OBJ), for a glTF that is made anew: first the wishes, which finds the files, then, beside
 * the solve, the conversions, then what is to be said about them. Other inputs and outputs have no such images: a
 * glTF that is changed keeps its own.
 */
#include "pipeline/stages.h"

#include <stdio.h>
#include <stdlib.h>
#include "base/parallel.h"
#include "base/pool.h"
#include "file/lookup.h"
#include "file/relative_path.h"

/* --bump-height where nobody says it. */
static const double default_bump_height = 1.0 / 64;

/* A map of a material, and what is wished for it. */
typedef struct wished_map {
	nt_map *map;
	nt_texture_wish what;
} wished_map;

enum { MOST_MAPS = 3 };

static nt_texture_kind kind_of_normal_map(const nt_material *m, nt_bump bump)
{
	if (bump == NT_BUMP_AUTO)
		return NT_TEXTURE_NORMALS_OR_HEIGHTS;
	return m->bump && bump == NT_BUMP_HEIGHT ? NT_TEXTURE_HEIGHTS : NT_TEXTURE_NORMALS;
}

/* The maps that a material has. */
static size_t list_maps(nt_material *m, const nt_settings *settings, wished_map maps[MOST_MAPS])
{
	const double height = settings->bump_height > 0 ? settings->bump_height : default_bump_height;
	const bool ignored = m->bump && settings->bump == NT_BUMP_IGNORE;
	const nt_texture_wish normals = {kind_of_normal_map(m, settings->bump), height * m->normal_scale,
		m->normal_map.placement.clamp};
	const wished_map all[MOST_MAPS] = {{&m->base_color_map, {0}}, {&m->emissive_map, {0}}, {&m->normal_map, normals}};
	size_t count = 0;
	for (size_t i = 0; i < MOST_MAPS; i++)
		if (all[i].map->name && *all[i].map->name && !(ignored && all[i].map == &m->normal_map))
			maps[count++] = all[i];
	return count;
}

/* Calls body once for each material that a mesh with texture coordinates uses, in the order of the meshes. */
static nt_status each_material(nt_scene *scene, void *context, nt_error *error,
	nt_status (*body)(nt_scene *scene, nt_material *material, void *context, nt_error *error))
{
	bool *seen = nt_calloc(scene->material_count, sizeof *seen);
	nt_status status = seen ? NT_OK : nt_fail_memory(error);
	for (size_t m = 0; m < scene->mesh_count && !status; m++) {
		const nt_mesh *mesh = &scene->meshes[m];
		for (size_t i = 0; i < mesh->primitive_count && mesh->texcoords && !status; i++) {
			const uint32_t number = mesh->primitives[i].material;
			if (number == NT_NONE || !mesh->primitives[i].face_count || seen[number])
				continue;
			seen[number] = true;
			status = body(scene, &scene->materials[number], context, error);
		}
	}
	free(seen);
	return status;
}

static nt_place place_of(const nt_scene *scene, const nt_material *m, size_t line)
{
	nt_place place;
	nt_place_clear(&place);
	snprintf(place.file, sizeof place.file, "%s", m->library ? m->library : scene->path);
	place.line = line;
	snprintf(place.object, sizeof place.object, "material \"%s\"", m->name ? m->name : "");
	return place;
}

/* ---- wishes ---- */

typedef struct wishing {
	nt_textures *textures;
	const nt_settings *settings;
} wishing;

static nt_status wish_for_material(nt_scene *scene, nt_material *m, void *context, nt_error *error)
{
	const wishing *w = context;
	const nt_image_places places = {.document = m->library ? m->library : scene->path, .input = scene->path,
		.folders = w->settings->texture_paths, .folder_count = w->settings->texture_path_count,
		.allow_outside = w->settings->allow_outside};
	wished_map maps[MOST_MAPS];
	const size_t count = list_maps(m, w->settings, maps);
	nt_status status = NT_OK;
	for (size_t i = 0; i < count && !status; i++)
		status = nt_textures_wish(w->textures, &places, maps[i].map->name, &maps[i].what, &maps[i].map->wish,
			error);
	return status;
}

static nt_status check_folders(const nt_settings *settings, nt_error *error)
{
	nt_status status = NT_OK;
	for (size_t i = 0; i < settings->texture_path_count && !status; i++) {
		struct stat info;
		bool found;
		status = nt_lookup_found(settings->texture_paths[i], &info, &found, error);
		if (!status && !(found && S_ISDIR(info.st_mode)))
			status = nt_fail(error, NT_ERROR_USAGE, "--texture-path: '%s' is no folder", settings->texture_paths[i]);
	}
	return status;
}

nt_status nt_stage_textures(nt_scene *scene, const nt_settings *settings, nt_textures **textures, nt_error *error)
{
	*textures = nt_textures_create();
	if (!*textures)
		return nt_fail_memory(error);
	for (size_t i = 0; i < scene->material_count; i++)
		for (size_t k = 0; k < NT_MATERIAL_MAPS; k++)
			scene->materials[i].maps[k].wish = NT_NONE;
	wishing w = {*textures, settings};
	const nt_status status = check_folders(settings, error);
	return status || settings->images == NT_IMAGES_NONE ? status : each_material(scene, &w, error, wish_for_material);
}

/* ---- making ---- */

typedef struct making {
	nt_scene *scene;
	const nt_settings *settings;
	nt_format output;
	nt_textures *textures;
	nt_summary *summary;
	nt_status status[2];
	nt_error *error, texture_error;
} making;

static void make_part(void *context, unsigned slot)
{
	making *m = context;
	if (slot == 0) {
		m->status[0] = nt_stage_tangents(m->scene, m->settings, m->output, m->summary, m->error);
		return;
	}
	const nt_texture_rules rules = {m->settings->textures, m->settings->flip_green, m->settings->threads};
	m->status[1] = nt_textures_make(m->textures, &rules, &m->texture_error);
}

nt_status nt_stage_tangents_and_textures(nt_scene *scene, const nt_settings *settings, nt_format output,
	nt_textures *textures, nt_summary *summary, nt_error *error)
{
	making m = {.scene = scene, .settings = settings, .output = output, .textures = textures, .summary = summary,
		.error = error};
	if (!textures || nt_thread_count(settings->threads) == 1) {
		make_part(&m, 0);
		if (textures && !m.status[0])
			make_part(&m, 1);
	} else {
		nt_pool_run(2, make_part, &m);
	}
	if (m.status[1] && !m.status[0])
		*error = m.texture_error;
	return m.status[0] ? m.status[0] : m.status[1];
}

/* ---- what is to be said ---- */

/* Where it is, from the folder of the material library. */
static void tell_elsewhere(nt_scene *scene, const nt_place *place, const char *name, const nt_texture *image)
{
	nt_buffer folder = {0}, relative = {0};
	nt_error unused;
	if (nt_link_folder(&folder, place->file, &unused) == NT_OK)
		nt_link_uri(&relative, folder.data, image->path);
	nt_finding_add(&scene->findings, NT_CODE_IMAGE_ELSEWHERE, place, 1, "%.100s is %.140s", name,
		relative.data ? relative.data : image->path);
	nt_buffer_free(&folder);
	nt_buffer_free(&relative);
}

static void tell_image(nt_scene *scene, const nt_material *m, const char *name, const nt_texture *image)
{
	const nt_place place = place_of(scene, m, m->line);
	nt_finding_list *findings = &scene->findings;
	if (image->found == NT_IMAGE_OUTSIDE)
		nt_finding_add(findings, NT_CODE_IMAGE_MISSING, &place, 1,
			"%.120s (it is outside of the folder of its MTL file, see --allow-outside)", name);
	else if (image->found == NT_IMAGE_MISSING)
		nt_finding_add(findings, NT_CODE_IMAGE_MISSING, &place, 1, "%.120s", name);
	else if (image->failure)
		nt_finding_add(findings, NT_CODE_IMAGE_DAMAGED, &place, 1, "%.100s (%.120s)", name, image->failure);
	else if (image->type == NT_IMAGE_OTHER)
		nt_finding_add(findings, NT_CODE_IMAGE_TYPE, &place, 1, "%.120s", name);
	if (image->found == NT_IMAGE_FOUND_ELSEWHERE)
		tell_elsewhere(scene, &place, name, image);
	if (image->bytes)
		nt_finding_add(findings, NT_CODE_IMAGE_CONVERTED, &place, 1, "%.100s: %s to %s%s", name,
			image->from_heights ? "height map" : nt_image_type_name(image->source_type),
			image->from_heights ? "normal map" : "PNG", image->flipped ? ", green turned up" : "");
}

static void tell_bump(nt_scene *scene, const nt_material *m)
{
	const nt_place place = place_of(scene, m, m->normal_map.line);
	nt_finding_add(&scene->findings, NT_CODE_BUMP_AS_NORMAL, &place, 1, "%s of %.120s", m->bump, m->name);
}

typedef struct telling {
	const nt_textures *textures;
	const nt_settings *settings;
} telling;

static nt_status tell_material(nt_scene *scene, nt_material *m, void *context, nt_error *error)
{
	(void)error;
	const telling *t = context;
	wished_map maps[MOST_MAPS];
	const size_t count = list_maps(m, t->settings, maps);
	for (size_t i = 0; i < count && t->textures; i++)
		tell_image(scene, m, maps[i].map->name,
			nt_textures_at(t->textures, nt_textures_result(t->textures, maps[i].map->wish)));
	for (size_t i = 0; i < NT_MATERIAL_MAPS; i++) {
		const nt_map *map = &m->maps[i];
		const nt_place place = place_of(scene, m, map->line);
		if (map->name && map != &m->base_color_map && map != &m->emissive_map && map != &m->normal_map)
			nt_finding_add(&scene->findings, NT_CODE_MATERIAL_LOST, &place, 1, "MTL: %.120s", map->name);
	}
	const bool wished = t->textures && m->normal_map.wish != NT_NONE;
	const nt_texture *normals = wished ? nt_textures_at(t->textures, nt_textures_result(t->textures, m->normal_map.wish)) : NULL;
	if (m->bump && t->settings->bump == NT_BUMP_AUTO &&
		(!t->textures || (normals && normals->type != NT_IMAGE_OTHER && !normals->from_heights)))
		tell_bump(scene, m);
	if (normals && normals->from_heights)
		m->normal_scale = 1; /* it went into the heights */
	return NT_OK;
}

nt_status nt_tell_textures(nt_scene *scene, const nt_settings *settings, const nt_textures *textures,
	nt_error *error)
{
	telling t = {textures, settings};
	if (settings->images == NT_IMAGES_NONE)
		return NT_OK;
	return each_material(scene, &t, error, tell_material);
}
