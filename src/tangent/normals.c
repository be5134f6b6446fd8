/* SPDX-License-Identifier: MIT */
/*
 * Normals from faces: see normals.h. Corners meet by the value of their position, not by index, so that a
 * texture seam does not become a crease. Expected linear time; a vertex remembers the sum that it has in the group of the
 * corner before, so that hardly more than one look-up is made for each.
 */
#include "tangent/normals.h"

#include <string.h>
#include "base/angle.h"
#include "base/dvec.h"
#include "topology/corners.h"

/* The sum for one position and smoothing group. */
typedef struct shared_normal {
	float position[3]; /* -0 made +0 */
	uint32_t group;
	nt_dvec3 sum;
} shared_normal;

/* What a vertex remembers. */
typedef struct known_normal {
	uint32_t group; /* 0: nothing */
	uint32_t entry;
} known_normal;

typedef struct normal_table {
	shared_normal *entries; /* [size], group 0 where free */
	size_t size;            /* a power of two */
	known_normal *known;    /* [vertex count] */
} normal_table;

static nt_dvec3 corner_position(const nmtan_mesh *mesh, size_t corner)
{
	return nt_dvec3_load(nt_position(mesh, nt_vertex_of(mesh, corner)));
}

/* Unit normal of a face (of a quad: across its diagonals); false where it has no area. */
static bool face_normal(const nmtan_mesh *mesh, size_t first, size_t size, nt_dvec3 *n)
{
	const nt_dvec3 a = corner_position(mesh, first), b = corner_position(mesh, first + 1);
	const nt_dvec3 c = corner_position(mesh, first + 2);
	*n = size == 3 ? nt_dvec3_cross(nt_dvec3_sub(b, a), nt_dvec3_sub(c, a))
		       : nt_dvec3_cross(nt_dvec3_sub(c, a),
				 nt_dvec3_sub(corner_position(mesh, first + 3), b));
	return nt_dvec3_normalise(n);
}

static double corner_angle(const nmtan_mesh *mesh, size_t first, size_t size, size_t k)
{
	const nt_dvec3 p = corner_position(mesh, first + k);
	const nt_dvec3 e = nt_dvec3_sub(corner_position(mesh, first + (k + 1) % size), p);
	const nt_dvec3 f = nt_dvec3_sub(corner_position(mesh, first + (k + size - 1) % size), p);
	const nt_dvec3 across = nt_dvec3_cross(e, f);
	return nt_angle(sqrt(nt_dvec3_dot(across, across)), nt_dvec3_dot(e, f));
}

static uint64_t hash_position(const float position[3], uint32_t group)
{
	uint64_t hash = group * 0x9e3779b97f4a7c15u;
	for (int i = 0; i < 3; i++) {
		uint32_t bits;
		memcpy(&bits, &position[i], sizeof bits);
		hash = (hash ^ bits) * 0xff51afd7ed558ccdu;
		hash ^= hash >> 32;
	}
	return hash;
}

static uint32_t look_up(const normal_table *table, const float *p, uint32_t group)
{
	const float position[3] = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};
	size_t at = hash_position(position, group) & (table->size - 1);
	for (;; at = (at + 1) & (table->size - 1)) {
		shared_normal *entry = &table->entries[at];
		if (entry->group == 0) {
			entry->group = group;
			memcpy(entry->position, position, sizeof position);
			return (uint32_t)at;
		}
		if (entry->group == group && memcmp(entry->position, position, sizeof position) == 0)
			return (uint32_t)at;
	}
}

/* The entry of a corner's position in a group other than 0. */
static shared_normal *find_entry(const normal_table *table, const nmtan_mesh *mesh, size_t corner, uint32_t group)
{
	const size_t vertex = nt_vertex_of(mesh, corner);
	known_normal *known = &table->known[vertex];
	if (known->group != group)
		*known = (known_normal){group, look_up(table, nt_position(mesh, vertex), group)};
	return &table->entries[known->entry];
}

/* At least as many as there are entries: how often a corner's group is not that of its vertex's corner before. */
static size_t count_entries(const nmtan_mesh *mesh, const uint32_t *smoothing, known_normal *known)
{
	size_t first = 0, count = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		const size_t size = nt_face_size(mesh, face);
		const uint32_t group = smoothing ? smoothing[face] : 1;
		for (size_t k = 0; k < size && group != 0; k++) {
			uint32_t *before = &known[nt_vertex_of(mesh, first + k)].group;
			count += *before != group;
			*before = group;
		}
		first += size;
	}
	return count;
}

static void sum_normals(const nmtan_mesh *mesh, const uint32_t *smoothing, normal_table *table)
{
	size_t first = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		const size_t size = nt_face_size(mesh, face);
		const uint32_t group = smoothing ? smoothing[face] : 1;
		nt_dvec3 n;
		if (group != 0 && face_normal(mesh, first, size, &n)) {
			for (size_t k = 0; k < size; k++) {
				nt_dvec3 *sum = &find_entry(table, mesh, first + k, group)->sum;
				*sum = nt_dvec3_add(*sum,
					nt_dvec3_scale(corner_angle(mesh, first, size, k), n));
			}
		}
		first += size;
	}
}

/* Sums become unit vectors; zero where they have no direction. */
static void normalise_sums(normal_table *table)
{
	for (size_t i = 0; i < table->size; i++)
		if (table->entries[i].group != 0 && !nt_dvec3_normalise(&table->entries[i].sum))
			table->entries[i].sum = (nt_dvec3){0, 0, 0};
}

static bool is_zero(nt_dvec3 n)
{
	return n.x == 0 && n.y == 0 && n.z == 0;
}

/* Every corner gets its sum; in group 0, or where that has no direction, its face's normal. */
static void write_normals(const nmtan_mesh *mesh, const uint32_t *smoothing, const normal_table *table,
	float (*normals)[3])
{
	size_t first = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		const size_t size = nt_face_size(mesh, face);
		const uint32_t group = smoothing ? smoothing[face] : 1;
		for (size_t k = 0; k < size; k++) {
			nt_dvec3 n = group != 0 ? find_entry(table, mesh, first + k, group)->sum : (nt_dvec3){0, 0, 0};
			if (is_zero(n) && !face_normal(mesh, first, size, &n))
				n = (nt_dvec3){0, 0, 1};
			float *out = normals[first + k];
			out[0] = (float)n.x;
			out[1] = (float)n.y;
			out[2] = (float)n.z;
		}
		first += size;
	}
}

nmtan_status nt_corner_normals(const nmtan_mesh *mesh, size_t corner_count, const uint32_t *smoothing,
	nt_scratch *scratch, float (*normals)[3])
{
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	const size_t vertices = mesh->indices ? mesh->vertex_count : corner_count;
	normal_table table = {.size = 16, .known = nt_scratch_alloc(scratch, vertices, sizeof *table.known)};
	if (!table.known)
		return NMTAN_ERROR_MEMORY;
	memset(table.known, 0, vertices * sizeof *table.known);
	const size_t most = count_entries(mesh, smoothing, table.known);
	while (table.size < 2 * most)
		table.size *= 2;
	if (table.size > (size_t)1 << 32) /* entries have 32 bits; these take 200 GB */
		return NMTAN_ERROR_MEMORY;
	table.entries = nt_scratch_alloc(scratch, table.size, sizeof *table.entries);
	if (!table.entries)
		return NMTAN_ERROR_MEMORY;
	memset(table.entries, 0, table.size * sizeof *table.entries);
	memset(table.known, 0, vertices * sizeof *table.known);
	sum_normals(mesh, smoothing, &table);
	normalise_sums(&table);
	write_normals(mesh, smoothing, &table, normals);
	nt_scratch_back(scratch, mark);
	return NMTAN_OK;
}
