/* SPDX-License-Identifier: MIT */
/*
 * Failures of a run of many, grouped by reason: ten thousand files that fail for one reason are one line.
 */
#ifndef NT_CLI_FAILURES_H
#define NT_CLI_FAILURES_H

#include "batch/batch.h"

/* So many reasons have a line, and so many inputs of each a name. */
enum { NT_FAILURE_GROUPS = 10, NT_FAILURE_NAMES = 3 };

typedef struct nt_failure_group {
	char *reason;
	char *names[NT_FAILURE_NAMES];
	size_t count;
} nt_failure_group;

/* Zeroed: nothing failed. */
typedef struct nt_failures {
	nt_failure_group groups[NT_FAILURE_GROUPS];
	size_t group_count, count;
} nt_failures;

/* Counts a job that failed. A reason that finds no memory counts as a further reason. */
void nt_failures_add(nt_failures *failures, const nt_job *job);

/* Appends a line for each reason, and one for those that have none; `manifest`: the file that has them all, or NULL. */
void nt_failures_append(nt_buffer *out, const nt_failures *failures, const char *manifest);

void nt_failures_free(nt_failures *failures);

#endif
