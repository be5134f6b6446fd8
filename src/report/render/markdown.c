/* SPDX-License-Identifier: MIT */
/*
 * Markdown, for comments on pull requests: short, the worst first. A table of the files with errors or warnings, then a
 * table of findings for each. Names come from files: everything that Markdown or HTML could take for markup is escaped.
 */
#include "report/render/writers.h"

#include <stdlib.h>
#include <string.h>
#include "base/utf8.h"

enum { MOST_FILES = 50, MOST_ROWS = 100 };

void nt_markdown_text(const char *text, nt_buffer *out)
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
		else if (nt_utf8_is_unsafe(text, length = nt_utf8_length(text, SIZE_MAX)))
			nt_buffer_text(out, "\xef\xbf\xbd");
		else
			nt_buffer_append(out, text, length);
		length = length ? length : 1;
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
	nt_markdown_text(report->shown, out);
	if (report->failure) {
		nt_buffer_text(out, " | not judged: ");
		nt_put_failure(report, true, nt_markdown_text, out);
		nt_buffer_text(out, " | | | | | |\n");
		return;
	}
	nt_buffer_format(out, " | %zu | %zu | %zu | %zu | %zu | %zu |\n",
		report->by_severity[NT_SEVERITY_ERROR], report->by_severity[NT_SEVERITY_WARNING],
		report->by_severity[NT_SEVERITY_INFO], triangles, mirrored, seams);
}

void nt_markdown_finding(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	nt_buffer_format(out, "| %s | `%s` | ", nt_severity_name(finding->severity), nt_code_info(finding->code)->name);
	nt_put_where(report, finding, true, nt_markdown_text, out);
	nt_buffer_text(out, " | ");
	nt_markdown_text(finding->message, out);
	nt_buffer_text(out, " |\n");
}

/* Inputs that could not be read first, then by errors, warnings and infos. */
static int by_worst(const void *a, const void *b)
{
	const nt_report *x = *(const nt_report *const *)a, *y = *(const nt_report *const *)b;
	if (!x->failure != !y->failure)
		return x->failure ? -1 : 1;
	for (int severity = NT_SEVERITY_ERROR; severity >= NT_SEVERITY_INFO; severity--)
		if (x->by_severity[severity] != y->by_severity[severity])
			return x->by_severity[severity] > y->by_severity[severity] ? -1 : 1;
	return strcmp(x->path, y->path);
}

static bool is_clean(const nt_report *report)
{
	return !report->failure && !report->by_severity[NT_SEVERITY_ERROR] && !report->by_severity[NT_SEVERITY_WARNING];
}

static void begin(nt_walk *w, nt_buffer *out)
{
	const nt_totals totals = nt_report_totals(w->reports);
	qsort(w->items, w->count, sizeof *w->items, by_worst);
	nt_buffer_text(out, "## nmtan: ");
	nt_totals_text(&totals, out);
	nt_buffer_text(out, "\n\n| file | errors | warnings | infos | triangles | mirrored | mirror seams |\n"
		"|---|---:|---:|---:|---:|---:|---:|\n");
	size_t files = 0;
	for (; files < w->count && files < MOST_FILES && (files == 0 || !is_clean(w->items[files])); files++)
		put_file_row(w->items[files], out);
	if (files < w->count)
		nt_buffer_format(out, "\n%zu more files are not shown%s.\n", w->count - files,
			is_clean(w->items[files]) ? ", all without errors and warnings" : "");
	w->count = files;
}

static void begin_file(nt_walk *w, nt_buffer *out)
{
	if (!w->report->finding_count)
		return;
	nt_buffer_text(out, "\n### ");
	nt_markdown_text(w->report->shown, out);
	nt_buffer_text(out, "\n\n");
	nt_put_verdict(w->report, nt_markdown_text, out);
	nt_buffer_text(out, "\n");
	if (w->report->new_count)
		nt_buffer_text(out, "\n| severity | code | where | finding |\n|---|---|---|---|\n");
}

static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	if (w->rows < MOST_ROWS) {
		nt_markdown_finding(w->report, finding, out);
		w->rows++;
	} else {
		w->missing++;
	}
}

static void end_file(nt_walk *w, nt_buffer *out)
{
	if (!w->report->finding_count)
		return;
	nt_put_together(w->report, "\n", nt_markdown_text, out);
	nt_dropped_text(w->report, "\nAnd ", ".\n", out);
	if (w->missing)
		nt_buffer_format(out, "\n%zu findings more do not fit.\n", w->missing);
	w->missing = 0;
}

const nt_report_writer nt_markdown_writer = {
	.begin = begin, .begin_file = begin_file, .put_finding = put_finding, .end_file = end_file};
