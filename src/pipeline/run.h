/* SPDX-License-Identifier: MIT */
/*
 * One input from file to file: read, select, load, make normals, solve, split, write. The entry point for any front
 * end; nothing here prints or exits.
 */
#ifndef NT_PIPELINE_RUN_H
#define NT_PIPELINE_RUN_H

#include "pipeline/settings.h"

/*
 * Runs one input.
 *
 *   input     path, or "-" for standard input
 *   output    path, or "-" for standard output; with settings->check where it would be, NULL: nowhere in particular
 *   settings  required
 *   summary   required; freed by nt_summary_free, after failure too
 *   error     required
 *
 * Returns any status.
 */
nt_status nt_run(const char *input, const char *output, const nt_settings *settings,
	nt_summary *summary, nt_error *error);

void nt_summary_free(nt_summary *summary);

/* How a stage is called: "tangents". */
const char *nt_stage_name(nt_stage stage);

/* Makes SIGINT, SIGTERM and SIGHUP remove the temporary files of all runs and call `tell` (NULL: nothing), in the
 * handler, before they end the process, and turns SIGPIPE into a write error. Called once, before the first run, by a
 * front end that is the whole process. */
void nt_run_catch_signals(void (*tell)(void));

/* The same where a C++ library would end the process for want of memory: `end` is called then, which must not
 * return. */
void nt_run_catch_exhaustion(void (*end)(void));

/* See nt_output_catch_faults(). */
void nt_run_catch_faults(void (*end)(const char *path, const char *change));

#endif
