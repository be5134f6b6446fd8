/* SPDX-License-Identifier: MIT */
/*
 * A line per finding: CSV, for spreadsheets; and of new findings, with their remedies, for a log.
 */
#include "report/render/inside.h"

/* ---- CSV (RFC 4180): a row per finding ---- */

static void begin(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "file,mesh,code,severity,count,message,line,triangle,x,y,z,u,v,fingerprint,state\r\n");
}

static void begin_file(nt_walk *w, nt_buffer *out)
{
	if (w->report->failure)
		nt_put(out, NT_CSV, "%s,,,error,1,%p,%.0zu,,,,,,,,\r\n", w->report->shown,
			nt_failure_text(w->report, false), w->report->failure_place.line);
}

/* The first place: triangle, x, y, z, u, v. */
static void put_spot(const nt_report *report, const nt_spot *spot, nt_buffer *out)
{
	if (spot->triangle != NT_NONE)
		nt_buffer_format(out, "%u", spot->triangle);
	for (int i = 0; i < 3; i++) {
		nt_buffer_text(out, ",");
		nt_put_coordinate(spot->positions[0][i], report->origin[i], out);
	}
	if (spot->has_texcoords)
		nt_buffer_format(out, ",%.9g,%.9g", (double)spot->texcoords[0][0], (double)spot->texcoords[0][1]);
	else
		nt_buffer_text(out, ",,");
}

static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const nt_report *report = w->report;
	nt_put_text(out, NT_CSV, nt_finding_file(report, finding));
	if (nt_finding_has_object(finding))
		nt_put(out, NT_CSV, ",%s", finding->place.object);
	else
		nt_put(out, NT_CSV, ",%p", nt_mesh_label(report, finding->mesh));
	nt_put(out, NT_CSV, ",%-s,%-s,%zu,%s,%.0zu,", nt_finding_name(finding), nt_severity_name(finding->severity),
		finding->count, finding->message, nt_finding_line(finding));
	if (finding->spot_count)
		put_spot(report, &finding->spots[0], out);
	else
		nt_buffer_text(out, ",,,,,");
	nt_put(out, NT_CSV, ",%" PRIx64 ",%-s\r\n", finding->fingerprint, finding->known ? "known" : "new");
}

const nt_report_writer nt_csv_writer = {
	.known = true, .begin = begin, .begin_file = begin_file, .put_finding = put_finding};

/* ---- a log ---- */

/* As compilers print them, which editors and CI services recognise, or as workflow commands, of which GitHub makes
 * annotations. */

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
