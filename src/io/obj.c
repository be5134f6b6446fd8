/* SPDX-License-Identifier: MIT */
/*
 * The OBJ reader: Wavefront's object files as they are found in the wild. One pass over the mapped
 * bytes, in chunks of whole lines that threads take one after the other; then the chunks are joined.
 *
 *   split     the file into chunks of 1 MiB, whatever the number of threads, so that it cannot show
 *   parse     obj_parse.c: numbers, corners, and the statements between faces
 *   join      positions, texture coordinates and normals into one array each
 *   events    obj_events.c: objects, materials and smoothing groups, in order
 *   vertices  obj_vertices.c: equal v/vt/vn of one object become one vertex
 *   meshes    obj_meshes.c: faces, quads kept, larger polygons triangulated
 *
 * An `o` makes a mesh; `g` does not. Of texture coordinates u and v are kept as they stand (v up).
 * Colours behind positions are sRGB, as Blender and three.js write them, and become linear.
 * Numbers that are not finite are an error wherever they stand: no output format can hold them. So is a
 * file without faces: there is nothing to put tangents on.
 */
#include "io/obj_parts.h"

#include <limits.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"

enum {
	CHUNK_BYTES = 1 << 20,
	TAIL_BYTES = 16,      /* at least so many bytes of the file go through the padded copy */
	RECOGNISE_BYTES = 1 << 16
};

/* ---- recognising ---- */

/* What an OBJ may begin with. Words that other formats share are no proof. */
static bool is_obj_statement(const char *word, size_t length)
{
	static const char *const words[] = {"v", "vt", "vn", "vp", "f", "o", "g", "s", "l", "p", "mtllib",
		"usemtl", "cstype", "deg", "mg", "lod"};
	for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
		if (strlen(words[i]) == length && memcmp(words[i], word, length) == 0)
			return true;
	return false;
}

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
	return p < end && *p && strchr(" \t\r\n", *p) && is_obj_statement(word, (size_t)(p - word));
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
	obj_chunk *chunk = &file->chunks[file->chunk_count++];
	memset(chunk, 0, sizeof *chunk);
	chunk->begin = begin;
	chunk->end = end;
	chunk->wanted_face = SIZE_MAX;
	return true;
}

/* A copy of the last lines with line feeds and readable bytes behind it. */
static bool add_tail(obj_file *file, size_t *capacity, const char *begin, const char *end)
{
	const size_t size = (size_t)(end - begin);
	file->tail = nt_calloc(size + 16, 1);
	if (!file->tail)
		return false;
	memcpy(file->tail, begin, size);
	memset(file->tail + size, '\n', 4);
	const bool ended = size && begin[size - 1] == '\n';
	return add_chunk(file, capacity, file->tail, file->tail + size + !ended);
}

static nmtan_status split(obj_file *file, nt_error *error)
{
	const char *p = (const char *)file->scene->bytes;
	const char *const end = p + file->scene->byte_count;
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
	if (!add_tail(file, &capacity, tail, end))
		return nt_fail_memory(error);
	return NMTAN_OK;
}

/* ---- parse ---- */

typedef struct parse_job {
	obj_file *file;
	atomic_size_t next;   /* the chunk to take */
	atomic_bool failed;   /* no later chunk matters any more */
} parse_job;

/* Chunks are taken in order, so all before one that fails have been taken and will be finished: which
 * error is the first in the file does not depend on the threads. */
static void parse_chunks(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)begin, (void)end, (void)slot;
	parse_job *job = context;
	while (!atomic_load(&job->failed)) {
		const size_t c = atomic_fetch_add(&job->next, 1);
		if (c >= job->file->chunk_count)
			return;
		if (obj_parse_chunk(&job->file->chunks[c]))
			atomic_store(&job->failed, true);
	}
}

static nmtan_status parse(obj_file *file, nt_error *error)
{
	parse_job job = {.file = file};
	nt_parallel_ranges(file->threads, file->chunk_count, 1, parse_chunks, &job);
	size_t line = 0;
	for (size_t c = 0; c < file->chunk_count; c++) {
		obj_chunk *chunk = &file->chunks[c];
		if (chunk->error.status) {
			*error = chunk->error;
			if (error->status == NMTAN_ERROR_INPUT)
				error->place.line += line;
			return error->status;
		}
		chunk->first_line = line;
		line += chunk->line_count;
	}
	return NMTAN_OK;
}

/* ---- join ---- */

static void count_all(obj_file *file)
{
	for (size_t c = 0; c < file->chunk_count; c++) {
		obj_chunk *chunk = &file->chunks[c];
		chunk->first_position = file->position_count;
		chunk->first_texcoord = file->texcoord_count;
		chunk->first_normal = file->normal_count;
		chunk->first_face = file->face_count;
		chunk->first_corner = file->corner_count;
		file->position_count += chunk->position_count;
		file->texcoord_count += chunk->texcoord_count;
		file->normal_count += chunk->normal_count;
		file->face_count += chunk->face_count;
		file->corner_count += chunk->corner_count;
		file->polygon_count += chunk->polygon_count;
	}
}

static float linear_from_srgb(float value)
{
	const double c = value < 0 ? 0 : value > 1 ? 1 : value;
	return (float)(c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4));
}

static void join_colors(obj_file *file, const obj_chunk *chunk)
{
	float *to = file->colors + 4 * chunk->first_position;
	for (size_t i = 0; i < 4 * chunk->position_count; i++) {
		const float value = chunk->colors ? chunk->colors[i] : 1;
		to[i] = i % 4 == 3 ? fminf(fmaxf(value, 0), 1) : linear_from_srgb(value);
	}
}

static void copy_rows(float *to, size_t first, const float *from, size_t count, size_t width)
{
	if (count)
		memcpy(to + first * width, from, count * width * sizeof *to);
}

/* Moves the arrays of chunks [begin, end) into the file's, but for corners, which are used in place. */
static void join_chunks(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	obj_file *file = context;
	for (size_t c = begin; c < end; c++) {
		obj_chunk *chunk = &file->chunks[c];
		copy_rows(file->positions, chunk->first_position, chunk->positions, chunk->position_count, 3);
		copy_rows(file->texcoords, chunk->first_texcoord, chunk->texcoords, chunk->texcoord_count, 2);
		copy_rows(file->normals, chunk->first_normal, chunk->normals, chunk->normal_count, 3);
		if (file->colors)
			join_colors(file, chunk);
		if (chunk->face_count)
			memcpy(file->face_sizes + chunk->first_face, chunk->face_sizes, chunk->face_count);
		free(chunk->positions);
		free(chunk->texcoords);
		free(chunk->normals);
		free(chunk->colors);
		free(chunk->face_sizes);
		chunk->positions = chunk->texcoords = chunk->normals = chunk->colors = NULL;
		chunk->face_sizes = NULL;
	}
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

static bool any_colors(const obj_file *file)
{
	for (size_t c = 0; c < file->chunk_count; c++)
		if (file->chunks[c].colors)
			return true;
	return false;
}

static nmtan_status join(obj_file *file, nt_error *error)
{
	count_all(file);
	if (file->position_count > INT32_MAX || file->texcoord_count > INT32_MAX ||
		file->normal_count > INT32_MAX || file->corner_count >= NT_NONE)
		return nt_fail(error, NMTAN_ERROR_TOO_LARGE,
			"more than 2^31 vertices or 2^32 face corners in one file");
	file->positions = nt_alloc(file->position_count, 3 * sizeof(float));
	file->texcoords = nt_alloc(file->texcoord_count, 2 * sizeof(float));
	file->normals = nt_alloc(file->normal_count, 3 * sizeof(float));
	file->face_sizes = nt_arena_alloc(&file->scene->arena, file->face_count, 1);
	file->polygons = nt_alloc(file->polygon_count, sizeof *file->polygons);
	if (!file->positions || !file->texcoords || !file->normals || !file->face_sizes ||
		!file->polygons)
		return nt_fail_memory(error);
	if (any_colors(file)) {
		file->colors = nt_alloc(file->position_count, 4 * sizeof(float));
		if (!file->colors)
			return nt_fail_memory(error);
	}
	join_polygons(file);
	nt_parallel_ranges(file->threads, file->chunk_count, 1, join_chunks, file);
	return NMTAN_OK;
}

/* ---- the whole ---- */

static void free_file(obj_file *file)
{
	for (size_t c = 0; c < file->chunk_count; c++)
		obj_chunk_free(&file->chunks[c]);
	free(file->chunks);
	free(file->tail);
	free(file->positions);
	free(file->texcoords);
	free(file->normals);
	free(file->colors);
	free(file->polygons);
	free(file->mesh_objects);
	free(file->mesh_lines);
	free(file->mesh_faces);
	free(file->mesh_corners);
	free(file->mesh_vertices);
	free(file->spans);
	free(file->vertices);
}

nmtan_status nt_obj_open(nt_scene *scene, const nt_read_options *options, nt_error *error)
{
	/* a file of a chunk or two is read before a second thread has begun */
	const bool small = scene->byte_count <= 2 * CHUNK_BYTES;
	obj_file file = {.scene = scene, .threads = small ? 1 : nt_thread_count(options->threads)};
	scene->format = NT_FORMAT_OBJ;
	nmtan_status status = split(&file, error);
	if (!status)
		status = parse(&file, error);
	if (!status)
		status = join(&file, error);
	if (!status)
		status = obj_read_events(&file, options, error);
	if (!status)
		status = obj_make_vertices(&file, error);
	if (!status)
		status = obj_make_meshes(&file, error);
	if (!status && scene->findings.failed)
		status = nt_fail_memory(error);
	free_file(&file);
	return status ? nt_error_in_file(error, scene->path) : NMTAN_OK;
}
