/* SPDX-License-Identifier: MIT */
/*
 * The meshes that the core is timed on: one family for each thing that can make a tangent solver slow.
 */
#ifndef NT_FAMILIES_H
#define NT_FAMILIES_H

#include "surfaces.h"

typedef enum nt_family {
	NT_FAMILY_CLEAN,     /* indexed torus */
	NT_FAMILY_NOISE,     /* positions, normals and UVs disturbed, one mirror seam */
	NT_FAMILY_SHUFFLED,  /* the clean torus with vertices and triangles in random order */
	NT_FAMILY_DEINDEXED, /* the clean torus, three rows for each triangle */
	NT_FAMILY_MIRRORED,  /* texture mirrored every four columns */
	NT_FAMILY_ZERO_UV,   /* 18 % of the vertices touch a triangle without UV area */
	NT_FAMILY_COLLAPSED, /* one more triangle for ten, with two corners at one position */
	NT_FAMILY_QUADS,     /* the clean torus in quads */
	NT_FAMILY_HUB,       /* fans of 100 000 triangles */
	NT_FAMILY_HALF,      /* as many collapsed triangles as sound ones */
	NT_FAMILY_COUNT
} nt_family;

extern const char *const nt_family_names[NT_FAMILY_COUNT];

/* A mesh with about that many triangles; its indices are NULL where it is not indexed. */
nt_owned nt_family_make(nt_family family, size_t triangles);

#endif
