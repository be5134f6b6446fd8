/* SPDX-License-Identifier: MIT */
/*
 * Data URIs that are encoded while the text is written: see gltf_embed.c.
 */
#ifndef NT_IO_GLTF_EMBED_H
#define NT_IO_GLTF_EMBED_H

#include "io/gltf_container.h"

/*
 * Buffers in the text: nt_gltf_embed() gives a buffer a uri without its data; nt_gltf_embedding_text() is the whole
 * document's text then, whose length with all the data is *length; nt_gltf_write_text() writes it and encodes the
 * buffers where they belong, so that no more of them than a few thousand bytes is in memory.
 */
nt_status nt_gltf_embed(nt_gltf_container *container, uint32_t buffer);
nt_status nt_gltf_embedding_text(nt_gltf_container *container, nt_buffer *text, uint64_t *length);
nt_status nt_gltf_write_text(nt_gltf_container *container, const nt_buffer *text, nt_sink *sink);

#endif
