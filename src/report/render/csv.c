/* SPDX-License-Identifier: MIT */
/*
 * CSV (RFC 4180): a row per finding, for spreadsheets.
 */
#include "report/render/inside.h"

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
