/* SPDX-License-Identifier: MIT */
/*
 * --fix: what a check of the input calls error or warning, and whose row in report/codes.c says that --fix mends it,
 * becomes wishes of the run that writes. A primitive has its own wish: what is right in another one stays.
 * --existing=repair is enough for a primitive, since no tangent that is wrong by itself passes it; one that no solve
 * makes better stays. An info alone is no reason for anything. Inverted w that a normal map cancels, or may, is the
 * convention of its mesh: what is repaired there gets it too, and the map stays.
 */
#include "pipeline/stages.h"

#include <stdlib.h>
#include <string.h>
#include "image/examine.h"

void nt_fixes_free(nt_fixes *fixes)
{
	free(fixes->meshes);
	free(fixes->keep_inverted);
	free(fixes->doubtful);
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

/* Maps that are turned: of meshes in no pair. */
static bool mark_images(const nt_scene *scene, nt_fixes *fixes)
{
	for (size_t i = 0; i < scene->mesh_count; i++)
		for (int slot = 0; slot < 2; slot++)
			if (scene->meshes[i].normal_maps[slot].image >= fixes->image_count)
				fixes->image_count = (size_t)scene->meshes[i].normal_maps[slot].image + 1;
	fixes->images = nt_calloc(fixes->image_count, sizeof *fixes->images);
	for (size_t i = 0; fixes->images && i < scene->mesh_count; i++)
		for (int slot = 0; slot < 2; slot++) {
			const nt_mesh_map *map = &scene->meshes[i].normal_maps[slot];
			if (map->number && map->green == NT_GREEN_DOWN && !scene->meshes[i].pair && fixes->turns_maps)
				fixes->images[map->image] = true;
		}
	return fixes->images != NULL;
}

nt_status nt_fixes_make(nt_fixes *fixes, const nt_scene *scene, const nt_report *report)
{
	*fixes = (nt_fixes){.mesh_count = report->mesh_count,
		.meshes = nt_calloc(report->mesh_count, sizeof *fixes->meshes),
		.keep_inverted = nt_calloc(report->mesh_count, sizeof *fixes->keep_inverted),
		.doubtful = nt_calloc(report->mesh_count, sizeof *fixes->doubtful)};
	if (!fixes->meshes || !fixes->keep_inverted || !fixes->doubtful)
		return NT_ERROR_MEMORY;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (f->code == NT_CODE_TAN_SIGN_MISMATCH && f->mesh != NT_NONE &&
			scene->meshes[f->mesh].doubt == NT_DOUBT_UNDECODABLE && !scene->meshes[f->mesh].pair)
			fixes->doubtful[f->mesh] = f->count;
		if (f->severity == NT_SEVERITY_INFO || !f->repair || strcmp(f->repair, "--fix") != 0)
			continue;
		if (f->code == NT_CODE_NMAP_GREEN_DOWN) {
			fixes->turns_maps = true;
			fixes->counts[f->code]++;
		} else if (f->mesh != NT_NONE) {
			fixes->counts[f->code] += mark(report, f->mesh, fixes);
		}
	}
	for (size_t i = 0; i < report->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		fixes->keep_inverted[i] = mesh->signs == NT_SIGN_INVERTED && (mesh->pair || mesh->doubt);
	}
	return !nt_format_is_gltf(scene->format) || mark_images(scene, fixes) ? NT_OK : NT_ERROR_MEMORY;
}
