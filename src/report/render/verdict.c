/* SPDX-License-Identifier: MIT */
/*
 * What is to be done about a report, in one sentence, and what nmtan itself can do about a finding.
 *
 * Errors count before warnings. Of these, what has to be exported again comes first, since all else is made from it,
 * then what has to be baked again, then what a conversion repairs.
 */
#include "report/render/words.h"

/* The greatest is told first. */
typedef enum action { ACTION_LOOK, ACTION_CONVERT, ACTION_BAKE, ACTION_EXPORT } action;

typedef struct repair {
	action action;
	const char *options; /* that repair it; NULL: nothing here does */
} repair;

#define EXPORT(code)           [NT_CODE_##code] = {ACTION_EXPORT, NULL}
#define BAKE(code)             [NT_CODE_##code] = {ACTION_BAKE, NULL}
#define CONVERT(code, options) [NT_CODE_##code] = {ACTION_CONVERT, options}

static const char replace[] = "--existing=replace";

/* What is not here is to be looked at. */
static const repair repairs[NT_CODE_COUNT] = {
	EXPORT(MTL_MISSING), EXPORT(MATERIAL_UNKNOWN), EXPORT(IMAGE_MISSING), EXPORT(IMAGE_TYPE),
	EXPORT(IMAGE_DAMAGED), EXPORT(IMAGE_ELSEWHERE), EXPORT(MATERIAL_DOUBTFUL), EXPORT(COLORS_DOUBTFUL),
	EXPORT(POLYGON_DEGENERATE), EXPORT(NORMALS_CANCELLED), EXPORT(NORMALS_NOT_THERE), EXPORT(UV_MIRROR_SEAM),
	EXPORT(UV_MIRROR_OVERLAP), EXPORT(UV_MIRROR_LONE), EXPORT(UV_MIXED_WINDING_ISLAND), EXPORT(UV_FLIPPED_TRIANGLE),
	EXPORT(UV_DEGENERATE_TRIANGLE), EXPORT(UV_NEAR_DEGENERATE), EXPORT(UV_FOLDED_QUAD), EXPORT(UV_UNMAPPED),
	EXPORT(UV_ROUNDED_AWAY), EXPORT(UV_NOT_FINITE), EXPORT(UV_MISSING), EXPORT(UV_NOT_THERE),
	EXPORT(MESH_NOT_READ), EXPORT(POS_DEGENERATE_TRIANGLE), EXPORT(POS_NOT_FINITE), EXPORT(MESH_NON_MANIFOLD_EDGE),
	EXPORT(MESH_INCONSISTENT_WINDING), EXPORT(MESH_NORMAL_NON_UNIT), EXPORT(MESH_NORMAL_ZERO),
	EXPORT(MESH_NORMAL_AGAINST_FACE), EXPORT(TAN_NO_UV), EXPORT(TAN_UVSET_CONFLICT),
	EXPORT(TAN_UV_TRANSFORM_ANIMATED), EXPORT(TAN_MORPH_TURNED), EXPORT(TAN_MORPH_HALFWAY),

	[NT_CODE_NMAP_GREEN_DOWN] = {ACTION_BAKE, "--flip-green=auto"},
	[NT_CODE_NMAP_HEIGHTS] = {ACTION_BAKE, "--bump=height"},
	BAKE(NMAP_GREEN_MIXED), BAKE(NMAP_NOT_UNIT), BAKE(NMAP_BLUE_BELOW_HALF), BAKE(NMAP_OBJECT_SPACE),
	BAKE(NMAP_CONSTANT), BAKE(NMAP_BANDED), BAKE(NMAP_SRGB), BAKE(NMAP_JPEG),

	CONVERT(TAN_MIRROR_SHARED_VERTEX, replace), CONVERT(TAN_MIXED_W_TRIANGLE, replace),
	CONVERT(TAN_SIGN_MISMATCH, replace), CONVERT(TAN_DIRECTION_MISMATCH, replace),
	CONVERT(TAN_NOT_ORTHOGONAL, replace), CONVERT(TAN_PARALLEL_NORMAL, replace), CONVERT(TAN_ZERO, replace),
	CONVERT(TAN_NOT_FINITE, replace), CONVERT(TAN_NON_UNIT, replace), CONVERT(TAN_BAD_W, replace),
	CONVERT(TAN_MORPH_MISSING, replace), CONVERT(TAN_MADE_BY, replace), CONVERT(TAN_KEPT_SIGN, replace),
	CONVERT(TAN_EXISTING_BAD, "--existing=repair"), CONVERT(TAN_MISSING_REQUIRED, ""),
	CONVERT(TAN_NO_NORMAL, "--normals=smooth"), CONVERT(TAN_PRIMITIVE_BORDER, "--across=mesh"),
	CONVERT(TAN_QUANTIZED, "--precision=float"), CONVERT(TAN_QUADS_LIKELY, "--quads=pairs"),
};

bool nt_repair_options(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	const char *options = repairs[finding->code].options;
	if (!options)
		return false;
	nt_buffer_text(out, options);
	/* what no material asks for stays as it is, unless it is asked for */
	if (options == replace && finding->mesh != NT_NONE && !report->meshes[finding->mesh].slots)
		nt_buffer_text(out, " --only=all");
	return true;
}

/* The finding that has to be seen to first, of the new ones of a severity; NULL: none was kept. */
static const nt_report_finding *find_first(const nt_report *report, nt_severity severity)
{
	const nt_report_finding *first = NULL;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *f = &report->findings[i];
		if (f->known || f->severity != severity)
			continue;
		if (!first || repairs[f->code].action > repairs[first->code].action)
			first = f;
	}
	return first;
}

/* "Ready to use", or "Nothing new: 1 known error, 2 known warnings". */
static void append_nothing_new(const size_t known[3], nt_buffer *out)
{
	const char *before = "Nothing new: ";
	for (int severity = NT_SEVERITY_ERROR; severity >= NT_SEVERITY_WARNING; severity--) {
		if (!known[severity])
			continue;
		nt_buffer_format(out, "%s%zu known %s%s", before, known[severity],
			nt_severity_name((nt_severity)severity), known[severity] == 1 ? "" : "s");
		before = ", ";
	}
	if (!known[NT_SEVERITY_ERROR] && !known[NT_SEVERITY_WARNING])
		nt_buffer_text(out, "Ready to use");
}

static void append_verdict(const nt_report *report, nt_buffer *out)
{
	static const char *const verbs[] = {"Look at this", "Convert with nmtan", "Bake again", "Export again"};
	const size_t errors = report->by_severity[NT_SEVERITY_ERROR];
	const size_t all = errors + report->by_severity[NT_SEVERITY_WARNING];
	if (report->failure) {
		nt_buffer_format(out, "Not judged: %s", report->failure);
		return;
	}
	if (!all) {
		append_nothing_new(report->known, out);
		return;
	}
	const nt_report_finding *first = find_first(report, errors ? NT_SEVERITY_ERROR : NT_SEVERITY_WARNING);
	nt_buffer_format(out, "%s: %s", first ? verbs[repairs[first->code].action] : verbs[0],
		first ? first->message : "findings that are not shown");
	if (all > 1)
		nt_buffer_format(out, "; and %zu more", all - 1);
}

void nt_put_verdict(const nt_report *report, void (*put)(const char *text, nt_buffer *out), nt_buffer *out)
{
	nt_buffer verdict = {0};
	append_verdict(report, &verdict);
	put(verdict.data ? verdict.data : "", out);
	nt_buffer_free_into(&verdict, out);
}
