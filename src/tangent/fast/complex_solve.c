/* SPDX-License-Identifier: MIT */
/*
 * Averages of groups at complex vertices: steps 7 to 10 of the spec page. Corners are solved SOLVED at a time in the
 * order of groups. Most groups do not split: their members' directions lie within a half-space. Otherwise each member
 * has a sum of its own, in large groups by several threads, which costs the square of the members.
 *
 * Sums of nearly the same members share no work: from the first member on that only one of them has, each adds all the
 * others again, since floats do not associate. MikkTSpace has as many sums, and no shorter way to their bytes is known.
 */
#include "tangent/fast/complex.h"

#include <string.h>
#include "base/deadline.h"
#include "base/parallel.h"
#include "base/vec.h"
#include "tangent/frames.h"
#include "topology/corners.h"

/*
 * Bound of its cost if results are repaired: squares of members, of all large groups of a mesh. Less than half
 * a second on one thread (1.5 ns each), which 8 192 folded quads around a vertex take, and 256 for each corner
 * more, so that time is linear. mikktspace.c takes 16 s and half a gigabyte for these quads: nobody has a mesh with
 * more, whose bytes would be missed. The group whose turn it is then has one sum.
 */
static const uint64_t most_work = (uint64_t)1 << 28, most_work_of_corner = 256;

/* Corners that the kernel gets; vertices by which records are prefetched before they are read. */
enum { SOLVED = 128, AHEAD = 12 };

/* Some members of a group, or of several. */
typedef struct part {
	const uint32_t *members; /* [count] places */
	const nt_corner *solved; /* [count] */
	size_t count;
} part;

/* Solving */

/* The three rows of each corner's triangle, from the mesh. */
static void load_rows(const nt_complex *c, const uint32_t *corners, size_t count, nt_weld_row *rows)
{
	/* copies, which no store to a row may change */
	const nmtan_mesh mesh = *c->fast->solve->mesh;
	const nt_triangles triangles = c->fast->triangles;
	for (size_t i = 0; i < count; i++) {
		const size_t t = (corners[i] & NT_COMPLEX_CORNER) >> 2;
		NT_UNROLL(3)
		for (unsigned k = 0; k < 3; k++)
			nt_weld_load(&mesh, nt_vertex_of(&mesh, nt_triangle_corner(&triangles, t, k)),
				&rows[3 * i + k]);
	}
}

static void solve_members(const nt_complex *c, const uint32_t *members, size_t count, nt_corner *solved)
{
	uint32_t corners[SOLVED];
	nt_weld_row rows[3 * SOLVED];
	for (size_t first = 0; first < count; first += SOLVED) {
		const size_t n = count - first < SOLVED ? count - first : SOLVED;
		for (size_t i = 0; i < n; i++)
			corners[i] = c->corners[members[first + i]];
		load_rows(c, corners, n, rows);
		c->kernels->corners(rows, corners, n, solved + first);
	}
}

/* Members that belong together with one of them although their directions do not: of its face. */
typedef struct own_members {
	uint32_t first, count; /* indices; 0: there are none but by direction */
} own_members;

/* Whether two members of a group are averaged together for their directions: step 7 with the default threshold. */
static inline bool belong_together(const nt_corner *a, const nt_corner *b)
{
	return nt_dot3(a->u, b->u) > -1.0f && nt_dot3(a->v, b->v) > -1.0f;
}

/* Adds all members, or those that belong together with `one`. The angles of their weights are added too. */
static inline NT_ALWAYS_INLINE void add_members(const part *p, const nt_corner *one, own_members own, nt_corner *sum)
{
#if NT_VECTORS
	nt_float4 u, v;
	memcpy(&u, sum->u, sizeof u);
	memcpy(&v, sum->v, sizeof v);
	for (size_t i = 0; i < p->count; i++) {
		const nt_corner *m = &p->solved[i];
		if (m->kind == NT_CORNER_ANY || (one && i - own.first >= own.count && !belong_together(one, m)))
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
#else
	for (size_t i = 0; i < p->count; i++) {
		const nt_corner *m = &p->solved[i];
		if (m->kind == NT_CORNER_ANY || (one && i - own.first >= own.count && !belong_together(one, m)))
			continue;
		for (int k = 0; k < 3; k++) {
			sum->u[k] += m->angle * m->u[k];
			sum->v[k] += m->angle * m->v[k];
		}
		sum->mag_s += m->angle * m->mag_s;
		sum->mag_t += m->angle * m->mag_t;
		sum->angle += m->angle;
	}
#endif
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

/* Two unit vectors less than 89.4 degrees from a third one, the axis, have a dot product of at least
 * 2 * 0.01^2 - 1, well above the -1 at which step 7 parts them. */
static bool is_near(const nt_corner *m, const nt_corner *axis)
{
	return m->kind == NT_CORNER_ANY ||
	       (m->kind == NT_CORNER_UNIT && nt_dot3(m->u, axis->u) > 0.01f && nt_dot3(m->v, axis->v) > 0.01f);
}

static bool belongs_to_all(const part *p, const nt_corner *m)
{
	for (size_t i = 0; i < p->count; i++)
		if (p->solved[i].kind != NT_CORNER_ANY && !belong_together(&p->solved[i], m))
			return false;
	return true;
}

/* The first member with a frame, or any if there is none. */
static const nt_corner *first_with_frame(const part *p)
{
	size_t i = 0;
	while (i + 1 < p->count && p->solved[i].kind == NT_CORNER_ANY)
		i++;
	return &p->solved[i];
}

/* Whether a group certainly does not split. One of two members that do is not near the axis. No more of those are asked
 * than cost little beside sums for all directions: a few in a hub do not make it one that splits. */
static bool is_one(const part *p, const nt_corner *axis)
{
	size_t left = p->count <= NT_LANES ? NT_LANES : p->count / 32;
	if (left > (most_work >> 2) / p->count)
		left = (size_t)((most_work >> 2) / p->count);
	for (size_t i = 0; i < p->count; i++)
		if (!is_near(&p->solved[i], axis) && (left-- == 0 || !belongs_to_all(p, &p->solved[i])))
			return false;
	return true;
}

/* Writing */

/* `mark`: NT_W_OPEN or 0. */
static void write_corner(const nt_complex *c, uint32_t place, const nt_corner *r, uint32_t mark)
{
	const nt_solve *solve = c->fast->solve;
	const size_t corner = nt_complex_corner(c, c->corners[place]);
	const uint32_t w = (c->corners[place] & NT_COMPLEX_PLUS ? NT_RESULT_PLUS : NT_RESULT_MINUS) | mark;
	float sign;
	memcpy(&sign, &w, sizeof sign);
	const float tangent[4] = {r->u[0], r->u[1], r->u[2], sign};
	memcpy(solve->tangents + 4 * corner, tangent, sizeof tangent);
	if (solve->bitangents)
		memcpy(solve->bitangents + 3 * corner, r->v, 3 * sizeof(float));
	if (r->kind == NT_CORNER_SUMMED && solve->summed_instead)
		++*solve->summed_instead;
	if (r->kind == NT_CORNER_SUMMED && solve->faults)
		solve->faults[corner] |= NMTAN_FAULT_SUMMED;
	if (solve->magnitudes)
		solve->magnitudes[2 * corner] = r->mag_s, solve->magnitudes[2 * corner + 1] = r->mag_t;
}

/* The mark of a member's result, and of those of others at its vertex that have the same. */
static uint32_t NT_NOINLINE mark_of(const nt_complex *c, uint32_t place, const nt_corner *r)
{
	const nt_solve *solve = c->fast->solve;
	if (!nt_fast_judges(solve) || nt_is_surely_frame(r->u, nt_normal(solve->mesh,
			nt_vertex_of(solve->mesh, nt_complex_corner(c, c->corners[place])))))
		return 0;
	nt_fast_tell_open(solve);
	return NT_W_OPEN;
}

/* A member's result goes to its corner, or to the batch's results. */
static void put_result(const nt_complex *c, const nt_batch *b, uint32_t place, const nt_corner *r, uint32_t mark)
{
	if (b->results)
		b->results[place - b->first] = *r;
	else
		write_corner(c, place, r, mark);
}

/* The corner of a quad's diagonal gets two results, one from each half: they are averaged. */
static nt_corner merge(const nt_corner *a, const nt_corner *b)
{
	bool equal = a->mag_s == b->mag_s && a->mag_t == b->mag_t;
	nt_corner r = {.mag_s = 0.5f * (a->mag_s + b->mag_s), .mag_t = 0.5f * (a->mag_t + b->mag_t),
		.kind = a->kind == NT_CORNER_SUMMED ? a->kind : b->kind};
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

/* Writes the corner at place i, and j (NT_NONE: there is none), the other half's corner of the same face vertex. */
static void write_halves(const nt_complex *c, const nt_batch *b, uint32_t i, uint32_t j)
{
	const bool first = c->group[i] != NT_NONE, second = j != NT_NONE && c->group[j] != NT_NONE;
	if (first && second) {
		const nt_corner r = merge(&b->results[i - b->first], &b->results[j - b->first]);
		/* the orientation is that of the later group */
		write_corner(c, c->group[i] > c->group[j] ? i : j, &r, 0);
	} else if (first || second) {
		write_corner(c, first ? i : j, &b->results[(first ? i : j) - b->first], 0);
	} else {
		nt_fast_write_unassigned(c->fast, nt_complex_corner(c, c->corners[i]));
	}
}

static void write_quads(const nt_complex *c, const nt_batch *b)
{
	const uint32_t end = b->first + b->count;
	for (uint32_t i = b->first; i < end; i++) {
		const bool two = i + 1 < end &&
			nt_complex_corner(c, c->corners[i]) == nt_complex_corner(c, c->corners[i + 1]);
		write_halves(c, b, i, two ? i + 1 : NT_NONE);
		i += two;
	}
}

/* Parts of groups */

static uint32_t triangle_of(const nt_complex *c, const part *p, size_t i)
{
	return (c->corners[p->members[i]] & NT_COMPLEX_CORNER) >> 2;
}

/* Members of one face belong together whatever their directions are: halves of a quad, which are neighbours, and a
 * member and itself, which a NaN parts from all. Whether that tells two members from others of their directions. */
static bool belongs_by_face(const nt_complex *c, const part *p, size_t first, size_t second)
{
	const uint32_t t = triangle_of(c, p, first), other = triangle_of(c, p, second);
	return (t == other || (t + 1 == other && c->fast->flags[other] & NT_TRIANGLE_SECOND)) &&
	       !belong_together(&p->solved[first], &p->solved[second]);
}

static own_members find_own(const nt_complex *c, const part *p, size_t i)
{
	const size_t first = i > 0 && belongs_by_face(c, p, i - 1, i) ? i - 1 : i;
	const size_t last = i + 1 < p->count && belongs_by_face(c, p, i, i + 1) ? i + 1 : i;
	const bool none = first == last && !belongs_by_face(c, p, i, i);
	return (own_members){(uint32_t)first, none ? 0 : (uint32_t)(last + 1 - first)};
}

typedef struct sum_context {
	const nt_complex *c;
	const part *p;
	nt_corner *sums; /* [members] averages of those that belong together with each */
} sum_context;

/* Averages for members [begin, end). */
static void sum_members(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	const sum_context *s = context;
	for (size_t i = begin; i < end && !nt_deadline_passed(); i++) {
		nt_corner *sum = &s->sums[i];
		*sum = (nt_corner){.kind = NT_CORNER_EXTREME};
		if (s->p->solved[i].kind == NT_CORNER_ANY)
			continue;
		add_members(s->p, &s->p->solved[i], find_own(s->c, s->p, i), sum);
		finish(s->c, sum);
	}
}

/* Groups */

/* Averages a group that certainly does not split. False: it may, and nothing is written. */
static bool average_whole(const nt_complex *c, const nt_batch *b, const part *p, nt_corner *whole)
{
	*whole = (nt_corner){.kind = NT_CORNER_EXTREME};
	add_members(p, NULL, (own_members){0}, whole);
	finish(c, whole);
	if (!is_one(p, first_with_frame(p)))
		return false;
	const uint32_t mark = mark_of(c, p->members[0], whole);
	for (size_t i = 0; i < p->count; i++)
		put_result(c, b, p->members[i], whole, mark);
	return true;
}

/* Averages a group whose members may split. sums: [p->count]. */
static void average_parts(const nt_complex *c, const nt_batch *b, const part *p, const nt_corner *whole,
	nt_corner *sums)
{
	const unsigned threads = p->count > SOLVED ? c->fast->solve->threads : 1;
	sum_context context = {c, p, sums};
	nt_parallel_ranges(threads, p->count, NT_LANES, sum_members, &context);
	for (size_t i = 0; i < p->count && !nt_deadline_passed(); i++) {
		/* a member without a frame belongs to all */
		const nt_corner *result = p->solved[i].kind == NT_CORNER_ANY ? whole : &sums[i];
		put_result(c, b, p->members[i], result, mark_of(c, p->members[i], result));
	}
}

/* The end of the group whose first member of all is `first`. */
static uint32_t end_of_group(const nt_complex *c, const part *all, uint32_t first)
{
	uint32_t end = first;
	while (++end < all->count && c->group[all->members[end]] == c->group[all->members[first]])
		;
	return end;
}

/* Whole groups, SOLVED members at most. */
static void solve_groups(const nt_complex *c, const nt_batch *b, const uint32_t *members, uint32_t count)
{
	nt_corner solved[(int)SOLVED + NT_LANES], sums[SOLVED], whole;
	const part all = {members, solved, count};
	solve_members(c, members, count, solved);
	for (uint32_t first = 0, end; first < count; first = end) {
		end = end_of_group(c, &all, first);
		const part p = {members + first, solved + first, end - first};
		if (!average_whole(c, b, &p, &whole))
			average_parts(c, b, &p, &whole, sums);
	}
}

static void put_sum(const nt_complex *c, const nt_batch *b, const part *p, const nt_corner *whole)
{
	nt_corner sum = *whole;
	sum.kind = NT_CORNER_SUMMED;
	const uint32_t mark = mark_of(c, p->members[0], whole);
	for (size_t i = 0; i < p->count; i++)
		put_result(c, b, p->members[i], &sum, mark);
}

static nmtan_status average_large_parts(const nt_complex *c, const nt_batch *b, const part *p, const nt_corner *whole)
{
	nt_corner *sums = nt_borrowed_alloc(c->memory, p->count, sizeof *sums);
	if (!sums)
		return NMTAN_ERROR_MEMORY;
	const uint64_t work = (uint64_t)p->count * p->count;
	const uint64_t most = most_work + most_work_of_corner * c->fast->solve->corner_count;
	if (c->fast->solve->repair && work > most - c->fast->work) {
		put_sum(c, b, p, whole);
		return NMTAN_OK;
	}
	c->fast->work += work;
	average_parts(c, b, p, whole, sums);
	return nt_deadline_passed() ? NMTAN_ERROR_MEMORY : NMTAN_OK;
}

/* A group of more members. */
static nmtan_status solve_large_group(const nt_complex *c, const nt_batch *b, const uint32_t *members, uint32_t count)
{
	const nt_scratch_mark mark = nt_scratch_here(c->memory->scratch);
	const nt_borrowed memory = *c->memory;
	nt_corner *solved = nt_borrowed_alloc(c->memory, count + NT_LANES, sizeof *solved), whole;
	if (!solved)
		return NMTAN_ERROR_MEMORY;
	const part p = {members, solved, count};
	solve_members(c, members, count, solved);
	const nmtan_status status = average_whole(c, b, &p, &whole) ? NMTAN_OK : average_large_parts(c, b, &p, &whole);
	nt_scratch_back(c->memory->scratch, mark);
	*c->memory = memory;
	return status;
}

/* Batches */

bool nt_batch_make(const nt_complex *c, size_t capacity, nt_batch *b)
{
	const bool quads = c->fast->triangles.cuts;
	*b = (nt_batch){.results = quads ? nt_borrowed_alloc(c->memory, capacity, sizeof *b->results) : NULL};
	return !quads || b->results;
}

/* The batch's corners by group. Their edges are of no use any more, and are as many as members and groups at most:
 * these take their memory. */
static part list_members(const nt_complex *c, const nt_batch *b)
{
	uint32_t *members = c->across + 2 * b->first, *at = members + b->count, count = 0;
	const uint32_t *group = c->group + b->first;
	memset(at, 0, b->group_count * sizeof *at);
	for (uint32_t i = 0; i < b->count; i++)
		if (group[i] != NT_NONE)
			at[group[i]]++;
	for (uint32_t g = 0; g < b->group_count; g++) {
		const uint32_t size = at[g];
		at[g] = count;
		count += size;
	}
	for (uint32_t i = 0; i < b->count; i++)
		if (group[i] != NT_NONE)
			members[at[group[i]]++] = b->first + i;
	return (part){members, NULL, count};
}

nmtan_status nt_solve_batch(const nt_complex *c, nt_batch *b)
{
	const part all = list_members(c, b);
	for (uint32_t first = 0, end; first < all.count; first = end) {
		end = end_of_group(c, &all, first);
		const bool large = end - first > SOLVED;
		for (uint32_t next = end; !large && next < all.count; ) {
			next = end_of_group(c, &all, next);
			if (next - first > SOLVED)
				break;
			end = next;
		}
		if (!large)
			solve_groups(c, b, all.members + first, end - first);
		else if (solve_large_group(c, b, all.members + first, end - first))
			return NMTAN_ERROR_MEMORY;
	}
	if (b->results)
		write_quads(c, b);
	b->count = b->group_count = 0;
	return NMTAN_OK;
}

/* Moves a corner to the batch. Its group's number stands in the place of an edge, which is of no use any more. */
static void add_to_batch(const nt_complex *c, nt_batch *b, uint32_t place)
{
	const uint32_t group = c->group[place], to = b->first + b->count++;
	c->corners[to] = c->corners[place];
	NT_PREFETCH_TO_WRITE(c->fast->solve->tangents + 4 * nt_complex_corner(c, c->corners[to]));
	c->group[to] = group == NT_NONE ? NT_NONE : c->across[2 * group];
}

/* Writes the record of the positive orientation to a corner of a triangle without a frame, to which step 6 has written
 * that of the negative one. */
static void write_record(const nt_complex *c, size_t v, uint32_t corner)
{
	nt_record record = *nt_fast_record(c->fast, 1, c->welded[v]);
	record.state = NT_RESULT_PLUS;
	memcpy(c->fast->solve->tangents + 4 * nt_complex_corner(c, corner), &record, sizeof record);
}

/* Writes what is known of triangles without a frame: that no group has reached them, or the record. */
static void write_frameless(const nt_complex *c, size_t v, const bool done[2])
{
	const uint32_t begin = nt_first_place(c, v), end = nt_last_place(c, v);
	for (uint32_t i = begin; i < end; i++) {
		const uint32_t corner = c->corners[i];
		const bool plus = corner & NT_COMPLEX_PLUS;
		if (c->group[i] == NT_NONE)
			nt_fast_write_unassigned(c->fast, nt_complex_corner(c, corner));
		else if (corner & NT_COMPLEX_ANY && plus && done[1] && !c->single)
			write_record(c, v, corner);
	}
}

nmtan_status nt_take_vertex(const nt_complex *c, nt_batch *b, size_t v)
{
	const uint32_t begin = nt_first_place(c, v), end = nt_last_place(c, v);
	if (!c->single && v + AHEAD < c->vertex_count)
		NT_PREFETCH(nt_fast_record(c->fast, 1, c->welded[v + AHEAD]));
	uint32_t groups[2] = {0}, kinds = 0;
	for (uint32_t i = begin; i < end; i++) {
		groups[(c->corners[i] & NT_COMPLEX_PLUS) != 0] += c->group[i] == i;
		kinds |= c->corners[i];
	}
	const bool sum = !c->more && c->vertices[v] & NT_RESULT_SUM;
	const bool done[2] = {sum && groups[0] < 2, sum && groups[1] < 2};
	if (kinds & NT_COMPLEX_ANY && !b->results)
		write_frameless(c, v, done);
	if (done[0] && done[1])
		return NMTAN_OK;
	if (b->count + (end - begin) > NT_BATCH && nt_solve_batch(c, b))
		return NMTAN_ERROR_MEMORY;
	if (b->count == 0)
		b->first = begin;
	for (uint32_t i = begin; i < end; i++)
		if (c->group[i] == i && !done[(c->corners[i] & NT_COMPLEX_PLUS) != 0])
			c->across[2 * i] = b->group_count++;
	for (uint32_t i = begin; i < end; i++)
		if (!done[(c->corners[i] & NT_COMPLEX_PLUS) != 0] && (c->group[i] != NT_NONE || b->results))
			add_to_batch(c, b, i);
	return NMTAN_OK;
}

/* Not in line: each byte of code is sent to browsers. */
NT_NOINLINE uint64_t nt_fast_flagged(const uint8_t *flags, size_t count, uint8_t flag)
{
	size_t others;
	return nt_flagged(flags, count < NT_FLAG_WORD ? count : NT_FLAG_WORD, flag, 0, &others);
}
