/* SPDX-License-Identifier: MIT */
/*
 * Buffers in the text of a document: see data_uris.c. No more of them than a few thousand bytes is in memory.
 */
#ifndef NT_GLTF_EDIT_DATA_URIS_H
#define NT_GLTF_EDIT_DATA_URIS_H

#include "gltf/bytes/relocate.h"

typedef struct nt_data_uri {
	uint32_t buffer;
	size_t at; /* where its data belongs in the text */
} nt_data_uri;

/* Zeroed but for the buffers they take their data from; the list is malloc'ed. */
typedef struct nt_data_uris {
	const nt_relocated *relocated;
	nt_data_uri *buffers; /* [count] ascending */
	size_t count, capacity;
} nt_data_uris;

/* Gives a buffer a uri, without its data; buffers come in their order. */
nt_status nt_data_uris_add(nt_data_uris *uris, uint32_t buffer, nt_error *error);

/* The document's text without the data, empty where no buffer has such, and its length with it. Anew after each change
 * of the document. */
nt_status nt_data_uris_text(nt_data_uris *uris, nt_buffer *text, uint64_t *length, nt_error *error);

/* Writes that text with the data. */
nt_status nt_data_uris_write(const nt_data_uris *uris, const nt_buffer *text, nt_sink *sink, nt_error *error);

#endif
