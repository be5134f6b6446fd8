/* SPDX-License-Identifier: MIT */
/*
 * The vertices that are not settled by their sums: pinches, edges with three triangles, triangles without a
 * frame between orientations, nearly antiparallel directions, hubs. The steps are those of the scalar
 * definition, but at these vertices only, and in linear time but for directions that really are
 * antiparallel: there every member of a group may have a sum of its own.
 *
 * Pairing is local to a vertex. Groups are seeded in the order of triangles over all vertices, because
 * a triangle without a frame keeps the orientation of the first group that takes it.
 */
#include <string.h>
#include "base/vec.h"
#include "tangent/acos.h"
#include "tangent/fast.h"
#include "topology/corners.h"

#define NONE UINT32_MAX

/* A result, and what the reference keeps beside it. */
typedef struct slot {
	nt_vec3 os, ot;
	float mag_s, mag_t;
} slot;

/* What a corner adds to its group. */
typedef struct member {
	nt_vec3 u, v; /* unit directions perpendicular to the normal */
	float angle, mag_s, mag_t;
	uint32_t triangle;
	bool any;
} member;

/* Corners of complex vertices, sorted by vertex and then by triangle. A "place" is an index into this
 * order. */
typedef struct complex {
	nt_fast *fast;
	nt_record *records;  /* x of a complex vertex holds its number, bit by bit */
	size_t vertex_count, corner_count;
	uint32_t *begin;     /* [vertex_count + 1] first place of each vertex */
	uint32_t *items;     /* [corner_count] 3 * triangle + k */
	uint32_t *order;     /* [corner_count] places in the order of triangles */
	uint32_t *across[2]; /* [corner_count] place beyond the edge to the next and from the previous vertex */
	uint32_t *group;     /* [corner_count] or NONE */
	uint32_t *stack;     /* [corner_count] */
	size_t group_count;
	uint32_t *group_begin; /* [group_count + 1] */
	uint32_t *members;   /* [corner_count] places by group, ascending */
	slot *slots;         /* [corner_count] until the halves of quads meet; NULL: written at once */
	member *room;        /* [size of the largest group] */
} complex;

static uint32_t vertex_number(const complex *c, uint32_t vertex)
{
	uint32_t number;
	memcpy(&number, &c->records[vertex].x, sizeof number);
	return number;
}

static bool is_complex(const complex *c, uint32_t vertex)
{
	return c->records[vertex].state == NT_RESULT_COMPLEX;
}

static uint32_t triangle_of(const complex *c, uint32_t place)
{
	return c->items[place] / 3;
}

static uint32_t next_vertex(const complex *c, uint32_t place)
{
	const uint32_t i = c->items[place];
	return c->fast->ids[i % 3 == 2 ? i - 2 : i + 1];
}

static uint32_t previous_vertex(const complex *c, uint32_t place)
{
	const uint32_t i = c->items[place];
	return c->fast->ids[i % 3 == 0 ? i + 2 : i - 1];
}

/* Collecting */

static size_t next_triangle(const complex *c, size_t t)
{
	return nt_fast_next_flagged(c->fast, t, NT_TRIANGLE_COMPLEX);
}

static nmtan_status number_vertices(complex *c)
{
	uint32_t number = 0;
	for (uint32_t v = 0; v < c->fast->vertex_count; v++) {
		if (!is_complex(c, v))
			continue;
		memcpy(&c->records[v].x, &number, sizeof number);
		number++;
	}
	c->begin = nt_scratch_alloc(c->fast->solve->scratch, c->vertex_count + 2, sizeof *c->begin);
	return c->begin ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}

static nmtan_status collect_corners(complex *c)
{
	const nt_fast *fast = c->fast;
	/* counted two places ahead: filling then moves each begin to where it belongs */
	uint32_t *at = c->begin + 1;
	memset(c->begin, 0, (c->vertex_count + 2) * sizeof *c->begin);
	for (size_t t = next_triangle(c, 0); t < fast->triangle_count; t = next_triangle(c, t + 1))
		for (size_t i = 3 * t; i < 3 * t + 3; i++)
			if (is_complex(c, fast->ids[i])) {
				at[vertex_number(c, fast->ids[i]) + 1]++;
				c->corner_count++;
			}
	for (size_t v = 1; v <= c->vertex_count; v++)
		at[v] += at[v - 1];
	nt_scratch *scratch = fast->solve->scratch;
	c->items = nt_scratch_alloc(scratch, c->corner_count, sizeof *c->items);
	c->order = nt_scratch_alloc(scratch, c->corner_count, sizeof *c->order);
	if (!c->items || !c->order)
		return NMTAN_ERROR_MEMORY;
	size_t seen = 0;
	for (size_t t = next_triangle(c, 0); t < fast->triangle_count; t = next_triangle(c, t + 1))
		for (size_t i = 3 * t; i < 3 * t + 3; i++)
			if (is_complex(c, fast->ids[i])) {
				const uint32_t place = at[vertex_number(c, fast->ids[i])]++;
				c->items[place] = (uint32_t)i;
				c->order[seen++] = place;
			}
	return NMTAN_OK;
}

/* Pairing */

/* Above this many corners a vertex is paired by hashing; below, looking at all of them is faster. */
enum { FEW = 24 };

/* The first later corner that is free and has the edge in the other direction. */
static void pair_few(complex *c, uint32_t begin, uint32_t end)
{
	uint32_t next[FEW], previous[FEW];
	for (uint32_t i = begin; i < end; i++) {
		next[i - begin] = next_vertex(c, i);
		previous[i - begin] = previous_vertex(c, i);
	}
	for (uint32_t i = begin; i < end; i++) {
		for (uint32_t j = i + 1; c->across[0][i] == NONE && j < end; j++)
			if (previous[j - begin] == next[i - begin] && c->across[1][j] == NONE) {
				c->across[0][i] = j;
				c->across[1][j] = i;
			}
		for (uint32_t j = i + 1; c->across[1][i] == NONE && j < end; j++)
			if (next[j - begin] == previous[i - begin] && c->across[0][j] == NONE) {
				c->across[1][i] = j;
				c->across[0][j] = i;
			}
	}
}

/* The edges between a hub and one other vertex that wait for a partner: all run the same way, first in,
 * first out. */
typedef struct waiting {
	uint32_t vertex; /* NONE: the entry is empty */
	uint32_t way;    /* index into across */
	uint32_t head, tail;
} waiting;

typedef struct waiting_table {
	waiting *entries;
	uint32_t *after; /* [2 * corners of the largest hub] what waits behind */
	size_t mask;
} waiting_table;

static waiting *find_waiting(const waiting_table *table, uint32_t vertex)
{
	size_t at = (vertex * 0x9e3779b1u) & table->mask;
	while (table->entries[at].vertex != NONE && table->entries[at].vertex != vertex)
		at = (at + 1) & table->mask;
	return &table->entries[at];
}

static void pair_edge(complex *c, const waiting_table *table, uint32_t begin, uint32_t place, uint32_t way,
	uint32_t vertex)
{
	waiting *w = find_waiting(table, vertex);
	if (w->vertex == NONE || w->head == NONE) {
		*w = (waiting){vertex, way, place, place};
		table->after[2 * (place - begin) + way] = NONE;
	} else if (w->way == way) {
		table->after[2 * (w->tail - begin) + way] = place;
		table->after[2 * (place - begin) + way] = NONE;
		w->tail = place;
	} else {
		const uint32_t partner = w->head;
		c->across[way][place] = partner;
		c->across[w->way][partner] = place;
		w->head = table->after[2 * (partner - begin) + w->way];
	}
}

static nmtan_status pair_many(complex *c, uint32_t begin, uint32_t end)
{
	nt_scratch *scratch = c->fast->solve->scratch;
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	size_t size = 64;
	while (size < 4 * (size_t)(end - begin))
		size *= 2;
	waiting_table table = {.mask = size - 1};
	table.entries = nt_scratch_alloc(scratch, size, sizeof *table.entries);
	table.after = nt_scratch_alloc(scratch, end - begin, 2 * sizeof *table.after);
	if (!table.entries || !table.after)
		return NMTAN_ERROR_MEMORY;
	memset(table.entries, 0xff, size * sizeof *table.entries);
	for (uint32_t place = begin; place < end; place++) {
		pair_edge(c, &table, begin, place, 0, next_vertex(c, place));
		pair_edge(c, &table, begin, place, 1, previous_vertex(c, place));
	}
	nt_scratch_back(scratch, mark);
	return NMTAN_OK;
}

static nmtan_status pair_corners(complex *c)
{
	for (int way = 0; way < 2; way++) {
		c->across[way] = nt_scratch_alloc(c->fast->solve->scratch, c->corner_count,
			sizeof *c->across[way]);
		if (!c->across[way])
			return NMTAN_ERROR_MEMORY;
		memset(c->across[way], 0xff, c->corner_count * sizeof *c->across[way]);
	}
	for (size_t v = 0; v < c->vertex_count; v++) {
		nmtan_status status = NMTAN_OK;
		if (c->begin[v + 1] - c->begin[v] <= FEW)
			pair_few(c, c->begin[v], c->begin[v + 1]);
		else
			status = pair_many(c, c->begin[v], c->begin[v + 1]);
		if (status)
			return status;
	}
	return NMTAN_OK;
}

/* Groups */

/* Takes a corner into the group, if it is free and of its orientation. */
static bool join_group(complex *c, uint32_t place, unsigned orient)
{
	if (place == NONE || c->group[place] != NONE)
		return false;
	uint8_t *flags = &c->fast->flags[triangle_of(c, place)];
	if ((*flags & NT_TRIANGLE_ANY) && !(*flags & NT_TRIANGLE_TAKEN))
		*flags = (uint8_t)((*flags & ~NT_TRIANGLE_ORIENT) | orient | NT_TRIANGLE_TAKEN);
	if ((*flags & NT_TRIANGLE_ORIENT) != orient)
		return false;
	c->group[place] = (uint32_t)c->group_count;
	return true;
}

static void flood_group(complex *c, uint32_t seed)
{
	const unsigned orient = c->fast->flags[triangle_of(c, seed)] & NT_TRIANGLE_ORIENT;
	size_t depth = 0;
	c->group[seed] = (uint32_t)c->group_count;
	c->stack[depth++] = seed;
	while (depth > 0) {
		const uint32_t place = c->stack[--depth];
		for (int way = 0; way < 2; way++)
			if (join_group(c, c->across[way][place], orient))
				c->stack[depth++] = c->across[way][place];
	}
	c->group_count++;
}

static nmtan_status find_groups(complex *c)
{
	nt_scratch *scratch = c->fast->solve->scratch;
	c->group = nt_scratch_alloc(scratch, c->corner_count, sizeof *c->group);
	c->stack = nt_scratch_alloc(scratch, c->corner_count, sizeof *c->stack);
	if (!c->group || !c->stack)
		return NMTAN_ERROR_MEMORY;
	memset(c->group, 0xff, c->corner_count * sizeof *c->group);
	for (size_t i = 0; i < c->corner_count; i++) {
		const uint32_t seed = c->order[i];
		const uint8_t flags = c->fast->flags[triangle_of(c, seed)];
		if (!(flags & NT_TRIANGLE_ANY) && c->group[seed] == NONE)
			flood_group(c, seed);
	}
	return NMTAN_OK;
}

/* Members of each group, ascending. */
static nmtan_status sort_members(complex *c, size_t *largest)
{
	nt_scratch *scratch = c->fast->solve->scratch;
	c->group_begin = nt_scratch_alloc(scratch, c->group_count + 2, sizeof *c->group_begin);
	if (!c->group_begin)
		return NMTAN_ERROR_MEMORY;
	c->members = c->stack; /* of the same size, and no longer needed */
	uint32_t *at = c->group_begin + 1;
	memset(c->group_begin, 0, (c->group_count + 2) * sizeof *c->group_begin);
	for (size_t i = 0; i < c->corner_count; i++)
		if (c->group[i] != NONE)
			at[c->group[i] + 1]++;
	*largest = 0;
	for (size_t g = 1; g <= c->group_count; g++) {
		*largest = at[g] > *largest ? at[g] : *largest;
		at[g] += at[g - 1];
	}
	for (uint32_t i = 0; i < c->corner_count; i++)
		if (c->group[i] != NONE)
			c->members[at[c->group[i]]++] = i;
	return NMTAN_OK;
}

/* Averages */

static nt_vec3 load3(const float *p)
{
	return (nt_vec3){p[0], p[1], p[2]};
}

/* Steps 4 and 8 for one corner. */
static member solve_corner(const complex *c, uint32_t place)
{
	const uint32_t item = c->items[place], t = item / 3, k = item % 3;
	const nmtan_mesh *mesh = c->fast->solve->mesh;
	member m = {.triangle = t, .any = c->fast->flags[t] & NT_TRIANGLE_ANY};
	if (m.any)
		return m;
	/* from the mesh: the welded rows lay in the output, which is written by now */
	size_t vertex[3];
	for (size_t i = 0; i < 3; i++)
		vertex[i] = nt_vertex_of(mesh, nt_fast_corner(c->fast, 3 * (size_t)t + i));
	const float *ta = nt_texcoord(mesh, vertex[0]), *tb = nt_texcoord(mesh, vertex[1]),
		    *tc = nt_texcoord(mesh, vertex[2]);
	const float t21x = tb[0] - ta[0], t21y = tb[1] - ta[1];
	const float t31x = tc[0] - ta[0], t31y = tc[1] - ta[1];
	const nt_vec3 pa = load3(nt_position(mesh, vertex[0]));
	const nt_vec3 d1 = nt_vec3_sub(load3(nt_position(mesh, vertex[1])), pa);
	const nt_vec3 d2 = nt_vec3_sub(load3(nt_position(mesh, vertex[2])), pa);
	const float area = t21x * t31y - t21y * t31x, sign = area > 0.0f ? 1.0f : -1.0f;
	nt_vec3 os = nt_vec3_sub(nt_vec3_scale(t31y, d1), nt_vec3_scale(t21y, d2));
	nt_vec3 ot = nt_vec3_add(nt_vec3_scale(-t31x, d1), nt_vec3_scale(t21x, d2));
	const float ls = nt_vec3_length(os), lt = nt_vec3_length(ot);
	os = nt_not_zero(ls) ? nt_vec3_scale(sign / ls, os) : (nt_vec3){0, 0, 0};
	ot = nt_not_zero(lt) ? nt_vec3_scale(sign / lt, ot) : (nt_vec3){0, 0, 0};
	m.mag_s = ls / fabsf(area);
	m.mag_t = lt / fabsf(area);

	const nt_vec3 n = load3(nt_normal(mesh, vertex[k])), p = load3(nt_position(mesh, vertex[k]));
	const nt_vec3 previous = load3(nt_position(mesh, vertex[(k + 2) % 3]));
	const nt_vec3 next = load3(nt_position(mesh, vertex[(k + 1) % 3]));
	const nt_vec3 e1 = nt_vec3_project(n, nt_vec3_sub(previous, p));
	const nt_vec3 e2 = nt_vec3_project(n, nt_vec3_sub(next, p));
	float cosine = nt_vec3_dot(e1, e2);
	cosine = cosine > 1.0f ? 1.0f : cosine < -1.0f ? -1.0f : cosine;
	m.angle = nt_acos(cosine);
	m.u = nt_vec3_project(n, os);
	m.v = nt_vec3_project(n, ot);
	return m;
}

/* Whether two members of a group are averaged together: step 7 with the default threshold. */
static bool belong_together(const complex *c, const member *f, const member *t)
{
	if (f->any || t->any || f->triangle == t->triangle)
		return true;
	const uint32_t low = f->triangle < t->triangle ? f->triangle : t->triangle;
	const uint32_t high = f->triangle < t->triangle ? t->triangle : f->triangle;
	if (high == low + 1 && (c->fast->flags[high] & NT_TRIANGLE_SECOND))
		return true;
	return nt_vec3_dot(f->u, t->u) > -1.0f && nt_vec3_dot(f->v, t->v) > -1.0f;
}

/* The average over the members that belong together with f; f NULL: over all. */
static slot average(const complex *c, const member *members, size_t count, const member *f)
{
	slot sum = {0};
	float angles = 0.0f;
	for (size_t i = 0; i < count; i++) {
		const member *m = &members[i];
		if (m->any || (f && !belong_together(c, f, m)))
			continue;
		sum.os = nt_vec3_add(sum.os, nt_vec3_scale(m->angle, m->u));
		sum.ot = nt_vec3_add(sum.ot, nt_vec3_scale(m->angle, m->v));
		sum.mag_s += m->angle * m->mag_s;
		sum.mag_t += m->angle * m->mag_t;
		angles += m->angle;
	}
	sum.os = nt_vec3_normalise_safe(sum.os);
	sum.ot = nt_vec3_normalise_safe(sum.ot);
	if (angles > 0.0f) {
		sum.mag_s /= angles;
		sum.mag_t /= angles;
	}
	return sum;
}

/* The half-spaces that a vector lies well inside of, one bit each; 0 where it is not nearly a unit vector. */
static unsigned half_spaces(nt_vec3 v)
{
	const float h = 0.1f, squared = nt_vec3_dot(v, v);
	if (!(squared > 0.99f && squared < 1.01f))
		return 0;
	return (v.x > h) | (v.x < -h) << 1 | (v.y > h) << 2 | (v.y < -h) << 3 | (v.z > h) << 4 | (v.z < -h) << 5;
}

/* Whether no two members can have antiparallel directions, by one look at each: see kernel_settle.h. */
static bool no_split(const member *members, size_t count)
{
	unsigned u = 0x3f, v = 0x3f;
	for (size_t i = 0; i < count; i++) {
		if (members[i].any)
			continue;
		u &= half_spaces(members[i].u);
		v &= half_spaces(members[i].v);
	}
	return u && v;
}

static bool whole_group_belongs(const complex *c, const member *members, size_t count, const member *f)
{
	for (size_t i = 0; i < count; i++)
		if (!belong_together(c, f, &members[i]))
			return false;
	return true;
}

static void write_slot(const nt_solve *solve, size_t corner, const slot *s, float sign)
{
	memcpy(solve->tangents + 4 * corner, (float[4]){s->os.x, s->os.y, s->os.z, sign}, 4 * sizeof(float));
	if (solve->bitangents)
		memcpy(solve->bitangents + 3 * corner, (float[3]){s->ot.x, s->ot.y, s->ot.z},
			3 * sizeof(float));
	if (solve->magnitudes)
		memcpy(solve->magnitudes + 2 * corner, (float[2]){s->mag_s, s->mag_t}, 2 * sizeof(float));
}

static float group_sign(const complex *c, uint32_t place)
{
	return c->fast->flags[triangle_of(c, place)] & NT_TRIANGLE_ORIENT ? 1.0f : -1.0f;
}

static void solve_group(complex *c, size_t g)
{
	const uint32_t *places = c->members + c->group_begin[g];
	const size_t count = c->group_begin[g + 1] - c->group_begin[g];
	for (size_t i = 0; i < count; i++)
		c->room[i] = solve_corner(c, places[i]);
	const slot whole = average(c, c->room, count, NULL);
	const bool one = no_split(c->room, count);
	for (size_t i = 0; i < count; i++) {
		const slot result = one || whole_group_belongs(c, c->room, count, &c->room[i])
			? whole : average(c, c->room, count, &c->room[i]);
		if (c->slots)
			c->slots[places[i]] = result;
		else
			write_slot(c->fast->solve, c->items[places[i]], &result, group_sign(c, places[i]));
	}
}

static nmtan_status solve_groups(complex *c)
{
	size_t largest;
	const nmtan_status status = sort_members(c, &largest);
	if (status)
		return status;
	nt_scratch *scratch = c->fast->solve->scratch;
	c->room = nt_scratch_alloc(scratch, largest, sizeof *c->room);
	/* a corner of a triangle has one result, which need not wait: 32 bytes for each corner at a hub */
	if (c->fast->corners)
		c->slots = nt_scratch_alloc(scratch, c->corner_count, sizeof *c->slots);
	if (!c->room || (c->fast->corners && !c->slots))
		return NMTAN_ERROR_MEMORY;
	for (size_t g = 0; g < c->group_count; g++)
		solve_group(c, g);
	return NMTAN_OK;
}

/* Writing */

static bool equal3(nt_vec3 a, nt_vec3 b)
{
	return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* The corner of a quad's diagonal gets two results, one from each half: they are averaged. */
static slot merge_slots(slot a, slot b)
{
	if (a.mag_s == b.mag_s && a.mag_t == b.mag_t && equal3(a.os, b.os) && equal3(a.ot, b.ot))
		return a;
	return (slot){nt_vec3_normalise_safe(nt_vec3_add(a.os, b.os)),
		nt_vec3_normalise_safe(nt_vec3_add(a.ot, b.ot)), 0.5f * (a.mag_s + b.mag_s),
		0.5f * (a.mag_t + b.mag_t)};
}

/* Writes the corner at `place`, and at `other` (NONE: there is none), the other half's corner of the same face
 * vertex. */
static void write_place(const complex *c, uint32_t place, uint32_t other)
{
	const size_t corner = nt_fast_corner(c->fast, c->items[place]);
	const bool first = c->group[place] != NONE, second = other != NONE && c->group[other] != NONE;
	slot result = {{1, 0, 0}, {0, 1, 0}, 1, 1};
	float sign = -1.0f;
	if (first && second) {
		/* the orientation is that of the later group */
		result = merge_slots(c->slots[place], c->slots[other]);
		sign = group_sign(c, c->group[place] > c->group[other] ? place : other);
	} else if (first || second) {
		result = c->slots[first ? place : other];
		sign = group_sign(c, first ? place : other);
	}
	write_slot(c->fast->solve, corner, &result, sign);
}

static void write_corners(const complex *c)
{
	for (size_t v = 0; v < c->vertex_count; v++) {
		for (uint32_t place = c->begin[v]; place < c->begin[v + 1]; place++) {
			const bool paired = c->fast->corners && place + 1 < c->begin[v + 1] &&
				c->fast->corners[c->items[place]] == c->fast->corners[c->items[place + 1]];
			if (c->slots || c->group[place] == NONE)
				write_place(c, place, paired ? place + 1 : NONE);
			place += paired;
		}
	}
}

nmtan_status nt_fast_complex(nt_fast *fast, size_t complex_count)
{
	complex c = {.fast = fast, .vertex_count = complex_count};
	c.records = fast->records[0] ? fast->records[0] : fast->records[1];
	nmtan_status status = number_vertices(&c);
	if (!status)
		status = collect_corners(&c);
	if (!status)
		status = pair_corners(&c);
	if (!status)
		status = find_groups(&c);
	if (!status)
		status = solve_groups(&c);
	if (!status)
		write_corners(&c);
	return status;
}
