/* SPDX-License-Identifier: MIT */
/*
 * Reports as text and files. All formats come from the same data; each is deterministic: no time, no
 * absolute path, no order that depends on threads.
 */
#ifndef NT_REPORT_RENDER_RENDER_H
#define NT_REPORT_RENDER_RENDER_H

#include "report/render/words.h"

typedef enum nt_report_format {
	NT_REPORT_TEXT,     /* for people */
	NT_REPORT_JSON,     /* everything; data/nmtan-report.schema.json */
	NT_REPORT_SARIF,    /* 2.1.0, for code scanning */
	NT_REPORT_JUNIT,    /* XML, for test dashboards */
	NT_REPORT_CSV,      /* a row per finding */
	NT_REPORT_MARKDOWN, /* for comments on pull requests */
	NT_REPORT_HTML,     /* one page with UV layouts and the meshes in space */
	NT_REPORT_LINES,    /* a line per finding, as compilers print */
	NT_REPORT_GITHUB,   /* the same as commands of GitHub's workflows */
	NT_REPORT_FORMAT_COUNT
} nt_report_format;

/* The format that a file name's extension means; false when it is none of them. */
bool nt_report_format_of_path(const char *path, nt_report_format *format);

/*
 * Writes reports, one for each input, as one document. style may be NULL.
 *
 * Returns NT_OK, NT_ERROR_MEMORY, or what the sink returned.
 */
nt_status nt_report_write(const nt_report *const *reports, size_t count, nt_report_format format,
	const nt_report_style *style, nt_report_sink sink, void *user, nt_error *error);

/* A mark that tells an HTML report from other files: it is in the first 1000 bytes. */
extern const char nt_html_mark[];

/* Shared parts of a folder's pages, a file each beside them. */
typedef enum nt_html_part_kind { NT_HTML_STYLE, NT_HTML_SCRIPT, NT_HTML_PART_COUNT } nt_html_part_kind;

/* The text of a part. Appends the name of its file, which depends on the text: a page has the parts that it was made
 * for, whatever other versions put beside them. */
const char *nt_html_part(nt_html_part_kind kind, nt_buffer *name);

/* Appends the row of a report in an HTML index of many pages: its counts, the codes that it has and a thumbnail of its
 * first layout. `page` is the report's own page, as a URI. */
void nt_report_index_row(const nt_report *report, const char *page, nt_buffer *rows);

/* Writes the index whose rows were made by nt_report_index_row(). Statuses as above. */
nt_status nt_report_write_index(const nt_buffer *rows, nt_report_sink sink, void *user, nt_error *error);

#endif
