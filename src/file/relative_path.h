/* SPDX-License-Identifier: MIT */
/*
 * Names of files as documents spell them: from a source that refers to a file, and as a relative,
 * percent-encoded URI in an output. Everything works on text, but for nt_link_folder().
 */
#ifndef NT_FILE_RELATIVE_PATH_H
#define NT_FILE_RELATIVE_PATH_H

#include <stdbool.h>
#include "base/buffer.h"

/* Appends the absolute path of the folder that contains `path` (links resolved, no final slash but for
 * the root). Folders that are not there are named as they are spelled. Returns NT_OK, NT_ERROR_MISSING where `path`
 * cannot come to be, NT_ERROR_IO or NT_ERROR_MEMORY. */
nt_status nt_link_folder(nt_buffer *text, const char *path, nt_error *error);

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

/* Appends the URI by which a document in `folder` reaches `path`; both absolute and resolved. */
void nt_link_uri(nt_buffer *text, const char *folder, const char *path);

#endif
