/* SPDX-License-Identifier: MIT */
/*
 * --fix: what a check of the input calls error or warning, and whose row in report/codes.c says that --fix mends it,
 * becomes wishes of the run that writes. A primitive has its own wish: what is right in another one stays.
 * --existing=repair is enough for a primitive, since no tangent that is wrong by itself passes it; one that no solve
 * makes better stays. An info alone is no reason for anything.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include <string.h>
#include "image/examine.h"

void nt_fixes_free(nt_fixes *fixes)
{
	free(fixes->meshes);
	free(fixes->images);
	*fixes = (nt_fixes){0};
}

/* The primitives that a finding holds for get their wish; how many. */
static size_t mark(const nt_report *report, uint32_t mesh, nt_fixes *fixes)
{
	size_t count = 0;
	for (size_t i = 0; i < report->mesh_count; i++) {
		if (i != mesh && report->meshes[i].same_as != mesh)
			continue;
		fixes->meshes[i] = NT_EXISTING_REPAIR;
		count++;
	}
	return count;
}

/* A pair of which a mesh has other faults is repaired as a whole: w is right then, and so has to be the map. */
static bool mark_pairs(const nt_scene *scene, nt_fixes *fixes)
{
	bool *repaired = nt_calloc(scene->mesh_count + 1, sizeof *repaired); /* by the pair's number */
	for (size_t i = 0; repaired && i < scene->mesh_count; i++)
		repaired[scene->meshes[i].pair] |= fixes->meshes[i] != 0;
	for (size_t i = 0; repaired && i < scene->mesh_count; i++)
		if (scene->meshes[i].pair && repaired[scene->meshes[i].pair])
			fixes->meshes[i] = NT_EXISTING_REPAIR;
	free(repaired);
	return repaired != NULL;
}

/* Maps that are turned: of meshes in no pair, and of those in one that is repaired. */
static bool mark_images(const nt_scene *scene, nt_fixes *fixes)
{
	const bool down = fixes->turns_maps;
	for (size_t i = 0; i < scene->mesh_count; i++)
		for (int slot = 0; slot < 2; slot++)
			if (scene->meshes[i].normal_maps[slot].image >= fixes->image_count)
				fixes->image_count = (size_t)scene->meshes[i].normal_maps[slot].image + 1;
	fixes->images = nt_calloc(fixes->image_count, sizeof *fixes->images);
	for (size_t i = 0; fixes->images && i < scene->mesh_count; i++)
		for (int slot = 0; slot < 2; slot++) {
			const nt_mesh_map *map = &scene->meshes[i].normal_maps[slot];
			const bool repaired = scene->meshes[i].pair ? fixes->meshes[i] != 0 : down;
			if (map->number && map->green == NT_GREEN_DOWN && repaired)
				fixes->images[map->image] = fixes->turns_maps = true;
		}
	return fixes->images != NULL;
}

nt_status nt_fixes_make(nt_fixes *fixes, const nt_scene *scene, const nt_report *report)
{
	*fixes = (nt_fixes){.mesh_count = report->mesh_count,
		.meshes = nt_calloc(report->mesh_count, sizeof *fixes->meshes)};
	if (!fixes->meshes)
		return NT_ERROR_MEMORY;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (f->severity == NT_SEVERITY_INFO || !f->repair || strcmp(f->repair, "--fix") != 0)
			continue;
		if (f->code == NT_CODE_NMAP_GREEN_DOWN) {
			fixes->turns_maps = true;
			fixes->counts[f->code]++;
		} else if (f->mesh != NT_NONE) {
			fixes->counts[f->code] += mark(report, f->mesh, fixes);
		}
	}
	const bool gltf = nt_format_is_gltf(scene->format);
	return !gltf || (mark_pairs(scene, fixes) && mark_images(scene, fixes)) ? NT_OK : NT_ERROR_MEMORY;
}
