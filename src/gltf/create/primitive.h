/* SPDX-License-Identifier: MIT */
/*
 * Primitives of a new document: triangles over vertices, ready to be written attribute by attribute. That of a
 * mesh with one material refers to the mesh's own arrays; of a mesh with several each gets the vertices it
 * uses, in the order of first use.
 */
#ifndef NT_GLTF_CREATE_PRIMITIVE_H
#define NT_GLTF_CREATE_PRIMITIVE_H

#include "scene/scene.h"

typedef struct nt_new_primitive {
	const nt_mesh *mesh;
	uint32_t material;        /* of the scene, or NT_NONE */
	uint32_t group;           /* of the mesh */
	size_t vertex_count;
	const uint32_t *vertices; /* [vertex_count] vertex of the mesh after its split; NULL: all, in order */
	size_t index_count;       /* 0 with indices NULL: every three vertices are a triangle */
	const uint32_t *indices;  /* [index_count] below vertex_count */
} nt_new_primitive;

typedef struct nt_new_primitives {
	nt_new_primitive *items;
	size_t count;
} nt_new_primitives;

/* The new primitives of a mesh, for those of its primitives that have faces, in their order. New strings live in the
 * arena. Returns NT_OK, NT_ERROR_MEMORY, NT_ERROR_TOO_LARGE or NT_ERROR_INTERNAL. */
nt_status nt_new_primitives_make(const nt_mesh *mesh, nt_arena *arena, nt_new_primitives *made,
	nt_error *error);

/* The attributes of a primitive that can be written. */
typedef enum nt_attribute {
	NT_ATTRIBUTE_POSITION,
	NT_ATTRIBUTE_NORMAL,
	NT_ATTRIBUTE_TANGENT,
	NT_ATTRIBUTE_TEXCOORD,  /* v down */
	NT_ATTRIBUTE_COLOR,
	NT_ATTRIBUTE_BITANGENT, /* cross(N, T) * w */
	NT_ATTRIBUTE_COUNT
} nt_attribute;

/* Name of the glTF attribute and floats per vertex. */
const char *nt_attribute_name(nt_attribute attribute);
int nt_attribute_width(nt_attribute attribute);

/* Whether the primitive has it. Tangents need normals, as glTF wants it. */
bool nt_new_primitive_has(const nt_new_primitive *primitive, nt_attribute attribute);

/* Smallest and largest coordinates of the positions, finite whatever they are. */
void nt_new_primitive_bounds(const nt_new_primitive *primitive, float min[3], float max[3]);

/* The component type of the indices: NT_GLTF_USHORT where that will do, else NT_GLTF_UINT. */
uint32_t nt_new_primitive_index_type(const nt_new_primitive *primitive);

/* The destination of a primitive's bytes. */
typedef nt_status (*nt_byte_writer)(void *user, const void *bytes, size_t size, nt_error *error);

/* Writes one attribute, or the indices, in blocks: straight from the mesh where it has them as they are
 * written. */
nt_status nt_new_primitive_write_attribute(const nt_new_primitive *primitive, nt_attribute attribute,
	nt_byte_writer write, void *user, nt_error *error);
nt_status nt_new_primitive_write_indices(const nt_new_primitive *primitive, nt_byte_writer write, void *user,
	nt_error *error);

#endif
