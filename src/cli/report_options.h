/* SPDX-License-Identifier: MIT */
/*
 * Meaning of --report and the options beside it: words to the options of a report, and where it goes.
 */
#ifndef NT_CLI_REPORT_OPTIONS_H
#define NT_CLI_REPORT_OPTIONS_H

#include "cli/options.h"
#include "pipeline/run.h"

/* The report of a command. */
typedef struct nt_report_plan {
	bool wanted;
	nt_report_options options;
	nt_baseline baseline;
	nt_shown_paths paths;    /* how reports name files */
	nt_buffer conversion;    /* options of the conversion that --check judges */
	nt_buffer given;         /* those of a command that repairs something */
	nt_buffer folder;        /* where a page will be, absolute */
	nt_report_target target; /* its path is NULL where nothing is written */
} nt_report_plan;

/* Reads --ignore, --severity, --min-severity, --max-issues, --path-prefix, --baseline, --report and --report-format.
 * With --check there is always a report; without --report its text goes to standard output. With --fail-on there is
 * one to judge by. Returns NT_OK, NT_ERROR_USAGE, or what reading the baseline returned. The plan is to be freed
 * either way. */
nt_status nt_report_plan_make(nt_report_plan *plan, const nt_command *command, bool colour,
	nt_error *error);
void nt_report_plan_free(nt_report_plan *plan);

#endif
