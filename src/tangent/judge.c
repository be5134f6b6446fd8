/* SPDX-License-Identifier: MIT */
/*
 * Judging: see judge.h. Most faces need no look: a method that has bounded the error of its determinants
 * and checked the vectors it shared out vouches for them (nt_solve.vouched), eight a step.
 */
#include "tangent/judge.h"

#include <math.h>
#include <string.h>
#include "base/parallel.h"
#include "tangent/frames.h"
#include "topology/corners.h"

enum { JUDGE_GRAIN = 1 << 15 }; /* faces per thread below which threads do not pay */

nt_suspects nt_suspects_among(const nt_solve *solve, size_t begin, size_t end)
{
	const size_t corner = nt_first_corner(solve->mesh, begin);
	return (nt_suspects){.solve = solve, .face = begin, .end = end, .corner = corner,
		.triangle = corner - 2 * begin}; /* a triangle has 3 corners, a quad 4 and two triangles */
}

void nt_suspects_step(nt_suspects *s)
{
	const unsigned size = nt_face_size(s->solve->mesh, s->face++);
	s->corner += size;
	s->triangle += size - 2;
}

/* The same for eight triangles at once, while none of them is suspect. */
static void skip_triangles(nt_suspects *s, size_t *mirrored)
{
	const nt_vouched *vouched = s->solve->vouched;
	const uint64_t ones = 0x0101010101010101u;
	size_t positive = 0;
	const size_t begin = s->face;
	for (uint64_t eight; s->face + 8 <= s->end; s->face += 8) {
		memcpy(&eight, vouched->flags + s->face, sizeof eight);
		if (eight & ones * vouched->suspect)
			break;
		positive += (size_t)__builtin_popcountll(eight & ones * vouched->positive);
	}
	*mirrored += s->face - begin - positive;
	s->triangle = s->face;
	s->corner = 3 * s->face;
}

bool nt_suspects_find(nt_suspects *s, size_t *mirrored)
{
	const nmtan_mesh *mesh = s->solve->mesh;
	const nt_vouched *vouched = s->solve->vouched;
	size_t ignored = 0;
	mirrored = mirrored ? mirrored : &ignored;
	if (!vouched || !vouched->flags)
		return s->face < s->end;
	while (s->face < s->end) {
		if (!mesh->face_sizes && s->face % 8 == 0) {
			skip_triangles(s, mirrored);
			if (s->face == s->end)
				break;
		}
		const uint8_t *flags = vouched->flags + s->triangle;
		const bool quad = nt_face_size(mesh, s->face) == 4;
		if ((flags[0] | (quad ? flags[1] : 0)) & vouched->suspect)
			return true;
		*mirrored += !(flags[0] & vouched->positive) + (quad && !(flags[1] & vouched->positive));
		nt_suspects_step(s);
	}
	return false;
}

static nt_fault judge_vector(const float *t, const float *n)
{
	const float squared = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
	if (!isfinite(squared))
		return NT_FAULT_NOT_FINITE;
	if (!(fabsf(squared - 1.0f) <= NT_UNIT_TOLERANCE))
		return NT_FAULT_LENGTH;
	return nt_is_parallel(t, n) ? NT_FAULT_PARALLEL : NT_FAULT_NONE;
}

/* The w of most corners of a face; of its first one when there are two of each. */
static float majority_sign(const float *tangents, size_t size)
{
	float sum = 0.0f;
	for (size_t k = 0; k < size; k++)
		sum += tangents[4 * k + 3];
	return sum > 0.0f ? 1.0f : sum < 0.0f ? -1.0f : tangents[3];
}

nt_verdict nt_judge_face(const nt_solve *solve, size_t face, size_t first, bool *folded)
{
	const nmtan_mesh *mesh = solve->mesh;
	const size_t size = nt_face_size(mesh, face);
	const float *tangents = solve->tangents + 4 * first;
	nt_verdict v = {.orientation = nt_face_orientation(mesh, face, first, true, folded)};
	v.w = v.orientation ? (float)v.orientation : majority_sign(tangents, size);
	for (size_t k = 0; k < size; k++) {
		const float *t = tangents + 4 * k;
		v.faults[k] = judge_vector(t, nt_normal(mesh, nt_vertex_of(mesh, first + k)));
		if (v.faults[k] == NT_FAULT_NONE && t[3] != v.w)
			v.faults[k] = NT_FAULT_SIGN;
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

static void count_faults(const nt_verdict *v, size_t size, nmtan_counts *counts)
{
	for (size_t k = 0; k < size; k++) {
		counts->repaired_not_finite += v->faults[k] == NT_FAULT_NOT_FINITE;
		counts->repaired_zero += v->faults[k] == NT_FAULT_LENGTH;
		counts->repaired_parallel += v->faults[k] == NT_FAULT_PARALLEL;
		counts->repaired_sign += v->faults[k] == NT_FAULT_SIGN;
	}
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
	nt_suspects s = nt_suspects_among(job->solve, begin, end);
	for (; nt_suspects_find(&s, &counts.mirrored); nt_suspects_step(&s)) {
		bool folded;
		const nt_verdict v = nt_judge_face(job->solve, s.face, s.corner, &folded);
		counts.folded_quads += folded;
		count_face(mesh, s.face, s.corner, &counts);
		count_faults(&v, nt_face_size(mesh, s.face), &counts);
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

nmtan_status nt_judge(const nt_solve *solve, nmtan_counts *counts)
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

size_t nt_fault_count(const nmtan_counts *counts)
{
	return counts->repaired_zero + counts->repaired_not_finite + counts->repaired_parallel +
	       counts->repaired_sign;
}

void nt_forget_faults(nmtan_counts *counts)
{
	counts->repaired_zero = counts->repaired_not_finite = 0;
	counts->repaired_parallel = counts->repaired_sign = 0;
}
