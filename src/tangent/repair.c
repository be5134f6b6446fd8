/* SPDX-License-Identifier: MIT */
/*
 * Repair: see repair.h.
 *
 * Judging (judge.c) finds nothing on most meshes. Where it finds something, the corners
 * concerned are collected by welded vertex and each gets, in this order: the robust average of the
 * triangles of its own orientation around its vertex (the exact value of what the method approximates);
 * a usable tangent at the same vertex; one of the same face; any vector perpendicular to the normal. What
 * is usable keeps its bytes.
 */
#include "tangent/repair.h"

#include <math.h>
#include <string.h>
#include "tangent/frames.h"
#include "tangent/judge.h"
#include "topology/corners.h"

/* What repairing needs: faults by corner, and the welded vertices that have one. */
typedef struct patient {
	const nt_solve *solve;
	uint8_t *faults;           /* [corner_count] enum nt_fault */
	const uint32_t *welded;    /* [corner_count] */
	size_t welded_count;
	uint32_t *ids;             /* [welded_count] number of a welded vertex with a fault, or NT_NO_ID */
	size_t id_count;
	nt_frame_sum (*sums)[2];   /* [id_count] */
	uint32_t (*usable)[2];     /* [id_count] first usable corner with w = -1 and +1, or NT_NO_ID */
} patient;

/* The welded vertices of all corners: the method's, if it tells. */
static nmtan_status weld(patient *p)
{
	const nt_solve *solve = p->solve;
	if (solve->vouched && solve->vouched->welded) {
		p->welded = solve->vouched->welded;
		p->welded_count = solve->vouched->welded_count;
		return NMTAN_OK;
	}
	uint32_t *own = nt_scratch_alloc(solve->scratch, solve->corner_count, sizeof *own);
	p->welded = own;
	return own ? nt_weld_corners(solve->mesh, solve->corner_count, solve->scratch, own, &p->welded_count)
		   : NMTAN_ERROR_MEMORY;
}

/* Numbers the welded vertices that have a faulty corner; all others become NT_NO_ID. */
static nmtan_status number_vertices(patient *p)
{
	const nmtan_status status = weld(p);
	if (status)
		return status;
	p->ids = nt_scratch_alloc(p->solve->scratch, p->welded_count, sizeof *p->ids);
	if (!p->ids)
		return NMTAN_ERROR_MEMORY;
	memset(p->ids, 0xff, p->welded_count * sizeof *p->ids);
	for (size_t c = 0; c < p->solve->corner_count; c++)
		if (p->faults[c] != NT_FAULT_NONE && p->ids[p->welded[c]] == NT_NO_ID)
			p->ids[p->welded[c]] = (uint32_t)p->id_count++;
	return NMTAN_OK;
}

static uint32_t id_of(const patient *p, size_t corner)
{
	return p->ids[p->welded[corner]];
}

static void find_usable(patient *p)
{
	memset(p->usable, 0xff, p->id_count * sizeof *p->usable);
	for (size_t c = 0; c < p->solve->corner_count; c++) {
		if (p->faults[c] != NT_FAULT_NONE || id_of(p, c) == NT_NO_ID)
			continue;
		uint32_t *slot = &p->usable[id_of(p, c)][p->solve->tangents[4 * c + 3] > 0.0f];
		if (*slot == NT_NO_ID)
			*slot = (uint32_t)c;
	}
}

static nmtan_status examine(patient *p)
{
	const nt_solve *solve = p->solve;
	p->faults = nt_scratch_alloc(solve->scratch, solve->corner_count, 1);
	if (!p->faults)
		return NMTAN_ERROR_MEMORY;
	memset(p->faults, NT_FAULT_NONE, solve->corner_count);
	nt_suspects s = nt_suspects_among(solve, 0, solve->mesh->face_count);
	for (; nt_suspects_find(&s, NULL); nt_suspects_step(&s)) {
		const nt_verdict v = nt_judge_face(solve, s.face, s.corner, NULL);
		for (size_t k = 0; k < nt_face_size(solve->mesh, s.face); k++)
			p->faults[s.corner + k] = (uint8_t)v.faults[k];
	}
	const nmtan_status status = number_vertices(p);
	if (status)
		return status;
	p->sums = nt_scratch_alloc(solve->scratch, p->id_count, sizeof *p->sums);
	p->usable = nt_scratch_alloc(solve->scratch, p->id_count, sizeof *p->usable);
	if (!p->sums || !p->usable)
		return NMTAN_ERROR_MEMORY;
	memset(p->sums, 0, p->id_count * sizeof *p->sums);
	nt_sum_frames(solve->mesh, NT_WEIGHT_ANGLE, p->welded, p->ids, p->sums);
	find_usable(p);
	return NMTAN_OK;
}

/* The tangent of corner c, perpendicular to n; false where it has no such part. */
static bool borrow(const nt_solve *solve, size_t c, nt_dvec3 n, nt_dvec3 *tangent)
{
	*tangent = nt_dvec3_reject(n, nt_dvec3_load(solve->tangents + 4 * c));
	return nt_dvec3_dot(*tangent, *tangent) > NT_PARALLEL_SINE_SQUARED && nt_dvec3_normalise(tangent);
}

/* The best tangent that can be had at corner c of a face that begins at `first`. `side` is 1 where w is to
 * be +1. */
static nt_dvec3 best_tangent(const patient *p, size_t first, size_t size, size_t c, int orientation,
	int side)
{
	const nt_solve *solve = p->solve;
	const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, c));
	const nt_frame_sum *sums = p->sums[id_of(p, c)];
	const uint32_t *usable = p->usable[id_of(p, c)];
	nt_dvec3 t;
	if (orientation && nt_sum_tangent(&sums[side], n, &t))
		return t;
	for (int i = 0; i < 2; i++) {
		const int s = i ? !side : side;
		if (usable[s] != NT_NO_ID && borrow(solve, usable[s], n, &t))
			return t;
	}
	for (int i = 0; i < 2; i++)
		if (nt_sum_tangent(&sums[i ? !side : side], n, &t))
			return t;
	for (size_t k = first; k < first + size; k++)
		if (p->faults[k] == NT_FAULT_NONE && borrow(solve, k, n, &t))
			return t;
	return nt_dvec3_perpendicular(n);
}

/* Writes a repaired corner; a wrong sign alone on a face without orientation leaves the vector. */
static void mend_corner(const patient *p, size_t c, const nt_dvec3 *t, float w)
{
	const nt_solve *solve = p->solve;
	float *tangent = solve->tangents + 4 * c;
	if (t) {
		tangent[0] = (float)t->x;
		tangent[1] = (float)t->y;
		tangent[2] = (float)t->z;
	}
	tangent[3] = w;
	if (solve->bitangents) {
		const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, c));
		const nt_dvec3 b =
			nt_dvec3_scale(w, nt_dvec3_cross(n, nt_dvec3_load(tangent)));
		const float bitangent[3] = {(float)b.x, (float)b.y, (float)b.z};
		memcpy(solve->bitangents + 3 * c, bitangent, sizeof bitangent);
	}
	if (solve->magnitudes)
		solve->magnitudes[2 * c] = solve->magnitudes[2 * c + 1] = 1.0f;
}

/* Repairs one face; usable corners are read as the method left them, so the order of faces does not
 * matter. */
static void mend_face(const patient *p, size_t face, size_t first)
{
	const size_t size = nt_face_size(p->solve->mesh, face);
	bool faulty = false;
	for (size_t k = 0; k < size; k++)
		faulty = faulty || p->faults[first + k] != NT_FAULT_NONE;
	if (!faulty)
		return;
	const nt_verdict v = nt_judge_face(p->solve, face, first, NULL);
	nt_dvec3 tangents[4];
	for (size_t k = 0; k < size; k++)
		if (p->faults[first + k] != NT_FAULT_NONE)
			tangents[k] = best_tangent(p, first, size, first + k, v.orientation, v.w > 0.0f);
	for (size_t k = 0; k < size; k++) {
		const nt_fault f = (nt_fault)p->faults[first + k];
		const bool keep_vector = f == NT_FAULT_SIGN && !v.orientation;
		if (f != NT_FAULT_NONE)
			mend_corner(p, first + k, keep_vector ? NULL : &tangents[k], v.w);
	}
}

nmtan_status nt_repair(const nt_solve *solve, bool repair, nmtan_counts *counts)
{
	nmtan_status status = nt_judge(solve, counts);
	if (status)
		return status;
	if (!repair) {
		nt_forget_faults(counts);
		return NMTAN_OK;
	}
	if (nt_fault_count(counts) == 0)
		return NMTAN_OK;

	patient p = {.solve = solve};
	status = examine(&p);
	if (status)
		return status;
	nt_suspects s = nt_suspects_among(solve, 0, solve->mesh->face_count);
	for (; nt_suspects_find(&s, NULL); nt_suspects_step(&s))
		mend_face(&p, s.face, s.corner);
	return NMTAN_OK;
}
