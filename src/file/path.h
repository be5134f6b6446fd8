/* SPDX-License-Identifier: MIT */
/*
 * Paths: folders and last parts, a path taken from another, what links make of it, and how reports show it. A path is
 * joined and compared as it is spelled, so that it keeps the links that it goes through; nt_path_real(),
 * nt_link_folder() and what stands on them ask the system, and note what links decide (trace.h).
 */
#ifndef NT_FILE_PATH_H
#define NT_FILE_PATH_H

#include <limits.h>
#include <stdbool.h>
#include "base/text.h"

/* ---- as it is spelled ---- */

/* Behind the last "/" of a path, and how many bytes are before that. */
const char *nt_last_part(const char *path);
size_t nt_folder_length(const char *path);

/* The folder of a path, without its final slash; "." if it names none. "" is the answer for a path that is too long
 * for the system. */
const char *nt_folder_of(const char *path, char folder[PATH_MAX]);

/* Appends a name as it is taken from the folder of a file. */
void nt_path_beside(nt_buffer *text, const char *file, const char *name);

/* Appends `name` taken from `folder` (absolute), with "." and ".." resolved. */
void nt_path_join(nt_buffer *text, const char *folder, const char *name);

/* Appends the absolute path of a name, "." and ".." resolved as they are spelled. Returns NT_OK, NT_ERROR_MISSING or
 * NT_ERROR_IO where the current folder has no name, or NT_ERROR_MEMORY. */
nt_status nt_path_absolute(nt_buffer *text, const char *name, nt_error *error);

/* Appends the way from a folder to a path, both absolute and resolved: "../b/c". */
void nt_path_relative(nt_buffer *text, const char *folder, const char *path);

/* Appends a name taken from `current` as it is named from `folder` on (both absolute), or `otherwise` if it is not
 * below that. */
void nt_path_below(nt_buffer *text, const char *current, const char *name, const char *folder, const char *otherwise);

/* Whether an absolute, resolved path is below an absolute folder. */
bool nt_link_is_inside(const char *path, const char *folder);

/* Whether a name of any system is a path of its own or a URL: "/x", "\\host\x", "C:\x",
 * "http://x". */
bool nt_link_is_absolute(const char *name);

/* ---- as links have it ---- */

/* Appends what realpath() says. Returns NT_OK or what nt_lookup_failed() does, or NT_ERROR_MEMORY. */
nt_status nt_path_real(nt_buffer *text, const char *path, nt_error *error);

/* Appends the absolute path of the folder that contains `path` (links resolved, no final slash but for the root).
 * Folders that are not there are named as they are spelled. Returns NT_OK, NT_ERROR_MISSING where `path` cannot come to
 * be, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_link_folder(nt_buffer *text, const char *path, nt_error *error);

/* The same with the last part of `path` behind it. */
nt_status nt_path_place(nt_buffer *text, const char *path, nt_error *error);

/* Whether `name`, taken from `folder` (absolute and real), stays below it through all links. It follows the path link
 * by link and never touches anything outside, so an attacker cannot probe for files. Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_path_stays_inside(const char *folder, const char *name, bool *inside, nt_error *error);

/* ---- as reports show it ---- */

/* How reports show files: relative to the folder of the run if all inputs are below it, else to the folder that the
 * inputs have in common, so that no two files have one name and none tells of the machine. */
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
