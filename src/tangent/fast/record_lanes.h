/* SPDX-License-Identifier: MIT */
/*
 * 16 records by component: loaded, normalised, judged by the rules of tangent/usable.h, stored. Included by settle.h.
 */
#ifndef NT_TANGENT_FAST_RECORD_LANES_H
#define NT_TANGENT_FAST_RECORD_LANES_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include "tangent/fast/turn.h"
#include "tangent/fast/parts.h"
#include "tangent/usable.h"

/* The lanes of records that hold their states, with those bits; 0 in the others. */
#if WIDTH == 16
#define STATES(bits) ((lanes){0, 0, 0, bits, 0, 0, 0, bits, 0, 0, 0, bits, 0, 0, 0, bits})
#elif WIDTH == 8
#define STATES(bits) ((lanes){0, 0, 0, bits, 0, 0, 0, bits})
#elif WIDTH == 4
#define STATES(bits) ((lanes){0, 0, 0, bits})
#endif
#define NO_STATE (NT_STATE_BASE | NT_STATE_ALL)

/* The records of a block by component, in turned places: lane i has the record of vertex turned_place(i). All loops
 * over them run up to `used`, whole vectors that hold the block's vertices; lanes behind these have neither records
 * nor corners. */
typedef struct record_lanes {
	float x[NT_LANES], y[NT_LANES], z[NT_LANES];
	uint32_t state[NT_LANES]; /* then the result's */
	uint32_t present[NT_LANES];
	uint32_t sound[NT_LANES];
} record_lanes;

/* Whether one of `used` values is not 0. */
static inline bool any_of(const uint32_t *values, size_t used)
{
	lanes any = {0};
	for (size_t i = 0; i < used; i += WIDTH)
		any |= load_lanes(values + i);
	return any_lane(any);
}

static inline void read_states(size_t used, record_lanes *NT_RESTRICT r)
{
	for (size_t i = 0; i < used; i++) {
		const uint32_t s = r->state[i];
		r->present[i] = (s & NT_STATE_EMPTY) == 0;
		/* a unit vector is beyond in half of the directions at most: with all bits each u was zero */
		r->sound[i] = ((s & NT_STATE_U) != 0 && (s & NT_STATE_V) != 0 && (s & NT_STATE_SOUND) != 0) ||
			      (s & NT_STATE_U) == NT_STATE_U;
	}
}

/* Records of an orientation that no vertex of the block has. */
static const record_lanes no_records = {.state = {NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE,
	NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE}};

/* Whether the records of a block are no_records, as those of one orientation are in most blocks. */
static inline bool has_no_records(const nt_record *records, size_t used)
{
	lanes all = {0};
	all = ~all;
#if WIDTH > 1
	for (size_t i = 0; i < used; i += WIDTH / 4)
		all &= load_lanes(records + i);
	return !any_lane((lanes)(~all & STATES(NT_STATE_EMPTY | NT_STATE_LOCAL)));
#else
	for (size_t i = 0; i < used; i++)
		all &= records[i].state;
	return !(~all & (NT_STATE_EMPTY | NT_STATE_LOCAL));
#endif
}

static void load_records(const nt_record *NT_RESTRICT records, size_t used, record_lanes *NT_RESTRICT r)
{
	for (size_t i = 0; i < used; i += WIDTH) {
		lanes four[4];
		memcpy(four, records + i, sizeof four);
		turn(four);
		memcpy(r->x + i, &four[0], sizeof *four);
		memcpy(r->y + i, &four[1], sizeof *four);
		memcpy(r->z + i, &four[2], sizeof *four);
		memcpy(r->state + i, &four[3], sizeof *four);
	}
	read_states(used, r);
}

static inline void normalise_records(size_t used, record_lanes *NT_RESTRICT r)
{
	for (size_t i = 0; i < used; i++) {
		const float x = r->x[i], y = r->y[i], z = r->z[i];
		const float scale = 1.0f / sqrtf(x * x + y * y + z * z);
		const int not_zero = (fabsf(x) > FLT_MIN) | (fabsf(y) > FLT_MIN) | (fabsf(z) > FLT_MIN);
		r->x[i] = not_zero ? scale * x : x;
		r->y[i] = not_zero ? scale * y : y;
		r->z[i] = not_zero ? scale * z : z;
	}
}

/* Normals of `count` vertices in turned places; lanes behind repeat the last one. */
static void load_normals(const nt_weld_row *rows, size_t count, size_t used, float normals[3][NT_LANES])
{
	for (size_t first = 0; first < used; first += WIDTH) {
		const float *from[WIDTH]; /* of rows, from the third float on */
		lanes four[4];
		for (size_t i = first; i < first + WIDTH; i++)
			from[i - first] = (const float *)&rows[i < count ? i : count - 1] + 2;
		load_turned(from, four);
		for (size_t c = 0; c < 3; c++)
			memcpy(normals[c] + first, &four[c + 1], sizeof *four);
	}
}

/* Which results tangent/usable.c would not accept: triangles at other vertices need no look. */
static inline void find_unusable(const float (*NT_RESTRICT normals)[NT_LANES], const record_lanes *NT_RESTRICT r,
	uint32_t *NT_RESTRICT unusable, size_t used)
{
	for (size_t i = 0; i < used; i++) {
		const float t[3] = {r->x[i], r->y[i], r->z[i]};
		const float n[3] = {normals[0][i], normals[1][i], normals[2][i]};
		unusable[i] = r->present[i] & !nt_is_surely_frame(t, n);
	}
}

/* Stores `count` records, `step` apart. If that is 1, there is room for `used`. */
static void store_records(nt_record *NT_RESTRICT records, size_t step, size_t count, size_t used,
	const record_lanes *NT_RESTRICT r, const uint32_t *NT_RESTRICT state)
{
	nt_record copy[NT_LANES];
	nt_record *to = step == 1 ? records : copy;
	for (size_t i = 0; i < used; i += WIDTH) {
		lanes four[4] = {load_lanes(r->x + i), load_lanes(r->y + i), load_lanes(r->z + i),
			load_lanes(state + i)};
		turn(four);
		memcpy(to + i, four, sizeof four);
	}
	for (size_t i = 0; to == copy && i < count; i++)
		records[2 * i] = copy[i]; /* pairs: nt_fast_place_records() */
}

#endif
