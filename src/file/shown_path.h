/* SPDX-License-Identifier: MIT */
/*
 * Names of files as reports show them: relative to the folder of the run where all inputs are below it, else to the
 * folder that the inputs have in common, so that no two files have one name and none tells of the machine. Works on
 * text, as names are spelled.
 */
#ifndef NT_FILE_SHOWN_PATH_H
#define NT_FILE_SHOWN_PATH_H

#include "base/buffer.h"

typedef struct nt_shown_paths {
	nt_buffer current; /* the folder of the run, absolute */
	nt_buffer base;    /* to which names are relative, absolute */
	const char *prefix; /* stands before what is shown; NULL: nothing. Not owned */
} nt_shown_paths;

/* Finds the folder. "-" has no say in it. Returns NT_OK, NT_ERROR_MISSING or NT_ERROR_IO where the current folder has
 * no name, or NT_ERROR_MEMORY. To be freed after failure too. */
nt_status nt_shown_paths_begin(nt_shown_paths *paths, const char *const *inputs, size_t count, const char *prefix,
	nt_error *error);

/* Appends how a path is shown: "-" as it is, a file that is not below the folder by its last part. With `paths` NULL
 * as it is spelled. */
void nt_shown_path(const nt_shown_paths *paths, const char *path, nt_buffer *out);

/* Appends a path that opens the file from the folder of the run, as compilers and editors do: relative if it is below,
 * else as it is spelled. With a prefix the same as nt_shown_path(). */
void nt_opened_path(const nt_shown_paths *paths, const char *path, nt_buffer *out);

void nt_shown_paths_free(nt_shown_paths *paths);

#endif
