/* SPDX-License-Identifier: MIT */
/*
 * tinygltf is a second opinion on files that we wrote, since its parser is not ours. The bytes of buffers and
 * images stay with the caller: nothing here opens a file.
 */
#ifndef NT_EXT_TINYGLTF_H
#define NT_EXT_TINYGLTF_H

#include "base/error.h"
#include "ext/gltf_numbers.h"

#ifdef __cplusplus
extern "C" {
#endif

/* No index: an optional reference that is absent, and the result of an addition that failed. */
#define NT_MODEL_NONE UINT32_MAX

typedef struct nt_reread nt_reread;

/* Gives the bytes of a file that a document refers to, by its URI after percent-decoding. They must stay
 * until the next call. False: there is none, which is an error for buffers and none for images. */
typedef bool (*nt_reread_find)(void *user, const char *uri, const unsigned char **bytes, size_t *size);

/*
 * Reads a .glb or .gltf with tinygltf. Images are not decoded.
 *
 *   bytes  [size] the file
 *   find   called for buffers and images in other files; NULL: there are none
 *
 * Returns NT_OK; NT_ERROR_INPUT with tinygltf's words when it refuses the file, or JSON is nested
 * deeper than 512; NT_ERROR_UNSUPPORTED from 4 GB on, which its interface cannot take; NT_ERROR_MEMORY.
 */
nt_status nt_reread_open(nt_reread **model, const unsigned char *bytes, size_t size,
	nt_reread_find find, void *user, nt_error *error);

/* NULL is allowed. */
void nt_reread_free(nt_reread *model);

size_t nt_reread_mesh_count(const nt_reread *model);
size_t nt_reread_primitive_count(const nt_reread *model, size_t mesh);

/* The elements of an accessor, inside its buffer. Element i begins at data + i * stride_bytes. */
typedef struct nt_reread_array {
	const unsigned char *data;
	size_t count, stride_bytes;
	int component_type, components;
	bool normalized;
	const char *filter; /* of meshoptimizer, by which they came; NULL: none */
	const unsigned char *unfiltered; /* what it was applied to, as far apart as the elements */
	bool turned; /* triangles that meshoptimizer packed: any of their corners may be the first */
} nt_reread_array;

/*
 * An attribute of a primitive by its name; its indices for a NULL name.
 *
 * Returns NT_OK (with data NULL and count 0 when the primitive has none), NT_ERROR_INPUT when the
 * accessor is not inside its view and buffer, or NT_ERROR_MEMORY. Views that meshoptimizer packed are unpacked.
 * Attributes in the primitive's Draco block are zeros here, and its indices are none: see nt_reread_block().
 */
nt_status nt_reread_attribute(nt_reread *model, size_t mesh, size_t primitive,
	const char *name, nt_reread_array *array, nt_error *error);

/* The same of a morph target of the primitive. */
nt_status nt_reread_target(nt_reread *model, size_t mesh, size_t primitive, size_t target,
	const char *name, nt_reread_array *array, nt_error *error);

/* The KHR_draco_mesh_compression block of a primitive, if it has one. *bytes NULL: it is not inside of a buffer.
 * Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_reread_block(nt_reread *model, size_t mesh, size_t primitive, bool *has_block,
	const unsigned char **bytes, size_t *size, nt_error *error);

/* The id that an attribute has in the block; false: it is not in it. */
bool nt_reread_block_id(const nt_reread *model, size_t mesh, size_t primitive, const char *name, uint32_t *id);

#ifdef __cplusplus
}
#endif
#endif
