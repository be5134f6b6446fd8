/* SPDX-License-Identifier: MIT */
/*
 * The table of report formats: see render.h.
 */
#include "report/render/render.h"

#include <string.h>
#include <strings.h>
#include "report/render/writers.h"

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
	[NT_REPORT_LINES] = {"lines", NULL, nt_write_lines},
	[NT_REPORT_GITHUB] = {"github", NULL, nt_write_github},
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

nt_status nt_report_write(const nt_report *const *reports, size_t count, nt_report_format format,
	const nt_report_style *style, nt_report_sink sink, void *user, nt_error *error)
{
	nt_report_stream stream = {.sink = sink, .user = user, .error = error};
	nt_report_list list = {.items = reports, .count = count, .stream = &stream};
	if (style)
		list.style = *style;
	nt_buffer out = {0};
	formats[format].write(&list, &out);
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
