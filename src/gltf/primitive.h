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

/* The accessor that a member of an object names; NT_NONE: none that is there. */
uint32_t nt_gltf_reference(const nt_gltf *document, const nt_json_value *object, const char *name);

/* An accessor; NULL: the file is at fault, or there is none (NT_NONE). */
const nt_gltf_accessor *nt_gltf_sound_accessor(const nt_gltf *document, uint32_t index);

/* The accessor that a member names; NULL: none, or a faulty one. */
static inline const nt_gltf_accessor *nt_gltf_named(const nt_gltf *document, const nt_json_value *object,
	const char *name)
{
	return nt_gltf_sound_accessor(document, nt_gltf_reference(document, object, name));
}

/* The first accessor over the same bytes, of one that is there. */
static inline uint32_t nt_gltf_same(const nt_gltf *document, uint32_t accessor)
{
	return document->accessors[accessor].same;
}

/* Uses of it, and of others over its bytes: after nt_gltf_find_users(). */
static inline const nt_gltf_users *nt_gltf_users_of(const nt_gltf *document, uint32_t accessor)
{
	return &document->users[nt_gltf_same(document, accessor)];
}

#endif
