/* SPDX-License-Identifier: MIT */
/*
 * What growing the accessors of a component takes: see append_items.c.
 */
#ifndef NT_GLTF_EDIT_APPEND_ITEMS_H
#define NT_GLTF_EDIT_APPEND_ITEMS_H

#include "gltf/accessor.h"
#include "gltf/edit/editor.h"

/* An accessor whose values are replaced in place: rows of `width` bytes for every new row. Without values it does not
 * grow: it will get a view of its own. */
typedef struct nt_gltf_override {
	uint32_t accessor;
	const unsigned char *values;
	uint32_t width;
} nt_gltf_override;

/* An accessor that grows. */
typedef struct nt_gltf_item {
	nt_gltf_accessor accessor;
	uint32_t buffer;
	uint64_t begin; /* in the buffer */
	const nt_gltf_override *override;
	uint32_t clone; /* accessor that takes its place in solved primitives; NT_NONE: it grows itself */
} nt_gltf_item;

/* Bytes of the source that have been edited for this component. */
typedef struct nt_gltf_edited {
	uint32_t buffer;
	uint64_t begin, end;
} nt_gltf_edited;

typedef struct nt_gltf_growing {
	nt_gltf_patcher *patcher;
	const nt_gltf_cluster *component;
	nt_gltf_item *items;
	size_t item_count, item_capacity;
	bool *seen;    /* [accessor_count] */
	bool *pinned;  /* [accessor_count] used by an unsolved member */
	bool collecting_unsolved;
	bool decoded_too; /* decompressed accessors get plain views */
	nt_gltf_edited *edited;
	size_t edited_count, edited_capacity;
} nt_gltf_growing;

/* Rows that are appended to every accessor. */
static inline size_t nt_gltf_added_rows(const nt_gltf_growing *g)
{
	return g->component->rows.new_count - g->component->rows.old_count;
}

/* Row of the source that a new row copies. */
static inline uint32_t nt_gltf_row_source(const nt_gltf_growing *g, size_t row)
{
	const nt_gltf_rows *rows = &g->component->rows;
	return row < rows->old_count ? (uint32_t)row : rows->sources[row - rows->old_count];
}

/* Notes that bytes of a source buffer have been edited. False: out of memory. */
bool nt_gltf_note_edit(nt_gltf_growing *growing, uint32_t buffer, uint64_t begin, uint64_t end);

/* All accessors of all members; when nothing is appended, only those with new values. Sorts the overrides. */
nt_status nt_gltf_collect_items(nt_gltf_growing *growing, nt_gltf_override *overrides, size_t override_count);

#endif
