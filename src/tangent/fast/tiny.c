/* SPDX-License-Identifier: MIT */
/*
 * Meshes of a few triangles, of which a file can have a hundred thousand. There every pass of the usual way costs more
 * by being there than by what it does. This is the definition, step by step, with everything on the stack and small
 * enough for the first-level cache:
 *
 *   weld     rows are compared with those of equal hash bits
 *   frames   and weights of 16 triangles at a time                            few_lanes.h
 *   pair     edges, by a table of all pairs of vertices
 *   groups   flooded in the order of seeds: nothing has to be decided ahead
 *   sums     over corners in order, each to its group
 *   vouch    for groups whose directions are too far apart for what lanes see of them
 *   results                                                                    few_lanes.h
 *   write
 *
 * A group that may split, or has extreme values, is averaged by complex_solve.c.
 */
#include "tangent/fast/tiny.h"

#include "base/vec.h"
#include "tangent/fast/complex_solve.h"
#include "tangent/fast/write.h"

/* Corners are 4 * triangle + k here; an edge has the number of the corner where it begins. */
enum { CORNERS = 3 * NT_TINY, SLOTS = 4 * NT_TINY, NOT_ONE = UINT8_MAX };
_Static_assert(SLOTS <= NOT_ONE, "a byte holds a corner, a vertex, a group, or none");

/* What is found out of corners, and of the edges that begin there. Each triangle's bytes are set when it comes. */
typedef struct corner_table {
	uint8_t forward[SLOTS], backward[SLOTS]; /* the corner beyond the edge to the next, from the previous vertex, or
	                                            NOT_ONE */
	uint8_t group[SLOTS];                    /* or NOT_ONE */
	uint8_t behind[SLOTS];                   /* the edge that waits behind this one, and 1, or 0 */
} corner_table;

typedef struct tiny {
	nt_fast *fast;
	const nt_kernels *kernels;
	const uint32_t *ids;
	nt_weld_row rows[CORNERS];
	nt_record add[CORNERS + 1];    /* of corner 3 t + k */
	nt_frames frames[(NT_TINY + NT_LANES - 1) / NT_LANES];
	corner_table corners;
	nt_record results[CORNERS + NT_LANES]; /* of groups: sums, then results */
	uint32_t vertices[CORNERS + NT_LANES]; /* of groups */
	uint32_t group_count;
} tiny;

static uint8_t next_of(uint8_t c)
{
	return (uint8_t)((c & 3) == 2 ? c - 2 : c + 1);
}

/* Weld */

/* Ten bits, which are enough to tell most rows apart: products modulo 2^64, whose highest bits depend on all bits of a
 * row. */
static inline unsigned bits_of_row(const nt_weld_row *row)
{
	return (unsigned)((nt_weld_word(row, 0) * 0x9e3779b97f4a7c15u + nt_weld_word(row, 1) * 0xa4093822299f31d1u +
		nt_weld_word(row, 2) * 0x13198a2e03707345u + nt_weld_word(row, 3) * 0x082efa98ec4e6c89u) >> 54);
}

static size_t find_row(const nt_weld_row *rows, size_t count, const nt_weld_row *row)
{
	size_t i = 0;
	while (i < count && !nt_weld_same(&rows[i], row))
		i++;
	return i;
}

/* Numbers of items, which are vertices or corners; false where one holds a NaN. */
static bool number_items(tiny *s, const uint32_t *vertices, size_t count, uint32_t *numbers)
{
	nt_fast *fast = s->fast;
	const nmtan_mesh mesh = *fast->solve->mesh;
	uint64_t seen[16] = {0};
	nt_weld_flags unordered = {0};
	size_t rows = 0;
	for (size_t i = 0; i < count; i++) {
		nt_weld_row *row = &s->rows[rows];
		unordered |= nt_weld_load(&mesh, vertices ? vertices[i] : i, row);
		const unsigned bits = bits_of_row(row);
		const uint64_t bit = (uint64_t)1 << bits / 16;
		uint64_t *word = &seen[bits % 16];
		const size_t number = *word & bit ? find_row(s->rows, rows, row) : rows;
		*word |= bit;
		numbers[i] = (uint32_t)number;
		rows += number == rows;
	}
	fast->vertex_count = rows;
	return nt_weld_ordered(unordered);
}

static nmtan_status weld(tiny *s, bool *done)
{
	nt_fast *fast = s->fast;
	const nmtan_mesh *mesh = fast->solve->mesh;
	const size_t corners = fast->solve->corner_count;
	const bool by_vertex = mesh->indices && mesh->vertex_count <= corners;
	uint32_t numbers[CORNERS];
	uint32_t *ids = nt_scratch_alloc(fast->solve->scratch, corners, sizeof *ids + 1);
	if (!ids)
		return NMTAN_ERROR_MEMORY;
	fast->flags = (uint8_t *)(ids + corners);
	for (size_t t = 0; t < fast->triangle_count; t++)
		fast->flags[t] = 0;
	*done = by_vertex ? number_items(s, NULL, mesh->vertex_count, numbers)
			  : number_items(s, mesh->indices, corners, ids);
	for (size_t c = 0; by_vertex && c < corners; c++)
		ids[c] = numbers[mesh->indices[c]];
	fast->triangles.ids = s->ids = ids;
	return NMTAN_OK;
}

/* Pair */

/* Corners at the end and at the beginning of an edge, and at the other ends of the edge that it is paired with. */
typedef struct edge {
	uint8_t begin, end;
} edge;

/* An edge meets the first that waits between its vertices and runs the other way; if there is none it waits behind
 * those that run its own. */
static inline void pair_edge(corner_table *c, uint8_t *here, uint8_t *there, edge e)
{
	if (*there) {
		const uint8_t other = (uint8_t)(*there - 1), other_end = next_of(other);
		c->forward[e.begin] = other_end;
		c->forward[other] = e.end;
		c->backward[e.end] = other;
		c->backward[other_end] = e.begin;
		*there = c->behind[other];
		return;
	}
	while (*here)
		here = &c->behind[*here - 1];
	*here = (uint8_t)(e.begin + 1);
}

static void pair_edges(tiny *s)
{
	const nt_fast *fast = s->fast;
	const size_t n = fast->vertex_count;
	corner_table *const c = &s->corners;
	uint8_t waiting[CORNERS * CORNERS]; /* by vertices: an edge and 1, or 0 */
	_Static_assert(sizeof waiting % sizeof(nt_int4) == 0, "whole vectors are cleared");
	const nt_int4 none = {0};
	for (size_t i = 0; i < n * n; i += sizeof none) /* memset() is a call, which takes longer for few vertices */
		memcpy(waiting + i, &none, sizeof none);
	for (size_t t = 0; t < fast->triangle_count; t++) {
		memset(c->forward + 4 * t, NOT_ONE, 4);
		memset(c->backward + 4 * t, NOT_ONE, 4);
		memset(c->group + 4 * t, NOT_ONE, 4);
		memset(c->behind + 4 * t, 0, 4);
		if (fast->flags[t] & NT_TRIANGLE_DEGENERATE)
			continue;
		const uint8_t first = (uint8_t)(4 * t);
		const size_t u = s->ids[3 * t], v = s->ids[3 * t + 1], w = s->ids[3 * t + 2];
		pair_edge(c, &waiting[u * n + v], &waiting[v * n + u], (edge){first, (uint8_t)(first + 1)});
		pair_edge(c, &waiting[v * n + w], &waiting[w * n + v],
			(edge){(uint8_t)(first + 1), (uint8_t)(first + 2)});
		pair_edge(c, &waiting[w * n + u], &waiting[u * n + w], (edge){(uint8_t)(first + 2), first});
	}
}

/* Groups */

/* Takes corner c into the newest group, if it is free and of its orientation. */
static inline bool join_group(tiny *s, uint8_t *flags, uint8_t c, unsigned orient)
{
	uint8_t *f = &flags[c >> 2];
	if (s->corners.group[c] != NOT_ONE)
		return false;
	if ((*f & NT_TRIANGLE_ANY) && !(*f & NT_TRIANGLE_DECIDED))
		*f = (uint8_t)((*f & ~NT_TRIANGLE_ORIENT) | orient | NT_TRIANGLE_DECIDED);
	if ((*f & NT_TRIANGLE_ORIENT) != orient)
		return false;
	s->corners.group[c] = (uint8_t)s->group_count;
	return true;
}

/* The group that begins at a free corner with a frame. */
static inline void flood_group(tiny *s, uint8_t *flags, uint8_t seed)
{
	const unsigned orient = flags[seed >> 2] & NT_TRIANGLE_ORIENT;
	s->corners.group[seed] = (uint8_t)s->group_count;
	uint8_t c;
	for (c = s->corners.forward[seed]; c != NOT_ONE && join_group(s, flags, c, orient);)
		c = s->corners.forward[c];
	for (c = s->corners.backward[seed]; c != NOT_ONE && join_group(s, flags, c, orient);)
		c = s->corners.backward[c];
	s->vertices[s->group_count++] = s->ids[3 * (seed >> 2) + (seed & 3)];
}

static void find_groups(tiny *s)
{
	uint8_t *flags = s->fast->flags;
	for (size_t t = 0; t < s->fast->triangle_count; t++)
		for (size_t k = 0; k < 3 && !(flags[t] & (NT_TRIANGLE_DEGENERATE | NT_TRIANGLE_ANY)); k++)
			if (s->corners.group[4 * t + k] == NOT_ONE)
				flood_group(s, flags, (uint8_t)(4 * t + k));
}

static void add_corners(tiny *s)
{
	static const nt_record nothing = {0, 0, 0, NT_STATE_BASE | NT_STATE_ALL};
	const nt_fast *fast = s->fast;
	/* lanes behind the last group, too: denormals that lie there take a microsecond */
	const size_t lanes = s->group_count <= 4 ? 4 : (s->group_count + NT_LANES - 1) / NT_LANES * NT_LANES;
	for (size_t g = 0; g < lanes; g++)
		/* in one store, which can be read before it is done */
		memcpy(&s->results[g], &nothing, sizeof nothing);
	for (size_t t = 0; t < fast->triangle_count; t++)
		for (size_t k = 0; k < 3 && !(fast->flags[t] & (NT_TRIANGLE_DEGENERATE | NT_TRIANGLE_ANY)); k++) {
			nt_int4 add;
			memcpy(&add, &s->add[3 * t + k], sizeof add);
			nt_record_add(&s->results[s->corners.group[4 * t + k]], add);
		}
}

/* Vouch */

/* Of unit vectors: below its square two of them, each rounded, cannot have the dot product -1 at which groups split. */
#define MOST_SQUARED_COSINE 0.999f

/* Corners of groups as lists. */
typedef struct lists {
	uint8_t first[CORNERS], next[SLOTS]; /* of groups, of corners; NOT_ONE: none */
} lists;

static void list_corners(const tiny *s, lists *l)
{
	memset(l->first, NOT_ONE, sizeof l->first);
	for (size_t c = 0; c < 4 * s->fast->triangle_count; c++) {
		const uint8_t g = s->corners.group[c];
		if (g == NOT_ONE || (s->fast->flags[c / 4] & NT_TRIANGLE_ANY))
			continue;
		l->next[c] = l->first[g];
		l->first[g] = (uint8_t)c;
	}
}

/* Whether two of a group's directions, u or v as they lie across the normal n, may be opposite. */
static bool may_be_opposite(const tiny *s, const lists *l, size_t group, bool of_v, const float *n)
{
	float seen[CORNERS][4];
	size_t count = 0;
	for (uint8_t c = l->first[group]; c != NOT_ONE; c = l->next[c], count++) {
		const size_t t = c / 4;
		const nt_frames *f = &s->frames[t / NT_LANES];
		const float (*d)[NT_LANES] = of_v ? f->v : f->u;
		const nt_vec3 whole = {d[0][t % NT_LANES], d[1][t % NT_LANES], d[2][t % NT_LANES]};
		const float along = n[0] * whole.x + n[1] * whole.y + n[2] * whole.z;
		const nt_vec3 a = {whole.x - along * n[0], whole.y - along * n[1], whole.z - along * n[2]};
		const float squared = nt_vec3_dot(a, a);
		for (size_t i = 0; i < count; i++) {
			const float dot = a.x * seen[i][0] + a.y * seen[i][1] + a.z * seen[i][2];
			if (!(dot > 0.0f) && !(dot * dot < MOST_SQUARED_COSINE * squared * seen[i][3]))
				return true;
		}
		memcpy(seen[count], (float[4]){a.x, a.y, a.z, squared}, sizeof *seen);
	}
	return false;
}

/* Groups whose directions fit in no half-space of the lanes, but which do not split. */
static void vouch_for_groups(tiny *s)
{
	lists l;
	bool listed = false;
	for (size_t g = 0; g < s->group_count; g++) {
		uint32_t *state = &s->results[g].state;
		const bool u = *state & NT_STATE_U, v = *state & NT_STATE_V;
		if ((u && v) || !(*state & NT_STATE_SOUND))
			continue;
		if (!listed)
			list_corners(s, &l);
		listed = true;
		const float *n = s->rows[s->vertices[g]].normal;
		if ((u || !may_be_opposite(s, &l, g, false, n)) && (v || !may_be_opposite(s, &l, g, true, n)))
			*state |= NT_STATE_U | NT_STATE_V;
	}
}

/* Write */

/* Groups that are not their sums. */
static nmtan_status solve_complex(tiny *s)
{
	uint32_t corners[CORNERS], groups[CORNERS], across[2 * CORNERS];
	const nt_complex c = {.fast = s->fast, .kernels = s->kernels, .corners = corners, .group = groups,
		.across = across};
	nt_batch b = {.group_count = (uint32_t)s->group_count};
	for (uint32_t i = 0; i < 4 * s->fast->triangle_count; i++) {
		const uint8_t g = s->corners.group[i];
		if (g == NOT_ONE || !(s->results[g].state & NT_RESULT_COMPLEX))
			continue;
		groups[b.count] = g;
		const unsigned flags = s->fast->flags[i / 4];
		corners[b.count++] = i | (flags & NT_TRIANGLE_ORIENT ? NT_COMPLEX_PLUS : 0) |
				     (flags & NT_TRIANGLE_ANY ? NT_COMPLEX_ANY : 0);
	}
	return nt_solve_batch(&c, &b);
}

/* The corners of a triangle get the results of their groups, and its orientation's sign; returns the union of the
 * results' states. */
static uint32_t write_triangle(const tiny *s, size_t t, float *out)
{
	const uint32_t minus = s->fast->flags[t] & NT_TRIANGLE_ORIENT ? 0 : NT_RESULT_PLUS ^ NT_RESULT_MINUS;
	const nt_int4 sign = {0, 0, 0, (int)minus}, kept = {-1, -1, -1, ~(int)NT_RESULT_UNUSABLE};
	uint32_t states = 0;
	for (size_t k = 0; k < 3; k++, out += 4) {
		const uint8_t g = s->corners.group[4 * t + k];
		if (g == NOT_ONE) {
			nt_fast_write_unassigned(s->fast, 3 * t + k);
			continue;
		}
		nt_int4 result;
		memcpy(&result, &s->results[g], sizeof result);
		result = (result & kept) | sign;
		memcpy(out, &result, sizeof result);
		states |= s->results[g].state;
	}
	return states;
}

static nmtan_status write_corners(tiny *s)
{
	nt_fast *fast = s->fast;
	uint32_t states = 0;
	unsigned seen = 0;
	fast->mirrored = 0;
	for (size_t t = 0; t < fast->triangle_count; t++) {
		const uint32_t of_triangle = write_triangle(s, t, fast->solve->tangents + 12 * t);
		unsigned flags = fast->flags[t];
		flags |= of_triangle & NT_RESULT_UNUSABLE ? NT_TRIANGLE_COMPLEX : 0;
		flags |= flags & NT_TRIANGLE_DEGENERATE ? NT_TRIANGLE_COPY : 0;
		fast->flags[t] = (uint8_t)flags;
		fast->mirrored += !(flags & NT_TRIANGLE_ORIENT);
		states |= of_triangle;
		seen |= flags;
	}
	fast->sound = !(seen & NT_TRIANGLE_SUSPECT);
	if ((states & NT_RESULT_COMPLEX) && solve_complex(s))
		return NMTAN_ERROR_MEMORY;
	return seen & NT_TRIANGLE_COPY ? nt_fast_write_copies(s->fast) : NMTAN_OK;
}

nmtan_status nt_fast_tiny(nt_fast *fast, const nt_kernels *kernels, bool *done)
{
	tiny s;
	s.fast = fast;
	s.kernels = kernels;
	s.group_count = 0;
	const nmtan_status status = weld(&s, done);
	if (status || !*done)
		return status;
	fast->rows = s.rows;
	kernels->few_frames(fast, s.add, s.frames);
	pair_edges(&s);
	find_groups(&s);
	add_corners(&s);
	vouch_for_groups(&s);
	kernels->few_results(s.rows, s.vertices, s.group_count, s.results);
	return write_corners(&s);
}
