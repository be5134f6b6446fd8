/* SPDX-License-Identifier: MIT */
/*
 * Texture coordinates that belong to corners (MeshLab's per-wedge ones): a vertex is then a row of the
 * file with one pair of coordinates. The first pair of a row keeps the row's number, further ones are
 * appended in the order they come.
 */
#ifndef NT_PLY_WEDGES_H
#define NT_PLY_WEDGES_H

#include "base/hash_index.h"
#include "ply/source.h"
#include "scene/scene.h"

typedef struct ply_wedges {
	size_t row_count;
	float (*row_uvs)[2];   /* [row_count] first pair of each row */
	uint8_t *row_states;   /* [row_count] enum wedge_state */
	float (*copy_uvs)[2];  /* pairs, rows and states of the copies */
	uint32_t *copy_rows;
	uint8_t *copy_states;
	size_t copy_count, uv_capacity, row_capacity, state_capacity;
	nt_hash_index index;   /* of copies */
	bool any, any_lacks;   /* some corner has, some has no coordinates */
} ply_wedges;

/* Starts with nothing known of `row_count` rows; false: out of memory. */
bool ply_wedges_init(ply_wedges *wedges, size_t row_count);
void ply_wedges_free(ply_wedges *wedges);

/* The vertex for a row with coordinates; uv NULL: with none. Copies are numbered from row_count on.
 * NT_NONE when memory or vertex numbers are exhausted. */
uint32_t ply_wedges_vertex(ply_wedges *wedges, uint32_t row, const float *uv);

/* The row of a vertex. */
static inline uint32_t ply_wedges_row(const ply_wedges *wedges, uint32_t vertex)
{
	return vertex < wedges->row_count ? vertex : wedges->copy_rows[vertex - wedges->row_count];
}

/* Gives the mesh its texture coordinates, and its copies all other attributes; copy_rows is handed
 * over to source->wedge_rows. Nothing happens when no corner had coordinates. False: out of memory. */
bool ply_wedges_apply(ply_wedges *wedges, nt_scene *scene, nt_mesh *mesh, ply_source *source);

#endif
