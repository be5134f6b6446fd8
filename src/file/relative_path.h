/* SPDX-License-Identifier: MIT */
/*
 * Names of files as documents spell them: from a source that refers to a file, and as a relative,
 * percent-encoded URI in an output. The first three ask the system, and note what links decide (trace.h).
 */
#ifndef NT_FILE_RELATIVE_PATH_H
#define NT_FILE_RELATIVE_PATH_H

#include <stdbool.h>
#include "base/buffer.h"

/* Appends what realpath() says. Returns NT_OK or what nt_lookup_failed() does, or NT_ERROR_MEMORY. */
nt_status nt_path_real(nt_buffer *text, const char *path, nt_error *error);

/* Appends the absolute path of the folder that contains `path` (links resolved, no final slash but for
 * the root). Folders that are not there are named as they are spelled. Returns NT_OK, NT_ERROR_MISSING where `path`
 * cannot come to be, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_link_folder(nt_buffer *text, const char *path, nt_error *error);

/* Whether `name`, taken from `folder` (absolute and real), stays below it through all links. It follows the path link
 * by link and never touches anything outside, so an attacker cannot probe for files. Returns NT_OK or NT_ERROR_MEMORY.
 */
nt_status nt_path_stays_inside(const char *folder, const char *name, bool *inside, nt_error *error);

/* Appends `name` taken from `folder` (absolute), with "\" as "/", and "." and ".." resolved. */
void nt_link_join(nt_buffer *text, const char *folder, const char *name);

/* The same with names of this system, in which "\" is a character like others. */
void nt_path_join(nt_buffer *text, const char *folder, const char *name);

/* Appends the absolute path of a name of this system, "." and ".." resolved as they are spelled. Returns NT_OK,
 * NT_ERROR_MISSING or NT_ERROR_IO where the current folder has no name, or NT_ERROR_MEMORY. */
nt_status nt_path_absolute(nt_buffer *text, const char *name, nt_error *error);

/* Whether a name is a path of its own or a URL: "/x", "\\host\x", "C:\x", "http://x". */
bool nt_link_is_absolute(const char *name);

/* Whether an absolute, resolved path is below an absolute folder. */
bool nt_link_is_inside(const char *path, const char *folder);

/* Behind the last "/" of a path. */
const char *nt_last_part(const char *path);

#endif
