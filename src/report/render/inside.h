/* SPDX-License-Identifier: MIT */
/*
 * The inside of the room: the walk over reports that all formats hang on, and what they say in words.
 */
#ifndef NT_REPORT_RENDER_INSIDE_H
#define NT_REPORT_RENDER_INSIDE_H

#include <inttypes.h>
#include "base/hash_index.h"
#include "report/render/render.h"

/* ---- the walk ---- */

/* Limits of one page while it grows. */
typedef struct nt_page_budget {
	size_t images[NT_PICTURE_COUNT], findings, seams;
	size_t left_out;    /* findings */
	bool seen[NT_CODE_COUNT];
	nt_buffer sources;  /* data URIs of images, as a JSON array without its end */
	nt_name_table held; /* their bytes */
} nt_page_budget;

/* A walk over reports, and what a writer remembers of it. */
typedef struct nt_walk {
	const nt_report_list *reports;
	const nt_report **items;         /* [count] the files to come, which begin() may sort and cut */
	size_t count;
	const nt_report *report;         /* the current file, */
	size_t file, finding;            /* its place among items, and that of the finding among its own */
	nt_report_sink sink;
	void *user;
	nt_error *error;
	nt_status status;                /* what the sink returned when it failed; nothing more is written then */
	const nt_report_finding *first;  /* JUnit: the first finding that fails, */
	nt_buffer parts[2];              /* and the lines of those that do not and that do */
	size_t rows, missing;            /* written; and not written, since there is a limit */
	const char *told[NT_CODE_COUNT]; /* text: the command of the last remedy of a code in this file; NULL: none */
	nt_page_budget page;             /* HTML */
} nt_walk;

/* A format: what is called before the first file, before the findings of each, for each, behind them and at the end.
 * NULL: nothing. Each appends to a buffer, whose failed flag tells of exhausted memory; it is emptied between
 * calls but for its last byte. */
typedef struct nt_report_writer {
	bool known; /* findings that the baseline has are written, too */
	void (*begin)(nt_walk *w, nt_buffer *out);
	void (*begin_file)(nt_walk *w, nt_buffer *out);
	void (*put_finding)(nt_walk *w, const nt_report_finding *finding, nt_buffer *out);
	void (*end_file)(nt_walk *w, nt_buffer *out);
	void (*end)(nt_walk *w, nt_buffer *out);
} nt_report_writer;

extern const nt_report_writer nt_text_writer, nt_json_writer, nt_sarif_writer, nt_junit_writer, nt_csv_writer,
	nt_markdown_writer, nt_html_writer, nt_index_writer, nt_lines_writer, nt_github_writer;

/* Hands on what a large document has so far, if that is `least` bytes or more: but for the last byte, by which
 * nt_put() knows whether a comma is due. least 0: all of it, at the end. */
enum { NT_FLUSHED_BYTES = 1 << 20 };
void nt_walk_flush(nt_walk *w, size_t least, nt_buffer *out);

/* Differences: whole documents, and the member of a page's data. */
void nt_diff_text(const nt_report_diff *diff, nt_buffer *out);
void nt_diff_markdown(const nt_report_diff *diff, nt_buffer *out);
void nt_diff_json(const nt_report_diff *diff, nt_buffer *out);
void nt_diff_page(const nt_report_diff *diff, nt_buffer *out);

/* page_assets.c: what goes into an HTML page. The inside of page.html's body; the scripts in order. */
extern const char nt_page_style[], nt_page_body[], nt_page_script[];

/* ---- sums ---- */

/* New findings of reports, by severity; known ones, and new ones that were dropped. */
typedef struct nt_totals {
	size_t by_severity[3], known[3], hidden[3], dropped;
} nt_totals;
nt_totals nt_report_totals(const nt_report *const *reports, size_t count);
size_t nt_known_count(const nt_totals *totals);

/* "1 error, 2 warnings, 0 infos", with the known ones where there are any. */
void nt_totals_text(const nt_totals *totals, nt_buffer *out);

/* Findings that --max-issues left out, between the two texts: "3 more: 2 UV_MIRROR_SEAM, 1 TAN_UNUSED". Nothing where
 * it left nothing out. */
void nt_dropped_text(const nt_report *report, const char *before, const char *after, nt_buffer *out);

/* ---- words ---- */

const char *nt_island_kind_name(nt_island_kind kind);

static inline const char *nt_plural(size_t count)
{
	return count == 1 ? "" : "s";
}

static inline const char *nt_finding_name(const nt_report_finding *finding)
{
	return nt_code_info(finding->code)->name;
}

/* The line of a text where a finding begins, of its first face that has one; 0: none. */
size_t nt_finding_line(const nt_report_finding *finding);

/* Whether its place has an object of its own, which may be no mesh: a material. */
bool nt_finding_has_object(const nt_report_finding *finding);

/* Its file as reports show it: the input's, or that of a material library. */
const char *nt_finding_file(const nt_report *report, const nt_report_finding *finding);

/* Whether a finding says, with its place, why a file is not judged. */
bool nt_failure_is_found(const nt_report *report);

/* The texts below are allocated, for %p of nt_put(); NULL: out of memory. */

/* Frees a buffer but for its text, "" if nothing is in it. */
char *nt_text_of(nt_buffer *text);

/* The name a mesh is shown with: its object in words, its name or its number. Never empty. */
char *nt_mesh_label(const nt_report *report, uint32_t mesh);

/* Its mesh, if `label`, or the object or JSON pointer of what is no mesh's; then its line, and in which file that is if
 * not in the input: material "wood", line 11 of wood.mtl. Empty if nothing of that is known. */
char *nt_finding_where(const nt_report *report, const nt_report_finding *finding, bool label);

/* Its sentence, and the mesh if the file has several, or what else it stands in; then `between` and its remedy, unless
 * that is NULL. */
char *nt_finding_sentence(const nt_report *report, const nt_report_finding *finding, const char *between);

/* Its remedy, with the command that repairs it. */
char *nt_finding_remedy(const nt_report *report, const nt_report_finding *finding);

/* Why a file is not judged, behind where in it: "line 3: ", "/meshes/0: ". line: false leaves the line out. */
char *nt_failure_text(const nt_report *report, bool line);

/* The first thing to know of a report: that it is ready to use, or what is to be done and why. */
char *nt_verdict(const nt_report *report);

/* Several findings name different commands, which write one output: a line with the command that does what all of them
 * do, `before` in front. Nothing if they name one, if none does all, or if the verdict names it. */
void nt_put_together(const nt_report *report, const char *before, nt_syntax syntax, nt_buffer *out);

/* ---- numbers and members of JSON ---- */

/* A coordinate of a mesh as the file has it: plus that of the origin, with the digits that a float leaves. */
void nt_put_coordinate(float value, double origin, nt_buffer *out);

/* Rows of numbers, as JSON; NULL for the origin: 0. */
void nt_put_rows(const float *values, size_t count, size_t width, const double *origin, nt_buffer *out);

/* Members: corners by angle; the command that repairs a finding, null if nmtan cannot; votes of a normal map's blocks,
 * row by row, null if a finding has none. */
void nt_put_histogram(const char *name, const size_t corners[NT_ANGLE_BINS], nt_buffer *out);
void nt_put_repair(const nt_report *report, const nt_report_finding *finding, nt_syntax syntax, nt_buffer *out);
void nt_put_votes(const nt_report_finding *finding, nt_buffer *out);

/* A finding as a row of four columns of Markdown. */
void nt_put_markdown_row(const nt_report *report, const nt_report_finding *finding, nt_buffer *out);

#endif
