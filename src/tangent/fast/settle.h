/* SPDX-License-Identifier: MIT */
/*
 * The second pass: 16 vertices at a time. A vertex is settled when the corners of each orientation make one fan
 * (step 6 would flood them in one go) and no two directions can be antiparallel (step 7 would not
 * split them). Then its sums are its results. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_SETTLE_H
#define NT_TANGENT_FAST_SETTLE_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#include "base/vec.h"
#include "tangent/fast/fan_lanes.h"
#include "tangent/fast/parts.h"
#include "tangent/fast/turn.h"
#include "tangent/frames.h"

/* ---- 16 records by component: loaded, normalised, judged by the rules of tangent/frames.h, stored ---- */

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

/* ---- a block of vertices ---- */

static void settle_more(nt_record_more *more, size_t count, const uint32_t *present)
{
	for (size_t i = 0; i < NT_LANES; i++) {
		nt_record_more *m = &more[turned_place(i)];
		if (turned_place(i) >= count)
			continue;
		if (!present[i]) {
			*m = (nt_record_more){.y = 1.0f, .mag_s = 1.0f, .mag_t = 1.0f};
			continue;
		}
		const nt_vec3 bitangent = nt_vec3_normalise_safe((nt_vec3){m->x, m->y, m->z});
		m->x = bitangent.x, m->y = bitangent.y, m->z = bitangent.z;
		if (m->angle > 0.0f) {
			m->mag_s /= m->angle;
			m->mag_t /= m->angle;
		}
	}
}

/* Corners of the block's vertices, HUB for a hub; and the most of each WIDTH of them. */
static void load_degrees(const nt_adjacency *a, size_t first, size_t count, size_t used, uint32_t *NT_RESTRICT degree,
	uint32_t *NT_RESTRICT most)
{
	const size_t place = first - a->first_vertex;
	const uint32_t *cursors = a->cursors + (a->ranges - 1) * a->vertex_count + place;
	const uint32_t begin = nt_adjacency_is_narrow(a) ? (uint32_t)place : a->block_begin[place / NT_FAN_LANES];
	/* places of a block are few enough for floats to be divided as integers are */
	const float corners_a_place = 1.0f / (float)a->step;
	for (uint32_t v = 0; v < used; v += WIDTH) {
		int deepest = 0;
		for (uint32_t i = v; i < v + WIDTH; i++) {
			const uint32_t cursor = cursors[i];
			const int corners =
				(int)(((float)(int)((cursor & NT_CURSOR_PLACE) - begin) + 0.5f) * corners_a_place);
			const uint32_t there = i < (uint32_t)count ? UINT32_MAX : 0;
			const uint32_t hub = cursor & NT_CURSOR_HUB ? UINT32_MAX : 0;
			const int known = (int)((uint32_t)corners & there & ~hub);
			deepest = known > deepest ? known : deepest;
			degree[i] = (uint32_t)known | (hub & there);
		}
		most[v / WIDTH] = (uint32_t)deepest;
	}
}

/* Data of a block's complex vertices for complex.c goes to their records: see NT_RESULT_COMPLEX. */
static void describe_complex(const nt_fast *fast, const nt_adjacency *a, size_t first, size_t used,
	const uint32_t *complex, const uint32_t *fan_count, nt_settled *settled)
{
	const size_t place = first - a->first_vertex;
	const uint32_t *cursors = a->cursors + (a->ranges - 1) * a->vertex_count + place;
	const vertex_entries entries = entries_at(a, place);
	const size_t begin = nt_adjacency_is_narrow(a) ? place : a->block_begin[place / NT_FAN_LANES];
	for (size_t i = 0; i < used; i++) {
		if (!complex[i])
			continue;
		const size_t lane = turned_place(i);
		const uint32_t places = cursors[lane] & NT_CURSOR_PLACE, tangled = fan_count[i] >= DOUBTFUL;
		uint32_t corners = 0;
		if (cursors[lane] & NT_CURSOR_HUB)
			corners = places;
		else
			for (size_t e = lane; e < places - begin; e += entries.step)
				corners += !(entries.are_narrow ? entries.narrow[e] & NT_ENTRY_VOID >> 16
					: entries.wide[e].next & NT_ENTRY_VOID);
		for (int o = 0; o < 2; o++)
			if (fast->records[o])
				nt_fast_record(fast, o, (uint32_t)(first + lane))->state |= corners | tangled *
					NT_RESULT_TANGLED;
		settled->complex_count++;
		settled->complex_corners += corners;
		settled->tangled_count += tangled;
		settled->tangled_corners += tangled * corners;
		if (tangled && corners > settled->most_tangled)
			settled->most_tangled = corners;
	}
}

static void settle_block(nt_fast *fast, const nt_adjacency *a, nt_record *const sums[2], size_t block,
	nt_settled *settled)
{
	const size_t first = block * NT_LANES, left = fast->vertex_count - first;
	const size_t count = left < NT_LANES ? left : NT_LANES;
	const size_t used = whole_lanes(count);
	const vertex_entries entries = entries_at(a, first - a->first_vertex);
	uint32_t degree[NT_LANES], mask[NT_LANES], fan_count[NT_LANES], complex[NT_LANES], unsound[NT_LANES];
	uint32_t depths[NT_LANES / WIDTH], unusable[2][NT_LANES] = {{0}};
	record_lanes own[2];
	const record_lanes *r[2];
	bool there[2], has_unusable = false;
	load_degrees(a, first, count, used, degree, depths);
	for (int o = 0; o < 2; o++) {
		const nt_record *from = sums[o] ? sums[o] + first - a->first_vertex : NULL;
		there[o] = from && !has_no_records(from, used);
		r[o] = there[o] ? &own[o] : &no_records;
		if (there[o])
			load_records(from, used, &own[o]);
	}

	/* "any" corners join whatever orientation there is: with one only, it need not be compared */
	for (size_t i = 0; i < used; i++)
		mask[i] = r[0]->present[i] & r[1]->present[i] ? UINT32_MAX : NT_ENTRY_VERTEX;
	for (size_t i = 0; i < used; i += WIDTH) {
		const lanes degrees = load_lanes(degree + i), masks = load_lanes(mask + i),
			hubs = LANES_WHERE(degrees == HUB);
		const lanes usual = degrees & ~hubs, mask_of = out_of_turn(masks);
		const lanes counted = (hubs & DOUBTFUL) | (nt_adjacency_is_narrow(a)
			? count_narrow_fans(entries.narrow + i, entries.step, depths[i / WIDTH], usual, mask_of)
			: count_wide_fans(entries.wide + i, depths[i / WIDTH], usual, mask_of));
		const lanes turned = in_turn(counted);
		memcpy(fan_count + i, &turned, sizeof turned);
	}

	for (size_t i = 0; i < used; i++) {
		const uint32_t both = r[0]->state[i] & r[1]->state[i];
		const uint32_t present = r[0]->present[i] + r[1]->present[i];
		unsound[i] = (r[0]->present[i] & !r[0]->sound[i]) | (r[1]->present[i] & !r[1]->sound[i]);
		const uint32_t mixed = present == 2 && !(both & NT_STATE_NO_ANY);
		complex[i] = present != 0 && 0 != (unsound[i] | mixed | !(both & NT_STATE_LOCAL) |
						     (fan_count[i] != present));
	}
	float normals[3][NT_LANES];
	const bool judges = nt_fast_judges(fast->solve);
	if (judges)
		load_normals(fast->rows + first, count, used, normals);
	for (int o = 0; o < 2; o++) {
		if (!there[o])
			continue;
		normalise_records(used, &own[o]);
		if (judges)
			find_unusable(normals, &own[o], unusable[o], used);
		has_unusable |= any_of(unusable[o], used);
	}
	const bool has_complex = any_of(complex, used);
	if (has_unusable)
		nt_fast_tell_open(fast->solve);
	if (fast->open)
		fast->open[block] = has_complex | has_unusable;
	/* from here on the rows may be overwritten */
	for (int o = 0; o < 2; o++) {
		if (!sums[o])
			continue;
		if (!there[o] && !has_complex && count == NT_LANES && fast->record_step == 1 && !fast->wants_more) {
			memset(nt_fast_record(fast, o, (uint32_t)first), 0, NT_LANES * sizeof(nt_record));
			continue;
		}
		const uint32_t sign = o ? NT_RESULT_PLUS : NT_RESULT_MINUS;
		uint32_t state[NT_LANES];
		/* with masks, since gcc 12 makes branches of the same with conditions */
		for (size_t i = 0; i < used; i++) {
			const uint32_t bad = unusable[0][i] | unusable[1][i];
			const uint32_t open = NT_RESULT_COMPLEX | (((unsound[i] | bad) - 1) & NT_RESULT_SUM);
			state[i] = (-complex[i] & open) | ((complex[i] - 1) & -r[o]->present[i] & (sign | bad));
		}
		store_records(nt_fast_record(fast, o, (uint32_t)first), fast->record_step, count, used, r[o], state);
		if (fast->wants_more)
			settle_more(fast->more[o] + first, count, r[o]->present);
	}
	if (has_complex)
		describe_complex(fast, a, first, used, complex, fan_count, settled);
}

static void kernel_settle(nt_fast *fast, const nt_adjacency *adjacency, nt_record *const sums[2], size_t begin,
	size_t end, nt_settled *settled)
{
	for (size_t block = begin; block < end; block++)
		settle_block(fast, adjacency, sums, block, settled);
}

#endif
