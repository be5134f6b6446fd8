/* SPDX-License-Identifier: MIT */
/*
 * Numbers of vertices and of corners, once it is known which vertices may be equal to another (weld_few.c,
 * weld_sieve.c).
 */
#include "base/parallel.h"
#include "topology/weld_parts.h"

/* Vertices */

bool nt_weld_number_own(nt_welder *w)
{
	w->numbers = nt_borrowed_alloc(w->memory, w->item_count, sizeof *w->numbers);
	for (size_t v = 0; w->numbers && v < w->item_count; v++)
		w->numbers[v] = (uint32_t)v;
	return w->numbers;
}

/* Listed vertices get the number of the first that is equal. Rows stay where they are, and those of the others are
 * nobody's. */
static void number_listed(const nt_welder *w, const nt_welder *listed)
{
	uint32_t *const firsts = listed->numbers; /* takes the place of what has been read */
	size_t classes = 0;
	for (size_t l = 0; l < listed->item_count; l++) {
		const uint32_t class = listed->numbers[l], v = listed->items[l];
		if (class == classes)
			firsts[classes++] = v;
		w->numbers[v] = firsts[class];
	}
}

bool nt_weld_list(nt_welder *w, const uint32_t *list, size_t count, unsigned ranges)
{
	if (count == 0)
		return true;
	nt_welder listed = {.mesh = w->mesh, .row_memory = w->memory, .memory = w->memory, .items = list,
		.item_count = count, .row_guess = count};
	listed.numbers = nt_borrowed_alloc(w->memory, count, sizeof *listed.numbers);
	if (!listed.numbers || !nt_weld_items(&listed, ranges))
		return false;
	w->unordered = listed.unordered;
	if (listed.row_count == count && !w->unordered)
		return true;
	if (!nt_weld_number_own(w))
		return false;
	number_listed(w, &listed);
	return true;
}

/* Corners */

/* In place of the number of a vertex with a NaN: its row was given to a corner. */
#define ROW_GIVEN UINT32_MAX

typedef struct copying {
	const uint32_t *numbers, *indices;
	uint32_t *ids;
} copying;

static void copy_numbers(void *context, size_t begin, size_t end, unsigned slot)
{
	const copying *job = context;
	(void)slot;
	for (size_t c = begin; c < end; c++) {
		const uint32_t vertex = job->indices ? job->indices[c] : (uint32_t)c;
		job->ids[c] = job->numbers ? job->numbers[vertex] : vertex;
	}
}

/* Gives each corner of a vertex with a NaN a row of its own: the first takes that of the vertex. */
static bool number_unordered(nt_welder *w, size_t corner_count, uint32_t *ids)
{
	size_t unordered = 0;
	for (size_t c = 0; c < corner_count; c++)
		unordered += !nt_weld_row_ordered(&w->rows[ids[c]]);
	if (w->row_count + unordered > w->row_capacity && !nt_weld_grow_rows(w, w->row_count + unordered))
		return false;
	for (size_t c = 0; c < corner_count; c++) {
		if (nt_weld_row_ordered(&w->rows[ids[c]]))
			continue;
		const uint32_t vertex = w->mesh->indices[c];
		if (w->numbers[vertex] == ROW_GIVEN)
			ids[c] = (uint32_t)w->row_count++;
		w->numbers[vertex] = ROW_GIVEN;
		nt_weld_load(w->mesh, vertex, &w->rows[ids[c]]);
	}
	return true;
}

const uint32_t *nt_weld_number_corners(nt_welder *w, size_t corner_count, unsigned ranges)
{
	if (!w->numbers && w->mesh->indices)
		return w->mesh->indices;
	uint32_t *ids = nt_scratch_alloc(w->memory->scratch, corner_count, sizeof *ids);
	if (!ids)
		return NULL;
	nt_parallel_ranges(ranges, corner_count, 1, copy_numbers, &(copying){w->numbers, w->mesh->indices, ids});
	return !w->unordered || !w->mesh->indices || number_unordered(w, corner_count, ids) ? ids : NULL;
}
