/* SPDX-License-Identifier: MIT */
/*
 * Primitives of a document and the accessors they name: see primitive.c.
 */
#ifndef NT_GLTF_PRIMITIVE_H
#define NT_GLTF_PRIMITIVE_H

#include "gltf/document.h"

/* Whether a mesh has tangents to be written. */
bool nt_gltf_is_solved(const nt_mesh *mesh);

/* The primitive of a mesh in the document. */
nt_json_value *nt_gltf_primitive_of(const nt_gltf *document, const nt_mesh *mesh);

/* A use of an accessor by a primitive: an attribute, or one of a morph target. */
typedef struct nt_gltf_use {
	nt_json_value *attributes; /* the primitive's, or the target's */
	const char *name;
	uint32_t accessor;
	size_t object, member;     /* what comes next */
} nt_gltf_use;

/* Goes through them: a zeroed use becomes the first one, each the next. False: that was the last. */
bool nt_gltf_next_use(const nt_gltf *document, const nt_json_value *primitive, nt_gltf_use *use);

/* Calls visit() for the accessors of a primitive: its attributes and those of its morph targets. */
typedef nt_status (*nt_gltf_visit)(void *context, nt_json_value *attributes, const char *name,
	uint32_t accessor);
nt_status nt_gltf_visit_attributes(const nt_json_value *primitive, size_t accessor_count,
	nt_gltf_visit visit, void *context);

/* Fills first_alias [accessor_count]: for each accessor the first over the same bytes. False: out of memory. */
bool nt_gltf_find_first_aliases(nt_gltf *document, uint32_t *first_alias, size_t accessor_count);

#endif
