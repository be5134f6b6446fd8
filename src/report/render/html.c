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
#include <math.h>
#include "file/output.h"
#include "report/pack/pack.h"
#include "report/render/inside.h"

/* Limits of one page. Triangles take 10 to 20 bytes of it; where the meshes have more together, each gets its share
 * and the page says so. */
enum {
	MOST_TRIANGLES = 3 * 1000 * 1000,
	IMAGE_BYTES = 16 * 1000 * 1000, /* of normal maps, and of other images */
	MOST_FINDINGS = 20000,
	MOST_SEAMS = 20000
};

/* ---- meshes ---- */

static bool has_geometry(const nt_report_mesh *m)
{
	return m->geometry && m->geometry->triangle_count;
}

static void put_facts(const nt_report_mesh *m, nt_buffer *out)
{
	nt_put(out, NT_SCRIPT, ",'facts':[['triangles','%zu: %zu unmirrored, %zu mirrored, %zu degenerate'],"
		"['vertices','%zu", m->triangle_count, m->triangles[2], m->triangles[0], m->triangles[1],
		m->vertices_before);
	if (m->vertices_after != m->vertices_before)
		nt_buffer_format(out, ", then %zu: %zu for mirroring, %zu for direction, %zu for normals",
			m->vertices_after, m->added_mirror, m->added_direction, m->added_normals);
	nt_put(out, NT_SCRIPT, "'],['islands','%zu: %zu normal, %zu mirrored, %zu mixed, %zu degenerate'],"
		"['mirror seams','%zu, of length %.4g'],['edges','%zu: %zu open in %zu loops, "
		"%zu of more than two triangles, %zu against the winding']", m->island_count, m->island_kinds[0],
		m->island_kinds[1], m->island_kinds[2], m->island_kinds[3], m->seam_count, m->seam_length,
		m->edge_count, m->boundary_edges, m->boundary_loops + m->boundary_chains, m->non_manifold_edges,
		m->inconsistent_edges);
	if (m->maker.known) {
		nt_buffer_text(out, ",[\"tangents of\",\"");
		nt_maker_text(&m->maker, out);
		nt_buffer_text(out, "\"]");
	}
	if (isfinite(m->worst_orthogonality))
		nt_put(out, NT_SCRIPT, ",['worst tangent','%.3g degrees off perpendicular']", m->worst_orthogonality);
	if (m->instance_count)
		nt_put(out, NT_SCRIPT, ",['instances','%zu, %zu of them mirrored by their node']", m->instance_count,
			m->negative_instances);
	nt_buffer_text(out, "]");
}

/* The image's number among data.images, null where there is none or no room. One that several meshes have is there
 * once. */
static void put_image(const nt_image *image, size_t *bytes_left, nt_page_budget *left, nt_buffer *out)
{
	const char *bytes = (const char *)image->bytes;
	const float *t = image->transform;
	uint32_t number = bytes ? nt_name_find(&left->held, bytes, image->size) : NT_NONE;
	const bool first = bytes && number == NT_NONE && image->size <= *bytes_left;
	if (first)
		number = nt_name_add(&left->held, bytes, image->size);
	left->sources.failed |= first && number == NT_NONE;
	nt_put(out, NT_SCRIPT, ",{'image':%u,'map':[%g,%g,%g,%g,%g,%g],'file':%s}", number, (double)t[0], (double)t[1],
		(double)t[2], (double)t[3], (double)t[4], (double)t[5], image->file);
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
	nt_put(out, NT_SCRIPT, ",\n{'label':%p,'why':%s,'same_as':%u,'mapped':%hhd,'triangles':%zu,'vertices':%zu,"
		"'islands':%zu,'geometry':%hhd", nt_mesh_label(report, mesh), m->why, m->same_as,
		(bool)(m->slots & NT_SLOT_NORMAL), m->triangle_count, m->vertices_before, m->island_count,
		has_geometry(m));
	put_facts(m, out);
	nt_buffer_text(out, ",\"images\":[");
	for (int p = 0; p < NT_PICTURE_COUNT; p++)
		put_image(&m->pictures[p], &left->images[p], left, out);
	nt_put(out, NT_SCRIPT, "],'wrap':[%d,%d],'seams':[", (int)m->wrap[0], (int)m->wrap[1]);
	const size_t seams = m->seams ? m->seam_count + m->hard_count : 0;
	for (size_t i = 0; i < seams && left->seams > 0; i++, left->seams--) {
		const nt_seam *seam = &m->seams[i];
		nt_put(out, NT_SCRIPT, ",[%zu,%hhd,%.6g,%s,%u,%u%-s]", seam->edge_count, seam->closed,
			isfinite(seam->length) ? seam->length : 0.0, seam->has_plane ? seam->plane_text : "",
			seam->islands[0], seam->islands[1], i >= m->seam_count ? ",1" : "");
	}
	nt_buffer_text(out, "]}");
}

/* ---- the page ---- */

/* Numbers that read back as doubles are %.17g. */
static void put_geometry(const nt_report *report, size_t file, uint32_t mesh, size_t most, nt_buffer *out)
{
	nt_packed packed;
	if (nt_pack_mesh(&packed, report, mesh, most)) {
		out->failed = true;
	} else {
		const double *origin = packed.position_origin, *step = packed.position_step;
		const double *uv = packed.texcoord_origin;
		nt_put(out, NT_SCRIPT, "<script type='text/plain' id='g-%zu-%u'>{'vertices':%zu,'triangles':%zu,"
			"'whole':%hhd,'seams':%zu,'origin':[%.17g,%.17g,%.17g],'step':[%.17g,%.17g,%.17g],"
			"'uvOrigin':[%.17g,%.17g],'uvStep':%.17g,'planes':'", file, mesh, packed.vertex_count,
			packed.triangle_count, packed.whole, packed.seam_count, origin[0], origin[1], origin[2],
			step[0], step[1], step[2], uv[0], uv[1], packed.texcoord_step);
		for (unsigned i = 0; i < NT_PACKED_ARRAYS; i++)
			nt_buffer_format(out, "%u", packed.arrays[i].planes);
		nt_buffer_text(out, "\"}\n");
		nt_base64_append(out, packed.bytes.data, packed.bytes.size);
		nt_buffer_text(out, "</script>\n");
	}
	nt_buffer_free(&packed.bytes);
}

static void put_geometries(nt_walk *w, nt_buffer *out)
{
	size_t wanted = 0;
	for (size_t i = 0; i < w->count; i++)
		for (size_t m = 0; m < w->items[i]->mesh_count; m++)
			if (has_geometry(&w->items[i]->meshes[m]))
				wanted += w->items[i]->meshes[m].geometry->triangle_count;
	const double share = wanted > MOST_TRIANGLES ? (double)MOST_TRIANGLES / (double)wanted : 1.0;
	for (size_t i = 0; i < w->count; i++) {
		const nt_report *report = w->items[i];
		for (uint32_t m = 0; m < report->mesh_count; m++) {
			if (!has_geometry(&report->meshes[m]))
				continue;
			const double most = ceil(share * (double)report->meshes[m].geometry->triangle_count);
			put_geometry(report, i, m, (size_t)most, out);
			nt_walk_flush(w, NT_FLUSHED_BYTES, out);
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

/* A file, in its page and in the index: how it begins. */
static void put_head(const nt_report *report, nt_buffer *out)
{
	const size_t *counts = report->by_severity;
	nt_put(out, NT_SCRIPT, ",\n{'name':%s,'verdict':%p,'counts':[%zu,%zu,%zu],'failure':%s", report->shown,
		nt_verdict(report), counts[NT_SEVERITY_ERROR], counts[NT_SEVERITY_WARNING], counts[NT_SEVERITY_INFO],
		report->failure);
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
	put_head(w->report, out);
	nt_buffer_text(out, ",\"meshes\":[");
	for (size_t i = 0; i < w->report->mesh_count; i++) {
		put_mesh(w->report, (uint32_t)i, &w->page, out);
		nt_walk_flush(w, NT_FLUSHED_BYTES, out);
	}
	nt_buffer_text(out, "],\"findings\":[");
	w->page.left_out += w->report->dropped;
}

static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const nt_report_diff *diff = w->reports->diff;
	const bool known = diff ? diff->known[w->file][w->finding] : finding->known;
	nt_buffer where = {0};
	if (!w->page.findings) {
		w->page.left_out++;
		return;
	}
	w->page.findings--;
	w->page.seen[finding->code] = true;
	nt_put(&where, NT_TERMINAL, "%p", nt_finding_where(w->report, finding, w->report->mesh_count > 1));
	nt_put(out, NT_SCRIPT, ",\n{'code':%s,'severity':%s,'count':%zu,'known':%hhd,'message':%s,'mesh':%u,'seam':%u,"
		"'island':%u,'where':%p,'at':[", nt_finding_name(finding), nt_severity_name(finding->severity),
		finding->count, known, finding->message, finding->mesh, finding->seam, finding->island,
		nt_text_of(&where));
	for (unsigned i = 0; i < finding->spot_count; i++)
		if (finding->spots[i].triangle != NT_NONE)
			nt_put(out, NT_SCRIPT, ",%u", finding->spots[i].triangle);
	nt_buffer_text(out, "]");
	nt_put_votes(finding, out);
	nt_put_repair(w->report, finding, NT_SCRIPT, out);
	nt_buffer_text(out, "}");
}

static void end_file(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "]}");
}

static void end(nt_walk *w, nt_buffer *out)
{
	const nt_report_list *reports = w->reports;
	nt_buffer_text(out, "],\"codes\":{");
	for (unsigned code = 0; code < NT_CODE_COUNT; code++) {
		const nt_code_row *row = nt_code_info((nt_code)code);
		if (w->page.seen[code])
			nt_put(out, NT_SCRIPT, ",\n'%-s':{'meaning':%s,'remedy':%s}", row->name, row->meaning,
				row->remedy);
	}
	nt_put(out, NT_SCRIPT, "},'left_out':%zu,'index':%s", w->page.left_out, reports->style.index);
	if (reports->diff) {
		nt_buffer_text(out, ",\"diff\":");
		nt_diff_page(reports->diff, out);
	}
	nt_buffer_text(out, ",\"images\":[");
	nt_buffer_append(out, w->page.sources.data, w->page.sources.size);
	nt_buffer_free_into(&w->page.sources, out);
	nt_name_table_free(&w->page.held);
	nt_buffer_text(out, "]}</script>\n");
	put_part(NT_HTML_SCRIPT, reports->style.index, out);
	put_geometries(w, out);
	nt_buffer_text(out, "</body>\n</html>\n");
}

const nt_report_writer nt_html_writer = {.known = true, .begin = begin, .begin_file = begin_file,
	.put_finding = put_finding, .end_file = end_file, .end = end};

/* ---- the index of many pages ---- */

/* The mesh of the most triangles, and the first layout. */
static void put_thumbs(const nt_report *report, nt_buffer *out)
{
	const nt_report_geometry *largest = NULL, *first = NULL;
	nt_buffer thumbs[2] = {{0}, {0}};
	for (size_t m = 0; m < report->mesh_count; m++) {
		const nt_report_geometry *g = report->meshes[m].geometry;
		if (!has_geometry(&report->meshes[m]))
			continue;
		first = first ? first : g;
		largest = !largest || g->triangle_count > largest->triangle_count ? g : largest;
	}
	if (first && (nt_thumb_model(largest, &thumbs[0]) ||
		nt_thumb_layout(first, nt_format_is_gltf(report->format), &thumbs[1])))
		out->failed = true;
	for (int i = 0; i < 2; i++) {
		nt_buffer_text(out, i ? "\",\"layout\":\"" : ",\"model\":\"");
		nt_base64_append(out, thumbs[i].data, thumbs[i].size);
		nt_buffer_free(&thumbs[i]);
	}
	nt_buffer_text(out, "\"");
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
	nt_put(rows, NT_SCRIPT, ",'page':%s,'triangles':%zu,'islands':%zu,'seams':%zu", page, triangles, islands,
		seams);
	put_thumbs(report, rows);
	nt_buffer_text(rows, ",\"meshes\":[],\"findings\":[");
	for (size_t i = 0; i < report->finding_count; i++) {
		const nt_report_finding *finding = &report->findings[i];
		bool *before = &seen[finding->code][finding->severity];
		if (!*before)
			nt_put(rows, NT_SCRIPT, ",{'code':%s,'severity':%s}", nt_finding_name(finding),
				nt_severity_name(finding->severity));
		*before = true;
	}
	nt_buffer_text(rows, "]}");
}

static void begin_index(nt_walk *w, nt_buffer *out)
{
	begin_page(true, out);
	nt_buffer_text(out, "<script type=\"application/json\" id=\"data\">{\"folder\":true,\"files\":[");
	nt_buffer_append(out, w->reports->rows->data, w->reports->rows->size);
	nt_buffer_text(out, "]}</script>\n");
	put_part(NT_HTML_SCRIPT, true, out);
	nt_buffer_text(out, "</body>\n</html>\n");
}

const nt_report_writer nt_index_writer = {.begin = begin_index};
