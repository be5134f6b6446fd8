/* SPDX-License-Identifier: MIT */
/*
 * The table of formats and its lookups: see format.h. Content decides before the name does: formats
 * with a magic number come first, OBJ, which has none, last.
 */
#include "format/format.h"

#include <string.h>
#include <strings.h>
#include "format/drc.h"
#include "gltf/create/create.h"
#include "gltf/document.h"
#include "gltf/edit/edit.h"
#include "gltf/edit/pool_edit.h"
#include "gltf/load.h"
#include "obj/read.h"
#include "ply/ply.h"

static nt_status write_gltf(nt_scene *scene, const nt_write_options *options,
	nt_output *output, nt_error *error)
{
	if (nt_format_is_gltf(scene->format))
		return nt_gltf_edit(scene, options, output, error);
	return nt_gltf_compose(scene, options, output, error);
}

static const nt_format_entry table[] = {
	{.format = NT_FORMAT_GLB,
		.name = "glb",
		.extensions = ".glb",
		.recognise = nt_glb_recognise,
		.open = nt_gltf_open,
		.plan = nt_gltf_plan,
		.prepare = nt_gltf_prepare,
		.load = nt_gltf_load,
		.merge = nt_gltf_merge,
		.write = write_gltf},
	{.format = NT_FORMAT_DRC,
		.name = "drc",
		.extensions = ".drc",
		.recognise = nt_drc_recognise,
		.open = nt_drc_open},
	{.format = NT_FORMAT_PLY,
		.name = "ply",
		.extensions = ".ply",
		.recognise = nt_ply_recognise,
		.open = nt_ply_open,
		.write = nt_ply_write},
	{.format = NT_FORMAT_GLTF,
		.name = "gltf",
		.extensions = ".gltf",
		.recognise = nt_gltf_recognise,
		.open = nt_gltf_open,
		.plan = nt_gltf_plan,
		.prepare = nt_gltf_prepare,
		.load = nt_gltf_load,
		.merge = nt_gltf_merge,
		.write = write_gltf},
	{.format = NT_FORMAT_OBJ,
		.name = "obj",
		.extensions = ".obj",
		.recognise = nt_obj_recognise,
		.open = nt_obj_open},
};
enum { FORMAT_COUNT = sizeof table / sizeof table[0] };

const nt_format_entry *nt_format_find(nt_format format)
{
	for (size_t i = 0; i < FORMAT_COUNT; i++)
		if (table[i].format == format)
			return &table[i];
	return NULL;
}

const nt_format_entry *nt_format_of_input(const unsigned char *bytes, size_t size, const char *path)
{
	for (size_t i = 0; i < FORMAT_COUNT; i++)
		if (table[i].recognise && table[i].recognise(bytes, size))
			return &table[i];
	return nt_format_of_path(path);
}

/* Whether a list of words separated by spaces has this word, in any case. */
static bool has_word(const char *list, const char *word)
{
	const size_t length = strlen(word);
	while (length && *list) {
		const size_t end = strcspn(list, " ");
		if (end == length && strncasecmp(list, word, length) == 0)
			return true;
		list += end + (list[end] == ' ');
	}
	return false;
}

const nt_format_entry *nt_format_of_path(const char *path)
{
	const char *slash = strrchr(path, '/');
	const char *dot = strrchr(slash ? slash + 1 : path, '.');
	for (size_t i = 0; dot && i < FORMAT_COUNT; i++)
		if (has_word(table[i].extensions, dot))
			return &table[i];
	return NULL;
}

const nt_format_entry *nt_format_unnamed(const nt_format_entry *reader)
{
	return nt_format_find(reader->format == NT_FORMAT_PLY ? NT_FORMAT_PLY : NT_FORMAT_GLB);
}
