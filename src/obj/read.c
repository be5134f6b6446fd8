/* SPDX-License-Identifier: MIT */
/*
 * The OBJ reader: Wavefront's object files as they are found in the wild. One pass over the mapped
 * bytes, in chunks of whole lines that threads take one after the other; then the chunks are joined.
 *
 *   split     the file into chunks of 1 MiB, whatever the number of threads, so that it cannot show
 *   parse     lines.c: numbers, corners, and the statements between faces
 *   join      what was counted; rows of numbers stay in their chunks and are found there
 *   events    spans.c: objects, materials and smoothing groups, in order
 *   vertices  vertices.c: equal v/vt/vn of one object become one vertex
 *   origin    again.c: positions that float cannot hold are read again, as doubles
 *   meshes    meshes.c: faces, quads kept, larger polygons triangulated
 *
 * Few faces are asked for their place in the text: again.c reads their lines again.
 *
 * An `o` makes a mesh, and so does a `g` in a file without `o`. The u and v of texture coordinates are kept as they
 * stand (v up). Colours behind positions are sRGB, as Blender and three.js write them, and become linear.
 * Numbers that are not finite are an error wherever they stand: no output format can hold them. So is a
 * file without faces: there is nothing to put tangents on.
 */
#include "obj/read.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "base/deadline.h"
#include "base/parallel.h"
#include "file/input.h"
#include "obj/parts.h"

enum {
	CHUNK_BYTES = 1 << 20,
	FEW_CHUNKS = 4,       /* of more, arrays are copied to blocks in which 1 MiB of text is no large request */
	BLOCK_BYTES = 4 << 20,
	TAIL_BYTES = 16,      /* at least so many bytes of the file go through the padded copy */
	RECOGNISE_BYTES = 1 << 16
};

/* ---- recognising ---- */

bool nt_obj_recognise(const unsigned char *bytes, size_t size)
{
	const char *p = (const char *)bytes;
	const char *end = p + (size < RECOGNISE_BYTES ? size : RECOGNISE_BYTES);
	if (end - p >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0)
		p += 3;
	/* The first line that is neither blank nor a comment has to be a statement of OBJ. */
	while (p < end) {
		while (p < end && strchr(" \t\r\n", *p) && *p)
			p++;
		if (p < end && *p != '#')
			break;
		while (p < end && *p != '\n' && *p != '\r')
			p++;
	}
	const char *word = p;
	while (p < end && *p > ' ' && *p < 0x7F)
		p++;
	const obj_keyword *keyword = obj_find_keyword(word, (size_t)(p - word));
	return p < end && (is_blank(*p) || is_line_end(*p)) && keyword && keyword->is_proof;
}

/* ---- split ---- */

/* Whether a chunk may end before `at`: it stands behind a line feed that no `\` takes back. */
static bool is_line_begin(const char *begin, const char *at)
{
	if (at == begin)
		return true;
	if (at[-1] != '\n')
		return false;
	const char *last = at - 1;
	if (last > begin && last[-1] == '\r')
		last--;
	return last == begin || last[-1] != '\\';
}

/* The last line begin at or before `at`. */
static const char *line_begin_before(const char *begin, const char *at)
{
	while (!is_line_begin(begin, at))
		at--;
	return at;
}

static bool add_chunk(obj_file *file, size_t *capacity, const char *begin, const char *end)
{
	if (!nt_grow((void **)&file->chunks, capacity, file->chunk_count + 1, sizeof *file->chunks))
		return false;
	file->chunks[file->chunk_count++] = obj_chunk_of(begin, end);
	return true;
}

/* The end of the text: some exporters write zero bytes behind it, which are a finding. */
static const char *end_of_text(nt_scene *scene)
{
	const char *const begin = (const char *)scene->bytes;
	size_t size = scene->byte_count;
	while (size > 0 && begin[size - 1] == '\0')
		size--;
	if (size < scene->byte_count) {
		nt_place place = nt_line_place(scene->path, 0);
		place.offset = size;
		nt_finding_add(&scene->findings, NT_CODE_STATEMENT_IGNORED, &place, 1,
			"OBJ: %zu zero bytes at the end", scene->byte_count - size);
	}
	return begin + size;
}

static nt_status split(obj_file *file, nt_error *error)
{
	const char *p = (const char *)file->scene->bytes;
	const char *const end = end_of_text(file->scene);
	if (end - p >= 3 && memcmp(p, "\xEF\xBB\xBF", 3) == 0)
		p += 3;
	const char *const begin = p;
	const char *const tail =
		end - p > TAIL_BYTES ? line_begin_before(begin, end - TAIL_BYTES) : begin;
	size_t capacity = 0;
	while (p < tail) {
		const char *next = tail;
		if (tail - p > CHUNK_BYTES) {
			next = line_begin_before(p, p + CHUNK_BYTES);
			if (next == p) { /* a line longer than a chunk */
				next = p + CHUNK_BYTES;
				while (!is_line_begin(begin, next))
					next++;
			}
		}
		if (!add_chunk(file, &capacity, p, next))
			return nt_fail_memory(error);
		p = next;
	}
	/* the last lines from a copy with line feeds and readable bytes behind it */
	const char *padded_end;
	file->tail_begin = tail;
	file->tail_end = end;
	file->tail = obj_copy_padded(tail, end, &padded_end);
	return file->tail && add_chunk(file, &capacity, file->tail, padded_end) ? NT_OK : nt_fail_memory(error);
}

/* ---- parse ---- */

static void *copy_array(nt_arena *arena, const void *array, size_t count, size_t size, bool *failed)
{
	void *copy = nt_arena_alloc(arena, count, size);
	*failed |= !copy;
	return copy && count ? memcpy(copy, array, count * size) : copy;
}

/* Moves the arrays from `work` to the chunk. The large arrays are copied, without the room that was left, into
 * blocks large enough for huge pages, and stay where they are for the next chunk: their pages are there and in the
 * cache. With arrays of its own for each chunk, 106 MB of text take 193 ms on one thread instead of 172, and 120 MB of
 * memory instead of 88 (nmtan --threads=1 --timing; perf stat -e minor-faults: 18 300 faults instead of 6 500). A file
 * of few chunks has no such blocks, and keeps its arrays. */
static void keep_chunk(const obj_file *file, obj_memory *memory, obj_chunk *work, obj_chunk *chunk)
{
	bool failed = false;
	*chunk = *work;
	if (!file->copies) {
		*work = (obj_chunk){0};
		return;
	}
	*work = (obj_chunk){.distinct = chunk->distinct, .distinct_capacity = chunk->distinct_capacity,
		.corners = chunk->corners, .corner_capacity = chunk->corner_capacity,
		.face_sizes = chunk->face_sizes, .face_capacity = chunk->face_capacity};
	for (int kind = 0; kind < OBJ_KIND_COUNT; kind++) {
		obj_rows *rows = &chunk->rows[kind];
		work->rows[kind] = (obj_rows){.data = rows->data, .capacity = rows->capacity};
		rows->data = copy_array(&memory->rows, rows->data, rows->count, obj_widths[kind] * sizeof *rows->data,
			&failed);
	}
	chunk->distinct = copy_array(&memory->corners, chunk->distinct, chunk->distinct_count,
		sizeof *chunk->distinct, &failed);
	chunk->corners = copy_array(&memory->corners, chunk->corners, chunk->corner_count, sizeof *chunk->corners,
		&failed);
	chunk->face_sizes = copy_array(&memory->corners, chunk->face_sizes, chunk->face_count, 1, &failed);
	if (failed)
		nt_fail_memory(&chunk->error);
}

typedef struct parse_job {
	obj_file *file;
	atomic_size_t next;   /* the chunk to take */
	atomic_bool failed;   /* no later chunk matters any more */
} parse_job;

/* Chunks are taken in order, so all before one that fails have been taken and will be finished: which
 * error is the first in the file does not depend on the threads. */
static void parse_chunks(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)begin, (void)end;
	parse_job *job = context;
	obj_file *file = job->file;
	obj_chunk work = {0};
	while (!atomic_load(&job->failed)) {
		const size_t c = atomic_fetch_add(&job->next, 1);
		if (c >= file->chunk_count)
			break;
		obj_chunk *chunk = &file->chunks[c];
		work.begin = work.p = chunk->begin;
		work.end = chunk->end;
		obj_read_lines(&work, SIZE_MAX);
		free(work.recent);
		work.recent = NULL;
		keep_chunk(file, &file->memory[slot], &work, chunk);
		if (chunk->error.status)
			atomic_store(&job->failed, true);
		/* text is half of what a conversion would hold, and only names are read again */
		if (file->scene->file && chunk->begin != file->tail)
			nt_file_release(file->scene->file, (size_t)(chunk->begin - (const char *)file->scene->bytes),
				(size_t)(chunk->end - chunk->begin));
	}
	obj_chunk_free(&work);
}

static nt_status parse(obj_file *file, nt_error *error)
{
	parse_job job = {.file = file};
	file->memory = nt_calloc(file->threads, sizeof *file->memory);
	if (!file->memory)
		return nt_fail_memory(error);
	file->copies = file->chunk_count > FEW_CHUNKS;
	for (unsigned i = 0; i < file->threads; i++)
		file->memory[i].rows.block_bytes = file->memory[i].corners.block_bytes = BLOCK_BYTES;
	nt_parallel_ranges(file->threads, file->chunk_count, 1, parse_chunks, &job);
	size_t line = 0;
	for (size_t c = 0; c < file->chunk_count; c++) {
		obj_chunk *chunk = &file->chunks[c];
		if (chunk->error.status) {
			*error = chunk->error;
			if (error->status == NT_ERROR_INPUT)
				error->place.line += line;
			return error->status;
		}
		chunk->first_line = line;
		line += chunk->line;
	}
	return NT_OK;
}

/* ---- join ---- */

static void count_all(obj_file *file)
{
	for (size_t c = 0; c < file->chunk_count; c++) {
		obj_chunk *chunk = &file->chunks[c];
		for (int kind = 0; kind < OBJ_KIND_COUNT; kind++) {
			chunk->rows[kind].first = file->row_counts[kind];
			file->row_counts[kind] += chunk->rows[kind].count;
		}
		chunk->first_face = file->face_count;
		chunk->first_corner = file->corner_count;
		file->face_count += chunk->face_count;
		file->corner_count += chunk->corner_count;
		file->polygon_count += chunk->polygon_count;
		file->has_colors = file->has_colors || chunk->colors;
	}
}

/* For every so many rows of a kind, the chunk that has the first of them. */
static bool make_guide(obj_file *file, int kind)
{
	const size_t count = (file->row_counts[kind] >> OBJ_GUIDE_SHIFT) + 1;
	uint32_t *guide = nt_alloc(count, sizeof *guide);
	file->guides[kind] = guide;
	size_t c = 0;
	for (size_t i = 0; guide && i < count; i++) {
		const size_t row = i << OBJ_GUIDE_SHIFT;
		while (c + 1 < file->chunk_count && file->chunks[c + 1].rows[kind].first <= row)
			c++;
		guide[i] = (uint32_t)c;
	}
	return guide;
}

static void join_polygons(obj_file *file)
{
	obj_polygon *to = file->polygons;
	for (size_t c = 0; c < file->chunk_count; c++) {
		const obj_chunk *chunk = &file->chunks[c];
		for (size_t i = 0; i < chunk->polygon_count; i++) {
			const obj_polygon *polygon = &chunk->polygons[i];
			*to++ = (obj_polygon){chunk->first_face + polygon->face, polygon->size,
				chunk->first_line + polygon->line + 1};
		}
	}
}

static nt_status join(obj_file *file, nt_error *error)
{
	count_all(file);
	for (int kind = 0; kind < OBJ_KIND_COUNT; kind++)
		if (file->row_counts[kind] > INT32_MAX)
			return nt_fail(error, NT_ERROR_TOO_LARGE, "more than 2^31 - 1 vertices in one file");
	if (file->corner_count >= NT_NONE)
		return nt_fail(error, NT_ERROR_TOO_LARGE, "more than 2^32 - 1 face corners in one file");
	for (int kind = 0; kind < OBJ_KIND_COUNT; kind++)
		if (!make_guide(file, kind))
			return nt_fail_memory(error);
	const nt_status status = obj_join_colors(file, error);
	if (status)
		return status;
	file->face_sizes = nt_arena_alloc(&file->scene->arena, file->face_count, 1);
	file->polygons = nt_alloc(file->polygon_count, sizeof *file->polygons);
	if (!file->face_sizes || !file->polygons)
		return nt_fail_memory(error);
	join_polygons(file);
	for (size_t c = 0; c < file->chunk_count; c++)
		if (file->chunks[c].face_count)
			memcpy(file->face_sizes + file->chunks[c].first_face, file->chunks[c].face_sizes,
				file->chunks[c].face_count);
	return NT_OK;
}

/* ---- the whole ---- */

static void free_file(obj_file *file)
{
	for (size_t c = 0; c < file->chunk_count; c++) {
		if (file->copies)
			obj_chunk_free_rest(&file->chunks[c]);
		else
			obj_chunk_free(&file->chunks[c]);
	}
	for (unsigned i = 0; file->memory && i < file->threads; i++) {
		nt_arena_free(&file->memory[i].corners);
		nt_arena_free(&file->memory[i].rows);
	}
	free(file->memory);
	free(file->chunks);
	free(file->tail);
	for (int kind = 0; kind < OBJ_KIND_COUNT; kind++)
		free(file->guides[kind]);
	free(file->polygons);
	free(file->meshes);
	free(file->spans);
	free(file->vertices);
}

/* vt or vn that were not finite, with the line of the first. */
static void report_bad_rows(const obj_file *file, int kind, nt_code code, const char *what)
{
	obj_count bad;
	obj_count_all(file, offsetof(obj_chunk, bad_rows) + (size_t)kind * sizeof bad, &bad);
	const nt_place place = nt_line_place(file->scene->path, bad.line);
	if (bad.count)
		nt_finding_add(&file->scene->findings, code, &place, bad.count, "%s", what);
}

static void add_file_finding(nt_scene *scene, nt_code code)
{
	const nt_place place = nt_line_place(scene->path, 0);
	nt_finding_add(&scene->findings, code, &place, 1, NULL);
}

nt_status nt_obj_open(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	/* a file of a chunk or two is read before a second thread has begun */
	const bool small = scene->byte_count <= 2 * CHUNK_BYTES;
	obj_file file = {.scene = scene, .threads = small ? 1 : nt_thread_count(options->threads),
		.options = options};
	scene->format = NT_FORMAT_OBJ;
	nt_status status = split(&file, error);
	if (!status)
		status = parse(&file, error);
	if (!status)
		status = join(&file, error);
	if (!status)
		status = obj_read_events(&file, options, error);
	const double begin = nt_seconds();
	if (!status)
		status = obj_make_vertices(&file, error);
	scene->index_seconds = nt_seconds() - begin;
	report_bad_rows(&file, OBJ_VT, NT_CODE_UV_NOT_FINITE, "vt that become 0 0");
	report_bad_rows(&file, OBJ_VN, NT_CODE_MESH_NORMAL_ZERO, "vn that are computed from faces");
	if (!status && file.lacks[OBJ_VT])
		add_file_finding(scene, NT_CODE_UV_NOT_THERE);
	if (!status && file.lacks[OBJ_VN])
		add_file_finding(scene, NT_CODE_NORMALS_NOT_THERE);
	if (!status)
		status = obj_make_meshes(&file, error);
	if (!status)
		status = obj_split_tiles(scene, error);
	if (!status && (scene->findings.failed || !obj_keep_places(&file)))
		status = nt_fail_memory(error);
	free_file(&file);
	return status ? nt_error_in_file(error, scene->path) : NT_OK;
}
