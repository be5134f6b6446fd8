/* SPDX-License-Identifier: MIT */
/*
 * The image error of a normal map's round trip.
 *
 * A field m(p) of unit normals with detail (bumps of up to some 30 degrees) is known at every point of a surface. A
 * baker stores it as what the frame [T B N] of a point makes of it, a shader reads it back with a frame of its own:
 *
 *     texel = quantise(unit([T B N]baker^-1 m)),    shown = unit([T B N]shader texel)
 *     error = atan2(|shown x m|, shown . m), in degrees
 *
 * With equal frames only the quantisation is left: 0.18 degrees root mean square at 8 bits a channel, 0.0007 at 16.
 * Frames are interpolated over a triangle from its corners, in one of four ways, by baker and shader alike; w is
 * interpolated too. Filtering of textures is left out.
 */
#ifndef NT_BENCH_IMAGE_H
#define NT_BENCH_IMAGE_H

#include <stdbool.h>

typedef struct image_convention {
	const char *name;
	bool per_pixel;  /* B = cross(N, T) w of the interpolated vectors; else of each corner's, then interpolated */
	bool normalised; /* T, B and N have unit length again before they are used */
	int bits;        /* a channel of the map */
} image_convention;

enum { IMAGE_CONVENTIONS = 8 };
extern const image_convention image_conventions[IMAGE_CONVENTIONS];

/* The frames at a triangle's corners. */
typedef struct image_triangle {
	double t[3][3], n[3][3], w[3];
} image_triangle;

/* The field at a point p of an object of size 1, over the unit normal n there. */
void image_field(const double p[3], const double n[3], double m[3]);

/* The error at the point with these barycentric weights, in degrees; NaN where the baker's frame is singular. */
double image_error(const image_triangle *baker, const image_triangle *shader, const double weights[3],
	const double m[3], const image_convention *convention);

/*
 * Holds the measure against theory: a frame turned by a around N errs by 2 asin(sin f sin(a / 2)) where f is the angle
 * from m to N, one with the other w by 2 asin |m . B|, both within half a step of the map; quantisation alone has a
 * root mean square of (2 / (2^bits - 1)) / sqrt(6) radians. False, and a line on standard error: it departs.
 */
bool image_check(void);

#endif
