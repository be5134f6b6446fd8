/* SPDX-License-Identifier: MIT */
/*
 * The report as one HTML file that opens without a network: see page/page.js for what it shows.
 *
 * The page holds its data as JSON in a script element that is not run, with every `<` written as \u003c, so
 * that no name can end the element. Arrays are base64. Budgets keep the file below 20 MB: what does not
 * fit is left out, and the page says so.
 */
#include "report/render/writers.h"

#include <math.h>
#include <string.h>
#include "report/render/page_assets.h"
#include "report/render/sample.h"

/* Bytes before base64 adds a third: geometry; text of pictures; images; and findings and seams by number. */
enum {
	GEOMETRY_BYTES = 7 * 1000 * 1000,
	PICTURE_BYTES = 3 * 1000 * 1000,
	MOST_DRAWN_BYTES = 4 * PICTURE_BYTES,
	IMAGE_BYTES = 2 * 1000 * 1000,
	MOST_FINDINGS = 2000,
	MOST_SEAM_POINTS = 20000,
	MOST_MESHES = 1000
};

/* What is left of the budgets while the page grows. */
typedef struct budget {
	size_t geometry, images, findings, seam_points, meshes;
	size_t geometry_wanted; /* by the meshes still to come */
	size_t left_out;        /* findings */
	nt_buffer sources;      /* data URIs of images, as a JSON array without its end */
	size_t image_count;
} budget;

/* ---- small things ---- */

static void put_base64(const void *bytes, size_t size, nt_buffer *out)
{
	static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
	const unsigned char *p = bytes;
	char *to = nt_buffer_extend(out, (size + 2) / 3 * 4);
	for (size_t i = 0; to && i < size; i += 3) {
		const uint32_t b = i + 1 < size ? p[i + 1] : 0, c = i + 2 < size ? p[i + 2] : 0;
		const uint32_t group = (uint32_t)p[i] << 16 | b << 8 | c;
		*to++ = digits[group >> 18];
		*to++ = digits[group >> 12 & 63];
		*to++ = i + 1 < size ? digits[group >> 6 & 63] : '=';
		*to++ = i + 2 < size ? digits[group & 63] : '=';
	}
}

/* A JSON string that is safe inside a script element. */
static void put_string(const char *text, nt_buffer *out)
{
	nt_buffer plain = {0};
	nt_json_string(text, &plain);
	for (size_t i = 0; i < plain.size; i++) {
		if (plain.data[i] == '<')
			nt_buffer_text(out, "\\u003c");
		else
			nt_buffer_append(out, plain.data + i, 1);
	}
	nt_buffer_free_into(&plain, out);
}

static void put_floats(const float *values, size_t count, nt_buffer *out)
{
	for (size_t i = 0; i < count; i++) {
		if (i)
			nt_buffer_text(out, ",");
		nt_json_float(values[i], out);
	}
}

static void put_box(const nt_box *box, nt_buffer *out)
{
	if (!(box->minimum[0] <= box->maximum[0])) {
		nt_buffer_text(out, "null");
		return;
	}
	nt_buffer_text(out, "[[");
	put_floats(box->minimum, 3, out);
	nt_buffer_text(out, "],[");
	put_floats(box->maximum, 3, out);
	nt_buffer_text(out, "]]");
}

static bool has_v_down(const nt_report *report)
{
	return report->format == NT_FORMAT_GLTF || report->format == NT_FORMAT_GLB;
}

/* Whether an element of an array stands before. */
static bool ends_in_bracket(const nt_buffer *out)
{
	return out->size && out->data[out->size - 1] == ']';
}

/* ---- geometry ---- */

/* Rows of `width` floats of the sample's vertices as base64, null without data. v_up turns v over. */
static void put_rows(const char *name, const float *rows, size_t width, const nt_sample *sample, bool v_up,
	nt_buffer *out)
{
	nt_buffer_format(out, ",\"%s\":", name);
	if (!rows) {
		nt_buffer_text(out, "null");
		return;
	}
	nt_buffer raw = {0};
	for (size_t i = 0; i < sample->vertex_count; i++) {
		float row[4];
		memcpy(row, rows + width * sample->vertices[i], width * sizeof *row);
		if (v_up)
			row[1] = 1.0f - row[1];
		nt_buffer_append(&raw, row, width * sizeof *row);
	}
	nt_buffer_text(out, "\"");
	put_base64(raw.data, raw.size, out);
	nt_buffer_text(out, "\"");
	nt_buffer_free_into(&raw, out);
}

static void put_note(const nt_report_mesh *m, const nt_sample *sample, nt_buffer *out)
{
	nt_buffer_text(out, "{\"note\":\"");
	if (sample->whole)
		nt_buffer_format(out, "All %zu triangles. ", sample->triangle_count);
	else
		nt_buffer_format(out, "%zu of %zu triangles: the neighbourhood of the findings. ",
			sample->triangle_count, m->triangle_count);
	nt_buffer_text(out, m->geometry->tangents
			? "Frames are those that are stored."
			: "There are no stored tangents: frames come from screen derivatives.");
	nt_buffer_text(out, "\"");
}

static void put_geometry(const nt_report *report, uint32_t mesh, budget *left, nt_buffer *out)
{
	const nt_report_mesh *m = &report->meshes[mesh];
	const nt_report_geometry *g = m->geometry;
	const size_t wanted = nt_sample_bytes(m);
	nt_buffer_text(out, ",\"geometry\":");
	/* a share by size, so that no mesh starves */
	const size_t share = left->geometry_wanted <= left->geometry
		? wanted
		: (size_t)((double)left->geometry * (double)wanted / (double)left->geometry_wanted);
	left->geometry_wanted -= wanted;
	nt_sample sample;
	if (!g || nt_sample_make(&sample, report, mesh, share)) {
		out->failed |= g != NULL;
		nt_buffer_text(out, "null");
		return;
	}
	if (sample.triangle_count == 0) {
		nt_buffer_text(out, "null");
		nt_sample_free(&sample);
		return;
	}
	const size_t used = NT_SAMPLE_TRIANGLE_BYTES * sample.triangle_count +
		NT_SAMPLE_VERTEX_BYTES * sample.vertex_count;
	left->geometry -= used < left->geometry ? used : left->geometry;
	put_note(m, &sample, out);
	put_rows("positions", g->positions, 3, &sample, false, out);
	put_rows("normals", g->normals, 3, &sample, false, out);
	put_rows("tangents", g->tangents, 4, &sample, false, out);
	put_rows("texcoords", g->texcoords, 2, &sample, !has_v_down(report), out);
	nt_buffer_text(out, ",\"indices\":\"");
	put_base64(sample.indices, 3 * sample.triangle_count * sizeof *sample.indices, out);
	nt_buffer_text(out, "\"}");
	nt_sample_free(&sample);
}

/* ---- meshes ---- */

static void put_seam(const nt_seam *seam, budget *left, nt_buffer *out)
{
	const size_t edges = seam->edge_count < NT_SEAM_EDGES ? seam->edge_count : NT_SEAM_EDGES;
	nt_buffer_text(out, "{\"points\":[");
	for (size_t i = 0; i < edges && left->seam_points > 0; i++, left->seam_points--) {
		if (i == 0)
			put_floats(seam->edges[0].positions[0], 3, out);
		nt_buffer_text(out, ",");
		put_floats(seam->edges[i].positions[1], 3, out);
	}
	nt_buffer_text(out, "]}");
}

static void begin_fact(const char *name, nt_buffer *out)
{
	if (ends_in_bracket(out))
		nt_buffer_text(out, ",");
	nt_buffer_format(out, "[\"%s\",\"", name);
}

static void put_facts(const nt_report_mesh *m, nt_buffer *out)
{
	nt_buffer_text(out, ",\"facts\":[");
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

/* The image's number among data.images, null where there is none or no room. */
static void put_image(const nt_report_mesh *m, budget *left, nt_buffer *out)
{
	nt_buffer_text(out, ",\"image\":");
	if (!m->normal_map.bytes || m->normal_map.size > left->images) {
		nt_buffer_text(out, "null");
		return;
	}
	left->images -= m->normal_map.size;
	nt_buffer_format(out, "%zu", left->image_count);
	nt_buffer_format(&left->sources, "%s\"data:%s;base64,", left->image_count++ ? "," : "",
		m->normal_map.type);
	put_base64(m->normal_map.bytes, m->normal_map.size, &left->sources);
	nt_buffer_text(&left->sources, "\"");
}

static void put_mesh(const nt_report *report, uint32_t mesh, budget *left, nt_buffer *out)
{
	const nt_report_mesh *m = &report->meshes[mesh];
	nt_buffer label = {0};
	nt_mesh_label(report, mesh, &label);
	nt_buffer_text(out, "{\"label\":");
	put_string(label.data ? label.data : "", out);
	nt_buffer_free_into(&label, out);
	nt_buffer_text(out, ",\"why\":");
	put_string(m->why, out);
	if (m->same_as != NT_NONE)
		nt_buffer_format(out, ",\"same_as\":%u", m->same_as);
	nt_buffer_format(out, ",\"has_uv\":%s,\"box\":", m->has_texcoords ? "true" : "false");
	put_box(&m->box, out);
	put_facts(m, out);
	put_image(m, left, out);
	nt_buffer_text(out, ",\"seams\":[");
	for (size_t i = 0; m->seams && i < m->seam_count && left->seam_points > 0; i++) {
		nt_buffer_text(out, i ? "," : "");
		put_seam(&m->seams[i], left, out);
	}
	nt_buffer_text(out, "]");
	put_geometry(report, mesh, left, out);
	nt_buffer_text(out, "}");
}

/* ---- findings ---- */

/* The direction from which a finding's first triangle is seen from its front, null where there is none. */
static void put_facing(const nt_spot *spot, nt_buffer *out)
{
	nt_buffer_text(out, ",\"facing\":");
	double n[3] = {0, 0, 0};
	if (spot && spot->corner_count == 3) {
		double e[2][3];
		for (int k = 0; k < 2; k++)
			for (int i = 0; i < 3; i++)
				e[k][i] = (double)spot->positions[k + 1][i] - spot->positions[0][i];
		for (int i = 0; i < 3; i++)
			n[i] = e[0][(i + 1) % 3] * e[1][(i + 2) % 3] - e[0][(i + 2) % 3] * e[1][(i + 1) % 3];
	}
	const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
	if (!(length > 0.0) || !isfinite(length)) {
		nt_buffer_text(out, "null");
		return;
	}
	nt_buffer_format(out, "[%.4g,%.4g,%.4g]", n[0] / length, n[1] / length, n[2] / length);
}

static void put_uvs(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	nt_buffer_text(out, ",\"uvs\":[");
	for (unsigned i = 0; i < finding->spot_count; i++) {
		const nt_spot *spot = &finding->spots[i];
		float uv[2] = {0.0f, 0.0f};
		for (unsigned k = 0; k < spot->corner_count; k++)
			for (int axis = 0; axis < 2; axis++)
				uv[axis] += spot->texcoords[k][axis] / (float)spot->corner_count;
		if (!spot->has_texcoords || !isfinite(uv[0]) || !isfinite(uv[1]))
			continue;
		if (!has_v_down(report))
			uv[1] = 1.0f - uv[1];
		nt_buffer_text(out, ends_in_bracket(out) ? ",[" : "[");
		put_floats(uv, 2, out);
		nt_buffer_text(out, "]");
	}
	nt_buffer_text(out, "]");
}

static void put_finding(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	nt_buffer_format(out, "{\"code\":\"%s\",\"severity\":\"%s\",\"count\":%zu,\"known\":%s,\"message\":",
		nt_code_info(finding->code)->name, nt_severity_name(finding->severity), finding->count,
		finding->known ? "true" : "false");
	put_string(finding->message, out);
	nt_buffer_text(out, ",\"remedy\":");
	put_string(nt_code_info(finding->code)->remedy, out);
	nt_buffer_text(out, ",\"mesh\":");
	if (finding->mesh == NT_NONE || finding->mesh >= MOST_MESHES)
		nt_buffer_text(out, "null");
	else
		nt_buffer_format(out, "%u", finding->mesh);
	nt_buffer_text(out, ",\"seam\":");
	if (finding->seam == NT_NONE)
		nt_buffer_text(out, "null");
	else
		nt_buffer_format(out, "%u", finding->seam);
	const nt_spot *spot = finding->spot_count ? &finding->spots[0] : NULL;
	nt_buffer_format(out, ",\"line\":%zu,\"box\":", spot && spot->line ? spot->line : finding->place.line);
	put_box(&finding->box, out);
	put_facing(spot, out);
	put_uvs(report, finding, out);
	nt_buffer_text(out, "}");
}

static void put_file(const nt_report *report, budget *left, nt_buffer *out)
{
	nt_buffer_text(out, "{\"name\":");
	put_string(nt_shown_path(report->path), out);
	nt_buffer_text(out, ",\"meshes\":[");
	for (size_t i = 0; i < report->mesh_count && i < MOST_MESHES; i++) {
		nt_buffer_text(out, i ? ",\n" : "\n");
		put_mesh(report, (uint32_t)i, left, out);
	}
	nt_buffer_text(out, "],\"findings\":[");
	for (size_t i = 0; i < report->finding_count; i++) {
		if (left->findings == 0) {
			left->left_out += report->finding_count - i;
			break;
		}
		left->findings--;
		nt_buffer_text(out, i ? ",\n" : "\n");
		put_finding(report, &report->findings[i], out);
	}
	left->left_out += report->dropped;
	nt_buffer_text(out, "]}");
}

/* ---- the page ---- */

static void put_data(const nt_report_list *reports, nt_buffer *out)
{
	budget left = {.geometry = GEOMETRY_BYTES, .images = IMAGE_BYTES, .findings = MOST_FINDINGS,
		.seam_points = MOST_SEAM_POINTS};
	for (size_t i = 0; i < reports->count; i++)
		for (size_t m = 0; m < reports->items[i]->mesh_count && m < MOST_MESHES; m++)
			left.geometry_wanted += nt_sample_bytes(&reports->items[i]->meshes[m]);
	nt_buffer_text(out, "<script type=\"application/json\" id=\"data\">{\"files\":[");
	for (size_t i = 0; i < reports->count; i++) {
		nt_buffer_text(out, i ? ",\n" : "\n");
		put_file(reports->items[i], &left, out);
	}
	nt_buffer_format(out, "],\"left_out\":%zu,\"images\":[", left.left_out);
	nt_buffer_append(out, left.sources.data, left.sources.size);
	nt_buffer_free_into(&left.sources, out);
	nt_buffer_text(out, "]}</script>\n");
}

/* The UV layouts, each in a template, while there is room. Ones that turn out not to fit are drawn in vain, but
 * not without end. */
static void put_pictures(const nt_report_list *reports, nt_buffer *out)
{
	size_t left = PICTURE_BYTES, drawn_bytes = 0;
	for (size_t i = 0; i < reports->count; i++) {
		const nt_report *report = reports->items[i];
		for (size_t m = 0; m < report->mesh_count && m < MOST_MESHES && drawn_bytes < MOST_DRAWN_BYTES; m++) {
			nt_buffer picture = {0};
			const bool drawn = nt_write_uv_svg(report, (uint32_t)m, &picture);
			drawn_bytes += picture.size;
			if (drawn && picture.size <= left) {
				nt_buffer_format(out, "<template id=\"uv-%zu-%zu\">", i, m);
				nt_buffer_append(out, picture.data, picture.size);
				nt_buffer_text(out, "</template>\n");
				left -= picture.size;
			}
			nt_buffer_free_into(&picture, out);
		}
	}
}

static void put_header(const nt_report_list *reports, nt_buffer *out)
{
	const nt_totals totals = nt_report_totals(reports);
	nt_buffer summary = {0};
	nt_totals_text(&totals, &summary);
	nt_buffer_text(out, "<header><h1>nmtan report</h1><span id=\"summary\">");
	nt_xml_text(summary.data ? summary.data : "", out);
	nt_buffer_free_into(&summary, out);
	nt_buffer_text(out, "</span><span class=\"note\">");
	for (size_t i = 0; i < reports->count; i++) {
		nt_buffer_text(out, i ? ", " : "");
		nt_xml_text(nt_shown_path(reports->items[i]->path), out);
	}
	nt_buffer_text(out, "</span><span class=\"spacer\"></span>"
		"<button type=\"button\" id=\"theme\">Light or dark</button></header>\n");
	for (size_t i = 0; i < reports->count; i++) {
		if (!reports->items[i]->failure)
			continue;
		nt_buffer_text(out, "<p class=\"error panel\">");
		nt_xml_text(nt_shown_path(reports->items[i]->path), out);
		nt_buffer_text(out, " could not be judged: ");
		nt_xml_text(reports->items[i]->failure, out);
		nt_buffer_text(out, "</p>\n");
	}
}

static const char body[] =
	"<main>\n<section>\n<div class=\"panel\"><h2>Findings</h2>\n<div class=\"row\">"
	"<label><input type=\"checkbox\" id=\"show-error\" checked> errors</label>"
	"<label><input type=\"checkbox\" id=\"show-warning\" checked> warnings</label>"
	"<label><input type=\"checkbox\" id=\"show-info\" checked> infos</label>"
	"<label>Code <select id=\"code\"><option value=\"\">all</option></select></label>"
	"<label>Text <input type=\"search\" id=\"text\"></label></div>\n"
	"<p class=\"note\" id=\"shown\" role=\"status\"></p>\n"
	"<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table of findings\">"
	"<table><thead><tr id=\"columns\"></tr></thead><tbody id=\"rows\"></tbody></table></div></div>\n"
	"<div class=\"panel\"><h2>UV layout</h2>\n<p class=\"note\">Blue: unmirrored. Red and hatched: mirrored. "
	"Grey: degenerate. Thick: mirror seams, with their numbers on both sides.</p><div id=\"uv\"></div></div>\n"
	"</section>\n"
	"<section>\n<div class=\"panel\"><h2><label>Mesh <select id=\"mesh\"></select></label></h2>"
	"<dl id=\"facts\"></dl></div>\n"
	"<div class=\"panel\"><h2>In space</h2>\n<div class=\"row\">"
	"<label>Show <select id=\"show\"><option value=\"0\">lit by the normal map</option>"
	"<option value=\"1\">normal</option><option value=\"2\">tangent</option>"
	"<option value=\"3\">bitangent</option><option value=\"4\">tangent w</option>"
	"<option value=\"5\">UV grid</option></select></label>"
	"<label>Frame <select id=\"frame\"><option value=\"0\">stored, per vertex</option>"
	"<option value=\"1\">stored, light in tangent space</option>"
	"<option value=\"2\">per pixel, from screen derivatives</option></select></label>"
	"<label><input type=\"checkbox\" id=\"vectors\"> T B N</label>"
	"<label><input type=\"checkbox\" id=\"seams\" checked> seams</label>"
	"<button type=\"button\" id=\"home\">Whole mesh</button></div>\n"
	"<canvas id=\"view\" tabindex=\"0\" role=\"img\" aria-label=\"The mesh in space; arrow keys turn it, plus "
	"and minus zoom, Home shows all of it\"></canvas>\n<p class=\"note\" id=\"note\"></p></div>\n"
	"</section>\n</main>\n";

void nt_write_html(const nt_report_list *reports, nt_buffer *out)
{
	nt_buffer_text(out, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
		"<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
		"style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
		"<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
		"<link rel=\"icon\" href=\"data:,\">\n<title>nmtan report</title>\n<style>\n");
	nt_buffer_text(out, nt_page_style);
	nt_buffer_text(out, "</style>\n</head>\n<body>\n");
	put_header(reports, out);
	nt_buffer_text(out, body);
	put_pictures(reports, out);
	put_data(reports, out);
	nt_buffer_text(out, "<script>\n");
	nt_buffer_text(out, nt_page_script);
	nt_buffer_text(out, "</script>\n</body>\n</html>\n");
}
