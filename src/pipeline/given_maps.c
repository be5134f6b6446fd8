/* SPDX-License-Identifier: MIT */
/*
 * Images that the user names for an input that says nothing of images, or of which one material does: --normal-map and
 * its like. If nobody names a normal map, one is proposed that is called after the input and lies beside it.
 */
#include "pipeline/stages.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "file/relative_path.h"

static const char *const option_names[NT_GIVEN_COUNT] = {
	"base-color", "normal-map", "metallic-roughness", "occlusion", "emissive"};

static nt_status check_file(const char *option, const char *path, nt_error *error)
{
	nt_file file;
	const nt_status status = nt_file_open_referred(&file, path, error);
	if (status && status != NT_ERROR_MISSING)
		return status;
	const bool image = !status && nt_image_type_of_bytes(file.data, file.size) != NT_IMAGE_OTHER;
	if (!status)
		nt_file_close(&file);
	return image ? NT_OK : nt_fail(error, NT_ERROR_USAGE, "--%s: '%s' is %s", option, path,
		status ? "not there" : "no image");
}

/* A map that lies where the one lay that it replaces: tangents follow how that was mirrored. */
static void set_map(nt_map *map, const char *name, char channel)
{
	*map = (nt_map){.name = name, .given = true, .placement = map->placement, .channel = channel, .gain = 1,
		.factor = 1};
}

static void set_maps(nt_material *m, const nt_settings *s)
{
	const char *const *names = s->given_maps;
	if (names[NT_GIVEN_BASE_COLOR]) {
		set_map(&m->base_color_map, names[NT_GIVEN_BASE_COLOR], 0);
		m->alpha_map.name = NULL;
	}
	if (names[NT_GIVEN_NORMAL]) {
		set_map(&m->normal_map, names[NT_GIVEN_NORMAL], 0);
		m->normal_scale = 1;
		m->bump = s->bump == NT_BUMP_HEIGHT ? "--normal-map" : NULL;
	}
	if (names[NT_GIVEN_METALLIC_ROUGHNESS]) {
		set_map(&m->roughness_map, names[NT_GIVEN_METALLIC_ROUGHNESS], 'g');
		set_map(&m->metallic_map, names[NT_GIVEN_METALLIC_ROUGHNESS], 'b');
		m->metallic = m->roughness = 1;
	}
	if (names[NT_GIVEN_OCCLUSION])
		set_map(&m->occlusion_map, names[NT_GIVEN_OCCLUSION], 'r');
	if (names[NT_GIVEN_EMISSIVE])
		set_map(&m->emissive_map, names[NT_GIVEN_EMISSIVE], 0);
}

/* All faces get the only material, or one that is made for it. */
static nt_status set_material(nt_scene *scene, const nt_settings *settings, nt_error *error)
{
	if (!scene->material_count) {
		scene->materials = nt_arena_alloc(&scene->arena, 1, sizeof *scene->materials);
		if (!scene->materials)
			return nt_fail_memory(error);
		*scene->materials = nt_material_default("");
		scene->material_count = 1;
	}
	set_maps(scene->materials, settings);
	for (size_t i = 0; i < scene->mesh_count; i++) {
		nt_mesh *mesh = &scene->meshes[i];
		for (size_t p = 0; p < mesh->primitive_count; p++)
			mesh->primitives[p].material = 0;
		mesh->slots |= settings->given_maps[NT_GIVEN_NORMAL] ? NT_SLOT_NORMAL : 0;
	}
	return NT_OK;
}

nt_status nt_stage_given_maps(nt_scene *scene, const nt_settings *settings, bool makes_document, nt_error *error)
{
	const char *option = NULL;
	nt_status status = NT_OK;
	for (size_t i = 0; i < NT_GIVEN_COUNT && !status; i++) {
		if (!settings->given_maps[i])
			continue;
		option = option_names[i];
		status = makes_document ? check_file(option, settings->given_maps[i], error)
			: nt_fail(error, NT_ERROR_USAGE, "--%s is for glTF made from OBJ, PLY or Draco", option);
	}
	if (status || !option)
		return status;
	if (scene->material_count > 1)
		return nt_fail(error, NT_ERROR_USAGE, "--%s is for an input with one material or none; it has %zu",
			option, scene->material_count);
	return set_material(scene, settings, error);
}

/* ---- what is beside the input ---- */

/* Whether `name` is the input's, then an ending of normal maps, then that of an image. */
static bool is_alike(const char *name, const char *stem, size_t length)
{
	static const char *const endings[] = {"nm_tangent", "normal", "normals", "normalmap", "nrm", "norm", "nm", "n",
		"ddn"};
	const char *dot = strrchr(name, '.');
	if (strncasecmp(name, stem, length) != 0 || !name[length] || !strchr("_-.", name[length]) || !dot ||
		dot <= name + length || nt_image_type_of_name(name) == NT_IMAGE_OTHER)
		return false;
	const char *rest = name + length + 1;
	const size_t left = (size_t)(dot - rest);
	for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
		if (strlen(endings[i]) == left && strncasecmp(endings[i], rest, left) == 0)
			return true;
	return false;
}

static bool wants_normals(const nt_scene *scene)
{
	bool wants = false;
	for (size_t i = 0; i < scene->mesh_count; i++)
		wants |= scene->meshes[i].has_texcoords;
	for (size_t i = 0; i < scene->material_count; i++)
		wants &= !scene->materials[i].normal_map.name;
	return wants;
}

void nt_propose_normal_map(nt_scene *scene, const nt_settings *settings)
{
	const char *name = nt_last_part(scene->path), *dot = strrchr(name, '.');
	const size_t length = dot ? (size_t)(dot - name) : strlen(name);
	char *folder = strndup(scene->path, (size_t)(name - scene->path));
	char found[256] = "";
	DIR *dir = settings->own_input && settings->images != NT_IMAGES_NONE && length && folder && wants_normals(scene)
		? opendir(*folder ? folder : ".") : NULL;
	for (const struct dirent *entry; dir && (entry = readdir(dir));)
		if (is_alike(entry->d_name, name, length) && (!*found || strcmp(entry->d_name, found) < 0))
			snprintf(found, sizeof found, "%s", entry->d_name);
	if (dir)
		closedir(dir);
	free(folder);
	nt_place place;
	nt_place_clear(&place);
	snprintf(place.file, sizeof place.file, "%s", scene->path);
	if (*found)
		nt_finding_add(&scene->findings, NT_CODE_NMAP_BESIDE, &place, 1, "%.200s", found);
}
