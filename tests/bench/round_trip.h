/* SPDX-License-Identifier: MIT */
/*
 * Normal maps of real models, there and back: where they are sampled, and in which frames they were baked.
 *
 * The baker has MikkTSpace's frame without its rounding: the formula in 113 bits (oracle128.h). Two kinds of corners
 * are other: where MikkTSpace's own answer is usable and further from the formula than the bound of its rounding
 * (tests/stress/bounds.h), its group is a part of the triangles around the vertex, and bakers have that answer;
 * triangles without texture area, or with a corner that has no frame at all, are not sampled. The shader has the
 * vertices of the file, normals too.
 */
#ifndef NT_BENCH_ROUND_TRIP_H
#define NT_BENCH_ROUND_TRIP_H

#include "files.h"
#include "image.h"
#include "measure.h"
#include "models.h"

enum { SAMPLED = 3000, STEPS = 3, POINTS = STEPS * (STEPS + 1) / 2 };

typedef struct sampled {
	size_t triangle;
	image_triangle baker;
	double m[POINTS][3]; /* the field */
} sampled;

typedef struct round_trip {
	sampled *triangles; /* [count], spread evenly over the model */
	size_t count;
	size_t own_groups; /* corners of these whose frame is MikkTSpace's own */
} round_trip;

round_trip round_trip_make(const model *m);
void round_trip_free(round_trip *r);

/* Adds the errors of a shading to one pool for each convention. A triangle that is not there is left out. */
void round_trip_judge(const round_trip *r, const shading *shader, measure_pool pools[IMAGE_CONVENTIONS]);

#endif
