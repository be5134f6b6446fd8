/* SPDX-License-Identifier: MIT */
/*
 * The search for unusable tangents: see frames.h. Most faces need no look: a method that has bounded the error of
 * its determinants and checked the vectors it shared out knows that they are usable (nt_solve.known). The others
 * are suspects. The triangles among 64 are found first and then checked.
 */
#include "tangent/frames.h"

#include <string.h>
#include "base/parallel.h"
#include "base/structs.h"
#include "topology/corners.h"

/* Faces that share a word of faulty bits, and the words per thread below which threads do not pay. */
enum { WORD = 64, GRAIN = (1 << 15) / WORD };

typedef struct search {
	const nt_solve *solve;
	nmtan_counts *counts; /* [ranges] */
	uint64_t *faulty;     /* [words] */
} search;

/* Faults of a row */

/* Why a corner is not usable, which is counted. */
static nmtan_fault fault_of(const float *t, const float *n, nmtan_counts *counts)
{
	if (t[3] == 0.0f)
		return counts->repaired_unassigned++, NMTAN_FAULT_UNASSIGNED;
	const float squared = nt_squared(t);
	if (!isfinite(squared))
		return counts->repaired_not_finite++, NMTAN_FAULT_NOT_FINITE;
	if (!(fabsf(squared - 1.0f) <= NT_UNIT_TOLERANCE))
		return counts->repaired_zero++, NMTAN_FAULT_ZERO;
	if (nt_is_parallel(t, n))
		return counts->repaired_parallel++, NMTAN_FAULT_PARALLEL;
	if (!nt_is_frame(t, n))
		return counts->repaired_leaning++, NMTAN_FAULT_LEANING;
	return counts->repaired_sign++, NMTAN_FAULT_SIGN;
}

static void mark_fault(const nt_solve *solve, size_t corner, int orientation, nmtan_fault fault)
{
	solve->tangents[4 * corner + 3] = orientation ? 0.0f : -0.0f;
	if (solve->faults)
		solve->faults[corner] |= (uint8_t)fault;
}

/* The w of most corners of a face that have one; of the first of these when there are two of each; 0: none has. */
static float majority_sign(const float *tangents, size_t size)
{
	float sum = 0.0f, first = 0.0f;
	for (size_t k = 0; k < size; k++) {
		sum += tangents[4 * k + 3];
		first = first != 0.0f ? first : tangents[4 * k + 3];
	}
	return sum > 0.0f ? 1.0f : sum < 0.0f ? -1.0f : first;
}

/* Takes NT_W_OPEN away from the rows of a face; whether it was there. */
static bool take_marks(float *tangents, size_t size)
{
	uint32_t marks = 0, w;
	for (size_t k = 0; k < size; k++) {
		memcpy(&w, &tangents[4 * k + 3], sizeof w);
		marks |= w & NT_W_OPEN;
		w &= ~NT_W_OPEN;
		memcpy(&tangents[4 * k + 3], &w, sizeof w);
	}
	return marks;
}

/* Whether no row of a face is marked and all have one w, of the face's orientation where it has one. */
static bool is_sound(const float *tangents, size_t size, int orientation)
{
	const float wanted = orientation ? (float)orientation : tangents[3];
	bool sound = wanted == 1.0f || wanted == -1.0f;
	for (size_t k = 0; k < size; k++)
		sound &= tangents[4 * k + 3] == wanted;
	return sound;
}

/* Checks the rows of a face of a known orientation; true: some are unusable. `judged`: see nt_known. */
static inline NT_ALWAYS_INLINE bool has_unusable(const nt_solve *solve, size_t first, size_t size, int orientation,
	bool judged, nmtan_counts *counts)
{
	const nmtan_mesh *mesh = solve->mesh;
	float *t = solve->tangents + 4 * first;
	if (judged && is_sound(t, size, orientation))
		return false;
	const bool open = take_marks(t, size) || !judged;
	const float w = orientation ? (float)orientation : majority_sign(t, size);
	const unsigned all = (1u << size) - 1;
	unsigned bad = w == 0.0f ? all : 0;
	for (size_t k = 0; k < size; k++)
		bad |= (unsigned)(t[4 * k + 3] != w) << k;
	for (size_t k = 0; open && bad != all && k < size; k++)
		bad |= (unsigned)!(fabsf(nt_squared(t + 4 * k) - 1.0f) <= NT_UNIT_TOLERANCE &&
			nt_is_frame(t + 4 * k, nt_normal(mesh, nt_vertex_of(mesh, first + k)))) << k;
	if (NT_EXPECT(!bad, 1))
		return false;
	for (size_t k = 0; k < size; k++)
		if (bad >> k & 1)
			mark_fault(solve, first + k, orientation,
				fault_of(t + 4 * k, nt_normal(mesh, nt_vertex_of(mesh, first + k)), counts));
	return true;
}

/* Facts about a face */

/* Adds what a triangle is like to the counts; returns its exact orientation, as stored if it has one there. */
static int count_triangle(const nmtan_mesh *mesh, const uint32_t corners[3], nmtan_counts *counts)
{
	const int sign = nt_triangle_orientation(mesh, corners, false);
	const int stored = nt_has_stored(mesh) ? nt_triangle_orientation(mesh, corners, true) : sign;
	counts->degenerate_texcoords += sign == 0;
	counts->mirrored += sign < 0;
	counts->stored_differently += nt_stored_v_offset(mesh) != 0.0f && sign != stored;
	return stored ? stored : sign;
}

/* The same for a quad, cut as it is solved. The sign of the larger half is that of the quad's area, whichever way it is
 * cut. If both are equal, the method's sign is as good as the other. */
static int count_quad(const nt_solve *solve, size_t face, size_t first, nmtan_counts *counts)
{
	const nmtan_mesh *mesh = solve->mesh;
	uint32_t corners[2][3];
	nt_fold fold;
	nt_face_triangles(mesh, face, first, corners);
	count_triangle(mesh, corners[0], counts);
	count_triangle(mesh, corners[1], counts);
	counts->degenerate_positions += nt_is_collapsed(mesh, corners[0]) && nt_is_collapsed(mesh, corners[1]);
	const int orientation = nt_cut_orientation(mesh, corners, 2, true, &fold);
	counts->folded_quads += fold && nt_outline_crosses(mesh, first);
	if (fold != NT_FOLDED_EVENLY || !solve->repair)
		return orientation;
	take_marks(solve->tangents + 4 * first, 4);
	const float w = majority_sign(solve->tangents + 4 * first, 4);
	return w != 0.0f ? (int)w : orientation;
}

/* Suspects */

/* A bit for each of `count` triangles, at most a word of them, that has to be looked at. The others are counted where
 * they are mirrored. */
static uint64_t find_suspects(const nt_known *known, const uint8_t *flags, size_t count, size_t *mirrored)
{
	const uint8_t mask =
		(uint8_t)(known->suspect & (known->open ? ~0u : ~(unsigned)known->judged));
	size_t plain;
	const uint64_t suspects = nt_flagged(flags, count, mask, known->positive, &plain);
	*mirrored += plain;
	return suspects;
}

/* Checks a suspect; true: it is faulty. */
static bool check_triangle(const nt_solve *solve, size_t t, nmtan_counts *counts)
{
	const nmtan_mesh *mesh = solve->mesh;
	const nt_known *known = solve->known;
	int orientation;
	if (nt_knows_orientation(known, t, &orientation)) {
		counts->mirrored += orientation < 0;
		counts->degenerate_texcoords += orientation == 0;
		counts->degenerate_positions += (known->flags[t] & known->degenerate) != 0;
	} else {
		const uint32_t c = (uint32_t)(3 * t), corners[3] = {c, c + 1, c + 2};
		orientation = count_triangle(mesh, corners, counts);
		counts->degenerate_positions += nt_is_collapsed(mesh, corners);
	}
	return solve->repair &&
		has_unusable(solve, 3 * t, 3, orientation, known && known->judged, counts);
}

static void check_triangles(const search *job, size_t begin, size_t end, nmtan_counts *counts)
{
	const nt_solve *solve = job->solve;
	const bool known = solve->known && solve->known->flags;
	for (size_t word = begin; word < end; word++) {
		const size_t first = WORD * word, left = solve->mesh->face_count - first;
		const size_t count = left < WORD ? left : WORD;
		const uint64_t suspects = known
			? find_suspects(solve->known, solve->known->flags + first, count, &counts->mirrored)
			: UINT64_MAX >> (WORD - count);
		uint64_t faulty = 0;
		for (uint64_t bits = suspects; bits; bits &= bits - 1) {
			const int i = nt_trailing_zeros(bits);
			faulty |= (uint64_t)check_triangle(solve, first + (size_t)i, counts) << i;
		}
		job->faulty[word] = faulty;
	}
}

/* Meshes with quads; flags are those of their triangles. */
static void check_quads(const search *job, size_t begin, size_t end, nmtan_counts *counts)
{
	const nt_solve *solve = job->solve;
	const nmtan_mesh *mesh = solve->mesh;
	const nt_known *known = solve->known && solve->known->flags ? solve->known : NULL;
	const size_t faces = WORD * end < mesh->face_count ? WORD * end : mesh->face_count;
	size_t first = nt_first_corner(mesh, WORD * begin);
	memset(job->faulty + begin, 0, (end - begin) * sizeof *job->faulty);
	for (size_t face = WORD * begin; face < faces; first += nt_face_size(mesh, face++)) {
		const bool quad = nt_face_size(mesh, face) == 4;
		const uint8_t *flags = known ? known->flags + (first - 2 * face) : NULL;
		if (flags && !((flags[0] | (quad ? flags[1] : 0)) & known->suspect)) {
			counts->mirrored += !(flags[0] & known->positive) + (quad && !(flags[1] & known->positive));
			continue;
		}
		int orientation;
		if (quad) {
			orientation = count_quad(solve, face, first, counts);
		} else {
			const uint32_t c = (uint32_t)first, corners[3] = {c, c + 1, c + 2};
			orientation = count_triangle(mesh, corners, counts);
			counts->degenerate_positions += nt_is_collapsed(mesh, corners);
		}
		if (solve->repair && has_unusable(solve, first, nt_face_size(mesh, face), orientation, false, counts))
			job->faulty[face / WORD] |= (uint64_t)1 << face % WORD;
	}
}

static void check_words(void *context, size_t begin, size_t end, unsigned thread)
{
	const search *job = context;
	nmtan_counts counts = {0};
	if (job->solve->mesh->face_sizes)
		check_quads(job, begin, end, &counts);
	else
		check_triangles(job, begin, end, &counts);
	job->counts[thread] = counts;
}

nmtan_status nt_find_unusable(const nt_solve *solve, nmtan_counts *counts, uint64_t **faulty)
{
	const nt_known *known = solve->known;
	const bool flags = known && known->flags && !solve->mesh->face_sizes;
	memset(counts, 0, sizeof *counts);
	*faulty = NULL;
	/* scenes have thousands of meshes of few triangles */
	if (flags && solve->mesh->face_count <= WORD &&
		!find_suspects(known, known->flags, solve->mesh->face_count, &counts->mirrored))
		return NMTAN_OK;
	counts->mirrored = 0;
	const size_t words = (solve->mesh->face_count + WORD - 1) / WORD;
	const unsigned threads = nt_parallel_slots(solve->threads, words, GRAIN);
	search job = {solve, nt_scratch_alloc(solve->scratch, threads, sizeof *job.counts),
		nt_scratch_alloc(solve->scratch, words, sizeof *job.faulty)};
	if (!job.counts || !job.faulty)
		return NMTAN_ERROR_MEMORY;
	nt_parallel_ranges(solve->threads, words, GRAIN, check_words, &job);
	for (unsigned thread = 0; thread < threads; thread++)
		nt_counts_add(counts, &job.counts[thread]);
	if (nt_counts_repaired(counts))
		*faulty = job.faulty;
	return NMTAN_OK;
}
