/* SPDX-License-Identifier: MIT */
/*
 * Edges: the sides of a surface by their points, the lower one first. Sides are listed by their lower point (a counting
 * sort); those of one point, about three, are sorted by the higher one when they are asked for. On each edge its sides
 * are ascending. The list is 4 bytes for each side; what an edge needs besides is looked up where it is in the cache
 * anyway, unless triangles are in no order.
 *
 * Time is linear but for the log of a point's valence.
 */
#include "report/surface/surface.h"

#include <stdlib.h>
#include <string.h>
#include "base/memory.h"
#include "base/parallel.h"

enum {
	GRAIN = 32768,   /* triangles that are worth a thread */
	MOST_RANGES = 4, /* each has a count for every point */
	MOST_MOVES = 12, /* a side, up to which insertion is the fastest sort: fans are nearly sorted */
	AHEAD = 12       /* sides by which points are prefetched; their vertices twice as early */
};

/* Ranges of triangles are listed one behind the other, so that sides of a point are ascending. */
typedef struct listing {
	const nt_surface *surface;
	uint32_t *counts; /* [ranges][point_count] sides with that lower point; then where the next one goes */
} listing;

/* sides: NULL: they are only counted. Without a loop over the three: that took twice the instructions. */
static inline void go_over(const nt_surface *s, size_t begin, size_t end, uint32_t *counts, uint32_t *sides)
{
	for (size_t t = begin; t < end; t++) {
		if (!nt_has_edges(s, t))
			continue;
		const uint32_t a = nt_side_point(s, 3 * t), b = nt_side_point(s, 3 * t + 1),
			       c = nt_side_point(s, 3 * t + 2);
		const uint32_t first = counts[a < b ? a : b]++, second = counts[b < c ? b : c]++,
			       third = counts[c < a ? c : a]++;
		if (!sides)
			continue;
		sides[first] = (uint32_t)(3 * t);
		sides[second] = (uint32_t)(3 * t + 1);
		sides[third] = (uint32_t)(3 * t + 2);
	}
}

static void count_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const listing *l = context;
	uint32_t *counts = l->counts + slot * l->surface->point_count;
	memset(counts, 0, l->surface->point_count * sizeof *counts);
	go_over(l->surface, begin, end, counts, NULL);
}

static void list_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const listing *l = context;
	go_over(l->surface, begin, end, l->counts + slot * l->surface->point_count, l->surface->sides);
}

nt_status nt_surface_list_sides(nt_surface *s, unsigned threads)
{
	threads = threads < MOST_RANGES ? threads : MOST_RANGES;
	const unsigned ranges = nt_parallel_slots(threads, s->triangle_count, GRAIN);
	listing l = {s, s->counts = nt_alloc(ranges * s->point_count, sizeof *s->counts)};
	s->sides = nt_alloc(3 * s->triangle_count, sizeof *s->sides);
	if (!s->sides || !l.counts)
		return NT_ERROR_MEMORY;
	nt_parallel_ranges(threads, s->triangle_count, GRAIN, count_range, &l);
	uint32_t sum = 0;
	for (size_t p = 0; p < s->point_count; p++) {
		const uint32_t before = sum;
		for (unsigned range = 0; range < ranges; range++) {
			uint32_t *count = &l.counts[range * s->point_count + p];
			const uint32_t begin = sum;
			sum += *count;
			*count = begin;
		}
		s->most_sides = sum - before > s->most_sides ? sum - before : s->most_sides;
	}
	nt_parallel_ranges(threads, s->triangle_count, GRAIN, list_range, &l);
	s->ends = l.counts + (ranges - 1) * s->point_count; /* the last range ends where the next point begins */
	return NT_OK;
}

void nt_surface_free_sides(nt_surface *s)
{
	free(s->sides);
	free(s->counts);
	s->sides = s->counts = NULL;
}

static int by_high(const void *a, const void *b)
{
	const nt_edge_side *x = a, *y = b;
	if (x->high != y->high)
		return x->high < y->high ? -1 : 1;
	return x->side < y->side ? -1 : x->side > y->side;
}

/* Triangles may lie anywhere: what is asked of a side's is fetched before it is its turn. */
static void prefetch(const nt_surface *s, size_t at)
{
	const size_t last = s->ends[s->point_count - 1];
	if (at + 2 * AHEAD >= last)
		return;
	const uint32_t near = s->sides[at + AHEAD], far = s->sides[at + 2 * AHEAD];
	if (s->vertices)
		__builtin_prefetch(&s->vertices[far]);
	__builtin_prefetch(&s->orientation[far / 3]);
	__builtin_prefetch(&s->points[nt_side_vertex(s, near)]);
	__builtin_prefetch(&s->points[nt_side_vertex(s, nt_side_next(near))]);
}

size_t nt_surface_edges(const nt_surface *s, uint32_t low, nt_edge_side *edges)
{
	const size_t begin = low ? s->ends[low - 1] : 0, count = s->ends[low] - begin;
	size_t moves = MOST_MOVES * count;
	for (size_t i = 0; i < count; i++) {
		prefetch(s, begin + i);
		const uint32_t side = s->sides[begin + i];
		const uint32_t a = nt_side_point(s, side), b = nt_side_point(s, nt_side_next(side));
		const nt_edge_side next = {side, a == low ? b : a, s->orientation[side / 3], a == low};
		size_t k = i;
		for (; k > 0 && next.high < edges[k - 1].high && moves; k--, moves--)
			edges[k] = edges[k - 1];
		edges[k] = next;
	}
	if (!moves)
		qsort(edges, count, sizeof *edges, by_high);
	return count;
}
