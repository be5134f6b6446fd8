/* SPDX-License-Identifier: MIT */
/*
 * Repair: see repair.h.
 *
 * The check (usable.c) finds nothing on most meshes, and then nothing is done here. Where it finds something it has
 * marked the corners concerned with w = 0. They are collected by welded vertex, the triangles around these vertices
 * are visited once, and each corner gets, in this order:
 *
 *   1 the robust average of the triangles of its face's orientation around its vertex: the exact value of what the
 *     methods approximate
 *   2 a usable tangent at the same vertex, in a face of the same orientation
 *   3 one of the same face
 *   4 where its face has no orientation of its own, 1 or 2 of the other orientation
 *   5 a unit vector perpendicular to the normal
 *
 * A face without orientation takes that of its usable corners, or of what is around its vertices. What is usable
 * keeps its bytes.
 *
 * Apart from what is faulty this costs one look at the numbers of each triangle's vertices.
 */
#include "tangent/repair.h"

#include <math.h>
#include <string.h>
#include "base/counts.h"
#include "tangent/frames.h"
#include "tangent/usable.h"
#include "topology/corners.h"

/* What the sums at a vertex and its usable corners come to, for orientation -1 and +1: 1 or 2 of the list above. */
typedef struct answers {
	float tangents[2][3], perpendicular[3]; /* unit; perpendicular to the normal */
	bool averaged[2], borrowed[2];          /* 1; 2; neither: there is no tangent */
	bool there[2];                          /* triangles or usable corners */
} answers;

/* What is around a vertex with an unusable corner, for orientation -1 and +1. */
typedef struct surroundings {
	nt_dvec3 normal;    /* unit or zero: of the first unusable corner */
	uint32_t usable[2]; /* the first usable corners, or NT_NO_ID */
	union {
		nt_frame_sum sums[2]; /* until all around is visited */
		answers answers;
	};
} surroundings;

typedef struct patient {
	const nt_solve *solve;
	const uint64_t *faulty; /* a bit for each face */
	const uint32_t *welded; /* [corner_count] */
	size_t welded_count;
	uint32_t *ids;          /* [welded_count] numbers of those that have an unusable corner, the touched ones; NT_NO_ID */
	size_t id_count;
	bool among_suspects;    /* all triangles with a touched vertex are suspects */
	surroundings *around;   /* [id_count], with room for as many as there can be */
} patient;

static unsigned has_bit(const uint64_t *bits, size_t i)
{
	return bits[i / 64] >> i % 64 & 1;
}

static const surroundings *around_corner(const patient *p, size_t c)
{
	return &p->around[p->ids[p->welded[c]]];
}

/* Whether a corner of a faulty face is usable. Such a face is a suspect: its rows are there. */
static bool is_usable(const nt_solve *solve, size_t c)
{
	return solve->tangents[4 * c + 3] != 0.0f;
}

/* The exact orientation of a face, by what is known of it. */
static inline int orientation_of(const patient *p, size_t face, size_t first)
{
	const nmtan_mesh *mesh = p->solve->mesh;
	const size_t faulty = has_bit(p->faulty, face) ? nt_face_size(mesh, face) : 0;
	for (size_t c = first; c < first + faulty; c++)
		if (!is_usable(p->solve, c) && signbit(p->solve->tangents[4 * c + 3]))
			return 0;
	const int known = mesh->face_sizes ? 0 : nt_known_orientation(p->solve->known, face);
	return known ? known : nt_face_orientation(mesh, face, first, true, NULL);
}

/* Faults */

/* A faulty face. */
typedef struct place {
	size_t face, first; /* its first corner */
} place;

/* The next faulty face from at->face on; false: there is none. */
static bool find_faulty(const patient *p, place *at)
{
	const nmtan_mesh *mesh = p->solve->mesh;
	size_t face = at->face;
	while (face < mesh->face_count) {
		const uint64_t left = p->faulty[face / 64] >> face % 64;
		if (left) {
			face += (size_t)__builtin_ctzll(left);
			break;
		}
		face = (face / 64 + 1) * 64;
	}
	if (face >= mesh->face_count)
		return false;
	if (!mesh->face_sizes)
		at->first = 3 * face;
	for (; mesh->face_sizes && at->face < face; at->face++)
		at->first += mesh->face_sizes[at->face];
	at->face = face;
	return true;
}

static void step_over(const patient *p, place *at)
{
	at->first += nt_face_size(p->solve->mesh, at->face++);
}

/* The welded vertices of all corners: the method's, if it tells. */
static nmtan_status weld(patient *p)
{
	const nt_solve *solve = p->solve;
	if (solve->known && solve->known->welded) {
		p->welded = solve->known->welded;
		p->welded_count = solve->known->welded_count;
		return NMTAN_OK;
	}
	uint32_t *own = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *own);
	p->welded = own;
	return own ? nt_weld_corners(solve->mesh, solve->corner_count, solve->scratch, own, &p->welded_count)
		   : NMTAN_ERROR_MEMORY;
}

/* Numbers the welded vertices that have an unusable corner, of which there are `unusable`. Equal vertices of the mesh
 * have equal normals: what is asked for at many corners is made once. */
static nmtan_status number_vertices(patient *p, size_t unusable)
{
	const nt_solve *solve = p->solve;
	const nmtan_mesh *mesh = solve->mesh;
	p->ids = nt_scratch_alloc(solve->scratch, p->welded_count, sizeof *p->ids);
	p->around = nt_scratch_alloc(solve->scratch, unusable < p->welded_count ? unusable : p->welded_count,
		sizeof *p->around);
	if (!p->ids || !p->around)
		return NMTAN_ERROR_MEMORY;
	memset(p->ids, 0xff, p->welded_count * sizeof *p->ids);
	for (place at = {0, 0}; find_faulty(p, &at); step_over(p, &at)) {
		for (size_t c = at.first; c < at.first + nt_face_size(mesh, at.face); c++) {
			uint32_t *id = &p->ids[p->welded[c]];
			if (*id != NT_NO_ID || is_usable(solve, c))
				continue;
			*id = (uint32_t)p->id_count++;
			p->around[*id] = (surroundings){.normal = nt_unit_normal(mesh, nt_vertex_of(mesh, c)),
				.usable = {NT_NO_ID, NT_NO_ID}};
		}
	}
	return NMTAN_OK;
}

/* What is around */

/* Adds a face of 3 or 4 corners with a touched vertex to what is around these. */
static inline void visit_face(const patient *p, size_t face, size_t first, unsigned size)
{
	const nt_solve *solve = p->solve;
	surroundings *around[4]; /* of its vertices; NULL: not touched */
	for (size_t k = 0; k < size; k++) {
		const uint32_t id = p->ids[p->welded[first + k]];
		around[k] = id == NT_NO_ID ? NULL : &p->around[id];
		const float w = around[k] ? nt_corner_tangent(solve, first + k)[3] : 0.0f;
		if (w != 0.0f && around[k]->usable[w > 0.0f] == NT_NO_ID)
			around[k]->usable[w > 0.0f] = (uint32_t)(first + k);
	}
	const int orientation = orientation_of(p, face, first);
	if (!orientation)
		return; /* no triangle of it has a frame */
	uint32_t corners[2][3] = {{(uint32_t)first, (uint32_t)first + 1, (uint32_t)first + 2}};
	const unsigned count = size == 3 ? 1 : nt_face_triangles(solve->mesh, face, first, corners);
	for (unsigned i = 0; i < count; i++) {
		nt_frame_sum *to[3];
		nt_dvec3 normals[3];
		for (int k = 0; k < 3; k++) {
			surroundings *at = around[corners[i][k] - first];
			to[k] = at ? &at->sums[orientation > 0] : NULL;
			normals[k] = at ? at->normal : (nt_dvec3){0, 0, 0};
		}
		nt_add_triangle(solve->mesh, NT_WEIGHT_ANGLE, corners[i], normals, to);
	}
}

/* A usable corner's tangent, perpendicular to n; false where it has no such part. */
static bool borrow(const nt_solve *solve, uint32_t c, nt_dvec3 n, nt_dvec3 *tangent)
{
	*tangent = nt_dvec3_reject(n, nt_dvec3_load(nt_corner_tangent(solve, c)));
	return nt_dvec3_dot(*tangent, *tangent) > NT_PARALLEL_SINE_SQUARED && nt_dvec3_normalise(tangent);
}

static void store(nt_dvec3 t, float *to)
{
	to[0] = (float)t.x, to[1] = (float)t.y, to[2] = (float)t.z;
}

static void answer(const nt_solve *solve, surroundings *around)
{
	const nt_dvec3 n = around->normal;
	answers a = {0};
	for (int side = 0; side < 2; side++) {
		const bool weighs = around->sums[side].weights > 0.0, usable = around->usable[side] != NT_NO_ID;
		nt_dvec3 t;
		a.there[side] = usable || weighs;
		a.averaged[side] = weighs && nt_sum_tangent(&around->sums[side], n, &t);
		a.borrowed[side] = !a.averaged[side] && usable && borrow(solve, around->usable[side], n, &t);
		if (a.averaged[side] || a.borrowed[side])
			store(t, a.tangents[side]);
	}
	store(nt_dvec3_perpendicular(n), a.perpendicular);
	around->answers = a;
}

/* Whether the triangle with that first corner has a touched vertex. */
static inline bool is_near(const patient *p, size_t first)
{
	const uint32_t *v = p->welded + first;
	return (p->ids[v[0]] & p->ids[v[1]] & p->ids[v[2]]) != NT_NO_ID;
}

/* Triangles that are looked at together. */
enum { STEP = 8 };

/* Whether one of STEP triangles from t on is a suspect. */
static inline bool has_suspect(const nt_known *known, size_t t)
{
	uint64_t flags;
	memcpy(&flags, known->flags + t, STEP);
	return flags & (0x0101010101010101u * known->suspect);
}

/* Visits the triangles with a touched vertex, which are listed without a branch. */
static void visit_triangles(const patient *p)
{
	const size_t count = p->solve->mesh->face_count;
	uint8_t list[STEP];
	for (size_t begin = 0, end; begin < count; begin = end) {
		size_t found = 0;
		end = count - begin < STEP ? count : begin + STEP;
		if (p->among_suspects && end == begin + STEP && !has_suspect(p->solve->known, begin))
			continue;
		for (size_t t = begin; t < end; t++) {
			list[found] = (uint8_t)(t - begin);
			found += is_near(p, 3 * t);
		}
		for (size_t i = 0; i < found; i++)
			visit_face(p, begin + list[i], 3 * (begin + list[i]), 3);
	}
}

static void visit_faces(const patient *p)
{
	const nmtan_mesh *mesh = p->solve->mesh;
	for (size_t face = 0, first = 0; face < mesh->face_count; first += nt_face_size(mesh, face++))
		if (is_near(p, first) || (nt_face_size(mesh, face) == 4 && p->ids[p->welded[first + 3]] != NT_NO_ID))
			visit_face(p, face, first, nt_face_size(mesh, face));
}

static void look_around(const patient *p)
{
	if (p->solve->mesh->face_sizes)
		visit_faces(p);
	else
		visit_triangles(p);
	for (size_t i = 0; i < p->id_count; i++)
		answer(p->solve, &p->around[i]);
}

/* Mending */

/* A faulty face. */
typedef struct face {
	size_t first, size; /* its corners */
	bool usable[4];
	int orientation, side;
} face;

/* The best tangent that can be had at an unusable corner c of a face; it may lie in `own`. */
static const float *best_tangent(const patient *p, const face *f, size_t c, float own[3])
{
	const nt_solve *solve = p->solve;
	const answers *a = &around_corner(p, c)->answers;
	if (solve->faults && !a->averaged[f->side])
		solve->faults[c] |= NMTAN_FAULT_NO_AVERAGE;
	if (a->averaged[f->side] || a->borrowed[f->side])
		return a->tangents[f->side];
	for (size_t k = 0; k < f->size; k++) {
		nt_dvec3 t;
		if (f->usable[k] && borrow(solve, (uint32_t)(f->first + k),
					    nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, c)), &t)) {
			store(t, own);
			return own;
		}
	}
	const bool other = !f->orientation && (a->averaged[!f->side] || a->borrowed[!f->side]);
	return other ? a->tangents[!f->side] : a->perpendicular;
}

/* The side of a face without orientation: that of a usable corner, all of which agree; else what most of its vertices
 * have around them; of the first usable corner around where that is even; +1 where there is nothing. */
static int choose_side(const patient *p, const face *f)
{
	int votes = 0, nearest = 1;
	uint32_t least = NT_NO_ID;
	for (size_t k = 0; k < f->size; k++)
		if (f->usable[k])
			return p->solve->tangents[4 * (f->first + k) + 3] > 0.0f;
	for (size_t k = 0; k < f->size; k++) {
		const surroundings *around = around_corner(p, f->first + k);
		votes += around->answers.there[1] - around->answers.there[0];
		for (int side = 0; side < 2; side++) {
			nearest = around->usable[side] < least ? side : nearest;
			least = around->usable[side] < least ? around->usable[side] : least;
		}
	}
	return votes ? votes > 0 : nearest;
}

static void write_corner(const nt_solve *solve, size_t c, const float *t, float w)
{
	const float tangent[4] = {t[0], t[1], t[2], w};
	memcpy(solve->tangents + 4 * c, tangent, sizeof tangent);
	if (solve->bitangents) {
		const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, c));
		const nt_dvec3 b = nt_dvec3_scale(w, nt_dvec3_cross(n, nt_dvec3_load(tangent)));
		const float bitangent[3] = {(float)b.x, (float)b.y, (float)b.z};
		memcpy(solve->bitangents + 3 * c, bitangent, sizeof bitangent);
	}
	if (solve->magnitudes)
		solve->magnitudes[2 * c] = solve->magnitudes[2 * c + 1] = 1.0f;
}

/* Repairs one face. What is read of its own corners and of those around are usable ones, which are never written: the
 * order of corners and of faces does not matter. */
static void mend_face(const patient *p, size_t number, size_t first)
{
	face f = {.first = first, .size = nt_face_size(p->solve->mesh, number), .orientation = orientation_of(p, number, first)};
	for (size_t k = 0; k < f.size; k++)
		f.usable[k] = is_usable(p->solve, first + k);
	f.side = f.orientation ? f.orientation > 0 : choose_side(p, &f);
	for (size_t k = 0; k < f.size; k++) {
		float own[3];
		if (!f.usable[k])
			write_corner(p->solve, first + k, best_tangent(p, &f, first + k, own), f.side ? 1.0f : -1.0f);
	}
}

/* Where there is nothing to repair from */

/* Whether all corners are unusable, and no face has an orientation, as in meshes that nobody has unwrapped. */
static bool is_hopeless(const nt_solve *solve, const nmtan_counts *counts)
{
	size_t c = nt_counts_repaired(counts) == solve->corner_count ? 0 : solve->corner_count + 1;
	while (c < solve->corner_count && signbit(solve->tangents[4 * c + 3]))
		c++;
	return c == solve->corner_count;
}

/* Whether a normal has a -0, in which equal vertices may differ: then the first of them decides. */
static bool has_negative_zero(const float *n)
{
	return (n[0] == 0.0f && signbit(n[0])) || (n[1] == 0.0f && signbit(n[1])) || (n[2] == 0.0f && signbit(n[2]));
}

/* Gives each corner what its normal alone says, without a look at what is around; `done` becomes false where that is
 * not enough, or not less work. */
static nmtan_status mend_by_normals(const nt_solve *solve, bool *done)
{
	const nmtan_mesh *mesh = solve->mesh;
	const size_t count = mesh->indices ? mesh->vertex_count : solve->corner_count;
	*done = false;
	if (count > solve->corner_count)
		return NMTAN_OK;
	float (*tangents)[3] = nt_scratch_alloc(solve->scratch, count, sizeof *tangents);
	if (!tangents)
		return NMTAN_ERROR_MEMORY;
	for (size_t v = 0; v < count; v++) {
		if (has_negative_zero(nt_normal(mesh, v)))
			return NMTAN_OK;
		store(nt_dvec3_perpendicular(nt_unit_normal(mesh, v)), tangents[v]);
	}
	for (size_t c = 0; c < solve->corner_count; c++) {
		write_corner(solve, c, tangents[nt_vertex_of(mesh, c)], 1.0f);
		if (solve->faults)
			solve->faults[c] |= NMTAN_FAULT_NO_AVERAGE;
	}
	*done = true;
	return NMTAN_OK;
}

/* What nearly all meshes do not need: not in line, since it saves many registers. */
static nmtan_status __attribute__((noinline)) mend(const nt_solve *solve, const nmtan_counts *counts, const uint64_t *faulty)
{
	patient p = {.solve = solve, .faulty = faulty};
	nmtan_status status = NMTAN_OK;
	bool done = false;
	if (NT_SHORT_WAYS && is_hopeless(solve, counts))
		status = mend_by_normals(solve, &done);
	if (status || done || (status = weld(&p)) || (status = number_vertices(&p, nt_counts_repaired(counts))))
		return status;
	p.among_suspects = solve->known && solve->known->around && counts->repaired_sign == 0;
	look_around(&p);
	for (place at = {0, 0}; find_faulty(&p, &at); step_over(&p, &at))
		mend_face(&p, at.face, at.first);
	return NMTAN_OK;
}

nmtan_status nt_repair(const nt_solve *solve, nmtan_counts *counts)
{
	const uint64_t *faulty = NULL;
	const nmtan_status status = nt_find_unusable(solve, counts, &faulty);
	return status || !faulty ? status : mend(solve, counts, faulty);
}
