/* SPDX-License-Identifier: MIT */
/*
 * Edges by bins: see edge_bins.h.
 *
 * Sides are partitioned by ranges of their lower point and sorted within each, so that memory is read and
 * written in order whatever the order of triangles and vertices is, and all that sorting needs at a time fits a
 * cache. Half of the bins are made at a time: the triangles are read again for the others, which takes less than the
 * memory for all.
 *
 * Time is linear but for the log of a point's valence.
 */
#include "report/surface/edge_bins.h"

#include <stdlib.h>
#include <string.h>
#include "base/memory.h"
#include "base/parallel.h"

enum {
	GRAIN = 32768,          /* triangles that are worth a thread */
	BIN_BITS = 12,          /* a bin of this many points takes some 300 KB */
	MOST_BINS = 4096,
	USUAL = 4,              /* times the mean, up to which the sides of a bin are expected */
	FEW_SIDES = 24          /* up to which insertion is the fastest sort */
};

static uint32_t least(uint32_t a, uint32_t b)
{
	return a < b ? a : b;
}

static uint32_t greatest(uint32_t a, uint32_t b)
{
	return a > b ? a : b;
}

/* ---- counts ---- */

static void count_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const nt_edge_bins *bins = context;
	const nt_surface *s = bins->surface;
	uint32_t *counts = bins->counts + slot * bins->count;
	memset(counts, 0, bins->count * sizeof *counts);
	for (size_t t = begin; t < end; t++) {
		if (!nt_has_edges(s, t))
			continue;
		const uint32_t a = nt_side_point(s, 3 * t), b = nt_side_point(s, 3 * t + 1),
			       c = nt_side_point(s, 3 * t + 2);
		/* the lowest point is that of two sides, the middle one of the third */
		counts[least(least(a, b), c) >> bins->bits] += 2;
		counts[greatest(least(a, b), least(greatest(a, b), c)) >> bins->bits]++;
	}
}

nt_status nt_edge_bins_make(nt_edge_bins *bins, const nt_surface *surface, unsigned threads, nt_scratch *scratch)
{
	*bins = (nt_edge_bins){.surface = surface, .threads = threads,
		.slots = nt_parallel_slots(threads, surface->triangle_count, GRAIN)};
	while (surface->point_count >> bins->bits >= (bins->bits < BIN_BITS ? 1 : MOST_BINS))
		bins->bits++;
	bins->count = (surface->point_count >> bins->bits) + 1;
	bins->counts = nt_scratch_alloc(scratch, bins->slots * bins->count, sizeof *bins->counts);
	bins->totals = nt_scratch_alloc(scratch, bins->count, sizeof *bins->totals);
	if (!bins->counts || !bins->totals)
		return NT_ERROR_MEMORY;
	nt_parallel_ranges(threads, surface->triangle_count, GRAIN, count_range, bins);
	for (size_t bin = 0; bin < bins->count; bin++) {
		bins->totals[bin] = 0;
		for (unsigned slot = 0; slot < bins->slots; slot++)
			bins->totals[bin] += bins->counts[slot * bins->count + bin];
	}
	return NT_OK;
}

/* ---- some bins at a time ---- */

typedef struct slab {
	const nt_edge_bins *bins;
	size_t begin, end;        /* bins */
	nt_edge_side *sides;      /* of these bins */
	nt_edge_side *sorted;     /* [slots][usual] */
	size_t usual;             /* the most sides of a bin without a hub */
	bool failed;              /* out of memory */
	size_t *places;           /* [slots][count] where the next side of a range goes */
	size_t *first;            /* [count] first side of each bin */
	uint32_t *starts;         /* [slots][(1 << bits) + 1] */
	void (*visit)(void *context, size_t bin, const nt_edge_side *sides, size_t count, unsigned slot);
	void *context;
} slab;

static void fill_range(void *context, size_t begin, size_t end, unsigned slot)
{
	const slab *l = context;
	const nt_surface *s = l->bins->surface;
	const unsigned bits = l->bins->bits;
	const uint32_t first = (uint32_t)(l->begin << bits);
	const size_t width = (l->end - l->begin) << bits;
	size_t *places = l->places + slot * l->bins->count;
	for (size_t t = begin; t < end; t++) {
		if (!nt_has_edges(s, t))
			continue;
		const uint32_t a = nt_side_point(s, 3 * t), p[4] = {a, nt_side_point(s, 3 * t + 1),
			nt_side_point(s, 3 * t + 2), a};
		const uint32_t orientation = (uint32_t)(s->orientation[t] + 1);
		for (size_t k = 0; k < 3; k++) {
			const uint32_t low = least(p[k], p[k + 1]), high = greatest(p[k], p[k + 1]);
			if (low - first >= width)
				continue;
			const bool joint = nt_bit(s->joints, low) || nt_bit(s->joints, high);
			const uint32_t within = low & (((uint32_t)1 << bits) - 1);
			l->sides[places[low >> bits]++] = (nt_edge_side){(uint32_t)(3 * t + k), high,
				within << NT_EDGE_FLAGS | (joint ? NT_EDGE_JOINT : 0) |
					(p[k] < p[k + 1] ? NT_EDGE_ASCENDING : 0) | orientation};
		}
	}
}

static void insert_sides(nt_edge_side *sides, size_t count)
{
	for (size_t i = 1; i < count; i++) {
		const nt_edge_side side = sides[i];
		size_t k = i;
		for (; k > 0 && side.high < sides[k - 1].high; k--)
			sides[k] = sides[k - 1];
		sides[k] = side;
	}
}

/* Sorts by the higher point; equal ones stay in order. `other` has room for as many. */
static void sort_sides(nt_edge_side *sides, size_t count, nt_edge_side *other)
{
	if (count <= FEW_SIDES) {
		insert_sides(sides, count);
		return;
	}
	const size_t half = count / 2;
	sort_sides(sides, half, other);
	sort_sides(sides + half, count - half, other);
	memcpy(other, sides, half * sizeof *other);
	size_t a = 0, b = half;
	for (size_t i = 0; a < half; i++)
		sides[i] = b == count || other[a].high <= sides[b].high ? other[a++] : sides[b++];
}

static void sort_bin(const slab *l, size_t bin, unsigned slot, nt_edge_side *sorted)
{
	const size_t count = l->bins->totals[bin], width = (size_t)1 << l->bins->bits;
	nt_edge_side *sides = l->sides + l->first[bin];
	uint32_t *starts = l->starts + slot * (width + 1);
	memset(starts, 0, (width + 1) * sizeof *starts);
	for (size_t i = 0; i < count; i++)
		starts[(sides[i].low >> NT_EDGE_FLAGS) + 1]++;
	for (size_t p = 0; p < width; p++)
		starts[p + 1] += starts[p];
	for (size_t i = 0; i < count; i++)
		sorted[starts[sides[i].low >> NT_EDGE_FLAGS]++] = sides[i];
	/* each start is the next one's now */
	for (size_t p = 0, first = 0; p < width; first = starts[p++])
		sort_sides(sorted + first, starts[p] - first, sides);
}

static void visit_bin(void *context, size_t item, unsigned slot)
{
	slab *l = context;
	const size_t bin = l->begin + item, count = l->bins->totals[bin];
	nt_edge_side *hub = count > l->usual ? nt_alloc(count, sizeof *hub) : NULL;
	nt_edge_side *sorted = hub ? hub : l->sorted + slot * l->usual;
	if (count > l->usual && !hub) {
		__atomic_store_n(&l->failed, true, __ATOMIC_RELAXED);
		return;
	}
	sort_bin(l, bin, slot, sorted);
	l->visit(l->context, bin, sorted, count, slot);
	free(hub);
}

/* Ends a slab before the bin with which it would have more sides than there is room for. Returns its sides. */
static size_t end_slab(slab *l, size_t room)
{
	size_t sum = 0;
	for (l->end = l->begin; l->end < l->bins->count; l->end++) {
		if (l->end > l->begin && sum + l->bins->totals[l->end] > room)
			break;
		l->first[l->end] = sum;
		for (unsigned slot = 0; slot < l->bins->slots; slot++) {
			const size_t at = slot * l->bins->count + l->end;
			l->places[at] = sum;
			sum += l->bins->counts[at];
		}
	}
	return sum;
}

nt_status nt_edge_bins_visit(const nt_edge_bins *bins, nt_scratch *scratch,
	void (*visit)(void *context, size_t bin, const nt_edge_side *sides, size_t count, unsigned slot), void *context)
{
	const size_t triangles = bins->surface->triangle_count;
	size_t room = 3 * triangles / 2, usual = USUAL * (3 * triangles / bins->count + 1);
	for (size_t bin = 0; bin < bins->count; bin++)
		room = bins->totals[bin] > room ? bins->totals[bin] : room;
	usual = usual < room ? usual : room;
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	slab l = {.bins = bins, .visit = visit, .context = context, .usual = usual,
		.sides = nt_scratch_alloc(scratch, room, sizeof *l.sides),
		.sorted = nt_scratch_alloc(scratch, bins->slots * usual, sizeof *l.sorted),
		.places = nt_scratch_alloc(scratch, bins->slots * bins->count, sizeof *l.places),
		.first = nt_scratch_alloc(scratch, bins->count, sizeof *l.first),
		.starts = nt_scratch_alloc(scratch, bins->slots * (((size_t)1 << bins->bits) + 1), sizeof *l.starts)};
	l.failed = !l.sides || !l.sorted || !l.places || !l.first || !l.starts;
	for (; !l.failed && l.begin < bins->count; l.begin = l.end) {
		if (end_slab(&l, room) > 0)
			nt_parallel_ranges(bins->threads, triangles, GRAIN, fill_range, &l);
		nt_parallel_items(bins->slots, l.end - l.begin, visit_bin, &l);
	}
	nt_scratch_back(scratch, mark);
	return l.failed ? NT_ERROR_MEMORY : NT_OK;
}
