/* SPDX-License-Identifier: MIT */
/*
 * Reports to files and folders, and the baseline from a file.
 */
#ifndef NT_PIPELINE_REPORT_FILE_H
#define NT_PIPELINE_REPORT_FILE_H

#include "base/hash_index.h"
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
	bool folder;               /* path is one, for a page of each input and an index */
	const nt_report_diff *diff; /* written in place of the reports; NULL: they are */
} nt_report_target;

/* Writes one document about all reports: whole or not at all. NULLs among the reports are passed over. Returns
 * NT_OK, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_report_to_file(nt_report *const *reports, size_t count, const nt_report_target *target,
	nt_error *error);

/* Reads the findings of a JSON report. The error names the report. */
nt_status nt_baseline_open(nt_baseline *baseline, const char *path, nt_error *error);

/* ---- a folder ---- */

/*
 * A report as a folder: a page of each input, and index.html, which lists them. Shared files are written first, each
 * page when its input is done, and the index at the end, so that no file refers to one that is not there yet. Memory
 * holds one row of the index for each page.
 */
typedef struct nt_report_folder {
	const nt_report_target *target;
	char **pages;   /* [target->input_count] file names in the folder */
	nt_key_set inputs; /* nt_file_id of those that are there */
	nt_buffer rows; /* of the index */
} nt_report_folder;

/*
 * Names the page of each input of the target, which must outlive the folder, makes the folder target->path where it
 * is missing (not its parents), and writes the parts that its pages share, where they are missing. A page is named
 * after the last part of its input's name: what is not a letter, a digit or one of ".-_" becomes "_"; where two would
 * have the same name, but for the case of letters, the later one has a hash of its input's path too.
 *
 * Returns NT_OK, NT_ERROR_IO, also where a file would replace what nmtan did not make, or an input, or NT_ERROR_MEMORY.
 * The folder is to be freed after failure too.
 */
nt_status nt_report_folder_begin(nt_report_folder *folder, const nt_report_target *target, nt_error *error);

/* Writes the page of an input, and notes its row for the index. Statuses as above; errors name the page. */
nt_status nt_report_folder_add(nt_report_folder *folder, size_t input, nt_report *report, nt_error *error);

/* Writes the index of the pages so far. */
nt_status nt_report_folder_end(nt_report_folder *folder, nt_error *error);

void nt_report_folder_free(nt_report_folder *folder);

#endif
