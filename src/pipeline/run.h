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

#endif
