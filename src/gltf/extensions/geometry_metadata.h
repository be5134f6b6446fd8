/* SPDX-License-Identifier: MIT */
/*
 * FB_geometry_metadata: see geometry_metadata.c.
 */
#ifndef NT_GLTF_EXTENSIONS_GEOMETRY_METADATA_H
#define NT_GLTF_EXTENSIONS_GEOMETRY_METADATA_H

#include "gltf/document.h"

/* What a scene shows, each mesh as often as a node has it. */
typedef struct nt_geometry_total {
	uint64_t vertices, primitives; /* points, lines and triangles */
} nt_geometry_total;

/* Counts for every scene, in the arena; *totals is NULL where no scene has the extension. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_geometry_totals(const nt_gltf *document, nt_arena *arena, nt_geometry_total **totals);

/* Brings the numbers of all scenes up to date; those that were not what the counts before an edit were are left, with a
 * finding. before: NULL: nothing to be done. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_geometry_metadata_follow(nt_scene *scene, const nt_geometry_total *before, nt_arena *arena);

#endif
