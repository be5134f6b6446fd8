/* SPDX-License-Identifier: MIT */
/*
 * A line per new finding, with its remedy, for a log: as compilers print them, which editors and CI services recognise,
 * or as workflow commands, of which GitHub makes annotations.
 */
#include "report/render/writers.h"

#include <string.h>
#include "base/utf8.h"

/* The parts of one line. */
typedef struct log_line {
	const char *file;
	size_t number; /* in the file; 0: it has no lines, or it is not known */
	nt_severity severity;
	const char *code; /* NULL: the file could not be judged */
	const char *text;
} log_line;

static void put_raw(const char *text, nt_buffer *out)
{
	nt_buffer_text(out, text);
}

static void put_failure(const nt_walk *w, void (*put)(const log_line *line, nt_buffer *out), nt_buffer *out)
{
	const nt_report *report = w->report;
	nt_buffer file = {0}, text = {0};
	if (!report->failure || nt_failure_is_found(report))
		return;
	nt_opened_path(report->paths, report->path, &file);
	nt_failure_text(report, false, &text);
	put(&(log_line){file.data ? file.data : "", report->failure_place.line, NT_SEVERITY_ERROR, NULL,
		text.data ? text.data : ""}, out);
	nt_buffer_free_into(&file, out);
	nt_buffer_free_into(&text, out);
}

/* before: the remedy. */
static void put_new(const nt_walk *w, const nt_report_finding *finding, const char *before,
	void (*put)(const log_line *line, nt_buffer *out), nt_buffer *out)
{
	nt_buffer text = {0}, file = {0};
	nt_opened_path(w->report->paths, finding->file ? finding->place.file : w->report->path, &file);
	nt_put_sentence(w->report, finding, put_raw, &text);
	nt_buffer_text(&text, before);
	nt_remedy_text(finding->code, finding->repair, w->report->given, w->report->path, &text);
	put(&(log_line){file.data ? file.data : "", nt_finding_line(finding), finding->severity,
		nt_code_info(finding->code)->name, text.data ? text.data : ""}, out);
	nt_buffer_free_into(&text, out);
	nt_buffer_free_into(&file, out);
}

/* ---- as compilers print ---- */

static void put_compiler_line(const log_line *line, nt_buffer *out)
{
	nt_buffer_clean(out, line->file);
	if (line->number)
		nt_buffer_format(out, ":%zu", line->number);
	nt_buffer_format(out, ": %s: ", nt_severity_name(line->severity));
	if (line->code)
		nt_buffer_format(out, "%s: ", line->code);
	nt_buffer_clean(out, line->text);
	nt_buffer_text(out, "\n");
}

static void begin_lines(nt_walk *w, nt_buffer *out)
{
	put_failure(w, put_compiler_line, out);
}

static void put_lines_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	put_new(w, finding, ". ", put_compiler_line, out);
}

const nt_report_writer nt_lines_writer = {.begin_file = begin_lines, .put_finding = put_lines_finding};

/* ---- for GitHub ---- */

/* A property ends at a comma or a colon, a command at the end of its line. Other characters that must not reach a
 * terminal are shown as \x1b. */
static void put_escaped(const char *text, bool property, nt_buffer *out)
{
	for (size_t length; *text; text += length) {
		char one[8] = "";
		length = nt_utf8_length(text, SIZE_MAX);
		length = length ? length : 1;
		if (strchr(property ? "%\r\n:," : "%\r\n", *text))
			nt_buffer_format(out, "%%%02X", (unsigned char)*text);
		else
			nt_buffer_clean(out, memcpy(one, text, length));
	}
}

static void put_command(const log_line *line, nt_buffer *out)
{
	static const char *const commands[] = {"notice", "warning", "error"};
	nt_buffer_format(out, "::%s file=", commands[line->severity]);
	put_escaped(line->file, true, out);
	if (line->number)
		nt_buffer_format(out, ",line=%zu", line->number);
	nt_buffer_format(out, ",title=%s::", line->code ? line->code : "not judged");
	put_escaped(line->text, false, out);
	nt_buffer_text(out, "\n");
}

static void begin_github(nt_walk *w, nt_buffer *out)
{
	put_failure(w, put_command, out);
}

static void put_github_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	put_new(w, finding, "\n", put_command, out);
}

const nt_report_writer nt_github_writer = {.begin_file = begin_github, .put_finding = put_github_finding};
