/* SPDX-License-Identifier: MIT */
/*
 * Memory of the fast path besides its output, one thread: at most 16 bytes a triangle on clean meshes, 40 on
 * others, and as much a face whatever quads do at a hub.
 */
#include "test.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/cpu.h"
#include "base/scratch.h"
#include "tangent/fast/fast.h"

typedef struct shape {
	float *p, *n, *t;
	unsigned *indices;
	size_t vertex_count, triangle_count;
	uint8_t *face_sizes; /* all 4, of half as many faces; NULL: triangles */
} shape;

static shape shape_make(size_t vertices, size_t triangles)
{
	return (shape){malloc(vertices * 12), malloc(vertices * 12), malloc(vertices * 8), malloc(triangles * 12),
		vertices, triangles, NULL};
}

static void put_vertex(shape *s, size_t v, float x, float y, float u, float v_up)
{
	memcpy(s->p + 3 * v, (float[3]){x, y, 0}, 12);
	memcpy(s->n + 3 * v, (float[3]){0, 0, 1}, 12);
	memcpy(s->t + 2 * v, (float[2]){u, v_up}, 8);
}

/* Bytes a triangle; frees the shape. */
static double solve_bytes(shape *s)
{
	const size_t faces = s->face_sizes ? s->triangle_count / 2 : s->triangle_count;
	const nmtan_mesh mesh = {.struct_bytes = sizeof mesh, .face_count = faces, .face_sizes = s->face_sizes,
		.vertex_count = s->vertex_count, .positions = s->p,
		.normals = s->n, .texcoords = s->t, .indices = s->indices, .position_stride_bytes = 12,
		.normal_stride_bytes = 12, .texcoord_stride_bytes = 8};
	float *tangents = malloc(s->triangle_count * 48);
	nt_scratch scratch;
	nt_scratch_init(&scratch, NULL);
	const nt_solve solve = {.mesh = &mesh, .corner_count = (s->face_sizes ? 4 : 3) * faces, .threshold_cos = -1.0f,
		.threads = 1, .isa = nt_cpu_best(), .scratch = &scratch, .tangents = tangents};
	assert_int_equal(nt_mikktspace_fast(&solve), NMTAN_OK);
	const double bytes = (double)nt_scratch_bytes(&scratch) / (double)s->triangle_count;
	nt_scratch_free(&scratch);
	free(tangents);
	free(s->p);
	free(s->n);
	free(s->t);
	free(s->indices);
	free(s->face_sizes);
	return bytes;
}

enum { SPOKES = 50000 };

/* One hub; texture coordinates are positions, but along the last `flat` triangles all the same. */
static shape make_hub(size_t flat)
{
	shape s = shape_make(SPOKES + 1, SPOKES);
	put_vertex(&s, 0, 0, 0, 0, 0);
	for (size_t i = 0; i < SPOKES; i++) {
		const double angle = 6.283185307179586 * (double)i / SPOKES;
		const float x = (float)cos(angle), y = (float)sin(angle);
		const bool framed = i < SPOKES - flat;
		put_vertex(&s, i + 1, x, y, framed ? x : 0, framed ? y : 0);
		memcpy(s.indices + 3 * i, (unsigned[3]){0, (unsigned)i + 1, (unsigned)((i + 1) % SPOKES) + 1}, 12);
	}
	return s;
}

TEST(hubs_take_at_most_45_bytes_a_triangle)
{
	for (size_t flat = 0; flat < 1000; flat += 300) {
		shape hub = make_hub(flat);
		assert_true(solve_bytes(&hub) <= 45);
	}
}

/* Quads at one hub whose halves have opposite directions: from the hub, the ends of both are in the direction of x, one
 * at u = 1 and the other at u = -1; their diagonal's are at v = 1 and v = -1 by turns. */
static shape make_opposite_quads(size_t quads)
{
	shape s = shape_make(2 * quads + 2, 2 * quads);
	s.face_sizes = malloc(quads);
	memset(s.face_sizes, 4, quads);
	put_vertex(&s, 0, 0, 0, 0, 0);
	for (size_t i = 0; i <= quads; i++) {
		const float side = i % 2 ? -1 : 1;
		put_vertex(&s, 2 * i + 1, 1 + (float)i / 65536, 0, side, 0);
		const unsigned end = (unsigned)(2 * i + 1);
		if (i < quads) {
			put_vertex(&s, end + 1, (float)(i % 7), 1 + (float)i / 65536, 0, side);
			memcpy(s.indices + 4 * i, (unsigned[4]){0, end, end + 1, end + 2}, 16);
		}
	}
	return s;
}

/* Each half has a sum of its own, of half the hub's corners: that takes time, but no memory, where MikkTSpace has a
 * list of these corners for each. Beside the 40 bytes there are a vertex a triangle (a row of 32), the directions of
 * members, their sums and the results of halves (40 each), numbers (24 at most), and what the scratch's blocks have
 * left. */
TEST(opposite_quads_take_memory_by_their_number)
{
	for (size_t quads = 4000; quads < 10000; quads *= 2) {
		shape hub = make_opposite_quads(quads);
		assert_true(solve_bytes(&hub) <= 40 + 32 + 3 * 40 + 24 + 40);
	}
}

/* A square; u goes back and forth over `period` columns. */
static shape make_square(size_t period)
{
	enum { SIDE = 200 };
	shape s = shape_make((SIDE + 1) * (SIDE + 1), 2 * SIDE * SIDE);
	for (size_t v = 0; v < s.vertex_count; v++) {
		const size_t column = v % (SIDE + 1), at = column % (2 * period);
		const float y = (float)(v / (SIDE + 1));
		put_vertex(&s, v, (float)column, y, (float)(at < period ? at : 2 * period - at), y);
	}
	for (size_t i = 0; i < SIDE * SIDE; i++) {
		const unsigned a = (unsigned)(i + i / SIDE), b = a + 1, d = a + SIDE + 1, c = d + 1;
		memcpy(s.indices + 6 * i, (unsigned[6]){a, b, c, a, c, d}, 24);
	}
	return s;
}

TEST(clean_meshes_take_at_most_16_bytes_a_triangle)
{
	shape square = make_square(1000);
	assert_true(solve_bytes(&square) <= 16);
}

TEST(mirrored_meshes_take_at_most_40_bytes_a_triangle)
{
	for (size_t period = 1; period < 6; period++) {
		shape square = make_square(period);
		assert_true(solve_bytes(&square) <= 40);
	}
}
