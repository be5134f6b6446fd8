/* SPDX-License-Identifier: MIT */
/*
 * Numbers of vertices and of corners, once it is known which vertices may be equal to another (weld_sieve.c).
 */
#include "base/parallel.h"
#include "topology/weld_parts.h"

/* Vertices */

static bool number_own(nt_welder *w)
{
	w->numbers = nt_borrowed_alloc(w->memory, w->item_count, sizeof *w->numbers);
	for (size_t v = 0; w->numbers && v < w->item_count; v++)
		w->numbers[v] = (uint32_t)v;
	w->renamed_begin = w->item_count;
	w->renamed_end = 0;
	return w->numbers;
}

static void rename_vertex(nt_welder *w, uint32_t vertex, uint32_t number)
{
	w->numbers[vertex] = number;
	w->renamed_begin = vertex < w->renamed_begin ? vertex : w->renamed_begin;
	w->renamed_end = vertex < w->renamed_end ? w->renamed_end : vertex + 1;
}

/* Listed vertices get the number of the first that is equal. Rows stay where they are, and those of the others are
 * nobody's. */
static void number_listed(nt_welder *w, const nt_welder *listed)
{
	uint32_t *const firsts = listed->numbers; /* takes the place of what has been read */
	size_t classes = 0;
	for (size_t l = 0; l < listed->item_count; l++) {
		const uint32_t class = listed->numbers[l], v = listed->items[l];
		if (class == classes)
			firsts[classes++] = v;
		if (v != firsts[class])
			rename_vertex(w, v, firsts[class]);
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
	if (!number_own(w))
		return false;
	number_listed(w, &listed);
	return true;
}

/* Corners */

/* In place of the number of a vertex with a NaN: its row was given to a corner. */
#define ROW_GIVEN UINT32_MAX

typedef struct copying {
	const uint32_t *numbers, *indices;
	uint32_t renamed_begin, renamed_count;
	uint32_t *ids;
} copying;

/* Corners that are looked at together. */
enum { BLOCK = 32 };

/* Whether a vertex of a block may have another number than its own. Differences are compared with signs, as SSE2 can,
 * and added up as masks: gcc 12 makes numbers of truth values first. */
static inline bool has_renamed(const uint32_t *vertices, uint32_t begin, uint32_t count)
{
	const uint32_t half = (uint32_t)1 << 31;
	int32_t found = 0;
	for (size_t i = 0; i < BLOCK; i++)
		found |= (int32_t)(vertices[i] - begin - half) < (int32_t)(count - half) ? -1 : 0;
	return found;
}

static void copy_numbers(void *context, size_t begin, size_t end, unsigned slot)
{
	const copying job = *(const copying *)context;
	(void)slot;
	for (size_t c = begin; c < end; c++)
		job.ids[c] = job.numbers[job.indices ? job.indices[c] : c];
}

/* The same where few vertices are renamed and lie near each other, as where a seam was appended: blocks without them
 * are copied as they are. 0.3 ns a triangle instead of 0.9 (AMD EPYC, one thread). */
static void copy_blocks(void *context, size_t begin, size_t end, unsigned slot)
{
	const copying job = *(const copying *)context;
	size_t c = begin;
	for (; end - c >= BLOCK; c += BLOCK) {
		if (has_renamed(job.indices + c, job.renamed_begin, job.renamed_count))
			copy_numbers(context, c, c + BLOCK, slot);
		else
			memcpy(job.ids + c, job.indices + c, BLOCK * sizeof *job.ids);
	}
	copy_numbers(context, c, end, slot);
}

/* Corners are vertices. */
static void copy_own(void *context, size_t begin, size_t end, unsigned slot)
{
	const copying job = *(const copying *)context;
	(void)slot;
	for (size_t c = begin; c < end; c++)
		job.ids[c] = (uint32_t)c;
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
	const size_t renamed = w->renamed_end - w->renamed_begin;
	const bool blocks = w->mesh->indices && renamed < w->item_count / 2;
	nt_parallel_ranges(ranges, corner_count, 1, !w->numbers ? copy_own : blocks ? copy_blocks : copy_numbers,
		&(copying){w->numbers, w->mesh->indices, (uint32_t)w->renamed_begin, (uint32_t)renamed, ids});
	return !w->unordered || !w->mesh->indices || number_unordered(w, corner_count, ids) ? ids : NULL;
}
