/* SPDX-License-Identifier: MIT */
/*
 * The table of report formats, and the walk that writes them all: see render.h.
 */
#include "report/render/render.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "report/render/writers.h"

static const struct {
	const char *name, *extensions;
	const nt_report_writer *writer;
} formats[NT_REPORT_FORMAT_COUNT] = {
	[NT_REPORT_TEXT] = {"text", ".txt", &nt_text_writer},
	[NT_REPORT_JSON] = {"json", ".json", &nt_json_writer},
	[NT_REPORT_SARIF] = {"sarif", ".sarif", &nt_sarif_writer},
	[NT_REPORT_JUNIT] = {"junit", ".xml", &nt_junit_writer},
	[NT_REPORT_CSV] = {"csv", ".csv", &nt_csv_writer},
	[NT_REPORT_MARKDOWN] = {"markdown", ".md", &nt_markdown_writer},
	[NT_REPORT_HTML] = {"html", ".html .htm", &nt_html_writer},
	[NT_REPORT_LINES] = {"lines", NULL, &nt_lines_writer},
	[NT_REPORT_GITHUB] = {"github", NULL, &nt_github_writer},
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

static void call(void (*part)(nt_walk *w, nt_buffer *out), nt_walk *w, nt_buffer *out)
{
	if (part)
		part(w, out);
	nt_list_flush(w->reports, NT_FLUSHED_BYTES, out);
}

void nt_report_walk(const nt_report_writer *writer, const nt_report_list *reports, nt_buffer *out)
{
	nt_walk w = {.reports = reports, .count = reports->count,
		.items = nt_alloc(reports->count, sizeof *w.items)};
	if (!w.items) {
		out->failed = true;
		return;
	}
	if (w.count)
		memcpy(w.items, reports->items, w.count * sizeof *w.items);
	call(writer->begin, &w, out);
	for (; w.file < w.count && !reports->stream->status; w.file++) {
		w.report = w.items[w.file];
		call(writer->begin_file, &w, out);
		const size_t count = writer->known ? w.report->finding_count : w.report->new_count;
		for (w.finding = 0; w.finding < count && writer->put_finding; w.finding++) {
			writer->put_finding(&w, &w.report->findings[w.finding], out);
			nt_list_flush(reports, NT_FLUSHED_BYTES, out);
		}
		call(writer->end_file, &w, out);
	}
	call(writer->end, &w, out);
	free(w.items);
}

nt_status nt_report_write(const nt_report *const *reports, size_t count, nt_report_format format,
	const nt_report_style *style, nt_report_sink sink, void *user, nt_error *error)
{
	nt_report_stream stream = {.sink = sink, .user = user, .error = error};
	nt_report_list list = {.items = reports, .count = count, .stream = &stream};
	if (style)
		list.style = *style;
	nt_buffer out = {0};
	nt_report_walk(formats[format].writer, &list, &out);
	nt_list_flush(&list, 0, &out);
	if (out.failed && !stream.status)
		stream.status = nt_fail_memory(error);
	nt_buffer_free(&out);
	return stream.status;
}

nt_status nt_report_write_index(const nt_buffer *rows, nt_report_sink sink, void *user, nt_error *error)
{
	nt_buffer out = {0};
	nt_write_html_index(rows, &out);
	const nt_status status = out.failed ? nt_fail_memory(error) : sink(user, out.data, out.size, error);
	nt_buffer_free(&out);
	return status;
}
