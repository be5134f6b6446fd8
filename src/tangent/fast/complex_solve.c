/* SPDX-License-Identifier: MIT */
/*
 * Averages of groups at complex vertices: steps 7 to 10 of the spec page. Corners are solved NT_SOLVED at a time in the
 * order of groups. Most groups do not split: their members' directions lie within a half-space, or at least no one
 * is antiparallel to the few outside of it. Otherwise a member that belongs to a part of its group has a sum of its own.
 */
#include "tangent/fast/complex_solve.h"

#include <string.h>
#include "base/vec.h"

/* Some members of a group. */
typedef struct part {
	const uint32_t *members; /* [count] */
	const nt_corner *solved; /* [count] */
	size_t count;
} part;

/* Solving */

static void solve_members(const nt_complex *c, const nt_batch *b, const uint32_t *members, size_t count,
	nt_corner *solved)
{
	uint32_t corners[NT_SOLVED];
	for (size_t first = 0; first < count; first += NT_SOLVED) {
		const size_t n = count - first < NT_SOLVED ? count - first : NT_SOLVED;
		for (size_t i = 0; i < n; i++)
			corners[i] = b->corners[members[first + i]];
		c->kernels->corners(c->fast, corners, n, solved + first);
	}
}

static uint32_t triangle_of(const nt_batch *b, const part *p, size_t i)
{
	return b->corners[p->members[i]] >> 2;
}

/* Whether two members belong together whatever their directions are: without a frame, or of one face. */
static bool always_belong(const nt_complex *c, const nt_batch *b, const part *p, size_t i, const part *q, size_t j)
{
	if (p->solved[i].kind == NT_CORNER_ANY || q->solved[j].kind == NT_CORNER_ANY)
		return true;
	const uint32_t pt = triangle_of(b, p, i), qt = triangle_of(b, q, j);
	const uint32_t first = pt < qt ? pt : qt, second = pt < qt ? qt : pt;
	return first == second || (second == first + 1 && (c->fast->flags[second] & NT_TRIANGLE_SECOND));
}

/* Whether two members of a group, one of part p and one of part q, are averaged together: step 7 with the default
 * threshold. */
static inline bool belong_together(const nt_complex *c, const nt_batch *b, const part *p, size_t i, const part *q,
	size_t j)
{
	const nt_corner *f = &p->solved[i], *t = &q->solved[j];
	const bool parted = !(nt_dot3(f->u, t->u) > -1.0f) || !(nt_dot3(f->v, t->v) > -1.0f);
	return !parted || always_belong(c, b, p, i, q, j);
}

/* Adds members, or those of them that belong together with member f; NT_NONE: all. The angles of their weights
 * are added too. */
static void add_members(const nt_complex *c, const nt_batch *b, const part *p, size_t f, nt_corner *sum)
{
	nt_float4 u, v;
	memcpy(&u, sum->u, sizeof u);
	memcpy(&v, sum->v, sizeof v);
	for (size_t i = 0; i < p->count; i++) {
		const nt_corner *m = &p->solved[i];
		if (m->kind == NT_CORNER_ANY || (f != NT_NONE && !belong_together(c, b, p, f, p, i)))
			continue;
		nt_float4 mu, mv;
		memcpy(&mu, m->u, sizeof mu);
		memcpy(&mv, m->v, sizeof mv);
		u += m->angle * mu;
		v += m->angle * mv;
		sum->angle += m->angle;
	}
	memcpy(sum->u, &u, sizeof u);
	memcpy(sum->v, &v, sizeof v);
}

static void normalise_safe(float v[3])
{
	const nt_vec3 n = nt_vec3_normalise_safe((nt_vec3){v[0], v[1], v[2]});
	v[0] = n.x, v[1] = n.y, v[2] = n.z;
}

/* From a sum to the average. */
static void finish(const nt_complex *c, nt_corner *total)
{
	normalise_safe(total->u);
	if (!c->more)
		return;
	normalise_safe(total->v);
	if (total->angle > 0.0f) {
		total->mag_s /= total->angle;
		total->mag_t /= total->angle;
	}
}

/* The first member with a frame, or any if there is none. */
static const nt_corner *first_with_frame(const part *p)
{
	size_t i = 0;
	while (i + 1 < p->count && p->solved[i].kind == NT_CORNER_ANY)
		i++;
	return &p->solved[i];
}

/* Two unit vectors less than 89.4 degrees from a third one, the axis, have a dot product of at least
 * 2 * 0.01^2 - 1, well above the -1 at which step 7 parts them. */
static bool is_near(const nt_corner *m, const nt_corner *axis)
{
	return m->kind == NT_CORNER_ANY ||
	       (m->kind == NT_CORNER_UNIT && nt_dot3(m->u, axis->u) > 0.01f && nt_dot3(m->v, axis->v) > 0.01f);
}

/* Whether member f belongs together with all. */
static bool belongs_to_all(const nt_complex *c, const nt_batch *b, const part *p, size_t f)
{
	for (size_t i = 0; i < p->count; i++)
		if (!belong_together(c, b, p, i, p, f))
			return false;
	return true;
}

/* Whether a group does not split. Of two members that do one is not near the axis. */
static bool is_one(const nt_complex *c, const nt_batch *b, const part *p)
{
	const nt_corner *axis = first_with_frame(p);
	for (size_t i = 0; i < p->count; i++)
		if (!is_near(&p->solved[i], axis) && !belongs_to_all(c, b, p, i))
			return false;
	return true;
}

/* Writing */

static size_t mesh_corner(const nt_complex *c, const nt_batch *b, uint32_t i)
{
	return nt_triangle_corner(&c->fast->triangles, b->corners[i] >> 2, b->corners[i] & 3);
}

static void write_corner(const nt_complex *c, size_t corner, const nt_corner *r, float sign)
{
	const nt_solve *solve = c->fast->solve;
	memcpy(solve->tangents + 4 * corner, (float[4]){r->u[0], r->u[1], r->u[2], sign}, 4 * sizeof(float));
	if (solve->bitangents)
		memcpy(solve->bitangents + 3 * corner, r->v, 3 * sizeof(float));
	if (solve->magnitudes)
		memcpy(solve->magnitudes + 2 * corner, (float[2]){r->mag_s, r->mag_t}, 2 * sizeof(float));
}

/* The orientation of a corner that a group has: its triangle's, which is its group's. Where only one orientation
 * occurs, triangles without a frame are not decided. */
static int orientation_of(const nt_complex *c, const nt_batch *b, uint32_t i)
{
	return c->single ? c->orient : c->fast->flags[b->corners[i] >> 2] & NT_TRIANGLE_ORIENT;
}

static float sign_of(const nt_complex *c, const nt_batch *b, uint32_t i)
{
	return orientation_of(c, b, i) ? 1.0f : -1.0f;
}

/* A member's result goes to its corner, or to the batch's results. */
static void put_result(const nt_complex *c, const nt_batch *b, uint32_t i, const nt_corner *r)
{
	if (b->results)
		b->results[i] = *r;
	else
		write_corner(c, mesh_corner(c, b, i), r, sign_of(c, b, i));
}

/* A corner that no group reached keeps the default: step 10. */
static const nt_corner untouched = {.u = {1, 0, 0}, .mag_s = 1, .v = {0, 1, 0}, .mag_t = 1};

static void write_untouched(const nt_complex *c, const nt_batch *b)
{
	for (uint32_t i = 0; i < b->count; i++)
		if (b->group[i] == NT_NONE)
			write_corner(c, mesh_corner(c, b, i), &untouched, nt_unassigned_sign(c->fast->solve));
}

void nt_write_sums(const nt_complex *c, nt_batch *b, size_t v)
{
	if (!(c->vertices[v] & NT_RESULT_SUM))
		return;
	const nt_fast *fast = c->fast;
	const uint32_t begin = nt_first_place(c, v) - b->first, end = nt_last_place(c, v) - b->first;
	/* the first group of each orientation; NT_WRITTEN: there are more */
	uint32_t groups[2] = {NT_NONE, NT_NONE};
	for (uint32_t i = begin; i < end; i++) {
		uint32_t *group = &groups[orientation_of(c, b, i)];
		if (b->group[i] != NT_NONE)
			*group = *group == NT_NONE || *group == b->group[i] ? b->group[i] : NT_WRITTEN;
	}
	const uint32_t vertex = fast->triangles.ids[mesh_corner(c, b, begin)];
	for (uint32_t i = begin; i < end; i++) {
		const int orient = orientation_of(c, b, i);
		if (b->group[i] == NT_NONE || b->group[i] != groups[orient])
			continue;
		nt_record record = *nt_fast_record(fast, orient, vertex);
		record.state = orient ? NT_RESULT_PLUS : NT_RESULT_MINUS;
		memcpy(fast->solve->tangents + 4 * mesh_corner(c, b, i), &record, sizeof record);
		b->group[i] = NT_WRITTEN;
	}
}

/* The corner of a quad's diagonal gets two results, one from each half: they are averaged. */
static nt_corner merge(const nt_corner *a, const nt_corner *b)
{
	bool equal = a->mag_s == b->mag_s && a->mag_t == b->mag_t;
	nt_corner r = {.mag_s = 0.5f * (a->mag_s + b->mag_s), .mag_t = 0.5f * (a->mag_t + b->mag_t)};
	for (int i = 0; i < 3; i++) {
		equal = equal && a->u[i] == b->u[i] && a->v[i] == b->v[i];
		r.u[i] = a->u[i] + b->u[i];
		r.v[i] = a->v[i] + b->v[i];
	}
	if (equal)
		return *a;
	normalise_safe(r.u);
	normalise_safe(r.v);
	return r;
}

/* Writes the corner i, and j (NT_NONE: there is none), the other half's corner of the same face vertex. */
static void write_halves(const nt_complex *c, const nt_batch *b, uint32_t i, uint32_t j)
{
	const bool first = b->group[i] != NT_NONE, second = j != NT_NONE && b->group[j] != NT_NONE;
	const size_t corner = mesh_corner(c, b, i);
	if (first && second) {
		const nt_corner r = merge(&b->results[i], &b->results[j]);
		/* the orientation is that of the later group */
		write_corner(c, corner, &r, sign_of(c, b, b->group[i] > b->group[j] ? i : j));
	} else if (first || second) {
		write_corner(c, corner, &b->results[first ? i : j], sign_of(c, b, first ? i : j));
	} else {
		write_corner(c, corner, &untouched, nt_unassigned_sign(c->fast->solve));
	}
}

static void write_quads(const nt_complex *c, const nt_batch *b)
{
	for (uint32_t i = 0; i < b->count; i++) {
		const bool two = i + 1 < b->count && mesh_corner(c, b, i) == mesh_corner(c, b, i + 1);
		write_halves(c, b, i, two ? i + 1 : NT_NONE);
		i += two;
	}
}

/* Groups */

/* A group, all of whose members are solved. */
static void average_group(const nt_complex *c, const nt_batch *b, const part *p)
{
	nt_corner whole = {.kind = NT_CORNER_EXTREME};
	add_members(c, b, p, NT_NONE, &whole);
	finish(c, &whole);
	const bool one = is_one(c, b, p);
	for (size_t i = 0; i < p->count; i++) {
		if (one || belongs_to_all(c, b, p, i)) {
			put_result(c, b, p->members[i], &whole);
			continue;
		}
		nt_corner own = {.kind = NT_CORNER_EXTREME};
		add_members(c, b, p, i, &own);
		finish(c, &own);
		put_result(c, b, p->members[i], &own);
	}
}

/* Groups [first, end), NT_SOLVED members together. */
static void solve_groups(const nt_complex *c, const nt_batch *b, uint32_t first, uint32_t end)
{
	nt_corner solved[NT_SOLVED + NT_LANES];
	const uint32_t begin = b->bounds[first];
	solve_members(c, b, b->members + begin, b->bounds[end] - begin, solved);
	for (uint32_t g = first; g < end; g++) {
		const part p = {b->members + b->bounds[g], solved + (b->bounds[g] - begin),
			b->bounds[g + 1] - b->bounds[g]};
		average_group(c, b, &p);
	}
}

/* The same for a group of more members, of which few at a time are solved: those that are not near the axis are kept. */
typedef struct outliers {
	uint32_t members[NT_SOLVED];
	nt_corner solved[NT_SOLVED];
	size_t count;
} outliers;

/* False: they are too many. */
static bool add_outliers(const part *p, const nt_corner *axis, outliers *o)
{
	for (size_t i = 0; i < p->count; i++) {
		if (is_near(&p->solved[i], axis))
			continue;
		if (o->count == NT_SOLVED)
			return false;
		o->members[o->count] = p->members[i];
		o->solved[o->count++] = p->solved[i];
	}
	return true;
}

/* Whether no member splits from an outlier. Where that holds for all members no two of them split. */
static bool no_outlier_splits(const nt_complex *c, const nt_batch *b, const part *p, const outliers *o)
{
	const part others = {o->members, o->solved, o->count};
	for (size_t j = 0; j < o->count; j++)
		for (size_t i = 0; i < p->count; i++)
			if (!belong_together(c, b, p, i, &others, j))
				return false;
	return true;
}

/* Whether a large group does not split, and if so its sum. */
static bool add_large_group(const nt_complex *c, const nt_batch *b, const uint32_t *members, size_t count,
	nt_corner *sum)
{
	nt_corner solved[NT_SOLVED + NT_LANES], axis = {.kind = NT_CORNER_ANY};
	outliers o;
	o.count = 0;
	for (int round = 0; round < 2; round++) {
		for (size_t first = 0; first < count; first += NT_SOLVED) {
			const part p = {members + first, solved, count - first < NT_SOLVED ? count - first : NT_SOLVED};
			solve_members(c, b, p.members, p.count, solved);
			if (axis.kind == NT_CORNER_ANY)
				axis = *first_with_frame(&p);
			if (round == 0 ? !add_outliers(&p, &axis, &o) : !no_outlier_splits(c, b, &p, &o))
				return false;
			if (round == 0)
				add_members(c, b, &p, NT_NONE, sum);
		}
		if (o.count == 0)
			break;
	}
	return true;
}

/* All members are kept only if they may split. */
static nmtan_status solve_large_group(const nt_complex *c, const nt_batch *b, uint32_t group)
{
	const uint32_t *members = b->members + b->bounds[group];
	const size_t count = b->bounds[group + 1] - b->bounds[group];
	nt_corner whole = {.kind = NT_CORNER_EXTREME};
	if (add_large_group(c, b, members, count, &whole)) {
		finish(c, &whole);
		for (size_t i = 0; i < count; i++)
			put_result(c, b, members[i], &whole);
		return NMTAN_OK;
	}
	const nt_scratch_mark mark = nt_scratch_here(c->memory->scratch);
	const nt_borrowed memory = *c->memory;
	nt_corner *solved = nt_borrowed_alloc(c->memory, count + NT_LANES, sizeof *solved);
	if (!solved)
		return NMTAN_ERROR_MEMORY;
	solve_members(c, b, members, count, solved);
	const part p = {members, solved, count};
	average_group(c, b, &p);
	nt_scratch_back(c->memory->scratch, mark);
	*c->memory = memory;
	return NMTAN_OK;
}

nmtan_status nt_solve_batch(const nt_complex *c, const nt_batch *b)
{
	for (uint32_t g = 0, end; g < b->group_count; g = end) {
		for (end = g; end < b->group_count && b->bounds[end + 1] - b->bounds[g] <= NT_SOLVED;)
			end++;
		if (end > g)
			solve_groups(c, b, g, end);
		else if (solve_large_group(c, b, end++))
			return NMTAN_ERROR_MEMORY;
	}
	if (b->results)
		write_quads(c, b);
	else
		write_untouched(c, b);
	return NMTAN_OK;
}
