/* SPDX-License-Identifier: MIT */
/*
 * Points: vertices whose positions are equal, compared as floats (0 equals -0, NaN equals nothing, no epsilon),
 * numbered by the first side that begins at any of them.
 */
#include "report/surface/surface.h"

#include <string.h>
#include "base/hash.h"

static bool same_position(const float *p, const float *q)
{
	return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

/* The place in a table of vertices + 1 where a position is, or belongs. A row with a NaN is not found again. */
static uint32_t *find_place(uint32_t *table, size_t mask, const nt_mesh *mesh, const float *position)
{
	const uint64_t xy = nt_hash_floats(position[0], position[1]), z = nt_hash_floats(position[2], 0);
	size_t at = (size_t)nt_hash_words(xy, z) & mask;
	while (table[at] && !same_position(mesh->positions + 3 * (size_t)(table[at] - 1), position))
		at = (at + 1) & mask;
	return &table[at];
}

nt_status nt_surface_weld(nt_surface *s, nt_scratch *scratch)
{
	const nt_mesh *mesh = s->mesh;
	const size_t vertices = mesh->vertex_count, sides = 3 * s->triangle_count;
	const size_t used = vertices < sides ? vertices : sides; /* at most */
	size_t size = 16;
	while (size < 2 * used)
		size *= 2;
	s->points = nt_scratch_alloc(scratch, vertices, sizeof *s->points);
	s->joints = nt_scratch_alloc(scratch, nt_bit_words(vertices), sizeof *s->joints);
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	uint32_t *table = nt_scratch_alloc(scratch, size, sizeof *table);
	if (!s->points || !s->joints || !table)
		return NT_ERROR_MEMORY;
	memset(s->points, 0xff, vertices * sizeof *s->points);
	memset(s->joints, 0, nt_bit_words(vertices) * sizeof *s->joints);
	memset(table, 0, size * sizeof *table);
	s->point_count = 0;
	for (size_t side = 0; side < sides; side++) {
		const uint32_t v = nt_side_vertex(s, side);
		if (s->points[v] != NT_NONE)
			continue;
		const float *position = mesh->positions + 3 * (size_t)v;
		const float *uv = s->texcoords ? s->texcoords + 2 * (size_t)v : NULL;
		uint32_t *place = find_place(table, size - 1, mesh, position);
		s->points[v] = *place ? s->points[*place - 1] : (uint32_t)s->point_count++;
		if (*place || (uv && (uv[0] != uv[0] || uv[1] != uv[1])))
			nt_bit_set(s->joints, s->points[v]);
		if (same_position(position, position))
			*place = v + 1;
	}
	nt_scratch_back(scratch, mark);
	return NT_OK;
}
