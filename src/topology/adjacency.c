/* SPDX-License-Identifier: MIT */
/*
 * Adjacency: see adjacency.h. Two passes: count, then walk the blocks and turn counts into cursors. The
 * price of blocks is padding; the more the corners of a block's vertices differ in number, the more it is.
 */
#include "topology/adjacency.h"

#include <string.h>
#include "base/parallel.h"

/* Corners by which a count is prefetched before it is needed: costs nothing where neighbours are near. */
enum { COUNT_AHEAD = 48 };

/* Of entries that do not fit the borrowed memory, less than one in so many may lie elsewhere. */
enum { PART_ELSEWHERE = 2 };

/* Triangles whose vertices are looked up at a time. */
enum { BATCH = 16 };

typedef struct counting {
	const nt_triangles *triangles;
	const nt_triangle_ranges *ranges;
	const nt_adjacency *adjacency;
} counting;

static void count_corners(uint32_t *counts, const uint32_t *ids, size_t count)
{
	size_t i = 0;
	for (; i + COUNT_AHEAD < count; i++) {
		__builtin_prefetch(&counts[ids[i + COUNT_AHEAD]], 1);
		counts[ids[i]]++;
	}
	for (; i < count; i++)
		counts[ids[i]]++;
}

static void count_range(const counting *c, size_t range)
{
	uint32_t *counts = c->adjacency->cursors + range * c->adjacency->vertex_count;
	memset(counts, 0, c->adjacency->vertex_count * sizeof *counts);
	const size_t end = c->ranges->bounds[range + 1];
	size_t step;
	for (size_t t = c->ranges->bounds[range]; t < end; t += step) {
		uint32_t copy[3 * BATCH];
		step = c->triangles->cuts && end - t > BATCH ? BATCH : end - t;
		count_corners(counts, nt_triangle_vertices(c->triangles, t, step, copy), 3 * step);
	}
}

static void count_ranges(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	for (size_t range = begin; range < end; range++)
		count_range(context, range);
}

/* Turns the counts of one vertex into cursors that begin at `place`; returns the sum of the counts. */
static uint32_t place_vertex(nt_adjacency *a, size_t vertex, uint32_t place)
{
	uint32_t total = 0;
	for (unsigned r = 0; r < a->ranges; r++) {
		uint32_t *cursor = &a->cursors[r * a->vertex_count + vertex];
		const uint32_t count = *cursor;
		const bool shared = total > 0 && count > 0;
		*cursor = (place + total * NT_FAN_LANES) | (shared ? NT_CURSOR_SHARED : 0);
		a->shared_counts[r] += shared ? count : 0;
		total += count;
	}
	return total;
}

static uint32_t total_count(const nt_adjacency *a, size_t vertex)
{
	uint32_t total = 0;
	for (unsigned r = 0; r < a->ranges; r++)
		total += a->cursors[r * a->vertex_count + vertex];
	return total;
}

static void mark_hub(nt_adjacency *a, size_t vertex)
{
	for (unsigned r = 0; r < a->ranges; r++) {
		uint32_t *cursor = &a->cursors[r * a->vertex_count + vertex];
		*cursor = (*cursor & NT_CURSOR_SHARED) | NT_CURSOR_HUB;
	}
}

/* Turns the counts of a block's vertices into cursors that begin at `place`; vertices of more than `most` corners
 * become hubs. Returns how deep the block is. */
static uint32_t place_block(nt_adjacency *a, size_t first, size_t count, uint32_t place, uint32_t most)
{
	uint32_t depth = 0;
	for (size_t lane = 0; lane < count; lane++) {
		const uint32_t degree = total_count(a, first + lane);
		place_vertex(a, first + lane, place + (uint32_t)lane);
		if (degree > most)
			mark_hub(a, first + lane);
		else
			depth = degree > depth ? degree : depth;
	}
	return depth;
}

/* The same for one range: nobody's corners come before its own. */
static uint32_t place_block_alone(uint32_t *cursors, size_t count, uint32_t place, uint32_t most)
{
	uint32_t depth = 0;
	for (size_t lane = 0; lane < count; lane++) {
		const uint32_t degree = cursors[lane], known = degree > most ? 0 : degree;
		cursors[lane] = degree > most ? NT_CURSOR_HUB : place + (uint32_t)lane;
		depth = known > depth ? known : depth;
	}
	return depth;
}

/* Returns the number of entries, padding included: at most most_places. */
static size_t place_blocks(nt_adjacency *a, size_t most_places)
{
	size_t place = 0;
	for (size_t first = 0; first < a->vertex_count; first += NT_FAN_LANES) {
		const size_t left = a->vertex_count - first, count = left < NT_FAN_LANES ? left : NT_FAN_LANES;
		a->block_begin[first / NT_FAN_LANES] = (uint32_t)place;
		const uint32_t most = place + NT_FAN_LANES * NT_FAN_DEPTH <= most_places ? NT_FAN_DEPTH : 0;
		const uint32_t depth = a->ranges == 1
			? place_block_alone(a->cursors + first, count, (uint32_t)place, most)
			: place_block(a, first, count, (uint32_t)place, most);
		place += (size_t)depth * NT_FAN_LANES;
	}
	a->block_begin[(a->vertex_count + NT_FAN_LANES - 1) / NT_FAN_LANES] = (uint32_t)place;
	return place;
}

/* Entries from a block on lie elsewhere. */
static void move_blocks(nt_adjacency *a, size_t block)
{
	for (unsigned r = 0; r < a->ranges; r++)
		for (size_t v = block * NT_FAN_LANES; v < a->vertex_count; v++)
			a->cursors[r * a->vertex_count + v] |= NT_CURSOR_ELSEWHERE;
}

/* Memory for `count` entries. If the borrowed memory is just too small for them the last blocks go to the scratch:
 * their corners take longer, but where rows and most entries fill an output, an uneven mesh needs no second one. */
static bool alloc_entries(nt_adjacency *a, size_t count, nt_borrowed *memory)
{
	size_t fit = (size_t)(memory->end - memory->begin) / sizeof *a->entries;
	fit -= fit > 0; /* one more is allocated, so that there is always something to point to */
	size_t block = (a->vertex_count + NT_FAN_LANES - 1) / NT_FAN_LANES;
	a->entry_count = count;
	if (count > fit && count - fit < count / PART_ELSEWHERE) {
		while (a->block_begin[block] > fit)
			block--;
		a->entry_count = a->block_begin[block];
		a->rest_count = count - a->entry_count;
		a->rest = nt_scratch_alloc(memory->scratch, a->rest_count, sizeof *a->rest);
		if (!a->rest)
			return false;
		move_blocks(a, block);
	}
	a->entries = nt_borrowed_alloc(memory, a->entry_count + 1, sizeof *a->entries);
	return a->entries;
}

nmtan_status nt_adjacency_make(const nt_triangles *triangles, const nt_triangle_ranges *ranges,
	size_t vertex_count, size_t most_places, nt_borrowed *cursor_memory, nt_borrowed *memory, nt_adjacency *adjacency)
{
	const size_t blocks = (vertex_count + NT_FAN_LANES - 1) / NT_FAN_LANES;
	*adjacency = (nt_adjacency){.vertex_count = vertex_count, .ranges = ranges->count};
	nt_adjacency *a = adjacency;
	/* readers load whole vectors of cursors */
	a->cursors = nt_borrowed_alloc(cursor_memory, vertex_count * ranges->count + NT_FAN_LANES, sizeof *a->cursors);
	a->block_begin = nt_borrowed_alloc(cursor_memory, blocks + 1, sizeof *a->block_begin);
	a->shared_counts = nt_scratch_alloc(memory->scratch, ranges->count, sizeof *a->shared_counts);
	if (!a->cursors || !a->block_begin || !a->shared_counts)
		return NMTAN_ERROR_MEMORY;
	memset(a->shared_counts, 0, ranges->count * sizeof *a->shared_counts);

	counting c = {triangles, ranges, a};
	nt_parallel_ranges(ranges->count, ranges->count, 1, count_ranges, &c);
	return alloc_entries(a, place_blocks(a, most_places), memory) ? NMTAN_OK : NMTAN_ERROR_MEMORY;
}
