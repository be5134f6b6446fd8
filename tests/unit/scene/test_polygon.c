/* SPDX-License-Identifier: MIT */
/*
 * Triangulations are judged by what they must be, not by a saved answer: n - 2 triangles, each wound
 * like the polygon, whose areas add up to the polygon's and which use every edge of the outline once.
 * Triangles of one orientation whose areas sum to that of a simple polygon cannot overlap or leave it.
 */
#include "growth.h"
#include "test.h"
#include <math.h>
#include <time.h>
#include "scene/values.h"

static double cross2(const double a[2], const double b[2], const double c[2])
{
	return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Checks a sound triangulation of a polygon that is given counter-clockwise in the plane and was put
 * into space by `points`. Returns the seconds that making it took. */
static double assert_proper(const double (*plane)[2], const float (*points)[3], size_t count)
{
	uint32_t *triangles = malloc(3 * (count - 2) * sizeof *triangles);
	unsigned char *edge_used = calloc(count, 1);
	bool sound = false;
	const clock_t begin = clock();
	assert_int_equal(nt_polygon_triangulate(points, NULL, count, triangles, &sound), NT_OK);
	const double seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
	assert_true(sound);
	double area = 0, sum = 0;
	for (size_t i = 1; i + 1 < count; i++)
		area += cross2(plane[0], plane[i], plane[i + 1]);
	for (size_t t = 0; t < count - 2; t++) {
		const uint32_t *c = &triangles[3 * t];
		assert_true(c[0] < count && c[1] < count && c[2] < count);
		const double part = cross2(plane[c[0]], plane[c[1]], plane[c[2]]);
		assert_true(part > 0);
		sum += part;
		for (int k = 0; k < 3; k++)
			if (c[(k + 1) % 3] == (c[k] + 1) % count)
				edge_used[c[k]]++;
	}
	assert_true(fabs(sum - area) <= 1e-6 * area);
	for (size_t i = 0; i < count; i++)
		assert_int_equal(edge_used[i], 1);
	free(edge_used);
	free(triangles);
	return seconds;
}

/* In the plane z = 0; at x = 7 with x as z, so that the normal becomes -x; in a tilted plane, spanned by vectors that
 * are not orthogonal. */
static void assert_proper_everywhere(const double (*plane)[2], size_t count)
{
	static const float spans[][3][3] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, {{0, 0, 1}, {0, 1, 0}, {7, 0, 0}},
		{{2, 1, 0}, {0, 1, 2}, {0, 0, 0}}};
	float points[16][3];
	for (size_t s = 0; s < 3; s++) {
		for (size_t i = 0; i < 3 * count; i++)
			points[i / 3][i % 3] = (float)(spans[s][0][i % 3] * plane[i / 3][0] +
				spans[s][1][i % 3] * plane[i / 3][1] + spans[s][2][i % 3]);
		assert_proper(plane, (const float(*)[3])points, count);
	}
}

TEST(convex_polygon_becomes_a_fan_in_order)
{
	const float points[6][3] = {{2, 0, 0}, {1, 2, 0}, {-1, 2, 0}, {-2, 0, 0}, {-1, -2, 0}, {1, -2, 0}};
	const uint32_t expected[12] = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5};
	uint32_t triangles[12];
	bool sound = false;
	assert_int_equal(nt_polygon_triangulate(points, NULL, 6, triangles, &sound), NT_OK);
	assert_true(sound);
	assert_memory_equal(triangles, expected, sizeof expected);
}

/* An arrow head whose notch is corner 3: the fan from 0 would leave it between (0,2,3) and (0,3,4).
 *
 *      4
 *      |\
 *      | 3---2      0 = (0,0), 1 = (4,0), 2 = (4,1), 3 = (1,1), 4 = (0,4)
 *      0-----1
 *
 * Corner 1: triangle (0,1,2) holds no corner but its own (3 is above its edge 0-2: 1 > 1/4), an ear.
 * Corner 2 then turns right from 0 over 2 to 3? (4,1)x(1,1) = 4*1 - 1*1 = 3 > 0: left, (0,2,3) an ear.
 * (0,3,4) is left. */
TEST(shapes_of_few_corners_are_proper)
{
	const double plane[5][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {0, 4}};
	assert_proper_everywhere(plane, 5);
	/* the same begun at corner 1: a fan from there leaves the polygon */
	const double turned[5][2] = {{4, 0}, {4, 1}, {1, 1}, {0, 4}, {0, 0}};
	assert_proper_everywhere(turned, 5);
	/* corners on straight edges */
	const double square[8][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
	assert_proper_everywhere(square, 8);
	const double triangle[6][2] = {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {2, 3}};
	assert_proper_everywhere(triangle, 6);
	/* a square with a square hole, joined by a bridge from (0,0) to (1,1): both ends appear twice */
	const double bridge[10][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
	assert_proper_everywhere(bridge, 10);
}

/* ---- what many corners cost ---- */

typedef void (*maker)(double (*plane)[2], size_t count);

/* Teeth point up; seen counter-clockwise the upper rim runs from right to left. */
static void make_comb(double (*plane)[2], size_t count)
{
	for (size_t i = 0; i < count - 2; i++) {
		plane[i][0] = (double)(count - i);
		plane[i][1] = i % 2 ? 1 : 50;
	}
	plane[count - 2][0] = 0, plane[count - 2][1] = 0;
	plane[count - 1][0] = (double)count + 1, plane[count - 1][1] = 0;
}

/* Out along one wall, back along the other, 40 turns. */
static void make_spiral(double (*plane)[2], size_t count)
{
	for (size_t i = 0; i < count / 2; i++) {
		const double angle = 80 * 3.14159265358979 * (double)i / (double)(count / 2);
		const size_t back = count - 1 - i;
		plane[i][0] = (2 + angle) * cos(angle), plane[i][1] = (2 + angle) * sin(angle);
		plane[back][0] = (1 + angle) * cos(angle), plane[back][1] = (1 + angle) * sin(angle);
	}
}

static void make_gear(double (*plane)[2], size_t count)
{
	for (size_t i = 0; i < count; i++) {
		const double angle = 2 * 3.14159265358979 * (double)i / (double)count;
		const double radius = i % 2 ? 1000 : 990;
		plane[i][0] = radius * cos(angle), plane[i][1] = radius * sin(angle);
	}
}

/* Radii at random: triangles are long slivers, whose bounding boxes hold thousands of corners that are not in them. */
static void make_star(double (*plane)[2], size_t count)
{
	uint32_t seed = 1;
	for (size_t i = 0; i < count; i++) {
		seed = seed * 1664525u + 1013904223u;
		const double angle = 2 * 3.14159265358979 * (double)i / (double)count;
		const double radius = 1000 + (double)(seed >> 8) / 1000;
		plane[i][0] = radius * cos(angle), plane[i][1] = radius * sin(angle);
	}
}

static maker make;

/* A polygon of that shape. */
static double cut(size_t count)
{
	double(*plane)[2] = malloc(count * sizeof *plane);
	float(*points)[3] = malloc(count * sizeof *points);
	make(plane, count);
	for (size_t i = 0; i < count; i++) {
		points[i][0] = (float)plane[i][0];
		points[i][1] = (float)plane[i][1];
		points[i][2] = 0;
		plane[i][0] = points[i][0];
		plane[i][1] = points[i][1];
	}
	const double seconds = assert_proper((const double(*)[2])plane, (const float(*)[3])points, count);
	free(plane);
	free(points);
	return seconds;
}

/* Ears of these that come one at a time made a version without the queue cubic. */
TEST(time_grows_little_faster_than_corners)
{
	static const struct {
		maker make;
		size_t least;
	} rows[] = {{make_comb, 1250}, {make_spiral, 1250}, {make_gear, 1250}, {make_star, 12500}};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		make = rows[i].make;
		assert_true(grows_slowly(cut, rows[i].least));
	}
}

/* Properties of every result: the right number of triangles, corners in range. */
static bool finish(const float (*points)[3], size_t count)
{
	uint32_t triangles[3 * 64];
	memset(triangles, 255, sizeof triangles);
	bool sound = true;
	assert_int_equal(nt_polygon_triangulate(points, NULL, count, triangles, &sound), NT_OK);
	for (size_t c = 0; c < 3 * (count - 2); c++)
		assert_true(triangles[c] < count);
	assert_int_equal(triangles[3 * (count - 2)], UINT32_MAX);
	return sound;
}

TEST(degenerate_polygons_are_finished_and_not_sound)
{
	static const struct {
		size_t count;
		float points[6][3];
	} rows[] = {
		{5, {{0, 10, 0}, {-6, -8, 0}, {10, 3, 0}, {-10, 3, 0}, {6, -8, 0}}},          /* a star */
		{6, {{0, 0, 0}, {2, 2, 0}, {4, 0, 0}, {4, 2, 0}, {2, 0, 0}, {0, 2, 0}}},      /* an eight */
		{5, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}}},                 /* a line */
		{5, {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}},                 /* a point */
		{5, {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}},                 /* a corner twice */
		{6, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 5, 0}, {2, 2, 0}, {0, 2, 0}}},      /* a spike */
		{5, {{0, 0, 0}, {1, 0, 0}, {NAN, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
		{5, {{0, 0, 0}, {1, 0, 0}, {INFINITY, 0, 0}, {1, 1, 0}, {0, 1, 0}}},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
		assert_false(finish(rows[i].points, rows[i].count));
}

/* The area of triangles in the plane z = 0, none of which is turned; sign: the polygon's. empty: some may be. */
static double sum_areas(const float (*points)[3], const uint32_t *triangles, size_t count, double sign, bool empty)
{
	double area = 0;
	for (size_t t = 0; t < count; t++) {
		double p[3][2];
		for (int k = 0; k < 6; k++)
			p[k / 2][k % 2] = points[triangles[3 * t + (size_t)k / 2]][k % 2];
		const double part = sign * cross2(p[0], p[1], p[2]);
		assert_true(empty ? part >= 0 : part > 0);
		area += part;
	}
	return area;
}

/* The repeated corner costs its own empty triangle and nothing else. */
TEST(repeated_point_leaves_the_rest_proper)
{
	const float points[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
	uint32_t triangles[9];
	bool sound = true;
	assert_int_equal(nt_polygon_triangulate(points, NULL, 5, triangles, &sound), NT_OK);
	assert_true(sum_areas(points, triangles, 3, 1, true) == 2.0);
}

/* Far from the origin and tiny, or huge: the plane is found relative to the first corner. */
TEST(size_and_distance_do_not_matter)
{
	const float shape[5][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {0, 4}};
	const float scales[3] = {1e-30f, 1e30f, 0.0625f}, offsets[3] = {0, 0, 100000};
	for (int k = 0; k < 3; k++) {
		float points[5][3];
		for (int i = 0; i < 5; i++) {
			points[i][0] = offsets[k] + scales[k] * shape[i][0];
			points[i][1] = offsets[k] + scales[k] * shape[i][1];
			points[i][2] = offsets[k];
		}
		assert_true(finish((const float(*)[3])points, 5));
	}
}

/* 20 000 random polygons, few of them simple, on a coarse grid of points so that touching, repeated
 * and collinear corners abound: always finished, and what is called sound has no triangle that is
 * empty or turned. */
TEST(sound_results_have_no_turned_triangle)
{
	uint32_t seed = 1;
	size_t sound_count = 0;
	for (int round = 0; round < 20000; round++) {
		float points[12][3];
		const size_t count = 3 + (size_t)round % 10;
		double area = 0;
		for (size_t i = 0; i < count; i++)
			for (int k = 0; k < 3; k++) {
				seed = seed * 1664525u + 1013904223u;
				points[i][k] = k < 2 ? (float)(seed >> 29) : 0;
			}
		for (size_t i = 0; i < count; i++) {
			const float *p = points[i], *q = points[(i + 1) % count];
			area += (double)p[0] * q[1] - (double)p[1] * q[0];
		}
		uint32_t triangles[3 * 10];
		bool sound = false;
		assert_int_equal(nt_polygon_triangulate((const float(*)[3])points, NULL, count, triangles, &sound),
			NT_OK);
		if (!sound)
			continue;
		sound_count++;
		assert_true(sum_areas((const float(*)[3])points, triangles, count - 2, area < 0 ? -1 : 1, false) ==
			fabs(area));
	}
	assert_true(sound_count > 1000);
}
