/* SPDX-License-Identifier: MIT */
/*
 * Repair: see repair.h.
 *
 * The check (usable.c) finds nothing on most meshes, and then nothing is done here. Where it finds something it has
 * marked the corners concerned with w = 0. They are collected by welded vertex, the triangles around these vertices
 * are visited once (repair_around.c), and each corner gets, in this order:
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
 * Around most vertices of triangles without a UV area there is nothing at all, and the method tells (bare vertices).
 * Where all unusable corners of a triangle are bare, it is repaired before anything is visited: repair_bare.c.
 *
 * Apart from what is faulty this costs one look at the numbers of each triangle's vertices.
 */
#include "tangent/repair.h"

#include <string.h>
#include "base/counts.h"
#include "tangent/repair_parts.h"

/* Faults */

/* A faulty face. */
typedef struct place {
	size_t face, first; /* its first corner */
} place;

/* The next faulty face from at->face on; false: there is none. */
static bool find_faulty(const nt_repair_state *r, place *at)
{
	const nmtan_mesh *mesh = r->solve->mesh;
	size_t face = at->face;
	while (face < mesh->face_count) {
		const uint64_t left = r->faulty[face / 64] >> face % 64;
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

static void step_over(const nt_repair_state *r, place *at)
{
	at->first += nt_face_size(r->solve->mesh, at->face++);
}

/* The welded vertices of all corners: the method's, if it tells. */
static nmtan_status weld(nt_repair_state *r)
{
	const nt_solve *solve = r->solve;
	if (solve->known && solve->known->welded) {
		r->welded = solve->known->welded;
		r->welded_count = solve->known->welded_count;
		return NMTAN_OK;
	}
	uint32_t *own = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *own);
	r->welded = own;
	return own ? nt_weld_corners(solve->mesh, solve->corner_count, solve->scratch, own, &r->welded_count)
		   : NMTAN_ERROR_MEMORY;
}

static nmtan_status begin_numbers(nt_repair_state *r, size_t unusable)
{
	const nt_solve *solve = r->solve;
	const size_t most = unusable < r->welded_count ? unusable : r->welded_count;
	r->ids = nt_scratch_alloc(solve->scratch, r->welded_count, sizeof *r->ids);
	r->around = nt_scratch_alloc(solve->scratch, most, sizeof *r->around);
	if (!r->ids || !r->around)
		return NMTAN_ERROR_MEMORY;
	r->first_bare = most * (sizeof *r->around / (4 * sizeof(float)));
	memset(r->ids, 0xff, r->welded_count * sizeof *r->ids);
	return NMTAN_OK;
}

/* Numbers the welded vertices that have an unusable corner. */
static void number_vertices(nt_repair_state *r)
{
	for (place at = {0, 0}; find_faulty(r, &at); step_over(r, &at))
		for (size_t c = at.first; c < at.first + nt_face_size(r->solve->mesh, at.face); c++)
			if (r->ids[r->welded[c]] == NT_NO_ID && !nt_is_usable(r->solve, c))
				nt_number_open(r, c);
}

/* Repairs */

/* A faulty face. */
typedef struct face {
	size_t first, size; /* its corners */
	bool usable[4];
	int orientation, side;
} face;

static const nt_surroundings *around_corner(const nt_repair_state *r, size_t c)
{
	return &r->around[r->ids[r->welded[c]]];
}

/* The best tangent that can be had at an unusable corner c of a face; it may lie in `own`. */
static const float *best_tangent(const nt_repair_state *r, const face *f, size_t c, float own[3])
{
	const nt_solve *solve = r->solve;
	const nt_answers *a = nt_is_bare(r, c) ? NULL : &around_corner(r, c)->answers;
	if (solve->faults && !(a && a->averaged[f->side]))
		solve->faults[c] |= NMTAN_FAULT_NO_AVERAGE;
	if (a && (a->averaged[f->side] || a->borrowed[f->side]))
		return a->tangents[f->side];
	for (size_t k = 0; k < f->size; k++) {
		nt_dvec3 t;
		if (f->usable[k] && nt_borrow(solve, (uint32_t)(f->first + k),
					    nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, c)), &t)) {
			nt_dvec3_store(t, own);
			return own;
		}
	}
	if (!a)
		return nt_bare_tangent(r, r->ids[r->welded[c]]);
	const bool other = !f->orientation && (a->averaged[!f->side] || a->borrowed[!f->side]);
	return other ? a->tangents[!f->side] : a->perpendicular;
}

/* The side of a face without orientation: that of a usable corner, all of which agree; else what most of its vertices
 * have around them; of the first usable corner around where that is even; +1 where there is nothing. */
static int choose_side(const nt_repair_state *r, const face *f)
{
	int votes = 0, nearest = 1;
	uint32_t least = NT_NO_ID;
	for (size_t k = 0; k < f->size; k++)
		if (f->usable[k])
			return r->solve->tangents[4 * (f->first + k) + 3] > 0.0f;
	for (size_t k = 0; k < f->size; k++) {
		if (nt_is_bare(r, f->first + k))
			continue;
		const nt_surroundings *around = around_corner(r, f->first + k);
		votes += around->answers.there[1] - around->answers.there[0];
		for (int side = 0; side < 2; side++) {
			nearest = around->usable[side] < least ? side : nearest;
			least = around->usable[side] < least ? around->usable[side] : least;
		}
	}
	return votes ? votes > 0 : nearest;
}

/* Repairs one face. What is read of its own corners and of those around are usable ones, which are never written: the
 * order of corners and of faces does not matter. */
static void repair_face(const nt_repair_state *r, size_t number, size_t first)
{
	face f = {.first = first, .size = nt_face_size(r->solve->mesh, number)};
	for (size_t k = 0; k < f.size; k++)
		f.usable[k] = nt_is_usable(r->solve, first + k);
	f.orientation = nt_orientation_of(r, number, first);
	f.side = f.orientation ? f.orientation > 0 : choose_side(r, &f);
	for (size_t k = 0; k < f.size; k++) {
		float own[3];
		if (!f.usable[k])
			nt_repair_corner(r->solve, first + k, best_tangent(r, &f, first + k, own),
				f.side ? 1.0f : -1.0f);
	}
}

/* What nearly all meshes do not need: not in line, since it saves many registers. */
static nmtan_status __attribute__((noinline)) repair(const nt_solve *solve, const nmtan_counts *counts,
	uint64_t *faulty)
{
	nt_repair_state r = {.solve = solve, .faulty = faulty};
	nmtan_status status = NMTAN_OK;
	bool done = false;
	/* meshes that nobody has unwrapped */
	if (NT_SHORT_WAYS)
		status = nt_repair_by_normals(solve, counts, &done);
	if (status || done || (status = weld(&r)) || (status = begin_numbers(&r, nt_counts_repaired(counts))))
		return status;
	/* most of what triangles without a UV area leave */
	if (!NT_SHORT_WAYS || !nt_repair_bare(&r))
		number_vertices(&r);
	/* all that has something around it */
	nt_look_around(&r, solve->known && solve->known->around && counts->repaired_sign == 0);
	for (place at = {0, 0}; find_faulty(&r, &at); step_over(&r, &at))
		repair_face(&r, at.face, at.first);
	return NMTAN_OK;
}

nmtan_status nt_repair(const nt_solve *solve, nmtan_counts *counts)
{
	uint64_t *faulty = NULL;
	const nmtan_status status = nt_find_unusable(solve, counts, &faulty);
	return status || !faulty ? status : repair(solve, counts, faulty);
}
