/* SPDX-License-Identifier: MIT */
/*
 * Changes of the bytes of a document's buffers. A source buffer is a row of segments, each with what refers to it. They
 * are replaced, go on behind their end, or go when nothing refers to them any more. New views come behind the end.
 * Everything else is streamed from the source as it is, and every offset in the JSON moves by what changed before it.
 */
#ifndef NT_GLTF_BYTES_BYTES_H
#define NT_GLTF_BYTES_BYTES_H

#include "file/output.h"
#include "gltf/document.h"
#include "gltf/quantize.h"
#include "gltf/vertex_pools.h"

/* ---- segments: segments.c ---- */

/* Bytes of a source buffer, or of a view that was decompressed, that something refers to, with all that overlaps
 * them. */
typedef struct nt_segment {
	uint64_t begin, end;
	uint32_t buffer;       /* NT_GLTF_OF_VIEW(): a view's own */
	uint32_t users;        /* that have not left; accessors over the same bytes are one */
	union {
		struct {
			uint32_t pool, known; /* how many of them a pool has: nt_segment_know() */
		};
		int64_t shift;         /* how far it moves: layout.c, once buffers are laid out */
	};
	uint32_t apart;        /* the last accessor that no edit touches; NT_NONE: none */
	bool changed;
} nt_segment;

/* The new content of a segment that is changed. */
typedef struct nt_segment_change {
	const unsigned char *bytes; /* [size] new ones */
	size_t size;
	uint32_t stride;       /* of vertices that were added; 0: none were */
	bool kept;             /* its bytes are, before the new ones */
	uint8_t padding;       /* behind the new ones */
} nt_segment_change;

/* An accessor while pools are edited, or all over its bytes (`same`). An attribute belongs to one
 * pool, so that nothing has to be emptied between pools; its bytes may be another pool's too. */
typedef struct nt_edited_accessor {
	uint32_t replaced;    /* `same`: uses by sets and morph targets that are no more */
	uint32_t index_moved; /* `same`: uses as indices that have other ones by now */
	uint32_t welded;      /* `same`: the last weld that compared its elements, from 1 on */
	uint32_t override;    /* `same`: the attribute whose values it takes, by its number in the pool's list, from 1
	                         on; 0: none */
	uint32_t apart;       /* `same`: the one before it in its segment that no edit touches; NT_NONE: none */
	bool seen;            /* the pool has it */
	bool listed, pinned, solved; /* `same`: pinned: an unsolved user has it; solved: a solved one */
} nt_edited_accessor;

/* glTF's own data in buffers needs no more. */
enum { NT_EDITS_ALIGNMENT = 4 };

/* All Draco blocks begin with DRAC, which views that an earlier run left free share: these do not count as users. */
enum { NT_FREE_VIEW_BYTES = 4 };

typedef struct nt_buffer_edits nt_buffer_edits;

/* Finds the segments of the source, and the users of its views. Faulty parts of the document are passed over. False:
 * out of memory. */
bool nt_segments_find(nt_buffer_edits *edits);

/* Number of segments before the first one of `buffer` that begins at or behind `position`. */
size_t nt_segments_before(nt_buffer_edits *edits, uint32_t buffer, uint64_t position);

/* The segment that has a byte of a buffer, or of a view; NULL: none. */
nt_segment *nt_segment_at(nt_buffer_edits *edits, uint32_t buffer, uint64_t position);
nt_segment *nt_segment_of(nt_buffer_edits *edits, uint32_t view, uint64_t offset);

/* Notes that a pool has some of the users of a segment (NULL: of none), and whether it has all. */
void nt_segment_know(nt_segment *segment, uint32_t pool, uint32_t users);
static inline bool nt_segment_is_known(const nt_segment *segment, uint32_t pool)
{
	return segment->pool == pool && segment->known == segment->users;
}

/* Whether `size` bytes from `begin` on are a segment, and nobody else is left in it: what others had around them before
 * they left is no place for these. segment: may be NULL. */
static inline bool nt_segment_is(const nt_segment *segment, uint64_t begin, uint64_t size)
{
	return segment && segment->users == 1 && segment->begin == begin && segment->end == begin + size;
}

/* Changes a segment; the new bytes live as long as the edits. */
void nt_segment_edit(nt_buffer_edits *edits, nt_segment *segment, nt_segment_change change);

/* ---- edits: edits.c ---- */

/* The destination of the bytes of a buffer. */
typedef struct nt_byte_target nt_byte_target;
nt_status nt_target_put(const nt_byte_target *to, const void *bytes, size_t size, nt_error *error);

/* A whole file, from file to file where that is possible. */
nt_status nt_target_put_file(const nt_byte_target *to, const nt_file *file, nt_error *error);

/* Writes the bytes of a view, when its buffer is written. */
typedef nt_status (*nt_view_writer)(const void *user, const nt_byte_target *to, nt_error *error);

/* New bytes behind the end of a buffer. */
typedef struct nt_buffer_addition {
	const void *bytes; /* or the user of `write` */
	nt_view_writer write; /* NULL: they are there */
	size_t size;
	uint64_t offset; /* in the new buffer */
	uint32_t view;   /* NT_NONE: of no view */
	bool packed;     /* they are what its extension refers to */
} nt_buffer_addition;

typedef struct nt_edited_buffer {
	nt_buffer_addition *additions;
	size_t addition_count, addition_capacity;
	uint64_t old_length; /* 0 for a new buffer */
	uint64_t length;     /* once it is laid out */
	bool changed;        /* some of its segments are, once it is */
	bool encoded;        /* it becomes a data URI */
} nt_edited_buffer;

/* A view of the source. */
typedef struct nt_edited_view {
	uint32_t users;      /* that have not left */
	bool is_free;        /* there were some, and all have left: its number serves the next new view */
	unsigned char *unfiltered; /* its bytes before the filter, owned; NULL: nobody asked, or there is none */
} nt_edited_view;

/* A new view that will be packed. */
typedef struct nt_packed_view {
	nt_gltf_packing packing;
	uint32_t view, target;
	nt_buffer bytes; /* before the filter */
} nt_packed_view;

struct nt_buffer_edits {
	nt_gltf *document;
	nt_arena arena;             /* owns the new bytes */
	nt_segment *segments;       /* [segment_count] in order, apart from each other */
	nt_segment_change *changes; /* [segment_count] of those that are changed: pages of others are never touched */
	size_t segment_count, near;    /* near: where the last search ended */
	nt_edited_buffer *buffers;  /* [buffer_count]: the document's, and at most one new one */
	size_t buffer_count;
	nt_edited_view *views;      /* [view_count] of the source */
	size_t view_count;
	uint32_t *free_views;       /* [free_count] those that nothing new has taken over */
	size_t free_count;
	uint32_t alignment;         /* what changes by less than this is padded */
	bool laid_out;              /* segments have their places, and are not asked any more who has their users */
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
};

static inline bool nt_is_edited(const nt_edited_buffer *buffer)
{
	return buffer->changed || buffer->addition_count;
}

/*
 * Starts with no edits. Compressed views that vertices will be appended to, or all with `welds`, are decompressed
 * first: edits have to know them from the beginning. Faulty data that nothing needs is passed over.
 */
nt_status nt_edits_create(nt_buffer_edits *edits, const nt_vertex_pools *pools, bool keeps_packed, bool welds,
	nt_error *error);
/* The same for a document that is new and has no buffer yet. */
nt_status nt_edits_create_new(nt_buffer_edits *edits, nt_gltf *document, nt_error *error);
void nt_edits_free(nt_buffer_edits *edits);

/*
 * Something that refers to bytes of a view from `offset` on will do so no more: an accessor with all over its bytes, an
 * array of a sparse one, an image, a block. Bytes that nothing refers to any more go. Views are never removed or
 * renumbered, since extensions we do not know may refer to them: one without users is free, and the next new view takes
 * its number. If there is none it shares bytes with others, since a view may not be empty.
 */
void nt_edits_leave(nt_buffer_edits *edits, uint32_t view, uint64_t offset);

/* The same of all that an accessor refers to. */
void nt_edits_leave_accessor(nt_buffer_edits *edits, uint32_t accessor);

/* Adds bytes behind the end of a buffer: of a view, whose byteOffset will be set (that of its extension where
 * `packed`), or NT_NONE. */
nt_status nt_edits_add_bytes(nt_buffer_edits *edits, uint32_t buffer, uint32_t view, bool packed, const void *bytes,
	size_t size, nt_error *error);

/* The same of bytes that are written when the buffer is; of no view. */
nt_status nt_edits_add_written(nt_buffer_edits *edits, uint32_t buffer, size_t size, nt_view_writer write,
	const void *user, nt_error *error);

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

/* ---- the new buffers: layout.c ---- */

/* Sets a member that has another value, 0 if it is not written. */
void nt_gltf_set_number(nt_json *json, nt_json_value *object, const char *key, uint64_t value);

/* Ends the edits: lays out the buffers, moves all offsets in the JSON and sets all lengths. */
nt_status nt_edits_end(nt_buffer_edits *edits, nt_error *error);

/* Writes the bytes of a buffer. `input` is the document's own file. */
nt_status nt_edits_write(nt_buffer_edits *edits, uint32_t buffer, const nt_file *input, nt_sink *sink, nt_error *error);

/* The same as base64, without the last group's padding. */
nt_status nt_edits_encode(nt_buffer_edits *edits, uint32_t buffer, nt_base64 *base64, nt_error *error);

/* ---- edit/save.c ---- */

/* Writes the input as it is where that is what the output should be; *written tells. */
nt_status nt_gltf_copy_unchanged(nt_scene *scene, const nt_write_options *options,
	nt_output *output, bool *written, nt_error *error);

/* Ends the edits and writes the document with its buffers, into a main file that was added. link_prefix: the way from
 * the output's folder to the input's as a URI. */
nt_status nt_gltf_save(nt_scene *scene, nt_buffer_edits *edits, const nt_write_options *options,
	const char *link_prefix, nt_output *output, nt_sink *main, nt_error *error);

/* The same with the images of the source. */
nt_status nt_gltf_write_document(nt_scene *scene, nt_buffer_edits *edits, const nt_write_options *options,
	nt_output *output, nt_error *error);

#endif
