/* SPDX-License-Identifier: MIT */
/*
 * Triangles, points and edges: see surface.h.
 *
 * Points are welded by hashing positions, compared as floats (0 equals -0, NaN equals nothing, no
 * epsilon). Edges come from a counting sort of the sides by their lower point and a small sort within
 * each point, so time is linear but for the log of a point's valence.
 */
#include "report/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "topology/orientation.h"

/* Ranges that threads take; fewer items are not worth one. */
enum { GRAIN = 32768 };

static uint32_t vertex_of(const nt_mesh *mesh, size_t corner)
{
	return mesh->indices ? mesh->indices[corner] : (uint32_t)corner;
}

/* Quads are cut, so that corners, faces and vertices are lists of their own. */
typedef struct cut_lists {
	uint32_t *corners, *faces, *vertices;
} cut_lists;

static void add_triangle(nt_surface *s, const cut_lists *lists, size_t face, size_t first, const unsigned char order[3])
{
	const size_t t = s->triangle_count++;
	lists->faces[t] = (uint32_t)face;
	for (size_t k = 0; k < 3; k++) {
		lists->corners[3 * t + k] = (uint32_t)(first + order[k]);
		lists->vertices[3 * t + k] = vertex_of(s->mesh, first + order[k]);
	}
}

/* The row of nt_quad_triangles that cuts the quad whose first corner is `first`. Without texture
 * coordinates they are all taken as equal, which leaves the choice to the positions. */
static int quad_cut(const nt_surface *s, size_t first)
{
	static const float nowhere[2];
	const float *uv[4], *p[4];
	for (size_t k = 0; k < 4; k++) {
		const size_t vertex = vertex_of(s->mesh, first + k);
		uv[k] = s->texcoords ? s->texcoords + 2 * vertex : nowhere;
		p[k] = s->mesh->positions + 3 * vertex;
	}
	return nt_quad_diagonal(uv, p);
}

static nt_status cut_faces(nt_surface *s, size_t triangle_count, nt_scratch *scratch)
{
	static const unsigned char in_order[3] = {0, 1, 2};
	const nt_mesh *mesh = s->mesh;
	const cut_lists lists = {nt_scratch_alloc(scratch, 3 * triangle_count, sizeof *lists.corners),
		nt_scratch_alloc(scratch, triangle_count, sizeof *lists.faces),
		nt_scratch_alloc(scratch, 3 * triangle_count, sizeof *lists.vertices)};
	if (!lists.corners || !lists.faces || !lists.vertices)
		return NT_ERROR_MEMORY;
	size_t first = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		if (mesh->face_sizes[face] == 3) {
			add_triangle(s, &lists, face, first, in_order);
			first += 3;
			continue;
		}
		const int cut = quad_cut(s, first);
		add_triangle(s, &lists, face, first, nt_quad_triangles[cut][0]);
		add_triangle(s, &lists, face, first, nt_quad_triangles[cut][1]);
		first += 4;
	}
	s->corners = lists.corners;
	s->faces = lists.faces;
	s->vertices = lists.vertices;
	return NT_OK;
}

/* Triangles alone are what the mesh has already. */
static nt_status list_triangles(nt_surface *s, nt_scratch *scratch)
{
	const nt_mesh *mesh = s->mesh;
	size_t quads = 0;
	for (size_t f = 0; mesh->face_sizes && f < mesh->face_count; f++)
		quads += mesh->face_sizes[f] == 4;
	if (quads)
		return cut_faces(s, mesh->face_count + quads, scratch);
	s->triangle_count = mesh->face_count;
	s->vertices = mesh->indices;
	if (mesh->indices)
		return NT_OK;
	uint32_t *vertices = nt_scratch_alloc(scratch, 3 * s->triangle_count, sizeof *vertices);
	if (!vertices)
		return NT_ERROR_MEMORY;
	for (size_t c = 0; c < 3 * s->triangle_count; c++)
		vertices[c] = (uint32_t)c;
	s->vertices = vertices;
	return NT_OK;
}

static nt_status allocate(nt_surface *s, nt_scratch *scratch)
{
	const size_t count = s->triangle_count;
	s->points = nt_scratch_alloc(scratch, 3 * count, sizeof *s->points);
	s->orientation = nt_scratch_alloc(scratch, count, sizeof *s->orientation);
	s->flatness = nt_scratch_alloc(scratch, count, sizeof *s->flatness);
	s->areas = nt_scratch_alloc(scratch, count, sizeof *s->areas);
	return s->points && s->orientation && s->flatness && s->areas ? NT_OK : NT_ERROR_MEMORY;
}

static uint32_t hash_position(const float *p)
{
	uint32_t hash = 0;
	for (int i = 0; i < 3; i++) {
		const float value = p[i] + 0.0f; /* -0 becomes 0 */
		uint32_t bits;
		memcpy(&bits, &value, sizeof bits);
		hash = (hash ^ bits) * 0x9e3779b1u;
		hash ^= hash >> 15;
	}
	return hash * 0x85ebca6bu;
}

/* Numbers positions in order of first use. */
static nt_status weld_points(nt_surface *s, nt_scratch *scratch)
{
	const nt_mesh *mesh = s->mesh;
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	size_t capacity = 16;
	while (capacity < 2 * mesh->vertex_count)
		capacity *= 2;
	uint32_t *table = nt_scratch_alloc(scratch, capacity, sizeof *table); /* a vertex per point */
	uint32_t *point_of = nt_scratch_alloc(scratch, mesh->vertex_count, sizeof *point_of);
	if (!table || !point_of)
		return NT_ERROR_MEMORY;
	memset(table, 0xff, capacity * sizeof *table);
	memset(point_of, 0xff, mesh->vertex_count * sizeof *point_of);
	for (size_t c = 0; c < 3 * s->triangle_count; c++) {
		const uint32_t vertex = s->vertices[c];
		if (point_of[vertex] == NT_NONE) {
			const float *p = mesh->positions + 3 * (size_t)vertex;
			size_t slot = hash_position(p) & (capacity - 1);
			for (; table[slot] != NT_NONE; slot = (slot + 1) & (capacity - 1)) {
				const float *q = mesh->positions + 3 * (size_t)table[slot];
				if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2])
					break;
			}
			if (table[slot] == NT_NONE) {
				/* NaN equals nothing, and need not be looked for again either */
				if (p[0] == p[0] && p[1] == p[1] && p[2] == p[2])
					table[slot] = vertex;
				point_of[vertex] = (uint32_t)s->point_count++;
			} else {
				point_of[vertex] = point_of[table[slot]];
			}
		}
		s->points[c] = point_of[vertex];
	}
	nt_scratch_back(scratch, mark);
	return NT_OK;
}

static void measure_triangle(nt_surface *s, size_t t)
{
	const float *a = nt_side_position(s, (uint32_t)(3 * t));
	const float *b = nt_side_position(s, (uint32_t)(3 * t + 1));
	const float *c = nt_side_position(s, (uint32_t)(3 * t + 2));
	const double ux = (double)b[0] - a[0], uy = (double)b[1] - a[1], uz = (double)b[2] - a[2];
	const double vx = (double)c[0] - a[0], vy = (double)c[1] - a[1], vz = (double)c[2] - a[2];
	const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
	const double area = 0.5 * sqrt(nx * nx + ny * ny + nz * nz);
	const uint32_t *points = s->points + 3 * t;
	if (!isfinite(area))
		s->flatness[t] = NT_NOT_FINITE;
	else if (points[0] == points[1] || points[1] == points[2] || points[2] == points[0])
		s->flatness[t] = NT_COINCIDENT;
	else
		s->flatness[t] = area > 0.0 ? NT_SOUND : NT_COLLINEAR;
	s->areas[t] = isfinite(area) ? area : 0.0;
	/* of a texture transform the exact sign, not that of its rounded result */
	const bool exact = s->mesh->solve_texcoords && s->mesh->solve_sign;
	const float *texcoords = exact ? s->mesh->texcoords : s->texcoords;
	const uint32_t *v = s->vertices + 3 * t;
	s->orientation[t] = 0;
	if (texcoords)
		s->orientation[t] = (int8_t)(nt_orientation(texcoords + 2 * (size_t)v[0],
			texcoords + 2 * (size_t)v[1], texcoords + 2 * (size_t)v[2]) *
			(exact ? s->mesh->solve_sign : 1));
}

static void measure_range(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	for (size_t t = begin; t < end; t++)
		measure_triangle(context, t);
}

/* ---- edges ---- */

typedef struct edge_end {
	uint32_t other, side;
} edge_end;

static int by_other(const void *a, const void *b)
{
	const edge_end *x = a, *y = b;
	if (x->other != y->other)
		return x->other < y->other ? -1 : 1;
	return x->side < y->side ? -1 : x->side > y->side;
}

/* Most points have six sides or fewer; insertion is then much faster than a call of qsort. */
static void sort_ends(edge_end *ends, size_t count)
{
	if (count > 24) {
		qsort(ends, count, sizeof *ends, by_other);
		return;
	}
	for (size_t i = 1; i < count; i++) {
		const edge_end end = ends[i];
		size_t k = i;
		for (; k > 0 && by_other(&end, &ends[k - 1]) < 0; k--)
			ends[k] = ends[k - 1];
		ends[k] = end;
	}
}

static bool has_edges(const nt_surface *s, size_t t)
{
	return s->flatness[t] == NT_SOUND || s->flatness[t] == NT_COLLINEAR;
}

/* Sorts the sides by their lower point: s->sides[first[p]] to s->sides[first[p + 1] - 1] are those of p. Returns the
 * most sides that a point has. */
static size_t bucket_sides(const nt_surface *s, uint32_t *first)
{
	uint32_t most = 0;
	memset(first, 0, (s->point_count + 2) * sizeof *first);
	for (int pass = 0; pass < 2; pass++) {
		for (size_t t = 0; t < s->triangle_count; t++) {
			if (!has_edges(s, t))
				continue;
			for (size_t k = 0; k < 3; k++) {
				const uint32_t side = (uint32_t)(3 * t + k);
				const uint32_t a = s->points[side], b = s->points[nt_side_next(side)];
				const uint32_t low = a < b ? a : b;
				if (pass == 0)
					first[low + 2]++;
				else
					s->sides[first[low + 1]++] = side;
			}
		}
		for (size_t p = 0; pass == 0 && p < s->point_count; p++) {
			most = first[p + 2] > most ? first[p + 2] : most;
			first[p + 2] += first[p + 1];
		}
	}
	return most;
}

/* Ranges of points, each of which finds its edges. */
typedef struct edge_work {
	nt_surface *s;
	const uint32_t *first; /* [point_count + 1] */
	edge_end *ends;        /* [slots][most] */
	size_t most;
	struct edge_range {
		size_t begin, count; /* where its edges are listed in edge_first */
	} *ranges;             /* [slots] */
} edge_work;

/* Puts the sides of each point in order and lists where edges begin, from the range's first side on: there are no more
 * edges than sides. */
static void find_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const edge_work *work = context;
	nt_surface *s = work->s;
	edge_end *ends = work->ends + slot * work->most;
	size_t edge = work->first[begin];
	work->ranges[slot].begin = edge;
	for (size_t p = begin; p < end; p++) {
		const size_t base = work->first[p], count = work->first[p + 1] - base;
		for (size_t i = 0; i < count; i++) {
			const uint32_t side = s->sides[base + i], a = s->points[side], b = s->points[nt_side_next(side)];
			ends[i] = (edge_end){a < b ? b : a, side};
		}
		sort_ends(ends, count);
		for (size_t i = 0; i < count; i++) {
			if (i == 0 || ends[i].other != ends[i - 1].other)
				s->edge_first[edge++] = (uint32_t)(base + i);
			s->sides[base + i] = ends[i].side;
		}
	}
	work->ranges[slot].count = edge - work->ranges[slot].begin;
}

static nt_status find_edges(nt_surface *s, unsigned threads, nt_scratch *scratch)
{
	const size_t side_count = 3 * s->triangle_count;
	s->edge_first = nt_scratch_alloc(scratch, side_count + 1, sizeof *s->edge_first);
	s->sides = nt_scratch_alloc(scratch, side_count, sizeof *s->sides);
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	uint32_t *first = nt_scratch_alloc(scratch, s->point_count + 2, sizeof *first);
	if (!s->edge_first || !s->sides || !first)
		return NT_ERROR_MEMORY;
	edge_work work = {.s = s, .first = first, .most = bucket_sides(s, first)};
	if (!work.most) /* nothing has edges */
		work.most = 1;
	const unsigned slots = nt_parallel_slots(threads, s->point_count, GRAIN);
	work.ends = nt_scratch_alloc(scratch, slots * work.most, sizeof *work.ends);
	work.ranges = nt_scratch_alloc(scratch, slots, sizeof *work.ranges);
	if (!work.ends || !work.ranges)
		return NT_ERROR_MEMORY;
	nt_parallel_ranges(threads, s->point_count, GRAIN, find_range, &work);
	for (unsigned slot = 0; slot < slots && s->point_count; slot++) {
		memmove(s->edge_first + s->edge_count, s->edge_first + work.ranges[slot].begin,
			work.ranges[slot].count * sizeof *s->edge_first);
		s->edge_count += work.ranges[slot].count;
	}
	s->edge_first[s->edge_count] = first[s->point_count];
	nt_scratch_back(scratch, mark);
	return NT_OK;
}

nt_status nt_surface_build(nt_surface *surface, const nt_mesh *mesh, unsigned threads, nt_scratch *scratch)
{
	*surface = (nt_surface){.mesh = mesh,
		.texcoords = mesh->solve_texcoords ? mesh->solve_texcoords : mesh->texcoords};
	nt_status status = list_triangles(surface, scratch);
	if (!status)
		status = allocate(surface, scratch);
	if (!status)
		status = weld_points(surface, scratch);
	if (status)
		return status;
	nt_parallel_ranges(threads, surface->triangle_count, GRAIN, measure_range, surface);
	return find_edges(surface, threads, scratch);
}
