/* SPDX-License-Identifier: MIT */
/*
 * CSV (RFC 4180): a row per finding, for spreadsheets. Names come from files, so that what must not reach a terminal is
 * shown as in text, and a cell that a spreadsheet would take for a formula gets an apostrophe in front.
 */
#include "report/render/writers.h"

#include <string.h>

static void put_cell(const char *text, nt_buffer *out)
{
	nt_buffer clean = {0};
	nt_buffer_clean(&clean, text);
	nt_buffer_text(out, "\"");
	if (*text && strchr("=+-@\t\r", *text))
		nt_buffer_text(out, "'");
	for (size_t at = 0, length; at < clean.size; at += length) {
		if (clean.data[at] == '"')
			nt_buffer_text(out, "\"");
		length = 1 + strcspn(clean.data + at + 1, "\"");
		nt_buffer_append(out, clean.data + at, length);
	}
	nt_buffer_text(out, "\",");
	nt_buffer_free_into(&clean, out);
}

/* Nothing, or numbers of the first place: line, triangle, x, y, z, u, v. */
static void put_spot(const nt_report *report, const nt_report_finding *finding, nt_buffer *out)
{
	if (nt_finding_line(finding))
		nt_buffer_format(out, "%zu", nt_finding_line(finding));
	nt_buffer_text(out, ",");
	if (finding->spot_count == 0) {
		nt_buffer_text(out, ",,,,,,");
		return;
	}
	const nt_spot *spot = &finding->spots[0];
	if (spot->triangle != NT_NONE)
		nt_buffer_format(out, "%u", spot->triangle);
	for (int i = 0; i < 3; i++) {
		nt_buffer_text(out, ",");
		nt_put_coordinate(spot->positions[0][i], report->origin[i], out);
	}
	if (spot->has_texcoords)
		nt_buffer_format(out, ",%.9g,%.9g,", (double)spot->texcoords[0][0],
			(double)spot->texcoords[0][1]);
	else
		nt_buffer_text(out, ",,,");
}

static void put_finding(nt_walk *w, const nt_report_finding *finding, nt_buffer *out)
{
	const nt_report *report = w->report;
	put_cell(nt_finding_file(report, finding), out);
	if (nt_finding_has_object(finding))
		put_cell(finding->place.object, out);
	else
		nt_put_label(report, finding->mesh, put_cell, out);
	nt_buffer_format(out, "%s,%s,%zu,", nt_code_info(finding->code)->name,
		nt_severity_name(finding->severity), finding->count);
	put_cell(finding->message, out);
	put_spot(report, finding, out);
	nt_buffer_format(out, "%016llx,%s\r\n", (unsigned long long)finding->fingerprint,
		finding->known ? "known" : "new");
}

static void begin(nt_walk *w, nt_buffer *out)
{
	(void)w;
	nt_buffer_text(out, "file,mesh,code,severity,count,message,line,triangle,x,y,z,u,v,fingerprint,"
		"state\r\n");
}

static void begin_file(nt_walk *w, nt_buffer *out)
{
	if (!w->report->failure)
		return;
	put_cell(w->report->shown, out);
	nt_buffer_text(out, ",,error,1,");
	nt_put_failure(w->report, false, put_cell, out);
	nt_buffer_format(out, w->report->failure_place.line ? "%zu,,,,,,,,\r\n" : ",,,,,,,,\r\n",
		w->report->failure_place.line);
}

const nt_report_writer nt_csv_writer = {
	.known = true, .begin = begin, .begin_file = begin_file, .put_finding = put_finding};
