/* SPDX-License-Identifier: MIT */
/*
 * The vertices that are not settled by their sums: pinches, edges with three triangles, triangles without a
 * frame between orientations, nearly antiparallel directions, hubs. The steps are those of the scalar
 * definition, but at these vertices only:
 *
 *   collect   corners of complex vertices, sorted by vertex and then by triangle
 *   adopt     which orientation each triangle without a frame takes. It keeps that of the first group that
 *             reaches it, wherever that is: the one thing that depends on the order of all corners
 *   then for a few vertices at a time, so that all of it stays in the first-level cache:
 *   pair      edges of triangles that meet at the vertex
 *   flood     groups
 *   solve     corners, in lanes (kernel_corners.h)
 *   average   and write
 *
 * In linear time but for directions that really are antiparallel: there every member of a group may have a
 * sum of its own.
 */
#include <string.h>
#include "base/vec.h"
#include "tangent/fast.h"
#include "topology/corners.h"

#define NONE UINT32_MAX

/* Corners that are solved together, unless one vertex has more. */
enum { BATCH = 128 };

/* nt_record.state of a complex vertex that has its number in x, bit by bit. */
#define NUMBERED (NT_RESULT_COMPLEX | 1)

/* A corner is 4 * triangle + k here, so that parting the two is no division. A "place" is an index into all
 * corners of complex vertices. */
typedef struct complex {
	nt_fast *fast;
	const nt_kernels *kernels;
	nt_room *room;
	int orient;          /* of the records that say which vertices are complex */
	size_t vertex_count, corner_count;
	size_t most;         /* corners of one vertex */
	uint32_t *begin;     /* [vertex_count + 1] first place of each vertex */
	uint32_t *corners;   /* [corner_count] */
	uint32_t *waiting;   /* [welded vertices] see pair_edge() */
	bool any;            /* some have no frame */
	bool more;           /* results are whole, not only their u */
} complex;

/* The corners of some vertices. Indices are places, counted from the first. */
typedef struct batch {
	uint32_t first, count;
	uint32_t *across[2]; /* the corner beyond the edge to the next and from the previous vertex, or NONE */
	uint32_t *behind;    /* [2 * capacity] see pair_edge(); then solved's memory */
	uint32_t *group;     /* or NONE */
	uint32_t group_count;
	uint32_t *head;      /* first member of each group */
	uint32_t *later;     /* the next member, ascending */
	nt_corner *solved;
} batch;

static void *allocate(const complex *c, size_t count, size_t size)
{
	return nt_room_alloc(c->room, count, size);
}

/* Collecting */

static nt_record *record_of(const complex *c, uint32_t vertex)
{
	return nt_fast_record(c->fast, c->orient, vertex);
}

static bool is_complex(const complex *c, uint32_t vertex)
{
	return (record_of(c, vertex)->state | 1) == NUMBERED;
}

static uint32_t number_of(const complex *c, uint32_t vertex)
{
	uint32_t number;
	memcpy(&number, &record_of(c, vertex)->x, sizeof number);
	return number;
}

static size_t next_triangle(const complex *c, size_t t)
{
	return nt_fast_next_flagged(c->fast, t, NT_TRIANGLE_COMPLEX);
}

/* Numbers the vertices as they come up and counts their corners. */
static void count_corners(complex *c, uint32_t *counts)
{
	const nt_fast *fast = c->fast;
	uint32_t numbers = 0;
	for (size_t t = next_triangle(c, 0); t < fast->triangle_count; t = next_triangle(c, t + 1)) {
		c->any |= (fast->flags[t] & NT_TRIANGLE_ANY) != 0;
		uint32_t copy[3];
		const uint32_t *vertices = nt_triangle_vertices(&fast->triangles, t, 1, copy);
		for (size_t k = 0; k < 3; k++) {
			const uint32_t v = vertices[k];
			nt_record *record = record_of(c, v);
			if (record->state == NT_RESULT_COMPLEX) {
				record->state = NUMBERED;
				memcpy(&record->x, &numbers, sizeof numbers);
				numbers++;
			}
			if (is_complex(c, v))
				counts[number_of(c, v)]++;
		}
	}
}

static nmtan_status collect(complex *c)
{
	c->begin = allocate(c, c->vertex_count + 2, sizeof *c->begin);
	if (!c->begin)
		return NMTAN_ERROR_MEMORY;
	/* counted two places ahead: filling then moves each begin to where it belongs */
	uint32_t *at = c->begin + 1;
	memset(c->begin, 0, (c->vertex_count + 2) * sizeof *c->begin);
	count_corners(c, at + 1);
	for (size_t v = 1; v <= c->vertex_count; v++) {
		c->most = at[v] > c->most ? at[v] : c->most;
		at[v] += at[v - 1];
	}
	c->corner_count = at[c->vertex_count];
	c->corners = allocate(c, c->corner_count, sizeof *c->corners);
	if (!c->corners)
		return NMTAN_ERROR_MEMORY;
	for (size_t t = next_triangle(c, 0); t < c->fast->triangle_count; t = next_triangle(c, t + 1)) {
		uint32_t copy[3];
		const uint32_t *vertices = nt_triangle_vertices(&c->fast->triangles, t, 1, copy);
		for (size_t k = 0; k < 3; k++)
			if (is_complex(c, vertices[k]))
				c->corners[at[number_of(c, vertices[k])]++] = (uint32_t)(4 * t + k);
	}
	return NMTAN_OK;
}

/* Pairing */

/* The vertex at the far end of a corner's edge: way 0 to the next, 1 from the previous. */
static uint32_t far_vertex(const complex *c, uint32_t corner, uint32_t way)
{
	static const uint8_t step[2][4] = {{1, 2, 0, 0}, {2, 0, 1, 0}};
	const nt_triangles *triangles = &c->fast->triangles;
	return triangles->ids[nt_triangle_corner(triangles, corner >> 2, step[way][corner & 3])];
}

/*
 * Edge 2 * place + way meets the first edge in the other direction that waits at its far end; if there is none
 * it waits there itself. Those that wait at one vertex all run the same way. They stand in a ring, of which
 * `waiting` knows the last and `behind` has each one's follower. What waits since another vertex's turn has a
 * number below `begin`. Numbers are kept with 1 added, 0 being nobody.
 */
static void pair_edge(const complex *c, batch *b, uint32_t begin, uint32_t edge, uint32_t far)
{
	uint32_t *behind = b->behind, *waiting = &c->waiting[far];
	const uint32_t zero = 2 * b->first, last = *waiting - 1 - zero, e = edge - zero;
	if (*waiting <= begin) {
		behind[e] = e;
		*waiting = edge + 1;
	} else if ((last ^ e) % 2 == 0) {
		behind[e] = behind[last];
		behind[last] = e;
		*waiting = edge + 1;
	} else {
		const uint32_t partner = behind[last];
		b->across[e % 2][e / 2] = partner / 2;
		b->across[partner % 2][partner / 2] = e / 2;
		behind[last] = behind[partner];
		if (partner == last)
			*waiting = 0;
	}
}

/* The vertex whose places are [begin, end). */
static void pair_vertex(const complex *c, batch *b, uint32_t begin, uint32_t end)
{
	for (uint32_t place = begin; place < end; place++)
		for (uint32_t way = 0; way < 2; way++) {
			b->across[way][place - b->first] = NONE;
			pair_edge(c, b, 2 * begin, 2 * place + way, far_vertex(c, c->corners[place], way));
		}
}

/* Groups */

/* Takes a corner into the group, if it is free and of its orientation. */
static bool join_group(const complex *c, batch *b, uint32_t i, unsigned orient)
{
	if (i == NONE || b->group[i] != NONE)
		return false;
	uint8_t *flags = &c->fast->flags[c->corners[b->first + i] >> 2];
	if ((*flags & NT_TRIANGLE_ANY) && !(*flags & NT_TRIANGLE_TAKEN))
		*flags = (uint8_t)((*flags & ~NT_TRIANGLE_ORIENT) | orient | NT_TRIANGLE_TAKEN);
	if ((*flags & NT_TRIANGLE_ORIENT) != orient)
		return false;
	b->group[i] = b->group_count;
	return true;
}

/* The group that begins at a corner, if that is free and has a frame. Corners are rows or rings: it is
 * followed both ways. */
static void flood_group(const complex *c, batch *b, uint32_t seed)
{
	const unsigned flags = c->fast->flags[c->corners[b->first + seed] >> 2];
	if ((flags & NT_TRIANGLE_ANY) || b->group[seed] != NONE)
		return;
	b->group[seed] = b->group_count;
	for (int way = 0; way < 2; way++)
		for (uint32_t i = b->across[way][seed]; join_group(c, b, i, flags & NT_TRIANGLE_ORIENT);)
			i = b->across[way][i];
	b->group_count++;
}

/* Members of each group, ascending. */
static void list_members(batch *b)
{
	memset(b->head, 0xff, b->group_count * sizeof *b->head);
	b->later = b->across[0]; /* no longer needed */
	for (uint32_t i = b->count; i-- > 0;)
		if (b->group[i] != NONE) {
			b->later[i] = b->head[b->group[i]];
			b->head[b->group[i]] = i;
		}
}

/* Adopting */

static bool alloc_pairs(const complex *c, batch *b, size_t capacity)
{
	b->across[0] = allocate(c, capacity, sizeof **b->across);
	b->across[1] = allocate(c, capacity, sizeof **b->across);
	b->group = allocate(c, capacity, sizeof *b->group);
	return b->across[0] && b->across[1] && b->group;
}

/* Pairs the corners of vertices that touch a triangle without a frame. Begins of the others become NONE. */
static void pair_undecided(const complex *c, batch *b, uint32_t *begin)
{
	for (size_t v = 0; v < c->vertex_count; v++) {
		bool any = false;
		for (uint32_t place = c->begin[v]; place < c->begin[v + 1] && !any; place++)
			any = c->fast->flags[c->corners[place] >> 2] & NT_TRIANGLE_ANY;
		begin[v] = any ? c->begin[v] : NONE;
		if (any)
			pair_vertex(c, b, c->begin[v], c->begin[v + 1]);
	}
}

/* Floods in the order of triangles, for what that does to flags. */
static nmtan_status adopt(complex *c)
{
	const nt_fast *fast = c->fast;
	if (!c->any || !fast->records[0] || !fast->records[1])
		return NMTAN_OK;
	const nt_scratch_mark mark = nt_scratch_here(c->room->scratch);
	const nt_room room = *c->room;
	batch b = {.count = (uint32_t)c->corner_count};
	uint32_t *at = allocate(c, c->vertex_count, sizeof *at);
	b.behind = allocate(c, c->corner_count, 2 * sizeof *b.behind);
	if (!alloc_pairs(c, &b, c->corner_count) || !at || !b.behind)
		return NMTAN_ERROR_MEMORY;
	memset(b.group, 0xff, c->corner_count * sizeof *b.group);
	pair_undecided(c, &b, at);
	for (size_t t = next_triangle(c, 0); t < fast->triangle_count; t = next_triangle(c, t + 1)) {
		uint32_t copy[3];
		const uint32_t *vertices = nt_triangle_vertices(&fast->triangles, t, 1, copy);
		for (size_t k = 0; k < 3; k++)
			if (is_complex(c, vertices[k]) && at[number_of(c, vertices[k])] != NONE)
				flood_group(c, &b, at[number_of(c, vertices[k])]++);
	}
	nt_scratch_back(c->room->scratch, mark);
	*c->room = room;
	memset(c->waiting, 0, fast->vertex_count * sizeof *c->waiting);
	return NMTAN_OK;
}

/* Averages */

static float dot3(const float *a, const float *b)
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Whether triangle t is the second half of a quad whose first half is s. */
static bool is_second_half(const complex *c, uint32_t t, uint32_t s)
{
	return t == s + 1 && (c->fast->flags[t] & NT_TRIANGLE_SECOND);
}

/* Whether two members of a group are averaged together: step 7 with the default threshold. */
static bool belong_together(const complex *c, const batch *b, uint32_t i, uint32_t j)
{
	const nt_corner *f = &b->solved[i], *t = &b->solved[j];
	if (dot3(f->u, t->u) > -1.0f && dot3(f->v, t->v) > -1.0f)
		return true;
	const uint32_t ft = c->corners[b->first + i] >> 2, tt = c->corners[b->first + j] >> 2;
	return f->kind == NT_CORNER_ANY || t->kind == NT_CORNER_ANY || ft == tt || is_second_half(c, ft, tt) || is_second_half(c, tt, ft);
}

static void normalise_safe(float v[3])
{
	const nt_vec3 n = nt_vec3_normalise_safe((nt_vec3){v[0], v[1], v[2]});
	v[0] = n.x, v[1] = n.y, v[2] = n.z;
}

/* The sum over the members that belong together with f; f NONE: over all. Members without a frame add 0. */
static nt_corner add_members(const complex *c, const batch *b, uint32_t group, uint32_t f)
{
	nt_float4 u = {0}, v = {0};
	nt_corner sum = {.kind = NT_CORNER_EXTREME};
	for (uint32_t i = b->head[group]; i != NONE; i = b->later[i]) {
		const nt_corner *m = &b->solved[i];
		if (f != NONE && !belong_together(c, b, f, i))
			continue;
		nt_float4 mu, mv;
		memcpy(&mu, m->u, sizeof mu);
		memcpy(&mv, m->v, sizeof mv);
		u += m->angle * mu;
		v += m->angle * mv;
		sum.angle += m->angle;
	}
	memcpy(sum.u, &u, sizeof u);
	memcpy(sum.v, &v, sizeof v);
	return sum;
}

/* From a sum to the average. */
static void finish(const complex *c, nt_corner *sum)
{
	normalise_safe(sum->u);
	if (!c->more)
		return;
	normalise_safe(sum->v);
	if (sum->angle > 0.0f) {
		sum->mag_s /= sum->angle;
		sum->mag_t /= sum->angle;
	}
}

/* Whether the angle between a unit vector and a sum is below 89.4 degrees. Of two such vectors the dot product
 * is at least -0.9998, as that of vectors in one half-space: see kernel_lanes.h. */
static bool leans(const float *unit, const float *sum, float sum_squared)
{
	const float along = dot3(unit, sum);
	return along > 0.0f && along * along > 1e-4f * sum_squared;
}

/* Whether no two members can have antiparallel directions, by one look at each. */
static bool no_split(const batch *b, uint32_t group, const nt_corner *sum)
{
	const float uu = dot3(sum->u, sum->u), vv = dot3(sum->v, sum->v);
	for (uint32_t i = b->head[group]; i != NONE; i = b->later[i]) {
		const nt_corner *m = &b->solved[i];
		const bool sure = m->kind == NT_CORNER_UNIT && leans(m->u, sum->u, uu) && leans(m->v, sum->v, vv);
		if (!sure && m->kind != NT_CORNER_ANY)
			return false;
	}
	return true;
}

/* Whether all members from i on belong together with f. */
static bool all_belong(const complex *c, const batch *b, uint32_t i, uint32_t f)
{
	for (; i != NONE; i = b->later[i])
		if (!belong_together(c, b, i, f))
			return false;
	return true;
}

/* The same by all pairs. */
static bool no_pair_splits(const complex *c, const batch *b, uint32_t group)
{
	for (uint32_t i = b->head[group]; i != NONE; i = b->later[i])
		if (!all_belong(c, b, b->later[i], i))
			return false;
	return true;
}

/* Writing */

static size_t mesh_corner(const complex *c, const batch *b, uint32_t i)
{
	const uint32_t corner = c->corners[b->first + i];
	return nt_triangle_corner(&c->fast->triangles, corner >> 2, corner & 3);
}

static void write_corner(const complex *c, size_t corner, const nt_corner *r, float sign)
{
	const nt_solve *solve = c->fast->solve;
	memcpy(solve->tangents + 4 * corner, (float[4]){r->u[0], r->u[1], r->u[2], sign}, 4 * sizeof(float));
	if (solve->bitangents)
		memcpy(solve->bitangents + 3 * corner, r->v, 3 * sizeof(float));
	if (solve->magnitudes)
		memcpy(solve->magnitudes + 2 * corner, (float[2]){r->mag_s, r->mag_t}, 2 * sizeof(float));
}

/* The sign of a group, by any of its members. */
static float group_sign(const complex *c, const batch *b, uint32_t i)
{
	return c->fast->flags[c->corners[b->first + i] >> 2] & NT_TRIANGLE_ORIENT ? 1.0f : -1.0f;
}

/* Results go to their corners, or to `results` where the halves of quads have to meet. */
static void solve_group(const complex *c, const batch *b, uint32_t group, nt_corner *results)
{
	nt_corner whole = add_members(c, b, group, NONE);
	const bool one = no_split(b, group, &whole) || no_pair_splits(c, b, group);
	finish(c, &whole);
	const float sign = group_sign(c, b, b->head[group]);
	for (uint32_t i = b->head[group]; i != NONE; i = b->later[i]) {
		nt_corner r = whole;
		if (!one && !all_belong(c, b, b->head[group], i)) {
			r = add_members(c, b, group, i);
			finish(c, &r);
		}
		if (results)
			results[i] = r;
		else
			write_corner(c, mesh_corner(c, b, i), &r, sign);
	}
}

/* A corner that no group reached keeps the default: step 10. */
static const nt_corner untouched = {.u = {1, 0, 0}, .mag_s = 1, .v = {0, 1, 0}, .mag_t = 1};

static void write_untouched(const complex *c, const batch *b)
{
	for (uint32_t i = 0; i < b->count; i++)
		if (b->group[i] == NONE)
			write_corner(c, mesh_corner(c, b, i), &untouched, -1.0f);
}

/* The corner of a quad's diagonal gets two results, one from each half: they are averaged. */
static nt_corner merge(const nt_corner *a, const nt_corner *b)
{
	const float *x = a->u, *y = b->u; /* with what lies behind: eight floats */
	bool equal = true;
	for (size_t i = 0; i < 8; i++)
		equal &= x[i] == y[i];
	if (equal)
		return *a;
	nt_corner r = {.mag_s = 0.5f * (a->mag_s + b->mag_s), .mag_t = 0.5f * (a->mag_t + b->mag_t)};
	for (int i = 0; i < 3; i++) {
		r.u[i] = a->u[i] + b->u[i];
		r.v[i] = a->v[i] + b->v[i];
	}
	normalise_safe(r.u);
	normalise_safe(r.v);
	return r;
}

/* Writes the corner i, and j (NONE: there is none), the other half's corner of the same face vertex. */
static void write_halves(const complex *c, const batch *b, uint32_t i, uint32_t j, const nt_corner *results)
{
	const bool first = b->group[i] != NONE, second = j != NONE && b->group[j] != NONE;
	const size_t corner = mesh_corner(c, b, i);
	if (first && second) {
		const nt_corner r = merge(&results[i], &results[j]);
		/* the orientation is that of the later group */
		write_corner(c, corner, &r, group_sign(c, b, b->group[i] > b->group[j] ? i : j));
	} else if (first || second) {
		write_corner(c, corner, &results[first ? i : j], group_sign(c, b, first ? i : j));
	} else {
		write_corner(c, corner, &untouched, -1.0f);
	}
}

static void write_quads(const complex *c, const batch *b, const nt_corner *results)
{
	for (uint32_t i = 0; i < b->count; i++) {
		const bool two = i + 1 < b->count && mesh_corner(c, b, i) == mesh_corner(c, b, i + 1);
		write_halves(c, b, i, two ? i + 1 : NONE, results);
		i += two;
	}
}

/* All steps */

static void solve_batch(const complex *c, batch *b, nt_corner *results)
{
	memset(b->group, 0xff, b->count * sizeof *b->group);
	b->group_count = 0;
	for (uint32_t i = 0; i < b->count; i++)
		flood_group(c, b, i);
	list_members(b);
	c->kernels->corners(c->fast, c->corners + b->first, b->count, b->solved);
	for (uint32_t group = 0; group < b->group_count; group++)
		solve_group(c, b, group, results);
	if (results)
		write_quads(c, b, results);
	else
		write_untouched(c, b);
}

static nmtan_status solve_batches(complex *c)
{
	batch b = {0};
	const size_t capacity = c->most > BATCH ? c->most : BATCH;
	const bool quads = c->fast->triangles.cuts;
	nt_corner *results = quads ? allocate(c, capacity, sizeof *results) : NULL;
	b.head = allocate(c, capacity, sizeof *b.head);
	b.solved = allocate(c, capacity + NT_LANES, sizeof *b.solved);
	if (!alloc_pairs(c, &b, capacity) || !b.head || !b.solved || (quads && !results))
		return NMTAN_ERROR_MEMORY;
	b.behind = (uint32_t *)b.solved; /* pairs are found before corners are solved */
	for (size_t v = 0; v < c->vertex_count;) {
		b.first = c->begin[v];
		do {
			pair_vertex(c, &b, c->begin[v], c->begin[v + 1]);
			v++;
		} while (v < c->vertex_count && c->begin[v + 1] - b.first <= BATCH);
		b.count = c->begin[v] - b.first;
		solve_batch(c, &b, results);
	}
	return NMTAN_OK;
}

nmtan_status nt_fast_complex(nt_fast *fast, const nt_kernels *kernels, size_t complex_count, nt_room *room)
{
	complex c = {.fast = fast, .kernels = kernels, .room = room, .vertex_count = complex_count,
		.more = fast->wants_more || fast->triangles.cuts};
	c.orient = !fast->records[0];
	c.waiting = allocate(&c, fast->vertex_count, sizeof *c.waiting);
	if (!c.waiting)
		return NMTAN_ERROR_MEMORY;
	memset(c.waiting, 0, fast->vertex_count * sizeof *c.waiting);
	nmtan_status status = collect(&c);
	if (!status)
		status = adopt(&c);
	return status ? status : solve_batches(&c);
}
