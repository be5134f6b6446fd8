/* SPDX-License-Identifier: MIT */
/*
 * A mesh as a surface: its triangles, the points where vertices at one position meet, and the edges
 * between points with the triangles on them. Normals, texture coordinates and vertex numbers do not
 * matter for what is connected here; they are what is checked afterwards.
 *
 * Side 3 * t + k runs from corner k of triangle t to its next corner.
 */
#ifndef NT_REPORT_SURFACE_H
#define NT_REPORT_SURFACE_H

#include "base/scratch.h"
#include "scene/scene.h"

/* Whether a triangle spans an area in space. */
typedef enum nt_flatness {
	NT_SOUND,
	NT_COLLINEAR,  /* three points on a line */
	NT_COINCIDENT, /* two corners at one position: MikkTSpace's degenerate triangle */
	NT_NOT_FINITE  /* a coordinate is NaN or infinite */
} nt_flatness;

typedef struct nt_surface {
	const nt_mesh *mesh;
	const float *texcoords; /* [vertex_count][2] what is solved by: turned and scaled by a texture transform
	                           where there is one; NULL: none */
	size_t triangle_count;
	uint32_t *corners;    /* [3 * triangle_count] corner of the mesh; NULL: side c begins at corner c */
	uint32_t *faces;      /* [triangle_count] face of the mesh; NULL: triangle t is face t */
	const uint32_t *vertices; /* [3 * triangle_count] vertex of the mesh */
	uint32_t *points;     /* [3 * triangle_count] welded position */
	size_t point_count;
	int8_t *orientation;  /* [triangle_count] exact sign in UV space, v up; 0 without texture coordinates */
	uint8_t *flatness;    /* [triangle_count] nt_flatness */
	double *areas;        /* [triangle_count] in space */

	/* Edges between different points, ordered by their lower point, then the higher one, and on each its
	 * sides, ascending. Triangles that are coincident or not finite have no edges. */
	size_t edge_count;
	uint32_t *edge_first; /* [edge_count + 1] into sides */
	uint32_t *sides;
} nt_surface;

/* Builds the surface of a loaded mesh on up to `threads` threads; it does not depend on how many. Everything is in
 * scratch or the mesh's own. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_surface_build(nt_surface *surface, const nt_mesh *mesh, unsigned threads, nt_scratch *scratch);

static inline uint32_t nt_side_corner(const nt_surface *s, size_t side)
{
	return s->corners ? s->corners[side] : (uint32_t)side;
}

/* The side after this one in its triangle; its first corner is where this one ends. */
static inline uint32_t nt_side_next(uint32_t side)
{
	return side % 3 == 2 ? side - 2 : side + 1;
}

static inline const float *nt_side_position(const nt_surface *s, uint32_t side)
{
	return s->mesh->positions + 3 * (size_t)s->vertices[side];
}

/* Where a side begins in UV space; the mesh has texture coordinates. */
static inline const float *nt_side_texcoord(const nt_surface *s, uint32_t side)
{
	return s->texcoords + 2 * (size_t)s->vertices[side];
}

/* Whether two sides of one edge lie on each other in UV space. */
static inline bool nt_sides_meet(const nt_surface *s, uint32_t a, uint32_t b)
{
	const bool same_way = s->points[a] == s->points[b];
	const float *a0 = nt_side_texcoord(s, a), *a1 = nt_side_texcoord(s, nt_side_next(a));
	const float *b0 = nt_side_texcoord(s, same_way ? b : nt_side_next(b));
	const float *b1 = nt_side_texcoord(s, same_way ? nt_side_next(b) : b);
	return a0[0] == b0[0] && a0[1] == b0[1] && a1[0] == b1[0] && a1[1] == b1[1];
}

#endif
