/* SPDX-License-Identifier: MIT */
/* Settings by chance: see any_settings.h. */
#include "any_settings.h"

#include <string.h>
#include "mutate.h"

nt_settings any_settings(const char *input, uint32_t *chance, const nt_report_options *report, const char **output)
{
	static const nt_format formats[] = {NT_FORMAT_GLB, NT_FORMAT_GLB, NT_FORMAT_GLTF, NT_FORMAT_PLY};
	static const char *const names[] = {"o.glb", "o.glb", "o.gltf", "o.ply"};
	static const nt_images images[] = {NT_IMAGES_DEFAULT, NT_IMAGES_LINK, NT_IMAGES_EMBED, NT_IMAGES_COPY};
	static const nt_draco_choice draco[] = {NT_DRACO_OFF, NT_DRACO_OFF, NT_DRACO_KEEP, NT_DRACO_KEEP,
		NT_DRACO_AS_SEQUENTIAL, NT_DRACO_AS_EDGEBREAKER};
	const uint32_t form = mutate_random(chance, 4);
	const bool check = mutate_random(chance, 8) == 0, ply = formats[form] == NT_FORMAT_PLY;
	const bool edited = strstr(input, ".gl") && !ply && !check;
	const bool integers = mutate_random(chance, 6) == 0 && !ply;
	const bool texts = strstr(input, ".obj") || strstr(input, ".ply");
	*output = names[form];
	nt_settings s = (nt_settings){.io.texcoord_set = -1, .only = mutate_random(chance, 4) ? NT_ONLY_ALL : 0,
		.existing = mutate_random(chance, 2) ? NT_EXISTING_REPLACE : 0, .io.threads = 1,
		.normals = mutate_random(chance, 3) ? NT_NORMALS_FLAT : NT_NORMALS_AUTO,
		.io.across = mutate_random(chance, 6) ? NT_ACROSS_PRIMITIVE : NT_ACROSS_MESH,
		.io.images = images[mutate_random(chance, 4)], .io.buffers = (nt_buffers)mutate_random(chance, 4),
		.io.draco = draco[mutate_random(chance, edited ? 6 : 4)],
		.io.morphs = (nt_morph_choice)mutate_random(chance, 3),
		.io.precision = integers ? (nt_precision)(1 + mutate_random(chance, 2)) : NT_PRECISION_FLOAT,
		.method = (nmtan_method)(mutate_random(chance, 4) ? 0 : mutate_random(chance, 4)),
		.io.weld = edited && mutate_random(chance, 4) == 0,
		.io.bitangents = mutate_random(chance, 8) == 0, .output_format = check ? 0 : formats[form],
		.verify = mutate_random(chance, 8) == 0 && !ply && !check, .list_meshes = mutate_random(chance, 8) == 0,
		.report = mutate_random(chance, 4) && !check ? NULL : report, .check = check};
	const uint32_t origin = texts ? mutate_random(chance, 8) : 0;
	if (origin == 1)
		s.io.origin.choice = NT_ORIGIN_KEEP;
	if (origin == 2)
		s.io.origin = (nt_origin){.choice = NT_ORIGIN_GIVEN, .at = {5e6, -0.125, 1e30}};
	return s;
}
