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
 * The parser has already found most corners that neighbouring faces share: only the distinct ones of
 * each chunk come here, in the order of the file, about a fifth of all. That is one thread's work; the
 * corners then take their vertices' numbers in parallel.
 */
#include "obj/parts.h"

#include <stdlib.h>
#include <string.h>
#include "base/hash_index.h"
#include "base/parallel.h"

enum { LINK_MOST = 8 };

typedef struct table {
	uint32_t *heads;      /* [position_count] vertex + 1; 0 or of an earlier mesh: none */
	obj_vertex *vertices; /* room for one of each distinct corner */
	size_t count;
	nt_hash_index index;  /* of vertices that are not linked */
} table;

static bool same_corner(const obj_vertex *a, const obj_corner *b)
{
	return a->v == b->v && a->t == b->t && a->n == b->n;
}

static uint32_t append(table *s, const obj_corner *c)
{
	s->vertices[s->count] = (obj_vertex){c->v, c->t, c->n, 0};
	return (uint32_t)s->count++;
}

/* Behind the last link. */
static uint32_t find_in_index(table *s, const obj_corner *c, size_t base)
{
	const uint64_t hash = nt_hash_words(nt_hash_words((uint64_t)c->v << 32 | c->t, c->n), base);
	size_t at = NT_HASH_BEGIN;
	for (uint32_t vertex; (vertex = nt_hash_index_next(&s->index, hash, &at)) != NT_NONE;)
		if (vertex >= base && same_corner(&s->vertices[vertex], c))
			return vertex;
	return nt_hash_index_add(&s->index, hash, (uint32_t)s->count) ? append(s, c) : NT_NONE;
}

/* The vertex of a corner in the mesh whose vertices begin at base; it is made where there is none.
 * NT_NONE: out of memory. */
static uint32_t find_vertex(table *s, const obj_corner *c, size_t base)
{
	const uint32_t head = s->heads[c->v];
	if (head <= base) {
		s->heads[c->v] = append(s, c) + 1;
		return s->heads[c->v] - 1;
	}
	uint32_t at = head - 1;
	for (int links = 0;; links++) {
		if (same_corner(&s->vertices[at], c))
			return at;
		if (links == LINK_MOST)
			return find_in_index(s, c, base);
		if (!s->vertices[at].next)
			break;
		at = s->vertices[at].next - 1;
	}
	s->vertices[at].next = append(s, c) + 1;
	return s->vertices[at].next - 1;
}

/* ---- distinct corners ---- */

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

/* Says which index of a distinct corner is out of range, as the file spells it. The chunk is read again, up to the face
 * that has the corner first. */
static nt_status fail_index(const obj_file *file, const obj_chunk *chunk, size_t distinct, nt_error *error)
{
	const obj_corner corner = chunk->distinct[distinct];
	obj_chunk again = obj_chunk_of(chunk->begin, chunk->end);
	while (again.distinct_count <= distinct && again.p < again.end)
		if (obj_read_lines(&again, again.face_count))
			break;
	const size_t line = again.error.status ? 0 : chunk->first_line + again.statement_line + 1;
	obj_chunk_free(&again);
	static const char *const words[OBJ_KIND_COUNT] = {"v", "vt", "vn"};
	const uint32_t indices[OBJ_KIND_COUNT] = {corner.v, corner.t, corner.n};
	int kind = OBJ_V;
	for (; kind < OBJ_VN; kind++) {
		uint32_t row = indices[kind];
		const bool ignored = kind != OBJ_V && !file->row_counts[kind];
		if (!ignored && !resolve(&row, chunk->rows[kind].first, file->row_counts[kind]))
			break;
	}
	const uint32_t index = indices[kind];
	const size_t before = again.rows[kind].count; /* elements of the chunk before the face */
	if (index & OBJ_RELATIVE)
		return nt_fail_line(error, NT_ERROR_INPUT, line,
			"face refers to \"%s\" number -%zu, but %zu precede it", words[kind],
			before + OBJ_BIAS - (index & ~OBJ_RELATIVE), chunk->rows[kind].first + before);
	return nt_fail_line(error, NT_ERROR_INPUT, line, "face refers to \"%s\" number %zu, but the file has %zu",
		words[kind], (size_t)index + 1, file->row_counts[kind]);
}

/* Corners that refer to a kind of which the file has none are read as if they did not, and a finding says so. */
static inline void drop_unless_any(uint32_t *index, obj_file *file, int kind)
{
	if (*index != OBJ_ABSENT && file->row_counts[kind] == 0) {
		file->lacks[kind] = true;
		*index = OBJ_ABSENT;
	}
}

/* Gives distinct corners [begin, end) of a chunk their vertices in the mesh whose vertices begin at
 * `base`: the number takes the place of v. */
static nt_status number_distinct(obj_file *file, obj_chunk *chunk, size_t begin, size_t end,
	table *vertices, size_t base, nt_error *error)
{
	for (size_t i = begin; i < end; i++) {
		obj_corner c = chunk->distinct[i];
		drop_unless_any(&c.t, file, OBJ_VT);
		drop_unless_any(&c.n, file, OBJ_VN);
		if (!resolve(&c.v, chunk->rows[OBJ_V].first, file->row_counts[OBJ_V]) ||
			!resolve(&c.t, chunk->rows[OBJ_VT].first, file->row_counts[OBJ_VT]) ||
			!resolve(&c.n, chunk->rows[OBJ_VN].first, file->row_counts[OBJ_VN]))
			return fail_index(file, chunk, i, error);
		chunk->distinct[i].v = find_vertex(vertices, &c, base);
		if (chunk->distinct[i].v == NT_NONE)
			return nt_fail_memory(error);
	}
	return NT_OK;
}

/* One chunk, whose first corner belongs to *mesh or begins the next one. */
static nt_status number_chunk(obj_file *file, obj_chunk *chunk, table *vertices, size_t *mesh,
	nt_error *error)
{
	const size_t end_corner = chunk->first_corner + chunk->corner_count;
	size_t begin = 0;
	chunk->mesh = *mesh;
	while (*mesh + 1 < file->mesh_count && file->meshes[*mesh + 1].corner < end_corner) {
		/* The first corner of a mesh is a distinct one of its own. */
		const size_t end = chunk->corners[file->meshes[*mesh + 1].corner - chunk->first_corner];
		const nt_status status = number_distinct(file, chunk, begin, end, vertices,
			file->meshes[*mesh].vertex, error);
		if (status)
			return status;
		file->meshes[++*mesh].vertex = vertices->count;
		begin = end;
	}
	return number_distinct(file, chunk, begin, chunk->distinct_count, vertices,
		file->meshes[*mesh].vertex, error);
}

static nt_status number_all(obj_file *file, table *vertices, nt_error *error)
{
	size_t most = 0;
	for (size_t c = 0; c < file->chunk_count; c++)
		most += file->chunks[c].distinct_count;
	vertices->vertices = nt_alloc(most, sizeof *vertices->vertices);
	vertices->heads = nt_calloc(file->row_counts[OBJ_V], sizeof *vertices->heads);
	if (!vertices->vertices || !vertices->heads)
		return nt_fail_memory(error);
	size_t mesh = 0;
	for (size_t c = 0; c < file->chunk_count; c++) {
		const nt_status status = number_chunk(file, &file->chunks[c], vertices, &mesh, error);
		if (status)
			return status;
	}
	file->meshes[file->mesh_count].vertex = vertices->count;
	return NT_OK;
}

/* ---- corners ---- */

/* Writes the vertices of the corners of chunks [begin, end), relative to their meshes. */
static void write_corners(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	const obj_file *file = context;
	size_t mesh = file->chunks[begin].mesh;
	for (size_t k = begin; k < end; k++) {
		obj_chunk *chunk = &file->chunks[k];
		uint32_t *to = file->corner_vertices + chunk->first_corner;
		for (size_t i = 0; i < chunk->corner_count;) {
			while (file->meshes[mesh + 1].corner <= chunk->first_corner + i)
				mesh++;
			const size_t left = file->meshes[mesh + 1].corner - chunk->first_corner;
			const size_t stop = left < chunk->corner_count ? left : chunk->corner_count;
			const uint32_t base = (uint32_t)file->meshes[mesh].vertex;
			for (; i < stop; i++)
				to[i] = chunk->distinct[chunk->corners[i]].v - base;
		}
	}
}

nt_status obj_make_vertices(obj_file *file, nt_error *error)
{
	table vertices = {0};
	nt_status status = number_all(file, &vertices, error);
	file->corner_vertices = status ? NULL :
		nt_arena_alloc(&file->scene->arena, file->corner_count, sizeof *file->corner_vertices);
	if (!status && !file->corner_vertices)
		status = nt_fail_memory(error);
	if (!status)
		nt_parallel_ranges(file->threads, file->chunk_count, 1, write_corners, file);
	for (unsigned i = 0; i < file->threads; i++)
		nt_arena_free(&file->memory[i].corners);
	file->vertices = vertices.vertices;
	file->vertex_count = vertices.count;
	free(vertices.heads);
	nt_hash_index_free(&vertices.index);
	return status;
}
