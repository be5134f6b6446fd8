/* SPDX-License-Identifier: MIT */
/*
 * Lines that are read again, by the same parser.
 *
 * Positions that float cannot hold: the rule is that of scene/values.h. All vertices have their positions as floats
 * when it is asked. Only if these are suspicious are the `v` lines read again, as doubles.
 *
 * The line of a face: nothing is kept of it while the file is read, as only reports ask for it, and for a few faces.
 * Their chunks are read again, as far as the face. For that, 32 bytes of each chunk and 8 of each mesh outlive the
 * reader.
 */
#include "obj/parts.h"

#include <stdatomic.h>
#include <stdlib.h>
#include "base/parallel.h"
#include "scene/values.h"

enum { GRAIN = 1 << 14 }; /* vertices for each thread that are worth one */

/* ---- edges ---- */

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
		lengths[count] = nt_edge_length(positions, exact, base + v[k < 2 ? k : 0], base + v[k < 2 ? k + 1 : 2]);
		count += lengths[count] > 0 || !exact;
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
	if (!job->rows || !job->exact) {
		free(job->rows);
		return false;
	}
	nt_parallel_items(file->threads, file->chunk_count, read_chunk, job);
	const bool done = !atomic_load(&job->failed);
	if (done)
		nt_parallel_ranges(file->threads, file->vertex_count, GRAIN, gather_exact, job);
	free(job->rows);
	return done;
}

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
		const nt_exact exact = {.positions = job.exact, .vertex_count = file->vertex_count, .edges = lengths,
			.edge_count = sample_edges(file, positions, job.exact, NT_ORIGIN_SAMPLED, lengths)};
		nt_origin_settle(file->scene, &options->origin, &exact, positions);
		file->exact_positions = options->world && nt_scene_has_origin(file->scene) ? job.exact : NULL;
	}
	free(lengths);
	return done ? NT_OK : nt_fail_memory(error);
}

/* ---- lines of faces ---- */

/* Lines of the input, and what comes before them in the file. */
typedef struct stretch {
	const char *begin, *end;
	size_t first_face, first_line;
} stretch;

/* Data that the reader leaves in the scene. */
typedef struct places {
	stretch *stretches;
	size_t stretch_count;
	size_t *mesh_faces; /* [mesh_count] first face of each mesh */
} places;

/* The words behind "f" as far as there is room for whole ones, one blank between two. */
static const char *copy_corners(const char *p, nt_arena *arena)
{
	char words[512];
	size_t length = 0;
	for (;;) {
		while (!is_word_end(p) && *p != '#')
			p++;
		while (is_blank(*p) || joins_lines(p))
			p = is_blank(*p) ? p + 1 : behind_line_end(p + 1);
		if (is_line_end(*p) || *p == '#')
			return nt_arena_text(arena, words, length);
		size_t size = 0;
		while (!is_word_end(p + size) && p[size] != '#')
			size++;
		if (length + size + sizeof " ..." > sizeof words) {
			memcpy(words + length, " ...", 4);
			return nt_arena_text(arena, words, length + 4);
		}
		if (length)
			words[length++] = ' ';
		memcpy(words + length, p, size);
		length += size;
	}
}

/* The number of a face in the file. */
static size_t number_of(const places *kept, const nt_face_place *face)
{
	return kept->mesh_faces[face->mesh] + face->face;
}

/* Locates faces of one chunk. */
static nt_status locate_in(const places *kept, const stretch *lines, const char *begin, const char *end,
	nt_face_place *faces, size_t count, nt_arena *arena)
{
	obj_chunk again = obj_chunk_of(begin, end);
	nt_status status = NT_OK;
	for (size_t i = 0; i < count && !status; i++) {
		const size_t face = number_of(kept, &faces[i]) - lines->first_face;
		status = obj_read_lines(&again, face);
		if (status)
			break;
		faces[i].line = lines->first_line + again.statement_line + 1;
		faces[i].corners = copy_corners(again.statement, arena);
		if (!faces[i].corners)
			status = NT_ERROR_MEMORY;
	}
	obj_chunk_free(&again);
	return status;
}

/* For nt_scene.locate_faces. */
static nt_status locate_faces(const nt_scene *scene, nt_face_place *faces, size_t count, nt_arena *arena)
{
	const places *kept = scene->source;
	nt_status status = NT_OK;
	size_t s = 0;
	for (size_t i = 0, next; i < count && !status; i = next) {
		while (s + 1 < kept->stretch_count &&
			kept->stretches[s + 1].first_face <= number_of(kept, &faces[i]))
			s++;
		const stretch *lines = &kept->stretches[s];
		const bool last = s + 1 == kept->stretch_count;
		for (next = i + 1; next < count; next++)
			if (!last && number_of(kept, &faces[next]) >= lines[1].first_face)
				break;
		const char *end = lines->end;
		char *copy = last ? obj_copy_padded(lines->begin, lines->end, &end) : NULL;
		status = last && !copy ? NT_ERROR_MEMORY
			: locate_in(kept, lines, last ? copy : lines->begin, end, faces + i, next - i, arena);
		free(copy);
	}
	return status;
}

bool obj_keep_places(const obj_file *file)
{
	nt_scene *scene = file->scene;
	places *kept = nt_arena_alloc(&scene->arena, 1, sizeof *kept);
	stretch *stretches = nt_arena_alloc(&scene->arena, file->chunk_count, sizeof *stretches);
	size_t *mesh_faces = nt_arena_alloc(&scene->arena, file->mesh_count, sizeof *mesh_faces);
	if (!kept || !stretches || !mesh_faces)
		return false;
	for (size_t c = 0; c < file->chunk_count; c++) {
		const obj_chunk *chunk = &file->chunks[c];
		stretches[c] = (stretch){chunk->begin, chunk->end, chunk->first_face, chunk->first_line};
	}
	stretches[file->chunk_count - 1].begin = file->tail_begin;
	stretches[file->chunk_count - 1].end = file->tail_end;
	for (size_t m = 0; m < file->mesh_count; m++)
		mesh_faces[m] = file->meshes[m].face;
	*kept = (places){stretches, file->chunk_count, mesh_faces};
	scene->source = kept;
	scene->locate_faces = locate_faces;
	return true;
}
