/* SPDX-License-Identifier: MIT */
/*
 * Adjacency: see adjacency.h. Two passes: count, then walk the blocks and turn counts into cursors. The
 * price of blocks is padding; the more the corners of a block's vertices differ in number, the more it is.
 */
#include "topology/adjacency.h"

#include <string.h>
#include "base/compiler.h"
#include "base/parallel.h"

/* Triangles whose vertices are looked up at a time. */
enum { BATCH = 16 };

typedef struct counting {
	const nt_triangles *triangles;
	const nt_triangle_ranges *ranges;
	const nt_adjacency *adjacency;
} counting;

static void count_range(const counting *c, size_t range)
{
	uint32_t *counts = c->adjacency->cursors + range * c->adjacency->vertex_count;
	memset(counts, 0, c->adjacency->vertex_count * sizeof *counts);
	for (unsigned sweep = 0; sweep < nt_sweeps(c->ranges); sweep++) {
		const size_t *const bounds = c->ranges->bounds + sweep * c->ranges->count + range;
		size_t step;
		for (size_t t = bounds[0]; t < bounds[1]; t += step) {
			uint32_t copy[3 * BATCH];
			step = c->triangles->cuts && bounds[1] - t > BATCH ? BATCH : bounds[1] - t;
			const uint32_t *ids = nt_triangle_vertices(c->triangles, t, step, copy);
			for (size_t i = 0; i < 3 * step; i++)
				counts[ids[i]]++;
		}
	}
}

static void count_ranges(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
	for (size_t range = begin; range < end; range++)
		count_range((const counting *)context, range);
}

/* Vertices of a block with more than `most` corners become hubs. Returns how deep the block is without them. */
static uint32_t NT_NOINLINE mark_hubs(const nt_adjacency *a, size_t first, size_t count, uint32_t most,
	const uint32_t *totals)
{
	uint32_t depth = 0;
	for (size_t lane = 0; lane < count; lane++) {
		const bool hub = totals[lane] > most;
		depth = !hub && totals[lane] > depth ? totals[lane] : depth;
		for (unsigned r = 0; hub && r < a->ranges; r++) {
			uint32_t *cursor = &a->cursors[r * a->vertex_count + first + lane];
			*cursor = (*cursor & NT_CURSOR_SHARED) | NT_CURSOR_HUB | totals[lane];
		}
	}
	return depth;
}

/* Turns the counts of a block's vertices into cursors that begin at `place`. Returns how deep the block is. Straight
 * loops over lanes, which with constants for the last two become vectors. */
static inline uint32_t place_block(nt_adjacency *a, size_t first, uint32_t place, uint32_t most, size_t count,
	unsigned ranges, bool two_sweeps)
{
	/* signed, which all vectors compare: there are fewer corners than NT_ADJACENCY_LIMIT */
	int32_t totals[NT_FAN_LANES] = {0}, before[NT_FAN_LANES] = {0}, depth = 0;
	/* in two sweeps each range may come before each other one: the one that is counted too much is its own */
	for (unsigned r = 0; two_sweeps && r < ranges; r++)
		for (size_t lane = 0; lane < count; lane++)
			before[lane] += a->cursors[r * a->vertex_count + first + lane] > 0;
	for (unsigned r = 0; r < ranges; r++) {
		uint32_t *cursors = a->cursors + r * a->vertex_count + first;
		int32_t shared_count = 0;
		for (size_t lane = 0; lane < count; lane++) {
			const int32_t here = (int32_t)cursors[lane];
			const int32_t shared = -((before[lane] > (two_sweeps ? 1 : 0)) & (here > 0));
			cursors[lane] = (place + (uint32_t)lane + (uint32_t)totals[lane] * NT_FAN_LANES) |
				((uint32_t)shared & NT_CURSOR_SHARED);
			shared_count += shared & here;
			totals[lane] += here;
			before[lane] = two_sweeps ? before[lane] : totals[lane];
		}
		a->shared_counts[r] += (uint32_t)shared_count;
	}
	for (size_t lane = 0; lane < count; lane++)
		depth = totals[lane] > depth ? totals[lane] : depth;
	return (uint32_t)depth > most ? mark_hubs(a, first, count, most, (const uint32_t *)totals) : (uint32_t)depth;
}

/* Returns the number of entries, padding included: at most most_places. */
static size_t place_blocks(nt_adjacency *a, size_t most_places, bool two_sweeps)
{
	size_t place = 0;
	for (size_t first = 0; first < a->vertex_count; first += NT_FAN_LANES) {
		const size_t left = a->vertex_count - first, count = left < NT_FAN_LANES ? left : NT_FAN_LANES;
		a->block_begin[first / NT_FAN_LANES] = (uint32_t)place;
		const uint32_t most = place + NT_FAN_LANES * NT_FAN_DEPTH <= most_places ? NT_FAN_DEPTH : 0;
		const uint32_t depth = count < NT_FAN_LANES || two_sweeps
			? place_block(a, first, (uint32_t)place, most, count, a->ranges, two_sweeps)
			: a->ranges == 1 ? place_block(a, first, (uint32_t)place, most, NT_FAN_LANES, 1, false)
			: place_block(a, first, (uint32_t)place, most, NT_FAN_LANES, a->ranges, false);
		place += (size_t)depth * NT_FAN_LANES;
	}
	a->block_begin[(a->vertex_count + NT_FAN_LANES - 1) / NT_FAN_LANES] = (uint32_t)place;
	return place;
}

/* Cursors of vertices that have narrow entries, and the memory for these. */
static bool make_narrow(nt_adjacency *a, nt_borrowed *memory)
{
	for (size_t v = 0; v < a->vertex_count; v++)
		a->cursors[v] = (uint32_t)v;
	/* an odd number of cache lines: a vertex's entries are not all in one set of a cache */
	a->step = (uint32_t)((a->vertex_count + NT_FAN_LANES - 1) / NT_FAN_LANES | 1) * NT_FAN_LANES;
	a->narrow = nt_borrowed_alloc(memory, NT_FAN_DEPTH * (size_t)a->step, sizeof *a->narrow);
	return a->narrow;
}

nmtan_status nt_adjacency_make(const nt_triangles *triangles, const nt_triangle_ranges *ranges,
	size_t vertex_count, size_t most_places, size_t most_narrow, nt_borrowed *cursor_memory, nt_borrowed *memory,
	nt_adjacency *adjacency)
{
	const size_t blocks = (vertex_count + NT_FAN_LANES - 1) / NT_FAN_LANES;
	*adjacency = (nt_adjacency){.vertex_count = vertex_count, .ranges = ranges->count, .step = NT_FAN_LANES};
	nt_adjacency *a = adjacency;
	/* readers load whole vectors of cursors */
	a->cursors = nt_borrowed_alloc(cursor_memory, vertex_count * ranges->count + NT_FAN_LANES, sizeof *a->cursors);
	if (a->cursors && NT_NARROW_LIMIT > 0 && ranges->count == 1 && vertex_count <= most_narrow)
		return make_narrow(a, memory) ? NMTAN_OK : NMTAN_ERROR_MEMORY;
	a->block_begin = nt_borrowed_alloc(cursor_memory, blocks + 1, sizeof *a->block_begin);
	a->shared_counts = nt_scratch_alloc(memory->scratch, ranges->count, sizeof *a->shared_counts);
	if (!a->cursors || !a->block_begin || !a->shared_counts)
		return NMTAN_ERROR_MEMORY;
	memset(a->shared_counts, 0, ranges->count * sizeof *a->shared_counts);

	counting c = {triangles, ranges, a};
	nt_parallel_ranges(ranges->count, ranges->count, 1, count_ranges, &c);
	a->entry_count = place_blocks(a, most_places, nt_sweeps(ranges) > 1);
	/* one more, so that there is always something to point to */
	a->entries = nt_borrowed_alloc(memory, a->entry_count + 1, sizeof *a->entries);
	return a->entries ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}
