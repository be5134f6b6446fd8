/* SPDX-License-Identifier: MIT */
/*
 * The table of formats and its lookups: see format.h. Content decides before the name does: formats
 * with a magic number come first, OBJ, which has none, last.
 */
#include "format/format.h"

#include <string.h>
#include <strings.h>
#include "gltf/create/create.h"
#include "gltf/document.h"
#include "gltf/edit/edit.h"
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

/* The extension of a path with its dot; "": none. */
static const char *extension_of(const char *path)
{
	const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash + 1 : path, '.');
	return dot ? dot : "";
}

const nt_format_entry *nt_format_of_path(const char *path)
{
	const char *extension = extension_of(path);
	for (size_t i = 0; i < FORMAT_COUNT; i++)
		if (has_word(table[i].extensions, extension))
			return &table[i];
	return NULL;
}

const nt_format_entry *nt_format_unnamed(const nt_format_entry *reader)
{
	return nt_format_find(reader->format == NT_FORMAT_PLY ? NT_FORMAT_PLY : NT_FORMAT_GLB);
}

/* ---- what is not read ---- */

static const struct {
	const char *begin;      /* first bytes; "": none that tell it */
	const char *extensions; /* separated by spaces */
	const char *advice;
} foreign[] = {
	{"Kaydara FBX Binary", ".fbx", "FBX is not read: export glTF (.glb) instead; Blender opens FBX and exports it"},
	{"; FBX", ".fbx", "FBX is not read: export glTF (.glb) instead; Blender opens FBX and exports it"},
	{"", ".dae", "COLLADA is not read: export glTF (.glb) instead, or OBJ"},
	{"solid ", ".stl",
		"STL is not read, and has no texture coordinates that tangents could follow: export OBJ or glTF "
		"(.glb) of the unwrapped model instead"},
	{"PXR-USDC", ".usd .usdc", "USD is not read: export glTF (.glb) instead; Blender opens USD and exports it"},
	{"#usda", ".usda .usdz", "USD is not read: export glTF (.glb) instead; Blender opens USD and exports it"},
	{"b3dm", ".b3dm",
		"a tile of 3D Tiles is not read: the GLB in it is (b3dmToGlb of 3d-tiles-tools takes it out)"},
	{"i3dm", ".i3dm",
		"a tile of 3D Tiles is not read: the GLB in it is (i3dmToGlb of 3d-tiles-tools takes it out)"},
	{"BLENDER", ".blend", "Blender's own files are not read: export glTF (.glb) from Blender instead"},
};
enum { FOREIGN_COUNT = sizeof foreign / sizeof foreign[0] };

const char *nt_foreign_advice(const unsigned char *bytes, size_t size, const char *path)
{
	const char *extension = extension_of(path);
	for (size_t i = 0; i < FOREIGN_COUNT; i++) {
		const size_t length = strlen(foreign[i].begin);
		if (length && size >= length && memcmp(bytes, foreign[i].begin, length) == 0)
			return foreign[i].advice;
	}
	for (size_t i = 0; i < FOREIGN_COUNT; i++)
		if (has_word(foreign[i].extensions, extension))
			return foreign[i].advice;
	return NULL;
}
