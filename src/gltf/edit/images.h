/* SPDX-License-Identifier: MIT */
/*
 * Images of a patched document: see images.c.
 */
#ifndef NT_GLTF_EDIT_IMAGES_H
#define NT_GLTF_EDIT_IMAGES_H

#include "gltf/edit/write.h"

/* What the images option means for this output. */
nt_images nt_gltf_images_choice(const nt_write_options *options, bool same_container);

/* The text of an external reference: neither a data URI nor anything else than a string. NULL: none. */
const char *nt_gltf_external_uri(const nt_json_value *object, size_t *length);

/* The way from the folder of one file to the folder of another as a URI: "../other/"; "" where they are
 * the same or cannot be found. "-" is a file of the current folder. */
nt_status nt_gltf_link_prefix(nt_arena *arena, const char *from, const char *to, const char **prefix,
	nt_error *error);

/* Puts the prefix before the uri of a buffer or an image. */
nt_status nt_gltf_link(nt_gltf_container *container, nt_json_value *object);

/* Links, embeds or copies the document's images, as the options say. Before nt_layout_finish(). */
nt_status nt_gltf_move_images(nt_gltf_container *container);

#endif
