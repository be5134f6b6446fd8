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
#include "image/image.h"

void nt_fixes_free(nt_fixes *fixes)
{
	free(fixes->meshes);
	free(fixes->images);
	*fixes = (nt_fixes){0};
}

/* Each primitive that a finding holds for gets its wish and its doubt: the later ones of the same geometry, too. */
static void mark(const nt_scene *scene, const nt_report *report, const nt_report_finding *f, bool mends,
	nt_fixes *fixes)
{
	for (size_t i = 0; i < report->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		if (i != f->mesh && report->meshes[i].same_as != f->mesh)
			continue;
		if (f->code == NT_CODE_TAN_SIGN_MISMATCH && mesh->doubt == NT_DOUBT_UNDECODABLE && !mesh->pair)
			fixes->meshes[i].doubtful = f->count;
		/* without texture coordinates nothing takes the place of what cannot be read */
		if (!mends || (f->code == NT_CODE_TAN_ACCESSOR && !mesh->has_texcoords))
			continue;
		fixes->meshes[i].existing = NT_EXISTING_REPAIR;
		fixes->counts[f->code]++;
	}
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
		.meshes = nt_calloc(report->mesh_count, sizeof *fixes->meshes)};
	if (!fixes->meshes)
		return NT_ERROR_MEMORY;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		const bool repairs = f->severity != NT_SEVERITY_INFO && f->repair && !f->stays;
		const bool mends = repairs && strcmp(f->repair, "--fix") == 0;
		const char *option = nt_code_info(f->code)->repair;
		fixes->left[f->code] |= repairs && !mends && option && strcmp(f->repair, option) == 0 &&
			!nt_code_condition(f->code);
		if (f->code == NT_CODE_NMAP_GREEN_DOWN) {
			fixes->turns_maps |= mends;
			fixes->counts[f->code] += mends;
		} else if (f->mesh != NT_NONE) {
			mark(scene, report, f, mends, fixes);
		}
	}
	for (size_t i = 0; i < report->mesh_count; i++) {
		const nt_mesh *mesh = &scene->meshes[i];
		fixes->meshes[i].keeps_inverted = mesh->signs == NT_SIGN_INVERTED && (mesh->pair || mesh->doubt);
	}
	return !nt_format_is_gltf(scene->format) || mark_images(scene, fixes) ? NT_OK : NT_ERROR_MEMORY;
}
