/* SPDX-License-Identifier: MIT */
/*
 * Points: vertices whose positions are equal, compared as floats (0 equals -0, NaN equals nothing, no epsilon).
 *
 * Equal vertices mostly follow each other closely, so that each thread first looks among the ones it met recently.
 * What is left goes into bins by its hash, which then are tables that fit a cache: memory is read and written
 * in order, and time is linear whatever the order of vertices is. A class of equal vertices is known by its
 * lowest one, its leader, and numbered by the first corner that uses any of them.
 */
#include "report/surface.h"

#include <string.h>
#include "base/hash.h"
#include "base/parallel.h"

enum {
	GRAIN = 32768,      /* items that are worth a thread */
	BIN_VERTICES = 4096,
	MOST_BIN_BITS = 12, /* a thread writes to all bins at once */
	MOST_RECENT_BITS = 14
};

/* A vertex that no recent one is equal to. */
typedef struct entry {
	uint32_t hash, vertex;
} entry;

typedef struct weld {
	nt_surface *s;      /* its points are vertices equal to each vertex, then leaders, then numbers */
	uint32_t *first;    /* [vertex_count] first corner of each vertex, in the end of its leader's class; NULL: the
	                       vertex is its corner */
	unsigned bin_bits, recent_bits;
	uint32_t *recent;   /* [slots][1 << recent_bits] vertices by their hashes */
	size_t *places;     /* [slots][1 << bin_bits] entries, then where the next one goes */
	size_t *bins;       /* [(1 << bin_bits) + 1] first entry of each */
	entry *entries;
	uint32_t **tables;  /* [slots] */
	uint64_t *leading;  /* [3 * triangle_count] bits: first corners of leaders */
	uint32_t *ranks;
} weld;

static const float *position_of(const weld *w, size_t vertex)
{
	return w->s->mesh->positions + 3 * vertex;
}

static bool same_position(const float *p, const float *q)
{
	return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

static uint32_t hash_position(const float *p)
{
	return (uint32_t)(nt_hash_words(nt_hash_floats(p[0], p[1]), nt_hash_floats(p[2], 0)) >> 32);
}

/* The upper bits of a hash; none of them are 0. */
static size_t upper_bits(uint32_t hash, unsigned bits)
{
	return (size_t)((uint64_t)hash << bits >> 32);
}

static bool is_used(const weld *w, size_t vertex)
{
	return !w->first || w->first[vertex] != NT_NONE;
}

/* ---- first corners ---- */

static void find_first(void *context, size_t begin, size_t end, unsigned slot)
{
	const weld *w = context;
	(void)slot;
	for (size_t c = begin; c < end; c++) {
		uint32_t *first = &w->first[w->s->vertices[c]], known = __atomic_load_n(first, __ATOMIC_RELAXED);
		while (known > c && !__atomic_compare_exchange_n(first, &known, (uint32_t)c, true, __ATOMIC_RELAXED,
					    __ATOMIC_RELAXED)) {
		}
	}
}

/* A vertex joins the class of another. */
static void lower_first(const weld *w, size_t leader, size_t vertex)
{
	if (w->first && w->first[vertex] < w->first[leader])
		w->first[leader] = w->first[vertex];
}

/* ---- recent ones ---- */

/* Notes the vertices that are equal to a recent one, and counts the others by bin. */
static void sift(void *context, size_t begin, size_t end, unsigned slot)
{
	const weld *w = context;
	uint32_t *recent = w->recent + ((size_t)slot << w->recent_bits), *points = w->s->points;
	size_t *counts = w->places + ((size_t)slot << w->bin_bits);
	memset(recent, 0xff, sizeof *recent << w->recent_bits);
	memset(counts, 0, sizeof *counts << w->bin_bits);
	for (size_t v = begin; v < end; v++) {
		points[v] = is_used(w, v) ? (uint32_t)v : NT_NONE;
		const float *p = position_of(w, v);
		if (points[v] == NT_NONE || !same_position(p, p))
			continue;
		const uint32_t hash = hash_position(p);
		uint32_t *other = &recent[upper_bits(hash, w->recent_bits)];
		if (*other != NT_NONE && same_position(p, position_of(w, *other))) {
			points[v] = *other;
			lower_first(w, *other, v);
			continue;
		}
		*other = (uint32_t)v;
		counts[upper_bits(hash, w->bin_bits)]++;
	}
}

/* ---- bins ---- */

static void fill_bins(void *context, size_t begin, size_t end, unsigned slot)
{
	const weld *w = context;
	size_t *places = w->places + ((size_t)slot << w->bin_bits);
	for (size_t v = begin; v < end; v++) {
		const float *p = position_of(w, v);
		if (w->s->points[v] != v || !same_position(p, p))
			continue;
		const uint32_t hash = hash_position(p);
		w->entries[places[upper_bits(hash, w->bin_bits)]++] = (entry){hash, (uint32_t)v};
	}
}

/* Finds the leaders of a bin's entries. */
static void weld_bin(void *context, size_t bin, unsigned slot)
{
	const weld *w = context;
	uint32_t *table = w->tables[slot];
	const size_t begin = w->bins[bin], count = w->bins[bin + 1] - begin;
	unsigned bits = 1;
	while ((size_t)1 << bits < 2 * count)
		bits++;
	memset(table, 0xff, sizeof *table << bits);
	for (size_t i = begin; i < begin + count; i++) {
		const entry e = w->entries[i];
		size_t at = upper_bits(e.hash * 0x9e3779b1u, bits);
		for (; table[at] != NT_NONE; at = (at + 1) & (((size_t)1 << bits) - 1)) {
			const entry other = w->entries[begin + table[at]];
			if (other.hash == e.hash &&
				same_position(position_of(w, e.vertex), position_of(w, other.vertex)))
				break;
		}
		if (table[at] == NT_NONE) {
			table[at] = (uint32_t)(i - begin);
			continue;
		}
		const uint32_t leader = w->entries[begin + table[at]].vertex;
		w->s->points[e.vertex] = leader;
		lower_first(w, leader, e.vertex);
	}
}

static nt_status weld_bins(weld *w, unsigned threads, unsigned slots, nt_scratch *scratch)
{
	const size_t bin_count = (size_t)1 << w->bin_bits;
	size_t sum = 0, most = 0;
	for (size_t bin = 0; bin < bin_count; bin++) {
		w->bins[bin] = sum;
		for (unsigned slot = 0; slot < slots; slot++) {
			size_t *place = &w->places[((size_t)slot << w->bin_bits) + bin];
			const size_t count = *place;
			*place = sum;
			sum += count;
		}
		most = sum - w->bins[bin] > most ? sum - w->bins[bin] : most;
	}
	w->bins[bin_count] = sum;
	w->entries = nt_scratch_alloc(scratch, sum, sizeof *w->entries);
	w->tables = nt_scratch_alloc(scratch, slots, sizeof *w->tables);
	if (!w->entries || !w->tables)
		return NT_ERROR_MEMORY;
	for (unsigned slot = 0; slot < slots; slot++) {
		w->tables[slot] = nt_scratch_alloc(scratch, 4 * most + 2, sizeof **w->tables);
		if (!w->tables[slot])
			return NT_ERROR_MEMORY;
	}
	nt_parallel_ranges(threads, w->s->mesh->vertex_count, GRAIN, fill_bins, w);
	nt_parallel_items(slots, bin_count, weld_bin, w);
	return NT_OK;
}

/* ---- numbers ---- */

/* What is equal to a recent vertex gets that one's leader, and leaders mark their first corners. */
static void find_leaders(void *context, size_t begin, size_t end, unsigned slot)
{
	const weld *w = context;
	uint32_t *points = w->s->points;
	(void)slot;
	for (size_t v = begin; v < end; v++) {
		if (points[v] == NT_NONE)
			continue;
		if (points[v] == v)
			nt_bit_set(w->leading, w->first ? w->first[v] : v);
		else if (points[points[v]] != points[v])
			points[v] = points[points[v]];
	}
}

static void number_vertices(void *context, size_t begin, size_t end, unsigned slot)
{
	const weld *w = context;
	nt_surface *s = w->s;
	(void)slot;
	for (size_t v = begin; v < end; v++) {
		const uint32_t leader = s->points[v];
		if (leader == NT_NONE)
			continue;
		const uint32_t point = nt_bit_rank(w->leading, w->ranks, w->first ? w->first[leader] : leader);
		const float *uv = s->texcoords ? s->texcoords + 2 * v : NULL;
		s->points[v] = point;
		if (leader != v || (uv && (uv[0] != uv[0] || uv[1] != uv[1])))
			nt_bit_set(s->joints, point);
	}
}

static nt_status number_points(weld *w, unsigned threads, nt_scratch *scratch)
{
	const size_t sides = 3 * w->s->triangle_count, vertices = w->s->mesh->vertex_count;
	w->leading = nt_scratch_alloc(scratch, nt_bit_words(sides), sizeof *w->leading);
	w->ranks = nt_scratch_alloc(scratch, nt_bit_words(sides), sizeof *w->ranks);
	if (!w->leading || !w->ranks)
		return NT_ERROR_MEMORY;
	memset(w->leading, 0, nt_bit_words(sides) * sizeof *w->leading);
	nt_parallel_ranges(threads, vertices, GRAIN, find_leaders, w);
	w->s->point_count = nt_bit_ranks(w->leading, sides, w->ranks);
	nt_parallel_ranges(threads, vertices, GRAIN, number_vertices, w);
	return NT_OK;
}

/* ---- entry ---- */

static unsigned bits_for(size_t count, unsigned most)
{
	unsigned bits = 0;
	while (bits < most && (size_t)1 << bits < count)
		bits++;
	return bits;
}

static nt_status make_weld(weld *w, unsigned slots, nt_scratch *scratch)
{
	const size_t sides = 3 * w->s->triangle_count, vertices = w->s->mesh->vertex_count;
	const size_t used = vertices < sides ? vertices : sides; /* at most */
	w->bin_bits = bits_for(used / BIN_VERTICES, MOST_BIN_BITS);
	w->recent_bits = bits_for(used, MOST_RECENT_BITS);
	w->recent = nt_scratch_alloc(scratch, (size_t)slots << w->recent_bits, sizeof *w->recent);
	w->places = nt_scratch_alloc(scratch, (size_t)slots << w->bin_bits, sizeof *w->places);
	w->bins = nt_scratch_alloc(scratch, ((size_t)1 << w->bin_bits) + 1, sizeof *w->bins);
	if (!w->recent || !w->places || !w->bins)
		return NT_ERROR_MEMORY;
	if (!w->s->vertices)
		return NT_OK;
	w->first = nt_scratch_alloc(scratch, vertices, sizeof *w->first);
	if (w->first)
		memset(w->first, 0xff, vertices * sizeof *w->first);
	return w->first ? NT_OK : NT_ERROR_MEMORY;
}

nt_status nt_surface_weld(nt_surface *s, unsigned threads, nt_scratch *scratch)
{
	const size_t vertices = s->mesh->vertex_count;
	s->points = nt_scratch_alloc(scratch, vertices, sizeof *s->points);
	s->joints = nt_scratch_alloc(scratch, nt_bit_words(vertices), sizeof *s->joints);
	if (!s->points || !s->joints)
		return NT_ERROR_MEMORY;
	memset(s->joints, 0, nt_bit_words(vertices) * sizeof *s->joints);
	const nt_scratch_mark mark = nt_scratch_here(scratch);
	const unsigned slots = nt_parallel_slots(threads, vertices, GRAIN);
	weld w = {.s = s};
	nt_status status = make_weld(&w, slots, scratch);
	if (!status) {
		if (w.first)
			nt_parallel_ranges(threads, 3 * s->triangle_count, GRAIN, find_first, &w);
		nt_parallel_ranges(threads, vertices, GRAIN, sift, &w);
		status = weld_bins(&w, threads, slots, scratch);
	}
	if (!status)
		status = number_points(&w, threads, scratch);
	nt_scratch_back(scratch, mark);
	return status;
}
