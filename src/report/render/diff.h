/* SPDX-License-Identifier: MIT */
/*
 * The difference of two reports as text, JSON, Markdown and HTML.
 */
#ifndef NT_REPORT_RENDER_DIFF_H
#define NT_REPORT_RENDER_DIFF_H

#include "report/render/compare.h"
#include "report/render/render.h"

/* Whether there is a writer for it: NT_REPORT_TEXT, NT_REPORT_JSON, NT_REPORT_MARKDOWN and NT_REPORT_HTML have one. */
bool nt_diff_has_format(nt_report_format format);

/* Writes a difference as one document, in a format that has a writer; otherwise like nt_report_write(). For HTML it was
 * made with exchanged tangents. */
nt_status nt_diff_write(const nt_report_diff *diff, nt_report_format format, nt_report_sink sink, void *user,
	nt_error *error);

#endif
