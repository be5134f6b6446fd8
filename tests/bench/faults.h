/* SPDX-License-Identifier: MIT */
/*
 * Tangents that a renderer cannot use, counted as tests/support/frames.mjs does for files: on meshes that are hard
 * for tangents.
 */
#ifndef NT_BENCH_FAULTS_H
#define NT_BENCH_FAULTS_H

#include <stdbool.h>
#include "surfaces.h"

enum { NASTY_MOST = 128 };

typedef struct faults {
	size_t corners;
	size_t wrong;   /* triangles with two values of w, or one that is not that of their orientation */
	size_t zero;    /* corners: not a vector of unit length */
	size_t leaning; /* corners: more than 2^-10 off perpendicular to the normal */
} faults;

/*
 * Triangle meshes of the families of make stress, within 1e-30 to 1e30 and finite, each followed by its mirrored twin:
 * the w of a corner that was never computed is right by chance on one of the two, and which one depends on the
 * direction of v that a tool works in. Returns their number; meshes is [NASTY_MOST].
 */
size_t nasty_make(nt_owned *meshes);

/* Adds those of one mesh. */
void faults_add(const nt_owned *mesh, const float (*tangents)[4], faults *sum);

/* Adds those of glTF files, counted by frames.mjs; false: it cannot be run. Files it cannot read are left out.
 *
 *   files  [count] paths */
bool faults_add_files(const char *const *files, size_t count, faults *sum);

#endif
