/* SPDX-License-Identifier: MIT */
/*
 * Changes of the bytes of a document's buffers: insertions and replacements at places of the source, and new views
 * behind the end. Everything else is streamed from the source as it is, and every offset in the JSON is moved by what
 * was inserted before it.
 */
#ifndef NT_GLTF_BYTES_BYTES_H
#define NT_GLTF_BYTES_BYTES_H

#include "file/base64.h"
#include "gltf/quantize.h"
#include "gltf/vertex_pools.h"
#include "gltf/document.h"

/* ---- users of bytes: byte_users.c ---- */

/* Bytes of a source buffer that something in the document refers to. */
typedef struct nt_byte_user {
	uint64_t begin, end;
	uint64_t reach;    /* largest end of this and what is below it in the tree (byte_users.c) */
	uint32_t buffer;
	uint32_t accessor; /* `same`; NT_NONE: an image, an extension, or an unknown user */
} nt_byte_user;

/* An accessor and its edits; numbers are those of the first one over the same bytes. An attribute belongs to one pool,
 * so that nothing has to be emptied between pools; its bytes may be another pool's too. */
typedef struct nt_edited_accessor {
	uint32_t appended_by; /* the pool that appends to it: nt_append_owner(); 0: none */
	uint32_t replaced;    /* uses by sets and morph targets that are no more */
	uint32_t index_moved; /* uses as indices that have other ones by now */
	uint32_t welded;      /* the last weld that compared its elements, from 1 on */
	bool seen, pinned;    /* pinned: an unsolved user has it */
} nt_edited_accessor;

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

/* Whether something other than the accessors that `own` appends to refers to bytes of [begin, end). rows: [row_count]
 * if nothing else of these bytes changes: an accessor that no edit touches may lie beside them. */
bool nt_byte_users_foreign(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end,
	const nt_edited_accessor *owners, uint32_t own, const nt_byte_rows *rows, size_t row_count);

/* Whether something other than one accessor does. */
bool nt_byte_users_other(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end,
	uint32_t accessor);

/* How many things refer to bytes of [begin, end). */
size_t nt_byte_users_count(const nt_byte_users *users, uint32_t buffer, uint64_t begin, uint64_t end);

/* ---- edits: buffer_edits.c ---- */

/* glTF's own data in buffers needs no more. */
enum { NT_EDITS_ALIGNMENT = 4 };

/* New bytes at a place of a source buffer. */
typedef struct nt_buffer_edit {
	uint64_t at;      /* byte of the source buffer */
	uint64_t removed; /* bytes from there on that go */
	const unsigned char *bytes;
	size_t size;
} nt_buffer_edit;

/* The destination of the bytes of a buffer. */
typedef struct nt_byte_target nt_byte_target;
nt_status nt_target_put(const nt_byte_target *to, const void *bytes, size_t size, nt_error *error);

/* A whole file, from file to file where that is possible. */
nt_status nt_target_put_file(const nt_byte_target *to, const nt_file *file, nt_error *error);

/* Writes the bytes of a view, when its buffer is written. */
typedef nt_status (*nt_view_writer)(const void *user, const nt_byte_target *to, nt_error *error);

/* A new view behind the end of a buffer. */
typedef struct nt_buffer_addition {
	const void *bytes; /* or the user of `write` */
	nt_view_writer write; /* NULL: they are there */
	size_t size;
	uint32_t view; /* NT_NONE: of no view */
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
	nt_edited_buffer *decoded;  /* [view_count] bytes of decompressed views */
	nt_byte_users users;        /* of the source */
	uint32_t alignment;         /* insertions are multiples of this */
	const nt_buffer *lists;     /* [list_count] of a new document: elements of arrays that were set open, in its
	                               order, with "buffers" behind them. Empty: it has no such array */
	size_t list_count;
	bool polygons_dropped;      /* a primitive lost FB_ngon_encoding */
	bool vertices_copied;       /* some pool has more of them now */
	bool keeps_packed;          /* views that meshoptimizer packed are packed again: packed_views.c */
	nt_packed_view *packed;     /* [packed_count] new ones */
	size_t packed_count, packed_capacity;

	nt_edited_accessor *accessors; /* [accessor_count] of the source */
	uint32_t weld_count;
} nt_buffer_edits;

/*
 * Starts with no edits. Compressed views that vertices will be appended to, or all with `welds`, are decompressed
 * first: edits have to know them from the beginning. Faulty data that nothing needs is passed over.
 */
nt_status nt_edits_create(nt_buffer_edits *edits, const nt_vertex_pools *pools, bool keeps_packed, bool welds,
	nt_error *error);
/* The same for a document that is new and has no buffer yet. */
nt_status nt_edits_create_new(nt_buffer_edits *edits, nt_gltf *document, nt_error *error);
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

/* The same of bytes that are written when the buffer is; of no view. */
nt_status nt_edits_add_written(nt_buffer_edits *edits, uint32_t buffer, size_t size, nt_view_writer write,
	const void *user, nt_error *error);

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

/* ---- views that meshoptimizer packed, changed or new: packed_views.c ---- */

/* How a view of the source is packed, and so what goes with it will be; extension NULL: plain. */
nt_gltf_packing nt_packing_of(const nt_buffer_edits *edits, uint32_t view);

/* The same of what an accessor refers to. */
nt_gltf_packing nt_packing_of_accessor(const nt_buffer_edits *edits, uint32_t accessor);

/*
 * Bytes of a buffer as they are stored: those before the filter of a packed view, which has been decompressed. Data
 * that is added to such a view has to be that.
 *
 *   bytes  those at `offset` of the buffer, and what takes their place
 */
nt_status nt_packed_bytes(nt_buffer_edits *edits, uint32_t buffer, uint64_t offset, const unsigned char **bytes,
	nt_error *error);

/*
 * Adds elements to the end of a new view that is packed so, which may have been added before; of a plain packing, adds
 * a view of their own to a buffer: nt_edits_add_view().
 *
 *   packing  with the mode, filter and stride of the new view; a list of triangles that is none becomes INDICES
 *   bytes  [size], before the filter
 *   stride  of a plain view; 0: none
 *   view, offset  where they are
 */
nt_status nt_packed_add(nt_buffer_edits *edits, uint32_t buffer, const nt_gltf_packing *packing, const void *bytes,
	size_t size, uint32_t target, uint32_t stride, uint32_t *view, uint64_t *offset, nt_error *error);

/* Lets an accessor refer to elements in a new place, all of them. */
void nt_gltf_place_accessor(nt_json *json, nt_json_value *accessor, uint32_t view, uint64_t offset);

/* nt_edits_release(), of packed views that have been decompressed too. */
nt_status nt_packed_release(nt_buffer_edits *edits, uint32_t view, uint64_t offset, uint64_t length, nt_error *error);

/*
 * How new tangents are stored that go with a primitive's attributes. If its tangents are packed, as they are; else,
 * if its normals are, as these: integers by the octahedron if they are, floats by the same filter; else plain.
 *
 *   wanted  NT_PRECISION_AUTO: as said; else they have this, and a filter only if that is of its kind
 */
nt_status nt_packed_tangents(nt_buffer_edits *edits, const nt_json_value *attributes, nt_precision wanted,
	nt_gltf_packing *packing, nt_tangent_filter *filter, nt_error *error);

/* Packs a view whose bytes have changed: to `size` bytes before its filter. */
nt_status nt_packed_replace(nt_buffer_edits *edits, uint32_t view, const unsigned char *bytes, size_t size,
	nt_error *error);

/* Packs the new ones. */
nt_status nt_packed_finish(nt_buffer_edits *edits, nt_error *error);

/* ---- moving offsets and writing buffers: relocate.c ---- */

/* A buffer as it will be. */
typedef struct nt_relocated_buffer {
	const nt_edited_buffer *from; /* its edits are in order */
	int64_t *shifts;              /* [edit_count] how far everything behind an edit moves */
	size_t *near;                 /* the first edit behind the last position that was mapped */
	uint64_t *offsets;            /* [addition_count] in the new buffer */
	uint64_t length;
} nt_relocated_buffer;

/* The buffers of a document after all edits. It lives as long as those. */
typedef struct nt_relocated {
	nt_gltf *document;
	nt_relocated_buffer *buffers; /* [buffer_count] */
	size_t buffer_count;
	const nt_buffer *lists;       /* [list_count] as the edits have them */
	size_t list_count;
} nt_relocated;

/* Moves all offsets in the JSON and sets all lengths. Afterwards nothing may be edited any more. */
nt_status nt_gltf_relocate(nt_buffer_edits *edits, nt_relocated *result, nt_error *error);

/* Writes the bytes of a buffer. `input` is the document's own file. */
nt_status nt_relocated_write(const nt_relocated *relocated, uint32_t buffer, const nt_file *input, nt_sink *sink,
	nt_error *error);

/* The same as base64, without the last group's padding. */
nt_status nt_relocated_encode(const nt_relocated *relocated, uint32_t buffer, nt_base64 *base64, nt_error *error);

/* write.c. Writes the input as it is where that is what the output should be; *written tells. */
nt_status nt_gltf_copy_unchanged(nt_scene *scene, const nt_write_options *options,
	nt_output *output, bool *written, nt_error *error);

/* write.c. Ends the edits and writes the document with its buffers, into a main file that was added. link_prefix: the
 * way from the output's folder to the input's as a URI. */
nt_status nt_gltf_save(nt_scene *scene, nt_buffer_edits *edits, const nt_write_options *options,
	const char *link_prefix, nt_output *output, nt_sink *main, nt_error *error);

/* write.c. The same with the images of the source. */
nt_status nt_gltf_write_document(nt_scene *scene, nt_buffer_edits *edits, const nt_write_options *options,
	nt_output *output, nt_error *error);

#endif
