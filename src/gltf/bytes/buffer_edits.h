/* SPDX-License-Identifier: MIT */
/*
 * Changes of the bytes of a document's buffers: insertions and replacements at places of the
 * source, and new views behind the end. Everything else is streamed from the source as it is, and every
 * offset in the JSON is moved by what was inserted before it.
 */
#ifndef NT_GLTF_BYTES_BUFFER_EDITS_H
#define NT_GLTF_BYTES_BUFFER_EDITS_H

#include "gltf/bytes/byte_users.h"
#include "gltf/view.h"

/* glTF's own data in buffers needs no more. */
enum { NT_EDITS_ALIGNMENT = 4 };

/* New bytes at a place of a source buffer. */
typedef struct nt_buffer_edit {
	uint64_t at;      /* byte of the source buffer */
	uint64_t removed; /* bytes from there on that go */
	const unsigned char *bytes;
	size_t size;
} nt_buffer_edit;

/* A new view behind the end of a buffer. */
typedef struct nt_buffer_addition {
	uint32_t view; /* NT_NONE: of no view */
	const unsigned char *bytes;
	size_t size;
	bool packed; /* they are what its extension refers to */
} nt_buffer_addition;

typedef struct nt_edited_buffer {
	nt_buffer_edit *edits;
	size_t edit_count, edit_capacity;
	nt_buffer_addition *additions;
	size_t addition_count, addition_capacity;
	uint64_t old_length; /* 0 for a new buffer */

	/* of a decompressed view that will be packed again */
	unsigned char *unfiltered; /* its bytes before the filter, owned; NULL: nobody asked, or there is none */
	uint32_t new_stride;       /* all of its elements are replaced by such of another size; 0: they are not */
} nt_edited_buffer;

/* A new view that will be packed. */
typedef struct nt_packed_view {
	nt_gltf_packing packing;
	uint32_t view, target;
	nt_buffer bytes; /* before the filter */
} nt_packed_view;

static inline bool nt_is_edited(const nt_edited_buffer *buffer)
{
	return buffer->edit_count || buffer->addition_count;
}

typedef struct nt_buffer_edits {
	nt_gltf *document;
	nt_arena arena;             /* owns the new bytes */
	nt_edited_buffer *buffers;  /* [buffer_count]: the document's, and at most one new one */
	size_t buffer_count;
	size_t view_count;          /* of the source */
	bool *is_free;              /* [view_count] what it held is gone: see nt_edits_release() */
	uint32_t *free_views;       /* [free_count] those that nothing new has taken over */
	size_t free_count;
	nt_edited_buffer *virtuals; /* [view_count] of decompressed views */
	nt_byte_users users;        /* of the source */
	uint32_t alignment;         /* insertions are multiples of this */
	bool polygons_dropped;      /* a primitive lost FB_ngon_encoding */
	bool vertices_copied;       /* some pool has more of them now */
	bool keeps_packed;          /* views that meshoptimizer packed are packed again: packed_views.h */
	nt_packed_view *packed;     /* [packed_count] new ones */
	size_t packed_count, packed_capacity;

	/* For appending to the attributes of one pool after the other. An attribute belongs to one pool, so that
	 * nothing has to be emptied in between; bytes may be another pool's too. */
	uint32_t *welding;          /* [accessor_count] by `same`: the last weld that compared its elements, from 1 on;
	                               NULL: there is none */
	uint32_t weld_count;
	bool *seen;                 /* [accessor_count] */
	bool *pinned;               /* [accessor_count] used by an unsolved user */
	uint32_t *index_moved;      /* [accessor_count] by `same`: uses as indices that have other ones by now */
	uint32_t *replaced;         /* [accessor_count] by `same`: uses by morph targets that are no more */
	uint32_t *appended_by;      /* [accessor_count] by `same`: the pool that appends to it, by its
	                               first user */
} nt_buffer_edits;

/*
 * Starts with no edits. Compressed views that vertices will be appended to, or all with `welds`, are decompressed
 * first: edits have to know them from the beginning. Faulty data that nothing needs is passed over.
 */
nt_status nt_edits_create(nt_buffer_edits *edits, const nt_vertex_pools *pools, bool keeps_packed, bool welds,
	nt_error *error);
void nt_edits_free(nt_buffer_edits *edits);

/* Replaces `removed` bytes of a source buffer by others, which must live as long as the edits. The
 * difference is padded with zeros to their alignment. Edits must not overlap. */
nt_status nt_edits_replace(nt_buffer_edits *edits, uint32_t buffer, uint64_t at, uint64_t removed,
	const unsigned char *bytes, size_t size, nt_error *error);

/*
 * Takes out a view to which so many things refer that will do so no more; nothing happens where anybody else
 * refers to its bytes, where it is compressed or has extensions. Views are never removed or renumbered: it
 * becomes free, and the next new view takes its number. If there is none it shares bytes with others, since a
 * view may not be empty.
 */
nt_status nt_edits_release_view(nt_buffer_edits *edits, uint32_t view, size_t users, nt_error *error);

/* The same for bytes of a view that one thing alone refers to; the view stays for what else is in it. */
nt_status nt_edits_release(nt_buffer_edits *edits, uint32_t view, uint64_t offset, uint64_t length,
	nt_error *error);

/* The changes of a buffer, a decompressed view's among them. */
nt_edited_buffer *nt_edits_of(nt_buffer_edits *edits, uint32_t buffer);

/* Adds bytes behind the end of a buffer: of a view, whose byteOffset will be set, or NT_NONE. */
nt_status nt_edits_add_bytes(nt_buffer_edits *edits, uint32_t buffer, uint32_t view, const void *bytes, size_t size,
	nt_error *error);

/* The same of the packed bytes of a view, which its extension refers to. */
nt_status nt_edits_add_packed(nt_buffer_edits *edits, uint32_t buffer, uint32_t view, const void *bytes, size_t size,
	nt_error *error);

/* The number of a new view, of which nothing is said yet. */
uint32_t nt_edits_new_view(nt_buffer_edits *edits);

/* Adds a view with these bytes behind the end of a buffer. target and stride: 0 for none. */
nt_status nt_edits_add_view(nt_buffer_edits *edits, uint32_t buffer, const void *bytes, size_t size,
	uint32_t target, uint32_t stride, uint32_t *view, nt_error *error);

/* The buffer that takes new views of who uses source buffer `near` (NT_NONE: nobody in particular);
 * a new buffer where no other can. */
nt_status nt_edits_choose_buffer(nt_buffer_edits *edits, uint32_t near, uint32_t *buffer,
	nt_error *error);

#endif
