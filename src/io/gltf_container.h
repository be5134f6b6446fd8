/* SPDX-License-Identifier: MIT */
/*
 * What writing the buffers and moving the images of a patched document share.
 */
#ifndef NT_IO_GLTF_CONTAINER_H
#define NT_IO_GLTF_CONTAINER_H

#include "io/gltf_patch.h"
#include "io/gltf_relocate.h"

typedef struct nt_gltf_container {
	nt_gltf_patcher *patcher;
	nt_gltf *document;
	nt_json *json;
	const nt_write_options *options;
	nt_output *output;
	nt_error *error;
	nt_arena arena;
	bool to_glb, same_container, embed;
	const char *link_prefix; /* from the output's folder to the input's, percent-encoded; "" */
	uint32_t *embedded;      /* [embedded_count] buffers whose data URIs are made when the text is written */
	size_t embedded_count;
	uint64_t mark_number;    /* gltf_embed.c */
	nt_file *images;         /* files that were read and are still to be written */
	size_t image_count, image_capacity;
} nt_gltf_container;

/* The way from the folder of one file to the folder of another as a URI: "../other/"; "" where they are
 * the same or cannot be found. "-" is a file of the current folder. */
nt_status nt_gltf_link_prefix(nt_arena *arena, const char *from, const char *to, const char **prefix,
	nt_error *error);

/* The text of an external reference: neither a data URI nor anything else than a string. NULL: none. */
const char *nt_gltf_external_uri(const nt_json_value *object, size_t *length);

/* Puts the prefix before the uri of a buffer or an image. */
nt_status nt_gltf_link(nt_gltf_container *container, nt_json_value *object);

/* Links, embeds or copies the document's images, as the options say. Before nt_layout_finish(). */
nt_status nt_gltf_move_images(nt_gltf_container *container);

/*
 * Buffers in the text: nt_gltf_embed() gives a buffer a uri without its data; nt_gltf_embedding_text() is the whole
 * document's text then, whose length with all the data is *length; nt_gltf_write_text() writes it and encodes the
 * buffers where they belong, so that no more of them than a few thousand bytes is in memory.
 */
nt_status nt_gltf_embed(nt_gltf_container *container, uint32_t buffer);
nt_status nt_gltf_embedding_text(nt_gltf_container *container, nt_buffer *text, uint64_t *length);
nt_status nt_gltf_write_text(nt_gltf_container *container, const nt_buffer *text, nt_sink *sink);

/* What the images option means for this output. */
nt_images nt_gltf_images_choice(const nt_write_options *options, bool same_container);

#endif
