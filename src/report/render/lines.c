/* SPDX-License-Identifier: MIT */
/*
 * A line per new finding, with its remedy, for a log: as compilers print them, which editors and CI services recognise,
 * or as workflow commands, of which GitHub makes annotations.
 */
#include "report/render/inside.h"

/* line 0: the file has none, or it is not known; code NULL: the file could not be judged. */
typedef void line_writer(const char *file, size_t line, nt_severity severity, const char *code, char *text,
	nt_buffer *out);

static void put_compiler_line(const char *file, size_t line, nt_severity severity, const char *code, char *text,
	nt_buffer *out)
{
	nt_put_text(out, NT_TERMINAL, file);
	if (line)
		nt_buffer_format(out, ":%zu", line);
	nt_put(out, NT_TERMINAL, ": %-s: %-s%-s%p\n", nt_severity_name(severity), code ? code : "", code ? ": " : "",
		text);
}

static void put_command(const char *file, size_t line, nt_severity severity, const char *code, char *text,
	nt_buffer *out)
{
	static const char *const commands[] = {"notice", "warning", "error"};
	nt_put(out, NT_PROPERTY, "::%-s file=%s", commands[severity], file);
	if (line)
		nt_buffer_format(out, ",line=%zu", line);
	nt_put(out, NT_COMMAND, ",title=%-s::%p\n", code ? code : "not judged", text);
}

static void put_line(const nt_walk *w, const nt_report_finding *finding, line_writer *put, nt_buffer *out)
{
	const nt_report *report = w->report;
	nt_buffer file = {0};
	nt_opened_path(report->paths, finding && finding->file ? finding->place.file : report->path, &file);
	if (finding)
		put(file.data ? file.data : "", nt_finding_line(finding), finding->severity, nt_finding_name(finding),
			nt_finding_sentence(report, finding, put == put_command ? "\n" : ". "), out);
	else if (report->failure && !nt_failure_is_found(report))
		put(file.data ? file.data : "", report->failure_place.line, NT_SEVERITY_ERROR, NULL,
			nt_failure_text(report, false), out);
	nt_buffer_free_into(&file, out);
}

static void begin_lines(nt_walk *w, nt_buffer *out)
{
	put_line(w, NULL, put_compiler_line, out);
}

static void put_lines_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	put_line(w, finding, put_compiler_line, out);
}

static void begin_github(nt_walk *w, nt_buffer *out)
{
	put_line(w, NULL, put_command, out);
}

static void put_github_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	put_line(w, finding, put_command, out);
}

const nt_report_writer nt_lines_writer = {.begin_file = begin_lines, .put_finding = put_lines_finding};
const nt_report_writer nt_github_writer = {.begin_file = begin_github, .put_finding = put_github_finding};
