/* SPDX-License-Identifier: MIT */
/*
 * The meshes on which run time is held against error, and what is known of each.
 */
#ifndef NT_BENCH_ERROR_MESHES_H
#define NT_BENCH_ERROR_MESHES_H

#include <stdbool.h>
#include "surfaces.h"

enum { BENCH_MESH_COUNT = 9 };

typedef struct bench_mesh {
	const char *name;
	nt_owned mesh;
	bool has_truth; /* mesh.truth is filled in */
	bool is_eye;    /* coarse, for normal maps: bench_frame_at() knows its true frame */
} bench_mesh;

/* Fills all meshes: five surfaces of 128 x 128 cells, a bevelled edge, data/head.obj, and the two coarse
 * ones for the eye. An unreadable file leaves its mesh without faces. */
void bench_meshes_make(bench_mesh meshes[BENCH_MESH_COUNT]);
void bench_meshes_free(bench_mesh meshes[BENCH_MESH_COUNT]);

/*
 * Two planes at a right angle and a flat bevel of the given width between them, cells x cells quads on the
 * planes. u runs along the profile and v along the edge; on the bevel v is sheared by 4/3, as it is where
 * an atlas joins two islands, so that dP/du turns by atan(4/3 sqrt 2) = 62.1 degrees in the projection.
 * Vertices of the two edges carry the normals of the planes.
 */
nt_owned bench_bevel(double width, uint32_t cells);

/* The true frame at texture coordinates of an eye mesh: unit T and N. False where there is no truth (on
 * the bevel and beyond). */
bool bench_frame_at(const bench_mesh *mesh, const double uv[2], double t[3], double n[3]);

#endif
