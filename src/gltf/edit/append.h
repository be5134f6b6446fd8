/* SPDX-License-Identifier: MIT */
/*
 * Vertices that splitting appended, in the accessors of a pool, and the indices that use them.
 */
#ifndef NT_GLTF_EDIT_APPEND_H
#define NT_GLTF_EDIT_APPEND_H

#include "gltf/bytes/bytes.h"
#include "gltf/document.h"
#include "gltf/edit/merge_splits.h"

/* An accessor whose values are replaced in place: elements of `width` bytes for every new vertex. Without values
 * nothing is appended to it: it will get a view of its own. */
typedef struct nt_gltf_override {
	uint32_t accessor;
	const unsigned char *values; /* as readers have them */
	const unsigned char *stored; /* before the filter of a packed view; the same where there is none */
	uint32_t width;
} nt_gltf_override;

typedef struct nt_override_list {
	nt_gltf_override *items; /* [count], malloc'ed */
	size_t count, capacity;
} nt_override_list;

/* False: out of memory. */
bool nt_override_add(nt_override_list *list, nt_gltf_override override);

/* An accessor to which vertices are appended, or that may lie between values that are replaced. */
typedef struct nt_append_target {
	nt_gltf_accessor accessor;
	uint32_t buffer;
	uint64_t begin; /* in the buffer */
	const nt_gltf_override *override;
	uint32_t clone; /* accessor that takes its place in solved primitives; NT_NONE: none does */
	uint32_t new_view; /* that has its elements now, from new_offset on; NT_NONE: they stay */
	uint64_t new_offset;
} nt_append_target;

/* Bytes of the source that have been edited for this pool. */
typedef struct nt_edited_range {
	uint32_t buffer;
	uint64_t begin, end;
} nt_edited_range;

typedef struct nt_appending {
	nt_buffer_edits *edits;
	nt_gltf *document; /* of the edits, as its JSON */
	nt_json *json;
	nt_arena *arena;   /* of the edits */
	const nt_pool_vertices *vertices;
	uint32_t buffer;  /* of new views */
	bool decoded_too; /* decompressed accessors get plain views */
	nt_error *error;
	nt_append_target *targets;
	size_t target_count, target_capacity;
	bool collecting_unsolved;
	bool collecting_beside; /* nothing is appended to them: one that cannot be read is none */
	nt_edited_range *edited;
	size_t edited_count, edited_capacity;
} nt_appending;

/* The pool, as nt_buffer_edits.appended_by has it. */
static inline uint32_t nt_append_owner(const nt_appending *a)
{
	return a->vertices->pool->users[0];
}

/* Notes that bytes of a source buffer have been edited. False: out of memory. */
bool nt_append_note_edit(nt_appending *appending, uint32_t buffer, uint64_t begin, uint64_t end);

/* All accessors of all users; when nothing is appended, only those with new values. Sorts the overrides. */
nt_status nt_append_collect(nt_appending *appending, nt_override_list *overrides);

/* Appends the elements that are copies of replaced ones to what a sparse accessor replaces. */
nt_status nt_append_sparse(nt_appending *appending, const nt_append_target *target);

/* ---- append.c, indices.c ---- */

/* Gives every accessor of the pool its copied elements, and overridden accessors their new values; `overrides` is
 * sorted for that. buffer: of new views. decoded_too: what was decompressed by Draco goes into plain views. */
nt_status nt_append_vertices(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	nt_override_list *overrides, bool decoded_too, nt_error *error);

/* Writes the indices of a pool's solved users where they changed. buffer: of new views. */
nt_status nt_gltf_write_indices(nt_buffer_edits *edits, uint32_t buffer, const nt_pool_vertices *vertices,
	nt_error *error);

#endif
