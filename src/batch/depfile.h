/* SPDX-License-Identifier: MIT */
/*
 * Depfiles: rules that tell make and Ninja which files an output was made of.
 */
#ifndef NT_BATCH_DEPFILE_H
#define NT_BATCH_DEPFILE_H

#include "base/text.h"
#include "file/input.h"

/* The text of a depfile; zeroed: no rules yet. */
typedef struct nt_depfile {
	nt_buffer text;
	nt_buffer current; /* the current folder */
} nt_depfile;

/*
 * Appends a rule: the output depends on everything in the trace that was read, and on the folders in which something
 * was looked for in vain, unless the run wrote to them: whatever arrives there changes their times. Files below the
 * current folder are named from there on if the output is. A dependency that is not the input gets a rule without
 * files, so that make goes on when it is gone.
 *
 * Returns NT_OK; NT_ERROR_UNSUPPORTED where a name has a line feed, for which neither has a spelling; NT_ERROR_IO or
 * NT_ERROR_MEMORY.
 */
nt_status nt_depfile_add(nt_depfile *depfile, const char *output, const nt_trace *trace, nt_error *error);

/* Writes the file whole or not at all, and not over one of the inputs. */
nt_status nt_depfile_write(const nt_depfile *depfile, const char *path, const char *const *inputs, size_t input_count,
	nt_error *error);

void nt_depfile_free(nt_depfile *depfile);

#endif
