/* SPDX-License-Identifier: MIT */
/*
 * Welding: an indexed mesh by its vertices (weld_bloom.c), and so a soup of triangles that hardly share any; others by
 * their corners, whose rows are looked up in a table (weld_table.c); several threads do so for a range of corners each
 * (weld_threads.c).
 */
#include "topology/weld.h"

#include "base/parallel.h"
#include "topology/inside.h"

/* Soups of fewer corners are not looked at. */
enum { LEAST_FLAT = 3 * 1024 };

/* Whether the corners of a mesh without indices seem to have vertices of their own, as with a normal for each triangle:
 * in triangles that follow one another, at some places, hardly any two are equal. The filter is given up soon where
 * that was chance. */
static bool is_flat(const nmtan_mesh *mesh, size_t corner_count)
{
	enum { PLACES = 16, TRIANGLES = 4, CORNERS = 3 * TRIANGLES };
	size_t equal = 0;
	if (corner_count < LEAST_FLAT)
		return false;
	for (size_t place = 0; place < PLACES; place++) {
		nt_weld_row rows[CORNERS];
		for (size_t i = 0; i < CORNERS; i++) {
			nt_weld_load(mesh, corner_count / (3 * PLACES) * 3 * place + i, &rows[i]);
			size_t before = 0;
			while (before < i && !nt_weld_same(&rows[before], &rows[i]))
				before++;
			equal += before < i;
		}
	}
	return equal <= PLACES / 2;
}

/* In place of the number of a vertex with a NaN: its row was given to a corner. */
#define ROW_GIVEN UINT32_MAX

typedef struct copying {
	const uint32_t *numbers, *indices;
	uint32_t *ids;
} copying;

static void copy_numbers(void *context, size_t begin, size_t end, unsigned thread)
{
	const copying job = *(const copying *)context;
	(void)thread;
	for (size_t c = begin; c < end; c++) {
		const size_t vertex = job.indices ? job.indices[c] : c;
		job.ids[c] = job.numbers ? job.numbers[vertex] : (uint32_t)vertex;
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

/* Numbers of corners from numbers of vertices, NULL: each its own; without indices likewise. May be the mesh's
 * indices; NULL when out of memory. */
static const uint32_t *number_corners(nt_welder *w, size_t corner_count, unsigned ranges)
{
	if (!w->numbers && w->mesh->indices)
		return w->mesh->indices;
	uint32_t *ids = nt_scratch_alloc(w->memory->scratch, corner_count, sizeof *ids);
	if (!ids)
		return NULL;
	copying c = {w->numbers, w->mesh->indices, ids};
	nt_parallel_ranges(ranges, corner_count, 1, copy_numbers, &c);
	return !w->unordered || !w->mesh->indices || number_unordered(w, corner_count, ids) ? ids : NULL;
}

/* All vertices by the table. */
static nt_weld_outcome weld_all(nt_welder *w, unsigned ranges)
{
	w->row_guess = w->item_count / 2;
	w->numbers = nt_borrowed_alloc(w->memory, w->item_count, sizeof *w->numbers);
	return w->numbers && nt_weld_items(w, ranges) ? NT_WELD_DONE : NT_WELD_NO_MEMORY;
}

/* Returns the number of each corner, which may be the mesh's indices; NULL when out of memory. */
static const uint32_t *weld_vertices(nt_welder *w, size_t corner_count, unsigned ranges)
{
	char *const begin = w->memory->begin, *const row_begin = w->row_memory->begin;
	const nt_scratch_mark mark = nt_scratch_here(w->memory->scratch);
	nt_weld_outcome outcome = nt_weld_by_filter(w, ranges);
	if (outcome == NT_WELD_MANY) {
		/* the table takes the memory that the filter had */
		w->memory->begin = begin;
		w->row_memory->begin = row_begin;
		nt_scratch_back(w->memory->scratch, mark);
		w->rows = NULL;
		outcome = weld_all(w, ranges);
	}
	return outcome == NT_WELD_DONE ? number_corners(w, corner_count, ranges) : NULL;
}

nmtan_status nt_weld_mesh(const nmtan_mesh *mesh, size_t corner_count, unsigned ranges, nt_borrowed *row_memory,
	nt_borrowed *memory, nt_weld *weld)
{
	nt_welder w = {.mesh = mesh, .key = nt_weld_make_key(), .row_memory = row_memory, .memory = memory};
	char *const begin = memory->begin;
	/* few of many vertices used: corner by corner, so that time follows the corners */
	if (mesh->indices ? mesh->vertex_count / 2 > corner_count : !is_flat(mesh, corner_count)) {
		w.items = mesh->indices;
		w.item_count = corner_count;
		w.row_guess = corner_count / 4; /* corners share vertices, usually six to one */
		w.numbers = nt_scratch_alloc(memory->scratch, corner_count, sizeof *w.numbers);
		weld->ids = w.numbers && nt_weld_items(&w, ranges) ? w.numbers : NULL;
	} else {
		w.item_count = mesh->indices ? mesh->vertex_count : corner_count;
		weld->ids = weld_vertices(&w, corner_count, ranges);
	}
	if (!weld->ids)
		return NMTAN_ERROR_MEMORY;
	/* tables and numbers of vertices are not needed any more */
	if (row_memory != memory || !w.rows_borrowed)
		memory->begin = begin;
	if (w.rows_borrowed)
		nt_borrowed_trim(row_memory, w.rows, w.row_count * sizeof *w.rows);
	weld->rows = w.rows;
	weld->count = w.row_count;
	return NMTAN_OK;
}
