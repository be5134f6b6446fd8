/* SPDX-License-Identifier: MIT */
/*
 * Meshes over surfaces whose dP/du is known in closed form, and a plain mesh that owns its arrays.
 */
#ifndef NT_SURFACES_H
#define NT_SURFACES_H

#include <stdbool.h>
#include <stdint.h>
#include "nmtan.h"

/* A mesh with its own arrays; mesh points to them. */
typedef struct nt_owned {
	nmtan_mesh mesh;
	size_t corner_count;
	float (*positions)[3], (*normals)[3], (*texcoords)[2]; /* [mesh.vertex_count] */
	uint32_t *indices;                                     /* [corner_count] */
	uint8_t *face_sizes;                                   /* NULL: triangles */
	double (*truth)[3]; /* [mesh.vertex_count] unit dP/du; zero where it is not known */
} nt_owned;

/* Zeroed arrays; ends the program when memory is exhausted. */
nt_owned nt_owned_make(size_t vertex_count, size_t triangle_count);
nt_owned nt_owned_make_quads(size_t vertex_count, size_t quad_count);
void nt_owned_free(nt_owned *owned);

/* Random numbers that are the same everywhere (xorshift64*). */
typedef struct nt_random {
	uint64_t state;
} nt_random;
nt_random nt_random_seed(uint64_t seed);
uint32_t nt_random_below(nt_random *random, uint32_t count);
double nt_random_real(nt_random *random); /* [0, 1) */

/* A point of a surface over parameters (a, b) in [0, 1]^2. */
typedef struct nt_surface_point {
	double p[3], n[3]; /* position, unit normal */
	double uv[2];
	double t[3]; /* unit dP/du */
} nt_surface_point;

typedef enum nt_surface {
	NT_SPHERE, /* without its poles */
	NT_TORUS,
	NT_STRIP,  /* half a twist */
	NT_SADDLE, /* sheared UVs */
	NT_NOISE,  /* a height field of a few sines */
	NT_SURFACE_COUNT
} nt_surface;

extern const char *const nt_surface_names[NT_SURFACE_COUNT];

nt_surface_point nt_surface_at(nt_surface surface, double a, double b);

/* A grid of columns x rows cells, two triangles each, diagonals alternating. Inner vertices move by up to
 * `jitter` cells in the parameters. Both sides of a seam have their own vertices. */
nt_owned nt_surface_grid(nt_surface surface, uint32_t columns, uint32_t rows, double jitter,
	uint64_t seed);

#endif
