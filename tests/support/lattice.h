/* SPDX-License-Identifier: MIT */
/*
 * A large mesh without any order, for the tests of the report's passes: vertices at the places of a lattice, several at
 * many of them, some at -0, some that are NaN, some that no triangle has; half of the triangles around one vertex,
 * some of which collapse, the others at random.
 */
#ifndef NT_LATTICE_H
#define NT_LATTICE_H

#include "test.h"
#include <math.h>
#include "report/surface/surface.h"

enum { LATTICE_SIDE = 40, LATTICE_VERTICES = 90000, LATTICE_TRIANGLES = 110000, LATTICE_HUB = 5 };

typedef struct lattice {
	nt_mesh mesh;
	float positions[3 * LATTICE_TRIANGLES][3], texcoords[3 * LATTICE_TRIANGLES][2];
	uint32_t places[3 * LATTICE_TRIANGLES]; /* of each vertex; NT_NONE: NaN */
	uint32_t indices[3 * LATTICE_TRIANGLES];
} lattice;

static inline uint32_t lattice_random(uint64_t *state)
{
	*state = *state * UINT64_C(6364136223846793005) + 1442695040888963407u;
	return (uint32_t)(*state >> 33);
}

/* indexed: or each corner has a vertex of its own. */
static inline lattice *lattice_new(bool indexed)
{
	lattice *l = calloc(1, sizeof *l);
	uint64_t random = 1;
	l->mesh.vertex_count = indexed ? LATTICE_VERTICES : 3 * LATTICE_TRIANGLES;
	l->mesh.face_count = LATTICE_TRIANGLES;
	l->mesh.corner_count = 3 * LATTICE_TRIANGLES;
	l->mesh.positions = l->positions[0];
	l->mesh.texcoords = l->texcoords[0];
	l->mesh.indices = indexed ? l->indices : NULL;
	for (size_t v = 0; v < l->mesh.vertex_count; v++) {
		uint32_t place = lattice_random(&random) % (LATTICE_SIDE * LATTICE_SIDE * LATTICE_SIDE);
		l->places[v] = v % 1000 == 7 ? NT_NONE : place;
		for (int i = 0; i < 3; i++, place /= LATTICE_SIDE) {
			const float x = (float)(place % LATTICE_SIDE);
			l->positions[v][i] = x == 0.0f && v % 2 ? -0.0f : x;
		}
		if (v % 1000 == 7)
			l->positions[v][v % 3] = NAN;
		l->texcoords[v][0] = v % 1000 == 9 ? NAN : (float)(v % 3);
		l->texcoords[v][1] = (float)(v % 5);
	}
	for (size_t c = 0; c < 3 * LATTICE_TRIANGLES; c++)
		l->indices[c] = c % 6 == 0 ? LATTICE_HUB : lattice_random(&random) % (LATTICE_VERTICES - 100);
	return l;
}

#endif
