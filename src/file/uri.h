/* SPDX-License-Identifier: MIT */
/*
 * URIs as glTF uses them: data URIs and names of files beside the document.
 */
#ifndef NT_FILE_URI_H
#define NT_FILE_URI_H

#include "base/memory.h"
#include "base/text.h"

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
