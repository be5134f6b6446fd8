/* SPDX-License-Identifier: MIT */
/*
 * A value that is stored as float is rounded, whatever the compiler makes of it. gcc 12 at -O2 keeps the doubles of
 * the first two lines for the fourth (-fno-tree-slp-vectorize in the Makefile), which breaks every promise of exact
 * results.
 */
#include "test.h"
#include <math.h>

enum { COUNT = 100 };

TEST(floats_are_rounded_before_they_are_widened)
{
	double(*plane)[2] = malloc(COUNT * sizeof *plane);
	float(*points)[3] = malloc(COUNT * sizeof *points);
	for (size_t i = 0; i < COUNT; i++) {
		const double angle = 0.1 * (double)i, radius = 1000 + (double)i / 3;
		points[i][0] = (float)(radius * cos(angle)), points[i][1] = (float)(radius * sin(angle));
		points[i][2] = 0;
		plane[i][0] = points[i][0], plane[i][1] = points[i][1];
	}
	for (size_t i = 0; i < COUNT; i++) {
		const volatile float x = points[i][0], y = points[i][1];
		assert_true(plane[i][0] == x && plane[i][1] == y);
	}
	free(plane);
	free(points);
}
