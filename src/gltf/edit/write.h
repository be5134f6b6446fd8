/* SPDX-License-Identifier: MIT */
/*
 * Writing an edited document: see write.c.
 */
#ifndef NT_GLTF_EDIT_WRITE_H
#define NT_GLTF_EDIT_WRITE_H

#include "file/output.h"
#include "gltf/edit/buffer_edits.h"

/* Writes the input as it is where that is what the output should be; *written tells. */
nt_status nt_gltf_copy_unchanged(nt_scene *scene, const nt_write_options *options,
	nt_output *output, bool *written, nt_error *error);

/* Ends the edits and writes the document with its buffers and images. */
nt_status nt_gltf_write_document(nt_scene *scene, nt_buffer_edits *edits, const nt_write_options *options,
	nt_output *output, nt_error *error);

#endif
