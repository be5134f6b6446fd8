/* SPDX-License-Identifier: MIT */
/*
 * Splitting: a vertex whose corners have different tangents gets a copy for each further tangent.
 *
 * Corners are visited in order. The tangent of a vertex's first corner stays with the vertex; only a
 * corner that differs from it asks a hash table of (vertex, tangent) for the copy that has its tangent, so
 * that meshes without splits pay one comparison a corner and a hub with many tangents stays linear.
 */
#include <string.h>
#include "base/dvec.h"
#include "topology/corners.h"

#define NO_VERTEX UINT32_MAX

typedef struct tangent_key {
	uint32_t bits[4]; /* of the four floats, -0 made +0: equal floats have equal bits */
} tangent_key;

/* A copy of a vertex and the tangent it was made for. */
typedef struct copy {
	uint32_t original;
	tangent_key tangent;
} copy;

typedef struct splitter {
	const nmtan_mesh *mesh;
	nmtan_split_output *output;
	nt_scratch *scratch;
	tangent_key *first; /* [vertex_count] tangent of the vertex's first corner */
	uint8_t *seen;      /* [vertex_count] first is set */
	copy *copies;       /* [copy_capacity] */
	size_t copy_count, copy_capacity;
	uint32_t *table; /* [table_size] numbers of copies, NO_VERTEX where free; at most half full */
	size_t table_size;
} splitter;

static tangent_key make_key(const float *tangent)
{
	float values[4];
	tangent_key key;
	for (int i = 0; i < 4; i++)
		values[i] = tangent[i] + 0.0f;
	memcpy(key.bits, values, sizeof key.bits);
	return key;
}

static bool equal_keys(const tangent_key *a, const tangent_key *b)
{
	return memcmp(a, b, sizeof *a) == 0;
}

static uint64_t hash_copy(uint32_t original, const tangent_key *key)
{
	uint64_t hash = original * 0x9e3779b97f4a7c15u;
	for (int i = 0; i < 4; i++) {
		hash = (hash ^ key->bits[i]) * 0xff51afd7ed558ccdu;
		hash ^= hash >> 32;
	}
	return hash;
}

/* The slot of the table where a copy is or belongs. */
static size_t find_slot(const splitter *s, uint32_t original, const tangent_key *key)
{
	size_t at = hash_copy(original, key) & (s->table_size - 1);
	while (s->table[at] != NO_VERTEX) {
		const copy *other = &s->copies[s->table[at]];
		if (other->original == original && equal_keys(&other->tangent, key))
			break;
		at = (at + 1) & (s->table_size - 1);
	}
	return at;
}

/* Doubles the room for copies. The old arrays stay in the scratch until the call ends. */
static bool grow(splitter *s)
{
	const size_t capacity = s->copy_capacity ? 2 * s->copy_capacity : 256;
	copy *copies = nt_scratch_alloc(s->scratch, capacity, sizeof *copies);
	uint32_t *table = nt_scratch_alloc(s->scratch, 2 * capacity, sizeof *table);
	if (!copies || !table)
		return false;
	if (s->copy_count)
		memcpy(copies, s->copies, s->copy_count * sizeof *copies);
	s->copies = copies;
	s->copy_capacity = capacity;
	s->table = table;
	s->table_size = 2 * capacity;
	memset(table, 0xff, s->table_size * sizeof *table);
	for (size_t i = 0; i < s->copy_count; i++)
		table[find_slot(s, copies[i].original, &copies[i].tangent)] = (uint32_t)i;
	return true;
}

/* The copy of a vertex that has this tangent, made where there is none yet. */
static nmtan_status take_copy(splitter *s, uint32_t original, const tangent_key *key, uint32_t *vertex)
{
	if (s->copy_count == s->copy_capacity && !grow(s))
		return NMTAN_ERROR_MEMORY;
	const size_t at = find_slot(s, original, key);
	if (s->table[at] == NO_VERTEX) {
		if (s->copy_count >= s->output->source_capacity ||
			s->mesh->vertex_count + s->copy_count >= UINT32_MAX)
			return NMTAN_ERROR_TOO_LARGE;
		s->output->sources[s->copy_count] = original;
		s->copies[s->copy_count] = (copy){original, *key};
		s->table[at] = (uint32_t)s->copy_count++;
	}
	*vertex = (uint32_t)(s->mesh->vertex_count + s->table[at]);
	return NMTAN_OK;
}

/* A vertex that no face uses still needs a valid tangent: a unit vector perpendicular to its normal. */
static void set_unused_tangent(const nmtan_mesh *mesh, size_t vertex, float *tangent)
{
	nt_dvec3 n = nt_dvec3_load(nt_normal(mesh, vertex));
	nt_dvec3 t = {1, 0, 0};
	if (nt_dvec3_normalise(&n))
		t = nt_dvec3_perpendicular(n);
	const float result[4] = {(float)t.x, (float)t.y, (float)t.z, 1.0f};
	memcpy(tangent, result, sizeof result);
}

static nmtan_status split_corners(splitter *s, const float *tangents, size_t corner_count)
{
	float *vertex_tangents = s->output->vertex_tangents;
	for (size_t c = 0; c < corner_count; c++) {
		uint32_t vertex = (uint32_t)nt_vertex_of(s->mesh, c);
		const tangent_key key = make_key(tangents + 4 * c);
		if (!s->seen[vertex]) {
			s->seen[vertex] = 1;
			s->first[vertex] = key;
		} else if (!equal_keys(&key, &s->first[vertex])) {
			const nmtan_status status = take_copy(s, vertex, &key, &vertex);
			if (status)
				return status;
		}
		s->output->indices[c] = vertex;
		if (vertex_tangents)
			memcpy(vertex_tangents + 4 * (size_t)vertex, tangents + 4 * c, 4 * sizeof(float));
	}
	return NMTAN_OK;
}

static nmtan_status split_mesh(splitter *s, const float *tangents, size_t corner_count)
{
	s->first = nt_scratch_alloc(s->scratch, s->mesh->vertex_count, sizeof *s->first);
	s->seen = nt_scratch_alloc(s->scratch, s->mesh->vertex_count, 1);
	if (!s->first || !s->seen)
		return NMTAN_ERROR_MEMORY;
	memset(s->seen, 0, s->mesh->vertex_count);
	const nmtan_status status = split_corners(s, tangents, corner_count);
	s->output->source_count = s->copy_count;
	if (!status && s->output->vertex_tangents)
		for (size_t v = 0; v < s->mesh->vertex_count; v++)
			if (!s->seen[v])
				set_unused_tangent(s->mesh, v, s->output->vertex_tangents + 4 * v);
	return status;
}

nmtan_status nmtan_split(const nmtan_mesh *mesh, const float *tangents, const nmtan_options *options,
	nmtan_split_output *output)
{
	if (!mesh || !tangents || !output || !output->indices ||
		(output->source_capacity && !output->sources) ||
		(output->vertex_tangents && !mesh->normals))
		return NMTAN_ERROR_ARGUMENT;
	nmtan_mesh checked = *mesh;
	if (checked.normal_stride_bytes == 0)
		checked.normal_stride_bytes = 3 * sizeof(float);
	size_t corner_count;
	nmtan_status status = nt_check_faces(&checked, &corner_count);
	if (status)
		return status;

	nt_scratch own;
	nt_scratch_init(&own, options ? options->allocator : NULL);
	nt_scratch *scratch = options && options->workspace ? &options->workspace->scratch : &own;
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	splitter s = {.mesh = &checked, .output = output, .scratch = scratch};
	status = split_mesh(&s, tangents, corner_count);
	nt_scratch_back(scratch, mark);
	nt_scratch_free(&own);
	return status;
}
