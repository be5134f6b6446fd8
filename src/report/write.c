/* SPDX-License-Identifier: MIT */
/*
 * The table of report formats and what their writers share: see write.h and writers.h.
 */
#include "report/writers.h"

#include <math.h>
#include <string.h>
#include <strings.h>
#include "base/utf8.h"

static const struct {
	const char *name, *extensions;
	void (*write)(const nt_report_list *, nt_buffer *);
} formats[NT_REPORT_FORMAT_COUNT] = {
	[NT_REPORT_TEXT] = {"text", ".txt", nt_write_text},
	[NT_REPORT_JSON] = {"json", ".json", nt_write_json},
	[NT_REPORT_SARIF] = {"sarif", ".sarif", nt_write_sarif},
	[NT_REPORT_JUNIT] = {"junit", ".xml", nt_write_junit},
	[NT_REPORT_CSV] = {"csv", ".csv", nt_write_csv},
	[NT_REPORT_MARKDOWN] = {"markdown", ".md", nt_write_markdown},
	[NT_REPORT_HTML] = {"html", ".html .htm", nt_write_html},
};

/* Whether a list of extensions separated by spaces has the one that the path ends in. */
static bool ends_in(const char *path, const char *extensions)
{
	const char *dot = strrchr(path, '.');
	while (dot && *extensions) {
		const size_t length = strcspn(extensions, " ");
		if (strlen(dot) == length && strncasecmp(dot, extensions, length) == 0)
			return true;
		extensions += length + (extensions[length] == ' ');
	}
	return false;
}

bool nt_report_format_of_path(const char *path, nt_report_format *format)
{
	for (unsigned i = 0; i < NT_REPORT_FORMAT_COUNT; i++) {
		if (formats[i].extensions && ends_in(path, formats[i].extensions)) {
			*format = (nt_report_format)i;
			return true;
		}
	}
	return false;
}

nmtan_status nt_report_write(const nt_report *const *reports, size_t count, nt_report_format format,
	const nt_report_style *style, nt_report_sink sink, void *user, nt_error *error)
{
	nt_report_list list = {.items = reports, .count = count};
	if (style)
		list.style = *style;
	nt_buffer out = {0};
	formats[format].write(&list, &out);
	const nmtan_status status = out.failed ? nt_fail_memory(error)
					       : sink(user, out.data ? out.data : "", out.size, error);
	nt_buffer_free(&out);
	return status;
}

nmtan_status nt_report_write_uv(const nt_report *report, uint32_t mesh, bool *drawn, nt_report_sink sink,
	void *user, nt_error *error)
{
	nt_buffer out = {0};
	*drawn = nt_write_uv_svg(report, mesh, &out);
	nmtan_status status = NMTAN_OK;
	if (out.failed)
		status = nt_fail_memory(error);
	else if (*drawn)
		status = sink(user, out.data, out.size, error);
	nt_buffer_free(&out);
	return status;
}

/* ---- shared ---- */

const char *nt_shown_path(const char *path)
{
	const char *slash = strrchr(path, '/');
	return path[0] == '/' && slash ? slash + 1 : path;
}

nt_totals nt_report_totals(const nt_report_list *reports)
{
	nt_totals totals = {0};
	for (size_t i = 0; i < reports->count; i++) {
		const nt_report *report = reports->items[i];
		for (int severity = 0; severity < 3; severity++)
			totals.by_severity[severity] += report->by_severity[severity];
		totals.known += report->known;
		totals.dropped += report->dropped;
	}
	return totals;
}

static void counted(size_t count, const char *noun, nt_buffer *out)
{
	nt_buffer_format(out, "%zu %s%s", count, noun, count == 1 ? "" : "s");
}

void nt_totals_text(const nt_totals *totals, nt_buffer *out)
{
	counted(totals->by_severity[NT_SEVERITY_ERROR], "error", out);
	nt_buffer_text(out, ", ");
	counted(totals->by_severity[NT_SEVERITY_WARNING], "warning", out);
	nt_buffer_text(out, ", ");
	counted(totals->by_severity[NT_SEVERITY_INFO], "info", out);
	if (totals->known)
		nt_buffer_format(out, ", %zu known from the baseline", totals->known);
	if (totals->dropped)
		nt_buffer_format(out, ", %zu not shown", totals->dropped);
}

const char *nt_island_kind_name(nt_island_kind kind)
{
	static const char *const names[] = {"normal", "mirrored", "mixed", "degenerate"};
	return names[kind];
}

const char *nt_input_format_name(nt_format format)
{
	static const char *const names[] = {"unknown", "obj", "ply", "gltf", "glb", "drc"};
	return names[format];
}

void nt_mesh_label(const nt_report *report, uint32_t mesh, nt_buffer *out)
{
	const nt_report_mesh *m = &report->meshes[mesh];
	if (m->place.object[0])
		nt_buffer_text(out, m->place.object);
	else if (m->name[0])
		nt_buffer_format(out, "mesh \"%s\"", m->name);
	else
		nt_buffer_format(out, "mesh %u", mesh);
}

void nt_json_string(const char *text, nt_buffer *out)
{
	nt_buffer_text(out, "\"");
	while (*text) {
		const unsigned char c = (unsigned char)*text;
		const size_t length = nt_utf8_length(text, SIZE_MAX);
		if (c == '"' || c == '\\')
			nt_buffer_format(out, "\\%c", c);
		else if (c == '\n')
			nt_buffer_text(out, "\\n");
		else if (c < 0x20 || c == 0x7f)
			nt_buffer_format(out, "\\u%04x", c);
		else if (length)
			nt_buffer_append(out, text, length);
		else
			nt_buffer_text(out, "\\ufffd");
		text += length ? length : 1;
	}
	nt_buffer_text(out, "\"");
}

void nt_json_float(double value, nt_buffer *out)
{
	if (isfinite(value))
		nt_buffer_format(out, "%.9g", value == 0.0 ? 0.0 : value);
	else
		nt_buffer_text(out, "null");
}

void nt_xml_text(const char *text, nt_buffer *out)
{
	while (*text) {
		const unsigned char c = (unsigned char)*text;
		const size_t length = nt_utf8_length(text, SIZE_MAX);
		if (c == '<')
			nt_buffer_text(out, "&lt;");
		else if (c == '>')
			nt_buffer_text(out, "&gt;");
		else if (c == '&')
			nt_buffer_text(out, "&amp;");
		else if (c == '"')
			nt_buffer_text(out, "&quot;");
		else if (c == '\'')
			nt_buffer_text(out, "&#39;");
		else if ((c < 0x20 && c != '\n' && c != '\t') || c == 0x7f || length == 0)
			nt_buffer_text(out, "\xef\xbf\xbd");
		else
			nt_buffer_append(out, text, length);
		text += length ? length : 1;
	}
}
