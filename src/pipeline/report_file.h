/* SPDX-License-Identifier: MIT */
/*
 * Reports to files, and the baseline from one.
 */
#ifndef NT_PIPELINE_REPORT_FILE_H
#define NT_PIPELINE_REPORT_FILE_H

#include "report/baseline.h"
#include "report/render/render.h"

/* The target of a report. */
typedef struct nt_report_target {
	const char *path;        /* "-" is standard output */
	nt_report_format format;
	nt_report_style style;
	bool no_clobber;
	const char *const *inputs; /* [input_count] files that must not be replaced */
	size_t input_count;
	bool folder;               /* path is one, for a page of each input and an index: see report_folder.h */
	const nt_report_diff *diff; /* written in place of the reports; NULL: they are */
	const nt_buffer *rows;      /* the same: those of a folder's index */
	const char *text;           /* the same: as it is */
} nt_report_target;

/* Writes one document about all reports: whole or not at all. NULLs among the reports are passed over. Returns
 * NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_report_to_file(nt_report *const *reports, size_t count, const nt_report_target *target,
	nt_error *error);

/* Reads the findings of a JSON report. The error names the report. */
nt_status nt_baseline_open(nt_baseline *baseline, const char *path, nt_error *error);

#endif
