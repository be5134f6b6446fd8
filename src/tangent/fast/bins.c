/* SPDX-License-Identifier: MIT */
/*
 * Bins: see bins.h. The memory in which a bin is added up (23 bytes a corner, its cursors, entries and sums) should
 * fit the second-level cache; but the more bins, the more streams, and each is a line in the first-level
 * cache and a page. 8192 vertices of six corners are about two megabytes.
 */
#include "tangent/fast/bins.h"

#include <string.h>
#include "base/parallel.h"

enum { USUAL_BITS = 13, MOST_BINS = 512 };

/* Fewer, smaller meshes have smaller bins: the memory that a bin is added up in has places for as many corners as its
 * vertices could have, and should not be more than half a byte for each triangle. */
enum { LEAST_BINS = 128 };

/* Every block has the full depth: what is not used is not touched, and nothing has to be counted. */
enum { BLOCK_ENTRIES = NT_FAN_LANES * NT_FAN_DEPTH };

typedef struct counting {
	const uint32_t *ids;
	const nt_triangle_ranges *ranges;
	const nt_bins *bins;
} counting;

static void count_ranges(void *context, size_t begin, size_t end, unsigned thread)
{
	(void)thread;
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
	unsigned bits = USUAL_BITS;
	while (bits < NT_BINNED_BITS && vertex_count >> bits >= MOST_BINS)
		bits++;
	while (vertex_count >> bits < LEAST_BINS && bits > 4)
		bits--;
	return bits;
}

nmtan_status nt_bins_make(const uint32_t *ids, const nt_triangle_ranges *ranges, size_t vertex_count,
	unsigned vertex_bits, nt_record *sums, nt_borrowed *memory, nt_bins *bins)
{
	const size_t count = (vertex_count + ((size_t)1 << vertex_bits) - 1) >> vertex_bits;
	const size_t corners = 3 * ranges->bounds[ranges->count];
	nt_scratch *scratch = memory->scratch;
	nt_bins b = {.vertex_bits = vertex_bits, .ranges = ranges->count, .count = count, .vertex_count = vertex_count};
	b.sums = sums;
	if (!sums)
		b.sums = nt_borrowed_alloc(memory, corners, sizeof *b.sums);
	b.entries = nt_scratch_alloc(scratch, corners * NT_BINNED_ENTRY + 1, 1);
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

void nt_bins_orientations(const nt_bins *bins, bool orientations[2])
{
	unsigned seen = 0;
	for (unsigned r = 0; r < bins->ranges; r++)
		seen |= bins->seen[r];
	for (int o = 0; o < 2; o++)
		orientations[o] = (seen == NT_SEEN_ANY ? NT_SEEN(0) : seen) & NT_SEEN(o);
}

nmtan_status nt_bin_make(const nt_bins *bins, const bool needed[2], nt_scratch *scratch, nt_bin *bin)
{
	const size_t vertices = (size_t)1 << bins->vertex_bits;
	*bin = (nt_bin){.adjacency = {.ranges = 1, .step = NT_FAN_LANES}};
	nt_adjacency *a = &bin->adjacency;
	a->cursors = nt_scratch_alloc(scratch, vertices, sizeof *a->cursors);
	a->block_begin = nt_scratch_alloc(scratch, vertices / NT_FAN_LANES + 1, sizeof *a->block_begin);
	a->entry_count = vertices * NT_FAN_DEPTH;
	a->entries = nt_scratch_alloc(scratch, a->entry_count, sizeof *a->entries);
	if (!a->cursors || !a->block_begin || !a->entries)
		return NMTAN_ERROR_MEMORY;
	for (size_t block = 0; block <= vertices / NT_FAN_LANES; block++)
		a->block_begin[block] = (uint32_t)block * BLOCK_ENTRIES;
	for (int o = 0; o < 2; o++)
		if (needed[o] && !(bin->sums[o] = nt_scratch_alloc(scratch, vertices, sizeof *bin->sums[o])))
			return NMTAN_ERROR_MEMORY;
	return NMTAN_OK;
}

static uint32_t vertex_of(const nt_bins *b, uint32_t state)
{
	return state >> NT_BINNED_SHIFT & (((uint32_t)1 << b->vertex_bits) - 1);
}

bool nt_bins_have_corners(const nt_bins *b, uint32_t vertex)
{
	const size_t bin = vertex >> b->vertex_bits;
	for (unsigned range = 0; range < b->ranges; range++)
		for (size_t i = b->begins[bin * b->ranges + range]; i < b->cursors[range * b->count + bin]; i++)
			if (((vertex_of(b, b->sums[i].state) ^ vertex) & (((uint32_t)1 << b->vertex_bits) - 1)) == 0)
				return true;
	return false;
}

static void add_corners(const nt_bins *b, size_t begin, size_t end, nt_record *const to[2], bool both,
	nt_adjacency *a)
{
	static const nt_int4 sum_bits = {-1, -1, -1, NT_STATE_BASE | NT_STATE_ALL};
	static const nt_int4 not_local = {-1, -1, -1, ~NT_STATE_LOCAL};
	for (size_t i = begin; i < end; i++) {
		const uint32_t state = b->sums[i].state, vertex = vertex_of(b, state);
		const uint32_t cursor = a->cursors[vertex];
		const bool full = cursor >= (vertex / NT_FAN_LANES + 1) * BLOCK_ENTRIES;
		if (!full)
			a->entries[cursor] = nt_binned_load(b->entries + NT_BINNED_ENTRY * i, state & NT_BINNED_ORIENT);
		a->cursors[vertex] = !full ? cursor + NT_FAN_LANES
			: cursor & NT_CURSOR_HUB ? cursor + 1 : NT_CURSOR_HUB | (NT_FAN_DEPTH + 1);
		nt_int4 sum;
		memcpy(&sum, &b->sums[i], sizeof sum);
		sum = nt_and4(sum, sum_bits);
		if (both && !(state & NT_STATE_NO_ANY))
			sum = nt_and4(sum, not_local);
		nt_record_add(&to[state >> 31][vertex], sum);
	}
}

void nt_bin_add_up(const nt_bins *bins, size_t index, nt_bin *bin)
{
	const size_t first = index << bins->vertex_bits, left = bins->vertex_count - first;
	const size_t most = (size_t)1 << bins->vertex_bits;
	const uint32_t *begins = bins->begins + index * bins->ranges;
	nt_adjacency *a = &bin->adjacency;
	a->first_vertex = first;
	a->vertex_count = left < most ? left : most;

	for (uint32_t v = 0; v < a->vertex_count; v++)
		a->cursors[v] = v / NT_FAN_LANES * BLOCK_ENTRIES + v % NT_FAN_LANES;
	nt_record *to[2];
	for (int o = 0; o < 2; o++) {
		to[o] = bin->sums[o] ? bin->sums[o] : bin->sums[!o];
		for (size_t v = 0; v < (a->vertex_count + NT_FAN_LANES - 1) / NT_FAN_LANES * NT_FAN_LANES; v++)
			memcpy(&to[o][v], &nt_no_record, sizeof nt_no_record);
	}
	for (unsigned range = 0; range < bins->ranges; range++)
		add_corners(bins, begins[range], bins->cursors[range * bins->count + index], to,
			bin->sums[0] && bin->sums[1], a);
}
