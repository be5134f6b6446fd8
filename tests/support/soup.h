/* SPDX-License-Identifier: MIT */
/*
 * A mesh as a bag of faces, each corner with its own eight floats: what tests transform, shrink and keep.
 */
#ifndef NT_SOUP_H
#define NT_SOUP_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include "golden.h"
#include "surfaces.h"

typedef struct soup {
	size_t face_count, corner_count;
	uint8_t *sizes;                                        /* [face_count] */
	float (*positions)[3], (*normals)[3], (*texcoords)[2]; /* [corner_count] */
} soup;

soup soup_make(size_t face_count, size_t corner_count);
soup soup_copy(const soup *from);
void soup_free(soup *s);

soup soup_from_mesh(const nmtan_mesh *mesh, size_t most_faces); /* strides must be 0 */
nmtan_mesh soup_mesh(const soup *s);

/* Random faces over few points, a third of them quads; some collapsed, some without UV area. */
soup soup_random(uint64_t seed);

/* The faces whose `keep` is true. */
soup soup_select(const soup *s, const bool *keep);

/* Faces of an OBJ file that have texture coordinates, at most most_faces; flat normals where it has none.
 * An empty soup where it cannot be read. No groups, no materials. */
soup soup_read_obj(const char *path, size_t most_faces);

/* Floats are printed so that reading gives them back. */
void soup_write_obj(const soup *s, FILE *to, const char *comment);

/* Equal rows (by bits) become one vertex: indices [corner_count] into vertices, numbered by first use. */
typedef struct soup_indexed {
	nmtan_mesh mesh;
	uint32_t *indices;
	float (*positions)[3], (*normals)[3], (*texcoords)[2];
} soup_indexed;
soup_indexed soup_index(const soup *s);
void soup_indexed_free(soup_indexed *indexed);

#endif
