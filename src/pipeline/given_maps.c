/* SPDX-License-Identifier: MIT */
/*
 * Images that the user names for an input with one material or none: --normal-map and its like. If no normal map is
 * named, an image beside the input with a name like the input's is proposed.
 */
#include "pipeline/stages.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>
#include "file/path.h"

static const char *const option_names[NT_GIVEN_COUNT] = {
	"base-color", "normal-map", "metallic-roughness", "occlusion", "emissive"};

static nt_status check_file(const char *option, const char *path, nt_error *error)
{
	nt_file file;
	const nt_status status = nt_file_open(&file, path, NT_NAMED_BY_DOCUMENT, error);
	if (status == NT_ERROR_MISSING && access(path, F_OK) == 0) {
		nt_error why = *error;
		return nt_fail(error, NT_ERROR_USAGE, "--%s: '%s': %s", option, path, why.message);
	}
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

/* The endings of normal maps, the likeliest first: of tangent space, then by how often they name one. */
static const char *const endings[] = {"nm_tangent", "normal", "normals", "normalmap", "nrm", "norm", "nm", "n", "ddn"};
enum { ENDINGS = sizeof endings / sizeof *endings, MOST_BESIDE = 8 };

/* Which ending `name` has after the input's name, before that of an image; ENDINGS: none. */
static size_t rank_of(const char *name, const char *stem, size_t length)
{
	const char *dot = strrchr(name, '.');
	if (strncasecmp(name, stem, length) != 0 || !name[length] || !strchr("_-.", name[length]) || !dot ||
		dot <= name + length || nt_image_type_of_name(name) == NT_IMAGE_OTHER)
		return ENDINGS;
	const char *rest = name + length + 1;
	const size_t left = (size_t)(dot - rest);
	size_t i = 0;
	while (i < ENDINGS && !(strlen(endings[i]) == left && strncasecmp(endings[i], rest, left) == 0))
		i++;
	return i;
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

/* An image that may be the normal map. */
typedef struct beside {
	char *name;
	size_t rank;
} beside;

static int by_rank(const void *a, const void *b)
{
	const beside *x = a, *y = b;
	return x->rank != y->rank ? (x->rank < y->rank ? -1 : 1) : strcmp(x->name, y->name);
}

static void tell_beside(nt_scene *scene, const char *folder, const beside *found, size_t count)
{
	nt_buffer detail = {0}, option = {0}, word = {0};
	const nt_place place = nt_line_place(scene->path, 0);
	for (size_t i = 0; i < count && i < MOST_BESIDE; i++)
		nt_buffer_format(&detail, "%s%s", i ? ", or " : "", found[i].name);
	nt_buffer_format(&option, "--normal-map=%s%s", folder, found[0].name);
	const bool sayable = option.data && nt_shell_word(option.data, &word) && word.data;
	char *repair = sayable ? nt_arena_text(&scene->findings.arena, word.data, word.size) : NULL;
	scene->findings.failed |= !detail.data || !option.data || (sayable && !repair);
	if (!scene->findings.failed)
		nt_finding_put(&scene->findings, (nt_finding){.code = NT_CODE_NMAP_BESIDE, .count = 1,
			.detail = detail.data, .repair = repair, .stays = !repair}, &place);
	nt_buffer_free(&detail);
	nt_buffer_free(&option);
	nt_buffer_free(&word);
}

void nt_propose_normal_map(nt_scene *scene, const nt_settings *settings)
{
	const char *name = nt_last_part(scene->path), *dot = strrchr(name, '.');
	const size_t length = dot ? (size_t)(dot - name) : strlen(name);
	char *folder = strndup(scene->path, (size_t)(name - scene->path));
	beside *found = NULL;
	size_t count = 0, capacity = 0;
	const bool looks = settings->own_input && settings->io.images != NT_IMAGES_NONE && length && folder &&
		wants_normals(scene);
	DIR *dir = looks ? opendir(*folder ? folder : ".") : NULL;
	for (const struct dirent *entry; dir && (entry = readdir(dir));) {
		const size_t rank = rank_of(entry->d_name, name, length);
		if (rank == ENDINGS || !nt_grow((void **)&found, &capacity, count + 1, sizeof *found))
			continue;
		found[count] = (beside){strdup(entry->d_name), rank};
		count += found[count].name != NULL;
	}
	if (dir)
		closedir(dir);
	if (count) {
		qsort(found, count, sizeof *found, by_rank);
		tell_beside(scene, folder, found, count);
	}
	while (count)
		free(found[--count].name);
	free(found);
	free(folder);
}
