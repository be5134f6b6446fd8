/* SPDX-License-Identifier: MIT */
/*
 * The images of materials (OBJ), for a glTF that is made anew: first the requests, which finds the files, then, beside
 * the solve, the conversions, then what is to be said about them. Other inputs and outputs have no such images: a
 * glTF that is changed keeps its own.
 */
#include "pipeline/stages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/text.h"
#include "file/input.h"
#include "file/path.h"

/* Materials that faces use, in the order of the meshes: first the *mapped ones that a mesh with texture coordinates
 * uses. Malloc'ed; NULL: memory is exhausted. */
static nt_material **list_materials(nt_scene *scene, size_t *mapped, size_t *count)
{
	nt_material **list = nt_alloc(scene->material_count, sizeof *list);
	bool *seen = nt_calloc(scene->material_count, sizeof *seen);
	*count = *mapped = 0;
	for (size_t m = 0; list && seen && m < 2 * scene->mesh_count; m++) {
		const nt_mesh *mesh = &scene->meshes[m % scene->mesh_count];
		if ((m < scene->mesh_count) != (mesh->texcoords != NULL))
			continue;
		for (size_t i = 0; i < mesh->primitive_count; i++) {
			const uint32_t number = mesh->primitives[i].material;
			if (number == NT_NONE || !mesh->primitives[i].face_count || seen[number])
				continue;
			seen[number] = true;
			list[(*count)++] = &scene->materials[number];
			*mapped += m < scene->mesh_count;
		}
	}
	if (!seen) {
		free(list);
		list = NULL;
	}
	free(seen);
	return list;
}

/* ---- requests ---- */

static nt_status request_material(const nt_scene *scene, const nt_settings *settings, nt_material *m,
	nt_textures *textures, nt_error *error)
{
	nt_image_places places = nt_searched_places(settings);
	places.document = m->library ? m->library : scene->path;
	places.input = scene->path;
	nt_map_request requests[NT_MATERIAL_MAPS];
	const size_t count = nt_map_requests(m, settings, requests);
	nt_status status = NT_OK;
	for (size_t i = 0; i < count && !status; i++) {
		uint32_t number;
		status = nt_textures_request(textures, &places, &requests[i].what, &number, error);
		for (int k = 0; k < 4 && !status; k++)
			if (requests[i].maps[k])
				requests[i].maps[k]->request = number;
	}
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
			status = nt_fail(error, NT_ERROR_USAGE, "--texture-path: '%s' is no folder",
				settings->texture_paths[i]);
	}
	return status;
}

nt_status nt_stage_textures(nt_scene *scene, const nt_settings *settings, const char *output, nt_textures **textures,
	nt_error *error)
{
	const bool writes = !settings->check && !settings->dry_run && strcmp(output, "-") != 0;
	*textures = nt_textures_create(writes ? output : NULL);
	if (!*textures)
		return nt_fail_memory(error);
	for (size_t i = 0; i < scene->material_count; i++)
		for (size_t k = 0; k < NT_MATERIAL_MAPS; k++)
			scene->materials[i].maps[k].request = NT_NONE;
	nt_status status = check_folders(settings, error);
	if (status || settings->io.images == NT_IMAGES_NONE)
		return status;
	size_t mapped, count;
	nt_material **materials = list_materials(scene, &mapped, &count);
	if (!materials)
		return nt_fail_memory(error);
	for (size_t i = 0; i < mapped && !status; i++)
		status = request_material(scene, settings, materials[i], *textures, error);
	free(materials);
	return status;
}

/* ---- making ---- */

nt_status nt_make_textures(nt_textures *textures, const nt_settings *s, nt_error *error)
{
	const nt_texture_rules rules = {.choice = s->textures, .flip = s->flip_green, .threads = s->io.threads,
		.max_pixels = s->max_pixels,
		.judged_only = (s->check || s->dry_run) && !(s->report && s->report->keep_geometry)};
	return nt_textures_make(textures, &rules, error);
}

/* ---- what is to be said ---- */

typedef struct telling {
	nt_scene *scene;
	const nt_textures *textures;
	const nt_settings *settings;
	nt_summary *summary;
	nt_material *material;
	size_t images, lost; /* that the material names, and those of them that are not in the output */
} telling;

/* Its path from the folder of the material library, as files are named. */
static void tell_elsewhere(const telling *t, const nt_place *place, const char *name, const char *path)
{
	nt_buffer folder = {0}, relative = {0};
	nt_error unused;
	if (nt_link_folder(&folder, place->file, &unused) == NT_OK)
		nt_path_relative(&relative, folder.data, path);
	nt_finding_add(&t->scene->findings, NT_CODE_IMAGE_ELSEWHERE, place, 1, "%.*s is %.*s", NT_CUT(100, name),
		NT_CUT(140, relative.data && !relative.failed ? relative.data : path));
	nt_buffer_free(&folder);
	nt_buffer_free(&relative);
}

/* Not ".", "..", or what ends in a slash. */
static bool names_file(const char *name)
{
	const char *slash = strrchr(name, '/'), *last = slash ? slash + 1 : name;
	return *last && strcmp(last, ".") != 0 && strcmp(last, "..") != 0;
}

/* Names of files, not paths: a report is the same wherever its input lies. */
static void tell_missing(const telling *t, const nt_place *place, const char *name)
{
	const char *input = t->scene->path, *library = t->material->library ? t->material->library : input;
	const char *own = nt_last_part(input), *last = nt_last_part(library);
	const bool apart = own - input != last - library || strncmp(input, library, (size_t)(own - input)) != 0;
	nt_finding_add(&t->scene->findings, NT_CODE_IMAGE_MISSING, place, 1,
		"%.*s (looked for beside %.*s%s%.*s%s)", NT_CUT(100, name), NT_CUT(40, last),
		apart ? " and " : "", apart ? (int)nt_utf8_cut(own, 40) : 0, own,
		t->settings->texture_path_count ? ", and in --texture-path" : "");
}

/* The image that a channel of a result came from. */
static void tell_source(telling *t, const nt_map *map, int channel, const nt_texture *image)
{
	const nt_place place = nt_material_place(t->scene, t->material, map->line);
	const nt_texture_source *source = nt_textures_source(t->textures, map->request, channel);
	const bool lost = image->packed ? image->lost >> channel & 1 : image->type == NT_IMAGE_OTHER;
	const bool failed = image->failure && (!image->packed || image->damaged >> channel & 1);
	nt_finding_list *findings = &t->scene->findings;
	t->images++;
	t->lost += source->found > NT_IMAGE_FOUND_ELSEWHERE || failed || lost;
	if (source->found > NT_IMAGE_FOUND_ELSEWHERE && !names_file(map->name))
		nt_finding_add(findings, NT_CODE_IMAGE_MISSING, &place, 1,
			"%.*s (no file is named)", NT_CUT(120, map->name));
	else if (source->found == NT_IMAGE_OUTSIDE)
		nt_finding_add(findings, NT_CODE_IMAGE_MISSING, &place, 1,
			"%.*s (it is outside of the folders where it may be; --outside=yes allows it)",
			NT_CUT(110, map->name));
	else if (source->obstacle)
		nt_finding_add(findings, NT_CODE_IMAGE_MISSING, &place, 1, "%.*s (%.*s)", NT_CUT(100, map->name),
			NT_CUT(120, source->obstacle));
	else if (source->found == NT_IMAGE_MISSING)
		tell_missing(t, &place, map->name);
	else if (failed)
		nt_finding_add(findings, NT_CODE_IMAGE_DAMAGED, &place, 1, "%.*s (%.*s)", NT_CUT(100, map->name),
			NT_CUT(120, image->failure));
	else if (lost)
		nt_finding_add(findings, NT_CODE_IMAGE_TYPE, &place, 1, "%.*s", NT_CUT(120, map->name));
	if (source->found == NT_IMAGE_FOUND_ELSEWHERE)
		tell_elsewhere(t, &place, map->name, source->path);
}

/* Whether an earlier map of the request has the same name. */
static bool is_repeated(const nt_map_request *w, int k)
{
	for (int j = 0; j < k; j++)
		if (w->maps[j] && strcmp(w->maps[j]->name, w->maps[k]->name) == 0)
			return true;
	return false;
}

static void tell_made(const telling *t, const nt_map_request *w, const nt_map *map, const nt_texture *image)
{
	const nt_place place = nt_material_place(t->scene, t->material, map->line);
	nt_finding_list *findings = &t->scene->findings;
	char names[4 * 50] = "";
	for (int k = 0; k < 4; k++)
		if (w->maps[k] && w->maps[k]->request != NT_NONE && !is_repeated(w, k))
			snprintf(names + strlen(names), sizeof names - strlen(names), "%s%.*s", *names ? ", " : "",
				NT_CUT(46, w->maps[k]->name));
	if (image->packed)
		nt_finding_add(findings, NT_CODE_IMAGE_CONVERTED, &place, 1, "channels of %s put together as %.*s",
			names, NT_CUT(50, image->name));
	else
		nt_finding_add(findings, NT_CODE_IMAGE_CONVERTED, &place, 1, "%.*s: %s to %s%s", NT_CUT(100, map->name),
			image->from_heights ? "height map" : nt_image_type_name(image->sources[0]->type),
			image->from_heights ? "normal map" : "PNG", image->flipped ? ", green turned up" : "");
}

/* The images of one request. */
static void tell_request(telling *t, const nt_map_request *w)
{
	const nt_map *first = NULL;
	const nt_texture *image = NULL;
	for (int k = 0; k < 4; k++) {
		nt_map *map = w->maps[k];
		if (!map || map->request == NT_NONE)
			continue;
		image = nt_textures_of(t->textures, map->request);
		if (!is_repeated(w, k))
			tell_source(t, map, k, image);
	}
	nt_map_request_settle(t->material, w, image ? image->lost : 0);
	for (int k = 4; k-- > 0;)
		first = w->maps[k] && w->maps[k]->request != NT_NONE ? w->maps[k] : first;
	if (first && image->made)
		tell_made(t, w, first, image);
}

static void tell_normals(const telling *t, const nt_texture *image)
{
	nt_material *m = t->material;
	const nt_place place = nt_material_place(t->scene, m, m->normal_map.line);
	nt_finding_list *findings = &t->scene->findings;
	const bool normals = image->type != NT_IMAGE_OTHER && !image->from_heights;
	const bool exists = image->sources[0]->found <= NT_IMAGE_FOUND_ELSEWHERE;
	if (m->bump && !m->bump_is_normal && t->settings->bump == NT_BUMP_AUTO && normals && exists)
		nt_finding_add(findings, NT_CODE_BUMP_AS_NORMAL, &place, 1, "%s %.*s", m->bump,
			NT_CUT(200, m->normal_map.name));
	if (normals && !nt_map_is_plain(&m->normal_map))
		nt_finding_add(findings, NT_CODE_MATERIAL_LOST, &place, 1, "MTL: -mm of a normal map");
	if (image->from_heights)
		m->normal_scale = 1; /* it went into the heights */
}

/* Maps for which nothing was requested, although they are there. */
static void tell_misplaced(const telling *t)
{
	for (size_t i = 0; i < NT_MATERIAL_MAPS; i++) {
		const nt_map *map = &t->material->maps[i];
		const nt_place place = nt_material_place(t->scene, t->material, map->line);
		if (map->name && map->request == NT_NONE && map != &t->material->normal_map)
			nt_finding_add(&t->scene->findings, NT_CODE_MATERIAL_LOST, &place, 1,
				"%.*s lies elsewhere than the map beside which it would be in one image",
				NT_CUT(120, map->name));
	}
}

static void count_bare(const telling *t, const nt_material *m)
{
	if (!t->summary->bare_materials++)
		snprintf(t->summary->bare_material, sizeof t->summary->bare_material, "%.*s",
			NT_CUT(sizeof t->summary->bare_material - 1, m->name));
}

static void tell_material(telling *t)
{
	nt_material *m = t->material;
	t->images = t->lost = 0;
	nt_map_request requests[NT_MATERIAL_MAPS];
	const size_t count = nt_map_requests(m, t->settings, requests);
	if (m->normal_map.request != NT_NONE)
		tell_normals(t, nt_textures_of(t->textures, m->normal_map.request));
	tell_misplaced(t);
	for (size_t i = 0; i < count; i++)
		tell_request(t, &requests[i]);
	if (t->images && t->lost == t->images)
		count_bare(t, m);
}

/* Images that no texture coordinates lay on the faces. */
static void tell_unmapped(const telling *t)
{
	const nt_material *m = t->material;
	const nt_map *first = NULL;
	size_t count = 0;
	for (size_t i = 0; i < NT_MATERIAL_MAPS; i++) {
		count += m->maps[i].name != NULL;
		first = first ? first : m->maps[i].name ? &m->maps[i] : NULL;
	}
	if (!count)
		return;
	const nt_place place = nt_material_place(t->scene, m, first->line);
	nt_finding_add(&t->scene->findings, NT_CODE_MATERIAL_LOST, &place, count,
		"%.*s%s: the faces have no texture coordinates, by which images lie on them", NT_CUT(120, first->name),
		count > 1 ? " and the others" : "");
	count_bare(t, m);
}

/* Whether the output has the normal map of a material. */
static bool is_mapped(const nt_scene *scene, const nt_settings *settings, const nt_textures *textures,
	const nt_primitive *primitive)
{
	const nt_map *map = primitive->material == NT_NONE || !primitive->face_count ? NULL
		: &scene->materials[primitive->material].normal_map;
	if (!map || !map->name || map->request == NT_NONE)
		return false;
	const nt_texture *image = nt_textures_at(textures, nt_textures_result(textures, map->request));
	return image->type != NT_IMAGE_OTHER &&
		(image->sources[0]->found != NT_IMAGE_MISSING || settings->io.images == NT_IMAGES_LINK);
}

/* Meshes are judged as the output has them, and so is what was found in their texture coordinates before. */
static void settle_slots(nt_scene *scene, const nt_settings *settings, const nt_textures *textures)
{
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		bool mapped = false;
		for (size_t p = 0; p < mesh->primitive_count && mesh->slots & NT_SLOT_NORMAL && !mapped; p++)
			mapped = is_mapped(scene, settings, textures, &mesh->primitives[p]);
		mesh->lost_map = mesh->slots & NT_SLOT_NORMAL && !mapped;
		if (mesh->lost_map)
			mesh->slots &= ~(unsigned)NT_SLOT_NORMAL;
	}
	for (size_t i = 0; i < scene->findings.count; i++) {
		nt_finding *f = &scene->findings.items[i];
		if (f->judged && !nt_mesh_needs_tangents(f->judged, nt_format_is_gltf(scene->judged)))
			f->severity = 1 + NT_SEVERITY_INFO;
	}
}

nt_status nt_tell_textures(nt_scene *scene, const nt_settings *settings, const nt_textures *textures,
	nt_summary *summary, nt_error *error)
{
	telling t = {.scene = scene, .textures = textures, .settings = settings, .summary = summary};
	if (textures)
		settle_slots(scene, settings, textures);
	if (settings->io.images == NT_IMAGES_NONE)
		return NT_OK;
	size_t mapped, count;
	nt_material **materials = list_materials(scene, &mapped, &count);
	if (!materials)
		return nt_fail_memory(error);
	for (size_t i = 0; i < count; i++) {
		t.material = materials[i];
		if (i >= mapped)
			tell_unmapped(&t);
		else if (textures)
			tell_material(&t);
	}
	free(materials);
	return NT_OK;
}
