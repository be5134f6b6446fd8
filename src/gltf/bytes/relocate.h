/* SPDX-License-Identifier: MIT */
/*
 * Moving offsets, writing buffers and the document: see relocate.c and write.c.
 */
#ifndef NT_GLTF_BYTES_RELOCATE_H
#define NT_GLTF_BYTES_RELOCATE_H

#include "file/base64.h"
#include "gltf/bytes/buffer_edits.h"

/* A buffer as it will be. */
typedef struct nt_relocated_buffer {
	const nt_edited_buffer *from; /* its edits are in order */
	int64_t *shifts;              /* [edit_count] how far everything behind an edit moves */
	size_t *near;                 /* the first edit behind the last position that was mapped */
	uint64_t *offsets;            /* [addition_count] in the new buffer */
	uint64_t length;
} nt_relocated_buffer;

/* The buffers of a document after all edits. It lives as long as those. */
typedef struct nt_relocated {
	nt_gltf *document;
	nt_relocated_buffer *buffers; /* [buffer_count] */
	size_t buffer_count;
} nt_relocated;

/* Moves all offsets in the JSON and sets all lengths. Afterwards nothing may be edited any more. */
nt_status nt_gltf_relocate(nt_buffer_edits *edits, nt_relocated *result, nt_error *error);

/* Writes the bytes of a buffer. `input` is the document's own file. */
nt_status nt_relocated_write(const nt_relocated *relocated, uint32_t buffer, const nt_file *input, nt_sink *sink,
	nt_error *error);

/* The same as base64, without the last group's padding. */
nt_status nt_relocated_encode(const nt_relocated *relocated, uint32_t buffer, nt_base64 *base64, nt_error *error);

/* write.c. Writes the input as it is where that is what the output should be; *written tells. */
nt_status nt_gltf_copy_unchanged(nt_scene *scene, const nt_write_options *options,
	nt_output *output, bool *written, nt_error *error);

/* write.c. Ends the edits and writes the document with its buffers and images. */
nt_status nt_gltf_write_document(nt_scene *scene, nt_buffer_edits *edits, const nt_write_options *options,
	nt_output *output, nt_error *error);

#endif
