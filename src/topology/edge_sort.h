/* SPDX-License-Identifier: MIT */
/*
 * The edges that mikktspace.c as published leaves unsorted (spec page, step 5). The published code sorts edges by
 * lower vertex, then higher vertex, then triangle, but skips the last run of each pass. Around the vertex of that run,
 * triangles may be paired differently.
 */
#ifndef NT_TOPOLOGY_EDGE_SORT_H
#define NT_TOPOLOGY_EDGE_SORT_H

#include "base/scratch.h"
#include "topology/adjacency.h"

/* ---- representatives of vertices ---- */

/*
 * Which of its corners stands for a welded vertex in mikktspace.c as published (spec page, step 2). Nearly always
 * nobody can tell; the edge sort can.
 *
 * The published weld sorts corners into 2048 cells along the longest axis of the box of all positions, halves each
 * cell by the middle of its box until nothing is left to halve, swapping corners from both ends, and lets the first
 * corner of each half that is equal stand for the others. So it may be any of them, but it depends on those in the
 * same cell alone.
 */

enum { NT_CELLS = 2048 };

/* A cell is halved so often at most; one with floats of ordinary sizes needs about 40. */
enum { NT_HALVINGS = 128 };

/* The box of some rows; the last of each four is of no use. */
typedef struct nt_row_box {
	float low[4], high[4];
} nt_row_box;

/* The rule by which the published weld chooses an axis. */
static inline unsigned nt_longest_axis(const nt_row_box *b)
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
	const nt_row_box *box;	/* of all rows; NULL: not known */
	const nt_adjacency *adjacency; /* of all triangles, in one range; NULL: there is none */
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

/* Finds the point at which a part is halved, and along which axis. False: nothing is left to halve. */
bool nt_cells_find_middle(const nt_cells *cells, nt_part *part);

/* Finds the representative of a vertex of a cell, if it is not known; and those of others. False: a limit, or out of
 * memory. */
bool nt_cells_find(nt_cells *cells, nt_part *cell, uint32_t vertex);

/* The representative that was found. */
static inline uint32_t nt_cells_found(const nt_cells *cells, uint32_t vertex)
{
	return cells->vertices[vertex].corners & ~NT_CELL_FOUND;
}

/* ---- unsorted edges ---- */

#define NT_NO_NEIGHBOUR UINT32_MAX

/* Meshes of more corners are beyond the limit. */
#define NT_EDGE_SORT_CORNERS ((size_t)1 << 28)

/* An edge, and its neighbour as mikktspace.c pairs it if it leaves the edge unsorted. */
typedef struct nt_unsorted_edge {
	uint32_t edge;	    /* 3 * triangle + k: from corner k to the next */
	uint32_t neighbour; /* triangle on its other side, or NT_NO_NEIGHBOUR */
} nt_unsorted_edge;

typedef struct nt_unsorted {
	nt_unsorted_edge *edges; /* [count] ascending: those that are paired otherwise than if they were sorted */
	size_t count;
	bool limit; /* positions or work are beyond a limit: what is published is not known, count is 0 */
} nt_unsorted;

/* Keys that are looked at to find the order of the last run, for each edge. */
enum { NT_EDGE_SORT_VISITS = 64 };

/* So few triangles have a quicker way to the answer, which is nearly always that the order does not matter. */
enum { NT_EDGE_FEW = 512 };

static inline bool nt_edge_are_few(const nt_welded_mesh *mesh)
{
	return mesh->triangle_count <= NT_EDGE_FEW && mesh->vertex_count <= 3 * NT_EDGE_FEW && !mesh->triangles->cuts &&
	       mesh->adjacency;
}

/* Triangles first + i with bit i, and at most so many. */
typedef struct nt_edge_note {
	uint32_t first, triangles;
} nt_edge_note;

enum { NT_EDGE_NOTE_LEAST = 31, NT_EDGE_NOTE_MOST = 32, NT_EDGE_BINS = 1024 };

/* The last triangles decide most, with all that is in the cells of their vertices. A bin has two cells: triangles with
 * a corner in one of certain bins are noted while the sums have their corners in lanes. */
typedef struct nt_edge_tail {
	nt_edge_note *notes; /* see nt_edge_notes(); NULL: there is nothing to note */
	nt_triangle_ranges ranges;
	nt_grid grid;
	uint32_t extremes[6];                /* vertices at the sides of the grid's box */
	bool is_grid_of_used;                /* the box is that of vertices which have corners */
	float scale;                         /* bins for each unit of length */
	uint32_t bins[NT_EDGE_BINS / 32];    /* a bit for each */
} nt_edge_tail;

static inline bool nt_edge_is_near(const nt_edge_tail *tail, float coordinate)
{
	const uint32_t bin = (uint32_t)(int)((coordinate - tail->grid.low) * tail->scale);
	return tail->bins[bin / 32] >> bin % 32 & 1;
}

/* The notes of a range of triangles, ascending; the last one has no triangles. The sums take NT_EDGE_NOTE_LEAST or more
 * at a time, but for the last. */
static inline nt_edge_note *nt_edge_notes(const nt_edge_tail *tail, unsigned range)
{
	return tail->notes + tail->ranges.bounds[range] / NT_EDGE_NOTE_LEAST + 2 * range;
}

/* Says what is to be noted of a mesh, in memory that is used until the question is asked. The sums of few triangles
 * have nothing to note. Returns NMTAN_OK or NMTAN_ERROR_MEMORY. */
nmtan_status nt_edge_tail_make(const nt_welded_mesh *mesh, const nt_triangle_ranges *ranges, nt_borrowed *memory,
	nt_edge_tail *tail);

/* Expected linear time. The result's edges come from `memory`, which may be that of the mesh. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY.
 *
 *   tail    with notes of all triangles; NULL: none have been noted */
nmtan_status nt_find_unsorted(const nt_welded_mesh *mesh, const nt_edge_tail *tail, nt_scratch *memory,
	nt_unsorted *unsorted);

/* The neighbour across an edge as published; false: it is the same as if all were sorted. */
bool nt_unsorted_neighbour(const nt_unsorted *unsorted, uint32_t edge, uint32_t *neighbour);

#endif
