/* SPDX-License-Identifier: MIT */
/*
 * Ear clipping. G. H. Meisters, "Polygons Have Ears", 1975: a simple polygon of more than three corners
 * has two corners whose triangle with their neighbours holds no other corner; cut one off and go on.
 *
 * The corners are projected along the Newell normal, so the polygon runs counter-clockwise there and a
 * concave one gets its true interior. Cutting an ear changes only whether its two neighbours are ears,
 * so every corner is tested when it is first met and again when a neighbour goes: at most 3n tests.
 * A test looks only at corners that are not strictly convex (every corner in the way implies such a
 * one), and finds them in a uniform grid. Cost: about n for the polygons people draw, n^2 at worst.
 *
 * The walk goes on with the corner behind the ear it has cut, so a convex polygon becomes the fan
 * (0,1,2) (0,2,3) ... that every other tool makes of it.
 *
 * Every triangle of a sound result is counter-clockwise in the plane. Where there is no ear (crossing
 * outlines, spikes, repeated points) a corner is cut off all the same and the result is not sound.
 */
#include "scene/polygon.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/memory.h"

/* Polygons up to this size work in a block on the stack; larger ones are rare. */
enum { STACK_CORNERS = 48 };

enum kind { CONVEX, BLOCKING, GONE };

enum verdict { NO_EAR, EAR, FLAT_EAR };

/* What is known of one corner. */
typedef struct corner {
	double x, y; /* in the plane, relative to corner 0 */
	uint32_t previous, next;
	uint32_t cell;
	enum kind kind;
} corner;

typedef struct outline {
	corner *corners;
	size_t count, left;
	double extent; /* the largest |x| or |y|, which bounds their error */

	/* The blocking corners of cell c are members[cell_begin[c] .. cell_end[c]); entries that block no
	 * more are dropped when they are met. */
	size_t columns;
	double low_x, low_y, cells_per_x, cells_per_y;
	uint32_t *cell_begin, *cell_end, *members;
	size_t blocking_count;

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

/* Newell's normal: its components are twice the areas of the polygon's shadows on the axis planes, and
 * no single bad corner spoils it. False where it is zero or not finite. */
static bool newell_normal(const float (*points)[3], size_t count, double normal[3])
{
	double sum[3] = {0, 0, 0};
	for (size_t i = 0; i < count; i++) {
		double a[3], b[3];
		const float *p = points[i], *q = points[i + 1 < count ? i + 1 : 0];
		for (int k = 0; k < 3; k++) {
			a[k] = (double)p[k] - points[0][k];
			b[k] = (double)q[k] - points[0][k];
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
static bool project(outline *o, const float (*points)[3])
{
	double normal[3], u[3], v[3];
	if (!newell_normal(points, o->count, normal))
		return false;
	plane_axes(normal, u, v);
	const uint32_t count = (uint32_t)o->count;
	for (uint32_t i = 0; i < count; i++) {
		double p[3];
		for (int k = 0; k < 3; k++)
			p[k] = (double)points[i][k] - points[0][k];
		corner *c = &o->corners[i];
		c->x = p[0] * u[0] + p[1] * u[1] + p[2] * u[2];
		c->y = p[0] * v[0] + p[1] * v[1] + p[2] * v[2];
		c->previous = i ? i - 1 : count - 1;
		c->next = i + 1 < count ? i + 1 : 0;
		o->extent = fmax(o->extent, fmax(fabs(c->x), fabs(c->y)));
	}
	return true;
}

static size_t cell_index(double value, double low, double cells_per_unit, size_t columns)
{
	const double cell = (value - low) * cells_per_unit;
	return cell <= 0 ? 0 : cell >= (double)columns ? columns - 1 : (size_t)cell;
}

/* Marks the corners that are not strictly convex and sorts them into cells, about one to a cell. */
static void find_blocking(outline *o)
{
	double high_x = -DBL_MAX, high_y = -DBL_MAX;
	o->low_x = o->low_y = DBL_MAX;
	for (size_t i = 0; i < o->count; i++) {
		corner *c = &o->corners[i];
		const bool convex = turn(o, &o->corners[c->previous], c, &o->corners[c->next]) > 0;
		c->kind = convex ? CONVEX : BLOCKING;
		o->blocking_count += !convex;
		o->low_x = fmin(o->low_x, c->x);
		o->low_y = fmin(o->low_y, c->y);
		high_x = fmax(high_x, c->x);
		high_y = fmax(high_y, c->y);
	}
	o->columns = (size_t)sqrt((double)o->blocking_count); /* columns^2 <= count, as allocated */
	if (o->columns == 0)
		o->columns = 1;
	o->cells_per_x = high_x > o->low_x ? (double)o->columns / (high_x - o->low_x) : 0;
	o->cells_per_y = high_y > o->low_y ? (double)o->columns / (high_y - o->low_y) : 0;

	/* Counting sort: count, running sum, place. */
	const size_t cell_count = o->columns * o->columns;
	memset(o->cell_end, 0, cell_count * sizeof *o->cell_end);
	for (size_t i = 0; i < o->count; i++) {
		corner *c = &o->corners[i];
		if (c->kind != BLOCKING)
			continue;
		c->cell = (uint32_t)(cell_index(c->y, o->low_y, o->cells_per_y, o->columns) * o->columns +
			cell_index(c->x, o->low_x, o->cells_per_x, o->columns));
		o->cell_end[c->cell]++;
	}
	uint32_t begin = 0;
	for (size_t cell = 0; cell < cell_count; cell++) {
		const uint32_t size = o->cell_end[cell];
		o->cell_begin[cell] = o->cell_end[cell] = begin;
		begin += size;
	}
	for (size_t i = 0; i < o->count; i++) {
		const corner *c = &o->corners[i];
		if (c->kind == BLOCKING)
			o->members[o->cell_end[c->cell]++] = (uint32_t)i;
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

static bool cell_blocks(outline *o, size_t cell, const corner *a, const corner *b, const corner *c)
{
	const uint32_t begin = o->cell_begin[cell];
	uint32_t i = begin;
	while (i < o->cell_end[cell]) {
		const corner *w = &o->corners[o->members[i]];
		if (w->kind != BLOCKING)
			o->members[i] = o->members[--o->cell_end[cell]];
		else if (blocks(o, w, a, b, c))
			return true;
		else
			i++;
	}
	return false;
}

static bool triangle_is_blocked(outline *o, const corner *a, const corner *b, const corner *c)
{
	if (o->blocking_count == 0)
		return false;
	const double low_x = fmin(a->x, fmin(b->x, c->x)), high_x = fmax(a->x, fmax(b->x, c->x));
	const double low_y = fmin(a->y, fmin(b->y, c->y)), high_y = fmax(a->y, fmax(b->y, c->y));
	const size_t column_low = cell_index(low_x, o->low_x, o->cells_per_x, o->columns);
	const size_t column_high = cell_index(high_x, o->low_x, o->cells_per_x, o->columns);
	const size_t row_low = cell_index(low_y, o->low_y, o->cells_per_y, o->columns);
	const size_t row_high = cell_index(high_y, o->low_y, o->cells_per_y, o->columns);
	for (size_t row = row_low; row <= row_high; row++)
		for (size_t column = column_low; column <= column_high; column++)
			if (cell_blocks(o, row * o->columns + column, a, b, c))
				return true;
	return false;
}

/* A spike or a repeated point is a flat ear: no later cut makes it better. A corner in the middle of a
 * straight edge is none: it gets its triangle when a neighbour has gone. */
static enum verdict judge(outline *o, uint32_t at)
{
	const corner *b = &o->corners[at];
	const corner *a = &o->corners[b->previous], *c = &o->corners[b->next];
	const double area = turn(o, a, b, c);
	if (area > 0)
		return triangle_is_blocked(o, a, b, c) ? NO_EAR : EAR;
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
		o->blocking_count--;
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
		o->blocking_count--;
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
		const enum verdict verdict = judge(o, at);
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

nt_status nt_polygon_triangulate(const float (*points)[3], size_t count, uint32_t *triangles,
	bool *sound)
{
	corner stack_corners[STACK_CORNERS];
	uint32_t stack_numbers[5 * STACK_CORNERS];
	const bool large = count > STACK_CORNERS;
	corner *corners = large ? nt_alloc(count, sizeof *corners) : stack_corners;
	/* cell_begin, cell_end and members have count numbers each, the queue has 2 * count. */
	uint32_t *numbers = large ? nt_alloc(count, 5 * sizeof *numbers) : stack_numbers;
	nt_status status = NT_ERROR_MEMORY;
	if (!corners || !numbers)
		goto out;

	outline o = {
		.corners = corners,
		.count = count,
		.left = count,
		.cell_begin = numbers,
		.cell_end = numbers + count,
		.members = numbers + 2 * count,
		.queue = numbers + 3 * count,
		.triangles = triangles,
		.sound = true,
	};
	if (project(&o, points)) {
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
	}
	return status;
}
