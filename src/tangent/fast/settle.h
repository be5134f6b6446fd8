/* SPDX-License-Identifier: MIT */
/*
 * The second pass: 16 vertices at a time. A vertex is settled when the corners of each orientation make one fan
 * (step 6 would flood them in one go) and no two directions can be antiparallel (step 7 would not
 * split them). Then its sums are its results. Included by kernel.h.
 */
#ifndef NT_TANGENT_FAST_SETTLE_H
#define NT_TANGENT_FAST_SETTLE_H

#include "base/vec.h"
#include "tangent/fast/lanes.h"

/* Degree of a hub, whose fans are not looked at; a number of fans that no vertex has. */
#define HUB UINT32_MAX
#define DOUBTFUL ((uint32_t)1 << 16)

/* The loops over a fan are worth their code, but not where each byte of it is sent to a browser. */
#ifdef __wasm__
#define UNROLL
#else
#define UNROLL _Pragma("GCC unroll 8")
#endif

/* Entries of vertices that follow one another, from the first one's first: these or those. */
typedef struct vertex_entries {
	bool are_narrow;
	const nt_fan_entry *wide;
	const uint32_t *narrow;
	size_t step;
} vertex_entries;

static inline vertex_entries entries_at(const nt_adjacency *a, size_t vertex)
{
	if (nt_adjacency_is_narrow(a))
		return (vertex_entries){.are_narrow = true, .narrow = a->narrow + vertex, .step = a->step};
	return (vertex_entries){.wide = nt_adjacency_block(a, vertex / NT_FAN_LANES) + vertex % NT_FAN_LANES,
		.step = NT_FAN_LANES};
}

/* Corner k of WIDTH vertices of so many corners; where one has fewer, voids above all numbers that accumulate gives to
 * voids. Of an entry the bits of `mask` count. The numbers of narrow entries are in the upper halves. */
static inline __attribute__((always_inline)) void load_corners(vertex_entries entries, uint32_t k, lanes degree, lanes mask,
	lanes *next, lanes *previous)
{
	const lanes there = (lanes)(degree > k);
	if (entries.are_narrow) {
		const lanes both = load_lanes(entries.narrow + k * entries.step);
		*next = both << 16 & mask;
		*previous = both & 0xffff0000u & mask;
	} else {
		const nt_fan_entry *from = entries.wide + k * NT_FAN_LANES;
		const lanes low = load_lanes(from), high = load_lanes(from + WIDTH / 2);
		*next = __builtin_shufflevector(low, high, EVEN) & mask;
		*previous = __builtin_shufflevector(low, high, ODD) & mask;
	}
	*next = (*next & there) | ((NT_ENTRY_VOID | 1u << 28 | k << 16 | k) & ~there);
	*previous = (*previous & there) | ((NT_ENTRY_VOID | 3u << 28 | k << 16 | k) & ~there);
}

/* -1 for vertices at which a directed edge occurs twice, whatever the orientations in bit 31. */
static lanes __attribute__((noinline)) find_twice(vertex_entries entries, uint32_t depth, lanes degree, lanes mask)
{
	lanes twice = {0};
	for (uint32_t b = 1; b < depth; b++) {
		lanes next, previous;
		load_corners(entries, b, degree, mask, &next, &previous);
		for (uint32_t a = 0; a < b; a++) {
			lanes other_next, other_previous;
			load_corners(entries, a, degree, mask, &other_next, &other_previous);
			twice |= (lanes)(next << 1 == other_next << 1) | (lanes)(previous << 1 == other_previous << 1);
		}
	}
	return twice;
}

/* The components of corners that are linked: bit j, times `unit`, of linked[i] for each later neighbour j. Those with
 * a bit of `voids` are none. By elimination: a corner hands its links to the later ones it is linked with; one that has
 * none when its turn comes is the last of its component. */
static inline __attribute__((always_inline)) lanes count_components(lanes linked[NT_FAN_DEPTH], uint32_t depth, uint32_t unit,
	uint32_t voids)
{
	lanes count = {0};
	UNROLL
	for (uint32_t a = 0; a < depth; a++) {
		const lanes mine = linked[a];
		UNROLL
		for (uint32_t b = a + 1; b < depth; b++)
			linked[b] = with_bits(linked[b], having_bit(mine, unit << b), mine);
		count = one_more_without(count, mine, unit * ((1u << depth) - (2u << a)) | voids);
	}
	return count;
}

/*
 * The fans of WIDTH vertices with at most `depth` corners: how many there are, DOUBTFUL added where a directed edge
 * occurs twice, because there pairs depend on order.
 *
 *   degree   corners of each vertex
 *   mask     the bits of entries that count
 */
static inline __attribute__((always_inline)) lanes count_wide_fans_of(vertex_entries entries, const uint32_t depth,
	lanes degree, lanes mask)
{
	lanes next[NT_FAN_DEPTH], previous[NT_FAN_DEPTH];
	lanes linked[NT_FAN_DEPTH];
	lanes halves[NT_FAN_DEPTH]; /* those of next and of previous in which vertices differ most, without orientation */
	half_set distinct = ALL_HALVES;
	UNROLL
	for (uint32_t k = 0; k < depth; k++) {
		load_corners(entries, k, degree, mask, &next[k], &previous[k]);
		halves[k] = (next[k] & 0xffff) | previous[k] << 16;
		linked[k] = (next[k] & NT_ENTRY_VOID) | ((1u << depth) - (2u << k));
	}
	/* links across shared edges; edges whose low halves differ are not the same */
	UNROLL
	for (uint32_t b = 0; b < depth; b++) {
		half_set from_earlier = ALL_HALVES; /* short chains: one for all took 15 to 40 cycles more a block */
		UNROLL
		for (uint32_t a = 0; a < b; a++) {
			const lane_set apart = differ(differ(ALL_LANES, next[a], previous[b]), next[b], previous[a]);
			linked[a] = without_bit(linked[a], apart, 1u << b);
			from_earlier = halves_differ(from_earlier, halves[a], halves[b]);
		}
		distinct = common_halves(distinct, from_earlier);
	}
	const lanes count = count_components(linked, depth, 1, NT_ENTRY_VOID);
	return all_halves(distinct) ? count : count | (find_twice(entries, depth, degree, mask) & DOUBTFUL);
}

/* The same of narrow entries, as halves of lanes: next and previous of one corner are compared with previous and next
 * of another at once, and a lane has its links in either half. */
static inline __attribute__((always_inline)) lanes count_narrow_fans_of(vertex_entries entries, const uint32_t depth,
	lanes degree, lanes mask)
{
	enum { BOTH = 0x10001, VOIDS = BOTH * (NT_ENTRY_VOID >> 16) };
	lanes entry[NT_FAN_DEPTH], plain[NT_FAN_DEPTH]; /* plain: without orientation */
	lanes linked[NT_FAN_DEPTH];
	half_set distinct = ALL_HALVES;
	const lanes mask_of_halves = (mask & 0xffff0000u) | mask >> 16;
	UNROLL
	for (uint32_t k = 0; k < depth; k++) {
		const lanes there = (lanes)(degree > k);
		const lanes both = (load_lanes(entries.narrow + k * entries.step) & there) | ((0x70005000u + BOTH * k) & ~there);
		entry[k] = both & mask_of_halves;
		plain[k] = both & ~(BOTH * (NT_ENTRY_ORIENT >> 16));
		linked[k] = both & VOIDS;
	}
	UNROLL
	for (uint32_t b = 1; b < depth; b++) {
		const lanes other_way = entry[b] << 16 | entry[b] >> 16;
		half_set from_others = ALL_HALVES; /* short chains, as above */
		UNROLL
		for (uint32_t a = 0; a < b; a++) {
			linked[a] = with_bit_where_same(linked[a], entry[a], other_way, (uint32_t)BOTH << b);
			from_others = halves_differ(from_others, plain[a], plain[b]);
		}
		distinct = common_halves(distinct, from_others);
	}
	const lanes count = count_components(linked, depth, BOTH, VOIDS);
	return all_halves(distinct) ? count : count | (find_twice(entries, depth, degree, mask) & DOUBTFUL);
}

static inline __attribute__((always_inline)) lanes count_fans_of(vertex_entries entries, const uint32_t depth,
	lanes degree, lanes mask)
{
	return entries.are_narrow ? count_narrow_fans_of(entries, depth, degree, mask)
		: count_wide_fans_of(entries, depth, degree, mask);
}

/* The usual depths are worth a loop without branches each. */
static inline __attribute__((always_inline)) lanes count_fans_at(vertex_entries entries, uint32_t depth, lanes degree,
	lanes mask)
{
	switch (depth) {
#ifndef __wasm__
	case 2: return count_fans_of(entries, 2, degree, mask);
	case 3: return count_fans_of(entries, 3, degree, mask);
	case 4: return count_fans_of(entries, 4, degree, mask);
	case 5: return count_fans_of(entries, 5, degree, mask);
	case 6: return count_fans_of(entries, 6, degree, mask);
	case 7: return count_fans_of(entries, 7, degree, mask);
	case 8: return count_fans_of(entries, 8, degree, mask);
#endif
	default: return count_fans_of(entries, depth, degree, mask);
	}
}

static lanes __attribute__((noinline)) count_wide_fans(const nt_fan_entry *entries, uint32_t depth, lanes degree, lanes mask)
{
	return count_fans_at((vertex_entries){.wide = entries}, depth, degree, mask);
}

static lanes __attribute__((noinline)) count_narrow_fans(const uint32_t *entries, size_t step, uint32_t depth, lanes degree,
	lanes mask)
{
	return count_fans_at((vertex_entries){.are_narrow = true, .narrow = entries, .step = step}, depth, degree, mask);
}

/* The lanes of records that hold their states, with those bits; 0 in the others. */
#if WIDTH == 16
#define STATES(bits) ((lanes){0, 0, 0, bits, 0, 0, 0, bits, 0, 0, 0, bits, 0, 0, 0, bits})
#elif WIDTH == 8
#define STATES(bits) ((lanes){0, 0, 0, bits, 0, 0, 0, bits})
#else
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

static inline void read_states(size_t used, record_lanes *restrict r)
{
	for (size_t i = 0; i < used; i++) {
		const uint32_t s = r->state[i];
		r->present[i] = (s & NT_STATE_EMPTY) == 0;
		r->sound[i] = (s & NT_STATE_U) != 0 && (s & NT_STATE_V) != 0 && (s & NT_STATE_SOUND) != 0;
	}
}

/* Those of an orientation that no vertex of the block has. */
static const record_lanes no_records = {.state = {NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE,
	NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE, NO_STATE}};

/* Whether the records of a block are no_records, as those of one orientation are in most blocks. */
static inline bool has_no_records(const nt_record *records, size_t used)
{
	lanes all = {0};
	all = ~all;
	for (size_t i = 0; i < used; i += WIDTH / 4)
		all &= load_lanes(records + i);
	return !any_lane((lanes)(~all & STATES(NT_STATE_EMPTY | NT_STATE_LOCAL)));
}

static void load_records(const nt_record *restrict records, size_t used, record_lanes *restrict r)
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

static inline void normalise_records(size_t used, record_lanes *restrict r)
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
		lanes four[4];
		for (size_t j = 0; j < 4; j++) {
			const float *parts[WIDTH / 4]; /* of rows, from the third float on */
			for (size_t i = 0; i < WIDTH / 4; i++) {
				const size_t row = first + j * (WIDTH / 4) + i;
				parts[i] = (const float *)&rows[row < count ? row : count - 1] + 2;
			}
			four[j] = load_parts(parts);
		}
		turn(four);
		for (size_t c = 0; c < 3; c++)
			memcpy(normals[c] + first, &four[c + 1], sizeof *four);
	}
}

/* Which results tangent/usable.c would not accept: triangles at other vertices need no look. */
static inline void find_unusable(const float (*restrict normals)[NT_LANES], const record_lanes *restrict r,
	uint32_t *restrict unusable, size_t used)
{
	for (size_t i = 0; i < used; i++) {
		const float t[3] = {r->x[i], r->y[i], r->z[i]};
		const float n[3] = {normals[0][i], normals[1][i], normals[2][i]};
		unusable[i] = r->present[i] & !nt_is_frame(t, n);
	}
}

/* Stores `count` records, `step` apart. */
static void store_records(nt_record *restrict records, size_t step, size_t count, size_t used,
	const record_lanes *restrict r, const uint32_t *restrict state)
{
	nt_record copy[NT_LANES];
	nt_record *to = count == used && step == 1 ? records : copy;
	for (size_t i = 0; i < used; i += WIDTH) {
		lanes four[4] = {load_lanes(r->x + i), load_lanes(r->y + i), load_lanes(r->z + i),
			load_lanes(state + i)};
		turn(four);
		memcpy(to + i, four, sizeof four);
	}
	for (size_t i = 0; to == copy && i < count; i++)
		records[step * i] = copy[i];
}

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
static void load_degrees(const nt_adjacency *a, size_t first, size_t count, size_t used, uint32_t *restrict degree,
	uint32_t *restrict most)
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
			const int corners = (int)(((float)(int)((cursor & NT_CURSOR_PLACE) - begin) + 0.5f) * corners_a_place);
			const uint32_t there = i < (uint32_t)count ? UINT32_MAX : 0;
			const uint32_t hub = cursor & NT_CURSOR_HUB ? UINT32_MAX : 0;
			const int known = (int)((uint32_t)corners & there & ~hub);
			deepest = known > deepest ? known : deepest;
			degree[i] = (uint32_t)known | (hub & there);
		}
		most[v / WIDTH] = (uint32_t)deepest;
	}
}

/* What complex.c wants to know of a block's complex vertices goes to their records: see NT_RESULT_COMPLEX. */
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
				corners += !(entries.are_narrow ? entries.narrow[e] & NT_ENTRY_VOID >> 16 : entries.wide[e].next & NT_ENTRY_VOID);
		for (int o = 0; o < 2; o++)
			if (fast->records[o])
				nt_fast_record(fast, o, (uint32_t)(first + lane))->state |= corners | tangled * NT_RESULT_TANGLED;
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
	bool there[2];
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
		const lanes degrees = load_lanes(degree + i), masks = load_lanes(mask + i), hubs = (lanes)(degrees == HUB);
		const lanes usual = degrees & ~hubs, mask_of = __builtin_shufflevector(masks, masks, UNTURNED);
		const lanes counted = (hubs & DOUBTFUL) | (nt_adjacency_is_narrow(a)
			? count_narrow_fans(entries.narrow + i, entries.step, depths[i / WIDTH], usual, mask_of)
			: count_wide_fans(entries.wide + i, depths[i / WIDTH], usual, mask_of));
		const lanes turned = __builtin_shufflevector(counted, counted, TURNED);
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
		if (NT_SHORT_WAYS && any_of(unusable[o], used))
			nt_fast_tell_open(fast->solve);
	}
	const bool has_complex = any_of(complex, used);
	/* from here on the rows may be overwritten */
	for (int o = 0; o < 2; o++) {
		if (!sums[o])
			continue;
		if (!there[o] && !has_complex && count == used && fast->record_step == 1 && !fast->wants_more) {
			for (size_t i = 0; i < used; i += WIDTH / 4)
				memcpy(nt_fast_record(fast, o, (uint32_t)(first + i)), &(const lanes){0}, sizeof(lanes));
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

static void settle(nt_fast *fast, const nt_adjacency *adjacency, nt_record *const sums[2], size_t begin, size_t end,
	nt_settled *settled)
{
	for (size_t block = begin; block < end; block++)
		settle_block(fast, adjacency, sums, block, settled);
}

#endif
