/* SPDX-License-Identifier: MIT */
/*
 * Writing a patched document: see write.c; what its buffers and its images share.
 */
#ifndef NT_GLTF_EDIT_WRITE_H
#define NT_GLTF_EDIT_WRITE_H

#include "gltf/edit/editor.h"
#include "gltf/edit/relocate.h"

typedef struct nt_gltf_container {
	nt_gltf_patcher *patcher;
	nt_gltf *document;
	nt_json *json;
	const nt_write_options *options;
	nt_output *output;
	nt_error *error;
	nt_arena arena;
	bool to_glb, same_container, embed, in_place;
	const char *link_prefix; /* from the output's folder to the input's, percent-encoded; "" */
	uint32_t *embedded;      /* [embedded_count] buffers whose data URIs are made when the text is written */
	size_t embedded_count;
	uint64_t mark_number;    /* data_uris.c */
	nt_sink *main;
	nt_sink **companions;    /* [buffer_count] the files that buffers are written to; NULL: another fate */
	nt_file *images;         /* files that were read and are still to be written */
	size_t image_count, image_capacity;
} nt_gltf_container;

/* Writes the input as it is where that is what the output should be; *written tells. */
nt_status nt_gltf_copy_unchanged(nt_scene *scene, const nt_write_options *options,
	nt_output *output, bool *written, nt_error *error);

/* Writes the document with its buffers and images. */
nt_status nt_gltf_write_container(nt_gltf_patcher *patcher, nt_output *output);

#endif
