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

enum { POOLED = 3000, STEPS = 3, POINTS = STEPS * (STEPS + 1) / 2 };

typedef struct sampled {
	size_t triangle;
	image_triangle baker;
	double m[POINTS][3]; /* the field */
	bool pooled;         /* one of those spread evenly over the model, whose errors go into pools */
	bool raw_zero[3];    /* corners where MikkTSpace's raw tangent is zero */
} sampled;

typedef struct round_trip {
	sampled *triangles; /* [count] */
	size_t count;
	size_t pooled;     /* of them */
	size_t own_groups; /* corners of the pooled ones whose frame is MikkTSpace's own */
} round_trip;

/* The largest error of all triangles, in the first convention, and its corner: the one whose frame errs most. */
typedef struct worst_point {
	double degrees;
	size_t triangle, corner;
	bool raw_zero;
} worst_point;

round_trip round_trip_make(const model *m);
void round_trip_free(round_trip *r);

/* Adds the errors of a shading to one pool for each convention, and returns the largest error. A triangle that is not
 * there is left out. */
worst_point round_trip_judge(const round_trip *r, const shading *shader, measure_pool pools[IMAGE_CONVENTIONS]);

/* The errors of a shading at triangles whose baker has the sign of the other orientation, at all corners: halves of
 * quads that are folded, or concave and cut outside. */
typedef struct sign_errors {
	measure_pool pool; /* degrees, in the first convention */
	size_t triangles;
	double uv_share; /* of the texture area */
} sign_errors;

/* Bakes with the frames of a file, whatever they are, and shades with those of another of the same triangles, at those
 * that are wound against the w that they have in a third: `raw`. */
sign_errors round_trip_signs(const nt_owned *mesh, double size, const shading *raw, const shading *baker,
	const shading *shader);

#endif
