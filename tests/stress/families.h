/* SPDX-License-Identifier: MIT */
/*
 * Families of meshes that lead floating point to its edges, each swept over one number.
 */
#ifndef NT_STRESS_FAMILIES_H
#define NT_STRESS_FAMILIES_H

#include "surfaces.h"

typedef struct family {
	const char *name;
	const char *level_name; /* what is swept */
	const double *levels;   /* [level_count] */
	size_t level_count;
	bool logarithmic; /* the sweep */
	bool finite;      /* all values are finite and within 1e-30 to 1e30: what must hold is asked */
	bool linear;      /* the sweep is one of size: time per triangle must stay */
	bool parts;       /* MikkTSpace's groups follow edges: here they may be parts of the triangles of an orientation
	                     around a vertex, because edges are missing, and the exact average over all of them is no
	                     closer than these differ from each other */
	nt_owned (*make)(double level, uint64_t seed);
} family;

extern const family families[];
extern const size_t family_count;

#endif
