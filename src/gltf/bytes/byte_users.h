/* SPDX-License-Identifier: MIT */
/*
 * Users of bytes: see byte_users.c.
 */
#ifndef NT_GLTF_BYTES_BYTE_USERS_H
#define NT_GLTF_BYTES_BYTE_USERS_H

#include "gltf/vertex_pools.h"

/* Bytes of a source buffer that something in the document refers to. */
typedef struct nt_byte_user {
	uint64_t begin, end;
	uint64_t reach;    /* largest end of this and what is below it in the tree (byte_users.c) */
	uint32_t buffer;
	uint32_t accessor; /* `same`; NT_NONE: an image, an extension, or an unknown user */
} nt_byte_user;

/* Bytes that get new values: `width` of them from `begin` on, every `stride` bytes. */
typedef struct nt_byte_rows {
	uint64_t begin;
	uint32_t stride, width;
} nt_byte_rows;

typedef struct nt_byte_users {
	const nt_gltf *document;
	nt_byte_user *list; /* sorted by buffer and begin; malloc'ed */
	size_t count, capacity;
	bool unknown;       /* nothing that we know uses one of the views */
} nt_byte_users;

/* Faulty parts of the document are passed over. False: out of memory. */
bool nt_byte_users_find(nt_byte_users *users, nt_gltf *document);

/* Whether something other than the accessors whose owner is `own` refers to bytes of [begin, end). rows: [row_count] if
 * nothing else of these bytes changes: an accessor that no edit touches may lie beside them. */
bool nt_byte_users_foreign(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end,
	const uint32_t *owners, uint32_t own, const nt_byte_rows *rows, size_t row_count);

/* Whether something other than one accessor does. */
bool nt_byte_users_other(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end,
	uint32_t accessor);

/* How many things refer to bytes of [begin, end). */
size_t nt_byte_users_count(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end);

#endif
