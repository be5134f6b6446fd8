/* SPDX-License-Identifier: MIT */
/*
 * External files of a document, named from another folder: see links.c.
 */
#ifndef NT_GLTF_EDIT_LINKS_H
#define NT_GLTF_EDIT_LINKS_H

#include "base/memory.h"
#include "json/json.h"

/* The text of an external reference: neither a data URI nor anything else than a string. NULL: none. */
const char *nt_gltf_external_uri(const nt_json_value *object, size_t *length);

/* The way from the folder of one file to the folder of another as a URI: "../other/"; "" where they are
 * the same or cannot be found. "-" is a file of the current folder. */
nt_status nt_gltf_link_prefix(nt_arena *arena, const char *from, const char *to, const char **prefix,
	nt_error *error);

/* Puts the prefix before the uri of a buffer or an image, where that is relative. */
nt_status nt_gltf_link(nt_json *json, nt_json_value *object, const char *prefix, nt_error *error);

#endif
