/* SPDX-License-Identifier: MIT */
/*
 * Names, sums and numbers as reports say them, and how they are handed on: see inside.h.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "report/render/inside.h"

void nt_walk_flush(nt_walk *w, size_t least, nt_buffer *out)
{
	if (out->failed || out->size < least)
		return;
	const size_t kept = least ? 1 : 0;
	if (!w->status)
		w->status = w->sink(w->user, out->data ? out->data : "", out->size - kept, w->error);
	if (kept) {
		out->data[0] = out->data[out->size - 1];
		out->data[1] = '\0';
	}
	out->size = kept;
}

/* ---- sums ---- */

nt_totals nt_report_totals(const nt_report *const *reports, size_t count)
{
	nt_totals totals = {0};
	for (size_t i = 0; i < count; i++) {
		for (int severity = 0; severity < 3; severity++) {
			totals.by_severity[severity] += reports[i]->by_severity[severity];
			totals.known[severity] += reports[i]->known[severity];
			totals.hidden[severity] += reports[i]->hidden[severity];
		}
		totals.dropped += reports[i]->dropped;
	}
	return totals;
}

size_t nt_known_count(const nt_totals *totals)
{
	return totals->known[0] + totals->known[1] + totals->known[2];
}

void nt_totals_text(const nt_totals *totals, nt_buffer *out)
{
	const size_t *n = totals->by_severity, hidden = totals->hidden[0] + totals->hidden[1] + totals->hidden[2];
	nt_buffer_format(out, "%zu error%s, %zu warning%s, %zu info%s", n[NT_SEVERITY_ERROR],
		nt_plural(n[NT_SEVERITY_ERROR]), n[NT_SEVERITY_WARNING], nt_plural(n[NT_SEVERITY_WARNING]),
		n[NT_SEVERITY_INFO], nt_plural(n[NT_SEVERITY_INFO]));
	if (nt_known_count(totals))
		nt_buffer_format(out, ", %zu known from the baseline", nt_known_count(totals));
	if (hidden)
		nt_buffer_format(out, ", %zu below --min-severity", hidden);
	if (totals->dropped)
		nt_buffer_format(out, ", %zu not shown", totals->dropped);
}

void nt_dropped_text(const nt_report *report, const char *before, const char *after, nt_buffer *out)
{
	if (!report->dropped)
		return;
	nt_buffer_format(out, "%s%zu more", before, report->dropped);
	const char *comma = ": ";
	for (unsigned code = 0; code < NT_CODE_COUNT; code++) {
		if (!report->dropped_by_code[code])
			continue;
		nt_buffer_format(out, "%s%zu %s", comma, report->dropped_by_code[code], nt_code_info(code)->name);
		comma = ", ";
	}
	nt_buffer_text(out, after);
}

/* ---- words ---- */

const char *nt_island_kind_name(nt_island_kind kind)
{
	static const char *const names[] = {"normal", "mirrored", "mixed", "degenerate"};
	return names[kind];
}

size_t nt_finding_line(const nt_report_finding *finding)
{
	for (unsigned i = 0; i < finding->spot_count; i++)
		if (finding->spots[i].line)
			return finding->spots[i].line;
	return finding->place.line;
}

bool nt_finding_has_object(const nt_report_finding *finding)
{
	return finding->mesh == NT_NONE || (finding->file && finding->place.object[0]);
}

const char *nt_finding_file(const nt_report *report, const nt_report_finding *finding)
{
	return finding->file ? finding->file : report->shown;
}

bool nt_failure_is_found(const nt_report *report)
{
	bool found = false;
	for (size_t i = 0; report->failure && i < report->new_count; i++)
		found |= report->findings[i].code == NT_CODE_BUFFER_MISSING;
	return found;
}

char *nt_text_of(nt_buffer *text)
{
	nt_buffer_text(text, "");
	if (text->failed)
		nt_buffer_free(text);
	return text->data;
}

static void append_label(const nt_report *report, uint32_t mesh, nt_buffer *out)
{
	const nt_report_mesh *m = &report->meshes[mesh];
	if (m->place.object[0])
		nt_buffer_text(out, m->place.object);
	else
		nt_buffer_format(out, "mesh %u", mesh);
}

char *nt_mesh_label(const nt_report *report, uint32_t mesh)
{
	nt_buffer text = {0};
	append_label(report, mesh, &text);
	return nt_text_of(&text);
}

char *nt_finding_where(const nt_report *report, const nt_report_finding *finding, bool label)
{
	const size_t line = nt_finding_line(finding);
	nt_buffer text = {0};
	if (nt_finding_has_object(finding))
		nt_buffer_text(&text, finding->place.object[0] ? finding->place.object : finding->place.pointer);
	else if (label)
		append_label(report, finding->mesh, &text);
	if (text.size && (line || finding->file))
		nt_buffer_text(&text, ", ");
	if (line)
		nt_buffer_format(&text, "line %zu%s", line, finding->file ? " of " : "");
	nt_buffer_text(&text, finding->file ? finding->file : "");
	return nt_text_of(&text);
}

char *nt_finding_sentence(const nt_report *report, const nt_report_finding *finding, const char *between)
{
	const bool has_object = nt_finding_has_object(finding);
	nt_buffer text = {0};
	nt_buffer_text(&text, finding->message);
	if (has_object ? finding->place.object[0] : report->mesh_count != 1)
		nt_buffer_text(&text, ", in ");
	if (has_object)
		nt_buffer_text(&text, finding->place.object);
	else if (report->mesh_count != 1)
		append_label(report, finding->mesh, &text);
	nt_buffer_text(&text, between ? between : "");
	if (between)
		nt_remedy_text(finding->code, finding->repair, report->given, report->path, &text);
	return nt_text_of(&text);
}

char *nt_finding_remedy(const nt_report *report, const nt_report_finding *finding)
{
	nt_buffer text = {0};
	nt_remedy_text(finding->code, finding->repair, report->given, report->path, &text);
	return nt_text_of(&text);
}

char *nt_failure_text(const nt_report *report, bool line)
{
	const nt_place_view *place = &report->failure_place;
	nt_buffer text = {0};
	if (place->file[0] && strcmp(place->file, report->path) != 0) {
		nt_report_show_path(report, place->file, &text);
		nt_buffer_text(&text, ": ");
	}
	if (place->line && line)
		nt_buffer_format(&text, "line %zu: ", place->line);
	if (place->offset != NT_NO_OFFSET)
		nt_buffer_format(&text, "at byte %" PRIu64 ": ", place->offset);
	if (place->pointer[0])
		nt_buffer_format(&text, "%s: ", place->pointer);
	if (place->object[0])
		nt_buffer_format(&text, "%s: ", place->object);
	nt_buffer_text(&text, report->failure);
	return nt_text_of(&text);
}

/* ---- numbers and members of JSON ---- */

void nt_put_coordinate(float value, double origin, nt_buffer *out)
{
	if (origin == 0 || !isfinite(value)) {
		nt_put(out, NT_JSON, "%g", (double)value);
		return;
	}
	/* the fewest digits of those numbers whose difference from the origin is this float */
	const double sum = origin + value, step = fabs((double)nextafterf(value, INFINITY) - value) / 2;
	char text[32];
	int digits = 6;
	do
		snprintf(text, sizeof text, "%.*g", digits, sum);
	while (fabs(strtod(text, NULL) - sum) > step && digits++ < 17);
	nt_buffer_text(out, text);
}

void nt_put_rows(const float *values, size_t count, size_t width, const double *origin, nt_buffer *out)
{
	for (size_t i = 0; i < width * count; i++) {
		nt_buffer_text(out, i == 0 ? "[[" : i % width == 0 ? "],[" : ",");
		nt_put_coordinate(values[i], origin ? origin[i % width] : 0.0, out);
	}
	nt_buffer_text(out, count ? "]]" : "[]");
}

void nt_put_histogram(const char *name, const size_t corners[NT_ANGLE_BINS], nt_buffer *out)
{
	nt_put(out, NT_JSON, ",'%-s':[", name);
	for (int i = 0; i < NT_ANGLE_BINS; i++)
		nt_put(out, NT_JSON, ",{'up_to_degrees':%g,'corners':%zu}", nt_angle_bins[i], corners[i]);
	nt_buffer_text(out, "]");
}

void nt_put_votes(const nt_report_finding *finding, nt_buffer *out)
{
	const unsigned side = finding->votes_side;
	nt_buffer_text(out, finding->votes ? ",\"votes\":" : ",\"votes\":null");
	for (unsigned i = 0; finding->votes && i < side * side; i++)
		nt_buffer_format(out, "%s%d", i == 0 ? "[[" : i % side == 0 ? "],[" : ",", finding->votes[i]);
	nt_buffer_text(out, finding->votes ? "]]" : "");
}

void nt_put_repair(const nt_report *report, const nt_report_finding *finding, nt_syntax syntax, nt_buffer *out)
{
	nt_buffer command = {0};
	if (finding->repair)
		nt_command_text(finding->repair, report->given, report->path, NULL, &command);
	nt_put(out, syntax, ",'repair':%s", command.data);
	nt_buffer_free_into(&command, out);
}
