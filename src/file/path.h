/* SPDX-License-Identifier: MIT */
/*
 * Names of files. Paths: folders and last parts, a path taken from another, what links make of it, and how reports show
 * it. A path is joined and compared as it is spelled, so that it keeps the links that it goes through; nt_path_real(),
 * nt_link_folder() and what stands on them ask the system, and note what links decide (nt_trace_note()). Behind them
 * are URIs as glTF uses them.
 */
#ifndef NT_FILE_PATH_H
#define NT_FILE_PATH_H

#include <limits.h>
#include <stdbool.h>
#include "base/memory.h"
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

/* ---- URIs: data URIs, and names of files beside the document ---- */

/* Whether a URI carries its data. */
bool nt_uri_is_data(const char *uri, size_t length);

/*
 * Decodes a data URI of any media type, base64 or percent-encoded.
 *
 *   bytes  receives a malloc'ed block, never NULL on success
 *   size   receives its size
 *
 * Returns NT_OK, NT_ERROR_INPUT (the message names the position in the URI) or
 * NT_ERROR_MEMORY.
 */
nt_status nt_uri_decode_data(const char *uri, size_t length, unsigned char **bytes, size_t *size,
	nt_error *error);

/*
 * Finds the file that a relative URI names.
 *
 *   document       path of the file the URI stands in; "-": the current folder
 *   uri, length    as in the document, percent-encoded
 *   allow_outside  the file may lie outside the document's folder, by "..", as an absolute path or
 *                  through a symbolic link; otherwise that is refused
 *   path           receives the path, in the arena
 *
 * Schemes, NULs and empty names are always refused. Returns NT_OK, NT_ERROR_INPUT,
 * NT_ERROR_UNSUPPORTED (a scheme), NT_ERROR_IO (no such file) or NT_ERROR_MEMORY; the message
 * names the URI.
 */
nt_status nt_uri_resolve(nt_arena *arena, const char *document, const char *uri, size_t length,
	bool allow_outside, const char **path, nt_error *error);

/* Whether a decoded name has a step "..", with "/" or "\\". */
bool nt_uri_has_parent_step(const char *name);

/* Appends the path that a relative URI without a scheme spells. */
void nt_uri_append_decoded(nt_buffer *text, const char *uri, size_t length);

/* Appends the name of the file that a URI names beside the document. False: it names something else, in another folder
 * or with a scheme, or memory is exhausted. */
bool nt_uri_append_name(nt_buffer *name, const char *uri, size_t length);

/* Appends a path as a URI: everything but letters, digits and "-._~/" is percent-encoded. */
void nt_uri_append_path(nt_buffer *buffer, const char *path);

/* Appends the URI by which a document in `folder` reaches `path`; both absolute and resolved. */
void nt_link_uri(nt_buffer *text, const char *folder, const char *path);

/* Appends "data:<media_type>;base64," and the data. */
void nt_uri_append_data(nt_buffer *buffer, const char *media_type, const void *bytes, size_t size);

#endif
