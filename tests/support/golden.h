/* SPDX-License-Identifier: MIT */
/*
 * Golden MikkTSpace output: un-indexed faces with the tangents that the reference implementation gives.
 * The format is that of data/golden/FORMAT.md.
 */
#ifndef NT_GOLDEN_H
#define NT_GOLDEN_H

#include <stddef.h>
#include <stdint.h>
#include "nmtan.h"

typedef struct nt_golden {
	uint32_t face_count, corner_count;
	uint8_t *face_sizes;
	float *positions, *normals, *texcoords, *tangents;
	void *block;
} nt_golden;

/* Reads one file; 0 when it cannot be read or is not a golden file. */
int nt_golden_read(nt_golden *golden, const char *path);
void nt_golden_free(nt_golden *golden);

/* The mesh of a golden file. */
nmtan_mesh nt_golden_mesh(const nt_golden *golden);

/* Calls `visit` for each .nmtg file of a folder in name order; returns how many there were. */
size_t nt_golden_each(const char *folder, void (*visit)(const char *path, const nt_golden *golden,
	void *context), void *context);

#endif
