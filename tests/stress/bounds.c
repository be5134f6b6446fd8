/* SPDX-License-Identifier: MIT */
/*
 * See bounds.h. Groups are found with a union of the triangles' corners over paired edges; what is not certain is
 * joined with everything that it may belong to.
 */
#include "bounds.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const double UNIT = 1.0 / 16777216, DEGREES = 57.29577951308232, QUARTER = 90;

/* Numbers between these are normal floats, as exact as others. */
static const double LEAST = 0x1p-124, LARGEST = 0x1p127;

/* Bounds of float's errors on a triangle. */
typedef enum nature {
	CERTAIN,  /* its orientation and frame are the exact ones but for rounding */
	NO_FRAME, /* none: it gives nothing, and connects others of either orientation */
	LOST      /* its orientation is the wrong one, or numbers leave the range of float: all is possible */
} nature;

/* A group, at the number of its first node. */
typedef struct group {
	double t[3], directions, weights; /* exact sum; sums of the conditions of its parts, in units */
	size_t members, lost, connectors;
	double worst_direction, spread; /* in units; in degrees from the sum */
	bool out_of_range, opposites;
} group;

typedef struct edge {
	size_t low, high, node, other; /* welded vertices; the nodes at both of them, low's first */
	bool forward;
} edge;

typedef struct work {
	const oracle_triangle *triangles;
	size_t count;
	size_t *parent; /* [3 count] of node 3 t + k */
	group *groups;  /* [3 count] */
	size_t *next;   /* [3 count] the next node of the same group; count: none */
} work;

static nature nature_of(const oracle_triangle *t)
{
	if (t->float_sign == 0)
		return NO_FRAME;
	return t->float_sign == t->sign && t->least > LEAST && t->largest < LARGEST ? CERTAIN : LOST;
}

static size_t root_of(work *w, size_t node)
{
	while (w->parent[node] != node)
		node = w->parent[node] = w->parent[w->parent[node]];
	return node;
}

static void join(work *w, size_t a, size_t b)
{
	a = root_of(w, a);
	b = root_of(w, b);
	if (a < b)
		w->parent[b] = a;
	else
		w->parent[a] = b;
}

static bool may_join(const oracle_triangle *a, const oracle_triangle *b)
{
	return a->side == b->side || nature_of(a) != CERTAIN || nature_of(b) != CERTAIN;
}

static int compare_edges(const void *left, const void *right)
{
	const edge *a = left, *b = right;
	if (a->low != b->low)
		return a->low < b->low ? -1 : 1;
	if (a->high != b->high)
		return a->high < b->high ? -1 : 1;
	return (a->node > b->node) - (a->node < b->node);
}

/* Edges between the same vertices: the n-th that runs forward meets the n-th that runs backward. */
static void pair_edges(work *w, const edge *run, size_t count)
{
	for (size_t forward = 0, backward = 0;; forward++, backward++) {
		while (forward < count && !run[forward].forward)
			forward++;
		while (backward < count && run[backward].forward)
			backward++;
		if (forward >= count || backward >= count)
			return;
		const edge *f = &run[forward], *b = &run[backward];
		if (!may_join(&w->triangles[f->node / 3], &w->triangles[b->node / 3]))
			continue;
		join(w, f->node, b->node);
		join(w, f->other, b->other);
	}
}

static bool join_neighbours(work *w)
{
	edge *edges = malloc((3 * w->count + 1) * sizeof *edges);
	size_t edge_count = 0;
	for (size_t t = 0; edges && t < w->count; t++) {
		const oracle_triangle *at = &w->triangles[t];
		for (size_t k = 0; at->sound && k < 3; k++) {
			const size_t l = (k + 1) % 3;
			const bool forward = at->vertex[k] < at->vertex[l];
			edges[edge_count++] = forward
				? (edge){at->vertex[k], at->vertex[l], 3 * t + k, 3 * t + l, true}
				: (edge){at->vertex[l], at->vertex[k], 3 * t + l, 3 * t + k, false};
		}
	}
	if (!edges)
		return false;
	qsort(edges, edge_count, sizeof *edges, compare_edges);
	for (size_t begin = 0, end; begin < edge_count; begin = end) {
		for (end = begin + 1; end < edge_count && edges[end].low == edges[begin].low &&
			edges[end].high == edges[begin].high;)
			end++;
		pair_edges(w, edges + begin, end - begin);
	}
	free(edges);
	return true;
}

/* Chains the nodes of each group, from its root on. */
static void list_groups(work *w, size_t nodes)
{
	for (size_t n = 0; n < nodes; n++)
		w->next[n] = SIZE_MAX;
	for (size_t n = nodes; n-- > 0;) {
		const size_t root = root_of(w, n);
		if (root == n)
			continue;
		w->next[n] = w->next[root];
		w->next[root] = n;
	}
}

static double length(const double v[3])
{
	return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double degrees_between(const double a[3], const double b[3])
{
	const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
	return atan2(length(cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * DEGREES;
}

/* A corner's part of a sum. */
static void add_member(group *g, const oracle_triangle *t, size_t k)
{
	const nature is = nature_of(t);
	g->lost += is == LOST;
	g->connectors += is == NO_FRAME;
	if (is != CERTAIN || length(t->at[k].t) == 0)
		return;
	for (int i = 0; i < 3; i++)
		g->t[i] += t->at[k].angle * t->at[k].t[i];
	g->directions += t->at[k].angle * t->at[k].t_condition;
	g->weights += t->at[k].angle_condition;
	g->worst_direction = fmax(g->worst_direction, t->at[k].t_condition);
	g->out_of_range = g->out_of_range || t->least_square < LEAST || t->largest_square > LARGEST;
	g->members++;
}

static void normalise(group *g)
{
	const double size = length(g->t);
	g->directions = size > 0 ? g->directions / size : INFINITY;
	g->weights = size > 0 ? g->weights / size : INFINITY;
	for (int i = 0; i < 3 && size > 0; i++)
		g->t[i] /= size;
}

static void measure_spread(group *g, const oracle_triangle *t, size_t k)
{
	if (nature_of(t) == CERTAIN && length(t->at[k].t) > 0)
		g->spread = length(g->t) > 0 ? fmax(g->spread, degrees_between(g->t, t->at[k].t)) : 180;
}

/* Whether two directions may be opposite in float: then MikkTSpace parts the two members. */
static bool may_be_opposite(const double *a, const double *b, double condition)
{
	const double doubt = 0.05 + MOST_UNITS * UNIT * condition * DEGREES; /* 1 + cosine < 2^-22 at 0.04 degrees */
	return length(a) > 0 && length(b) > 0 && !(degrees_between(a, b) < 180 - doubt);
}

/* Large groups, whose pairs are too many, must keep within a quarter turn of their first member. */
static bool has_opposites(const work *w, size_t root, size_t members)
{
	enum { MOST_PAIRED = 256 };
	for (size_t n = root; n != SIZE_MAX; n = w->next[n])
		for (size_t m = w->next[n]; m != SIZE_MAX; m = w->next[m]) {
			const oracle_triangle *a = &w->triangles[n / 3], *b = &w->triangles[m / 3];
			const size_t i = n % 3, j = m % 3;
			if (may_be_opposite(a->at[i].t, b->at[j].t, a->at[i].t_condition + b->at[j].t_condition) ||
				may_be_opposite(a->at[i].b, b->at[j].b, a->at[i].b_condition + b->at[j].b_condition))
				return true;
			if (members > MOST_PAIRED && !(degrees_between(a->at[i].t, b->at[j].t) < QUARTER &&
				degrees_between(a->at[i].b, b->at[j].b) < QUARTER))
				return true;
			if (members > MOST_PAIRED && w->next[m] == SIZE_MAX)
				return false;
		}
	return false;
}

/* The bound of a corner in group g. A triangle alone whose sign is lost has a wrong w,
 * or is unassigned, and then repair sees it. */
static bound bound_of(const group *g, const oracle_triangle *t, size_t k, bool opposites)
{
	bound b = {.degrees = INFINITY};
	if (nature_of(t) == LOST && g->lost == 1 && g->members == 0 && g->connectors == 0 && length(t->at[k].t) > 0) {
		memcpy(b.t, t->at[k].t, sizeof b.t);
		b.condition = t->at[k].t_condition;
		b.degrees = MOST_UNITS * UNIT * b.condition * DEGREES;
	} else if (g->lost == 0 && g->members > 0) {
		memcpy(b.t, g->t, sizeof b.t);
		const double cap = g->spread < QUARTER
			? g->spread + MOST_UNITS * UNIT * g->worst_direction * DEGREES : INFINITY;
		const bool certain = g->connectors == 0 && !g->out_of_range && !opposites;
		b.condition = g->directions + (g->members > 1 ? g->weights : 0);
		b.degrees = certain ? MOST_UNITS * UNIT * b.condition * DEGREES : INFINITY;
		if (!(b.degrees <= cap)) {
			b.degrees = cap;
			b.condition = 0;
		}
	}
	if (!(b.degrees < QUARTER))
		b = (bound){.degrees = INFINITY};
	return b;
}

/* The side of the corner that is copied: that of w, which a face without orientation takes from what is there. */
static int copied_side(const group sides[2], int sign)
{
	return sign ? sign > 0 : sides[0].members == 0;
}

static const float *position_of(const nmtan_mesh *mesh, size_t corner)
{
	return mesh->positions + 3 * (mesh->indices ? mesh->indices[corner] : corner);
}

/* The corner of a quad's other half, which has size, at the position of corner k of triangle t: what MikkTSpace copies
 * from. SIZE_MAX: none. */
static size_t find_original(const work *w, const nmtan_mesh *mesh, size_t t, size_t k)
{
	for (size_t other = t ? t - 1 : 0; other < w->count && other <= t + 1; other++) {
		const oracle_triangle *a = &w->triangles[t], *b = &w->triangles[other];
		size_t shared = 0, found = SIZE_MAX;
		for (size_t i = 0; i < 9; i++)
			shared += a->corner[i / 3] == b->corner[i % 3];
		for (size_t i = 0; i < 3; i++)
			if (memcmp(position_of(mesh, b->corner[i]), position_of(mesh, a->corner[k]), 12) == 0)
				found = b->corner[i];
		if (shared == 2 && b->sound)
			return found;
	}
	return SIZE_MAX;
}

/* A triangle without size takes the answer of another corner: within the cap of all at its vertex. */
static void bound_copies(work *w, const nmtan_mesh *mesh, const oracle_corner *exact, size_t corner_count,
	bound *bounds)
{
	group *all = calloc(2 * (corner_count + 1), sizeof *all);
	for (size_t t = 0; all && t < w->count; t++)
		for (size_t k = 0; k < 3; k++) {
			const oracle_triangle *at = &w->triangles[t];
			group *g = &all[2 * at->vertex[k]];
			const bool sure = nature_of(at) == CERTAIN;
			if (at->sound)
				for (int side = 0; side < 2; side++)
					if (!sure || side == (at->side > 0))
						add_member(g + side, at, k);
		}
	for (size_t i = 0; all && i < 2 * corner_count; i++)
		normalise(&all[i]);
	for (size_t t = 0; all && t < w->count; t++)
		for (size_t k = 0; k < 3; k++)
			if (w->triangles[t].sound)
				measure_spread(&all[2 * w->triangles[t].vertex[k] + (w->triangles[t].side > 0)],
					&w->triangles[t], k);
	for (size_t t = 0; all && t < w->count; t++)
		for (size_t k = 0; k < 3; k++) {
			const oracle_triangle *at = &w->triangles[t];
			const size_t c = at->corner[k];
			if (at->sound || bounds[c].degrees < INFINITY)
				continue;
			const size_t original = find_original(w, mesh, t, k);
			if (original != SIZE_MAX)
				bounds[c] = bounds[original];
			else
				bounds[c] = bound_of(&all[2 * at->vertex[k] +
					copied_side(&all[2 * at->vertex[k]], exact[c].sign)],
					at, k, true);
		}
	free(all);
}

/* At a quad's corner whose two triangles are in different groups, MikkTSpace writes the average of both answers. */
static bound between(const bound *a, const bound *b)
{
	bound both = *a;
	both.condition = 0;
	both.degrees = fmax(a->degrees, b->degrees) + degrees_between(a->t, b->t);
	return both.degrees < QUARTER ? both : (bound){.degrees = INFINITY};
}

bool find_bounds(const nmtan_mesh *mesh, const oracle_corner *exact, const oracle_triangle *triangles,
	size_t corner_count, bound *bounds)
{
	work w = {.triangles = triangles, .count = oracle_triangle_count(mesh)};
	const size_t nodes = 3 * w.count;
	w.parent = malloc((nodes + 1) * sizeof *w.parent);
	w.groups = calloc(nodes + 1, sizeof *w.groups);
	w.next = malloc((nodes + 1) * sizeof *w.next);
	size_t *root_at = malloc((corner_count + 1) * sizeof *root_at);
	for (size_t n = 0; w.parent && n < nodes; n++)
		w.parent[n] = n;
	const bool done = w.parent && w.groups && w.next && root_at && join_neighbours(&w);
	for (size_t c = 0; done && c < corner_count; c++) {
		bounds[c] = (bound){.degrees = INFINITY};
		root_at[c] = SIZE_MAX;
	}
	for (size_t n = 0; done && n < nodes; n++)
		if (triangles[n / 3].sound)
			add_member(&w.groups[root_of(&w, n)], &triangles[n / 3], n % 3);
	if (done)
		list_groups(&w, nodes);
	for (size_t n = 0; done && n < nodes; n++) {
		normalise(&w.groups[n]);
		w.groups[n].opposites = w.parent[n] == n && has_opposites(&w, n, w.groups[n].members);
	}
	for (size_t n = 0; done && n < nodes; n++)
		measure_spread(&w.groups[root_of(&w, n)], &triangles[n / 3], n % 3);
	for (size_t n = 0; done && n < nodes; n++) {
		const oracle_triangle *t = &triangles[n / 3];
		const size_t root = root_of(&w, n), c = t->corner[n % 3];
		if (!t->sound)
			continue;
		const bound b = bound_of(&w.groups[root], t, n % 3, w.groups[root].opposites);
		bounds[c] = root_at[c] == SIZE_MAX || root_at[c] == root ? b : between(&bounds[c], &b);
		root_at[c] = root;
	}
	if (done)
		bound_copies(&w, mesh, exact, corner_count, bounds);
	free(w.parent);
	free(w.groups);
	free(w.next);
	free(root_at);
	return done;
}
