/* SPDX-License-Identifier: MIT */
/*
 * The weld of the fast path, and nt_weld_corners(), against rows that are sorted and compared: on every number of
 * threads the same corners are one vertex.
 */
#include "test.h"
#include <math.h>
#include "budget.h"
#include "topology/corners.h"
#include "topology/weld.h"
#include "topology/inside.h"

static const unsigned thread_counts[] = {1, 2, 3, 8};
enum { THREAD_COUNTS = 4 };

typedef float vertex_row[8];

static nmtan_mesh mesh_of(const vertex_row *rows, size_t vertices, const uint32_t *indices, size_t corners)
{
	return (nmtan_mesh){.struct_bytes = sizeof(nmtan_mesh), .face_count = corners / 3,
		.vertex_count = vertices, .indices = indices,
		.positions = rows[0], .position_stride_bytes = 32, .normals = rows[0] + 3,
		.normal_stride_bytes = 32, .texcoords = rows[0] + 6, .texcoord_stride_bytes = 32};
}

/* Whether two numberings of corners have the same classes: each number of one always meets one of the other. */
static void assert_same_classes(const uint32_t *a, const uint32_t *b, size_t corners, size_t count)
{
	uint32_t *of = malloc(2 * count * sizeof *of);
	memset(of, 0xff, 2 * count * sizeof *of);
	for (size_t c = 0; c < corners; c++) {
		assert_in_range(a[c], 0, count - 1);
		assert_in_range(b[c], 0, count - 1);
		uint32_t *there = &of[a[c]], *back = &of[count + b[c]];
		if (*there == UINT32_MAX && *back == UINT32_MAX)
			*there = b[c], *back = a[c];
		assert_int_equal(*there, b[c]);
		assert_int_equal(*back, a[c]);
	}
	free(of);
}

/* Each corner's row of the weld is that of its vertex, as floats. */
static void assert_rows(const nt_weld *weld, const nmtan_mesh *mesh, size_t corners)
{
	for (size_t c = 0; c < corners; c++) {
		const size_t v = nt_vertex_of(mesh, c);
		const nt_weld_row *row = &weld->rows[weld->ids[c]];
		for (int i = 0; i < 8; i++) {
			const float expected = nt_position(mesh, v)[i];
			const float found = ((const float *)row)[i];
			assert_true(found == expected || (isnan(found) && isnan(expected)));
		}
	}
}

/* A corner's row, -0 made +0, and the corner. */
typedef struct sorted_row {
	float values[8];
	uint32_t corner;
} sorted_row;

static int compare_rows(const void *a, const void *b)
{
	const sorted_row *x = a, *y = b;
	const int order = memcmp(x->values, y->values, sizeof x->values);
	return order ? order : (x->corner > y->corner) - (x->corner < y->corner);
}

/* Numbers corners by sorting them. Returns how many numbers there are. */
static size_t number_by_sorting(const nmtan_mesh *mesh, size_t corners, uint32_t *ids)
{
	sorted_row *rows = malloc((corners + 1) * sizeof *rows);
	size_t count = 0;
	for (size_t c = 0; c < corners; c++) {
		rows[c].corner = (uint32_t)c;
		for (int i = 0; i < 8; i++)
			rows[c].values[i] = nt_position(mesh, nt_vertex_of(mesh, c))[i] + 0.0f;
	}
	qsort(rows, corners, sizeof *rows, compare_rows);
	for (size_t i = 0; i < corners; i++) {
		bool same = i > 0 && memcmp(rows[i - 1].values, rows[i].values, sizeof rows->values) == 0;
		for (int k = 0; k < 8; k++)
			same &= !isnan(rows[i].values[k]);
		count += !same;
		ids[rows[i].corner] = (uint32_t)count - 1;
	}
	free(rows);
	return count;
}

/* Welds on every number of threads, without memory that is borrowed and with so many bytes. */
static void check(const nmtan_mesh *mesh, size_t corners, size_t borrowed_bytes)
{
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	uint32_t *expected = nt_scratch_alloc(&scratch, corners, sizeof *expected);
	uint32_t *plain = nt_scratch_alloc(&scratch, corners, sizeof *plain);
	size_t plain_count;
	const size_t count = number_by_sorting(mesh, corners, expected);
	assert_int_equal(nt_weld_corners(mesh, corners, &scratch, plain, &plain_count), NMTAN_OK);
	assert_int_equal(plain_count, count);
	assert_same_classes(plain, expected, corners, count);
	for (int i = 0; i < (borrowed_bytes ? 2 : 1) * THREAD_COUNTS; i++) {
		const unsigned threads = thread_counts[i % THREAD_COUNTS];
		const size_t bytes = i < THREAD_COUNTS ? 0 : borrowed_bytes;
		nt_borrowed memory = nt_borrow(nt_scratch_alloc(&scratch, bytes, 1), bytes, &scratch);
		nt_weld weld;
		assert_int_equal(nt_weld_mesh(mesh, corners, threads, &memory, &memory, &weld), NMTAN_OK);
		assert_rows(&weld, mesh, corners);
		/* those of nt_weld_mesh() have gaps, and vertices that no corner uses */
		assert_true(weld.count >= count);
		assert_same_classes(weld.ids, expected, corners, weld.count);
	}
	nt_scratch_free(&scratch);
}

static uint32_t next_random(uint32_t *state)
{
	*state = *state * 1664525u + 1013904223u;
	return *state >> 8;
}

/* Rows of `kinds` values; the more there are the fewer are equal. */
static vertex_row *random_rows(size_t count, uint32_t kinds, float odd)
{
	vertex_row *rows = malloc(count * sizeof *rows);
	uint32_t state = 1 + kinds;
	for (size_t i = 0; i < count; i++) {
		const uint32_t kind = next_random(&state) % kinds;
		memcpy(rows[i], (float[8]){(float)kind, 0, 1, 0, 0, 1, (float)(kind % 7), 3}, sizeof *rows);
		if (next_random(&state) % 9 == 0)
			rows[i][next_random(&state) % 2 ? 1 : 3] = odd;
	}
	return rows;
}

/* The same of a soup, whose corners are its rows, with borrowed memory and without. */
static void check_soup(vertex_row *rows, size_t corners, size_t borrowed_bytes)
{
	const nmtan_mesh mesh = mesh_of(rows, corners, NULL, corners);
	check(&mesh, corners, borrowed_bytes);
	free(rows);
}

/* The same with the corners of random triangles. */
static void check_corners(const vertex_row *rows, size_t vertices, size_t corners, uint32_t seed)
{
	uint32_t *indices = malloc(corners * sizeof *indices);
	for (size_t c = 0; c < corners; c++)
		indices[c] = next_random(&seed) % (uint32_t)vertices;
	const nmtan_mesh mesh = mesh_of(rows, vertices, indices, corners);
	check(&mesh, corners, corners * 16);
	free(indices);
}

TEST(corners_and_vertices_weld_alike_on_all_threads)
{
	enum { COUNT = 9000, VERTICES = 5000 };
	/* from nearly one row to nearly all different, which the first table does not hold; -0 is 0 */
	static const uint32_t kinds[] = {1, 5, 1500, 4000, 1 << 24};
	for (int k = 0; k < 5; k++)
		for (int odd = 0; odd < 2; odd++) {
			check_soup(random_rows(COUNT, kinds[k], odd ? NAN : -0.0f), COUNT, COUNT * 48);
			vertex_row *rows = random_rows(VERTICES, kinds[k], odd ? NAN : -0.0f);
			check_corners(rows, VERTICES, COUNT, 7);
			free(rows);
		}
}

TEST(no_corners_weld_to_nothing)
{
	vertex_row rows[2] = {{0}};
	for (size_t vertices = 0; vertices < 3; vertices++)
		for (int indexed = 0; indexed < 2; indexed++) {
			nt_scratch scratch;
			nt_scratch_init(&scratch, NULL);
			nt_borrowed memory = nt_borrow(NULL, 0, &scratch);
			const nmtan_mesh mesh = mesh_of(rows, vertices, indexed ? (uint32_t[1]){0} : NULL, 0);
			nt_weld weld;
			for (int i = 0; i < THREAD_COUNTS; i++)
				assert_int_equal(nt_weld_mesh(&mesh, 0, thread_counts[i], &memory, &memory,
					&weld), NMTAN_OK);
			assert_in_range(weld.count, 0, vertices);
			nt_scratch_free(&scratch);
		}
}

TEST(few_corners_weld_alike_on_all_threads)
{
	for (size_t corners = 3; corners < 900; corners += corners / 3)
		for (uint32_t kinds = 1; kinds < 1000; kinds *= 9)
			check_soup(random_rows(corners, kinds, NAN), corners, corners * 16);
}

/* Two corners for three vertices and more: the weld goes by corner. */
TEST(few_of_many_vertices_weld_alike)
{
	enum { VERTICES = 5000, CORNERS = 900 };
	vertex_row *rows = random_rows(VERTICES, 300, -0.0f);
	check_corners(rows, VERTICES, CORNERS, 7);
	free(rows);
}

/* `equal` of a hundred vertices are the one before them, which may be one of them. */
static void check_doubles(size_t vertices, size_t corners, uint32_t equal, float odd)
{
	vertex_row *rows = malloc(vertices * sizeof *rows);
	uint32_t random = 3 + equal;
	for (size_t v = 0; v < vertices; v++) {
		memcpy(rows[v], (float[8]){(float)v, 1, 0, 0, 0, 1, 0, 0}, sizeof *rows);
		if (v > 0 && next_random(&random) % 100 < equal)
			memcpy(rows[v], rows[v - 1], sizeof *rows);
		if (next_random(&random) % 999 == 0)
			rows[v][3] = odd;
	}
	check_corners(rows, vertices, corners, random);
	free(rows);
}

TEST(some_equal_vertices_of_many_weld_alike)
{
	check_doubles(30000, 60000, 0, NAN);
	check_doubles(30000, 60000, 1, -0.0f);
	check_doubles(30000, 60000, 10, NAN);
}

/* Equal vertices in one place, as where a seam was appended: most corners keep their vertex. */
TEST(equal_vertices_in_one_place_weld_alike)
{
	enum { VERTICES = 5000, CORNERS = 3 * 3001 };
	static const size_t places[] = {1, 2000, VERTICES - 20};
	for (size_t p = 0; p < 3; p++)
		for (int odd = 0; odd < 2; odd++) {
			vertex_row *rows = calloc(VERTICES, sizeof *rows);
			for (size_t v = 0; v < VERTICES; v++)
				rows[v][0] = (float)v;
			for (size_t v = places[p]; v < places[p] + 20; v += 2)
				rows[v][0] = (float)(v / 3);
			rows[300][4] = odd ? NAN : 0;
			check_corners(rows, VERTICES, CORNERS, 21);
			free(rows);
		}
}

/* More than the filter bears. */
TEST(many_equal_vertices_weld_alike)
{
	check_doubles(60000, 90000, 25, -0.0f);
	check_doubles(60000, 90000, 90, NAN);
}

/* A row that has that hash with another key than this process, and that number. nt_weld_hash() adds the products of the
 * first and of the last two words, each with a word of the key added by XOR. If the first is 1 then, and the third
 * 0, the sum is the second, which is folded to itself and multiplied by an odd number; the fourth is free. */
static const nt_weld_key other_key = {{0x243f6a8885a308d3u, 0x13198a2e03707344u, 0xa4093822299f31d0u,
	0x082efa98ec4e6c89u}};

static void make_row_of_hash(uint64_t hash, uint32_t number, nt_weld_row *row)
{
	const uint64_t factor = 0x9e3779b97f4a7c15u;
	uint64_t inverse = factor; /* to 3 bits; each step doubles them */
	for (int i = 0; i < 5; i++)
		inverse *= 2 - factor * inverse;
	const float u = (float)number;
	uint32_t bits;
	memcpy(&bits, &u, sizeof bits);
	const uint64_t *key = other_key.words;
	memcpy(row, (uint64_t[4]){key[0] ^ 1, hash * inverse ^ key[1], key[2], bits}, sizeof *row);
}

/* Rows that were made for one hash spread over the table. Without the key of the process all would stand in one run,
 * and each be compared with those before it. */
TEST(rows_of_one_hash_spread)
{
	enum { COUNT = 20000 };
	nt_weld_row *rows = malloc(COUNT * sizeof *rows);
	for (uint32_t i = 0; i < COUNT; i++) {
		make_row_of_hash(0x123456789abcdef0u, i, &rows[i]);
		assert_true(nt_weld_row_ordered(&rows[i]));
		assert_true(nt_weld_hash(&other_key, &rows[i]) == 0x123456789abcdef0u);
	}
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	nt_borrowed memory = nt_borrow(NULL, 0, &scratch);
	const nmtan_mesh mesh = mesh_of((const vertex_row *)rows, COUNT, NULL, COUNT);
	nt_welder w = {.mesh = &mesh, .key = nt_weld_make_key(), .row_memory = &memory, .memory = &memory,
		.item_count = COUNT, .row_guess = COUNT, .numbers =
			nt_scratch_alloc(&scratch, COUNT, sizeof *w.numbers)};
	assert_true(nt_weld_items(&w, 1));
	assert_int_equal(w.row_count, COUNT);
	size_t run = 0;
	for (size_t at = 0; at < (size_t)1 << w.table_bits; at++) {
		run = w.table[at] == NT_WELD_EMPTY ? 0 : run + 1;
		assert_in_range(run, 0, COUNT / 10);
	}
	nt_scratch_free(&scratch);
	check(&mesh, COUNT / 3 * 3, 0);
	free(rows);
}

/* Fewer than a vector, a batch, and more. */
TEST(every_number_of_vertices_welds_alike)
{
	static const size_t counts[] = {1, 2, 3, 4, 5, 7, 31, 32, 33, 34, 35, 63, 64, 65, 129, 1000, 65536};
	for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
		check_doubles(counts[i], 3 * counts[i], 0, -0.0f);
		check_doubles(counts[i], 3 * counts[i], 5, -0.0f);
	}
}

/* Soups whose triangles have vertices of their own but for `equal` of a hundred, in the second half of the soup. */
static void check_flat_soup(size_t corners, uint32_t equal, float odd)
{
	vertex_row *rows = malloc(corners * sizeof *rows);
	uint32_t random = 5 + equal;
	for (size_t c = 0; c < corners; c++) {
		const bool again = c > corners / 2 && next_random(&random) % 100 < equal;
		const size_t kind = again ? next_random(&random) % c : c;
		memcpy(rows[c], (float[8]){(float)kind, 1, 0, 0, 0, 1, 0, 0}, sizeof *rows);
		if (next_random(&random) % 999 == 0)
			rows[c][3] = odd;
	}
	check_soup(rows, corners, corners * 16);
}

TEST(flat_soups_weld_alike)
{
	check_flat_soup(60000, 0, -0.0f);
	check_flat_soup(60000, 0, NAN);
	check_flat_soup(60000, 3, NAN);
	check_flat_soup(60000, 90, NAN); /* more than the filter bears */
}

/* So many that the filter lets through go to all threads. */
TEST(an_eighth_of_a_million_equal_vertices_weld_alike)
{
	check_doubles(900000, 500000, 11, NAN);
}

TEST(without_doubles_the_indices_of_the_mesh_are_the_numbers)
{
	enum { VERTICES = 3000 };
	vertex_row *rows = calloc(VERTICES, sizeof *rows);
	uint32_t indices[VERTICES];
	for (size_t i = 0; i < VERTICES; i++) {
		rows[i][0] = (float)i;
		indices[i] = (uint32_t)(VERTICES - 1 - i);
	}
	const nmtan_mesh mesh = mesh_of(rows, VERTICES, indices, VERTICES);
	for (int i = 0; i < THREAD_COUNTS; i++) {
		nt_scratch scratch;
		nt_scratch_init(&scratch, NULL);
		nt_borrowed memory = nt_borrow(NULL, 0, &scratch);
		nt_weld weld;
		assert_int_equal(nt_weld_mesh(&mesh, VERTICES, thread_counts[i], &memory, &memory, &weld), NMTAN_OK);
		assert_ptr_equal(weld.ids, indices);
		assert_int_equal(weld.count, VERTICES);
		assert_memory_equal(weld.rows, rows, VERTICES * sizeof *rows);
		nt_scratch_free(&scratch);
	}
	free(rows);
}

TEST(every_failed_allocation_is_told)
{
	enum { COUNT = 60000 };
	static const uint32_t kinds[] = {5, 20000, 1 << 26};
	for (int k = 0; k < 3; k++) {
		vertex_row *rows = random_rows(COUNT, kinds[k], NAN);
		uint32_t *indices = malloc(COUNT * sizeof *indices);
		for (uint32_t c = 0; c < COUNT; c++)
			indices[c] = c;
		for (int i = 0; i < 4; i++) {
			const nmtan_mesh mesh = mesh_of(rows, COUNT, i < 2 ? indices : NULL, COUNT);
			nmtan_status status = NMTAN_ERROR_MEMORY;
			size_t allowed = 0;
			for (; status; allowed++) {
				budget b = {allowed};
				nt_scratch scratch;
				nt_scratch_init(&scratch, &(nmtan_allocator){take_budget, give_back, &b});
				nt_borrowed memory = nt_borrow(NULL, 0, &scratch);
				nt_weld weld;
				status = nt_weld_mesh(&mesh, COUNT, i % 2 ? 3 : 1, &memory, &memory, &weld);
				assert_true(status == NMTAN_OK || status == NMTAN_ERROR_MEMORY);
				nt_scratch_free(&scratch);
				assert_in_range(allowed, 0, 40);
			}
			assert_in_range(allowed, 3, 40);
		}
		free(rows);
		free(indices);
	}
}
