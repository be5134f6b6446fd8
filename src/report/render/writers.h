/* SPDX-License-Identifier: MIT */
/*
 * The writers of reports, for the table in render.c, and the walk that calls them.
 */
#ifndef NT_REPORT_RENDER_WRITERS_H
#define NT_REPORT_RENDER_WRITERS_H

#include "base/hash_index.h"
#include "report/render/words.h"

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
	nt_markdown_writer, nt_html_writer, nt_lines_writer, nt_github_writer;

/* Writes reports by one of them. */
void nt_report_walk(const nt_report_writer *writer, const nt_report_list *reports, nt_buffer *out);

/* The HTML page that lists files by the rows that nt_report_index_row() made. */
void nt_write_html_index(const nt_buffer *rows, nt_buffer *out);

/* page_assets.c: what goes into an HTML page. The inside of page.html's body; the scripts in order. */
extern const char nt_page_style[], nt_page_body[], nt_page_script[];

/* For other writers of Markdown: a text without markup, and a finding as a row of four columns. */
void nt_markdown_text(const char *text, nt_buffer *out);
void nt_markdown_finding(const nt_report *report, const nt_report_finding *finding, nt_buffer *out);

#endif
