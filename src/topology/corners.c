/* SPDX-License-Identifier: MIT */
/*
 * Corners: the check of faces and indices that lets every later stage trust them, and welding by hash.
 * A vertex of an indexed mesh is hashed once, further corners take its number. The table is
 * open-addressed and at most half full. Vertices that were made to have one hash are welded without it.
 */
#include "topology/corners.h"

#include <string.h>
#include "base/largest.h"
#include "topology/weld_parts.h"

/* Counts the corners; every face must have 3 or 4. */
static nmtan_status count_corners(const nmtan_mesh *mesh, size_t *corner_count)
{
	*corner_count = mesh->face_count * 3;
	if (!mesh->face_sizes)
		return NMTAN_OK;
	size_t quads = 0, wrong = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		quads += mesh->face_sizes[face] == 4;
		wrong += mesh->face_sizes[face] != 4 && mesh->face_sizes[face] != 3;
	}
	*corner_count += quads;
	return wrong ? NMTAN_ERROR_FACE_SIZE : NMTAN_OK;
}

nmtan_status nt_check_faces(const nmtan_mesh *mesh, unsigned threads, size_t *corner_count)
{
	if (mesh->face_count > NMTAN_MAX_FACES || mesh->vertex_count > UINT32_MAX)
		return NMTAN_ERROR_TOO_LARGE;
	const nmtan_status status = count_corners(mesh, corner_count);
	if (status)
		return status;
	if (!mesh->indices)
		return *corner_count > mesh->vertex_count ? NMTAN_ERROR_INDEX : NMTAN_OK;
	const uint32_t most = nt_largest(mesh->indices, *corner_count, threads);
	return *corner_count > 0 && most >= mesh->vertex_count ? NMTAN_ERROR_INDEX : NMTAN_OK;
}

enum { ROW_FLOATS = 8, EMPTY = -1 };

/* One vertex's eight floats with -0 made +0, so that equal rows have equal bits; false when one is NaN. */
static bool gather_row(const nmtan_mesh *mesh, size_t vertex, uint32_t row[ROW_FLOATS])
{
	float values[ROW_FLOATS];
	memcpy(values, nt_position(mesh, vertex), 3 * sizeof(float));
	memcpy(values + 3, nt_normal(mesh, vertex), 3 * sizeof(float));
	memcpy(values + 6, nt_texcoord(mesh, vertex), 2 * sizeof(float));
	bool ordered = true;
	for (int i = 0; i < ROW_FLOATS; i++) {
		values[i] += 0.0f;
		ordered = ordered && values[i] == values[i];
	}
	memcpy(row, values, sizeof values);
	return ordered;
}

static uint64_t hash_row(const uint32_t row[ROW_FLOATS])
{
	uint64_t hash = 0x9e3779b97f4a7c15u;
	for (int i = 0; i < ROW_FLOATS; i += 2) {
		const uint64_t pair = (uint64_t)row[i + 1] << 32 | row[i];
		hash = (hash ^ pair) * 0xff51afd7ed558ccdu;
		hash ^= hash >> 32;
	}
	return hash;
}

static size_t table_size(size_t entries)
{
	size_t size = 16;
	while (size < entries * 2)
		size *= 2;
	return size;
}

/* Numbers corners in order of first appearance; returns how many numbers, or SIZE_MAX where the table is crowded.
 * `table` and `number` are all EMPTY. */
static size_t weld_by_table(const nmtan_mesh *mesh, size_t corner_count, int64_t *table, size_t size, int64_t *number,
	uint32_t *ids)
{
	uint32_t next = 0;
	size_t steps = 0;
	for (size_t corner = 0; corner < corner_count; corner++) {
		const size_t vertex = nt_vertex_of(mesh, corner);
		uint32_t row[ROW_FLOATS];
		if (number[vertex] != EMPTY) {
			ids[corner] = (uint32_t)number[vertex];
			continue;
		}
		if (!gather_row(mesh, vertex, row)) {
			ids[corner] = next++; /* NaN: every corner stands alone */
			continue;
		}
		size_t at = hash_row(row) & (size - 1);
		for (; table[at] != EMPTY; at = (at + 1) & (size - 1), steps++) {
			uint32_t other[ROW_FLOATS];
			gather_row(mesh, (size_t)table[at], other);
			if (memcmp(row, other, sizeof row) == 0)
				break;
		}
		if (nt_weld_too_many(steps, corner_count))
			return SIZE_MAX;
		if (table[at] == EMPTY) {
			table[at] = (int64_t)vertex;
			number[vertex] = next++;
		} else {
			number[vertex] = number[table[at]];
		}
		ids[corner] = (uint32_t)number[vertex];
	}
	return next;
}

nmtan_status nt_weld_corners(const nmtan_mesh *mesh, size_t corner_count, nt_scratch *scratch,
	uint32_t *ids, size_t *count)
{
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	const size_t size = table_size(mesh->vertex_count < corner_count ? mesh->vertex_count
									: corner_count);
	int64_t *table = nt_scratch_alloc(scratch, size, sizeof *table); /* vertex, or EMPTY */
	int64_t *number = nt_scratch_alloc(scratch, mesh->vertex_count, sizeof *number);
	bool done = table && number;
	if (done) {
		memset(table, 0xff, size * sizeof *table);
		memset(number, 0xff, mesh->vertex_count * sizeof *number);
		*count = weld_by_table(mesh, corner_count, table, size, number, ids);
	}
	nt_scratch_back(scratch, mark);
	if (done && *count == SIZE_MAX) {
		nt_borrowed memory = nt_borrow(NULL, 0, scratch);
		nt_welder w = {.mesh = mesh, .row_memory = &memory, .memory = &memory, .items = mesh->indices,
			.item_count = corner_count, .numbers = ids};
		done = nt_weld_by_bits(&w);
		*count = w.row_count;
		nt_scratch_back(scratch, mark);
	}
	return done ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}
