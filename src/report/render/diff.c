/* SPDX-License-Identifier: MIT */
/*
 * Changes between two versions: see render.h. Short, the worst first: meshes that are as they were are not listed in
 * text and Markdown, and of findings that both versions have only the number is told. data/nmtan-diff.schema.json
 * describes the JSON. HTML is the page of html.c, with both versions.
 */
#include "report/render/inside.h"

enum { OLD, NEW, SHOWN_FINDINGS = 50, SHOWN_MESHES = 50 };
static const char *const states[] = {"gone", "new"};

/* ---- what all formats ask ---- */

static const nt_report_mesh *mesh_of(const nt_report_diff *diff, const nt_mesh_change *change, int version)
{
	return change->meshes[version] == NT_NONE ? NULL : &diff->reports[version]->meshes[change->meshes[version]];
}

static bool is_changed(const nt_report_diff *diff, const nt_mesh_change *change)
{
	const nt_report_mesh *a = mesh_of(diff, change, OLD), *b = mesh_of(diff, change, NEW);
	return !a || !b || change->matched != a->triangle_count || change->matched != b->triangle_count ||
		change->moved_texcoords || change->turned || change->reversed || a->seam_count != b->seam_count ||
		a->seam_length < b->seam_length || a->seam_length > b->seam_length ||
		a->checked_tangents != b->checked_tangents || a->vertices_after != b->vertices_after;
}

static char *label_of(const nt_report_diff *diff, const nt_mesh_change *change)
{
	const int version = change->meshes[NEW] == NT_NONE ? OLD : NEW;
	return nt_mesh_label(diff->reports[version], change->meshes[version]);
}

static size_t total(const size_t by_severity[3])
{
	return by_severity[0] + by_severity[1] + by_severity[2];
}

/* "2 new findings (1 error, 1 warning, 0 infos), 3 gone, 12 unchanged" */
static void put_summary(const nt_report_diff *diff, nt_buffer *out)
{
	nt_totals totals = {0};
	for (int i = 0; i < 3; i++)
		totals.by_severity[i] = diff->by_severity[NEW][i];
	size_t changed = 0;
	for (size_t i = 0; i < diff->mesh_count; i++)
		changed += is_changed(diff, &diff->meshes[i]);
	const size_t new = total(diff->by_severity[NEW]), gone = total(diff->by_severity[OLD]);
	nt_buffer_format(out, "%zu new finding%s", new, nt_plural(new));
	if (new) {
		nt_buffer_text(out, " (");
		nt_totals_text(&totals, out);
		nt_buffer_text(out, ")");
	}
	nt_buffer_format(out, ", %zu gone, %zu unchanged; %zu of %zu meshes changed", gone, diff->unchanged, changed,
		diff->mesh_count);
}

/* Puts the findings that only a version has, most: how many at most; returns how many there are. */
static size_t put_findings(const nt_report_diff *diff, int version, size_t most,
	void (*put)(const nt_report *report, const nt_report_finding *finding, nt_buffer *out), nt_buffer *out)
{
	const nt_report *report = diff->reports[version];
	size_t count = 0;
	for (size_t i = 0; i < report->finding_count; i++)
		if (!diff->known[version][i] && count++ < most)
			put(report, &report->findings[i], out);
	return count;
}

/* Numbers of both versions, "1200 -> 1210" or "1200", between two texts. */
static void put_pair(const char *before, size_t a, size_t b, const char *after, nt_buffer *out)
{
	nt_buffer_text(out, before);
	if (a != b)
		nt_buffer_format(out, "%zu -> ", a);
	nt_buffer_format(out, "%zu%s", b, after);
}

/* "120 of 3570 tangents turned, by 35.2 degrees at most, 6 with w reversed" */
static void put_tangents(const nt_report_diff *diff, const nt_mesh_change *change, nt_buffer *out)
{
	const bool before = mesh_of(diff, change, OLD)->checked_tangents;
	const bool after = mesh_of(diff, change, NEW)->checked_tangents;
	if (before != after)
		nt_buffer_text(out, after ? "has tangents now" : "has no tangents any more");
	else if (!after)
		nt_buffer_text(out, "no tangents");
	else if (!change->compared)
		nt_buffer_text(out, "no tangents to compare");
	else
		nt_buffer_format(out, "%zu of %zu tangents turned, by %.4g degrees at most, %zu with w reversed",
			change->turned, change->compared, change->worst_degrees, change->reversed);
}

/* ---- text ---- */

static void text_mesh(const nt_report_diff *diff, const nt_mesh_change *change, nt_buffer *out)
{
	const nt_report_mesh *a = mesh_of(diff, change, OLD), *b = mesh_of(diff, change, NEW);
	nt_put(out, NT_TERMINAL, "  %p", label_of(diff, change));
	if (!a || !b) {
		nt_buffer_format(out, ": %s, %zu triangles\n", states[!a], (a ? a : b)->triangle_count);
		return;
	}
	put_pair(": triangles ", a->triangle_count, b->triangle_count, "", out);
	nt_buffer_format(out, ", %zu of them in place, %zu corners with other texture coordinates\n    ",
		change->matched, change->moved_texcoords);
	put_tangents(diff, change, out);
	if (change->turned)
		nt_buffer_format(out, "; most turned at (%.6g %.6g %.6g)", (double)change->worst_position[0],
			(double)change->worst_position[1], (double)change->worst_position[2]);
	put_pair("\n    vertices ", a->vertices_after, b->vertices_after, "", out);
	put_pair(", mirror seams ", a->seam_count, b->seam_count, "", out);
	nt_buffer_format(out, " of length %.4g -> %.4g\n", a->seam_length, b->seam_length);
}

static void text_finding(const nt_report *report, const nt_report_finding *finding, const char *state, nt_buffer *out)
{
	nt_put(out, NT_TERMINAL, "  %-4s  %-7s  %-s  %s", state, nt_severity_name(finding->severity),
		nt_finding_name(finding), finding->message);
	if (finding->mesh != NT_NONE && report->mesh_count > 1)
		nt_put(out, NT_TERMINAL, ", in %p", nt_mesh_label(report, finding->mesh));
	nt_buffer_text(out, "\n");
}

static void text_new(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	text_finding(report, finding, states[NEW], out);
}

static void text_gone(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	text_finding(report, finding, states[OLD], out);
}

void nt_diff_text(const nt_report_diff *diff, nt_buffer *out)
{
	nt_put(out, NT_TERMINAL, "%s -> %s: ", diff->reports[OLD]->shown, diff->reports[NEW]->shown);
	put_summary(diff, out);
	nt_buffer_text(out, "\n");
	for (int version = NEW; version >= OLD; version--) {
		const size_t count = put_findings(diff, version, SHOWN_FINDINGS, version ? text_new : text_gone, out);
		if (count > SHOWN_FINDINGS)
			nt_buffer_format(out, "  and %zu more that are %s\n", count - SHOWN_FINDINGS, states[version]);
	}
	for (size_t i = 0; i < diff->mesh_count; i++)
		if (is_changed(diff, &diff->meshes[i]))
			text_mesh(diff, &diff->meshes[i], out);
}

/* ---- Markdown ---- */

static void markdown_findings(const nt_report_diff *diff, int version, nt_buffer *out)
{
	if (!total(diff->by_severity[version]))
		return;
	nt_buffer_format(out, "\n| %s | code | where | finding |\n|---|---|---|---|\n", states[version]);
	const size_t count = put_findings(diff, version, SHOWN_FINDINGS, nt_put_markdown_row, out);
	if (count > SHOWN_FINDINGS)
		nt_buffer_format(out, "\n%zu more are not shown.\n", count - SHOWN_FINDINGS);
}

static void markdown_mesh(const nt_report_diff *diff, const nt_mesh_change *change, nt_buffer *out)
{
	const nt_report_mesh *a = mesh_of(diff, change, OLD), *b = mesh_of(diff, change, NEW);
	nt_put(out, NT_MARKDOWN, "| %p | ", label_of(diff, change));
	if (!a || !b) {
		nt_buffer_format(out, "%s | %zu | | |\n", states[!a], (a ? a : b)->triangle_count);
		return;
	}
	put_tangents(diff, change, out);
	put_pair(" | ", a->triangle_count, b->triangle_count, " | ", out);
	put_pair("", a->vertices_after, b->vertices_after, " | ", out);
	put_pair("", a->seam_count, b->seam_count, " |\n", out);
}

void nt_diff_markdown(const nt_report_diff *diff, nt_buffer *out)
{
	nt_put(out, NT_MARKDOWN, "**%s \xe2\x86\x92 %s**: ", diff->reports[OLD]->shown, diff->reports[NEW]->shown);
	put_summary(diff, out);
	nt_buffer_text(out, "\n");
	markdown_findings(diff, NEW, out);
	size_t changed = 0;
	for (size_t i = 0; i < diff->mesh_count; i++) {
		if (!is_changed(diff, &diff->meshes[i]) || changed++ >= SHOWN_MESHES)
			continue;
		if (changed == 1)
			nt_buffer_text(out, "\n| mesh | tangents | triangles | vertices | mirror seams |\n"
				"|---|---|---:|---:|---:|\n");
		markdown_mesh(diff, &diff->meshes[i], out);
	}
	if (changed > SHOWN_MESHES)
		nt_buffer_format(out, "\n%zu more meshes changed.\n", changed - SHOWN_MESHES);
	markdown_findings(diff, OLD, out);
}

/* ---- JSON ---- */

static void json_side(const char *name, const nt_report_mesh *mesh, nt_buffer *out)
{
	if (mesh)
		nt_put(out, NT_JSON, ",'%-s':{'name':%s,'triangles':%zu,'vertices':%zu,'has_tangents':%hhd,"
			"'mirror_seams':%zu,'seam_length':%g}", name, mesh->name, mesh->triangle_count,
			mesh->vertices_after, mesh->checked_tangents, mesh->seam_count, mesh->seam_length);
	else
		nt_put(out, NT_JSON, ",'%-s':null", name);
}

static void json_mesh(const nt_report_diff *diff, const nt_mesh_change *change, nt_buffer *out)
{
	nt_put(out, NT_JSON, ",\n\t\t{'changed':%hhd", is_changed(diff, change));
	json_side("old", mesh_of(diff, change, OLD), out);
	json_side("new", mesh_of(diff, change, NEW), out);
	nt_put(out, NT_JSON, ",'triangles_in_place':%zu,'corners_with_other_texcoords':%zu,'tangents':{'compared':%zu,"
		"'turned':%zu,'reversed_w':%zu,'worst_degrees':%g,'worst_position':", change->matched,
		change->moved_texcoords, change->compared, change->turned, change->reversed, change->worst_degrees);
	if (change->compared)
		nt_put(out, NT_JSON, "[%g,%g,%g]", (double)change->worst_position[0],
			(double)change->worst_position[1], (double)change->worst_position[2]);
	else
		nt_buffer_text(out, "null");
	nt_put_histogram("histogram", change->histogram, out);
	nt_buffer_text(out, "}}");
}

static void json_finding(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	(void)report;
	nt_put(out, NT_JSON, ",\n\t\t{'code':%s,'severity':%s,'message':%s,'count':%zu,'fingerprint':%" PRIx64
		",'mesh':%u}", nt_finding_name(finding), nt_severity_name(finding->severity), finding->message,
		finding->count, finding->fingerprint, finding->mesh);
}

void nt_diff_json(const nt_report_diff *diff, nt_buffer *out)
{
	nt_put(out, NT_JSON, "{\n\t'report':'nmtan-diff',\n\t'report_version':1,\n\t'generator':'nmtan %-s',\n"
		"\t'old':%s,\n\t'new':%s,\n\t'unchanged_findings':%zu", NMTAN_VERSION_STRING,
		diff->reports[OLD]->shown, diff->reports[NEW]->shown, diff->unchanged);
	for (int version = NEW; version >= OLD; version--) {
		nt_put(out, NT_JSON, ",\n\t'%-s_findings':[", states[version]);
		const size_t count = put_findings(diff, version, SIZE_MAX, json_finding, out);
		nt_buffer_text(out, count ? "\n\t]" : "]");
	}
	nt_buffer_text(out, ",\n\t\"meshes\":[");
	for (size_t i = 0; i < diff->mesh_count; i++)
		json_mesh(diff, &diff->meshes[i], out);
	nt_buffer_text(out, "\n\t]\n}\n");
}

/* ---- HTML ---- */

static void page_rows(const nt_report_diff *diff, const nt_mesh_change *change, nt_buffer *out)
{
	const nt_report_mesh *a = mesh_of(diff, change, OLD), *b = mesh_of(diff, change, NEW);
	if (!a || !b) {
		nt_buffer_format(out, "[\"mesh\",\"%s, %zu triangles\"]", states[!a], (a ? a : b)->triangle_count);
		return;
	}
	nt_buffer_text(out, "[\"tangents\",\"");
	put_tangents(diff, change, out);
	put_pair("\"],[\"triangles\",\"", a->triangle_count, b->triangle_count, "", out);
	nt_buffer_format(out, ", %zu in place\"],[\"texture\",\"%zu corners with other coordinates", change->matched,
		change->moved_texcoords);
	put_pair("\"],[\"islands\",\"", a->island_count, b->island_count, "", out);
	put_pair("\"],[\"vertices\",\"", a->vertices_after, b->vertices_after, "", out);
	put_pair("\"],[\"split for tangents\",\"", a->vertices_after - a->vertices_before,
		b->vertices_after - b->vertices_before, "", out);
	put_pair("\"],[\"mirror seams\",\"", a->seam_count, b->seam_count, "", out);
	nt_buffer_format(out, " of length %.4g -> %.4g\"]", a->seam_length, b->seam_length);
}

/* The object that html.c calls diff. */
void nt_diff_page(const nt_report_diff *diff, nt_buffer *out)
{
	nt_put(out, NT_SCRIPT, "{'unchanged':%zu,'meshes':[", diff->unchanged);
	for (size_t i = 0; i < diff->mesh_count; i++) {
		const nt_mesh_change *change = &diff->meshes[i];
		nt_put(out, NT_SCRIPT, ",\n{'old':%u,'new':%u,'label':%p,'changed':%hhd,'rows':[", change->meshes[OLD],
			change->meshes[NEW], label_of(diff, change), is_changed(diff, change));
		page_rows(diff, change, out);
		nt_buffer_text(out, "]}");
	}
	nt_buffer_text(out, "]}");
}
