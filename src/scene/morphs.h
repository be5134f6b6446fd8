/* SPDX-License-Identifier: MIT */
/*
 * Tangents that morph targets give to vertices: see morphs.c.
 */
#ifndef NT_SCENE_MORPHS_H
#define NT_SCENE_MORPHS_H

#include "scene/scene.h"

typedef struct nt_morph_tangents {
	uint32_t *class_of; /* [vertex_count + split.source_count] of the mesh; NT_NONE: no corner has the vertex, and
	                       no target turns it */
	uint32_t *parent;   /* [class_count] a smaller number, or itself */
	size_t class_count;
	uint32_t *words;    /* [word_count] of each target: [row_count] classes, unless these are all that it has, then
	                       [row_count][3] floats */
	size_t word_count;
	size_t user_count;  /* meshes that have them, since geometry is shared, and a verification of the output */
	size_t reader_count; /* of these, the ones of the tangent set that is written */
	size_t *rows;       /* while a target of that set is read: as nt_morph_find_rows() has them; NULL: not yet */
} nt_morph_tangents;

/* The tangents of a mesh as its m-th target moves it: [vertex_count + split.source_count][3]. Returns NT_OK or
 * NT_ERROR_MEMORY. */
nt_status nt_morph_read(const nt_mesh *mesh, size_t m, float *tangents);

/* The same by vertex. at: [class_count] receives the word of each class's tangent in the m-th target; SIZE_MAX: it has
 * the base's. */
void nt_morph_find_rows(const nt_mesh *mesh, size_t m, size_t *at);

/* The three floats of a vertex. */
static inline const void *nt_morph_row(const nt_mesh *mesh, const size_t *at, size_t vertex)
{
	const uint32_t k = mesh->morph_tangents->class_of[vertex];
	return k != NT_NONE && at[k] != SIZE_MAX ? (const void *)(mesh->morph_tangents->words + at[k])
						 : mesh->split.vertex_tangents + 4 * vertex;
}

/* Nobody will read targets up to the m-th again: their memory goes. */
void nt_morph_drop(const nt_mesh *mesh, size_t m);

#endif
