/* SPDX-License-Identifier: MIT */
/*
 * Positions that float cannot hold: the rule is that of scene/origin.h. All vertices have their positions as floats
 * when it is asked. Only if these are suspicious are the `v` lines read again, by the same parser, as doubles.
 */
#include "obj/parts.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"
#include "scene/origin.h"

enum { GRAIN = 1 << 14 }; /* vertices for each thread that are worth one */

/* ---- edges ---- */

/* The length of an edge between vertices of the file: in doubles, if there are any. */
static double length_of(const float *positions, const double *exact, size_t a, size_t b)
{
	double square = 0;
	for (size_t k = 0; k < 3; k++) {
		const double d = exact ? exact[3 * a + k] - exact[3 * b + k]
			: (double)positions[3 * a + k] - (double)positions[3 * b + k];
		square += d * d;
	}
	return sqrt(square);
}

/* Lengths of one edge of each of `most` faces or fewer, evenly taken from the file; the count is returned. */
static size_t sample_edges(const obj_file *file, const float *positions, const double *exact, size_t most,
	double *lengths)
{
	const size_t step = file->face_count / most + 1;
	size_t count = 0, corner = 0, polygon = 0, mesh = 0;
	for (size_t f = 0; f < file->face_count; f += step) {
		while (file->meshes[mesh + 1].face <= f)
			mesh++;
		const size_t k = count % 3;
		const uint32_t *v = file->corner_vertices + corner;
		const size_t base = file->meshes[mesh].vertex;
		/* edge 2 is that between corners 0 and 2, a diagonal in larger faces */
		const double length = length_of(positions, exact, base + v[k < 2 ? k : 0], base + v[k < 2 ? k + 1 : 2]);
		if (length > 0 || !exact)
			lengths[count++] = length;
		const size_t end = f + step < file->face_count ? f + step : file->face_count;
		for (size_t i = f; i < end; i++)
			corner += file->face_sizes[i];
		for (; polygon < file->polygon_count && file->polygons[polygon].face < end; polygon++)
			corner += file->polygons[polygon].size - OBJ_POLYGON;
	}
	return count;
}

/* ---- doubles ---- */

typedef struct second_reading {
	const obj_file *file;
	double *rows;   /* [row_counts[OBJ_V]][3] */
	double *exact;  /* [vertex_count][3] */
	atomic_bool failed;
} second_reading;

static void read_chunk(void *context, size_t item, unsigned slot)
{
	(void)slot;
	second_reading *job = context;
	const obj_chunk *chunk = &job->file->chunks[item];
	obj_chunk again = obj_chunk_of(chunk->begin, chunk->end);
	again.exact = job->rows + 3 * chunk->rows[OBJ_V].first;
	again.exact_count = chunk->rows[OBJ_V].count;
	again.rare = true;
	/* other faults are those of a file that has changed, which the run's watch of its inputs tells */
	if (obj_read_lines(&again, SIZE_MAX) == NT_ERROR_MEMORY)
		atomic_store(&job->failed, true);
	obj_chunk_free(&again);
}

static void gather_exact(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	const second_reading *job = context;
	for (size_t i = begin; i < end; i++)
		memcpy(job->exact + 3 * i, job->rows + 3 * (size_t)job->file->vertices[i].v, 3 * sizeof(double));
}

/* Fills job->exact; false: out of memory. The lines have been read once without a fault. */
static bool read_exact(second_reading *job)
{
	const obj_file *file = job->file;
	job->rows = nt_calloc(file->row_counts[OBJ_V], 3 * sizeof *job->rows);
	if (!job->rows || !job->exact)
		return false;
	nt_parallel_items(file->threads, file->chunk_count, read_chunk, job);
	const bool done = !atomic_load(&job->failed);
	if (done)
		nt_parallel_ranges(file->threads, file->vertex_count, GRAIN, gather_exact, job);
	free(job->rows);
	return done;
}

/* ---- the whole ---- */

nt_status obj_settle_origin(obj_file *file, float largest, float *positions, nt_error *error)
{
	const nt_read_options *options = file->options;
	double *lengths = nt_alloc(NT_ORIGIN_SAMPLED, sizeof *lengths);
	if (!lengths)
		return nt_fail_memory(error);
	const size_t tried = sample_edges(file, positions, NULL, NT_ORIGIN_TRIED, lengths);
	if (!nt_origin_is_given(&options->origin) &&
		!nt_origin_is_suspected(largest, lengths, tried, NT_ORIGIN_DOUBT)) {
		free(lengths);
		return NT_OK;
	}
	/* a file of text keeps the doubles for the writer of one mesh in the world, which PLY can hold */
	second_reading job = {.file = file,
		.exact = nt_arena_alloc(&file->scene->arena, file->vertex_count, 3 * sizeof *job.exact)};
	const bool done = read_exact(&job);
	if (done) {
		const nt_exact exact = {job.exact, file->vertex_count, lengths,
			sample_edges(file, positions, job.exact, NT_ORIGIN_SAMPLED, lengths)};
		nt_origin_settle(file->scene, &options->origin, &exact, positions);
		file->exact_positions = options->world && nt_scene_has_origin(file->scene) ? job.exact : NULL;
	}
	free(lengths);
	return done ? NT_OK : nt_fail_memory(error);
}
