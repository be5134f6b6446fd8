/* SPDX-License-Identifier: MIT */
/*
 * Which of its corners stands for a welded vertex in mikktspace.c as published (spec page, step 2). Nearly always
 * nobody can tell; the edge sort can (edge_sort.h).
 *
 * The published weld sorts corners into 2048 cells along the longest axis of the box of all positions, halves each
 * cell by the middle of its box until nothing is left to halve, swapping corners from both ends, and lets the first
 * corner of each half that is equal stand for the others. So it may be any of them, but it depends on those in the
 * same cell alone.
 */
#ifndef NT_TOPOLOGY_REPRESENTATIVES_H
#define NT_TOPOLOGY_REPRESENTATIVES_H

#include "base/scratch.h"
#include "topology/triangles.h"

enum { NT_CELLS = 2048 };

/* A cell is halved so often at most; one with floats of ordinary sizes needs about 40. */
enum { NT_HALVINGS = 128 };

/* Triangles of welded vertices, those with two corners at one position too. */
typedef struct nt_welded_mesh {
	const nt_triangles *triangles;
	size_t triangle_count, vertex_count;
	const float *positions; /* [vertex_count] rows of three floats, of numbers that no corner has too; three
	                           floats behind the last one can be read */
	size_t step;            /* floats from one row to the next */
	unsigned threads;
	nt_scratch *scratch;
} nt_welded_mesh;

static inline const float *nt_welded_position(const nt_welded_mesh *mesh, uint32_t vertex)
{
	return mesh->positions + mesh->step * vertex;
}

/* Cells lie along one axis of the box. */
typedef struct nt_grid {
	unsigned axis;
	float low, high;
	uint32_t extremes[6]; /* vertices that have the least and the largest coordinate on each axis */
} nt_grid;

/* The box of the vertices that have a bit in `used` (NULL: all); at least one has. False where one of their coordinates
 * is not finite or not below FLT_MAX / 2: the published weld leaves some of these unwelded. */
bool nt_grid_make(const nt_welded_mesh *mesh, const uint64_t *used, nt_grid *grid);

/* The cell of a coordinate on the grid's axis, below NT_CELLS. */
unsigned nt_grid_cell(const nt_grid *grid, float coordinate);

/* How it ends. LIMIT: a cell would have to be halved more than NT_HALVINGS times. */
typedef enum nt_representatives_end {
	NT_REPRESENTATIVES_FOUND,
	NT_REPRESENTATIVES_LIMIT,
	NT_REPRESENTATIVES_NO_MEMORY
} nt_representatives_end;

/*
 * Finds the corner of the mesh that stands for each vertex of the corners given.
 *
 *   corners   [count] ascending 3 * triangle + k: all corners of the cells that they are in; NULL: all there are
 *   found     [vertex_count] receives the representatives of the vertices that these corners have
 */
nt_representatives_end nt_representatives(const nt_welded_mesh *mesh, const nt_grid *grid, const uint32_t *corners,
	size_t count, uint32_t *found);

#endif
