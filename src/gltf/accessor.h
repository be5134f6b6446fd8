/* SPDX-License-Identifier: MIT */
/*
 * Accessors of a document: see accessor.c.
 */
#ifndef NT_GLTF_ACCESSOR_H
#define NT_GLTF_ACCESSOR_H

#include "gltf/document.h"

/* Reads buffers, views and accessors, each once; whoever uses a faulty one is told. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_gltf_read_arrays(nt_gltf *document, nt_error *error);

/* An accessor of the source. `from` is the JSON pointer of the reference. */
nt_status nt_gltf_get_accessor(nt_gltf *document, uint64_t index, const char *from,
	nt_gltf_accessor *accessor, nt_error *error);

/* The JSON of an accessor, NULL where there is none. */
nt_json_value *nt_gltf_accessor_json(const nt_gltf *document, uint64_t index);

/* Makes what an accessor says of its least and most values, if it does, that of the elements that are written:
 * bounds as nt_component_bounds() has them. */
void nt_gltf_state_bounds(nt_json *json, nt_json_value *accessor, size_t components, double bounds[2][4]);

/* The bytes of an accessor's elements, `stride` apart; NULL where it has no view. */
nt_status nt_gltf_elements(nt_gltf *document, const nt_gltf_accessor *accessor,
	const unsigned char **elements, nt_error *error);

/* The elements a sparse accessor replaces: their numbers and new values, tightly packed. Numbers are
 * checked: increasing and below the count. The array is in the arena. */
nt_status nt_gltf_sparse(nt_gltf *document, const nt_gltf_accessor *accessor, nt_arena *arena,
	const uint32_t **elements, const unsigned char **values, nt_error *error);

/*
 * An accessor as floats, `width` per element: normalized integers as the specification maps them, other
 * integers by value. Components beyond those of the accessor get `fill`. Points into the input where it
 * already is that.
 */
nt_status nt_gltf_floats(nt_gltf *document, const nt_gltf_accessor *accessor, uint32_t width,
	float fill, nt_arena *arena, float **floats, nt_error *error);

/* The same, not to be written to: an accessor that several primitives use is decoded once, and lives as long as the
 * document. Several threads may call this. */
nt_status nt_gltf_shared_floats(nt_gltf *document, const nt_gltf_accessor *accessor, uint32_t width, float fill,
	float **floats, nt_error *error);

/* An accessor of unsigned scalars as 32-bit indices, each below `vertex_count` and not the value that
 * is reserved for restarts. Points into the input where it already is that. */
nt_status nt_gltf_indices(nt_gltf *document, const nt_gltf_accessor *accessor, size_t vertex_count,
	nt_arena *arena, uint32_t **indices, nt_error *error);

/* Size of a component; 0 for an unknown type. */
uint32_t nt_gltf_component_bytes(uint64_t component_type);

/* The narrowest type for numbers up to `most` that is not narrower than `least`. For a primitive's indices that is
 * the number of vertices, since the largest number of a type is reserved for restarts. */
uint32_t nt_gltf_index_type(uint64_t most, uint32_t least);

/* Numbers as a type of `width` bytes has them: count * width bytes. */
void nt_gltf_store_indices(const uint32_t *indices, size_t count, uint32_t width, unsigned char *bytes);

#endif
