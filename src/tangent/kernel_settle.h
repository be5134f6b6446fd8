/* SPDX-License-Identifier: MIT */
/*
 * The second pass: 16 vertices at a time. A vertex is settled when the corners of each orientation make one fan
 * (step 6 would flood them in one go) and no two directions can be antiparallel (step 7 would not
 * split them). Then its sums are its results. Included by kernel.h.
 */
#ifndef NT_TANGENT_KERNEL_SETTLE_H
#define NT_TANGENT_KERNEL_SETTLE_H

#include "tangent/kernel_lanes.h"

/* Vectors of the set's own width, for what the compiler does not make of loops. */
#if defined(__AVX512F__)
enum { WIDTH = 16 };
#define EVEN 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30
#define ODD 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31
#elif defined(__AVX2__)
enum { WIDTH = 8 };
#define EVEN 0, 2, 4, 6, 8, 10, 12, 14
#define ODD 1, 3, 5, 7, 9, 11, 13, 15
#else
enum { WIDTH = 4 };
#define EVEN 0, 2, 4, 6
#define ODD 1, 3, 5, 7
#endif
typedef uint32_t lanes __attribute__((vector_size(4 * WIDTH)));

static inline lanes load_lanes(const void *from)
{
	lanes result;
	memcpy(&result, from, sizeof result);
	return result;
}

/* The fans of WIDTH vertices by corner. */
typedef struct fans {
	lanes next[NT_FAN_DEPTH], previous[NT_FAN_DEPTH];
	lanes linked[NT_FAN_DEPTH]; /* corner i: bit j for each neighbour j of its orientation */
} fans;

/* Loads entries, voids where a vertex has fewer corners than the block is deep. */
static inline void load_fans(const nt_fan_entry *entries, uint32_t depth, lanes degree, lanes mask, fans *f)
{
	for (uint32_t k = 0; k < depth; k++, entries += NT_FAN_LANES) {
		const lanes low = load_lanes(entries), high = load_lanes(entries + WIDTH / 2);
		const lanes next = __builtin_shufflevector(low, high, EVEN) & mask;
		const lanes previous = __builtin_shufflevector(low, high, ODD) & mask;
		const lanes there = (lanes)(degree > k);
		/* above all numbers that accumulate gives to voids */
		f->next[k] = (next & there) | ((NT_ENTRY_VOID | 1u << 28 | k) & ~there);
		f->previous[k] = (previous & there) | ((NT_ENTRY_VOID | 3u << 28 | k) & ~there);
		f->linked[k] = there & 0;
	}
}

/* Links corners across shared edges. Returns all ones where a directed edge occurs twice: there pairs depend
 * on order. */
static inline lanes link_fans(uint32_t depth, fans *f)
{
	lanes doubtful = {0};
	for (uint32_t a = 0; a + 1 < depth; a++) {
		const lanes na = f->next[a], pa = f->previous[a];
		lanes linked = f->linked[a];
		for (uint32_t b = a + 1; b < depth; b++) {
			const lanes nb = f->next[b], pb = f->previous[b];
			const lanes link = (lanes)(na == pb) | (lanes)(nb == pa);
			/* compared without the orientation in bit 31 */
			doubtful |= (lanes)((na ^ nb) << 1 == 0) | (lanes)((pa ^ pb) << 1 == 0);
			linked |= link & 1u << b;
			f->linked[b] |= link & 1u << a;
		}
		f->linked[a] = linked;
	}
	return doubtful;
}

/* Counts components by elimination: a corner hands its links to the later ones it is linked with; one that
 * has none when its turn comes is the last of its component. */
static inline lanes count_fans(uint32_t depth, const fans *fan, lanes *linked)
{
	lanes count = {0};
	for (uint32_t a = 0; a < depth; a++) {
		const lanes mine = linked[a];
		for (uint32_t b = a + 1; b < depth; b++)
			linked[b] |= (lanes)((mine & 1u << b) != 0) & mine;
		const lanes last = (lanes)(mine >> a >> 1 == 0) & (lanes)((fan->next[a] & NT_ENTRY_VOID) == 0);
		count -= last;
	}
	return count;
}

/* The records of a block by component. */
typedef struct record_lanes {
	float x[NT_LANES], y[NT_LANES], z[NT_LANES];
	uint32_t state[NT_LANES]; /* then the result's */
	uint32_t present[NT_LANES];
	uint32_t sound[NT_LANES];
} record_lanes;

static void load_records(const nt_record *restrict records, size_t count, record_lanes *restrict r)
{
	nt_record copy[NT_LANES];
	if (!records || count < NT_LANES) {
		for (int i = 0; i < NT_LANES; i++)
			copy[i] = (nt_record){0, 0, 0, NT_STATE_BASE | NT_STATE_ALL};
		if (records)
			memcpy(copy, records, count * sizeof *copy);
		records = copy;
	}
	for (size_t i = 0; i < NT_LANES; i += 4) {
		nt_float4 four[4];
		memcpy(four, records + i, sizeof four);
		turn(four);
		memcpy(r->x + i, &four[0], sizeof *four);
		memcpy(r->y + i, &four[1], sizeof *four);
		memcpy(r->z + i, &four[2], sizeof *four);
		memcpy(r->state + i, &four[3], sizeof *four);
	}
	for (int i = 0; i < NT_LANES; i++) {
		const uint32_t s = r->state[i];
		r->present[i] = (s & NT_STATE_EMPTY) == 0;
		r->sound[i] = (s & NT_STATE_U) != 0 && (s & NT_STATE_V) != 0 && (s & NT_STATE_SOUND) != 0;
	}
}

static void normalise_records(record_lanes *restrict r)
{
	for (int i = 0; i < NT_LANES; i++) {
		const float x = r->x[i], y = r->y[i], z = r->z[i];
		const float scale = 1.0f / sqrtf(x * x + y * y + z * z);
		const int not_zero = (fabsf(x) > FLT_MIN) | (fabsf(y) > FLT_MIN) | (fabsf(z) > FLT_MIN);
		r->x[i] = not_zero ? scale * x : x;
		r->y[i] = not_zero ? scale * y : y;
		r->z[i] = not_zero ? scale * z : z;
	}
}

/* Settled results that judge.c would not accept. */
static size_t count_unusable(const nt_weld_row *rows, size_t count, const record_lanes *restrict r,
	const uint32_t *restrict complex)
{
	uint32_t unusable = 0;
	for (size_t i = 0; i < count; i++) {
		const float t[3] = {r->x[i], r->y[i], r->z[i]};
		const float *n = (const float *)&rows[i] + 3;
		const float squared = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
		const int good = (fabsf(squared - 1.0f) <= NT_UNIT_TOLERANCE) & !nt_is_parallel(t, n);
		unusable += r->present[i] & !complex[i] & !good;
	}
	return unusable;
}

static void store_records(nt_record *restrict records, size_t count, const record_lanes *restrict r)
{
	nt_record copy[NT_LANES];
	nt_record *to = count == NT_LANES ? records : copy;
	for (size_t i = 0; i < NT_LANES; i += 4) {
		nt_float4 four[4];
		memcpy(&four[0], r->x + i, sizeof *four);
		memcpy(&four[1], r->y + i, sizeof *four);
		memcpy(&four[2], r->z + i, sizeof *four);
		memcpy(&four[3], r->state + i, sizeof *four);
		turn(four);
		memcpy(to + i, four, sizeof four);
	}
	if (to == copy)
		memcpy(records, copy, count * sizeof *copy);
}

static void normalise3(float *x, float *y, float *z)
{
	if (!(fabsf(*x) > FLT_MIN || fabsf(*y) > FLT_MIN || fabsf(*z) > FLT_MIN))
		return;
	const float scale = 1.0f / sqrtf(*x * *x + *y * *y + *z * *z);
	*x = scale * *x, *y = scale * *y, *z = scale * *z;
}

static void settle_more(nt_record_more *more, size_t count, const uint32_t *present)
{
	for (size_t i = 0; i < count; i++) {
		nt_record_more *m = &more[i];
		if (!present[i]) {
			*m = (nt_record_more){.y = 1.0f, .mag_s = 1.0f, .mag_t = 1.0f};
			continue;
		}
		normalise3(&m->x, &m->y, &m->z);
		if (m->angle > 0.0f) {
			m->mag_s /= m->angle;
			m->mag_t /= m->angle;
		}
	}
}

/* Corners of the block's vertices, and which of its vertices are hubs. Returns the most corners. */
static uint32_t load_degrees(const nt_adjacency *a, size_t first, size_t count, uint32_t *restrict degree,
	uint32_t *restrict hub)
{
	const size_t place = first - a->first_vertex;
	const uint32_t *cursors = a->cursors + (a->ranges - 1) * a->vertex_count + place;
	const uint32_t begin = a->block_begin[place / NT_FAN_LANES];
	uint32_t most = 0;
	for (size_t i = 0; i < NT_LANES; i++) {
		const uint32_t cursor = i < count ? cursors[i] : begin;
		hub[i] = cursor >> 31;
		degree[i] = hub[i] ? 0 : ((cursor & NT_CURSOR_PLACE) - begin) / NT_FAN_LANES;
		most = degree[i] > most ? degree[i] : most;
	}
	return most;
}

static void settle_block(nt_fast *fast, const nt_adjacency *a, size_t block, nt_settled *settled)
{
	const size_t first = block * NT_LANES, left = fast->vertex_count - first;
	const size_t count = left < NT_LANES ? left : NT_LANES;
	const nt_fan_entry *entries = a->entries + a->block_begin[block - a->first_vertex / NT_FAN_LANES];
	uint32_t degree[NT_LANES], hub[NT_LANES], mask[NT_LANES], complex[NT_LANES];
	uint32_t doubtful[NT_LANES], fan_count[NT_LANES];
	record_lanes r[2];
	const uint32_t depth = load_degrees(a, first, count, degree, hub);
	for (int o = 0; o < 2; o++)
		load_records(fast->records[o] ? fast->records[o] + first : NULL, count, &r[o]);

	/* "any" corners join whatever orientation there is: with one only, it need not be compared */
	for (int i = 0; i < NT_LANES; i++)
		mask[i] = r[0].present[i] & r[1].present[i] ? UINT32_MAX : NT_ENTRY_VERTEX;
	for (size_t i = 0; i < NT_LANES; i += WIDTH) {
		fans f;
		load_fans(entries + i, depth, load_lanes(degree + i),
			load_lanes(mask + i), &f);
		const lanes twice = link_fans(depth, &f), counted = count_fans(depth, &f, f.linked);
		memcpy(doubtful + i, &twice, sizeof twice);
		memcpy(fan_count + i, &counted, sizeof counted);
	}

	for (int i = 0; i < NT_LANES; i++) {
		const uint32_t both = r[0].state[i] & r[1].state[i];
		const uint32_t present = r[0].present[i] + r[1].present[i];
		const uint32_t unsound = (r[0].present[i] & !r[0].sound[i]) | (r[1].present[i] & !r[1].sound[i]);
		const uint32_t mixed = present == 2 && !(both & NT_STATE_NO_ANY);
		complex[i] = present != 0 && 0 != (unsound | mixed | hub[i] | doubtful[i] |
						     !(both & NT_STATE_LOCAL) | (fan_count[i] != present));
	}
	for (int o = 0; o < 2; o++) {
		if (!fast->records[o])
			continue;
		normalise_records(&r[o]);
		if (fast->solve->vouched)
			settled->unusable_count += count_unusable(fast->rows + first, count, &r[o], complex);
		const uint32_t sign = o ? NT_RESULT_PLUS : NT_RESULT_MINUS;
		for (int i = 0; i < NT_LANES; i++) {
			const uint32_t none = r[0].present[i] | r[1].present[i];
			/* no group at all: the default of step 10 */
			r[o].x[i] = none ? r[o].x[i] : 1.0f;
			r[o].state[i] = complex[i] ? NT_RESULT_COMPLEX
				: r[o].present[i] ? sign : none ? NT_RESULT_NONE : NT_RESULT_MINUS;
		}
		store_records(fast->records[o] + first, count, &r[o]);
		if (fast->wants_more)
			settle_more(fast->more[o] + first, count, r[o].present);
	}
	for (size_t i = 0; i < count; i++)
		settled->complex_count += complex[i];
}

static void settle(nt_fast *fast, const nt_adjacency *adjacency, size_t begin, size_t end,
	nt_settled *settled)
{
	for (size_t block = begin; block < end; block++)
		settle_block(fast, adjacency, block, settled);
}

#endif
