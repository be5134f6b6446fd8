/* SPDX-License-Identifier: MIT */
/*
 * The table of report formats, and the walk that writes them all: see render.h.
 */
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "report/render/inside.h"

static const struct {
	const char *endings[2];
	const nt_report_writer *writer;
	void (*write_diff)(const nt_report_diff *diff, nt_buffer *out); /* NULL: by the writer, or not at all */
} formats[NT_REPORT_FORMAT_COUNT] = {
	[NT_REPORT_TEXT] = {{".txt"}, &nt_text_writer, nt_diff_text},
	[NT_REPORT_JSON] = {{".json"}, &nt_json_writer, nt_diff_json},
	[NT_REPORT_SARIF] = {{".sarif"}, &nt_sarif_writer},
	[NT_REPORT_JUNIT] = {{".xml"}, &nt_junit_writer},
	[NT_REPORT_CSV] = {{".csv"}, &nt_csv_writer},
	[NT_REPORT_MARKDOWN] = {{".md"}, &nt_markdown_writer, nt_diff_markdown},
	[NT_REPORT_HTML] = {{".html", ".htm"}, &nt_html_writer},
	[NT_REPORT_LINES] = {.writer = &nt_lines_writer},
	[NT_REPORT_GITHUB] = {.writer = &nt_github_writer},
};

bool nt_report_format_of_path(const char *path, nt_report_format *format)
{
	const char *dot = strrchr(path, '.');
	for (unsigned i = 0; dot && i < 2 * NT_REPORT_FORMAT_COUNT; i++) {
		const char *ending = formats[i / 2].endings[i % 2];
		*format = (nt_report_format)(i / 2);
		if (ending && strcasecmp(dot, ending) == 0)
			return true;
	}
	return false;
}

bool nt_diff_has_format(nt_report_format format)
{
	return formats[format].write_diff || format == NT_REPORT_HTML;
}

static void call(void (*part)(nt_walk *w, nt_buffer *out), nt_walk *w, nt_buffer *out)
{
	if (part)
		part(w, out);
	nt_walk_flush(w, NT_FLUSHED_BYTES, out);
}

static void write_reports(nt_walk *w, const nt_report_writer *writer, nt_buffer *out)
{
	call(writer->begin, w, out);
	for (; w->file < w->count && !w->status; w->file++) {
		w->report = w->items[w->file];
		call(writer->begin_file, w, out);
		const size_t count = writer->known ? w->report->finding_count : w->report->new_count;
		for (w->finding = 0; w->finding < count && writer->put_finding; w->finding++) {
			writer->put_finding(w, &w->report->findings[w->finding], out);
			nt_walk_flush(w, NT_FLUSHED_BYTES, out);
		}
		call(writer->end_file, w, out);
	}
	call(writer->end, w, out);
}

nt_status nt_report_write(const nt_report_list *what, nt_report_format format, nt_report_sink sink, void *user,
	nt_error *error)
{
	nt_walk w = {.reports = what, .sink = sink, .user = user, .error = error,
		.items = nt_alloc(what->count, sizeof *w.items)};
	nt_buffer out = {.failed = !w.items};
	for (size_t i = 0; i < what->count && w.items; i++)
		if (what->items[i])
			w.items[w.count++] = what->items[i];
	if (what->diff && formats[format].write_diff)
		formats[format].write_diff(what->diff, &out);
	else if (w.items)
		write_reports(&w, what->rows ? &nt_index_writer : formats[format].writer, &out);
	nt_walk_flush(&w, 0, &out);
	if (out.failed && !w.status)
		w.status = nt_fail_memory(error);
	nt_buffer_free(&out);
	free(w.items);
	return w.status;
}
