/* SPDX-License-Identifier: MIT */
/*
 * --fix: what a check of the input calls error or warning, and whose row in report/codes.c says that --fix mends it,
 * becomes wishes of the run that writes. A primitive has its own wish: what is right in another one stays. Of a
 * primitive --existing=repair is enough, since no tangent that is wrong by itself passes it; what no solve makes better
 * stays. An info alone is no reason for anything.
 */
#include "pipeline/stages.h"

#include <stdlib.h>

void nt_fixes_free(nt_fixes *fixes)
{
	free(fixes->meshes);
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

nt_status nt_fixes_make(nt_fixes *fixes, const nt_report *report)
{
	*fixes = (nt_fixes){.mesh_count = report->mesh_count,
		.meshes = nt_calloc(report->mesh_count, sizeof *fixes->meshes)};
	if (!fixes->meshes)
		return NT_ERROR_MEMORY;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (f->severity == NT_SEVERITY_INFO || !f->repair || !nt_code_mends(f->code))
			continue;
		if (f->code == NT_CODE_NMAP_GREEN_DOWN) {
			fixes->turns_maps = true;
			fixes->counts[f->code]++;
		} else if (f->mesh != NT_NONE) {
			fixes->counts[f->code] += mark(report, f->mesh, fixes);
		}
	}
	return NT_OK;
}
