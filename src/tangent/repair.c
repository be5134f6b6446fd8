/* SPDX-License-Identifier: MIT */
/*
 * Repair: see repair.h.
 *
 * Judging is one streaming pass that finds nothing on most meshes. Where it finds something, the corners
 * concerned are collected by welded vertex and each gets, in this order: the robust average of the
 * triangles of its own orientation around its vertex (the exact value of what the method approximates);
 * a usable tangent at the same vertex; one of the same face; any vector perpendicular to the normal. What
 * is usable keeps its bytes.
 */
#include "tangent/repair.h"

#include <float.h>
#include <math.h>
#include <string.h>
#include "base/parallel.h"
#include "tangent/frames.h"
#include "topology/corners.h"

/* |T|^2 may differ from 1 by this much: 32 units in the last place. Normalising in float is good to 4. */
static const float UNIT_TOLERANCE = 32 * FLT_EPSILON;

/* sin^2 of the angle between T and N below which they count as parallel: 0.06 degrees. */
static const float PARALLEL_SINE_SQUARED = 1e-6f;

enum { JUDGE_GRAIN = 1 << 15 }; /* faces per thread below which threads do not pay */

typedef enum fault {
	FAULT_NONE,
	FAULT_NOT_FINITE,
	FAULT_LENGTH,
	FAULT_PARALLEL,
	FAULT_SIGN
} fault;

/* What a face's corners must agree on. */
typedef struct verdict {
	float w;         /* required on every corner */
	int orientation; /* exact, 0: none */
	fault faults[4];
} verdict;

static bool is_parallel(const float *t, const float *n)
{
	const float x = n[1] * t[2] - n[2] * t[1], y = n[2] * t[0] - n[0] * t[2],
		    z = n[0] * t[1] - n[1] * t[0];
	const float sine_squared = x * x + y * y + z * z;
	const float normal_squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
	return normal_squared > 0.0f && isfinite(normal_squared) &&
	       sine_squared < PARALLEL_SINE_SQUARED * normal_squared;
}

static fault judge_vector(const float *t, const float *n)
{
	const float squared = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
	if (!isfinite(squared))
		return FAULT_NOT_FINITE;
	if (!(fabsf(squared - 1.0f) <= UNIT_TOLERANCE))
		return FAULT_LENGTH;
	return is_parallel(t, n) ? FAULT_PARALLEL : FAULT_NONE;
}

/* The w of most corners of a face; of its first one when there are two of each. */
static float majority_sign(const float *tangents, size_t size)
{
	float sum = 0.0f;
	for (size_t k = 0; k < size; k++)
		sum += tangents[4 * k + 3];
	return sum > 0.0f ? 1.0f : sum < 0.0f ? -1.0f : tangents[3];
}

static verdict judge_face(const nt_solve *solve, size_t face, size_t first, bool *folded)
{
	const nmtan_mesh *mesh = solve->mesh;
	const size_t size = nt_face_size(mesh, face);
	const float *tangents = solve->tangents + 4 * first;
	verdict v = {.orientation = nt_face_orientation(mesh, face, first, true, folded)};
	v.w = v.orientation ? (float)v.orientation : majority_sign(tangents, size);
	for (size_t k = 0; k < size; k++) {
		const float *t = tangents + 4 * k;
		v.faults[k] = judge_vector(t, nt_normal(mesh, nt_vertex_of(mesh, first + k)));
		if (v.faults[k] == FAULT_NONE && t[3] != v.w)
			v.faults[k] = FAULT_SIGN;
	}
	return v;
}

static bool equal_positions(const nmtan_mesh *mesh, uint32_t a, uint32_t b)
{
	const float *p = nt_position(mesh, nt_vertex_of(mesh, a));
	const float *q = nt_position(mesh, nt_vertex_of(mesh, b));
	return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

/* Adds what a face is like to the counts. */
static void count_face(const nmtan_mesh *mesh, size_t face, size_t first, nmtan_counts *counts)
{
	uint32_t corners[2][3];
	const unsigned count = nt_face_triangles(mesh, face, first, corners);
	bool degenerate = true;
	for (unsigned i = 0; i < count; i++) {
		const uint32_t *c = corners[i];
		degenerate = degenerate && (equal_positions(mesh, c[0], c[1]) ||
						   equal_positions(mesh, c[1], c[2]) ||
						   equal_positions(mesh, c[2], c[0]));
		const int sign = nt_triangle_orientation(mesh, c, false);
		counts->degenerate_texcoords += sign == 0;
		counts->mirrored += sign < 0;
		counts->stored_differently += mesh->stored_v_offset != 0.0f &&
					      sign != nt_triangle_orientation(mesh, c, true);
	}
	counts->degenerate_positions += degenerate;
}

static void count_faults(const verdict *v, size_t size, nmtan_counts *counts)
{
	for (size_t k = 0; k < size; k++) {
		counts->repaired_not_finite += v->faults[k] == FAULT_NOT_FINITE;
		counts->repaired_zero += v->faults[k] == FAULT_LENGTH;
		counts->repaired_parallel += v->faults[k] == FAULT_PARALLEL;
		counts->repaired_sign += v->faults[k] == FAULT_SIGN;
	}
}

static size_t fault_count(const nmtan_counts *counts)
{
	return counts->repaired_zero + counts->repaired_not_finite + counts->repaired_parallel +
	       counts->repaired_sign;
}

typedef struct judge_job {
	const nt_solve *solve;
	nmtan_counts *counts; /* [ranges] */
} judge_job;

static void judge_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const judge_job *job = context;
	const nmtan_mesh *mesh = job->solve->mesh;
	nmtan_counts counts = {0};
	size_t first = nt_first_corner(mesh, begin);
	for (size_t face = begin; face < end; face++) {
		const size_t size = nt_face_size(mesh, face);
		bool folded;
		const verdict v = judge_face(job->solve, face, first, &folded);
		counts.folded_quads += folded;
		count_face(mesh, face, first, &counts);
		count_faults(&v, size, &counts);
		first += size;
	}
	job->counts[slot] = counts;
}

static void add_counts(nmtan_counts *sum, const nmtan_counts *part)
{
	sum->degenerate_positions += part->degenerate_positions;
	sum->degenerate_texcoords += part->degenerate_texcoords;
	sum->mirrored += part->mirrored;
	sum->stored_differently += part->stored_differently;
	sum->folded_quads += part->folded_quads;
	sum->repaired_zero += part->repaired_zero;
	sum->repaired_not_finite += part->repaired_not_finite;
	sum->repaired_parallel += part->repaired_parallel;
	sum->repaired_sign += part->repaired_sign;
}

static nmtan_status judge_mesh(const nt_solve *solve, nmtan_counts *counts)
{
	const size_t faces = solve->mesh->face_count;
	const unsigned slots = nt_parallel_slots(solve->threads, faces, JUDGE_GRAIN);
	judge_job job = {solve, nt_scratch_alloc(solve->scratch, slots, sizeof *job.counts)};
	if (!job.counts)
		return NMTAN_ERROR_MEMORY;
	nt_parallel_ranges(solve->threads, faces, JUDGE_GRAIN, judge_range, &job);
	memset(counts, 0, sizeof *counts);
	for (unsigned slot = 0; slot < slots; slot++)
		add_counts(counts, &job.counts[slot]);
	return NMTAN_OK;
}

/* What repairing needs: faults by corner, and the welded vertices that have one. */
typedef struct patient {
	const nt_solve *solve;
	uint8_t *faults;           /* [corner_count] enum fault */
	uint32_t *ids;             /* [corner_count] number of a welded vertex with a fault, or NT_NO_ID */
	size_t id_count;
	nt_frame_sum (*sums)[2];   /* [id_count] */
	uint32_t (*usable)[2];     /* [id_count] first usable corner with w = -1 and +1, or NT_NO_ID */
} patient;

/* Numbers the welded vertices that have a faulty corner; all others become NT_NO_ID. */
static nmtan_status number_vertices(patient *p)
{
	const size_t corner_count = p->solve->corner_count;
	size_t welded_count;
	p->ids = nt_scratch_alloc(p->solve->scratch, corner_count, sizeof *p->ids);
	if (!p->ids)
		return NMTAN_ERROR_MEMORY;
	const nmtan_status status = nt_weld_corners(p->solve->mesh, corner_count, p->solve->scratch,
		p->ids, &welded_count);
	if (status)
		return status;
	uint32_t *number = nt_scratch_alloc(p->solve->scratch, welded_count, sizeof *number);
	if (!number)
		return NMTAN_ERROR_MEMORY;
	memset(number, 0xff, welded_count * sizeof *number);
	for (size_t c = 0; c < corner_count; c++)
		if (p->faults[c] != FAULT_NONE && number[p->ids[c]] == NT_NO_ID)
			number[p->ids[c]] = (uint32_t)p->id_count++;
	for (size_t c = 0; c < corner_count; c++)
		p->ids[c] = number[p->ids[c]];
	return NMTAN_OK;
}

static void find_usable(patient *p)
{
	memset(p->usable, 0xff, p->id_count * sizeof *p->usable);
	for (size_t c = 0; c < p->solve->corner_count; c++) {
		if (p->faults[c] != FAULT_NONE || p->ids[c] == NT_NO_ID)
			continue;
		uint32_t *slot = &p->usable[p->ids[c]][p->solve->tangents[4 * c + 3] > 0.0f];
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
	size_t first = 0;
	for (size_t face = 0; face < solve->mesh->face_count; face++) {
		const verdict v = judge_face(solve, face, first, NULL);
		const size_t size = nt_face_size(solve->mesh, face);
		for (size_t k = 0; k < size; k++)
			p->faults[first + k] = (uint8_t)v.faults[k];
		first += size;
	}
	const nmtan_status status = number_vertices(p);
	if (status)
		return status;
	p->sums = nt_scratch_alloc(solve->scratch, p->id_count, sizeof *p->sums);
	p->usable = nt_scratch_alloc(solve->scratch, p->id_count, sizeof *p->usable);
	if (!p->sums || !p->usable)
		return NMTAN_ERROR_MEMORY;
	memset(p->sums, 0, p->id_count * sizeof *p->sums);
	nt_sum_frames(solve->mesh, NT_WEIGHT_ANGLE, p->ids, p->sums);
	find_usable(p);
	return NMTAN_OK;
}

/* The tangent of corner c, perpendicular to n; false where it has no such part. */
static bool borrow(const nt_solve *solve, size_t c, nt_dvec3 n, nt_dvec3 *tangent)
{
	*tangent = nt_dvec3_reject(n, nt_dvec3_load(solve->tangents + 4 * c));
	return nt_dvec3_dot(*tangent, *tangent) > PARALLEL_SINE_SQUARED && nt_dvec3_normalise(tangent);
}

/* The best tangent that can be had at corner c of a face that begins at `first`. `side` is 1 where w is to
 * be +1. */
static nt_dvec3 best_tangent(const patient *p, size_t first, size_t size, size_t c, int orientation,
	int side)
{
	const nt_solve *solve = p->solve;
	const nt_dvec3 n = nt_unit_normal(solve->mesh, nt_vertex_of(solve->mesh, c));
	const nt_frame_sum *sums = p->sums[p->ids[c]];
	const uint32_t *usable = p->usable[p->ids[c]];
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
		if (p->faults[k] == FAULT_NONE && borrow(solve, k, n, &t))
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
		faulty = faulty || p->faults[first + k] != FAULT_NONE;
	if (!faulty)
		return;
	const verdict v = judge_face(p->solve, face, first, NULL);
	nt_dvec3 tangents[4];
	for (size_t k = 0; k < size; k++)
		if (p->faults[first + k] != FAULT_NONE)
			tangents[k] = best_tangent(p, first, size, first + k, v.orientation, v.w > 0.0f);
	for (size_t k = 0; k < size; k++) {
		const fault f = (fault)p->faults[first + k];
		const bool keep_vector = f == FAULT_SIGN && !v.orientation;
		if (f != FAULT_NONE)
			mend_corner(p, first + k, keep_vector ? NULL : &tangents[k], v.w);
	}
}

nmtan_status nt_repair(const nt_solve *solve, bool repair, nmtan_counts *counts)
{
	nmtan_status status = judge_mesh(solve, counts);
	if (status)
		return status;
	if (!repair) {
		counts->repaired_zero = counts->repaired_not_finite = 0;
		counts->repaired_parallel = counts->repaired_sign = 0;
		return NMTAN_OK;
	}
	if (fault_count(counts) == 0)
		return NMTAN_OK;

	patient p = {.solve = solve};
	status = examine(&p);
	if (status)
		return status;
	size_t first = 0;
	for (size_t face = 0; face < solve->mesh->face_count; face++) {
		mend_face(&p, face, first);
		first += nt_face_size(solve->mesh, face);
	}
	return NMTAN_OK;
}
