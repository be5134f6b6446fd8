/* SPDX-License-Identifier: MIT */
/*
 * Meshes that are hard for MikkTSpace's grouping, made from a seed: grids with random mirrors, soups over
 * few points, collapsed and zero-UV triangles, bowties, hubs, duplicate and reversed faces, quads mixed in,
 * -0, extreme scales, NaN and infinities; indexed or not, with doubled vertices and odd strides.
 */
#ifndef NT_NASTY_H
#define NT_NASTY_H

#include <stdint.h>
#include "nmtan.h"

typedef struct nt_nasty {
	nmtan_mesh mesh;
	size_t corner_count;
	void *blocks[5];
} nt_nasty;

/* The same seed gives the same mesh everywhere. A few hundred corners at most, but for some hubs. */
void nt_nasty_make(uint64_t seed, nt_nasty *nasty);
void nt_nasty_free(nt_nasty *nasty);

#endif
