/* SPDX-License-Identifier: MIT */
/* Bins against a plain loop over the corners: sums, states, entries, for one range and several. */
#include "tangent/fast/bins.h"
#include "test.h"

enum { VERTICES = 100, TRIANGLES = 400, BITS = 5 };

static uint32_t next_random(uint32_t *state)
{
	return *state = *state * 1664525u + 1013904223u;
}

/* A contribution that differs from all others and adds up without rounding. */
static nt_record contribution(size_t corner, uint32_t state)
{
	return (nt_record){(float)corner, 1.0f, -2.0f * (float)corner, state};
}

/* Differs from all others, up to the last bit that an entry holds. */
static nt_fan_entry entry_of(size_t corner, uint32_t vertex)
{
	return (nt_fan_entry){(uint32_t)corner << 16 | (uint32_t)corner % 2, ((uint32_t)1 << 28) - 1 - vertex};
}

static uint32_t state_of(size_t triangle)
{
	const uint32_t bits = NT_STATE_BASE | (NT_STATE_ALL & ~NT_STATE_EMPTY);
	return triangle % 7 == 0
		? bits & ~(uint32_t)NT_STATE_NO_ANY : bits & ~(uint32_t)(triangle % 2 ? NT_STATE_U : NT_STATE_V);
}

typedef struct expected {
	nt_record records[2][VERTICES];
	nt_fan_entry entries[VERTICES][3 * TRIANGLES];
	uint32_t degrees[VERTICES];
} expected;

/* Triangles of [begin, end) that take part, and corners of both orientations. */
static void fill(const nt_bins *bins, unsigned range, const uint32_t *ids, size_t begin, size_t end)
{
	uint32_t *cursors = bins->cursors + range * bins->count;
	for (size_t t = begin; t < end; t++) {
		if (t % 5 == 0)
			continue; /* collapsed: takes no part */
		for (size_t k = 0; k < 3; k++) {
			const uint32_t v = ids[3 * t + k], orient = t % 3 == 0;
			const uint32_t at = cursors[v >> BITS]++;
			bins->sums[at] = contribution(3 * t + k, state_of(t) |
				(v % (1u << BITS)) << NT_BINNED_SHIFT | orient << 31);
			const nt_fan_entry entry = entry_of(3 * t + k, v);
			nt_binned_store(bins->entries + NT_BINNED_ENTRY * at, entry.next, entry.previous);
		}
	}
}

static void expect(expected *e, const uint32_t *ids, bool both)
{
	memset(e, 0, sizeof *e);
	for (size_t v = 0; v < VERTICES; v++)
		e->records[0][v].state = e->records[1][v].state = NT_STATE_BASE | NT_STATE_ALL;
	for (size_t t = 0; t < TRIANGLES; t++)
		for (size_t k = 0; t % 5 != 0 && k < 3; k++) {
			const uint32_t v = ids[3 * t + k];
			nt_record *r = &e->records[both && t % 3 == 0][v];
			const nt_record add = contribution(3 * t + k, state_of(t));
			r->x += add.x, r->y += add.y, r->z += add.z;
			r->state &= both && t % 7 == 0 ? add.state & ~(uint32_t)NT_STATE_LOCAL : add.state;
			nt_fan_entry entry = entry_of(3 * t + k, v);
			entry.next |= (uint32_t)(t % 3 == 0) << 31;
			entry.previous |= (uint32_t)(t % 3 == 0) << 31;
			e->entries[v][e->degrees[v]++] = entry;
		}
}

static void compare(const nt_bins *bins, const expected *e, bool both)
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_bin bin;
	size_t hubs = 0;
	assert_int_equal(nt_bin_make(bins, (bool[2]){true, both}, &scratch, &bin), NMTAN_OK);
	for (size_t index = 0; index < bins->count; index++) {
		nt_bin_add_up(bins, index, &bin);
		const nt_adjacency a = bin.adjacency;
		assert_int_equal(a.first_vertex, index << BITS);
		for (size_t lane = 0; lane < a.vertex_count; lane++) {
			const size_t v = a.first_vertex + lane;
			for (int o = 0; o <= both; o++)
				assert_memory_equal(&bin.sums[o][lane], &e->records[o][v], sizeof(nt_record));
			if (e->degrees[v] > NT_FAN_DEPTH) {
				assert_true(a.cursors[lane] & NT_CURSOR_HUB);
				hubs++;
				continue;
			}
			const uint32_t first = a.block_begin[lane / NT_FAN_LANES] + (uint32_t)lane % NT_FAN_LANES;
			assert_int_equal(a.cursors[lane], first + e->degrees[v] * NT_FAN_LANES);
			for (uint32_t k = 0; k < e->degrees[v]; k++)
				assert_memory_equal(&a.entries[first + k * NT_FAN_LANES], &e->entries[v][k],
					sizeof *a.entries);
		}
	}
	assert_in_range(hubs, 1, VERTICES - 1);
	nt_scratch_free(&scratch);
}

static void check(unsigned ranges, bool both)
{
	static const size_t bounds[4][5] = {{0}, {0, TRIANGLES}, {0}, {0, 100, 100, TRIANGLES}};
	static expected e;
	uint32_t ids[3 * TRIANGLES], random = 1;
	/* the squares of small numbers come more often: some vertices are hubs */
	for (size_t i = 0; i < 3 * TRIANGLES; i++) {
		const uint32_t r = next_random(&random) >> 20;
		ids[i] = r * r / (4096 * 4096 / VERTICES) % VERTICES;
	}
	expect(&e, ids, both);
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	const nt_triangle_ranges cut = {ranges, bounds[ranges]};
	nt_borrowed memory = nt_borrow(NULL, 0, &scratch);
	nt_bins bins;
	assert_int_equal(nt_bins_make(ids, &cut, VERTICES, BITS, NULL, &memory, &bins), NMTAN_OK);
	assert_int_equal(bins.count, 4);
	for (unsigned r = ranges; r-- > 0;)
		fill(&bins, r, ids, cut.bounds[r], cut.bounds[r + 1]);
	compare(&bins, &e, both);
	nt_scratch_free(&scratch);
}

TEST(sums_are_in_triangle_order_with_one_range)
{
	check(1, false);
	check(1, true);
}

TEST(sums_are_in_triangle_order_with_several_ranges)
{
	check(3, false);
	check(3, true);
}

TEST(bins_stay_within_their_bits)
{
	for (size_t vertices = 1; vertices < (size_t)1 << 28; vertices *= 2) {
		assert_in_range(nt_bins_bits(vertices), 4, NT_BINNED_BITS);
		assert_true(nt_bins_bits(vertices) == NT_BINNED_BITS || vertices >> nt_bins_bits(vertices) < 512);
	}
}
