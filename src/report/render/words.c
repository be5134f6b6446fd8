/* SPDX-License-Identifier: MIT */
/*
 * Names, sums and escaped text for reports: see words.h.
 */
#include "report/render/words.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/utf8.h"

void nt_list_flush(const nt_report_list *reports, size_t least, nt_buffer *out)
{
	nt_report_stream *to = reports->stream;
	if (out->failed || out->size < least)
		return;
	const size_t kept = least ? 1 : 0;
	if (!to->status)
		to->status = to->sink(to->user, out->data ? out->data : "", out->size - kept, to->error);
	if (kept) {
		out->data[0] = out->data[out->size - 1];
		out->data[1] = '\0';
	}
	out->size = kept;
}

nt_totals nt_report_totals(const nt_report_list *reports)
{
	nt_totals totals = {0};
	for (size_t i = 0; i < reports->count; i++) {
		const nt_report *report = reports->items[i];
		for (int severity = 0; severity < 3; severity++) {
			totals.by_severity[severity] += report->by_severity[severity];
			totals.known[severity] += report->known[severity];
			totals.hidden[severity] += report->hidden[severity];
		}
		totals.dropped += report->dropped;
	}
	return totals;
}

size_t nt_known_count(const nt_totals *totals)
{
	return totals->known[0] + totals->known[1] + totals->known[2];
}

static void counted(size_t count, const char *noun, nt_buffer *out)
{
	nt_buffer_format(out, "%zu %s%s", count, noun, count == 1 ? "" : "s");
}

void nt_totals_text(const nt_totals *totals, nt_buffer *out)
{
	counted(totals->by_severity[NT_SEVERITY_ERROR], "error", out);
	nt_buffer_text(out, ", ");
	counted(totals->by_severity[NT_SEVERITY_WARNING], "warning", out);
	nt_buffer_text(out, ", ");
	counted(totals->by_severity[NT_SEVERITY_INFO], "info", out);
	if (nt_known_count(totals))
		nt_buffer_format(out, ", %zu known from the baseline", nt_known_count(totals));
	const size_t hidden = totals->hidden[0] + totals->hidden[1] + totals->hidden[2];
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

const char *nt_island_kind_name(nt_island_kind kind)
{
	static const char *const names[] = {"normal", "mirrored", "mixed", "degenerate"};
	return names[kind];
}

const char *nt_input_format_name(nt_format format)
{
	static const char *const names[] = {"unknown", "obj", "ply", "gltf", "glb", "drc"};
	return names[format];
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

void nt_put_line(const nt_report_finding *finding, const char *before, void (*put)(const char *text, nt_buffer *out),
	nt_buffer *out)
{
	const size_t line = nt_finding_line(finding);
	if (line || finding->file)
		nt_buffer_text(out, before);
	if (line)
		nt_buffer_format(out, "line %zu%s", line, finding->file ? " of " : "");
	if (finding->file)
		put(finding->file, out);
}

void nt_put_where(const nt_report *report, const nt_report_finding *finding, bool label,
	void (*put)(const char *text, nt_buffer *out), nt_buffer *out)
{
	const size_t begin = out->size;
	if (nt_finding_has_object(finding))
		put(finding->place.object[0] ? finding->place.object : finding->place.pointer, out);
	else if (label)
		nt_put_label(report, finding->mesh, put, out);
	nt_put_line(finding, out->size > begin ? ", " : "", put, out);
}

void nt_put_sentence(const nt_report *report, const nt_report_finding *finding,
	void (*put)(const char *text, nt_buffer *out), nt_buffer *out)
{
	put(finding->message, out);
	const bool has_object = nt_finding_has_object(finding);
	if (has_object ? !finding->place.object[0] : report->mesh_count == 1)
		return;
	nt_buffer_text(out, ", in ");
	if (has_object)
		put(finding->place.object, out);
	else
		nt_put_label(report, finding->mesh, put, out);
}

void nt_failure_text(const nt_report *report, bool line, nt_buffer *out)
{
	const nt_place_view *place = &report->failure_place;
	if (place->file[0] && strcmp(place->file, report->path) != 0) {
		nt_report_show_path(report, place->file, out);
		nt_buffer_text(out, ": ");
	}
	if (place->line && line)
		nt_buffer_format(out, "line %zu: ", place->line);
	if (place->offset != NT_NO_OFFSET)
		nt_buffer_format(out, "at byte %" PRIu64 ": ", place->offset);
	if (place->pointer[0])
		nt_buffer_format(out, "%s: ", place->pointer);
	if (place->object[0])
		nt_buffer_format(out, "%s: ", place->object);
	nt_buffer_text(out, report->failure);
}

void nt_put_failure(const nt_report *report, bool line, void (*put)(const char *text, nt_buffer *out), nt_buffer *out)
{
	nt_buffer text = {0};
	nt_failure_text(report, line, &text);
	put(text.data ? text.data : "", out);
	nt_buffer_free_into(&text, out);
}

void nt_mesh_label(const nt_report *report, uint32_t mesh, nt_buffer *out)
{
	const nt_report_mesh *m = &report->meshes[mesh];
	if (m->place.object[0])
		nt_buffer_text(out, m->place.object);
	else if (m->name[0])
		nt_buffer_format(out, "mesh \"%s\"", m->name);
	else
		nt_buffer_format(out, "mesh %u", mesh);
}

void nt_put_label(const nt_report *report, uint32_t mesh, void (*put)(const char *text, nt_buffer *out),
	nt_buffer *out)
{
	nt_buffer label = {0};
	nt_mesh_label(report, mesh, &label);
	put(label.data ? label.data : "", out);
	nt_buffer_free_into(&label, out);
}

void nt_json_string(const char *text, nt_buffer *out)
{
	nt_buffer_text(out, "\"");
	while (*text) {
		const unsigned char c = (unsigned char)*text;
		const size_t length = nt_utf8_length(text, SIZE_MAX);
		if (c == '"' || c == '\\')
			nt_buffer_format(out, "\\%c", c);
		else if (c == '\n')
			nt_buffer_text(out, "\\n");
		else if (c < 0x20 || c == 0x7f)
			nt_buffer_format(out, "\\u%04x", c);
		else if (length)
			nt_buffer_append(out, text, length);
		else
			nt_buffer_text(out, "\\ufffd");
		text += length ? length : 1;
	}
	nt_buffer_text(out, "\"");
}

void nt_json_float(double value, nt_buffer *out)
{
	if (isfinite(value))
		nt_buffer_format(out, "%.9g", value == 0.0 ? 0.0 : value);
	else
		nt_buffer_text(out, "null");
}

void nt_json_index(uint32_t index, nt_buffer *out)
{
	if (index == NT_NONE)
		nt_buffer_text(out, "null");
	else
		nt_buffer_format(out, "%u", index);
}

void nt_json_floats(const float *values, size_t count, nt_buffer *out)
{
	nt_buffer_text(out, "[");
	for (size_t i = 0; i < count; i++) {
		nt_member_next(out, NT_SAME_LINE);
		nt_json_float(values[i], out);
	}
	nt_buffer_text(out, "]");
}

void nt_json_rows(const float *values, size_t count, size_t width, nt_buffer *out)
{
	nt_buffer_text(out, "[");
	for (size_t i = 0; i < count; i++) {
		nt_member_next(out, NT_SAME_LINE);
		nt_json_floats(values + i * width, width, out);
	}
	nt_buffer_text(out, "]");
}

void nt_member_next(nt_buffer *out, int indent)
{
	const char last = out->size ? out->data[out->size - 1] : '{';
	if (last != '{' && last != '[')
		nt_buffer_text(out, indent == NT_SPACED ? ", " : ",");
	if (indent >= 0)
		nt_buffer_text(out, "\n");
	for (int i = 0; i < indent; i++)
		nt_buffer_text(out, "\t");
}

void nt_member_key(nt_buffer *out, int indent, const char *name)
{
	nt_member_next(out, indent);
	nt_buffer_text(out, "\"");
	nt_buffer_text(out, name);
	nt_buffer_text(out, indent == NT_SPACED ? "\": " : "\":");
}

void nt_member_open(nt_buffer *out, const char *name, const char *bracket)
{
	nt_member_key(out, NT_SAME_LINE, name);
	nt_buffer_text(out, bracket);
}

void nt_member_text(nt_buffer *out, const char *name, const char *text)
{
	nt_member_key(out, NT_SAME_LINE, name);
	if (text)
		nt_json_string(text, out);
	else
		nt_buffer_text(out, "null");
}

void nt_member_count(nt_buffer *out, const char *name, uint64_t count)
{
	nt_member_key(out, NT_SAME_LINE, name);
	nt_buffer_format(out, "%" PRIu64, count);
}

void nt_member_index(nt_buffer *out, const char *name, uint32_t index)
{
	nt_member_key(out, NT_SAME_LINE, name);
	nt_json_index(index, out);
}

void nt_member_bool(nt_buffer *out, const char *name, bool value)
{
	nt_member_key(out, NT_SAME_LINE, name);
	nt_buffer_text(out, value ? "true" : "false");
}

void nt_member_float(nt_buffer *out, const char *name, double value)
{
	nt_member_key(out, NT_SAME_LINE, name);
	nt_json_float(value, out);
}

void nt_member_doubles(nt_buffer *out, const char *name, const double *values, size_t count)
{
	nt_member_open(out, name, "[");
	for (size_t i = 0; i < count; i++) {
		nt_member_next(out, NT_SAME_LINE);
		nt_json_float(values[i], out);
	}
	nt_buffer_text(out, "]");
}

void nt_member_digest(nt_buffer *out, const char *name, uint64_t digest)
{
	nt_member_key(out, NT_SAME_LINE, name);
	nt_buffer_format(out, digest ? "\"%016" PRIx64 "\"" : "null", digest);
}

void nt_member_histogram(nt_buffer *out, const char *name, const size_t corners[NT_ANGLE_BINS])
{
	nt_member_open(out, name, "[");
	for (int i = 0; i < NT_ANGLE_BINS; i++) {
		nt_member_next(out, NT_SAME_LINE);
		nt_buffer_format(out, "{\"up_to_degrees\":%g,\"corners\":%zu}", nt_angle_bins[i], corners[i]);
	}
	nt_buffer_text(out, "]");
}

void nt_put_coordinate(float value, double origin, nt_buffer *out)
{
	if (origin == 0 || !isfinite(value)) {
		nt_json_float(value, out);
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

void nt_json_positions(const float *positions, size_t count, const double origin[3], nt_buffer *out)
{
	for (size_t i = 0; i < 3 * count; i++) {
		nt_buffer_text(out, i == 0 ? "[[" : i % 3 == 0 ? "],[" : ",");
		nt_put_coordinate(positions[i], origin[i % 3], out);
	}
	nt_buffer_text(out, count ? "]]" : "[]");
}

void nt_json_box(const nt_box *box, const double origin[3], nt_buffer *out)
{
	if (!(box->minimum[0] <= box->maximum[0])) {
		nt_buffer_text(out, "null");
		return;
	}
	float corners[6];
	memcpy(corners, box->minimum, sizeof box->minimum);
	memcpy(corners + 3, box->maximum, sizeof box->maximum);
	nt_json_positions(corners, 2, origin, out);
}

void nt_member_votes(nt_buffer *out, const nt_report_finding *finding)
{
	const unsigned side = finding->votes_side;
	nt_member_key(out, NT_SAME_LINE, "votes");
	if (!finding->votes) {
		nt_buffer_text(out, "null");
		return;
	}
	for (unsigned i = 0; i < side * side; i++) {
		nt_buffer_text(out, i == 0 ? "[[" : i % side == 0 ? "],[" : ",");
		nt_buffer_format(out, "%d", finding->votes[i]);
	}
	nt_buffer_text(out, "]]");
}

void nt_member_repair(nt_buffer *out, const nt_report *report, const nt_report_finding *finding)
{
	nt_buffer command = {0};
	if (finding->repair)
		nt_command_text(finding->repair, report->given, report->path, NULL, &command);
	nt_member_text(out, "repair", command.data);
	nt_buffer_free_into(&command, out);
}

bool nt_failure_is_found(const nt_report *report)
{
	bool found = false;
	for (size_t i = 0; report->failure && i < report->new_count; i++)
		found |= report->findings[i].code == NT_CODE_BUFFER_MISSING;
	return found;
}

void nt_plain_text(const char *text, nt_buffer *out)
{
	nt_buffer_clean(out, text);
}

void nt_xml_text(const char *text, nt_buffer *out)
{
	while (*text) {
		const unsigned char c = (unsigned char)*text;
		const size_t length = nt_utf8_length(text, SIZE_MAX);
		if (c == '<')
			nt_buffer_text(out, "&lt;");
		else if (c == '>')
			nt_buffer_text(out, "&gt;");
		else if (c == '&')
			nt_buffer_text(out, "&amp;");
		else if (c == '"')
			nt_buffer_text(out, "&quot;");
		else if (c == '\'')
			nt_buffer_text(out, "&#39;");
		else if (c != '\n' && c != '\t' && nt_utf8_is_unsafe(text, length))
			nt_buffer_text(out, "\xef\xbf\xbd");
		else
			nt_buffer_append(out, text, length);
		text += length ? length : 1;
	}
}
