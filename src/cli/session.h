/* SPDX-License-Identifier: MIT */
/*
 * A session: the jobs of one command run, messages and reports are written, and the exit code follows.
 */
#ifndef NT_CLI_SESSION_H
#define NT_CLI_SESSION_H

#include "batch/batch.h"
#include "cli/messages.h"
#include "cli/options.h"

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

/* ---- the manifest: manifest.c ---- */

/* It tells other programs what became of each input: JSON lines, one for each, written when it ends; the schema is
 * data/nmtan-manifest.schema.json. */

typedef struct nt_manifest {
	const char *path;    /* "-": standard output */
	const char *options; /* what shapes outputs, in words */
	const nt_report_options *judged; /* which findings count */
	bool check;          /* nothing is written: lines count all that was judged */
	int fd;              /* below 0: not open */
	nt_buffer current;   /* the folder of the run; empty: it has no name */
	nt_buffer line;      /* what most lines take is there from the start */
	nt_error error;      /* the first that came about */
} nt_manifest;

/* Begins a file anew: an earlier manifest, or none, is there. Returns NT_OK, NT_ERROR_IO, NT_ERROR_USAGE or
 * NT_ERROR_MEMORY; close it after failure, too. */
nt_status nt_manifest_open(nt_manifest *manifest, const char *path, const char *options,
	const nt_report_options *judged, bool check, nt_error *error);

/* Appends the line of a job that has ended, in one piece. A failure is kept for nt_manifest_close(). */
void nt_manifest_add(nt_manifest *manifest, const nt_job *job, int exit_code);

/* Returns NT_OK, or what went wrong since it was opened. */
nt_status nt_manifest_close(nt_manifest *manifest, nt_error *error);

#endif
