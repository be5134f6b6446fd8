/* SPDX-License-Identifier: MIT */
/*
 * What the eye gets: a normal map of a known detailed surface, decoded through interpolated frames.
 */
#ifndef NT_BENCH_ERROR_EYE_H
#define NT_BENCH_ERROR_EYE_H

#include "error_meshes.h"

/* Sums over samples; eye_psnr() and so on read it. */
typedef struct eye_sum {
	size_t samples;
	double squared_degrees, worst_degrees;
	double squared_shade; /* of the difference of diffuse shading in [0, 1] */
} eye_sum;

/*
 * Adds the samples of one eye mesh.
 *
 *   baker    [corner count][4] the frames in which the map was baked (8 bits a channel) from the detailed
 *            surface; NULL: the map was painted for a flat patch and tiles
 *   decoder  [corner count][4] the frames that shade with it
 */
void eye_add(const bench_mesh *mesh, const float (*baker)[4], const float (*decoder)[4], eye_sum *sum);

double eye_rms_degrees(const eye_sum *sum);
double eye_psnr(const eye_sum *sum); /* decibels of the shaded result */

#endif
