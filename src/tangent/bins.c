/* SPDX-License-Identifier: MIT */
/*
 * Bins: see bins.h. What a bin is added up in (24 bytes a corner, its cursors, entries and records) should
 * fit the second-level cache; but the more bins, the more streams, and each is a line in the first-level
 * cache and a page. 8192 vertices of six corners are about two megabytes.
 */
#include "tangent/bins.h"

#include <string.h>
#include "base/parallel.h"

enum { LEAST_BITS = 13, MOST_BINS = 512 };

/* Every block has the full depth: what is not used is not touched, and nothing has to be counted. */
enum { BLOCK_ENTRIES = NT_FAN_LANES * NT_FAN_DEPTH };

typedef struct counting {
	const uint32_t *ids;
	const nt_triangle_ranges *ranges;
	const nt_bins *bins;
} counting;

static void count_ranges(void *context, size_t begin, size_t end, unsigned slot)
{
	(void)slot;
	const counting *c = context;
	const unsigned bits = c->bins->vertex_bits;
	for (size_t range = begin; range < end; range++) {
		uint32_t *counts = c->bins->cursors + range * c->bins->count;
		memset(counts, 0, c->bins->count * sizeof *counts);
		for (size_t i = 3 * c->ranges->bounds[range]; i < 3 * c->ranges->bounds[range + 1]; i++)
			counts[c->ids[i] >> bits]++;
	}
}

/* Bin by bin, and in it range by range. */
static void place_corners(nt_bins *b)
{
	uint32_t place = 0;
	for (size_t bin = 0; bin < b->count; bin++)
		for (unsigned range = 0; range < b->ranges; range++) {
			uint32_t *cursor = &b->cursors[range * b->count + bin];
			const uint32_t count = *cursor;
			*cursor = b->begins[bin * b->ranges + range] = place;
			place += count;
		}
}

bool nt_is_scattered(const uint32_t *vertices, size_t corner_count, size_t vertex_count)
{
	enum { SAMPLES = 256, FAR = 4096 };
	const size_t step = corner_count / SAMPLES;
	size_t far = 0;
	if (vertex_count < NT_BINS_LEAST || step < 6)
		return false;
	for (size_t i = 0; i < SAMPLES; i++) {
		const uint32_t a = vertices[i * step], b = vertices[i * step + 3];
		far += (a > b ? a - b : b - a) > FAR;
	}
	return far > SAMPLES / 8;
}

unsigned nt_bins_bits(size_t vertex_count)
{
	unsigned bits = LEAST_BITS;
	while (bits < NT_BINNED_BITS && vertex_count >> bits >= MOST_BINS)
		bits++;
	return bits;
}

nmtan_status nt_bins_make(const uint32_t *ids, const nt_triangle_ranges *ranges, size_t vertex_count,
	unsigned vertex_bits, nt_record *sums, nt_scratch *scratch, nt_bins *bins)
{
	const size_t count = (vertex_count + ((size_t)1 << vertex_bits) - 1) >> vertex_bits;
	const size_t corners = 3 * ranges->bounds[ranges->count];
	nt_bins b = {.vertex_bits = vertex_bits, .ranges = ranges->count, .count = count, .vertex_count = vertex_count};
	b.sums = sums ? sums : nt_scratch_alloc(scratch, corners, sizeof *b.sums);
	b.entries = nt_scratch_alloc(scratch, corners, sizeof *b.entries);
	b.begins = nt_scratch_alloc(scratch, count, ranges->count * sizeof *b.begins);
	b.seen = nt_scratch_alloc(scratch, ranges->count, sizeof *b.seen);
	b.cursors = nt_scratch_alloc(scratch, count, ranges->count * sizeof *b.cursors);
	if (!b.entries || !b.sums || !b.begins || !b.seen || !b.cursors)
		return NMTAN_ERROR_MEMORY;
	memset(b.seen, 0, ranges->count * sizeof *b.seen);
	counting c = {ids, ranges, &b};
	nt_parallel_ranges(ranges->count, ranges->count, 1, count_ranges, &c);
	place_corners(&b);
	*bins = b;
	return NMTAN_OK;
}

nmtan_status nt_bins_adjacency(const nt_bins *bins, nt_scratch *scratch, nt_adjacency *adjacency)
{
	const size_t vertices = (size_t)1 << bins->vertex_bits;
	nt_adjacency a = {.ranges = 1};
	a.cursors = nt_scratch_alloc(scratch, vertices, sizeof *a.cursors);
	a.block_begin = nt_scratch_alloc(scratch, vertices / NT_FAN_LANES + 1, sizeof *a.block_begin);
	a.entries = nt_scratch_alloc(scratch, vertices * NT_FAN_DEPTH, sizeof *a.entries);
	*adjacency = a;
	if (!a.cursors || !a.block_begin || !a.entries)
		return NMTAN_ERROR_MEMORY;
	for (size_t block = 0; block <= vertices / NT_FAN_LANES; block++)
		a.block_begin[block] = (uint32_t)block * BLOCK_ENTRIES;
	return NMTAN_OK;
}

static uint32_t vertex_of(const nt_bins *b, uint32_t state)
{
	return state >> NT_BINNED_SHIFT & (((uint32_t)1 << b->vertex_bits) - 1);
}

static void add_corners(const nt_bins *b, size_t begin, size_t end, nt_record *const to[2], bool contested,
	nt_adjacency *a)
{
	static const nt_int4 sum_bits = {-1, -1, -1, NT_STATE_BASE | NT_STATE_ALL};
	static const nt_int4 not_local = {-1, -1, -1, ~NT_STATE_LOCAL};
	for (size_t i = begin; i < end; i++) {
		const uint32_t state = b->sums[i].state, vertex = vertex_of(b, state);
		const uint32_t cursor = a->cursors[vertex];
		const bool full = cursor >= (vertex / NT_FAN_LANES + 1) * BLOCK_ENTRIES;
		if (!full)
			a->entries[cursor] = b->entries[i];
		a->cursors[vertex] = full ? NT_CURSOR_HUB : cursor + NT_FAN_LANES;
		nt_int4 sum;
		memcpy(&sum, &b->sums[i], sizeof sum);
		sum &= sum_bits;
		if (contested && !(state & NT_STATE_NO_ANY))
			sum &= not_local;
		nt_record_add(&to[state >> 31][vertex], sum);
	}
}

void nt_bins_add(const nt_bins *bins, size_t bin, nt_record *const records[2], nt_adjacency *adjacency)
{
	const size_t first = bin << bins->vertex_bits, left = bins->vertex_count - first;
	const size_t most = (size_t)1 << bins->vertex_bits;
	const uint32_t *begins = bins->begins + bin * bins->ranges;
	nt_adjacency *a = adjacency;
	a->first_vertex = first;
	a->vertex_count = left < most ? left : most;

	for (uint32_t v = 0; v < a->vertex_count; v++)
		a->cursors[v] = v / NT_FAN_LANES * BLOCK_ENTRIES + v % NT_FAN_LANES;
	nt_record *to[2];
	for (int o = 0; o < 2; o++) {
		to[o] = (records[o] ? records[o] : records[!o]) + first;
		for (size_t v = 0; v < a->vertex_count; v++)
			to[o][v] = (nt_record){0, 0, 0, NT_STATE_BASE | NT_STATE_ALL};
	}
	for (unsigned range = 0; range < bins->ranges; range++)
		add_corners(bins, begins[range], bins->cursors[range * bins->count + bin], to,
			records[0] && records[1], a);
}
