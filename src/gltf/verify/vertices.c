/* SPDX-License-Identifier: MIT */
/*
 * The comparison of vertices.h. A list is put into cells, by position and by x of the tangent, since a hub has any
 * number of vertices at one place. A cell is some tolerances wide: a value has its like in one or two along each axis,
 * and mostly in one.
 */
#include "gltf/verify/verify.h"

#include <math.h>
#include <string.h>
#include "base/hash_index.h"

enum { AXES = 4, WIDTH = 16 };

static bool within(const float *a, const float *b, size_t count, float tolerance)
{
	for (size_t i = 0; i < count; i++)
		/* what is not finite has to be the same */
		if (!(fabsf(a[i] - b[i]) <= tolerance) && !(isnan(a[i]) && isnan(b[i])) && a[i] != b[i])
			return false;
	return true;
}

bool nt_verify_close(const nt_verify_vertex *a, const nt_verify_vertex *b, const nt_verify_tolerance *tolerance)
{
	const float u = a->tangent[3], w = b->tangent[3];
	/* a client takes w of 1 and -1 alone */
	return within(a->position, b->position, 3, tolerance->position) &&
		within(a->tangent, b->tangent, 4, tolerance->tangent) && (u == w || (fabsf(u) != 1 && fabsf(w) != 1));
}

/* The cell of a vertex along an axis, moved by some of its tolerance; all that is not finite is in one. */
static double cell_of(const nt_verify_vertex *v, size_t axis, double moved, const nt_verify_tolerance *tolerance)
{
	const double value = axis < 3 ? v->position[axis] : v->tangent[0];
	const double slack = axis < 3 ? tolerance->position : tolerance->tangent;
	const double cell = slack > 0 ? floor((value + moved * slack) / (WIDTH * slack)) : value;
	return isfinite(cell) ? cell + 0.0 : 0;
}

/* Whether a vertex has one in the list. */
static bool is_there(const nt_hash_index *cells, const nt_verify_vertex *list, const nt_verify_vertex *v,
	const nt_verify_tolerance *tolerance)
{
	double low[AXES], high[AXES];
	for (size_t k = 0; k < AXES; k++) {
		low[k] = cell_of(v, k, -1.01, tolerance);
		high[k] = cell_of(v, k, 1.01, tolerance);
	}
	for (unsigned corner = 0; corner < 1u << AXES; corner++) {
		double cell[AXES];
		bool met = false; /* with another corner */
		uint32_t i;
		for (size_t k = 0; k < AXES; k++) {
			met |= corner >> k & 1 && low[k] == high[k];
			cell[k] = corner >> k & 1 ? high[k] : low[k];
		}
		const uint64_t hash = nt_hash_bytes(0, cell, sizeof cell);
		for (size_t at = NT_HASH_BEGIN; !met && (i = nt_hash_index_next(cells, hash, &at)) != UINT32_MAX;)
			if (nt_verify_close(v, &list[i], tolerance))
				return true;
	}
	return false;
}

/* Puts a list into cells, each vertex once. False: out of memory. */
static bool fill(nt_hash_index *cells, const nt_verify_vertex *list, size_t count, const nt_verify_tolerance *tolerance)
{
	bool added = true;
	for (size_t i = 0; added && i < count; i++) {
		double cell[AXES];
		uint32_t other;
		for (size_t k = 0; k < AXES; k++)
			cell[k] = cell_of(&list[i], k, 0, tolerance);
		const uint64_t hash = nt_hash_bytes(0, cell, sizeof cell);
		for (size_t at = NT_HASH_BEGIN; (other = nt_hash_index_next(cells, hash, &at)) != UINT32_MAX;)
			if (memcmp(&list[other], &list[i], sizeof *list) == 0)
				break;
		if (other == UINT32_MAX)
			added = nt_hash_index_add(cells, hash, (uint32_t)i);
	}
	return added;
}

/* The first of a list that the other one does not have; SIZE_MAX: none. */
static nt_status find_missing(const nt_verify_vertex *list, size_t count, const nt_verify_vertex *other,
	size_t other_count, const nt_verify_tolerance *tolerance, size_t *missing)
{
	nt_hash_index cells = {0};
	const bool filled = fill(&cells, other, other_count, tolerance);
	*missing = SIZE_MAX;
	for (size_t i = 0; filled && i < count && *missing == SIZE_MAX; i++)
		if (!is_there(&cells, other, &list[i], tolerance))
			*missing = i;
	nt_hash_index_free(&cells);
	return filled ? NT_OK : NT_ERROR_MEMORY;
}

nt_status nt_verify_vertices(const nt_verify_vertex *a, size_t a_count, const nt_verify_vertex *b, size_t b_count,
	const nt_verify_tolerance *tolerance, size_t *first)
{
	size_t other;
	nt_status status = find_missing(a, a_count, b, b_count, tolerance, first);
	if (status || *first != SIZE_MAX)
		return status;
	status = find_missing(b, b_count, a, a_count, tolerance, &other);
	*first = other == SIZE_MAX ? SIZE_MAX : 0;
	return status;
}
