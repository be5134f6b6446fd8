/* SPDX-License-Identifier: MIT */
/*
 * Changes between two versions: see diff.h. Short, the worst first: meshes that are as they were are not listed in
 * text and Markdown, and of findings that both versions have only the number is told. data/nmtan-diff.schema.json
 * describes the JSON. HTML is the page of html.c, with both versions.
 */
#include "report/render/diff.h"

#include "report/render/writers.h"

enum { OLD, NEW, SHOWN_FINDINGS = 50, SHOWN_MESHES = 50 };

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

static void put_label(const nt_report_diff *diff, const nt_mesh_change *change,
	void (*put)(const char *text, nt_buffer *out), nt_buffer *out)
{
	const int version = change->meshes[NEW] == NT_NONE ? OLD : NEW;
	nt_put_label(diff->reports[version], change->meshes[version], put, out);
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
	nt_buffer_format(out, "%zu new finding%s", new, new == 1 ? "" : "s");
	if (new) {
		nt_buffer_text(out, " (");
		nt_totals_text(&totals, out);
		nt_buffer_text(out, ")");
	}
	nt_buffer_format(out, ", %zu gone, %zu unchanged; %zu of %zu meshes changed", gone, diff->unchanged, changed,
		diff->mesh_count);
}

/* "1200 -> 1210" or "1200" */
static void put_pair(size_t before, size_t after, nt_buffer *out)
{
	if (before == after)
		nt_buffer_format(out, "%zu", after);
	else
		nt_buffer_format(out, "%zu -> %zu", before, after);
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
	nt_buffer_text(out, "  ");
	put_label(diff, change, nt_plain_text, out);
	if (!a || !b) {
		nt_buffer_format(out, ": %s, %zu triangles\n", a ? "gone" : "new", (a ? a : b)->triangle_count);
		return;
	}
	nt_buffer_text(out, ": triangles ");
	put_pair(a->triangle_count, b->triangle_count, out);
	nt_buffer_format(out, ", %zu of them in place, %zu corners with other texture coordinates\n    ",
		change->matched, change->moved_texcoords);
	put_tangents(diff, change, out);
	if (change->turned)
		nt_buffer_format(out, " at (%.6g %.6g %.6g)", (double)change->worst_position[0],
			(double)change->worst_position[1], (double)change->worst_position[2]);
	nt_buffer_text(out, "\n    vertices ");
	put_pair(a->vertices_after, b->vertices_after, out);
	nt_buffer_text(out, ", mirror seams ");
	put_pair(a->seam_count, b->seam_count, out);
	nt_buffer_format(out, " of length %.4g -> %.4g\n", a->seam_length, b->seam_length);
}

static void text_findings(const nt_report_diff *diff, int version, nt_buffer *out)
{
	const nt_report *report = diff->reports[version];
	size_t shown = 0;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *finding = &report->findings[i];
		if (diff->known[version][i] || shown++ >= SHOWN_FINDINGS)
			continue;
		nt_buffer_format(out, "  %-4s  %-7s  %s  ", version == NEW ? "new" : "gone",
			nt_severity_name(finding->severity), nt_code_info(finding->code)->name);
		nt_buffer_clean(out, finding->message);
		if (finding->mesh != NT_NONE && report->mesh_count > 1) {
			nt_buffer_text(out, ", in ");
			nt_put_label(report, finding->mesh, nt_plain_text, out);
		}
		nt_buffer_text(out, "\n");
	}
	if (shown > SHOWN_FINDINGS)
		nt_buffer_format(out, "  and %zu more that are %s\n", shown - SHOWN_FINDINGS,
			version == NEW ? "new" : "gone");
}

static void write_text(const nt_report_diff *diff, nt_buffer *out)
{
	nt_buffer_clean(out, diff->reports[OLD]->shown);
	nt_buffer_text(out, " -> ");
	nt_buffer_clean(out, diff->reports[NEW]->shown);
	nt_buffer_text(out, ": ");
	put_summary(diff, out);
	nt_buffer_text(out, "\n");
	text_findings(diff, NEW, out);
	text_findings(diff, OLD, out);
	for (size_t i = 0; i < diff->mesh_count; i++)
		if (is_changed(diff, &diff->meshes[i]))
			text_mesh(diff, &diff->meshes[i], out);
}

/* ---- Markdown ---- */

static void markdown_findings(const nt_report_diff *diff, int version, nt_buffer *out)
{
	const nt_report *report = diff->reports[version];
	if (!total(diff->by_severity[version]))
		return;
	nt_buffer_format(out, "\n| %s | code | where | finding |\n|---|---|---|---|\n",
		version == NEW ? "new" : "gone");
	size_t shown = 0;
	for (size_t i = 0; i < report->finding_count; i++)
		if (!diff->known[version][i] && shown++ < SHOWN_FINDINGS)
			nt_markdown_finding(report, &report->findings[i], out);
	if (shown > SHOWN_FINDINGS)
		nt_buffer_format(out, "\n%zu more are not shown.\n", shown - SHOWN_FINDINGS);
}

static void markdown_mesh(const nt_report_diff *diff, const nt_mesh_change *change, nt_buffer *out)
{
	const nt_report_mesh *a = mesh_of(diff, change, OLD), *b = mesh_of(diff, change, NEW);
	nt_buffer_text(out, "| ");
	put_label(diff, change, nt_markdown_text, out);
	if (!a || !b) {
		nt_buffer_format(out, " | %s | %zu | | |\n", a ? "gone" : "new", (a ? a : b)->triangle_count);
		return;
	}
	nt_buffer_text(out, " | ");
	put_tangents(diff, change, out);
	nt_buffer_text(out, " | ");
	put_pair(a->triangle_count, b->triangle_count, out);
	nt_buffer_text(out, " | ");
	put_pair(a->vertices_after, b->vertices_after, out);
	nt_buffer_text(out, " | ");
	put_pair(a->seam_count, b->seam_count, out);
	nt_buffer_text(out, " |\n");
}

static void write_markdown(const nt_report_diff *diff, nt_buffer *out)
{
	nt_buffer_text(out, "**");
	nt_markdown_text(diff->reports[OLD]->shown, out);
	nt_buffer_text(out, " \xe2\x86\x92 ");
	nt_markdown_text(diff->reports[NEW]->shown, out);
	nt_buffer_text(out, "**: ");
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
	nt_member_open(out, name, mesh ? "{" : "null");
	if (!mesh)
		return;
	nt_member_text(out, "name", mesh->name);
	nt_member_count(out, "triangles", mesh->triangle_count);
	nt_member_count(out, "vertices", mesh->vertices_after);
	nt_member_bool(out, "has_tangents", mesh->checked_tangents);
	nt_member_count(out, "mirror_seams", mesh->seam_count);
	nt_member_float(out, "seam_length", mesh->seam_length);
	nt_buffer_text(out, "}");
}

static void json_mesh(const nt_report_diff *diff, const nt_mesh_change *change, nt_buffer *out)
{
	nt_buffer_text(out, "{");
	nt_member_bool(out, "changed", is_changed(diff, change));
	json_side("old", mesh_of(diff, change, OLD), out);
	json_side("new", mesh_of(diff, change, NEW), out);
	nt_member_count(out, "triangles_in_place", change->matched);
	nt_member_count(out, "corners_with_other_texcoords", change->moved_texcoords);
	nt_member_open(out, "tangents", "{");
	nt_member_count(out, "compared", change->compared);
	nt_member_count(out, "turned", change->turned);
	nt_member_count(out, "reversed_w", change->reversed);
	nt_member_float(out, "worst_degrees", change->worst_degrees);
	nt_member_open(out, "worst_position", change->compared ? "" : "null");
	if (change->compared)
		nt_json_floats(change->worst_position, 3, out);
	nt_member_histogram(out, "histogram", change->histogram);
	nt_buffer_text(out, "}}");
}

static void json_findings(const nt_report_diff *diff, int version, const char *name, nt_buffer *out)
{
	const nt_report *report = diff->reports[version];
	nt_member_key(out, 1, name);
	nt_buffer_text(out, "[");
	const size_t begin = out->size;
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *finding = &report->findings[i];
		if (diff->known[version][i])
			continue;
		nt_member_next(out, 2);
		nt_buffer_text(out, "{");
		nt_member_text(out, "code", nt_code_info(finding->code)->name);
		nt_member_text(out, "severity", nt_severity_name(finding->severity));
		nt_member_text(out, "message", finding->message);
		nt_member_count(out, "count", finding->count);
		nt_member_digest(out, "fingerprint", finding->fingerprint);
		nt_member_index(out, "mesh", finding->mesh);
		nt_buffer_text(out, "}");
	}
	nt_buffer_text(out, out->size == begin ? "]" : "\n\t]");
}

static void write_json(const nt_report_diff *diff, nt_buffer *out)
{
	nt_buffer_format(out, "{\n\t\"report\":\"nmtan-diff\",\n\t\"report_version\":1,\n\t\"generator\":\"nmtan %s\"",
		NMTAN_VERSION_STRING);
	nt_member_key(out, 1, "old");
	nt_json_string(diff->reports[OLD]->shown, out);
	nt_member_key(out, 1, "new");
	nt_json_string(diff->reports[NEW]->shown, out);
	nt_member_key(out, 1, "unchanged_findings");
	nt_buffer_format(out, "%zu", diff->unchanged);
	json_findings(diff, NEW, "new_findings", out);
	json_findings(diff, OLD, "gone_findings", out);
	nt_member_key(out, 1, "meshes");
	nt_buffer_text(out, "[");
	for (size_t i = 0; i < diff->mesh_count; i++) {
		nt_member_next(out, 2);
		json_mesh(diff, &diff->meshes[i], out);
	}
	nt_buffer_text(out, "\n\t]\n}\n");
}

/* ---- HTML ---- */

static void page_rows(const nt_report_diff *diff, const nt_mesh_change *change, nt_buffer *out)
{
	const nt_report_mesh *a = mesh_of(diff, change, OLD), *b = mesh_of(diff, change, NEW);
	if (!a || !b) {
		nt_buffer_format(out, "[\"mesh\",\"%s, %zu triangles\"]", a ? "gone" : "new",
			(a ? a : b)->triangle_count);
		return;
	}
	nt_buffer_text(out, "[\"tangents\",\"");
	put_tangents(diff, change, out);
	nt_buffer_text(out, "\"],[\"triangles\",\"");
	put_pair(a->triangle_count, b->triangle_count, out);
	nt_buffer_format(out, ", %zu in place\"],[\"texture\",\"%zu corners with other coordinates\"],[\"islands\",\"",
		change->matched, change->moved_texcoords);
	put_pair(a->island_count, b->island_count, out);
	nt_buffer_text(out, "\"],[\"vertices\",\"");
	put_pair(a->vertices_after, b->vertices_after, out);
	nt_buffer_text(out, "\"],[\"split for tangents\",\"");
	put_pair(a->vertices_after - a->vertices_before, b->vertices_after - b->vertices_before, out);
	nt_buffer_text(out, "\"],[\"mirror seams\",\"");
	put_pair(a->seam_count, b->seam_count, out);
	nt_buffer_format(out, " of length %.4g -> %.4g\"]", a->seam_length, b->seam_length);
}

/* The object that html.c calls diff. */
static void page_json(const nt_report_diff *diff, nt_buffer *out)
{
	nt_buffer_text(out, "{");
	nt_member_count(out, "unchanged", diff->unchanged);
	nt_member_open(out, "meshes", "[");
	for (size_t i = 0; i < diff->mesh_count; i++) {
		const nt_mesh_change *change = &diff->meshes[i];
		nt_member_next(out, 0);
		nt_buffer_text(out, "{");
		nt_member_index(out, "old", change->meshes[OLD]);
		nt_member_index(out, "new", change->meshes[NEW]);
		nt_member_key(out, NT_SAME_LINE, "label");
		put_label(diff, change, nt_json_string, out);
		nt_member_bool(out, "changed", is_changed(diff, change));
		nt_member_open(out, "rows", "[");
		page_rows(diff, change, out);
		nt_buffer_text(out, "]}");
	}
	nt_buffer_text(out, "]}");
}

/* ---- entry ---- */

bool nt_diff_has_format(nt_report_format format)
{
	return format == NT_REPORT_TEXT || format == NT_REPORT_JSON || format == NT_REPORT_MARKDOWN ||
		format == NT_REPORT_HTML;
}

nt_status nt_diff_write(const nt_report_diff *diff, nt_report_format format, nt_report_sink sink, void *user,
	nt_error *error)
{
	nt_report_stream stream = {.sink = sink, .user = user, .error = error};
	nt_report_list versions = {.items = diff->reports, .count = 2, .stream = &stream, .diff = diff};
	nt_buffer out = {0}, changes = {0};
	if (format == NT_REPORT_HTML) {
		page_json(diff, &changes);
		versions.changes = &changes;
		nt_report_walk(&nt_html_writer, &versions, &out);
	} else if (format == NT_REPORT_JSON) {
		write_json(diff, &out);
	} else if (format == NT_REPORT_MARKDOWN) {
		write_markdown(diff, &out);
	} else {
		write_text(diff, &out);
	}
	nt_list_flush(&versions, 0, &out);
	if (out.failed && !stream.status)
		stream.status = nt_fail_memory(error);
	nt_buffer_free(&out);
	return stream.status;
}
