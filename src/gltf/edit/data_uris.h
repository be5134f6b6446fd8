/* SPDX-License-Identifier: MIT */
/*
 * Buffers in the text of a document: see data_uris.c. No more of them than a few thousand bytes is in memory.
 */
#ifndef NT_GLTF_EDIT_DATA_URIS_H
#define NT_GLTF_EDIT_DATA_URIS_H

#include "gltf/bytes/relocate.h"

/* Zeroed but for the buffers they take their data from; the list is malloc'ed. */
typedef struct nt_data_uris {
	const nt_relocated *relocated;
	uint32_t *buffers; /* [count] ascending */
	size_t count, capacity;
} nt_data_uris;

/* Gives a buffer a uri, without its data; buffers come in their order. */
nt_status nt_data_uris_add(nt_data_uris *uris, uint32_t buffer, nt_error *error);

/* The length of the document's text with the data. */
nt_status nt_data_uris_measure(const nt_data_uris *uris, uint64_t *length, nt_error *error);

/* Writes that text. */
nt_status nt_data_uris_write(const nt_data_uris *uris, nt_sink *sink, nt_error *error);

#endif
