/* SPDX-License-Identifier: MIT */
/*
 * Views that meshoptimizer packed, changed or new: see packed_views.c.
 */
#ifndef NT_GLTF_BYTES_PACKED_VIEWS_H
#define NT_GLTF_BYTES_PACKED_VIEWS_H

#include "gltf/bytes/buffer_edits.h"
#include "gltf/tangent_filter.h"
#include "gltf/view.h"

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

#endif
