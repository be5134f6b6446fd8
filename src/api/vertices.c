/* SPDX-License-Identifier: MIT */
/*
 * Tangents of vertices: solve, repair and split in one, without a row for every corner.
 *
 * Nearly every corner's tangent is that of its welded vertex (nt_known.ids). A vertex whose corners all have one row
 * needs no look at its corners: its tangent is that row. Only vertices of both orientations and those of suspect
 * triangles stay open and are split corner by corner, in order. On a clean mesh this reads each row once, where going
 * by corners reads it six times, and writes no index. All passes but the one over open corners go by ranges of vertices
 * or triangles.
 *
 * For meshes with quads all rows are written and split one after the other.
 */
#include "api/inside.h"

#include <string.h>
#include "base/deadline.h"
#include "base/parallel.h"
#include "tangent/frames.h"
#include "topology/corners.h"

typedef struct vertex_split {
	const nt_solve *solve;
	nt_splitter *splitter;
	const uint32_t *numbers; /* [vertex_count] welded vertex of each; NULL: v is v */
	uint32_t *found;         /* numbers, while they are being found */
	uint8_t *touched;        /* [triangle_count] 1: has a corner at an open vertex */
	size_t *open;            /* [ranges] open vertices */
} vertex_split;

/* Values of nt_splitter.seen before the corners are taken; those of open vertices become 1 then. */
enum { SEEN_NOT = 0, SEEN_OPEN = 2, SEEN_ONE = 3 };

enum { VERTEX_GRAIN = 32768 }; /* vertices or triangles per thread below which threads do not pay */

#define NO_NUMBER UINT32_MAX

/* Other threads write the same value, or one that check_numbers() finds to differ. */
static void find_numbers(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const vertex_split *job = context;
	const uint32_t *indices = job->solve->mesh->indices, *ids = job->solve->known->ids;
	for (size_t c = 3 * begin; c < 3 * end; c++)
		nt_atomic_store(&job->found[indices[c]], ids[c], RELAXED);
}

/* A vertex with a NaN is another welded vertex at each corner. */
static void check_numbers(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const vertex_split *job = context;
	const uint32_t *indices = job->solve->mesh->indices, *ids = job->solve->known->ids;
	for (size_t c = 3 * begin; c < 3 * end; c++)
		if (job->numbers[indices[c]] != ids[c])
			nt_atomic_store(&job->splitter->seen[indices[c]], SEEN_OPEN, RELAXED);
}

/* Which welded vertex each vertex of the mesh is. */
static nmtan_status number_vertices(vertex_split *job)
{
	const nt_solve *solve = job->solve;
	const nmtan_mesh *mesh = solve->mesh;
	if (solve->known->ids == mesh->indices)
		return NMTAN_OK;
	if (!mesh->indices) {
		job->numbers = solve->known->ids;
		return NMTAN_OK;
	}
	job->found = nt_scratch_alloc(solve->scratch, mesh->vertex_count, sizeof *job->found);
	if (!job->found)
		return NMTAN_ERROR_MEMORY;
	memset(job->found, 0xff, mesh->vertex_count * sizeof *job->found);
	job->numbers = job->found;
	nt_parallel_ranges(solve->threads, solve->mesh->face_count, VERTEX_GRAIN, find_numbers, job);
	nt_parallel_ranges(solve->threads, solve->mesh->face_count, VERTEX_GRAIN, check_numbers, job);
	return NMTAN_OK;
}

/* Corners of suspect triangles have rows of their own. */
static void open_suspects(const vertex_split *job)
{
	const nmtan_mesh *mesh = job->solve->mesh;
	const nt_known *known = job->solve->known;
	size_t t = nt_next_flagged(known->flags, 0, mesh->face_count, known->suspect);
	for (; t < mesh->face_count; t = nt_next_flagged(known->flags, t + 1, mesh->face_count, known->suspect))
		for (size_t i = 3 * t; i < 3 * t + 3; i++)
			job->splitter->seen[nt_vertex_of(mesh, i)] = SEEN_OPEN;
}

static bool has_result(const nt_known *known, int side, uint32_t number)
{
	return known->rows[side] && known->rows[side][known->row_step * number + 3] != 0.0f;
}

/* Gives vertices [begin, end) their one row; counts those that do not have one. */
static void take_vertices(void *context, size_t begin, size_t end, unsigned thread)
{
	const vertex_split *job = context;
	const nt_known *known = job->solve->known;
	size_t open = 0;
	for (size_t v = begin; v < end; v++) {
		const uint32_t number = job->numbers ? job->numbers[v] : (uint32_t)v;
		uint8_t *seen = &job->splitter->seen[v];
		if (number == NO_NUMBER)
			continue;
		const bool positive = has_result(known, 1, number);
		if (*seen == SEEN_OPEN || (positive && has_result(known, 0, number))) {
			*seen = SEEN_NOT;
			open++;
		} else if (positive || has_result(known, 0, number)) {
			const float *row = known->rows[positive] + known->row_step * number;
			*seen = SEEN_ONE;
			memcpy(job->splitter->tangents + 4 * v, row, 4 * sizeof(float));
		}
	}
	job->open[thread] = open;
}

static void touch_triangles(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const vertex_split *job = context;
	const nmtan_mesh *mesh = job->solve->mesh;
	const uint8_t *seen = job->splitter->seen;
	for (size_t t = begin; t < end; t++)
		job->touched[t] = !(seen[nt_vertex_of(mesh, 3 * t)] & seen[nt_vertex_of(mesh, 3 * t + 1)] &
			seen[nt_vertex_of(mesh, 3 * t + 2)]);
}

/* The corners at open vertices, in order. */
static nmtan_status split_open(vertex_split *job)
{
	const nt_solve *solve = job->solve;
	job->touched = nt_scratch_alloc(solve->scratch, solve->mesh->face_count, 1);
	if (!job->touched)
		return NMTAN_ERROR_MEMORY;
	nt_parallel_ranges(solve->threads, solve->mesh->face_count, VERTEX_GRAIN, touch_triangles, job);
	nmtan_status status = NMTAN_OK;
	const size_t count = solve->mesh->face_count;
	size_t t = nt_next_flagged(job->touched, 0, count, 1);
	for (; !status && t < count; t = nt_next_flagged(job->touched, t + 1, count, 1))
		for (size_t i = 3 * t; !status && i < 3 * t + 3; i++) {
			const uint32_t vertex = (uint32_t)nt_vertex_of(solve->mesh, i);
			if (job->splitter->seen[vertex] != SEEN_ONE)
				status = nt_splitter_take(job->splitter, vertex, nt_corner_tangent(solve, i), i);
		}
	return status;
}

static nmtan_status split_shared(const nt_solve *solve, nt_splitter *splitter)
{
	/* without indices vertices behind the last corner have none */
	const size_t vertex_count = solve->mesh->indices ? solve->mesh->vertex_count : solve->corner_count;
	const double begin = nt_seconds();
	const unsigned threads = nt_parallel_slots(solve->threads, vertex_count, VERTEX_GRAIN);
	vertex_split job = {.solve = solve, .splitter = splitter,
		.open = nt_scratch_alloc(solve->scratch, threads, sizeof *job.open)};
	nmtan_status status = job.open ? number_vertices(&job) : NMTAN_ERROR_MEMORY;
	if (status)
		return status;
	open_suspects(&job);
	nt_parallel_ranges(solve->threads, vertex_count, VERTEX_GRAIN, take_vertices, &job);
	size_t open = 0;
	for (unsigned thread = 0; thread < threads; thread++)
		open += job.open[thread];
	if (open)
		status = split_open(&job);
	if (solve->timing)
		solve->timing->split += nt_seconds() - begin;
	return status;
}

static nmtan_status split_rows(const nt_solve *solve, nt_splitter *splitter)
{
	const double begin = nt_seconds();
	for (size_t c = 0; c < solve->corner_count; c++) {
		const nmtan_status status = nt_splitter_take(splitter,
			(uint32_t)nt_vertex_of(solve->mesh, c), solve->tangents + 4 * c, c);
		if (status)
			return status;
	}
	if (solve->timing)
		solve->timing->split += nt_seconds() - begin;
	return NMTAN_OK;
}

nmtan_status nt_repair_and_split(const nt_solve *solve, nmtan_counts *counts, nt_splitter *splitter)
{
	const nmtan_status status = nt_repair(solve, counts);
	if (status)
		return status;
	return solve->known && solve->known->ids ? split_shared(solve, splitter) : split_rows(solve, splitter);
}
