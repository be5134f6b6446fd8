/* SPDX-License-Identifier: MIT */
/*
 * MikkTSpace, the definition: one pass after the other, as a student would write it from the paper
 * (M. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008). Its bytes are those of the
 * reference implementation as published, or with its edge sort completed; every faster path is held
 * against this file.
 *
 *   1 cut quads into triangles        5 pair triangles across edges
 *   2 weld equal corners              6 flood groups of one orientation around each vertex
 *   3 put degenerate triangles aside  7 split groups by angle, average each part
 *   4 solve each triangle's frame     8 give degenerate triangles a neighbour's answer
 *
 * All arithmetic is float, in the order written; double only inside the angle's arc cosine. Time grows with
 * n log n (sorting the edges of a vertex) but for the split by angle, which compares all pairs of a
 * group. Memory: about 150 bytes per triangle.
 */
#include "tangent/solve.h"

#include <stdlib.h>
#include <string.h>
#include "base/vec.h"
#include "tangent/acos.h"
#include "topology/corners.h"
#include "topology/edge_sort.h"

#define NO_TRIANGLE UINT32_MAX

typedef struct triangle {
	uint32_t face, number; /* number: in the order of faces, degenerate ones too */
	uint32_t corner[3];    /* corners of the mesh */
	uint32_t vertex[3];    /* welded */
	uint32_t neighbour[3]; /* triangle across edge k (corner k to k + 1), or NO_TRIANGLE */
	nt_vec3 os, ot;        /* unit directions of growing u and v */
	float mag_s, mag_t;    /* lengths of dP/du and dP/dv */
	bool any;              /* no usable frame: takes any group's orientation */
	bool orient;           /* UV determinant positive; for "any" that of the first group that reaches it */
	bool assigned[3];      /* corner k is in a group */
} triangle;

/* One result, and what the reference keeps beside it. */
typedef struct corner_frame {
	nt_vec3 os, ot;
	float mag_s, mag_t;
	bool orient;
	unsigned char writes;
} corner_frame;

/* One entry for each corner of the sound triangles around a welded vertex. */
typedef struct fan_corner {
	uint32_t triangle;
	uint32_t k;
} fan_corner;

typedef struct edge {
	uint32_t high;     /* the larger welded vertex; the smaller one is the list the edge is in */
	uint32_t triangle;
	uint32_t k;
	bool forward;      /* runs from the smaller to the larger vertex */
} edge;

typedef struct state {
	const nt_solve *solve;
	const nmtan_mesh *mesh;
	triangle *triangles; /* the sound ones first, in order, then the degenerate ones */
	size_t triangle_count, sound_count;
	uint32_t *cuts;      /* [triangle_count] in the order of faces */
	uint32_t *ids;       /* [corner_count] welded vertex */
	size_t vertex_count;
	corner_frame *frames; /* [corner_count] */
	size_t *fan_begin;   /* [vertex_count + 1] into fans */
	fan_corner *fans;    /* [3 * sound_count] ascending by triangle in each vertex */
	fan_corner *group;   /* members of the current group */
	fan_corner *part;    /* members of the current part of it */
	fan_corner *stack;
} state;

static nt_vec3 load3(const float *p)
{
	return (nt_vec3){p[0], p[1], p[2]};
}

static nt_vec3 position(const state *s, uint32_t corner)
{
	return load3(nt_position(s->mesh, nt_vertex_of(s->mesh, corner)));
}

static nt_vec3 normal(const state *s, uint32_t corner)
{
	return load3(nt_normal(s->mesh, nt_vertex_of(s->mesh, corner)));
}

static const float *texcoord(const state *s, uint32_t corner)
{
	return nt_texcoord(s->mesh, nt_vertex_of(s->mesh, corner));
}

static bool equal3(nt_vec3 a, nt_vec3 b)
{
	return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* 1 and 2 */

static void cut_faces(state *s)
{
	size_t first = 0;
	for (size_t face = 0; face < s->mesh->face_count; face++) {
		uint32_t corners[2][3];
		const unsigned count = nt_face_triangles(s->mesh, face, first, corners);
		for (unsigned i = 0; i < count; i++) {
			triangle *t = &s->triangles[s->triangle_count++];
			*t = (triangle){.face = (uint32_t)face, .number = (uint32_t)s->triangle_count - 1};
			s->cuts[t->number] = nt_cut_of((uint32_t)first, corners[i]);
			for (int k = 0; k < 3; k++) {
				t->corner[k] = corners[i][k];
				t->vertex[k] = s->ids[corners[i][k]];
				t->neighbour[k] = NO_TRIANGLE;
			}
		}
		first += nt_face_size(s->mesh, face);
	}
}

/* 3 */

static bool is_degenerate(const state *s, const triangle *t)
{
	const nt_vec3 a = position(s, t->corner[0]), b = position(s, t->corner[1]),
		      c = position(s, t->corner[2]);
	return equal3(a, b) || equal3(a, c) || equal3(b, c);
}

/* Moves degenerate triangles behind the sound ones; both keep their order. */
static nmtan_status put_degenerate_aside(state *s)
{
	triangle *aside = nt_scratch_alloc(s->solve->scratch, s->triangle_count, sizeof *aside);
	if (!aside)
		return NMTAN_ERROR_MEMORY;
	size_t aside_count = 0;
	for (size_t i = 0; i < s->triangle_count; i++) {
		if (is_degenerate(s, &s->triangles[i]))
			aside[aside_count++] = s->triangles[i];
		else
			s->triangles[s->sound_count++] = s->triangles[i];
	}
	memcpy(s->triangles + s->sound_count, aside, aside_count * sizeof *aside);
	return NMTAN_OK;
}

/* 4 */

/* Twice the signed UV area, in float as the reference has it. */
static float uv_area(const state *s, const triangle *t)
{
	const float *ta = texcoord(s, t->corner[0]), *tb = texcoord(s, t->corner[1]),
		    *tc = texcoord(s, t->corner[2]);
	const float t21x = tb[0] - ta[0], t21y = tb[1] - ta[1];
	const float t31x = tc[0] - ta[0], t31y = tc[1] - ta[1];
	return t21x * t31y - t21y * t31x;
}

static void solve_frame(const state *s, triangle *t)
{
	const float *ta = texcoord(s, t->corner[0]), *tb = texcoord(s, t->corner[1]),
		    *tc = texcoord(s, t->corner[2]);
	const nt_vec3 pa = position(s, t->corner[0]);
	const nt_vec3 d1 = nt_vec3_sub(position(s, t->corner[1]), pa);
	const nt_vec3 d2 = nt_vec3_sub(position(s, t->corner[2]), pa);
	const float t21x = tb[0] - ta[0], t21y = tb[1] - ta[1];
	const float t31x = tc[0] - ta[0], t31y = tc[1] - ta[1];

	const float area = uv_area(s, t);
	t->orient = area > 0.0f;
	t->any = true;
	if (!nt_not_zero(area))
		return;
	const nt_vec3 os = nt_vec3_sub(nt_vec3_scale(t31y, d1), nt_vec3_scale(t21y, d2));
	const nt_vec3 ot = nt_vec3_add(nt_vec3_scale(-t31x, d1), nt_vec3_scale(t21x, d2));
	const float length_s = nt_vec3_length(os), length_t = nt_vec3_length(ot);
	const float sign = t->orient ? 1.0f : -1.0f;
	if (nt_not_zero(length_s))
		t->os = nt_vec3_scale(sign / length_s, os);
	if (nt_not_zero(length_t))
		t->ot = nt_vec3_scale(sign / length_t, ot);
	t->mag_s = length_s / fabsf(area);
	t->mag_t = length_t / fabsf(area);
	t->any = !(nt_not_zero(t->mag_s) && nt_not_zero(t->mag_t));
}

/* The halves of a quad take one orientation: the second takes the first's if it has no frame of its own
 * or is not the larger one. */
static void orient_quads(state *s)
{
	for (size_t i = 0; i + 1 < s->sound_count; i++) {
		triangle *first = &s->triangles[i], *second = &s->triangles[i + 1];
		if (first->face != second->face)
			continue;
		if (first->orient != second->orient) {
			const float a = fabsf(uv_area(s, first)), b = fabsf(uv_area(s, second));
			if (second->any || a >= b)
				second->orient = first->orient;
			else
				first->orient = second->orient;
		}
		i++;
	}
}

/* 5 */

/* Lists the corners of the sound triangles around each welded vertex, ascending. */
static nmtan_status list_fans(state *s)
{
	s->fan_begin = nt_scratch_alloc(s->solve->scratch, s->vertex_count + 2, sizeof *s->fan_begin);
	s->fans = nt_scratch_alloc(s->solve->scratch, s->sound_count, 3 * sizeof *s->fans);
	if (!s->fan_begin || !s->fans)
		return NMTAN_ERROR_MEMORY;
	/* counted two places ahead: filling then moves each begin to where it belongs */
	size_t *at = s->fan_begin + 1;
	memset(s->fan_begin, 0, (s->vertex_count + 2) * sizeof *s->fan_begin);
	for (size_t i = 0; i < s->sound_count; i++)
		for (int k = 0; k < 3; k++)
			at[s->triangles[i].vertex[k] + 1]++;
	for (size_t v = 1; v < s->vertex_count; v++)
		at[v] += at[v - 1];
	for (size_t i = 0; i < s->sound_count; i++)
		for (uint32_t k = 0; k < 3; k++)
			s->fans[at[s->triangles[i].vertex[k]]++] = (fan_corner){(uint32_t)i, k};
	return NMTAN_OK;
}

static int compare_edges(const void *left, const void *right)
{
	const edge *a = left, *b = right;
	if (a->high != b->high)
		return a->high < b->high ? -1 : 1;
	if (a->triangle != b->triangle)
		return a->triangle < b->triangle ? -1 : 1;
	return (a->k > b->k) - (a->k < b->k);
}

/* Pairs the edges of one run, all between the same two vertices. An edge takes the first later one that
 * is free and runs the other way; so the n-th forward edge meets the n-th backward one. */
static void pair_run(state *s, const edge *run, size_t count)
{
	size_t forward = 0, backward = 0;
	for (;;) {
		while (forward < count && !run[forward].forward)
			forward++;
		while (backward < count && run[backward].forward)
			backward++;
		if (forward == count || backward == count)
			return;
		const edge *f = &run[forward++], *b = &run[backward++];
		s->triangles[f->triangle].neighbour[f->k] = b->triangle;
		s->triangles[b->triangle].neighbour[b->k] = f->triangle;
	}
}

/* The edges from vertex v to larger vertices: two at each corner, k and k - 1. */
static size_t gather_edges(const state *s, size_t v, edge *edges)
{
	size_t count = 0;
	for (size_t i = s->fan_begin[v]; i < s->fan_begin[v + 1]; i++) {
		const fan_corner at = s->fans[i];
		const triangle *t = &s->triangles[at.triangle];
		const uint32_t next = (at.k + 1) % 3, previous = (at.k + 2) % 3;
		if (t->vertex[next] > v)
			edges[count++] = (edge){t->vertex[next], at.triangle, at.k, true};
		if (t->vertex[previous] > v)
			edges[count++] = (edge){t->vertex[previous], at.triangle, previous, false};
	}
	return count;
}

static nmtan_status pair_edges(state *s)
{
	size_t most = 0;
	for (size_t v = 0; v < s->vertex_count; v++) {
		const size_t valence = s->fan_begin[v + 1] - s->fan_begin[v];
		most = valence > most ? valence : most;
	}
	edge *edges = nt_scratch_alloc(s->solve->scratch, most, 2 * sizeof *edges);
	if (!edges)
		return NMTAN_ERROR_MEMORY;
	for (size_t v = 0; v < s->vertex_count; v++) {
		const size_t count = gather_edges(s, v, edges);
		qsort(edges, count, sizeof *edges, compare_edges);
		for (size_t begin = 0, end; begin < count; begin = end) {
			for (end = begin + 1; end < count && edges[end].high == edges[begin].high; end++)
				continue;
			pair_run(s, edges + begin, end - begin);
		}
	}
	return NMTAN_OK;
}

/* A sound triangle by its number. */
static uint32_t sound_triangle(const state *s, uint32_t number)
{
	size_t low = 0, high = s->sound_count;
	while (low + 1 < high) {
		const size_t middle = low + (high - low) / 2;
		*(s->triangles[middle].number <= number ? &low : &high) = middle;
	}
	return (uint32_t)low;
}

/* The published sort leaves some edges unsorted, which are paired otherwise. */
static nmtan_status pair_unsorted(state *s)
{
	nt_scratch *scratch = s->solve->scratch;
	float *positions = nt_scratch_alloc(scratch, s->vertex_count + 1, 3 * sizeof *positions);
	if (!positions)
		return NMTAN_ERROR_MEMORY;
	for (uint32_t c = 0; c < s->solve->corner_count; c++)
		memcpy(positions + 3 * (size_t)s->ids[c], nt_position(s->mesh, nt_vertex_of(s->mesh, c)),
			3 * sizeof *positions);
	const nt_triangles triangles = {s->ids, s->cuts};
	nt_unsorted unsorted = {.edges = NULL};
	const nt_welded_mesh mesh = {.triangles = &triangles,
		.triangle_count = s->triangle_count, .vertex_count = s->vertex_count, .positions = positions,
		.step = 3, .scratch = scratch};
	const nmtan_status status = nt_find_unsorted(&mesh, NULL, scratch, &unsorted);
	for (size_t i = 0; i < unsorted.count; i++) {
		const nt_unsorted_edge *e = &unsorted.edges[i];
		s->triangles[sound_triangle(s, e->edge / 3)].neighbour[e->edge % 3] =
			e->neighbour == NT_NO_NEIGHBOUR ? NO_TRIANGLE : sound_triangle(s, e->neighbour);
	}
	if (unsorted.limit && s->solve->sorted_instead)
		*s->solve->sorted_instead = true;
	return status;
}

/* 6 */

static uint32_t corner_at(const triangle *t, uint32_t vertex)
{
	return t->vertex[0] == vertex ? 0 : t->vertex[1] == vertex ? 1 : 2;
}

/* Takes a triangle's corner at the vertex into the group, if it is free and of its orientation. */
static bool join_group(state *s, uint32_t neighbour, uint32_t vertex, bool orient)
{
	triangle *t = &s->triangles[neighbour];
	const uint32_t k = corner_at(t, vertex);
	if (t->assigned[k])
		return false;
	if (t->any && !t->assigned[0] && !t->assigned[1] && !t->assigned[2])
		t->orient = orient; /* the first group that reaches it */
	if (t->orient != orient)
		return false;
	t->assigned[k] = true;
	return true;
}

/* Floods from one corner over the edges at its vertex; returns the number of members. */
static size_t flood_group(state *s, uint32_t seed, uint32_t seed_k)
{
	const uint32_t vertex = s->triangles[seed].vertex[seed_k];
	const bool orient = s->triangles[seed].orient;
	size_t count = 0, depth = 0;
	s->triangles[seed].assigned[seed_k] = true;
	s->stack[depth++] = (fan_corner){seed, seed_k};
	while (depth > 0) {
		const fan_corner at = s->stack[--depth];
		s->group[count++] = at;
		const triangle *t = &s->triangles[at.triangle];
		const uint32_t across[2] = {t->neighbour[at.k], t->neighbour[(at.k + 2) % 3]};
		for (int i = 0; i < 2; i++) {
			if (across[i] != NO_TRIANGLE && join_group(s, across[i], vertex, orient))
				s->stack[depth++] = (fan_corner){across[i],
					corner_at(&s->triangles[across[i]], vertex)};
		}
	}
	return count;
}

/* 7 */

static int compare_fan_corners(const void *left, const void *right)
{
	const fan_corner *a = left, *b = right;
	return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

/* Whether two members of a group are averaged together. */
static bool belong_together(const state *s, const triangle *f, const triangle *t, nt_vec3 n)
{
	if (f->any || t->any || f->face == t->face)
		return true;
	const nt_vec3 fs = nt_vec3_project(n, f->os), ft = nt_vec3_project(n, f->ot);
	const nt_vec3 ts = nt_vec3_project(n, t->os), tt = nt_vec3_project(n, t->ot);
	const float threshold = s->solve->threshold_cos;
	return nt_vec3_dot(fs, ts) > threshold && nt_vec3_dot(ft, tt) > threshold;
}

/* The weighted average of a part's frames; the weight is the triangle's angle seen along the normal. */
static corner_frame average(const state *s, const fan_corner *part, size_t count)
{
	corner_frame sum = {0};
	float angles = 0.0f;
	for (size_t i = 0; i < count; i++) {
		const triangle *t = &s->triangles[part[i].triangle];
		if (t->any)
			continue;
		const uint32_t k = part[i].k;
		const nt_vec3 n = normal(s, t->corner[k]);
		const nt_vec3 p = position(s, t->corner[k]);
		const nt_vec3 previous = position(s, t->corner[(k + 2) % 3]);
		const nt_vec3 next = position(s, t->corner[(k + 1) % 3]);
		const nt_vec3 e1 = nt_vec3_project(n, nt_vec3_sub(previous, p));
		const nt_vec3 e2 = nt_vec3_project(n, nt_vec3_sub(next, p));
		float c = nt_vec3_dot(e1, e2);
		c = c > 1.0f ? 1.0f : c < -1.0f ? -1.0f : c;
		const float angle = nt_acos(c); /* (float)acos((double)c), the same in every C library */
		sum.os = nt_vec3_add(sum.os, nt_vec3_scale(angle, nt_vec3_project(n, t->os)));
		sum.ot = nt_vec3_add(sum.ot, nt_vec3_scale(angle, nt_vec3_project(n, t->ot)));
		sum.mag_s += angle * t->mag_s;
		sum.mag_t += angle * t->mag_t;
		angles += angle;
	}
	sum.os = nt_vec3_normalise_safe(sum.os);
	sum.ot = nt_vec3_normalise_safe(sum.ot);
	if (angles > 0.0f) {
		sum.mag_s /= angles;
		sum.mag_t /= angles;
	}
	return sum;
}

/* The corner of a quad's diagonal gets two results, one from each half: they are averaged. */
static corner_frame merge_frames(const corner_frame *a, const corner_frame *b)
{
	corner_frame merged = *a;
	if (a->mag_s == b->mag_s && a->mag_t == b->mag_t && equal3(a->os, b->os) && equal3(a->ot, b->ot))
		return merged;
	merged.mag_s = 0.5f * (a->mag_s + b->mag_s);
	merged.mag_t = 0.5f * (a->mag_t + b->mag_t);
	merged.os = nt_vec3_normalise_safe(nt_vec3_add(a->os, b->os));
	merged.ot = nt_vec3_normalise_safe(nt_vec3_add(a->ot, b->ot));
	return merged;
}

static void write_frame(corner_frame *target, corner_frame result, bool orient)
{
	if (target->writes)
		result = merge_frames(target, &result);
	result.writes = (unsigned char)(target->writes + 1);
	result.orient = orient;
	*target = result;
}

/* Averages and writes one group: for each member the part of the group it agrees with. */
static void finish_group(state *s, size_t count, bool orient)
{
	qsort(s->group, count, sizeof *s->group, compare_fan_corners);
	corner_frame whole;
	bool have_whole = false;
	for (size_t i = 0; i < count; i++) {
		const triangle *f = &s->triangles[s->group[i].triangle];
		const nt_vec3 n = normal(s, f->corner[s->group[i].k]);
		size_t part_count = 0;
		for (size_t j = 0; j < count; j++)
			if (belong_together(s, f, &s->triangles[s->group[j].triangle], n))
				s->part[part_count++] = s->group[j];
		corner_frame result;
		if (part_count < count) {
			result = average(s, s->part, part_count);
		} else {
			if (!have_whole)
				whole = average(s, s->group, count);
			have_whole = true;
			result = whole;
		}
		write_frame(&s->frames[f->corner[s->group[i].k]], result, orient);
	}
}

static nmtan_status solve_groups(state *s)
{
	s->group = nt_scratch_alloc(s->solve->scratch, s->sound_count, 3 * sizeof *s->group);
	s->part = nt_scratch_alloc(s->solve->scratch, s->sound_count, 3 * sizeof *s->part);
	s->stack = nt_scratch_alloc(s->solve->scratch, s->sound_count, 3 * sizeof *s->stack);
	if (!s->group || !s->part || !s->stack)
		return NMTAN_ERROR_MEMORY;
	for (uint32_t i = 0; i < s->sound_count; i++) {
		for (uint32_t k = 0; k < 3; k++) {
			if (s->triangles[i].any || s->triangles[i].assigned[k])
				continue;
			const bool orient = s->triangles[i].orient;
			finish_group(s, flood_group(s, i, k), orient);
		}
	}
	return NMTAN_OK;
}

/* 8 */

/* The sound half of a degenerate triangle's quad, or NULL. Halves of a quad are neighbours in face
 * order, and the sound triangles are sorted by face. */
static const triangle *sound_half(const state *s, const triangle *degenerate)
{
	if (nt_face_size(s->mesh, degenerate->face) != 4)
		return NULL;
	size_t low = 0, high = s->sound_count;
	while (low < high) {
		const size_t middle = low + (high - low) / 2;
		if (s->triangles[middle].face < degenerate->face)
			low = middle + 1;
		else
			high = middle;
	}
	return low < s->sound_count && s->triangles[low].face == degenerate->face ? &s->triangles[low]
										   : NULL;
}

/* The fourth corner of a quad whose other half is sound takes the result at its position. */
static void copy_from_half(state *s, const triangle *degenerate, const triangle *sound)
{
	for (int k = 0; k < 3; k++) {
		const uint32_t corner = degenerate->corner[k];
		if (corner == sound->corner[0] || corner == sound->corner[1] || corner == sound->corner[2])
			continue;
		for (int j = 0; j < 3; j++) {
			if (equal3(position(s, corner), position(s, sound->corner[j]))) {
				s->frames[corner] = s->frames[sound->corner[j]];
				break;
			}
		}
	}
}

static void fill_degenerate(state *s)
{
	for (size_t i = s->sound_count; i < s->triangle_count; i++) {
		const triangle *t = &s->triangles[i];
		const triangle *half = sound_half(s, t);
		if (half) {
			copy_from_half(s, t, half);
			continue;
		}
		for (int k = 0; k < 3; k++) {
			const size_t begin = s->fan_begin[t->vertex[k]];
			if (begin == s->fan_begin[t->vertex[k] + 1])
				continue; /* no sound triangle there: the default stays */
			const fan_corner first = s->fans[begin];
			s->frames[t->corner[k]] =
				s->frames[s->triangles[first.triangle].corner[first.k]];
		}
	}
}

static void write_output(const state *s)
{
	const nt_solve *solve = s->solve;
	for (size_t c = 0; c < solve->corner_count; c++) {
		const corner_frame *from = &s->frames[c];
		const float w = !from->writes ? nt_unassigned_sign(solve) : from->orient ? 1.0f : -1.0f;
		const float tangent[4] = {from->os.x, from->os.y, from->os.z, w};
		memcpy(solve->tangents + 4 * c, tangent, sizeof tangent);
		if (solve->bitangents)
			memcpy(solve->bitangents + 3 * c, &from->ot, sizeof from->ot);
		if (solve->magnitudes)
			solve->magnitudes[2 * c] = from->mag_s, solve->magnitudes[2 * c + 1] = from->mag_t;
	}
}

nmtan_status nt_mikktspace_scalar(const nt_solve *solve)
{
	state s = {.solve = solve, .mesh = solve->mesh};
	s.triangles = nt_scratch_alloc(solve->scratch, nt_triangle_count(solve->mesh, solve->corner_count),
		sizeof *s.triangles);
	s.cuts = nt_scratch_alloc(solve->scratch, nt_triangle_count(solve->mesh, solve->corner_count), sizeof *s.cuts);
	s.ids = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *s.ids);
	s.frames = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *s.frames);
	if (!s.triangles || !s.cuts || !s.ids || !s.frames)
		return NMTAN_ERROR_MEMORY;
	for (size_t c = 0; c < solve->corner_count; c++)
		s.frames[c] = (corner_frame){.os = {1, 0, 0}, .ot = {0, 1, 0}, .mag_s = 1, .mag_t = 1};

	nmtan_status status = nt_weld_corners(solve->mesh, solve->corner_count, solve->scratch, s.ids,
		&s.vertex_count);
	if (status)
		return status;
	cut_faces(&s);
	if ((status = put_degenerate_aside(&s)))
		return status;
	for (size_t i = 0; i < s.sound_count; i++)
		solve_frame(&s, &s.triangles[i]);
	orient_quads(&s);
	if ((status = list_fans(&s)) || (status = pair_edges(&s)) ||
		(!solve->sorted && (status = pair_unsorted(&s))) || (status = solve_groups(&s)))
		return status;
	fill_degenerate(&s);
	write_output(&s);
	return NMTAN_OK;
}
