/* SPDX-License-Identifier: MIT */
/*
 * Ear clipping. G. H. Meisters, "Polygons Have Ears", 1975: a simple polygon of more than three corners
 * has two corners whose triangle with their neighbours holds no other corner; cut one off and go on.
 *
 * The corners are projected along the Newell normal, so the polygon runs counter-clockwise there and a
 * concave one gets its true interior. Cutting an ear changes only whether its two neighbours are ears,
 * so every corner is tested when it is first met and again when a neighbour goes: at most 3n tests.
 * A test looks only at corners that are not strictly convex (every corner in the way implies such a
 * one), and finds them in a k-d tree (J. L. Bentley, "Multidimensional Binary Search Trees Used for
 * Associative Searching", 1975) whose boxes are left out where they lie beyond an edge of the triangle.
 * Cost: n log n for the polygons people draw, stars of long slivers included. A triangle that runs along
 * many boxes without a corner in it visits them all. Combs of 100 000 teeth have many of those: once visits are more
 * than any sound outline of common use needs, convex corners are cut off without a look, and the result is not sound.
 *
 * The walk goes on with the corner behind the ear it has cut, so a convex polygon becomes the fan
 * (0,1,2) (0,2,3) ... that every other tool makes of it.
 *
 * Every triangle of a sound result is counter-clockwise in the plane. If there is no ear (crossing
 * outlines, spikes, repeated points) a corner is cut off all the same and the result is not sound.
 */
#include "scene/values.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "base/memory.h"

/* Polygons up to this size work in a block on the stack; larger ones are rare. */
enum { STACK_CORNERS = 48 };

/* Leaves of the tree hold 4 to 9 corners where there are more than 8, so that half a node for each corner is
 * enough. */
enum { LEAF_CORNERS = 8 };

/* Visits of boxes that a corner may cost for each level of the tree. */
enum { MOST_VISITS = 24 };

enum kind { CONVEX, BLOCKING, GONE };

enum verdict { NO_EAR, EAR, FLAT_EAR };

/* Data of one corner. */
typedef struct corner {
	double x, y; /* in the plane, relative to corner 0 */
	uint32_t previous, next;
	uint32_t leaf; /* of a blocking corner */
	enum kind kind;
} corner;

/* A node of the tree over the blocking corners: a complete binary tree, the children of node i are 2i + 1 and
 * 2i + 2. The members of a node are a range of `members`, halved for its children. */
typedef struct node {
	double low_x, low_y, high_x, high_y;
	uint32_t blocking; /* members that still block */
} node;

typedef struct outline {
	corner *corners;
	size_t count, left;
	double extent; /* the largest |x| or |y|, which bounds their error */

	node *nodes;
	uint32_t *members; /* [member_count] the corners that blocked at first */
	size_t member_count, leaf_depth;
	size_t visits_left;

	/* Corners to test, in order: all of them once, and one more for each that is cut off. */
	uint32_t *queue;
	size_t queue_head, queue_tail;

	uint32_t *triangles;
	bool sound;
} outline;

/* Twice the signed area of a, b, c; 0 within the error of the projection, which is some 1e-16 of the
 * extent in each coordinate. */
static double turn(const outline *o, const corner *a, const corner *b, const corner *c)
{
	const double bx = b->x - a->x, by = b->y - a->y;
	const double cx = c->x - a->x, cy = c->y - a->y;
	const double area = bx * cy - by * cx;
	const double bound = 1e-15 * o->extent * (fabs(bx) + fabs(by) + fabs(cx) + fabs(cy));
	return fabs(area) <= bound ? 0.0 : area;
}

static bool same_point(const corner *a, const corner *b)
{
	return a->x == b->x && a->y == b->y;
}

/* The position of a corner of a polygon. */
static const float *position(const float (*points)[3], const uint32_t *vertices, size_t i)
{
	return points[vertices ? vertices[i] : i];
}

/* Newell's normal: its components are twice the areas of the polygon's shadows on the axis planes, and
 * no single bad corner spoils it. False where it is zero or not finite. */
static bool newell_normal(const float (*points)[3], const uint32_t *vertices, size_t count, double normal[3])
{
	const float *const first = position(points, vertices, 0);
	double sum[3] = {0, 0, 0};
	for (size_t i = 0; i < count; i++) {
		double a[3], b[3];
		const float *p = position(points, vertices, i);
		const float *q = position(points, vertices, i + 1 < count ? i + 1 : 0);
		for (int k = 0; k < 3; k++) {
			a[k] = (double)p[k] - first[k];
			b[k] = (double)q[k] - first[k];
		}
		for (int k = 0; k < 3; k++)
			sum[k] += a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
	}
	const double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
	if (!(length > 0) || !isfinite(length))
		return false;
	for (int k = 0; k < 3; k++)
		normal[k] = sum[k] / length;
	return true;
}

/* Two unit vectors that make a right-handed frame with the normal. For a normal along an axis they are
 * axes too, and the projection is exact. */
static void plane_axes(const double normal[3], double u[3], double v[3])
{
	int axis = 0; /* the largest component */
	for (int k = 1; k < 3; k++)
		if (fabs(normal[k]) > fabs(normal[axis]))
			axis = k;
	const int other = (axis + 1) % 3, third = (axis + 2) % 3;
	const double length = hypot(normal[axis], normal[other]);
	u[other] = fabs(normal[axis]) / length;
	u[axis] = -normal[other] / length * (normal[axis] < 0 ? -1 : 1);
	u[third] = 0;
	for (int k = 0; k < 3; k++)
		v[k] = normal[(k + 1) % 3] * u[(k + 2) % 3] - normal[(k + 2) % 3] * u[(k + 1) % 3];
}

/* Fills the corners' coordinates and links. False where the polygon has no plane. */
static bool project(outline *o, const float (*points)[3], const uint32_t *vertices)
{
	double normal[3], u[3], v[3];
	if (!newell_normal(points, vertices, o->count, normal))
		return false;
	plane_axes(normal, u, v);
	const uint32_t count = (uint32_t)o->count;
	const float *const first = position(points, vertices, 0);
	for (uint32_t i = 0; i < count; i++) {
		const float *const own = position(points, vertices, i);
		double p[3];
		for (int k = 0; k < 3; k++)
			p[k] = (double)own[k] - first[k];
		corner *c = &o->corners[i];
		c->x = p[0] * u[0] + p[1] * u[1] + p[2] * u[2];
		c->y = p[0] * v[0] + p[1] * v[1] + p[2] * v[2];
		c->previous = i ? i - 1 : count - 1;
		c->next = i + 1 < count ? i + 1 : 0;
		o->extent = fmax(o->extent, fmax(fabs(c->x), fabs(c->y)));
	}
	return true;
}

static double coordinate(const outline *o, uint32_t member, bool along_y)
{
	const corner *c = &o->corners[member];
	return along_y ? c->y : c->x;
}

/* Puts the members of a range in such an order that none of the first `left` lies behind one of the others
 * (C. A. R. Hoare, "Find", 1961). */
static void part_members(outline *o, uint32_t *members, size_t count, size_t left, bool along_y)
{
	while (count > 1) {
		const double pivot = coordinate(o, members[count / 2], along_y);
		size_t l = 0, r = count - 1;
		for (;;) {
			while (coordinate(o, members[l], along_y) < pivot)
				l++;
			while (coordinate(o, members[r], along_y) > pivot)
				r--;
			if (l >= r)
				break;
			const uint32_t swapped = members[l];
			members[l++] = members[r];
			members[r--] = swapped;
		}
		/* [0, l) is at most the pivot, [l, count) at least */
		if (left == l)
			return;
		if (left < l) {
			count = l;
		} else {
			members += l;
			left -= l;
			count -= l;
		}
	}
}

static node box_of(const outline *o, const uint32_t *members, size_t count)
{
	node box = {DBL_MAX, DBL_MAX, -DBL_MAX, -DBL_MAX, (uint32_t)count};
	for (size_t i = 0; i < count; i++) {
		const corner *c = &o->corners[members[i]];
		box.low_x = fmin(box.low_x, c->x);
		box.low_y = fmin(box.low_y, c->y);
		box.high_x = fmax(box.high_x, c->x);
		box.high_y = fmax(box.high_y, c->y);
	}
	return box;
}

/* Builds the node `at` over a range of the members. Depth: at most log2 of the corner count. */
static void build_node(outline *o, size_t at, size_t depth, uint32_t *members, size_t count)
{
	o->nodes[at] = box_of(o, members, count);
	if (depth == o->leaf_depth) {
		for (size_t i = 0; i < count; i++)
			o->corners[members[i]].leaf = (uint32_t)at;
		return;
	}
	const node *box = &o->nodes[at];
	part_members(o, members, count, count / 2, box->high_y - box->low_y > box->high_x - box->low_x);
	build_node(o, 2 * at + 1, depth + 1, members, count / 2);
	build_node(o, 2 * at + 2, depth + 1, members + count / 2, count - count / 2);
}

/* Marks the corners that are not strictly convex and builds the tree over them. */
static void find_blocking(outline *o)
{
	for (size_t i = 0; i < o->count; i++) {
		corner *c = &o->corners[i];
		const bool convex = turn(o, &o->corners[c->previous], c, &o->corners[c->next]) > 0;
		c->kind = convex ? CONVEX : BLOCKING;
		if (!convex)
			o->members[o->member_count++] = (uint32_t)i;
	}
	while (o->member_count >> o->leaf_depth > LEAF_CORNERS)
		o->leaf_depth++;
	o->visits_left = MOST_VISITS * o->count * (o->leaf_depth + 1);
	build_node(o, 0, 0, o->members, o->member_count);
}

/* A corner blocks no more. */
static void stop_blocking(outline *o, const corner *c)
{
	for (size_t at = c->leaf;; at = (at - 1) / 2) {
		o->nodes[at].blocking--;
		if (at == 0)
			return;
	}
}

/* Whether the outline leaves the point w, which is the point of corner b of the triangle a, b, c, into
 * that triangle. Outlines touch themselves where a hole is joined to them by a bridge. */
static bool enters(const outline *o, const corner *w, const corner *a, const corner *b,
	const corner *c)
{
	const corner *ends[2] = {&o->corners[w->previous], &o->corners[w->next]};
	for (int k = 0; k < 2; k++)
		if (turn(o, b, c, ends[k]) > 0 && turn(o, a, b, ends[k]) > 0)
			return true;
	return false;
}

/* Whether corner w keeps the counter-clockwise triangle a, b, c from being cut off: it lies inside or
 * on its rim, so that a corner in the middle of a straight edge keeps its own triangle. */
static bool blocks(const outline *o, const corner *w, const corner *a, const corner *b,
	const corner *c)
{
	if (w == a || w == b || w == c)
		return false;
	if (turn(o, a, b, w) < 0 || turn(o, b, c, w) < 0 || turn(o, c, a, w) < 0)
		return false;
	if (same_point(w, a))
		return enters(o, w, c, a, b);
	if (same_point(w, b))
		return enters(o, w, a, b, c);
	if (same_point(w, c))
		return enters(o, w, b, c, a);
	return true;
}

/* Whether every point of the box lies strictly to the right of the line from a to b: the corner of the box that
 * lies farthest to its left does. */
static bool box_is_beyond(const outline *o, const node *box, const corner *a, const corner *b)
{
	const corner farthest = {.x = b->y < a->y ? box->high_x : box->low_x,
		.y = b->x > a->x ? box->high_y : box->low_y};
	return turn(o, a, b, &farthest) < 0;
}

/* A triangle that may be cut off, and its box. */
typedef struct ear {
	const corner *a, *b, *c;
	node box;
} ear;

/* Whether a blocking corner among `count` members of the node `at` lies in the triangle. */
static bool node_blocks(outline *o, size_t at, size_t depth, const uint32_t *members, size_t count,
	const ear *t)
{
	const node *box = &o->nodes[at];
	if (box->blocking == 0 || o->visits_left == 0)
		return false;
	o->visits_left--;
	if (t->box.high_x < box->low_x || t->box.low_x > box->high_x || t->box.high_y < box->low_y ||
		t->box.low_y > box->high_y || box_is_beyond(o, box, t->a, t->b) ||
		box_is_beyond(o, box, t->b, t->c) || box_is_beyond(o, box, t->c, t->a))
		return false;
	if (depth < o->leaf_depth)
		return node_blocks(o, 2 * at + 1, depth + 1, members, count / 2, t) ||
			node_blocks(o, 2 * at + 2, depth + 1, members + count / 2, count - count / 2, t);
	for (size_t i = 0; i < count; i++) {
		const corner *w = &o->corners[members[i]];
		if (w->kind == BLOCKING && blocks(o, w, t->a, t->b, t->c))
			return true;
	}
	return false;
}

static bool triangle_is_blocked(outline *o, uint32_t at)
{
	const uint32_t corners[3] = {o->corners[at].previous, at, o->corners[at].next};
	const ear t = {&o->corners[corners[0]], &o->corners[at], &o->corners[corners[2]],
		box_of(o, corners, 3)};
	return node_blocks(o, 0, 0, o->members, o->member_count, &t);
}

/* A spike or a repeated point is a flat ear: no later cut makes it better. A corner in the middle of a
 * straight edge is none: it gets its triangle when a neighbour has gone. */
static enum verdict verdict_of(outline *o, uint32_t at)
{
	const corner *b = &o->corners[at];
	const corner *a = &o->corners[b->previous], *c = &o->corners[b->next];
	const double area = turn(o, a, b, c);
	if (area > 0)
		return triangle_is_blocked(o, at) ? NO_EAR : EAR;
	if (area < 0)
		return NO_EAR;
	const double along = (b->x - a->x) * (c->x - b->x) + (b->y - a->y) * (c->y - b->y);
	return along > 0 ? NO_EAR : FLAT_EAR;
}

static void update_kind(outline *o, corner *c)
{
	if (c->kind != BLOCKING)
		return;
	if (turn(o, &o->corners[c->previous], c, &o->corners[c->next]) > 0) {
		c->kind = CONVEX;
		stop_blocking(o, c);
	}
}

/* Writes the triangle of a corner and takes the corner out. Returns the corner behind it. */
static uint32_t cut(outline *o, uint32_t at)
{
	corner *b = &o->corners[at];
	corner *a = &o->corners[b->previous], *c = &o->corners[b->next];
	*o->triangles++ = b->previous;
	*o->triangles++ = at;
	*o->triangles++ = b->next;
	o->left--;
	if (b->kind == BLOCKING)
		stop_blocking(o, b);
	b->kind = GONE;
	a->next = b->next;
	c->previous = b->previous;
	update_kind(o, a);
	update_kind(o, c);
	o->queue[o->queue_tail++] = b->previous;
	return b->next;
}

/* The next corner to test: false when all that are left have been tested. */
static bool take(outline *o, uint32_t *at)
{
	while (o->queue_head < o->queue_tail) {
		const uint32_t candidate = o->queue[o->queue_head++];
		if (o->corners[candidate].kind != GONE) {
			*at = candidate;
			return true;
		}
	}
	return false;
}

static void clip_ears(outline *o)
{
	for (size_t i = 2; i <= o->count; i++)
		o->queue[o->queue_tail++] = (uint32_t)(i % o->count);
	uint32_t at = 1;
	while (o->left > 3) {
		const enum verdict verdict = verdict_of(o, at);
		o->sound &= o->visits_left > 0;
		if (verdict == EAR) {
			at = cut(o, at);
		} else if (verdict == FLAT_EAR || !take(o, &at)) {
			o->sound = false;
			at = cut(o, at);
		}
	}
	const corner *b = &o->corners[at];
	if (!(turn(o, &o->corners[b->previous], b, &o->corners[b->next]) > 0))
		o->sound = false;
	cut(o, at);
}

static void fan(size_t count, uint32_t *triangles)
{
	for (size_t i = 1; i + 1 < count; i++) {
		*triangles++ = 0;
		*triangles++ = (uint32_t)i;
		*triangles++ = (uint32_t)(i + 1);
	}
}

nt_status nt_polygon_triangulate(const float (*points)[3], const uint32_t *vertices, size_t count, uint32_t *triangles,
	bool *sound)
{
	corner stack_corners[STACK_CORNERS];
	uint32_t stack_numbers[3 * STACK_CORNERS];
	node stack_nodes[STACK_CORNERS / 2];
	const bool large = count > STACK_CORNERS;
	corner *corners = large ? nt_alloc(count, sizeof *corners) : stack_corners;
	uint32_t *numbers = large ? nt_alloc(count, 3 * sizeof *numbers) : stack_numbers;
	node *nodes = large ? nt_alloc(count / 2, sizeof *nodes) : stack_nodes;
	nt_status status = NT_ERROR_MEMORY;
	if (!corners || !numbers || !nodes)
		goto out;

	outline o = {
		.corners = corners,
		.count = count,
		.left = count,
		.nodes = nodes,
		.members = numbers,
		.queue = numbers + count, /* [2 * count] */
		.triangles = triangles,
		.sound = true,
	};
	if (project(&o, points, vertices)) {
		find_blocking(&o);
		clip_ears(&o);
	} else {
		fan(count, triangles);
		o.sound = false;
	}
	*sound = o.sound;
	status = NT_OK;
out:
	if (large) {
		free(corners);
		free(numbers);
		free(nodes);
	}
	return status;
}
