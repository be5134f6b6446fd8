/* SPDX-License-Identifier: MIT */
/*
 * Markdown, for comments on pull requests: a table of files, then a table of findings for each that has
 * some. Names come from files: everything that Markdown or HTML could take for markup is escaped.
 */
#include "report/render/writers.h"

#include <string.h>

enum { MOST_ROWS = 100 };

static void put_escaped(const char *text, nt_buffer *out)
{
	for (size_t length; *text; text += length) {
		length = 1;
		const unsigned char c = (unsigned char)*text;
		if (c < 0x20 || c == 0x7f)
			nt_buffer_text(out, " ");
		else if (c == '<')
			nt_buffer_text(out, "&lt;");
		else if (c == '&')
			nt_buffer_text(out, "&amp;");
		else if (strchr("\\`*_{}[]()#+-!|>~@", c))
			nt_buffer_format(out, "\\%c", c);
		else
			length = nt_put_utf8(text, out);
	}
}

static void put_file_row(const nt_report *report, nt_buffer *out)
{
	size_t triangles = 0, mirrored = 0, seams = 0;
	for (size_t i = 0; i < report->mesh_count; i++) {
		triangles += report->meshes[i].triangle_count;
		mirrored += report->meshes[i].triangles[0];
		seams += report->meshes[i].seam_count;
	}
	nt_buffer_text(out, "| ");
	put_escaped(nt_shown_path(report->path), out);
	if (report->failure) {
		nt_buffer_text(out, " | not judged: ");
		put_escaped(report->failure, out);
		nt_buffer_text(out, " | | | | | |\n");
		return;
	}
	nt_buffer_format(out, " | %zu | %zu | %zu | %zu | %zu | %zu |\n",
		report->by_severity[NT_SEVERITY_ERROR], report->by_severity[NT_SEVERITY_WARNING],
		report->by_severity[NT_SEVERITY_INFO], triangles, mirrored, seams);
}

static void put_findings(const nt_report *report, nt_buffer *out)
{
	nt_buffer_text(out, "\n## ");
	put_escaped(nt_shown_path(report->path), out);
	nt_buffer_text(out, "\n\n| severity | code | where | finding |\n|---|---|---|---|\n");
	for (size_t i = 0; i < report->finding_count && i < MOST_ROWS; i++) {
		const nt_report_finding *finding = &report->findings[i];
		nt_buffer label = {0};
		if (finding->mesh != NT_NONE)
			nt_mesh_label(report, finding->mesh, &label);
		nt_buffer_format(out, "| %s%s | `%s` | ", nt_severity_name(finding->severity),
			finding->known ? " (known)" : "", nt_code_info(finding->code)->name);
		put_escaped(label.data ? label.data : "", out);
		if (finding->spot_count && finding->spots[0].line)
			nt_buffer_format(out, ", line %zu", finding->spots[0].line);
		nt_buffer_text(out, " | ");
		put_escaped(finding->message, out);
		nt_buffer_text(out, " |\n");
		nt_buffer_free_into(&label, out);
	}
	const size_t missing = report->dropped +
		(report->finding_count > MOST_ROWS ? report->finding_count - MOST_ROWS : 0);
	if (missing)
		nt_buffer_format(out, "\n%zu more findings are not shown.\n", missing);
}

void nt_write_markdown(const nt_report_list *reports, nt_buffer *out)
{
	const nt_totals totals = nt_report_totals(reports);
	nt_buffer_text(out, "# nmtan report: ");
	nt_totals_text(&totals, out);
	nt_buffer_text(out, "\n\n| file | errors | warnings | infos | triangles | mirrored | mirror seams |\n"
		"|---|---:|---:|---:|---:|---:|---:|\n");
	for (size_t i = 0; i < reports->count; i++)
		put_file_row(reports->items[i], out);
	for (size_t i = 0; i < reports->count; i++)
		if (reports->items[i]->finding_count)
			put_findings(reports->items[i], out);
}
