/* SPDX-License-Identifier: MIT */
/*
 * Packed meshes: a triangle takes less than eight bytes, and of a mesh that is too large a part keeps its numbers. The
 * numbers of small ones are in tests/report/transcript.txt.
 */
#include "fail_alloc.h"
#include "test.h"

#include <libdeflate.h>
#include <math.h>
#include "report/pack/pack.h"

typedef struct unpacked {
	nt_packed packed;
	uint32_t *numbers[NT_PACKED_ARRAYS]; /* of each array */
	uint32_t *corners;                   /* its vertices */
} unpacked;

/* The numbers of an array; NULL: it is not there. */
static const uint32_t *numbers_of(const unpacked *u, const char *name)
{
	for (unsigned i = 0; i < NT_PACKED_ARRAYS; i++)
		if (u->packed.arrays[i].count && strcmp(u->packed.arrays[i].name, name) == 0)
			return u->numbers[i];
	return NULL;
}

static void unpack(unpacked *u, const nt_report *report, size_t most)
{
	assert_int_equal(nt_pack_mesh(&u->packed, report, 0, most), NT_OK);
	size_t size = 0;
	for (unsigned i = 0; i < NT_PACKED_ARRAYS; i++)
		size += u->packed.arrays[i].planes * u->packed.arrays[i].count;
	unsigned char *raw = test_malloc(size), *at = raw;
	struct libdeflate_decompressor *d = libdeflate_alloc_decompressor();
	assert_int_equal(libdeflate_deflate_decompress(d, u->packed.bytes.data, u->packed.bytes.size, raw,
				 size, NULL), LIBDEFLATE_SUCCESS);
	libdeflate_free_decompressor(d);
	for (unsigned i = 0; i < NT_PACKED_ARRAYS; i++) {
		const nt_packed_array *a = &u->packed.arrays[i];
		const uint32_t mask = a->planes < 4 ? (1u << 8 * a->planes) - 1 : UINT32_MAX;
		u->numbers[i] = test_calloc(a->count, sizeof **u->numbers);
		for (unsigned k = 0; k < a->planes; k++)
			for (size_t n = 0; n < a->count; n++)
				u->numbers[i][n] |= (uint32_t)*at++ << 8 * k;
		for (size_t n = 0; n < a->count; n++) {
			const uint32_t z = u->numbers[i][n], step = z & 1 ? 0u - (z / 2 + 1) : z / 2;
			u->numbers[i][n] = ((n ? u->numbers[i][n - 1] : 0) + step) & mask;
		}
	}
	test_free(raw);
	u->corners = test_malloc(3 * u->packed.triangle_count * sizeof *u->corners);
	uint32_t next = 0;
	for (size_t c = 0; c < 3 * u->packed.triangle_count; c++) {
		const uint32_t below = numbers_of(u, "corners")[c];
		u->corners[c] = next - below;
		next += below == 0;
	}
	assert_int_equal(next, u->packed.vertex_count);
}

static void forget(unpacked *u)
{
	for (unsigned i = 0; i < NT_PACKED_ARRAYS; i++)
		test_free(u->numbers[i]);
	test_free(u->corners);
	nt_buffer_free(&u->packed.bytes);
}

/* ---- meshes ---- */

typedef struct sheet {
	nt_report report;
	nt_report_mesh mesh;
	nt_report_geometry geometry;
} sheet;

/* A grid of n * n quads over a wavy surface with noise in every coordinate; the seed is fixed. */
static sheet *make_sheet(uint32_t n, bool attributes)
{
	sheet *s = test_calloc(1, sizeof *s);
	const size_t side = n + 1, vertices = side * side, triangles = 2 * (size_t)n * n;
	nt_report_geometry *g = &s->geometry;
	*g = (nt_report_geometry){.vertex_count = vertices, .triangle_count = triangles,
		.positions = test_malloc(3 * vertices * sizeof(float)),
		.normals = attributes ? test_malloc(3 * vertices * sizeof(float)) : NULL,
		.texcoords = attributes ? test_malloc(2 * vertices * sizeof(float)) : NULL,
		.computed = attributes ? test_malloc(4 * vertices * sizeof(float)) : NULL,
		.indices = test_malloc(3 * triangles * sizeof(uint32_t)), .orientation = test_malloc(triangles),
		.islands = test_calloc(triangles, sizeof(uint32_t))};
	uint32_t seed = 1;
	for (size_t v = 0; v < vertices; v++) {
		const double x = (double)(v % side), y = (double)(v / side);
		float noise[6];
		for (int i = 0; i < 6; i++) {
			seed = seed * 1664525u + 1013904223u;
			noise[i] = (float)(seed >> 8) / 16777216.0f;
		}
		float *p = g->positions + 3 * v;
		p[0] = (float)x + 0.3f * noise[0];
		p[1] = (float)y + 0.3f * noise[1];
		p[2] = 20.0f * (float)sin(x / 17) + noise[2];
		if (!attributes)
			continue;
		const float direction[4] = {noise[3] - 0.5f, noise[4] - 0.5f, noise[5] - 0.5f, v % 3 ? 1.0f : -1.0f};
		memcpy(g->normals + 3 * v, direction, 3 * sizeof(float));
		memcpy(g->computed + 4 * v, direction, 4 * sizeof(float));
		g->texcoords[2 * v] = (float)(x / n) - 3.0f;
		g->texcoords[2 * v + 1] = (float)(y / n);
	}
	for (size_t t = 0; t < triangles; t++) {
		const uint32_t a = (uint32_t)(t / 2 / n * side + t / 2 % n), b = a + (uint32_t)side;
		const uint32_t corners[2][3] = {{a, a + 1, b + 1}, {a, b + 1, b}};
		memcpy(g->indices + 3 * t, corners[t % 2], sizeof corners[0]);
		g->orientation[t] = 1;
	}
	s->mesh = (nt_report_mesh){.geometry = g, .triangle_count = triangles};
	s->report = (nt_report){.meshes = &s->mesh, .mesh_count = 1, .format = NT_FORMAT_OBJ};
	return s;
}

static void free_sheet(sheet *s)
{
	void *blocks[] = {s->geometry.positions, s->geometry.normals, s->geometry.texcoords, s->geometry.computed,
		s->geometry.indices, s->geometry.orientation, s->geometry.islands, s};
	for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
		if (blocks[i])
			test_free(blocks[i]);
}

/* ---- cases ---- */

TEST(positions_and_indices_take_less_than_eight_bytes_a_triangle)
{
	sheet *s = make_sheet(200, false);
	unpacked u;
	unpack(&u, &s->report, SIZE_MAX);
	assert_true(u.packed.whole);
	assert_int_equal(u.packed.vertex_count, 201 * 201);
	const double bytes = (double)u.packed.bytes.size / (double)u.packed.triangle_count;
	print_message("%.2f bytes a triangle\n", bytes);
	assert_true(bytes < 8.0);
	forget(&u);

	/* and no more where triangles stand in any order */
	for (size_t t = s->geometry.triangle_count - 1, seed = 7; t > 0; t--) {
		seed = (seed * 1103515245 + 12345) & 0x7fffffff;
		/* within some hundred of each other, as exporters sort by material and smoothing group */
		const size_t other = t - (seed >> 8) % (t < 400 ? t + 1 : 400);
		for (int k = 0; k < 3; k++) {
			const uint32_t kept = s->geometry.indices[3 * t + (size_t)k];
			s->geometry.indices[3 * t + (size_t)k] = s->geometry.indices[3 * other + (size_t)k];
			s->geometry.indices[3 * other + (size_t)k] = kept;
		}
	}
	unpack(&u, &s->report, SIZE_MAX);
	const double shuffled = (double)u.packed.bytes.size / (double)u.packed.triangle_count;
	print_message("%.2f bytes a triangle where neighbours lie apart\n", shuffled);
	assert_true(shuffled < 8.0);
	forget(&u);
	free_sheet(s);
}

TEST(a_mesh_above_the_bound_is_a_part_that_keeps_its_numbers)
{
	sheet *s = make_sheet(20, true);
	nt_report_finding finding = {.mesh = 0, .spot_count = 1, .spots = &(nt_spot){.triangle = 500}};
	s->report.findings = &finding;
	s->report.finding_count = 1;
	unpacked u;
	unpack(&u, &s->report, 50);
	assert_false(u.packed.whole);
	assert_int_equal(u.packed.triangle_count, 50);
	const uint32_t *numbers = numbers_of(&u, "numbers");
	bool found = false;
	for (uint32_t i = 0; i < 50; i++) {
		const uint32_t number = numbers[i];
		assert_true(i == 0 || number > numbers[i - 1]);
		assert_true(number > 500 - 170 && number < 500 + 170); /* four rings are four rows of 40 */
		found |= number == 500;
	}
	assert_true(found);
	forget(&u);
	free_sheet(s);
}

TEST(exhausted_memory_is_told_and_nothing_leaks)
{
	sheet *s = make_sheet(6, true);
	for (size_t most = 20; most <= 100; most += 80)
		for (size_t n = 0, failed = 1; failed; n++) {
			nt_packed packed;
			fail_allocations_from(n);
			const nt_status status = nt_pack_mesh(&packed, &s->report, 0, most);
			failed = stop_failing_allocations();
			assert_int_equal(status, failed ? NT_ERROR_MEMORY : NT_OK);
			nt_buffer_free(&packed.bytes);
		}
	free_sheet(s);
}
