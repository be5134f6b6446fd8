/* SPDX-License-Identifier: MIT */
/*
 * Data URIs that are encoded while the text is written: see data_uris.c.
 */
#ifndef NT_GLTF_EDIT_DATA_URIS_H
#define NT_GLTF_EDIT_DATA_URIS_H

#include "gltf/edit/write.h"

/*
 * Buffers in the text: nt_gltf_embed() gives a buffer a uri without its data; nt_gltf_embedding_text() is the whole
 * document's text then, whose length with all the data is *length; nt_gltf_write_text() writes it and encodes the
 * buffers where they belong, so that no more of them than a few thousand bytes is in memory.
 */
nt_status nt_gltf_embed(nt_gltf_container *container, uint32_t buffer);
nt_status nt_gltf_embedding_text(nt_gltf_container *container, nt_buffer *text, uint64_t *length);
nt_status nt_gltf_write_text(nt_gltf_container *container, const nt_buffer *text, nt_sink *sink);

#endif
