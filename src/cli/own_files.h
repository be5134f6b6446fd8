/* SPDX-License-Identifier: MIT */
/*
 * Files that a run writes beside its outputs: a report, a manifest, a depfile, a record. None replaces another one, an
 * output, or what a run reads or writes.
 */
#ifndef NT_CLI_OWN_FILES_H
#define NT_CLI_OWN_FILES_H

#include "batch/batch.h"
#include "cli/options.h"

/* Refuses files that are named twice, also by different names. With a batch (NULL: its jobs are not known yet) it also
 * refuses one that is an output or an input of a job, has no folder, or with --no-clobber is there already. Returns
 * NT_OK, NT_ERROR_USAGE, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_own_files_check(const nt_command *command, const nt_batch *batch, bool report_is_folder, nt_error *error);

/* Refuses a file that a run has read or written. Returns NT_OK or NT_ERROR_IO. */
nt_status nt_own_file_check_trace(const char *path, const nt_trace *trace, nt_error *error);

#endif
