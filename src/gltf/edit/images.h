/* SPDX-License-Identifier: MIT */
/*
 * Images of an edited document: see images.c.
 */
#ifndef NT_GLTF_EDIT_IMAGES_H
#define NT_GLTF_EDIT_IMAGES_H

#include "file/output.h"
#include "gltf/edit/buffer_edits.h"

/* Where an edited document goes. */
typedef struct nt_gltf_output {
	const nt_write_options *options;
	nt_output *set;          /* of files */
	const char *link_prefix; /* from the output's folder to the input's, percent-encoded; "" */
} nt_gltf_output;

/* Files that were read and are still to be written. */
typedef struct nt_open_images {
	nt_file *files; /* [count] */
	size_t count, capacity;
} nt_open_images;

/* What the images option means for this output of a document. */
nt_images nt_gltf_images_choice(const nt_write_options *options, const nt_gltf *document);

/* Links, embeds or copies the document's images, as the options say. images: empty; what is open in it must
 * stay so while the edits live. */
nt_status nt_gltf_move_images(nt_scene *scene, nt_buffer_edits *edits, const nt_gltf_output *output,
	nt_open_images *images, nt_error *error);

void nt_open_images_close(nt_open_images *images);

#endif
