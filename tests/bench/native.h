/* SPDX-License-Identifier: MIT */
/*
 * Native peers, from shared libraries that the caller has built: this project has neither their source nor a recipe.
 */
#ifndef NT_BENCH_NATIVE_H
#define NT_BENCH_NATIVE_H

#include "surfaces.h"

enum { NATIVE_MOST = 3 };

typedef struct native {
	char name[64]; /* the library's file without "lib" and ".so", so that a version can stand there */
	void (*function)(void);
	unsigned flags; /* meshoptimizer's */
} native;

/*
 * Looks for libmeshoptimizer*.so and libmikktspace*.so (from mikktspace.c) in a folder; the system's libmeshoptimizer
 * where the folder has none. Prints which program is missing, or gives no tangents.
 *
 *   folder  NULL: the system alone
 *
 * Returns how many of peers [NATIVE_MOST] there are.
 */
size_t native_open(const char *folder, native *peers);

/* One tangent [4] for each corner of a triangle mesh, v up. False: the peer refused. */
bool native_solve(const native *peer, const nt_owned *mesh, float (*tangents)[4]);

#endif
