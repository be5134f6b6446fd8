/* SPDX-License-Identifier: MIT */
/*
 * Extensions that refer to vertices, when these were copied.
 */
#ifndef NT_GLTF_EXTENSIONS_EXTENSIONS_H
#define NT_GLTF_EXTENSIONS_EXTENSIONS_H

#include "gltf/document.h"

/* ---- EXT_mesh_manifold: manifold.c ---- */

/* The corners of all primitives of a glTF mesh, one after the other as they lie in their buffer view. */
typedef struct nt_manifold {
	nt_json_value *extension; /* NULL: the mesh has none */
	const char *obstacle;     /* what of the mesh is not as the extension demands; NULL: nothing */
	size_t corner_count;
	uint32_t component_type;  /* of the indices */
	uint32_t *corners;        /* [corner_count] vertices */
	const uint32_t *merged;   /* [corner_count] the same of the manifold, where vertices at one place are one */
	size_t primitive_count;
	size_t *first;            /* [primitive_count] where its corners begin */
	size_t *count;            /* [primitive_count] */
} nt_manifold;

/* Reads the extension of a glTF mesh into the arena. A mesh that is not as it demands is no error. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_manifold_read(nt_manifold *manifold, nt_gltf *document, size_t mesh, nt_arena *arena);

/* Which corners have another vertex in the manifold, and which: ascending, in the arena. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_manifold_merges(const nt_manifold *manifold, nt_arena *arena, uint32_t **corners, uint32_t **vertices,
	size_t *count);

/* ---- CESIUM_primitive_outline: outline.c ---- */

/* Triangles whose vertices were copied. */
typedef struct nt_copied_triangles {
	const uint32_t *vertices; /* [corner_count] after copying, three a triangle */
	size_t corner_count;
	size_t old_count;         /* vertices before; vertex old_count + i is a copy of sources[i] */
	const uint32_t *sources;
} nt_copied_triangles;

/* The edges of an outline, two vertices each, after copying: in the arena. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_outline_follow(const uint32_t *edges, size_t edge_count, const nt_copied_triangles *triangles,
	nt_arena *arena, uint32_t **result, size_t *result_count);

/* ---- those that nobody makes follow: references.c ---- */

/* Adds a finding for each extension of a primitive, whose vertices were copied, and, with_mesh, of its glTF mesh that
 * seems to refer to its vertices and that nobody makes follow. old_count: vertices before. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_extension_references(nt_scene *scene, const nt_mesh *mesh, size_t old_count, bool with_mesh);

/* Vertices were copied: adds a finding for each scene with FB_geometry_metadata, which counts them. */
void nt_extension_scenes(nt_scene *scene);

#endif
