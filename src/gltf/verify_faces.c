/* SPDX-License-Identifier: MIT */
/*
 * The comparison of verify_faces.h. Triangles of one list are put into cubes of space by their centres, a few
 * tolerances wide; one of the other list looks into the cubes that its own centre may have come from, at most
 * eight. Both lists are asked, so that none has more than the other.
 */
#include "gltf/verify_faces.h"

#include <math.h>
#include "base/hash_index.h"
#include "base/parallel.h"

static bool within(const float *a, const float *b, size_t count, float tolerance)
{
	for (size_t i = 0; i < count; i++)
		/* what is not finite has to be the same */
		if (!(fabsf(a[i] - b[i]) <= tolerance) && !(isnan(a[i]) && isnan(b[i])) && a[i] != b[i])
			return false;
	return true;
}

bool nt_verify_close(const nt_verify_corner *a, const nt_verify_corner *b, const nt_verify_tolerance *tolerance)
{
	return within(a->position, b->position, 3, tolerance->position) &&
		within(a->tangent, b->tangent, 4, tolerance->tangent);
}

/* In one of the three ways in which the corners of one can be those of the other. */
static bool same_face(const nt_verify_corner *a, const nt_verify_corner *b, const nt_verify_tolerance *tolerance)
{
	for (size_t turn = 0; turn < 3; turn++) {
		size_t k = 0;
		while (k < 3 && nt_verify_close(&a[k], &b[(k + turn) % 3], tolerance))
			k++;
		if (k == 3)
			return true;
	}
	return false;
}

/* Cube of a centre along each axis, shifted by so many tolerances. */
static void cube_of(const nt_verify_corner *face, double size, double shift, int64_t cube[3])
{
	for (int i = 0; i < 3; i++) {
		const double centre = ((double)face[0].position[i] + face[1].position[i] + face[2].position[i]) / 3;
		const double number = floor((centre + shift) / size);
		cube[i] = number > -9e15 && number < 9e15 ? (int64_t)number : 0;
	}
}

static bool is_known(const nt_hash_index *index, const nt_verify_corner *others, const nt_verify_corner *face,
	double size, const nt_verify_tolerance *tolerance)
{
	int64_t low[3], high[3], cube[3];
	cube_of(face, size, -1.01 * tolerance->position, low);
	cube_of(face, size, 1.01 * tolerance->position, high);
	for (cube[0] = low[0]; cube[0] <= high[0]; cube[0]++)
		for (cube[1] = low[1]; cube[1] <= high[1]; cube[1]++)
			for (cube[2] = low[2]; cube[2] <= high[2]; cube[2]++) {
				const uint64_t hash = nt_hash_bytes(0, cube, sizeof cube);
				uint32_t other;
				for (size_t at = NT_HASH_BEGIN;
					(other = nt_hash_index_next(index, hash, &at)) != UINT32_MAX;)
					if (same_face(face, others + 3 * (size_t)other, tolerance))
						return true;
			}
	return false;
}

/* The first face of `a` that `b` does not have. */
static nt_status find_missing(const nt_verify_corner *a, size_t a_faces, const nt_verify_corner *b,
	size_t b_faces, const nt_verify_tolerance *tolerance, size_t *missing)
{
	const double size = 4.0 * tolerance->position + 1e-30;
	nt_hash_index index = {0};
	nt_status status = NT_OK;
	*missing = SIZE_MAX;
	for (size_t f = 0; f < b_faces && status == NT_OK; f++) {
		int64_t cube[3];
		cube_of(b + 3 * f, size, 0, cube);
		if (!nt_hash_index_add(&index, nt_hash_bytes(0, cube, sizeof cube), (uint32_t)f))
			status = NT_ERROR_MEMORY;
	}
	for (size_t f = 0; f < a_faces && status == NT_OK && *missing == SIZE_MAX; f++)
		if (!is_known(&index, b, a + 3 * f, size, tolerance))
			*missing = f;
	nt_hash_index_free(&index);
	return status;
}

typedef struct both_ways {
	const nt_verify_corner *corners[2];
	size_t face_counts[2], missing[2]; /* missing in the other list */
	const nt_verify_tolerance *tolerance;
	nt_status statuses[2];
} both_ways;

static void ask_one_way(void *context, size_t way, unsigned thread)
{
	both_ways *w = context;
	(void)thread;
	w->statuses[way] = find_missing(w->corners[way], w->face_counts[way], w->corners[1 - way],
		w->face_counts[1 - way], w->tolerance, &w->missing[way]);
}

nt_status nt_verify_faces(const nt_verify_corner *a, size_t a_faces, const nt_verify_corner *b, size_t b_faces,
	const nt_verify_tolerance *tolerance, unsigned threads, size_t *first)
{
	both_ways w = {.corners = {a, b}, .face_counts = {a_faces, b_faces}, .tolerance = tolerance};
	nt_parallel_items(threads, 2, ask_one_way, &w);
	*first = w.missing[0];
	if (*first == SIZE_MAX && (w.missing[1] != SIZE_MAX || a_faces != b_faces))
		*first = 0;
	return w.statuses[0] ? w.statuses[0] : w.statuses[1];
}
