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
	const uint8_t *flags;   /* [triangle_count] NT_DEGENERATE; NULL: positions are compared */
	size_t triangle_count, vertex_count;
	const float *positions; /* [vertex_count] rows of three floats, of numbers that no corner has too; three
	                           floats behind the last one can be read */
	size_t step;		/* floats from one row to the next */
	const nt_box *box;	/* of all rows; NULL: not known */
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

/* Whether two corners of triangle t, with these vertices, are at one position. */
static inline bool nt_welded_is_degenerate(const nt_welded_mesh *mesh, size_t t, const uint32_t v[3])
{
	if (mesh->flags)
		return mesh->flags[t] & NT_DEGENERATE;
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

/* A corner, by a number that tells the caller which, and its vertex. */
typedef struct nt_cell_corner {
	uint32_t vertex, corner;
} nt_cell_corner;

typedef struct nt_cell_vertex {
	float position[3];
	uint32_t corners; /* how many it has; then NT_CELL_FOUND and the one that stands for it */
} nt_cell_vertex;

#define NT_CELL_FOUND ((uint32_t)1 << 31)

/* A part of a cell: some of its vertices, in any order, and all of their corners. */
typedef struct nt_part {
	struct nt_part *halves; /* two; NULL: it has not been halved */
	uint32_t vertices, corners; /* the first ones */
	uint32_t vertex_count, corner_count;
	float middle;
	uint8_t axis, halvings;
} nt_part;

/* Cells are halved where somebody asks for a vertex, each part once. Halves are made of vertices, of which there are
 * few, and corners are only swapped. A vertex that is alone in its half needs no part. */
typedef struct nt_cells {
	nt_cell_vertex *vertices;
	nt_cell_corner *corners; /* of a cell at first in the order of triangles */
	uint32_t *order;         /* all vertices: a part's are side by side */
	uint8_t *below;          /* [vertices] room */
	uint32_t *swaps;         /* [most corners of a cell] room */
	nt_part *parts;          /* [part_count] pairs that are free */
	size_t part_count;
	nt_scratch *scratch;     /* for more of them; NULL: there are two for each vertex */
	bool limit;              /* a cell would have to be halved more than NT_HALVINGS times */
} nt_cells;

/* Cells with room for so many vertices, which receive their places in `order`, and so many corners in one cell. False
 * when out of memory. */
bool nt_cells_make(nt_scratch *scratch, nt_cell_vertex *vertices, size_t vertex_count, size_t most_corners,
	nt_cells *cells);

/* Finds the representative of a vertex of a cell, if it is not known; and those of others. False: a limit, or out of
 * memory. */
bool nt_cells_find(nt_cells *cells, nt_part *cell, uint32_t vertex);

/* The representative that was found. */
static inline uint32_t nt_cells_found(const nt_cells *cells, uint32_t vertex)
{
	return cells->vertices[vertex].corners & ~NT_CELL_FOUND;
}

#endif
