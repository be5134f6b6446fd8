/* SPDX-License-Identifier: MIT */
/*
 * Formats by their first bytes and endings: see foreign.h. Asked only of what no reader recognises.
 */
#include "format/foreign.h"

#include <string.h>
#include <strings.h>

static const struct {
	const char *begin;      /* first bytes; "": none that tell it */
	const char *extensions; /* separated by spaces */
	const char *advice;
} table[] = {
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

/* Whether the path ends in one of the extensions, in any case. */
static int ends_in(const char *path, const char *extensions)
{
	const char *dot = strrchr(path, '.');
	for (const char *e = extensions; dot && *e; e += strspn(e, " ")) {
		const size_t length = strcspn(e, " ");
		if (strlen(dot) == length && strncasecmp(dot, e, length) == 0)
			return 1;
		e += length;
	}
	return 0;
}

const char *nt_foreign_advice(const unsigned char *bytes, size_t size, const char *path)
{
	enum { COUNT = sizeof table / sizeof table[0] };
	for (size_t i = 0; i < COUNT; i++) {
		const size_t length = strlen(table[i].begin);
		if (length && size >= length && memcmp(bytes, table[i].begin, length) == 0)
			return table[i].advice;
	}
	for (size_t i = 0; i < COUNT; i++)
		if (ends_in(path, table[i].extensions))
			return table[i].advice;
	return NULL;
}
