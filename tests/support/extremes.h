/* SPDX-License-Identifier: MIT */
/*
 * Families of meshes that lead floating point to its edges, each swept over one number.
 */
#ifndef NT_EXTREMES_H
#define NT_EXTREMES_H

#include "surfaces.h"

typedef struct family {
	const char *name;
	const char *level_name; /* what is swept */
	const double *levels;   /* [level_count] */
	size_t level_count;
	bool linear;      /* the sweep is one of size: time per triangle must stay */
	/* Corners with MikkTSpace's own bytes of which tests/stress/bounds.h can say nothing: none in the first
	 * `bounded` levels, at most `most_unbounded` per cent of a mesh from there on. extremes.c says why. */
	size_t bounded;
	double most_unbounded;
	nt_owned (*make)(double level, uint64_t seed);
} family;

extern const family families[];
extern const size_t family_count;

#endif
