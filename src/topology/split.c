/* SPDX-License-Identifier: MIT */
/*
 * Splitting: a vertex whose corners have different tangents gets a copy for each further tangent.
 *
 * Corners are visited in order. The tangent of a vertex's first corner stays with the vertex; only a
 * corner that differs from it asks a hash table of (vertex, tangent) for the copy that has its tangent, so
 * that meshes without splits pay one comparison a corner and a hub with many tangents stays linear. The hash has the
 * key of the process. Indices are not written before the first copy.
 */
#include "topology/split.h"

#include <math.h>
#include <string.h>
#include "base/parallel.h"
#include "base/vec.h"
#include "topology/corners.h"

#define NO_COPY UINT32_MAX

enum { COPY_GRAIN = 1 << 18 }; /* indices per thread below which threads do not pay */

/* All zeros are one, and so are all NaN: which one comes of a sum is the compiler's choice. */
static nt_tangent_key make_key(const float *tangent)
{
	float values[4];
	nt_tangent_key key;
	for (int i = 0; i < 4; i++)
		values[i] = tangent[i] == tangent[i] ? tangent[i] + 0.0f : NAN;
	memcpy(key.bits, values, sizeof key.bits);
	return key;
}

/* Two products instead of the four of nt_hash_words() for three words: 4 % of nmtan_vertex_tangents(). */
static size_t hash_copy(const nt_splitter *s, const nt_vertex_copy *copy)
{
	uint64_t halves[2], high;
	memcpy(halves, copy->tangent.bits, sizeof halves);
	const uint64_t first = nt_multiply(halves[0] ^ s->key[0], halves[1] ^ s->key[1], &high);
	const uint64_t second = nt_multiply(first ^ high ^ copy->original, s->key[1], &high);
	return (size_t)(second ^ high);
}

/* The slot of the table where a copy is or belongs. */
static size_t find_slot(const nt_splitter *s, const nt_vertex_copy *copy)
{
	size_t at = hash_copy(s, copy) & (s->table_size - 1);
	while (s->table[at] != NO_COPY) {
		const nt_vertex_copy *other = &s->copies[s->table[at]];
		if (other->original == copy->original && nt_same_bits(&other->tangent, &copy->tangent))
			break;
		at = (at + 1) & (s->table_size - 1);
	}
	return at;
}

static bool make_table(nt_splitter *s)
{
	s->table_size = 2 * s->copy_capacity;
	s->table = nt_scratch_alloc(s->scratch, s->table_size, sizeof *s->table);
	if (!s->table)
		return false;
	memset(s->table, 0xff, s->table_size * sizeof *s->table);
	for (size_t i = 0; i < s->copy_count; i++)
		s->table[find_slot(s, &s->copies[i])] = (uint32_t)i;
	return true;
}

/* Doubles the room for copies. The old arrays stay in the scratch until the call ends. */
static bool grow(nt_splitter *s)
{
	const size_t capacity = s->copy_capacity ? 2 * s->copy_capacity : 256;
	nt_vertex_copy *copies = nt_scratch_alloc(s->scratch, capacity, sizeof *copies);
	if (!copies)
		return false;
	if (s->copy_count)
		memcpy(copies, s->copies, s->copy_count * sizeof *copies);
	s->copies = copies;
	s->copy_capacity = capacity;
	return make_table(s);
}

/* The copy of a vertex that has this tangent, made where there is none yet. */
static nmtan_status take_copy(nt_splitter *s, uint32_t original, const nt_tangent_key *key, uint32_t *vertex)
{
	if (s->copy_count == s->copy_capacity && !grow(s))
		return NMTAN_ERROR_MEMORY;
	s->copies[s->copy_count] = (nt_vertex_copy){original, *key};
	uint32_t *copy = &s->table[find_slot(s, &s->copies[s->copy_count])];
	if (*copy == NO_COPY) {
		if (s->mesh->vertex_count + s->copy_count >= UINT32_MAX)
			return NMTAN_ERROR_TOO_LARGE;
		if (s->copy_count < s->output->source_capacity)
			s->output->sources[s->copy_count] = original;
		s->output->split_count += !(s->seen[original] & NT_SEEN_SPLIT);
		s->seen[original] |= NT_SEEN_SPLIT;
		if (s->output->copy_counts)
			s->output->copy_counts[original]++;
		*copy = (uint32_t)s->copy_count++;
	}
	*vertex = (uint32_t)(s->mesh->vertex_count + *copy);
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

nmtan_status nt_splitter_begin(nt_splitter *s, const nmtan_mesh *mesh, size_t corner_count,
	nmtan_split_output *output, nt_scratch *scratch)
{
	*s = (nt_splitter){.mesh = mesh, .output = output, .scratch = scratch, .corner_count = corner_count};
	output->source_count = output->split_count = 0;
	nt_hash_key(s->key);
	s->tangents = output->vertex_tangents;
	if (!s->tangents)
		s->tangents = nt_scratch_alloc(scratch, mesh->vertex_count, 4 * sizeof *s->tangents);
	s->seen = nt_scratch_alloc(scratch, mesh->vertex_count, 1);
	if (!s->tangents || !s->seen)
		return NMTAN_ERROR_MEMORY;
	memset(s->seen, 0, mesh->vertex_count);
	if (output->copy_counts)
		memset(output->copy_counts, 0, mesh->vertex_count * sizeof *output->copy_counts);
	return NMTAN_OK;
}

static void copy_range(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const nt_splitter *s = context;
	uint32_t *to = s->output->indices;
	const uint32_t *from = s->mesh->indices;
	if (from)
		memcpy(to + begin, from + begin, (end - begin) * sizeof *to);
	for (size_t c = begin; !from && c < end; c++)
		to[c] = (uint32_t)c;
}

/* The mesh's indices, to be changed where corners move to copies. */
static void copy_indices(nt_splitter *s)
{
	s->indexed = true;
	if (s->mesh->indices != s->output->indices)
		nt_parallel_ranges(s->threads, s->corner_count, COPY_GRAIN, copy_range, s);
}

nmtan_status nt_splitter_differs(nt_splitter *s, uint32_t vertex, const float *tangent, size_t corner)
{
	const nt_tangent_key key = make_key(tangent);
	const nt_tangent_key first = make_key(s->tangents + 4 * (size_t)vertex);
	if (nt_same_bits(&key, &first))
		return NMTAN_OK;
	const nmtan_status status = take_copy(s, vertex, &key, &vertex);
	if (status)
		return status;
	if (!s->output->indices || vertex - s->mesh->vertex_count >= s->output->source_capacity)
		return NMTAN_OK;
	if (s->output->vertex_tangents)
		memcpy(s->output->vertex_tangents + 4 * (size_t)vertex, tangent, 4 * sizeof(float));
	if (!s->indexed)
		copy_indices(s);
	s->output->indices[corner] = vertex;
	return NMTAN_OK;
}

void nt_splitter_end(nt_splitter *s)
{
	s->output->source_count = s->copy_count;
	if (s->output->indices && !s->indexed && !s->lazy)
		copy_indices(s);
	const uint8_t *at = s->seen, *const end = at + s->mesh->vertex_count;
	for (; s->output->vertex_tangents && (at = (const uint8_t *)memchr(at, 0, (size_t)(end - at))); at++)
		set_unused_tangent(s->mesh, (size_t)(at - s->seen), s->output->vertex_tangents + 4 * (at - s->seen));
}
