/* SPDX-License-Identifier: MIT */
/*
 * Tools that go from file to file: a model as GLB for them, and their result as frames of the model's corners.
 */
#ifndef NT_BENCH_FILES_H
#define NT_BENCH_FILES_H

#include <stdbool.h>
#include "surfaces.h"

/* A tangent and a normal for each corner of a mesh; there is no telling a triangle that is not there. */
typedef struct shading {
	float (*tangents)[4], (*normals)[3]; /* [corner count] */
	bool *there;                         /* [face count] */
	size_t missing;                      /* triangles */
} shading;

shading shading_make(const nt_owned *mesh);
void shading_free(shading *s);

/* A GLB of one primitive whose material has a normal map; v becomes -v. */
void files_write_glb(const char *path, const nt_owned *mesh);

/* The arrays of a mesh, as peers.mjs reads them. */
void files_write_mesh(const char *path, const nt_owned *mesh);

/* Runs a program without a word; seconds of the wall's clock, negative where it failed. */
double files_run(const char *const *arguments);

/*
 * Fills a shading with what a tool made of files_write_glb()'s mesh. Triangles are found by their place in the file,
 * where all are within 2^-12 of the mesh's size of where they were, else by their positions: the nearest within that.
 *
 *   nmtan  path of the tool that reads the GLB (it has its own tests) and writes it as PLY
 *   glb    the tool's output
 *   size   of the mesh
 *
 * False: there are no tangents.
 */
bool files_read_shading(const char *nmtan, const char *glb, const nt_owned *mesh, double size, shading *to);

#endif
