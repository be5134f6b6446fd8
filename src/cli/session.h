/* SPDX-License-Identifier: MIT */
/*
 * A session: the jobs of one command run, messages and reports are written, and the exit code follows.
 */
#ifndef NT_CLI_SESSION_H
#define NT_CLI_SESSION_H

#include "cli/messages.h"
#include "cli/options.h"
#include "cli/report_options.h"

/* Runs the jobs and says what became of them. folder: of reports; NULL: they are one file, or none. Returns the exit
 * code. */
int nt_session_run(const nt_command *command, nt_style style, const nt_report_plan *plan, nt_batch *batch,
	nt_report_folder *folder);

/* Says which outputs are left of inputs that are gone, where none is there any more. */
void nt_session_tell_left_over(const nt_command *command, nt_style style, const nt_report_plan *plan);

/* In a signal handler: says how far a run of many jobs came. */
void nt_session_tell_interrupted(void);

/* Ends the process where memory is exhausted in a place that cannot fail. */
void nt_session_end_exhausted(void);

#endif
