/* SPDX-License-Identifier: MIT */
/*
 * Shared by the writers of reports: the reports they write, names and sums in words, and text escaped for
 * JSON, XML and HTML.
 */
#ifndef NT_REPORT_RENDER_WORDS_H
#define NT_REPORT_RENDER_WORDS_H

#include "report/render/compare.h"

typedef struct nt_report_style {
	bool colour;       /* text: for a terminal */
	int least_failure; /* JUnit: the nt_severity from which on a finding is a failure; 3: none */
	const char *index; /* HTML: the page that lists all files, as a URI; beside it are the parts that pages share.
	                      NULL: there is none but this one */
} nt_report_style;

/* Takes a piece of the output. */
typedef nt_status (*nt_report_sink)(void *user, const void *bytes, size_t size, nt_error *error);

/* The destination of a growing document. */
typedef struct nt_report_stream {
	nt_report_sink sink;
	void *user;
	nt_error *error;
	nt_status status; /* what the sink returned when it failed; nothing more is written then */
} nt_report_stream;

typedef struct nt_report_list {
	const nt_report *const *items;
	size_t count;
	nt_report_style style;
	nt_report_stream *stream;
	const nt_report_diff *diff; /* HTML: of the two reports; NULL: none */
	nt_buffer *changes;         /* and what the page says of it, as JSON; empty when it is written */
} nt_report_list;

/* Hands on what a large document has so far, if it is `least` bytes or more: but for the last byte, by which the next
 * knows whether a comma is due. least 0: all of it, at the end. */
enum { NT_FLUSHED_BYTES = 1 << 20 };
void nt_list_flush(const nt_report_list *reports, size_t least, nt_buffer *out);

/* New findings of all reports, by severity; known ones, and new ones that were dropped. */
typedef struct nt_totals {
	size_t by_severity[3], known[3], hidden[3], dropped;
} nt_totals;
nt_totals nt_report_totals(const nt_report_list *reports);

const char *nt_island_kind_name(nt_island_kind kind);
const char *nt_input_format_name(nt_format format);

size_t nt_known_count(const nt_totals *totals);

/* "1 error, 2 warnings, 0 infos", with the known ones where there are any. */
void nt_totals_text(const nt_totals *totals, nt_buffer *out);

/* The first thing to know of a report: that it is ready to use, or what is to be done and why. `put` writes a text of
 * any bytes. */
void nt_put_verdict(const nt_report *report, void (*put)(const char *text, nt_buffer *out), nt_buffer *out);

/* Several findings name different commands, which write one output: a line with the command that does what all of them
 * do, `before` in front. Nothing if they name one, if none does all, or if the verdict names it. */
void nt_put_together(const nt_report *report, const char *before, void (*put)(const char *text, nt_buffer *out),
	nt_buffer *out);

/* Findings that --max-issues left out, between the two texts: "3 more: 2 UV_MIRROR_SEAM, 1 TAN_UNUSED". Nothing where
 * it left nothing out. */
void nt_dropped_text(const nt_report *report, const char *before, const char *after, nt_buffer *out);

/* The line of a text where a finding begins, of its first face that has one; 0: none. */
size_t nt_finding_line(const nt_report_finding *finding);

/* Whether its place has an object of its own, which may be no mesh: a material. */
bool nt_finding_has_object(const nt_report_finding *finding);

/* Its file as reports show it: the input's, or that of a material library. */
const char *nt_finding_file(const nt_report *report, const nt_report_finding *finding);

/* Appends its mesh, if `label`, or the object or JSON pointer of what is no mesh's; then its line, and in which file
 * that is if not in the input: material "wood", line 11 of wood.mtl. Nothing if nothing of that is known. */
void nt_put_where(const nt_report *report, const nt_report_finding *finding, bool label,
	void (*put)(const char *text, nt_buffer *out), nt_buffer *out);

/* The second part alone, with `before` in front. */
void nt_put_line(const nt_report_finding *finding, const char *before, void (*put)(const char *text, nt_buffer *out),
	nt_buffer *out);

/* Appends its sentence, and the mesh if the file has several, or what else it stands in. */
void nt_put_sentence(const nt_report *report, const nt_report_finding *finding,
	void (*put)(const char *text, nt_buffer *out), nt_buffer *out);

/* Why a file is not judged, behind where in it: "line 3: ", "/meshes/0: ". line: false leaves the line out. */
void nt_failure_text(const nt_report *report, bool line, nt_buffer *out);

/* The same, as `put` writes a text of any bytes. */
void nt_put_failure(const nt_report *report, bool line, void (*put)(const char *text, nt_buffer *out), nt_buffer *out);

/* The name a mesh is shown with: its object in words, its name or its number. Never empty. */
void nt_mesh_label(const nt_report *report, uint32_t mesh, nt_buffer *out);

/* The same, as `put` writes a text of any bytes. */
void nt_put_label(const nt_report *report, uint32_t mesh, void (*put)(const char *text, nt_buffer *out),
	nt_buffer *out);

/* ---- JSON ---- */

/* A string with its quotes; bytes that are no UTF-8 become U+FFFD. */
void nt_json_string(const char *text, nt_buffer *out);

/* A number that reads back as the same float; null for NaN and infinities. */
void nt_json_float(double value, nt_buffer *out);

/* A number; null for NT_NONE. */
void nt_json_index(uint32_t index, nt_buffer *out);

/* Arrays: of numbers, of `count` rows of `width` numbers, of the corners of a box; null for an empty box. */
void nt_json_floats(const float *values, size_t count, nt_buffer *out);
void nt_json_rows(const float *values, size_t count, size_t width, nt_buffer *out);
void nt_json_box(const nt_box *box, const double origin[3], nt_buffer *out);

/* Begins the next value of an array, the next member of an object: with a comma unless a bracket is before it, and on a
 * new line with `indent` tabs unless that is one of these. */
enum { NT_SAME_LINE = -1, NT_SPACED = -2 };
void nt_member_next(nt_buffer *out, int indent);
void nt_member_key(nt_buffer *out, int indent, const char *name);

/* Members, on the same line: an object or array to be closed; a string, null for NULL; numbers as above, doubles as
 * floats. */
void nt_member_open(nt_buffer *out, const char *name, const char *bracket);
void nt_member_text(nt_buffer *out, const char *name, const char *text);
void nt_member_count(nt_buffer *out, const char *name, uint64_t count);
void nt_member_index(nt_buffer *out, const char *name, uint32_t index);
void nt_member_bool(nt_buffer *out, const char *name, bool value);
void nt_member_float(nt_buffer *out, const char *name, double value);
void nt_member_doubles(nt_buffer *out, const char *name, const double *values, size_t count);
/* 16 digits, null for 0; corners by angle. */
void nt_member_digest(nt_buffer *out, const char *name, uint64_t digest);
void nt_member_histogram(nt_buffer *out, const char *name, const size_t corners[NT_ANGLE_BINS]);

/* A coordinate of a mesh as the file has it: plus that of the origin, with the digits that a float leaves. */
void nt_put_coordinate(float value, double origin, nt_buffer *out);
/* The same of `count` positions, as JSON. */
void nt_json_positions(const float *positions, size_t count, const double origin[3], nt_buffer *out);

/* Votes of a normal map's blocks, row by row; null if a finding has none. */
void nt_member_votes(nt_buffer *out, const nt_report_finding *finding);

/* The command that repairs a finding; null if nmtan cannot. */
void nt_member_repair(nt_buffer *out, const nt_report *report, const nt_report_finding *finding);

/* Whether a finding says, with its place, why a file is not judged. */
bool nt_failure_is_found(const nt_report *report);

/* Text for a terminal: nt_buffer_clean(). */
void nt_plain_text(const char *text, nt_buffer *out);

/* Text for XML and HTML: markup escaped, and U+FFFD for what is unsafe (nt_utf8_is_unsafe()). */
void nt_xml_text(const char *text, nt_buffer *out);

#endif
