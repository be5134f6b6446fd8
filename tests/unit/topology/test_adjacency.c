/* SPDX-License-Identifier: MIT */
/* Places of corners: filled as accumulate fills them, then read as settle reads them, in borrowed memory of every
 * size. */
#include "test.h"
#include "topology/adjacency.h"

enum { VERTICES = 200, TRIANGLES = 400, BLOCKS = (VERTICES + NT_FAN_LANES - 1) / NT_FAN_LANES };

static uint32_t ids[3 * TRIANGLES];

/* Squares of small numbers come more often: some vertices are hubs, and depths differ. */
static void make_ids(void)
{
	uint32_t random = 1;
	for (size_t i = 0; i < 3 * TRIANGLES; i++) {
		random = random * 1664525u + 1013904223u;
		const uint32_t r = random >> 20;
		ids[i] = VERTICES - 1 - r * r / (4096 * 4096 / VERTICES) % VERTICES;
	}
}

/* The corner is its own entry: numbers that no other has. */
static void fill(const nt_adjacency *a, unsigned range, size_t begin, size_t end)
{
	for (size_t i = 3 * begin; i < 3 * end; i++) {
		uint32_t *cursor = &a->cursors[range * a->vertex_count + ids[i]];
		if (*cursor & NT_CURSOR_HUB)
			continue;
		nt_adjacency_store(a, *cursor, (nt_fan_entry){(uint32_t)i, ids[i]});
		*cursor += NT_FAN_LANES;
	}
}

/* Each vertex has its corners in order, in its lane; a hub has none. Vertices of many corners are hubs; with fewer
 * places left than a block may need all those behind are. Returns the number of hubs. */
static size_t check_entries(const nt_adjacency *a, size_t most_places)
{
	size_t hubs = 0;
	for (uint32_t v = 0; v < VERTICES; v++) {
		const nt_fan_entry *entry = nt_adjacency_block(a, v / NT_FAN_LANES) + v % NT_FAN_LANES;
		const uint32_t cursor = a->cursors[(a->ranges - 1) * a->vertex_count + v];
		uint32_t degree = 0;
		for (uint32_t i = 0; i < 3 * TRIANGLES; i++)
			degree += ids[i] == v;
		const size_t left = most_places - a->block_begin[v / NT_FAN_LANES];
		const bool hub = degree > (left < NT_FAN_LANES * NT_FAN_DEPTH ? 0 : NT_FAN_DEPTH);
		assert_int_equal((cursor & NT_CURSOR_HUB) != 0, hub);
		hubs += hub;
		if (hub)
			continue;
		assert_int_equal((cursor & NT_CURSOR_PLACE) - a->block_begin[v / NT_FAN_LANES] - v % NT_FAN_LANES,
			degree * NT_FAN_LANES);
		for (uint32_t i = 0; i < 3 * TRIANGLES; i++)
			if (ids[i] == v) {
				assert_int_equal(entry->next, i);
				assert_int_equal(entry->previous, v);
				entry += NT_FAN_LANES;
			}
	}
	return hubs;
}

/* Entries lie in borrowed memory that holds them and one more, else in the scratch. */
TEST(borrowed_memory_of_any_size_gives_the_same_places)
{
	static const size_t bounds[2][4] = {{0, TRIANGLES}, {0, 100, 100, TRIANGLES}};
	static char borrowed[1 << 16];
	make_ids();
	for (size_t i = 0; i < 4; i++) {
		const size_t bytes = i < 2 ? 0 : sizeof borrowed;
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		nt_borrowed memory = nt_borrow(borrowed, bytes, &scratch), none = nt_borrow(borrowed, 0, &scratch);
		const nt_triangles triangles = {.ids = ids};
		const nt_triangle_ranges cut = {.count = i % 2 ? 3 : 1, .bounds = bounds[i % 2]};
		nt_adjacency a;
		assert_int_equal(nt_adjacency_make(&triangles, &cut, VERTICES, NT_ADJACENCY_PLACES, 0, &none,
			&memory, &a), NMTAN_OK);
		for (unsigned r = 0; r < cut.count; r++)
			fill(&a, r, cut.bounds[r], cut.bounds[r + 1]);
		assert_in_range(check_entries(&a, NT_ADJACENCY_PLACES), 1, VERTICES - 1);
		assert_int_equal((char *)a.entries >= borrowed && (char *)a.entries < borrowed + sizeof borrowed,
			bytes > 0);
		nt_scratch_free(&scratch);
	}
}

TEST(places_that_do_not_suffice_leave_hubs)
{
	make_ids();
	static const size_t bounds[4] = {0, 100, 100, TRIANGLES};
	size_t hubs = SIZE_MAX;
	for (size_t most = 0; most <= VERTICES * NT_FAN_DEPTH; most += 50) {
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		nt_borrowed memory = nt_borrow(NULL, 0, &scratch);
		const nt_triangles triangles = {.ids = ids};
		const nt_triangle_ranges cut = {.count = 3, .bounds = bounds};
		nt_adjacency a;
		assert_int_equal(nt_adjacency_make(&triangles, &cut, VERTICES, most, 0, &memory, &memory, &a),
			NMTAN_OK);
		assert_in_range(a.block_begin[BLOCKS], 0, most);
		for (unsigned r = 0; r < 3; r++)
			fill(&a, r, bounds[r], bounds[r + 1]);
		const size_t now = check_entries(&a, most);
		assert_in_range(now, 1, hubs);
		hubs = now;
		nt_scratch_free(&scratch);
	}
	assert_in_range(hubs, 1, VERTICES - 1);
}

/* Narrow entries are there for whoever is no hub; a hub knows how many corners it has. */
TEST(few_vertices_need_not_be_counted)
{
	make_ids();
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_borrowed memory = nt_borrow(NULL, 0, &scratch);
	const size_t bounds[3] = {0, 100, TRIANGLES};
	const nt_triangles triangles = {.ids = ids};
	nt_adjacency a;
	const nt_triangle_ranges two = {.count = 2, .bounds = bounds}, whole = {.count = 1, .bounds = bounds + 1};
	assert_int_equal(nt_adjacency_make(&triangles, &two, VERTICES, NT_ADJACENCY_PLACES, NT_NARROW_LIMIT, &memory,
		&memory, &a), NMTAN_OK);
	assert_null(a.narrow); /* two ranges */
	assert_int_equal(nt_adjacency_make(&triangles, &whole, VERTICES, NT_ADJACENCY_PLACES, VERTICES - 1, &memory,
		&memory, &a), NMTAN_OK);
	assert_null(a.narrow); /* a vertex too many */
	assert_int_equal(nt_adjacency_make(&triangles, &whole, VERTICES, NT_ADJACENCY_PLACES, VERTICES, &memory,
		&memory, &a), NMTAN_OK);
	assert_non_null(a.narrow);
	assert_true(a.step >= VERTICES && a.step / NT_FAN_LANES % 2 == 1);
	uint32_t degrees[VERTICES] = {0}, hubs = 0;
	for (uint32_t i = 0; i < 3 * TRIANGLES; i++) {
		const uint32_t v = ids[i], place = nt_adjacency_next(&a, &a.cursors[v]);
		assert_int_equal((place & NT_CURSOR_HUB) != 0, degrees[v] >= NT_FAN_DEPTH);
		if (!(place & NT_CURSOR_HUB))
			nt_adjacency_store(&a, place, (nt_fan_entry){(uint32_t)1 << 31 | i, (uint32_t)1 << 30 | v});
		degrees[v]++;
	}
	for (uint32_t v = 0; v < VERTICES; v++)
		if (degrees[v] > NT_FAN_DEPTH) {
			hubs++;
			assert_int_equal(a.cursors[v], NT_CURSOR_HUB | degrees[v]);
		} else {
			assert_int_equal(a.cursors[v], degrees[v] * a.step + v);
			degrees[v] = 0;
		}
	assert_in_range(hubs, 1, VERTICES - 1);
	for (uint32_t i = 0; i < 3 * TRIANGLES; i++)
		if (!(a.cursors[ids[i]] & NT_CURSOR_HUB))
			assert_int_equal(a.narrow[degrees[ids[i]]++ * a.step + ids[i]], 0x40008000 | ids[i] << 16 | i);
	nt_scratch_free(&scratch);
}
