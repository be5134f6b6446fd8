/* SPDX-License-Identifier: MIT */
/*
 * Corners become vertices: corners of one mesh with the same v, vt and vn share one, numbered in the
 * order of first use.
 *
 * The table is found by v itself: most positions have one or two combinations of vt and vn, and
 * neighbouring corners touch neighbouring entries, which a hash would scatter. heads[v] is the first
 * vertex of v, the others are linked. A link longer than LINK_MOST (the hub of a fan whose every corner
 * has its own vt) goes on in a hash table, so that no input makes this quadratic.
 *
 * In parallel each thread numbers the corners of its stretch of the file by itself; then the stretches'
 * vertices, far fewer than their corners, are added to those of the first in order. First uses come in
 * the same order as in one stretch, so the numbers are the same.
 */
#include "io/obj_parts.h"

#include <stdlib.h>
#include <string.h>
#include "base/parallel.h"

/* Each stretch has 4 bytes for each v; more than four of them stop to pay. */
enum { LINK_MOST = 8, STRETCHES_MOST = 4, CORNERS_LEAST = 1 << 16 };

typedef struct table {
	uint32_t *heads;      /* [position_count] vertex + 1; 0 or of an earlier mesh: none */
	obj_vertex *vertices;
	size_t count, capacity;
	uint32_t *slots;      /* hash table of vertices + 1 that are not linked */
	size_t slot_count, slot_used; /* slot_count is a power of two or 0 */
} table;

static size_t hash_vertex(const obj_vertex *x)
{
	uint64_t h = x->v * UINT64_C(0x9E3779B97F4A7C15);
	h = (h ^ h >> 32 ^ x->t) * UINT64_C(0xD6E8FEB86659FD93);
	h = (h ^ h >> 32 ^ x->n) * UINT64_C(0x9E3779B97F4A7C15);
	return (size_t)(h ^ h >> 32);
}

static bool same_corner(const obj_vertex *a, uint32_t v, uint32_t t, uint32_t n)
{
	return a->v == v && a->t == t && a->n == n;
}

/* The slot of a vertex, or the free one where it belongs. Vertices before `base` are of other meshes. */
static size_t find_slot(const table *s, const obj_vertex *wanted, size_t base)
{
	size_t slot = hash_vertex(wanted) & (s->slot_count - 1);
	while (s->slots[slot]) {
		const size_t vertex = s->slots[slot] - 1;
		if (vertex >= base && same_corner(&s->vertices[vertex], wanted->v, wanted->t, wanted->n))
			break;
		slot = (slot + 1) & (s->slot_count - 1);
	}
	return slot;
}

static bool grow_slots(table *s)
{
	if (2 * (s->slot_used + 1) <= s->slot_count)
		return true;
	table larger = *s;
	larger.slot_count = s->slot_count ? 2 * s->slot_count : 1024;
	larger.slots = nt_calloc(larger.slot_count, sizeof *larger.slots);
	if (!larger.slots)
		return false;
	for (size_t i = 0; i < s->slot_count; i++)
		if (s->slots[i]) {
			size_t slot = hash_vertex(&s->vertices[s->slots[i] - 1]) & (larger.slot_count - 1);
			while (larger.slots[slot])
				slot = (slot + 1) & (larger.slot_count - 1);
			larger.slots[slot] = s->slots[i];
		}
	free(s->slots);
	*s = larger;
	return true;
}

static uint32_t append(table *s, uint32_t v, uint32_t t, uint32_t n)
{
	if (s->count >= NT_NONE - 1 ||
		!nt_grow((void **)&s->vertices, &s->capacity, s->count + 1, sizeof *s->vertices))
		return NT_NONE;
	s->vertices[s->count] = (obj_vertex){v, t, n, 0};
	return (uint32_t)s->count++;
}

/* Behind the last link. */
static uint32_t find_in_slots(table *s, uint32_t v, uint32_t t, uint32_t n, size_t base)
{
	if (!grow_slots(s))
		return NT_NONE;
	const obj_vertex wanted = {v, t, n, 0};
	const size_t slot = find_slot(s, &wanted, base);
	if (s->slots[slot])
		return s->slots[slot] - 1;
	const uint32_t vertex = append(s, v, t, n);
	if (vertex != NT_NONE) {
		s->slots[slot] = vertex + 1;
		s->slot_used++;
	}
	return vertex;
}

/* The vertex of a corner in the mesh whose vertices begin at base; it is made where there is none.
 * NT_NONE: out of memory. */
static uint32_t find_vertex(table *s, uint32_t v, uint32_t t, uint32_t n, size_t base)
{
	const uint32_t head = s->heads[v];
	if (head <= base) {
		const uint32_t vertex = append(s, v, t, n);
		if (vertex != NT_NONE)
			s->heads[v] = vertex + 1;
		return vertex;
	}
	uint32_t at = head - 1;
	for (int links = 0;; links++) {
		if (same_corner(&s->vertices[at], v, t, n))
			return at;
		if (links == LINK_MOST)
			return find_in_slots(s, v, t, n, base);
		if (!s->vertices[at].next)
			break;
		at = s->vertices[at].next - 1;
	}
	const uint32_t vertex = append(s, v, t, n);
	if (vertex != NT_NONE)
		s->vertices[at].next = vertex + 1;
	return vertex;
}

/* ---- stretches ---- */

/* Some chunks, their corners, and what became of them. */
typedef struct stretch {
	size_t chunk_begin, chunk_end;
	size_t corner_begin, corner_end;
	size_t mesh;               /* of the first corner */
	table table;
	uint32_t *renumber;        /* [table.count] number in the first stretch; NULL: the same */
	nmtan_status status;
	size_t bad_corner;         /* INPUT: the corner whose index is out of range */
} stretch;

typedef struct vertex_job {
	obj_file *file;
	stretch stretches[STRETCHES_MOST];
	size_t stretch_count;
} vertex_job;

/* An index as a row number; false where there is no such row. */
static inline bool resolve(uint32_t *index, size_t first, size_t count)
{
	if (*index & OBJ_RELATIVE) {
		if (*index == OBJ_ABSENT)
			return true;
		const int64_t row = (int64_t)(*index & ~OBJ_RELATIVE) - OBJ_BIAS + (int64_t)first;
		if (row < 0)
			return false;
		*index = (uint32_t)row;
	}
	return *index < count;
}

static inline bool resolve_corner(const obj_file *file, const obj_chunk *chunk, obj_corner *corner)
{
	return resolve(&corner->v, chunk->first_position, file->position_count) &&
		resolve(&corner->t, chunk->first_texcoord, file->texcoord_count) &&
		resolve(&corner->n, chunk->first_normal, file->normal_count);
}

static void number_chunk(const obj_file *file, stretch *s, const obj_chunk *chunk, size_t *mesh,
	size_t *base)
{
	for (size_t i = 0; i < chunk->corner_count; i++) {
		const size_t c = chunk->first_corner + i;
		while (c >= file->mesh_corners[*mesh + 1]) {
			++*mesh;
			*base = file->mesh_vertices[*mesh] = s->table.count;
		}
		obj_corner corner = chunk->corners[i];
		if (!resolve_corner(file, chunk, &corner)) {
			s->status = NMTAN_ERROR_INPUT;
			s->bad_corner = c;
			return;
		}
		const uint32_t vertex = find_vertex(&s->table, corner.v, corner.t, corner.n, *base);
		if (vertex == NT_NONE) {
			s->status = NMTAN_ERROR_MEMORY;
			return;
		}
		file->corner_vertices[c] = vertex;
	}
}

/* Numbers the corners of one stretch by itself. mesh_vertices of the meshes that begin in it are set in
 * its own numbers. */
static void number_stretch(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	vertex_job *job = context;
	const obj_file *file = job->file;
	for (size_t i = begin; i < end; i++) {
		stretch *s = &job->stretches[i];
		s->table.heads = nt_calloc(file->position_count, sizeof *s->table.heads);
		if (!s->table.heads)
			s->status = NMTAN_ERROR_MEMORY;
		size_t mesh = s->mesh, base = 0;
		for (size_t c = s->chunk_begin; c < s->chunk_end && !s->status; c++)
			number_chunk(file, s, &file->chunks[c], &mesh, &base);
	}
}

/* Chunks are dealt out by their corners. */
static void plan_stretches(vertex_job *job)
{
	const obj_file *file = job->file;
	const unsigned most = file->threads < STRETCHES_MOST ? file->threads : STRETCHES_MOST;
	job->stretch_count = nt_parallel_slots(most, file->corner_count, CORNERS_LEAST);
	size_t chunk = 0, corner = 0, mesh = 0;
	for (size_t i = 0; i < job->stretch_count; i++) {
		stretch *s = &job->stretches[i];
		const size_t goal = file->corner_count / job->stretch_count * (i + 1);
		s->chunk_begin = chunk;
		s->corner_begin = corner;
		while (chunk < file->chunk_count && (corner < goal || i + 1 == job->stretch_count))
			corner += file->chunks[chunk++].corner_count;
		s->chunk_end = chunk;
		s->corner_end = corner;
		while (mesh + 1 < file->mesh_count && file->mesh_corners[mesh + 1] <= s->corner_begin)
			mesh++;
		s->mesh = mesh;
	}
}

/* Adds the vertices of a later stretch to the first one's, mesh by mesh. A mesh that begins exactly at
 * the stretch's first corner begins here too. */
static bool add_stretch(obj_file *file, table *all, stretch *s)
{
	s->renumber = nt_alloc(s->table.count, sizeof *s->renumber);
	if (!s->renumber)
		return false;
	size_t mesh = s->mesh, base = file->mesh_vertices[mesh];
	if (file->mesh_corners[mesh] >= s->corner_begin)
		base = file->mesh_vertices[mesh] = all->count;
	for (size_t i = 0; i < s->table.count; i++) {
		while (mesh + 1 < file->mesh_count && file->mesh_corners[mesh + 1] < s->corner_end &&
			file->mesh_vertices[mesh + 1] == i)
			base = file->mesh_vertices[++mesh] = all->count;
		const obj_vertex *x = &s->table.vertices[i];
		s->renumber[i] = find_vertex(all, x->v, x->t, x->n, base);
		if (s->renumber[i] == NT_NONE)
			return false;
	}
	return true;
}

/* Corners take their final numbers, relative to their mesh. */
static void renumber_stretch(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	const vertex_job *job = context;
	const obj_file *file = job->file;
	for (size_t i = begin; i < end; i++) {
		const stretch *s = &job->stretches[i];
		size_t mesh = s->mesh, c = s->corner_begin;
		while (c < s->corner_end) {
			while (c >= file->mesh_corners[mesh + 1])
				mesh++;
			const size_t stop = file->mesh_corners[mesh + 1] < s->corner_end ?
				file->mesh_corners[mesh + 1] : s->corner_end;
			const uint32_t base = (uint32_t)file->mesh_vertices[mesh];
			uint32_t *vertex = file->corner_vertices;
			if (s->renumber)
				for (; c < stop; c++)
					vertex[c] = s->renumber[vertex[c]] - base;
			else if (base)
				for (; c < stop; c++)
					vertex[c] -= base;
			c = stop;
		}
	}
}

/* ---- errors ---- */

/* The face of a corner of the file. */
static size_t face_of_corner(const obj_file *file, const obj_chunk *chunk, size_t wanted)
{
	size_t face = chunk->first_face, corner = chunk->first_corner, large = 0;
	while (large < file->large_count && file->large[large].face < face)
		large++;
	for (;; face++) {
		const bool is_large = file->face_sizes[face] == OBJ_LARGE;
		corner += is_large ? file->large[large++].size : file->face_sizes[face];
		if (wanted < corner)
			return face;
	}
}

/* Says which index of the corner is out of range, as the file spells it. */
static nmtan_status fail_index(const obj_file *file, size_t bad_corner, nt_error *error)
{
	size_t c = 0;
	while (bad_corner >= file->chunks[c].first_corner + file->chunks[c].corner_count)
		c++;
	const obj_chunk *chunk = &file->chunks[c];
	const obj_corner corner = chunk->corners[bad_corner - chunk->first_corner];
	obj_corner before;
	const size_t line = obj_face_line(file, face_of_corner(file, chunk, bad_corner), &before);
	const struct {
		const char *word;
		uint32_t index;
		uint32_t before;      /* elements of the chunk before the face */
		size_t first, count;
	} parts[3] = {
		{"v", corner.v, before.v, chunk->first_position, file->position_count},
		{"vt", corner.t, before.t, chunk->first_texcoord, file->texcoord_count},
		{"vn", corner.n, before.n, chunk->first_normal, file->normal_count},
	};
	int k = 0;
	uint32_t row = parts[0].index;
	while (k < 2 && resolve(&row, parts[k].first, parts[k].count))
		row = parts[++k].index;
	const uint32_t index = parts[k].index;
	if (index & OBJ_RELATIVE)
		return nt_fail_line(error, NMTAN_ERROR_INPUT, line,
			"face refers to \"%s\" number -%zu, but %zu precede it", parts[k].word,
			(size_t)(parts[k].before + OBJ_BIAS - (index & ~OBJ_RELATIVE)),
			parts[k].first + parts[k].before);
	return nt_fail_line(error, NMTAN_ERROR_INPUT, line,
		"face refers to \"%s\" number %zu, but the file has %zu", parts[k].word, (size_t)index + 1,
		parts[k].count);
}

/* The first failure in the order of the file. */
static nmtan_status report_failure(const vertex_job *job, nt_error *error)
{
	for (size_t i = 0; i < job->stretch_count; i++)
		if (job->stretches[i].status == NMTAN_ERROR_INPUT)
			return fail_index(job->file, job->stretches[i].bad_corner, error);
		else if (job->stretches[i].status)
			return nt_fail_memory(error);
	return NMTAN_OK;
}

nmtan_status obj_make_vertices(obj_file *file, nt_error *error)
{
	file->corner_vertices =
		nt_arena_alloc(&file->scene->arena, file->corner_count, sizeof *file->corner_vertices);
	if (!file->corner_vertices)
		return nt_fail_memory(error);
	if (file->mesh_count == 0)
		return NMTAN_OK;
	vertex_job job = {.file = file};
	plan_stretches(&job);
	nt_parallel_ranges((unsigned)job.stretch_count, job.stretch_count, 1, number_stretch, &job);
	nmtan_status status = report_failure(&job, error);
	for (size_t i = 1; i < job.stretch_count && !status; i++)
		if (!add_stretch(file, &job.stretches[0].table, &job.stretches[i]))
			status = nt_fail_memory(error);
	if (!status) {
		nt_parallel_ranges((unsigned)job.stretch_count, job.stretch_count, 1, renumber_stretch, &job);
		file->vertices = job.stretches[0].table.vertices;
		file->vertex_count = job.stretches[0].table.count;
		file->mesh_vertices[file->mesh_count] = file->vertex_count;
		job.stretches[0].table.vertices = NULL;
	}
	for (size_t i = 0; i < job.stretch_count; i++) {
		free(job.stretches[i].table.heads);
		free(job.stretches[i].table.vertices);
		free(job.stretches[i].table.slots);
		free(job.stretches[i].renumber);
	}
	return status;
}
