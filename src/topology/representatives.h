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

/* The box of some rows; the last of each four is of no use. */
typedef struct nt_box {
	float low[4], high[4];
} nt_box;

/* The rule by which the published weld chooses an axis. */
static inline unsigned nt_longest_axis(const nt_box *b)
{
	const float x = b->high[0] - b->low[0], y = b->high[1] - b->low[1], z = b->high[2] - b->low[2];
	return y > x && y > z ? 1 : z > x ? 2 : 0;
}

/* Triangles of welded vertices, those with two corners at one position too. */
typedef struct nt_welded_mesh {
	const nt_triangles *triangles;
	size_t triangle_count, vertex_count;
	const float *positions; /* [vertex_count] rows of three floats, of numbers that no corner has too; three
	                           floats behind the last one can be read */
	size_t step;		/* floats from one row to the next */
	const nt_box *box;	/* of all rows; NULL: not known */
	unsigned threads;       /* at least 1 */
	nt_scratch *scratch;
} nt_welded_mesh;

static inline const float *nt_welded_position(const nt_welded_mesh *mesh, uint32_t vertex)
{
	return mesh->positions + mesh->step * vertex;
}

static inline bool nt_welded_are_same(const nt_welded_mesh *mesh, uint32_t a, uint32_t b)
{
	const float *p = nt_welded_position(mesh, a), *q = nt_welded_position(mesh, b);
	return (p[0] == q[0]) & (p[1] == q[1]) & (p[2] == q[2]);
}

/* Whether two corners of a triangle with these vertices are at one position. */
static inline bool nt_welded_is_degenerate(const nt_welded_mesh *mesh, const uint32_t v[3])
{
	return nt_welded_are_same(mesh, v[0], v[1]) || nt_welded_are_same(mesh, v[1], v[2]) ||
	       nt_welded_are_same(mesh, v[2], v[0]);
}

/* Cells lie along one axis of the box. */
typedef struct nt_grid {
	unsigned axis;
	float low, high;
	double inverse; /* of the length */
} nt_grid;

/*
 * The cells of all rows. False if one of their coordinates is not finite or not below FLT_MAX / 2: the published weld
 * leaves some of these unwelded.
 *
 *   extremes   receive the vertices that have the least and the largest coordinate on each axis; NULL: not needed
 */
bool nt_grid_make(const nt_welded_mesh *mesh, uint32_t extremes[6], nt_grid *grid);

/* The same for the rows that have corners alone. */
bool nt_grid_of_used(const nt_welded_mesh *mesh, nt_grid *grid);

/* The cell of a coordinate on the grid's axis, below NT_CELLS. The published weld divides floats: a product of doubles
 * rounds to the same float, since it is wrong by 2^-52 of itself, and no quotient of two floats is nearer than 2^-49 to
 * what is half-way between two floats. */
static inline unsigned nt_grid_cell(const nt_grid *grid, float coordinate)
{
	const float quotient = (float)((double)(coordinate - grid->low) * grid->inverse);
	const float cell = (float)NT_CELLS * quotient;
	/* NaN, of a box without extent, is cell 0 */
	const float from_zero = cell > 0.0f ? cell : 0.0f, last = (float)(NT_CELLS - 1);
	return (unsigned)(int)(from_zero < last ? from_zero : last);
}

/* A corner, by a number that tells the caller which, and its vertex: its number in the cell. */
typedef struct nt_cell_corner {
	uint32_t vertex, corner;
} nt_cell_corner;

typedef struct nt_cell_vertex {
	float position[3];
	uint32_t corner_count;
} nt_cell_vertex;

/* The vertices and corners of one cell. Halves are made of vertices, of which there are few, and corners are only
 * swapped. */
typedef struct nt_cell {
	const nt_cell_vertex *vertices; /* [vertex_count] */
	nt_cell_corner *corners;        /* [corner_count] in the order of triangles; lost */
	uint32_t *order, *swaps;        /* [vertex_count], [corner_count] room */
	uint8_t *below;                 /* [vertex_count] room */
	uint8_t *wanted;                /* [vertex_count] 1: to be found, or 0 */
	uint32_t *found;                /* [vertex_count] receives what stands for those that are wanted, and others */
	size_t vertex_count, corner_count;
} nt_cell;

/* Room for a cell of so many vertices and corners, which are elsewhere; its `order` is NULL when out of memory. */
nt_cell nt_cell_make(nt_scratch *scratch, size_t vertices, size_t corners);

/* Finds the corners that stand for some vertices of a cell. False: it would have to be halved more than NT_HALVINGS
 * times. */
bool nt_weld_cell(const nt_cell *cell);

#endif
