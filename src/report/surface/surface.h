/* SPDX-License-Identifier: MIT */
/*
 * A mesh as a surface: its triangles, and the points where vertices at one position meet. Normals, texture
 * coordinates and vertex numbers do not matter for what is connected here; they are what is checked afterwards.
 *
 * Side 3 * t + k runs from corner k of triangle t to its next corner.
 */
#ifndef NT_REPORT_SURFACE_H
#define NT_REPORT_SURFACE_H

#include <math.h>
#include "base/numbers.h"
#include "base/scratch.h"
#include "report/surface/box.h"
#include "scene/scene.h"

/* Whether a triangle spans an area in space. */
typedef enum nt_flatness {
	NT_SOUND,
	NT_COLLINEAR,  /* three points on a line */
	NT_COINCIDENT, /* two corners at one position: MikkTSpace's degenerate triangle */
	NT_NOT_FINITE  /* a coordinate is NaN or infinite */
} nt_flatness;

/* Triangles of a block. Every sum is taken by block and then in the order of blocks, so that the last bit
 * does not depend on threads. */
enum { NT_BLOCK = 128 };

/* Sums over the triangles of one block. */
typedef struct nt_block {
	uint32_t triangles[3]; /* mirrored, degenerate, normal: [orientation + 1] */
	double areas[3];       /* the same, in space */
	nt_box box;            /* of finite positions */
	float minimum[2], maximum[2]; /* of the mesh's texture coordinates; NaN is passed over */
} nt_block;

typedef struct nt_surface {
	const nt_mesh *mesh;
	const float *texcoords; /* [vertex_count][2] what is solved by: turned and scaled by a texture transform
	                           where there is one; NULL: none */
	size_t triangle_count;
	uint32_t *corners;    /* [3 * triangle_count] corner of the mesh; NULL: side c begins at corner c */
	uint32_t *faces;      /* [triangle_count] face of the mesh; NULL: triangle t is face t */
	const uint32_t *vertices; /* [3 * triangle_count] vertex of the mesh; NULL: side c begins at vertex c */
	uint32_t *points;     /* [vertex_count] welded position, numbered in order of first use; NT_NONE: no triangle
	                         has the vertex */
	size_t point_count;
	uint64_t *joints;     /* [point_count] bits: points where texture coordinates may differ, since several
	                         vertices are there, or one whose coordinates are NaN */
	int8_t *orientation;  /* [triangle_count] exact sign in UV space, v up; 0 without texture coordinates */
	uint8_t *flatness;    /* [triangle_count] nt_flatness */
	nt_block *blocks;     /* [nt_block_count(triangle_count)] */
	/* by nt_surface_list_sides() */
	uint32_t *sides;      /* [3 * triangle_count] at most, by the lower of their two points */
	const uint32_t *ends; /* [point_count] behind the last one of each point */
	uint32_t *counts;     /* what `ends` is part of */
	uint32_t most_sides;  /* of a point */
} nt_surface;

/* A side of an edge. */
typedef struct nt_edge_side {
	uint32_t side;
	uint32_t high;      /* the edge's higher point */
	int8_t orientation; /* of the triangle */
	bool ascending;     /* it runs from the lower point to the higher one */
} nt_edge_side;

/* An edge that a check marks. */
typedef struct nt_edge {
	uint32_t sides[2]; /* of a boundary edge the only one; of a mirror edge the first unmirrored and the first
	                      mirrored one; of a hard edge the lower one first */
	float cosine;      /* of a hard edge: of the angle between its normals, where it is widest */
	bool against;      /* sides[0] runs against the lowest side of the edge */
	bool non_manifold; /* it has more than two sides */
} nt_edge;

/* Edges by their first sides, ascending. */
typedef struct nt_edges {
	nt_edge *items;
	size_t count;
} nt_edges;

/* Chain i has the edges edges[first[i]] to edges[first[i + 1] - 1]. A chain walks from one edge to the next across the
 * point they share; reversed[k]: edges[k] is walked against its first side. */
typedef struct nt_chains {
	size_t count;
	size_t *first; /* [count + 1] */
	bool *closed;  /* [count] */
	uint32_t *edges;
	bool *reversed;
	size_t left_out; /* triangles that OpenMesh could not take */
} nt_chains;

/* Builds the surface of a loaded mesh, but for orientation, flatness and blocks. Everything is in scratch or the mesh's
 * own. Returns NT_OK or NT_ERROR_MEMORY. */
nt_status nt_surface_build(nt_surface *surface, const nt_mesh *mesh, nt_scratch *scratch);

/* Whether two normals look the same way, 1, or opposite ways, -1, by 60 degrees at most; else 0. points.c */
int nt_compare_normals(const float *a, const float *b);

/* A part of that: sets points, point_count and joints. points.c */
nt_status nt_surface_weld(nt_surface *surface, nt_scratch *scratch);

/* Sets the orientation and flatness of a block's triangles, and the block. The triangles are then in the cache. */
void nt_surface_measure(nt_surface *surface, size_t block);

/* Lists the sides of all triangles that have edges, in memory that the second one frees. Returns NT_OK or
 * NT_ERROR_MEMORY. sides.c */
nt_status nt_surface_list_sides(nt_surface *surface, unsigned threads);
void nt_surface_free_sides(nt_surface *surface);

/* The edges of which a point is the lower one, ordered by the higher one, on each its sides, ascending. `edges` has
 * room for most_sides. Returns how many sides these are. */
size_t nt_surface_edges(const nt_surface *surface, uint32_t low, nt_edge_side *edges);

/*
 * Puts edges in walking order, as closed loops and open chains. These are as long as possible without passing a
 * junction, a point where more than two of the edges meet (unless in fans that have only this point in common); they
 * are ordered by their lowest first side. conflicts: somewhere triangles use an edge in one direction, or more than two
 * share one.
 *
 * Everything is in scratch. Returns NT_OK, NT_ERROR_MEMORY, or NT_ERROR_MODULE and what else opening a module comes to.
 * chains.c
 */
nt_status nt_chains_trace(const nt_surface *surface, const nt_edges *edges, bool conflicts, nt_scratch *scratch,
	nt_chains *chains, nt_error *error);

/* Gives the members of each set one number, in the order of their lowest members. sets: [count] made by nt_unite();
 * what is NT_NONE is no member and stays so. Returns how many sets there are. */
static inline uint32_t nt_number_sets(uint32_t *sets, size_t count)
{
	uint32_t numbers = 0;
	for (size_t i = 0; i < count; i++)
		if (sets[i] != NT_NONE)
			sets[i] = sets[i] == i ? numbers++ : sets[sets[i]]; /* a parent is lower: it has its number */
	return numbers;
}

static inline size_t nt_block_count(const nt_surface *s)
{
	return (s->triangle_count + NT_BLOCK - 1) / NT_BLOCK;
}

/* The triangle after the last one of a block. */
static inline size_t nt_block_end(const nt_surface *s, size_t block)
{
	const size_t end = (block + 1) * NT_BLOCK;
	return end < s->triangle_count ? end : s->triangle_count;
}

static inline uint32_t nt_side_corner(const nt_surface *s, size_t side)
{
	return s->corners ? s->corners[side] : (uint32_t)side;
}

static inline uint32_t nt_triangle_face(const nt_surface *s, size_t triangle)
{
	return s->faces ? s->faces[triangle] : (uint32_t)triangle;
}

static inline uint32_t nt_side_vertex(const nt_surface *s, size_t side)
{
	return s->vertices ? s->vertices[side] : (uint32_t)side;
}

/* The point where a side begins. */
static inline uint32_t nt_side_point(const nt_surface *s, size_t side)
{
	return s->points[nt_side_vertex(s, side)];
}

/* The side after this one in its triangle; its first corner is where this one ends. */
static inline uint32_t nt_side_next(uint32_t side)
{
	return side % 3 == 2 ? side - 2 : side + 1;
}

static inline const float *nt_side_position(const nt_surface *s, size_t side)
{
	return s->mesh->positions + 3 * (size_t)nt_side_vertex(s, side);
}

/* The beginning of a side in UV space; the mesh has texture coordinates. */
static inline const float *nt_side_texcoord(const nt_surface *s, size_t side)
{
	return s->texcoords + 2 * (size_t)nt_side_vertex(s, side);
}

/* Triangles that are coincident or not finite have no edges. */
static inline bool nt_has_edges(const nt_surface *s, size_t triangle)
{
	return s->flatness[triangle] == NT_SOUND || s->flatness[triangle] == NT_COLLINEAR;
}

/* Half a unit in the last place of a float: by how much rounding may have changed it. */
static inline double nt_half_unit(float x)
{
	return 0.5 * ((double)nextafterf(fabsf(x), INFINITY) - (double)fabsf(x));
}

/* Whether rounding of the texture coordinates to float may turn the sign of a triangle's area in UV space. */
bool nt_is_sliver(const nt_surface *s, size_t triangle);

/* The grid that texture coordinates of a mesh were rounded to: by Draco, KHR_mesh_quantization or a few decimals. */
typedef struct nt_texcoord_grid {
	double range[2][2];       /* of coordinates along an axis */
	bool asked;               /* whether what follows is known */
	double step[2], noise[2]; /* along an axis; step 0: there is no grid */
} nt_texcoord_grid;

nt_texcoord_grid nt_texcoord_grid_of(const nt_surface *s);

/* Whether rounding of the texture coordinates, to float or to their grid, may turn a triangle. */
bool nt_may_be_turned(const nt_surface *s, nt_texcoord_grid *grid, size_t triangle);

/* The area of a triangle in space; 0 where it is not finite. */
double nt_triangle_area(const nt_surface *s, size_t triangle);
double nt_uv_area(const nt_surface *s, size_t triangle); /* the same of its texture coordinates */

/* Whether two sides of one edge lie on each other in UV space. */
static inline bool nt_sides_meet(const nt_surface *s, uint32_t a, uint32_t b)
{
	const bool same_way = nt_side_point(s, a) == nt_side_point(s, b);
	const float *a0 = nt_side_texcoord(s, a), *a1 = nt_side_texcoord(s, nt_side_next(a));
	const float *b0 = nt_side_texcoord(s, same_way ? b : nt_side_next(b));
	const float *b1 = nt_side_texcoord(s, same_way ? nt_side_next(b) : b);
	return a0[0] == b0[0] && a0[1] == b0[1] && a1[0] == b1[0] && a1[1] == b1[1];
}

/* ---- other meshes of a scene that may share the texels of one: others.c ---- */

/* Meshes by what a sampler takes alike. */
typedef struct nt_other nt_other;
typedef struct nt_others {
	size_t faces;    /* of other meshes that checks of a mesh may still look at */
	nt_other *all;   /* [count] by sampler; NULL: nobody asked */
	uint32_t *built; /* of a sampler's first one: how many are in its tree; NT_NONE: nobody asked */
	size_t count;
	uint32_t *textures, *met; /* [material_count + 1] by islands.c: numbers of the images of materials, the last of
	                             none; of an image, one more than the mesh that had it last */
} nt_others;

/* The unmirrored triangles of a mesh that is no surface, quads cut anyhow: those of `face` come next. */
typedef struct nt_mesh_triangles {
	const nt_mesh *mesh;
	size_t face, first, turn;
} nt_mesh_triangles;

/* The place that a sampler looks up along an axis, for a coordinate of the surface: repeated modulo 1, mirrored
 * folded, clamped (inside the texture) or in tiles as it stands. Offsets that move all alike are left out. */
static inline double nt_wrap_coordinate(const nt_mesh *mesh, int axis, double coordinate)
{
	const nt_wrap wrap = mesh->wrap[axis];
	const double x = coordinate + mesh->wrap_offset[axis];
	if (wrap == NT_WRAP_CLAMP || wrap == NT_WRAP_TILES)
		return x;
	const double tile = floor(x), within = x - tile;
	return wrap == NT_WRAP_MIRRORED && fmod(tile, 2.0) != 0.0 ? 1.0 - within : within;
}

/* Goes to the next one; false: there is none. */
bool nt_next_unmirrored(nt_mesh_triangles *at, const float *texcoords[3]);

/* Calls visit for the meshes whose unmirrored triangles, as a sampler takes them, may reach into a box of UV space of
 * a mesh that the sampler takes alike, which may be among them, until it returns false. */
nt_status nt_others_ask(nt_others *others, const nt_scene *scene, const nt_mesh *mesh, const double minimum[2],
	const double maximum[2], bool (*visit)(void *context, const nt_mesh *other), void *context);
void nt_others_free(nt_others *others);

/* ---- sets of numbers: union and find, the lower number on top ---- */

/* Parents only ever become lower, whatever other threads unite at the same time; so the result does not depend on their
 * order. */
/* parents[i] is i at first. */
static inline uint32_t nt_find_root(uint32_t *parents, uint32_t i)
{
	for (;;) {
		const uint32_t parent = __atomic_load_n(&parents[i], __ATOMIC_RELAXED);
		if (parent == i)
			return i;
		const uint32_t above = __atomic_load_n(&parents[parent], __ATOMIC_RELAXED);
		if (above != parent)
			__atomic_store_n(&parents[i], above, __ATOMIC_RELAXED);
		i = above;
	}
}

static inline void nt_unite(uint32_t *parents, uint32_t a, uint32_t b)
{
	for (;;) {
		a = nt_find_root(parents, a);
		b = nt_find_root(parents, b);
		if (a == b)
			return;
		uint32_t high = a > b ? a : b;
		const uint32_t low = a > b ? b : a;
		if (__atomic_compare_exchange_n(&parents[high], &high, low, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
			return;
	}
}

#endif
