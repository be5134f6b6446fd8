/* SPDX-License-Identifier: MIT */
/*
 * Markdown, for comments on pull requests: short, the worst first. A table of the files with errors or warnings, then a
 * table of findings for each. Names come from files: everything that Markdown or HTML could take for markup is escaped.
 */
#include <stdlib.h>
#include <string.h>
#include "report/render/inside.h"

enum { MOST_FILES = 50, MOST_ROWS = 100 };

static void put_file_row(const nt_report *report, nt_buffer *out)
{
	size_t triangles = 0, mirrored = 0, seams = 0;
	for (size_t i = 0; i < report->mesh_count; i++) {
		triangles += report->meshes[i].triangle_count;
		mirrored += report->meshes[i].triangles[0];
		seams += report->meshes[i].seam_count;
	}
	nt_put(out, NT_MARKDOWN, "| %s", report->shown);
	if (report->failure) {
		nt_put(out, NT_MARKDOWN, " | not judged: %p | | | | | |\n", nt_failure_text(report, true));
		return;
	}
	nt_buffer_format(out, " | %zu | %zu | %zu | %zu | %zu | %zu |\n",
		report->by_severity[NT_SEVERITY_ERROR], report->by_severity[NT_SEVERITY_WARNING],
		report->by_severity[NT_SEVERITY_INFO], triangles, mirrored, seams);
}

void nt_put_markdown_row(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	nt_put(out, NT_MARKDOWN, "| %-s | `%-s` | %p | %s |\n", nt_severity_name(finding->severity),
		nt_finding_name(finding), nt_finding_where(report, finding, true), finding->message);
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
	const nt_totals totals = nt_report_totals(w->items, w->count);
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
	nt_put(out, NT_MARKDOWN, "\n### %s\n\n%p\n", w->report->shown, nt_verdict(w->report));
	if (w->report->new_count)
		nt_buffer_text(out, "\n| severity | code | where | finding |\n|---|---|---|---|\n");
}

static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	if (w->rows < MOST_ROWS) {
		nt_put_markdown_row(w->report, finding, out);
		w->rows++;
	} else {
		w->missing++;
	}
}

static void end_file(nt_walk *w, nt_buffer *out)
{
	if (!w->report->finding_count)
		return;
	nt_put_together(w->report, "\n", NT_MARKDOWN, out);
	nt_dropped_text(w->report, "\nAnd ", ".\n", out);
	if (w->missing)
		nt_buffer_format(out, "\n%zu findings more do not fit.\n", w->missing);
	w->missing = 0;
}

const nt_report_writer nt_markdown_writer = {
	.begin = begin, .begin_file = begin_file, .put_finding = put_finding, .end_file = end_file};
