/* SPDX-License-Identifier: MIT */
/*
 * The manifest: what became of each input, for other programs. JSON lines, one for each input, written when it ends;
 * the schema is data/nmtan-manifest.schema.json.
 */
#ifndef NT_CLI_MANIFEST_H
#define NT_CLI_MANIFEST_H

#include "batch/batch.h"

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
