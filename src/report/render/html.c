/* SPDX-License-Identifier: MIT */
/*
 * The report as one HTML file that opens without a network: see page/main.js for what it shows.
 *
 * The text comes first, as JSON in a script element that is not run (#data), with every `<` written as
 * \u003c, so that no name can end the element:
 *
 *   files     [{name, verdict, failure, counts: [errors, warnings, infos], meshes, findings}]
 *             mesh:     {label, why, same_as, mapped: whether it has a normal map, triangles, vertices, islands,
 *                       facts: [[name, text]],
 *                       images: [{image, map: [6], file}] of normal map and base colour: numbers of images, and URIs,
 *                       or null, wrap: [nt_wrap, nt_wrap], seams: [[edges, closed, length, plane, unmirrored island,
 *                       mirrored island, 1: hard edges; else not there]], geometry: bool}
 *             finding:  {code, severity, count, known, message, mesh, seam, island, where, at: [triangle],
 *                       votes: [[percent]] of a normal map's blocks, rows from the top, green up above 0; or null,
 *                       repair: the command, or null if nmtan cannot repair it}
 *   codes     {CODE: {meaning, remedy}} of the findings that there are
 *   images    [data URI], which meshes number
 *   left_out  findings that have no place on the page
 *   index     the page that lists all files; null: none but this one
 *   diff      of two versions only: {unchanged, meshes: [{old, new, changed, label, rows: [[name, text]]}]}, where old
 *             and new are numbers of meshes or null; a finding is known where the other version has it
 *
 * The index of a folder of pages has `folder: true` and, of each file, {name, verdict, counts, failure, page,
 * triangles, islands, seams, model, layout: nt_thumb_model() and nt_thumb_layout() as base64, meshes: [], findings:
 * [{code, severity}]}, without equal findings.
 *
 * Then the page's script (the pages of a folder refer to one file with it, and to one with the style), then the
 * geometry of each mesh in an element of its own, #g-FILE-MESH, which is not looked at until the mesh is opened: a line
 * of JSON (fields of nt_packed, and how many planes each array has, as a digit) and its bytes as base64: see
 * pack/pack.h. Written and forgotten mesh by mesh.
 */
#include "report/render/writers.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include "base/hash.h"
#include "file/base64.h"
#include "report/pack/pack.h"
#include "report/pack/thumb.h"
#include "report/render/render.h"

/* Limits of one page. Triangles take 10 to 20 bytes of it; where the meshes have more together, each gets its share
 * and the page says so. */
enum {
	MOST_TRIANGLES = 3 * 1000 * 1000,
	IMAGE_BYTES = 16 * 1000 * 1000, /* of normal maps, and of other images */
	MOST_FINDINGS = 20000,
	MOST_SEAMS = 20000
};

/* ---- small things ---- */

/* Appends JSON so that it is safe inside a script element. */
static void put_safe(const nt_buffer *json, nt_buffer *out)
{
	const char *at = json->data ? json->data : "", *end = at + json->size, *mark;
	for (; (mark = memchr(at, '<', (size_t)(end - at))); at = mark + 1) {
		nt_buffer_append(out, at, (size_t)(mark - at));
		nt_buffer_text(out, "\\u003c");
	}
	nt_buffer_append(out, at, (size_t)(end - at));
}

/* The same of what was appended since. */
static void make_safe(nt_buffer *out, size_t since)
{
	if (out->size == since || !memchr(out->data + since, '<', out->size - since))
		return;
	nt_buffer copy = {0};
	nt_buffer_append(&copy, out->data + since, out->size - since);
	out->size = since;
	put_safe(&copy, out);
	nt_buffer_free_into(&copy, out);
}

/* Numbers that read back as doubles. */
static void put_doubles(const char *name, const double *values, size_t count, nt_buffer *out)
{
	nt_member_open(out, name, "[");
	for (size_t i = 0; i < count; i++)
		nt_buffer_format(out, i ? ",%.17g" : "%.17g", values[i]);
	nt_buffer_text(out, "]");
}

/* ---- meshes ---- */

static bool has_geometry(const nt_report_mesh *m)
{
	return m->geometry && m->geometry->triangle_count;
}

static void put_seam(const nt_seam *seam, bool hard, nt_buffer *out)
{
	nt_buffer_format(out, "[%zu,%s,%.6g,", seam->edge_count, seam->closed ? "true" : "false",
		isfinite(seam->length) ? seam->length : 0.0);
	nt_json_string(seam->has_plane ? seam->plane_text : "", out);
	for (int side = 0; side < 2; side++) {
		nt_buffer_text(out, ",");
		nt_json_index(seam->islands[side], out);
	}
	nt_buffer_text(out, hard ? ",1]" : "]");
}

static void begin_fact(const char *name, nt_buffer *out)
{
	nt_member_next(out, NT_SAME_LINE);
	nt_buffer_format(out, "[\"%s\",\"", name);
}

static void put_facts(const nt_report_mesh *m, nt_buffer *out)
{
	nt_member_open(out, "facts", "[");
	begin_fact("triangles", out);
	nt_buffer_format(out, "%zu: %zu unmirrored, %zu mirrored, %zu degenerate\"]", m->triangle_count,
		m->triangles[2], m->triangles[0], m->triangles[1]);
	begin_fact("vertices", out);
	nt_buffer_format(out, "%zu", m->vertices_before);
	if (m->vertices_after != m->vertices_before)
		nt_buffer_format(out, ", then %zu: %zu for mirroring, %zu for direction, %zu for normals",
			m->vertices_after, m->added_mirror, m->added_direction, m->added_normals);
	nt_buffer_text(out, "\"]");
	begin_fact("islands", out);
	nt_buffer_format(out, "%zu: %zu normal, %zu mirrored, %zu mixed, %zu degenerate\"]", m->island_count,
		m->island_kinds[0], m->island_kinds[1], m->island_kinds[2], m->island_kinds[3]);
	begin_fact("mirror seams", out);
	nt_buffer_format(out, "%zu, of length %.4g\"]", m->seam_count, m->seam_length);
	begin_fact("edges", out);
	nt_buffer_format(out, "%zu: %zu open in %zu loops, %zu of more than two triangles, %zu against the "
		"winding\"]", m->edge_count, m->boundary_edges, m->boundary_loops + m->boundary_chains,
		m->non_manifold_edges, m->inconsistent_edges);
	if (m->maker.known) {
		begin_fact("tangents of", out);
		nt_maker_text(&m->maker, out);
		nt_buffer_text(out, "\"]");
	}
	if (isfinite(m->worst_orthogonality)) {
		begin_fact("worst tangent", out);
		nt_buffer_format(out, "%.3g degrees off perpendicular\"]", m->worst_orthogonality);
	}
	if (m->instance_count) {
		begin_fact("instances", out);
		nt_buffer_format(out, "%zu, %zu of them mirrored by their node\"]", m->instance_count,
			m->negative_instances);
	}
	nt_buffer_text(out, "]");
}

/* The image's number among data.images, null where there is none or no room. One that several meshes have is there
 * once. */
static void put_image(const nt_image *image, size_t *bytes_left, nt_page_budget *left, nt_buffer *out)
{
	const char *bytes = (const char *)image->bytes;
	uint32_t number = bytes ? nt_name_find(&left->held, bytes, image->size) : NT_NONE;
	const bool first = bytes && number == NT_NONE && image->size <= *bytes_left;
	if (first)
		number = nt_name_add(&left->held, bytes, image->size);
	left->sources.failed |= first && number == NT_NONE;
	nt_buffer_text(out, "{");
	nt_member_index(out, "image", number);
	nt_member_key(out, NT_SAME_LINE, "map");
	nt_json_floats(image->transform, 6, out);
	nt_member_text(out, "file", image->file);
	nt_buffer_text(out, "}");
	if (!first)
		return;
	*bytes_left -= image->size;
	nt_buffer_format(&left->sources, "%s\"data:%s;base64,", number ? "," : "", image->type);
	nt_base64_append(&left->sources, image->bytes, image->size);
	nt_buffer_text(&left->sources, "\"");
}

static void put_mesh(const nt_report *report, uint32_t mesh, nt_page_budget *left, nt_buffer *out)
{
	const nt_report_mesh *m = &report->meshes[mesh];
	nt_buffer_text(out, "{");
	nt_member_key(out, NT_SAME_LINE, "label");
	nt_put_label(report, mesh, nt_json_string, out);
	nt_member_text(out, "why", m->why);
	nt_member_index(out, "same_as", m->same_as);
	nt_member_bool(out, "mapped", m->slots & NT_SLOT_NORMAL);
	nt_member_count(out, "triangles", m->triangle_count);
	nt_member_count(out, "vertices", m->vertices_before);
	nt_member_count(out, "islands", m->island_count);
	nt_member_bool(out, "geometry", has_geometry(m));
	put_facts(m, out);
	nt_member_open(out, "images", "[");
	for (int p = 0; p < NT_PICTURE_COUNT; p++) {
		nt_member_next(out, NT_SAME_LINE);
		put_image(&m->pictures[p], &left->images[p], left, out);
	}
	nt_buffer_format(out, "],\"wrap\":[%d,%d],\"seams\":[", (int)m->wrap[0], (int)m->wrap[1]);
	const size_t seams = m->seams ? m->seam_count + m->hard_count : 0;
	for (size_t i = 0; i < seams && left->seams > 0; i++, left->seams--) {
		nt_member_next(out, NT_SAME_LINE);
		put_seam(&m->seams[i], i >= m->seam_count, out);
	}
	nt_buffer_text(out, "]}");
}

/* ---- findings ---- */

static void put_members(const nt_report *report, const nt_report_finding *finding, bool known, nt_buffer *out)
{
	nt_buffer where = {0};
	nt_put_where(report, finding, report->mesh_count > 1, nt_plain_text, &where);
	nt_buffer_text(out, "{");
	nt_member_text(out, "code", nt_code_info(finding->code)->name);
	nt_member_text(out, "severity", nt_severity_name(finding->severity));
	nt_member_count(out, "count", finding->count);
	nt_member_bool(out, "known", known);
	nt_member_text(out, "message", finding->message);
	nt_member_index(out, "mesh", finding->mesh);
	nt_member_index(out, "seam", finding->seam);
	nt_member_index(out, "island", finding->island);
	nt_member_text(out, "where", where.data ? where.data : "");
	nt_member_open(out, "at", "[");
	for (unsigned i = 0; i < finding->spot_count; i++) {
		if (finding->spots[i].triangle == NT_NONE)
			continue;
		nt_member_next(out, NT_SAME_LINE);
		nt_json_index(finding->spots[i].triangle, out);
	}
	nt_buffer_text(out, "]");
	nt_member_votes(out, finding);
	nt_member_repair(out, report, finding);
	nt_buffer_text(out, "}");
	nt_buffer_free_into(&where, out);
}

/* How a file begins, in its page and in the index. */
static void put_head(const nt_report *report, nt_buffer *out)
{
	nt_member_next(out, 0);
	nt_buffer_text(out, "{");
	nt_member_text(out, "name", report->shown);
	nt_member_key(out, NT_SAME_LINE, "verdict");
	nt_put_verdict(report, nt_json_string, out);
	nt_member_open(out, "counts", "[");
	for (int severity = NT_SEVERITY_ERROR; severity >= NT_SEVERITY_INFO; severity--)
		nt_buffer_format(out, severity ? "%zu," : "%zu]", report->by_severity[severity]);
	nt_member_text(out, "failure", report->failure);
}

static void put_codes(const nt_page_budget *left, nt_buffer *out)
{
	nt_member_open(out, "codes", "{");
	for (unsigned code = 0; code < NT_CODE_COUNT; code++) {
		if (!left->seen[code])
			continue;
		const nt_code_row *row = nt_code_info((nt_code)code);
		nt_member_key(out, 0, row->name);
		nt_buffer_text(out, "{");
		nt_member_text(out, "meaning", row->meaning);
		nt_member_text(out, "remedy", row->remedy);
		nt_buffer_text(out, "}");
	}
	nt_buffer_text(out, "}");
}

/* ---- the page ---- */

static void put_geometry(const nt_report *report, size_t file, uint32_t mesh, size_t most, nt_buffer *out)
{
	nt_packed packed;
	if (nt_pack_mesh(&packed, report, mesh, most)) {
		out->failed = true;
	} else {
		nt_buffer_format(out, "<script type=\"text/plain\" id=\"g-%zu-%u\">{", file, mesh);
		nt_member_count(out, "vertices", packed.vertex_count);
		nt_member_count(out, "triangles", packed.triangle_count);
		nt_member_bool(out, "whole", packed.whole);
		nt_member_count(out, "seams", packed.seam_count);
		put_doubles("origin", packed.position_origin, 3, out);
		put_doubles("step", packed.position_step, 3, out);
		put_doubles("uvOrigin", packed.texcoord_origin, 2, out);
		nt_buffer_format(out, ",\"uvStep\":%.17g,\"planes\":\"", packed.texcoord_step);
		for (unsigned i = 0; i < NT_PACKED_ARRAYS; i++)
			nt_buffer_format(out, "%u", packed.arrays[i].planes);
		nt_buffer_text(out, "\"}\n");
		nt_base64_append(out, packed.bytes.data, packed.bytes.size);
		nt_buffer_text(out, "</script>\n");
	}
	nt_buffer_free(&packed.bytes);
}

static void put_geometries(const nt_report_list *reports, nt_buffer *out)
{
	size_t wanted = 0;
	for (size_t i = 0; i < reports->count; i++)
		for (size_t m = 0; m < reports->items[i]->mesh_count; m++)
			if (has_geometry(&reports->items[i]->meshes[m]))
				wanted += reports->items[i]->meshes[m].geometry->triangle_count;
	const double share = wanted > MOST_TRIANGLES ? (double)MOST_TRIANGLES / (double)wanted : 1.0;
	for (size_t i = 0; i < reports->count; i++) {
		const nt_report *report = reports->items[i];
		for (uint32_t m = 0; m < report->mesh_count; m++) {
			if (!has_geometry(&report->meshes[m]))
				continue;
			const double most = ceil(share * (double)report->meshes[m].geometry->triangle_count);
			put_geometry(report, i, m, (size_t)most, out);
			nt_list_flush(reports, NT_FLUSHED_BYTES, out);
		}
	}
}

const char nt_html_mark[] = "<meta name=\"generator\" content=\"nmtan\">\n";

const char *nt_html_part(nt_html_part_kind kind, nt_buffer *name)
{
	const char *text = kind == NT_HTML_STYLE ? nt_page_style : nt_page_script;
	nt_buffer_format(name, "nmtan-%016llx.%s", (unsigned long long)nt_hash_name(0, text),
		kind == NT_HTML_STYLE ? "css" : "js");
	return text;
}

/* A part, or where it is. */
static void put_part(nt_html_part_kind kind, bool in_folder, nt_buffer *out)
{
	const bool style = kind == NT_HTML_STYLE;
	nt_buffer name = {0};
	const char *text = nt_html_part(kind, &name);
	if (in_folder)
		nt_buffer_format(out,
			style ? "<link rel=\"stylesheet\" href=\"%s\">\n" : "<script src=\"%s\"></script>\n",
			name.data ? name.data : "");
	else
		nt_buffer_format(out, style ? "<style>\n%s</style>\n" : "<script>\n%s</script>\n", text);
	out->failed |= name.failed;
	nt_buffer_free(&name);
}

/* The beginning of the page, before the data. A file is from file: or, on a server, from there. */
static void begin_page(bool in_folder, nt_buffer *out)
{
	const char *parts = in_folder ? "'self' file:" : "'unsafe-inline'";
	nt_buffer_text(out, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
	nt_buffer_text(out, nt_html_mark);
	nt_buffer_format(out,
		"<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: "
		"blob: 'self' file:; style-src %s; script-src %s\">\n"
		"<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
		"<link rel=\"icon\" href=\"data:,\">\n<title>nmtan report</title>\n", parts, parts);
	put_part(NT_HTML_STYLE, in_folder, out);
	nt_buffer_text(out, "</head>\n<body>\n");
	nt_buffer_text(out, nt_page_body);
}

static void begin(nt_walk *w, nt_buffer *out)
{
	w->page = (nt_page_budget){.images = {IMAGE_BYTES, IMAGE_BYTES}, .findings = MOST_FINDINGS,
		.seams = MOST_SEAMS};
	begin_page(w->reports->style.index, out);
	nt_buffer_text(out, "<script type=\"application/json\" id=\"data\">{\"files\":[");
}

static void begin_file(nt_walk *w, nt_buffer *out)
{
	size_t since = out->size;
	put_head(w->report, out);
	nt_member_open(out, "meshes", "[");
	for (size_t i = 0; i < w->report->mesh_count; i++) {
		nt_member_next(out, 0);
		put_mesh(w->report, (uint32_t)i, &w->page, out);
		make_safe(out, since);
		nt_list_flush(w->reports, NT_FLUSHED_BYTES, out);
		since = out->size;
	}
	make_safe(out, since);
	nt_buffer_text(out, "]");
	nt_member_open(out, "findings", "[");
	w->page.left_out += w->report->dropped;
}

static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const size_t since = out->size;
	const nt_report_diff *diff = w->reports->diff;
	if (!w->page.findings) {
		w->page.left_out++;
		return;
	}
	nt_member_next(out, 0);
	put_members(w->report, finding, diff ? diff->known[w->file][w->finding] : finding->known, out);
	w->page.seen[finding->code] = true;
	w->page.findings--;
	make_safe(out, since);
}

static void end_file(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "]}");
}

static void end(nt_walk *w, nt_buffer *out)
{
	const nt_report_list *reports = w->reports;
	const size_t since = out->size;
	nt_buffer_text(out, "]");
	put_codes(&w->page, out);
	nt_member_count(out, "left_out", w->page.left_out);
	nt_member_text(out, "index", reports->style.index);
	if (reports->diff) {
		nt_member_key(out, NT_SAME_LINE, "diff");
		nt_buffer_append(out, reports->changes->data, reports->changes->size);
		nt_buffer_free_into(reports->changes, out);
	}
	make_safe(out, since);
	nt_member_open(out, "images", "[");
	nt_buffer_append(out, w->page.sources.data, w->page.sources.size);
	nt_buffer_free_into(&w->page.sources, out);
	nt_name_table_free(&w->page.held);
	nt_buffer_text(out, "]}</script>\n");
	put_part(NT_HTML_SCRIPT, reports->style.index, out);
	put_geometries(reports, out);
	nt_buffer_text(out, "</body>\n</html>\n");
}

const nt_report_writer nt_html_writer = {.known = true, .begin = begin, .begin_file = begin_file,
	.put_finding = put_finding, .end_file = end_file, .end = end};

/* ---- the index of many pages ---- */

/* The mesh of the most triangles, and the first layout. */
static void put_thumbs(const nt_report *report, nt_buffer *out)
{
	const nt_report_geometry *largest = NULL, *first = NULL;
	nt_buffer model = {0}, layout = {0};
	for (size_t m = 0; m < report->mesh_count; m++) {
		const nt_report_geometry *g = report->meshes[m].geometry;
		if (!has_geometry(&report->meshes[m]))
			continue;
		first = first ? first : g;
		largest = !largest || g->triangle_count > largest->triangle_count ? g : largest;
	}
	if (first && (nt_thumb_model(largest, &model) ||
		nt_thumb_layout(first, nt_format_is_gltf(report->format), &layout)))
		out->failed = true;
	nt_member_open(out, "model", "\"");
	nt_base64_append(out, model.data, model.size);
	nt_buffer_text(out, "\"");
	nt_member_open(out, "layout", "\"");
	nt_base64_append(out, layout.data, layout.size);
	nt_buffer_text(out, "\"");
	nt_buffer_free(&model);
	nt_buffer_free(&layout);
}

void nt_report_index_row(const nt_report *report, const char *page, nt_buffer *rows)
{
	size_t triangles = 0, islands = 0, seams = 0;
	bool seen[NT_CODE_COUNT][3] = {{false}};
	for (size_t i = 0; i < report->mesh_count; i++) {
		triangles += report->meshes[i].triangle_count;
		islands += report->meshes[i].island_count;
		seams += report->meshes[i].seams ? report->meshes[i].seam_count : 0;
	}
	put_head(report, rows);
	nt_member_text(rows, "page", page);
	nt_member_count(rows, "triangles", triangles);
	nt_member_count(rows, "islands", islands);
	nt_member_count(rows, "seams", seams);
	put_thumbs(report, rows);
	nt_buffer_text(rows, ",\"meshes\":[],\"findings\":[");
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *finding = &report->findings[i];
		bool *before = &seen[finding->code][finding->severity];
		if (*before)
			continue;
		nt_member_next(rows, NT_SAME_LINE);
		nt_buffer_text(rows, "{");
		nt_member_text(rows, "code", nt_code_info(finding->code)->name);
		nt_member_text(rows, "severity", nt_severity_name(finding->severity));
		nt_buffer_text(rows, "}");
		*before = true;
	}
	nt_buffer_text(rows, "]}");
}

void nt_write_html_index(const nt_buffer *rows, nt_buffer *out)
{
	begin_page(true, out);
	nt_buffer_text(out, "<script type=\"application/json\" id=\"data\">{\"folder\":true,\"files\":[");
	put_safe(rows, out);
	nt_buffer_text(out, "]}</script>\n");
	put_part(NT_HTML_SCRIPT, true, out);
	nt_buffer_text(out, "</body>\n</html>\n");
}
