/* SPDX-License-Identifier: MIT */
/*
 * Real meshes to measure on, and stand-ins where there are none.
 */
#ifndef NT_BENCH_MODELS_H
#define NT_BENCH_MODELS_H

#include <stdbool.h>
#include "surfaces.h"

enum { MODEL_MOST = 32 };

typedef struct model {
	char name[64];
	nt_owned mesh; /* triangles */
	double size;   /* of its bounding box: the longest side */
} model;

/*
 * Reads the PLY files that models.sh made of real models. Quads are cut at their first corner. If a file has no
 * normals, they are made: sums of triangles' normals by area; all get unit length, as bakers have them. If it has no
 * texture coordinates, x and y are projected to [0, 1]: the silhouettes are mirror seams. Without a file there are
 * stand-ins.
 *
 *   files   [count] paths
 *   models  [MODEL_MOST]
 *
 * Returns how many models there are. A file that is not what nmtan writes ends the program.
 */
size_t models_make(char *const *files, size_t count, model *models);

/* A triangle mesh from a binary PLY as nmtan writes it; tangents [vertex count][4], NULL where it has none; either
 * is for the caller to free. */
nt_owned model_read_ply(const char *path, float (**tangents)[4]);

void models_free(model *models, size_t count);

#endif
