/* SPDX-License-Identifier: MIT */
/*
 * A part is what becomes one glTF primitive of a new document: triangles over vertices, ready to be
 * written attribute by attribute. A mesh with one primitive is one part that refers to the mesh's own
 * arrays; of a mesh with several each part gets the vertices it uses, in the order of first use.
 */
#ifndef NT_GLTF_CREATE_PRIMITIVE_H
#define NT_GLTF_CREATE_PRIMITIVE_H

#include "scene/scene.h"

typedef struct nt_part {
	const nt_mesh *mesh;
	uint32_t material;        /* of the scene, or NT_NONE */
	size_t vertex_count;
	const uint32_t *vertices; /* [vertex_count] vertex of the mesh after its split; NULL: all, in order */
	size_t index_count;       /* 0 with indices NULL: every three vertices are a triangle */
	const uint32_t *indices;  /* [index_count] below vertex_count */
} nt_part;

typedef struct nt_parts {
	nt_part *items;
	size_t count;
} nt_parts;

/* The parts of a mesh that have faces, in the order of its primitives. What has to be made lives in the
 * arena. Returns NT_OK, NT_ERROR_MEMORY, NT_ERROR_TOO_LARGE or NT_ERROR_INTERNAL. */
nt_status nt_parts_make(const nt_mesh *mesh, nt_arena *arena, nt_parts *parts, nt_error *error);

/* What can be written of a part. */
typedef enum nt_stream {
	NT_STREAM_POSITION,
	NT_STREAM_NORMAL,
	NT_STREAM_TANGENT,
	NT_STREAM_TEXCOORD,  /* v down */
	NT_STREAM_COLOR,
	NT_STREAM_BITANGENT, /* cross(N, T) * w */
	NT_STREAM_COUNT
} nt_stream;

/* Name of the glTF attribute and floats per vertex. */
const char *nt_stream_name(nt_stream stream);
int nt_stream_width(nt_stream stream);

/* Whether the part has it. Tangents need normals, as glTF wants it. */
bool nt_part_has(const nt_part *part, nt_stream stream);

/* Smallest and largest coordinates of the positions, finite whatever they are. */
void nt_part_bounds(const nt_part *part, float min[3], float max[3]);

/* The component type of the indices: NT_GLTF_USHORT where that will do, else NT_GLTF_UINT. */
uint32_t nt_part_index_type(const nt_part *part);

/* Where the bytes of a part go. */
typedef nt_status (*nt_part_write)(void *user, const void *bytes, size_t size, nt_error *error);

/* Writes one stream, or the indices, in blocks: straight from the mesh where it has them as they are
 * written. */
nt_status nt_part_write_stream(const nt_part *part, nt_stream stream, nt_part_write write,
	void *user, nt_error *error);
nt_status nt_part_write_indices(const nt_part *part, nt_part_write write, void *user,
	nt_error *error);

#endif
