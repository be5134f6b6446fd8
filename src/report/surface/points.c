/* SPDX-License-Identifier: MIT */
/*
 * Points: vertices whose positions are equal, compared as floats (0 equals -0, NaN equals nothing, no epsilon),
 * numbered by the first side that begins at any of them.
 *
 * A sheet that is there twice, front and back, shares no edge for MikkTSpace, which compares normals too. So its points
 * are two: if all triangles at a point lie on their reverse, with opposite normals, the vertices whose normals are
 * against the first one's get a point of their own. Anything else that touches stays connected.
 */
#include "report/surface/surface.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash.h"
#include "base/vec.h"

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

/* ---- sheets that are there twice ---- */

int nt_compare_normals(const float *a, const float *b)
{
	const nt_dvec3 x = nt_dvec3_load(a), y = nt_dvec3_load(b);
	const double dot = nt_dvec3_dot(x, y), both = nt_dvec3_dot(x, x) * nt_dvec3_dot(y, y);
	return dot * dot >= 0.25 * both ? (dot > 0.0) - (dot < 0.0) : 0;
}

static int compare_normals(const nt_mesh *mesh, uint32_t a, uint32_t b)
{
	return nt_compare_normals(mesh->normals + 3 * (size_t)a, mesh->normals + 3 * (size_t)b);
}

/* The same as -1, for what is asked of many. */
static bool is_against(const nt_mesh *mesh, uint32_t a, uint32_t b)
{
	const float *x = mesh->normals + 3 * (size_t)a, *y = mesh->normals + 3 * (size_t)b;
	return x[0] * y[0] + x[1] * y[1] + x[2] * y[2] < 0.0f && compare_normals(mesh, a, b) < 0;
}

/* A triangle, or a quad however it is cut. */
typedef struct outline {
	uint32_t points[4]; /* in the order, of all that go around it, that is the least; NT_NONE behind a third */
	int turn;           /* 1: the face goes around that way, -1: the other way, 0: that is the same */
	uint32_t triangle;  /* its first */
} outline;

static int by_points(const void *a, const void *b)
{
	const outline *x = a, *y = b;
	const int order = memcmp(x->points, y->points, sizeof x->points);
	return order ? order : x->triangle < y->triangle ? -1 : x->triangle > y->triangle;
}

/* The corners of a quad follow each other, and both ways to cut it begin with its first one. */
static outline find_outline(const nt_surface *s, size_t t, size_t size)
{
	outline best = {.triangle = (uint32_t)t};
	uint32_t points[4];
	for (size_t k = 0; k < size; k++) {
		const uint32_t corner = nt_side_corner(s, 3 * t) + (uint32_t)k;
		points[k] = size == 3 ? nt_side_point(s, 3 * t + k)
				      : s->points[s->mesh->indices ? s->mesh->indices[corner] : corner];
	}
	for (size_t way = 0; way < 2 * size; way++) {
		outline next = {{NT_NONE, NT_NONE, NT_NONE, NT_NONE}, way % 2 ? -1 : 1, (uint32_t)t};
		for (size_t k = 0; k < size; k++)
			next.points[k] = points[(way / 2 + (way % 2 ? size - k : k)) % size];
		const int order = way ? by_points(&next, &best) : -1;
		if (order < 0)
			best = next;
		else if (order == 0 && next.turn != best.turn)
			best.turn = 0;
	}
	return best;
}

/* Whether two faces of the same outline are each other's reverse and lit so. */
static bool is_reverse(const nt_surface *s, const outline *a, const outline *b, size_t size)
{
	const size_t sides = 3 * (size - 2), first = 3 * (size_t)a->triangle, second = 3 * (size_t)b->triangle;
	if (a->turn + b->turn)
		return false;
	for (size_t side = first; side < first + sides; side++)
		for (size_t other = second; other < second + sides; other++)
			if (nt_side_point(s, side) == nt_side_point(s, other) &&
				!is_against(s->mesh, nt_side_vertex(s, side), nt_side_vertex(s, other)))
				return false;
	return true;
}

/* Whether a face of `size` corners begins with a triangle, is not paired, and has only such points. */
static bool may_be_doubled(const nt_surface *s, const uint64_t *doubled, const uint64_t *paired, size_t t, size_t size)
{
	if (nt_bit(paired, t) || (size == 4 && (t + 1 == s->triangle_count || s->faces[t] != s->faces[t + 1])))
		return false;
	bool all = true;
	for (size_t side = 3 * t; side < 3 * (t + size - 2) && all; side++)
		all = nt_bit(doubled, nt_side_point(s, side));
	return all;
}

/* paired: [triangle_count] bits; sets those of faces of `size` corners that are there twice. */
static nt_status pair_faces(const nt_surface *s, const uint64_t *doubled, uint64_t *paired, size_t size,
	nt_scratch *scratch)
{
	size_t count = 0, added = 0;
	for (size_t t = 0; t < s->triangle_count; t++)
		count += may_be_doubled(s, doubled, paired, t, size);
	outline *list = nt_scratch_alloc(scratch, count, sizeof *list);
	if (!list)
		return NT_ERROR_MEMORY;
	for (size_t t = 0; t < s->triangle_count && added < count; t++)
		if (may_be_doubled(s, doubled, paired, t, size))
			list[added++] = find_outline(s, t, size);
	if (count)
		qsort(list, count, sizeof *list, by_points);
	for (size_t i = 0, end; i < count; i = end) {
		for (end = i + 1; end < count && !memcmp(list[end].points, list[i].points, sizeof list->points);)
			end++;
		if (end - i != 2 || !is_reverse(s, &list[i], &list[i + 1], size))
			continue;
		for (uint32_t k = 0; k < size - 2; k++) {
			nt_bit_set(paired, list[i].triangle + k);
			nt_bit_set(paired, list[i + 1].triangle + k);
		}
	}
	return NT_OK;
}

/*
 * doubled: [point_count] bits, in: points with opposite normals; out: those where all triangles are there twice. Front
 * and back of a quad may be cut along different diagonals, so that quads are compared before their triangles are.
 */
static nt_status find_doubled(const nt_surface *s, uint64_t *doubled, nt_scratch *scratch)
{
	const size_t words = nt_bit_words(s->triangle_count);
	uint64_t *paired = nt_scratch_alloc(scratch, words, sizeof *paired);
	if (!paired)
		return NT_ERROR_MEMORY;
	memset(paired, 0, words * sizeof *paired);
	if ((s->faces && pair_faces(s, doubled, paired, 4, scratch)) || pair_faces(s, doubled, paired, 3, scratch))
		return NT_ERROR_MEMORY;
	for (size_t side = 0; side < 3 * s->triangle_count; side++)
		if (!nt_bit(paired, side / 3))
			nt_bit_clear(doubled, nt_side_point(s, side));
	return NT_OK;
}

/* Gives the backs of doubled points points of their own, behind all others. */
static nt_status separate_sheets(nt_surface *s, uint64_t *doubled, nt_scratch *scratch)
{
	const size_t before = s->point_count;
	const nt_status status = find_doubled(s, doubled, scratch);
	uint32_t *front = nt_scratch_alloc(scratch, before, sizeof *front);
	uint32_t *back = nt_scratch_alloc(scratch, before, sizeof *back);
	if (status || !front || !back)
		return NT_ERROR_MEMORY;
	memset(front, 0xff, before * sizeof *front);
	memset(back, 0xff, before * sizeof *back);
	for (size_t side = 0; side < 3 * s->triangle_count; side++) {
		const uint32_t v = nt_side_vertex(s, side), point = s->points[v];
		if (!nt_bit(doubled, point))
			continue;
		if (front[point] == NT_NONE)
			front[point] = v;
		if (!compare_normals(s->mesh, front[point], v))
			nt_bit_clear(doubled, point);
	}
	for (size_t side = 0; side < 3 * s->triangle_count; side++) {
		const uint32_t v = nt_side_vertex(s, side), point = s->points[v];
		if (point >= before || !nt_bit(doubled, point) || compare_normals(s->mesh, front[point], v) > 0)
			continue;
		if (back[point] == NT_NONE)
			back[point] = (uint32_t)s->point_count++;
		s->points[v] = back[point];
		nt_bit_set(s->joints, back[point]);
	}
	return NT_OK;
}

/* ---- welding ---- */

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
	uint64_t *opposed = nt_scratch_alloc(scratch, nt_bit_words(vertices), sizeof *opposed);
	size_t opposed_count = 0;
	uint32_t *table = nt_scratch_alloc(scratch, size, sizeof *table);
	if (!s->points || !s->joints || !opposed || !table)
		return NT_ERROR_MEMORY;
	memset(s->points, 0xff, vertices * sizeof *s->points);
	memset(s->joints, 0, nt_bit_words(vertices) * sizeof *s->joints);
	memset(opposed, 0, nt_bit_words(vertices) * sizeof *opposed);
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
		if (*place && mesh->normals && is_against(mesh, *place - 1, v)) {
			nt_bit_set(opposed, s->points[v]);
			opposed_count++;
		}
		if (same_position(position, position))
			*place = v + 1;
	}
	/* a triangle has three */
	const nt_status status = opposed_count > 2 ? separate_sheets(s, opposed, scratch) : NT_OK;
	nt_scratch_back(scratch, mark);
	return status;
}
