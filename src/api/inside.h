/* SPDX-License-Identifier: MIT */
/*
 * From the tangents of corners to those of vertices, in the arrays of the caller.
 */
#ifndef NT_API_INSIDE_H
#define NT_API_INSIDE_H

#include <stdbool.h>
#include "base/scratch.h"
#include "nmtan.h"
#include "tangent/solve.h"
#include "topology/split.h"

/* ---- from a method's result: vertices.c ---- */

/* From a method's result, which may be sparse: checks or repairs it, and splits. Returns what
 * nmtan_vertex_tangents() does. */
nmtan_status nt_repair_and_split(const nt_solve *solve, nmtan_counts *counts, nt_splitter *splitter);

/* ---- the output of a split: split.c ---- */

/* Between the caller's arrays and those of the splitter, which knows plain meshes and rows of tangents that are tightly
 * packed. */

/* Rows of tangents. */
enum { NT_TANGENT_BYTES = 4 * sizeof(float) };

typedef struct nt_split_places {
	nmtan_split_output given; /* the caller's, the stride filled in */
	nmtan_split_output own;   /* the splitter's: the same arrays where they fit */
	const uint32_t *corners;  /* of vertices that have come into being; NULL: vertices are the caller's */
	size_t made;              /* how many have */
} nt_split_places;

/* Copies what the caller gave; false where its members contradict each other. */
bool nt_split_read(nt_split_places *places, const nmtan_mesh *mesh, const nmtan_split_output *output);

/* Sets `own` for a mesh that nt_make_plain() made of one with so many corners. Returns NMTAN_OK or
 * NMTAN_ERROR_MEMORY. */
nmtan_status nt_split_begin(nt_split_places *places, const nmtan_mesh *plain, size_t corner_count,
	const uint32_t *corners, nt_scratch *scratch);

/* Brings what the splitter wrote to the caller's arrays. Returns NMTAN_OK or NMTAN_ERROR_CAPACITY. */
nmtan_status nt_split_end(nt_split_places *places, const nmtan_mesh *plain);

/* Copies rows of tangents, where they are not in their place. */
void nt_put_tangents(float *to, size_t stride_bytes, const float *from, size_t count);

#endif
