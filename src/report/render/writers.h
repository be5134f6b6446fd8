/* SPDX-License-Identifier: MIT */
/*
 * The writers of reports, for the table in render.c. Each appends its document to a buffer, whose failed flag
 * tells of exhausted memory.
 */
#ifndef NT_REPORT_RENDER_WRITERS_H
#define NT_REPORT_RENDER_WRITERS_H

#include "report/render/words.h"

void nt_write_text(const nt_report_list *reports, nt_buffer *out);
void nt_write_json(const nt_report_list *reports, nt_buffer *out);
void nt_write_sarif(const nt_report_list *reports, nt_buffer *out);
void nt_write_junit(const nt_report_list *reports, nt_buffer *out);
void nt_write_csv(const nt_report_list *reports, nt_buffer *out);
void nt_write_markdown(const nt_report_list *reports, nt_buffer *out);
void nt_write_html(const nt_report_list *reports, nt_buffer *out);
void nt_write_lines(const nt_report_list *reports, nt_buffer *out);
void nt_write_github(const nt_report_list *reports, nt_buffer *out);

/* The HTML page that lists files by the rows that nt_report_index_row() made. */
void nt_write_html_index(const nt_buffer *rows, nt_buffer *out);

/* page_assets.c: what goes into an HTML page. The inside of page.html's body; the scripts in order. */
extern const char nt_page_style[], nt_page_body[], nt_page_script[];

/* For other writers of Markdown: a text without markup, and a finding as a row of four columns. */
void nt_markdown_text(const char *text, nt_buffer *out);
void nt_markdown_finding(const nt_report *report, const nt_report_finding *finding, nt_buffer *out);

#endif
