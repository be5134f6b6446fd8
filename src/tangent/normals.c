/* SPDX-License-Identifier: MIT */
/*
 * Normals from faces: see frames.h. Corners meet by the value of their position, not by index, so that a
 * texture seam does not become a crease. Expected linear time; a vertex remembers the sum that it has in the group of
 * the corner before, so that hardly more than one look-up is made for each. Face normals and angles are worked out for
 * some faces at a time, in vectors of whatever the compiler assumes of every processor; sums are in the order of faces.
 */
#include "tangent/frames.h"

#include <float.h>
#include <string.h>
#include "base/angle.h"
#include "base/hash.h"
#include "base/vec.h"
#include "topology/corners.h"

/* The sum for one position and smoothing group. */
typedef struct shared_normal {
	float position[3]; /* -0 made +0 */
	uint32_t group;
	nt_dvec3 sum;
	double weights; /* of what went into the sum: unit vectors times angles */
} shared_normal;

/* State of a vertex. */
typedef struct known_normal {
	uint32_t group; /* 0: nothing */
	uint32_t entry;
} known_normal;

typedef struct normal_table {
	shared_normal *entries; /* [count] */
	size_t count;
	uint32_t *slots; /* [size] 1 + an entry, 0 where free */
	size_t size;     /* a power of two */
	known_normal *known; /* [vertex count] */
} normal_table;

enum { FACES = 32, CORNERS = 4 * FACES };

/* Some faces, one beside the other for loops that the compiler makes vectors of. */
typedef struct face_block {
	double across[2][3][FACES]; /* two edges (of a quad: its diagonals), whose cross product is along the normal */
	double normal[3][FACES];    /* unit vectors */
	double usable[FACES];       /* 1; 0: the face has no area, and no normal */
	double edges[2][3][CORNERS]; /* from a corner to the next and to the one before */
	double angles[CORNERS];
} face_block;

static nt_dvec3 lane(const double *x, const double *y, const double *z, size_t i)
{
	return (nt_dvec3){x[i], y[i], z[i]};
}

/* nt_dvec3_normalise() of `count` vectors. */
static void normalise(double *NT_RESTRICT x, double *NT_RESTRICT y, double *NT_RESTRICT z,
	double *NT_RESTRICT usable, size_t count)
{
	for (size_t i = 0; i < count; i++) {
		const nt_dvec3 v = {x[i], y[i], z[i]};
		const double largest = nt_dvec3_largest(v), sum = fabs(v.x + v.y + v.z);
		const double ok =
			(largest > 0.0 ? 1.0 : 0.0) * (largest <= DBL_MAX ? 1.0 : 0.0) * (sum <= DBL_MAX ? 1.0 : 0.0);
		const nt_dvec3 scaled = {v.x / largest, v.y / largest, v.z / largest};
		const double inverse = 1.0 / sqrt(nt_dvec3_dot(scaled, scaled));
		x[i] = inverse * scaled.x;
		y[i] = inverse * scaled.y;
		z[i] = inverse * scaled.z;
		usable[i] = ok;
	}
}

static void measure_angles(face_block *NT_RESTRICT b, size_t corners)
{
	/* both times the edges' lengths */
	double sine[CORNERS], cosine[CORNERS], t[CORNERS], base[CORNERS], arc[CORNERS];
	for (size_t i = 0; i < corners; i++) {
		const nt_dvec3 e = lane(b->edges[0][0], b->edges[0][1], b->edges[0][2], i);
		const nt_dvec3 f = lane(b->edges[1][0], b->edges[1][1], b->edges[1][2], i);
		const nt_dvec3 across = nt_dvec3_cross(e, f);
		sine[i] = sqrt(nt_dvec3_dot(across, across));
		cosine[i] = nt_dvec3_dot(e, f);
		t[i] = nt_lesser_tangent(sine[i], cosine[i]);
	}
	for (size_t i = 0; i < corners; i++) {
		const nt_tangent nearest = nt_nearest_arc(t[i]);
		base[i] = nearest.base;
		arc[i] = nearest.arc;
	}
	for (size_t i = 0; i < corners; i++)
		b->angles[i] = nt_angle_by((nt_tangent){t[i], base[i], arc[i]}, sine[i], cosine[i]);
}

static void measure(face_block *NT_RESTRICT b, size_t faces, size_t corners)
{
	for (size_t i = 0; i < faces; i++) {
		const nt_dvec3 n = nt_dvec3_cross(lane(b->across[0][0], b->across[0][1], b->across[0][2], i),
			lane(b->across[1][0], b->across[1][1], b->across[1][2], i));
		b->normal[0][i] = n.x;
		b->normal[1][i] = n.y;
		b->normal[2][i] = n.z;
	}
	normalise(b->normal[0], b->normal[1], b->normal[2], b->usable, faces);
	measure_angles(b, corners);
}

static void put(double (*to)[CORNERS], size_t corner, nt_dvec3 v)
{
	to[0][corner] = v.x;
	to[1][corner] = v.y;
	to[2][corner] = v.z;
}

/* The edges of a face that begins with corner `first` of the mesh, and `at` of the block. */
static void gather_face(const nmtan_mesh *mesh, size_t first, size_t size, face_block *b, size_t face, size_t at)
{
	nt_dvec3 p[4];
	for (size_t k = 0; k < size; k++)
		p[k] = nt_dvec3_load(nt_position(mesh, nt_vertex_of(mesh, first + k)));
	for (size_t k = 0; k < size; k++) {
		put(b->edges[0], at + k, nt_dvec3_sub(p[k + 1 < size ? k + 1 : 0], p[k]));
		put(b->edges[1], at + k, nt_dvec3_sub(p[k ? k - 1 : size - 1], p[k]));
	}
	const nt_dvec3 one = size == 3 ? nt_dvec3_sub(p[1], p[0]) : nt_dvec3_sub(p[2], p[0]);
	const nt_dvec3 other = size == 3 ? nt_dvec3_sub(p[2], p[0]) : nt_dvec3_sub(p[3], p[1]);
	b->across[0][0][face] = one.x, b->across[0][1][face] = one.y, b->across[0][2][face] = one.z;
	b->across[1][0][face] = other.x, b->across[1][1][face] = other.y, b->across[1][2][face] = other.z;
}

bool nt_face_normal(const nmtan_mesh *mesh, size_t first, size_t size, nt_dvec3 *n)
{
	face_block b;
	gather_face(mesh, first, size, &b, 0, 0);
	measure(&b, 1, 0);
	*n = lane(b.normal[0], b.normal[1], b.normal[2], 0);
	return b.usable[0] != 0.0;
}

static uint64_t hash_position(const float position[3], uint32_t group)
{
	return nt_hash_words(nt_hash_floats(position[0], position[1]), nt_hash_floats(position[2], 0) << 32 | group);
}

static uint32_t look_up(normal_table *table, const float *p, uint32_t group)
{
	const float position[3] = {p[0] + 0.0f, p[1] + 0.0f, p[2] + 0.0f};
	size_t at = hash_position(position, group) & (table->size - 1);
	for (; table->slots[at] != 0; at = (at + 1) & (table->size - 1)) {
		const shared_normal *entry = &table->entries[table->slots[at] - 1];
		if (entry->group == group && memcmp(entry->position, position, sizeof position) == 0)
			return table->slots[at] - 1;
	}
	shared_normal *entry = &table->entries[table->count++];
	memcpy(entry->position, position, sizeof position);
	entry->group = group;
	entry->sum = (nt_dvec3){0, 0, 0};
	entry->weights = 0.0;
	return (table->slots[at] = (uint32_t)table->count) - 1;
}

/* The entry of a corner's position in a group other than 0. */
static shared_normal *find_entry(normal_table *table, const nmtan_mesh *mesh, size_t corner, uint32_t group)
{
	const size_t vertex = nt_vertex_of(mesh, corner);
	known_normal *known = &table->known[vertex];
	if (known->group != group)
		*known = (known_normal){group, look_up(table, nt_position(mesh, vertex), group)};
	return &table->entries[known->entry];
}

/* Which corners share a sum. */
typedef struct grouping {
	const uint32_t *faces, *corners; /* of nt_corner_normals() */
} grouping;

static inline uint32_t group_of(const grouping *g, size_t face, size_t corner)
{
	return g->corners ? g->corners[corner] : g->faces ? g->faces[face] : 1;
}

/* At least as many as there are entries: how often a corner's group is not that of its vertex's corner before. */
static size_t count_entries(const nmtan_mesh *mesh, const grouping *g, known_normal *known)
{
	size_t first = 0, count = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		const size_t size = nt_face_size(mesh, face);
		for (size_t k = 0; k < size; k++) {
			const uint32_t group = group_of(g, face, first + k);
			uint32_t *before = &known[nt_vertex_of(mesh, first + k)].group;
			count += group && *before != group;
			*before = group ? group : *before;
		}
		first += size;
	}
	return count;
}

/* Adds a block of faces, of which the first is `face` and begins with corner `first`. */
static void add_block(const nmtan_mesh *mesh, const grouping *g, size_t face, size_t count, size_t first,
	const face_block *b, normal_table *table)
{
	for (size_t i = 0, at = 0; i < count; i++) {
		const size_t size = nt_face_size(mesh, face + i);
		const nt_dvec3 n = lane(b->normal[0], b->normal[1], b->normal[2], i);
		for (size_t k = 0; k < size && b->usable[i] != 0.0; k++) {
			const uint32_t group = group_of(g, face + i, first + at + k);
			if (!group)
				continue;
			shared_normal *entry = find_entry(table, mesh, first + at + k, group);
			entry->sum = nt_dvec3_add(entry->sum, nt_dvec3_scale(b->angles[at + k], n));
			entry->weights += b->angles[at + k];
		}
		at += size;
	}
}

static void sum_normals(const nmtan_mesh *mesh, const grouping *g, normal_table *table)
{
	face_block b;
	for (size_t face = 0, first = 0; face < mesh->face_count;) {
		const size_t left = mesh->face_count - face, count = left < FACES ? left : FACES;
		size_t corners = 0;
		for (size_t i = 0; i < count; i++) {
			const size_t size = nt_face_size(mesh, face + i);
			gather_face(mesh, first + corners, size, &b, i, corners);
			corners += size;
		}
		measure(&b, count, corners);
		add_block(mesh, g, face, count, first, &b, table);
		face += count;
		first += corners;
	}
}

/* Sums become unit vectors; zero where they have no direction, as those of a sheet whose faces are there twice, once
 * reversed: what the additions leave of these is rounding. */
static void normalise_sums(normal_table *table)
{
	double v[3][CORNERS], usable[CORNERS];
	for (size_t first = 0; first < table->count; first += CORNERS) {
		const size_t left = table->count - first, count = left < CORNERS ? left : CORNERS;
		shared_normal *const entries = table->entries + first;
		for (size_t i = 0; i < count; i++)
			put(v, i, entries[i].sum);
		normalise(v[0], v[1], v[2], usable, count);
		for (size_t i = 0; i < count; i++) {
			const bool has_direction = nt_dvec3_length(entries[i].sum) > NT_CANCELLED * entries[i].weights;
			entries[i].sum = has_direction && usable[i] != 0.0 ? lane(v[0], v[1], v[2], i)
									  : (nt_dvec3){0, 0, 0};
		}
	}
}

static bool is_zero(nt_dvec3 n)
{
	return n.x == 0 && n.y == 0 && n.z == 0;
}

/* Every corner gets its sum; in group 0, or where that has no direction, its face's normal. */
static void write_normals(const nmtan_mesh *mesh, const grouping *g, normal_table *table,
	float (*normals)[4])
{
	static const shared_normal none;
	size_t first = 0;
	for (size_t face = 0; face < mesh->face_count; face++) {
		const size_t size = nt_face_size(mesh, face);
		for (size_t k = 0; k < size; k++) {
			const uint32_t group = group_of(g, face, first + k);
			const shared_normal *entry = group != 0 ? find_entry(table, mesh, first + k, group) : &none;
			const bool cancelled = is_zero(entry->sum) && entry->weights > 0.0;
			nt_dvec3 n = entry->sum;
			const bool has_normal = !is_zero(n) || nt_face_normal(mesh, first, size, &n);
			nt_dvec3_store(has_normal ? n : (nt_dvec3){0, 0, 1}, normals[first + k]);
			normals[first + k][3] = cancelled && has_normal ? 1.0f : 0.0f;
		}
		first += size;
	}
}

nmtan_status nt_corner_normals(const nmtan_mesh *mesh, size_t corner_count, const uint32_t *smoothing,
	const uint32_t *groups, nt_scratch *scratch, float (*normals)[4])
{
	const grouping g = {smoothing, groups};
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	const size_t vertices = mesh->indices ? mesh->vertex_count : corner_count;
	normal_table table = {.size = 16, .known = nt_scratch_alloc(scratch, vertices, sizeof *table.known)};
	if (!table.known)
		return NMTAN_ERROR_MEMORY;
	memset(table.known, 0, vertices * sizeof *table.known);
	const size_t most = count_entries(mesh, &g, table.known);
	while (table.size < 2 * most)
		table.size *= 2;
	if (most >= UINT32_MAX) /* slots have 32 bits; these take 200 GB */
		return NMTAN_ERROR_MEMORY;
	table.entries = nt_scratch_alloc(scratch, most, sizeof *table.entries);
	table.slots = nt_scratch_alloc(scratch, table.size, sizeof *table.slots);
	if (!table.entries || !table.slots)
		return NMTAN_ERROR_MEMORY;
	memset(table.slots, 0, table.size * sizeof *table.slots);
	memset(table.known, 0, vertices * sizeof *table.known);
	sum_normals(mesh, &g, &table);
	normalise_sums(&table);
	write_normals(mesh, &g, &table, normals);
	nt_scratch_back(scratch, mark);
	return NMTAN_OK;
}
